// Writes a document as XML.
#pragma once

#include <string>
#include <string_view>

#include "doc/document.h"

namespace shaderx::doc {

struct WriteOptions {
    // Keep an xi:include as one, and leave out what it brought in; else write the merged document.
    bool keepIncludes = true;
};

// Reading the text again gives the same elements and attributes in the same order, comments included.
std::string write(const Document& document, const WriteOptions& options = {});

// Whether an element can be called so (XML 1.0, production 5; letters beyond ASCII are all taken).
bool isXmlName(std::string_view text);

}  // namespace shaderx::doc
