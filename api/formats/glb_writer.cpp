// What a mesh looks like, as binary glTF: the surface of a solid's cell or the triangles of a planar one,
// coloured by group; the full mesh as a node a sector, which all show one mesh.
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include "api/formats/glb_document.hpp"
#include "api/formats/mesh_formats.hpp"
#include "api/formats/mesh_groups.hpp"
#include "core/cell/boundary_faces.hpp"

namespace symcell::internal {
namespace {

using Json = nlohmann::ordered_json;
using Corners = std::array<std::int32_t, 3>;  // of facets in the plane the third is -1

constexpr GlbColour kLowerColour{0.72, 0.05, 0.04};
constexpr GlbColour kHigherColour{0.04, 0.12, 0.72};
constexpr GlbColour kEdgeColour{0.02, 0.03, 0.04};
constexpr GlbColour kPlainColour{0.47, 0.53, 0.58};  // of marker 0, region 0

// Which materials there are: bounds first, so that they sort first.
enum class Side : std::uint8_t { kLower, kHigher, kOuter };
struct Group {
  Side side = Side::kOuter;
  std::int32_t marker = 0;
  std::int32_t region = 0;
  auto operator<=>(const Group&) const = default;
};

struct CornersHash {
  std::size_t operator()(const Corners& c) const {
    constexpr std::uint64_t kMix = 0x9E3779B97F4A7C15;
    std::uint64_t hash = 0;
    for (const std::int32_t node : c) hash = (hash ^ static_cast<std::uint32_t>(node)) * kMix;
    return static_cast<std::size_t>(hash >> 16U);
  }
};

// Quaternion of the rotation whose matrix (row-major, proper) is `m`.
// Source: Shepperd, by the largest of the four squares.
std::array<double, 4> quaternion_of(const std::array<double, 9>& m) {
  const std::array<double, 4> squares{1 + m[0] - m[4] - m[8], 1 - m[0] + m[4] - m[8],
                                      1 - m[0] - m[4] + m[8], 1 + m[0] + m[4] + m[8]};
  const auto largest =
      static_cast<std::size_t>(std::ranges::max_element(squares) - squares.begin());
  const double twice = std::sqrt(squares[largest]);  // of the component, which is then twice / 2
  const double over = 1 / (2 * twice);
  const double xy = (m[1] + m[3]) * over, xz = (m[2] + m[6]) * over, yz = (m[5] + m[7]) * over;
  const double xw = (m[7] - m[5]) * over, yw = (m[2] - m[6]) * over, zw = (m[3] - m[1]) * over;
  switch (largest) {
    case 0: return {twice / 2, xy, xz, xw};
    case 1: return {xy, twice / 2, yz, yw};
    case 2: return {xz, yz, twice / 2, zw};
    default: return {xw, yw, zw, twice / 2};
  }
}

class GlbWriter {
 public:
  GlbWriter(const SymmetryCellMesh& cell, bool full) : cell_(cell), full_(full) {}

  Result<void> write(ByteWriter& out) {
    note_facets();
    find_shapes();
    add_points();
    const bool varied =
        full_ && (!cell_.sector_regions.empty() || !cell_.sector_boundary_markers.empty());
    const std::size_t axis = document_.add_node("axis", GlbDocument::kRoot, cell_.axis_origin,
                                                quaternion_of(cell_.frame));
    if (full_) {
      std::vector<std::size_t> meshes;
      meshes.reserve(static_cast<std::size_t>(cell_.fold));
      for (std::int32_t s = 0; s < cell_.fold; ++s) {
        meshes.push_back(s == 0 || varied ? add_mesh(s) : meshes.front());
      }
      document_.set_turned_copies(axis, std::move(meshes));
    } else {
      document_.set_mesh(document_.add_node("cell", axis, {}, {0, 0, 0, 1}), add_mesh(0));
    }
    document_.set_extras({{"dimension", cell_.dimension},
                          {"fold", cell_.fold},
                          {"part", full_ ? "full" : "cell"},
                          {"elements", cell_.element_count()}});
    return document_.write(out);
  }

