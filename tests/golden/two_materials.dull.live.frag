#version 400

// dull

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform sampler2D u_envIrradiance;

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

void main()
{
	vec3 normal = normalize(vd.normalWorld);
	vec3 diffuse = 0.8 * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * faceforward(normal, -normalize(u_viewPosition - vd.positionWorld), normal));
	out1 = vec4(diffuse * u_envLightIntensity, 1.0);
}
