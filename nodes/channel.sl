// The components of a value as outputs of their own.
void separate_vector2(vector2 value, output float x, output float y) {
    x = value.x;
    y = value.y;
}

void separate_color3(color value, output float r, output float g, output float b) {
    r = value.r;
    g = value.g;
    b = value.b;
}

void separate_vector3(vector value, output float x, output float y, output float z) {
    x = value.x;
    y = value.y;
    z = value.z;
}

void separate_color4(color4 value, output float r, output float g, output float b, output float a) {
    r = value.r;
    g = value.g;
    b = value.b;
    a = value.a;
}

void separate_vector4(vector4 value, output float x, output float y, output float z, output float w) {
    x = value.x;
    y = value.y;
    z = value.z;
    w = value.w;
}
