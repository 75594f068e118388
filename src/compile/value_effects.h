// Which values of a document do nothing.
#pragma once

#include <vector>

#include "base/diagnostics.h"
#include "doc/document.h"

namespace shaderx {

// Which values of a document have an effect on anything that it renders, gathered element by element.
class ValueEffects {
  public:
    void note(doc::ElementId input, bool hasEffect) { found_.push_back({input, hasEffect}); }
    // One note (idle-value) for each node with values that have none.
    void report(const doc::Document& document, Diagnostics& diagnostics);

  private:
    struct Found {
        doc::ElementId input;
        bool hasEffect;
    };
    std::vector<Found> found_;
};

}  // namespace shaderx
