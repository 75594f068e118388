// Surfaces of microscopic mirrors: GGX slopes with the height-correlated masking and shadowing of Smith (Heitz 2014).
// Directions named in small letters are in the frame (x, y, N) of the surface; alpha is the roughness along x and y,
// its third component 1, so that alpha * v is v stretched to where the surface has roughness 1.

// Below this the lobe is a mirror to any picture, and its density would leave the range of float.
vector microfacet_alpha(vector2 roughness)
{
    return vector(clamp(roughness, 0.0001, 1.0), 1.0);
}

// The frame in which roughness is given. An isotropic surface has no preferred tangent: its x is V laid down into the
// surface, so that nothing needs the tangent of the mesh. Looking straight down, any x will do.
inline void microfacet_frame(vector2 roughness, vector N, vector V, vector X, output vector x, output vector y)
{
    vector tangent = roughness.x == roughness.y ? V : X;
    tangent -= dot(tangent, N) * N;
    vector other = abs(N.y) < 0.9 ? vector(0.0, 1.0, 0.0) : vector(1.0, 0.0, 0.0);
    x = normalize(dot(tangent, tangent) < 0.00000001 ? cross(N, other) : tangent);
    y = cross(N, x);
}

// Direction number i over the cap of visible normals (Dupuy and Benyoub 2023, algorithm 2). The cap of the
// unit sphere is that of a view s, stretched and made unit: the half vector, stretched, is s plus a point of the sphere.
// Heights descend evenly; `azimuth` is a direction.
inline vector microfacet_cap(int i, vector2 azimuth, float descent, vector s)
{
    float z = 1.0 - (i + 0.5) * descent;
    return vector(azimuth * sqrt(1.0 - z * z), z) + s;
}

// A direction in the plane, turned by the golden angle.
vector2 golden_turn(vector2 d)
{
    return -0.737368878 * d + vector2(-0.675490294, 0.675490294) * vector2(d.y, d.x);
}

// The level of detail of samples, but for what differs from one to the next. Each of n samples covers 1 / (n pdf) of the
// sphere (Krivanek and Colbert 2008; GPU Gems 3, chapter 20, eq. 13). Here pdf = ratio^2 / (2 pi ax ay (NV +
// stretched)), where ratio = |h|^2 / |stretched h|^2 of an unnormalised half vector h.
inline float microfacet_level(vector alpha, float reach)
{
    float density = environment_samples / (6.28318531 * alpha.x * alpha.y * reach);
    return environment_mips - 2.5 - 0.5 * log2(density);
}

// Light from the direction d of the map, at the level for its sample. Halfway between two levels they are mixed, near
// one of them it is read alone, which is much faster: the samples, each at a level of its own, mix the rest.
inline color microfacet_lookup(vector d, float level, float ratio)
{
    float r2 = ratio * ratio;
    // 1.00001 instead of 1: the poles keep a finite level.
    float best = max(level - 0.25 * log2(r2 * r2 * (1.00001 - d.y * d.y)), 0.0);
    float whole = floor(best);
    return environment_lookup(environment_radiance, d, whole + clamp(32.0 * (best - whole) - 15.5, 0.0, 1.0));
}

// E: what white GGX reflects in one bounce to a view at cosine NV. Fitted by tools/fit to E by quadrature.
inline float microfacet_white(float NV, float alpha)
{
    float scale = NV * alpha / (NV * NV + alpha * alpha * (0.792037 + 3.68834 * NV));
    float lost = 0.218505 - 0.207071 * NV + alpha * (1.3982 * NV + 2.44659 * alpha);
    return clamp(1.0 - scale * lost, 0.01, 1.0);
}

// The cosine at which reflectance is what it is in the mean over the bounces to a view at cosine NV. Fitted by
// tools/fit.
float microfacet_cosine(float NV, float alpha)
{
    float up = 8.40215 * alpha - NV * (0.45666 + 1.95084 * NV + 2.88335 * alpha);
    float down = NV + alpha * (3.17524 + 16.0143 * alpha + 21.3677 * NV);
    return clamp(NV + alpha * up / down, 0.0, 1.0);
}

