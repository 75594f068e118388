// chiang_hair_bsdf: a fibre of glass with tilted scales (Chiang et al., A Practical and Controllable Hair and Fur Model
// for Production Path Tracing, CGF 35(2), 2016; Marschner et al. 2003; d'Eon et al. 2011). Light is mirrored (R), passes
// (TT), is mirrored inside once (TRT) or more often. Each of these lobes is a product of what is left of the light, of a
// distribution of the angle to the plane across the fibre and of one of the azimuth about it, and both of these
// integrate to 1. The normal says where the fibre is hit.

// A fibre as it is seen: x along it, y across it; the sine of the view's inclination; the azimuth of the view, from y
// towards N; the azimuths between the normal and the view, outside and refracted.
void hair_frame(float ior, vector N, vector V, vector curve_direction, output vector x, output vector y,
                output float sine, output float azimuth, output float outside, output float inside)
{
    vector along = curve_direction - dot(curve_direction, N) * N;
    vector other = abs(N.y) < 0.9 ? vector(0.0, 1.0, 0.0) : vector(1.0, 0.0, 0.0);
    x = normalize(dot(along, along) < 0.00000001 ? cross(N, other) : along);
    y = cross(N, x);
    sine = clamp(dot(V, x), -1.0, 1.0);
    float cosine = sqrt(max(1.0 - sine * sine, 0.00000001));
    azimuth = atan2(dot(V, N), dot(V, y));
    float offset = clamp(-dot(V, y) / cosine, -1.0, 1.0);
    outside = asin(offset);
    float bent = sqrt(max(ior * ior - sine * sine, 0.0001)) / cosine;
    inside = asin(clamp(offset / bent, -1.0, 1.0));
}

// What is left of the light in each lobe; their sum is 1 where nothing is absorbed.
void hair_shares(float ior, vector absorption, float sine, float outside, float inside, output color R,
                 output color TT, output color TRT, output color rest)
{
    float cosine = sqrt(max(1.0 - sine * sine, 0.0));
    float mirrored = clamp(fresnel_dielectric(max(cosine * cos(outside), 0.0001), ior), 0.0, 0.9999);
    float steep = sine / max(ior, 0.01);
    float way = 2.0 * cos(inside) / sqrt(max(1.0 - steep * steep, 0.0001));
    color passed = color(exp(-max(absorption, 0.0) * way));
    float entered = 1.0 - mirrored;
    R = color(mirrored);
    TT = entered * entered * passed;
    TRT = TT * passed * mirrored;
    rest = TRT * passed * mirrored / (1.0 - passed * mirrored);
}

// The inclination of the view as a lobe sees it, whose scales are tilted: sine and cosine. cuticle_angle runs from -90
// degrees (0) to 90 (1).
void hair_tilted(float sine, float cuticle_angle, float times, output float tilted, output float cosine)
{
    float tilt = times * 3.14159265 * (cuticle_angle - 0.5);
    float level = sqrt(max(1.0 - sine * sine, 0.0));
    tilted = clamp(sine * cos(tilt) + level * sin(tilt), -1.0, 1.0);
    cosine = abs(level * cos(tilt) - sine * sin(tilt));
}

// exp(-x) I0(x): the modified Bessel function (Abramowitz and Stegun, 9.8.1 and 9.8.2).
float hair_bessel(float x)
{
    float t = x / 3.75;
    float s = t * t;
    float i = 1.0 / max(t, 1.0);
    float low = 1.0 + s * (3.5156229 + s * (3.0899424 + s * (1.2067492 +
                s * (0.2659732 + s * (0.0360768 + s * 0.0045813)))));
    float high = 0.39894228 + i * (0.01328592 + i * (0.00225319 + i * (-0.00157565 + i * (0.00916281 +
                 i * (-0.02057706 + i * (0.02635537 + i * (-0.01647633 + i * 0.00392377)))))));
    return x < 3.75 ? exp(-x) * low : high / sqrt(max(x, 1.0));
}

