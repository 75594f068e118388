#include "base/temporary_name.h"

#include <algorithm>
#include <atomic>

#include <fmt/format.h>
#include <unistd.h>

namespace shaderx {

std::string temporaryNameFor(const std::string& file) {
    constexpr std::size_t kLongest = 255;
    static std::atomic<unsigned> count{0};  // long names may be the same as far as they are kept
    const std::string end = fmt::format(".{}.{}.part", ::getpid(), count++);
    const std::size_t start = file.find_last_of('/') + 1;
    const std::size_t length = std::min(file.size() - start, kLongest - end.size());
    return file.substr(0, start + length) + end;
}

}  // namespace shaderx
