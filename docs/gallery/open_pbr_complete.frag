#version 400

// Car_Paint

uniform vec3 u_viewPosition = vec3(0.0);
uniform mat4 u_envMatrix = mat4(-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform bool u_refractionTwoSided = false;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform float open_pbr_surface_surfaceshader_base_weight = 1.0;
uniform vec3 open_pbr_surface_surfaceshader_base_color = vec3(0.1, 0.6, 0.9);
uniform float open_pbr_surface_surfaceshader_base_diffuse_roughness = 0.0;
uniform float open_pbr_surface_surfaceshader_base_metalness = 0.0;
uniform float open_pbr_surface_surfaceshader_specular_weight = 1.0;
uniform vec3 open_pbr_surface_surfaceshader_specular_color = vec3(1.0);
uniform float open_pbr_surface_surfaceshader_specular_roughness = 0.3;
uniform float open_pbr_surface_surfaceshader_specular_ior = 1.6;
uniform float open_pbr_surface_surfaceshader_specular_roughness_anisotropy = 0.0;
uniform float open_pbr_surface_surfaceshader_transmission_weight = 0.0;
uniform vec3 open_pbr_surface_surfaceshader_transmission_color = vec3(1.0);
uniform float open_pbr_surface_surfaceshader_transmission_depth = 0.0;
uniform float open_pbr_surface_surfaceshader_subsurface_weight = 0.0;
uniform vec3 open_pbr_surface_surfaceshader_subsurface_color = vec3(0.8);
uniform float open_pbr_surface_surfaceshader_subsurface_scatter_anisotropy = 0.0;
uniform float open_pbr_surface_surfaceshader_fuzz_weight = 0.0;
uniform vec3 open_pbr_surface_surfaceshader_fuzz_color = vec3(1.0);
uniform float open_pbr_surface_surfaceshader_fuzz_roughness = 0.5;
uniform float open_pbr_surface_surfaceshader_coat_weight = 1.0;
uniform vec3 open_pbr_surface_surfaceshader_coat_color = vec3(1.0);
uniform float open_pbr_surface_surfaceshader_coat_roughness = 0.02;
uniform float open_pbr_surface_surfaceshader_coat_roughness_anisotropy = 0.0;
uniform float open_pbr_surface_surfaceshader_coat_ior = 1.6;
uniform float open_pbr_surface_surfaceshader_coat_darkening = 1.0;
uniform float open_pbr_surface_surfaceshader_thin_film_weight = 0.0;
uniform float open_pbr_surface_surfaceshader_thin_film_thickness = 0.5;
uniform float open_pbr_surface_surfaceshader_thin_film_ior = 1.4;
uniform float open_pbr_surface_surfaceshader_emission_luminance = 0.0;
uniform vec3 open_pbr_surface_surfaceshader_emission_color = vec3(1.0);
uniform float open_pbr_surface_surfaceshader_geometry_opacity = 1.0;
uniform bool open_pbr_surface_surfaceshader_geometry_thin_walled = false;

in VertexData
{
    vec3 positionWorld;
    vec3 normalWorld;
    vec3 tangentWorld;
} vd;

out vec4 out1;

// Mode "zeltner": a layer of upright fibres in which light scatters any number of times (Zeltner, Burley and Chiang
// 2022, Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines, eq. 1).
float fibre_albedo(float roughness, float NV)
{
    float r = clamp(roughness, 0.01, 1.0);
    float x = NV * (r * (0.0790869 * r + 0.669584) + 0.198854 + NV * (1.36266 - 1.34894 * r));
    float x2 = -(r * (r * (0.802235 - 0.409352 * r) + -0.123956) + 0.0111547 + x);
    return exp(x2 / (r * (r + 0.0353364 + NV * (0.00039855 * r + 0.102131))));
}

// Reads a latitude-longitude map in the direction d. v = 0 is the zenith; u runs with the azimuth from -z.
vec3 environment_lookup(sampler2D map, vec3 d, float level)
{
    float v = 0.5 - 0.31830987 * asin(clamp(d.y, -1.0, 1.0));
    return textureLod(map, vec2(0.15915494 * atan(d.x, -d.z) + 0.5, v), level).xyz;
}

// Reflectance of a thin film over an interface to n + ik (Belcour and Barla 2017, eq. 8).
vec3 fresnel_thin_film(float c, vec3 n, float thickness, float film_ior)
{
    float film = max(film_ior, 1.0);
    float inside = sqrt(1.0 - (1.0 - c * c) / (film * film));
    float phase = inside * (thickness * (1.256637e-08 * film));
    vec3 v = n / film;
    vec3 re = v * v;
    float x = inside * inside;
    vec3 t = re - (1.0 - x);
    vec3 m = sqrt(t * t);
    vec3 u = sqrt(max(0.5 * (t + m), 0.0));
    vec3 w = sqrt(max(0.5 * (m - t), 0.0));
    vec3 scale = 1.0 / max(re * re, 1e-12);
    vec3 up = scale * (re * u);
    vec3 wp = scale * (re * w);
    float x2 = film * inside;
    float x3 = inside / film;
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
        vec3 v2 = inside - u2;
        vec3 v3 = w2 * w2;
        vec3 v4 = inside + u2;
        vec3 R23 = (v2 * v2 + v3) / max(v3 + v4 * v4, 1e-12);
        vec3 v5 = atan(w2 * x4, x - u2 * u2 - v3);
        vec3 shift = v5 + (0.0 < r ? 3.1415927 : 0.0);
        vec3 R123 = R12 * R23;
        vec3 steady = R23 * (T * T) / (1.0 - R123);
        vec3 R123_2 = sqrt(R123);
        vec3 sum2 = sum + R12 + steady;
        vec3 wave = steady - T;
        for (int i = 0; i < 2; i++)
        {
            vec3 wave2 = R123_2 * wave;
            float x5 = float(i + 1);
            float x6 = phase * x5;
            vec3 v6 = shift * x5;
            vec3 v7 = cos(v6 + vec3(1681000.0, 1795300.0, 2208400.0) * x6);
            vec3 v8 = exp(x6 * (vec3(-4327800000.0, -9304600000.0, -6612100000.0) * x6));
            float second = 1.644e-08 * cos(2239900.0 * x6 + v6.x) * exp(x6 * (-4528200000.0 * x6));
            vec3 v9 = 9358910.0 * (vec3(9.04581e-08, 1.068737e-07, 1.069699e-07) * v7 * v8 + vec3(second, 0.0, 0.0));
            sum2 += 2.0 * wave2 * v9;
            wave = wave2;
        }
        u2 = up;
        w2 = wp;
        sum = sum2;
    }
    vec3 v10 = mat3(2.3706744, -0.513885, 0.0052982, -0.9000405, 1.4253036, -0.0146949, -0.4706338, 0.0885814, 1.0093968) * sum;
    return clamp(0.5 * v10, 0.0, 1.0);
}

