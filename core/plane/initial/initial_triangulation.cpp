#include "core/plane/initial/initial_triangulation.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <tuple>

#include "core/plane/delaunay/insert.hpp"
#include "core/plane/initial/full_cdt.hpp"

namespace symcell::plane {
namespace initial {
namespace {

using FaceHandle = Cdt::Face_handle;

// Orbit of a directed edge: orbits of its ends and the exponent of the end relative to the start
// (0 where one of them is the centre).
struct EdgeKey {
  std::int32_t a = 0;
  std::int32_t b = 0;
  std::int32_t turn = 0;
  friend auto operator<=>(const EdgeKey&, const EdgeKey&) = default;
};

struct DirectedEdge {
  EdgeKey key;
  std::int32_t ka = 0;
  std::int32_t kb = 0;
};

class QuotientBuilder {
 public:
  QuotientBuilder(const SymmetricPslg& pslg, FullCdt& full)
      : pslg_(pslg), full_(full), rotations_(pslg.fold) {}

  Result<InitialTriangulation> build() {
    drop_incomplete_edges();
    if (merged_count_ == 0) {
      return fail(ErrorCode::kDegenerateGeometry,
                  "no area is left to mesh: the segments enclose nothing outside the holes");
    }
    SYMCELL_TRY(choose_representatives());
    InitialTriangulation result{
        QuotientTriangulation(pslg_.fold, pslg_.fold > 1 ? full_.centre_orbit : -1), {}, nullptr};
    emit_vertices(result.mesh);
    emit_triangles(result.mesh);
    SYMCELL_TRY(link_triangles(result.mesh));
    result.subdomains = subdomain_orbits_;
    if (full_.centre_orbit >= 0 && result.mesh.corner_of(full_.centre_orbit) == kNoHalfEdge) {
      result.mesh.set_centre(-1);
    }
    return result;
  }

 private:
  [[nodiscard]] bool inside(FaceHandle f) const {
    return !full_.cdt.is_infinite(f) &&
           full_.subdomains[static_cast<std::size_t>(f->info().subdomain)].inside;
  }
  [[nodiscard]] bool is_centre(std::int32_t orbit) const {
    return pslg_.fold > 1 && orbit == full_.centre_orbit;
  }

  // Edge i of a face, counter-clockwise.
  [[nodiscard]] DirectedEdge edge(FaceHandle f, int i) const {
    const OrbitVertex a = f->vertex(Cdt::ccw(i))->info(), b = f->vertex(Cdt::cw(i))->info();
    return make_edge(a, b);
  }
  [[nodiscard]] DirectedEdge make_edge(OrbitVertex a, OrbitVertex b) const {
    const bool centred = is_centre(a.orbit) || is_centre(b.orbit);
    return {{a.orbit, b.orbit, centred ? 0 : rotations_.subtract(b.exponent, a.exponent)},
            a.exponent,
            b.exponent};
  }
  [[nodiscard]] EdgeKey reversed(EdgeKey k) const {
    return {k.b, k.a, rotations_.subtract(0, k.turn)};
  }
  [[nodiscard]] EdgeKey undirected(EdgeKey k) const { return std::min(k, reversed(k)); }

