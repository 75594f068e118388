#version 400

// lacquered_wood

uniform vec3 u_viewPosition = vec3(0.0);
uniform mat4 u_envMatrix = mat4(-1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
uniform float u_envLightIntensity = 1.0;
uniform int u_envRadianceMips = 1;
uniform int u_envRadianceSamples = 16;
uniform sampler2D u_envRadiance;
uniform sampler2D u_envIrradiance;

uniform sampler2D wood_color_file;
uniform vec2 NG_wood_planks = vec2(3.0, 2.0);
uniform vec3 NG_wood_stain = vec3(1.0, 0.92, 0.84);
uniform sampler2D wood_roughness_file;
uniform sampler2D wood_relief_file;
uniform float NG_wood_relief = 0.7;
uniform float SR_lacquered_wood_base = 0.95;
uniform float SR_lacquered_wood_specular = 0.4;
uniform float SR_lacquered_wood_coat = 0.9;
uniform vec3 SR_lacquered_wood_coat_color = vec3(1.0, 0.97, 0.92);
uniform float SR_lacquered_wood_coat_roughness = 0.08;
uniform float SR_lacquered_wood_coat_IOR = 1.52;
uniform float SR_lacquered_wood_coat_affect_color = 0.25;

in VertexData
{
    vec3 positionWorld;
    vec3 normalWorld;
    vec3 tangentWorld;
    vec3 bitangentWorld;
    vec2 texcoord_0;
} vd;

out vec4 out1;

// The transfer curve of sRGB (IEC 61966-2-1), decoded: a straight piece near black, a power above.
vec3 srgb_to_linear(vec3 encoded)
{
    vec3 curve = pow(max((encoded + 0.055) / 1.055, 0.0), vec3(2.4));
    return mix(curve, encoded / 12.92, step(encoded, vec3(0.04045)));
}

// A normal read from a tangent space normal map, whose values in [0, 1] stand for [-1, 1].
vec3 apply_normal_map(vec3 value, float scale, vec3 N, vec3 T, vec3 B)
{
    vec3 direction = 2.0 * value - 1.0;
    return normalize(T * (scale * direction.x) + B * (scale * direction.y) + N * direction.z);
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
vec3 microfacet_reflection(float roughness, float ior, vec3 N, vec3 V, out vec3 albedo)
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
        float weight = NL / (stretched * NL + NV * sqrt(mix(NL * NL, 1.0, x2)));
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

void main()
{
    vec2 p = vd.texcoord_0 * NG_wood_planks;
    float wood_roughness = texture(wood_roughness_file, p).x;
    vec3 wood_relief = texture(wood_relief_file, p).xyz;
    vec3 normal = normalize(vd.normalWorld);
    vec3 coat_tangent = normalize(vd.tangentWorld);
    vec3 wood_normal = apply_normal_map(wood_relief, NG_wood_relief, normal, coat_tangent, normalize(vd.bitangentWorld));
    float alpha = SR_lacquered_wood_coat_roughness * SR_lacquered_wood_coat_roughness;
    float coat_gamma = SR_lacquered_wood_coat_affect_color * clamp(SR_lacquered_wood_coat, 0.0, 1.0) + 1.0;
    vec3 base_color_positive = max(srgb_to_linear(texture(wood_color_file, p).xyz) * NG_wood_stain, 0.0);
    vec3 coat_tint = mix(vec3(1.0), SR_lacquered_wood_coat_color, SR_lacquered_wood_coat);
    vec3 V = normalize(u_viewPosition - vd.positionWorld);
    vec3 coat_lobe_albedo;
    vec3 coat_lobe = microfacet_reflection(alpha, SR_lacquered_wood_coat_IOR, faceforward(normal, -V, normal), V, coat_lobe_albedo);
    vec3 v = coat_tint * (1.0 - SR_lacquered_wood_coat * coat_lobe_albedo);
    vec3 N = faceforward(wood_normal, -V, wood_normal);
    vec3 specular_lobe_albedo;
    vec3 specular_lobe = microfacet_reflection(wood_roughness * wood_roughness, 1.5, N, V, specular_lobe_albedo);
    vec3 v2 = SR_lacquered_wood_base * (v * (1.0 - SR_lacquered_wood_specular * specular_lobe_albedo));
    vec3 v3 = environment_lookup(u_envIrradiance, mat3(u_envMatrix) * N, 0.0);
    vec3 v4 = v2 * (pow(base_color_positive, vec3(coat_gamma)) * v3);
    vec3 v5 = v4 + specular_lobe * (SR_lacquered_wood_specular * v);
    out1 = vec4((v5 + SR_lacquered_wood_coat * coat_lobe) * u_envLightIntensity, 1.0);
}
