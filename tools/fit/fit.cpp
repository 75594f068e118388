// Fits the directional albedos that nodes/microfacet.sl and nodes/bsdf_*.sl use: quadrature, then a small rational
// or polynomial form by least squares. Prints each form's coefficients with its largest and RMS error over the grid.
//   c++ -O2 -std=c++20 tools/fit/fit.cpp -o fit && ./fit        (standard library only; half a minute)
//   ./fit ltc_table_sheen_volume.cpp
// The second form fits the sheen of Zeltner, Burley and Chiang 2022 instead, from the table that they publish with
// their paper (github.com/tizian/ltc-sheen, fitting/python/data).
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

namespace {

constexpr double kPi = 3.14159265358979323846;

struct Point {
    double x, y, value, weight = 1;
};

using Basis = std::function<std::vector<double>(double, double)>;

struct Form {
    std::function<double(double, double)> factor;
    Basis numerator, denominator;
};

// What a white GGX surface reflects in one bounce, and the same weighted by Schlick's Fresnel curve.
struct Ggx {
    double white = 0;  // E: reflectance 1
    double edge = 0;   // B: (1 - V.H)^5
};

// E over visible normals (Dupuy and Benyoub 2023): the mean of G2 / G1, height-correlated Smith (Heitz 2014, eq. 99).
Ggx integrateGgx(double nv, double alpha, int n) {
    const double vx = std::sqrt(1 - nv * nv);
    const double length = std::hypot(alpha * vx, nv);
    const double sx = alpha * vx / length, sz = nv / length;
    Ggx sum;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            const double phi = kPi * (j + 0.5) / n;  // half a turn: the other half mirrors it
            const double z = 1 - (i + 0.5) / n * (1 + sz);
            const double r = std::sqrt(std::max(1 - z * z, 0.0));
            double hx = alpha * (r * std::cos(phi) + sx), hy = alpha * r * std::sin(phi), hz = z + sz;
            const double h = std::sqrt(hx * hx + hy * hy + hz * hz);
            hx /= h, hy /= h, hz /= h;
            const double vh = std::min(vx * hx + nv * hz, 1.0);
            const double nl = 2 * vh * hz - nv;
            if (nl <= 0) continue;
            const double lengthL = std::sqrt(nl * nl + alpha * alpha * (1 - nl * nl));
            const double weight = nl * (nv + length) / (nl * length + nv * lengthL);
            const double x = 1 - vh, x5 = x * x * x * x * x;
            sum.white += weight;
            sum.edge += weight * x5;
        }
    }
    const double scale = 1.0 / (double(n) * n);
    return {sum.white * scale, sum.edge * scale};
}

// E with a roughness along each of x and y, exact to 0.0002: half vectors that mirror light from above the horizon, in
// polar coordinates of their slopes stretched by 1 / ax and 1 / ay. On each azimuth the slope ends at the larger root
// of A r^2 - 2 B r - 1 = 0. View at the azimuth psi.
double integrateGgxSlopes(double nv, double psi, double ax, double ay, int n) {
    const double side = std::sqrt(1 - nv * nv), vx = side * std::cos(psi), vy = side * std::sin(psi);
    const double toView = std::hypot(ax * vx, ay * vy, nv);
    double sum = 0;
    for (int j = 0; j < n; j++) {
        const double phi = 2 * kPi * (j + 0.5) / n, px = ax * std::cos(phi), py = ay * std::sin(phi);
        const double a = px * px + py * py, b = (vx * px + vy * py) / nv, root = std::sqrt(b * b + a);
        const double limit = std::atan(b > 0 ? (b + root) / a : 1 / (root - b));
        for (int i = 0; i < n; i++) {
            const double left = 1 - (i + 0.5) / n, tilt = limit * (1 - left * left);
            const double s = std::sin(tilt), c = std::cos(tilt), h = std::hypot(px * s, py * s, c);
            const double hx = px * s / h, hy = py * s / h, hz = c / h, vh = vx * hx + vy * hy + nv * hz;
            const double lz = 2 * vh * hz - nv;
            if (lz <= 0) continue;
            const double toLight = std::hypot(ax * (2 * vh * hx - vx), ay * (2 * vh * hy - vy), lz);
            sum += limit * left * s * h * lz * vh / (lz * toView + nv * toLight);
        }
    }
    return 8 * sum / (double(n) * n);
}

