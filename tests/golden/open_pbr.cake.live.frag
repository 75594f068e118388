#version 400

// cake

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform vec3 layered_base_color = vec3(0.6, 0.3, 0.1);
uniform float layered_base_metalness = 0.4;
uniform float layered_specular_roughness = 0.35;
uniform float layered_fuzz_weight = 0.3;
uniform float layered_coat_weight = 0.7;
uniform vec3 layered_coat_color = vec3(1.0, 0.9, 0.8);
uniform float layered_thin_film_weight = 0.5;
uniform float layered_thin_film_thickness = 0.4;
uniform float layered_emission_luminance = 0.2;

in VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
} vd;

out vec4 out1;

// Reads a latitude-longitude map: v = 0 is the zenith, u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d, float level)
{
	return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0))), level).xyz;
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light(float roughness, float ior, vec3 N, vec3 V, out vec3 albedo)
{
	float x = dot(N, V);
	vec3 tangent = V - N * x;
	vec3 v = cross(N, abs(N.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0));
	vec3 x2 = normalize(dot(tangent, tangent) < 1e-08 ? v : tangent);
	float NV = clamp(x, 0.0001, 1.0);
	float mean = clamp(roughness, 0.0001, 1.0);
	vec3 alpha = vec3(mean, mean, 1.0);
	vec3 v2 = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
	vec3 wide = alpha * v2;
	float stretched = length(wide);
	vec3 s = wide / stretched;
	float x3 = mean * mean;
	float count = float(u_envRadianceSamples);
	float descent = (s.z + 1.0) / count;
	float reach = NV + stretched;
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(count / (reach * (mean * (6.2831855 * mean))));
	mat3 frame = mat3(u_envMatrix) * mat3(x2, cross(N, x2), N);
	float n2 = max(ior * ior, 0.0001);
	float x4 = n2 - 1.0;
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
		float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, x3)));
		float x5 = dot(v2, H);
		float u = sqrt(max(x4 + x5 * x5, 0.0));
		float p = u / n2;
		float rs = (x5 - u) / (x5 + u);
		float rp = (x5 - p) / (x5 + p);
		float F = weight * (0.5 * (rs * rs + rp * rp));
		vec3 d = frame * L;
		float x6 = dot(slope, slope) / dot(h, h);
		float r2 = x6 * x6;
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

// Reflectance at an interface of admittance u + iw.
vec3 fresnel_reflectance(float c, vec3 u, vec3 w)
{
	vec3 v = c - u;
	vec3 v2 = w * w;
	vec3 v3 = c + u;
	return (v * v + v2) / max(v2 + v3 * v3, 1e-12);
}

