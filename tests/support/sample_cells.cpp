#include "tests/support/sample_cells.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace symcell::test {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

Point3 polar(double radius, double angle) {
  return {radius * std::cos(angle), radius * std::sin(angle), 0};
}

void add_edge(std::vector<std::int32_t>& edges, std::int32_t a, std::int32_t b) {
  edges.push_back(a);
  edges.push_back(b);
}

void add_boundary(SymmetryCellMesh& mesh, std::int32_t a, std::int32_t b, std::int32_t marker) {
  add_edge(mesh.boundary, a, b);
  mesh.boundary_markers.push_back(marker);
  mesh.boundary_is_higher_image.push_back(0);
}

void add_triangle(
    SymmetryCellMesh& mesh, std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t region) {
  mesh.elements.insert(mesh.elements.end(), {a, b, c});
  mesh.regions.push_back(region);
}

// Where point `step` of circle `layer` lies, relative to the centre.
Point3 ring_point(const RingShape& s, std::int32_t layer, std::int32_t step) {
  const double t = static_cast<double>(layer) / s.layers;
  const double radius = s.inner_radius + t * (s.outer_radius - s.inner_radius);
  return polar(radius, kTurn * step / (static_cast<double>(s.fold) * s.steps) + t * s.swirl);
}

// Adds the polygon orbit by orbit: point j of each sector is rotated from point j of the first.
void add_polygon(Pslg& model,
                 const std::vector<Point3>& sector,
                 std::int32_t fold,
                 Point2 center,
                 std::int32_t marker) {
  const RotationTable rotations(fold);
  const auto first = static_cast<std::int32_t>(model.vertices.size());
  for (std::int32_t k = 0; k < fold; ++k) {
    for (const Point3& p : sector) {
      const Point2 q = rotations.rotate(Point2{p.x, p.y}, k);
      model.vertices.push_back({center.x + q.x, center.y + q.y});
    }
  }
  const auto count = static_cast<std::int32_t>(model.vertices.size()) - first;
  for (std::int32_t i = 0; i < count; ++i) {
    model.segments.push_back({first + i, first + (i + 1) % count, marker});
  }
}

}  // namespace

SymmetryCellMesh ring_cell(const RingShape& s) {
  SymmetryCellMesh mesh;
  mesh.fold = s.fold;
  mesh.axis_origin = {s.center.x, s.center.y, 0};
  const std::int32_t columns = s.fold == 1 ? s.steps : s.steps + 1;
  for (std::int32_t i = 0; i <= s.layers; ++i) {
    for (std::int32_t j = 0; j < s.steps; ++j) mesh.orbit_points.push_back(ring_point(s, i, j));
    for (std::int32_t j = 0; j < columns; ++j) {
      mesh.nodes.push_back({i * s.steps + j % s.steps, j / s.steps});
      mesh.node_markers.push_back(i == 0 ? 1 : i == s.layers ? 2 : 0);
    }
  }
  mesh.on_axis.assign(mesh.orbit_points.size(), 0);
  const auto node = [&](std::int32_t i, std::int32_t j) { return i * columns + j % columns; };
  for (std::int32_t i = 0; i < s.layers; ++i) {
    for (std::int32_t j = 0; j < s.steps; ++j) {
      add_triangle(mesh, node(i, j), node(i + 1, j), node(i + 1, j + 1), 0);
      add_triangle(mesh, node(i, j), node(i + 1, j + 1), node(i, j + 1), 0);
    }
  }
  for (std::int32_t j = 0; j < s.steps; ++j) {
    add_boundary(mesh, node(0, j), node(0, j + 1), 1);
    add_boundary(mesh, node(s.layers, j), node(s.layers, j + 1), 2);
  }
  mesh.lower_to_higher.assign(mesh.nodes.size(), -1);
  if (s.fold == 1) return mesh;
  for (std::int32_t i = 0; i <= s.layers; ++i) {
    mesh.lower_to_higher[static_cast<std::size_t>(node(i, 0))] = node(i, s.steps);
    if (i == s.layers) break;
    add_edge(mesh.lower_facets, node(i, 0), node(i + 1, 0));
    add_edge(mesh.higher_facets, node(i, s.steps), node(i + 1, s.steps));
  }
  return mesh;
}

