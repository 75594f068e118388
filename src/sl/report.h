// Located errors of one source text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/diagnostics.h"

namespace shaderx::sl {

// Adds diagnostics at byte offsets of one text. After a hundred errors further ones are counted but no longer told:
// what follows so many is noise, and a text of random bytes must not fill the memory.
class Reporter {
  public:
    Reporter(Diagnostics& diagnostics, std::string_view file, std::string_view text)
        : diagnostics_(diagnostics), file_(file), text_(text) {}

    // The reference serves to add notes and a hint at once; it lasts until the next report.
    Diagnostic& error(std::uint32_t offset, std::string_view code, std::string message);
    Diagnostic& warning(std::uint32_t offset, std::string_view code, std::string message);
    // An error that follows from one told already.
    void silent() { errors_++; }
    Location at(std::uint32_t offset) const { return locate(file_, text_, offset); }
    std::size_t errors() const { return errors_; }

  private:
    Diagnostics& diagnostics_;
    std::string_view file_, text_;
    std::size_t errors_ = 0, warnings_ = 0;
    Diagnostic dropped_;
};

// A word of the source in quotes for a message: cut where it is long, bytes that are not printable replaced.
std::string quoted(std::string_view word);

}  // namespace shaderx::sl
