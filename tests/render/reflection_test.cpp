// What reflection says of a shader against what a driver finds active in it: over all golden documents, the project's
// examples and, where they are there, MaterialX's.
#include "compile/compile.h"
#include "doc/file_resolver.h"
#include "draw/draw.h"
#include "support.h"

namespace shaderx::tests {
namespace {

using Variables = std::vector<draw::Active::Variable>;

std::string glslType(ir::Type type) {
    switch (type) {
        case ir::Type::Boolean:
            return "bool";
        case ir::Type::Integer:
            return "int";
        case ir::Type::Float:
            return "float";
        case ir::Type::Vector2:
            return "vec2";
        case ir::Type::Color4:
        case ir::Type::Vector4:
            return "vec4";
        case ir::Type::Matrix33:
            return "mat3";
        case ir::Type::Matrix44:
            return "mat4";
        case ir::Type::Texture2D:
            return "sampler2D";
        default:
            return "vec3";
    }
}

void sort(Variables& all) {
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
}

std::string text(const Variables& all) {
    std::string out;
    for (const auto& v : all) out += v.type + " " + v.name + " " + v.block + " " + std::to_string(v.offset) + "\n";
    return out;
}

std::vector<fs::path> documents() {
    std::vector<fs::path> all = filesOf(testFolder("golden"), ".mtlx");
    std::vector<fs::path> folders{fs::path(SHADERX_SOURCE_DIR) / "examples"};
    fs::path shared = fs::path(SHADERX_SOURCE_DIR) / "../shared/resources/Materials";
    if (fs::exists(shared / "Examples"))
        for (const auto& entry : fs::directory_iterator(shared / "Examples")) folders.push_back(entry.path());
    if (fs::exists(shared / "Features")) folders.push_back(shared / "Features");
    std::sort(folders.begin(), folders.end());
    for (const fs::path& folder : folders)
        for (const fs::path& file : filesOf(folder, ".mtlx")) all.push_back(file);
    return all;
}

// Textures of the chess set that weigh subsurface scattering against diffuse: under the environment both are the same
// light, so that a driver with algebra of its own may find that the weights do not matter.
bool mayCancel(const std::string& name) {
    return name == "sss_file" || name == "sss1_file" || name == "mtlximage3_file" || name == "mtlximage8_file";
}

class Reflection : public testing::Test {
  protected:
    void SetUp() override {
        Diagnostics loading;
        context_ = draw::Context::create(loading);
        if (!context_) GTEST_SKIP() << "no graphics driver here: " << loading.text();
    }

    void check(const Shader& shader, const std::string& what) {
        Variables uniforms, inputs;
        for (const UniformBinding& u : shader.uniforms)
            uniforms.push_back({u.name, glslType(u.type),
                                u.block < 0 ? "" : shader.blocks.at(std::size_t(u.block)).name,
                                static_cast<int>(u.offset)});
        for (const TextureBinding& t : shader.textures) uniforms.push_back({t.uniform, "sampler2D", "", 0});
        for (const VertexInputBinding& i : shader.inputs) inputs.push_back({i.name, glslType(i.type), "", 0});
        sort(uniforms);
        sort(inputs);
        Diagnostics diagnostics;
        Result<draw::Active> active = context_->active(shader.vertex, shader.pixel, diagnostics);
        ASSERT_TRUE(active) << what << "\n" << diagnostics.text();
        if (what.starts_with("standard_surface_chess_set "))
            std::erase_if(uniforms, [&](const auto& u) {
                auto same = [&](const auto& a) { return a.name == u.name; };
                return mayCancel(u.name) && std::none_of(active->uniforms.begin(), active->uniforms.end(), same);
            });
        EXPECT_EQ(text(active->uniforms), text(uniforms)) << what;
        EXPECT_EQ(text(active->inputs), text(inputs)) << what;
        checked_++;
    }

    void checkAll(const GenerateOptions& how) {
        for (const fs::path& file : documents()) {
            Diagnostics diagnostics;
            doc::FileResolver files;
            Compiler compiler(builtinLibrary());
            auto document = compiler.read(file.string(), fileText(file), files, diagnostics);
            ASSERT_TRUE(document) << diagnostics.text();
            // What cannot be generated is the business of other tests.
            for (doc::ElementId e : compiler.renderableElements(*document))
                if (Result<Shader> shader = compiler.generate(*document, e, how, diagnostics))
                    check(*shader, file.stem().string() + " " + shader->element);
        }
        EXPECT_GT(checked_, 30u);
    }

    std::unique_ptr<draw::Context> context_;
    std::size_t checked_ = 0;
};

TEST_F(Reflection, OfLiveShadersIsWhatTheDriverFinds) { checkAll({}); }

TEST_F(Reflection, OfBakedShadersIsWhatTheDriverFinds) {
    GenerateOptions how;
    how.interface = Interface::Baked;
    checkAll(how);
}

TEST_F(Reflection, OfBlocksIsWhatTheDriverFinds) {
    GenerateOptions how;
    how.blocks = true;
    how.bindingBase = 1;
    how.transparency = true;
    checkAll(how);
}

}  // namespace
}  // namespace shaderx::tests
