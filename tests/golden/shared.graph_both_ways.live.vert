#version 400

uniform mat4 u_worldMatrix = mat4(1);
uniform mat4 u_viewProjectionMatrix = mat4(1);

in vec3 i_position;
in vec2 i_texcoord_0;

out VertexData
{
	vec2 texcoord_0;
} vd;

void main()
{
	gl_Position = u_viewProjectionMatrix * (u_worldMatrix * vec4(i_position, 1.0));
	vd.texcoord_0 = i_texcoord_0;
}
