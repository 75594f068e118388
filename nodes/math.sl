// Turns a vector about an axis by an angle in degrees (Rodrigues' formula). The sense follows the row vector
// convention of the node library, v' = v M: looking against the axis, a positive angle turns clockwise.
vector rotate_about(vector v, float degrees, vector axis) {
    vector a = normalize(axis);
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
    vector2 placed = order == 0 ? rotate_in_plane(centred / scale, degrees) - offset
                                : rotate_in_plane(centred - offset, degrees) / scale;
    return placed + pivot;
}
