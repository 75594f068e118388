#version 400

// specular

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform vec3 by_specular_emissiveColor = vec3(0.0, 0.1, 0.0);
uniform vec3 by_specular_specularColor = vec3(0.2, 0.1, 0.05);
uniform float by_specular_opacity = 0.6;
uniform float by_specular_opacityThreshold = 0.5;
uniform vec3 by_specular_normal = vec3(0.1, 0.0, 0.99);

in VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
	vec3 tangentWorld;
	vec3 bitangentWorld;
} vd;

out vec4 out1;

// Reads a latitude-longitude map: v = 0 is the zenith, u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d, float level)
{
	return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0))), level).xyz;
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light(vec3 base, vec3 rise, vec3 N, vec3 V, out vec3 albedo)
{
	float x = dot(N, V);
	vec3 tangent = V - N * x;
	vec3 v = cross(N, abs(N.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0));
	vec3 x2 = normalize(dot(tangent, tangent) < 1e-08 ? v : tangent);
	float NV = clamp(x, 0.0001, 1.0);
	vec3 v2 = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
	vec3 wide = vec3(0.25, 0.25, 1.0) * v2;
	float stretched = length(wide);
	vec3 s = wide / stretched;
	float count = float(u_envRadianceSamples);
	float descent = (s.z + 1.0) / count;
	float reach = NV + stretched;
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(count / (0.3926991 * reach));
	mat3 frame = mat3(u_envMatrix) * mat3(x2, cross(N, x2), N);
	vec2 azimuth = vec2(1, 0);
	float total = 1e-08;
	vec3 light = vec3(0);
	vec3 share = vec3(0);
	for (int i = 0; i < u_envRadianceSamples; i++)
	{
		float z = 1.0 - descent * (float(i) + 0.5);
		vec3 h = s + vec3(azimuth * sqrt(1.0 - z * z), z);
		vec3 slope = vec3(0.25, 0.25, 1.0) * h;
		vec3 H = normalize(slope);
		vec3 L = reflect(-v2, H);
		float NL = max(L.z, 0.0);
		float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, 0.0625)));
		float t = max(1.0 - dot(v2, H), 0.0);
		float t2 = t * t;
		vec3 F = weight * clamp(base + rise * (t * (t2 * t2)), 0.0, 1.0);
		vec3 d = frame * L;
		float x3 = dot(slope, slope) / dot(h, h);
		float r2 = x3 * x3;
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
vec3 microfacet_light2(vec3 N, vec3 V)
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
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(count / (6.283185e-08 * (NV + stretched)));
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
		vec3 d = frame * reflect(v2, refract(-v2, normalize(slope), 0.6666667));
		float x3 = dot(slope, slope) / dot(h, h);
		float r2 = x3 * x3;
		float best = max(level - 0.25 * log2(r2 * r2 * (1.00001 - d.y * d.y)), 0.0);
		float whole = floor(best);
		vec3 seen = environment_lookup(u_envRadiance, d, whole + clamp(32.0 * (best - whole) - 15.5, 0.0, 1.0));
		azimuth = -0.7373689 * azimuth + vec2(-0.6754903, 0.6754903) * azimuth.yx;
		total += 1.0;
		light += seen;
		share += 1.0;
	}
	return light * (1.0 / total);
}

void main()
{
	vec3 direction = 2.0 * (0.5 * by_specular_normal + 0.5) - vec3(1.0, 1.0, 0.99999994);
	vec3 v = normalize(vd.tangentWorld) * direction.x + normalize(vd.bitangentWorld) * direction.y + normalize(vd.normalWorld) * direction.z;
	vec3 surface_normal = normalize(v);
	float matte_unless_cut = 0.0 < by_specular_opacityThreshold ? 1.0 : by_specular_opacity;
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 N = faceforward(surface_normal, -V, surface_normal);
	vec3 colored_albedo;
	vec3 colored = microfacet_light(by_specular_specularColor, 1.0 - by_specular_specularColor, N, V, colored_albedo);
	vec3 passed = 1.0 - colored_albedo;
	vec3 v2 = matte_unless_cut * passed * (0.18 * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0));
	vec3 v3 = (colored + passed * (1.0 - matte_unless_cut) * microfacet_light2(N, V) + v2) * u_envLightIntensity;
	out1 = vec4((by_specular_opacityThreshold <= by_specular_opacity ? 1.0 : 0.0) * (by_specular_emissiveColor + v3), 1.0);
}
