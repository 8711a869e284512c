#include "api/formats/model_glb.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "api/formats/glb_document.hpp"
#include "core/geometry/arc.hpp"
#include "core/geometry/facet_triangulation.hpp"

namespace symcell {
namespace {

constexpr GlbColour kFaultColour{0.85, 0.02, 0.02};
constexpr GlbColour kPlainColour{0.47, 0.53, 0.58};
constexpr GlbColour kLineColour{0.10, 0.14, 0.18};
constexpr double kArcStep = 0.1;  // radians of a drawn chord

struct PointHash {
  std::size_t operator()(const std::array<float, 3>& p) const {
    constexpr std::uint64_t kMix = 0x9E3779B97F4A7C15;
    std::uint64_t hash = 0;
    for (const float c : p) hash = (hash ^ std::bit_cast<std::uint32_t>(c)) * kMix;
    return static_cast<std::size_t>(hash >> 16U);
  }
};

class ModelPicture {
 public:
  explicit ModelPicture(std::span<const std::int64_t> at_fault)
      : at_fault_(at_fault.begin(), at_fault.end()) {}

  void draw(const Pslg& pslg) {
    marker_names_ = pslg.marker_names;
    take_centre(pslg.vertices, [](const Point2& p) { return Point3{p.x, p.y, 0}; });
    const auto count = pslg.vertices.size();
    for (std::size_t i = 0; i < pslg.segments.size(); ++i) {
      const PslgSegment& s = pslg.segments[i];
      if (!exists(s.a, count) || !exists(s.b, count)) continue;
      const Point2 a = pslg.vertices[index(s.a)], b = pslg.vertices[index(s.b)];
      const double bulge = pslg.bulge(i);
      const bool arc = bulge != 0 && a != b && std::isfinite(bulge);
      const double steps = arc ? std::ceil(std::abs(angle_of_bulge(bulge)) / kArcStep) : 1;
      Point2 from = a;
      for (double k = 1; k <= steps; ++k) {
        const Point2 to = k == steps ? b : arc_point(a, b, bulge, k / steps);
        add(lines_, group_of(i, s.marker), {{from.x, from.y, 0}, {to.x, to.y, 0}});
        from = to;
      }
    }
  }

  void draw(const Plc& plc) {
    take_centre(plc.vertices, [](const Point3& p) { return p; });
    for (std::size_t f = 0; f < plc.facets.size(); ++f) {
      const Key group = group_of(f, plc.facets[f].marker);
      for (const auto& t : triangles_of(plc, plc.facets[f])) {
        add(triangles_, group,
            {plc.vertices[index(t[0])], plc.vertices[index(t[1])], plc.vertices[index(t[2])]});
      }
    }
    for (const auto& [a, b] : edges_of(plc)) {
      add(lines_, {true, 0}, {plc.vertices[index(a)], plc.vertices[index(b)]});
    }
  }

  void draw(const TriangleSurface& surface) {
    take_centre(surface.vertices, [](const Point3& p) { return p; });
    const auto count = surface.vertices.size();
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const auto& corners = surface.triangles[t];
      if (!std::ranges::all_of(corners, [&](std::int32_t v) { return exists(v, count); })) continue;
      const std::size_t face = surface.source_face.empty() ? t : index(surface.source_face[t]);
      add(triangles_, group_of(face, 0),
          {surface.vertices[index(corners[0])], surface.vertices[index(corners[1])],
           surface.vertices[index(corners[2])]});
    }
  }

  Result<void> write(nlohmann::ordered_json extras, ByteWriter& out) {
    if (points_.empty()) {
      return fail(ErrorCode::kDegenerateGeometry, "the model has nothing that could be shown");
    }
    GlbDocument document;
    const std::size_t positions = document.add_positions(points_);
    const std::size_t mesh = document.add_mesh("model");
    for (const auto& [marker, indices] : triangles_) {
      document.add_primitive(
          mesh, GlbDocument::Shape::kTriangles, positions, document.add_indices(indices),
          document.add_material(name_of(marker), colour_of(marker, kPlainColour), true));
    }
    for (const auto& [marker, indices] : lines_) {
      document.add_primitive(
          mesh, GlbDocument::Shape::kLines, positions, document.add_indices(indices),
          document.add_material(name_of(marker), colour_of(marker, kLineColour), false));
    }
    document.set_mesh(document.add_node("model", GlbDocument::kRoot, centre_, {0, 0, 0, 1}), mesh);
    document.set_extras(std::move(extras));
    return document.write(out);
  }

 private:
  // By marker; what is at fault comes first.
  using Groups = std::map<std::pair<bool, std::int32_t>, std::vector<std::uint32_t>>;
  using Key = Groups::key_type;

  static std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }
  static bool exists(std::int32_t i, std::size_t count) { return i >= 0 && index(i) < count; }

  template <class Points, class Lift>
  void take_centre(const Points& points, Lift lift) {
    if (points.empty()) return;
    Point3 least = lift(points[0]), most = least;
    for (const auto& point : points) {
      const Point3 p = lift(point);
      least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
      most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
    }
    centre_ = 0.5 * least + 0.5 * most;
  }

