// Measures pairs of shaders of two makers on whatever driver there is: the worker of tools/bench_gpu.
//
//   bench_gpu JOBS [SIZE SAMPLES FRAMES]
//
// JOBS is a text of lines, their words parted by tabs; files are relative to it:
//
//   material NAME
//   shader MAKER VERTEX-FILE PIXEL-FILE                 of the last material
//   texture UNIFORM FILE U-ADDRESS V-ADDRESS FILTER     of the last shader
//
// Standard output: "driver" and its name, then for each material and maker "time", the two names, and milliseconds of
// compiling, of a frame, and of the device (-1: it has no clock), or "failed", the two names, and why.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "draw/draw.h"

namespace shaderx {
namespace {

namespace fs = std::filesystem;

struct Material {
    std::string name;
    std::vector<std::string> makers;
    std::vector<draw::Job> jobs;
};

std::string fileText(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

std::vector<std::string> wordsOf(const std::string& line) {
    std::vector<std::string> words;
    std::istringstream in(line);
    for (std::string word; std::getline(in, word, '\t');) words.push_back(word);
    return words;
}

// Empty after a line that is none of these.
std::vector<Material> readJobs(const fs::path& file, int size, int samples) {
    std::vector<Material> all;
    std::ifstream in(file);
    const fs::path folder = file.parent_path();
    for (std::string line; std::getline(in, line);) {
        const std::vector<std::string> w = wordsOf(line);
        if (w.size() == 2 && w[0] == "material") {
            all.push_back({w[1], {}, {}});
        } else if (w.size() == 4 && w[0] == "shader" && !all.empty()) {
            draw::Job& job = all.back().jobs.emplace_back();
            all.back().makers.push_back(w[1]);
            job.vertex = fileText(folder / w[2]);
            job.pixel = fileText(folder / w[3]);
            job.size = size;
            job.samples = samples;
        } else if (w.size() == 6 && w[0] == "texture" && !all.empty() && !all.back().jobs.empty()) {
            draw::Texture& texture = all.back().jobs.back().textures.emplace_back();
            texture.uniform = w[1];
            texture.file = w[2].empty() ? "" : (folder / w[2]).string();
            texture.uAddress = w[3];
            texture.vAddress = w[4];
            texture.filter = w[5];
        } else {
            std::fprintf(stderr, "bench_gpu: cannot read the line '%s'\n", line.c_str());
            return {};
        }
    }
    if (all.empty()) std::fprintf(stderr, "bench_gpu: no jobs in '%s'\n", file.c_str());
    return all;
}

void measure(draw::Context& context, const Material& material, int frames) {
    Diagnostics diagnostics;
    if (auto times = context.measure(material.jobs, frames, diagnostics)) {
        for (std::size_t i = 0; i < times->size(); i++)
            std::printf("time\t%s\t%s\t%.4f\t%.4f\t%.4f\n", material.name.c_str(), material.makers[i].c_str(),
                        (*times)[i].compile, (*times)[i].frame, (*times)[i].device);
    } else {
        for (const Diagnostic& d : diagnostics.all())
            if (d.severity != Severity::Warning)
                std::printf("failed\t%s\t%s: %s\n", material.name.c_str(), d.message.c_str(),
                            d.notes.empty() ? "" : d.notes[0].message.c_str());
    }
    std::fflush(stdout);
}

}  // namespace
}  // namespace shaderx

int main(int argc, char** argv) {
    using namespace shaderx;
    const auto number = [&](int i, int usual) { return argc > i ? std::atoi(argv[i]) : usual; };
    if (argc < 2 || number(2, 512) < 1 || number(4, 30) < 1) {
        std::fputs("usage: bench_gpu JOBS [SIZE SAMPLES FRAMES], or bench_gpu --driver\n", stderr);
        return 2;
    }
    const bool isAsked = argv[1] == std::string_view("--driver");
    const std::vector<Material> all =
        isAsked ? std::vector<Material>() : readJobs(argv[1], number(2, 512), number(3, 16));
    if (all.empty() && !isAsked) return 1;
    Diagnostics diagnostics;
    const auto context = draw::Context::create(diagnostics);
    if (!context) {
        std::fputs(diagnostics.text().c_str(), stderr);
        return 1;
    }
    std::printf("driver\t%s\n", context->renderer().c_str());
    for (const Material& material : all) measure(*context, material, number(4, 30));
    return 0;
}
