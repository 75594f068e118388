// Work shared by threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace shaderx::oracle {

// As many threads as asked for, at most one for each piece of work; below 1, as many as the machine has cores.
inline std::size_t threadCount(int wanted, std::size_t pieces) {
    const std::size_t cores = std::max(std::thread::hardware_concurrency(), 1u);
    return std::clamp<std::size_t>(wanted > 0 ? static_cast<std::size_t>(wanted) : cores, 1,
                                   std::max<std::size_t>(pieces, 1));
}

// Runs work(0) … work(count - 1) at once, the first by the caller's own thread, and waits for all of them. Where the
// system gives fewer threads, only the first ones run: each is to take what is left to do until there is nothing. An
// exception of one, say for want of memory, goes on to the caller.
template <class Work>
void runThreads(std::size_t count, Work&& work) {
    std::vector<std::exception_ptr> thrown(count);
    const auto guarded = [&](std::size_t i) {
        try {
            work(i);
        } catch (...) {
            thrown[i] = std::current_exception();
        }
    };
    std::vector<std::thread> threads;
    threads.reserve(count);
    try {
        for (std::size_t i = 1; i < count; i++) threads.emplace_back(guarded, i);
    } catch (const std::system_error&) {
    }
    guarded(0);
    for (std::thread& t : threads) t.join();
    for (const std::exception_ptr& e : thrown)
        if (e) std::rethrow_exception(e);
}

}  // namespace shaderx::oracle
