#version 400

// marble

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform float veins_scale = 4.0;
uniform int veins_octaves = 3;
uniform vec3 out_color_fg = vec3(0.8);
uniform vec3 out_color_bg = vec3(0.1, 0.1, 0.3);

in VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
	vec3 positionObject;
} vd;

out vec4 out1;

int hash_mix(int first, int second, int third)
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
	float x3 = gradient_3d(hash_mix(first2, second, third), x2, y, z);
	int second2 = j + 1 - 559038712;
	float y2 = y - 1.0;
	float x4 = gradient_3d(hash_mix(first2, second2, third), x2, y2, z);
	float far = mix(gradient_3d(hash_mix(first, second2, third), x, y2, z), x4, u);
	return mix(mix(gradient_3d(hash_mix(first, second, third), x, y, z), x3, u), far, v);
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

float fractal_3d(vec3 p, int octaves)
{
	int k = min(octaves, 64);
	float sum = 0.0;
	float amplitude = 1.0;
	vec3 q = p;
	for (int i = 0; i < k; i++)
	{
		sum += amplitude * noise_3d(q);
		amplitude *= 0.5;
		q *= 2.0;
	}
	return sum;
}

// Reads a latitude-longitude map: v = 0 is the zenith, u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d, float level)
{
	return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0))), level).xyz;
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light(vec3 N, vec3 V, out vec3 albedo)
{
	float x = dot(N, V);
	vec3 tangent = V - N * x;
	vec3 v = cross(N, abs(N.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0));
	vec3 x2 = normalize(dot(tangent, tangent) < 1e-08 ? v : tangent);
	float NV = clamp(x, 0.0001, 1.0);
	vec3 v2 = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
	vec3 wide = vec3(0.040000003, 0.040000003, 1.0) * v2;
	float stretched = length(wide);
	vec3 s = wide / stretched;
	float count = float(u_envRadianceSamples);
	float descent = (s.z + 1.0) / count;
	float reach = NV + stretched;
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(count / (0.010053097 * reach));
	mat3 frame = mat3(u_envMatrix) * mat3(x2, cross(N, x2), N);
	vec2 azimuth = vec2(1, 0);
	float total = 1e-08;
	vec3 light = vec3(0);
	vec3 share = vec3(0);
	for (int i = 0; i < u_envRadianceSamples; i++)
	{
		float z = 1.0 - descent * (float(i) + 0.5);
		vec3 h = s + vec3(azimuth * sqrt(1.0 - z * z), z);
		vec3 slope = vec3(0.040000003, 0.040000003, 1.0) * h;
		vec3 H = normalize(slope);
		vec3 L = reflect(-v2, H);
		float NL = max(L.z, 0.0);
		float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, 0.0016000002)));
		float x3 = dot(v2, H);
		float u = sqrt(max(x3 * x3 + 1.25, 0.0));
		float p = u / 2.25;
		float rs = (x3 - u) / (x3 + u);
		float rp = (x3 - p) / (x3 + p);
		float F = weight * (0.5 * (rs * rs + rp * rp));
		vec3 d = frame * L;
		float x4 = dot(slope, slope) / dot(h, h);
		float r2 = x4 * x4;
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
	vec3 scaled = vd.positionObject * veins_scale;
	int k = hash_mix(int(floor(scaled.x)) - 559038712, int(floor(scaled.y)) - 559038712, int(floor(scaled.z)) - 559038712);
	float stripe = sin(fractal_3d(scaled, veins_octaves) + 2.3283064e-10 * (65536.0 * float(int(uint(k) >> 16)) + float(k & 65535)));
	vec3 normal = normalize(vd.normalWorld);
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 N = faceforward(normal, -V, normal);
	vec3 specular_albedo;
	vec3 specular = microfacet_light(N, V, specular_albedo);
	vec3 diffuse = max(mix(out_color_bg, out_color_fg, stripe), 0.0) * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
	out1 = vec4((specular + (1.0 - specular_albedo) * diffuse) * u_envLightIntensity, 1.0);
}
