#include "scene/loader.h"

#include <filesystem>

#include <dlfcn.h>

namespace shaderx::scene {

namespace fs = std::filesystem;

DrawingEntry drawingEntry(const char* name, Diagnostics& diagnostics) {
    std::error_code error;
    const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
    for (const fs::path& folder : {here, here / ".." / "lib"}) {
        const fs::path file = folder / "libshaderx_draw.so";
        if (error || !fs::exists(file, error)) continue;
        void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* entry = module ? ::dlsym(module, name) : nullptr;
        if (entry) return reinterpret_cast<DrawingEntry>(entry);
        const char* reason = ::dlerror();
        diagnostics.error("no-module", "cannot load the drawing module '" + file.lexically_normal().string() +
                                           "': " + (reason ? reason : "no reason given"));
        return nullptr;
    }
    diagnostics.error("no-module", "cannot find the drawing module libshaderx_draw.so beside the program or in ../lib");
    return nullptr;
}

}  // namespace shaderx::scene