 private:
  // A triangle of the picture, in nodes of the cell, and where its colour comes from.
  struct Face {
    Corners nodes{};
    std::size_t element = 0;
    std::int64_t facet = -1;  // of the cell's boundary; -1: none
    Side side = Side::kOuter;
  };
  struct Line {
    std::array<std::int32_t, 2> nodes{};
    std::int64_t facet = -1;  // -1: an edge between elements, or of a bound
    Side side = Side::kOuter;
    bool edge = true;
  };

  [[nodiscard]] bool solid() const { return cell_.dimension == 3; }
  [[nodiscard]] std::size_t corners_of_facet() const { return solid() ? 3 : 2; }

  [[nodiscard]] Corners facet_key(const std::vector<std::int32_t>& facets, std::size_t i) const {
    Corners key{-1, -1, -1};
    const auto k = static_cast<std::size_t>(cell_.nodes_per_facet);
    std::copy_n(facets.begin() + static_cast<std::ptrdiff_t>(i * k), corners_of_facet(),
                key.begin());
    std::ranges::sort(key);
    return key;
  }

  void note_facets() {
    const auto k = static_cast<std::size_t>(cell_.nodes_per_facet);
    for (std::size_t b = 0; b < cell_.facet_count(); ++b) {
      facets_.emplace(facet_key(cell_.boundary, b), static_cast<std::int64_t>(b));
    }
    for (std::size_t i = 0; i < cell_.lower_facets.size() / k; ++i) {
      sides_.emplace(facet_key(cell_.lower_facets, i), Side::kLower);
      sides_.emplace(facet_key(cell_.higher_facets, i), Side::kHigher);
    }
  }

  [[nodiscard]] std::int32_t element_node(std::size_t element, std::size_t i) const {
    return cell_.elements[element * static_cast<std::size_t>(cell_.nodes_per_element) + i];
  }

  void find_shapes() {
    solid() ? find_surface() : find_triangles();
    std::ranges::sort(edges_);
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  }

  void find_surface() {
    for (const BoundaryFace& face : boundary_faces(cell_)) {
      if (full_ && !face.outer) continue;
      Corners key = face.corners;
      std::ranges::sort(key);
      Face drawn{face.corners, face.element, -1, Side::kOuter};
      if (const auto side = sides_.find(key); side != sides_.end() && !face.outer) {
        drawn.side = side->second;
      }
      if (const auto facet = facets_.find(key); facet != facets_.end()) drawn.facet = facet->second;
      std::array<std::int32_t, 3> middles{-1, -1, -1};
      if (cell_.order == 2) middles = middles_of(face);
      add_triangle(drawn, middles);
    }
  }

  // Mid-side nodes of a tetrahedron's face, of its sides 01, 12, 20.
  [[nodiscard]] std::array<std::int32_t, 3> middles_of(const BoundaryFace& face) const {
    // Node of the edge between two corners, VTK's order.
    constexpr std::array<std::array<std::size_t, 4>, 4> kMiddle{
        {{0, 4, 6, 7}, {4, 0, 5, 8}, {6, 5, 0, 9}, {7, 8, 9, 0}}};
    std::array<std::size_t, 3> local{};
    for (std::size_t i = 0; i < 3; ++i) {
      while (element_node(face.element, local[i]) != face.corners[i]) ++local[i];
    }
    std::array<std::int32_t, 3> middles{};
    for (std::size_t i = 0; i < 3; ++i) {
      middles[i] = element_node(face.element, kMiddle[local[i]][local[(i + 1) % 3]]);
    }
    return middles;
  }

  void find_triangles() {
    for (std::size_t e = 0; e < cell_.element_count(); ++e) {
      Face drawn{{element_node(e, 0), element_node(e, 1), element_node(e, 2)}, e};
      std::array<std::int32_t, 3> middles{-1, -1, -1};
      for (std::size_t i = 0; i < 3 && cell_.order == 2; ++i) middles[i] = element_node(e, 3 + i);
      add_triangle(drawn, middles);
    }
    const auto k = static_cast<std::size_t>(cell_.nodes_per_facet);
    for (std::size_t b = 0; b < cell_.facet_count(); ++b) {
      if (full_ && cell_.boundary_is_higher_image[b] != 0) continue;
      add_lines(cell_.boundary, b, {{}, static_cast<std::int64_t>(b), Side::kOuter, false});
    }
    for (std::size_t i = 0; i < cell_.lower_facets.size() / k && !full_; ++i) {
      add_lines(cell_.lower_facets, i, {{}, -1, Side::kLower, false});
      add_lines(cell_.higher_facets, i, {{}, -1, Side::kHigher, false});
    }
  }

