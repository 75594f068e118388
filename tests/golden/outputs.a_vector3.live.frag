#version 400

// a_vector3

in VertexData
{
	vec3 normalWorld;
} vd;

out vec4 a_vector3;

void main()
{
	a_vector3 = vec4(normalize(vd.normalWorld), 1.0);
}
