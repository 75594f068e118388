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

// GGX roughness along and across the tangent: a lobe stretched by the anisotropy keeps its roughness as the geometric
// mean.
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

// The complex index of refraction of a metal from its colour face on and at the edge (O. Gulbrandsen, Artist Friendly
// Metallic Fresnel, JCGT 2014, equations 5 and 6).
vec3 artistic_ior(vec3 reflectivity, out vec3 extinction)
{
    vec3 r = clamp(reflectivity, 0.0, 0.99);
    vec3 v = 1.0 - r;
    vec3 n = v / (r + 1.0);
    vec3 above = n + 1.0;
    vec3 below = n - 1.0;
    extinction = sqrt(max((r * (above * above) - below * below) / v, 0.0));
    return n;
}

// The frame in which roughness is given.
vec3 microfacet_frame(vec3 N, vec3 X, out vec3 y)
{
    vec3 tangent = X - N * dot(N, X);
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

// Direction number i of a sequence over the cap of visible normals (Dupuy and Benyoub 2023, algorithm 2).
vec3 microfacet_cap(int i, float descent, vec3 s)
{
    float k = float(i);
    float azimuth = 2.3999631 * k;
    float z = 1.0 - descent * (k + 0.5);
    return s + vec3(vec2(cos(azimuth), sin(azimuth)) * sqrt(1.0 - z * z), z);
}

// Reflectance of a dielectric for unpolarised light; exact, 1 where reflection is total.
float fresnel_dielectric(float c)
{
    float u = sqrt(max(c * c + 1.25, 0.0));
    float p = u / 2.25;
    float rs = (c - u) / (c + u);
    float rp = (c - p) / (c + p);
    return 0.5 * (rs * rs + rp * rp);
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
    float level2 = max(level - 0.25 * log2(r2 * r2 * (1.00001 - d.y * d.y)), 0.0);
    return environment_lookup(u_envRadiance, d, level2);
}

// E: what white GGX reflects in one bounce to a view at cosine NV. Fitted by tools/fit to E by quadrature.
float microfacet_white(float NV, float alpha)
{
    float scale = NV * alpha / (NV * NV + alpha * alpha * (4.4736 * NV + 0.669338));
    float x = alpha * (NV * (0.427862 * NV + 1.88316) + 0.0766197 + alpha * (2.18724 - 0.015081 * NV));
    return clamp(1.0 - scale * (NV * (0.0677313 - 0.519049 * NV) + 0.179275 + x), 0.01, 1.0);
}

// Light that n visible normals mirror from the environment.
vec3 microfacet_reflection(vec2 roughness, vec3 N, vec3 V, vec3 X, out vec3 albedo)
{
    vec3 y;
    vec3 x = microfacet_frame(N, X, y);
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
    float total = 1e-08;
    vec3 light = vec3(0.0);
    vec3 share = vec3(0.0);
    for (int i = 0; i < u_envRadianceSamples; i++)
    {
        vec3 h = microfacet_cap(i, descent, s);
        vec3 slope = alpha * h;
        vec3 H = normalize(slope);
        vec3 L = reflect(-v, H);
        float NL = max(L.z, 0.0);
        float weight = NL / (toView * NL + NV * sqrt(mix(NL * NL, 1.0, x4)));
        float F = weight * fresnel_dielectric(dot(v, H));
        total += weight;
        light += F * microfacet_lookup(frame * L, level, dot(slope, slope) / dot(h, h));
        share += F;
    }
    vec3 once = share / total;
    float white = microfacet_white(NV, mean);
    float x5 = min(min(reach * total / count, 1.0) / white, 1.0);
    vec3 all2 = mix(once, vec3(1.0), white) * x5;
    albedo = once * all2;
    return light * (all2 / total);
}

// Reflectance at an interface of admittance u + iw.
vec3 fresnel_reflectance(float c, vec3 u, vec3 w)
{
    vec3 v = c - u;
    vec3 v2 = w * w;
    vec3 v3 = c + u;
    return (v * v + v2) / max(v2 + v3 * v3, 1e-12);
}

// What the cosine is compared with at an interface to the index n + ik, as a complex number u + iw for s-polarised
// light: the amplitude of reflection is (c - y) / (c + y) with the admittance y = sqrt((n + ik)^2 - sin^2).
vec3 fresnel_admittance(float c, vec3 n, vec3 k, out vec3 w)
{
    vec3 t = n * n - k * k - (1.0 - c * c);
    vec3 m = sqrt(t * t + k * (k * (n * (4.0 * n))));
    w = sqrt(max(0.5 * (m - t), 0.0));
    return sqrt(max(0.5 * (t + m), 0.0));
}

// The same for p-polarised light: the admittance divided by (n + ik)^2.
vec3 fresnel_admittance_p(vec3 n, vec3 k, vec3 u, vec3 w, out vec3 wp)
{
    vec3 re = n * n - k * k;
    vec3 im = k * (2.0 * n);
    vec3 scale = 1.0 / max(re * re + im * im, 1e-12);
    wp = scale * (w * re - u * im);
    return scale * (u * re + w * im);
}

// Reflectance of a conductor of index n + ik for unpolarised light; exact.
vec3 fresnel_conductor(float c, vec3 n, vec3 k)
{
    vec3 w;
    vec3 u = fresnel_admittance(c, n, k, w);
    vec3 wp;
    vec3 up = fresnel_admittance_p(n, k, u, w, wp);
    vec3 v = fresnel_reflectance(c, u, w);
    return 0.5 * (v + fresnel_reflectance(c, up, wp));
}

// A conductor's reflectance as a curve that costs little per half vector: with x = 1 - c, F = base + rise x^5 + c x^2
// (bend + dip x^4).
vec3 fresnel_curve(vec3 F0, vec3 F60, vec3 F82, out vec3 bend, out vec3 dip)
{
    vec3 rise = 1.0 - F0;
    vec3 more60 = F60 - F0 - 0.03125 * rise;
    vec3 more82 = F82 - F0 - 0.46266437 * rise;
    bend = 9.047614 * more60 - 1.247679 * more82;
    dip = 19.962864 * more82 - 16.761822 * more60;
    return rise;
}

// Reflectance at cosine c. A clear interface has its exact one between base and base + rise; others follow a curve
// (fresnel_curve), which has the exponent 5 unless a material says otherwise.
vec3 microfacet_fresnel(vec3 base, vec3 rise, vec3 bend, vec3 dip, float c)
{
    float t = max(1.0 - c, 0.0);
    float t2 = t * t;
    float t4 = t2 * t2;
    return clamp(base + rise * (t * t4) + (bend + dip * t4) * (c * t2), 0.0, 1.0);
}

// Light that n visible normals mirror from the environment.
vec3 microfacet_reflection2(vec2 roughness, vec3 base, vec3 rise, vec3 bend, vec3 dip, vec3 N, vec3 V, vec3 X)
{
    vec3 y;
    vec3 x = microfacet_frame(N, X, y);
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
    float total = 1e-08;
    vec3 light = vec3(0.0);
    vec3 share = vec3(0.0);
    for (int i = 0; i < u_envRadianceSamples; i++)
    {
        vec3 h = microfacet_cap(i, descent, s);
        vec3 slope = alpha * h;
        vec3 H = normalize(slope);
        vec3 L = reflect(-v, H);
        float NL = max(L.z, 0.0);
        float weight = NL / (toView * NL + NV * sqrt(mix(NL * NL, 1.0, x4)));
        vec3 F = weight * microfacet_fresnel(base, rise, bend, dip, dot(v, H));
        total += weight;
        light += F * microfacet_lookup(frame * L, level, dot(slope, slope) / dot(h, h));
        share += F;
    }
    float white = microfacet_white(NV, mean);
    vec3 v2 = mix(share / total, vec3(1.0), white);
    vec3 v3 = v2 * min(min(reach * total / count, 1.0) / white, 1.0) / total;
    return light * v3;
}

void main()
{
    vec3 normal = normalize(vd.normalWorld);
    vec3 v = normalize(vd.tangentWorld);
    vec2 coat_alpha = roughness_anisotropy(paint_shader_coat_roughness, paint_shader_coat_anisotropy);
    vec3 coat_turned_unit = normalize(rotate_about(v, 360.0 * paint_shader_coat_rotation, normal));
    vec3 coat_tangent = 0.0 < paint_shader_coat_anisotropy ? coat_turned_unit : v;
    vec3 metal_index_extinction;
    vec3 metal_index_ior = artistic_ior(paint_shader_base * paint_shader_base_color, metal_index_extinction);
    float coat_blur = paint_shader_coat_roughness * (paint_shader_coat * paint_shader_coat_affect_roughness);
    float specular_blurred = mix(paint_shader_specular_roughness, 1.0, coat_blur);
    vec2 specular_alpha = roughness_anisotropy(specular_blurred, paint_shader_specular_anisotropy);
    vec3 specular_turned_unit = normalize(rotate_about(v, 360.0 * paint_shader_specular_rotation, normal));
    vec3 specular_tangent = 0.0 < paint_shader_specular_anisotropy ? specular_turned_unit : v;
    vec3 coat_tint = mix(vec3(1.0), paint_shader_coat_color, paint_shader_coat);
    vec3 V = normalize(u_viewPosition - vd.positionWorld);
    vec3 N = faceforward(normal, -V, normal);
    vec3 coat_lobe_albedo;
    vec3 coat_lobe = microfacet_reflection(coat_alpha, N, V, coat_tangent, coat_lobe_albedo);
    vec3 v2 = coat_tint * (1.0 - paint_shader_coat * coat_lobe_albedo);
    vec3 v3 = v2 * (1.0 - paint_shader_metalness);
    vec3 specular_lobe_albedo;
    vec3 specular_lobe = microfacet_reflection(specular_alpha, N, V, specular_tangent, specular_lobe_albedo);
    vec3 v4 = environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
    vec3 base = fresnel_reflectance(1.0, metal_index_ior, metal_index_extinction);
    vec3 F60 = fresnel_conductor(0.5, metal_index_ior, metal_index_extinction);
    vec3 bend;
    vec3 dip;
    vec3 rise = fresnel_curve(base, F60, fresnel_conductor(0.14285715, metal_index_ior, metal_index_extinction), bend, dip);
    vec3 metal = microfacet_reflection2(specular_alpha, base, rise, bend, dip, N, V, specular_tangent);
    vec3 v5 = paint_shader_base * (v3 * (1.0 - specular_lobe_albedo)) * (max(paint_shader_base_color, 0.0) * v4);
    vec3 v6 = v5 + v3 * specular_lobe + paint_shader_metalness * v2 * metal;
    out1 = vec4((v6 + paint_shader_coat * coat_lobe) * u_envLightIntensity, 1.0);
}
