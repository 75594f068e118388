#version 400

// a_color3

in VertexData
{
	vec3 normalWorld;
} vd;

out vec4 a_color3;

void main()
{
	a_color3 = vec4(normalize(vd.normalWorld), 1.0);
}
