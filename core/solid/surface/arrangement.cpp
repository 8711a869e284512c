#include "core/solid/surface/arrangement.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <map>
#include <optional>

#include "core/base/union_find.hpp"

namespace symcell::solid {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using P2 = Kernel::Point_2;
using P3 = Kernel::Point_3;
using Number = Kernel::FT;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Tds = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Tds, CGAL::Exact_intersections_tag>;

constexpr std::size_t kCheckEvery = 256;  // pairs, planes or edges

// Rounded from its exact value, not from a bound of it.
double rounded(const Number& number) {
  return CGAL::to_double(number.exact());
}

// Coordinates of a plane's points without the one that its normal has most of.
struct Projection {
  int kept_a = 0, kept_b = 1, dropped = 2;
  bool mirrored = false;  // counter-clockwise about the normal is clockwise in the projection

  [[nodiscard]] P2 operator()(const P3& p) const { return {p[kept_a], p[kept_b]}; }
};

class Arranger {
 public:
  Arranger(const IndexedSurface& surface,
           std::span<const std::pair<std::int32_t, std::int32_t>> pairs,
           ExecutionContext& context)
      : surface_(surface),
        pairs_(pairs),
        context_(context),
        planes_(surface.triangles.size()),
        cuts_(surface.triangles.size()) {}

  Result<Arrangement> run() {
    points_.reserve(surface_.points.size());
    for (const Point3& p : surface_.points) points_.emplace_back(p.x, p.y, p.z);
    for (const auto& [s, t] : pairs_) {
      for (const std::int32_t triangle : {s, t}) {
        for (const std::int32_t v : surface_.triangles[triangle]) ids_.emplace(points_[v], v);
      }
    }
    SYMCELL_TRY(intersect_pairs());
    SYMCELL_TRY(cut_planes());
    SYMCELL_TRY(sort_rings());
    for (std::size_t i = surface_.points.size(); i < points_.size(); ++i) {
      const P3& p = points_[i];
      result_.points.push_back({rounded(p.x()), rounded(p.y()), rounded(p.z())});
    }
    result_.points.insert(result_.points.begin(), surface_.points.begin(), surface_.points.end());
    result_.plane.resize(surface_.triangles.size());
    for (std::size_t t = 0; t < result_.plane.size(); ++t) {
      result_.plane[t] = planes_.root(static_cast<std::int32_t>(t));
    }
    return std::move(result_);
  }

 private:
  struct ByPlace {
    bool operator()(const P3& p, const P3& q) const {
      return CGAL::compare_xyz(p, q) == CGAL::SMALLER;
    }
  };
  using Segment = std::pair<std::int32_t, std::int32_t>;  // of one point twice: a point

  [[nodiscard]] const P3& corner(std::int32_t t, int i) const {
    return points_[surface_.triangles[t][i]];
  }

  std::int32_t id_of(const P3& p) {
    const auto [place, added] = ids_.emplace(p, static_cast<std::int32_t>(points_.size()));
    if (added) points_.push_back(p);
    return place->second;
  }

