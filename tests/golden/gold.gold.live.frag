#version 400

// gold

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;

uniform float gold_shader_base = 1.0;
uniform vec3 gold_shader_base_color = vec3(0.944, 0.776, 0.373);
uniform vec3 gold_shader_specular_color = vec3(0.998, 0.981, 0.751);
uniform float gold_shader_specular_roughness = 0.02;

in VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
} vd;

out vec4 out1;

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

// Reads a latitude-longitude map: v = 0 is the zenith, u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d, float level)
{
	return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0))), level).xyz;
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light(float roughness, vec3 base, vec3 rise, vec3 bend, vec3 dip, vec3 N, vec3 V)
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
		float t = max(1.0 - x4, 0.0);
		float t2 = t * t;
		float t4 = t2 * t2;
		vec3 F = weight * clamp(base + rise * (t * t4) + (bend + dip * t4) * (x4 * t2), 0.0, 1.0);
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
	return light * (mix(share / total, vec3(1), min(reach * total / count, 1.0)) / total);
}

void main()
{
	vec3 normal = normalize(vd.normalWorld);
	vec3 r = clamp(gold_shader_base * gold_shader_base_color, 0.0, 0.99);
	vec3 root = sqrt(r);
	vec3 v = 1.0 - r;
	vec3 metal_index_ior = mix((root + 1.0) / (1.0 - root), v / (r + 1.0), gold_shader_specular_color);
	vec3 above = metal_index_ior + 1.0;
	vec3 below = metal_index_ior - 1.0;
	vec3 v2 = above * above;
	vec3 metal_index_extinction = sqrt(max((r * v2 - below * below) / v, 0.0));
	float alpha = gold_shader_specular_roughness * gold_shader_specular_roughness;
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 v3 = 1.0 - metal_index_ior;
	vec3 v4 = metal_index_extinction * metal_index_extinction;
	vec3 base = (v3 * v3 + v4) / max(v2 + v4, 1e-12);
	vec3 rise = 1.0 - base;
	vec3 more60 = fresnel_conductor(0.5, metal_index_ior, metal_index_extinction) - base - 0.03125 * rise;
	vec3 more82 = fresnel_conductor(0.14285715, metal_index_ior, metal_index_extinction) - base - 0.46266437 * rise;
	vec3 bend = 9.047614 * more60 - 1.247679 * more82;
	vec3 metal = microfacet_light(alpha, base, rise, bend, 19.962864 * more82 - 16.761822 * more60, faceforward(normal, -V, normal), V);
	out1 = vec4(metal * u_envLightIntensity, 1.0);
}
