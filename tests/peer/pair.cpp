// Draws shaders of two makers on the same sphere, under the same sky, and says how far the pictures are from each
// other.
//
// Reads jobs from standard input, one JSON object a line, and answers each with one on standard output:
//
//   in   {"id": "…", "size": 48, "samples": 16, "environment": "white.pfm", "pictures": "grid.pfm",
//         "theirs": ["a.vert", "a.frag"] or "a.pfm", "ours": [["b.vert", "b.frag"], …]}
//   out  {"id": "…", "theirs": "" or why not drawn, "ours": [{"glslang": "" or its complaint, "draw": "" or why not,
//         "max": …, "rmse": …, "odd": …, "undefined": …, "highest": …, "lowest": …, "bad": …, "mean": [r, g, b]}, …]}
//
// `environment` (a picture of radiance; the built-in sky) and `theirs` may be left out; `pictures` is what every
// sampler of a material reads. `max` is the largest difference of a channel, relative where their value exceeds 1;
// `odd` the share of covered pixels in which it exceeds `tolerance` (1e-3); `rmse` is over the whole picture, values
// clamped to 0 … 4; `undefined` that of pixels in which theirs is no finite number, where nothing is compared.
// `highest`, `lowest` and `bad` (channels that are no finite number) are of our picture alone, colours only.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <nlohmann/json.hpp>

#include "draw/draw.h"

