// Cosine-weighted directions, and the lobes that need nothing else.

// A direction for the two numbers u in [0, 1): a point of the unit sphere that touches the surface from above.
vector cosine_sample(vector N, vector2 u)
{
    float azimuth = 6.28318531 * u.x;
    float z = 1.0 - 2.0 * u.y;
    // A little short, so that the antipode gives a direction too.
    return normalize(N + 0.99999 * vector(vector2(cos(azimuth), sin(azimuth)) * sqrt(max(1.0 - z * z, 0.0)), z));
}

float cosine_pdf(vector N, vector L)
{
    return 0.318309886 * max(dot(N, L), 0.0);
}

// translucent_bsdf: Lambert's law for light from behind. Its normal is not turned to the viewer.
void translucent_bsdf_environment(color color, vector normal, output color radiance, output color albedo)
{
    radiance = color * irradiance(-normal);
    albedo = 1.0;
}

color translucent_bsdf_eval(color color, vector normal, vector V, vector L)
{
    return color * cosine_pdf(-normal, L);
}

void translucent_bsdf_sample(vector normal, vector V, vector2 u, output vector L)
{
    L = cosine_sample(-normal, u);
}

float translucent_bsdf_pdf(vector normal, vector V, vector L)
{
    return cosine_pdf(-normal, L);
}

color translucent_bsdf_albedo(color color, vector normal, vector V)
{
    return color;
}

// uniform_edf: the same light to all sides.
color uniform_edf_emission(color color)
{
    return color;
}
