// Metal flakes (MaterialX specification, "Procedural Nodes"): cubes of random orientation in a lattice of cells, of
// which the one of highest priority shows.

// A point, turned at random by three numbers in [0, 1] (J. Arvo, Fast Random Rotation Matrices, Graphics Gems III):
// about z, then mirrored through a random direction.
vector random_turn(vector p, vector random) {
    float azimuth = 6.2831853 * random.y;
    float angle = 6.2831853 * random.x;
    vector direction = vector(vector2(sin(azimuth), cos(azimuth)) * sqrt(2.0 * random.z), sqrt(2.0 - 2.0 * random.z));
    vector mirrored = direction * dot(direction, p) - p;
    float cosine = cos(angle);
    float sine = sin(angle);
    return vector(cosine * mirrored.x - sine * mirrored.y, sine * mirrored.x + cosine * mirrored.y, mirrored.z);
}

// How likely a cell must hold a flake for flakes to cover that part of the surface. Cubes overlap, so it is more than
// proportional; a fit.
float flake_probability(float coverage) {
    float x = clamp(coverage, 0.0, 1.0);
    float above = (26.39663835 - 26.19771808 * x) * x;
    return above / (((85.53857017 * x - 102.35069432) * x - 101.42634862) * x + 118.45082288);
}

// The flake that shows at p, in units of flakes: its cell and its priority, 0 where there is none. Half a cube's
// edge is sqrt(3) / 2, so that it reaches into the neighbouring cells.
void find_flake(vector p, float probability, output vector found, output float priority) {
    vector middle = floor(p);
    vector cell = vector(0.0);
    float highest = 0.0;
    for (int x = -1; x <= 1; x++) {
        for (int y = -1; y <= 1; y++) {
            for (int z = -1; z <= 1; z++) {
                vector here = middle + vector(x, y, z);
                vector within = p - here - 0.5;
                int i = int(here.x);
                int j = int(here.y);
                int k = int(here.z);
                if (dot(within, within) < 2.25 && unit_interval(hash_3d(i, j, k)) <= probability) {
                    float rank = unit_interval(hash_4d(i, j, k, 3));
                    vector random = vector(unit_interval(hash_4d(i, j, k, 0)), unit_interval(hash_4d(i, j, k, 1)),
                                           unit_interval(hash_4d(i, j, k, 2)));
                    vector away = abs(random_turn(within, random));
                    if (rank >= highest && max(away.x, max(away.y, away.z)) <= 0.8660254) {
                        highest = rank;
                        cell = here;
                    }
                }
            }
        }
    }
    found = cell;
    priority = highest;
}

// The normal of a flake strays from that of the surface as those of a GGX surface do (Walter et al., Microfacet Models
// for Refraction through Rough Surfaces, EGSR 2007, eq. 35 and 36).
void flake_3d(float size, float roughness, float coverage, vector position, vector normal, vector tangent,
              vector bitangent, output int id, output float rand, output float presence, output vector flakenormal) {
    vector cell = vector(0.0);
    float priority = 0.0;
    float edge = abs(size) < 1e-6 ? 1e-6 : size;
    find_flake(position / edge, flake_probability(coverage), cell, priority);
    id = 0;
    rand = 0.0;
    presence = 0.0;
    flakenormal = normal;
    if (priority > 0.0) {
        int i = int(cell.x);
        int j = int(cell.y);
        int k = int(cell.z);
        float azimuth = 6.2831853 * unit_interval(hash_5d(i, j, k, 2, 0));
        float share = unit_interval(hash_5d(i, j, k, 2, 1));
        rand = unit_interval(hash_5d(i, j, k, 2, 2));
        id = int(rand * 16777215.0);
        presence = priority;
        float alpha = roughness * roughness;
        float slope = alpha * sqrt(share / max(1.0 - share, 1e-7));
        flakenormal = unit_or_zero((tangent * cos(azimuth) + bitangent * sin(azimuth)) * slope + normal);
    }
}

void flake_2d(float size, float roughness, float coverage, vector2 texcoord, vector normal, vector tangent,
              vector bitangent, output int id, output float rand, output float presence, output vector flakenormal) {
    flake_3d(size, roughness, coverage, vector(texcoord, 0.0), normal, tangent, bitangent, id, rand, presence,
             flakenormal);
}
