#include "draw/loader.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

namespace shaderx::draw {
namespace {

TEST(Loader, DrawsThroughTheModule) {
    const std::string file =
        (std::filesystem::temp_directory_path() / ("shaderx_loader_test_" + std::to_string(::getpid()) + ".png"))
            .string();
    Job job;
    job.vertex = "#version 330\nin vec3 i_position;\nvoid main() { gl_Position = vec4(i_position * 0.5, 1.0); }\n";
    job.pixel = "#version 330\nout vec4 out1;\nvoid main() { out1 = vec4(1.0); }\n";
    job.size = 16;
    job.output = file;
    Diagnostics diagnostics;
    if (!drawWithModule(job, diagnostics)) {
        ASSERT_EQ(diagnostics.all().size(), 1u);
        ASSERT_EQ(diagnostics.all()[0].code, "no-driver") << diagnostics.text();
        GTEST_SKIP() << "no graphics driver here: " << diagnostics.text();
    }
    EXPECT_EQ(std::ifstream(file, std::ios::binary).get(), 0x89);
    std::filesystem::remove(file);
    job.output = "picture.unknown";
    EXPECT_FALSE(drawWithModule(job, diagnostics));
    EXPECT_EQ(diagnostics.all().back().code, "unknown-output-format");
}

}  // namespace
}  // namespace shaderx::draw
