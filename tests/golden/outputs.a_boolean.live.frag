#version 400

// a_boolean

out vec4 a_boolean;

void main()
{
	a_boolean = vec4(1);
}
