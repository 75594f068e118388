#version 400

uniform mat4 u_worldMatrix = mat4(1);
uniform mat4 u_worldInverseTransposeMatrix = mat4(1);
uniform mat4 u_viewProjectionMatrix = mat4(1);

in vec3 i_position;
in vec3 i_normal;
in vec3 i_tangent;

out VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
	vec3 tangentWorld;
} vd;

void main()
{
	vec4 positionWorld = u_worldMatrix * vec4(i_position, 1.0);
	gl_Position = u_viewProjectionMatrix * positionWorld;
	vd.positionWorld = positionWorld.xyz;
	vd.normalWorld = normalize(mat3(u_worldInverseTransposeMatrix) * i_normal);
	vd.tangentWorld = normalize(mat3(u_worldMatrix) * i_tangent);
}