// Sheen: distribution of Conty and Kulla 2017, eq. 2, under the visibility 1 / (4 (NL + NV - NL NV)) of Neubelt and
// Pettineo 2013. The azimuth is integrated over the light's direction.
double integrateSheen(double nv, double roughness, int n) {
    const double vx = std::sqrt(1 - nv * nv), inverse = 1 / roughness;
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const double nl = (i + 0.5) / n, lx = std::sqrt(1 - nl * nl);
        for (int j = 0; j < n; j++) {
            const double phi = kPi * (j + 0.5) / n;
            const double hx = lx * std::cos(phi) + vx, hy = lx * std::sin(phi), hz = nl + nv;
            const double sin2 = (hx * hx + hy * hy) / (hx * hx + hy * hy + hz * hz);
            const double d = (2 + inverse) * std::pow(sin2, 0.5 * inverse) / (2 * kPi);
            sum += d * nl / (4 * (nl + nv - nl * nv));
        }
    }
    return sum * 2 * kPi / (double(n) * n);
}

// Burley 2012, eq. 4, for a white surface.
double integrateBurley(double nv, double roughness, int n) {
    const double vx = std::sqrt(1 - nv * nv), v5 = std::pow(1 - nv, 5);
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const double nl = (i + 0.5) / n, lx = std::sqrt(1 - nl * nl), l5 = std::pow(1 - nl, 5);
        for (int j = 0; j < n; j++) {
            const double lv = nl * nv + lx * vx * std::cos(kPi * (j + 0.5) / n);
            const double bend = roughness * (1 + lv) - 0.5;  // 2 (L.H)^2 = 1 + L.V
            sum += nl * (1 + bend * l5) * (1 + bend * v5);
        }
    }
    return 2 * sum / (double(n) * n);
}

// Oren and Nayar 1994, the qualitative form: the integral of max(0, cos dphi) sin(a) tan(b) cos / pi.
double orenNayarQualitative(double c) {
    const double s = std::sqrt(1 - c * c);
    return 2 * s / kPi * ((std::acos(c) - s * c) / 2 + (1 - s * s * s) / (3 * c));
}

// Oren and Nayar as improved by Fujii, integrated (Portsmouth, Kutz and Hill 2024, eq. 19), divided by pi.
double orenNayarFujii(double c) {
    const double s = std::sqrt(1 - c * c);
    return (s * (std::acos(c) - s * c) + 2.0 / 3 * (s / c * (1 - s * s * s) - s)) / kPi;
}

std::vector<double> solve(std::vector<std::vector<double>> a) {
    const int n = int(a.size());
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++)
            if (std::fabs(a[i][k]) > std::fabs(a[pivot][k])) pivot = i;
        std::swap(a[k], a[pivot]);
        for (int i = 0; i < n; i++) {
            if (i == k || a[k][k] == 0) continue;
            const double f = a[i][k] / a[k][k];
            for (int j = k; j <= n; j++) a[i][j] -= f * a[k][j];
        }
    }
    std::vector<double> x(n);
    for (int i = 0; i < n; i++) x[i] = a[i][n] / a[i][i];
    return x;
}

// The value of a form at a point: factor P / Q, with Q = its first term + the others times squares, so that it has no
// pole.
double evaluate(const Form& form, const std::vector<double>& x, const Point& s) {
    const std::vector<double> up = form.numerator(s.x, s.y), down = form.denominator(s.x, s.y);
    double above = 0, below = down[0];
    for (size_t i = 0; i < up.size(); i++) above += x[i] * up[i];
    for (size_t i = 1; i < down.size(); i++) below += x[up.size() + i - 1] * x[up.size() + i - 1] * down[i];
    return form.factor(s.x, s.y) * above / below;
}

