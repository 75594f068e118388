// Arithmetic that gives a number everywhere. What a language leaves open at an edge is said here, once for all of them:
// a root, logarithm or arc is that of the nearest number which has one.

// A divisor that is not 0. What it divides becomes large, with its sign, and 0 / 0 is 0.
inline float nonzero(float x) {
    return abs(x) < 1e-20 ? 1e-20 : x;
}
inline vector2 nonzero(vector2 x) {
    return x + 1e-20 * step(abs(x), 0.5e-20);
}
inline vector nonzero(vector x) {
    return x + 1e-20 * step(abs(x), 0.5e-20);
}
inline vector4 nonzero(vector4 x) {
    return x + 1e-20 * step(abs(x), 0.5e-20);
}
inline color nonzero(color x) {
    return color(nonzero(vector(x)));
}
inline color4 nonzero(color4 x) {
    return color4(nonzero(vector4(x)));
}

// A vector of unit length; what has no length stays 0.
inline vector2 unit_or_zero(vector2 v) {
    return v * inversesqrt(max(dot(v, v), 1e-37));
}
inline vector unit_or_zero(vector v) {
    return v * inversesqrt(max(dot(v, v), 1e-37));
}
inline vector4 unit_or_zero(vector4 v) {
    return v * inversesqrt(max(dot(v, v), 1e-37));
}

// x to the power y. Of a negative number only whole powers are numbers, the others are 0 here; 0 to the power 0 is 1.
float power(float x, float y) {
    if (known(y > 0.0 && fract(y) != 0.0))
        return pow(max(x, 0.0), y);
    boolean nothing = abs(x) < 1e-20 && y > 0.0;
    float size = known(y > 0.0) ? pow(abs(x), y) : nothing ? 0.0 : min(pow(max(abs(x), 1e-20), y), 1e30);
    float signed = mod(y, 2.0) == 1.0 ? -size : size;
    return x >= 0.0 ? size : fract(y) == 0.0 ? signed : 0.0;
}
vector2 power(vector2 x, vector2 y) {
    return vector2(power(x.x, y.x), power(x.y, y.y));
}
vector power(vector x, vector y) {
    return vector(power(x.x, y.x), power(x.y, y.y), power(x.z, y.z));
}
vector4 power(vector4 x, vector4 y) {
    return vector4(power(x.x, y.x), power(x.y, y.y), power(x.z, y.z), power(x.w, y.w));
}
inline color power(color x, color y) {
    return color(power(vector(x), vector(y)));
}
inline color4 power(color4 x, color4 y) {
    return color4(power(vector4(x), vector4(y)));
}

// Turns a vector about an axis by an angle in degrees (Rodrigues' formula). The sense follows the row vector
// convention of the node library, v' = v M: looking against the axis, a positive angle turns clockwise.
vector rotate_about(vector v, float degrees, vector axis) {
    vector a = unit_or_zero(axis);
    float angle = radians(degrees);
    float cosine = cos(angle);
    return v * cosine + cross(v, a) * sin(angle) + a * (dot(a, v) * (1.0 - cosine));
}

// The same in the plane.
vector2 rotate_in_plane(vector2 v, float degrees) {
    float angle = radians(degrees);
    float cosine = cos(angle);
    float sine = sin(angle);
    return vector2(cosine * v.x + sine * v.y, cosine * v.y - sine * v.x);
}

// Where a texture is put: order 0 scales, rotates, then translates about the pivot, order 1 translates first.
vector2 place_texture(vector2 texcoord, vector2 pivot, vector2 scale, float degrees, vector2 offset, int order) {
    vector2 centred = texcoord - pivot;
    vector2 placed = order == 0 ? rotate_in_plane(centred / nonzero(scale), degrees) - offset
                                : rotate_in_plane(centred - offset, degrees) / nonzero(scale);
    return placed + pivot;
}
