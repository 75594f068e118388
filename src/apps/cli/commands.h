// What the program does.
#pragma once

#include <string>
#include <vector>

namespace shaderx::cli {

constexpr int kMostThreads = 1024;

enum ExitCode { kDone = 0, kInputErrors = 1, kBadUsage = 2, kOurBug = 3 };

struct Options {
    std::vector<std::string> files, paths, libraries, limits;
    std::string out = ".", target = "glsl", element, interface = "live", dump;
    bool followsLinks = false, strict = false;
    std::string unknown = "error";
    // of the shaders that are made
    std::string light = "fis", unit = "meter", colorspace = "lin_rec709";
    bool flipV = false, transparency = false, blocks = false;
    int bindingBase = -1;
    int jobs = -1;  // threads; 0: one a core; below it, what the command usually takes
    // of draw
    std::string picture, environment, with = "gl";
    int size = 512, samples = 1024;
    float exposure = 0;
    bool progress = false;
    // of inspect
    bool lobes = false, cost = false, idle = false, json = false;
    // of upgrade
    bool explain = false;
    // of eval
    std::string function;
    std::vector<std::string> arguments;
};

int generate(const Options& options);
int validate(const Options& options);
int draw(const Options& options);
int inspect(const Options& options);
int upgrade(const Options& options);
int showIr(const Options& options);
int evaluate(const Options& options);

}  // namespace shaderx::cli
