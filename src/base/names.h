// Interned names: equal text is one 32-bit handle, so comparing names compares numbers.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/handle.h"
#include "base/hash.h"

namespace shaderx {

using Name = Handle<struct NameTag>;

// The names of a precompiled library: read in place, never copied. Names 0 … count-1 of a table that starts from it.
struct NameImage {
    std::span<const std::uint32_t> ends;   // of each text in `bytes`; the first starts at 0
    std::span<const std::uint32_t> slots;  // open addressing by hashText, a power of two long; name + 1, or 0 for empty
    std::string_view bytes;
};

// The bytes at p as a number, the first one lowest: the same when compiling and when running.
template <class T>
constexpr T loadText(const char* p) {
    T word = 0;
    if (std::is_constant_evaluated() || std::endian::native != std::endian::little) {
        for (std::size_t i = sizeof(T); i-- > 0;) word = static_cast<T>(word << 8 | static_cast<unsigned char>(p[i]));
    } else {
        std::memcpy(&word, p, sizeof(T));
    }
    return word;
}

// A text of at most eight bytes as a number; with its size, it tells the text.
constexpr std::uint64_t shortText(std::string_view text) {
    const char* p = text.data();
    const std::size_t n = text.size();
    if (n >= 4)  // the halves overlap
        return loadText<std::uint32_t>(p) | std::uint64_t(loadText<std::uint32_t>(p + n - 4)) << 32;
    if (n == 0) return 0;
    auto byte = [p](std::size_t i) { return std::uint64_t(static_cast<unsigned char>(p[i])); };
    return byte(0) | byte(n / 2) << 8 | byte(n - 1) << 16;
}

// Hash of a text, eight bytes at a time; also that of NameImage's slots, so it is part of the library's file format.
constexpr std::uint32_t hashText(std::string_view text) {
    std::uint64_t h = text.size();
    for (; text.size() > 8; text.remove_prefix(8)) h = mixHash(h, loadText<std::uint64_t>(text.data()));
    h = mixHash(h, shortText(text));
    return static_cast<std::uint32_t>(h ^ h >> 17);
}

// Owns the text of every name. Not thread-safe: one table belongs to one compilation. The empty text is a name too.
class NameTable {
  public:
    NameTable() = default;
    // Starts from an image, which must outlive the table.
    explicit NameTable(const NameImage& image) : image_(image) {}
    NameTable(const NameTable&) = delete;
    NameTable& operator=(const NameTable&) = delete;

    Name intern(std::string_view text) {
        if (text.size() > 8) return internAny(text);
        const std::uint64_t word = shortText(text);
        const std::uint32_t end = static_cast<std::uint32_t>(text.size()) + 1;
        Recent& r = recent_[word * 0x9e3779b97f4a7c15u >> 54];
        if (r.word != word || r.end != end) r = {word, end, internAny(text).index};
        return Name(r.name);
    }
    // The name of a text if it was interned before, else none.
    Name find(std::string_view text) const;
    // Valid as long as the table. An absent name reads as the empty text.
    std::string_view text(Name name) const;
    std::uint32_t size() const { return imageSize() + static_cast<std::uint32_t>(texts_.size()); }

  private:
    // Documents say the same few words again and again: the last short text of a hash is found without a search.
    struct Recent {
        std::uint64_t word = 0;
        std::uint32_t end = 0, name = 0;  // its size + 1, or 0 for none
    };

    Name internAny(std::string_view text);
    std::uint32_t imageSize() const { return static_cast<std::uint32_t>(image_.ends.size()); }
    Name inImage(std::string_view text, std::uint32_t hash) const;
    std::uint32_t slotOf(std::string_view text, std::uint32_t hash) const;
    void grow();
    std::string_view store(std::string_view text);

    NameImage image_;
    std::array<Recent, 1024> recent_{};
    std::vector<std::string_view> texts_;
    std::vector<std::uint32_t> slots_;  // as in NameImage, for the names after the image's
    std::vector<std::unique_ptr<char[]>> chunks_;
    std::size_t chunkLeft_ = 0;
    char* chunkNext_ = nullptr;
};

}  // namespace shaderx
