// sheen_bsdf: the fibres of cloth, as a microfacet lobe along the horizon. Distribution of Conty and Kulla 2017, eq.
// 2; visibility of Neubelt and Pettineo 2013. Both modes of the node use this lobe.

float sheen_width(float roughness)
{
    return clamp(roughness, 0.01, 1.0);
}

// Its directional albedo by quadrature, fitted by tools/fit. Narrow lobes reflect more than falls in along the
// surface; what exceeds 1 is divided out of the lobe.
float sheen_fit(float roughness, float NV)
{
    float r = sheen_width(roughness);
    return (3.35395 + NV * (1.91259 * NV - 6.35138) + r * (13.7158 - 4.94826 * NV - 0.698754 * r)) /
           (1.0 + 13.4539 * NV + r * (26.6426 + 11.4431 * NV));
}

// At least the albedo that sheen_fit approximates, wherever that exceeds 1; made by tools/fit.
float sheen_excess(float roughness, float NV)
{
    float r = sheen_width(roughness);
    float s = sqrt(r);
    return (0.395 + 0.0378 * s + 0.23 * r) / (s + 2.1 * NV);
}

// Reflectance times cosine of the lobe as published. Divided by NL it is the same for V and L exchanged.
float sheen_lobe(float roughness, float NV, float NL, float NH)
{
    float power = 1.0 / sheen_width(roughness);
    float density = 0.159154943 * (2.0 + power) * pow(max(1.0 - NH * NH, 0.0), 0.5 * power);
    return density * NL / (4.0 * (NL + NV - NL * NV));
}

// The lobe without what exceeds 1, which depends on the view.
float sheen_light(float roughness, vector N, vector V, vector L)
{
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    float NL = clamp(dot(N, L), 0.0, 1.0);
    float NH = dot(N, normalize(V + L));
    return sheen_lobe(roughness, NV, NL, NH) / max(sheen_excess(roughness, NV), 1.0);
}

float sheen_albedo(float roughness, vector N, vector V)
{
    return clamp(sheen_fit(roughness, clamp(dot(N, V), 0.0001, 1.0)), 0.0, 1.0);
}

void sheen_bsdf_environment(color color, float roughness, string mode, vector N, vector V, output color radiance,
                            output color albedo)
{
    float share = sheen_albedo(roughness, N, V);
    radiance = color * share * irradiance(N);
    albedo = share;
}

color sheen_bsdf_eval(color color, float roughness, string mode, vector N, vector V, vector L)
{
    return color * sheen_light(roughness, N, V, L);
}

void sheen_bsdf_sample(vector N, vector V, vector2 u, output vector L)
{
    L = cosine_sample(N, u);
}

float sheen_bsdf_pdf(vector N, vector V, vector L)
{
    return cosine_pdf(N, L);
}

// The integral of sheen_light over L, off by less than 0.001 where roughness is 0.05 and more: halves of circles of
// light of one height, which are denser along the surface.
color sheen_bsdf_albedo(color color, float roughness, string mode, vector N, vector V)
{
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    float across = sqrt(max(1.0 - NV * NV, 0.0));
    float sum = 0.0;
    for (int i = 0; i < 32; i++)
    {
        float step = 0.03125 * (i + 0.5);
        float NL = step * step;
        for (int j = 0; j < 16; j++)
        {
            float azimuth = 0.196349541 * (j + 0.5);
            // Squared length of V + L.
            float both = 2.0 + 2.0 * (NV * NL + across * sqrt(1.0 - NL * NL) * cos(azimuth));
            float NH = (NV + NL) / sqrt(max(both, 0.00000001));
            sum += step * sheen_lobe(roughness, NV, NL, NH);
        }
    }
    return color * (0.0245436926 * sum / max(sheen_excess(roughness, NV), 1.0));
}
