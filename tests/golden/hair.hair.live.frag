#version 400

// hair

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;

uniform float roughness_longitudinal = 0.3;
uniform float roughness_azimuthal = 0.4;
uniform float melanin_melanin_concentration = 0.6;
uniform float melanin_melanin_redness = 0.2;
uniform float fibre_cuticle_angle = 0.48;

in VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
	vec3 tangentWorld;
} vd;

out vec4 out1;

// A fibre as it is seen: x along it, y across it; the sine of the view's inclination; the azimuth of the view, from y
// towards N; the azimuths between the normal and the view, outside and refracted.
vec3 hair_frame(vec3 N, vec3 V, vec3 curve_direction, out vec3 y, out float sine, out float azimuth, out float outside, out float inside)
{
	vec3 along = curve_direction - N * dot(N, curve_direction);
	vec3 v = cross(N, abs(N.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0));
	vec3 x = normalize(dot(along, along) < 1e-08 ? v : along);
	vec3 y2 = cross(N, x);
	float sine2 = clamp(dot(V, x), -1.0, 1.0);
	float x2 = sine2 * sine2;
	float cosine = sqrt(max(1.0 - x2, 1e-08));
	float x3 = dot(V, y2);
	float offset = clamp(-x3 / cosine, -1.0, 1.0);
	y = y2;
	sine = sine2;
	azimuth = atan(dot(N, V), x3);
	outside = asin(offset);
	inside = asin(clamp(offset / (sqrt(max(2.4025 - x2, 0.0001)) / cosine), -1.0, 1.0));
	return x;
}

// What is left of the light in each lobe; their sum is 1 where nothing is absorbed.
vec3 hair_shares(vec3 absorption, float sine, float outside, float inside, out vec3 TT, out vec3 TRT, out vec3 rest)
{
	float x = max(sqrt(max(1.0 - sine * sine, 0.0)) * cos(outside), 0.0001);
	float u = sqrt(max(x * x + 1.4024999, 0.0));
	float p = u / 2.4025;
	float rs = (x - u) / (x + u);
	float rp = (x - p) / (x + p);
	float mirrored = clamp(0.5 * (rs * rs + rp * rp), 0.0, 0.9999);
	float steep = sine / 1.55;
	vec3 passed = exp(2.0 * cos(inside) / sqrt(max(1.0 - steep * steep, 0.0001)) * -max(absorption, 0.0));
	float entered = 1.0 - mirrored;
	vec3 TT2 = passed * (entered * entered);
	vec3 TRT2 = mirrored * (passed * TT2);
	TT = TT2;
	TRT = TRT2;
	rest = mirrored * (passed * TRT2) / (1.0 - mirrored * passed);
	return vec3(mirrored);
}

// A direction of light of a lobe for three numbers in [0, 1]: the fibre's coordinates, sine of the inclination and
// azimuth from the view.
vec2 hair_direction(vec3 u, float sine, float cuticle_angle, float times, float middle, vec2 roughness)
{
	vec2 r = clamp(roughness, 0.001, 1.0);
	float tilt = 3.1415927 * times * (cuticle_angle - 0.5);
	float level = sqrt(max(1.0 - sine * sine, 0.0));
	float x = cos(tilt);
	float x2 = sin(tilt);
	float c = clamp(r.x * log(max(u.x + (1.0 - u.x) * exp(-2.0 / r.x), 1e-37)) + 1.0, -1.0, 1.0);
	float x3 = abs(level * x - sine * x2) * (sqrt(1.0 - c * c) * cos(6.2831855 * u.y));
	float scale = 0.62665707 * r.y;
	float cut = 1.0 / (exp(3.1415927 / scale) + 1.0);
	float p = clamp(cut + u.z * (1.0 - 2.0 * cut), 1e-07, 0.9999999);
	float x4 = clamp(x3 - clamp(sine * x + level * x2, -1.0, 1.0) * c, -1.0, 1.0);
	return vec2(x4, middle + scale * log(p / (1.0 - p)));
}

// Reads a latitude-longitude map: v = 0 is the zenith, u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d, float level)
{
	return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0))), level).xyz;
}

// The environment's light in the middle of a lobe's sample.
vec3 hair_seen(vec3 u, float sine, float cuticle_angle, float times, float middle, vec2 roughness, float azimuth, vec3 x, vec3 y, vec3 N)
{
	vec2 r = clamp(roughness, 0.001, 1.0);
	vec2 light = hair_direction(u, sine, cuticle_angle, times, middle, roughness);
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(0.05 * float(u_envRadianceSamples) / (r.y * sqrt(r.x)));
	float turn = azimuth + light.y;
	vec3 d = mat3(u_envMatrix) * (x * light.x + sqrt(max(1.0 - light.x * light.x, 0.0)) * (y * cos(turn) + N * sin(turn)));
	float best = max(level - 0.25 * log2(1.00001 - d.y * d.y), 0.0);
	float whole = floor(best);
	return environment_lookup(u_envRadiance, d, whole + clamp(32.0 * (best - whole) - 15.5, 0.0, 1.0));
}

