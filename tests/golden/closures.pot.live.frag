#version 400

// pot

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform float varnish_weight = 0.7;
uniform float varnish_ior = 1.45;
uniform vec2 metal_roughness = vec2(0.2);
uniform vec3 clay_color = vec3(0.6, 0.3, 0.2);
uniform float clay_roughness = 0.4;
uniform float worn_mix = 0.4;
uniform vec3 dim_in2 = vec3(0.9, 0.8, 0.7);
uniform float dust_weight = 0.3;
uniform vec3 dust_color = vec3(0.5, 0.5, 0.4);
uniform vec3 glow_color = vec3(0.01, 0.02, 0.03);
uniform float built_opacity = 0.95;

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
vec3 microfacet_light(float ior, vec3 N, vec3 V, out vec3 albedo)
{
	float x = dot(N, V);
	vec3 tangent = V - N * x;
	vec3 v = cross(N, abs(N.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0));
	vec3 x2 = normalize(dot(tangent, tangent) < 1e-08 ? v : tangent);
	float NV = clamp(x, 0.0001, 1.0);
	vec3 v2 = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
	vec3 wide = vec3(0.05, 0.05, 1.0) * v2;
	float stretched = length(wide);
	vec3 s = wide / stretched;
	float count = float(u_envRadianceSamples);
	float descent = (s.z + 1.0) / count;
	float reach = NV + stretched;
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(count / (0.015707964 * reach));
	mat3 frame = mat3(u_envMatrix) * mat3(x2, cross(N, x2), N);
	float n2 = max(ior * ior, 0.0001);
	float x3 = n2 - 1.0;
	vec2 azimuth = vec2(1, 0);
	float total = 1e-08;
	vec3 light = vec3(0);
	vec3 share = vec3(0);
	for (int i = 0; i < u_envRadianceSamples; i++)
	{
		float z = 1.0 - descent * (float(i) + 0.5);
		vec3 h = s + vec3(azimuth * sqrt(1.0 - z * z), z);
		vec3 slope = vec3(0.05, 0.05, 1.0) * h;
		vec3 H = normalize(slope);
		vec3 L = reflect(-v2, H);
		float NL = max(L.z, 0.0);
		float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, 0.0025000002)));
		float x4 = dot(v2, H);
		float u = sqrt(max(x3 + x4 * x4, 0.0));
		float p = u / n2;
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

vec3 sheen_bsdf_environment(vec3 color, vec3 N, vec3 V)
{
	float NV = clamp(dot(N, V), 0.0001, 1.0);
	float x = NV * (1.91259 * NV - 6.35138) + 3.35395 + 0.3 * (13.7158 - 4.94826 * NV - 0.20962621);
	vec3 v = color * clamp(x / (13.4539 * NV + 1.0 + 0.3 * (11.4431 * NV + 26.6426)), 0.0, 1.0);
	return v * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light2(vec2 roughness, vec3 N, vec3 V, vec3 X)
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
		float t = max(1.0 - x4, 0.0);
		float t2 = t * t;
		float t4 = t2 * t2;
		vec3 v3 = (vec3(-0.20466384, 0.045040794, -0.4090425) * t4 + vec3(-0.04540178, -0.025290249, 0.18574984)) * (x4 * t2);
		vec3 F = weight * clamp(vec3(0.05577874, 0.22384816, 0.6266525) * (t * t4) + vec3(0.94422126, 0.77615184, 0.37334755) + v3, 0.0, 1.0);
		vec3 d = frame * L;
		float x5 = dot(slope, slope) / dot(h, h);
		float r2 = x5 * x5;
		float best = max(level - 0.25 * log2(r2 * r2 * (1.00001 - d.y * d.y)), 0.0);
		float whole = floor(best);
		vec3 v4 = F * environment_lookup(u_envRadiance, d, whole + clamp(32.0 * (best - whole) - 15.5, 0.0, 1.0));
		azimuth = -0.7373689 * azimuth + vec2(-0.6754903, 0.6754903) * azimuth.yx;
		total += weight;
		light += v4;
		share += F;
	}
	float E = min(reach * total / count, 1.0);
	float lost = 0.218505 - 0.207071 * NV + mean * (1.3982 * NV + 2.44659 * mean);
	float x6 = clamp(1.0 - NV * mean / (x2 + x3 * (3.68834 * NV + 0.792037)) * lost, 0.01, 1.0);
	float white = isotropic ? E : x6;
	return light * (mix(share / total, vec3(1), white) * min(E / white, 1.0) / total);
}

void main()
{
	vec3 normal = normalize(vd.normalWorld);
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 N = faceforward(normal, -V, normal);
	vec3 varnish_albedo;
	vec3 varnish = microfacet_light(varnish_ior, N, V, varnish_albedo);
	vec3 passed = 1.0 - varnish_weight * varnish_albedo;
	vec3 v = dim_in2 * passed;
	float NV = clamp(dot(V, N), 0.0001, 1.0);
	float s2 = clay_roughness * clay_roughness;
	float t = 1.0 - NV;
	float x = 0.45 * s2 / (s2 + 0.09) * (sqrt(max(1.0 - NV * NV, 0.0)) * (t * (0.0396229 * t + 0.252719) + 0.208327));
	vec3 v2 = clay_color * min(1.0 - 0.5 * s2 / (s2 + 0.33) + x, 1.0);
	vec3 v3 = v * (1.0 - worn_mix) * (v2 * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0));
	vec3 v4 = worn_mix * v * microfacet_light2(metal_roughness, N, V, normalize(vd.tangentWorld));
	vec3 v5 = dust_weight * passed * sheen_bsdf_environment(dust_color, N, V) + v3 + v4;
	out1 = vec4(built_opacity * (glow_color + (v5 + varnish_weight * varnish) * u_envLightIntensity), 1.0);
}
