#include "base/names.h"

#include <algorithm>

namespace shaderx {

static inline std::string_view imageText(const NameImage& image, std::uint32_t i) {
    std::uint32_t begin = i ? image.ends[i - 1] : 0;
    return image.bytes.substr(begin, image.ends[i] - begin);
}

// Most names are short: compared in words, without a call.
static inline bool isSame(std::string_view a, std::string_view b) {
    const std::size_t n = a.size();
    if (b.size() != n) return false;
    auto same = [&]<class T>(T, std::size_t at) { return loadText<T>(a.data() + at) == loadText<T>(b.data() + at); };
    if (n > 16) return std::memcmp(a.data(), b.data(), n) == 0;
    if (n >= 8) return same(std::uint64_t(), 0) && same(std::uint64_t(), n - 8);
    if (n >= 4) return same(std::uint32_t(), 0) && same(std::uint32_t(), n - 4);
    return n == 0 || (a[0] == b[0] && a[n / 2] == b[n / 2] && a[n - 1] == b[n - 1]);
}

inline Name NameTable::inImage(std::string_view text, std::uint32_t hash) const {
    if (image_.slots.empty()) return {};
    const std::uint32_t mask = static_cast<std::uint32_t>(image_.slots.size()) - 1;
    for (std::uint32_t i = hash & mask; image_.slots[i]; i = (i + 1) & mask)
        if (isSame(imageText(image_, image_.slots[i] - 1), text)) return Name(image_.slots[i] - 1);
    return {};
}

inline std::uint32_t NameTable::slotOf(std::string_view text, std::uint32_t hash) const {
    std::uint32_t mask = static_cast<std::uint32_t>(slots_.size()) - 1, i = hash & mask;
    while (slots_[i] && !isSame(texts_[slots_[i] - 1], text)) i = (i + 1) & mask;
    return i;
}

Name NameTable::find(std::string_view text) const {
    const std::uint32_t hash = hashText(text);
    if (Name known = inImage(text, hash)) return known;
    if (slots_.empty()) return {};
    std::uint32_t found = slots_[slotOf(text, hash)];
    return found ? Name(imageSize() + found - 1) : Name();
}

Name NameTable::internAny(std::string_view text) {
    const std::uint32_t hash = hashText(text);
    if (Name known = inImage(text, hash)) return known;
    if (texts_.size() * 2 >= slots_.size()) grow();
    std::uint32_t& slot = slots_[slotOf(text, hash)];
    if (!slot) {
        texts_.push_back(store(text));
        slot = static_cast<std::uint32_t>(texts_.size());
    }
    return Name(imageSize() + slot - 1);
}

void NameTable::grow() {
    slots_.assign(slots_.empty() ? 256 : slots_.size() * 2, 0);
    const std::uint32_t mask = static_cast<std::uint32_t>(slots_.size()) - 1;
    for (std::size_t k = 0; k < texts_.size(); k++) {
        std::uint32_t i = hashText(texts_[k]) & mask;
        while (slots_[i]) i = (i + 1) & mask;
        slots_[i] = static_cast<std::uint32_t>(k + 1);
    }
}

std::string_view NameTable::store(std::string_view text) {
    if (text.size() > chunkLeft_) {
        chunkLeft_ = std::max<std::size_t>(4096, text.size());
        chunks_.push_back(std::make_unique<char[]>(chunkLeft_));
        chunkNext_ = chunks_.back().get();
    }
    if (!text.empty()) std::memcpy(chunkNext_, text.data(), text.size());
    std::string_view stored(chunkNext_, text.size());
    chunkNext_ += text.size();
    chunkLeft_ -= text.size();
    return stored;
}

std::string_view NameTable::text(Name name) const {
    if (!name) return {};
    if (name.index < imageSize()) return imageText(image_, name.index);
    return texts_[name.index - imageSize()];
}

}  // namespace shaderx
