// Classes of numbers from 0 on (Galler-Fischer 1964), with path halving.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace symcell {

// The smallest number of a class is its root, whatever the order in which they were joined.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::int32_t{0});
  }
  [[nodiscard]] std::int32_t root(std::int32_t i) {
    auto at = static_cast<std::size_t>(i);
    while (parent_[at] != static_cast<std::int32_t>(at)) {
      parent_[at] = parent_[static_cast<std::size_t>(parent_[at])];
      at = static_cast<std::size_t>(parent_[at]);
    }
    return static_cast<std::int32_t>(at);
  }
  void join(std::int32_t i, std::int32_t j) {
    const std::int32_t a = root(i), b = root(j);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }
  [[nodiscard]] std::size_t class_count() {
    std::size_t count = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      count += parent_[i] == static_cast<std::int32_t>(i) ? 1 : 0;
    }
    return count;
  }

 private:
  std::vector<std::int32_t> parent_;
};

}  // namespace symcell
