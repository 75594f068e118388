// What one surface's parameters are for another. (The formulas are those of MaterialX's library.)

// Three channels as one.
inline float mean_of(color c)
{
    return (c.r + c.g + c.b) * 0.333333333;
}

inline void standard_surface_to_usd(float metalness, float base, color base_color, float specular, color specular_color,
                                    float specular_IOR, float specular_roughness, float coat, color coat_color,
                                    float coat_roughness, float subsurface, color subsurface_color, float emission,
                                    color emission_color, color opacity, vector normal, output color diffuseColor_out,
                                    output color emissiveColor_out, output float metallic_out,
                                    output float roughness_out, output float clearcoat_out,
                                    output float clearcoatRoughness_out, output float opacity_out,
                                    output float ior_out, output vector normal_out)
{
    color through_coat = mix(color(1.0), coat_color, coat);
    diffuseColor_out = mix(base_color * base, subsurface_color, subsurface) * through_coat;
    emissiveColor_out = emission_color * emission * through_coat;
    metallic_out = metalness;
    roughness_out = specular_roughness;
    clearcoat_out = mean_of(coat_color * coat);
    clearcoatRoughness_out = coat_roughness;
    opacity_out = mean_of(opacity);
    ior_out = specular_IOR;
    normal_out = (normal - 0.5) * 2.0;
}

// glTF roughens only along the tangent: the roughness across is the roughness, and anisotropy makes up the rest.
inline void standard_surface_to_gltf(
    float base, color base_color, float metalness, float specular, color specular_color, float specular_anisotropy,
    float specular_rotation, float specular_roughness, float specular_IOR, float transmission, color transmission_color,
    float transmission_depth, float transmission_dispersion, float sheen, color sheen_color, float sheen_roughness,
    float coat, color coat_color, float coat_roughness, float emission, color emission_color, vector normal,
    vector tangent, color opacity, boolean thin_walled, float thin_film_thickness, float thin_film_IOR,
    output color base_color_out, output float metallic_out, output float roughness_out, output float specular_out,
    output color specular_color_out, output float ior_out, output float anisotropy_strength_out,
    output float anisotropy_rotation_out, output float transmission_out, output float thickness_out,
    output color attenuation_color_out, output float attenuation_distance_out, output color sheen_color_out,
    output float sheen_roughness_out, output float clearcoat_out, output float clearcoat_roughness_out,
    output float iridescence_out, output float iridescence_ior_out, output float iridescence_thickness_out,
    output float dispersion_out, output color emissive_out, output float emissive_strength_out,
    output vector normal_out, output vector tangent_out, output float alpha_out, output int alpha_mode_out)
{
    boolean has_depth = transmission_depth > 0.0;
    boolean has_film = thin_film_thickness > 0.0;

    // A black coat has no colour of its own.
    boolean is_tinting = coat_color.r + coat_color.g + coat_color.b != 0.0;
    color through_coat = is_tinting ? mix(color(1.0), coat_color, coat) : color(1.0);
    color tint = has_depth ? color(1.0) : transmission_color;
    base_color_out = mix(base_color * base * through_coat, tint, transmission * transmission);
    metallic_out = metalness;

    vector2 alpha = roughness_anisotropy(specular_roughness, specular_anisotropy);
    float room = 1.0 - alpha.y;
    roughness_out = sqrt(alpha.y);
    anisotropy_strength_out = room > 0.0 ? sqrt(max(alpha.x - alpha.y, 0.0) / room) : 0.0;
    anisotropy_rotation_out = specular_rotation * -6.283;
    specular_out = specular;
    specular_color_out = specular_color;
    ior_out = specular_IOR;

    transmission_out = transmission;
    thickness_out = thin_walled ? 0.0 : 1.0;
    attenuation_color_out = transmission > 0.0 && has_depth ? transmission_color : color(1.0);
    attenuation_distance_out = transmission_depth;
    dispersion_out = transmission_dispersion == 0.0 ? 0.0 : 20.0 / nonzero(transmission_dispersion);

    sheen_color_out = sheen_color * sheen;
    sheen_roughness_out = sheen > 0.0 ? sqrt(max(sheen_roughness, 0.0)) : 0.0;
    clearcoat_out = is_tinting ? mean_of(coat_color * coat) : coat;
    clearcoat_roughness_out = coat_roughness;
    iridescence_out = has_film ? 1.0 : 0.0;
    iridescence_ior_out = has_film ? thin_film_IOR : 1.3;
    iridescence_thickness_out = thin_film_thickness;

    emissive_out = emission_color;
    emissive_strength_out = emission;
    normal_out = normal;
    tangent_out = tangent;
    alpha_out = luminance(opacity, color(0.2722287, 0.6740818, 0.0536895));
    alpha_mode_out = alpha_out == 1.0 ? 0 : 2;
}

