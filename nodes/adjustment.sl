// Hue, saturation and value, all in [0, 1], after A. R. Smith, Color Gamut Transform Pairs, SIGGRAPH 1978.

// A pure hue is a trapezoid wave per channel, red, green and blue a third of a turn apart.
color hsv_to_rgb(color hsv) {
    vector turns = fract(vector(hsv.r, hsv.r + 0.6666667, hsv.r + 0.3333333));
    vector pure = clamp(abs(turns * 6.0 - 3.0) - 1.0, 0.0, 1.0);
    return color(hsv.b * mix(vector(1.0), pure, max(hsv.g, 0.0)));
}

// Grey has hue 0, black has saturation 0.
color rgb_to_hsv(color rgb) {
    float highest = max(rgb.r, max(rgb.g, rgb.b));
    float chroma = highest - min(rgb.r, min(rgb.g, rgb.b));
    float saturation = highest > 0.0 ? chroma / highest : 0.0;
    float sixths = rgb.r >= highest   ? (rgb.g - rgb.b) / chroma
                   : rgb.g >= highest ? (rgb.b - rgb.r) / chroma + 2.0
                                      : (rgb.r - rgb.g) / chroma + 4.0;
    float hue = saturation > 0.0 ? fract(sixths / 6.0) : 0.0;
    return color(hue, saturation, highest);
}

// Turns the hue by `amount.x` (1 is a full turn), scales saturation by `amount.y` and value by `amount.z`.
color hsv_adjust(color rgb, vector amount) {
    color hsv = rgb_to_hsv(rgb);
    return hsv_to_rgb(color(hsv.r + amount.x, hsv.g * amount.y, hsv.b * amount.z));
}

// What of a colour the eye takes for brightness.
float luminance(color rgb, color weights) {
    return dot(vector(rgb), vector(weights));
}

// Away from grey: 0 gives the luminance, 1 the colour itself, more exaggerates.
color saturate(color rgb, float amount, color weights) {
    return mix(color(luminance(rgb, weights)), rgb, amount);
}

// Hue, saturation, gamma, lift, gain, contrast and exposure, in this order.
color color_correct(color rgb, float hue, float saturation, float gamma, float lift, float gain, float contrast,
                    float pivot, float exposure) {
    color hued = hsv_adjust(rgb, vector(hue, 1.0, 1.0));
    color saturated = saturate(hued, saturation, color(0.2722287, 0.6740818, 0.0536895));
    color powered = sign(saturated) * pow(abs(saturated), 1.0 / nonzero(gamma));
    color gained = (powered * (1.0 - lift) + lift) * gain;
    return ((gained - pivot) * contrast + pivot) * exp2(exposure);
}