namespace shaderx {
namespace {

using image::Image;
using Json = nlohmann::json;

struct Text {
    std::string vertex, pixel;
    friend bool operator==(const Text&, const Text&) = default;
};

std::string fileText(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

Text textOf(const Json& files) { return {fileText(files.at(0)), fileText(files.at(1))}; }

// What the reference compiler of the language says against a pair; empty if nothing.
std::string complaint(const Text& text) {
    glslang::TShader vertex(EShLangVertex), pixel(EShLangFragment);
    glslang::TProgram program;
    const auto parse = [&](glslang::TShader& shader, const std::string& source) {
        const char* start = source.c_str();
        shader.setStrings(&start, 1);
        const bool ok = shader.parse(GetDefaultResources(), 100, false, EShMsgDefault);
        program.addShader(&shader);
        return ok ? std::string() : std::string(shader.getInfoLog());
    };
    std::string found = parse(vertex, text.vertex) + parse(pixel, text.pixel);
    if (found.empty() && !program.link(EShMsgDefault)) found = program.getInfoLog();
    return found;
}

// The names of a shader's samplers, but for those of the environment.
std::set<std::string> samplersOf(const std::string& text) {
    static const std::regex declaration(R"(uniform\s+sampler2D\s+(\w+))");
    std::set<std::string> names;
    for (std::sregex_iterator at(text.begin(), text.end(), declaration), end; at != end; ++at) names.insert((*at)[1]);
    names.erase("u_envRadiance");
    names.erase("u_envIrradiance");
    return names;
}

struct Drawn {
    std::optional<Image> picture;
    std::string reason;  // why there is none
};

class Painter {
  public:
    Painter(draw::Context& context, const Json& settings) : context_(context), settings_(settings) {}

    Drawn drawn(const Text& text) const {
        draw::Job job;
        job.vertex = text.vertex;
        job.pixel = text.pixel;
        job.size = settings_.value("size", 48);
        job.samples = settings_.value("samples", 16);
        job.environment = settings_.value("environment", "");
        job.supersample = 1;
        job.uniforms = {{"u_time", {1.25f}}, {"u_frame", {7}}};
        for (const std::string& name : samplersOf(text.pixel)) {
            scene::Texture texture;
            texture.uniform = name;
            texture.file = settings_.value("pictures", "");
            job.textures.push_back(texture);
        }
        Diagnostics diagnostics;
        Result<Image> picture = context_.render(job, diagnostics);
        if (picture) return {std::move(*picture), ""};
        return {std::nullopt, diagnostics.text()};
    }

  private:
    draw::Context& context_;
    const Json& settings_;
};

// A difference of two channels, relative to theirs where that is larger than 1. Theirs that is no finite number is
// nothing to compare with.
double difference(float ours, float theirs) {
    if (ours == theirs || !std::isfinite(theirs)) return 0;
    const double d = std::fabs(double(ours) - double(theirs)) / std::max(1.0, std::fabs(double(theirs)));
    return std::isfinite(d) ? d : 1e9;
}

double clamped(float v) { return std::isnan(v) ? 4.0 : std::clamp(double(v), 0.0, 4.0); }

void compare(const Image& ours, const Image& theirs, double tolerance, Json& row) {
    if (ours.width != theirs.width || ours.height != theirs.height) {
        row["draw"] = "the pictures differ in size";
        return;
    }
    double largest = 0, squares = 0;
    int covered = 0, odd = 0, undefined = 0;
    for (int y = 0; y < ours.height; y++)
        for (int x = 0; x < ours.width; x++) {
            double pixel = 0;
            bool defined = true;
            for (int c = 0; c < std::min(theirs.channels, 4); c++) {
                const float a = ours.at(x, y, c), b = theirs.at(x, y, c);
                pixel = std::max(pixel, difference(a, b));
                defined &= std::isfinite(b);
                if (c < 3 && std::isfinite(b)) squares += (clamped(a) - clamped(b)) * (clamped(a) - clamped(b));
            }
            covered += ours.at(x, y, 3) != 0 || theirs.at(x, y, theirs.channels - 1) != 0;
            odd += pixel > tolerance;
            undefined += !defined;
            largest = std::max(largest, pixel);
        }
    row["max"] = largest;
    row["odd"] = double(odd) / std::max(covered, 1);
    row["undefined"] = double(undefined) / std::max(covered, 1);
    row["rmse"] = std::sqrt(squares / (3.0 * ours.width * ours.height));
}

// What our picture is like by itself.
void describe(const Image& ours, Json& row) {
    double sums[3] = {}, highest = 0, lowest = 0;
    int covered = 0, bad = 0;
    for (int y = 0; y < ours.height; y++)
        for (int x = 0; x < ours.width; x++) {
            bool seen = false;
            for (int c = 0; c < ours.channels; c++) seen |= ours.at(x, y, c) != 0;
            if (!seen) continue;
            covered++;
            for (int c = 0; c < std::min(ours.channels, 3); c++) {
                const float v = ours.at(x, y, c);
                if (!std::isfinite(v)) {
                    bad++;
                    continue;
                }
                sums[c] += v;
                highest = std::max(highest, double(v));
                lowest = std::min(lowest, double(v));
            }
        }
    row["highest"] = highest;
    row["lowest"] = lowest;
    row["bad"] = bad;
    row["mean"] = Json::array();
    for (double sum : sums) row["mean"].push_back(sum / std::max(covered, 1));
}

Json answer(draw::Context& context, const Json& job) {
    const Painter painter(context, job);
    Json out{{"id", job.at("id")}, {"theirs", ""}, {"ours", Json::array()}};
    Drawn theirs;
    if (job.contains("theirs") && job["theirs"].is_string()) {
        Diagnostics diagnostics;
        const Result<Image> picture = image::readImage(job["theirs"], diagnostics);
        if (picture)
            theirs.picture = *picture;
        else
            theirs.reason = diagnostics.text();
    } else if (job.contains("theirs")) {
        theirs = painter.drawn(textOf(job["theirs"]));
    }
    out["theirs"] = theirs.reason;
    if (theirs.picture) describe(*theirs.picture, out["peer"]);
    std::vector<Text> known;
    for (const Json& files : job.at("ours")) {
        const Text text = textOf(files);
        const auto same = static_cast<std::size_t>(std::find(known.begin(), known.end(), text) - known.begin());
        known.push_back(text);
        if (same + 1 < known.size()) {  // two interfaces, one shader
            const Json before = out["ours"][same];
            out["ours"].push_back(before);
            continue;
        }
        Json& row = out["ours"].emplace_back(Json::object());
        row["glslang"] = complaint(text);
        const Drawn ours = painter.drawn(text);
        row["draw"] = ours.reason;
        if (!ours.picture) continue;
        describe(*ours.picture, row);
        if (theirs.picture) compare(*ours.picture, *theirs.picture, job.value("tolerance", 1e-3), row);
    }
    return out;
}

int run() {
    Diagnostics loading;
    const std::unique_ptr<draw::Context> context = draw::Context::create(loading);
    if (!context) {
        std::fputs(loading.text().c_str(), stderr);
        return 1;
    }
    glslang::InitializeProcess();
    for (std::string line; std::getline(std::cin, line);) {
        if (line.empty()) continue;
        std::cout << answer(*context, Json::parse(line)).dump(-1, ' ', true, Json::error_handler_t::replace)
                  << std::endl;
    }
    glslang::FinalizeProcess();
    return 0;
}

}  // namespace
}  // namespace shaderx

int main() {
    try {
        return shaderx::run();
    } catch (const std::exception& error) {  // of the JSON library, for a job that is none
        std::fprintf(stderr, "shader_pair: %s\n", error.what());
        return 2;
    }
}
