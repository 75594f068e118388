#include "apps/cli/limits.h"

#include <charconv>
#include <limits>

namespace shaderx::cli {

namespace {

// Sets one if the name is its.
struct Setter {
    std::string_view name;
    std::uint64_t number;
    bool found = false, fits = true;

    template <class T>
    void at(std::string_view its, T& limit) {
        if (name != its) return;
        found = true;
        fits = number <= std::numeric_limits<T>::max();
        limit = static_cast<T>(number);
    }
};

}  // namespace

std::string Limits::set(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
        std::size_t equals = text.find('=');
        if (equals == std::string::npos) return "expected --limit NAME=NUMBER, found '" + text + "'";
        Setter s{std::string_view(text).substr(0, equals), 0};
        const char* end = text.data() + text.size();
        auto got = std::from_chars(text.data() + equals + 1, end, s.number);
        s.at("include-depth", read.maxIncludeDepth);
        s.at("elements", read.maxElements);
        s.at("nesting", read.maxNesting);
        s.at("attributes", read.maxAttributes);
        s.at("attribute-bytes", read.maxAttributeBytes);
        s.at("file-bytes", read.maxFileBytes);
        s.at("depth", depth);
        s.at("expressions", expressions);
        if (!s.found) return "there is no limit '" + std::string(s.name) + "'";
        if (got.ec != std::errc() || got.ptr != end || !s.fits) return "'" + text + "' sets no limit";
    }
    return {};
}

}  // namespace shaderx::cli
