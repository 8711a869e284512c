#include "core/solid/delaunay/legalise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace symcell::solid {
namespace {

// A sphere contains a point only if it does so by this share; flips on less could go round for
// ever.
constexpr double kCertainShare = 1e-9;
// Flips a tetrahedron at most: each lowers the lifted surface, but rounding could make a cycle.
constexpr std::uint64_t kMaxFlipsATet = 5;
constexpr std::uint64_t kCheckEvery = 1024;  // faces: most need no flip

class Legaliser {
 public:
  Legaliser(Editor& editor, ExecutionContext& context)
      : editor_(editor), mesh_(editor.mesh()), context_(context) {}

  Result<std::uint64_t> run() {
    for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
      if (mesh_.alive(t)) push(t);
    }
    const std::uint64_t most = kMaxFlipsATet * (mesh_.tet_count() + 1);
    for (std::uint64_t step = 0; !todo_.empty() && flips_ < most; ++step) {
      if (step % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check(mesh_.tet_count()));
      }
      const Item item = todo_.back();
      todo_.pop_back();
      if (!mesh_.alive(item.t) || mesh_.tet(item.t).version != item.version) continue;
      for (std::uint32_t i = 0; i < 4; ++i) {
        if (!flip(item.t, i)) continue;
        ++flips_;
        editor_.count_flip();
        for (const TetId t : mesh_.added_ids()) push(t);
        break;
      }
    }
    return flips_;
  }

 private:
  struct Item {
    TetId t;
    std::uint32_t version;
  };
  void push(TetId t) { todo_.push_back({t, mesh_.tet(t).version}); }

  [[nodiscard]] static bool positive(Point3 a, Point3 b, Point3 c, Point3 d) {
    const TetMeasures m = measure_tet(a, b, c, d);
    return 6 * m.volume > kMinRelativeVolume * m.longest2 * std::sqrt(m.longest2);
  }
  [[nodiscard]] bool positive(const NewTet& t) const {
    return positive(mesh_.lift(t.c[0]), mesh_.lift(t.c[1]), mesh_.lift(t.c[2]), mesh_.lift(t.c[3]));
  }
  static NewTet make(
      std::int32_t region, OrbitVertex a, OrbitVertex b, OrbitVertex c, OrbitVertex d) {
    NewTet t;
    t.region = region;
    t.c[0] = a;
    t.c[1] = b;
    t.c[2] = c;
    t.c[3] = d;
    return t;
  }

  [[nodiscard]] bool flip(TetId t, std::uint32_t i) {
    const Tet& tet = mesh_.tet(t);
    if (!is_illegal(editor_, t, i)) return false;
    const TetCopy here{t, 0}, there = mesh_.neighbour(here, i);
    if (there.t == t) return false;
    const OrbitVertex d = mesh_.corner(here, i), e = mesh_.corner(there, face_of(tet.nb[i]));
    const std::array<OrbitVertex, 3> f = {mesh_.corner(here, kFaceCorners[i][0]),
                                          mesh_.corner(here, kFaceCorners[i][1]),
                                          mesh_.corner(here, kFaceCorners[i][2])};
    tets_.clear();
    int bad = 0;
    std::size_t reflex = 3;
    for (std::size_t j = 0; j < 3; ++j) {
      tets_.push_back(make(tet.region, d, f[j], f[(j + 1) % 3], e));
      if (positive(tets_.back())) continue;
      ++bad;
      reflex = j;
    }
    if (bad == 0) {
      const std::array<TetCopy, 2> removed = {here, there};
      return editor_.replace(removed, tets_);
    }
    return bad == 1 && flip_edge(here, f[reflex], f[(reflex + 1) % 3], d, e);
  }

  // Replaces edge (a, b) by (d, e) in a ring of three or four, or of two at a facet.
  [[nodiscard]] bool flip_edge(
      TetCopy from, OrbitVertex a, OrbitVertex b, OrbitVertex d, OrbitVertex e) {
    if (mesh_.segment_of(a, b) != kNoSegment ||
        (mesh_.on_axis(a.orbit) && mesh_.on_axis(b.orbit))) {
      return false;
    }
    ring_.clear();
    const bool closed = mesh_.ring(from, a, b, ring_);
    if (ring_.size() != 2 && ring_.size() != 3 && ring_.size() != 4) return false;
    if (closed != (ring_.size() > 2)) return false;
    const std::int32_t region = mesh_.tet(from.t).region;
    std::int32_t facet = kNoFacet;
    // The corners of the ring besides d and e.
    std::vector<OrbitVertex> others;
    for (const TetCopy& c : ring_) {
      if (mesh_.tet(c.t).region != region) return false;
      for (std::uint32_t k = 0; k < 4; ++k) {
        const OrbitVertex x = mesh_.corner(c, k);
        if (x == a || x == b) continue;
        if (mesh_.tet(c.t).facet[k] != kNoFacet) {
          if (closed) return false;
          facet = mesh_.tet(c.t).facet[k];
        }
        if (x != d && x != e && std::find(others.begin(), others.end(), x) == others.end()) {
          others.push_back(x);
        }
      }
    }
    if (others.size() != (ring_.size() == 4 ? 2u : 1u)) return false;
    tets_.clear();
    for (const OrbitVertex& o : others) {
      for (const OrbitVertex& end : {a, b}) {
        NewTet n = make(region, d, e, o, end);
        if (six_volumes(mesh_.lift(d), mesh_.lift(e), mesh_.lift(o), mesh_.lift(end)) < 0) {
          std::swap(n.c[0], n.c[1]);
        }
        if (!positive(n)) return false;
        n.facet[2] = facet;  // opposite the ring's corner: a, d, e or b, d, e
        tets_.push_back(n);
      }
    }
    // Both ends must lie on different sides of the new triangles, else the flip would fold.
    double before = 0, after = 0;
    for (const TetCopy& c : ring_) before += editor_.measures(c.t).volume;
    for (const NewTet& n : tets_) {
      after += six_volumes(mesh_.lift(n.c[0]), mesh_.lift(n.c[1]), mesh_.lift(n.c[2]),
                           mesh_.lift(n.c[3])) /
               6;
    }
    if (std::abs(after - before) > kSameVolume * before) return false;
    return editor_.replace(ring_, tets_);
  }

  // Of the volume before: above the rounding of lifted corners, while a flip that folds adds more.
  static constexpr double kSameVolume = 1e-6;

  Editor& editor_;
  QuotientTetrahedralization& mesh_;
  ExecutionContext& context_;
  std::vector<Item> todo_;
  std::vector<TetCopy> ring_;
  std::vector<NewTet> tets_;
  std::uint64_t flips_ = 0;
};

}  // namespace

bool is_illegal(const Editor& editor, TetId t, std::uint32_t i) {
  const QuotientTetrahedralization& mesh = editor.mesh();
  const Tet& tet = mesh.tet(t);
  if (tet.facet[i] != kNoFacet || tet.nb[i] == kNoHalfFace) return false;
  const TetMeasures& m = editor.measures(t);
  const OrbitVertex e = mesh.corner(mesh.neighbour({t, 0}, i), face_of(tet.nb[i]));
  return squared_distance(mesh.lift(e), m.centre) < m.radius2 * (1 - kCertainShare);
}

Result<std::uint64_t> legalise(Editor& editor, ExecutionContext& context) {
  return Legaliser(editor, context).run();
}

std::uint64_t count_illegal(const Editor& editor) {
  std::uint64_t count = 0;
  for (TetId t = 0; t < editor.mesh().tet_slots(); ++t) {
    if (!editor.mesh().alive(t)) continue;
    for (std::uint32_t i = 0; i < 4; ++i) count += is_illegal(editor, t, i) ? 1 : 0;
  }
  return count;
}

}  // namespace symcell::solid
