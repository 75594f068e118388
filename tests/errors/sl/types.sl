float a(color c, vector v) { return c + v; }
float b(color c) { return c; }
vector c(color k) { return k; }
int d(float x) { return x; }
float e(int i) { if (i) return 1; return 0; }
bool f(color c) { return c == c; }
float g(float x) { return x % 2; }
vector h(matrix33 m, vector v) { return v * m; }
point i(matrix44 m, point p) { return m * p; }
float j(float x, flaot y) { return x; }
float k(float x) { flaot y = x; return y; }
float l(vector v) { return v.w + v.xr + v[7] + v.xyzxy; }
color m(float x) { return color(x, x); }
float n(bool b) { return -b + ~1.0; }
texture2d o(texture2d t) { return t; }
void p(float x) { }
BSDF q(BSDF x, vector v) { return x * v; }
