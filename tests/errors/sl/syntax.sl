float a(float x) { return x +; }
float b(float x) { float y = 2 return y; }
float c(float x) { while (x > 0) { x -= 1; } return x; }
float d(float x) { float y[3]; y[0] = x; return y[0]; }
float e(float x { return x; }
float f(float x) { for (int i = 0; i < ; i++) { x += 1; } break; return x; }
float g(float x = 1) { return x; }
float h(float x) { return 1.5f * x; }
struct thing { float x; };
float global = 1;
float i(float x) { return x @ 2; }
void j(output float y, float x) { y = x; }
float k(float x);
float l(float x) { a = = 2; if x > 0 return 1; return (x; }
float m(float x) { return 1e50 + 0xfffffffff + 99999999999; }
#define M 1
float n(string s) { return s == "open; }
float o(float x) { return x; }
}
float p(float x) { return "a\q" == "b" ? 1 : 0; }
float q(float x) {
    if (x > 0) {
        return 1;
    return x;
}
float r(float x) { return x; }
