#include "base/names.h"

#include <algorithm>
#include <cstring>

namespace shaderx {

std::uint32_t hashText(std::string_view text) {
    // FNV-1a, with a final mix so that the low bits, which pick the slot, depend on every byte.
    std::uint32_t h = 2166136261u;
    for (unsigned char c : text) h = (h ^ c) * 16777619u;
    return h ^ (h >> 15);
}

static std::string_view imageText(const NameImage& image, std::uint32_t i) {
    std::uint32_t begin = i ? image.ends[i - 1] : 0;
    return image.bytes.substr(begin, image.ends[i] - begin);
}

Name NameTable::find(std::string_view text) const {
    if (!image_.slots.empty()) {
        std::uint32_t mask = static_cast<std::uint32_t>(image_.slots.size()) - 1;
        for (std::uint32_t i = hashText(text) & mask; image_.slots[i]; i = (i + 1) & mask)
            if (imageText(image_, image_.slots[i] - 1) == text) return Name(image_.slots[i] - 1);
    }
    if (slots_.empty()) return {};
    std::uint32_t found = slots_[slotOf(text)];
    return found ? Name(imageSize() + found - 1) : Name();
}

std::uint32_t NameTable::slotOf(std::string_view text) const {
    std::uint32_t mask = static_cast<std::uint32_t>(slots_.size()) - 1, i = hashText(text) & mask;
    while (slots_[i] && texts_[slots_[i] - 1] != text) i = (i + 1) & mask;
    return i;
}

Name NameTable::intern(std::string_view text) {
    if (Name known = find(text)) return known;
    if (texts_.size() * 2 >= slots_.size()) grow();
    texts_.push_back(store(text));
    slots_[slotOf(text)] = static_cast<std::uint32_t>(texts_.size());
    return Name(size() - 1);
}

void NameTable::grow() {
    slots_.assign(slots_.empty() ? 256 : slots_.size() * 2, 0);
    for (std::size_t i = 0; i < texts_.size(); i++) slots_[slotOf(texts_[i])] = static_cast<std::uint32_t>(i + 1);
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
