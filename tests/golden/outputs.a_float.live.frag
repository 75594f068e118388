#version 400

// a_float

uniform float chosen_value2 = 0.5;
uniform float chosen_in1 = 1.0;

in VertexData
{
	vec2 texcoord_0;
} vd;

out vec4 a_float;

void main()
{
	float chosen = chosen_value2 < vd.texcoord_0.y ? chosen_in1 : vd.texcoord_0.x;
	a_float = vec4(chosen, chosen, chosen, 1.0);
}
