// sheen_bsdf: the fibres of cloth.

// Mode "conty_kulla": a microfacet lobe along the horizon. Distribution of Conty and Kulla 2017, eq. 2; visibility of
// Neubelt and Pettineo 2013.

inline float sheen_width(float roughness)
{
    return clamp(roughness, 0.01, 1.0);
}

// Its directional albedo by quadrature, fitted by tools/fit. Narrow lobes reflect more than falls in along the
// surface; what exceeds 1 is divided out of the lobe.
inline float sheen_fit(float roughness, float NV)
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

// Mode "zeltner": a layer of upright fibres in which light scatters any number of times (Zeltner, Burley and Chiang 2022,
// Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines, eq. 1). What comes to a view at cosine NV is
// a cosine lobe, stretched and sheared: in the frame (x, y, N) whose x is V laid down, L belongs to the direction
// (A L.x + B L.z, A L.y, L.z) of the cosine. A, B and the albedo are fitted by tools/fit to the table published with it.
float fibre_albedo(float roughness, float NV)
{
    float r = sheen_width(roughness);
    float up = 0.0111547 + r * (-0.123956 + r * (0.802235 - 0.409352 * r)) +
               NV * (0.198854 + r * (0.669584 + 0.0790869 * r) + NV * (1.36266 - 1.34894 * r));
    return exp(-up / (r * (0.0353364 + r + NV * (0.102131 + 0.00039855 * r))));
}

// A and B.
vector2 fibre_transform(float roughness, float NV)
{
    float r = sheen_width(roughness);
    float scale = (0.491028 - NV * (5.39946 + 1.21236 * NV) + r * (-4.0881 + 47.9716 * NV + 10.8696 * r)) /
                  (1.0 + 24.3968 * NV + r * (8.99022 + 19.9769 * NV));
    float shear = (r * (-0.568242 + r * (-6.26041 - 12.0802 * r)) + NV * (r * (48.1897 - 78.9398 * r) - 21.5877 * NV)) /
                  (1.0 + 131.265 * NV * NV + 30.8189 * r * r);
    // The table has less only where there is next to no light.
    return vector2(max(scale, 0.02 + 0.3 * NV), (1.0 - r) * sqrt(1.0 - NV) * shear);
}

// The frame of the view.
void fibre_frame(vector N, vector V, output vector x, output vector y)
{
    microfacet_frame(vector2(1.0), N, V, V, x, y);
}

// Density over solid angle of the lobe, which is the density of the cosine times what the transform does to a solid
// angle. It holds the cosine of the light, as reflectance does not, so the lobe is not the same for V and L exchanged.
float fibre_density(float roughness, vector N, vector V, vector L)
{
    vector x = vector(0.0);
    vector y = vector(0.0);
    fibre_frame(N, V, x, y);
    vector2 t = fibre_transform(roughness, clamp(dot(N, V), 0.0001, 1.0));
    float NL = max(dot(N, L), 0.0);
    vector d = vector(t.x * dot(L, x) + t.y * NL, t.x * dot(L, y), NL);
    float square = dot(d, d);
    return 0.318309886 * t.x * t.x * NL / max(square * square, 0.00000001);
}

// Both modes.

inline float sheen_albedo(float roughness, string mode, vector N, vector V)
{
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    return mode == "zeltner" ? fibre_albedo(roughness, NV) : clamp(sheen_fit(roughness, NV), 0.0, 1.0);
}

void sheen_bsdf_environment(color color, float roughness, string mode, vector N, vector V, output color radiance,
                            output color albedo)
{
    float share = sheen_albedo(roughness, mode, N, V);
    radiance = color * share * irradiance(N);
    albedo = share;
}

color sheen_bsdf_eval(color color, float roughness, string mode, vector N, vector V, vector L)
{
    if (mode == "zeltner")
        return color * fibre_albedo(roughness, clamp(dot(N, V), 0.0001, 1.0)) * fibre_density(roughness, N, V, L);
    return color * sheen_light(roughness, N, V, L);
}

void sheen_bsdf_sample(float roughness, string mode, vector N, vector V, vector2 u, output vector L)
{
    L = cosine_sample(N, u);
    if (mode == "zeltner")
    {
        vector x = vector(0.0);
        vector y = vector(0.0);
        fibre_frame(N, V, x, y);
        vector2 t = fibre_transform(roughness, clamp(dot(N, V), 0.0001, 1.0));
        float NL = dot(N, L);
        L = normalize((dot(L, x) - t.y * NL) * x + dot(L, y) * y + t.x * NL * N);
    }
}

float sheen_bsdf_pdf(float roughness, string mode, vector N, vector V, vector L)
{
    return mode == "zeltner" ? fibre_density(roughness, N, V, L) : cosine_pdf(N, L);
}

// In mode "conty_kulla" the integral of sheen_light over L, off by less than 0.001 where roughness is 0.05 and more:
// halves of circles of light of one height, which are denser along the surface.
color sheen_bsdf_albedo(color color, float roughness, string mode, vector N, vector V)
{
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    if (mode == "zeltner")
        return color * fibre_albedo(roughness, NV);
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
