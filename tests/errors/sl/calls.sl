float f(float a, color b) { return a; }
float f(color a, float b) { return b; }
float one(vector2 v) { return v.x; }
void outs(float a, output float b) { b = a; }
float a(float x) { return f(x, x); }
float b(float x) { return f(color(x), color(x)); }
float c(vector v) { return one(v); }
float d(float x) { outs(x, x + 1); return x; }
float e(float x) { return outs(x, x); }
float g(float x) { return ping(x); }
float ping(float x) { return pong(x); }
float pong(float x) { return x > 0 ? ping(x - 1) : 0; }
float self(float x) { return self(x); }
float h(float x) { f(x, color(x)); sin(x); x; return x; }