  // Numbers the merged faces of the domain: triangles joined across edges that lack copies.
  void drop_incomplete_edges() {
    std::vector<EdgeKey> keys;
    const auto is_plain = [&](FaceHandle f, int i) {
      return !f->is_constrained(i) && inside(f) && inside(f->neighbor(i));
    };
    if (pslg_.fold > 1) {
      for (auto e = full_.cdt.finite_edges_begin(); e != full_.cdt.finite_edges_end(); ++e) {
        if (is_plain(e->first, e->second))
          keys.push_back(undirected(edge(e->first, e->second).key));
      }
      std::sort(keys.begin(), keys.end());
    }
    std::vector<EdgeKey> incomplete;
    for (std::size_t i = 0; i < keys.size();) {
      std::size_t j = i;
      while (j < keys.size() && keys[j] == keys[i]) ++j;
      if (j - i != static_cast<std::size_t>(pslg_.fold)) incomplete.push_back(keys[i]);
      i = j;
    }
    const auto dropped = [&](FaceHandle f, int i) {
      return !incomplete.empty() && is_plain(f, i) &&
             std::binary_search(incomplete.begin(), incomplete.end(), undirected(edge(f, i).key));
    };
    std::vector<FaceHandle> stack;
    for (auto f = full_.cdt.finite_faces_begin(); f != full_.cdt.finite_faces_end(); ++f) {
      if (!inside(f) || f->info().merged >= 0) continue;
      f->info().merged = merged_count_;
      stack.push_back(f);
      while (!stack.empty()) {
        const FaceHandle face = stack.back();
        stack.pop_back();
        for (int i = 0; i < 3; ++i) {
          const FaceHandle other = face->neighbor(i);
          if (!dropped(face, i) || other->info().merged >= 0) continue;
          other->info().merged = merged_count_;
          stack.push_back(other);
        }
      }
      ++merged_count_;
    }
  }

