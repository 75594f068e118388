// Parts of Lama's materials (Pixar, RenderMan; the formulas are those of MaterialX's library).

// GGX roughness along the tangent and across it. Below 0, anisotropy draws the second towards 0, above towards 1.
vector2 lama_roughness(float roughness, float anisotropy)
{
    float room = anisotropy < 0.0 ? roughness : 1.0 - roughness;
    float across = clamp(roughness + anisotropy * room, 0.0, 1.0);
    float alpha = max(roughness * roughness, 0.000001);
    return anisotropy == 0.0 ? vector2(alpha) : vector2(alpha, max(across * across, 0.000001));
}

vector2 lama_roughness_across(float roughness, float across)
{
    float alpha = max(roughness * roughness, 0.000001);
    return across > 0.0 ? vector2(alpha, max(across * across, 0.000001)) : vector2(alpha);
}

// A direction of anisotropy, turned counter-clockwise about the normal, in turns.
vector lama_tangent(vector direction, float rotation, vector normal)
{
    return rotation == 0.0 ? direction : normalize(rotate_about(direction, -360.0 * rotation, normal));
}

// The complex index of a metal: in mode 0 that of its colours, else as given.
void lama_metal(int mode, vector ior, vector extinction, color reflectivity, color edge_color, output color ior_out,
                output color extinction_out)
{
    ior_out = color(ior);
    extinction_out = color(extinction);
    if (mode < 1)
        artistic_ior(reflectivity, edge_color, ior_out, extinction_out);
}

// The index of glass: in mode 0 that of its reflectance face on, else as given.
float lama_index(int mode, float ior, float reflectivity)
{
    float root = sqrt(clamp(reflectivity, 0.0, 0.99));
    return mode < 1 ? (1.0 + root) / (1.0 - root) : ior;
}

// The reflectance face on: in mode 0 as given, else of the index.
color lama_facing(int mode, vector ior, color reflectivity)
{
    vector amplitude = (ior - 1.0) / (ior + 1.0);
    return mode < 1 ? reflectivity : color(amplitude * amplitude);
}

// What fills a body: white light is of the colour given after the radius.
void lama_interior(color absorption_color, float radius, color scatter_color, output vector absorption,
                   output vector scattering)
{
    absorption = vector(log(1.0 / clamp(absorption_color, 0.000001, 1.0))) / max(radius, 0.000001);
    scattering = vector(scatter_color);
}

float lama_sheen_roughness(float roughness)
{
    float kept = 0.1 + 0.9 * roughness;
    return kept * kept;
}
