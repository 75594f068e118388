#version 400

// paint

uniform vec3 u_viewPosition = vec3(0.0);
uniform mat4 u_envMatrix = mat4(-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
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
    return 0.0 < anisotropy ? vec2(min(alpha / aspect, 1.0), alpha * aspect) : vec2(alpha);
}

// Turns a vector about an axis by an angle in degrees (Rodrigues' formula).
vec3 rotate_about(vec3 v, float degrees2, vec3 axis)
{
    vec3 a = normalize(axis);
    float angle = radians(degrees2);
    float cosine = cos(angle);
    return v * cosine + cross(v, a) * sin(angle) + a * (dot(v, a) * (1.0 - cosine));
}

// The frame in which roughness is given.
vec3 microfacet_frame(vec2 roughness, vec3 N, vec3 V, vec3 X, out vec3 y)
{
    vec3 tangent = roughness.x == roughness.y ? V : X;
    vec3 tangent2 = tangent - N * dot(N, tangent);
    vec3 other = abs(N.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 x = normalize(dot(tangent2, tangent2) < 1e-08 ? cross(N, other) : tangent2);
    y = cross(N, x);
    return x;
}

// The level of detail of samples, but for what differs from one to the next.
float microfacet_level(vec3 alpha, float reach)
{
    float x = 0.5 * log2(float(u_envRadianceSamples) / (reach * (6.2831855 * alpha.x * alpha.y)));
    return float(u_envRadianceMips) - 2.5 - x;
}

// Direction number i over the cap of visible normals (Dupuy and Benyoub 2023, algorithm 2).
vec3 microfacet_cap(int i, vec2 azimuth, float descent, vec3 s)
{
    float z = 1.0 - descent * (float(i) + 0.5);
    return s + vec3(azimuth * sqrt(1.0 - z * z), z);
}

// Reads a latitude-longitude map in the direction d. v = 0 is the zenith; u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d, float level)
{
    float v = 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0));
    return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, v), level).xyz;
}

// Light from the direction d of the map, at the level for its sample.
vec3 microfacet_lookup(vec3 d, float level, float ratio)
{
    float r2 = ratio * ratio;
    float best = max(level - 0.25 * log2(r2 * r2 * (1.00001 - d.y * d.y)), 0.0);
    float whole = floor(best);
    float level2 = whole + clamp(32.0 * (best - whole) - 15.5, 0.0, 1.0);
    return environment_lookup(u_envRadiance, d, level2);
}

// E: what white GGX reflects in one bounce to a view at cosine NV. Fitted by tools/fit to E by quadrature.
float microfacet_white(float NV, float alpha)
{
    float scale = NV * alpha / (NV * NV + alpha * alpha * (4.4736 * NV + 0.669338));
    float x = alpha * (NV * (0.427862 * NV + 1.88316) + 0.0766197 + alpha * (2.18724 - 0.015081 * NV));
    return clamp(1.0 - scale * (NV * (0.0677313 - 0.519049 * NV) + 0.179275 + x), 0.01, 1.0);
}

