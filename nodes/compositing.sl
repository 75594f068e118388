// Blends of one channel that need a case distinction; the other blends are expressions.

// Darkens the background: 1 - (1 - bg) / fg, and 0 where the foreground is black.
float burn(float fg, float bg) {
    return abs(fg) < 1e-8 ? 0.0 : 1.0 - (1.0 - bg) / fg;
}

// Brightens the background: bg / (1 - fg), and 0 where the foreground is white.
float dodge(float fg, float bg) {
    return abs(1.0 - fg) < 1e-8 ? 0.0 : bg / (1.0 - fg);
}

// Screens light and multiplies dark parts of the background.
float overlay(float fg, float bg) {
    return bg >= 0.5 ? 1.0 - 2.0 * (1.0 - fg) * (1.0 - bg) : 2.0 * fg * bg;
}

// Two shapes that cover a pixel without overlap as long as their alphas allow it (Porter and Duff's "disjoint over").
// Of a foreground that is more than opaque nothing remains over a background that is not there.
color4 disjoint_over(color4 fg, color4 bg) {
    float sum = fg.a + bg.a;
    boolean nowhere = abs(bg.a) < 1e-8;
    float kept = (1.0 - fg.a) / (nowhere ? 1.0 : bg.a);
    color both = nowhere ? color(0.0) : fg.rgb + bg.rgb * kept;
    return color4(sum <= 1.0 ? fg.rgb + bg.rgb : both, min(sum, 1.0));
}