  void add_lines(const std::vector<std::int32_t>& facets, std::size_t i, Line line) {
    const auto k = static_cast<std::size_t>(cell_.nodes_per_facet);
    const std::int32_t a = facets[i * k], b = facets[i * k + 1];
    if (k == 2) {
      line.nodes = {a, b};
      lines_.push_back(line);
      return;
    }
    const std::int32_t middle = facets[i * k + 2];
    line.nodes = {a, middle};
    lines_.push_back(line);
    line.nodes = {middle, b};
    lines_.push_back(line);
  }

  void add_edge(std::int32_t a, std::int32_t b) {
    edges_.push_back({std::min(a, b), std::max(a, b)});
  }

  void add_triangle(Face face, const std::array<std::int32_t, 3>& middles) {
    const Corners c = face.nodes;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t next = c[(i + 1) % 3];
      if (cell_.order == 1) {
        add_edge(c[i], next);
      } else {
        add_edge(c[i], middles[i]);
        add_edge(middles[i], next);
      }
    }
    if (cell_.order == 1) {
      faces_.push_back(face);
      return;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      face.nodes = {c[i], middles[i], middles[(i + 2) % 3]};
      faces_.push_back(face);
    }
    face.nodes = {middles[0], middles[1], middles[2]};
    faces_.push_back(face);
  }

  // Points are those that are drawn, in the frame of the axis.
  void add_points() {
    number_.assign(cell_.nodes.size(), kNone);
    std::vector<Point3> points;
    const RotationTable rotations(cell_.fold);
    const auto take = [&](std::int32_t node) {
      std::uint32_t& number = number_[static_cast<std::size_t>(node)];
      if (number != kNone) return;
      number = static_cast<std::uint32_t>(points.size());
      const OrbitVertex v = cell_.nodes[static_cast<std::size_t>(node)];
      points.push_back(
          rotations.rotate(cell_.orbit_points[static_cast<std::size_t>(v.orbit)], v.exponent));
    };
    for (const Face& face : faces_) {
      for (const std::int32_t node : face.nodes) take(node);
    }
    for (const Line& line : lines_) {
      for (const std::int32_t node : line.nodes) take(node);
    }
    positions_ = document_.add_positions(points);
  }

  [[nodiscard]] std::uint32_t number(std::int32_t node) const {
    return number_[static_cast<std::size_t>(node)];
  }

  // Group of a triangle or line in a sector.
  [[nodiscard]] Group group_of(Side side,
                               std::int64_t facet,
                               std::size_t element,
                               std::int32_t s) const {
    if (side != Side::kOuter) return {side, 0, 0};
    Group group;
    if (facet >= 0) group.marker = cell_.boundary_marker(static_cast<std::size_t>(facet), s);
    group.region = cell_.region(element, s);
    return group;
  }

  std::size_t add_mesh(std::int32_t sector) {
    const std::size_t mesh = document_.add_mesh(full_ ? "sector" : "cell");
    std::map<Group, std::vector<std::uint32_t>> triangles;
    for (const Face& face : faces_) {
      auto& indices = triangles[group_of(face.side, face.facet, face.element, sector)];
      for (const std::int32_t node : face.nodes) indices.push_back(number(node));
    }
    for (const auto& [group, indices] : triangles) {
      add_primitive(mesh, GlbDocument::Shape::kTriangles, indices, face_material(group));
    }
    std::map<Group, std::vector<std::uint32_t>> lines;
    for (const Line& line : lines_) {
      Group group{line.side, 0, 0};
      if (line.facet >= 0) {
        group.marker = cell_.boundary_marker(static_cast<std::size_t>(line.facet), sector);
      }
      for (const std::int32_t node : line.nodes) lines[group].push_back(number(node));
    }
    for (const auto& [group, indices] : lines) {
      add_primitive(mesh, GlbDocument::Shape::kLines, indices, line_material(group));
    }
    std::vector<std::uint32_t> edges;
    edges.reserve(2 * edges_.size());
    for (const auto& edge : edges_) {
      for (const std::int32_t node : edge) edges.push_back(number(node));
    }
    add_primitive(mesh, GlbDocument::Shape::kLines, edges, material("edges", kEdgeColour, false));
    return mesh;
  }

