#version 400

// a_color4

uniform vec4 fade_valuel = vec4(1, 0, 0, 1);
uniform vec4 fade_valuer = vec4(0.0, 0.0, 1.0, 0.5);

in VertexData
{
	vec2 texcoord_0;
} vd;

out vec4 a_color4;

void main()
{
	a_color4 = mix(fade_valuel, fade_valuer, clamp(vd.texcoord_0.x, 0.0, 1.0));
}
