// Canonical names of faces and edges between copies of vertices: equal for two faces (edges)
// exactly if a rotation maps one onto the other.
//
// A face is three corners (vertex, exponent). Its reference is its non-axis corner with the
// smallest vertex id; the others' exponents are relative to it. Where that id occurs twice the
// choice with the smaller name wins. Source: [paper] sec. 5.1 (symmetric faces), here as keys.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/orbit_vertex.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell {

struct FaceKey {
  std::uint64_t high = 0;
  std::uint64_t low = 0;
  friend bool operator==(const FaceKey&, const FaceKey&) = default;
};

struct KeyedFace {
  FaceKey key;
  std::int32_t reference = 0;  // exponent of the reference corner
};

struct EdgeKey {
  VertexId a = -1;
  VertexId b = -1;
  std::int32_t exponent = 0;  // of b relative to a
  friend bool operator==(const EdgeKey&, const EdgeKey&) = default;
};

// Requires: at least one corner off the axis.
[[nodiscard]] KeyedFace make_face_key(const RotationTable& rotations,
                                      std::array<OrbitVertex, 3> corners,
                                      std::array<bool, 3> on_axis);
[[nodiscard]] EdgeKey make_edge_key(
    const RotationTable& rotations, OrbitVertex a, OrbitVertex b, bool a_on_axis, bool b_on_axis);

// Edge key -> segment id. Open addressing, so that lookups of absent keys stay cheap.
class EdgeMap {
 public:
  void set(const EdgeKey& key, std::int32_t segment);
  void erase(const EdgeKey& key);
  [[nodiscard]] std::int32_t find(const EdgeKey& key) const;  // -1: not there
  [[nodiscard]] std::size_t size() const { return size_; }
  // In no particular order.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const Slot& s : slots_) {
      if (s.state == State::kUsed) visit(s.key, s.segment);
    }
  }
  void clear();

 private:
  enum class State : std::uint8_t { kEmpty, kUsed, kErased };
  struct Slot {
    EdgeKey key;
    std::int32_t segment = -1;
    State state = State::kEmpty;
  };
  [[nodiscard]] std::size_t place(const EdgeKey& key) const;
  void grow();

  std::vector<Slot> slots_;
  std::size_t size_ = 0;
  std::size_t erased_ = 0;
};

}  // namespace symcell
