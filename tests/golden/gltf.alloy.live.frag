#version 400

// alloy

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform vec3 wheel_base_color = vec3(0.7, 0.7, 0.75);
uniform float wheel_metallic = 0.6;
uniform float wheel_roughness = 0.4;
uniform float wheel_alpha = 0.7;
uniform float wheel_iridescence_thickness = 350.0;
uniform vec3 wheel_sheen_color = vec3(0.1, 0.2, 0.3);
uniform float wheel_sheen_roughness = 0.6;
uniform float wheel_clearcoat = 0.5;
uniform float wheel_anisotropy_strength = 0.5;
uniform float wheel_anisotropy_rotation = 0.8;

in VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
	vec3 tangentWorld;
} vd;

out vec4 out1;

// Reads a latitude-longitude map: v = 0 is the zenith, u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d, float level)
{
	return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0))), level).xyz;
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light(vec3 N, vec3 V, out vec3 albedo)
{
	float x = dot(N, V);
	vec3 tangent = V - N * x;
	vec3 v = cross(N, abs(N.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0));
	vec3 x2 = normalize(dot(tangent, tangent) < 1e-08 ? v : tangent);
	float NV = clamp(x, 0.0001, 1.0);
	vec3 v2 = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
	vec3 wide = vec3(0.0001, 0.0001, 1.0) * v2;
	float stretched = length(wide);
	vec3 s = wide / stretched;
	float count = float(u_envRadianceSamples);
	float descent = (s.z + 1.0) / count;
	float reach = NV + stretched;
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(count / (6.283185e-08 * reach));
	mat3 frame = mat3(u_envMatrix) * mat3(x2, cross(N, x2), N);
	vec2 azimuth = vec2(1, 0);
	float total = 1e-08;
	vec3 light = vec3(0);
	vec3 share = vec3(0);
	for (int i = 0; i < u_envRadianceSamples; i++)
	{
		float z = 1.0 - descent * (float(i) + 0.5);
		vec3 h = s + vec3(azimuth * sqrt(1.0 - z * z), z);
		vec3 slope = vec3(0.0001, 0.0001, 1.0) * h;
		vec3 H = normalize(slope);
		vec3 L = reflect(-v2, H);
		float NL = max(L.z, 0.0);
		float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, 9.999999e-09)));
		float x3 = dot(v2, H);
		float u = sqrt(max(x3 * x3 + 1.25, 0.0));
		float p = u / 2.25;
		float rs = (x3 - u) / (x3 + u);
		float rp = (x3 - p) / (x3 + p);
		float F = weight * (0.5 * (rs * rs + rp * rp));
		vec3 d = frame * L;
		float x4 = dot(slope, slope) / dot(h, h);
		float r2 = x4 * x4;
		float best = max(level - 0.25 * log2(r2 * r2 * (1.00001 - d.y * d.y)), 0.0);
		float whole = floor(best);
		vec3 v3 = F * environment_lookup(u_envRadiance, d, whole + clamp(32.0 * (best - whole) - 15.5, 0.0, 1.0));
		azimuth = -0.7373689 * azimuth + vec2(-0.6754903, 0.6754903) * azimuth.yx;
		total += weight;
		light += v3;
		share += F;
	}
	vec3 once = share / total;
	vec3 kept = mix(once, vec3(1), min(reach * total / count, 1.0));
	albedo = once * kept;
	return light * (kept / total);
}

vec3 sheen_bsdf_environment(vec3 color, float roughness, vec3 N, vec3 V, out vec3 albedo)
{
	float NV = clamp(dot(N, V), 0.0001, 1.0);
	float r = clamp(roughness, 0.01, 1.0);
	float x = NV * (1.91259 * NV - 6.35138) + 3.35395 + r * (13.7158 - 4.94826 * NV - 0.698754 * r);
	float share = clamp(x / (13.4539 * NV + 1.0 + r * (11.4431 * NV + 26.6426)), 0.0, 1.0);
	albedo = vec3(share);
	return color * share * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
}

// Reflectance at an interface of admittance u + iw.
vec3 fresnel_reflectance(float c, vec3 u, vec3 w)
{
	vec3 v = c - u;
	vec3 v2 = w * w;
	vec3 v3 = c + u;
	return (v * v + v2) / max(v2 + v3 * v3, 1e-12);
}

// Reflectance of a thin film over an interface to n + ik (Belcour and Barla 2017, eq. 8).
vec3 fresnel_thin_film(float c, float thickness)
{
	float inside = sqrt(1.0 - (1.0 - c * c) / 1.6899998);
	float phase = inside * (1.633628e-08 * thickness);
	float x = inside * inside;
	float t = 1.3313609 - (1.0 - x);
	vec3 m = sqrt(vec3(t * t));
	vec3 u = sqrt(max(0.5 * (t + m), 0.0));
	vec3 w = sqrt(max(0.5 * (m - t), 0.0));
	vec3 up = 0.75111115 * u;
	vec3 wp = 0.75111115 * w;
	int polarisations = 0.0 < thickness ? 2 : 0;
	float x2 = 1.3 * inside;
	float x3 = inside / 1.3;
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
			vec3 v = shift * x5;
			vec3 v2 = vec3(9.04581e-08, 1.068737e-07, 1.069699e-07) * cos(v + vec3(1681000.0, 1795300.0, 2208400.0) * x6);
			vec3 v3 = vec3(1.644e-08 * cos(2239900.0 * x6 + v.x) * exp(x6 * (-4528200000.0 * x6)), 0.0, 0.0);
			vec3 v4 = 2.0 * wave2 * (9358910.0 * (v2 * exp(x6 * (vec3(-4327800000.0, -9304600000.0, -6612100000.0) * x6)) + v3));
			sum2 += v4;
			wave = wave2;
		}
		u2 = up;
		w2 = wp;
		sum = sum2;
	}
	return clamp(0.5 * (mat3(2.3706744, -0.513885, 0.0052982, -0.9000405, 1.4253036, -0.0146949, -0.4706338, 0.0885814, 1.0093968) * sum), 0.0, 1.0);
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light2(vec2 roughness, vec3 base, vec3 rise, vec3 N, vec3 V, vec3 X, out vec3 albedo)
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
		vec3 L = reflect(-v2, H);
		float NL = max(L.z, 0.0);
		float weight = NL / (toView * NL + NV * sqrt(mix(NL * NL, 1.0, x3)));
		float t = max(1.0 - dot(v2, H), 0.0);
		float t2 = t * t;
		vec3 F = weight * clamp(base + rise * (t * (t2 * t2)), 0.0, 1.0);
		vec3 d = frame * L;
		float x4 = dot(slope, slope) / dot(h, h);
		float r2 = x4 * x4;
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
	float x5 = clamp(1.0 - NV * mean / (x2 + x3 * (3.68834 * NV + 0.792037)) * lost, 0.01, 1.0);
	float white = isotropic ? E : x5;
	vec3 kept = mix(once, vec3(1), white) * min(E / white, 1.0);
	albedo = once * kept;
	return light * (kept / total);
}

