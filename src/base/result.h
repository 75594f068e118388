// A value, or nothing because something went wrong that the diagnostics tell.
#pragma once

#include <optional>
#include <utility>

namespace shaderx {

// What a function returns after it has reported why it failed.
struct Failure {};

template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : value_(std::move(value)) {}
    Result(Failure) {}
    explicit operator bool() const { return value_.has_value(); }
    T& operator*() { return *value_; }
    const T& operator*() const { return *value_; }
    T* operator->() { return &*value_; }
    const T* operator->() const { return &*value_; }

  private:
    std::optional<T> value_;
};

}  // namespace shaderx