// The one roughness that stands for both where shadows and further bounces are concerned, as other programs have it.
float microfacet_mean(vector2 roughness)
{
    return sqrt(clamp(roughness.x, 0.0001, 1.0) * clamp(roughness.y, 0.0001, 1.0));
}

// Length of a unit direction at cosine c to the normal, stretched by one roughness: Smith's terms are made of it.
float microfacet_stretch(float alpha, float c)
{
    return sqrt(mix(c * c, 1.0, alpha * alpha));
}

// Reflectance at cosine c. A clear interface has its exact one between base and base + rise. Others follow a curve
// (fresnel_curve), which has the exponent 5 unless a material says otherwise.
inline color microfacet_fresnel(boolean clear, float ior, color base, color rise, color bend, color dip, float exponent,
                         float c)
{
    float t = max(1.0 - c, 0.0);
    float t2 = t * t;
    float t4 = t2 * t2;
    float climb = clear ? fresnel_dielectric(c, ior) : (exponent == 5.0 ? t4 * t : pow(t, exponent));
    color F = base + rise * climb + (bend + dip * t4) * (c * t2);
    return known(clear) ? F : clamp(F, 0.0, 1.0);
}

// The environment's light in a GGX lobe, by samples of visible normals.
//
// What refracts is a solid sphere (microfacet_refraction). Mirrored light weighs G2 / G1, and the sum is divided by the
// sum of these weights and multiplied by the directional albedo: so a white furnace gains nothing at any n. After
// Turquin 2019 the albedo is that of one bounce, E times the mean reflectance, and of all further ones, which lose what
// is missing in E but for a further factor of mean reflectance. E, the share that a white surface mirrors in one bounce,
// comes from the same samples.
void microfacet_light(vector2 roughness, boolean refracts, boolean retroreflective, boolean clear, float ior, color base,
                      color rise, color bend, color dip, float exponent, vector N, vector V, vector X,
                      output color radiance, output color albedo)
{
    boolean isotropic = roughness.x == roughness.y;
    vector x = vector(0.0);
    vector y = vector(0.0);
    microfacet_frame(roughness, N, V, X, x, y);
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    vector alpha = microfacet_alpha(roughness);
    vector v = known(isotropic) ? vector(sqrt(1.0 - NV * NV), 0.0, NV) : vector(dot(V, x), dot(V, y), NV);
    vector wide = alpha * v;
    float stretched = length(wide);
    vector s = wide / stretched;
    float mean = known(isotropic) ? alpha.x : sqrt(alpha.x * alpha.y);
    float toView = known(isotropic) ? stretched : microfacet_stretch(mean, NV);
    float count = environment_samples;
    float descent = (1.0 + s.z) / count;
    float reach = NV + stretched;
    float level = microfacet_level(alpha, reach);
    // A retroreflector sends the same lobe to where the light came from.
    if (retroreflective)
    {
        x = -x;
        y = -y;
    }
    matrix33 frame = matrix33(environment_matrix) * matrix33(x, y, N);
    vector away = refracts ? v : -v;
    vector2 azimuth = vector2(1.0, 0.0);
    float total = 0.00000001;
    color light = color(0.0);
    color share = color(0.0);
    for (int i = 0; i < environment_samples; i++)
    {
        vector h = microfacet_cap(i, azimuth, descent, s);
        vector slope = alpha * h;
        vector H = normalize(slope);
        // Through the sphere light turns as much at the far side as at the near one: it leaves where a mirror along its
        // way inside would send the view.
        vector L = reflect(away, refracts ? refract(-v, H, 1.0 / ior) : H);
        float NL = max(L.z, 0.0);
        float weight = refracts ? 1.0 : NL / (toView * NL + NV * microfacet_stretch(mean, NL));
        color F = weight * microfacet_fresnel(clear, ior, base, rise, bend, dip, exponent, dot(v, H));
        color seen = microfacet_lookup(frame * L, level, dot(slope, slope) / dot(h, h));
        azimuth = golden_turn(azimuth);
        total += weight;
        share += F;
        light += F * seen;
    }
    float E = min(total * reach / count, 1.0);
    color once = share / total;
    // What an anisotropic lobe throws below the horizon beyond what an isotropic one would is lost, as shadows are. This
    // makes 1 of refracted light, of which nothing is lost, too.
    float white = refracts || isotropic ? E : microfacet_white(NV, mean);
    color kept = mix(once, color(1.0), white) * (known(isotropic) ? 1.0 : min(E / white, 1.0));
    color bounces = known(refracts) && refracts ? color(1.0) : kept;
    radiance = light * (bounces / total);
    albedo = once * bounces;
}