  [[nodiscard]] Projection projection(std::int32_t t) const {
    const auto n = CGAL::cross_product(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
    std::array<double, 3> size{};
    for (int i = 0; i < 3; ++i) {
      size[i] = CGAL::is_zero(n[i]) ? -1 : std::abs(CGAL::to_double(n[i]));
    }
    const int k = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
    return {(k + 1) % 3, (k + 2) % 3, k, CGAL::is_negative(n[k])};
  }

  // p, in the triangle's plane, lies in the closed triangle.
  [[nodiscard]] bool covers(std::int32_t t, const P3& p) const {
    const Projection flat = projection(t);
    const P2 q = flat(p);
    const CGAL::Orientation outside = flat.mirrored ? CGAL::LEFT_TURN : CGAL::RIGHT_TURN;
    for (int i = 0; i < 3; ++i) {
      if (CGAL::orientation(flat(corner(t, i)), flat(corner(t, (i + 1) % 3)), q) == outside) {
        return false;
      }
    }
    return true;
  }

  // Adds where the sides of s cross or touch the closed triangle t, and ends of sides in its plane.
  void cross_sides(std::int32_t s,
                   const std::array<CGAL::Orientation, 3>& side_of_t,
                   std::int32_t t,
                   std::vector<std::int32_t>& found) {
    for (int i = 0; i < 3; ++i) {
      if (side_of_t[i] == CGAL::ZERO && covers(t, corner(s, i))) {
        found.push_back(surface_.triangles[s][i]);
      }
      const int j = (i + 1) % 3;
      if (side_of_t[i] * side_of_t[j] != CGAL::NEGATIVE) continue;
      const P3 &p = corner(s, i), &q = corner(s, j);
      bool left = false, right = false;
      for (int k = 0; k < 3; ++k) {
        const auto turn = CGAL::orientation(p, q, corner(t, k), corner(t, (k + 1) % 3));
        left |= turn == CGAL::POSITIVE;
        right |= turn == CGAL::NEGATIVE;
      }
      if (left && right) continue;
      const auto n = CGAL::cross_product(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
      const Number hp = n * (p - corner(t, 0)), hq = n * (q - corner(t, 0));
      // The same point whichever way the side runs: it is exact.
      found.push_back(id_of(p + (hp / (hp - hq)) * (q - p)));
    }
  }

  [[nodiscard]] std::array<CGAL::Orientation, 3> sides(std::int32_t s, std::int32_t t) const {
    std::array<CGAL::Orientation, 3> result{};
    for (int i = 0; i < 3; ++i) {
      result[i] = CGAL::orientation(corner(t, 0), corner(t, 1), corner(t, 2), corner(s, i));
    }
    return result;
  }

  Result<void> intersect_pairs() {
    std::vector<std::int32_t> found;
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (k % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      const auto [s, t] = pairs_[k];
      const auto of_s = sides(s, t), of_t = sides(t, s);
      if (std::all_of(of_s.begin(), of_s.end(), [](auto side) { return side == CGAL::ZERO; })) {
        planes_.join(s, t);
        continue;
      }
      found.clear();
      cross_sides(s, of_s, t, found);
      cross_sides(t, of_t, s, found);
      if (found.empty()) continue;
      const auto [first, last] =
          std::minmax_element(found.begin(), found.end(), [&](std::int32_t a, std::int32_t b) {
            return a != b && ByPlace{}(points_[a], points_[b]);
          });
      const Segment segment{*first, *last};
      cuts_[s].push_back(segment);
      cuts_[t].push_back(segment);
    }
    return {};
  }

  Result<void> cut_planes() {
    const auto count = static_cast<std::int32_t>(surface_.triangles.size());
    std::vector<std::vector<std::int32_t>> members(count);
    for (std::int32_t t = 0; t < count; ++t) members[planes_.root(t)].push_back(t);
    for (std::int32_t t = 0; t < count; ++t) {
      if (t % static_cast<std::int32_t>(kCheckEvery) == 0) {
        SYMCELL_TRY(context_.check());
      }
      if (members[t].empty()) continue;
      if (members[t].size() > 1 || !cuts_[t].empty()) {
        SYMCELL_TRY(cut_plane(members[t]));
      } else if (!CGAL::collinear(corner(t, 0), corner(t, 1), corner(t, 2))) {
        result_.pieces.push_back({surface_.triangles[t], 1, surface_.source[t], t});
      }
    }
    return {};
  }

  struct Member {
    std::int32_t triangle;
    std::array<P2, 3> corners;
    int sign;  // 1: counter-clockwise in the projection
  };

  // Faces of the triangulation of all sides and cuts in one plane that members cover.
  Result<void> cut_plane(const std::vector<std::int32_t>& triangles) {
    const Projection flat = projection(triangles.front());
    Cdt cdt;
    std::map<std::int32_t, Cdt::Vertex_handle> handles;
    const auto handle = [&](std::int32_t id) {
      const auto known = handles.find(id);
      if (known != handles.end()) return known->second;
      const Cdt::Vertex_handle v = cdt.insert(flat(points_[id]));
      v->info() = id;
      return handles.emplace(id, v).first->second;
    };
    std::vector<Segment> segments;
    std::vector<Member> members;
    for (const std::int32_t t : triangles) {
      const Triangle& v = surface_.triangles[t];
      for (std::size_t i = 0; i < 3; ++i) segments.push_back(std::minmax(v[i], v[(i + 1) % 3]));
      for (const Segment& cut : cuts_[t]) segments.push_back(std::minmax(cut.first, cut.second));
      members.push_back({t, {flat(corner(t, 0)), flat(corner(t, 1)), flat(corner(t, 2))}, 1});
      Member& m = members.back();
      if (CGAL::orientation(m.corners[0], m.corners[1], m.corners[2]) == CGAL::RIGHT_TURN) {
        m.sign = -1;
        std::swap(m.corners[1], m.corners[2]);
      }
    }
    std::sort(segments.begin(), segments.end());
    segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
    // Vertices first: a vertex that is put in where segments cross has no id of its own yet.
    for (const Segment& s : segments) {
      handle(s.first);
      handle(s.second);
    }
    const std::size_t named = cdt.number_of_vertices();
    std::size_t steps = 0;
    for (const Segment& s : segments) {
      if (++steps % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      if (s.first != s.second) cdt.insert_constraint(handle(s.first), handle(s.second));
    }
    if (cdt.number_of_vertices() > named) name_crossings(cdt, triangles.front(), flat, handles);
    for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
      if (++steps % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      add_face(f, members);
    }
    return {};
  }

  void name_crossings(Cdt& cdt,
                      std::int32_t t,
                      const Projection& flat,
                      const std::map<std::int32_t, Cdt::Vertex_handle>& handles) {
    std::vector<Cdt::Vertex_handle> known;
    for (const auto& [id, v] : handles) known.push_back(v);
    std::sort(known.begin(), known.end());
    const P3 a = corner(t, 0);  // a copy: points are added meanwhile
    const auto n = CGAL::cross_product(corner(t, 1) - a, corner(t, 2) - a);
    for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) {
      const Cdt::Vertex_handle h = v;
      if (std::binary_search(known.begin(), known.end(), h)) continue;
      std::array<Number, 3> x;
      x[flat.kept_a] = v->point().x();
      x[flat.kept_b] = v->point().y();
      x[flat.dropped] = a[flat.dropped] - (n[flat.kept_a] * (x[flat.kept_a] - a[flat.kept_a]) +
                                           n[flat.kept_b] * (x[flat.kept_b] - a[flat.kept_b])) /
                                              n[flat.dropped];
      v->info() = id_of(P3(x[0], x[1], x[2]));
    }
  }

  void add_face(const Cdt::Finite_faces_iterator& f, const std::vector<Member>& members) {
    const P2 &a = f->vertex(0)->point(), &b = f->vertex(1)->point(), &c = f->vertex(2)->point();
    const P2 inside = CGAL::centroid(a, b, c);
    Piece piece;
    bool covered = false;
    for (const Member& m : members) {
      bool within = true;
      for (std::size_t i = 0; i < 3 && within; ++i) {
        within =
            CGAL::orientation(m.corners[i], m.corners[(i + 1) % 3], inside) != CGAL::RIGHT_TURN;
      }
      if (!within) continue;
      piece.multiplicity += m.sign;
      if (covered) continue;
      covered = true;
      piece.triangle = m.triangle;
      piece.source = surface_.source[m.triangle];
    }
    piece.corners = {f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()};
    if (piece.multiplicity == 0) {
      if (covered) result_.cancelled_area += area(piece.corners);
      return;
    }
    if (piece.multiplicity < 0) {
      piece.multiplicity = -piece.multiplicity;
      std::swap(piece.corners[1], piece.corners[2]);
    }
    result_.pieces.push_back(piece);
  }

  [[nodiscard]] double area(const Triangle& t) const {
    const auto place = [&](std::size_t i) {
      const P3& p = points_[t[i]];
      return Point3{CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
    };
    return length(area_normal(place(0), place(1), place(2))) / 2;
  }

  Result<void> sort_rings() {
    std::vector<Triangle> corners;
    corners.reserve(result_.pieces.size());
    for (const Piece& p : result_.pieces) corners.push_back(p.corners);
    const std::vector<EdgeUse> uses = sorted_edge_uses(corners);
    result_.rings.reserve(uses.size());
    Result<void> state;
    std::size_t steps = 0;
    for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
      if (!state) return;
      if (++steps % kCheckEvery == 0) {
        state = context_.check();
        if (!state) return;
      }
      result_.ring_begin.push_back(result_.rings.size());
      std::vector<PieceAtEdge> ring;
      for (std::size_t i = begin; i < end; ++i) {
        const std::int32_t m = result_.pieces[uses[i].triangle].multiplicity;
        ring.push_back({uses[i].triangle, uses[i].forward ? m : -m});
      }
      if (ring.size() > 2) sort_ring(uses[begin].low, uses[begin].high, ring);
      result_.rings.insert(result_.rings.end(), ring.begin(), ring.end());
    });
    result_.ring_begin.push_back(result_.rings.size());
    return state;
  }

  void sort_ring(std::int32_t u, std::int32_t v, std::vector<PieceAtEdge>& ring) const {
    const auto apex = [&](const PieceAtEdge& at) -> const P3& {
      const Triangle& t = result_.pieces[at.piece].corners;
      std::size_t i = 0;
      while (t[i] == u || t[i] == v) ++i;
      return points_[t[i]];
    };
    const P3 &pu = points_[u], &pv = points_[v];
    const P3& reference = apex(ring.front());
    // 0: less than half a turn from the reference, 1: half a turn, 2: more.
    const auto half = [&](const PieceAtEdge& at) {
      return 1 - static_cast<int>(CGAL::orientation(pu, pv, reference, apex(at)));
    };
    std::sort(ring.begin() + 1, ring.end(), [&](const PieceAtEdge& a, const PieceAtEdge& b) {
      const int ha = half(a), hb = half(b);
      return ha != hb ? ha < hb : CGAL::orientation(pu, pv, apex(a), apex(b)) == CGAL::POSITIVE;
    });
  }

  const IndexedSurface& surface_;
  std::span<const std::pair<std::int32_t, std::int32_t>> pairs_;
  ExecutionContext& context_;
  Arrangement result_;
  std::vector<P3> points_;
  std::map<P3, std::int32_t, ByPlace> ids_;
  UnionFind planes_;
  std::vector<std::vector<Segment>> cuts_;  // per triangle
};

}  // namespace

Result<Arrangement> arrange(const IndexedSurface& surface,
                            std::span<const std::pair<std::int32_t, std::int32_t>> pairs,
                            ExecutionContext& context) {
  try {
    return Arranger(surface, pairs, context).run();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return fail(ErrorCode::kSelfIntersection, "the triangles could not be cut along each other");
  }
}

}  // namespace symcell::solid
