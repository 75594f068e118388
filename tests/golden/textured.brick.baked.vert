#version 400

uniform mat4 u_worldMatrix = mat4(1);
uniform mat4 u_worldInverseTransposeMatrix = mat4(1);
uniform mat4 u_viewProjectionMatrix = mat4(1);

in vec3 i_position;
in vec3 i_normal;
in vec3 i_tangent;
in vec2 i_texcoord_0;

out VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
	vec3 tangentWorld;
	vec3 bitangentWorld;
	vec2 texcoord_0;
} vd;

void main()
{
	vec4 positionWorld = u_worldMatrix * vec4(i_position, 1.0);
	vec3 v = normalize(mat3(u_worldInverseTransposeMatrix) * i_normal);
	vec3 v2 = normalize(mat3(u_worldMatrix) * i_tangent);
	gl_Position = u_viewProjectionMatrix * positionWorld;
	vd.positionWorld = positionWorld.xyz;
	vd.normalWorld = v;
	vd.tangentWorld = v2;
	vd.bitangentWorld = cross(v, v2);
	vd.texcoord_0 = i_texcoord_0;
}
