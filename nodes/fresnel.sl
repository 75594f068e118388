// Reflectance of smooth interfaces. Indices are relative to the medium the light comes from; c is the cosine of the
// angle of incidence.

// Reflectance of a dielectric face on.
inline float reflectance_of_index(float ior)
{
    float amplitude = (ior - 1.0) / (ior + 1.0);
    return amplitude * amplitude;
}

// Admittance u + iw of an interface to the index n + ik for s-polarised light. It is what the cosine is compared with:
// the amplitude of reflection is (c - y) / (c + y) with y = sqrt((n + ik)^2 - sin^2).
inline void fresnel_admittance(float c, color n, color k, output color u, output color w)
{
    color t = n * n - k * k - (1.0 - c * c);
    color m = sqrt(t * t + 4.0 * n * n * k * k);
    u = sqrt(max(0.5 * (m + t), 0.0));
    w = sqrt(max(0.5 * (m - t), 0.0));
}

// The same for p-polarised light: the admittance divided by (n + ik)^2.
inline void fresnel_admittance_p(color n, color k, color u, color w, output color up, output color wp)
{
    color re = n * n - k * k;
    color im = 2.0 * n * k;
    color scale = 1.0 / max(re * re + im * im, 1e-12);
    up = (u * re + w * im) * scale;
    wp = (w * re - u * im) * scale;
}

// Reflectance at an interface of admittance u + iw.
color fresnel_reflectance(float c, color u, color w)
{
    color toward = (c - u) * (c - u) + w * w;
    color away = (c + u) * (c + u) + w * w;
    return toward / max(away, 1e-12);
}

// Reflectance of a conductor of index n + ik for unpolarised light. Exact for positive cosines. Written out, the squares
// of the amplitudes for p- and s-polarised light have a ratio that needs no further root.
color fresnel_conductor(float c, color n, color k)
{
    float c2 = c * c;
    float s2 = 1.0 - c2;
    color t = n * n - k * k - s2;
    color m = sqrt(t * t + 4.0 * n * n * k * k);
    color a = 2.0 * c * sqrt(max(0.5 * (m + t), 0.0));
    color b = m + c2;
    color d = c2 * m + s2 * s2;
    color Rs = (b - a) / (b + a);
    return 0.5 * Rs * (1.0 + (d - s2 * a) / (d + s2 * a));
}

// Reflectance of a dielectric for unpolarised light; exact, 1 where reflection is total.
inline float fresnel_dielectric(float c, float ior)
{
    float n2 = max(ior * ior, 0.0001);
    float u = sqrt(max(n2 - 1.0 + c * c, 0.0));
    float p = u / n2;
    float rs = (c - u) / (c + u);
    float rp = (c - p) / (c + p);
    return 0.5 * (rs * rs + rp * rp);
}

// A conductor's reflectance as a curve that costs little per half vector. With x = 1 - c it is
//     F = base + rise x^5 + c x^2 (bend + dip x^4).
// The first two terms are Schlick's, dip is Hoffman's (2019, eq. 6) and bend ours. It is exact at the cosines 1, 1/2,
// 1/7 and 0. For the indices of gold, silver and copper it is off by 0.004 at most, for those of chromium by 0.017 above
// 1/7 and 0.025 below; for one as extreme as 20 + 32i by 0.038 above.
void fresnel_curve(color F0, color F60, color F82, output color rise, output color bend, output color dip)
{
    rise = 1.0 - F0;
    color more60 = F60 - F0 - 0.03125 * rise;
    color more82 = F82 - F0 - 0.462664366 * rise;
    bend = 9.0476139 * more60 - 1.2476790 * more82;
    dip = 19.9628640 * more82 - 16.7618217 * more60;
}

// Response of the eye to interference of one order, as XYZ (Belcour and Barla 2017, eq. 10 and their numbers). It comes
// from the phase difference at unit wave number and the shift at the interfaces, through four Gaussians in wave number.
inline color interference(float phase, color shift)
{
    color centre = color(1.6810e6, 1.7953e6, 2.2084e6);
    color width = color(4.3278e9, 9.3046e9, 6.6121e9);
    color xyz = color(9.04581e-8, 1.068737e-7, 1.069699e-7) * cos(centre * phase + shift) * exp(-width * phase * phase);
    float second = 1.6440e-8 * cos(2.2399e6 * phase + shift.x) * exp(-4.5282e9 * phase * phase);
    return (xyz + color(second, 0.0, 0.0)) * 9.35891e6;
}

// Reflectance of a thin film over an interface to n + ik (Belcour and Barla 2017, eq. 8). It is the Airy sum over the
// orders of interference, of which three count. s- and p-polarised light differ by their admittances alone. thickness
// is in nanometres; where it is 0 there is no film, and no work.
color fresnel_thin_film(float c, color n, color k, float thickness, float film_ior)
{
    float film = max(film_ior, 1.0);
    float inside = sqrt(1.0 - (1.0 - c * c) / (film * film));
    float phase = 1.25663706e-8 * film * thickness * inside;
    color u = color(0.0);
    color w = color(0.0);
    color up = color(0.0);
    color wp = color(0.0);
    fresnel_admittance(inside, n / film, k / film, u, w);
    fresnel_admittance_p(n / film, k / film, u, w, up, wp);
    color sum = color(0.0);
    int polarisations = thickness > 0.0 ? 2 : 0;
    for (int p = 0; p < polarisations; p++)
    {
        float y = p == 0 ? film * inside : inside / film;
        float r = (c - y) / (c + y);
        float R12 = r * r;
        float T = 1.0 - R12;
        color R23 = fresnel_reflectance(inside, u, w);
        color shift = atan2(-2.0 * inside * w, inside * inside - u * u - w * w) + (r > 0.0 ? 3.14159265 : 0.0);
        color R123 = R12 * R23;
        color steady = T * T * R23 / (1.0 - R123);
        color wave = steady - T;
        sum += R12 + steady;
        R123 = sqrt(R123);
        for (int m = 1; m < 3; m++)
        {
            wave *= R123;
            sum += 2.0 * wave * interference(m * phase, m * shift);
        }
        u = up;
        w = wp;
    }
    matrix33 rgb = matrix33(vector(2.3706743, -0.5138850, 0.0052982), vector(-0.9000405, 1.4253036, -0.0146949),
                            vector(-0.4706338, 0.0885814, 1.0093968));
    return clamp(0.5 * color(rgb * vector(sum)), 0.0, 1.0);
}
