// Build step: packs the files of a node library into the image that programs carry. pack OUT FILE…
#include <cstdio>
#include <fstream>

#include "compile/compile.h"
#include "doc/file_resolver.h"

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fputs("usage: shaderx_pack OUT FILE...\n", stderr);
        return 2;
    }
    std::vector<shaderx::LibraryFile> files;
    for (int i = 2; i < argc; i++) {
        std::string path = argv[i];
        std::optional<std::string> text = shaderx::doc::readFile(path);
        if (!text) {
            std::fprintf(stderr, "cannot read %s\n", path.c_str());
            return 1;
        }
        files.push_back({path.substr(path.find_last_of('/') + 1), std::move(*text)});
    }
    shaderx::Diagnostics diagnostics;
    std::vector<std::uint8_t> image = shaderx::packLibrary(std::move(files), diagnostics);
    std::fputs(diagnostics.text().c_str(), stderr);
    if (image.empty()) return 1;
    std::ofstream out(argv[1], std::ios::binary);
    out.write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size()));
    return out ? 0 : 1;
}
