// Interned names: equal text is one 32-bit handle, so comparing names compares numbers.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/handle.h"

namespace shaderx {

using Name = Handle<struct NameTag>;

// The names of a precompiled library: read in place, never copied. Names 0 … count-1 of a table that starts from it.
struct NameImage {
    std::span<const std::uint32_t> ends;   // of each text in `bytes`; the first starts at 0
    std::span<const std::uint32_t> slots;  // open addressing by hashText, a power of two long; name + 1, or 0 for empty
    std::string_view bytes;
};

// Hash of a text; also that of NameImage's slots, so it is part of the library's file format. FNV-1a, with a final mix
// so that the low bits, which pick the slot, depend on every byte.
constexpr std::uint32_t hashText(std::string_view text) {
    std::uint32_t h = 2166136261u;
    for (char c : text) h = (h ^ static_cast<unsigned char>(c)) * 16777619u;
    return h ^ (h >> 15);
}

// Owns the text of every name. Not thread-safe: one table belongs to one compilation. The empty text is a name too.
class NameTable {
  public:
    NameTable() = default;
    // Starts from an image, which must outlive the table.
    explicit NameTable(const NameImage& image) : image_(image) {}
    NameTable(const NameTable&) = delete;
    NameTable& operator=(const NameTable&) = delete;

    Name intern(std::string_view text);
    // The name of a text if it was interned before, else none.
    Name find(std::string_view text) const;
    // Valid as long as the table. An absent name reads as the empty text.
    std::string_view text(Name name) const;
    std::uint32_t size() const { return imageSize() + static_cast<std::uint32_t>(texts_.size()); }

  private:
    std::uint32_t imageSize() const { return static_cast<std::uint32_t>(image_.ends.size()); }
    Name inImage(std::string_view text, std::uint32_t hash) const;
    std::uint32_t slotOf(std::string_view text, std::uint32_t hash) const;
    void grow();
    std::string_view store(std::string_view text);

    NameImage image_;
    std::vector<std::string_view> texts_;
    std::vector<std::uint32_t> slots_;  // as in NameImage, for the names after the image's
    std::vector<std::unique_ptr<char[]>> chunks_;
    std::size_t chunkLeft_ = 0;
    char* chunkNext_ = nullptr;
};

}  // namespace shaderx