// Light from around the fibre, as what is mirrored more than once inside leaves it: four directions of its ring.
vec3 hair_around(float sine, vec2 roughness, vec3 x, vec3 y, vec3 N)
{
	float x2 = clamp(roughness, 0.001, 1.0).x;
	float e = exp(-2.0 / x2);
	float mean = ((e + 1.0) / (1.0 - e) - x2) * -sine;
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(0.25 / sqrt(x2));
	vec3 v = x * mean;
	float x3 = sqrt(max(1.0 - mean * mean, 0.0));
	vec3 sum = vec3(0);
	for (int i = 0; i < 4; i++)
	{
		float turn = 1.5707964 * float(i) + 0.7853982;
		vec3 d = mat3(u_envMatrix) * (v + x3 * (y * cos(turn) + N * sin(turn)));
		float best = max(level - 0.25 * log2(1.00001 - d.y * d.y), 0.0);
		float whole = floor(best);
		vec3 v2 = environment_lookup(u_envRadiance, d, whole + clamp(32.0 * (best - whole) - 15.5, 0.0, 1.0));
		sum += v2;
	}
	return 0.25 * sum;
}

// Every lobe is sampled as its light is distributed, so that a white world is seen through what is left of the light,
// at any number of samples.
vec3 chiang_hair_bsdf_environment(vec2 roughness_R, vec2 roughness_TT, vec2 roughness_TRT, float cuticle_angle, vec3 absorption_coefficient, vec3 curve_direction, vec3 N, vec3 V)
{
	vec3 y;
	float sine;
	float azimuth;
	float outside;
	float inside;
	vec3 x = hair_frame(N, V, curve_direction, y, sine, azimuth, outside, inside);
	vec3 TT;
	vec3 TRT;
	vec3 rest;
	vec3 R = hair_shares(absorption_coefficient, sine, outside, inside, TT, TRT, rest);
	float x2 = float(u_envRadianceSamples);
	float x3 = 2.0 * inside + 3.1415927;
	float x4 = 2.0 * outside;
	float middle = x3 - x4;
	float middle2 = 2.0 * x3 - x4;
	vec3 mirrored = vec3(0);
	vec3 through = vec3(0);
	vec3 back = vec3(0);
	for (int i = 0; i < u_envRadianceSamples; i++)
	{
		float x5 = float(i);
		vec3 u = fract(vec3((x5 + 0.5) / x2, 0.7548777 * x5 + 0.5, 0.5698403 * x5 + 0.5));
		vec3 v = hair_seen(u, sine, cuticle_angle, 2.0, -x4, roughness_R, azimuth, x, y, N);
		mirrored += v;
		through += hair_seen(u, sine, cuticle_angle, -1.0, middle, roughness_TT, azimuth, x, y, N);
		back += hair_seen(u, sine, cuticle_angle, -4.0, middle2, roughness_TRT, azimuth, x, y, N);
	}
	vec3 v2 = (R * mirrored + TT * through + TRT * back) / x2;
	return v2 + rest * hair_around(sine, roughness_TRT, x, y, N);
}

void main()
{
	float l = clamp(roughness_longitudinal, 0.001, 1.0);
	float a = clamp(roughness_azimuthal, 0.001, 1.0);
	float deviation = 0.726 * l + l * (0.812 * l) + 3.7 * pow(l, 20.0);
	float variance = deviation * deviation;
	float spread = 0.265 * a + a * (1.194 * a) + 5.372 * pow(a, 22.0);
	vec2 roughness_roughness_R = vec2(variance, spread);
	vec2 roughness_roughness_TT = vec2(0.25 * variance, spread);
	vec2 roughness_roughness_TRT = vec2(4.0 * variance, spread);
	vec3 absorbed = mix(vec3(0.4190003, 0.69700056, 1.3699999), vec3(0.1869997, 0.4000001, 1.0499992), melanin_melanin_redness);
	vec3 melanin = max(-log(max(1.0 - melanin_melanin_concentration, 0.0001)) * absorbed, 0.0);
	vec3 normal = normalize(vd.normalWorld);
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 N = faceforward(normal, -V, normal);
	vec3 fibre = chiang_hair_bsdf_environment(roughness_roughness_R, roughness_roughness_TT, roughness_roughness_TRT, fibre_cuticle_angle, melanin, normalize(vd.tangentWorld), N, V);
	out1 = vec4(fibre * u_envLightIntensity, 1.0);
}