// Density of the light's inclination for a lobe's variance, per cosine of it (d'Eon et al., section 4.1).
float hair_longitudinal(float light, float sine, float cosine, float variance)
{
    float level = sqrt(max(1.0 - light * light, 0.0)) * cosine;
    float away = (level - light * sine - 1.0) / variance;
    return hair_bessel(level / variance) * exp(min(away, 0.0)) / (variance * (1.0 - exp(-2.0 / variance)));
}

// Density of an azimuth from the middle of a lobe: the logistic distribution, cut to a full turn (Chiang et al., eq. 12).
float hair_azimuthal(float away, float roughness)
{
    float scale = 0.626657069 * roughness;
    float turn = away - 6.28318531 * floor(away * 0.159154943 + 0.5);
    float e = exp(-abs(turn) / scale);
    float cut = exp(-3.14159265 / scale);
    return e * (1.0 + cut) / (scale * (1.0 + e) * (1.0 + e) * (1.0 - cut));
}

// The roughness of a lobe as it is used: variance and scale.
inline vector2 hair_roughness(vector2 roughness)
{
    return clamp(roughness, 0.001, 1.0);
}

// The azimuth at which a lobe leaves, from that of the view, after so many passes through the fibre.
inline float hair_middle(float passes, float outside, float inside)
{
    return passes * (2.0 * inside + 3.14159265) - 2.0 * outside;
}

// Density of a lobe over solid angle, for light of an inclination and an azimuth from the view.
float hair_lobe(float light, float turn, float sine, float cuticle_angle, float times, float middle, vector2 roughness)
{
    vector2 r = hair_roughness(roughness);
    float tilted = 0.0;
    float cosine = 0.0;
    hair_tilted(sine, cuticle_angle, times, tilted, cosine);
    return hair_longitudinal(light, tilted, cosine, r.x) * hair_azimuthal(turn - middle, r.y);
}

// A direction of light of a lobe for three numbers in [0, 1]: the fibre's coordinates, sine of the inclination and
// azimuth from the view.
vector2 hair_direction(vector u, float sine, float cuticle_angle, float times, float middle, vector2 roughness)
{
    vector2 r = hair_roughness(roughness);
    float tilted = 0.0;
    float cosine = 0.0;
    hair_tilted(sine, cuticle_angle, times, tilted, cosine);
    float c = clamp(1.0 + r.x * log(max(u.x + (1.0 - u.x) * exp(-2.0 / r.x), 1e-37)), -1.0, 1.0);
    float light = sqrt(1.0 - c * c) * cos(6.28318531 * u.y) * cosine - c * tilted;
    float scale = 0.626657069 * r.y;
    float cut = 1.0 / (1.0 + exp(3.14159265 / scale));
    float p = clamp(cut + u.z * (1.0 - 2.0 * cut), 1e-7, 0.9999999);
    return vector2(clamp(light, -1.0, 1.0), middle + scale * log(p / (1.0 - p)));
}

// A direction from its inclination and azimuth.
inline vector hair_world(vector2 light, float azimuth, vector x, vector y, vector N)
{
    float turn = azimuth + light.y;
    return light.x * x + sqrt(max(1.0 - light.x * light.x, 0.0)) * (cos(turn) * y + sin(turn) * N);
}

// The environment's light in the middle of a lobe's sample. A sample covers as much of the sphere as the lobe's peak
// says, twofold.
color hair_seen(vector u, float sine, float cuticle_angle, float times, float middle, vector2 roughness, float azimuth,
                vector x, vector y, vector N)
{
    vector2 r = hair_roughness(roughness);
    vector2 light = hair_direction(u, sine, cuticle_angle, times, middle, roughness);
    float density = environment_samples * 0.05 / (r.y * sqrt(r.x));
    float level = environment_mips - 2.5 - 0.5 * log2(density);
    return microfacet_lookup(environment_direction(hair_world(light, azimuth, x, y, N)), level, 1.0);
}

