#version 400

// lacquered_wood

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform sampler2D wood_color_file;
uniform vec2 NG_wood_planks = vec2(3, 2);
uniform vec3 NG_wood_stain = vec3(1.0, 0.92, 0.84);
uniform sampler2D wood_roughness_file;
uniform sampler2D wood_relief_file;
uniform float NG_wood_relief = 0.7;
uniform float SR_lacquered_wood_base = 0.95;
uniform float SR_lacquered_wood_specular = 0.4;
uniform float SR_lacquered_wood_coat = 0.9;
uniform vec3 SR_lacquered_wood_coat_color = vec3(1.0, 0.97, 0.92);
uniform float SR_lacquered_wood_coat_roughness = 0.08;
uniform float SR_lacquered_wood_coat_IOR = 1.52;
uniform float SR_lacquered_wood_coat_affect_color = 0.25;

in VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
	vec3 tangentWorld;
	vec3 bitangentWorld;
	vec2 texcoord_0;
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

void main()
{
	vec2 p = vd.texcoord_0 * NG_wood_planks;
	vec3 v = texture(wood_color_file, p).xyz;
	vec3 curve = pow(max((v + 0.055) / 1.055, 0.0), vec3(2.4));
	float wood_roughness = texture(wood_roughness_file, p).x;
	vec3 normal = normalize(vd.normalWorld);
	vec3 direction = 2.0 * texture(wood_relief_file, p).xyz - vec3(1.0, 1.0, 0.99999994);
	vec3 v2 = normalize(vd.tangentWorld) * (NG_wood_relief * direction.x) + normalize(vd.bitangentWorld) * (NG_wood_relief * direction.y);
	vec3 wood_normal = normalize(v2 + normal * direction.z);
	float alpha = SR_lacquered_wood_coat_roughness * SR_lacquered_wood_coat_roughness;
	vec3 v3 = max(mix(curve, v / 12.92, step(v, vec3(0.04045))) * NG_wood_stain, 0.0);
	vec3 base_deepened = pow(v3, vec3(SR_lacquered_wood_coat_affect_color * clamp(SR_lacquered_wood_coat, 0.0, 1.0) + 1.0));
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 coat_albedo;
	vec3 coat = microfacet_light(alpha, SR_lacquered_wood_coat_IOR, faceforward(normal, -V, normal), V, coat_albedo);
	vec3 v4 = mix(vec3(1), SR_lacquered_wood_coat_color, SR_lacquered_wood_coat) * (1.0 - SR_lacquered_wood_coat * coat_albedo);
	vec3 N = faceforward(wood_normal, -V, wood_normal);
	vec3 specular_albedo;
	vec3 specular = microfacet_light(wood_roughness * wood_roughness, 1.5, N, V, specular_albedo);
	vec3 diffuse = base_deepened * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
	vec3 v5 = SR_lacquered_wood_base * (v4 * (1.0 - SR_lacquered_wood_specular * specular_albedo)) * diffuse;
	vec3 light = v5 + specular * (SR_lacquered_wood_specular * v4) + SR_lacquered_wood_coat * coat;
	out1 = vec4(light * u_envLightIntensity, 1.0);
}