// The specular weight of OpenPBR dims metals, too; a black specular colour stands for none.
inline void standard_surface_to_open_pbr(
    float base, color base_color, float diffuse_roughness, float metalness, float specular, color specular_color,
    float specular_roughness, float specular_IOR, float specular_anisotropy, float transmission,
    color transmission_color, float transmission_depth, color transmission_scatter,
    float transmission_scatter_anisotropy, float transmission_dispersion, float subsurface, color subsurface_color,
    color subsurface_radius, float subsurface_scale, float subsurface_anisotropy, float sheen, color sheen_color,
    float sheen_roughness, float coat, color coat_color, float coat_roughness, float coat_anisotropy, float coat_IOR,
    float coat_affect_roughness, float thin_film_thickness, float thin_film_IOR, float emission, color emission_color,
    color opacity, boolean thin_walled, output float base_weight_out, output color base_color_out,
    output float base_diffuse_roughness_out, output float base_metalness_out, output float specular_weight_out,
    output color specular_color_out, output float specular_roughness_out, output float specular_ior_out,
    output float specular_roughness_anisotropy_out, output float transmission_weight_out,
    output color transmission_color_out, output float transmission_depth_out, output color transmission_scatter_out,
    output float transmission_scatter_anisotropy_out, output float transmission_dispersion_scale_out,
    output float subsurface_weight_out, output color subsurface_color_out, output float subsurface_radius_out,
    output color subsurface_radius_scale_out, output float subsurface_scatter_anisotropy_out,
    output float fuzz_weight_out, output color fuzz_color_out, output float fuzz_roughness_out,
    output float coat_weight_out, output color coat_color_out, output float coat_roughness_out,
    output float coat_roughness_anisotropy_out, output float coat_ior_out, output float coat_darkening_out,
    output float thin_film_weight_out, output float thin_film_thickness_out, output float thin_film_ior_out,
    output float emission_luminance_out, output color emission_color_out, output float geometry_opacity_out,
    output boolean geometry_thin_walled_out)
{
    base_weight_out = base;
    base_color_out = base_color * mix(color(1.0), coat_color, coat);
    base_diffuse_roughness_out = diffuse_roughness;
    base_metalness_out = metalness;

    boolean is_black = specular_color.r + specular_color.g + specular_color.b == 0.0;
    specular_weight_out = metalness > 0.0 ? 1.0 : specular;
    specular_color_out = is_black ? color(1.0) : specular_color;
    specular_roughness_out = specular_roughness;
    specular_ior_out = specular_IOR;
    specular_roughness_anisotropy_out = specular_anisotropy;

    transmission_weight_out = transmission;
    transmission_color_out = transmission_color;
    transmission_depth_out = transmission_depth;
    transmission_scatter_out = transmission_scatter;
    transmission_scatter_anisotropy_out = transmission_scatter_anisotropy;
    transmission_dispersion_scale_out = transmission_dispersion;

    subsurface_weight_out = subsurface;
    subsurface_color_out = subsurface_color;
    subsurface_radius_out = subsurface_scale;
    subsurface_radius_scale_out = subsurface_radius;
    subsurface_scatter_anisotropy_out = subsurface_anisotropy;

    fuzz_weight_out = sheen;
    fuzz_color_out = sheen_color;
    fuzz_roughness_out = pow(max(sheen_roughness, 0.0), 0.4);

    // On metal the coat's colour is the metal's; it must not tint twice.
    coat_weight_out = coat * metalness > 0.0 ? 0.0 : coat;
    coat_color_out = coat_color;
    coat_roughness_out = coat_roughness;
    coat_roughness_anisotropy_out = coat_anisotropy;
    coat_ior_out = coat_IOR;
    coat_darkening_out = coat_affect_roughness;

    // Nanometres become micrometres.
    thin_film_weight_out = thin_film_thickness > 0.0 ? 1.0 : 0.0;
    thin_film_thickness_out = thin_film_thickness * 0.001;
    thin_film_ior_out = thin_film_IOR;

    emission_luminance_out = emission;
    emission_color_out = emission_color;
    geometry_opacity_out = opacity.r;
    geometry_thin_walled_out = thin_walled;
}

