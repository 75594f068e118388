#version 400

// Car_Paint

uniform vec3 u_viewPosition = vec3(0.0);
uniform mat4 u_envMatrix = mat4(-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform float SR_carpaint_base = 0.5;
uniform vec3 SR_carpaint_base_color = vec3(0.1037792, 0.5921203, 0.85064936);
uniform float SR_carpaint_specular = 1.0;
uniform vec3 SR_carpaint_specular_color = vec3(1.0);
uniform float SR_carpaint_specular_roughness = 0.4;
uniform float SR_carpaint_specular_anisotropy = 0.5;
uniform float SR_carpaint_coat_roughness = 0.0;

in VertexData
{
    vec3 positionWorld;
    vec3 normalWorld;
    vec3 tangentWorld;
} vd;

out vec4 out1;

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
    float best = max(level - 0.25 * log2(r2 * r2 * (1.00001 - d.y * d.y)), 0.0);
    float whole = floor(best);
    float level2 = whole + clamp(32.0 * (best - whole) - 15.5, 0.0, 1.0);
    return environment_lookup(u_envRadiance, d, level2);
}

// Light that n visible normals mirror from the environment, or refract from it (microfacet_refraction).
vec3 microfacet_light(float roughness, vec3 N, vec3 V, out vec3 albedo)
{
    float x = dot(N, V);
    vec3 tangent = V - N * x;
    vec3 other = abs(N.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
    vec3 x2 = normalize(dot(tangent, tangent) < 1e-08 ? cross(N, other) : tangent);
    float NV = clamp(x, 0.0001, 1.0);
    float mean = clamp(roughness, 0.0001, 1.0);
    vec3 alpha = vec3(mean, mean, 1.0);
    vec3 v = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
    vec3 wide = alpha * v;
    float stretched = length(wide);
    vec3 s = wide / stretched;
    float x3 = mean * mean;
    float count = float(u_envRadianceSamples);
    float descent = (s.z + 1.0) / count;
    float reach = NV + stretched;
    float level = microfacet_level(alpha, reach);
    mat3 frame = mat3(u_envMatrix) * mat3(x2, cross(N, x2), N);
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
        float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, x3)));
        float F = weight * fresnel_dielectric(dot(v, H));
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

// E: what white GGX reflects in one bounce to a view at cosine NV. Fitted by tools/fit to E by quadrature.
float microfacet_white(float NV, float alpha)
{
    float scale = NV * alpha / (NV * NV + alpha * alpha * (4.4736 * NV + 0.669338));
    float x = alpha * (NV * (0.427862 * NV + 1.88316) + 0.0766197 + alpha * (2.18724 - 0.015081 * NV));
    return clamp(1.0 - scale * (NV * (0.0677313 - 0.519049 * NV) + 0.179275 + x), 0.01, 1.0);
}

// Light that n visible normals mirror from the environment, or refract from it (microfacet_refraction).
vec3 microfacet_light2(vec2 roughness, vec3 N, vec3 V, vec3 X, out vec3 albedo)
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
        float F = weight * fresnel_dielectric(dot(v, H));
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

void main()
{
    vec3 normal = normalize(vd.normalWorld);
    float alpha = SR_carpaint_specular_roughness * SR_carpaint_specular_roughness;
    float aspect = sqrt(1.0 - clamp(SR_carpaint_specular_anisotropy, 0.0, 0.98));
    vec2 p = vec2(min(alpha / aspect, 1.0), alpha * aspect);
    vec2 specular_alpha = 0.0 < SR_carpaint_specular_anisotropy ? p : vec2(alpha);
    vec3 V = normalize(u_viewPosition - vd.positionWorld);
    vec3 N = faceforward(normal, -V, normal);
    vec3 coat_lobe_albedo;
    vec3 coat_lobe = microfacet_light(SR_carpaint_coat_roughness * SR_carpaint_coat_roughness, N, V, coat_lobe_albedo);
    vec3 passed = 1.0 - coat_lobe_albedo;
    vec3 specular_lobe_albedo;
    vec3 radiance = microfacet_light2(specular_alpha, N, V, normalize(vd.tangentWorld), specular_lobe_albedo);
    vec3 v = SR_carpaint_base * (passed * (1.0 - SR_carpaint_specular * specular_lobe_albedo));
    vec3 v2 = environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
    vec3 v3 = SR_carpaint_specular_color * radiance * (SR_carpaint_specular * passed);
    vec3 light = coat_lobe + v * (max(SR_carpaint_base_color, 0.0) * v2) + v3;
    out1 = vec4(light * u_envLightIntensity, 1.0);
}