  Key group_of(std::size_t entity, std::int32_t marker) const {
    if (at_fault_.contains(static_cast<std::int64_t>(entity))) return {false, 0};
    return {true, marker};
  }

  void add(Groups& groups, const Key& group, std::initializer_list<Point3> corners) {
    auto& indices = groups[group];
    for (const Point3& corner : corners) {
      const Point3 p = corner - centre_;
      const std::array<float, 3> rounded{static_cast<float>(p.x), static_cast<float>(p.y),
                                         static_cast<float>(p.z)};
      const auto [known, added] =
          numbers_.emplace(rounded, static_cast<std::uint32_t>(points_.size()));
      if (added) points_.push_back(p);
      indices.push_back(known->second);
    }
  }

  static std::set<IndexPair> edges_of(const Plc& plc) {
    std::set<IndexPair> edges;
    for (const PlcFacet& facet : plc.facets) {
      for (const auto& polygon : facet.polygons) {
        for (std::size_t i = 0; i < polygon.size(); ++i) {
          const std::int32_t a = polygon[i], b = polygon[(i + 1) % polygon.size()];
          if (a == b || !exists(a, plc.vertices.size()) || !exists(b, plc.vertices.size()))
            continue;
          edges.insert({std::min(a, b), std::max(a, b)});
        }
      }
    }
    return edges;
  }

  // None of a facet that cannot be triangulated and is no single polygon.
  static std::vector<std::array<std::int32_t, 3>> triangles_of(const Plc& plc,
                                                               const PlcFacet& facet) {
    const auto sound = [&](const std::vector<std::int32_t>& polygon) {
      return polygon.size() >= 3 && std::ranges::all_of(polygon, [&](std::int32_t v) {
               return exists(v, plc.vertices.size());
             });
    };
    FacetGraph graph;
    graph.holes = facet.holes;
    std::set<IndexPair> edges;
    double largest = 0;
    for (const auto& polygon : facet.polygons) {
      if (!sound(polygon)) continue;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const std::int32_t a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        edges.insert({std::min(a, b), std::max(a, b)});
      }
      const Point3 normal = normal_of(plc, polygon);
      if (length(normal) > largest) {
        largest = length(normal);
        graph.normal = normal;
      }
    }
    if (edges.empty() || !(largest > 0)) return {};
    graph.segments.assign(edges.begin(), edges.end());
    // A facet of its own points: the triangulation looks at all that it is given.
    std::vector<Point3> points;
    std::map<std::int32_t, std::int32_t> number;
    std::vector<std::int32_t> vertex;
    for (IndexPair& edge : graph.segments) {
      for (std::int32_t& end : edge) {
        const auto [known, added] = number.emplace(end, static_cast<std::int32_t>(points.size()));
        if (added) {
          points.push_back(plc.vertices[index(end)]);
          vertex.push_back(end);
        }
        end = known->second;
      }
    }
    if (auto found = triangulate_facet(points, graph)) {
      for (auto& triangle : found->triangles) {
        for (std::int32_t& corner : triangle) corner = vertex[index(corner)];
      }
      return std::move(found->triangles);
    }
    return {};
  }

  // Newell's, relative to one corner.
  static Point3 normal_of(const Plc& plc, const std::vector<std::int32_t>& polygon) {
    const Point3 origin = plc.vertices[index(polygon[0])];
    Point3 normal;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point3 p = plc.vertices[index(polygon[i])] - origin;
      const Point3 q = plc.vertices[index(polygon[(i + 1) % polygon.size()])] - origin;
      normal = normal + cross(p, q);
    }
    return normal;
  }

  [[nodiscard]] std::string name_of(const Key& group) const {
    if (!group.first) return "at fault";
    const auto known = std::ranges::find(marker_names_, group.second, &MarkerName::marker);
    return known == marker_names_.end() ? "boundary_" + std::to_string(group.second) : known->name;
  }

  [[nodiscard]] GlbColour colour_of(const Key& group, const GlbColour& plain) {
    if (!group.first) return kFaultColour;
    if (group.second == 0) return plain;
    return glb_palette(met_.emplace(group.second, met_.size()).first->second);
  }

  std::set<std::int64_t> at_fault_;
  std::vector<MarkerName> marker_names_;
  Point3 centre_;
  std::vector<Point3> points_;
  std::unordered_map<std::array<float, 3>, std::uint32_t, PointHash> numbers_;
  Groups triangles_;
  Groups lines_;
  std::map<std::int32_t, std::size_t> met_;  // markers in the order of their colours
};

}  // namespace

Result<void> write_model_glb(const Model& model,
                             std::span<const std::int64_t> at_fault,
                             nlohmann::ordered_json extras,
                             const Sink& sink) {
  ModelPicture picture(at_fault);
  std::visit([&](const auto& drawn) { picture.draw(drawn); }, model);
  ByteWriter out(sink);
  SYMCELL_TRY(picture.write(std::move(extras), out));
  return out.finish();
}

}  // namespace symcell
