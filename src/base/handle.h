// Typed 32-bit indices into arenas.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace shaderx {

// An index that only fits the arena it was made for. A default-made handle refers to nothing and is false.
template <class Tag>
struct Handle {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::uint32_t index = kNone;

    constexpr Handle() = default;
    constexpr explicit Handle(std::uint32_t i) : index(i) {}
    constexpr explicit operator bool() const { return index != kNone; }
    friend constexpr bool operator==(Handle, Handle) = default;
    friend constexpr auto operator<=>(Handle, Handle) = default;
};

}  // namespace shaderx

template <class Tag>
struct std::hash<shaderx::Handle<Tag>> {
    std::size_t operator()(shaderx::Handle<Tag> h) const noexcept { return h.index * 0x9e3779b97f4a7c15ull >> 20; }
};
