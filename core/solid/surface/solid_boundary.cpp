#include "core/solid/surface/solid_boundary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/winding.hpp"
#include "core/model/describe.hpp"
#include "core/solid/surface/arrangement.hpp"
#include "core/solid/surface/weld.hpp"

namespace symcell::solid {
namespace {

constexpr std::int32_t kUnknown = INT32_MIN;
constexpr std::size_t kCheckEvery = 1024;  // triangles or pieces
// Pieces of a component tried for a first winding number, the largest first, and how far from whole
// it may be: noise is far below, the edge of another triangle far above.
constexpr std::size_t kMostSeeds = 20;
constexpr double kWholeWithin = 0.05;

// Winding numbers before a piece, where its triangles' outside is, and behind it.
struct Sides {
  std::int32_t front = kUnknown, back = kUnknown;
};

class Winder {
 public:
  Winder(const IndexedSurface& surface, const Arrangement& cut, ExecutionContext& context)
      : surface_(surface), cut_(cut), context_(context), sides_(cut.pieces.size()) {}

  Result<std::vector<Sides>> run() {
    link();
    std::vector<std::int32_t> by_area(cut_.pieces.size());
    std::iota(by_area.begin(), by_area.end(), 0);
    std::vector<double> areas;
    areas.reserve(cut_.pieces.size());
    for (const Piece& p : cut_.pieces) {
      areas.push_back(length(area_normal(cut_.points[p.corners[0]], cut_.points[p.corners[1]],
                                         cut_.points[p.corners[2]])));
    }
    std::stable_sort(by_area.begin(), by_area.end(),
                     [&](std::int32_t a, std::int32_t b) { return areas[a] > areas[b]; });
    std::vector<std::int32_t> component(cut_.pieces.size(), -1);
    std::int32_t components = 0;
    std::vector<std::size_t> tried;
    for (const std::int32_t p : by_area) {
      if (sides_[p].front != kUnknown) continue;
      if (component[p] < 0) {
        mark(p, components++, component);
        tried.push_back(0);
      }
      std::size_t& times = tried[component[p]];
      if (++times > kMostSeeds) {
        return fail(ErrorCode::kSelfIntersection,
                    "what is inside could not be found near " +
                        describe_point(cut_.points[cut_.pieces[p].corners[0]]));
      }
      auto seeded = seed(p);
      if (!seeded) return error_of(seeded);
      if (!*seeded) continue;
      SYMCELL_TRY(spread(p));
    }
    return std::move(sides_);
  }

 private:
  // Per piece: the rings it is in.
  void link() {
    rings_of_.assign(cut_.pieces.size(), {-1, -1, -1});
    for (std::size_t r = 0; r + 1 < cut_.ring_begin.size(); ++r) {
      for (std::size_t i = cut_.ring_begin[r]; i < cut_.ring_begin[r + 1]; ++i) {
        auto& rings = rings_of_[cut_.rings[i].piece];
        *std::find(rings.begin(), rings.end(), -1) = static_cast<std::int32_t>(r);
      }
    }
  }

  [[nodiscard]] std::span<const PieceAtEdge> ring(std::int32_t r) const {
    return std::span(cut_.rings)
        .subspan(cut_.ring_begin[r], cut_.ring_begin[r + 1] - cut_.ring_begin[r]);
  }

  void mark(std::int32_t first, std::int32_t number, std::vector<std::int32_t>& component) const {
    std::vector<std::int32_t> stack{first};
    component[first] = number;
    while (!stack.empty()) {
      const std::int32_t p = stack.back();
      stack.pop_back();
      for (const std::int32_t r : rings_of_[p]) {
        for (const PieceAtEdge& at : ring(r)) {
          if (component[at.piece] >= 0) continue;
          component[at.piece] = number;
          stack.push_back(at.piece);
        }
      }
    }
  }

