#include "core/cell/boundary_faces.hpp"

#include <algorithm>
#include <tuple>

#include "core/base/assert.hpp"
#include "core/geometry/orbit_keys.hpp"

namespace symcell {
namespace {

// Face i lies opposite corner i; outward for a positively oriented element.
constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

class FaceFinder {
 public:
  explicit FaceFinder(const SymmetryCellMesh& cell) : cell_(cell), rotations_(cell.fold) {}

  std::vector<BoundaryFace> run() {
    collect();
    std::vector<BoundaryFace> result;
    std::vector<std::uint8_t> kind(halves_.size(), kInner);
    for (std::size_t begin = 0; begin < halves_.size();) {
      std::size_t end = begin + 1;
      while (end < halves_.size() && halves_[end].key == halves_[begin].key) ++end;
      classify(begin, end, kind);
      begin = end;
    }
    for (std::size_t h = 0; h < kind.size(); ++h) {
      if (kind[h] != kInner) result.push_back({corners(h), kind[h] == kOuter, h / 4, h % 4});
    }
    return result;
  }

 private:
  enum : std::uint8_t { kInner, kBound, kOuter };

  struct HalfFace {
    FaceKey key;                // equal for the copies of one face
    std::uint32_t half = 0;     // 4 * element + opposite corner
    std::int32_t exponent = 0;  // of the copy
  };

  [[nodiscard]] std::array<std::int32_t, 3> corners(std::size_t half) const {
    const auto k = static_cast<std::size_t>(cell_.nodes_per_element);
    const std::int32_t* element = &cell_.elements[half / 4 * k];
    const auto& face = kFaces[half % 4];
    return {element[face[0]], element[face[1]], element[face[2]]};
  }

  void collect() {
    halves_.resize(4 * cell_.element_count());
    for (std::size_t h = 0; h < halves_.size(); ++h) {
      std::array<OrbitVertex, 3> named{};
      std::array<bool, 3> axis{};
      const auto nodes = corners(h);
      for (std::size_t i = 0; i < 3; ++i) {
        const OrbitVertex v = cell_.nodes[static_cast<std::size_t>(nodes[i])];
        named[i] = {v.orbit, v.exponent};
        axis[i] = cell_.fold > 1 && cell_.on_axis[static_cast<std::size_t>(v.orbit)] != 0;
      }
      const KeyedFace face = make_face_key(rotations_, named, axis);
      halves_[h] = {face.key, static_cast<std::uint32_t>(h), face.reference};
    }
    std::ranges::sort(halves_, {}, [](const HalfFace& f) {
      return std::tuple(f.key.high, f.key.low, f.exponent, f.half);
    });
  }

  // Of all copies of one face: two elements have it, or one and the outside.
  void classify(std::size_t begin, std::size_t end, std::vector<std::uint8_t>& kind) const {
    if (end - begin == 1) {
      kind[halves_[begin].half] = own_image(halves_[begin].half) ? kBound : kOuter;
      return;
    }
    for (std::size_t i = begin; i < end; ++i) {
      const bool paired = (i > begin && halves_[i - 1].exponent == halves_[i].exponent) ||
                          (i + 1 < end && halves_[i + 1].exponent == halves_[i].exponent);
      if (!paired) kind[halves_[i].half] = kBound;
    }
  }

  // A half turn maps a face through the axis (o, v, Rv) onto itself: its element and the element's
  // own copy lie on the two sides.
  [[nodiscard]] bool own_image(std::uint32_t half) const {
    if (cell_.fold % 2 != 0) return false;
    const auto nodes = corners(half);
    for (std::size_t i = 0; i < 3; ++i) {
      const OrbitVertex o = cell_.nodes[static_cast<std::size_t>(nodes[i])];
      const OrbitVertex a = cell_.nodes[static_cast<std::size_t>(nodes[(i + 1) % 3])];
      const OrbitVertex b = cell_.nodes[static_cast<std::size_t>(nodes[(i + 2) % 3])];
      const bool turned =
          a.orbit == b.orbit && 2 * rotations_.subtract(a.exponent, b.exponent) == cell_.fold;
      if (turned && cell_.on_axis[static_cast<std::size_t>(o.orbit)] != 0) return true;
    }
    return false;
  }

  const SymmetryCellMesh& cell_;
  RotationTable rotations_;
  std::vector<HalfFace> halves_;
};

}  // namespace

std::vector<BoundaryFace> boundary_faces(const SymmetryCellMesh& cell) {
  SYMCELL_ASSERT(cell.dimension == 3);
  return FaceFinder(cell).run();
}

}  // namespace symcell
