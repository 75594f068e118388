// burley_diffuse_bsdf: Burley 2012, eq. 4. Roughness bends Lambert's law where view or light graze.

// One of its two factors, at cosine c; bend is the factor along the surface.
float burley_factor(float c, float bend)
{
    float t = 1.0 - c;
    float t2 = t * t;
    return 1.0 + (bend - 1.0) * (t2 * t2 * t);
}

// Directional albedo of a white surface by quadrature, fitted by tools/fit. A rough one reflects more than falls in
// along the surface; what exceeds 1 is divided out of the lobe.
float burley_fit(float roughness, vector N, vector V)
{
    float t = 1.0 - clamp(dot(N, V), 0.0001, 1.0);
    float t2 = t * t;
    float t5 = t2 * t2 * t;
    float graze = roughness * (1.11096 + 0.071724 * roughness - 0.183363 * t5) - 0.486356;
    return 0.97561 + 0.060425 * roughness + graze * t5;
}

// The same albedo, exact: every term of the integral over L is a polynomial in its cosine. The environment makes do
// with the fit.
float burley_exact(float roughness, float NV)
{
    float t = 1.0 - NV;
    float t2 = t * t;
    float bend = roughness - 0.5;
    float tilt = roughness * NV;
    float cross = roughness * roughness * (1.0 - NV * NV);
    float both = bend * bend / 21.0 + bend * tilt / 42.0 + tilt * tilt / 252.0 + cross * 11.0 / 504.0;
    return 1.0 + bend / 21.0 + tilt / 84.0 + t2 * t2 * t * (bend + tilt / 1.5 + both);
}

// Reflectance times cosine. It is the same for V and L exchanged but for the cosine and what is divided out.
float burley_lobe(float roughness, vector N, vector V, vector L)
{
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    float NL = clamp(dot(N, L), 0.0, 1.0);
    float LH = dot(L, normalize(V + L));
    float bend = 0.5 + 2.0 * roughness * LH * LH;
    return 0.318309886 * NL * burley_factor(NL, bend) * burley_factor(NV, bend) / max(burley_exact(roughness, NV), 1.0);
}

float burley_white(float roughness, vector N, vector V)
{
    return min(burley_fit(roughness, N, V), 1.0);
}

void burley_diffuse_bsdf_environment(color color, float roughness, vector N, vector V, output color radiance,
                                     output color albedo)
{
    radiance = color * burley_white(roughness, N, V) * irradiance(N);
    albedo = 1.0;
}

color burley_diffuse_bsdf_eval(color color, float roughness, vector N, vector V, vector L)
{
    return color * burley_lobe(roughness, N, V, L);
}

void burley_diffuse_bsdf_sample(vector N, vector V, vector2 u, output vector L)
{
    L = cosine_sample(N, u);
}

float burley_diffuse_bsdf_pdf(vector N, vector V, vector L)
{
    return cosine_pdf(N, L);
}

color burley_diffuse_bsdf_albedo(color color, float roughness, vector N, vector V)
{
    return color * min(burley_exact(roughness, clamp(dot(N, V), 0.0001, 1.0)), 1.0);
}
