// Object space goes by two names.
inline boolean is_object_space(string space) {
    return space == "object" || space == "model";
}

// A direction of the surface as it is asked for, of unit length.
inline vector unit_in_space(string space, vector in_object, vector in_world) {
    return space == "world" ? normalize(in_world) : normalize(in_object);
}

// Points, directions and normals between object and world space; any other pair of names changes nothing.
vector transform_point(vector p, string from_space, string to_space) {
    return is_object_space(from_space) && to_space == "world"   ? (world_matrix * vector4(p, 1.0)).xyz
           : from_space == "world" && is_object_space(to_space) ? (world_inverse_matrix * vector4(p, 1.0)).xyz
                                                                : p;
}

vector transform_vector(vector v, string from_space, string to_space) {
    return is_object_space(from_space) && to_space == "world"   ? (world_matrix * vector4(v, 0.0)).xyz
           : from_space == "world" && is_object_space(to_space) ? (world_inverse_matrix * vector4(v, 0.0)).xyz
                                                                : v;
}

// A normal goes by the inverse transpose, and is of unit length after that, also from a space to itself.
vector transform_normal(vector n, string from_space, string to_space) {
    return is_object_space(from_space) && to_space == "world"
               ? unit_or_zero((world_inverse_transpose_matrix * vector4(n, 0.0)).xyz)
           : from_space == "world" && is_object_space(to_space)
               ? unit_or_zero((world_transpose_matrix * vector4(n, 0.0)).xyz)
               : unit_or_zero(n);
}

// From the eye to the shaded point, of unit length.
vector view_direction_in(string space) {
    vector eye = vector(view_position);
    return space == "world"
               ? normalize(vector(position_world) - eye)
               : normalize(vector(position_object) - (world_inverse_matrix * vector4(eye, 1.0)).xyz);
}

// A normal read from a tangent space normal map, whose values in [0, 1] stand for [-1, 1]. One without direction is N
// itself: of z a little less than 1 is taken, which changes no other.
vector apply_normal_map(vector value, vector2 scale, vector N, vector T, vector B) {
    vector direction = value * 2.0 - vector(1.0, 1.0, 0.99999994);
    return normalize(T * (direction.x * scale.x) + B * (direction.y * scale.y) + N * direction.z);
}

// The normal map of a height field, from the differences of height and texture coordinates to the neighbouring
// pixels: the surface (u, v, height) has the normal dP/dx × dP/dy. A mirrored map is turned to face up again. The
// factor 1/16 gives the slopes that the usual Sobel filter would.
vector height_to_normal(float height, float scale, vector2 texcoord) {
    float steepness = scale * 0.0625;
    vector across = vector(Dx(texcoord), Dx(height) * steepness);
    vector along = vector(Dy(texcoord), Dy(height) * steepness);
    vector n = cross(across, along);
    vector up = dot(n, n) < 1e-12 ? vector(0.0, 0.0, 1.0) : n.z < 0.0 ? -n : n;
    return normalize(up) * 0.5 + 0.5;
}
