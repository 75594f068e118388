float a(float x) { float y; if (x > 0) y = 1; return y; }
float b(float x) { if (x > 0) return 1; }
void c(float x, output float y, output color z) { if (x > 0) { y = 1; return; } y = 2; z = color(1); }
float d(float x) { for (int i = 0; i < 4; i++) return x; return 0; }
float e(float x) { for (int i = 0; i < 4; i++) { i = 2; } return x; }
float f(int n) { int k = n; for (int i = 0; i < k; i++) k -= 1; return k; }
float g(int n) { for (int i = 0; i < n; i += n) n = 1; return n; }
float h(int n) { for (int i = n; i > 0; i--) n = 1; return n; }
float i(float x) { for (float t = 0; t < 1; t += 0.1) x += t; return x; }
float j(float x) { return x; x = 2; return x; }
float k(float x) { float s; for (int i = 0; i < 3; i++) s = x; return s; }
float l(float x) { return; }
void m(output float y) { y = 1; return y; }
float n(vector v) { vector w; w.x = 1; return w.x + w.y; }
