#include "core/cell/measure_cell.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/cell/full_mesh.hpp"
#include "core/geometry/quadratic_tet.hpp"
#include "core/geometry/tet_figures.hpp"

namespace symcell {
namespace {

constexpr double kBinEdges[kAspectBins - 1] = {1.5, 2, 2.5, 3, 4, 6, 10, 15};

std::size_t aspect_bin(double aspect) {
  return static_cast<std::size_t>(
      std::upper_bound(std::begin(kBinEdges), std::end(kBinEdges), aspect) - std::begin(kBinEdges));
}

void count(const SymmetryCellMesh& cell, const FullMeshView& full, Statistics& statistics) {
  Statistics::Cell& c = statistics.cell;
  c = {};
  c.elements = cell.element_count();
  c.nodes = cell.nodes.size();
  for (const std::int32_t image : cell.lower_to_higher) c.symmetry_nodes += image >= 0 ? 1 : 0;
  c.symmetry_facets = cell.lower_facets.size() / static_cast<std::size_t>(cell.nodes_per_facet);
  statistics.full.elements = static_cast<std::uint64_t>(full.element_count());
  statistics.full.nodes = static_cast<std::uint64_t>(full.node_count());
}

// Between the straight sides of a quadratic triangle and its sides.
double area_beside_chords(const SymmetryCellMesh& cell,
                          const FullMeshView& full,
                          std::size_t first) {
  Point2 p[6];
  for (std::size_t i = 0; i < 6; ++i) {
    const Point3 q = full.cell_node_position(static_cast<std::size_t>(cell.elements[first + i]));
    p[i] = {q.x, q.y};
  }
  double area = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 a = p[i], side = p[(i + 1) % 3] - a;
    area += 2.0 / 3.0 * cross(p[3 + i] - a - 0.5 * side, side);
  }
  return area;
}

}  // namespace

void measure_cell_2(const SymmetryCellMesh& cell, Statistics& statistics) {
  const FullMeshView full(cell);
  count(cell, full, statistics);
  Statistics::Cell& c = statistics.cell;
  double smallest = std::numbers::pi, largest = 0;
  const auto stride = static_cast<std::size_t>(cell.nodes_per_element);
  for (std::size_t e = 0; e < cell.element_count(); ++e) {
    Point2 p[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 q =
          full.cell_node_position(static_cast<std::size_t>(cell.elements[e * stride + i]));
      p[i] = {q.x, q.y};
    }
    const double doubled = cross(p[1] - p[0], p[2] - p[0]);
    double shortest2 = squared_distance(p[0], p[1]), longest2 = shortest2, product = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point2 u = p[(i + 1) % 3] - p[i], v = p[(i + 2) % 3] - p[i];
      const double angle = std::atan2(cross(u, v), dot(u, v));
      smallest = std::min(smallest, angle);
      largest = std::max(largest, angle);
      const double edge2 = squared_length(u);
      shortest2 = std::min(shortest2, edge2);
      longest2 = std::max(longest2, edge2);
      product *= std::sqrt(edge2);
    }
    c.measure += 0.5 * doubled;
    if (cell.order == 2) c.measure += area_beside_chords(cell, full, e * stride);
    const double circumradius = product / (2 * doubled);
    c.max_radius_edge = std::max(c.max_radius_edge, circumradius / std::sqrt(shortest2));
    ++c.aspect_ratio_histogram[aspect_bin(longest2 / doubled)];
  }
  c.min_angle_deg = smallest * 180 / std::numbers::pi;
  c.max_angle_deg = largest * 180 / std::numbers::pi;
}

void measure_cell_3(const SymmetryCellMesh& cell, Statistics& statistics) {
  const FullMeshView full(cell);
  count(cell, full, statistics);
  Statistics::Cell& c = statistics.cell;
  std::vector<Point3> place(cell.nodes.size());
  for (std::size_t i = 0; i < place.size(); ++i) place[i] = full.cell_node_position(i);

  TetFigures worst;
  worst.face_cot_max = worst.dihedral_cot_max = -std::numeric_limits<double>::infinity();
  worst.face_cot_min = worst.dihedral_cot_min = std::numeric_limits<double>::infinity();
  const auto stride = static_cast<std::size_t>(cell.nodes_per_element);
  for (std::size_t at = 0; at < cell.elements.size(); at += stride) {
    std::array<Point3, 4> p;
    for (std::size_t i = 0; i < 4; ++i)
      p[i] = place[static_cast<std::size_t>(cell.elements[at + i])];
    const TetFigures f = tet_figures(p);
    if (cell.order == 2) {
      QuadraticTet q;
      for (std::size_t i = 0; i < 10; ++i) {
        q[i] = place[static_cast<std::size_t>(cell.elements[at + i])];
      }
      c.measure += is_straight(q) ? f.volume : volume_of(jacobian_coefficients(q));
    } else {
      c.measure += f.volume;
    }
    c.max_radius_edge = std::max(c.max_radius_edge, f.radius_edge);
    ++c.aspect_ratio_histogram[aspect_bin(f.aspect)];
    worst.face_cot_max = std::max(worst.face_cot_max, f.face_cot_max);
    worst.face_cot_min = std::min(worst.face_cot_min, f.face_cot_min);
    worst.dihedral_cot_max = std::max(worst.dihedral_cot_max, f.dihedral_cot_max);
    worst.dihedral_cot_min = std::min(worst.dihedral_cot_min, f.dihedral_cot_min);
  }
  c.min_angle_deg = degrees_of_cotangent(worst.face_cot_max);
  c.max_angle_deg = degrees_of_cotangent(worst.face_cot_min);
  c.min_dihedral_deg = degrees_of_cotangent(worst.dihedral_cot_max);
  c.max_dihedral_deg = degrees_of_cotangent(worst.dihedral_cot_min);
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in kilobytes
}

}  // namespace symcell
