#version 400

// metallic

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform vec3 by_metallic_diffuseColor = vec3(0.8, 0.6, 0.3);
uniform float by_metallic_metallic = 0.5;
uniform float by_metallic_clearcoat = 0.4;
uniform float by_metallic_opacity = 0.6;

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
		float t = max(1.0 - dot(v2, H), 0.0);
		float t2 = t * t;
		float F = weight * clamp(0.96 * (t * (t2 * t2)) + 0.040000003, 0.0, 1.0);
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

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light3(vec3 base, vec3 rise, vec3 bend, vec3 dip, vec3 N, vec3 V)
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
		float x3 = dot(v2, H);
		float t = max(1.0 - x3, 0.0);
		float t2 = t * t;
		float t4 = t2 * t2;
		vec3 F = weight * clamp(base + rise * (t * t4) + (bend + dip * t4) * (x3 * t2), 0.0, 1.0);
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

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light4(vec3 N, vec3 V)
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
	vec3 surface_normal = normalize(vd.normalWorld);
	float nonmetal = 1.0 - by_metallic_metallic;
	vec3 r = clamp(by_metallic_diffuseColor, 0.0, 0.99);
	vec3 root = sqrt(r);
	vec3 v = 1.0 - r;
	vec3 metal_index_ior = mix((root + 1.0) / (1.0 - root), v / (r + 1.0), by_metallic_diffuseColor);
	vec3 above = metal_index_ior + 1.0;
	vec3 below = metal_index_ior - 1.0;
	vec3 v2 = above * above;
	vec3 metal_index_extinction = sqrt(max((r * v2 - below * below) / v, 0.0));
	vec3 specular_color90 = mix(vec3(1), by_metallic_diffuseColor, by_metallic_metallic);
	vec3 specular_color0 = mix(0.040000003 * specular_color90, specular_color90, by_metallic_metallic);
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 N = faceforward(surface_normal, -V, surface_normal);
	vec3 coat_albedo;
	vec3 coat = microfacet_light(N, V, coat_albedo);
	vec3 passed = 1.0 - by_metallic_clearcoat * coat_albedo;
	vec3 v3 = nonmetal * passed;
	vec3 specular_albedo;
	vec3 specular = microfacet_light2(specular_color0, specular_color90 - specular_color0, N, V, specular_albedo);
	vec3 passed2 = v3 * (1.0 - specular_albedo);
	vec3 v4 = 1.0 - metal_index_ior;
	vec3 v5 = metal_index_extinction * metal_index_extinction;
	vec3 base = (v4 * v4 + v5) / max(v2 + v5, 1e-12);
	vec3 rise = 1.0 - base;
	vec3 more60 = fresnel_conductor(0.5, metal_index_ior, metal_index_extinction) - base - 0.03125 * rise;
	vec3 more82 = fresnel_conductor(0.14285715, metal_index_ior, metal_index_extinction) - base - 0.46266437 * rise;
	vec3 metal = microfacet_light3(base, rise, 9.047614 * more60 - 1.247679 * more82, 19.962864 * more82 - 16.761822 * more60, N, V);
	vec3 diffuse = by_metallic_diffuseColor * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
	vec3 v6 = passed2 * (1.0 - by_metallic_opacity) * microfacet_light4(N, V);
	vec3 v7 = v3 * specular + by_metallic_metallic * passed * metal + v6;
	vec3 light = v7 + nonmetal * (by_metallic_opacity * passed2) * diffuse + by_metallic_clearcoat * coat;
	out1 = vec4((0.0 <= by_metallic_opacity ? 1.0 : 0.0) * (light * u_envLightIntensity), 1.0);
}