// Least squares by Levenberg and Marquardt. Between its rounds the weights follow the residual (Lawson 1961), which
// pushes the largest error down; the round of the smallest one is printed.
void fit(const char* name, const std::vector<Point>& points, const Form& form) {
    const size_t p = form.numerator(0, 0).size(), n = p + form.denominator(0, 0).size() - 1, count = points.size();
    std::vector<double> x(n, 0.5), best = x, weight(count, 1), residual(count);
    double bestMax = 1e30, bestRms = 0, damping = 1e-2;
    const auto cost = [&](const std::vector<double>& at) {
        double sum = 0;
        for (size_t k = 0; k < count; k++) {
            residual[k] = (evaluate(form, at, points[k]) - points[k].value) * points[k].weight;
            sum += weight[k] * residual[k] * residual[k];
        }
        return sum;
    };
    for (int round = 0; round < 5000; round++) {
        const double before = cost(x);
        std::vector<std::vector<double>> a(n, std::vector<double>(n + 1, 0));
        const std::vector<double> r = residual;
        std::vector<std::vector<double>> slope(n, std::vector<double>(count));
        for (size_t i = 0; i < n; i++) {
            std::vector<double> moved = x;
            const double step = 1e-6 * (1 + std::fabs(x[i]));
            moved[i] += step;
            for (size_t k = 0; k < count; k++)
                slope[i][k] = ((evaluate(form, moved, points[k]) - points[k].value) * points[k].weight - r[k]) / step;
        }
        for (size_t k = 0; k < count; k++)
            for (size_t i = 0; i < n; i++) {
                for (size_t j = 0; j < n; j++) a[i][j] += weight[k] * slope[i][k] * slope[j][k];
                a[i][n] -= weight[k] * slope[i][k] * r[k];
            }
        for (size_t i = 0; i < n; i++) a[i][i] *= 1 + damping, a[i][i] += 1e-14;
        const std::vector<double> move = solve(a);
        std::vector<double> next = x;
        for (size_t i = 0; i < n; i++) next[i] += move[i];
        if (cost(next) < before) {
            x = next;
            damping = std::max(damping * 0.3, 1e-10);
        } else {
            damping = std::min(damping * 4, 1e8);
        }
        double largest = 0, squares = 0, mean = 0, total = 0;
        cost(x);
        for (size_t k = 0; k < count; k++) {
            largest = std::max(largest, std::fabs(residual[k]));
            squares += residual[k] * residual[k];
            mean += std::fabs(residual[k]) / double(count);
        }
        if (largest < bestMax) best = x, bestMax = largest, bestRms = std::sqrt(squares / double(count));
        if (round < 1500 || round % 50 != 0) continue;
        for (size_t k = 0; k < count; k++) total += weight[k] *= 0.8 + 0.2 * std::fabs(residual[k]) / mean;
        for (double& w : weight) w *= double(count) / total;
    }
    std::printf("%s\n  max error %.5f  rms %.5f\n  numerator  ", name, bestMax, bestRms);
    for (size_t i = 0; i < n; i++)
        std::printf(i == p ? "\n  denominator (after its first) %.6g" : " %.6g", i < p ? best[i] : best[i] * best[i]);
    std::printf("\n");
}

// The terms of microfacet_energy's loss over t = NV / toView and z, in the order of its coefficients, times t.
std::vector<double> energyTerms(double t, double z) {
    std::vector<double> terms;
    for (int i = 0; i <= 3; i++)
        for (int j = 0; j <= 3; j++)
            if (i + j <= 4) terms.push_back(std::pow(t, i + 1) * std::pow(z, j));
    for (int j = 0; j <= 2; j++) terms.push_back(t * std::log(t) * std::pow(z, j));
    return terms;
}

double energyVariable(double ax, double ay) {
    const double square = 0.4 * (ax * ax + ay * ay) + 0.2 * ax * ay;
    return square / (square + 0.5);
}