// Light from around the fibre, as what is mirrored more than once inside leaves it: four directions of its ring.
color hair_around(float sine, vector2 roughness, vector x, vector y, vector N)
{
    vector2 r = hair_roughness(roughness);
    // The mean of the inclination's sine, as hair_direction draws it.
    float e = exp(-2.0 / r.x);
    float mean = ((1.0 + e) / (1.0 - e) - r.x) * -sine;
    float level = environment_mips - 2.5 - 0.5 * log2(0.25 / sqrt(r.x));
    color sum = color(0.0);
    for (int i = 0; i < 4; i++)
    {
        vector L = hair_world(vector2(mean, 1.57079633 * i), 0.785398163, x, y, N);
        sum += microfacet_lookup(environment_direction(L), level, 1.0);
    }
    return 0.25 * sum;
}

// Every lobe is sampled as its light is distributed, so that a white world is seen through what is left of the light,
// at any number of samples. Nothing passes to layers below.
void chiang_hair_bsdf_environment(color tint_R, color tint_TT, color tint_TRT, float ior, vector2 roughness_R,
                                  vector2 roughness_TT, vector2 roughness_TRT, float cuticle_angle,
                                  vector absorption_coefficient, vector curve_direction, vector N, vector V,
                                  output color radiance, output color albedo)
{
    vector x = vector(0.0);
    vector y = vector(0.0);
    float sine = 0.0;
    float azimuth = 0.0;
    float outside = 0.0;
    float inside = 0.0;
    hair_frame(ior, N, V, curve_direction, x, y, sine, azimuth, outside, inside);
    color R = color(0.0);
    color TT = color(0.0);
    color TRT = color(0.0);
    color rest = color(0.0);
    hair_shares(ior, absorption_coefficient, sine, outside, inside, R, TT, TRT, rest);
    color mirrored = color(0.0);
    color through = color(0.0);
    color back = color(0.0);
    for (int i = 0; i < environment_samples; i++)
    {
        // An even sequence in the cube (M. Roberts, The Unreasonable Effectiveness of Quasirandom Sequences, 2018).
        vector u = fract(vector((i + 0.5) / environment_samples, 0.5 + 0.7548776662 * i, 0.5 + 0.5698402910 * i));
        mirrored += hair_seen(u, sine, cuticle_angle, 2.0, hair_middle(0.0, outside, inside), roughness_R, azimuth, x,
                              y, N);
        through += hair_seen(u, sine, cuticle_angle, -1.0, hair_middle(1.0, outside, inside), roughness_TT, azimuth, x,
                             y, N);
        back += hair_seen(u, sine, cuticle_angle, -4.0, hair_middle(2.0, outside, inside), roughness_TRT, azimuth, x, y,
                          N);
    }
    color around = hair_around(sine, roughness_TRT, x, y, N);
    color seen = max(tint_R, 0.0) * R * mirrored + max(tint_TT, 0.0) * TT * through + max(tint_TRT, 0.0) * TRT * back;
    radiance = seen / environment_samples + max(tint_TRT, 0.0) * rest * around;
    albedo = color(1.0);
}

// Where the host has blurred its map: the light from the middle of a lobe, as blurred as the lobe is wide.
color hair_blurred(float sine, float cuticle_angle, float times, float middle, vector2 roughness, float azimuth,
                   vector x, vector y, vector N)
{
    vector2 r = hair_roughness(roughness);
    float tilted = 0.0;
    float cosine = 0.0;
    hair_tilted(sine, cuticle_angle, times, tilted, cosine);
    vector L = hair_world(vector2(-tilted, middle), azimuth, x, y, N);
    float alpha = min(sqrt(r.y * sqrt(r.x)), 1.0);
    return environment_lookup(environment_radiance, environment_direction(L), microfacet_blurred(alpha));
}

