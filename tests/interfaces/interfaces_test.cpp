// What interfaces promise: they differ in what a host may change, not in the picture, and a uniform that it changes
// gives the picture that a document with that value gives.
#include <cmath>

#include <nlohmann/json.hpp>

#include "compile/compile.h"
#include "doc/file_resolver.h"
#include "draw/draw.h"
#include "support.h"

namespace shaderx::tests {
namespace {

using image::Image;
using Json = nlohmann::json;

class Interfaces : public testing::Test {
  protected:
    void SetUp() override {
        Diagnostics loading;
        context_ = draw::Context::create(loading);
        if (!context_) GTEST_SKIP() << "no graphics driver here: " << loading.text();
    }

    static fs::path folder() { return fs::path(SHADERX_SOURCE_DIR) / "examples"; }

    std::unique_ptr<doc::Document> read(const std::string& name, const std::string& text) {
        Diagnostics diagnostics;
        doc::FileResolver resolver(std::vector<std::string>{});
        auto document = compiler_.read((folder() / name).string(), text, resolver, diagnostics);
        EXPECT_TRUE(document) << diagnostics.text();
        return document;
    }

    Shader shaderOf(const doc::Document& document, Interface interface) {
        Diagnostics diagnostics;
        GenerateOptions how;
        how.interface = interface;
        Result<Shader> shader =
            compiler_.generate(document, compiler_.renderableElements(document).at(0), how, diagnostics);
        EXPECT_TRUE(shader) << diagnostics.text();
        return shader ? *shader : Shader();
    }

    Image drawn(const Shader& shader, const std::vector<draw::UniformValue>& uniforms = {}) {
        draw::Job job;
        job.vertex = shader.vertex;
        job.pixel = shader.pixel;
        job.size = 48;
        job.samples = 16;
        job.uniforms = uniforms;
        for (const TextureBinding& t : shader.textures)
            job.textures.push_back(
                {t.uniform, (folder() / t.file).string(), t.uAddress, t.vAddress, t.filter, {}, t.path});
        Diagnostics diagnostics;
        Result<Image> picture = context_->render(job, diagnostics);
        EXPECT_TRUE(picture) << diagnostics.text();
        EXPECT_EQ(diagnostics.text(), "");
        return picture ? *picture : Image();
    }

