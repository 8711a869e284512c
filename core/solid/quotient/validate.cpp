#include "core/solid/quotient/validate.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/geometry/tolerances.hpp"
#include "core/solid/quotient/edge_turns.hpp"
#include "core/solid/quotient/lifted_predicates.hpp"

namespace symcell::solid {
namespace {

// Facets are planar up to the rounding of their vertices, so volumes agree up to that only.
constexpr double kVolumeSlack = 1e-7;

class Checker {
 public:
  explicit Checker(const QuotientTetrahedralization& mesh) : mesh_(mesh) {}

  Result<TetrahedraReport> run(ValidationLevel level, double expected_volume) {
    if (level == ValidationLevel::kElements) {
      SYMCELL_TRY(each_tet([&](TetId t) { return elements(t); }));
      return report_;
    }
    // In one go: most of the cost is to fetch the tetrahedra.
    seen_.resize(mesh_.vertex_slots());
    mesh_.edges().for_each([&](const EdgeKey& key, std::int32_t) {
      ++seen_[static_cast<std::size_t>(key.a)].segment_ends;
      ++seen_[static_cast<std::size_t>(key.b)].segment_ends;
    });
    SYMCELL_TRY(each_tet([&](TetId t) { return look_at(t); }));
    SYMCELL_TRY(subsegments());
    SYMCELL_TRY(vertices());
    if (level == ValidationLevel::kIncidence) return report_;
    SYMCELL_TRY(angles());
    SYMCELL_TRY(volume(expected_volume));
    if (level == ValidationLevel::kEmbedding) return report_;
    delaunay();
    return report_;
  }

 private:
  static Result<void> broken(const char* layer, TetId t, std::size_t i, const char* what) {
    return fail(ErrorCode::kInternal,
                std::string("mesh check '") + layer + "': tetrahedron " + std::to_string(t) +
                    ", corner, face or edge " + std::to_string(i) + ": " + what,
                {static_cast<std::int64_t>(t)});
  }
  static Result<void> broken_vertex(VertexId v, const char* what) {
    return fail(ErrorCode::kInternal,
                "mesh check 'incidence': vertex " + std::to_string(v) + ": " + what,
                {static_cast<std::int64_t>(v)});
  }

  template <class Check>
  [[nodiscard]] Result<void> each_tet(const Check& check) const {
    for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
      if (!mesh_.alive(t)) continue;
      SYMCELL_TRY(check(t));
    }
    return {};
  }

  Result<void> look_at(TetId t) {
    SYMCELL_TRY(elements(t));
    SYMCELL_TRY(incidence(t));
    see_subsegments(t);
    see_vertices(t);
    report_.volume += volume_of(t);
    return {};
  }

  [[nodiscard]] Result<void> elements(TetId t) const {
    const Tet& tet = mesh_.tet(t);
    for (std::uint32_t i = 0; i < 4; ++i) {
      const VertexId v = tet.v[i];
      if (v < 0 || static_cast<std::size_t>(v) >= mesh_.vertex_slots() ||
          mesh_.kind(v) == VertexKind::kDeleted) {
        return broken("elements", t, i, "corner is no vertex");
      }
      if (tet.k[i] < 0 || tet.k[i] >= mesh_.fold() || tet.off[i] < 0 ||
          tet.off[i] >= mesh_.fold()) {
        return broken("elements", t, i, "exponent out of range");
      }
      if (mesh_.on_axis(v)) {
        const Point3 p = mesh_.point(v);
        if (p.x != 0 || p.y != 0) return broken("elements", t, i, "axis vertex off the axis");
        if (tet.k[i] != 0) return broken("elements", t, i, "axis vertex with an exponent");
      }
      for (std::uint32_t j = 0; j < i; ++j) {
        if (v == tet.v[j] && tet.k[i] == tet.k[j]) {
          return broken("elements", t, i, "corners repeat");
        }
      }
    }
    if (orientation_3(mesh_, mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2),
                      mesh_.corner(t, 3)) != Sign::kPositive) {
      return broken("elements", t, 0, "not (certainly) positively oriented");
    }
    return {};
  }

  [[nodiscard]] Result<void> incidence(TetId t) const {
    const Tet& tet = mesh_.tet(t);
    for (std::uint32_t i = 0; i < 4; ++i) {
      const HalfFace g = tet.nb[i];
      if (g == kNoHalfFace) {
        if (tet.facet[i] == kNoFacet) return broken("incidence", t, i, "open face, no facet");
        continue;
      }
      if (tet_of(g) >= mesh_.tet_slots() || !mesh_.alive(tet_of(g))) {
        return broken("incidence", t, i, "neighbour is not alive");
      }
      const Tet& other = mesh_.tet(tet_of(g));
      const std::uint32_t j = face_of(g);
      if (other.nb[j] != 4 * t + i) return broken("incidence", t, i, "neighbour not mutual");
      if (g < 4 * t + i) continue;  // looked at from the other side
      if (mesh_.add(tet.off[i], other.off[j]) != 0) return broken("incidence", t, i, "exponents");
      if (tet.facet[i] != other.facet[j]) return broken("incidence", t, i, "facets differ");
      if (tet.facet[i] == kNoFacet && tet.region != other.region) {
        return broken("incidence", t, i, "regions differ without a facet between");
      }
      if (!faces_agree(t, i, g)) return broken("incidence", t, i, "corners differ across the face");
    }
    return {};
  }