// microfacet_energy: linear least squares for the relative error, Lawson's weights as in fit. Then by how much the true
// E is above and below it where the roughnesses differ up to tenfold, in steps of |ax^2 - ay^2| / (ax^2 + ay^2).
void fitEnergy() {
    struct Sample {
        std::vector<double> terms;
        double lost, weight;
    };
    std::vector<Sample> samples;
    for (int i = 0; i <= 32; i++)
        for (int j = 0; j <= 24; j++) {
            const double t = std::max(0.5 - 0.5 * std::cos(kPi * i / 32), 1e-3);
            const double a = 0.0005 + 0.9995 * (0.5 - 0.5 * std::cos(kPi * j / 24));
            const double nv = std::min(t * a / std::sqrt(1 - t * t * (1 - a * a)), 1.0);
            const double white = integrateGgxSlopes(nv, 0, a, a, 150);
            samples.push_back({energyTerms(t, energyVariable(a, a)), 1 - white, 1 / white});
        }
    const size_t n = samples[0].terms.size();
    std::vector<double> lawson(samples.size(), 1), best;
    double bestMax = 1e30;
    const auto valueOf = [](const std::vector<double>& x, const std::vector<double>& terms) {
        double sum = 0;
        for (size_t i = 0; i < x.size(); i++) sum += x[i] * terms[i];
        return sum;
    };
    for (int round = 0; round < 300; round++) {
        std::vector<std::vector<double>> a(n, std::vector<double>(n + 1, 0));
        for (size_t k = 0; k < samples.size(); k++) {
            const Sample& s = samples[k];
            const double w = lawson[k] * s.weight * s.weight;
            for (size_t i = 0; i < n; i++) {
                for (size_t j = 0; j < n; j++) a[i][j] += w * s.terms[i] * s.terms[j];
                a[i][n] += w * s.terms[i] * s.lost;
            }
        }
        const std::vector<double> x = solve(a);
        std::vector<double> error;
        double largest = 0, mean = 0, total = 0;
        for (const Sample& s : samples) {
            error.push_back(std::fabs(valueOf(x, s.terms) - s.lost) * s.weight);
            largest = std::max(largest, error.back());
            mean += error.back() / double(samples.size());
        }
        if (largest < bestMax) best = x, bestMax = largest;
        for (size_t k = 0; k < samples.size(); k++) total += lawson[k] *= 0.7 + 0.3 * error[k] / mean;
        for (double& w : lawson) w *= double(samples.size()) / total;
    }
    std::printf("microfacet_energy\n  max relative error %.5f\n ", bestMax);
    for (double x : best) std::printf(" %.6g", x);
    std::printf("\n  true E by this, up to: ");
    double most[11] = {}, least = 1;
    for (int i = 0; i < 12; i++)
        for (int j = 0; j <= 20; j++)
            for (int k = 0; k <= 12; k++)
                for (int p = 0; p <= 4; p++) {
                    const double ax = std::pow(0.7, i), ay = ax * std::pow(10, -1 + j / 10.0), nv = (k + 0.5) / 12.5;
                    if (ay > 1) continue;
                    const double psi = kPi / 8 * p, side = std::sqrt(1 - nv * nv);
                    const double toView = std::hypot(ax * side * std::cos(psi), ay * side * std::sin(psi), nv);
                    const double fitted = 1 - valueOf(best, energyTerms(nv / toView, energyVariable(ax, ay)));
                    const double ratio = integrateGgxSlopes(nv, psi, ax, ay, 64) / fitted;
                    const double apart = std::fabs(ax * ax - ay * ay) / (ax * ax + ay * ay);
                    most[int(10 * apart)] = std::max(most[int(10 * apart)], ratio);
                    least = std::min(least, ratio);
                }
    for (double m : most) std::printf(" %.4f", m);
    std::printf("; at least %.4f\n", least);
}

// The linearly transformed cosine of Zeltner et al., A, B and R of 32 cosines in each of 32 lines of a roughness: as
// the table holds them, for cosines and roughness from 0 to 1. Errors count as much as the light that they move.
bool fitSheenVolume(const char* path) {
    std::FILE* file = std::fopen(path, "r");
    if (!file) return false;
    std::vector<double> numbers;
    for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
        double abr[3];
        if (c == 'f' && std::fscanf(file, "(%lf, %lf, %lf)", abr, abr + 1, abr + 2) == 3)
            numbers.insert(numbers.end(), abr, abr + 3);
    }
    std::fclose(file);
    if (numbers.size() != 3 * 32 * 32) return false;
    std::vector<Point> scale, shear, reflected;
    for (int i = 0; i < 32; i++)
        for (int j = 0; j < 32; j++) {
            const double* abr = &numbers[3 * (32 * i + j)];
            const double nv = j / 31.0, r = i / 31.0, light = abr[2];
            if (light < 1e-4 || nv == 0) continue;
            scale.push_back({nv, r, abr[0], light});
            shear.push_back({nv, r, abr[1], light});
            reflected.push_back({nv, r, -std::log(light), light});
        }
    const auto one = [](double, double) { return 1.0; };
    fit("fibre_albedo: -log of it (error as albedo)", reflected,
        {one,
         [](double n, double r) {
             return std::vector<double>{1, n, n * n, r, n * r, n * n * r, r * r, n * r * r, r * r * r};
         },
         [](double n, double r) { return std::vector<double>{r * r, r, n * r, n * r * r}; }});
    fit("fibre_transform: A (error times albedo)", scale,
        {one, [](double n, double r) { return std::vector<double>{1, n, n * n, r, n * r, r * r}; },
         [](double n, double r) { return std::vector<double>{1, n, r, n * r}; }});
    fit("fibre_transform: B, times (1 - r) sqrt(1 - n) (error times albedo)", shear,
        {[](double n, double r) { return std::sqrt(1 - n) * (1 - r); },
         [](double n, double r) { return std::vector<double>{r, n * r, r * r, n * r * r, r * r * r, n * n}; },
         [](double n, double r) { return std::vector<double>{1, n * n, r * r, n * r * r}; }});
    return true;
}