  void add_primitive(std::size_t mesh,
                     GlbDocument::Shape shape,
                     const std::vector<std::uint32_t>& indices,
                     std::size_t material) {
    if (indices.empty()) return;
    document_.add_primitive(mesh, shape, positions_, document_.add_indices(indices), material);
  }

  std::size_t material(const std::string& name, const GlbColour& colour, bool lit) {
    const auto known = materials_.find({name, lit});
    if (known != materials_.end()) return known->second;
    const std::size_t made = document_.add_material(name, colour, lit);
    materials_.emplace(std::pair(name, lit), made);
    return made;
  }

  // The number of a label among those that have been met, 0 being none.
  static GlbColour label_colour(std::vector<std::int32_t>& met, std::int32_t label) {
    if (label == 0) return kPlainColour;
    const auto found = std::ranges::find(met, label);
    const auto number = static_cast<std::size_t>(found - met.begin());
    if (found == met.end()) met.push_back(label);
    return glb_palette(number);
  }

  [[nodiscard]] bool several_regions() const {
    const auto differ = [&](const std::vector<std::int32_t>& regions) {
      return std::ranges::adjacent_find(regions, std::ranges::not_equal_to{}) != regions.end();
    };
    return differ(cell_.regions) || differ(cell_.sector_regions);
  }

  std::size_t face_material(const Group& group) {
    if (group.side == Side::kLower) return material("lower bound", kLowerColour, true);
    if (group.side == Side::kHigher) return material("higher bound", kHigherColour, true);
    if (!solid()) {
      return material(region_name(group.region), label_colour(regions_met_, group.region), true);
    }
    if (!several_regions()) {
      return material(marker_name(cell_, group.marker), label_colour(markers_met_, group.marker),
                      true);
    }
    // Of a group that spans regions: each in its region's colour, a little towards the group's.
    const GlbColour region = label_colour(regions_met_, group.region);
    const GlbColour marker = label_colour(markers_met_, group.marker);
    GlbColour mixed{};
    constexpr double kRegionShare = 0.75;
    for (std::size_t i = 0; i < 3; ++i) {
      mixed[i] =
          std::round(1000 * (kRegionShare * region[i] + (1 - kRegionShare) * marker[i])) / 1000;
    }
    return material(region_name(group.region) + " " + marker_name(cell_, group.marker), mixed,
                    true);
  }

  std::size_t line_material(const Group& group) {
    if (group.side == Side::kLower) return material("lower bound", kLowerColour, false);
    if (group.side == Side::kHigher) return material("higher bound", kHigherColour, false);
    return material(marker_name(cell_, group.marker), label_colour(markers_met_, group.marker),
                    false);
  }

  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  const SymmetryCellMesh& cell_;
  bool full_;
  GlbDocument document_;
  std::unordered_map<Corners, std::int64_t, CornersHash> facets_;
  std::unordered_map<Corners, Side, CornersHash> sides_;
  std::vector<Face> faces_;
  std::vector<Line> lines_;
  std::vector<std::array<std::int32_t, 2>> edges_;
  std::vector<std::uint32_t> number_;  // of a cell node among the points
  std::size_t positions_ = 0;
  std::map<std::pair<std::string, bool>, std::size_t> materials_;
  std::vector<std::int32_t> markers_met_;
  std::vector<std::int32_t> regions_met_;
};

}  // namespace

Result<void> write_glb(const MeshStream& mesh, ByteWriter& out) {
  return GlbWriter(mesh.cell(), mesh.full()).write(out);
}

}  // namespace symcell::internal
