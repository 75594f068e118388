// What checking a document has found. (Part of checking; see check.h.)
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "doc/document.h"

namespace shaderx::doc {

// A message and what it is about. Two elements of one name are both at fault.
struct Finding {
    Diagnostic diagnostic;
    ElementId element, other;
};

class Findings {
  public:
    explicit Findings(const Document& document) : d_(document) {}

    // Messages about an element, placed at one of its attributes where that is named.
    Diagnostic& error(std::string_view code, std::string message, ElementId e, Name attribute = {}) {
        return add(Severity::Error, code, std::move(message), e, attribute);
    }
    Diagnostic& warning(std::string_view code, std::string message, ElementId e, Name attribute = {}) {
        return add(Severity::Warning, code, std::move(message), e, attribute);
    }
    void add(Diagnostic diagnostic, ElementId e) { all.push_back({std::move(diagnostic), e, {}}); }

    std::vector<Finding> all;

  private:
    Diagnostic& add(Severity severity, std::string_view code, std::string message, ElementId e, Name attribute) {
        Finding& made = all.emplace_back();
        made.element = e;
        made.diagnostic = {severity, std::string(code), std::move(message), d_.locate(e, attribute), d_.path(e), {},
                           {}};
        return made.diagnostic;
    }

    const Document& d_;
};

}  // namespace shaderx::doc
