#version 400

// principled

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform bool u_refractionTwoSided = false;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform vec3 SR_baseColor = vec3(0.5, 0.2, 0.1);
uniform float SR_metallic = 0.3;
uniform float SR_specularTint = 0.5;
uniform float SR_sheen = 0.4;
uniform float SR_clearcoat = 0.8;
uniform float SR_clearcoatGloss = 0.7;
uniform float SR_specTrans = 0.2;
uniform float SR_subsurface = 0.3;

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
vec3 microfacet_light(float roughness, vec3 N, vec3 V, out vec3 albedo)
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
		vec3 L = reflect(-v2, normalize(slope));
		float NL = max(L.z, 0.0);
		float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, x3)));
		vec3 d = frame * L;
		float x4 = dot(slope, slope) / dot(h, h);
		float r2 = x4 * x4;
		float best = max(level - 0.25 * log2(r2 * r2 * (1.00001 - d.y * d.y)), 0.0);
		float whole = floor(best);
		vec3 v3 = weight * environment_lookup(u_envRadiance, d, whole + clamp(32.0 * (best - whole) - 15.5, 0.0, 1.0));
		azimuth = -0.7373689 * azimuth + vec2(-0.6754903, 0.6754903) * azimuth.yx;
		total += weight;
		light += v3;
		share += weight;
	}
	vec3 once = share / total;
	vec3 kept = mix(once, vec3(1), min(reach * total / count, 1.0));
	albedo = once * kept;
	return light * (kept / total);
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light2(vec3 base, vec3 rise, vec3 N, vec3 V, out vec3 albedo)
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

vec3 sheen_bsdf_environment(vec3 color, vec3 N, vec3 V, out vec3 albedo)
{
	float NV = clamp(dot(N, V), 0.0001, 1.0);
	float x = NV * (1.91259 * NV - 6.35138) + 3.35395 + 0.3 * (13.7158 - 4.94826 * NV - 0.20962621);
	float share = clamp(x / (13.4539 * NV + 1.0 + 0.3 * (11.4431 * NV + 26.6426)), 0.0, 1.0);
	albedo = vec3(share);
	return color * share * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light3(vec3 N, vec3 V)
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
	float coat_reflectance = 0.04 * SR_clearcoat;
	float coat_roughness = 1.0 - SR_clearcoatGloss;
	vec3 normal = normalize(vd.normalWorld);
	vec3 specular_color = mix(vec3(1), SR_baseColor, SR_specularTint);
	float matte_weight = 1.0 - SR_metallic;
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 N = faceforward(normal, -V, normal);
	vec3 coat_albedo;
	vec3 coat = microfacet_light(coat_roughness * coat_roughness, N, V, coat_albedo);
	vec3 passed = 1.0 - coat_reflectance * coat_albedo;
	vec3 v = matte_weight * passed;
	vec3 specular_albedo;
	vec3 specular = microfacet_light2(specular_color, 1.0 - specular_color, N, V, specular_albedo);
	vec3 passed2 = v * (1.0 - 0.04 * specular_albedo);
	vec3 v2 = passed2 * (1.0 - SR_specTrans);
	vec3 sheen_albedo;
	vec3 sheen = sheen_bsdf_environment(mix(vec3(1), SR_baseColor, 0.5), N, V, sheen_albedo);
	vec3 passed3 = v2 * (1.0 - SR_sheen * sheen_albedo);
	float t = 1.0 - clamp(dot(V, N), 0.0001, 1.0);
	float t2 = t * t;
	float t5 = t * (t2 * t2);
	vec3 v3 = environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
	vec3 diffuse = SR_baseColor * min(t5 * (0.5 * (1.146822 - 0.183363 * t5) - 0.486356) + 1.0058225, 1.0) * v3;
	vec3 albedo;
	vec3 metal = microfacet_light2(SR_baseColor, 1.0 - SR_baseColor, N, V, albedo);
	vec3 v4 = matte_weight * (passed3 * (1.0 - SR_subsurface)) * diffuse + SR_subsurface * passed3 * (SR_baseColor * v3);
	vec3 v5 = SR_specTrans * passed2 * ((u_refractionTwoSided ? SR_baseColor * SR_baseColor : SR_baseColor) * microfacet_light3(N, V));
	vec3 v6 = v4 + sheen * (SR_sheen * v2) + v5 + specular * (0.04 * v);
	out1 = vec4((v6 + SR_metallic * passed * metal + coat_reflectance * coat) * u_envLightIntensity, 1.0);
}
