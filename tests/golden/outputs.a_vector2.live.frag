#version 400

// a_vector2

uniform vec3 turn_in1 = vec3(0, 1, 0);
uniform vec3 turn_in2 = vec3(-1, 0, 0);
uniform vec3 turn_in3 = vec3(0.25, 0.5, 1.0);

in VertexData
{
	vec2 texcoord_0;
} vd;

out vec4 a_vector2;

void main()
{
	a_vector2 = vec4((mat3(turn_in1, turn_in2, turn_in3) * vec3(vd.texcoord_0, 1.0)).xy, 0.0, 1.0);
}
