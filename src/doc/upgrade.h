// Brings documents of older MaterialX versions to 1.39.
#pragma once

#include "doc/document.h"

namespace shaderx::doc {

// Rewrites, in every part of the document that came from a file of version 1.38 or older, what 1.39 says otherwise:
// swizzle nodes and `channels` attributes become extract, convert, separate and combine nodes; atan2's in1 and in2
// become iny and inx; normalmap loses its `space`; and the older spellings parameter, geomattrvalue, rotate, combine,
// separate, compare, invert and transform* of matrices. Sets the root's version to 1.39.
// What cannot be upgraded stays as it is, with a warning (cannot-upgrade).
void upgrade(Document& document, Diagnostics& diagnostics);

}  // namespace shaderx::doc
