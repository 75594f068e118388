#version 400

// velvet

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform sampler2D u_envIrradiance;

uniform float velvet_shader_base = 0.8;
uniform vec3 velvet_shader_base_color = vec3(0.12, 0.01, 0.05);
uniform float velvet_shader_sheen = 0.9;
uniform vec3 velvet_shader_sheen_color = vec3(0.8, 0.4, 0.5);
uniform float velvet_shader_sheen_roughness = 0.35;

in VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
} vd;

out vec4 out1;

// Reads a latitude-longitude map: v = 0 is the zenith, u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d)
{
	return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0))), 0.0).xyz;
}

vec3 sheen_bsdf_environment(vec3 color, float roughness, vec3 N, vec3 V, out vec3 albedo)
{
	float NV = clamp(dot(N, V), 0.0001, 1.0);
	float r = clamp(roughness, 0.01, 1.0);
	float x = NV * (1.91259 * NV - 6.35138) + 3.35395 + r * (13.7158 - 4.94826 * NV - 0.698754 * r);
	float share = clamp(x / (13.4539 * NV + 1.0 + r * (11.4431 * NV + 26.6426)), 0.0, 1.0);
	albedo = vec3(share);
	return color * share * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N);
}

void main()
{
	vec3 normal = normalize(vd.normalWorld);
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 N = faceforward(normal, -V, normal);
	vec3 sheen_albedo;
	vec3 sheen = sheen_bsdf_environment(velvet_shader_sheen_color, velvet_shader_sheen_roughness, N, V, sheen_albedo);
	vec3 diffuse = max(velvet_shader_base_color, 0.0) * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N);
	vec3 light = velvet_shader_base * (1.0 - velvet_shader_sheen * sheen_albedo) * diffuse + velvet_shader_sheen * sheen;
	out1 = vec4(light * u_envLightIntensity, 1.0);
}
