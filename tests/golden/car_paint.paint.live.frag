#version 400

// paint

uniform vec3 u_viewPosition = vec3(0);
uniform mat4 u_envMatrix = mat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform float paint_shader_base = 0.6;
uniform vec3 paint_shader_base_color = vec3(0.5, 0.03, 0.02);
uniform float paint_shader_metalness = 0.4;
uniform float paint_shader_specular_roughness = 0.35;
uniform float paint_shader_specular_anisotropy = 0.5;
uniform float paint_shader_specular_rotation = 0.25;
uniform float paint_shader_coat = 0.9;
uniform vec3 paint_shader_coat_color = vec3(1.0, 0.95, 0.9);
uniform float paint_shader_coat_roughness = 0.05;
uniform float paint_shader_coat_anisotropy = 0.3;
uniform float paint_shader_coat_rotation = 0.1;
uniform float paint_shader_coat_affect_roughness = 0.2;

in VertexData
{
	vec3 positionWorld;
	vec3 normalWorld;
	vec3 tangentWorld;
} vd;

out vec4 out1;

// GGX roughness along and across the tangent.
vec2 roughness_anisotropy(float roughness, float anisotropy)
{
	float alpha = roughness * roughness;
	float aspect = sqrt(1.0 - clamp(anisotropy, 0.0, 0.98));
	vec2 p = vec2(min(alpha / aspect, 1.0), alpha * aspect);
	return 0.0 < anisotropy ? p : vec2(alpha);
}

// Turns a vector about an axis by an angle in degrees (Rodrigues' formula).
vec3 rotate_about(vec3 v, float degrees2, vec3 axis)
{
	vec3 a = axis * inversesqrt(max(dot(axis, axis), 1e-37));
	float angle = radians(degrees2);
	float cosine = cos(angle);
	return v * cosine + cross(v, a) * sin(angle) + a * (dot(v, a) * (1.0 - cosine));
}

// Reads a latitude-longitude map: v = 0 is the zenith, u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d, float level)
{
	return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0))), level).xyz;
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light(vec2 roughness, vec3 N, vec3 V, vec3 X, out vec3 albedo)
{
	bool isotropic = roughness.x == roughness.y;
	vec3 tangent = isotropic ? V : X;
	vec3 tangent2 = tangent - N * dot(N, tangent);
	vec3 v = cross(N, abs(N.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0));
	vec3 x = normalize(dot(tangent2, tangent2) < 1e-08 ? v : tangent2);
	vec3 y = cross(N, x);
	float NV = clamp(dot(N, V), 0.0001, 1.0);
	vec2 p = clamp(roughness, 0.0001, 1.0);
	vec3 alpha = vec3(p, 1.0);
	float x2 = NV * NV;
	vec3 v2 = vec3(dot(V, x), dot(V, y), NV);
	vec3 wide = alpha * v2;
	float stretched = length(wide);
	vec3 s = wide / stretched;
	float mean = sqrt(p.x * p.y);
	float x3 = mean * mean;
	float toView = sqrt(mix(x2, 1.0, x3));
	float count = float(u_envRadianceSamples);
	float descent = (s.z + 1.0) / count;
	float reach = NV + stretched;
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(count / (reach * (p.y * (6.2831855 * p.x))));
	mat3 frame = mat3(u_envMatrix) * mat3(x, y, N);
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
		float weight = NL / (toView * NL + NV * sqrt(mix(NL * NL, 1.0, x3)));
		float x4 = dot(v2, H);
		float u = sqrt(max(x4 * x4 + 1.25, 0.0));
		float p2 = u / 2.25;
		float rs = (x4 - u) / (x4 + u);
		float rp = (x4 - p2) / (x4 + p2);
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
	float E = min(reach * total / count, 1.0);
	vec3 once = share / total;
	float lost = 0.218505 - 0.207071 * NV + mean * (1.3982 * NV + 2.44659 * mean);
	float x6 = clamp(1.0 - NV * mean / (x2 + x3 * (3.68834 * NV + 0.792037)) * lost, 0.01, 1.0);
	float white = isotropic ? E : x6;
	vec3 kept = mix(once, vec3(1), white) * min(E / white, 1.0);
	albedo = once * kept;
	return light * (kept / total);
}

// Reflectance of a conductor of index n + ik for unpolarised light.
vec3 fresnel_conductor(float c, vec3 n, vec3 k)
{
	float c2 = c * c;
	float s2 = 1.0 - c2;
	vec3 t = n * n - k * k - s2;
	vec3 m = sqrt(t * t + k * (k * (n * (4.0 * n))));
	vec3 a = 2.0 * c * sqrt(max(0.5 * (t + m), 0.0));
	vec3 b = c2 + m;
	vec3 d = c2 * m + s2 * s2;
	vec3 v = s2 * a;
	return 0.5 * ((b - a) / (a + b)) * ((d - v) / (d + v) + 1.0);
}

