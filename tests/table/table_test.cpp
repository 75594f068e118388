// What the interpreter computes is what the driver computes, for every operation and for every function of the library.
#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "table/check.h"
#include "table/functions.h"
#include "table/operations.h"

namespace shaderx::table {
namespace {

constexpr std::size_t kShownFailures = 20;

// Functions that cannot be compared, by name, each with its reason.
const std::map<std::string_view, std::string_view> kNotCompared = {};

// Bodies of nodes that are no number for some inputs, with the reason. All others are, for all inputs of the test.
const std::map<std::string_view, std::string_view> kOpen = {
    {"ND_invertmatrix_matrix33", "a singular matrix has no inverse"},
    {"ND_invertmatrix_matrix44", "a singular matrix has no inverse"},
    {"ND_divide_matrix33", "a singular matrix has no inverse"},
    {"ND_divide_matrix44", "a singular matrix has no inverse"},
    {"ND_open_pbr_coated_ior", "a part of open_pbr_surface, whose indices are 1 or more"},
    {"ND_open_pbr_coat_darkening", "a part of open_pbr_surface, whose albedos are below 1"},
};

class Table : public testing::Test {
  protected:
    void SetUp() override {
        std::string reason;
        pass_ = FloatPass::open(kWidth, kHeight, reason);
        if (!pass_) GTEST_SKIP() << "no graphics driver here: " << reason;
    }

    // What was compared. Failures, also where a subject has no value to compare, are the test's.
    std::set<std::string> check(ir::Module& program, const std::vector<Subject>& subjects) {
        Checker checker(program, *pass_);
        const std::vector<Outcome> outcomes = checker.check(subjects);
        std::set<std::string> compared;
        std::size_t failures = 0, values = 0, undefined = 0;
        for (std::size_t i = 0; i < subjects.size(); i++) {
            compared.insert(subjects[i].covers);
            values += outcomes[i].compared;
            undefined += outcomes[i].undefined;
            undefined_[subjects[i].covers] += outcomes[i].undefined;
            std::string failure = outcomes[i].failure;
            if (failure.empty() && outcomes[i].compared == 0) failure = subjects[i].name + ": no value is defined";
            if (!failure.empty() && failures++ < kShownFailures) ADD_FAILURE() << failure;
        }
        if (failures > kShownFailures) ADD_FAILURE() << "and " << failures - kShownFailures << " more";
        fmt::print(
            "{} subjects, {} values compared, {} not defined; {} shaders, {:.1f} s in the driver, {:.1f} s in the "
            "interpreter\n",
            subjects.size(), values, undefined, checker.shaders(), checker.driverSeconds(),
            checker.interpreterSeconds());
        return compared;
    }

    std::unique_ptr<FloatPass> pass_;
    NameTable names_;
    std::map<std::string, std::size_t> undefined_;  // values, by what was to be covered
};

TEST_F(Table, Operations) {
    ir::Module program(names_);
    const std::vector<Subject> subjects = operations(program);
    const std::set<std::string> compared = check(program, subjects);
    std::size_t covered = 0, exempt = 0;
    for (int i = 0; i < ir::kOps; i++) {
        const ir::Op op = static_cast<ir::Op>(i);
        const auto found = compared.find(std::string(ir::info(op).name));
        if (!exemption(op).empty()) {
            EXPECT_EQ(found, compared.end()) << ir::info(op).name << " is exempt, and yet it is run";
            exempt++;
        } else if (found == compared.end()) {
            ADD_FAILURE() << "nothing covers the operation " << ir::info(op).name;
        } else {
            covered++;
        }
    }
    fmt::print("covered {} operations, {} exempt\n", covered, exempt);
}

TEST_F(Table, Functions) {
    NodeLibrary nodes(names_);
    ASSERT_TRUE(nodes.library) << nodes.diagnostics.text();
    ir::Module program(names_);
    program.sources = {nodes.bodies.get(), nodes.library.get()};
    std::vector<std::string> all;
    std::vector<Exempt> exempt;
    std::vector<Subject> subjects = functions(nodes, program, all, exempt);
    ASSERT_FALSE(nodes.diagnostics.hasErrors()) << nodes.diagnostics.text();
    std::erase_if(subjects, [&](const Subject& s) { return kNotCompared.count(s.covers) != 0; });
    const std::set<std::string> compared = check(program, subjects);
    for (const auto& [name, reason] : kNotCompared) exempt.push_back({std::string(name), std::string(reason)});
    std::map<std::string, std::string> reasons;
    for (const Exempt& e : exempt) reasons[e.name] = e.reason;
    std::size_t covered = 0;
    for (const std::string& name : all) {
        const auto found = compared.find(name);
        if (found != compared.end())
            covered++;
        else if (!reasons.count(name))
            ADD_FAILURE() << "nothing covers the function " << name;
    }
    for (const auto& [name, reason] : kNotCompared)
        EXPECT_NE(std::find(all.begin(), all.end(), name), all.end())
            << name << " is exempt, and there is no such function";
    for (const auto& [name, values] : undefined_)
        if (name.starts_with("ND_") && values != 0 && !kOpen.count(name))
            ADD_FAILURE() << name << ": " << values << " values are no numbers";
    for (const auto& [name, reason] : kOpen)
        EXPECT_NE(undefined_[std::string(name)], 0u) << name << " is open, and yet it is a number everywhere";
    std::map<std::string, std::size_t> byReason;
    for (const auto& [name, reason] : reasons) byReason[reason]++;
    fmt::print("covered {} functions, {} exempt:\n", covered, reasons.size());
    for (const auto& [reason, count] : byReason) fmt::print("    {} {}\n", count, reason);
}

}  // namespace
}  // namespace shaderx::table
