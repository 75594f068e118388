// How far a long piece of work is, on standard error.
#pragma once

#include <chrono>
#include <cstddef>

namespace shaderx::cli {

// On a terminal one line with a percentage and an estimate of the time left, from half a second on, gone in the end.
// Elsewhere nothing, or, if `lines`, a line each tenth.
class Progress {
  public:
    explicit Progress(bool lines);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void at(std::size_t done, std::size_t all);

  private:
    using Clock = std::chrono::steady_clock;
    bool isTerminal_, lines_, isShown_ = false;
    std::size_t tenths_ = 0;
    Clock::time_point start_ = Clock::now(), next_ = start_ + std::chrono::milliseconds(500);
};

}  // namespace shaderx::cli
