// Parts of the OpenPBR surface; equations by the names of its specification (ASWF, OpenPBR 1.1).

// GGX roughness along and across the tangent. Their squares keep their mean (section "Microfacet model").
vector2 open_pbr_anisotropy(float roughness, float anisotropy)
{
    float alpha = roughness * roughness;
    float aspect = 1.0 - anisotropy;
    float along = alpha * sqrt(2.0 / (1.0 + aspect * aspect));
    return anisotropy > 0.0 ? vector2(along, aspect * along) : vector2(alpha);
}

// Roughness of a mirror as seen through a coat. Light crosses the coat twice, so that the variances of slopes add up as
// 2 coat + base (section "Roughening").
float open_pbr_coated_roughness(float roughness, float coat_roughness, float coat_weight)
{
    float coat = coat_roughness * coat_roughness;
    float base = roughness * roughness;
    return mix(roughness, sqrt(sqrt(min(base * base + 2.0 * coat * coat, 1.0))), coat_weight);
}

// Index of the base relative to its coat, weakened. Its reflectance face on is `weight` times the true one (section
// "Dielectric base"). A ratio below 1 is inverted, so that nothing is totally reflected ("Total internal reflection").
float open_pbr_coated_ior(float ior, float weight, float coat_ior, float coat_weight)
{
    float ratio = ior / coat_ior;
    float index = mix(ior, max(ratio, 1.0 / ratio), coat_weight);
    float amplitude = (index - 1.0) / (index + 1.0);
    float weighted = sign(amplitude) * sqrt(clamp(weight * amplitude * amplitude, 0.0, 0.99999));
    return (1.0 + weighted) / (1.0 - weighted);
}

// What a coat leaves of the light of its base. It holds back the share K of diffuse light from below, which the base
// reflects again (section "Coat darkening").
color open_pbr_coat_darkening(color albedo, float coat_ior, float amount, float coat_weight)
{
    float amplitude = (coat_ior - 1.0) / (coat_ior + 1.0);
    float K = 1.0 - (1.0 - amplitude * amplitude) / (coat_ior * coat_ior);
    return mix(color(1.0), (1.0 - K) / (1.0 - albedo * K), coat_weight * amount);
}

// What fills a transparent body. Absorption and scattering per length leave `color` of white light at `depth`, and
// `scatter` is the part of the loss that is scattered; where that asks for less than no absorption, all channels absorb
// more (section "Translucent base"). Without a depth there is no medium.
void open_pbr_medium(color color, float depth, color scatter, output vector absorption, output vector scattering)
{
    absorption = vector(0.0);
    scattering = vector(0.0);
    if (depth > 1e-20)
    {
        vector absorbed = (vector(-log(max(color, 0.000001))) - vector(scatter)) / depth;
        float least = min(absorbed.x, min(absorbed.y, absorbed.z));
        absorption = absorbed - min(least, 0.0);
        scattering = vector(scatter) / depth;
    }
}
