float a(float x) { return x; }
/* never ends
float b(float x) { return y; }
