// How much a surface faces the viewer: 1 where it does, 0 at the silhouette.
float facing_ratio(vector view_direction, vector normal, boolean face_forward, boolean invert) {
    float cosine = dot(view_direction, normal);
    float facing = face_forward ? abs(cosine) : -cosine;
    return invert ? 1.0 - facing : facing;
}

// Shading from a warm to a cool hue, and a highlight (Gooch et al., A Non-Photorealistic Lighting Model for Automatic
// Technical Illustration, SIGGRAPH 1998).
color gooch_shade(color warm, color cool, float specular_intensity, float shininess, vector light_direction) {
    vector N = normalize(normal_world);
    vector L = normalize(light_direction);
    vector mirrored = reflect(view_direction_in("world"), N);
    float highlight = pow(max(dot(-L, mirrored), 0.0), shininess) * specular_intensity;
    return mix(warm, cool, 0.5 + 0.5 * dot(N, L)) + highlight;
}