void chiang_hair_bsdf_environment_prefiltered(color tint_R, color tint_TT, color tint_TRT, float ior,
                                              vector2 roughness_R, vector2 roughness_TT, vector2 roughness_TRT,
                                              float cuticle_angle, vector absorption_coefficient,
                                              vector curve_direction, vector N, vector V, output color radiance,
                                              output color albedo)
{
    vector x = vector(0.0);
    vector y = vector(0.0);
    float sine = 0.0;
    float azimuth = 0.0;
    float outside = 0.0;
    float inside = 0.0;
    hair_frame(ior, N, V, curve_direction, x, y, sine, azimuth, outside, inside);
    color R = color(0.0);
    color TT = color(0.0);
    color TRT = color(0.0);
    color rest = color(0.0);
    hair_shares(ior, absorption_coefficient, sine, outside, inside, R, TT, TRT, rest);
    color mirrored =
        hair_blurred(sine, cuticle_angle, 2.0, hair_middle(0.0, outside, inside), roughness_R, azimuth, x, y, N);
    color through =
        hair_blurred(sine, cuticle_angle, -1.0, hair_middle(1.0, outside, inside), roughness_TT, azimuth, x, y, N);
    color back =
        hair_blurred(sine, cuticle_angle, -4.0, hair_middle(2.0, outside, inside), roughness_TRT, azimuth, x, y, N);
    color around = hair_around(sine, roughness_TRT, x, y, N);
    radiance = max(tint_R, 0.0) * R * mirrored + max(tint_TT, 0.0) * TT * through +
               max(tint_TRT, 0.0) * (TRT * back + rest * around);
    albedo = color(1.0);
}

// Sums the lobes at light from L, each with a weight.
color hair_sum(color R, color TT, color TRT, color rest, float ior, vector2 roughness_R, vector2 roughness_TT,
               vector2 roughness_TRT, float cuticle_angle, float sine, float azimuth, float outside, float inside,
               vector x, vector y, vector N, vector L)
{
    float light = clamp(dot(L, x), -1.0, 1.0);
    float turn = atan2(dot(L, N), dot(L, y)) - azimuth;
    vector2 r = hair_roughness(roughness_TRT);
    float level = sqrt(max(1.0 - sine * sine, 0.0));
    return R * hair_lobe(light, turn, sine, cuticle_angle, 2.0, hair_middle(0.0, outside, inside), roughness_R) +
           TT * hair_lobe(light, turn, sine, cuticle_angle, -1.0, hair_middle(1.0, outside, inside), roughness_TT) +
           TRT * hair_lobe(light, turn, sine, cuticle_angle, -4.0, hair_middle(2.0, outside, inside), roughness_TRT) +
           rest * (0.159154943 * hair_longitudinal(light, sine, level, r.x));
}

// The cosine is the light's to the plane across the fibre, as published.
color chiang_hair_bsdf_eval(color tint_R, color tint_TT, color tint_TRT, float ior, vector2 roughness_R,
                            vector2 roughness_TT, vector2 roughness_TRT, float cuticle_angle,
                            vector absorption_coefficient, vector curve_direction, vector N, vector V, vector L)
{
    vector x = vector(0.0);
    vector y = vector(0.0);
    float sine = 0.0;
    float azimuth = 0.0;
    float outside = 0.0;
    float inside = 0.0;
    hair_frame(ior, N, V, curve_direction, x, y, sine, azimuth, outside, inside);
    color R = color(0.0);
    color TT = color(0.0);
    color TRT = color(0.0);
    color rest = color(0.0);
    hair_shares(ior, absorption_coefficient, sine, outside, inside, R, TT, TRT, rest);
    return hair_sum(max(tint_R, 0.0) * R, max(tint_TT, 0.0) * TT, max(tint_TRT, 0.0) * TRT, max(tint_TRT, 0.0) * rest,
                    ior, roughness_R, roughness_TT, roughness_TRT, cuticle_angle, sine, azimuth, outside, inside, x, y,
                    N, L);
}

// The lobes' shares of samples: what is left of the light of all colours, whatever the tints.
void hair_chances(color R, color TT, color TRT, color rest, output float a, output float b, output float c,
                  output float d)
{
    a = R.r + R.g + R.b;
    b = TT.r + TT.g + TT.b;
    c = TRT.r + TRT.g + TRT.b;
    d = rest.r + rest.g + rest.b;
    float all = a + b + c + d;
    a /= all;
    b /= all;
    c /= all;
    d /= all;
}

