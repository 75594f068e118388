#version 400

// a_part

in VertexData
{
	vec2 texcoord_0;
} vd;

out vec4 a_part;

void main()
{
	a_part = vec4(vd.texcoord_0.y, vd.texcoord_0.y, vd.texcoord_0.y, 1.0);
}
