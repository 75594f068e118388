// Says what is wrong with XML that does not parse. (Part of reading; not for other rooms.)
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace shaderx::doc {

struct XmlProblem {
    std::size_t offset = 0;
    std::string message;
    std::optional<std::size_t> opened;  // offset of the tag that is still open, where that matters
    std::string openedName;
};

// The first mistake in the markup, none if this finds none. Only run once parsing has failed.
std::optional<XmlProblem> findXmlProblem(std::string_view text);

// The offset of the first byte that is no UTF-8 text (a NUL included), none if there is none.
std::optional<std::size_t> findBadByte(std::string_view text);

// The offset of the first character reference, as in "&#0;", to what XML does not take as a character; those in
// comments and CDATA sections are text.
std::optional<std::size_t> findBadReference(std::string_view text);

}  // namespace shaderx::doc
