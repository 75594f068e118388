// dielectric_bsdf: GGX over a clear interface. scatter_mode "R" mirrors, "T" lets through, "RT" does both.

// A thin film's reflectance is taken once, at the angle of the view, instead of per half vector.
void dielectric_film(float ior, float thinfilm_thickness, float thinfilm_ior, vector N, vector V, output color base,
                     output color rise)
{
    base = color(0.0);
    rise = color(1.0);
    if (thinfilm_thickness > 0.0)
    {
        float NV = clamp(dot(N, V), 0.0001, 1.0);
        color film = fresnel_thin_film(NV, color(ior), color(0.0), thinfilm_thickness, thinfilm_ior);
        base = film;
        rise = color(0.0);
    }
}

// In mode "T" the interface mirrors nothing of its own: what it would mirror belongs to a layer of mode "R" above it,
// which has taken it away already. In mode "RT" it takes it away itself. Nothing passes to layers below either.
void dielectric_bsdf_environment(color tint, float ior, vector2 roughness, boolean retroreflective,
                                 float thinfilm_thickness, float thinfilm_ior, string scatter_mode, vector N, vector V,
                                 vector X, output color radiance, output color albedo)
{
    radiance = color(0.0);
    albedo = color(0.0);
    // An index of 1 is no interface, as that of a base below a coat of the same stuff.
    boolean nothing = known(ior == 1.0 && thinfilm_thickness == 0.0);
    if (!nothing && (scatter_mode == "R" || scatter_mode == "RT"))
    {
        color base = color(0.0);
        color rise = color(0.0);
        dielectric_film(ior, thinfilm_thickness, thinfilm_ior, N, V, base, rise);
        microfacet_reflection(roughness, retroreflective, true, ior, base, rise, color(0.0), color(0.0), 5.0, N, V, X,
                              radiance, albedo);
        radiance *= tint;
    }
    if (scatter_mode == "T" || scatter_mode == "RT")
    {
        color inside = refraction_two_sided ? tint * tint : tint;
        radiance += (1.0 - albedo) * inside * microfacet_refraction(roughness, ior, N, V, X);
        albedo = color(1.0);
    }
}

// Lights do not reach what is seen through the surface.
color dielectric_bsdf_eval(color tint, float ior, vector2 roughness, boolean retroreflective, float thinfilm_thickness,
                           float thinfilm_ior, string scatter_mode, vector N, vector V, vector X, vector L)
{
    if (scatter_mode == "T")
        return color(0.0);
    color base = color(0.0);
    color rise = color(0.0);
    dielectric_film(ior, thinfilm_thickness, thinfilm_ior, N, V, base, rise);
    color none = color(0.0);
    return tint * microfacet_eval(roughness, retroreflective, true, ior, base, rise, none, none, 5.0, N, V, X, L);
}

void dielectric_bsdf_sample(vector2 roughness, boolean retroreflective, vector N, vector V, vector X, vector2 u,
                            output vector L)
{
    microfacet_sample(roughness, retroreflective, N, V, X, u, L);
}

float dielectric_bsdf_pdf(vector2 roughness, boolean retroreflective, vector N, vector V, vector X, vector L)
{
    return microfacet_pdf(roughness, retroreflective, N, V, X, L);
}

// What it reflects of lights. (Layering takes more: what the tint holds back, and all in modes "T" and "RT".)
color dielectric_bsdf_albedo(color tint, float ior, vector2 roughness, float thinfilm_thickness, float thinfilm_ior,
                             string scatter_mode, vector N, vector V, vector X)
{
    if (scatter_mode == "T")
        return color(0.0);
    color base = color(0.0);
    color rise = color(0.0);
    dielectric_film(ior, thinfilm_thickness, thinfilm_ior, N, V, base, rise);
    color none = color(0.0);
    return tint * microfacet_albedo(roughness, true, ior, base, rise, none, none, 5.0, N, V, X);
}
