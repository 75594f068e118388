// An image laid onto a surface from three sides, weighted by how much the surface faces each. `blend` widens the seams;
// `up_axis` (0 x, 1 y, 2 z) says which way the images stand.
color4 project_triplanar(texture2d image_x, texture2d image_y, texture2d image_z, vector position, vector normal,
                         int up_axis, float blend) {
    vector facing = abs(unit_or_zero(normal));
    vector share = facing / nonzero(facing.x + facing.y + facing.z);
    vector weight = pow(share, 1.0 / clamp(blend, 0.03, 1.0));
    weight /= weight.x + weight.y + weight.z;
    vector2 along_x = up_axis == 2 ? position.yz : vector2(position.z, position.y);
    vector2 along_y = up_axis == 0 ? vector2(position.z, position.x) : vector2(position.x, position.z);
    vector2 along_z = up_axis == 0 ? vector2(-position.y, position.x) : position.xy;
    return texture(image_x, along_x) * weight.x + texture(image_y, along_y) * weight.y
           + texture(image_z, along_z) * weight.z;
}

// Where a direction lies in an image of the whole sphere; `degrees` turns the image about the upright axis.
vector2 latitude_longitude(vector direction, float degrees) {
    float longitude = 0.5 - atan2(direction.x, direction.z) * 0.15915494;
    float latitude = 0.5 + asin(clamp(direction.y, -1.0, 1.0)) * 0.31830989;
    return vector2(longitude + degrees / 360.0, latitude);
}

// A texture coordinate in tiles of a physical size; a size of 0 counts as 1.
inline vector2 tiled(vector2 texcoord, vector2 tiling, vector2 offset, vector2 image_size, vector2 tile_size) {
    return (texcoord * tiling - offset) / (image_size + step(abs(image_size), 1e-20)) * tile_size;
}

// The same by glTF's transform, which scales and turns the image; v of the offset grows downwards. An image that stays
// where it is costs nothing.
vector2 place_gltf_texture(vector2 texcoord, vector2 pivot, vector2 scale, float degrees, vector2 offset, int order) {
    if (known(scale.x == 1.0 && scale.y == 1.0 && degrees == 0.0 && offset.x == 0.0 && offset.y == 0.0))
        return texcoord;
    vector2 centred = texcoord - pivot;
    vector2 moved = offset * vector2(-1.0, 1.0);
    vector2 placed = order == 0 ? rotate_in_plane(centred * scale, -degrees) - moved
                                : rotate_in_plane(centred - moved, -degrees) * scale;
    return placed + pivot;
}

// A texel times `scale` plus `bias`, by channel and whole.
inline void scale_texel(color4 texel, color4 scale, color4 bias, output float r, output float g, output float b,
                        output float a, output color rgb, output color4 rgba) {
    color4 scaled = texel * scale + bias;
    r = scaled.r;
    g = scaled.g;
    b = scaled.b;
    a = scaled.a;
    rgb = scaled.rgb;
    rgba = scaled;
}
