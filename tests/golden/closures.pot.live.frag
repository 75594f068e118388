#version 400

// pot

uniform vec3 u_viewPosition = vec3(0.0);
uniform mat4 u_envMatrix = mat4(-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform float varnish_weight = 0.7;
uniform float varnish_ior = 1.45;
uniform vec2 metal_roughness = vec2(0.2);
uniform vec3 clay_color = vec3(0.6, 0.3, 0.2);
uniform float clay_roughness = 0.4;
uniform float worn_mix = 0.4;
uniform vec3 dim_in2 = vec3(0.9, 0.8, 0.7);
uniform float dust_weight = 0.3;
uniform vec3 dust_color = vec3(0.5, 0.5, 0.4);
uniform vec3 glow_color = vec3(0.01, 0.02, 0.03);
uniform float built_opacity = 0.95;

in VertexData
{
    vec3 positionWorld;
    vec3 normalWorld;
    vec3 tangentWorld;
} vd;

out vec4 out1;

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
float microfacet_level(float reach)
{
    float x = 0.5 * log2(float(u_envRadianceSamples) / (0.015707964 * reach));
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
float fresnel_dielectric(float c, float ior)
{
    float n2 = max(ior * ior, 0.0001);
    float u = sqrt(max(n2 - 1.0 + c * c, 0.0));
    float p = u / n2;
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

// Light that n visible normals mirror from the environment.
vec3 microfacet_reflection(float ior, vec3 N, vec3 V, out vec3 albedo)
{
    vec3 y;
    vec3 x = microfacet_frame(N, V, y);
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    vec3 v = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
    vec3 wide = vec3(0.05, 0.05, 1.0) * v;
    float stretched = length(wide);
    vec3 s = wide / stretched;
    float count = float(u_envRadianceSamples);
    float descent = (s.z + 1.0) / count;
    float reach = NV + stretched;
    float level = microfacet_level(reach);
    mat3 frame = mat3(u_envMatrix) * mat3(x, y, N);
    float total = 1e-08;
    vec3 light = vec3(0.0);
    vec3 share = vec3(0.0);
    for (int i = 0; i < u_envRadianceSamples; i++)
    {
        vec3 h = microfacet_cap(i, descent, s);
        vec3 slope = vec3(0.05, 0.05, 1.0) * h;
        vec3 H = normalize(slope);
        vec3 L = reflect(-v, H);
        float NL = max(L.z, 0.0);
        float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, 0.0025000002)));
        float F = weight * fresnel_dielectric(dot(v, H), ior);
        total += weight;
        light += F * microfacet_lookup(frame * L, level, dot(slope, slope) / dot(h, h));
        share += F;
    }
    vec3 once = share / total;
    vec3 all2 = mix(once, vec3(1.0), min(reach * total / count, 1.0));
    albedo = once * all2;
    return light * (all2 / total);
}

// Its directional albedo by quadrature, fitted by tools/fit.
float sheen_fit(float NV)
{
    float x = NV * (1.91259 * NV - 6.35138) + 3.35395 + 0.3 * (13.7158 - 4.94826 * NV - 0.20962621);
    return x / (13.4539 * NV + 1.0 + 0.3 * (11.4431 * NV + 26.6426));
}

vec3 sheen_bsdf_environment(vec3 color, vec3 N, vec3 V)
{
    vec3 v = environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
    return color * clamp(sheen_fit(clamp(dot(N, V), 0.0001, 1.0)), 0.0, 1.0) * v;
}

// Shares of Lambert's term (x) and of the rough one (y).
vec2 oren_nayar_shares(float roughness)
{
    float s2 = roughness * roughness;
    return vec2(1.0 - 0.5 * s2 / (s2 + 0.33), 0.45 * s2 / (s2 + 0.09));
}

// Share of light that one bounce on white matter keeps.
float oren_nayar_fit(float roughness, float NV)
{
    vec2 share = oren_nayar_shares(roughness);
    float t = 1.0 - NV;
    float x = sqrt(max(1.0 - NV * NV, 0.0)) * (t * (0.0396229 * t + 0.252719) + 0.208327) * share.y;
    return share.x + x;
}

vec3 oren_nayar_diffuse_bsdf_environment(vec3 color, float roughness, vec3 N, vec3 V)
{
    vec3 v = environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
    return color * min(oren_nayar_fit(roughness, clamp(dot(N, V), 0.0001, 1.0)), 1.0) * v;
}

// The level of detail of samples, but for what differs from one to the next.
float microfacet_level2(vec3 alpha, float reach)
{
    float x = 0.5 * log2(float(u_envRadianceSamples) / (reach * (6.2831855 * alpha.x * alpha.y)));
    return float(u_envRadianceMips) - 2.5 - x;
}

// Reflectance at cosine c. A clear interface has its exact one between base and base + rise; others follow a curve
// (fresnel_curve), which has the exponent 5 unless a material says otherwise.
vec3 microfacet_fresnel(float c)
{
    float t = max(1.0 - c, 0.0);
    float t2 = t * t;
    float t4 = t2 * t2;
    vec3 v = (vec3(-0.20467374, 0.0450396, -0.40904638) * t4 + vec3(-0.04540211, -0.025290174, 0.1857508)) * (c * t2);
    vec3 v2 = vec3(0.05577874, 0.22384816, 0.6266525) * (t * t4) + vec3(0.94422126, 0.77615184, 0.37334755) + v;
    return clamp(v2, 0.0, 1.0);
}

// E: what white GGX reflects in one bounce to a view at cosine NV. Fitted by tools/fit to E by quadrature.
float microfacet_white(float NV, float alpha)
{
    float scale = NV * alpha / (NV * NV + alpha * alpha * (4.4736 * NV + 0.669338));
    float x = alpha * (NV * (0.427862 * NV + 1.88316) + 0.0766197 + alpha * (2.18724 - 0.015081 * NV));
    return clamp(1.0 - scale * (NV * (0.0677313 - 0.519049 * NV) + 0.179275 + x), 0.01, 1.0);
}

// Light that n visible normals mirror from the environment.
vec3 microfacet_reflection2(vec2 roughness, vec3 N, vec3 V, vec3 X)
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
    float level = microfacet_level2(alpha, reach);
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
        vec3 F = weight * microfacet_fresnel(dot(v, H));
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
    vec3 V = normalize(u_viewPosition - vd.positionWorld);
    vec3 N = faceforward(normal, -V, normal);
    vec3 varnish_albedo;
    vec3 varnish = microfacet_reflection(varnish_ior, N, V, varnish_albedo);
    vec3 passed = 1.0 - varnish_weight * varnish_albedo;
    vec3 v = dim_in2 * passed;
    vec3 clay = oren_nayar_diffuse_bsdf_environment(clay_color, clay_roughness, N, V);
    vec3 metal = microfacet_reflection2(metal_roughness, N, V, normalize(vd.tangentWorld));
    vec3 v2 = dust_weight * passed * sheen_bsdf_environment(dust_color, N, V);
    vec3 v3 = v2 + v * (1.0 - worn_mix) * clay + worn_mix * v * metal;
    vec3 v4 = glow_color + (v3 + varnish_weight * varnish) * u_envLightIntensity;
    out1 = vec4(built_opacity * v4, 1.0);
}
