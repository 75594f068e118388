#version 400

// a_matrix33

out vec4 a_matrix33;

void main()
{
	a_matrix33 = vec4(0, 0, 0, 1);
}
