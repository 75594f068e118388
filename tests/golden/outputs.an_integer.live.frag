#version 400

// an_integer

in VertexData
{
	vec2 texcoord_0;
} vd;

out vec4 an_integer;

void main()
{
	float x = float(int(floor(vd.texcoord_0.x)));
	an_integer = vec4(x, x, x, 1.0);
}
