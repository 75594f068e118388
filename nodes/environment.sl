// Light from afar: two latitude-longitude maps around the scene, one of radiance and one of irradiance.

// A world direction, turned into the space of the maps.
vector environment_direction(vector d)
{
    return matrix33(environment_matrix) * d;
}

// Reads a latitude-longitude map: v = 0 is the zenith, u runs with the azimuth from -z. Rounding may make d a little
// longer than 1, and asin must not see that.
color environment_lookup(texture2d map, vector d, float level)
{
    float u = 0.5 + 0.159154943 * atan2(d.x, -d.z);
    float v = 0.5 - 0.318309886 * asin(clamp(d.y, -1.0, 1.0));
    color4 texel = texture_level(map, vector2(u, v), level);
    return texel.rgb;
}

// Irradiance of a surface that faces N, divided by pi: 1 in a white world.
color irradiance(vector N)
{
    return environment_lookup(environment_irradiance, environment_direction(N), 0.0);
}