// The environment's light in a GGX lobe, by samples of visible normals.
vec3 microfacet_light2(vec2 roughness, vec3 base, vec3 rise, vec3 bend, vec3 dip, vec3 N, vec3 V, vec3 X)
{
	bool isotropic = roughness.x == roughness.y;
	vec3 tangent = isotropic ? V : X;
	vec3 tangent2 = tangent - N * dot(N, tangent);
	vec3 v = cross(N, abs(N.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0));
	vec3 x = normalize(dot(tangent2, tangent2) < 1e-08 ? v : tangent2);
	vec3 y = cross(N, x);
	float NV = clamp(dot(N, V), 0.0001, 1.0);
	vec2 p = clamp(roughness, 0.0001, 1.0);
	vec3 alpha = vec3(p, 1.0);
	float x2 = NV * NV;
	vec3 v2 = vec3(dot(V, x), dot(V, y), NV);
	vec3 wide = alpha * v2;
	float stretched = length(wide);
	vec3 s = wide / stretched;
	float mean = sqrt(p.x * p.y);
	float x3 = mean * mean;
	float toView = sqrt(mix(x2, 1.0, x3));
	float count = float(u_envRadianceSamples);
	float descent = (s.z + 1.0) / count;
	float reach = NV + stretched;
	float level = float(u_envRadianceMips) - 2.5 - 0.5 * log2(count / (reach * (p.y * (6.2831855 * p.x))));
	mat3 frame = mat3(u_envMatrix) * mat3(x, y, N);
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
		float weight = NL / (toView * NL + NV * sqrt(mix(NL * NL, 1.0, x3)));
		float x4 = dot(v2, H);
		float t = max(1.0 - x4, 0.0);
		float t2 = t * t;
		float t4 = t2 * t2;
		vec3 F = weight * clamp(base + rise * (t * t4) + (bend + dip * t4) * (x4 * t2), 0.0, 1.0);
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
	float E = min(reach * total / count, 1.0);
	float lost = 0.218505 - 0.207071 * NV + mean * (1.3982 * NV + 2.44659 * mean);
	float x6 = clamp(1.0 - NV * mean / (x2 + x3 * (3.68834 * NV + 0.792037)) * lost, 0.01, 1.0);
	float white = isotropic ? E : x6;
	return light * (mix(share / total, vec3(1), white) * min(E / white, 1.0) / total);
}

void main()
{
	vec3 normal = normalize(vd.normalWorld);
	vec3 v = normalize(vd.tangentWorld);
	vec2 coat_alpha = roughness_anisotropy(paint_shader_coat_roughness, paint_shader_coat_anisotropy);
	vec3 coat_turned = rotate_about(v, 360.0 * paint_shader_coat_rotation, normal);
	vec3 r = clamp(paint_shader_base * paint_shader_base_color, 0.0, 0.99);
	vec3 v2 = 1.0 - r;
	vec3 metal_index_ior = v2 / (r + 1.0);
	vec3 above = metal_index_ior + 1.0;
	vec3 below = metal_index_ior - 1.0;
	vec3 v3 = above * above;
	vec3 metal_index_extinction = sqrt(max((r * v3 - below * below) / v2, 0.0));
	float coat_blur = paint_shader_coat_roughness * (paint_shader_coat * paint_shader_coat_affect_roughness);
	vec2 specular_alpha = roughness_anisotropy(mix(paint_shader_specular_roughness, 1.0, coat_blur), paint_shader_specular_anisotropy);
	vec3 specular_turned = rotate_about(v, 360.0 * paint_shader_specular_rotation, normal);
	vec3 specular_tangent = 0.0 < paint_shader_specular_anisotropy ? specular_turned : v;
	vec3 V = normalize(u_viewPosition - vd.positionWorld);
	vec3 N = faceforward(normal, -V, normal);
	vec3 coat_albedo;
	vec3 coat = microfacet_light(coat_alpha, N, V, 0.0 < paint_shader_coat_anisotropy ? coat_turned : v, coat_albedo);
	vec3 v4 = mix(vec3(1), paint_shader_coat_color, paint_shader_coat) * (1.0 - paint_shader_coat * coat_albedo);
	vec3 v5 = v4 * (1.0 - paint_shader_metalness);
	vec3 specular_albedo;
	vec3 specular = microfacet_light(specular_alpha, N, V, specular_tangent, specular_albedo);
	vec3 diffuse = max(paint_shader_base_color, 0.0) * environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
	vec3 v6 = 1.0 - metal_index_ior;
	vec3 v7 = metal_index_extinction * metal_index_extinction;
	vec3 base = (v6 * v6 + v7) / max(v3 + v7, 1e-12);
	vec3 rise = 1.0 - base;
	vec3 more60 = fresnel_conductor(0.5, metal_index_ior, metal_index_extinction) - base - 0.03125 * rise;
	vec3 more82 = fresnel_conductor(0.14285715, metal_index_ior, metal_index_extinction) - base - 0.46266437 * rise;
	vec3 bend = 9.047614 * more60 - 1.247679 * more82;
	vec3 metal = microfacet_light2(specular_alpha, base, rise, bend, 19.962864 * more82 - 16.761822 * more60, N, V, specular_tangent);
	vec3 v8 = paint_shader_base * (v5 * (1.0 - specular_albedo)) * diffuse + v5 * specular;
	vec3 v9 = (v8 + paint_shader_metalness * v4 * metal + paint_shader_coat * coat) * u_envLightIntensity;
	out1 = vec4(v9, 1.0);
}
