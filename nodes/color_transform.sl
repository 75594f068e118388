// The transfer curves of colour spaces, each way. What an encoding says of values beyond [0, 1] goes on above 1; below 0
// the straight piece of sRGB goes on, and a power is 0.

// The transfer curve of sRGB (IEC 61966-2-1), decoded: a straight piece near black, a power above.
color srgb_to_linear(color encoded) {
    color curve = pow(max((encoded + 0.055) / 1.055, 0.0), 2.4);
    return mix(curve, encoded / 12.92, step(encoded, 0.04045));
}

// The same, encoded.
color linear_to_srgb(color value) {
    color curve = 1.055 * pow(max(value, 0.0), 1.0 / 2.4) - 0.055;
    return mix(curve, value * 12.92, step(value, 0.0031308));
}

// A plain power curve; what lies below black is black.
inline color gamma_to_linear(color encoded, float gamma) {
    return pow(max(encoded, 0.0), gamma);
}

// The same, encoded.
inline color linear_to_gamma(color value, float gamma) {
    return pow(max(value, 0.0), 1.0 / gamma);
}
