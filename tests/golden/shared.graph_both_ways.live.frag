#version 400

// graph/both_ways

in VertexData
{
	vec2 texcoord_0;
} vd;

out vec4 both_ways;

int hash_mix(int first, int second)
{
	int c = (-559038716 ^ second) - (second << 14 | int(uint(second) >> 18));
	int a = (first ^ c) - (c << 11 | int(uint(c) >> 21));
	int b = (second ^ a) - (a << 25 | int(uint(a) >> 7));
	int c2 = (c ^ b) - (b << 16 | int(uint(b) >> 16));
	int a2 = (a ^ c2) - (c2 << 4 | int(uint(c2) >> 28));
	int b2 = (b ^ a2) - (a2 << 14 | int(uint(a2) >> 18));
	return (c2 ^ b2) - (b2 << 24 | int(uint(b2) >> 8));
}

// The product of (x, y) with one of eight gradients (±1, ±2) and (±2, ±1).
float gradient_2d(int hash, float x, float y)
{
	bool test = (hash & 4) == 0;
	float u = test ? x : y;
	float v = test ? y : x;
	return ((hash & 1) == 0 ? u : -u) + 2.0 * ((hash & 2) == 0 ? v : -v);
}

// Three channels take a byte each of one hash.
vec3 gradients_2d(int hash, float x, float y)
{
	return vec3(gradient_2d(hash, x, y), gradient_2d(hash >> 8, x, y), gradient_2d(hash >> 16, x, y));
}

vec3 noise_vector_2d(vec2 p)
{
	vec2 cell = floor(p);
	int i = int(cell.x);
	int j = int(cell.y);
	float x = p.x - cell.x;
	float y = p.y - cell.y;
	float u = x * (x * x) * (x * (6.0 * x - 15.0) + 10.0);
	int first = i - 559038716;
	int second = j - 559038716;
	int first2 = i + 1 - 559038716;
	float x2 = x - 1.0;
	vec3 v = gradients_2d(hash_mix(first2, second), x2, y);
	vec3 near = mix(gradients_2d(hash_mix(first, second), x, y), v, u);
	int second2 = j + 1 - 559038716;
	float y2 = y - 1.0;
	vec3 v2 = gradients_2d(hash_mix(first2, second2), x2, y2);
	vec3 far = mix(gradients_2d(hash_mix(first, second2), x, y2), v2, u);
	return 0.6616 * mix(near, far, y * (y * y) * (y * (6.0 * y - 15.0) + 10.0));
}

void main()
{
	vec3 cloud = noise_vector_2d(vd.texcoord_0);
	both_ways = vec4(mix(cloud.zxy, cloud, length(cloud)), 1.0);
}
