// Noise on integer lattices. The hash is the final mixing of R. Jenkins' lookup3 (public domain), the noise K. Perlin's
// of 2002 (Improving Noise, SIGGRAPH), so that values are bit for bit those of other implementations of these nodes.

inline int rotate_bits(int x, int bits) {
    return (x << bits) | (x >>> (32 - bits));
}

int hash_mix(int first, int second, int third) {
    int b = second;
    int c = (third ^ b) - rotate_bits(b, 14);
    int a = (first ^ c) - rotate_bits(c, 11);
    b = (b ^ a) - rotate_bits(a, 25);
    c = (c ^ b) - rotate_bits(b, 16);
    a = (a ^ c) - rotate_bits(c, 4);
    b = (b ^ a) - rotate_bits(a, 14);
    return (c ^ b) - rotate_bits(b, 24);
}

// Hashes of cells. The seed is 0xdeadbeef + 4 n + 13 for n coordinates.
int hash_2d(int x, int y) {
    return hash_mix(x - 559038716, y - 559038716, -559038716);
}

int hash_3d(int x, int y, int z) {
    return hash_mix(x - 559038712, y - 559038712, z - 559038712);
}

// More than three coordinates are mixed in rounds of three (lookup3's "mix").
int hash_rounds(int seed, int x, int y, int z, int w, int v) {
    int a = x + seed;
    int b = y + seed;
    int c = z + seed;
    a = (a - c) ^ rotate_bits(c, 4);
    c += b;
    b = (b - a) ^ rotate_bits(a, 6);
    a += c;
    c = (c - b) ^ rotate_bits(b, 8);
    b += a;
    a = (a - c) ^ rotate_bits(c, 16);
    c += b;
    b = (b - a) ^ rotate_bits(a, 19);
    a += c;
    c = (c - b) ^ rotate_bits(b, 4);
    b += a;
    return hash_mix(a + w, b + v, c);
}

int hash_4d(int x, int y, int z, int w) {
    return hash_rounds(-559038708, x, y, z, w, 0);
}

int hash_5d(int x, int y, int z, int w, int v) {
    return hash_rounds(-559038704, x, y, z, w, v);
}

// 32 random bits as a number in [0, 1]. Each half is exact as a float, so the sum is rounded once.
float unit_interval(int bits) {
    return (float(bits >>> 16) * 65536.0 + float(bits & 65535)) * 2.3283064365386963e-10;
}

// A random number per unit cell.
float cell_noise_2d(vector2 p) {
    return unit_interval(hash_2d(int(floor(p.x)), int(floor(p.y))));
}

float cell_noise_3d(vector p) {
    return unit_interval(hash_3d(int(floor(p.x)), int(floor(p.y)), int(floor(p.z))));
}