void microfacet_reflection(vector2 roughness, boolean retroreflective, boolean clear, float ior, color base, color rise,
                           color bend, color dip, float exponent, vector N, vector V, vector X, output color radiance,
                           output color albedo)
{
    microfacet_light(roughness, false, retroreflective, clear, ior, base, rise, bend, dip, exponent, N, V, X, radiance,
                     albedo);
}

// Light that comes through a solid sphere: in at the near side with the half vector H, along R inside, out at the far
// side, whose normal there is 2 dot(R, H) R - H. What the surface mirrors instead is not taken away here.
color microfacet_refraction(vector2 roughness, float ior, vector N, vector V, vector X)
{
    color none = color(0.0);
    color radiance = none;
    color albedo = none;
    microfacet_light(roughness, true, false, false, ior, color(1.0), none, none, none, 5.0, N, V, X, radiance, albedo);
    return radiance;
}

// Where the host has blurred the levels of its map for a roughness: the level that hosts agreed on, whose blur grows as
// the root of the roughness at first.
float microfacet_blurred(float alpha)
{
    return (alpha < 0.25 ? sqrt(alpha) : 0.5 * alpha + 0.375) * (environment_mips - 1);
}

// Stands in for microfacet_light where maps are prefiltered: the light from where a mirror, or one ray through the
// sphere, leads the view; of a reflection times the directional albedo, by the fits.
void microfacet_light_prefiltered(vector2 roughness, boolean refracts, boolean retroreflective, boolean clear,
                                  float ior, color base, color rise, color bend, color dip, float exponent, vector N,
                                  vector V, vector X, output color radiance, output color albedo)
{
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    float mean = microfacet_mean(roughness);
    vector L = retroreflective ? V : reflect(-V, N);
    albedo = color(1.0);
    if (refracts)
        L = reflect(V, refract(-V, N, 1.0 / ior));
    else
    {
        color once = microfacet_fresnel(clear, ior, base, rise, bend, dip, exponent, microfacet_cosine(NV, mean));
        albedo = once * mix(once, color(1.0), microfacet_white(NV, mean));
    }
    radiance = albedo * environment_lookup(environment_radiance, environment_direction(L), microfacet_blurred(mean));
}

// Density D of the half vector H under GGX. Where there is one roughness, the sine comes from a cross product: taken
// from the cosine it would lose all digits on a smooth surface.
float microfacet_density(vector2 roughness, vector N, vector V, vector X, vector H)
{
    if (known(roughness.x == roughness.y))
    {
        float one = clamp(roughness.x, 0.0001, 1.0);
        float c = dot(N, H);
        vector tilt = cross(N, H);
        float spread = dot(tilt, tilt) / one + c * c * one;
        return 0.318309886 / (spread * spread);
    }
    vector x = vector(0.0);
    vector y = vector(0.0);
    microfacet_frame(roughness, N, V, X, x, y);
    vector alpha = microfacet_alpha(roughness);
    vector h = vector(dot(H, x), dot(H, y), dot(H, N)) / alpha;
    float q = dot(h, h);
    return 0.318309886 / (alpha.x * alpha.y * q * q);
}

