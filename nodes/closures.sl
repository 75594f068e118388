// Parameters of closures, and what is emitted.

// GGX roughness along and across the tangent. A lobe stretched by the anisotropy keeps its roughness as the geometric
// mean.
vector2 roughness_anisotropy(float roughness, float anisotropy) {
    float alpha = roughness * roughness;
    float aspect = sqrt(1.0 - clamp(anisotropy, 0.0, 0.98));
    return anisotropy > 0.0 ? vector2(min(alpha / aspect, 1.0), alpha * aspect) : vector2(alpha);
}

// A second roughness below 0 stands for "as the first".
vector2 roughness_dual(vector2 roughness) {
    float x = roughness.x * roughness.x;
    return vector2(x, roughness.y < 0.0 ? x : roughness.y * roughness.y);
}

// The complex index of refraction of a metal from its colour face on and at the edge. (O. Gulbrandsen, Artist Friendly
// Metallic Fresnel, JCGT 2014, equations 5 and 6.)
void artistic_ior(color reflectivity, color edge_color, output color ior, output color extinction) {
    color r = clamp(reflectivity, 0.0, 0.99);
    color root = sqrt(r);
    color n = mix((1.0 + root) / (1.0 - root), (1.0 - r) / (1.0 + r), edge_color);
    color above = n + 1.0;
    color below = n - 1.0;
    ior = n;
    extinction = sqrt(max((above * above * r - below * below) / (1.0 - r), 0.0));
}

// Emission seen through a layer that lets through `color0` face on and `color90` at the edge (Schlick's shape).
EDF schlick_emission(color color0, color color90, float exponent, EDF base) {
    vector N = normalize(normal_world);
    vector V = normalize(vector(view_position) - vector(position_world));
    return base * mix(color0, color90, pow(1.0 - abs(dot(N, V)), exponent));
}

// The colour of a black body in linear Rec. 709 at luminance 1 (or black where a channel would be negative). The locus
// of temperatures is the cubic fit of Kang et al. 2002 (Design of Advanced Color Temperature Control System for HDTV
// Applications), good from 1,667 K to 25,000 K and smooth enough down to 800 K.
color blackbody(float temperature) {
    float kelvin = clamp(temperature, 800.0, 25000.0);
    float t = 1000.0 / kelvin;
    float x = kelvin < 4000.0 ? ((-0.2661239 * t - 0.2343580) * t + 0.8776956) * t + 0.179910
                              : ((-3.0258469 * t + 2.1070379) * t + 0.2226347) * t + 0.240390;
    float y = kelvin < 2222.0   ? ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683
              : kelvin < 4000.0 ? ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867
                                : ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
    // CIE XYZ at luminance 1, then the primaries of Rec. 709.
    float safe_y = max(y, 1e-6);
    vector xyz = vector(x / safe_y, 1.0, (1.0 - x - y) / safe_y);
    vector rgb = matrix33(vector(3.2406, -0.9689, 0.0557), vector(-1.5372, 1.8758, -0.2040),
                          vector(-0.4986, 0.0415, 1.0570)) * xyz;
    return color(max(rgb, 0.0));
}

// A cone of light about the normal: full within the inner angle, none beyond the outer one. Angles are those of the
// whole cone, in degrees; an outer angle below the inner one makes a hard edge.
color conical_edf_emission(color color, vector normal, float inner_angle, float outer_angle) {
    vector V = normalize(vector(view_position) - vector(position_world));
    float cosine = dot(normalize(normal), V);
    float inner = cos(radians(inner_angle * 0.5));
    float outer = cos(radians(max(outer_angle, inner_angle + 0.01) * 0.5));
    return color * smoothstep(outer, inner, cosine);
}

// Roughness of the three lobes of hair, from perceptual to variances (Chiang et al., A Practical and Controllable Hair
// and Fur Model for Production Path Tracing, EGSR 2016, equations 7 and 8).
void chiang_hair_roughness(float longitudinal, float azimuthal, float scale_TT, float scale_TRT,
                           output vector2 roughness_R, output vector2 roughness_TT, output vector2 roughness_TRT) {
    float l = clamp(longitudinal, 0.001, 1.0);
    float a = clamp(azimuthal, 0.001, 1.0);
    float deviation = 0.726 * l + 0.812 * l * l + 3.7 * pow(l, 20.0);
    float variance = deviation * deviation;
    float spread = 0.265 * a + 1.194 * a * a + 5.372 * pow(a, 22.0);
    roughness_R = vector2(variance, spread);
    roughness_TT = vector2(variance * scale_TT * scale_TT, spread);
    roughness_TRT = vector2(variance * scale_TRT * scale_TRT, spread);
}

// The absorption of hair from the colour it has after multiple scattering (the same, equation 9).
vector chiang_hair_absorption(color hair_color, float b) {
    float scale = 5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + b * 0.245))));
    vector root = vector(log(clamp(hair_color, 0.001, 1.0))) / scale;
    return root * root;
}

// The absorption of hair from its melanin (d'Eon et al., An Energy-Conserving Hair Reflectance Model, EGSR 2011).
vector melanin_absorption(float concentration, float redness, color eumelanin, color pheomelanin) {
    float melanin = -log(max(1.0 - concentration, 0.0001));
    color absorbed = mix(-log(max(eumelanin, 1e-30)), -log(max(pheomelanin, 1e-30)), redness);
    return max(vector(melanin * absorbed), 0.0);
}