inline float fade(float t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

// The product of (x, y) with one of eight gradients (±1, ±2) and (±2, ±1).
float gradient_2d(int hash, float x, float y) {
    float u = (hash & 4) == 0 ? x : y;
    float v = (hash & 4) == 0 ? y : x;
    return ((hash & 1) == 0 ? u : -u) + 2.0 * ((hash & 2) == 0 ? v : -v);
}

// The product of (x, y, z) with one of twelve gradients, to the middles of a cube's edges; four of them count twice.
float gradient_3d(int hash, float x, float y, float z) {
    float u = (hash & 8) == 0 ? x : y;
    float v = (hash & 12) == 0 ? y : (hash & 13) == 12 ? x : z;
    return ((hash & 1) == 0 ? u : -u) + ((hash & 2) == 0 ? v : -v);
}

// Three channels take a byte each of one hash.
vector gradients_2d(int hash, float x, float y) {
    return vector(gradient_2d(hash, x, y), gradient_2d(hash >> 8, x, y), gradient_2d(hash >> 16, x, y));
}

vector gradients_3d(int hash, float x, float y, float z) {
    return vector(gradient_3d(hash, x, y, z), gradient_3d(hash >> 8, x, y, z), gradient_3d(hash >> 16, x, y, z));
}

// Perlin noise in about [-1, 1], 0 at the lattice points.
float noise_2d(vector2 p) {
    vector2 cell = floor(p);
    int i = int(cell.x);
    int j = int(cell.y);
    float x = p.x - cell.x;
    float y = p.y - cell.y;
    float u = fade(x);
    float near = mix(gradient_2d(hash_2d(i, j), x, y), gradient_2d(hash_2d(i + 1, j), x - 1.0, y), u);
    float far =
        mix(gradient_2d(hash_2d(i, j + 1), x, y - 1.0), gradient_2d(hash_2d(i + 1, j + 1), x - 1.0, y - 1.0), u);
    return 0.6616 * mix(near, far, fade(y));
}

vector noise_vector_2d(vector2 p) {
    vector2 cell = floor(p);
    int i = int(cell.x);
    int j = int(cell.y);
    float x = p.x - cell.x;
    float y = p.y - cell.y;
    float u = fade(x);
    vector near = mix(gradients_2d(hash_2d(i, j), x, y), gradients_2d(hash_2d(i + 1, j), x - 1.0, y), u);
    vector far =
        mix(gradients_2d(hash_2d(i, j + 1), x, y - 1.0), gradients_2d(hash_2d(i + 1, j + 1), x - 1.0, y - 1.0), u);
    return 0.6616 * mix(near, far, fade(y));
}

vector4 noise_vector4_2d(vector2 p) {
    return vector4(noise_vector_2d(p), noise_2d(p + vector2(19.0, 73.0)));
}

// The noise on one face of a cell of the lattice, `k` the layer, (x, y, z) the place relative to its first corner.
float noise_layer(int i, int j, int k, float x, float y, float z, float u, float v) {
    float near = mix(gradient_3d(hash_3d(i, j, k), x, y, z), gradient_3d(hash_3d(i + 1, j, k), x - 1.0, y, z), u);
    float far = mix(gradient_3d(hash_3d(i, j + 1, k), x, y - 1.0, z),
                    gradient_3d(hash_3d(i + 1, j + 1, k), x - 1.0, y - 1.0, z), u);
    return mix(near, far, v);
}

float noise_3d(vector p) {
    vector cell = floor(p);
    int i = int(cell.x);
    int j = int(cell.y);
    int k = int(cell.z);
    vector r = p - cell;
    float u = fade(r.x);
    float v = fade(r.y);
    float below = noise_layer(i, j, k, r.x, r.y, r.z, u, v);
    float above = noise_layer(i, j, k + 1, r.x, r.y, r.z - 1.0, u, v);
    return 0.9820 * mix(below, above, fade(r.z));
}

vector noise_layer_vector(int i, int j, int k, float x, float y, float z, float u, float v) {
    vector near = mix(gradients_3d(hash_3d(i, j, k), x, y, z), gradients_3d(hash_3d(i + 1, j, k), x - 1.0, y, z), u);
    vector far = mix(gradients_3d(hash_3d(i, j + 1, k), x, y - 1.0, z),
                     gradients_3d(hash_3d(i + 1, j + 1, k), x - 1.0, y - 1.0, z), u);
    return mix(near, far, v);
}

vector noise_vector_3d(vector p) {
    vector cell = floor(p);
    int i = int(cell.x);
    int j = int(cell.y);
    int k = int(cell.z);
    vector r = p - cell;
    float u = fade(r.x);
    float v = fade(r.y);
    vector below = noise_layer_vector(i, j, k, r.x, r.y, r.z, u, v);
    vector above = noise_layer_vector(i, j, k + 1, r.x, r.y, r.z - 1.0, u, v);
    return 0.9820 * mix(below, above, fade(r.z));
}

vector4 noise_vector4_3d(vector p) {
    return vector4(noise_vector_3d(p), noise_3d(p + vector(19.0, 73.0, 29.0)));
}

// More octaves than these are finer than a float can tell; a document must not make who draws it wait for ever.
int octave_count(int octaves) {
    return min(octaves, 64);
}

// Octaves of noise: each is finer by `lacunarity` and weaker by `diminish`.
float fractal_2d(vector2 p, int octaves, float lacunarity, float diminish) {
    float sum = 0.0;
    float amplitude = 1.0;
    vector2 q = p;
    for (int i = 0; i < octave_count(octaves); i++) {
        sum += amplitude * noise_2d(q);
        amplitude *= diminish;
        q *= lacunarity;
    }
    return sum;
}

vector fractal_vector_2d(vector2 p, int octaves, float lacunarity, float diminish) {
    vector sum = vector(0.0);
    float amplitude = 1.0;
    vector2 q = p;
    for (int i = 0; i < octave_count(octaves); i++) {
        sum += amplitude * noise_vector_2d(q);
        amplitude *= diminish;
        q *= lacunarity;
    }
    return sum;
}

vector2 fractal_vector2_2d(vector2 p, int octaves, float lacunarity, float diminish) {
    return vector2(fractal_2d(p, octaves, lacunarity, diminish),
                   fractal_2d(p + vector2(19.0, 193.0), octaves, lacunarity, diminish));
}

vector4 fractal_vector4_2d(vector2 p, int octaves, float lacunarity, float diminish) {
    return vector4(fractal_vector_2d(p, octaves, lacunarity, diminish),
                   fractal_2d(p + vector2(19.0, 193.0), octaves, lacunarity, diminish));
}

float fractal_3d(vector p, int octaves, float lacunarity, float diminish) {
    float sum = 0.0;
    float amplitude = 1.0;
    vector q = p;
    for (int i = 0; i < octave_count(octaves); i++) {
        sum += amplitude * noise_3d(q);
        amplitude *= diminish;
        q *= lacunarity;
    }
    return sum;
}

vector fractal_vector_3d(vector p, int octaves, float lacunarity, float diminish) {
    vector sum = vector(0.0);
    float amplitude = 1.0;
    vector q = p;
    for (int i = 0; i < octave_count(octaves); i++) {
        sum += amplitude * noise_vector_3d(q);
        amplitude *= diminish;
        q *= lacunarity;
    }
    return sum;
}

vector2 fractal_vector2_3d(vector p, int octaves, float lacunarity, float diminish) {
    return vector2(fractal_3d(p, octaves, lacunarity, diminish),
                   fractal_3d(p + vector(19.0, 193.0, 17.0), octaves, lacunarity, diminish));
}

vector4 fractal_vector4_3d(vector p, int octaves, float lacunarity, float diminish) {
    return vector4(fractal_vector_3d(p, octaves, lacunarity, diminish),
                   fractal_3d(p + vector(19.0, 193.0, 17.0), octaves, lacunarity, diminish));
}

// Cellular noise (S. Worley, A Cellular Texture Basis Function, SIGGRAPH 1996): one point in each cell, `jitter` says
// how far it strays from the middle. `squares` are the squared distances to the nearest, second and third point,
// `feature` is where the nearest one lies.
void worley_2d(vector2 p, float jitter, output vector squares, output vector2 feature) {
    vector2 cell = floor(p);
    vector nearest = vector(1e6);
    vector2 found = vector2(0.0);
    for (int x = -1; x <= 1; x++) {
        for (int y = -1; y <= 1; y++) {
            int i = int(cell.x) + x;
            int j = int(cell.y) + y;
            vector2 spot = vector2(unit_interval(hash_3d(i, j, 0)), unit_interval(hash_3d(i, j, 1)));
            vector2 toward = cell - p + vector2(x, y) + (spot - 0.5) * jitter + 0.5;
            float square = dot(toward, toward);
            if (square < nearest.x) {
                nearest = vector(square, nearest.x, nearest.y);
                found = toward;
            } else if (square < nearest.y) {
                nearest = vector(nearest.x, square, nearest.y);
            } else if (square < nearest.z) {
                nearest = vector(nearest.x, nearest.y, square);
            }
        }
    }
    squares = nearest;
    feature = p + found;
}

void worley_3d(vector p, float jitter, output vector squares, output vector feature) {
    vector cell = floor(p);
    vector nearest = vector(1e6);
    vector found = vector(0.0);
    for (int x = -1; x <= 1; x++) {
        for (int y = -1; y <= 1; y++) {
            for (int z = -1; z <= 1; z++) {
                int i = int(cell.x) + x;
                int j = int(cell.y) + y;
                int k = int(cell.z) + z;
                vector spot = vector(unit_interval(hash_4d(i, j, k, 0)), unit_interval(hash_4d(i, j, k, 1)),
                                     unit_interval(hash_4d(i, j, k, 2)));
                vector toward = cell - p + vector(x, y, z) + (spot - 0.5) * jitter + 0.5;
                float square = dot(toward, toward);
                if (square < nearest.x) {
                    nearest = vector(square, nearest.x, nearest.y);
                    found = toward;
                } else if (square < nearest.y) {
                    nearest = vector(nearest.x, square, nearest.y);
                } else if (square < nearest.z) {
                    nearest = vector(nearest.x, nearest.y, square);
                }
            }
        }
    }
    squares = nearest;
    feature = p + found;
}

// Style 0 gives the distances, style 1 a random value of the nearest point's cell.
vector worley_noise_2d(vector2 p, float jitter, int style) {
    vector squares = vector(0.0);
    vector2 feature = vector2(0.0);
    worley_2d(p, jitter, squares, feature);
    int i = int(floor(feature.x));
    int j = int(floor(feature.y));
    return style == 1 ? vector(unit_interval(hash_3d(i, j, 0)), unit_interval(hash_3d(i, j, 1)),
                               unit_interval(hash_3d(i, j, 2)))
                      : sqrt(squares);
}

vector worley_noise_3d(vector p, float jitter, int style) {
    vector squares = vector(0.0);
    vector feature = vector(0.0);
    worley_3d(p, jitter, squares, feature);
    int i = int(floor(feature.x));
    int j = int(floor(feature.y));
    int k = int(floor(feature.z));
    return style == 1 ? vector(unit_interval(hash_4d(i, j, k, 0)), unit_interval(hash_4d(i, j, k, 1)),
                               unit_interval(hash_4d(i, j, k, 2)))
                      : sqrt(squares);
}

// A single channel's random value is the cell's own, not the first of three.
float worley_scalar_2d(vector2 p, float jitter, int style) {
    vector squares = vector(0.0);
    vector2 feature = vector2(0.0);
    worley_2d(p, jitter, squares, feature);
    return style == 1 ? cell_noise_2d(feature) : sqrt(squares.x);
}

float worley_scalar_3d(vector p, float jitter, int style) {
    vector squares = vector(0.0);
    vector feature = vector(0.0);
    worley_3d(p, jitter, squares, feature);
    return style == 1 ? cell_noise_3d(feature) : sqrt(squares.x);
}

// The noise of a kind (0 Perlin, 1 cells, 2 Worley, 3 fractal) over a range. With less than full jitter the lattice is
// turned, by more than a turn per thousandth, so that a slider of it shuffles the pattern.
float unified_noise_2d(vector2 texcoord, vector2 freq, vector2 offset, float jitter, float lowest, float highest,
                       boolean clamped, int octaves, float lacunarity, float diminish, int kind, int style) {
    vector2 p = texcoord * freq + offset;
    float shuffle = (jitter - 1.0) * 90000.0;
    vector2 turned = rotate_in_plane(p, shuffle);
    float n = 0.0;
    if (kind == 0) {
        n = 0.5 * noise_2d(turned) + 0.5;
    } else if (kind == 1) {
        n = cell_noise_2d(turned);
    } else if (kind == 2) {
        n = worley_scalar_2d(p, jitter, style);
    } else if (kind == 3) {
        n = fractal_3d(vector(p, shuffle), octaves, lacunarity, diminish);
    }
    float ranged = lowest + n * (highest - lowest);
    return clamped ? clamp(ranged, lowest, highest) : ranged;
}

float unified_noise_3d(vector position, vector freq, vector offset, float jitter, float lowest, float highest,
                       boolean clamped, int octaves, float lacunarity, float diminish, int kind, int style) {
    vector p = position * freq + offset;
    vector turned = rotate_about(p, (jitter - 1.0) * 90000.0, vector(0.1, 1.0, 0.0));
    float n = 0.0;
    if (kind == 0) {
        n = 0.5 * noise_3d(turned) + 0.5;
    } else if (kind == 1) {
        n = cell_noise_3d(turned);
    } else if (kind == 2) {
        n = worley_scalar_3d(p, jitter, style);
    } else if (kind == 3) {
        n = fractal_3d(turned, octaves, lacunarity, diminish);
    }
    float ranged = lowest + n * (highest - lowest);
    return clamped ? clamp(ranged, lowest, highest) : ranged;
}

// A random number for each value of the input; the seed picks another sequence. Whole inputs give one each, others one
// for every 4096th.
float random_float(float x, float lowest, float highest, int seed) {
    return mix(lowest, highest, cell_noise_2d(vector2(x, seed)));
}

// A random colour within ranges of hue, saturation and brightness, each with a sequence of its own.
color random_color(float x, float hue_low, float hue_high, float saturation_low, float saturation_high,
                   float brightness_low, float brightness_high, int seed) {
    float key = x * 4096.0;
    return hsv_to_rgb(color(random_float(key, hue_low, hue_high, seed + 414),
                            random_float(key, saturation_low, saturation_high, seed + 1523),
                            random_float(key, brightness_low, brightness_high, seed + 1814)));
}

// Ramps run from 0 at the left or bottom to 1 at the right or top. A split has an edge one pixel wide: the difference
// of x to the neighbouring pixels says how wide that is.
float antialiased_step(float edge, float x) {
    float half_width = length(vector2(Dx(x), Dy(x))) * 0.70710678;
    return smoothstep(edge - half_width, edge + half_width, x);
}

// Shapes: 1 within, 0 outside.
float circle(vector2 p, vector2 center, float radius) {
    vector2 away = p - center;
    return dot(away, away) > radius * radius ? 0.0 : 1.0;
}

// A line of width 2 `radius` with round ends between two points, seen from `center`.
float line(vector2 p, vector2 center, float radius, vector2 begin, vector2 end) {
    vector2 along = end - begin;
    vector2 away = p - center - begin;
    float t = clamp(dot(away, along) / dot(along, along), 0.0, 1.0);
    return distance(away, along * t) > radius ? 0.0 : 1.0;
}

// Four circles of half the radius, right, left, above and below.
float cloverleaf(vector2 p, vector2 center, float radius) {
    vector2 q = 2.0 * (p - center);
    vector2 side = vector2(radius, 0.0);
    vector2 up = vector2(0.0, radius);
    return max(max(circle(q, side, radius), circle(q, -side, radius)),
               max(circle(q, up, radius), circle(q, -up, radius)));
}

// A hexagon with two upright edges, `radius` away from its center.
float hexagon(vector2 p, vector2 center, float radius) {
    vector2 away = abs(p - center);
    return max(away.x, 0.5 * away.x + 0.8660254 * away.y) > radius ? 0.0 : 1.0;
}

// Tiles. A staggered pattern moves every other row by half a tile.
vector2 tile(vector2 texcoord, vector2 tiling, vector2 offset, boolean staggered) {
    vector2 p = texcoord * tiling - offset;
    float shift = staggered && mod(p.y, 2.0) > 1.0 ? 0.5 : 0.0;
    return fract(p + vector2(shift, 0.0)) * 2.0 - 1.0;
}

color grid(vector2 texcoord, vector2 tiling, vector2 offset, float thickness, boolean staggered) {
    vector2 p = abs(tile(texcoord, tiling, offset, staggered));
    return color(max(p.x, p.y) > 1.0 - thickness ? 1.0 : 0.0);
}

color crosshatch(vector2 texcoord, vector2 tiling, vector2 offset, float thickness, boolean staggered) {
    vector2 p = tile(texcoord, tiling, offset, staggered);
    vector2 corner = vector2(1.0, 1.0);
    vector2 other = vector2(-1.0, 1.0);
    vector2 middle = vector2(0.0);
    return color(max(line(p, middle, thickness, corner, -corner), line(p, middle, thickness, other, -other)));
}

// Staggered shapes stand in rows, every other one moved by half a tile. Three of them can reach a point: those at the
// ends of the row below it and the one between them in the row above.
void staggered_rows(vector2 p, float height, output vector2 left, output vector2 right, output vector2 above) {
    float x = fract(p.x + (mod(p.y, 2.0 * height) > height ? 0.5 : 0.0));
    float y = mod(p.y, height);
    left = vector2(x, y);
    right = vector2(1.0 - x, y);
    above = vector2(x - 0.5, height - y);
}

// Circles and hexagons are densest in rows √3/2 apart, cloverleafs in rows 1/2 apart.
color tiled_circles(vector2 texcoord, vector2 tiling, vector2 offset, float size, boolean staggered) {
    vector2 left = vector2(0.0);
    vector2 right = vector2(0.0);
    vector2 above = vector2(0.0);
    staggered_rows(texcoord * tiling - offset, 0.8660254, left, right, above);
    vector2 middle = vector2(0.0);
    float radius = size * 0.5;
    float dense =
        max(max(circle(left, middle, radius), circle(right, middle, radius)), circle(above, middle, radius));
    return color(staggered ? dense : circle(tile(texcoord, tiling, offset, false), middle, size));
}

color tiled_hexagons(vector2 texcoord, vector2 tiling, vector2 offset, float size, boolean staggered) {
    vector2 left = vector2(0.0);
    vector2 right = vector2(0.0);
    vector2 above = vector2(0.0);
    staggered_rows(texcoord * tiling - offset, 0.8660254, left, right, above);
    vector2 middle = vector2(0.0);
    float radius = size * 0.5;
    float dense =
        max(max(hexagon(left, middle, radius), hexagon(right, middle, radius)),
            hexagon(above, middle, radius));
    return color(staggered ? dense : hexagon(tile(texcoord, tiling, offset, false), middle, size));
}

color tiled_cloverleafs(vector2 texcoord, vector2 tiling, vector2 offset, float size, boolean staggered) {
    vector2 left = vector2(0.0);
    vector2 right = vector2(0.0);
    vector2 above = vector2(0.0);
    staggered_rows(texcoord * tiling - offset, 0.5, left, right, above);
    vector2 middle = vector2(0.0);
    float radius = size * 0.5;
    float dense =
        max(max(cloverleaf(left, middle, radius), cloverleaf(right, middle, radius)),
            cloverleaf(above, middle, radius));
    return color(staggered ? dense : cloverleaf(tile(texcoord, tiling, offset, false), middle, size));
}

// The alternating squares of a board: 0 or 1.
inline float checker(vector2 p) {
    vector2 cell = floor(p);
    return mod(cell.x + cell.y, 2.0);
}

// One interval of a colour ramp: `previous` before it and where the ramp has fewer intervals, else linear (0), smooth (1)
// or a step (2) from the first to the second colour. An interval that does not rise is a step.
color4 ramp_interval(float x, float begin, float end, color4 first, color4 second, int interpolation, color4 previous,
                     int number, int intervals) {
    float linear = 1.0 - clamp((end - x) / max(end - begin, 1e-20), 0.0, 1.0);
    float t = interpolation == 0 ? linear : smoothstep(begin, end, x);
    color4 inside = interpolation == 2 ? (end > x ? first : second) : mix(first, second, t);
    return number < intervals && x > begin ? inside : previous;
}

// A ramp of up to ten colours along x (0), around the middle (1), away from it (2), or in nested squares (3).
color4 ramp(vector2 texcoord, int kind, int interpolation, int intervals, float interval1, color4 color_1,
            float interval2, color4 color_2, float interval3, color4 color_3, float interval4, color4 color_4,
            float interval5, color4 color_5, float interval6, color4 color_6, float interval7, color4 color_7,
            float interval8, color4 color_8, float interval9, color4 color_9, float interval10, color4 color_10) {
    vector2 away = texcoord - 0.5;
    float x = 0.0;
    if (kind == 0) {
        x = texcoord.x;
    } else if (kind == 1) {
        x = atan2(away.x, nonzero(away.y)) / 6.2831853 + 0.5;
    } else if (kind == 2) {
        x = length(away) * 1.414;
    } else {
        x = 2.0 * max(abs(away.x), abs(away.y));
    }
    color4 result = color_1;
    result = ramp_interval(x, interval1, interval2, color_1, color_2, interpolation, result, 1, intervals);
    result = ramp_interval(x, interval2, interval3, color_2, color_3, interpolation, result, 2, intervals);
    result = ramp_interval(x, interval3, interval4, color_3, color_4, interpolation, result, 3, intervals);
    result = ramp_interval(x, interval4, interval5, color_4, color_5, interpolation, result, 4, intervals);
    result = ramp_interval(x, interval5, interval6, color_5, color_6, interpolation, result, 5, intervals);
    result = ramp_interval(x, interval6, interval7, color_6, color_7, interpolation, result, 6, intervals);
    result = ramp_interval(x, interval7, interval8, color_7, color_8, interpolation, result, 7, intervals);
    result = ramp_interval(x, interval8, interval9, color_8, color_9, interpolation, result, 8, intervals);
    result = ramp_interval(x, interval9, interval10, color_9, color_10, interpolation, result, 9, intervals);
    return result;
}
