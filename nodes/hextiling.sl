// Images in blended hexagonal tiles, each turned, scaled and moved at random, that hide their repetition (M. Mikkelsen,
// Practical Real-Time Hex-Tiling, JCGT 11(3), 2022).

// Two random numbers for a tile (D. Hoskins, Hash without Sine).
vector2 hex_random(vector2 tile) {
    vector p = fract(vector(tile.x, tile.y, tile.x) * vector(0.1031, 0.1030, 0.0973));
    p += dot(p, vector(p.y, p.z, p.x) + 33.33);
    return fract((vector2(p.x, p.x) + vector2(p.y, p.z)) * vector2(p.z, p.y));
}

// The three tiles that reach a point, the corners of the triangle around it in a skewed grid, and its barycentric
// coordinates.
void hex_corners(vector2 coord, output vector2 tile1, output vector2 tile2, output vector2 tile3,
                 output vector weights) {
    vector2 grid = coord * 3.4641016;
    vector2 skewed = vector2(grid.x - 0.57735027 * grid.y, 1.15470054 * grid.y);
    vector2 base = floor(skewed);
    vector2 part = fract(skewed);
    float rest = 1.0 - part.x - part.y;
    boolean upper = rest <= 0.0;
    tile1 = upper ? base + 1.0 : base;
    tile2 = base + (upper ? vector2(1.0, 0.0) : vector2(0.0, 1.0));
    tile3 = base + (upper ? vector2(0.0, 1.0) : vector2(1.0, 0.0));
    weights = upper ? vector(-rest, 1.0 - part.y, 1.0 - part.x) : vector(rest, part.y, part.x);
}

inline vector2 hex_turned(vector2 v, float cosine, float sine) {
    return vector2(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y);
}

// A tile's texel, with the angle by which it is turned. How much is random is said by rotation, scale and offset, how far
// it goes by their ranges; angles are in degrees.
void hex_texel(texture2d file, vector2 tile, vector2 coord, vector2 across, vector2 along, float rotation,
               vector2 rotationrange, float scale, vector2 scalerange, float offset, vector2 offsetrange,
               output color4 texel, output float angle) {
    vector2 random = hex_random(tile + 0.12345);
    angle = radians(mix(rotationrange.x, rotationrange.y, random.x * rotation));
    float cosine = cos(angle);
    float sine = sin(angle);
    float size = nonzero(mix(1.0, mix(scalerange.x, scalerange.y, random.y), scale));
    vector2 moved = mix(vector2(offsetrange.x), vector2(offsetrange.y), random * offset);
    vector2 corner = tile / 3.4641016;
    vector2 centre = vector2(corner.x + 0.5 * corner.y, 0.866025388 * corner.y);
    texel = texture_grad(file, hex_turned(coord - centre, cosine, sine) / size + centre + moved,
                         hex_turned(across, cosine, sine) / size, hex_turned(along, cosine, sine) / size);
}

// Schlick's gain (Fast Alternatives to Perlin's Bias and Gain Functions, Graphics Gems IV).
float hex_gain(float x, float amount) {
    float a = (1.0 / clamp(amount, 0.001, 0.999) - 2.0) * (1.0 - 2.0 * x);
    return x < 0.5 ? x / (a + 1.0) : (a - x) / (a - 1.0);
}

// What each of three tiles counts: most where it is near, and more where it is bright. A falloff of 0.5 leaves that as it
// is, less makes the seams wider.
vector hex_blend(vector brightness, vector weights, float falloff) {
    vector cubed = weights * weights * weights;
    vector share = brightness * (cubed * cubed * weights);
    share /= nonzero(share.x + share.y + share.z);
    if (falloff == 0.5)
        return share;
    vector bent = vector(hex_gain(share.x, falloff), hex_gain(share.y, falloff), hex_gain(share.z, falloff));
    return bent / nonzero(bent.x + bent.y + bent.z);
}