// Reflectance of a thin film over an interface to n + ik (Belcour and Barla 2017, eq. 8).
vec3 fresnel_thin_film(float c, float n, float thickness)
{
	float inside = sqrt(1.0 - (1.0 - c * c) / 1.9599999);
	float phase = inside * (1.7592917e-08 * thickness);
	float x = n / 1.4;
	float re = x * x;
	float x2 = inside * inside;
	float t = re - (1.0 - x2);
	vec3 m = sqrt(vec3(t * t));
	vec3 u = sqrt(max(0.5 * (t + m), 0.0));
	vec3 w = sqrt(max(0.5 * (m - t), 0.0));
	float scale = 1.0 / max(re * re, 1e-12);
	vec3 up = scale * (re * u);
	vec3 wp = scale * (re * w);
	int polarisations = 0.0 < thickness ? 2 : 0;
	float x3 = 1.4 * inside;
	float x4 = inside / 1.4;
	float x5 = -2.0 * inside;
	vec3 u2 = u;
	vec3 w2 = w;
	vec3 sum = vec3(0);
	for (int p = 0; p < polarisations; p++)
	{
		float y = p == 0 ? x3 : x4;
		float r = (c - y) / (c + y);
		float R12 = r * r;
		float T = 1.0 - R12;
		vec3 R23 = fresnel_reflectance(inside, u2, w2);
		vec3 shift = atan(w2 * x5, x2 - u2 * u2 - w2 * w2) + (0.0 < r ? 3.1415927 : 0.0);
		vec3 R123 = R12 * R23;
		vec3 steady = R23 * (T * T) / (1.0 - R123);
		vec3 R123_2 = sqrt(R123);
		vec3 sum2 = sum + R12 + steady;
		vec3 wave = steady - T;
		for (int i = 0; i < 2; i++)
		{
			vec3 wave2 = R123_2 * wave;
			float x6 = float(i + 1);
			float x7 = phase * x6;
			vec3 v = shift * x6;
			vec3 v2 = vec3(9.04581e-08, 1.068737e-07, 1.069699e-07) * cos(v + vec3(1681000.0, 1795300.0, 2208400.0) * x7);
			vec3 v3 = vec3(1.644e-08 * cos(2239900.0 * x7 + v.x) * exp(x7 * (-4528200000.0 * x7)), 0.0, 0.0);
			vec3 v4 = 2.0 * wave2 * (9358910.0 * (v2 * exp(x7 * (vec3(-4327800000.0, -9304600000.0, -6612100000.0) * x7)) + v3));
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
vec3 microfacet_light2(float roughness, float ior, vec3 base, vec3 rise, vec3 N, vec3 V, out vec3 albedo)
{
	float x = dot(N, V);
	vec3 tangent = V - N * x;
	vec3 v = cross(N, abs(N.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0));
	vec3 x2 = normalize(dot(tangent, tangent) < 1e-08 ? v : tangent);
	float NV = clamp(x, 0.0001, 1.0);
	float mean = clamp(roughness, 0.0001, 1.0);
	vec3 alpha = vec3(mean, mean, 1.0);
	vec3 v2 = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
	vec3 wide = alpha * v2;
	float stretched = length(wide);
	vec3 s = wide / stretched;
	float x3 = mean * mean;
	float count = float(u_envRadianceSamples);
	float descent = (s.z + 1.0) / count;
	float reach = NV + stretched;
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(count / (reach * (mean * (6.2831855 * mean))));
	mat3 frame = mat3(u_envMatrix) * mat3(x2, cross(N, x2), N);
	float n2 = max(ior * ior, 0.0001);
	float x4 = n2 - 1.0;
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
		float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, x3)));
		float x5 = dot(v2, H);
		float u = sqrt(max(x4 + x5 * x5, 0.0));
		float p = u / n2;
		float rs = (x5 - u) / (x5 + u);
		float rp = (x5 - p) / (x5 + p);
		vec3 F = weight * (base + rise * (0.5 * (rs * rs + rp * rp)));
		vec3 d = frame * L;
		float x6 = dot(slope, slope) / dot(h, h);
		float r2 = x6 * x6;
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

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light3(float roughness, vec3 base, vec3 rise, vec3 N, vec3 V)
{
	float x = dot(N, V);
	vec3 tangent = V - N * x;
	vec3 v = cross(N, abs(N.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0));
	vec3 x2 = normalize(dot(tangent, tangent) < 1e-08 ? v : tangent);
	float NV = clamp(x, 0.0001, 1.0);
	float mean = clamp(roughness, 0.0001, 1.0);
	vec3 alpha = vec3(mean, mean, 1.0);
	vec3 v2 = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
	vec3 wide = alpha * v2;
	float stretched = length(wide);
	vec3 s = wide / stretched;
	float x3 = mean * mean;
	float count = float(u_envRadianceSamples);
	float descent = (s.z + 1.0) / count;
	float reach = NV + stretched;
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(count / (reach * (mean * (6.2831855 * mean))));
	mat3 frame = mat3(u_envMatrix) * mat3(x2, cross(N, x2), N);
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
		float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, x3)));
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
	return light * (mix(share / total, vec3(1), min(reach * total / count, 1.0)) / total);
}

