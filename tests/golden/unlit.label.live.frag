#version 400

// label

uniform sampler2D sticker_file;

in VertexData
{
	vec2 texcoord_0;
} vd;

out vec4 out1;

void main()
{
	vec4 sticker = texture(sticker_file, vd.texcoord_0);
	out1 = vec4(sticker.xyz * sticker.w, 1.0);
}
