#version 400

uniform mat4 u_worldMatrix = mat4(1);
uniform mat4 u_worldInverseTransposeMatrix = mat4(1);
uniform mat4 u_viewProjectionMatrix = mat4(1);

in vec3 i_position;
in vec3 i_normal;

out VertexData
{
	vec3 normalWorld;
} vd;

void main()
{
	gl_Position = u_viewProjectionMatrix * (u_worldMatrix * vec4(i_position, 1.0));
	vd.normalWorld = normalize(mat3(u_worldInverseTransposeMatrix) * i_normal);
}