inline void open_pbr_to_standard_surface(
    float base_weight, color base_color, float base_diffuse_roughness, float base_metalness, float specular_weight,
    color specular_color, float specular_roughness, float specular_ior, float specular_roughness_anisotropy,
    float transmission_weight, color transmission_color, float transmission_depth, color transmission_scatter,
    float transmission_scatter_anisotropy, float transmission_dispersion_scale, float subsurface_weight,
    color subsurface_color, float subsurface_radius, color subsurface_radius_scale,
    float subsurface_scatter_anisotropy, float fuzz_weight, color fuzz_color, float fuzz_roughness, float coat_weight,
    color coat_color, float coat_roughness, float coat_roughness_anisotropy, float coat_ior, float coat_darkening,
    float thin_film_weight, float thin_film_thickness, float thin_film_ior, float emission_luminance,
    color emission_color, float geometry_opacity, boolean geometry_thin_walled, output float base_out,
    output color base_color_out, output float diffuse_roughness_out, output float metalness_out,
    output float specular_out, output color specular_color_out, output float specular_roughness_out,
    output float specular_IOR_out, output float specular_anisotropy_out, output float transmission_out,
    output color transmission_color_out, output float transmission_depth_out, output color transmission_scatter_out,
    output float transmission_scatter_anisotropy_out, output float transmission_dispersion_out,
    output float subsurface_out, output color subsurface_color_out, output color subsurface_radius_out,
    output float subsurface_scale_out, output float subsurface_anisotropy_out, output float sheen_out,
    output color sheen_color_out, output float sheen_roughness_out, output float coat_out, output color coat_color_out,
    output float coat_roughness_out, output float coat_anisotropy_out, output float coat_IOR_out,
    output float coat_affect_roughness_out, output float thin_film_thickness_out, output float thin_film_IOR_out,
    output float emission_out, output color emission_color_out, output color opacity_out,
    output boolean thin_walled_out)
{
    // What the coat takes from a base of about this albedo.
    color matte = mix(base_color, subsurface_color, subsurface_weight);
    color albedo = mix(matte, base_color * specular_weight, base_metalness);
    color darkened = open_pbr_coat_darkening(albedo, max(coat_ior, 0.01), coat_darkening, coat_weight);

    base_out = base_weight;
    base_color_out = base_color * darkened;
    diffuse_roughness_out = base_diffuse_roughness;
    metalness_out = base_metalness;

    specular_out = specular_weight;
    specular_color_out = specular_color;
    specular_roughness_out = mix(specular_roughness, coat_roughness, coat_weight);
    specular_IOR_out = specular_ior;
    specular_anisotropy_out = specular_roughness_anisotropy;

    transmission_out = transmission_weight;
    transmission_color_out = transmission_color;
    transmission_depth_out = transmission_depth;
    transmission_scatter_out = transmission_scatter;
    transmission_scatter_anisotropy_out = transmission_scatter_anisotropy;
    transmission_dispersion_out = transmission_dispersion_scale;

    subsurface_out = subsurface_weight;
    subsurface_color_out = subsurface_color * darkened;
    subsurface_radius_out = subsurface_radius_scale;
    subsurface_scale_out = subsurface_radius;
    subsurface_anisotropy_out = subsurface_scatter_anisotropy;

    sheen_out = fuzz_weight;
    sheen_color_out = fuzz_color;
    sheen_roughness_out = pow(max(fuzz_roughness, 0.0), 2.5);

    coat_out = coat_weight;
    coat_color_out = coat_color;
    coat_roughness_out = coat_roughness;
    coat_anisotropy_out = coat_roughness_anisotropy;
    coat_IOR_out = coat_ior;
    coat_affect_roughness_out = 1.0;

    // Micrometres become nanometres.
    thin_film_thickness_out = thin_film_weight > 0.0 ? thin_film_thickness * 1000.0 : 0.0;
    thin_film_IOR_out = thin_film_ior;

    emission_out = emission_luminance;
    emission_color_out = emission_color;
    opacity_out = color(geometry_opacity);
    thin_walled_out = geometry_thin_walled;
}