// E: what white GGX reflects in one bounce to a view at cosine NV. Fitted by tools/fit to E by quadrature.
float microfacet_white(float NV, float alpha)
{
    float scale = NV * alpha / (NV * NV + alpha * alpha * (4.4736 * NV + 0.669338));
    float x = alpha * (NV * (0.427862 * NV + 1.88316) + 0.0766197 + alpha * (2.18724 - 0.015081 * NV));
    return clamp(1.0 - scale * (NV * (0.0677313 - 0.519049 * NV) + 0.179275 + x), 0.01, 1.0);
}

// Light that n visible normals mirror from the environment, or refract from it (microfacet_refraction).
vec3 microfacet_light(vec2 roughness, bool refracts, bool clear, float ior, vec3 base, vec3 rise, vec3 dip, vec3 N, vec3 V, vec3 X, out vec3 albedo)
{
    bool isotropic = roughness.x == roughness.y;
    vec3 tangent = isotropic ? V : X;
    vec3 tangent2 = tangent - N * dot(N, tangent);
    vec3 other = abs(N.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 x = normalize(dot(tangent2, tangent2) < 1e-08 ? cross(N, other) : tangent2);
    vec3 y = cross(N, x);
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
    float x5 = 0.5 * log2(count / (reach * (x3 * (6.2831855 * x2))));
    float level = float(u_envRadianceMips) - 2.5 - x5;
    mat3 frame = mat3(u_envMatrix) * mat3(x, y, N);
    vec3 away = refracts ? v : -v;
    float x6 = 1.0 / ior;
    float n2 = max(ior * ior, 0.0001);
    float x7 = n2 - 1.0;
    vec2 azimuth = vec2(1.0, 0.0);
    float total = 1e-08;
    vec3 light = vec3(0.0);
    vec3 share = vec3(0.0);
    for (int i = 0; i < u_envRadianceSamples; i++)
    {
        float z = 1.0 - descent * (float(i) + 0.5);
        vec3 h = s + vec3(azimuth * sqrt(1.0 - z * z), z);
        vec3 slope = alpha * h;
        vec3 H = normalize(slope);
        vec3 L = reflect(away, refracts ? refract(-v, H, x6) : H);
        float NL = max(L.z, 0.0);
        float weight = refracts ? 1.0 : NL / (toView * NL + NV * sqrt(mix(NL * NL, 1.0, x4)));
        float x8 = dot(v, H);
        float t = max(1.0 - x8, 0.0);
        float t2 = t * t;
        float t4 = t2 * t2;
        float u = sqrt(max(x7 + x8 * x8, 0.0));
        float p = u / n2;
        float rs = (x8 - u) / (x8 + u);
        float rp = (x8 - p) / (x8 + p);
        vec3 v2 = base + rise * (clear ? 0.5 * (rs * rs + rp * rp) : t * t4);
        vec3 F = weight * clamp(v2 + dip * t4 * (x8 * t2), 0.0, 1.0);
        vec3 d = frame * L;
        float x9 = dot(slope, slope) / dot(h, h);
        float r2 = x9 * x9;
        float best = max(level - 0.25 * log2(r2 * r2 * (1.00001 - d.y * d.y)), 0.0);
        float whole = floor(best);
        float level2 = whole + clamp(32.0 * (best - whole) - 15.5, 0.0, 1.0);
        azimuth = -0.7373689 * azimuth + vec2(-0.6754903, 0.6754903) * azimuth.yx;
        total += weight;
        light += F * environment_lookup(u_envRadiance, d, level2);
        share += F;
    }
    float E = min(reach * total / count, 1.0);
    vec3 once = share / total;
    float white = isotropic ? E : microfacet_white(NV, mean);
    vec3 v3 = mix(once, vec3(1.0), white) * (isotropic ? 1.0 : min(E / white, 1.0));
    vec3 bounces = refracts ? vec3(1.0) : v3;
    albedo = once * bounces;
    return light * (bounces / total);
}

void main()
{
    vec3 normal = normalize(vd.normalWorld);
    vec3 X = normalize(vd.tangentWorld);
    vec3 metal_color = open_pbr_surface_surfaceshader_base_weight * open_pbr_surface_surfaceshader_base_color;
    float coat = open_pbr_surface_surfaceshader_coat_roughness * open_pbr_surface_surfaceshader_coat_roughness;
    float base = open_pbr_surface_surfaceshader_specular_roughness * open_pbr_surface_surfaceshader_specular_roughness;
    float x = sqrt(sqrt(min(base * base + coat * (2.0 * coat), 1.0)));
    float specular_roughness_coated = mix(open_pbr_surface_surfaceshader_specular_roughness, x, open_pbr_surface_surfaceshader_coat_weight);
    float film_nanometers = 1000.0 * open_pbr_surface_surfaceshader_thin_film_thickness;
    float ratio = open_pbr_surface_surfaceshader_specular_ior / open_pbr_surface_surfaceshader_coat_ior;
    float index = mix(open_pbr_surface_surfaceshader_specular_ior, max(ratio, 1.0 / ratio), open_pbr_surface_surfaceshader_coat_weight);
    float amplitude = (index - 1.0) / (index + 1.0);
    float x2 = clamp(amplitude * (open_pbr_surface_surfaceshader_specular_weight * amplitude), 0.0, 0.99999);
    float weighted = sign(amplitude) * sqrt(x2);
    float specular_index = (weighted + 1.0) / (1.0 - weighted);
    bool test = 0.0 < open_pbr_surface_surfaceshader_transmission_depth;
    vec3 transmission_tint = test ? vec3(1.0) : open_pbr_surface_surfaceshader_transmission_color;
    vec3 subsurface_color_positive = max(open_pbr_surface_surfaceshader_subsurface_color, 0.0);
    vec3 backward_color = open_pbr_surface_surfaceshader_subsurface_color * (1.0 - open_pbr_surface_surfaceshader_subsurface_scatter_anisotropy);
    vec3 forward_color = open_pbr_surface_surfaceshader_subsurface_color * (open_pbr_surface_surfaceshader_subsurface_scatter_anisotropy + 1.0);
    float thin_walled_weight = open_pbr_surface_surfaceshader_geometry_thin_walled ? 1.0 : 0.0;
    vec3 base_color_positive = max(open_pbr_surface_surfaceshader_base_color, 0.0);
    vec3 metal_albedo = open_pbr_surface_surfaceshader_base_color * open_pbr_surface_surfaceshader_specular_weight;
    vec3 dielectric_albedo = mix(open_pbr_surface_surfaceshader_base_color, open_pbr_surface_surfaceshader_subsurface_color, open_pbr_surface_surfaceshader_subsurface_weight);
    float coat_index_below = open_pbr_surface_surfaceshader_coat_ior - 1.0;
    float amplitude2 = coat_index_below / (open_pbr_surface_surfaceshader_coat_ior + 1.0);
    float coat_transmittance = 1.0 - amplitude2 * amplitude2;
    float x3 = open_pbr_surface_surfaceshader_coat_ior * open_pbr_surface_surfaceshader_coat_ior;
    float K = 1.0 - coat_transmittance / x3;
    vec3 v = mix(dielectric_albedo, metal_albedo, open_pbr_surface_surfaceshader_base_metalness) * K;
    float x4 = open_pbr_surface_surfaceshader_coat_weight * open_pbr_surface_surfaceshader_coat_darkening;
    vec3 coat_tint = mix(vec3(1.0), open_pbr_surface_surfaceshader_coat_color, open_pbr_surface_surfaceshader_coat_weight);
    vec3 coat_passed = mix(vec3(1.0), (1.0 - K) / (1.0 - v), x4) * coat_tint;
    vec3 emitted_color = open_pbr_surface_surfaceshader_emission_luminance * open_pbr_surface_surfaceshader_emission_color;
    vec3 V = normalize(u_viewPosition - vd.positionWorld);
    float x5 = coat_transmittance * (1.0 - pow(1.0 - abs(dot(normal, V)), 5.0));
    float x6 = 1.0 - open_pbr_surface_surfaceshader_base_metalness;
    float x7 = 1.0 - open_pbr_surface_surfaceshader_thin_film_weight;
    float x8 = open_pbr_surface_surfaceshader_base_metalness * x7;
    float x9 = open_pbr_surface_surfaceshader_base_metalness * open_pbr_surface_surfaceshader_thin_film_weight;
    vec3 N = faceforward(normal, -V, normal);
    float NV = clamp(dot(V, N), 0.0001, 1.0);
    float share = fibre_albedo(open_pbr_surface_surfaceshader_fuzz_roughness, NV);
    mat3 m = mat3(u_envMatrix);
    vec3 v2 = environment_lookup(u_envIrradiance, m * N, 0.0);
    float passed = 1.0 - open_pbr_surface_surfaceshader_fuzz_weight * share;
    bool metal_film_is_used = open_pbr_surface_surfaceshader_specular_weight * x9 != 0.0;
    vec3 rise = 1.0 - metal_color;
    vec3 dip = (metal_color + 0.46266437 * rise) * (17.651384 * (open_pbr_surface_surfaceshader_specular_color - 1.0));
    bool test2 = 0.0 < film_nanometers;
    vec3 dip2 = test2 ? vec3(0.0) : dip;
    vec3 rise2 = test2 ? vec3(0.0) : rise;
    vec3 root = sqrt(clamp(metal_color, 0.0, 0.99));
    vec3 v3 = (root + 1.0) / (1.0 - root);
    bool specular_film_is_used = open_pbr_surface_surfaceshader_thin_film_weight * x6 != 0.0;
    vec3 v4 = vec3(specular_index);
    bool test3 = test2 && specular_film_is_used;
    int calls = int(test3) + int(metal_film_is_used && test2);
    int which = test3 ? 0 : 1;
    vec3 base2 = vec3(0.0);
    vec3 base3 = vec3(0.0);
    for (int i = 0; i < calls; i++)
    {
        bool is_metal_film = which == 1;
        vec3 n = is_metal_film ? v3 : v4;
        vec3 v5 = fresnel_thin_film(NV, n, film_nanometers, open_pbr_surface_surfaceshader_thin_film_ior);
        base2 = which == 0 ? v5 : base2;
        which = 1;
        base3 = is_metal_film ? v5 : base3;
    }
    vec3 base4 = test2 ? base3 : metal_color;
    bool metal_plain_is_used = open_pbr_surface_surfaceshader_specular_weight * x8 != 0.0;
    bool specular_plain_is_used = x6 * x7 != 0.0;
    bool transmitted_is_used = open_pbr_surface_surfaceshader_transmission_weight * x6 != 0.0;
    vec3 rise3 = test2 ? vec3(0.0) : vec3(1.0);
    bool coat_lobe_is_used = open_pbr_surface_surfaceshader_coat_weight != 0.0;
    int k = int(coat_lobe_is_used) + int(specular_film_is_used) + int(transmitted_is_used);
    int k2 = k + int(specular_plain_is_used) + int(metal_plain_is_used);
    int calls2 = k2 + int(metal_film_is_used);
    int k3 = specular_plain_is_used ? 3 : metal_plain_is_used ? 4 : 5;
    int k4 = specular_film_is_used ? 1 : transmitted_is_used ? 2 : k3;
    int which2 = coat_lobe_is_used ? 0 : k4;
    vec3 coat_lobe = vec3(0.0);
    vec3 coat_lobe_albedo = vec3(0.0);
    vec3 radiance = vec3(0.0);
    vec3 specular_film_albedo = vec3(0.0);
    vec3 radiance2 = vec3(0.0);
    vec3 radiance3 = vec3(0.0);
    vec3 specular_plain_albedo = vec3(0.0);
    vec3 metal_plain = vec3(0.0);
    vec3 metal_film = vec3(0.0);
    for (int i2 = 0; i2 < calls2; i2++)
    {
        bool test4 = which2 < 4;
        int k5 = metal_plain_is_used && test4 ? 4 : 5;
        int k6 = specular_plain_is_used && which2 < 3 ? 3 : k5;
        int k7 = transmitted_is_used && which2 < 2 ? 2 : k6;
        bool is_coat_lobe = which2 == 0;
        float x10 = is_coat_lobe ? open_pbr_surface_surfaceshader_coat_roughness : specular_roughness_coated;
        float x11 = is_coat_lobe ? open_pbr_surface_surfaceshader_coat_roughness_anisotropy : open_pbr_surface_surfaceshader_specular_roughness_anisotropy;
        float alpha = x10 * x10;
        float aspect = 1.0 - x11;
        float along = alpha * sqrt(2.0 / (aspect * aspect + 1.0));
        vec2 roughness = 0.0 < x11 ? vec2(along, aspect * along) : vec2(alpha);
        bool is_transmitted = which2 == 2;
        bool clear = is_transmitted ? false : test4;
        float x12 = 4 <= which2 ? 1.0 : specular_index;
        float ior = is_coat_lobe ? open_pbr_surface_surfaceshader_coat_ior : x12;
        bool is_metal_film2 = which2 == 5;
        bool is_metal_plain = which2 == 4;
        vec3 v6 = is_metal_plain ? metal_color : is_metal_film2 ? base4 : vec3(0.0);
        bool is_specular_film = which2 == 1;
        vec3 base5 = is_specular_film ? base2 : is_transmitted ? vec3(1.0) : v6;
        vec3 v7 = is_metal_plain ? rise : is_metal_film2 ? rise2 : vec3(1.0);
        vec3 rise4 = is_specular_film ? rise3 : is_transmitted ? vec3(0.0) : v7;
        vec3 dip3 = is_metal_plain ? dip : is_metal_film2 ? dip2 : vec3(0.0);
        vec3 albedo;
        vec3 radiance4 = microfacet_light(roughness, is_transmitted, clear, ior, base5, rise4, dip3, N, V, X, albedo);
        bool is_specular_plain = which2 == 3;
        which2 = specular_film_is_used && which2 < 1 ? 1 : k7;
        coat_lobe = is_coat_lobe ? radiance4 : coat_lobe;
        coat_lobe_albedo = is_coat_lobe ? albedo : coat_lobe_albedo;
        radiance = is_specular_film ? radiance4 : radiance;
        specular_film_albedo = is_specular_film ? albedo : specular_film_albedo;
        radiance2 = is_transmitted ? radiance4 : radiance2;
        radiance3 = is_specular_plain ? radiance4 : radiance3;
        specular_plain_albedo = is_specular_plain ? albedo : specular_plain_albedo;
        metal_plain = is_metal_plain ? radiance4 : metal_plain;
        metal_film = is_metal_film2 ? radiance4 : metal_film;
    }
    vec3 v8 = coat_passed * (passed * (1.0 - open_pbr_surface_surfaceshader_coat_weight * coat_lobe_albedo));
    vec3 v9 = x6 * v8;
    vec3 v10 = open_pbr_surface_surfaceshader_base_metalness * v8;
    vec3 v11 = mix(1.0 - specular_plain_albedo, 1.0 - specular_film_albedo, open_pbr_surface_surfaceshader_thin_film_weight);
    vec3 passed2 = v9 * v11;
    vec3 v12 = (1.0 - open_pbr_surface_surfaceshader_transmission_weight) * passed2;
    vec3 v13 = (1.0 - open_pbr_surface_surfaceshader_subsurface_weight) * v12;
    vec3 v14 = open_pbr_surface_surfaceshader_subsurface_weight * v12;
    vec3 v15 = 0.5 * (thin_walled_weight * v14);
    vec3 v16 = open_pbr_surface_surfaceshader_thin_film_weight * v10;
    float x13 = 0.2877934 * open_pbr_surface_surfaceshader_base_diffuse_roughness + 1.0;
    float share2 = 1.0 / x13;
    float t = 1.0 - NV;
    float rough = t * (t * (t * (0.094506 * t - 0.380115) + 0.522378) + 0.0514252);
    float white = min(share2 + open_pbr_surface_surfaceshader_base_diffuse_roughness * share2 * rough, 1.0);
    float kept = (0.0724882 * open_pbr_surface_surfaceshader_base_diffuse_roughness + 1.0) / x13;
    vec3 v17 = kept * (base_color_positive * base_color_positive);
    vec3 v18 = v17 / (1.0 - base_color_positive * (1.0 - kept)) * (1.0 - white);
    vec3 diffuse = v2 * (base_color_positive * white + v18);
    vec3 v19 = environment_lookup(u_envIrradiance, m * -normal, 0.0);
    float s2 = open_pbr_surface_surfaceshader_base_diffuse_roughness * open_pbr_surface_surfaceshader_base_diffuse_roughness;
    float rough2 = sqrt(max(1.0 - NV * NV, 0.0)) * (t * (0.0396229 * t + 0.252719) + 0.208327);
    float white2 = min(1.0 - 0.5 * s2 / (s2 + 0.33) + 0.45 * s2 / (s2 + 0.09) * rough2, 1.0);
    vec3 inside = u_refractionTwoSided ? transmission_tint * transmission_tint : transmission_tint;
    vec3 v20 = (1.0 - thin_walled_weight) * v14 * (subsurface_color_positive * v2);
    vec3 v21 = open_pbr_surface_surfaceshader_base_weight * v13 * diffuse + v20;
    vec3 v22 = v21 + forward_color * v15 * (subsurface_color_positive * v19);
    vec3 v23 = v22 + backward_color * v15 * (v2 * (subsurface_color_positive * white2));
    vec3 v24 = open_pbr_surface_surfaceshader_transmission_weight * passed2 * (radiance2 * inside);
    vec3 v25 = open_pbr_surface_surfaceshader_specular_color * radiance * (open_pbr_surface_surfaceshader_thin_film_weight * v9);
    vec3 v26 = v23 + v24 + open_pbr_surface_surfaceshader_specular_color * radiance3 * (x7 * v9) + v25;
    vec3 v27 = metal_plain * (open_pbr_surface_surfaceshader_specular_weight * (x7 * v10));
    vec3 v28 = metal_film * (open_pbr_surface_surfaceshader_specular_weight * v16);
    vec3 v29 = coat_lobe * (open_pbr_surface_surfaceshader_coat_weight * passed);
    vec3 v30 = open_pbr_surface_surfaceshader_fuzz_weight * (open_pbr_surface_surfaceshader_fuzz_color * share * v2);
    vec3 v31 = (v26 + v27 + v28 + v29 + v30) * u_envLightIntensity;
    vec3 v32 = open_pbr_surface_surfaceshader_coat_color * (open_pbr_surface_surfaceshader_coat_weight * x5);
    vec3 v33 = emitted_color * (1.0 - open_pbr_surface_surfaceshader_coat_weight + v32);
    out1 = vec4(open_pbr_surface_surfaceshader_geometry_opacity * (v31 + v33), 1.0);
}
