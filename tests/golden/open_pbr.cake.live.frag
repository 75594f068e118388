#version 400

// cake

uniform vec3 u_viewPosition = vec3(0.0);
uniform mat4 u_envMatrix = mat4(-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform vec3 layered_base_color = vec3(0.6, 0.3, 0.1);
uniform float layered_base_metalness = 0.4;
uniform float layered_specular_roughness = 0.35;
uniform float layered_fuzz_weight = 0.3;
uniform float layered_coat_weight = 0.7;
uniform vec3 layered_coat_color = vec3(1.0, 0.9, 0.8);
uniform float layered_thin_film_weight = 0.5;
uniform float layered_thin_film_thickness = 0.4;
uniform float layered_emission_luminance = 0.2;

in VertexData
{
    vec3 positionWorld;
    vec3 normalWorld;
} vd;

out vec4 out1;

// Reads a latitude-longitude map in the direction d. v = 0 is the zenith; u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d, float level)
{
    float v = 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0));
    return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, v), level).xyz;
}

// The frame in which roughness is given.
vec3 microfacet_frame(vec3 N, vec3 V, out vec3 y)
{
    vec3 tangent = V - N * dot(N, V);
    vec3 other = abs(N.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 x = normalize(dot(tangent, tangent) < 1e-08 ? cross(N, other) : tangent);
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

// Reflectance of a dielectric for unpolarised light; exact, 1 where reflection is total.
float fresnel_dielectric(float c, float ior)
{
    float n2 = max(ior * ior, 0.0001);
    float u = sqrt(max(n2 - 1.0 + c * c, 0.0));
    float p = u / n2;
    float rs = (c - u) / (c + u);
    float rp = (c - p) / (c + p);
    return 0.5 * (rs * rs + rp * rp);
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

// Light that n visible normals mirror from the environment, or refract from it (microfacet_refraction).
vec3 microfacet_light(float roughness, float ior, vec3 N, vec3 V, out vec3 albedo)
{
    vec3 y;
    vec3 x = microfacet_frame(N, V, y);
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    float mean = clamp(roughness, 0.0001, 1.0);
    vec3 alpha = vec3(mean, mean, 1.0);
    vec3 v = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
    vec3 wide = alpha * v;
    float stretched = length(wide);
    vec3 s = wide / stretched;
    float x2 = mean * mean;
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
        float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, x2)));
        float F = weight * fresnel_dielectric(dot(v, H), ior);
        azimuth = -0.7373689 * azimuth + vec2(-0.6754903, 0.6754903) * azimuth.yx;
        total += weight;
        light += F * microfacet_lookup(frame * L, level, dot(slope, slope) / dot(h, h));
        share += F;
    }
    vec3 once = share / total;
    vec3 bounces = mix(once, vec3(1.0), min(reach * total / count, 1.0));
    albedo = once * bounces;
    return light * (bounces / total);
}

// Reflectance at an interface of admittance u + iw.
vec3 fresnel_reflectance(float c, vec3 u, vec3 w)
{
    vec3 v = c - u;
    vec3 v2 = w * w;
    vec3 v3 = c + u;
    return (v * v + v2) / max(v2 + v3 * v3, 1e-12);
}

// Response of the eye to interference of one order, as XYZ (Belcour and Barla 2017, eq. 10 and their numbers).
vec3 interference(float phase, vec3 shift)
{
    vec3 v = vec3(9.04581e-08, 1.068737e-07, 1.069699e-07) * cos(shift + vec3(1681000.0, 1795300.0, 2208400.0) * phase);
    vec3 v2 = vec3(1.644e-08 * cos(2239900.0 * phase + shift.x) * exp(phase * (-4528200000.0 * phase)), 0.0, 0.0);
    return 9358910.0 * (v * exp(phase * (vec3(-4327800000.0, -9304600000.0, -6612100000.0) * phase)) + v2);
}

