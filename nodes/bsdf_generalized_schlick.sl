// generalized_schlick_bsdf: GGX whose reflectance is a curve given by its colours: color0 facing, color90 along the
// surface, color82 near it.

// Schlick's curve with any exponent, bent to pass color82 times its own value at the cosine 1/7 (Hoffman 2019, eq. 6).
// A thin film's reflectance is taken once, at the angle of the view: the film lies on the dielectric or metal that
// color0 suggests (Gulbrandsen 2014, with no extinction).
void generalized_schlick_curve(color color0, color color82, color color90, float exponent, float thinfilm_thickness,
                               float thinfilm_ior, vector N, vector V, output color base, output color rise,
                               output color dip)
{
    if (thinfilm_thickness > 0.0)
    {
        float NV = clamp(dot(N, V), 0.0001, 1.0);
        color root = sqrt(clamp(color0, 0.0, 0.99));
        color film = fresnel_thin_film(NV, (1.0 + root) / (1.0 - root), color(0.0), thinfilm_thickness, thinfilm_ior);
        base = film;
        rise = color(0.0);
        dip = color(0.0);
    }
    else
    {
        base = color0;
        rise = color90 - color0;
        float climb = known(exponent == 5.0) ? 0.462664366 : pow(0.857142857, exponent);
        dip = 17.6513846 * (color82 - 1.0) * (base + climb * rise);
    }
}

// As dielectric_bsdf_environment; light is refracted by the index that color0 suggests.
void generalized_schlick_bsdf_environment(color color0, color color82, color color90, float exponent, vector2 roughness,
                                          boolean retroreflective, float thinfilm_thickness, float thinfilm_ior,
                                          string scatter_mode, vector N, vector V, vector X, output color radiance,
                                          output color albedo)
{
    radiance = color(0.0);
    albedo = color(0.0);
    if (scatter_mode == "R" || scatter_mode == "RT")
    {
        color base = color(0.0);
        color rise = color(0.0);
        color dip = color(0.0);
        generalized_schlick_curve(color0, color82, color90, exponent, thinfilm_thickness, thinfilm_ior, N, V, base,
                                  rise, dip);
        microfacet_reflection(roughness, retroreflective, false, 1.0, base, rise, color(0.0), dip, exponent, N, V, X,
                              radiance, albedo);
    }
    if (scatter_mode == "T" || scatter_mode == "RT")
    {
        float root = sqrt(clamp(dot(vector(color0), vector(0.333333333)), 0.0, 0.99));
        radiance += (1.0 - albedo) * microfacet_refraction(roughness, (1.0 + root) / (1.0 - root), N, V, X);
        albedo = color(1.0);
    }
}

color generalized_schlick_bsdf_eval(color color0, color color82, color color90, float exponent, vector2 roughness,
                                    boolean retroreflective, float thinfilm_thickness, float thinfilm_ior,
                                    string scatter_mode, vector N, vector V, vector X, vector L)
{
    if (scatter_mode == "T")
        return color(0.0);
    color base = color(0.0);
    color rise = color(0.0);
    color dip = color(0.0);
    generalized_schlick_curve(color0, color82, color90, exponent, thinfilm_thickness, thinfilm_ior, N, V, base, rise,
                              dip);
    return microfacet_eval(roughness, retroreflective, false, 1.0, base, rise, color(0.0), dip, exponent, N, V, X, L);
}

void generalized_schlick_bsdf_sample(vector2 roughness, boolean retroreflective, vector N, vector V, vector X,
                                     vector2 u, output vector L)
{
    microfacet_sample(roughness, retroreflective, N, V, X, u, L);
}

float generalized_schlick_bsdf_pdf(vector2 roughness, boolean retroreflective, vector N, vector V, vector X, vector L)
{
    return microfacet_pdf(roughness, retroreflective, N, V, X, L);
}

// What it reflects of lights. (Layering takes all in modes "T" and "RT".)
color generalized_schlick_bsdf_albedo(color color0, color color82, color color90, float exponent, vector2 roughness,
                                      float thinfilm_thickness, float thinfilm_ior, string scatter_mode, vector N,
                                      vector V, vector X)
{
    if (scatter_mode == "T")
        return color(0.0);
    color base = color(0.0);
    color rise = color(0.0);
    color dip = color(0.0);
    generalized_schlick_curve(color0, color82, color90, exponent, thinfilm_thickness, thinfilm_ior, N, V, base, rise,
                              dip);
    return microfacet_albedo(roughness, false, 1.0, base, rise, color(0.0), dip, exponent, N, V, X);
}

// generalized_schlick_edf: the share of the light of its base that passes towards V.
color generalized_schlick_edf_share(color color0, color color90, float exponent, vector N, vector V)
{
    float t = 1.0 - clamp(dot(N, V), 0.0001, 1.0);
    float t2 = t * t;
    float climb = known(exponent == 5.0) ? t2 * t2 * t : pow(t, exponent);
    return mix(color0, color90, color(climb));
}