  // Groups merged faces into orbits by their smallest boundary edge orbit and takes, of each, the
  // copy at which that edge starts with exponent 0.
  Result<void> choose_representatives() {
    struct Mark {
      EdgeKey key;
      std::int32_t gauge;
      std::int32_t subdomain;
      bool set;
    };
    std::vector<Mark> marks(static_cast<std::size_t>(merged_count_), {{}, 0, -1, false});
    for (auto f = full_.cdt.finite_faces_begin(); f != full_.cdt.finite_faces_end(); ++f) {
      if (f->info().merged < 0) continue;
      Mark& mark = marks[static_cast<std::size_t>(f->info().merged)];
      mark.subdomain = f->info().subdomain;
      for (int i = 0; i < 3; ++i) {
        if (f->neighbor(i)->info().merged == f->info().merged) continue;
        const DirectedEdge e = edge(f, i);
        const std::int32_t gauge = is_centre(e.key.a) ? e.kb : e.ka;
        if (!mark.set || e.key < mark.key) mark = {e.key, gauge, mark.subdomain, true};
      }
    }
    std::vector<std::int32_t> order(marks.size());
    std::iota(order.begin(), order.end(), 0);
    const auto rank = [&](std::int32_t i) {
      const Mark& m = marks[static_cast<std::size_t>(i)];
      return std::tuple(m.key, m.gauge, i);
    };
    std::sort(order.begin(), order.end(),
              [&](std::int32_t a, std::int32_t b) { return rank(a) < rank(b); });
    representative_.assign(marks.size(), 0);
    std::vector<std::int32_t> leader(full_.subdomains.size());
    std::iota(leader.begin(), leader.end(), 0);
    const auto find = [&](std::int32_t s) {
      while (leader[static_cast<std::size_t>(s)] != s) s = leader[static_cast<std::size_t>(s)];
      return s;
    };
    for (std::size_t i = 0; i < order.size();) {
      std::size_t j = i;
      const Mark& first = marks[static_cast<std::size_t>(order[i])];
      for (; j < order.size() && marks[static_cast<std::size_t>(order[j])].key == first.key; ++j) {
        const std::int32_t a = find(first.subdomain);
        const std::int32_t b = find(marks[static_cast<std::size_t>(order[j])].subdomain);
        leader[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
      }
      if (j - i != static_cast<std::size_t>(pslg_.fold)) {
        return fail(ErrorCode::kNotSymmetric,
                    "the domain is not " + std::to_string(pslg_.fold) +
                        "-fold symmetric although its segments are: a face has " +
                        std::to_string(j - i) +
                        " copies; give every copy of a hole or region its own seed");
      }
      representative_[static_cast<std::size_t>(order[i])] = 1;
      i = j;
    }
    number_subdomain_orbits(find);
    return {};
  }

  template <class Find>
  void number_subdomain_orbits(const Find& find) {
    orbit_of_subdomain_.assign(full_.subdomains.size(), -1);
    for (std::size_t s = 0; s < full_.subdomains.size(); ++s) {
      const Subdomain& sub = full_.subdomains[s];
      if (!sub.inside) continue;
      std::int32_t& orbit =
          orbit_of_subdomain_[static_cast<std::size_t>(find(static_cast<std::int32_t>(s)))];
      if (orbit < 0) {
        orbit = static_cast<std::int32_t>(subdomain_orbits_.size());
        subdomain_orbits_.push_back({sub.attribute, sub.max_area});
      }
      SubdomainOrbit& target = subdomain_orbits_[static_cast<std::size_t>(orbit)];
      target.max_area = std::min(target.max_area, sub.max_area);
      orbit_of_subdomain_[s] = orbit;
    }
  }

  void emit_vertices(QuotientTriangulation& mesh) const {
    for (const Point2 p : pslg_.orbit_points) mesh.add_vertex(p, VertexKind::kInput);
    if (full_.orbit_count > static_cast<std::int32_t>(pslg_.orbit_points.size())) {
      mesh.add_vertex({0, 0}, VertexKind::kInput);
    }
  }

  void emit_triangles(QuotientTriangulation& mesh) {
    for (auto f = full_.cdt.finite_faces_begin(); f != full_.cdt.finite_faces_end(); ++f) {
      if (!represents(f)) continue;
      const TriangleId t = mesh.add_triangle();
      Triangle& tri = mesh.triangle(t);
      for (std::uint32_t i = 0; i < 3; ++i) {
        const OrbitVertex v = f->vertex(static_cast<int>(i))->info();
        tri.v[i] = v.orbit;
        tri.k[i] = static_cast<std::int16_t>(v.exponent);
        tri.nb[i] = kNoHalfEdge;
        tri.off[i] = 0;
        tri.seg[i] = kNoSubsegment;
        mesh.set_corner(v.orbit, 3 * t + i);
      }
      tri.face = orbit_of_subdomain_[static_cast<std::size_t>(f->info().subdomain)];
      handles_.push_back(f);
      // From here on `merged` holds the triangle of a representative face.
      slot_of_.emplace_back(f, t);
    }
    std::sort(slot_of_.begin(), slot_of_.end());
  }

  [[nodiscard]] bool represents(FaceHandle f) const {
    return f->info().merged >= 0 && representative_[static_cast<std::size_t>(f->info().merged)];
  }

  [[nodiscard]] TriangleId slot(FaceHandle f) const {
    return std::lower_bound(slot_of_.begin(), slot_of_.end(), std::pair(f, TriangleId{0}))->second;
  }

  Result<void> link_triangles(QuotientTriangulation& mesh) const {
    struct Side {
      DirectedEdge edge;
      HalfEdge half_edge;
    };
    std::vector<Side> sides;
    for (std::size_t t = 0; t < handles_.size(); ++t) {
      const FaceHandle f = handles_[t];
      for (int i = 0; i < 3; ++i) {
        const auto h = static_cast<HalfEdge>(3 * t + static_cast<std::size_t>(i));
        const FaceHandle other = f->neighbor(i);
        if (!f->is_constrained(i) && other->info().merged == f->info().merged) {
          const int back = other->index(f);
          mesh.link(h, 3 * slot(other) + static_cast<HalfEdge>(back), 0);
        } else {
          sides.push_back({edge(f, i), h});
        }
      }
    }
    const auto by_key = [](const Side& x, const Side& y) { return x.edge.key < y.edge.key; };
    std::sort(sides.begin(), sides.end(), by_key);
    const std::vector<std::pair<EdgeKey, std::int32_t>> parents = segment_orbits();
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Side& side = sides[i];
      if (i > 0 && sides[i - 1].edge.key == side.edge.key) {
        return fail(ErrorCode::kInternal, "two triangles on one side of an edge orbit");
      }
      const Side probe{{reversed(side.edge.key), 0, 0}, 0};
      const auto mate = std::lower_bound(sides.begin(), sides.end(), probe, by_key);
      const bool found = mate != sides.end() && mate->edge.key == probe.edge.key;
      Triangle& tri = mesh.triangle(triangle_of(side.half_edge));
      const FaceHandle f = handles_[triangle_of(side.half_edge)];
      const bool constrained = f->is_constrained(static_cast<int>(local_of(side.half_edge)));
      if (found) {
        const std::int32_t off = is_centre(side.edge.key.a)
                                     ? rotations_.subtract(side.edge.kb, mate->edge.ka)
                                     : rotations_.subtract(side.edge.ka, mate->edge.kb);
        mesh.link(side.half_edge, mate->half_edge, off);
      } else if (!constrained) {
        return fail(ErrorCode::kInternal, "an edge orbit inside the domain has one side only");
      }
      if (constrained && tri.seg[local_of(side.half_edge)] == kNoSubsegment) {
        const auto parent = std::lower_bound(parents.begin(), parents.end(),
                                             std::pair(undirected(side.edge.key), std::int32_t{0}));
        if (parent == parents.end() || parent->first != undirected(side.edge.key)) {
          return fail(ErrorCode::kInternal, "a constrained edge belongs to no segment orbit");
        }
        const SubsegmentId s = mesh.add_subsegment(parent->second);
        mesh.subsegment(s).half_edge = side.half_edge;
        tri.seg[local_of(side.half_edge)] = s;
        if (found) {
          mesh.triangle(triangle_of(mate->half_edge)).seg[local_of(mate->half_edge)] = s;
        }
      }
    }
    return {};
  }