    std::unique_ptr<draw::Context> context_;
    Compiler compiler_{builtinLibrary()};
};

void expectSame(const Image& a, const Image& b, const std::string& what) {
    ASSERT_EQ(a.width, b.width) << what;
    double sum = 0, largest = 0;
    for (int y = 0; y < a.height; y++)
        for (int x = 0; x < a.width; x++)
            for (int c = 0; c < 3; c++) {
                const double d = std::abs(double(a.at(x, y, c)) - b.at(x, y, c));
                sum += d * d;
                largest = std::max(largest, d);
            }
    EXPECT_LT(std::sqrt(sum / (3.0 * a.width * a.height)), 1e-5) << what;
    EXPECT_LT(largest, 1e-3) << what;
}

TEST_F(Interfaces, DrawTheSamePicture) {
    for (const fs::path& file : filesOf(folder(), ".mtlx")) {
        auto document = read(file.filename().string(), fileText(file));
        Image complete = drawn(shaderOf(*document, Interface::Complete));
        for (Interface other : {Interface::Live, Interface::Baked})
            expectSame(complete, drawn(shaderOf(*document, other)),
                       file.filename().string() + (other == Interface::Live ? " live" : " baked"));
    }
}

// Another value of a live uniform, near its own: what decides topology stays as it is.
std::vector<float> moved(const Json& value) {
    std::vector<float> all;
    if (value.is_number())
        all.push_back(value.get<float>());
    else
        for (const Json& v : value) all.push_back(v.get<float>());
    for (std::size_t i = 0; i < all.size(); i++) all[i] = all[i] * 0.8f + 0.0731f + 0.01f * static_cast<float>(i);
    return all;
}

// The text of a shader without the default of one uniform.
std::string withoutDefault(const std::string& text, const std::string& uniform) {
    std::size_t at = text.find(" " + uniform + " = ");
    return at == std::string::npos ? text : text.substr(0, at) + text.substr(text.find(';', at));
}

// Each alone: the same text but for the default, so the same picture. All at once: drawn.
TEST_F(Interfaces, LiveUniformsSetByHandAreDocumentsGeneratedAgain) {
    std::size_t count = 0;
    for (const char* name :
         {"brushed_copper.mtlx", "car_paint_red.mtlx", "ceramic.mtlx", "soap_film.mtlx", "velvet.mtlx"}) {
        auto document = read(name, fileText(folder() / name)), all = read(name, fileText(folder() / name));
        Shader shader = shaderOf(*document, Interface::Live);
        std::vector<draw::UniformValue> uniforms;
        const Json reflection = Json::parse(shader.reflection());
        for (const Json& u : reflection["uniforms"]) {
            if (u["kind"] != "live" || u["type"] == "integer" || u["type"] == "boolean") continue;
            count++;
            std::string uniform = u["name"], path = u["path"], text;
            std::vector<float> values = moved(u["value"]);
            for (float& v : values) {
                text += (text.empty() ? "" : ", ") + std::to_string(v);
                v = std::stof(std::to_string(v));  // as many digits as the document has
            }
            auto changed = read(name, fileText(folder() / name));
            changed->set(changed->find(path), "value", text);
            all->set(all->find(path), "value", text);
            Shader again = shaderOf(*changed, Interface::Live);
            EXPECT_NE(again.pixel, shader.pixel) << name << " " << uniform;
            EXPECT_EQ(withoutDefault(again.pixel, uniform), withoutDefault(shader.pixel, uniform)) << name;
            uniforms.push_back({uniform, values});
        }
        expectSame(drawn(shader, uniforms), drawn(shaderOf(*all, Interface::Live)), name);
    }
    EXPECT_GT(count, 25u);
}

// With a complete interface every lobe that standard_surface has can be had from the shader of a document that says
// nothing.
TEST_F(Interfaces, CompleteUniformsSetByHandAreDocumentsThatSaySo) {
    struct Value {
        const char* input;
        const char* type;
        std::vector<float> values;
    };
    const std::vector<std::vector<Value>> materials = {
        {{"metalness", "float", {1}},
         {"base_color", "color3", {0.9f, 0.6f, 0.3f}},
         {"specular_anisotropy", "float", {0.6f}}},
        {{"metalness", "float", {0.5f}}, {"thin_film_thickness", "float", {450}}, {"thin_film_IOR", "float", {1.33f}}},
        {{"transmission", "float", {0.7f}},
         {"transmission_color", "color3", {0.5f, 0.8f, 0.9f}},
         {"specular_IOR", "float", {1.6f}},
         {"transmission_extra_roughness", "float", {0.1f}}},
        {{"coat", "float", {0.8f}},
         {"coat_color", "color3", {0.9f, 0.3f, 0.2f}},
         {"coat_affect_color", "float", {0.5f}},
         {"coat_affect_roughness", "float", {0.4f}},
         {"coat_anisotropy", "float", {0.5f}},
         {"coat_rotation", "float", {0.2f}}},
        {{"sheen", "float", {0.6f}},
         {"sheen_roughness", "float", {0.4f}},
         {"subsurface", "float", {0.5f}},
         {"diffuse_roughness", "float", {0.8f}},
         {"subsurface_color", "color3", {0.8f, 0.3f, 0.2f}}},
        {{"thin_walled", "boolean", {1}},
         {"subsurface", "float", {1}},
         {"specular", "float", {0}},
         {"emission", "float", {0.2f}},
         {"coat", "float", {1}}},
    };
    auto text = [](const std::string& inputs) {
        return "<materialx version=\"1.39\"><standard_surface name=\"s\" type=\"surfaceshader\">" + inputs +
               "</standard_surface><surfacematerial name=\"m\" type=\"material\"><input name=\"surfaceshader\" "
               "type=\"surfaceshader\" nodename=\"s\"/></surfacematerial></materialx>";
    };
    Shader complete = shaderOf(*read("nothing.mtlx", text("")), Interface::Complete);
    for (const auto& material : materials) {
        std::string inputs;
        std::vector<draw::UniformValue> uniforms;
        for (const Value& v : material) {
            std::string value;
            for (float x : v.values) value += (value.empty() ? "" : ", ") + std::to_string(x);
            if (std::string_view(v.type) == "boolean") value = "true";
            inputs += "<input name=\"" + std::string(v.input) + "\" type=\"" + v.type + "\" value=\"" + value + "\"/>";
            uniforms.push_back({"s_" + std::string(v.input), v.values});
        }
        Image byHand = drawn(complete, uniforms);
        expectSame(byHand, drawn(shaderOf(*read("said.mtlx", text(inputs)), Interface::Baked)), inputs);
    }
}

}  // namespace
}  // namespace shaderx::tests
