#version 400

// plain

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform bool u_refractionTwoSided = false;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform float plain_shader_base = 1.0;
uniform vec3 plain_shader_base_color = vec3(0.8);
uniform float plain_shader_diffuse_roughness = 0.0;
uniform float plain_shader_metalness = 0.0;
uniform float plain_shader_specular = 1.0;
uniform vec3 plain_shader_specular_color = vec3(1);
uniform float plain_shader_specular_roughness = 0.2;
uniform float plain_shader_specular_IOR = 1.5;
uniform float plain_shader_specular_anisotropy = 0.0;
uniform float plain_shader_specular_rotation = 0.0;
uniform float plain_shader_transmission = 0.0;
uniform vec3 plain_shader_transmission_color = vec3(1);
uniform float plain_shader_transmission_extra_roughness = 0.0;
uniform float plain_shader_subsurface = 0.0;
uniform vec3 plain_shader_subsurface_color = vec3(1);
uniform float plain_shader_sheen = 0.0;
uniform vec3 plain_shader_sheen_color = vec3(1);
uniform float plain_shader_sheen_roughness = 0.3;
uniform float plain_shader_coat = 0.0;
uniform vec3 plain_shader_coat_color = vec3(1);
uniform float plain_shader_coat_roughness = 0.1;
uniform float plain_shader_coat_anisotropy = 0.0;
uniform float plain_shader_coat_rotation = 0.0;
uniform float plain_shader_coat_IOR = 1.5;
uniform float plain_shader_coat_affect_color = 0.0;
uniform float plain_shader_coat_affect_roughness = 0.0;
uniform float plain_shader_thin_film_thickness = 0.0;
uniform float plain_shader_thin_film_IOR = 1.5;
uniform float plain_shader_emission = 0.0;
uniform vec3 plain_shader_emission_color = vec3(1);
uniform vec3 plain_shader_opacity = vec3(1);
uniform bool plain_shader_thin_walled = false;

in VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
	vec3 tangentWorld;
} vd;

out vec4 out1;

// Reflectance at an interface of admittance u + iw.
vec3 fresnel_reflectance(float c, vec3 u, vec3 w)
{
	vec3 v = c - u;
	vec3 v2 = w * w;
	vec3 v3 = c + u;
	return (v * v + v2) / max(v2 + v3 * v3, 1e-12);
}

// Reflectance of a conductor of index n + ik for unpolarised light.
vec3 fresnel_conductor(float c, vec3 n, vec3 k)
{
	float c2 = c * c;
	float s2 = 1.0 - c2;
	vec3 t = n * n - k * k - s2;
	vec3 m = sqrt(t * t + k * (k * (n * (4.0 * n))));
	vec3 a = 2.0 * c * sqrt(max(0.5 * (t + m), 0.0));
	vec3 b = c2 + m;
	vec3 d = c2 * m + s2 * s2;
	vec3 v = s2 * a;
	return 0.5 * ((b - a) / (a + b)) * ((d - v) / (d + v) + 1.0);
}

// Reflectance of a thin film over an interface to n + ik (Belcour and Barla 2017, eq. 8).
vec3 fresnel_thin_film(float c, vec3 n, vec3 k, float thickness, float film_ior)
{
	float film = max(film_ior, 1.0);
	float inside = sqrt(1.0 - (1.0 - c * c) / (film * film));
	float phase = inside * (thickness * (1.256637e-08 * film));
	vec3 v = n / film;
	vec3 v2 = k / film;
	vec3 re = v * v - v2 * v2;
	float x = inside * inside;
	vec3 t = re - (1.0 - x);
	vec3 m = sqrt(t * t + v2 * (v2 * (v * (4.0 * v))));
	vec3 u = sqrt(max(0.5 * (t + m), 0.0));
	vec3 w = sqrt(max(0.5 * (m - t), 0.0));
	vec3 im = v2 * (2.0 * v);
	vec3 scale = 1.0 / max(re * re + im * im, 1e-12);
	vec3 up = scale * (re * u + w * im);
	vec3 wp = scale * (re * w - u * im);
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
		vec3 R23 = fresnel_reflectance(inside, u2, w2);
		vec3 shift = atan(w2 * x4, x - u2 * u2 - w2 * w2) + (0.0 < r ? 3.1415927 : 0.0);
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
			vec3 v3 = shift * x5;
			vec3 v4 = vec3(9.04581e-08, 1.068737e-07, 1.069699e-07) * cos(v3 + vec3(1681000.0, 1795300.0, 2208400.0) * x6);
			vec3 v5 = vec3(1.644e-08 * cos(2239900.0 * x6 + v3.x) * exp(x6 * (-4528200000.0 * x6)), 0.0, 0.0);
			vec3 v6 = 2.0 * wave2 * (9358910.0 * (v4 * exp(x6 * (vec3(-4327800000.0, -9304600000.0, -6612100000.0) * x6)) + v5));
			sum2 += v6;
			wave = wave2;
		}
		u2 = up;
		w2 = wp;
		sum = sum2;
	}
	return clamp(0.5 * (mat3(2.3706744, -0.513885, 0.0052982, -0.9000405, 1.4253036, -0.0146949, -0.4706338, 0.0885814, 1.0093968) * sum), 0.0, 1.0);
}

