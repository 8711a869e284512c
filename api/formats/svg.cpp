#include <algorithm>
#include <cmath>
#include <utility>

#include "api/formats/mesh_formats.hpp"

namespace symcell::internal {
namespace {

constexpr double kPixels = 1000;  // the longer side of the picture
constexpr int kDigits = 8;

using Edge = std::pair<std::int32_t, std::int32_t>;

// Coordinates in pixels about the axis; the picture's y axis points down.
class Picture {
 public:
  explicit Picture(const MeshStream& mesh) : mesh_(mesh) {
    const SymmetryCellMesh& cell = mesh.cell();
    double reach = 0;  // of the full mesh about the axis
    Point2 low{1e300, 1e300};
    Point2 high{-1e300, -1e300};
    for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
      const Point2 p = local(i);
      reach = std::max(reach, length(p));
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    if (mesh.full() && cell.fold > 1) {
      low = {-reach, -reach};
      high = {reach, reach};
    }
    const double extent = std::max({high.x - low.x, high.y - low.y, 1e-300});
    scale_ = kPixels / extent;
    left_ = low.x * scale_;
    top_ = -high.y * scale_;
    width_ = (high.x - low.x) * scale_;
    height_ = (high.y - low.y) * scale_;
  }

  void write_head(ByteWriter& out) const {
    const double margin = kPixels / 50;
    out.text("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"");
    for (const double v : {left_ - margin, top_ - margin, width_ + 2 * margin}) {
      out.short_real(v, kDigits);
      out.character(' ');
    }
    out.short_real(height_ + 2 * margin, kDigits);
    out.text("\" stroke-linecap=\"round\" stroke-linejoin=\"round\" fill=\"none\">\n");
  }

  void write_edge(std::int32_t a, std::int32_t b, ByteWriter& out) const {
    write_point('M', a, out);
    write_point('L', b, out);
  }
  void write_point(char command, std::int32_t node, ByteWriter& out) const {
    const Point2 p = local(static_cast<std::size_t>(node));
    out.character(command);
    out.short_real(p.x * scale_, kDigits);
    out.character(' ');
    out.short_real(0.0 - p.y * scale_, kDigits);  // no "-0"
  }

 private:
  // Relative to the axis: no digits are lost on models far from the origin.
  [[nodiscard]] Point2 local(std::size_t node) const {
    const OrbitVertex v = mesh_.cell().nodes[node];
    const Point3& p = mesh_.cell().orbit_points[static_cast<std::size_t>(v.orbit)];
    return mesh_.view().rotations().rotate(Point2{p.x, p.y}, v.exponent);
  }

  const MeshStream& mesh_;
  double scale_ = 1;
  double left_ = 0;
  double top_ = 0;
  double width_ = 0;
  double height_ = 0;
};

// Corner edges of the elements, each once.
std::vector<Edge> unique_edges(const SymmetryCellMesh& cell) {
  std::vector<Edge> edges;
  const auto k = static_cast<std::size_t>(cell.nodes_per_element);
  edges.reserve(cell.element_count() * 3);
  for (std::size_t e = 0; e < cell.element_count(); ++e) {
    for (std::size_t i = 0; i < 3; ++i) {
      edges.push_back(std::minmax(cell.elements[e * k + i], cell.elements[e * k + (i + 1) % 3]));
    }
  }
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

// Paths of bounded length: viewers choke on a path of millions of points.
constexpr std::size_t kEdgesAPath = 2000;

void write_edges(const Picture& picture,
                 std::string_view style,
                 std::span<const Edge> edges,
                 ByteWriter& out) {
  for (std::size_t begin = 0; begin < edges.size(); begin += kEdgesAPath) {
    out.text("<path ");
    out.text(style);
    out.text(" d=\"");
    const auto part = edges.subspan(begin, std::min(kEdgesAPath, edges.size() - begin));
    for (const Edge& e : part) picture.write_edge(e.first, e.second, out);
    out.text("\"/>\n");
  }
}

std::vector<Edge> facet_edges(const SymmetryCellMesh& cell,
                              const std::vector<std::int32_t>& nodes) {
  std::vector<Edge> edges;
  const auto k = static_cast<std::size_t>(cell.nodes_per_facet);
  for (std::size_t i = 0; i + 1 < nodes.size(); i += k) edges.emplace_back(nodes[i], nodes[i + 1]);
  return edges;
}

void write_fill(const Picture& picture, const SymmetryCellMesh& cell, ByteWriter& out) {
  const auto k = static_cast<std::size_t>(cell.nodes_per_element);
  for (std::size_t begin = 0; begin < cell.element_count(); begin += kEdgesAPath) {
    out.text("<path d=\"");
    const std::size_t end = std::min(begin + kEdgesAPath, cell.element_count());
    for (std::size_t e = begin; e < end; ++e) {
      picture.write_point('M', cell.elements[e * k], out);
      picture.write_point('L', cell.elements[e * k + 1], out);
      picture.write_point('L', cell.elements[e * k + 2], out);
      out.character('z');
    }
    out.text("\"/>\n");
  }
}

}  // namespace

void write_svg(const MeshStream& mesh, ByteWriter& out) {
  const SymmetryCellMesh& cell = mesh.cell();
  const Picture picture(mesh);
  picture.write_head(out);
  out.text("<g id=\"fill\" fill=\"#cfe3f7\" stroke=\"none\">\n");
  write_fill(picture, cell, out);
  out.text("</g>\n<g id=\"lines\">\n");
  write_edges(picture, "stroke=\"#7d8b99\" stroke-width=\"0.6\"", unique_edges(cell), out);
  write_edges(picture, "stroke=\"#1b2733\" stroke-width=\"1.8\"", facet_edges(cell, cell.boundary),
              out);
  out.text("</g>\n");
  if (mesh.full()) {
    for (std::int32_t s = 1; s < cell.fold && out.ok(); ++s) {
      out.text("<use href=\"#lines\" transform=\"rotate(");
      // The picture's y axis points down: counter-clockwise is negative.
      out.short_real(-360.0 * s / cell.fold, 17);
      out.text(")\"/>\n");
    }
  }
  write_edges(picture, "stroke=\"#2454d6\" stroke-width=\"2.4\"",
              facet_edges(cell, cell.higher_facets), out);
  write_edges(picture, "stroke=\"#d62424\" stroke-width=\"2.4\"",
              facet_edges(cell, cell.lower_facets), out);
  out.text("</svg>\n");
}

}  // namespace symcell::internal
