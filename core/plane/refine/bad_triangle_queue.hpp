// Bad triangles, shortest edge first: FIFO buckets, four per octave of the squared shortest edge.
//
// Entries are checked when taken, not when triangles change: a slot whose content no longer matches
// its entry's key is dropped. Triangle::queued keeps one live entry a triangle.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/plane/quotient/quotient_triangulation.hpp"

namespace symcell::plane {

class BadTriangleQueue {
 public:
  void push(QuotientTriangulation& mesh, TriangleId t, double shortest2) {
    const auto key = static_cast<float>(shortest2);
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(key);
    Triangle& tri = mesh.triangle(t);
    if (tri.queued == bits) return;
    tri.queued = bits;
    const std::size_t bucket = bits >> kDroppedBits;
    buckets_[bucket].items.push_back({t, bits});
    occupied_[bucket / 64] |= std::uint64_t{1} << (bucket % 64);
    ++size_;
  }

  // The next triangle whose slot still holds what was pushed.
  [[nodiscard]] std::optional<TriangleId> pop(QuotientTriangulation& mesh) {
    for (std::size_t word = 0; word < occupied_.size(); ++word) {
      while (occupied_[word] != 0) {
        const auto bit = static_cast<std::size_t>(std::countr_zero(occupied_[word]));
        Bucket& bucket = buckets_[word * 64 + bit];
        while (bucket.head < bucket.items.size()) {
          const Item item = bucket.items[bucket.head++];
          --size_;
          if (item.t >= mesh.triangle_slots()) continue;
          Triangle& tri = mesh.triangle(item.t);
          if (tri.face < 0 || tri.queued != item.bits) continue;
          tri.queued = 0;
          return item.t;
        }
        bucket.items.clear();
        bucket.head = 0;
        occupied_[word] &= ~(std::uint64_t{1} << bit);
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  struct Item {
    TriangleId t;
    std::uint32_t bits;
  };
  struct Bucket {
    std::vector<Item> items;
    std::size_t head = 0;
  };
  // Sign, exponent and two bits of the mantissa of a float remain: four buckets an octave.
  static constexpr std::uint32_t kDroppedBits = 21;
  static constexpr std::size_t kBuckets = std::size_t{1} << (31 - kDroppedBits);

  std::array<Bucket, kBuckets> buckets_;
  std::array<std::uint64_t, kBuckets / 64> occupied_{};
  std::size_t size_ = 0;
};

}  // namespace symcell::plane