// Light that n visible normals mirror from the environment, or refract from it (microfacet_refraction).
vec3 microfacet_light(vec2 roughness, vec3 N, vec3 V, vec3 X, out vec3 albedo)
{
    bool isotropic = roughness.x == roughness.y;
    vec3 y;
    vec3 x = microfacet_frame(roughness, N, V, X, y);
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    float x2 = clamp(roughness.x, 0.0001, 1.0);
    float x3 = clamp(roughness.y, 0.0001, 1.0);
    vec3 alpha = vec3(x2, x3, 1.0);
    vec3 v = vec3(dot(V, x), dot(V, y), NV);
    vec3 wide = alpha * v;
    float stretched = length(wide);
    vec3 s = wide / stretched;
    float mean = sqrt(x2 * x3);
    float x4 = mean * mean;
    float toView = sqrt(mix(NV * NV, 1.0, x4));
    float count = float(u_envRadianceSamples);
    float descent = (s.z + 1.0) / count;
    float reach = NV + stretched;
    float level = microfacet_level(alpha, reach);
    mat3 frame = mat3(u_envMatrix) * mat3(x, y, N);
    vec2 azimuth = vec2(1.0, 0.0);
    float total = 1e-08;
    vec3 light = vec3(0.0);
    vec3 share = vec3(0.0);
    for (int i = 0; i < u_envRadianceSamples; i++)
    {
        vec3 h = microfacet_cap(i, azimuth, descent, s);
        vec3 slope = alpha * h;
        vec3 H = normalize(slope);
        vec3 L = reflect(-v, H);
        float NL = max(L.z, 0.0);
        float weight = NL / (toView * NL + NV * sqrt(mix(NL * NL, 1.0, x4)));
        float x5 = dot(v, H);
        float u = sqrt(max(x5 * x5 + 1.25, 0.0));
        float p = u / 2.25;
        float rs = (x5 - u) / (x5 + u);
        float rp = (x5 - p) / (x5 + p);
        float F = weight * (0.5 * (rs * rs + rp * rp));
        azimuth = -0.7373689 * azimuth + vec2(-0.6754903, 0.6754903) * azimuth.yx;
        total += weight;
        light += F * microfacet_lookup(frame * L, level, dot(slope, slope) / dot(h, h));
        share += F;
    }
    float E = min(reach * total / count, 1.0);
    vec3 once = share / total;
    float white = isotropic ? E : microfacet_white(NV, mean);
    vec3 bounces = mix(once, vec3(1.0), white) * (isotropic ? 1.0 : min(E / white, 1.0));
    albedo = once * bounces;
    return light * (bounces / total);
}

// Reflectance of a conductor of index n + ik for unpolarised light; exact for positive c. Written out, the squares of
// the amplitudes for p- and s-polarised light have a ratio that needs no further root.
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

// Light that n visible normals mirror from the environment, or refract from it (microfacet_refraction).
vec3 microfacet_light2(vec2 roughness, vec3 base, vec3 rise, vec3 bend, vec3 dip, vec3 N, vec3 V, vec3 X)
{
    bool isotropic = roughness.x == roughness.y;
    vec3 y;
    vec3 x = microfacet_frame(roughness, N, V, X, y);
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    float x2 = clamp(roughness.x, 0.0001, 1.0);
    float x3 = clamp(roughness.y, 0.0001, 1.0);
    vec3 alpha = vec3(x2, x3, 1.0);
    vec3 v = vec3(dot(V, x), dot(V, y), NV);
    vec3 wide = alpha * v;
    float stretched = length(wide);
    vec3 s = wide / stretched;
    float mean = sqrt(x2 * x3);
    float x4 = mean * mean;
    float toView = sqrt(mix(NV * NV, 1.0, x4));
    float count = float(u_envRadianceSamples);
    float descent = (s.z + 1.0) / count;
    float reach = NV + stretched;
    float level = microfacet_level(alpha, reach);
    mat3 frame = mat3(u_envMatrix) * mat3(x, y, N);
    vec2 azimuth = vec2(1.0, 0.0);
    float total = 1e-08;
    vec3 light = vec3(0.0);
    vec3 share = vec3(0.0);
    for (int i = 0; i < u_envRadianceSamples; i++)
    {
        vec3 h = microfacet_cap(i, azimuth, descent, s);
        vec3 slope = alpha * h;
        vec3 H = normalize(slope);
        vec3 L = reflect(-v, H);
        float NL = max(L.z, 0.0);
        float weight = NL / (toView * NL + NV * sqrt(mix(NL * NL, 1.0, x4)));
        float x5 = dot(v, H);
        float t = max(1.0 - x5, 0.0);
        float t2 = t * t;
        float t4 = t2 * t2;
        vec3 F = weight * clamp(base + rise * (t * t4) + (bend + dip * t4) * (x5 * t2), 0.0, 1.0);
        azimuth = -0.7373689 * azimuth + vec2(-0.6754903, 0.6754903) * azimuth.yx;
        total += weight;
        light += F * microfacet_lookup(frame * L, level, dot(slope, slope) / dot(h, h));
        share += F;
    }
    float E = min(reach * total / count, 1.0);
    float white = isotropic ? E : microfacet_white(NV, mean);
    vec3 v2 = mix(share / total, vec3(1.0), white);
    return light * (v2 * (isotropic ? 1.0 : min(E / white, 1.0)) / total);
}

