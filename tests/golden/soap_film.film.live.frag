#version 400

// film

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform vec3 film_shader_base_color = vec3(0.02);
uniform float film_shader_specular_roughness = 0.05;
uniform float film_shader_thin_film_thickness = 380.0;
uniform float film_shader_thin_film_IOR = 1.33;

in VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
} vd;

out vec4 out1;

// Reflectance of a thin film over an interface to n + ik (Belcour and Barla 2017, eq. 8).
vec3 fresnel_thin_film(float c, float thickness, float film_ior)
{
	float film = max(film_ior, 1.0);
	float inside = sqrt(1.0 - (1.0 - c * c) / (film * film));
	float phase = inside * (thickness * (1.256637e-08 * film));
	float x = 1.5 / film;
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
	float x3 = film * inside;
	float x4 = inside / film;
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
		vec3 v = inside - u2;
		vec3 v2 = w2 * w2;
		vec3 v3 = inside + u2;
		vec3 R23 = (v * v + v2) / max(v2 + v3 * v3, 1e-12);
		vec3 shift = atan(w2 * x5, x2 - u2 * u2 - v2) + (0.0 < r ? 3.1415927 : 0.0);
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
			vec3 v4 = shift * x6;
			vec3 v5 = vec3(9.04581e-08, 1.068737e-07, 1.069699e-07) * cos(v4 + vec3(1681000.0, 1795300.0, 2208400.0) * x7);
			vec3 v6 = vec3(1.644e-08 * cos(2239900.0 * x7 + v4.x) * exp(x7 * (-4528200000.0 * x7)), 0.0, 0.0);
			vec3 v7 = 2.0 * wave2 * (9358910.0 * (v5 * exp(x7 * (vec3(-4327800000.0, -9304600000.0, -6612100000.0) * x7)) + v6));
			sum2 += v7;
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
vec3 microfacet_light(float roughness, vec3 base, vec3 rise, vec3 N, vec3 V, out vec3 albedo)
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
		float x4 = dot(v2, H);
		float u = sqrt(max(x4 * x4 + 1.25, 0.0));
		float p = u / 2.25;
		float rs = (x4 - u) / (x4 + u);
		float rp = (x4 - p) / (x4 + p);
		vec3 F = weight * (base + rise * (0.5 * (rs * rs + rp * rp)));
		vec3 d = frame * L;
		float x5 = dot(slope, slope) / dot(h, h);
		float r2 = x5 * x5;
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

void main()
{
	vec3 normal = normalize(vd.normalWorld);
	float alpha = film_shader_specular_roughness * film_shader_specular_roughness;
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 N = faceforward(normal, -V, normal);
	bool test = 0.0 < film_shader_thin_film_thickness;
	vec3 film = fresnel_thin_film(clamp(dot(V, N), 0.0001, 1.0), film_shader_thin_film_thickness, film_shader_thin_film_IOR);
	vec3 rise = test ? vec3(0) : vec3(1);
	vec3 specular_albedo;
	vec3 specular = microfacet_light(alpha, test ? film : vec3(0), rise, N, V, specular_albedo);
	vec3 v = (1.0 - specular_albedo) * (max(film_shader_base_color, 0.0) * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0));
	out1 = vec4((specular + v) * u_envLightIntensity, 1.0);
}
