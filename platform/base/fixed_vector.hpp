// FixedVector: a vector of at most N elements, stored within; never allocates. Adding to a full
// one is refused. Elements are default-constructed beforehand. A value; RT safe.
#pragma once

#include <array>
#include <cassert>
#include <span>
#include <utility>

namespace gannet {

template <class T, int N>
class FixedVector {
 public:
  // False: full, nothing added.
  bool push_back(T value) {
    if (size_ == N) return false;
    items_[static_cast<std::size_t>(size_++)] = std::move(value);
    return true;
  }
  void clear() { size_ = 0; }
  // Keeps the first n; n <= size().
  void truncate(int n) {
    assert(n >= 0 && n <= size_);
    size_ = n;
  }

  int size() const { return size_; }
  bool empty() const { return size_ == 0; }
  bool full() const { return size_ == N; }
  static constexpr int capacity() { return N; }

  T& operator[](int i) {
    assert(i >= 0 && i < size_);
    return items_[static_cast<std::size_t>(i)];
  }
  const T& operator[](int i) const {
    assert(i >= 0 && i < size_);
    return items_[static_cast<std::size_t>(i)];
  }
  T* begin() { return items_.data(); }
  T* end() { return items_.data() + size_; }
  const T* begin() const { return items_.data(); }
  const T* end() const { return items_.data() + size_; }
  std::span<const T> span() const { return {items_.data(), static_cast<std::size_t>(size_)}; }

 private:
  std::array<T, static_cast<std::size_t>(N)> items_ = {};
  int size_ = 0;
};

}  // namespace gannet