// Compares sheen_excess, made by hand from the albedo along the surface, with the albedo where that exceeds 1.
void checkSheenExcess() {
    double most = 0;
    for (int i = 0; i <= 40; i++)
        for (int j = 0; j <= 40; j++) {
            const double s = 0.1 + 0.9 * i / 40.0, nv = 0.0001 + 0.3 * std::pow(j / 40.0, 2), r = s * s;
            const double excess = (0.395 + 0.0378 * s + 0.23 * r) / (s + 2.1 * nv);
            most = std::max(most, integrateSheen(nv, r, 600) / std::max(excess, 1.0));
        }
    std::printf("sheen_excess: what it leaves is at most %.4f\n", most);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 1) return fitSheenVolume(argv[1]) ? 0 : 1;
    // Both ends are where the curves bend: the grid is denser towards a view along the surface and a smooth surface.
    std::vector<Point> white, edge, sheen, burley, qualitative, fujii;
    double most = 0, mostSheen = 0;
    for (int i = 0; i <= 32; i++) {
        const double t = i / 32.0, nv = 0.02 + 0.98 * t * t * (1.5 - 0.5 * t);
        for (int j = 0; j <= 24; j++) {
            const double u = j / 24.0, alpha = 0.01 + 0.99 * u * u;
            const Ggx g = integrateGgx(nv, alpha, 160);
            white.push_back({nv, alpha, 1 - g.white});
            // Reflectance at which cosine is the mean? Errors count as much as reflectance changes there.
            const double mean = 1 - std::pow(g.edge / g.white, 0.2);
            edge.push_back({nv, alpha, mean - nv, 5 * std::pow(1 - mean, 4)});
            const double roughness = 0.1 + 0.9 * u;
            sheen.push_back({nv, roughness, integrateSheen(nv, roughness, 160)});
            burley.push_back({nv, u, integrateBurley(nv, u, 64)});
            mostSheen = std::max(mostSheen, sheen.back().value);
        }
        const double c = std::max(i / 32.0, 1e-6);
        qualitative.push_back({1 - c, 0, orenNayarQualitative(c)});
        fujii.push_back({1 - c, 0, orenNayarFujii(c)});
        for (int j = 1; j <= 100; j++) {
            const double s2 = 0.0001 * j * j;
            most = std::max(most, 1 - 0.5 * s2 / (s2 + 0.33) + 0.45 * s2 / (s2 + 0.09) * qualitative.back().value);
        }
    }
    const auto one = [](double, double) { return 1.0; };
    const Basis none = [](double, double) { return std::vector<double>{1}; };
    const Basis sixTerms = [](double n, double a) { return std::vector<double>{1, n, n * n, a, n * a, a * a}; };
    // The lobe's own scale is n / a: its dip moves towards the horizon as the surface gets smooth.
    fit("1 - E, times n a: microfacet_white", white,
        {[](double n, double a) { return n * a; },
         [](double n, double a) { return std::vector<double>{1, n, n * a, a * a}; },
         [](double n, double a) { return std::vector<double>{n * n, a * a, n * a * a}; }});
    fit("cosine of mean reflectance - n, times a: microfacet_cosine (error as reflectance)", edge,
        {[](double, double a) { return a; }, [](double n, double a) { return std::vector<double>{a, n, n * n, n * a}; },
         [](double n, double a) { return std::vector<double>{n, a, a * a, n * a}; }});
    fit("sheen_fit", sheen, {one, sixTerms, [](double n, double r) { return std::vector<double>{1, n, r, n * r}; }});
    fit("burley_fit", burley,
        {one,
         [](double n, double r) {
             const double t5 = std::pow(1 - n, 5);
             return std::vector<double>{1, t5, r, r * t5, r * t5 * t5, r * r * t5};
         },
         none});
    fit("qualitative Oren-Nayar over t = 1 - n, times the sine", qualitative,
        {[](double t, double) { return std::sqrt(t * (2 - t)); },
         [](double t, double) { return std::vector<double>{1, t, t * t}; }, none});
    fit("Fujii's Oren-Nayar over t = 1 - n", fujii,
        {one, [](double t, double) { return std::vector<double>{t, t * t, t * t * t, t * t * t * t}; }, none});
    std::printf("largest albedo: sheen %.4f, qualitative Oren-Nayar of a white surface %.4f\n", mostSheen, most);
    fitEnergy();
    checkSheenExcess();
}
