#include "tests/support/block_meshes.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace symcell::test {
namespace {

// Numbers lattice points in order of first use.
class Lattice {
 public:
  std::int32_t number(const Block& p) {
    const auto [at, fresh] = numbers_.try_emplace(p, static_cast<std::int32_t>(points_.size()));
    if (fresh) points_.push_back({1.0 * p[0], 1.0 * p[1], 1.0 * p[2]});
    return at->second;
  }
  [[nodiscard]] const std::vector<Point3>& points() const { return points_; }

 private:
  std::map<Block, std::int32_t> numbers_;
  std::vector<Point3> points_;
};

Block moved(Block p, std::size_t axis, std::int32_t by) {
  p[axis] += by;
  return p;
}

// f(corners in order round the side, counter-clockwise seen from outside) for every side of a cube
// that no other cube has. Corners 0 and 2 are the lowest and the highest.
template <class F>
void each_outer_side(const Blocks& cubes, F f) {
  for (const Block& cube : cubes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const std::int32_t up : {0, 1}) {
        if (std::ranges::find(cubes, moved(cube, axis, up == 0 ? -1 : 1)) != cubes.end()) continue;
        const Block low = moved(cube, axis, up);
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::array<Block, 4> side{low, moved(low, u, 1), moved(moved(low, u, 1), v, 1),
                                  moved(low, v, 1)};
        if (up == 0) std::swap(side[1], side[3]);
        f(side);
      }
    }
  }
}

MeshData finished(MeshData mesh) {
  const auto count = static_cast<std::int32_t>(mesh.element_count());
  mesh.regions.assign(mesh.element_count(), 0);
  mesh.sectors.assign(mesh.element_count(), 0);
  for (std::int32_t e = 0; e < count; ++e) mesh.cell_elements.push_back(e);
  mesh.lower_to_higher.assign(mesh.points.size(), -1);
  return mesh;
}

}  // namespace

Blocks all_blocks(const Block& sizes, const Blocks& without) {
  Blocks blocks;
  for (std::int32_t i = 0; i < sizes[0]; ++i) {
    for (std::int32_t j = 0; j < sizes[1]; ++j) {
      for (std::int32_t k = 0; k < std::max(sizes[2], 1); ++k) {
        const Block block{i, j, k};
        if (std::ranges::find(without, block) == without.end()) blocks.push_back(block);
      }
    }
  }
  return blocks;
}

MeshData square_mesh(const Blocks& squares) {
  MeshData mesh;
  Lattice lattice;
  for (const Block& low : squares) {
    const std::int32_t a = lattice.number(low), b = lattice.number(moved(low, 0, 1));
    const std::int32_t c = lattice.number(moved(moved(low, 0, 1), 1, 1));
    const std::int32_t d = lattice.number(moved(low, 1, 1));
    mesh.elements.insert(mesh.elements.end(), {a, b, c, a, c, d});
  }
  mesh.points = lattice.points();
  return finished(std::move(mesh));
}

MeshData cube_mesh(const Blocks& cubes) {
  MeshData mesh;
  mesh.dimension = 3;
  mesh.nodes_per_element = 4;
  Lattice lattice;
  // Along the edges from the lowest to the highest corner in each order of the axes.
  constexpr std::array<std::array<std::size_t, 3>, 6> kPaths{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {2, 1, 0}, {0, 2, 1}}};
  for (const Block& low : cubes) {
    for (std::size_t path = 0; path < kPaths.size(); ++path) {
      std::array<std::int32_t, 4> nodes{};
      Block at = low;
      nodes[0] = lattice.number(at);
      for (std::size_t i = 0; i < 3; ++i) {
        at = moved(at, kPaths[path][i], 1);
        nodes[i + 1] = lattice.number(at);
      }
      if (path >= 3) std::swap(nodes[1], nodes[2]);
      mesh.elements.insert(mesh.elements.end(), nodes.begin(), nodes.end());
    }
  }
  mesh.points = lattice.points();
  return finished(std::move(mesh));
}

MeshData quadratic(const MeshData& mesh) {
  // Corner pairs of the mid nodes, as VTK has them.
  constexpr std::array<std::array<std::size_t, 2>, 6> kEdges{
      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  const std::size_t corners = static_cast<std::size_t>(mesh.dimension) + 1;
  const std::size_t edges = mesh.dimension == 2 ? 3 : 6;
  MeshData result = mesh;
  result.order = 2;
  result.nodes_per_element = static_cast<std::int32_t>(corners + edges);
  result.elements.clear();
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> mids;
  for (std::size_t at = 0; at < mesh.elements.size(); at += corners) {
    const std::int32_t* nodes = &mesh.elements[at];
    result.elements.insert(result.elements.end(), nodes, nodes + corners);
    for (std::size_t i = 0; i < edges; ++i) {
      const auto ends = std::minmax(nodes[kEdges[i][0]], nodes[kEdges[i][1]]);
      const auto [mid, fresh] =
          mids.try_emplace(ends, static_cast<std::int32_t>(result.points.size()));
      result.elements.push_back(mid->second);
      if (!fresh) continue;
      result.points.push_back(0.5 * (mesh.points[static_cast<std::size_t>(ends.first)] +
                                     mesh.points[static_cast<std::size_t>(ends.second)]));
      result.lower_to_higher.push_back(-1);
    }
  }
  return result;
}

Pslg square_model(const Blocks& squares) {
  Pslg model;
  Lattice lattice;
  for (const Block& low : squares) {
    for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
      for (const std::int32_t up : {0, 1}) {
        const Block beside = moved(low, axis, up == 0 ? -1 : 1);
        if (std::ranges::find(squares, beside) != squares.end()) continue;
        const Block start = moved(low, axis, up);
        model.segments.push_back(
            {lattice.number(start), lattice.number(moved(start, 1 - axis, 1)), 0});
      }
    }
  }
  for (const Point3& p : lattice.points()) model.vertices.push_back({p.x, p.y});
  return model;
}

Plc cube_plc(const Blocks& cubes) {
  Plc model;
  Lattice lattice;
  each_outer_side(cubes, [&](const std::array<Block, 4>& side) {
    std::vector<std::int32_t> polygon;
    for (const Block& p : side) polygon.push_back(lattice.number(p));
    model.facets.push_back({{polygon}, {}, 0});
  });
  model.vertices = lattice.points();
  return model;
}

TriangleSurface cube_surface(const Blocks& cubes) {
  TriangleSurface surface;
  Lattice lattice;
  each_outer_side(cubes, [&](const std::array<Block, 4>& side) {
    std::array<std::int32_t, 4> v{};
    for (std::size_t i = 0; i < 4; ++i) v[i] = lattice.number(side[i]);
    surface.triangles.push_back({v[0], v[1], v[2]});
    surface.triangles.push_back({v[0], v[2], v[3]});
  });
  surface.vertices = lattice.points();
  return surface;
}

}  // namespace symcell::test