  // From the solid angles of the whole surface, without what lies in the piece's own plane.
  Result<bool> seed(std::int32_t p) {
    const Piece& piece = cut_.pieces[p];
    const Point3 at = (1.0 / 3) * (cut_.points[piece.corners[0]] + cut_.points[piece.corners[1]] +
                                   cut_.points[piece.corners[2]]);
    double sum = 0;
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      if (t % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      if (cut_.plane[t] == cut_.plane[piece.triangle]) continue;
      sum += solid_angle(surface_, static_cast<std::int32_t>(t), at);
    }
    // In the plane itself it is the mean of both sides.
    const double front = sum / (4 * std::numbers::pi) - 0.5 * piece.multiplicity;
    if (!(std::abs(front - std::round(front)) < kWholeWithin)) return false;
    sides_[p].front = static_cast<std::int32_t>(std::lround(front));
    sides_[p].back = sides_[p].front + piece.multiplicity;
    return true;
  }

  // Across edges: turning round an edge, the front of a piece and the back of the next see the same.
  Result<void> spread(std::int32_t first) {
    std::vector<std::int32_t> stack{first};
    std::size_t steps = 0;
    while (!stack.empty()) {
      if (++steps % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      const std::int32_t p = stack.back();
      stack.pop_back();
      for (const std::int32_t r : rings_of_[p]) {
        const auto pieces = ring(r);
        std::size_t start = 0;
        while (pieces[start].piece != p) ++start;
        std::int32_t winding = after(pieces[start]);
        for (std::size_t k = 1; k <= pieces.size(); ++k) {
          const PieceAtEdge& at = pieces[(start + k) % pieces.size()];
          const std::int32_t beyond = winding - at.multiplicity;
          const bool runs = at.multiplicity > 0;
          const Sides sides = runs ? Sides{beyond, winding} : Sides{winding, beyond};
          Sides& known = sides_[at.piece];
          if (known.front == kUnknown) {
            known = sides;
            stack.push_back(at.piece);
          } else if (known.front != sides.front || known.back != sides.back) {
            return fail(ErrorCode::kSelfIntersection,
                        "what is inside is contradictory near " +
                            describe_point(cut_.points[cut_.pieces[at.piece].corners[0]]));
          }
          winding = beyond;
        }
      }
    }
    return {};
  }

  // The winding number beyond the piece, turning round the edge.
  [[nodiscard]] std::int32_t after(const PieceAtEdge& at) const {
    return at.multiplicity > 0 ? sides_[at.piece].front : sides_[at.piece].back;
  }

  const IndexedSurface& surface_;
  const Arrangement& cut_;
  ExecutionContext& context_;
  std::vector<Sides> sides_;
  std::vector<std::array<std::int32_t, 3>> rings_of_;
};

// What bounds the points for which `inside` holds of their winding number, outwards.
template <class Inside>
IndexedSurface boundary_of(const Arrangement& cut,
                           const std::vector<Sides>& sides,
                           const Inside& inside) {
  IndexedSurface result;
  result.points = cut.points;
  for (std::size_t p = 0; p < cut.pieces.size(); ++p) {
    const bool front = inside(sides[p].front), back = inside(sides[p].back);
    if (front == back) continue;
    Triangle t = cut.pieces[p].corners;
    if (front) std::swap(t[1], t[2]);
    result.triangles.push_back(t);
    result.source.push_back(cut.pieces[p].source);
  }
  drop_unused_points(result);
  return result;
}

}  // namespace

Result<SolidBoundary> solid_boundary(const IndexedSurface& surface,
                                     std::span<const std::pair<std::int32_t, std::int32_t>> pairs,
                                     ExecutionContext& context) {
  const auto cut = arrange(surface, pairs, context);
  if (!cut) return error_of(cut);
  const auto sides = Winder(surface, *cut, context).run();
  if (!sides) return error_of(sides);
  const auto bounded = [&](const auto& inside) { return boundary_of(*cut, *sides, inside); };
  const auto volume = [](const IndexedSurface& s) {
    return s.triangles.empty() ? 0 : enclosed_volume(s, s.points.front());
  };
  SolidBoundary result;
  result.cancelled_area = cut->cancelled_area;
  IndexedSurface solid = bounded([](std::int32_t w) { return w >= 1; });
  result.volume = volume(solid);
  result.surface = weld_exactly(solid);
  result.inverted = bounded([](std::int32_t w) { return w <= -1; });
  result.inverted_volume = volume(result.inverted);
  result.overlap_volume = volume(bounded([](std::int32_t w) { return w >= 2; }));
  return result;
}

}  // namespace symcell::solid
