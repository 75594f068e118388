// Directions to integrate over and to sort samples by, made without the library's functions.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "physics/leaf.h"

namespace shaderx::tests {

// Nodes and weights of Gauss and Legendre on [0, 1].
struct Gauss {
    std::vector<double> at, weight;
    explicit Gauss(int n) : at(n), weight(n) {
        for (int i = 0; i < n; i++) {
            double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 1;
            for (int round = 0; round < 20; round++) {
                double before = 1, p = x;
                for (int k = 2; k <= n; k++) {
                    const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
                    before = p;
                    p = next;
                }
                slope = n * (x * p - before) / (x * x - 1);
                x -= p / slope;
            }
            at[i] = 0.5 - 0.5 * x;
            weight[i] = 1 / ((1 - x * x) * slope * slope);
        }
    }
};

// A map of the unit square to directions. `density` is solid angle per area of the square, 0 where the square leaves
// the sphere.
struct Direction {
    Vec d;
    double density = 0;
};

// All directions: v is the azimuth, u the height, from below to above.
struct SphereMap {
    Direction operator()(double u, double v) const {
        const double z = 2 * u - 1, r = std::sqrt(std::max(1 - z * z, 0.0)), azimuth = 2 * kPi * v;
        return {{r * std::cos(azimuth), r * std::sin(azimuth), z}, 4 * kPi};
    }
    void inverse(Vec d, double& u, double& v) const {
        u = 0.5 + 0.5 * d.z;
        v = std::atan2(d.y, d.x) / (2 * kPi);
        if (v < 0) v += 1;
    }
};

// Directions that a rough mirror sends V to: u and v are polar coordinates of the slopes of half vectors, stretched by
// 1 / ax and 1 / ay, u from flat to upright; with `above`, to where light comes from the horizon. That is the larger
// root of A r^2 - 2 B r - 1 = 0.
struct SlopeMap {
    Vec V;
    double ax, ay;
    bool above = false, retroreflective = false;

    Direction operator()(double u, double v) const {
        const double azimuth = 2 * kPi * v, px = ax * std::cos(azimuth), py = ay * std::sin(azimuth);
        double limit = kPi / 2;
        if (above) {
            const double A = px * px + py * py, B = (px * V.x + py * V.y) / V.z, root = std::sqrt(B * B + A);
            limit = std::atan(B > 0 ? (B + root) / A : 1 / (root - B));
        }
        const double left = 1 - u, tilt = limit * (1 - left * left), r = std::tan(tilt), cosine = std::cos(tilt);
        const Vec h = normalize({px * r, py * r, 1});
        const double VH = dot(V, h);
        if (VH <= 0) return {};
        Vec l = reflect(V, h);
        if (retroreflective) l = {-l.x, -l.y, l.z};
        // Area of slopes, then solid angle of half vectors, then of light.
        const double area = ax * ay * r / (cosine * cosine) * limit * 2 * left * 2 * kPi;
        return {l, area * h.z * h.z * h.z * 4 * VH};
    }
    void inverse(Vec l, double& u, double& v) const {
        if (retroreflective) l = {-l.x, -l.y, l.z};
        const Vec h = normalize(V + l);
        const double px = h.x / h.z / ax, py = h.y / h.z / ay;
        const double tilt = h.z > 0 ? std::atan(std::hypot(px, py)) : kPi / 2;
        u = 1 - std::sqrt(std::max(1 - tilt / (kPi / 2), 0.0));
        v = std::atan2(py, px) / (2 * kPi);
        if (v < 0) v += 1;
    }
};

// The integral over directions, Gauss's points by even azimuths. The square's u is cut into `parts`.
template <typename Map, typename F>
Vec integrate(const Map& map, int parts, int points, int azimuths, F&& f) {
    const Gauss gauss(points);
    Vec sum;
    for (int part = 0; part < parts; part++)
        for (int i = 0; i < points; i++)
            for (int j = 0; j < azimuths; j++) {
                const Direction d = map((part + gauss.at[i]) / parts, (j + 0.5) / azimuths);
                if (d.density > 0) sum = sum + gauss.weight[i] * d.density / (parts * azimuths) * f(d.d);
            }
    return sum;
}

}  // namespace shaderx::tests