// Length of a unit direction d, stretched by alpha; c is its cosine to the normal.
float microfacet_length(vector2 roughness, vector N, vector X, vector d, float c)
{
    if (known(roughness.x == roughness.y))
        return microfacet_stretch(clamp(roughness.x, 0.0001, 1.0), c);
    vector x = vector(0.0);
    vector y = vector(0.0);
    microfacet_frame(roughness, N, d, X, x, y);
    return length(microfacet_alpha(roughness) * vector(dot(d, x), dot(d, y), c));
}

// E: at least what white GGX reflects in one bounce to a view at cosine NV, which has the length toView when stretched.
// Fitted by tools/fit over t = NV / toView; never below E, so that nothing is gained, and above it by 1.2 % at most
// where there is one roughness, by up to 16 % where the two differ tenfold.
float microfacet_energy(vector2 roughness, float NV, float toView)
{
    vector alpha = microfacet_alpha(roughness);
    float x2 = alpha.x * alpha.x;
    float y2 = alpha.y * alpha.y;
    float square = 0.4 * (x2 + y2) + 0.2 * alpha.x * alpha.y;
    float z = square / (square + 0.5);
    float t = NV / toView;
    float lost = 1.22043 + z * (-0.159009 + z * (-5.24541 + 3.66578 * z)) +
                 t * (-3.26255 + z * (3.54124 + z * (8.09339 - 4.23369 * z)) +
                      t * (4.29676 + z * (-6.66177 - 1.92236 * z) + t * (-2.25195 + 3.95304 * z))) +
                 log(t) * (0.309672 + z * (-0.585627 - 2.14011 * z));
    float apart = known(roughness.x == roughness.y) ? 0.0 : abs(x2 - y2) / (x2 + y2);
    float above = 1.0056 + 0.045 * apart;
    return clamp((1.0 - t * lost) * above, 0.01, 1.0);
}

// What all bounces reflect per light of the first one, after Turquin 2019: the first loses 1 - E, of which the mean
// reflectance comes back.
color microfacet_further(color mean, float E)
{
    return 1.0 + mean * (1.0 / E - 1.0);
}

// One bounce off white: D G2 / (4 NV), which is cosine times reflectance. Divided by NL it is the same for V and L
// exchanged.
float microfacet_bounce(vector2 roughness, vector N, vector V, vector X, vector L, vector H, float NV, float toView)
{
    float NL = max(dot(N, L), 0.0);
    float shadow = NL * toView + NV * microfacet_length(roughness, N, X, L, NL);
    return 0.5 * NL * microfacet_density(roughness, N, V, X, H) / max(shadow, 0.00000001);
}

// Reflectance times cosine for light from L (unit weight): one bounce, raised by the further ones. One bounce is
// reciprocal, unless a thin film's reflectance was taken at the view; how much the further ones add depends on the view
// alone. White matter reflects no more than it gets.
color microfacet_eval(vector2 roughness, boolean retroreflective, boolean clear, float ior, color base, color rise,
                      color bend, color dip, float exponent, vector N, vector V, vector X, vector L)
{
    vector light = retroreflective ? reflect(-L, N) : L;
    vector H = normalize(V + light);
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    float toView = microfacet_length(roughness, N, X, V, NV);
    color F = microfacet_fresnel(clear, ior, base, rise, bend, dip, exponent, dot(V, H));
    float c = microfacet_cosine(NV, microfacet_mean(roughness));
    color mean = microfacet_fresnel(clear, ior, base, rise, bend, dip, exponent, c);
    return microfacet_bounce(roughness, N, V, X, light, H, NV, toView) * F *
           microfacet_further(mean, microfacet_energy(roughness, NV, toView));
}

