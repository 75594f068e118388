#version 400

// out

uniform float edge_amount = 0.1;

in VertexData
{
	vec2 texcoord_0;
} vd;

out vec4 out1;

void main()
{
	float edge = clamp((vd.texcoord_0.x - 0.5) / max(edge_amount, 0.001) + 0.5, 0.0, 1.0);
	out1 = vec4(edge, edge, edge, 1.0);
}