  // The three corners are the same, turning the other way seen from the other side.
  [[nodiscard]] bool faces_agree(TetId t, std::uint32_t i, HalfFace g) const {
    const std::int32_t off = mesh_.tet(t).off[i];
    const auto& mine = kFaceCorners[i];
    const auto& theirs = kFaceCorners[face_of(g)];
    const OrbitVertex first = mesh_.corner(t, mine[0]);
    const auto seen = [&](std::uint32_t c) {
      return mesh_.shift(mesh_.corner(tet_of(g), theirs[c % 3]), off);
    };
    for (std::uint32_t turn = 0; turn < 3; ++turn) {
      if (seen(turn) != first) continue;
      return seen(turn + 2) == mesh_.corner(t, mine[1]) &&
             seen(turn + 1) == mesh_.corner(t, mine[2]);
    }
    return false;
  }

  void see_subsegments(TetId t) {
    // Most have no two corners that end subsegments.
    const Tet& tet = mesh_.tet(t);
    const auto ends = [&](VertexId v) {
      return seen_[static_cast<std::size_t>(v)].segment_ends > 0;
    };
    if (std::count_if(tet.v, tet.v + 4, ends) < 2) return;
    for (const auto& e : kEdgeCorners) {
      const OrbitVertex a = mesh_.corner(t, e[0]), b = mesh_.corner(t, e[1]);
      const std::int32_t segment = mesh_.segment_of(a, b);
      if (segment != kNoSegment) found_.set(mesh_.edge_key(a, b), segment);
    }
  }

  [[nodiscard]] Result<void> subsegments() const {
    if (found_.size() == mesh_.edges().size()) return {};
    return fail(ErrorCode::kInternal,
                "mesh check 'incidence': " + std::to_string(mesh_.edges().size() - found_.size()) +
                    " of " + std::to_string(mesh_.edges().size()) +
                    " subsegments are no edges of the mesh, or end at a vertex of no segment");
  }

  void see_vertices(TetId t) {
    const Tet& tet = mesh_.tet(t);
    for (std::uint32_t i = 0; i < 4; ++i) {
      seen_[static_cast<std::size_t>(tet.v[i])].used = true;
      if (tet.facet[i] == kNoFacet) continue;
      for (const std::uint32_t c : kFaceCorners[i]) {
        Seen& s = seen_[static_cast<std::size_t>(tet.v[c])];
        ++s.facets;
        s.other_facet = s.other_facet || tet.facet[i] != mesh_.parent(tet.v[c]);
      }
    }
  }

  [[nodiscard]] Result<void> vertices() const {
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const auto v = static_cast<VertexId>(i);
      if (!seen_[i].used) continue;
      const TetId at = mesh_.tet_at(v);
      if (at >= mesh_.tet_slots() || !mesh_.alive(at) ||
          std::find(mesh_.tet(at).v, mesh_.tet(at).v + 4, v) == mesh_.tet(at).v + 4) {
        return broken_vertex(v, "its tetrahedron does not have it as a corner");
      }
      const VertexKind kind = mesh_.kind(v);
      if (kind == VertexKind::kFree && (seen_[i].facets != 0 || seen_[i].segment_ends != 0)) {
        return broken_vertex(v, "free, but on a facet or segment");
      }
      if (kind == VertexKind::kFacet && (seen_[i].facets == 0 || seen_[i].other_facet)) {
        return broken_vertex(v, "on no face of its facet, or on one of another facet");
      }
      // A segment that the axis cuts in two equal halves has one end orbit there.
      if (kind == VertexKind::kSegment &&
          seen_[i].segment_ends < (mesh_.on_axis(v) && mesh_.fold() > 1 ? 1U : 2U)) {
        return broken_vertex(v, "inside a segment, but not between two subsegments");
      }
    }
    return {};
  }

  [[nodiscard]] Result<void> angles() const {
    const auto wrong = find_wrong_turn(mesh_);
    if (!wrong) return {};
    return broken("embedding", wrong->tet, wrong->edge, "dihedral angles do not make one turn");
  }

  [[nodiscard]] double volume_of(TetId t) const {
    const Point3 d = mesh_.corner_point(t, 3);
    const Point3 a = mesh_.corner_point(t, 0) - d, b = mesh_.corner_point(t, 1) - d;
    return -dot(cross(a, b), mesh_.corner_point(t, 2) - d) / 6;
  }

  [[nodiscard]] Result<void> volume(double expected) const {
    const double size = report_.volume;
    if (expected <= 0 || std::abs(size - expected) <= kVolumeSlack * expected) return {};
    return fail(ErrorCode::kInternal, "mesh check 'embedding': volume " + std::to_string(size) +
                                          " instead of " + std::to_string(expected));
  }

  void delaunay() {
    for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
      if (!mesh_.alive(t)) continue;
      const Tet& tet = mesh_.tet(t);
      for (std::uint32_t i = 0; i < 4; ++i) {
        const HalfFace g = tet.nb[i];
        if (g == kNoHalfFace || tet.facet[i] != kNoFacet || g < 4 * t + i) continue;
        ++report_.free_faces;
        const OrbitVertex apex = mesh_.shift(mesh_.corner(tet_of(g), face_of(g)), tet.off[i]);
        if (in_sphere(mesh_, mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2),
                      mesh_.corner(t, 3), apex, kTieSlack) == Sign::kPositive) {
          ++report_.certain_flips;
        }
      }
    }
  }

  struct Seen {  // of a vertex
    std::uint32_t segment_ends = 0;
    std::uint32_t facets = 0;
    bool other_facet = false;  // a facet that is not the vertex's parent
    bool used = false;
  };

  const QuotientTetrahedralization& mesh_;
  TetrahedraReport report_;
  EdgeMap found_;           // subsegments that are edges of tetrahedra
  std::vector<Seen> seen_;  // per vertex
};

}  // namespace

Result<TetrahedraReport> validate(const QuotientTetrahedralization& mesh,
                                  ValidationLevel level,
                                  double expected_volume) {
  return Checker(mesh).run(level, expected_volume);
}

}  // namespace symcell::solid
