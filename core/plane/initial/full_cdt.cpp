#include "core/plane/initial/full_cdt.hpp"

#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <exception>
#include <numeric>
#include <string>

#include "core/geometry/rotation.hpp"

namespace symcell::plane::initial {
namespace {

using Point = Cdt::Point;
using VertexHandle = Cdt::Vertex_handle;
using FaceHandle = Cdt::Face_handle;

constexpr std::size_t kCheckEvery = 4096;  // points or copies of segments put in

// Handles of the copies of orbit o: n from first[o], one for the centre.
struct Handles {
  std::vector<std::size_t> first;
  std::vector<VertexHandle> handle;
  [[nodiscard]] VertexHandle operator()(OrbitVertex v) const {
    return handle[first[static_cast<std::size_t>(v.orbit)] + static_cast<std::size_t>(v.exponent)];
  }
};

// All copies of all vertices, orbit by orbit. Whether the centre lies in the domain is known only
// after flooding: it is taken in here and dropped later.
std::vector<Point> lift_vertices(const SymmetricPslg& pslg,
                                 FullCdt& full,
                                 Handles& handles,
                                 std::vector<OrbitVertex>& ids) {
  const RotationTable rotations(pslg.fold);
  full.centre_orbit = pslg.centre_orbit;
  full.orbit_count = static_cast<std::int32_t>(pslg.orbit_points.size());
  std::vector<Point> points;
  points.reserve(pslg.orbit_points.size() * static_cast<std::size_t>(pslg.fold) + 1);
  for (std::int32_t o = 0; o < full.orbit_count; ++o) {
    handles.first.push_back(points.size());
    const std::int32_t copies = o == pslg.centre_orbit ? 1 : pslg.fold;
    for (std::int32_t k = 0; k < copies; ++k) {
      const Point2 p = rotations.rotate(pslg.orbit_points[static_cast<std::size_t>(o)], k);
      points.emplace_back(p.x, p.y);
      ids.push_back({o, k});
    }
  }
  if (pslg.fold > 1 && pslg.centre_orbit < 0) {
    handles.first.push_back(points.size());
    full.centre_orbit = full.orbit_count++;
    points.emplace_back(0, 0);
    ids.push_back({full.centre_orbit, 0});
  }
  return points;
}

// Inserts along a space-filling curve, looking at the context on the way.
Result<Handles> insert_vertices(const SymmetricPslg& pslg,
                                ExecutionContext& context,
                                FullCdt& full) {
  Handles handles;
  std::vector<OrbitVertex> ids;
  const std::vector<Point> points = lift_vertices(pslg, full, handles, ids);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  using Map = CGAL::Pointer_property_map<Point>::const_type;
  using Traits = CGAL::Spatial_sort_traits_adapter_2<Kernel, Map>;
  CGAL::spatial_sort(order.begin(), order.end(), Traits(CGAL::make_property_map(points)));
  handles.handle.resize(points.size());
  FaceHandle hint;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i % kCheckEvery == 0) {
      SYMCELL_TRY(context.check());
    }
    const VertexHandle v = full.cdt.insert(points[order[i]], hint);
    v->info() = ids[order[i]];
    handles.handle[order[i]] = v;
    hint = v->face();
  }
  if (full.cdt.number_of_vertices() != points.size()) {
    return fail(ErrorCode::kDuplicateVertices,
                "vertices coincide once the model is made symmetric; lower symmetry_tolerance or "
                "merge vertices that lie closer than it");
  }
  return handles;
}

Result<void> insert_segments(const SymmetricPslg& pslg,
                             const Handles& handles,
                             ExecutionContext& context,
                             FullCdt& full) {
  const RotationTable rotations(pslg.fold);
  const auto turned = [&](OrbitVertex v, std::int32_t k) {
    return v.orbit == pslg.centre_orbit ? v : OrbitVertex{v.orbit, rotations.add(v.exponent, k)};
  };
  std::size_t done = 0;
  for (std::size_t s = 0; s < pslg.segments.size(); ++s) {
    for (std::int32_t k = 0; k < pslg.fold; ++k) {
      if (++done % kCheckEvery == 0) {
        SYMCELL_TRY(context.check());
      }
      const VertexHandle a = handles(turned(pslg.segments[s].a, k));
      const VertexHandle b = handles(turned(pslg.segments[s].b, k));
      full.cdt.insert_constraint(a, b);
      FaceHandle face;
      int index = 0;
      if (!full.cdt.is_edge(a, b, face, index)) {
        return fail(ErrorCode::kSelfIntersection,
                    "a vertex lies inside segment orbit " + std::to_string(s) +
                        " once the model is made symmetric; lower symmetry_tolerance",
                    {static_cast<std::int64_t>(s)});
      }
    }
  }
  return {};
}

// Subdomain 0 is the unbounded one.
void flood(FullCdt& full) {
  std::vector<FaceHandle> stack;
  const auto fill = [&](FaceHandle seed) {
    const auto id = static_cast<std::int32_t>(full.subdomains.size());
    full.subdomains.emplace_back();
    seed->info().subdomain = id;
    stack.push_back(seed);
    while (!stack.empty()) {
      const FaceHandle face = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i) {
        const FaceHandle other = face->neighbor(i);
        if (face->is_constrained(i) || other->info().subdomain >= 0) continue;
        other->info().subdomain = id;
        stack.push_back(other);
      }
    }
  };
  fill(full.cdt.infinite_face());
  full.subdomains[0].inside = false;
  for (auto f = full.cdt.finite_faces_begin(); f != full.cdt.finite_faces_end(); ++f) {
    if (f->info().subdomain < 0) fill(f);
  }
}

void apply_seeds(const SymmetricPslg& pslg, FullCdt& full) {
  FaceHandle hint;
  const auto subdomain_at = [&](Point2 p) -> Subdomain* {
    hint = full.cdt.locate(Point(p.x, p.y), hint);
    return hint == FaceHandle() || full.cdt.is_infinite(hint)
               ? nullptr
               : &full.subdomains[static_cast<std::size_t>(hint->info().subdomain)];
  };
  for (const Point2 p : pslg.holes) {
    if (Subdomain* s = subdomain_at(p)) s->inside = false;
  }
  for (const PslgRegion& region : pslg.regions) {
    Subdomain* s = subdomain_at(region.point);
    if (s == nullptr) continue;
    if (!s->has_region) s->attribute = region.attribute;
    s->has_region = true;
    s->max_area = std::min(s->max_area, region.max_area);
  }
}

}  // namespace

Result<void> build_full_cdt(const SymmetricPslg& pslg, ExecutionContext& context, FullCdt& full) {
  try {
    auto handles = insert_vertices(pslg, context, full);
    if (!handles) return error_of(handles);
    if (full.cdt.dimension() < 2) {
      return fail(ErrorCode::kDegenerateGeometry, "all vertices lie on one line: there is no area");
    }
    SYMCELL_TRY(context.check());
    SYMCELL_TRY(insert_segments(pslg, *handles, context, full));
  } catch (const std::exception& e) {
    return fail(ErrorCode::kSelfIntersection,
                std::string("segments cross once the model is made symmetric (") + e.what() +
                    "); lower symmetry_tolerance or mend the model");
  }
  flood(full);
  apply_seeds(pslg, full);
  return {};
}

}  // namespace symcell::plane::initial
