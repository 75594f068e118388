#version 400

// half

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform float gr_e_value = 0.55;
uniform vec3 a_b_value = vec3(0.4, 0.5, 0.6);
uniform vec3 a_b_value2 = vec3(0.1, 0.2, 0.3);
uniform sampler2D texture_file;
uniform float n1st_value = 0.7;
uniform float texture2D_amplitude = 0.5;
uniform float sampler2D_amplitude = 0.25;

in VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
	vec3 positionObject;
	vec2 texcoord_0;
} vd;

out vec4 out1;

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

// Perlin noise in about [-1, 1], 0 at the lattice points.
float noise_2d(vec2 p)
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
	float x3 = gradient_2d(hash_mix(first2, second), x2, y);
	float near = mix(gradient_2d(hash_mix(first, second), x, y), x3, u);
	int second2 = j + 1 - 559038716;
	float y2 = y - 1.0;
	float x4 = gradient_2d(hash_mix(first2, second2), x2, y2);
	float far = mix(gradient_2d(hash_mix(first, second2), x, y2), x4, u);
	return 0.6616 * mix(near, far, y * (y * y) * (y * (6.0 * y - 15.0) + 10.0));
}

int hash_mix2(int first, int second, int third)
{
	int c = (third ^ second) - (second << 14 | int(uint(second) >> 18));
	int a = (first ^ c) - (c << 11 | int(uint(c) >> 21));
	int b = (second ^ a) - (a << 25 | int(uint(a) >> 7));
	int c2 = (c ^ b) - (b << 16 | int(uint(b) >> 16));
	int a2 = (a ^ c2) - (c2 << 4 | int(uint(c2) >> 28));
	int b2 = (b ^ a2) - (a2 << 14 | int(uint(a2) >> 18));
	return (c2 ^ b2) - (b2 << 24 | int(uint(b2) >> 8));
}

// The product of (x, y, z) with one of twelve gradients, to the middles of a cube's edges; four of them count twice.
float gradient_3d(int hash, float x, float y, float z)
{
	float u = (hash & 8) == 0 ? x : y;
	float v = (hash & 12) == 0 ? y : (hash & 13) == 12 ? x : z;
	return ((hash & 1) == 0 ? u : -u) + ((hash & 2) == 0 ? v : -v);
}

// The noise on one face of a cell of the lattice, `k` the layer, (x, y, z) the place relative to its first corner.
float noise_layer(int i, int j, int k, float x, float y, float z, float u, float v)
{
	int first = i - 559038712;
	int second = j - 559038712;
	int third = k - 559038712;
	int first2 = i + 1 - 559038712;
	float x2 = x - 1.0;
	float x3 = gradient_3d(hash_mix2(first2, second, third), x2, y, z);
	int second2 = j + 1 - 559038712;
	float y2 = y - 1.0;
	float x4 = gradient_3d(hash_mix2(first2, second2, third), x2, y2, z);
	float far = mix(gradient_3d(hash_mix2(first, second2, third), x, y2, z), x4, u);
	return mix(mix(gradient_3d(hash_mix2(first, second, third), x, y, z), x3, u), far, v);
}

float noise_3d(vec3 p)
{
	vec3 cell = floor(p);
	int i = int(cell.x);
	int j = int(cell.y);
	int k = int(cell.z);
	vec3 r = p - cell;
	float u = r.x * (r.x * r.x) * (r.x * (6.0 * r.x - 15.0) + 10.0);
	float v = r.y * (r.y * r.y) * (r.y * (6.0 * r.y - 15.0) + 10.0);
	float above = noise_layer(i, j, k + 1, r.x, r.y, r.z - 1.0, u, v);
	float x = r.z * (r.z * r.z) * (r.z * (6.0 * r.z - 15.0) + 10.0);
	return 0.982 * mix(noise_layer(i, j, k, r.x, r.y, r.z, u, v), above, x);
}

// Reads a latitude-longitude map: v = 0 is the zenith, u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d, float level)
{
	return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0))), level).xyz;
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light(float roughness, vec3 N, vec3 V, out vec3 albedo)
{
	float x = dot(N, V);
	vec3 tangent = V - N * x;
	vec3 v = cross(N, abs(N.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0));
	vec3 x2 = normalize(dot(tangent, tangent) < 1e-08 ? v : tangent);
	float NV = clamp(x, 0.0001, 1.0);
	float mean = clamp(roughness, 0.0001, 1.0);
	vec3 alpha = vec3(mean, mean, 1.0);
	vec3 v2 = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
	vec3 wide = alpha * v2;
	float stretched = length(wide);
	vec3 s = wide / stretched;
	float x3 = mean * mean;
	float count = float(u_envRadianceSamples);
	float descent = (s.z + 1.0) / count;
	float reach = NV + stretched;
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(count / (reach * (mean * (6.2831855 * mean))));
	mat3 frame = mat3(u_envMatrix) * mat3(x2, cross(N, x2), N);
	vec2 azimuth = vec2(1, 0);
	float total = 1e-08;
	vec3 light = vec3(0);
	vec3 share = vec3(0);
	for (int i = 0; i < u_envRadianceSamples; i++)
	{
		float z = 1.0 - descent * (float(i) + 0.5);
		vec3 h = s + vec3(azimuth * sqrt(1.0 - z * z), z);
		vec3 slope = alpha * h;
		vec3 H = normalize(slope);
		vec3 L = reflect(-v2, H);
		float NL = max(L.z, 0.0);
		float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, x3)));
		float x4 = dot(v2, H);
		float u = sqrt(max(x4 * x4 + 1.25, 0.0));
		float p = u / 2.25;
		float rs = (x4 - u) / (x4 + u);
		float rp = (x4 - p) / (x4 + p);
		float F = weight * (0.5 * (rs * rs + rp * rp));
		vec3 d = frame * L;
		float x5 = dot(slope, slope) / dot(h, h);
		float r2 = x5 * x5;
		float best = max(level - 0.25 * log2(r2 * r2 * (1.00001 - d.y * d.y)), 0.0);
		float whole = floor(best);
		vec3 v3 = F * environment_lookup(u_envRadiance, d, whole + clamp(32.0 * (best - whole) - 15.5, 0.0, 1.0));
		azimuth = -0.7373689 * azimuth + vec2(-0.6754903, 0.6754903) * azimuth.yx;
		total += weight;
		light += v3;
		share += F;
	}
	vec3 once = share / total;
	vec3 kept = mix(once, vec3(1), min(reach * total / count, 1.0));
	albedo = once * kept;
	return light * (kept / total);
}

void main()
{
	float texture2D2 = texture2D_amplitude * noise_2d(vd.texcoord_0);
	float sampler2D2 = sampler2D_amplitude * noise_3d(vd.positionObject);
	vec3 normal = normalize(vd.normalWorld);
	vec3 base_deepened = max(mix(a_b_value2 * texture(texture_file, vd.texcoord_0).xyz, a_b_value, n1st_value), 0.0);
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 N = faceforward(normal, -V, normal);
	vec3 coat_albedo;
	vec3 coat = microfacet_light(0.010000001, N, V, coat_albedo);
	vec3 passed = 1.0 - sampler2D2 * coat_albedo;
	vec3 specular_albedo;
	vec3 specular = microfacet_light(0.040000003, N, V, specular_albedo);
	vec3 diffuse = base_deepened * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
	vec3 v = sin(gr_e_value) * (passed * (1.0 - texture2D2 * specular_albedo)) * diffuse + specular * (texture2D2 * passed);
	out1 = vec4((v + sampler2D2 * coat) * u_envLightIntensity, 1.0);
}