// Reflectance of a thin film over an interface to n + ik (Belcour and Barla 2017, eq. 8).
vec3 fresnel_thin_film(float c, float n, float thickness)
{
    float inside = sqrt(1.0 - (1.0 - c * c) / 1.9599999);
    float phase = inside * (1.7592917e-08 * thickness);
    float x = n / 1.4;
    float re = x * x;
    float x2 = inside * inside;
    float t = re - (1.0 - x2);
    vec3 m = sqrt(vec3(t * t));
    vec3 u = sqrt(max(0.5 * (t + m), 0.0));
    vec3 w = sqrt(max(0.5 * (m - t), 0.0));
    float scale = 1.0 / max(re * re, 1e-12);
    vec3 up = scale * (re * u);
    vec3 wp = scale * (re * w);
    float x3 = 1.4 * inside;
    float x4 = inside / 1.4;
    float x5 = -2.0 * inside;
    vec3 u2 = u;
    vec3 w2 = w;
    vec3 sum = vec3(0.0);
    for (int p = 0; p < 2; p++)
    {
        float y = p == 0 ? x3 : x4;
        float r = (c - y) / (c + y);
        float R12 = r * r;
        float T = 1.0 - R12;
        vec3 R23 = fresnel_reflectance(inside, u2, w2);
        vec3 v = atan(w2 * x5, x2 - u2 * u2 - w2 * w2);
        vec3 shift = v + (0.0 < r ? 3.1415927 : 0.0);
        vec3 R123 = R12 * R23;
        vec3 steady = R23 * (T * T) / (1.0 - R123);
        vec3 R123_2 = sqrt(R123);
        vec3 sum2 = sum + R12 + steady;
        vec3 wave = steady - T;
        for (int i = 0; i < 2; i++)
        {
            vec3 wave2 = R123_2 * wave;
            float x6 = float(i + 1);
            sum2 += 2.0 * wave2 * interference(phase * x6, shift * x6);
            wave = wave2;
        }
        u2 = up;
        w2 = wp;
        sum = sum2;
    }
    vec3 v2 = mat3(2.3706744, -0.513885, 0.0052982, -0.9000405, 1.4253036, -0.0146949, -0.4706338, 0.0885814, 1.0093968) * sum;
    return clamp(0.5 * v2, 0.0, 1.0);
}

// Light that n visible normals mirror from the environment, or refract from it (microfacet_refraction).
vec3 microfacet_light2(float roughness, float ior, vec3 base, vec3 rise, vec3 N, vec3 V, out vec3 albedo)
{
    vec3 y;
    vec3 x = microfacet_frame(N, V, y);
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    float mean = clamp(roughness, 0.0001, 1.0);
    vec3 alpha = vec3(mean, mean, 1.0);
    vec3 v = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
    vec3 wide = alpha * v;
    float stretched = length(wide);
    vec3 s = wide / stretched;
    float x2 = mean * mean;
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
        float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, x2)));
        vec3 F = weight * (base + rise * fresnel_dielectric(dot(v, H), ior));
        azimuth = -0.7373689 * azimuth + vec2(-0.6754903, 0.6754903) * azimuth.yx;
        total += weight;
        light += F * microfacet_lookup(frame * L, level, dot(slope, slope) / dot(h, h));
        share += F;
    }
    vec3 once = share / total;
    vec3 bounces = mix(once, vec3(1.0), min(reach * total / count, 1.0));
    albedo = once * bounces;
    return light * (bounces / total);
}

// Light that n visible normals mirror from the environment, or refract from it (microfacet_refraction).
vec3 microfacet_light3(float roughness, vec3 base, vec3 rise, vec3 N, vec3 V)
{
    vec3 y;
    vec3 x = microfacet_frame(N, V, y);
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    float mean = clamp(roughness, 0.0001, 1.0);
    vec3 alpha = vec3(mean, mean, 1.0);
    vec3 v = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
    vec3 wide = alpha * v;
    float stretched = length(wide);
    vec3 s = wide / stretched;
    float x2 = mean * mean;
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
        float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, x2)));
        float t = max(1.0 - dot(v, H), 0.0);
        float t2 = t * t;
        vec3 F = weight * clamp(base + rise * (t * (t2 * t2)), 0.0, 1.0);
        azimuth = -0.7373689 * azimuth + vec2(-0.6754903, 0.6754903) * azimuth.yx;
        total += weight;
        light += F * microfacet_lookup(frame * L, level, dot(slope, slope) / dot(h, h));
        share += F;
    }
    vec3 bounces = mix(share / total, vec3(1.0), min(reach * total / count, 1.0));
    return light * (bounces / total);
}

// Reflectance of a thin film over an interface to n + ik (Belcour and Barla 2017, eq. 8).
vec3 fresnel_thin_film2(float c, vec3 n, float thickness)
{
    float inside = sqrt(1.0 - (1.0 - c * c) / 1.9599999);
    float phase = inside * (1.7592917e-08 * thickness);
    vec3 v = n / 1.4;
    vec3 re = v * v;
    float x = inside * inside;
    vec3 t = re - (1.0 - x);
    vec3 m = sqrt(t * t);
    vec3 u = sqrt(max(0.5 * (t + m), 0.0));
    vec3 w = sqrt(max(0.5 * (m - t), 0.0));
    vec3 scale = 1.0 / max(re * re, 1e-12);
    vec3 up = scale * (re * u);
    vec3 wp = scale * (re * w);
    float x2 = 1.4 * inside;
    float x3 = inside / 1.4;
    float x4 = -2.0 * inside;
    vec3 u2 = u;
    vec3 w2 = w;
    vec3 sum = vec3(0.0);
    for (int p = 0; p < 2; p++)
    {
        float y = p == 0 ? x2 : x3;
        float r = (c - y) / (c + y);
        float R12 = r * r;
        float T = 1.0 - R12;
        vec3 R23 = fresnel_reflectance(inside, u2, w2);
        vec3 v2 = atan(w2 * x4, x - u2 * u2 - w2 * w2);
        vec3 shift = v2 + (0.0 < r ? 3.1415927 : 0.0);
        vec3 R123 = R12 * R23;
        vec3 steady = R23 * (T * T) / (1.0 - R123);
        vec3 R123_2 = sqrt(R123);
        vec3 sum2 = sum + R12 + steady;
        vec3 wave = steady - T;
        for (int i = 0; i < 2; i++)
        {
            vec3 wave2 = R123_2 * wave;
            float x5 = float(i + 1);
            sum2 += 2.0 * wave2 * interference(phase * x5, shift * x5);
            wave = wave2;
        }
        u2 = up;
        w2 = wp;
        sum = sum2;
    }
    vec3 v3 = mat3(2.3706744, -0.513885, 0.0052982, -0.9000405, 1.4253036, -0.0146949, -0.4706338, 0.0885814, 1.0093968) * sum;
    return clamp(0.5 * v3, 0.0, 1.0);
}

