// A door of the module that scene/loader.h opens. Both sides are built together, so C++ types may pass through it.
#include "oracle/render.h"

extern "C" __attribute__((visibility("default"))) int shaderx_oracle_run(const void* job, void* diagnostics) {
    shaderx::Diagnostics& reports = *static_cast<shaderx::Diagnostics*>(diagnostics);
    try {
        return shaderx::oracle::draw(*static_cast<const shaderx::oracle::RenderJob*>(job), reports) ? 1 : 0;
    } catch (const std::exception& error) {
        reports.add(shaderx::Severity::Internal, "internal-error", error.what());
        return 0;
    }
}
