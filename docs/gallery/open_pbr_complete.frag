#version 400

// Car_Paint

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform bool u_refractionTwoSided = false;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform float open_pbr_surface_surfaceshader_base_weight = 1.0;
uniform vec3 open_pbr_surface_surfaceshader_base_color = vec3(0.1, 0.6, 0.9);
uniform float open_pbr_surface_surfaceshader_base_diffuse_roughness = 0.0;
uniform float open_pbr_surface_surfaceshader_base_metalness = 0.0;
uniform float open_pbr_surface_surfaceshader_specular_weight = 1.0;
uniform vec3 open_pbr_surface_surfaceshader_specular_color = vec3(1);
uniform float open_pbr_surface_surfaceshader_specular_roughness = 0.3;
uniform float open_pbr_surface_surfaceshader_specular_ior = 1.6;
uniform float open_pbr_surface_surfaceshader_specular_roughness_anisotropy = 0.0;
uniform float open_pbr_surface_surfaceshader_transmission_weight = 0.0;
uniform vec3 open_pbr_surface_surfaceshader_transmission_color = vec3(1);
uniform float open_pbr_surface_surfaceshader_transmission_depth = 0.0;
uniform float open_pbr_surface_surfaceshader_subsurface_weight = 0.0;
uniform vec3 open_pbr_surface_surfaceshader_subsurface_color = vec3(0.8);
uniform float open_pbr_surface_surfaceshader_subsurface_scatter_anisotropy = 0.0;
uniform float open_pbr_surface_surfaceshader_fuzz_weight = 0.0;
uniform vec3 open_pbr_surface_surfaceshader_fuzz_color = vec3(1);
uniform float open_pbr_surface_surfaceshader_fuzz_roughness = 0.5;
uniform float open_pbr_surface_surfaceshader_coat_weight = 1.0;
uniform vec3 open_pbr_surface_surfaceshader_coat_color = vec3(1);
uniform float open_pbr_surface_surfaceshader_coat_roughness = 0.02;
uniform float open_pbr_surface_surfaceshader_coat_roughness_anisotropy = 0.0;
uniform float open_pbr_surface_surfaceshader_coat_ior = 1.6;
uniform float open_pbr_surface_surfaceshader_coat_darkening = 1.0;
uniform float open_pbr_surface_surfaceshader_thin_film_weight = 0.0;
uniform float open_pbr_surface_surfaceshader_thin_film_thickness = 0.5;
uniform float open_pbr_surface_surfaceshader_thin_film_ior = 1.4;
uniform float open_pbr_surface_surfaceshader_emission_luminance = 0.0;
uniform vec3 open_pbr_surface_surfaceshader_emission_color = vec3(1);
uniform float open_pbr_surface_surfaceshader_geometry_opacity = 1.0;
uniform bool open_pbr_surface_surfaceshader_geometry_thin_walled = false;

in VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
	vec3 tangentWorld;
} vd;

out vec4 out1;

// Mode "zeltner": a layer of upright fibres in which light scatters any number of times (Zeltner, Burley and Chiang
// 2022, Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines, eq. 1).
float fibre_albedo(float roughness, float NV)
{
	float r = clamp(roughness, 0.01, 1.0);
	float x = NV * (r * (0.0790869 * r + 0.669584) + 0.198854 + NV * (1.36266 - 1.34894 * r));
	float x2 = -(r * (r * (0.802235 - 0.409352 * r) + -0.123956) + 0.0111547 + x) / (r * (r + 0.0353364 + NV * (0.00039855 * r + 0.102131)));
	return exp(x2);
}

// Reads a latitude-longitude map: v = 0 is the zenith, u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d, float level)
{
	return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0))), level).xyz;
}