void main()
{
    vec3 normal = normalize(vd.normalWorld);
    float base = layered_specular_roughness * layered_specular_roughness;
    float specular_roughness_coated = mix(layered_specular_roughness, sqrt(sqrt(min(base * base, 1.0))), layered_coat_weight);
    float alpha = specular_roughness_coated * specular_roughness_coated;
    float film_nanometers = 1000.0 * layered_thin_film_thickness;
    float index = mix(1.5, 1.0666667, layered_coat_weight);
    float amplitude = (index - 1.0) / (index + 1.0);
    float weighted = sign(amplitude) * sqrt(clamp(amplitude * amplitude, 0.0, 0.99999));
    float specular_index = (weighted + 1.0) / (1.0 - weighted);
    vec3 v = 0.3698225 / (1.0 - 0.6301775 * layered_base_color);
    vec3 coat_darkened = mix(vec3(1.0), v, layered_coat_weight);
    vec3 coat_passed = coat_darkened * mix(vec3(1.0), layered_coat_color, layered_coat_weight);
    vec3 V = normalize(u_viewPosition - vd.positionWorld);
    vec3 N = faceforward(normal, -V, normal);
    float NV = clamp(dot(V, N), 0.0001, 1.0);
    float share = exp(-(NV * (0.68819004 * NV + 0.5534177) + 0.09856644) / (0.5 * (0.102330275 * NV + 0.5353364)));
    vec3 v2 = environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
    float passed = 1.0 - layered_fuzz_weight * share;
    vec3 coat_lobe_albedo;
    vec3 coat_lobe = microfacet_light(0.0, 1.6, N, V, coat_lobe_albedo);
    vec3 v3 = coat_passed * (passed * (1.0 - layered_coat_weight * coat_lobe_albedo));
    vec3 v4 = v3 * (1.0 - layered_base_metalness);
    vec3 v5 = layered_base_metalness * v3;
    bool test = 0.0 < film_nanometers;
    vec3 base2 = fresnel_thin_film(NV, specular_index, film_nanometers);
    vec3 base3 = test ? base2 : vec3(0.0);
    vec3 rise = test ? vec3(0.0) : vec3(1.0);
    vec3 specular_film_albedo;
    vec3 specular_film = microfacet_light2(alpha, specular_index, base3, rise, N, V, specular_film_albedo);
    vec3 specular_plain_albedo;
    vec3 specular_plain = microfacet_light(alpha, specular_index, N, V, specular_plain_albedo);
    vec3 passed2 = v4 * mix(1.0 - specular_plain_albedo, 1.0 - specular_film_albedo, layered_thin_film_weight);
    float x = 1.0 - layered_thin_film_weight;
    vec3 rise2 = 1.0 - layered_base_color;
    vec3 root = sqrt(clamp(layered_base_color, 0.0, 0.99));
    vec3 base4 = fresnel_thin_film2(NV, (root + 1.0) / (1.0 - root), film_nanometers);
    vec3 rise3 = test ? vec3(0.0) : rise2;
    vec3 metal_film = microfacet_light3(alpha, test ? base4 : layered_base_color, rise3, N, V);
    vec3 v6 = passed2 * (max(layered_base_color, 0.0) * v2) + specular_plain * (v4 * x);
    vec3 v7 = v5 * x * microfacet_light3(alpha, layered_base_color, rise2, N, V);
    vec3 v8 = v6 + specular_film * (layered_thin_film_weight * v4) + v7;
    vec3 v9 = v8 + layered_thin_film_weight * v5 * metal_film;
    vec3 v10 = v9 + coat_lobe * (layered_coat_weight * passed);
    vec3 v11 = (v10 + layered_fuzz_weight * (share * v2)) * u_envLightIntensity;
    vec3 v12 = layered_coat_color * (layered_coat_weight * (0.9467456 * (1.0 - pow(1.0 - abs(dot(normal, V)), 5.0))));
    vec3 v13 = v11 + layered_emission_luminance * (1.0 - layered_coat_weight + v12);
    out1 = vec4(v13, 1.0);
}