// Reflectance of a thin film over an interface to n + ik (Belcour and Barla 2017, eq. 8).
vec3 fresnel_thin_film2(float c, vec3 n, float thickness)
{
	float inside = sqrt(1.0 - (1.0 - c * c) / 1.6899998);
	float phase = inside * (1.633628e-08 * thickness);
	vec3 v = n / 1.3;
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
	float x2 = 1.3 * inside;
	float x3 = inside / 1.3;
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
			vec3 v2 = shift * x5;
			vec3 v3 = vec3(9.04581e-08, 1.068737e-07, 1.069699e-07) * cos(v2 + vec3(1681000.0, 1795300.0, 2208400.0) * x6);
			vec3 v4 = vec3(1.644e-08 * cos(2239900.0 * x6 + v2.x) * exp(x6 * (-4528200000.0 * x6)), 0.0, 0.0);
			vec3 v5 = 2.0 * wave2 * (9358910.0 * (v3 * exp(x6 * (vec3(-4327800000.0, -9304600000.0, -6612100000.0) * x6)) + v4));
			sum2 += v5;
			wave = wave2;
		}
		u2 = up;
		w2 = wp;
		sum = sum2;
	}
	return clamp(0.5 * (mat3(2.3706744, -0.513885, 0.0052982, -0.9000405, 1.4253036, -0.0146949, -0.4706338, 0.0885814, 1.0093968) * sum), 0.0, 1.0);
}

void main()
{
	vec3 normal = normalize(vd.normalWorld);
	vec3 v = normalize(vd.tangentWorld);
	float sheen_weight = max(max(wheel_sheen_color.x, wheel_sheen_color.y), wheel_sheen_color.z);
	vec3 sheen_tint = wheel_sheen_color / (abs(sheen_weight) < 1e-20 ? 1e-20 : sheen_weight);
	float alpha = wheel_roughness * wheel_roughness;
	vec2 alpha_both = vec2(clamp(mix(alpha, 1.0, wheel_anisotropy_strength * wheel_anisotropy_strength), 1e-05, 1.0), clamp(alpha, 1e-05, 1.0));
	float angle = radians(-57.29578 * wheel_anisotropy_rotation);
	float cosine = cos(angle);
	vec3 tangent_turned = v * cosine + cross(v, normal) * sin(angle) + normal * (dot(normal, v) * (1.0 - cosine));
	vec3 tangent_used = 0.0 < abs(wheel_anisotropy_rotation) ? tangent_turned : v;
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 N = faceforward(normal, -V, normal);
	vec3 coat_albedo;
	vec3 coat = microfacet_light(N, V, coat_albedo);
	vec3 passed = 1.0 - wheel_clearcoat * coat_albedo;
	vec3 sheen_albedo;
	vec3 sheen = sheen_bsdf_environment(sheen_tint, wheel_sheen_roughness * wheel_sheen_roughness, N, V, sheen_albedo);
	vec3 passed2 = passed * (1.0 - sheen_weight * sheen_albedo);
	vec3 v2 = passed2 * (1.0 - wheel_metallic);
	bool test = 0.0 < wheel_iridescence_thickness;
	float NV = clamp(dot(V, N), 0.0001, 1.0);
	vec3 base = test ? fresnel_thin_film(NV, wheel_iridescence_thickness) : vec3(0.040000003);
	vec3 rise = test ? vec3(0) : vec3(0.96);
	vec3 specular_film_albedo;
	vec3 specular_film = microfacet_light2(alpha_both, base, rise, N, V, tangent_used, specular_film_albedo);
	vec3 root = sqrt(clamp(wheel_base_color, 0.0, 0.99));
	vec3 film = fresnel_thin_film2(NV, (root + 1.0) / (1.0 - root), wheel_iridescence_thickness);
	vec3 rise2 = test ? vec3(0) : 1.0 - wheel_base_color;
	vec3 albedo;
	vec3 metal_film = microfacet_light2(alpha_both, test ? film : wheel_base_color, rise2, N, V, tangent_used, albedo);
	vec3 v3 = v2 * (1.0 - specular_film_albedo) * (wheel_base_color * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0));
	vec3 v4 = v3 + v2 * specular_film + wheel_metallic * passed2 * metal_film + sheen * (sheen_weight * passed);
	out1 = vec4((0.5 <= wheel_alpha ? 1.0 : 0.0) * ((v4 + wheel_clearcoat * coat) * u_envLightIntensity), 1.0);
}
