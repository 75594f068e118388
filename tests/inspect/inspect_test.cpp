// Why shaders are as they are: each tests/inspect/NAME.mtlx with NAME.expected, what `inspect` says of it for a live
// interface. SHADERX_BLESS=1 rewrites what is expected.
#include "compile/inspect.h"

#include <algorithm>
#include <iterator>
#include <set>

#include <nlohmann/json.hpp>

#include "compile/compile.h"
#include "doc/file_resolver.h"
#include "support.h"

namespace shaderx::tests {
namespace {

using Json = nlohmann::json;

class Inspect : public testing::TestWithParam<fs::path> {
  protected:
    void SetUp() override {
        doc::FileResolver files;
        document_ = compiler_.read(GetParam().string(), fileText(GetParam()), files, diagnostics_);
        ASSERT_TRUE(document_) << diagnostics_.text();
    }

    std::vector<Inspection> all(const GenerateOptions& how) {
        std::vector<Inspection> found;
        for (doc::ElementId e : compiler_.renderableElements(*document_)) {
            auto lobes = compiler_.lobes(*document_, e, how, diagnostics_);
            auto costs = compiler_.costs(*document_, e, how, diagnostics_);
            auto shader = compiler_.generate(*document_, e, how, diagnostics_);
            if (lobes && costs && shader) found.push_back({document_->path(e), *lobes, *costs, shader->withoutEffect});
        }
        return found;
    }

    Compiler compiler_{builtinLibrary()};
    Diagnostics diagnostics_;
    std::unique_ptr<doc::Document> document_;
};

TEST_P(Inspect, SaysAsExpected) {
    fs::path expected = GetParam();
    expectFile(expected.replace_extension(".expected"), inspectionText(all({})));
}

TEST_P(Inspect, JsonSaysTheSame) {
    std::vector<Inspection> found = all({});
    Json json = Json::parse(inspectionJson(found));
    ASSERT_EQ(json.size(), found.size());
    for (std::size_t i = 0; i < found.size(); i++) {
        ASSERT_EQ(json[i]["lobes"].size(), found[i].lobes->size());
        for (std::size_t k = 0; k < found[i].lobes->size(); k++) {
            const passes::Lobe& lobe = (*found[i].lobes)[k];
            EXPECT_EQ(json[i]["lobes"][k]["name"], lobe.name);
            EXPECT_EQ(json[i]["lobes"][k]["remains"], lobe.remains);
            EXPECT_EQ(json[i]["lobes"][k].contains("weight"), lobe.remains);
            EXPECT_NE(json[i]["lobes"][k].contains("removed"), lobe.remains);
        }
        EXPECT_EQ(json[i]["withoutEffect"], Json(*found[i].withoutEffect));
        ASSERT_EQ(json[i]["cost"].size(), found[i].costs->size());
        for (std::size_t k = 0; k < found[i].costs->size(); k++)
            EXPECT_EQ(json[i]["cost"][k]["fixed"]["instructions"], (*found[i].costs)[k].fixed.instructions);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Inspect, testing::ValuesIn(filesOf(testFolder("inspect"), ".mtlx")), testName);

// Whether a live value other than 0 and 1 takes part in a removal: such values are not baked, so the lobe stays in the
// program of a live interface, with a weight of 0 for now.
bool staysLive(const passes::Lobe& lobe) {
    const std::set<std::string> baked{"0", "1", "true", "false"};
    for (const passes::Removal& r : lobe.removals)
        for (const passes::Decision& d : r.inputs)
            if (!baked.count(d.value)) return true;
    return false;
}

class InspectGolden : public Inspect {};

// Lobes that remain cost something, those that were removed nothing: both by what the shade stage made. (Light that is
// only added costs nothing of its own.)
TEST_P(InspectGolden, LobesThatRemainAreThoseOfTheProgram) {
    for (Interface interface : {Interface::Live, Interface::Baked}) {
        GenerateOptions how;
        how.interface = interface;
        for (const Inspection& i : all(how)) {
            std::set<std::string> costly, remain, lobes;
            for (const passes::NodeCost& c : *i.costs) costly.insert(c.node);
            for (const passes::Lobe& l : *i.lobes) {
                if (l.leaf.ends_with("_edf") || l.leaf.ends_with("_vdf")) continue;
                if (interface == Interface::Live && staysLive(l)) continue;
                std::string whole = l.node.ends_with("/" + l.name) || l.node == l.name ? l.node : l.node + "/" + l.name;
                lobes.insert(whole);
                if (l.remains) remain.insert(whole);
            }
            std::set<std::string> found;
            std::set_intersection(costly.begin(), costly.end(), lobes.begin(), lobes.end(),
                                  std::inserter(found, found.end()));
            EXPECT_EQ(found, remain) << inspectionText(std::vector<Inspection>{i});
        }
        EXPECT_EQ(diagnostics_.errorCount(), 0u) << diagnostics_.text();
    }
}

INSTANTIATE_TEST_SUITE_P(All, InspectGolden, testing::ValuesIn(filesOf(testFolder("golden"), ".mtlx")), testName);

TEST(InspectCost, SamplesAreThoseOfTheText) {
    Compiler compiler(builtinLibrary());
    Diagnostics diagnostics;
    doc::NoIncludes none;
    auto document = compiler.read("gold.mtlx", fileText(testFolder("golden") / "gold.mtlx"), none, diagnostics);
    ASSERT_TRUE(document);
    doc::ElementId element = compiler.renderableElements(*document).at(0);
    GenerateOptions how;
    std::uint32_t sampled = 0, looked = 0, none_ = 0;
    auto reads = [&](EnvironmentLight light, std::uint32_t& perSample) {
        how.environment = light;
        std::uint32_t fixed = 0;
        auto costs = compiler.costs(*document, element, how, diagnostics);
        EXPECT_TRUE(costs) << diagnostics.text();
        for (const passes::NodeCost& c : *costs) {
            fixed += c.fixed.environmentReads;
            perSample += c.perSample.environmentReads;
        }
        return fixed;
    };
    reads(EnvironmentLight::Samples, sampled);
    EXPECT_GE(sampled, 1u);
    EXPECT_GE(reads(EnvironmentLight::Prefiltered, looked), sampled);
    EXPECT_EQ(looked, 0u);
    EXPECT_EQ(reads(EnvironmentLight::None, none_), 0u);
    EXPECT_EQ(none_, 0u);
}

}  // namespace
}  // namespace shaderx::tests