// Reflectance of a thin film over an interface to n + ik (Belcour and Barla 2017, eq. 8).
vec3 fresnel_thin_film(float c, vec3 n, float thickness, float film_ior)
{
	float film = max(film_ior, 1.0);
	float inside = sqrt(1.0 - (1.0 - c * c) / (film * film));
	float phase = inside * (thickness * (1.256637e-08 * film));
	vec3 v = n / film;
	vec3 re = v * v;
	float x = inside * inside;
	vec3 t = re - (1.0 - x);
	vec3 m = sqrt(t * t);
	vec3 u = sqrt(max(0.5 * (t + m), 0.0));
	vec3 w = sqrt(max(0.5 * (m - t), 0.0));
	vec3 scale = 1.0 / max(re * re, 1e-12);
	vec3 up = scale * (re * u);
	vec3 wp = scale * (re * w);
	int polarisations = 0.0 < thickness ? 2 : 0;
	float x2 = film * inside;
	float x3 = inside / film;
	float x4 = -2.0 * inside;
	vec3 u2 = u;
	vec3 w2 = w;
	vec3 sum = vec3(0);
	for (int p = 0; p < polarisations; p++)
	{
		float y = p == 0 ? x2 : x3;
		float r = (c - y) / (c + y);
		float R12 = r * r;
		float T = 1.0 - R12;
		vec3 v2 = inside - u2;
		vec3 v3 = w2 * w2;
		vec3 v4 = inside + u2;
		vec3 R23 = (v2 * v2 + v3) / max(v3 + v4 * v4, 1e-12);
		vec3 shift = atan(w2 * x4, x - u2 * u2 - v3) + (0.0 < r ? 3.1415927 : 0.0);
		vec3 R123 = R12 * R23;
		vec3 steady = R23 * (T * T) / (1.0 - R123);
		vec3 R123_2 = sqrt(R123);
		vec3 sum2 = sum + R12 + steady;
		vec3 wave = steady - T;
		for (int i = 0; i < 2; i++)
		{
			vec3 wave2 = R123_2 * wave;
			float x5 = float(i + 1);
			float x6 = phase * x5;
			vec3 v5 = shift * x5;
			vec3 v6 = vec3(9.04581e-08, 1.068737e-07, 1.069699e-07) * cos(v5 + vec3(1681000.0, 1795300.0, 2208400.0) * x6);
			vec3 v7 = vec3(1.644e-08 * cos(2239900.0 * x6 + v5.x) * exp(x6 * (-4528200000.0 * x6)), 0.0, 0.0);
			vec3 v8 = 2.0 * wave2 * (9358910.0 * (v6 * exp(x6 * (vec3(-4327800000.0, -9304600000.0, -6612100000.0) * x6)) + v7));
			sum2 += v8;
			wave = wave2;
		}
		u2 = up;
		w2 = wp;
		sum = sum2;
	}
	return clamp(0.5 * (mat3(2.3706744, -0.513885, 0.0052982, -0.9000405, 1.4253036, -0.0146949, -0.4706338, 0.0885814, 1.0093968) * sum), 0.0, 1.0);
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light(vec2 roughness, bool refracts, bool clear, float ior, vec3 base, vec3 rise, vec3 dip, vec3 N, vec3 V, vec3 X, out vec3 albedo)
{
	bool isotropic = roughness.x == roughness.y;
	vec3 tangent = isotropic ? V : X;
	vec3 tangent2 = tangent - N * dot(N, tangent);
	vec3 v = cross(N, abs(N.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0));
	vec3 x = normalize(dot(tangent2, tangent2) < 1e-08 ? v : tangent2);
	vec3 y = cross(N, x);
	float NV = clamp(dot(N, V), 0.0001, 1.0);
	vec2 p = clamp(roughness, 0.0001, 1.0);
	vec3 alpha = vec3(p, 1.0);
	float x2 = NV * NV;
	vec3 v2 = vec3(dot(V, x), dot(V, y), NV);
	vec3 wide = alpha * v2;
	float stretched = length(wide);
	vec3 s = wide / stretched;
	float mean = sqrt(p.x * p.y);
	float x3 = mean * mean;
	float toView = sqrt(mix(x2, 1.0, x3));
	float count = float(u_envRadianceSamples);
	float descent = (s.z + 1.0) / count;
	float reach = NV + stretched;
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(count / (reach * (p.y * (6.2831855 * p.x))));
	mat3 frame = mat3(u_envMatrix) * mat3(x, y, N);
	vec3 away = refracts ? v2 : -v2;
	float x4 = 1.0 / ior;
	float n2 = max(ior * ior, 0.0001);
	float x5 = n2 - 1.0;
	vec2 azimuth = vec2(1, 0);
	float total = 1e-08;
	vec3 light = vec3(0);
	vec3 share = vec3(0);
	for (int i = 0; i < u_envRadianceSamples; i++)
	{
		float z = 1.0 - descent * (float(i) + 0.5);
		vec3 h = s + vec3(azimuth * sqrt(1.0 - z * z), z);
		vec3 slope = alpha * h;
		vec3 H = normalize(slope);
		vec3 L = reflect(away, refracts ? refract(-v2, H, x4) : H);
		float NL = max(L.z, 0.0);
		float x6 = NL / (toView * NL + NV * sqrt(mix(NL * NL, 1.0, x3)));
		float weight = refracts ? 1.0 : x6;
		float x7 = dot(v2, H);
		float t = max(1.0 - x7, 0.0);
		float t2 = t * t;
		float t4 = t2 * t2;
		float u = sqrt(max(x5 + x7 * x7, 0.0));
		float p2 = u / n2;
		float rs = (x7 - u) / (x7 + u);
		float rp = (x7 - p2) / (x7 + p2);
		float x8 = 0.5 * (rs * rs + rp * rp);
		vec3 F = weight * clamp(base + rise * (clear ? x8 : t * t4) + dip * t4 * (x7 * t2), 0.0, 1.0);
		vec3 d = frame * L;
		float x9 = dot(slope, slope) / dot(h, h);
		float r2 = x9 * x9;
		float best = max(level - 0.25 * log2(r2 * r2 * (1.00001 - d.y * d.y)), 0.0);
		float whole = floor(best);
		vec3 v3 = F * environment_lookup(u_envRadiance, d, whole + clamp(32.0 * (best - whole) - 15.5, 0.0, 1.0));
		azimuth = -0.7373689 * azimuth + vec2(-0.6754903, 0.6754903) * azimuth.yx;
		total += weight;
		light += v3;
		share += F;
	}
	float E = min(reach * total / count, 1.0);
	vec3 once = share / total;
	float lost = 0.218505 - 0.207071 * NV + mean * (1.3982 * NV + 2.44659 * mean);
	float x10 = clamp(1.0 - NV * mean / (x2 + x3 * (3.68834 * NV + 0.792037)) * lost, 0.01, 1.0);
	float white = refracts || isotropic ? E : x10;
	vec3 kept = mix(once, vec3(1), white) * min(E / white, 1.0);
	albedo = once * kept;
	return light * (kept / total);
}

// Directional albedo of matter of the given colour.
vec3 oren_nayar_albedo(vec3 tint, float roughness, float NV)
{
	float x = 0.2877934 * roughness + 1.0;
	float share = 1.0 / x;
	float t = 1.0 - NV;
	float white = min(share + roughness * share * (t * (t * (t * (0.094506 * t - 0.380115) + 0.522378) + 0.0514252)), 1.0);
	float kept = (0.0724882 * roughness + 1.0) / x;
	return tint * white + kept * (tint * tint) / (1.0 - tint * (1.0 - kept)) * (1.0 - white);
}

void main()
{
	vec3 normal = normalize(vd.normalWorld);
	vec3 X = normalize(vd.tangentWorld);
	vec3 metal_color = open_pbr_surface_surfaceshader_base_weight * open_pbr_surface_surfaceshader_base_color;
	float coat = open_pbr_surface_surfaceshader_coat_roughness * open_pbr_surface_surfaceshader_coat_roughness;
	float base = open_pbr_surface_surfaceshader_specular_roughness * open_pbr_surface_surfaceshader_specular_roughness;
	float x = sqrt(sqrt(min(base * base + coat * (2.0 * coat), 1.0)));
	float specular_roughness_coated = mix(open_pbr_surface_surfaceshader_specular_roughness, x, open_pbr_surface_surfaceshader_coat_weight);
	float film_nanometers = 1000.0 * open_pbr_surface_surfaceshader_thin_film_thickness;
	float ratio = open_pbr_surface_surfaceshader_specular_ior / open_pbr_surface_surfaceshader_coat_ior;
	float index = mix(open_pbr_surface_surfaceshader_specular_ior, max(ratio, 1.0 / ratio), open_pbr_surface_surfaceshader_coat_weight);
	float amplitude = (index - 1.0) / (index + 1.0);
	float weighted = sign(amplitude) * sqrt(clamp(amplitude * (open_pbr_surface_surfaceshader_specular_weight * amplitude), 0.0, 0.99999));
	float specular_index = (weighted + 1.0) / (1.0 - weighted);
	vec3 transmission_tint = 0.0 < open_pbr_surface_surfaceshader_transmission_depth ? vec3(1) : open_pbr_surface_surfaceshader_transmission_color;
	vec3 subsurface_color_positive = max(open_pbr_surface_surfaceshader_subsurface_color, 0.0);
	float thin_walled_weight = open_pbr_surface_surfaceshader_geometry_thin_walled ? 1.0 : 0.0;
	vec3 metal_albedo = open_pbr_surface_surfaceshader_base_color * open_pbr_surface_surfaceshader_specular_weight;
	vec3 dielectric_albedo = mix(open_pbr_surface_surfaceshader_base_color, open_pbr_surface_surfaceshader_subsurface_color, open_pbr_surface_surfaceshader_subsurface_weight);
	float amplitude2 = (open_pbr_surface_surfaceshader_coat_ior - 1.0) / (open_pbr_surface_surfaceshader_coat_ior + 1.0);
	float coat_transmittance = 1.0 - amplitude2 * amplitude2;
	float K = 1.0 - coat_transmittance / (open_pbr_surface_surfaceshader_coat_ior * open_pbr_surface_surfaceshader_coat_ior);
	vec3 v = (1.0 - K) / (1.0 - mix(dielectric_albedo, metal_albedo, open_pbr_surface_surfaceshader_base_metalness) * K);
	float x2 = open_pbr_surface_surfaceshader_coat_weight * open_pbr_surface_surfaceshader_coat_darkening;
	vec3 coat_tint = mix(vec3(1), open_pbr_surface_surfaceshader_coat_color, open_pbr_surface_surfaceshader_coat_weight);
	vec3 emitted_color = open_pbr_surface_surfaceshader_emission_luminance * open_pbr_surface_surfaceshader_emission_color;
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	float x3 = 1.0 - open_pbr_surface_surfaceshader_base_metalness;
	float x4 = 1.0 - open_pbr_surface_surfaceshader_thin_film_weight;
	float x5 = open_pbr_surface_surfaceshader_base_metalness * open_pbr_surface_surfaceshader_thin_film_weight;
	vec3 N = faceforward(normal, -V, normal);
	float NV = clamp(dot(V, N), 0.0001, 1.0);
	float share = fibre_albedo(open_pbr_surface_surfaceshader_fuzz_roughness, NV);
	vec3 v2 = environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
	float passed = 1.0 - open_pbr_surface_surfaceshader_fuzz_weight * share;
	bool test = 0.0 < film_nanometers;
	vec3 root = sqrt(clamp(metal_color, 0.0, 0.99));
	vec3 v3 = (root + 1.0) / (1.0 - root);
	vec3 v4 = vec3(specular_index);
	bool has_specular_film = open_pbr_surface_surfaceshader_thin_film_weight * x3 != 0.0;
	vec3 rise = 1.0 - metal_color;
	vec3 dip = (metal_color + 0.46266437 * rise) * (17.651384 * (open_pbr_surface_surfaceshader_specular_color - 1.0));
	vec3 dip2 = test ? vec3(0) : dip;
	vec3 rise2 = test ? vec3(0) : rise;
	bool has_metal_plain = open_pbr_surface_surfaceshader_specular_weight * (open_pbr_surface_surfaceshader_base_metalness * x4) != 0.0;
	bool has_specular_plain = x3 * x4 != 0.0;
	bool has_transmitted = open_pbr_surface_surfaceshader_transmission_weight * x3 != 0.0;
	vec3 rise3 = test ? vec3(0) : vec3(1);
	bool has_coat = open_pbr_surface_surfaceshader_coat_weight != 0.0;
	int k = int(has_coat) + int(has_specular_film) + int(has_transmitted) + int(has_specular_plain) + int(has_metal_plain);
	int calls = k + int(open_pbr_surface_surfaceshader_specular_weight * x5 != 0.0);
	int last = -1;
	vec3 coat2 = vec3(0);
	vec3 coat_albedo = vec3(0);
	vec3 radiance = vec3(0);
	vec3 specular_film_albedo = vec3(0);
	vec3 radiance2 = vec3(0);
	vec3 radiance3 = vec3(0);
	vec3 specular_plain_albedo = vec3(0);
	vec3 metal_plain = vec3(0);
	vec3 metal_film = vec3(0);
	for (int i = 0; i < calls; i++)
	{
		int k2 = has_specular_plain && last < 3 ? 3 : has_metal_plain && last < 4 ? 4 : 5;
		int k3 = has_specular_film && last < 1 ? 1 : has_transmitted && last < 2 ? 2 : k2;
		int which = has_coat && last < 0 ? 0 : k3;
		bool is_metal_film = which == 5;
		vec3 n = is_metal_film ? v3 : v4;
		vec3 film = fresnel_thin_film(NV, n, film_nanometers, open_pbr_surface_surfaceshader_thin_film_ior);
		vec3 base2 = test ? film : vec3(0);
		bool is_coat = which == 0;
		float x6 = is_coat ? open_pbr_surface_surfaceshader_coat_roughness : specular_roughness_coated;
		float x7 = is_coat ? open_pbr_surface_surfaceshader_coat_roughness_anisotropy : open_pbr_surface_surfaceshader_specular_roughness_anisotropy;
		float alpha = x6 * x6;
		float aspect = 1.0 - x7;
		float along = alpha * sqrt(2.0 / (aspect * aspect + 1.0));
		vec2 p = vec2(along, aspect * along);
		vec2 roughness = 0.0 < x7 ? p : vec2(alpha);
		bool is_transmitted = which == 2;
		bool clear = is_transmitted ? false : which < 4;
		float ior = is_coat ? open_pbr_surface_surfaceshader_coat_ior : 4 <= which ? 1.0 : specular_index;
		bool is_metal_plain = which == 4;
		vec3 v5 = is_metal_plain ? metal_color : is_metal_film ? (test ? film : metal_color) : vec3(0);
		bool is_specular_film = which == 1;
		vec3 base3 = is_specular_film ? base2 : is_transmitted ? vec3(1) : v5;
		vec3 v6 = is_metal_plain ? rise : is_metal_film ? rise2 : vec3(1);
		vec3 rise4 = is_specular_film ? rise3 : is_transmitted ? vec3(0) : v6;
		vec3 dip3 = is_metal_plain ? dip : is_metal_film ? dip2 : vec3(0);
		vec3 albedo;
		vec3 radiance4 = microfacet_light(roughness, is_transmitted, clear, ior, base3, rise4, dip3, N, V, X, albedo);
		bool is_specular_plain = which == 3;
		last = which;
		if (is_coat) coat2 = radiance4;
		if (is_coat) coat_albedo = albedo;
		if (is_specular_film) radiance = radiance4;
		if (is_specular_film) specular_film_albedo = albedo;
		if (is_transmitted) radiance2 = radiance4;
		if (is_specular_plain) radiance3 = radiance4;
		if (is_specular_plain) specular_plain_albedo = albedo;
		if (is_metal_plain) metal_plain = radiance4;
		if (is_metal_film) metal_film = radiance4;
	}
	vec3 passed2 = passed * (1.0 - open_pbr_surface_surfaceshader_coat_weight * coat_albedo);
	vec3 v7 = mix(vec3(1), v, x2) * coat_tint * passed2;
	vec3 v8 = x3 * v7;
	vec3 v9 = open_pbr_surface_surfaceshader_base_metalness * v7;
	vec3 passed3 = v8 * mix(1.0 - specular_plain_albedo, 1.0 - specular_film_albedo, open_pbr_surface_surfaceshader_thin_film_weight);
	vec3 v10 = (1.0 - open_pbr_surface_surfaceshader_transmission_weight) * passed3;
	vec3 v11 = open_pbr_surface_surfaceshader_subsurface_weight * v10;
	vec3 v12 = 0.5 * (thin_walled_weight * v11);
	vec3 v13 = open_pbr_surface_surfaceshader_base_weight * ((1.0 - open_pbr_surface_surfaceshader_subsurface_weight) * v10);
	vec3 diffuse = v2 * oren_nayar_albedo(max(open_pbr_surface_surfaceshader_base_color, 0.0), open_pbr_surface_surfaceshader_base_diffuse_roughness, NV);
	vec3 wall_translucent = subsurface_color_positive * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * -normal, 0.0);
	float s2 = open_pbr_surface_surfaceshader_base_diffuse_roughness * open_pbr_surface_surfaceshader_base_diffuse_roughness;
	float t = 1.0 - NV;
	float x8 = 0.45 * s2 / (s2 + 0.09) * (sqrt(max(1.0 - NV * NV, 0.0)) * (t * (0.0396229 * t + 0.252719) + 0.208327));
	vec3 wall_reflecting = v2 * (subsurface_color_positive * min(1.0 - 0.5 * s2 / (s2 + 0.33) + x8, 1.0));
	vec3 transmitted = radiance2 * (u_refractionTwoSided ? transmission_tint * transmission_tint : transmission_tint);
	vec3 v14 = open_pbr_surface_surfaceshader_specular_weight * (open_pbr_surface_surfaceshader_thin_film_weight * v9);
	vec3 v15 = open_pbr_surface_surfaceshader_subsurface_color * (open_pbr_surface_surfaceshader_subsurface_scatter_anisotropy + 1.0) * v12 * wall_translucent;
	vec3 v16 = v13 * diffuse + (1.0 - thin_walled_weight) * v11 * (subsurface_color_positive * v2) + v15;
	vec3 v17 = open_pbr_surface_surfaceshader_subsurface_color * (1.0 - open_pbr_surface_surfaceshader_subsurface_scatter_anisotropy) * v12 * wall_reflecting;
	vec3 v18 = v16 + v17 + open_pbr_surface_surfaceshader_transmission_weight * passed3 * transmitted;
	vec3 v19 = open_pbr_surface_surfaceshader_specular_color * radiance * (open_pbr_surface_surfaceshader_thin_film_weight * v8);
	vec3 v20 = metal_plain * (open_pbr_surface_surfaceshader_specular_weight * (x4 * v9));
	vec3 v21 = v18 + open_pbr_surface_surfaceshader_specular_color * radiance3 * (x4 * v8) + v19 + v20 + metal_film * v14;
	vec3 v22 = v21 + coat2 * (open_pbr_surface_surfaceshader_coat_weight * passed);
	vec3 v23 = (v22 + open_pbr_surface_surfaceshader_fuzz_weight * (open_pbr_surface_surfaceshader_fuzz_color * share * v2)) * u_envLightIntensity;
	float x9 = open_pbr_surface_surfaceshader_coat_weight * (coat_transmittance * (1.0 - pow(1.0 - abs(dot(normal, V)), 5.0)));
	vec3 v24 = v23 + emitted_color * (1.0 - open_pbr_surface_surfaceshader_coat_weight + open_pbr_surface_surfaceshader_coat_color * x9);
	out1 = vec4(open_pbr_surface_surfaceshader_geometry_opacity * v24, 1.0);
}
