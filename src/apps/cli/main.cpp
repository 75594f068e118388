// shaderx: materials to shaders, on the command line.
#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "apps/cli/commands.h"
#include "base/diagnostics.h"

namespace {

using shaderx::cli::Options;

void common(CLI::App& command, Options& o) {
    command.add_option("--path", o.paths, "where to look for included files and textures; may be repeated")
        ->allow_extra_args(false);
    command.add_option("--library", o.libraries, "a folder with more node definitions; may be repeated")
        ->allow_extra_args(false);
    command.add_flag("--follow-links", o.followsLinks, "take included files to which symbolic links lead elsewhere");
    command.add_flag("--strict", o.strict, "what is worth a warning is an error");
    command
        .add_option("--unknown", o.unknown,
                    "default: nodes that nothing defines are a warning, and what reads them takes its default")
        ->check(CLI::IsMember({"error", "default"}));
    command.add_option("--limit", o.limits, "NAME=NUMBER: a limit of what is taken in; docs/robustness.md lists them")
        ->allow_extra_args(false);
}

void shading(CLI::App& command, Options& o, const char* usual = "all that can be rendered") {
    command.add_option("--element", o.element, std::string("the element to compile, by its path; default: ") + usual);
    command
        .add_option("--interface", o.interface,
                    "complete: all values are uniforms; live: authored ones are; baked: none")
        ->check(CLI::IsMember({"complete", "live", "baked", "reduced"}));
    command.add_option("--env", o.light, "the environment's light: sampled, looked up in prefiltered maps, or none")
        ->check(CLI::IsMember({"fis", "prefilter", "none"}));
    command.add_flag("--flip-v", o.flipV, "for hosts that load pictures with their top row first");
    command.add_flag("--transparency", o.transparency, "alpha from opacity; discard what is clear");
    command.add_flag("--blocks", o.blocks, "uniforms in std140 blocks");
    command.add_option("--binding-base", o.bindingBase, "number the bindings of blocks and textures from here")
        ->check(CLI::NonNegativeNumber);
    command.add_option("--colorspace", o.colorspace, "the colour space that shading works in: lin_rec709, acescg, …");
    command.add_option("--unit", o.unit, "what a unit of distance is in the scene");
    command.add_option("--dump", o.dump,
                       "print the program after a stage: read, check, graph, lower, specialise, shade, interface, "
                       "place, legalise, print");
}

void generating(CLI::App& command, Options& o) {
    command.add_option("FILE", o.files, "documents; - is standard input")->required();
    command.add_option("-t,--target", o.target, "the shading language")->check(CLI::IsMember({"glsl"}));
    command.add_option("-o,--out", o.out, "the folder to write to; - is standard output");
    command
        .add_option("-j,--jobs", o.jobs, "threads; default: 1; 0: one a core; what is written does not depend on it")
        ->check(CLI::Range(0, shaderx::cli::kMostThreads));
    shading(command, o);
    common(command, o);
}

void drawing(CLI::App& command, Options& o) {
    command.add_option("FILE", o.files, "the document; - is standard input")->required()->expected(1);
    command.add_option("-o,--out", o.picture, "the picture: .png, or linear .exr or .pfm")->required();
    command.add_option("--with", o.with, "gl: the machine's driver; interpreter: the program itself, on the CPU")
        ->check(CLI::IsMember({"gl", "interpreter"}));
    command.add_option("--size", o.size, "pixels a side")->check(CLI::Range(1, 16384));
    command.add_option("--environment", o.environment,
                       "a latitude-longitude picture of light (.hdr, .exr); default: a sky with two lamps");
    command.add_option("--samples", o.samples, "samples of the environment a pixel and lobe")
        ->check(CLI::Range(0, 1 << 20));
    command.add_option("--exposure", o.exposure, "stops, for .png");
    command.add_option("-j,--jobs", o.jobs, "threads of the interpreter; 0, the default: one a core")
        ->check(CLI::Range(0, shaderx::cli::kMostThreads));
    command.add_flag("--progress", o.progress, "how far the interpreter is, in lines, also where there is no terminal");
    shading(command, o, "the first that can be rendered");
    common(command, o);
}

void inspecting(CLI::App& command, Options& o) {
    command.add_option("FILE", o.files, "documents; - is standard input")->required();
    command.add_flag("--lobes", o.lobes, "which lobes remain, with which weights, and what removed the others");
    command.add_flag("--cost", o.cost, "instructions and reads by node");
    command.add_flag("--idle", o.idle, "authored values that have no effect");
    command.add_flag("--json", o.json, "as JSON");
    shading(command, o);
    common(command, o);
}

void upgrading(CLI::App& command, Options& o) {
    o.out = "-";
    command.add_option("FILE", o.files, "documents; - is standard input")->required();
    command.add_option("-o,--out", o.out,
                       "the file, or for several documents the folder, to write to; default: standard output");
    command.add_flag("--explain", o.explain, "list each change with its line on standard error");
    common(command, o);
}

void evaluating(CLI::App& command, Options& o) {
    command.add_option("FILE", o.files, "the text; - is standard input")
        ->required()
        ->expected(1)
        ->allow_extra_args(false);
    command.add_option("--function", o.function, "its name; default: the last one of the file");
    command.add_option("ARGS", o.arguments, "a value for each parameter: 0.5, or 1,2,3 with components, or true");
}

// Names the first option that a command does not have: CLI11 counts what stands behind it as one file too many.
bool sayUnknownOption(const CLI::App& app, int argc, char** argv) {
    const auto chosen = app.get_subcommands();
    if (chosen.empty()) return false;
    const CLI::App& command = *chosen[0];
    bool isInside = false;
    for (int i = 1; i < argc; i++) {
        const std::string_view word = argv[i];
        if (word == "--") return false;
        const std::string name(word.substr(0, word.find('=')));
        if (isInside && word.starts_with("--") && !command.get_option_no_throw(name)) {
            std::vector<std::string> known;
            for (const CLI::Option* option : command.get_options())
                if (!option->get_lnames().empty()) known.push_back("--" + option->get_lnames()[0]);
            const std::string_view near = shaderx::nearest(name, {known.begin(), known.end()});
            std::fprintf(stderr, "shaderx: %s has no option '%s'\n", command.get_name().c_str(),
                         shaderx::visible(name).c_str());
            if (!near.empty()) std::fprintf(stderr, "  hint: did you mean '%s'?\n", std::string(near).c_str());
            std::fprintf(stderr, "Run with --help for more information.\n");
            return true;
        }
        isInside = isInside || word == command.get_name();
    }
    return false;
}

}  // namespace

