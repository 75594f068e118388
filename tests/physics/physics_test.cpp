// Closure leaves proven by mathematics: what a leaf reflects in sum is what it says, nothing is gained, directions are
// sampled as their density says, and light may be followed from either end.

#include <cmath>
#include <ostream>
#include <random>
#include <set>

#include "physics/leaf.h"
#include "physics/sphere.h"

namespace shaderx::tests {
namespace {

using Numbers = std::map<std::string, std::vector<float>>;

// One form of a leaf, and the numbers to try it with.
struct Form {
    std::string leaf, name;
    Inputs fixed;
    std::vector<Numbers> settings;
    bool mirror = false;  // GGX: `roughness` is among the numbers
    bool white = false;   // reflects all but what the form loses
};

void PrintTo(const Form& form, std::ostream* out) { *out << form.leaf << ", " << form.name; }

const std::vector<double> kCosines{0.1, 0.3, 0.6, 1};

// Every choice from `more` for every setting.
void times(std::vector<Numbers>& settings, const std::string& name, const std::vector<std::vector<float>>& more) {
    std::vector<Numbers> all;
    for (const Numbers& s : settings)
        for (const auto& values : more) {
            all.push_back(s);
            all.back()[name] = values;
        }
    settings = all;
}

const std::vector<std::vector<float>> kRough{{0.05f}, {0.15f}, {0.4f}, {0.7f}, {1}};
const std::vector<std::vector<float>> kApart{{0.05f, 0.5f}, {1, 0.3f}, {0.2f, 0.1f}, {0.1f, 1}, {0.46f, 0.37f}};

// The four forms of every GGX lobe: one roughness, one per direction, retroreflective, and below a thin film.
std::vector<Form> mirrors(const std::string& leaf, const Inputs& words, const std::vector<Numbers>& materials,
                          const std::vector<Numbers>& whites) {
    Numbers bare{{"thinfilm_thickness", {0}}, {"thinfilm_ior", {1.5f}}};
    std::vector<Form> forms;
    const auto add = [&](const char* name, bool retroreflective, bool isotropic, const std::vector<Numbers>& all,
                         const std::vector<std::vector<float>>& roughness, bool film, bool white) {
        Form f{leaf, name, words, {}, true, white};
        f.fixed.switches["retroreflective"] = retroreflective;
        f.fixed.isotropic = isotropic;
        for (Numbers n : all) {
            n.insert(bare.begin(), bare.end());
            if (film) {
                n["thinfilm_thickness"] = {450};
                n["thinfilm_ior"] = {1.3f};
            }
            f.settings.push_back(n);
        }
        times(f.settings, "roughness", roughness);
        forms.push_back(f);
    };
    const std::vector<Numbers> one{materials[0]};
    add("isotropic", false, true, materials, kRough, false, false);
    add("anisotropic", false, false, one, kApart, false, false);
    add("retroreflective", true, false, one, {{0.1f, 0.1f}, {0.3f, 0.8f}}, false, false);
    add("film", false, true, one, {{0.1f}, {0.5f}}, true, false);
    if (!whites.empty()) {
        add("white", false, true, whites, kRough, false, true);
        add("white anisotropic", false, false, whites, kApart, false, true);
    }
    return forms;
}

std::vector<Form> rough(const std::string& leaf, const std::string& name, const Inputs& fixed,
                        const std::vector<std::vector<float>>& roughness) {
    Form f{leaf, name, fixed, {{{"color", {0.8f, 0.5f, 0.2f}}}}};
    times(f.settings, "roughness", roughness);
    Form white = f;
    white.name += " white";
    white.white = true;
    for (Numbers& n : white.settings) n["color"] = {1, 1, 1};
    return {f, white};
}

// The modes that let light through, with the numbers of the first form.
void addThrough(std::vector<Form>& forms) {
    Form through{forms[0].leaf, "through", {{{"scatter_mode", "T"}}}, {forms[0].settings[1]}, true};
    through.fixed.isotropic = true;
    through.fixed.switches["retroreflective"] = false;
    forms.push_back(through);
    through.name = "both";
    through.fixed.words["scatter_mode"] = "RT";
    forms.push_back(through);
}

// Fibres, seen from beside and from along them; light comes from all around.
std::vector<Form> hairs(const std::string& leaf) {
    const Numbers blond{{"tint_R", {1, 0.9f, 0.8f}},    {"tint_TT", {0.7f, 1, 1}},
                        {"tint_TRT", {1, 0.5f, 1}},     {"ior", {1.55f}},
                        {"cuticle_angle", {0.5f}},      {"curve_direction", {1, 0, 0}},
                        {"roughness_R", {0.1f, 0.3f}},  {"roughness_TT", {0.05f, 0.3f}},
                        {"roughness_TRT", {0.2f, 0.3f}}};
    Form fair{leaf, "fair", {}, {blond}};
    fair.settings[0]["absorption_coefficient"] = {0.1f, 0.2f, 0.5f};
    Form rough{leaf, "rough", {}, {blond}};
    rough.settings[0]["absorption_coefficient"] = {1, 1.5f, 3};
    for (const char* lobe : {"roughness_R", "roughness_TT", "roughness_TRT"}) rough.settings[0][lobe] = {1, 1};
    Form tilted{leaf, "tilted", {}, {blond}};
    tilted.settings[0]["absorption_coefficient"] = {0, 0.3f, 0.6f};
    tilted.settings[0]["roughness_R"] = {0.15f, 0.5f};
    tilted.settings[0]["roughness_TT"] = {0.15f, 0.5f};
    tilted.settings[0]["roughness_TRT"] = {0.3f, 0.5f};
    times(tilted.settings, "cuticle_angle", {{0.52f}, {0.45f}});
    times(tilted.settings, "curve_direction", {{0.6f, 0.8f, 0.5f}});
    Form white{leaf, "white", {}, {blond}, false, true};
    white.settings[0]["absorption_coefficient"] = {0, 0, 0};
    for (const char* tint : {"tint_R", "tint_TT", "tint_TRT"}) white.settings[0][tint] = {1, 1, 1};
    return {fair, rough, tilted, white};
}

// How a leaf is tried; none for a leaf that is not known here.
std::vector<Form> formsOf(const std::string& leaf) {
    const std::vector<std::vector<float>> even{{0}, {0.1f}, {0.3f}, {0.6f}, {1}};
    if (leaf == "dielectric_bsdf") {
        std::vector<Numbers> materials;
        for (float ior : {1.5f, 1.1f, 2.5f}) materials.push_back({{"tint", {1, 0.7f, 0.4f}}, {"ior", {ior}}});
        std::vector<Form> forms = mirrors(leaf, {{{"scatter_mode", "R"}}}, materials, {});
        addThrough(forms);
        return forms;
    }
    if (leaf == "conductor_bsdf")
        return mirrors(leaf, {},
                       {{{"ior", {0.183f, 0.421f, 1.373f}}, {"extinction", {3.424f, 2.346f, 1.770f}}},
                        {{"ior", {2.9f, 2.9f, 2.5f}}, {"extinction", {3.1f, 2.9f, 2.7f}}}},
                       {{{"ior", {0, 0, 0}}, {"extinction", {9, 9, 9}}}});
    if (leaf == "generalized_schlick_bsdf") {
        std::vector<Form> forms = mirrors(
            leaf, {{{"scatter_mode", "R"}}},
            {{{"color0", {0.9f, 0.5f, 0.1f}}, {"color82", {1, 0.8f, 0.5f}}, {"color90", {1, 1, 1}}, {"exponent", {5}}},
             {{"color0", {0.04f, 0, 1}}, {"color82", {1, 1, 1}}, {"color90", {1, 0.5f, 0}}, {"exponent", {2}}}},
            {{{"color0", {1, 1, 1}}, {"color82", {1, 1, 1}}, {"color90", {1, 1, 1}}, {"exponent", {5}}}});
        addThrough(forms);
        return forms;
    }
    if (leaf == "oren_nayar_diffuse_bsdf") {
        std::vector<Form> forms = rough(leaf, "qualitative", {{}, {{"energy_compensation", false}}}, even);
        for (Form& f : rough(leaf, "compensated", {{}, {{"energy_compensation", true}}}, even)) forms.push_back(f);
        return forms;
    }
    if (leaf == "burley_diffuse_bsdf") return rough(leaf, "burley", {}, even);
    if (leaf == "sheen_bsdf") {
        const std::vector<std::vector<float>> cloth{{0.05f}, {0.1f}, {0.2f}, {0.3f}, {0.6f}, {1}};
        std::vector<Form> forms = rough(leaf, "conty_kulla", {{{"mode", "conty_kulla"}}}, cloth);
        for (Form& f : rough(leaf, "zeltner", {{{"mode", "zeltner"}}}, cloth)) forms.push_back(f);
        return forms;
    }
    if (leaf == "translucent_bsdf") return rough(leaf, "translucent", {}, {{0}});
    if (leaf == "chiang_hair_bsdf") return hairs(leaf);
    if (leaf == "subsurface_bsdf") {
        std::vector<Form> forms;
        for (float curvature : {0.f, 0.3f, 3.f}) {
            Form f{leaf, "curvature " + std::to_string(curvature), {}, {}};
            f.fixed.curvature = curvature;
            f.settings.push_back({{"color", {1, 0.5f, 0.2f}}, {"radius", {1, 0.4f, 0.1f}}, {"anisotropy", {0}}});
            forms.push_back(f);
        }
        return forms;
    }
    return {};
}

std::vector<Form> allForms() {
    std::vector<Form> all;
    for (const std::string& leaf : BuiltIn().leaves())
        for (Form& f : formsOf(leaf)) all.push_back(f);
    return all;
}

Vec viewAt(double cosine, double azimuth) {
    const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

std::string describe(const Numbers& numbers, Vec v) {
    std::string text;
    for (const auto& [name, values] : numbers) {
        text += name;
        for (float x : values) text += " " + std::to_string(x).substr(0, 5);
        text += ", ";
    }
    return text + "cosine " + std::to_string(v.z).substr(0, 4);
}

SlopeMap slopesOf(const Form& form, const Numbers& numbers, Vec v) {
    const std::vector<float>& r = numbers.at("roughness");
    return {v, r[0], r.back(), false, form.fixed.switches.at("retroreflective")};
}

void expectNear(Vec a, Vec b, double tolerance, const std::string& what) {
    EXPECT_NEAR(a.x, b.x, tolerance) << what;
    EXPECT_NEAR(a.y, b.y, tolerance) << what;
    EXPECT_NEAR(a.z, b.z, tolerance) << what;
}

// Views to try a form from: where it has a direction, from along it, across it and between.
std::vector<Vec> viewsOf(const Form& form) {
    std::vector<Vec> views;
    const bool turned = form.mirror && !form.fixed.isotropic;
    for (double c : kCosines)
        for (double azimuth : turned ? std::vector<double>{0, 0.8, kPi / 2} : std::vector<double>{0.3})
            if (c < 1 || azimuth < 0.5) views.push_back(viewAt(c, azimuth));
    return views;
}

class Physics : public testing::TestWithParam<Form> {
  protected:
    void SetUp() override { ASSERT_TRUE(builtIn_.library); }
    Call call(const std::string& function) { return Call(builtIn_, GetParam().leaf + function, GetParam().fixed); }
    void give(Call& call, const Numbers& numbers, Vec v) {
        Inputs inputs = GetParam().fixed;
        inputs.numbers = numbers;
        call.set(inputs);
        call.vector("V", v);
    }
    BuiltIn builtIn_;
};

TEST(PhysicsCoverage, EveryLeafIsTried) {
    const std::vector<std::string> leaves = BuiltIn().leaves();
    EXPECT_GE(leaves.size(), 8u);
    for (const std::string& leaf : leaves) EXPECT_FALSE(formsOf(leaf).empty()) << leaf << " is not tried";
}

// The integral of eval over light from everywhere is the albedo, and no more than comes in.
TEST_P(Physics, EvalIntegratesToAlbedo) {
    const Form& form = GetParam();
    Call eval = call("_eval"), albedo = call("_albedo");
    ASSERT_FALSE(eval.failed() || albedo.failed()) << eval.errors() << albedo.errors();
    const auto light = [&](Vec d) {
        eval.vector("L", d);
        return eval.run();
    };
    for (const Numbers& numbers : form.settings)
        for (Vec v : viewsOf(form)) {
            give(eval, numbers, v);
            give(albedo, numbers, v);
            Vec sum;
            if (form.mirror) {
                SlopeMap map = slopesOf(form, numbers, v);
                map.above = true;
                sum = integrate(map, 1, 24, 48, light);
            } else {
                // Lobes of hair are narrower than those of other matte surfaces.
                const int finer = form.leaf == "chiang_hair_bsdf" ? 6 : 1;
                sum = integrate(SphereMap(), 2, 16 * finer, 40 * finer, light);
            }
            const Vec said = albedo.run();
            const std::string what = form.leaf + ", " + form.name + ": " + describe(numbers, v);
            expectNear(sum, said, 1e-3, what);
            for (double x : {said.x, said.y, said.z}) {
                EXPECT_LE(x, 1.001) << what;
                EXPECT_GE(x, 0) << what;
            }
        }
}

// Gloss as wide as the hemisphere, integrated without the map that knows where mirrors send light.
TEST_P(Physics, AlbedoHoldsWithoutHalfVectors) {
    const Form& form = GetParam();
    if (!form.mirror) return;
    Call eval = call("_eval"), albedo = call("_albedo");
    ASSERT_FALSE(eval.failed() || albedo.failed()) << eval.errors() << albedo.errors();
    const Numbers* widest = nullptr;
    for (const Numbers& numbers : form.settings)
        if (numbers.at("roughness").front() >= 0.3 && numbers.at("roughness").back() >= 0.3) widest = &numbers;
    if (!widest) return;
    const Vec v = viewAt(0.6, 0.8);
    give(eval, *widest, v);
    give(albedo, *widest, v);
    const Vec sum = integrate(SphereMap(), 2, 32, 64, [&](Vec d) {
        eval.vector("L", d);
        const Vec value = eval.run();
        if (d.z < 0) {
            EXPECT_EQ(length(value), 0) << "light from below";
        }
        return value;
    });
    expectNear(sum, albedo.run(), 1e-3, form.leaf + ", " + form.name + ": " + describe(*widest, v));
}

// f(a, b) f(b, c) f(c, a) = f(b, a) f(c, b) f(a, c): each value is the same for V and L exchanged, but for a factor of
// the view. The published lobes need no such factor. A fitted cosine (Zeltner's sheen) is not reciprocal at all, and no
// fibre is whose normal says where the view meets it.
TEST_P(Physics, ReciprocalButForTheView) {
    const Form& form = GetParam();
    if (form.name.rfind("zeltner", 0) == 0 || form.leaf == "chiang_hair_bsdf") return;
    Call eval = call("_eval");
    ASSERT_FALSE(eval.failed()) << eval.errors();
    const std::set<std::string> exact{"conty_kulla", "compensated", "translucent"};
    const double side = form.leaf == "translucent_bsdf" ? -1 : 1;
    const Vec corners[3] = {viewAt(0.8, 0.1), viewAt(0.5, 2), viewAt(0.3, 4.5)};
    for (const Numbers& numbers : form.settings) {
        const auto value = [&](int i, int j) {
            give(eval, numbers, corners[i]);
            eval.vector("L", {corners[j].x, corners[j].y, side * corners[j].z});
            return (1 / corners[j].z) * eval.run();
        };
        const std::string what = form.leaf + ", " + form.name + ": " + describe(numbers, corners[0]);
        const Vec a = value(0, 1), b = value(1, 2), c = value(2, 0), d = value(1, 0), e = value(2, 1), f = value(0, 2);
        const double one = a.x * b.x * c.x, other = d.x * e.x * f.x;
        EXPECT_NEAR(one, other, 1e-4 * std::abs(one) + 1e-30) << what;
        if (exact.count(form.name)) {
            EXPECT_NEAR(a.x, d.x, 1e-4 * a.x) << what;
        }
    }
}

// What a fibre shows of a world that is not alike on all sides is the integral of the light times eval.
TEST_P(Physics, HairShowsTheIntegral) {
    const Form& form = GetParam();
    if (form.leaf != "chiang_hair_bsdf") return;
    Call eval = call("_eval"), environment = call("_environment");
    ASSERT_FALSE(eval.failed() || environment.failed()) << eval.errors() << environment.errors();
    for (const Numbers& numbers : form.settings)
        for (Vec v : viewsOf(form)) {
            give(eval, numbers, v);
            give(environment, numbers, v);
            const Vec sum = integrate(SphereMap(), 2, 96, 240, [&](Vec d) {
                eval.vector("L", d);
                const Vec f = eval.run(), light = lightFrom(d);
                return Vec{f.x * light.x, f.y * light.y, f.z * light.z};
            });
            const std::string what = form.leaf + ", " + form.name + ": " + describe(numbers, v);
            expectNear(sum, environment.run(), 5e-3, what);
        }
}

// ---- Sampling ----

// The chance of a sum of squares as large as this, after Wilson and Hilferty 1931.
double chanceOf(double chiSquare, int freedom) {
    const double k = freedom, scale = 2 / (9 * k);
    return 0.5 * std::erfc((std::cbrt(chiSquare / k) - (1 - scale)) / std::sqrt(2 * scale));
}

// What a map's cells hold by the density, and what they got of samples.
struct Cells {
    static constexpr int kU = 10, kV = 12, kFine = 6;
    std::vector<double> expected = std::vector<double>(kU * kV), found = std::vector<double>(kU * kV);

    template <typename Map>
    void add(const Map& map, Vec d) {
        double u = 0, v = 0;
        map.inverse(d, u, v);
        const int i = std::min(static_cast<int>(u * kU), kU - 1), j = std::min(static_cast<int>(v * kV), kV - 1);
        found[i * kV + j]++;
    }
    // Cells that expect few samples count as one.
    double chance() const {
        double sum = 0, restExpected = 0, restFound = 0;
        int count = 0;
        const auto cell = [&](double e, double f) {
            sum += (f - e) * (f - e) / e;
            count++;
        };
        for (std::size_t k = 0; k < expected.size(); k++) {
            if (expected[k] >= 10) {
                cell(expected[k], found[k]);
            } else {
                restExpected += expected[k];
                restFound += found[k];
            }
        }
        if (restExpected >= 10) cell(restExpected, restFound);
        return chanceOf(sum, count - 1);
    }
};

template <typename Map>
void compareSamples(const Map& map, Call& sample, Call& pdf, int tests, const std::string& what) {
    constexpr int kSamples = 10000;
    Cells cells;
    double total = 0, above = 0;
    const Gauss gauss(Cells::kFine);
    for (int i = 0; i < Cells::kU; i++)
        for (int j = 0; j < Cells::kV * Cells::kFine; j++)
            for (int k = 0; k < Cells::kFine; k++) {
                const Direction d = map((i + gauss.at[k]) / Cells::kU, (j + 0.5) / (Cells::kV * Cells::kFine));
                if (d.density <= 0) continue;
                pdf.vector("L", d.d);
                const double mass = pdf.run().x * d.density * gauss.weight[k] / (Cells::kU * Cells::kV * Cells::kFine);
                cells.expected[i * Cells::kV + j / Cells::kFine] += mass * kSamples;
                total += mass;
                if (d.d.z > 0) above += mass;
            }
    // The whole sphere: a rough mirror sends some directions below the horizon, where they carry nothing.
    EXPECT_NEAR(total, 1, 2e-3) << what << " (" << above << " above the horizon)";
    std::mt19937 random(1);
    double foundAbove = 0;
    for (int i = 0; i < kSamples; i++) {
        const auto next = [&] { return static_cast<float>(random() >> 8) * 0x1p-24f; };
        const float first = next();
        sample.number("u", {first, next()});
        const Vec d = sample.run();
        ASSERT_NEAR(length(d), 1, 1e-4) << what;
        cells.add(map, d);
        foundAbove += d.z > 0;
    }
    EXPECT_NEAR(foundAbove / kSamples, above, 0.02) << what;
    EXPECT_GT(cells.chance(), 1e-3 / tests) << what;
}

TEST_P(Physics, SamplesFollowTheDensity) {
    const Form& form = GetParam();
    if (form.white) return;  // samples know nothing of colours
    Call sample = call("_sample"), pdf = call("_pdf");
    ASSERT_FALSE(sample.failed() || pdf.failed()) << sample.errors() << pdf.errors();
    constexpr int kTests = 100;  // at most, of all forms
    for (std::size_t k = 0; k < form.settings.size(); k += form.mirror && form.settings.size() > 5 ? 8 : 3)
        for (double cosine : {0.15, 0.8}) {
            const Numbers& numbers = form.settings[k];
            const Vec v = viewAt(cosine, 0.8);
            give(sample, numbers, v);
            give(pdf, numbers, v);
            const std::string what = form.leaf + ", " + form.name + ": " + describe(numbers, v);
            if (form.mirror)
                compareSamples(slopesOf(form, numbers, v), sample, pdf, kTests, what);
            else
                compareSamples(SphereMap(), sample, pdf, kTests, what);
        }
}

INSTANTIATE_TEST_SUITE_P(Leaves, Physics, testing::ValuesIn(allForms()), [](const auto& form) {
    std::string name = form.param.leaf + "_" + form.param.name;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
});

// ---- What the leaves are made of ----

// One bounce of GGX is the same for V and L exchanged, whatever the roughness.
TEST(PhysicsMicrofacet, OneBounceIsReciprocal) {
    BuiltIn builtIn;
    Call bounce(builtIn, "microfacet_bounce", {});
    ASSERT_FALSE(bounce.failed()) << bounce.errors();
    const auto value = [&](Vec v, Vec l, float ax, float ay) {
        bounce.number("roughness", {ax, ay});
        bounce.vector("V", v);
        bounce.vector("L", l);
        bounce.vector("H", normalize(v + l));
        bounce.number("NV", {static_cast<float>(v.z)});
        bounce.number("toView", {static_cast<float>(std::hypot(ax * v.x, ay * v.y, v.z))});
        bounce.set(Inputs{});
        return bounce.run().x / l.z;
    };
    for (const auto& r : kApart)
        for (double a : kCosines)
            for (double b : kCosines) {
                const Vec v = viewAt(a, 0.2), l = viewAt(b, 2.5);
                const double there = value(v, l, r[0], r[1]), back = value(l, v, r[0], r[1]);
                EXPECT_NEAR(there, back, 1e-4 * there);
            }
}

// Numbers of the table that Zeltner et al. publish: the albedo, and A and B by the share of light that they move.
TEST(PhysicsSheen, FibresFollowTheTable) {
    struct Row {
        double cosine, roughness, a, b, albedo;
    };
    BuiltIn builtIn;
    Call albedo(builtIn, "fibre_albedo", {}), transform(builtIn, "fibre_transform", {});
    ASSERT_FALSE(albedo.failed() || transform.failed()) << albedo.errors() << transform.errors();
    for (const Row& row : {Row{2, 4, 0.05724, -0.00717, 0.24931}, Row{8, 8, 0.21199, -0.01460, 0.10220},
                           Row{8, 20, 0.54234, -0.11418, 0.45520}, Row{16, 16, 0.49060, -0.05014, 0.15718},
                           Row{20, 31, 0.86997, -0.00001, 0.44209}, Row{31, 24, 0.77115, 0.00005, 0.15588},
                           Row{4, 31, 0.79981, -0.00003, 0.68291}}) {
        for (Call* call : {&albedo, &transform}) {
            call->set({});
            call->number("NV", {static_cast<float>(row.cosine / 31)});
            call->number("roughness", {static_cast<float>(row.roughness / 31)});
        }
        EXPECT_NEAR(albedo.run().x, row.albedo, 0.008) << row.cosine << " " << row.roughness;
        EXPECT_NEAR(transform.run().x * row.albedo, row.a * row.albedo, 0.01) << row.cosine << " " << row.roughness;
        EXPECT_NEAR(transform.run().y * row.albedo, row.b * row.albedo, 0.006) << row.cosine << " " << row.roughness;
    }
}

// The form for one roughness, which a shader gets where it can see that, gives the values of the other.
TEST(PhysicsMicrofacet, BothFormsOfOneRoughnessAgree) {
    BuiltIn builtIn;
    for (Form form : formsOf("generalized_schlick_bsdf")) {
        if (form.name != "isotropic") continue;
        Inputs two = form.fixed;
        two.isotropic = false;
        for (const char* function : {"_eval", "_pdf", "_albedo"}) {
            Call seen(builtIn, form.leaf + function, form.fixed), unseen(builtIn, form.leaf + function, two);
            ASSERT_FALSE(seen.failed() || unseen.failed()) << seen.errors() << unseen.errors();
            for (Numbers numbers : form.settings)
                for (double cosine : kCosines) {
                    const float r = numbers["roughness"][0];
                    for (Call* c : {&seen, &unseen}) {
                        Inputs inputs{{}, {}, numbers};
                        if (c == &unseen) inputs.numbers["roughness"] = {r, r};
                        c->set(inputs);
                        c->vector("V", viewAt(cosine, 0.4));
                        c->vector("L", normalize(viewAt(0.7, 3.4) + viewAt(cosine, 3.5)));
                    }
                    const Vec a = seen.run(), b = unseen.run();
                    expectNear(a, b, 1e-3 * (function[1] == 'a' ? 1 : length(a)) + 1e-6,
                               function + (": " + describe(numbers, viewAt(cosine, 0))));
                }
        }
    }
}

}  // namespace
}  // namespace shaderx::tests
