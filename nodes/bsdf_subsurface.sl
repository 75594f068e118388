// subsurface_bsdf: light that enters, scatters and leaves elsewhere. The environment is so wide that it looks diffuse.

// Share of the light from L that leaves here: Burley's diffusion profile (Christensen and Burley 2015, eq. 3) averaged
// over a circle as curved as the surface, which light meets at cosine dot(N, L) (Penner 2011). radius is the mean free
// path. Every place x of the circle weighs what it gets in sum from lights all around, seen from here, so that the
// integral over L is the tint whatever the curvature. Light from below the horizon counts where the surface is curved;
// the view does not, so it is not reciprocal.
color subsurface_light(color tint, color radius, vector N, vector L)
{
    float turn = length(abs(Dx(N)) + abs(Dy(N)));
    float move = length(abs(Dx(position_world)) + abs(Dy(position_world)));
    float curvature = turn / max(move, 0.00000001);
    float circle = 2.0 / max(curvature, 0.01);
    color shape = 1.0 / max(radius, 0.1);
    // The profile counts relative to that of the nearest places, of which something is left on a flat surface too.
    float nearest = 0.0490676743 * circle;
    float angle = acos(clamp(dot(N, L), -1.0, 1.0));
    color lit = color(0.0);
    color total = color(0.0);
    for (int i = 0; i < 32; i++)
    {
        float x = 0.196349541 * (i + 0.5) - 3.14159265;
        float gap = circle * abs(sin(0.5 * x));
        color steep = exp((nearest / 3.0 - gap) * shape);
        color profile = (steep + exp((nearest - gap) / 3.0 * shape)) / max(gap, 0.00000001);
        lit += profile * max(cos(angle + x), 0.0);
        float turned = abs(x);
        total += profile * (abs(cos(x)) + min(turned, 3.14159265 - turned) * sin(turned));
    }
    return tint * lit / max(total, 0.00000001) * 0.318309886;
}

void subsurface_bsdf_environment(color color, color radius, float anisotropy, vector N, output color radiance,
                                 output color albedo)
{
    radiance = color * irradiance(N);
    albedo = 1.0;
}

color subsurface_bsdf_eval(color color, color radius, float anisotropy, vector N, vector V, vector L)
{
    return subsurface_light(color, radius, N, L);
}

void subsurface_bsdf_sample(vector N, vector V, vector2 u, output vector L)
{
    L = cosine_sample(N, u);
}

float subsurface_bsdf_pdf(vector N, vector V, vector L)
{
    return cosine_pdf(N, L);
}

color subsurface_bsdf_albedo(color color, vector N, vector V)
{
    return color;
}
