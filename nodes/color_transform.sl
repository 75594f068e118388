// Colour encodings and primaries, to linear Rec. 709. Matrices are given by columns.

// The transfer curve of sRGB (IEC 61966-2-1), decoded: a straight piece near black, a power above.
color srgb_to_linear(color encoded) {
    color curve = pow(max((encoded + 0.055) / 1.055, 0.0), 2.4);
    return mix(curve, encoded / 12.92, step(encoded, 0.04045));
}

// A plain power curve; what lies below black is black.
inline color gamma_to_linear(color encoded, float gamma) {
    return pow(max(encoded, 0.0), gamma);
}

// ACEScg (AP1 primaries, white point adapted from D60 to D65 by Bradford's method).
color ap1_to_rec709(color c) {
    return color(matrix33(vector(1.705051, -0.130256, -0.024003), vector(-0.621792, 1.140805, -0.128969),
                          vector(-0.083259, -0.010548, 1.152972)) * vector(c));
}

// Adobe RGB (1998).
color adobe_to_rec709(color c) {
    return color(matrix33(vector(1.398356, 0.0, 0.0), vector(-0.398356, 1.0, -0.042929),
                          vector(0.0, 0.0, 1.042929)) * vector(c));
}

// Display P3 (DCI primaries with a D65 white point).
color display_p3_to_rec709(color c) {
    return color(matrix33(vector(1.224930, -0.042059, -0.019641), vector(-0.224930, 1.042059, -0.078648),
                          vector(0.0, 0.0, 1.098289)) * vector(c));
}
