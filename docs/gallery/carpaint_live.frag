#version 400

// Car_Paint

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform float SR_carpaint_base = 0.5;
uniform vec3 SR_carpaint_base_color = vec3(0.1037792, 0.5921203, 0.85064936);
uniform float SR_carpaint_specular = 1.0;
uniform vec3 SR_carpaint_specular_color = vec3(1);
uniform float SR_carpaint_specular_roughness = 0.4;
uniform float SR_carpaint_specular_anisotropy = 0.5;
uniform float SR_carpaint_coat_roughness = 0.0;

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
		vec3 H = normalize(slope);
		vec3 L = reflect(-v2, H);
		float NL = max(L.z, 0.0);
		float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, x3)));
		float x4 = dot(v2, H);
		float u = sqrt(max(x4 * x4 + 1.25, 0.0));
		float p = u / 2.25;
		float rs = (x4 - u) / (x4 + u);
		float rp = (x4 - p) / (x4 + p);
		float F = weight * (0.5 * (rs * rs + rp * rp));
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

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light2(vec2 roughness, vec3 N, vec3 V, vec3 X, out vec3 albedo)
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
		float x4 = dot(v2, H);
		float u = sqrt(max(x4 * x4 + 1.25, 0.0));
		float p2 = u / 2.25;
		float rs = (x4 - u) / (x4 + u);
		float rp = (x4 - p2) / (x4 + p2);
		float F = weight * (0.5 * (rs * rs + rp * rp));
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
	float E = min(reach * total / count, 1.0);
	vec3 once = share / total;
	float lost = 0.218505 - 0.207071 * NV + mean * (1.3982 * NV + 2.44659 * mean);
	float x6 = clamp(1.0 - NV * mean / (x2 + x3 * (3.68834 * NV + 0.792037)) * lost, 0.01, 1.0);
	float white = isotropic ? E : x6;
	vec3 kept = mix(once, vec3(1), white) * min(E / white, 1.0);
	albedo = once * kept;
	return light * (kept / total);
}

void main()
{
	vec3 normal = normalize(vd.normalWorld);
	float alpha = SR_carpaint_specular_roughness * SR_carpaint_specular_roughness;
	float aspect = sqrt(1.0 - clamp(SR_carpaint_specular_anisotropy, 0.0, 0.98));
	vec2 p = vec2(min(alpha / aspect, 1.0), alpha * aspect);
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 N = faceforward(normal, -V, normal);
	vec3 coat_albedo;
	vec3 coat = microfacet_light(SR_carpaint_coat_roughness * SR_carpaint_coat_roughness, N, V, coat_albedo);
	vec3 passed = 1.0 - coat_albedo;
	vec3 specular_albedo;
	vec3 radiance = microfacet_light2(0.0 < SR_carpaint_specular_anisotropy ? p : vec2(alpha), N, V, normalize(vd.tangentWorld), specular_albedo);
	vec3 diffuse = max(SR_carpaint_base_color, 0.0) * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
	vec3 v = SR_carpaint_base * (passed * (1.0 - SR_carpaint_specular * specular_albedo)) * diffuse;
	out1 = vec4((coat + v + SR_carpaint_specular_color * radiance * (SR_carpaint_specular * passed)) * u_envLightIntensity, 1.0);
}