Pslg ring_model(const RingShape& s) {
  Pslg model;
  for (const std::int32_t layer : {0, s.layers}) {
    std::vector<Point3> sector;
    for (std::int32_t j = 0; j < s.steps; ++j) sector.push_back(ring_point(s, layer, j));
    add_polygon(model, sector, s.fold, s.center, layer == 0 ? 1 : 2);
  }
  model.holes.push_back(s.center);
  return model;
}

SymmetryCellMesh disc_cell(std::int32_t fold, std::int32_t steps, Point2 center) {
  SymmetryCellMesh mesh;
  mesh.fold = fold;
  mesh.axis_origin = {center.x, center.y, 0};
  mesh.orbit_points.push_back({0, 0, 0});
  mesh.nodes.push_back({0, 0});
  mesh.node_markers.push_back(0);
  mesh.on_axis.push_back(1);
  for (std::int32_t j = 0; j <= steps; ++j) {
    if (j < steps) {
      mesh.orbit_points.push_back(polar(2, kTurn * j / (static_cast<double>(fold) * steps)));
      mesh.on_axis.push_back(0);
    }
    mesh.nodes.push_back({1 + j % steps, j / steps});
    mesh.node_markers.push_back(3);
    if (j == 0) continue;
    add_triangle(mesh, 0, j, j + 1, 7);
    add_boundary(mesh, j, j + 1, 3);
  }
  mesh.lower_facets = {0, 1};
  mesh.higher_facets = {0, steps + 1};
  mesh.lower_to_higher.assign(mesh.nodes.size(), -1);
  mesh.lower_to_higher[0] = 0;
  mesh.lower_to_higher[1] = steps + 1;
  return mesh;
}

Pslg disc_model(std::int32_t fold, std::int32_t steps, Point2 center) {
  Pslg model;
  std::vector<Point3> sector;
  for (std::int32_t j = 0; j < steps; ++j) {
    sector.push_back(polar(2, kTurn * j / (static_cast<double>(fold) * steps)));
  }
  add_polygon(model, sector, fold, center, 3);
  model.regions.push_back(
      {{center.x + 0.25, center.y + 0.125}, 7, std::numeric_limits<double>::infinity()});
  return model;
}

SymmetryCellMesh square_cell() {
  SymmetryCellMesh mesh;
  mesh.orbit_points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.on_axis.assign(4, 0);
  for (std::int32_t i = 0; i < 4; ++i) {
    mesh.nodes.push_back({i, 0});
    mesh.node_markers.push_back(1);
    add_boundary(mesh, i, (i + 1) % 4, i + 1);
  }
  add_boundary(mesh, 0, 2, 5);
  add_triangle(mesh, 0, 1, 2, 1);
  add_triangle(mesh, 0, 2, 3, 2);
  mesh.lower_to_higher.assign(4, -1);
  return mesh;
}

Pslg square_model() {
  Pslg model;
  model.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  model.segments = {{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 4}, {0, 2, 5}};
  model.regions = {{{0.75, 0.25}, 1, std::numeric_limits<double>::infinity()},
                   {{0.25, 0.75}, 2, std::numeric_limits<double>::infinity()}};
  return model;
}

std::vector<Sample> all_samples() {
  RingShape six;
  six.swirl = 0.3;
  RingShape two;
  two.fold = 2;
  two.steps = 6;
  two.center = {10, -4};
  RingShape one;
  one.fold = 1;
  one.steps = 12;
  return {{"ring6", ring_model(six), ring_cell(six)},
          {"ring2", ring_model(two), ring_cell(two)},
          {"ring1", ring_model(one), ring_cell(one)},
          {"disc5", disc_model(5, 2, {0, 0}), disc_cell(5, 2, {0, 0})},
          {"disc3", disc_model(3, 4, {-2, 5}), disc_cell(3, 4, {-2, 5})},
          {"square", square_model(), square_cell()}};
}

}  // namespace symcell::test