int main(int argc, char** argv) {
    Options o;
    CLI::App app{"ShaderX, a compiler for materials"};
    app.set_version_flag("--version", "shaderx " SHADERX_VERSION);
    app.require_subcommand(1);
    // All options of all commands would cost each start 0.3 M instructions: only those of the command asked for.
    auto named = [&](std::string_view command) { return std::find(argv, argv + argc, command) != argv + argc; };

    CLI::App* generate = app.add_subcommand("generate", "write the shaders of MaterialX documents");
    if (named("generate")) generating(*generate, o);

    CLI::App* validate = app.add_subcommand("validate", "report all mistakes of MaterialX documents");
    validate->add_option("FILE", o.files, "documents; - is standard input")->required();
    common(*validate, o);

    CLI::App* draw = app.add_subcommand("draw", "draw a material on a sphere");
    if (named("draw")) drawing(*draw, o);

    CLI::App* inspect = app.add_subcommand("inspect", "say why the shaders of documents are as they are");
    if (named("inspect")) inspecting(*inspect, o);

    CLI::App* upgrade = app.add_subcommand("upgrade", "write documents of older versions anew as ones of 1.39");
    if (named("upgrade")) upgrading(*upgrade, o);

    CLI::App* ir = app.add_subcommand("ir", "check a program in the text form of the IR and print it");
    if (named("ir")) ir->add_option("FILE", o.files, "the text; - is standard input")->required()->expected(1);

    CLI::App* eval = app.add_subcommand("eval", "run a function of a program in the text form of the IR");
    if (named("eval")) evaluating(*eval, o);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        if (sayUnknownOption(app, argc, argv)) return shaderx::cli::kBadUsage;
        return app.exit(e) == 0 ? shaderx::cli::kDone : shaderx::cli::kBadUsage;
    }
    if (*generate) return shaderx::cli::generate(o);
    if (*validate) return shaderx::cli::validate(o);
    if (*inspect) return shaderx::cli::inspect(o);
    if (*upgrade) return shaderx::cli::upgrade(o);
    if (*ir) return shaderx::cli::showIr(o);
    if (*eval) return shaderx::cli::evaluate(o);
    return shaderx::cli::draw(o);
}
