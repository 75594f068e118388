// oren_nayar_diffuse_bsdf: rough matter that scatters light all ways. Roughness 0 is Lambert's. Without
// energy_compensation the qualitative model of Oren and Nayar 1994, eq. 30, roughness being the deviation of slopes in
// radians. With it the model that keeps energy (Portsmouth, Kutz and Hill 2024): Fujii's form of Oren-Nayar and a
// second lobe for what bounces more than once.

// Shares of Lambert's term (x) and of the rough one (y).
inline vector2 oren_nayar_shares(float roughness, boolean energy_compensation)
{
    if (energy_compensation)
    {
        float share = 1.0 / (1.0 + 0.287793409 * roughness);
        return vector2(share, roughness * share);
    }
    float s2 = roughness * roughness;
    return vector2(1.0 - 0.5 * s2 / (s2 + 0.33), 0.45 * s2 / (s2 + 0.09));
}

// Share of light that one bounce on white matter keeps. The rough term's integral is fitted by tools/fit over 1 - NV.
// The qualitative model exceeds 1 by up to 1.5 % along the surface.
inline float oren_nayar_fit(float roughness, boolean energy_compensation, float NV)
{
    vector2 share = oren_nayar_shares(roughness, energy_compensation);
    float t = 1.0 - NV;
    float rough = 0.0;
    if (energy_compensation)
        rough = t * (0.0514252 + t * (0.522378 + t * (0.094506 * t - 0.380115)));
    else
        rough = sqrt(max(1.0 - NV * NV, 0.0)) * (0.208327 + t * (0.252719 + t * 0.0396229));
    return share.x + share.y * rough;
}

inline float oren_nayar_white(float roughness, boolean energy_compensation, float NV)
{
    return min(oren_nayar_fit(roughness, energy_compensation, NV), 1.0);
}

// Mean of oren_nayar_white over the hemisphere, with energy_compensation.
inline float oren_nayar_mean(float roughness)
{
    return (1.0 + 0.0724882 * roughness) / (1.0 + 0.287793409 * roughness);
}

// Colour of light that bounced more than once.
inline color oren_nayar_bounces(color tint, float roughness)
{
    float kept = oren_nayar_mean(roughness);
    return tint * tint * kept / (1.0 - tint * (1.0 - kept));
}

// Directional albedo of matter of the given colour.
color oren_nayar_albedo(color tint, float roughness, boolean energy_compensation, float NV)
{
    float white = oren_nayar_white(roughness, energy_compensation, NV);
    if (energy_compensation)
        return tint * white + oren_nayar_bounces(tint, roughness) * (1.0 - white);
    return tint * white;
}

// What oren_nayar_fit approximates, exact: the integrals of Portsmouth, Kutz and Hill 2024, eq. 19, and of the
// qualitative model, which leaves out light from beyond the normal.
float oren_nayar_exact(float roughness, boolean energy_compensation, float NV)
{
    vector2 share = oren_nayar_shares(roughness, energy_compensation);
    float s = sqrt(max(1.0 - NV * NV, 0.0));
    float angle = acos(NV) - s * NV;
    float low = (1.0 - s * s * s) / (1.5 * NV);
    float rough = energy_compensation ? s * (angle + low - 0.666666667) : s * (angle + low);
    return share.x + share.y * 0.318309886 * rough;
}

// Reflectance times cosine for light from L. But for the cosine, and for what the qualitative model divides out, it is
// the same for V and L exchanged.
color oren_nayar_light(color tint, float roughness, boolean energy_compensation, vector N, vector V, vector L)
{
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    float NL = clamp(dot(N, L), 0.0, 1.0);
    vector2 share = oren_nayar_shares(roughness, energy_compensation);
    // The cosine between both directions as seen from above, times both sines: positive where light comes from the
    // viewer's side, and there divided by the larger cosine. Elsewhere nothing (qualitative) or itself (Fujii) counts.
    float side = dot(V, L) - NV * NL;
    float rough = side > 0.0 ? side / max(NV, NL) : (energy_compensation ? side : 0.0);
    // What would exceed 1 in sum over all light is divided out.
    float once = max(share.x + share.y * rough, 0.0) / max(oren_nayar_exact(roughness, energy_compensation, NV), 1.0);
    color light = tint * once;
    if (energy_compensation)
    {
        float kept = oren_nayar_mean(roughness);
        float lost = (1.0 - oren_nayar_white(roughness, true, NV)) * (1.0 - oren_nayar_white(roughness, true, NL));
        light += oren_nayar_bounces(tint, roughness) * (lost / max(1.0 - kept, 0.0000001));
    }
    return light * (0.318309886 * NL);
}

void oren_nayar_diffuse_bsdf_environment(color color, float roughness, boolean energy_compensation, vector N, vector V,
                                         output color radiance, output color albedo)
{
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    radiance = oren_nayar_albedo(color, roughness, energy_compensation, NV) * irradiance(N);
    albedo = 1.0;
}

color oren_nayar_diffuse_bsdf_eval(color color, float roughness, boolean energy_compensation, vector N, vector V,
                                   vector L)
{
    return oren_nayar_light(color, roughness, energy_compensation, N, V, L);
}

void oren_nayar_diffuse_bsdf_sample(vector N, vector V, vector2 u, output vector L)
{
    L = cosine_sample(N, u);
}

float oren_nayar_diffuse_bsdf_pdf(vector N, vector V, vector L)
{
    return cosine_pdf(N, L);
}

color oren_nayar_diffuse_bsdf_albedo(color color, float roughness, boolean energy_compensation, vector N, vector V)
{
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    color light = color * min(oren_nayar_exact(roughness, energy_compensation, NV), 1.0);
    if (energy_compensation)
        light += oren_nayar_bounces(color, roughness) * (1.0 - oren_nayar_white(roughness, true, NV));
    return light;
}