// Reflectance of a thin film over an interface to n + ik (Belcour and Barla 2017, eq. 8).
vec3 fresnel_thin_film2(float c, vec3 n, float thickness)
{
	float inside = sqrt(1.0 - (1.0 - c * c) / 1.9599999);
	float phase = inside * (1.7592917e-08 * thickness);
	vec3 v = n / 1.4;
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
	float x2 = 1.4 * inside;
	float x3 = inside / 1.4;
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
	float base = layered_specular_roughness * layered_specular_roughness;
	float specular_roughness_coated = mix(layered_specular_roughness, sqrt(sqrt(min(base * base, 1.0))), layered_coat_weight);
	float alpha = specular_roughness_coated * specular_roughness_coated;
	float film_nanometers = 1000.0 * layered_thin_film_thickness;
	float index = mix(1.5, 1.0666667, layered_coat_weight);
	float amplitude = (index - 1.0) / (index + 1.0);
	float weighted = sign(amplitude) * sqrt(clamp(amplitude * amplitude, 0.0, 0.99999));
	float specular_index = (weighted + 1.0) / (1.0 - weighted);
	vec3 coat_darkened = mix(vec3(1), 0.3698225 / (1.0 - 0.6301775 * layered_base_color), layered_coat_weight);
	vec3 coat_passed = coat_darkened * mix(vec3(1), layered_coat_color, layered_coat_weight);
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 N = faceforward(normal, -V, normal);
	float NV = clamp(dot(V, N), 0.0001, 1.0);
	float share = exp(-(NV * (0.68819004 * NV + 0.5534177) + 0.09856644) / (0.5 * (0.102330275 * NV + 0.5353364)));
	vec3 v = environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
	float passed = 1.0 - layered_fuzz_weight * share;
	vec3 coat_albedo;
	vec3 coat = microfacet_light(0.0, 1.6, N, V, coat_albedo);
	vec3 v2 = coat_passed * (passed * (1.0 - layered_coat_weight * coat_albedo));
	vec3 v3 = v2 * (1.0 - layered_base_metalness);
	vec3 v4 = layered_base_metalness * v2;
	bool test = 0.0 < film_nanometers;
	vec3 base2 = test ? fresnel_thin_film(NV, specular_index, film_nanometers) : vec3(0);
	vec3 rise = test ? vec3(0) : vec3(1);
	vec3 specular_film_albedo;
	vec3 specular_film = microfacet_light2(alpha, specular_index, base2, rise, N, V, specular_film_albedo);
	vec3 specular_plain_albedo;
	vec3 specular_plain = microfacet_light(alpha, specular_index, N, V, specular_plain_albedo);
	float x = 1.0 - layered_thin_film_weight;
	vec3 rise2 = 1.0 - layered_base_color;
	vec3 root = sqrt(clamp(layered_base_color, 0.0, 0.99));
	vec3 film = fresnel_thin_film2(NV, (root + 1.0) / (1.0 - root), film_nanometers);
	vec3 metal_film = microfacet_light3(alpha, test ? film : layered_base_color, test ? vec3(0) : rise2, N, V);
	vec3 v5 = v3 * mix(1.0 - specular_plain_albedo, 1.0 - specular_film_albedo, layered_thin_film_weight) * (max(layered_base_color, 0.0) * v);
	vec3 v6 = v5 + specular_plain * (v3 * x) + specular_film * (layered_thin_film_weight * v3);
	vec3 v7 = v6 + v4 * x * microfacet_light3(alpha, layered_base_color, rise2, N, V);
	vec3 v8 = v7 + layered_thin_film_weight * v4 * metal_film + coat * (layered_coat_weight * passed);
	vec3 v9 = (v8 + layered_fuzz_weight * (share * v)) * u_envLightIntensity;
	vec3 v10 = layered_coat_color * (layered_coat_weight * (0.9467456 * (1.0 - pow(1.0 - abs(dot(normal, V)), 5.0))));
	out1 = vec4(v9 + layered_emission_luminance * (1.0 - layered_coat_weight + v10), 1.0);
}
