const float SCALE = 2.0;
float helper(float amount) { return amount * SCALE; }
float a(float roughness) { return roughnes + SCAL + tme; }
float b(float x) { return helpr(x) + clmp(x, 0, 1); }
float c(float x) { float x = 1; return x; }
float helper(float other) { return other; }
const float SCALE = 3.0;
float d(float x) { SCALE = 1; time = 2; 1 = 2; x.y = 3; return x; }
float e(float x) { const float k = x; k = 2; return k; }
float f(float x) { return sin(x, x) + dot(x, x) + color; }
float g(float x, output float out) { out = x; return x; }
const float LOOP = LOOP2;
const float LOOP2 = LOOP;
const float COMPUTED = d(1);
