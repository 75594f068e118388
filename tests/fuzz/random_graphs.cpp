// random_graphs [COUNT] [FIRST_SEED] [--print]: random documents, each checked as a whole. Those that fail are written
// to the current folder. random_graphs FILE.mtlx…: these documents, drawn with every interface.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "compile/compile.h"
#include "fuzz/check_document.h"
#include "fuzz/random_document.h"
#include "support.h"

using namespace shaderx;

static void write(const std::string& file, const std::string& text) {
    if (std::FILE* out = std::fopen(file.c_str(), "wb")) {
        std::fwrite(text.data(), 1, text.size(), out);
        std::fclose(out);
    }
}

static int checkFiles(int argc, char** argv) {
    fuzz::DocumentChecker checker;
    int failed = 0;
    for (int i = 1; i < argc; i++)
        for (Interface drawn : {Interface::Live, Interface::Baked, Interface::Complete}) {
            const fuzz::Verdict v = checker.check(tests::fileText(argv[i]), drawn);
            if (!v.failure.empty()) failed = 1, std::printf("%s: %s\n", argv[i], v.failure.c_str());
        }
    return failed;
}

int main(int argc, char** argv) {
    if (argc > 1 && std::string_view(argv[1]).ends_with(".mtlx")) return checkFiles(argc, argv);
    const auto number = [&](int i, unsigned long usual) {
        return argc > i ? std::strtoul(argv[i], nullptr, 10) : usual;
    };
    const std::uint32_t count = static_cast<std::uint32_t>(number(1, 100)),
                        first = static_cast<std::uint32_t>(number(2, 0));
    const bool prints = argc > 3 && std::strcmp(argv[3], "--print") == 0;
    const fuzz::NodeTable nodes(builtinLibrary());
    fuzz::DocumentChecker checker;
    if (!checker.hasDriver()) std::puts("no graphics driver here: nothing is drawn");
    std::size_t failed = 0, compared = 0, excused = 0;
    for (std::uint32_t seed = first; seed < first + count; seed++) {
        const std::string text = fuzz::randomDocument(nodes, passes::Dice(seed), checker.pictures());
        if (prints) std::puts(text.c_str());
        const auto start = std::chrono::steady_clock::now();
        const fuzz::Verdict v = checker.check(text, fuzz::interfaceFor(seed));
        const double s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (prints || s > 5) std::printf("seed %u: %.1f s\n", seed, s);
        compared += v.compared, excused += v.excused;
        if (v.failure.empty()) continue;
        failed++;
        // The document, so that it can be kept, and all that is to say, shaders included.
        const std::string stem = "random_graph_" + std::to_string(seed);
        write(stem + ".mtlx", text);
        write(stem + ".txt", v.failure);
        std::printf("seed %u FAILED: %s\n", seed, v.failure.substr(0, v.failure.find('\n')).c_str());
        std::fflush(stdout);
    }
    std::printf("%u documents from seed %u: %zu failed; of %zu components, %.1f %% were excused\n", count, first,
                failed, compared + excused,
                100.0 * static_cast<double>(excused) / static_cast<double>(compared + excused + 1));
    return failed ? 1 : 0;
}
