// Brings documents of older MaterialX versions to 1.39.
#pragma once

#include <string>
#include <vector>

#include "doc/definitions.h"
#include "doc/document.h"

namespace shaderx::doc {

// One thing that the upgrade changed: "<rotate>" is "<rotate3d>" now.
struct Edit {
    Location where;    // in the file as it was read
    std::string path;  // of the element
    std::string was, now;
};

struct UpgradeOptions {
    // The nodes of the libraries, which tell of what type a shader is; none: shaders that the document does not define
    // are of surfaces.
    const Definitions* libraries = nullptr;
    // Takes up what was changed, in the order in which it was.
    std::vector<Edit>* edits = nullptr;
};

// Rewrites, in every part of the document that came from a file of version 1.22 to 1.38, what 1.39 says otherwise;
// docs/upgrade.md lists it. A part of a file without a version is taken for one of the newest version that has all the
// old syntax found in it, with a warning (assumed-version). Sets the root's version to 1.39.
// What cannot be upgraded stays as it is, with a warning (cannot-upgrade).
void upgrade(Document& document, Diagnostics& diagnostics, const UpgradeOptions& options = {});

}  // namespace shaderx::doc
