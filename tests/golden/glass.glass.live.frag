#version 400

// glass

uniform vec3 u_viewPosition = vec3(0.0);
uniform mat4 u_envMatrix = mat4(-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform bool u_refractionTwoSided = false;
uniform sampler2D u_envRadiance;

uniform float glass_shader_specular_roughness = 0.01;
uniform float glass_shader_specular_IOR = 1.52;
uniform vec3 glass_shader_transmission_color = vec3(0.9, 0.98, 0.95);

in VertexData
{
    vec3 positionWorld;
    vec3 normalWorld;
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
    float n2 = max(ior * ior, 0.0001);
    float x3 = n2 - 1.0;
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
        float x4 = dot(v, H);
        float u = sqrt(max(x3 + x4 * x4, 0.0));
        float p = u / n2;
        float rs = (x4 - u) / (x4 + u);
        float rp = (x4 - p) / (x4 + p);
        float F = weight * (0.5 * (rs * rs + rp * rp));
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
vec3 microfacet_light2(float roughness, float ior, vec3 N, vec3 V)
{
    vec3 y;
    vec3 x = microfacet_frame(N, V, y);
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    float x2 = clamp(roughness, 0.0001, 1.0);
    vec3 alpha = vec3(x2, x2, 1.0);
    vec3 v = vec3(sqrt(1.0 - NV * NV), 0.0, NV);
    vec3 wide = alpha * v;
    float stretched = length(wide);
    vec3 s = wide / stretched;
    float descent = (s.z + 1.0) / float(u_envRadianceSamples);
    float level = microfacet_level(alpha, NV + stretched);
    mat3 frame = mat3(u_envMatrix) * mat3(x, y, N);
    float x3 = 1.0 / ior;
    vec2 azimuth = vec2(1.0, 0.0);
    float total = 1e-08;
    vec3 light = vec3(0.0);
    vec3 share = vec3(0.0);
    for (int i = 0; i < u_envRadianceSamples; i++)
    {
        vec3 h = microfacet_cap(i, azimuth, descent, s);
        vec3 slope = alpha * h;
        vec3 d = frame * reflect(v, refract(-v, normalize(slope), x3));
        azimuth = -0.7373689 * azimuth + vec2(-0.6754903, 0.6754903) * azimuth.yx;
        total += 1.0;
        light += microfacet_lookup(d, level, dot(slope, slope) / dot(h, h));
        share += 1.0;
    }
    return light * (1.0 / total);
}

void main()
{
    vec3 normal = normalize(vd.normalWorld);
    float alpha = glass_shader_specular_roughness * glass_shader_specular_roughness;
    float transmission_clamped = clamp(glass_shader_specular_roughness, 0.0, 1.0);
    float alpha2 = transmission_clamped * transmission_clamped;
    vec3 V = normalize(u_viewPosition - vd.positionWorld);
    vec3 N = faceforward(normal, -V, normal);
    vec3 specular_lobe_albedo;
    vec3 specular_lobe = microfacet_light(alpha, glass_shader_specular_IOR, N, V, specular_lobe_albedo);
    vec3 radiance = microfacet_light2(alpha2, glass_shader_specular_IOR, N, V);
    vec3 v = (1.0 - specular_lobe_albedo) * ((u_refractionTwoSided ? glass_shader_transmission_color * glass_shader_transmission_color : glass_shader_transmission_color) * radiance);
    out1 = vec4((specular_lobe + v) * u_envLightIntensity, 1.0);
}