// Reads a latitude-longitude map: v = 0 is the zenith, u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d, float level)
{
	return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0))), level).xyz;
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light(vec2 roughness, bool refracts, bool clear, float ior, vec3 base, vec3 rise, vec3 bend, vec3 dip, vec3 N, vec3 V, vec3 X, out vec3 albedo)
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
		vec3 F = weight * clamp(base + rise * (clear ? x8 : t * t4) + (bend + dip * t4) * (x7 * t2), 0.0, 1.0);
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

void main()
{
	vec3 normal = normalize(vd.normalWorld);
	vec3 v = normalize(vd.tangentWorld);
	vec3 r = clamp(plain_shader_base * plain_shader_base_color, 0.0, 0.99);
	vec3 root = sqrt(r);
	vec3 v2 = 1.0 - r;
	vec3 metal_index_ior = mix((root + 1.0) / (1.0 - root), v2 / (r + 1.0), plain_shader_specular * plain_shader_specular_color);
	vec3 above = metal_index_ior + 1.0;
	vec3 below = metal_index_ior - 1.0;
	vec3 metal_index_extinction = sqrt(max((r * (above * above) - below * below) / v2, 0.0));
	float coat_blur = plain_shader_coat_roughness * (plain_shader_coat * plain_shader_coat_affect_roughness);
	float specular_blurred = mix(plain_shader_specular_roughness, 1.0, coat_blur);
	float transmission_blurred = mix(clamp(plain_shader_specular_roughness + plain_shader_transmission_extra_roughness, 0.0, 1.0), 1.0, coat_blur);
	float coat_gamma = plain_shader_coat_affect_color * clamp(plain_shader_coat, 0.0, 1.0) + 1.0;
	vec3 subsurface_deepened = pow(max(plain_shader_subsurface_color, 0.0), vec3(coat_gamma));
	float thin_walled_weight = plain_shader_thin_walled ? 1.0 : 0.0;
	float amplitude = (plain_shader_coat_IOR - 1.0) / (plain_shader_coat_IOR + 1.0);
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	float x = 1.0 - plain_shader_metalness;
	vec3 N = faceforward(normal, -V, normal);
	float NV = clamp(dot(V, N), 0.0001, 1.0);
	vec3 base = fresnel_reflectance(1.0, metal_index_ior, metal_index_extinction);
	bool test = 0.0 < plain_shader_thin_film_thickness;
	bool has_specular = plain_shader_specular * x != 0.0;
	vec3 rise = 1.0 - base;
	vec3 more60 = fresnel_conductor(0.5, metal_index_ior, metal_index_extinction) - base - 0.03125 * rise;
	vec3 more82 = fresnel_conductor(0.14285715, metal_index_ior, metal_index_extinction) - base - 0.46266437 * rise;
	vec3 bend = 9.047614 * more60 - 1.247679 * more82;
	vec3 dip = 19.962864 * more82 - 16.761822 * more60;
	vec3 dip2 = test ? vec3(0) : dip;
	vec3 bend2 = test ? vec3(0) : bend;
	vec3 rise2 = test ? vec3(0) : rise;
	bool has_transmitted = plain_shader_transmission * x != 0.0;
	vec3 rise3 = test ? vec3(0) : vec3(1);
	bool has_coat = plain_shader_coat != 0.0;
	int calls = int(has_coat) + int(has_specular) + int(has_transmitted) + int(plain_shader_metalness != 0.0);
	vec3 v3 = cross(v, normal);
	float x2 = dot(normal, v);
	int last = -1;
	vec3 coat = vec3(0);
	vec3 coat_albedo = vec3(0);
	vec3 radiance = vec3(0);
	vec3 specular_albedo = vec3(0);
	vec3 radiance2 = vec3(0);
	vec3 metal = vec3(0);
	for (int i = 0; i < calls; i++)
	{
		int k = has_specular && last < 1 ? 1 : has_transmitted && last < 2 ? 2 : 3;
		int which = has_coat && last < 0 ? 0 : k;
		bool is_metal = which == 3;
		vec3 n = is_metal ? metal_index_ior : vec3(plain_shader_specular_IOR);
		vec3 k2 = is_metal ? metal_index_extinction : vec3(0);
		vec3 film = fresnel_thin_film(NV, n, k2, plain_shader_thin_film_thickness, plain_shader_thin_film_IOR);
		bool is_transmitted = which == 2;
		bool is_coat = which == 0;
		float x3 = is_coat ? plain_shader_coat_roughness : is_transmitted ? transmission_blurred : specular_blurred;
		float x4 = is_coat ? plain_shader_coat_anisotropy : plain_shader_specular_anisotropy;
		float alpha = x3 * x3;
		float aspect = sqrt(1.0 - clamp(x4, 0.0, 0.98));
		bool test2 = 0.0 < x4;
		vec2 p = vec2(min(alpha / aspect, 1.0), alpha * aspect);
		vec2 roughness = test2 ? p : vec2(alpha);
		float ior = is_coat ? plain_shader_coat_IOR : is_metal ? 1.0 : plain_shader_specular_IOR;
		vec3 v4 = is_transmitted ? vec3(1) : is_metal ? (test ? film : base) : vec3(0);
		bool is_specular = which == 1;
		vec3 base2 = is_specular ? (test ? film : vec3(0)) : v4;
		vec3 rise4 = is_specular ? rise3 : is_transmitted ? vec3(0) : is_metal ? rise2 : vec3(1);
		vec3 bend3 = is_metal ? bend2 : vec3(0);
		vec3 dip3 = is_metal ? dip2 : vec3(0);
		float angle = radians(360.0 * (is_coat ? plain_shader_coat_rotation : plain_shader_specular_rotation));
		float cosine = cos(angle);
		vec3 v5 = v * cosine + v3 * sin(angle) + normal * (x2 * (1.0 - cosine));
		vec3 X = test2 ? v5 : v;
		vec3 albedo;
		vec3 radiance3 = microfacet_light(roughness, is_transmitted, which < 2, ior, base2, rise4, bend3, dip3, N, V, X, albedo);
		last = which;
		if (is_coat) coat = radiance3;
		if (is_coat) coat_albedo = albedo;
		if (is_specular) radiance = radiance3;
		if (is_specular) specular_albedo = albedo;
		if (is_transmitted) radiance2 = radiance3;
		if (is_metal) metal = radiance3;
	}
	vec3 v6 = mix(vec3(1), plain_shader_coat_color, plain_shader_coat) * (1.0 - plain_shader_coat * coat_albedo);
	vec3 v7 = x * v6;
	vec3 passed = v7 * (1.0 - plain_shader_specular * specular_albedo);
	vec3 v8 = (1.0 - plain_shader_transmission) * passed;
	float r2 = clamp(plain_shader_sheen_roughness, 0.01, 1.0);
	float x5 = NV * (1.91259 * NV - 6.35138) + 3.35395 + r2 * (13.7158 - 4.94826 * NV - 0.698754 * r2);
	float share = clamp(x5 / (13.4539 * NV + 1.0 + r2 * (11.4431 * NV + 26.6426)), 0.0, 1.0);
	vec3 v9 = environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
	vec3 passed2 = v8 * (1.0 - plain_shader_sheen * share);
	vec3 v10 = plain_shader_subsurface * passed2;
	float s2 = plain_shader_diffuse_roughness * plain_shader_diffuse_roughness;
	float t = 1.0 - NV;
	float x6 = 0.45 * s2 / (s2 + 0.09) * (sqrt(max(1.0 - NV * NV, 0.0)) * (t * (0.0396229 * t + 0.252719) + 0.208327));
	vec3 diffuse = v9 * (pow(max(plain_shader_base_color, 0.0), vec3(coat_gamma)) * min(1.0 - 0.5 * s2 / (s2 + 0.33) + x6, 1.0));
	vec3 translucent = subsurface_deepened * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * -normal, 0.0);
	vec3 v11 = plain_shader_base * ((1.0 - plain_shader_subsurface) * passed2) * diffuse;
	vec3 v12 = v11 + (1.0 - thin_walled_weight) * v10 * (subsurface_deepened * v9);
	vec3 v13 = plain_shader_sheen_color * share * v9 * (plain_shader_sheen * v8);
	vec3 v14 = plain_shader_transmission * passed * (radiance2 * (u_refractionTwoSided ? plain_shader_transmission_color * plain_shader_transmission_color : plain_shader_transmission_color));
	vec3 v15 = v12 + thin_walled_weight * v10 * translucent + v13 + v14;
	vec3 v16 = v15 + plain_shader_specular_color * radiance * (plain_shader_specular * v7) + metal * (plain_shader_metalness * v6);
	vec3 v17 = plain_shader_coat_color * (plain_shader_coat * ((1.0 - amplitude * amplitude) * (1.0 - pow(1.0 - abs(dot(normal, V)), 5.0))));
	vec3 v18 = plain_shader_emission * plain_shader_emission_color * (1.0 - plain_shader_coat + v17);
	vec3 v19 = (v16 + plain_shader_coat * coat) * u_envLightIntensity + v18;
	out1 = vec4(dot(plain_shader_opacity, vec3(0.2722287, 0.6740818, 0.0536895)) * v19, 1.0);
}
