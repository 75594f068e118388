// Writes a document as XML.
#pragma once

#include <string>

#include "doc/document.h"

namespace shaderx::doc {

struct WriteOptions {
    // Keep an xi:include as one, and leave out what it brought in; else write the merged document.
    bool keepIncludes = true;
};

// Reading the text again gives the same elements and attributes in the same order, comments included.
std::string write(const Document& document, const WriteOptions& options = {});

}  // namespace shaderx::doc