// The integral of microfacet_eval over L. One bounce is integrated over the half vectors that mirror light from above
// the horizon, in polar coordinates of the slopes h.xy / h.z, stretched by 1 / alpha: along each azimuth they reach to
// the larger root of a quadratic equation, the limit. Off by less than 0.001 where roughness is 0.05 and more, NV 0.1
// and more and ior 1 and more.
color microfacet_albedo(vector2 roughness, boolean clear, float ior, color base, color rise, color bend, color dip,
                        float exponent, vector N, vector V, vector X)
{
    vector x = vector(0.0);
    vector y = vector(0.0);
    microfacet_frame(roughness, N, V, X, x, y);
    vector alpha = microfacet_alpha(roughness);
    vector v = vector(dot(V, x), dot(V, y), clamp(dot(N, V), 0.0001, 1.0));
    float toView = length(alpha * v);
    color once = color(0.0);
    for (int j = 0; j < 48; j++)
    {
        float azimuth = 0.130899694 * (j + 0.5);
        vector aside = alpha * vector(cos(azimuth), sin(azimuth), 0.0);
        float a = dot(aside, aside);
        float b = dot(aside, v) / v.z;
        float root = sqrt(b * b + a);
        float limit = atan(b > 0.0 ? (b + root) / a : 1.0 / (root - b));
        for (int i = 0; i < 32; i++)
        {
            // Denser towards the limit, where shadows fall.
            float left = 1.0 - 0.03125 * (i + 0.5);
            float tilt = limit * (1.0 - left * sqrt(left));
            vector h = sin(tilt) * aside + vector(0.0, 0.0, cos(tilt));
            vector l = reflect(-v, normalize(h));
            float NL = max(l.z, 0.0);
            float VH = dot(v, normalize(h));
            float weight = limit * sqrt(left) * sin(tilt) * length(h) * VH * NL /
                           max(NL * toView + v.z * length(alpha * l), 0.00000001);
            once += weight * microfacet_fresnel(clear, ior, base, rise, bend, dip, exponent, VH);
        }
    }
    float c = microfacet_cosine(v.z, microfacet_mean(roughness));
    color mean = microfacet_fresnel(clear, ior, base, rise, bend, dip, exponent, c);
    return once * microfacet_further(mean, microfacet_energy(roughness, v.z, toView)) / 256.0;
}

// A direction of light for the two numbers u in [0, 1), by visible normals; below the surface it carries nothing.
void microfacet_sample(vector2 roughness, boolean retroreflective, vector N, vector V, vector X, vector2 u,
                       output vector L)
{
    vector x = vector(0.0);
    vector y = vector(0.0);
    microfacet_frame(roughness, N, V, X, x, y);
    vector alpha = microfacet_alpha(roughness);
    vector v = vector(dot(V, x), dot(V, y), clamp(dot(N, V), 0.0001, 1.0));
    vector s = normalize(alpha * v);
    float azimuth = 6.28318531 * u.x;
    float z = 1.0 - u.y * (1.0 + s.z);
    vector h = vector(vector2(cos(azimuth), sin(azimuth)) * sqrt(max(1.0 - z * z, 0.0)), z) + s;
    vector l = reflect(-v, normalize(alpha * h));
    if (retroreflective)
        l = vector(-l.x, -l.y, l.z);
    L = l.x * x + l.y * y + l.z * N;
}

// Density over solid angle of what microfacet_sample returns: its integral over the whole sphere is 1.
float microfacet_pdf(vector2 roughness, boolean retroreflective, vector N, vector V, vector X, vector L)
{
    vector x = vector(0.0);
    vector y = vector(0.0);
    microfacet_frame(roughness, N, V, X, x, y);
    float NV = clamp(dot(N, V), 0.0001, 1.0);
    float stretched = length(microfacet_alpha(roughness) * vector(dot(V, x), dot(V, y), NV));
    vector light = retroreflective ? reflect(-L, N) : L;
    vector H = normalize(V + light);
    return dot(N, H) > 0.0 ? 0.5 * microfacet_density(roughness, N, V, X, H) / (NV + stretched) : 0.0;
}