  [[nodiscard]] std::vector<std::pair<EdgeKey, std::int32_t>> segment_orbits() const {
    std::vector<std::pair<EdgeKey, std::int32_t>> parents;
    for (std::size_t s = 0; s < pslg_.segments.size(); ++s) {
      const DirectedEdge e = make_edge(pslg_.segments[s].a, pslg_.segments[s].b);
      parents.emplace_back(undirected(e.key), static_cast<std::int32_t>(s));
    }
    std::sort(parents.begin(), parents.end());
    return parents;
  }

  const SymmetricPslg& pslg_;
  FullCdt& full_;
  RotationTable rotations_;
  std::int32_t merged_count_ = 0;
  std::vector<char> representative_;  // per merged face
  std::vector<std::int32_t> orbit_of_subdomain_;
  std::vector<SubdomainOrbit> subdomain_orbits_;
  std::vector<FaceHandle> handles_;  // per triangle of the quotient
  std::vector<std::pair<FaceHandle, TriangleId>> slot_of_;
};

class CdtRegionLocator final : public RegionLocator {
 public:
  explicit CdtRegionLocator(std::unique_ptr<FullCdt> full) : full_(std::move(full)) {}

  [[nodiscard]] std::int32_t attribute_at(Point2 x) const override {
    hint_ = full_->cdt.locate(Cdt::Point(x.x, x.y), hint_);
    if (hint_ == FaceHandle() || full_->cdt.is_infinite(hint_)) return 0;
    return full_->subdomains[static_cast<std::size_t>(hint_->info().subdomain)].attribute;
  }

 private:
  std::unique_ptr<FullCdt> full_;
  mutable FaceHandle hint_;
};

bool attributes_differ(const FullCdt& full, const std::vector<SubdomainOrbit>& orbits) {
  for (const Subdomain& s : full.subdomains) {
    if (s.inside && s.attribute != orbits.front().attribute) return true;
  }
  return false;
}

}  // namespace
}  // namespace initial

Result<InitialTriangulation> triangulate_initial(const SymmetricPslg& pslg,
                                                 ExecutionContext& context) {
  auto full = std::make_unique<initial::FullCdt>();
  SYMCELL_TRY(initial::build_full_cdt(pslg, context, *full));
  auto result = initial::QuotientBuilder(pslg, *full).build();
  if (!result) return result;
  if (pslg.fold > 1 && pslg.ignore_markers &&
      initial::attributes_differ(*full, result->subdomains)) {
    result->locator = std::make_unique<initial::CdtRegionLocator>(std::move(full));
  }
  Editor editor(result->mesh);
  for (TriangleId t = 0; t < result->mesh.triangle_slots(); ++t) {
    for (std::uint32_t j = 0; j < 3; ++j) editor.queue_edge(3 * t + j);
  }
  editor.legalise();
  return result;
}

}  // namespace symcell::plane