// The first number chooses the lobe and then its inclination, the second one's leading digits turn that about the lobe's
// middle, its others are the azimuth.
void chiang_hair_bsdf_sample(float ior, vector2 roughness_R, vector2 roughness_TT, vector2 roughness_TRT,
                             float cuticle_angle, vector absorption_coefficient, vector curve_direction, vector N,
                             vector V, vector2 u, output vector L)
{
    vector x = vector(0.0);
    vector y = vector(0.0);
    float sine = 0.0;
    float azimuth = 0.0;
    float outside = 0.0;
    float inside = 0.0;
    hair_frame(ior, N, V, curve_direction, x, y, sine, azimuth, outside, inside);
    color R = color(0.0);
    color TT = color(0.0);
    color TRT = color(0.0);
    color rest = color(0.0);
    hair_shares(ior, absorption_coefficient, sine, outside, inside, R, TT, TRT, rest);
    float a = 0.0;
    float b = 0.0;
    float c = 0.0;
    float d = 0.0;
    hair_chances(R, TT, TRT, rest, a, b, c, d);
    float digits = u.y * 1024.0;
    float second = (floor(digits) + 0.5) / 1024.0;
    float third = fract(digits);
    vector2 light = vector2(0.0);
    if (u.x < a)
        light = hair_direction(vector(u.x / max(a, 1e-7), second, third), sine, cuticle_angle, 2.0,
                               hair_middle(0.0, outside, inside), roughness_R);
    else if (u.x < a + b)
        light = hair_direction(vector((u.x - a) / max(b, 1e-7), second, third), sine, cuticle_angle, -1.0,
                               hair_middle(1.0, outside, inside), roughness_TT);
    else if (u.x < a + b + c)
        light = hair_direction(vector((u.x - a - b) / max(c, 1e-7), second, third), sine, cuticle_angle, -4.0,
                               hair_middle(2.0, outside, inside), roughness_TRT);
    else
    {
        vector2 any = hair_direction(vector(clamp((u.x - a - b - c) / max(d, 1e-7), 0.0, 1.0), second, third), sine,
                                     cuticle_angle, 0.0, 0.0, roughness_TRT);
        light = vector2(any.x, 6.28318531 * third);
    }
    L = hair_world(light, azimuth, x, y, N);
}

float chiang_hair_bsdf_pdf(float ior, vector2 roughness_R, vector2 roughness_TT, vector2 roughness_TRT,
                           float cuticle_angle, vector absorption_coefficient, vector curve_direction, vector N,
                           vector V, vector L)
{
    vector x = vector(0.0);
    vector y = vector(0.0);
    float sine = 0.0;
    float azimuth = 0.0;
    float outside = 0.0;
    float inside = 0.0;
    hair_frame(ior, N, V, curve_direction, x, y, sine, azimuth, outside, inside);
    color R = color(0.0);
    color TT = color(0.0);
    color TRT = color(0.0);
    color rest = color(0.0);
    hair_shares(ior, absorption_coefficient, sine, outside, inside, R, TT, TRT, rest);
    float a = 0.0;
    float b = 0.0;
    float c = 0.0;
    float d = 0.0;
    hair_chances(R, TT, TRT, rest, a, b, c, d);
    color sum = hair_sum(color(a), color(b), color(c), color(d), ior, roughness_R, roughness_TT, roughness_TRT,
                         cuticle_angle, sine, azimuth, outside, inside, x, y, N, L);
    return sum.r;
}

// What is left of light from everywhere.
color chiang_hair_bsdf_albedo(color tint_R, color tint_TT, color tint_TRT, float ior, vector absorption_coefficient,
                              vector curve_direction, vector N, vector V)
{
    vector x = vector(0.0);
    vector y = vector(0.0);
    float sine = 0.0;
    float azimuth = 0.0;
    float outside = 0.0;
    float inside = 0.0;
    hair_frame(ior, N, V, curve_direction, x, y, sine, azimuth, outside, inside);
    color R = color(0.0);
    color TT = color(0.0);
    color TRT = color(0.0);
    color rest = color(0.0);
    hair_shares(ior, absorption_coefficient, sine, outside, inside, R, TT, TRT, rest);
    return max(tint_R, 0.0) * R + max(tint_TT, 0.0) * TT + max(tint_TRT, 0.0) * (TRT + rest);
}