color4 hex_tiled(texture2d file, vector2 texcoord, vector2 tiling, float rotation, vector2 rotationrange, float scale,
                 vector2 scalerange, float offset, vector2 offsetrange, float falloff, float contrast,
                 color lumacoeffs) {
    vector2 coord = texcoord * tiling;
    vector2 across = Dx(coord);
    vector2 along = Dy(coord);
    vector2 tile1 = vector2(0.0);
    vector2 tile2 = vector2(0.0);
    vector2 tile3 = vector2(0.0);
    vector weights = vector(0.0);
    hex_corners(coord, tile1, tile2, tile3, weights);
    color4 c1 = color4(0.0);
    color4 c2 = color4(0.0);
    color4 c3 = color4(0.0);
    float angle = 0.0;
    hex_texel(file, tile1, coord, across, along, rotation, rotationrange, scale, scalerange, offset, offsetrange, c1,
              angle);
    hex_texel(file, tile2, coord, across, along, rotation, rotationrange, scale, scalerange, offset, offsetrange, c2,
              angle);
    hex_texel(file, tile3, coord, across, along, rotation, rotationrange, scale, scalerange, offset, offsetrange, c3,
              angle);
    vector brightness =
        vector(luminance(c1.rgb, lumacoeffs), luminance(c2.rgb, lumacoeffs), luminance(c3.rgb, lumacoeffs));
    vector share = hex_blend(mix(vector(1.0), brightness, contrast), weights, falloff);
    vector plain = hex_blend(vector(1.0), weights, falloff);
    return color4(c1.rgb * share.x + c2.rgb * share.y + c3.rgb * share.z,
                  c1.a * plain.x + c2.a * plain.y + c3.a * plain.z);
}

// The surface gradient of a tile's normal: how the normal map leans away from N, turned with its tile (M. Mikkelsen,
// Surface Gradient-Based Bump Mapping Framework, JCGT 9(3), 2020).
vector hex_gradient(color4 texel, float angle, float strength, boolean flip_g, vector N, vector T, vector B) {
    vector value = vector(texel.r, flip_g ? 1.0 - texel.g : texel.g, texel.b) * 2.0 - 1.0;
    vector lean = (T * value.x + B * value.y) * strength;
    float cosine = cos(angle);
    vector turned = lean * cosine + cross(N, lean) * sin(angle) + N * (dot(N, lean) * (1.0 - cosine));
    vector n = unit_or_zero(turned + N * value.z);
    float facing = dot(N, n);
    return (N * facing - n) / max(abs(facing), 1e-8);
}

vector hex_tiled_normal(texture2d file, vector value, vector2 texcoord, vector2 tiling, float rotation,
                        vector2 rotationrange, float scale, vector2 scalerange, float offset, vector2 offsetrange,
                        float falloff, float strength, boolean flip_g, vector N, vector T, vector B) {
    vector2 coord = texcoord * tiling;
    vector2 across = Dx(coord);
    vector2 along = Dy(coord);
    vector2 tile1 = vector2(0.0);
    vector2 tile2 = vector2(0.0);
    vector2 tile3 = vector2(0.0);
    vector weights = vector(0.0);
    hex_corners(coord, tile1, tile2, tile3, weights);
    color4 c = color4(0.0);
    float angle = 0.0;
    hex_texel(file, tile1, coord, across, along, rotation, rotationrange, scale, scalerange, offset, offsetrange, c,
              angle);
    vector g1 = hex_gradient(c, angle, strength, flip_g, N, T, B);
    hex_texel(file, tile2, coord, across, along, rotation, rotationrange, scale, scalerange, offset, offsetrange, c,
              angle);
    vector g2 = hex_gradient(c, angle, strength, flip_g, N, T, B);
    hex_texel(file, tile3, coord, across, along, rotation, rotationrange, scale, scalerange, offset, offsetrange, c,
              angle);
    vector g3 = hex_gradient(c, angle, strength, flip_g, N, T, B);
    vector share = clamp(hex_blend(vector(1.0), weights, falloff), 0.0, 1.0);
    return unit_or_zero(N - (g1 * share.x + g2 * share.y + g3 * share.z));
}