void main()
{
    vec3 normal = normalize(vd.normalWorld);
    vec3 v = normalize(vd.tangentWorld);
    vec2 coat_alpha = roughness_anisotropy(paint_shader_coat_roughness, paint_shader_coat_anisotropy);
    vec3 coat_turned_unit = normalize(rotate_about(v, 360.0 * paint_shader_coat_rotation, normal));
    vec3 coat_tangent = 0.0 < paint_shader_coat_anisotropy ? coat_turned_unit : v;
    vec3 r = clamp(paint_shader_base * paint_shader_base_color, 0.0, 0.99);
    vec3 v2 = 1.0 - r;
    vec3 metal_index_ior = v2 / (r + 1.0);
    vec3 above = metal_index_ior + 1.0;
    vec3 below = metal_index_ior - 1.0;
    vec3 v3 = above * above;
    vec3 metal_index_extinction = sqrt(max((r * v3 - below * below) / v2, 0.0));
    float coat_blur = paint_shader_coat_roughness * (paint_shader_coat * paint_shader_coat_affect_roughness);
    float specular_blurred = mix(paint_shader_specular_roughness, 1.0, coat_blur);
    vec2 specular_alpha = roughness_anisotropy(specular_blurred, paint_shader_specular_anisotropy);
    vec3 specular_turned_unit = normalize(rotate_about(v, 360.0 * paint_shader_specular_rotation, normal));
    vec3 specular_tangent = 0.0 < paint_shader_specular_anisotropy ? specular_turned_unit : v;
    vec3 coat_tint = mix(vec3(1.0), paint_shader_coat_color, paint_shader_coat);
    vec3 V = normalize(u_viewPosition - vd.positionWorld);
    vec3 N = faceforward(normal, -V, normal);
    vec3 coat_lobe_albedo;
    vec3 coat_lobe = microfacet_light(coat_alpha, N, V, coat_tangent, coat_lobe_albedo);
    vec3 v4 = coat_tint * (1.0 - paint_shader_coat * coat_lobe_albedo);
    vec3 v5 = v4 * (1.0 - paint_shader_metalness);
    vec3 specular_lobe_albedo;
    vec3 specular_lobe = microfacet_light(specular_alpha, N, V, specular_tangent, specular_lobe_albedo);
    vec3 v6 = environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
    vec3 v7 = 1.0 - metal_index_ior;
    vec3 v8 = metal_index_extinction * metal_index_extinction;
    vec3 base = (v7 * v7 + v8) / max(v3 + v8, 1e-12);
    vec3 rise = 1.0 - base;
    vec3 v9 = fresnel_conductor(0.5, metal_index_ior, metal_index_extinction) - base;
    vec3 more60 = v9 - 0.03125 * rise;
    vec3 v10 = fresnel_conductor(0.14285715, metal_index_ior, metal_index_extinction) - base;
    vec3 more82 = v10 - 0.46266437 * rise;
    vec3 bend = 9.047614 * more60 - 1.247679 * more82;
    vec3 dip = 19.962864 * more82 - 16.761822 * more60;
    vec3 metal = microfacet_light2(specular_alpha, base, rise, bend, dip, N, V, specular_tangent);
    vec3 v11 = paint_shader_base * (v5 * (1.0 - specular_lobe_albedo)) * (max(paint_shader_base_color, 0.0) * v6);
    vec3 v12 = v11 + v5 * specular_lobe + paint_shader_metalness * v4 * metal;
    out1 = vec4((v12 + paint_shader_coat * coat_lobe) * u_envLightIntensity, 1.0);
}
