#include "apps/cli/progress.h"

#include <cstdio>

#include <unistd.h>

namespace shaderx::cli {

Progress::Progress(bool lines) : isTerminal_(isatty(2) != 0), lines_(lines && !isTerminal_) {}

Progress::~Progress() {
    if (isShown_) std::fputs("\r\033[K", stderr);
}

void Progress::at(std::size_t done, std::size_t all) {
    if (all == 0) return;
    if (lines_ && done * 10 / all > tenths_) {
        tenths_ = done * 10 / all;
        std::fprintf(stderr, "drawing: %zu %%\n", tenths_ * 10);
    }
    const Clock::time_point now = Clock::now();
    if (!isTerminal_ || now < next_ || done == 0) return;
    next_ = now + std::chrono::milliseconds(100);
    isShown_ = true;
    const double spent = std::chrono::duration<double>(now - start_).count();
    const double left = spent * static_cast<double>(all - done) / static_cast<double>(done);
    std::fprintf(stderr, "\rdrawing: %zu %%, about %.0f s left\033[K", done * 100 / all, left);
    std::fflush(stderr);
}

}  // namespace shaderx::cli
