// conductor_bsdf: GGX over a metal of index ior + i extinction. Nothing passes below it.

// Reflectance as a curve (fresnel_curve). A thin film's is taken once, at the angle of the view, instead of per half
// vector.
void conductor_curve(color ior, color extinction, float thinfilm_thickness, float thinfilm_ior, vector N, vector V,
                     output color base, output color rise, output color bend, output color dip)
{
    if (thinfilm_thickness > 0.0)
    {
        float NV = clamp(dot(N, V), 0.0001, 1.0);
        color film = fresnel_thin_film(NV, ior, extinction, thinfilm_thickness, thinfilm_ior);
        base = film;
        rise = color(0.0);
        bend = color(0.0);
        dip = color(0.0);
    }
    else
    {
        base = fresnel_reflectance(1.0, ior, extinction);
        color F60 = fresnel_conductor(0.5, ior, extinction);
        color F82 = fresnel_conductor(0.142857143, ior, extinction);
        fresnel_curve(base, F60, F82, rise, bend, dip);
    }
}

void conductor_bsdf_environment(color ior, color extinction, vector2 roughness, boolean retroreflective,
                                float thinfilm_thickness, float thinfilm_ior, vector N, vector V, vector X,
                                output color radiance, output color albedo)
{
    color base = color(0.0);
    color rise = color(0.0);
    color bend = color(0.0);
    color dip = color(0.0);
    conductor_curve(ior, extinction, thinfilm_thickness, thinfilm_ior, N, V, base, rise, bend, dip);
    microfacet_reflection(roughness, retroreflective, false, 1.0, base, rise, bend, dip, 5.0, N, V, X, radiance,
                          albedo);
    albedo = color(1.0);
}

color conductor_bsdf_eval(color ior, color extinction, vector2 roughness, boolean retroreflective,
                          float thinfilm_thickness, float thinfilm_ior, vector N, vector V, vector X, vector L)
{
    color base = color(0.0);
    color rise = color(0.0);
    color bend = color(0.0);
    color dip = color(0.0);
    conductor_curve(ior, extinction, thinfilm_thickness, thinfilm_ior, N, V, base, rise, bend, dip);
    return microfacet_eval(roughness, retroreflective, false, 1.0, base, rise, bend, dip, 5.0, N, V, X, L);
}

void conductor_bsdf_sample(vector2 roughness, boolean retroreflective, vector N, vector V, vector X, vector2 u,
                           output vector L)
{
    microfacet_sample(roughness, retroreflective, N, V, X, u, L);
}

float conductor_bsdf_pdf(vector2 roughness, boolean retroreflective, vector N, vector V, vector X, vector L)
{
    return microfacet_pdf(roughness, retroreflective, N, V, X, L);
}

// What it reflects. (Layering takes 1: what is not reflected is absorbed.)
color conductor_bsdf_albedo(color ior, color extinction, vector2 roughness, float thinfilm_thickness,
                            float thinfilm_ior, vector N, vector V, vector X)
{
    color base = color(0.0);
    color rise = color(0.0);
    color bend = color(0.0);
    color dip = color(0.0);
    conductor_curve(ior, extinction, thinfilm_thickness, thinfilm_ior, N, V, base, rise, bend, dip);
    return microfacet_albedo(roughness, false, 1.0, base, rise, bend, dip, 5.0, N, V, X);
}
