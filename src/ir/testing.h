// For tests: programs from their text.
#pragma once

#include <memory>
#include <string_view>

#include <gtest/gtest.h>

#include "ir/text.h"
#include "ir/validate.h"

namespace shaderx::ir {

// A module with its names.
struct TestModule {
    std::unique_ptr<NameTable> names = std::make_unique<NameTable>();
    std::unique_ptr<Module> module = std::make_unique<Module>(*names);

    Function& operator[](std::string_view name) { return *module->findOwn(names->intern(name)); }
};

// The program of a text (see text.h). Fails the test with the diagnostics where it does not parse or, unless told not
// to look, is not valid.
inline TestModule parseModule(std::string_view text, bool mustBeValid = true) {
    TestModule m;
    Diagnostics diagnostics;
    const bool parsed = static_cast<bool>(parse(*m.module, "test", text, diagnostics));
    if (parsed && mustBeValid) validate(*m.module, diagnostics);
    EXPECT_TRUE(diagnostics.all().empty()) << diagnostics.text();
    return m;
}

}  // namespace shaderx::ir
