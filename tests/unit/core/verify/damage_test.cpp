// verify_mesh on meshes of blocks that are damaged in one way each: the check that is for it fails,
// and the mesh before passes all. Damage that the symmetry has no part in; fold 1.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <string>

#include "core/verify/verify_mesh.hpp"
#include "tests/support/block_meshes.hpp"

namespace symcell {
namespace {

using test::all_blocks;
using test::Blocks;

std::set<std::string> failed(const MeshData& mesh, const Model* model) {
  std::set<std::string> names;
  for (const Check& c : verify_mesh(mesh, &mesh, model, {}).checks) {
    if (c.status == Check::Status::kFail) names.insert(c.name);
  }
  return names;
}

std::string shown(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += name + " ";
  return text;
}

void expect_good(const MeshData& mesh, const Model& model) {
  EXPECT_EQ(shown(failed(mesh, &model)), "");
}

void expect_found(const char* check, const MeshData& mesh, const Model* model) {
  const auto names = failed(mesh, model);
  EXPECT_TRUE(names.contains(check)) << check << " not among " << shown(names);
}

// Takes out elements, the nodes that no other has, and mends what goes by elements and nodes.
MeshData without(const MeshData& mesh, const std::set<std::size_t>& elements) {
  MeshData result = mesh;
  result.elements.clear();
  result.points.clear();
  std::vector<std::int32_t> renamed(mesh.points.size(), -1);
  const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    if (elements.contains(e)) continue;
    for (std::size_t i = 0; i < k; ++i) {
      const auto node = static_cast<std::size_t>(mesh.elements[e * k + i]);
      if (renamed[node] < 0) {
        renamed[node] = static_cast<std::int32_t>(result.points.size());
        result.points.push_back(mesh.points[node]);
      }
      result.elements.push_back(renamed[node]);
    }
  }
  const std::size_t count = result.element_count();
  result.regions.resize(count);
  result.sectors.assign(count, 0);
  result.cell_elements.resize(count);
  for (std::size_t e = 0; e < count; ++e) {
    result.cell_elements[e] = static_cast<std::int32_t>(e);
  }
  result.lower_to_higher.assign(result.points.size(), -1);
  return result;
}

// Divides an element at the middle of its facet opposite a corner: what lies beyond is not updated.
MeshData cracked(const MeshData& mesh, std::size_t element, std::size_t opposite) {
  const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
  std::array<std::int32_t, 4> nodes{};
  for (std::size_t i = 0; i < k; ++i) nodes[i] = mesh.elements[element * k + i];
  MeshData result = mesh;
  const auto middle = static_cast<std::int32_t>(mesh.points.size());
  Point3 sum;
  for (std::size_t i = 0; i < k; ++i) {
    if (i != opposite) sum = sum + mesh.points[static_cast<std::size_t>(nodes[i])];
  }
  result.points.push_back((1.0 / static_cast<double>(k - 1)) * sum);
  result.lower_to_higher.push_back(-1);
  bool first = true;
  for (std::size_t i = 0; i < k; ++i) {
    if (i == opposite) continue;
    std::array<std::int32_t, 4> part = nodes;
    part[i] = middle;
    if (first) {
      std::copy_n(part.begin(), k,
                  result.elements.begin() + static_cast<std::ptrdiff_t>(element * k));
      first = false;
      continue;
    }
    result.cell_elements.push_back(static_cast<std::int32_t>(result.element_count()));
    result.elements.insert(result.elements.end(), part.begin(),
                           part.begin() + static_cast<std::ptrdiff_t>(k));
    result.regions.push_back(0);
    result.sectors.push_back(0);
  }
  return result;
}

const Blocks kVertexPair{{0, 0, 0}, {1, 1, 1}};
const Blocks kEdgePair{{0, 0, 0}, {1, 1, 0}};
const Blocks kApart{{0, 0, 0}, {3, 0, 0}};
const Blocks kU = all_blocks({3, 2, 1}, {{1, 1, 0}});
const Blocks kShell = all_blocks({3, 3, 3}, {{1, 1, 1}});
const Blocks kRing = all_blocks({3, 3, 0}, {{1, 1, 0}});

// Models whose cavities are holes by their seeds.
Pslg planar_model(const Blocks& squares) {
  Pslg model = test::square_model(squares);
  if (squares == kRing) model.holes.push_back({1.5, 1.5});
  return model;
}
Plc plc_model(const Blocks& cubes) {
  Plc model = test::cube_plc(cubes);
  if (cubes == kShell) model.holes.push_back({1.5, 1.5, 1.5});
  return model;
}

TEST(VerifyDamage, GoodSquaresPass) {
  for (const Blocks& squares :
       {all_blocks({1, 1, 0}), all_blocks({3, 3, 0}), kRing, kEdgePair, kApart}) {
    const Model model = planar_model(squares);
    expect_good(test::square_mesh(squares), model);
    expect_good(test::quadratic(test::square_mesh(squares)), model);
  }
}

TEST(VerifyDamage, GoodCubesPass) {
  for (const Blocks& cubes :
       {all_blocks({1, 1, 1}), all_blocks({2, 2, 2}), kU, kShell, kVertexPair, kEdgePair, kApart}) {
    const MeshData mesh = test::cube_mesh(cubes);
    const Model plc = plc_model(cubes);
    const Model surface = test::cube_surface(cubes);
    for (const MeshData& each : {mesh, test::quadratic(mesh)}) {
      expect_good(each, plc);
      expect_good(each, surface);
    }
  }
}

// A lid of no thickness on a pocket bounds nothing; the pocket's own walls do.
TEST(VerifyDamage, WallsOfNoThickness) {
  const Blocks pocketed = all_blocks({3, 3, 3}, {{1, 1, 2}});
  TriangleSurface surface = test::cube_surface(pocketed);
  const std::array<Point3, 4> lid = {{{1, 1, 3}, {2, 1, 3}, {2, 2, 3}, {1, 2, 3}}};
  const auto first = static_cast<std::int32_t>(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(), lid.begin(), lid.end());
  for (const std::array<std::int32_t, 3>& t :
       {std::array<std::int32_t, 3>{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}}) {
    surface.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  const Model model = std::move(surface);
  expect_good(test::cube_mesh(pocketed), model);
  // What else is missing is found.
  expect_found("model.on_surface", test::cube_mesh(all_blocks({3, 3, 3}, {{1, 1, 2}, {0, 0, 0}})),
               &model);
  expect_found("model.covered", test::cube_mesh(all_blocks({3, 3, 3}, {{1, 1, 2}, {0, 0, 0}})),
               &model);
}

// The model's own pinches exempt those of the mesh; nothing else does.
TEST(VerifyDamage, PinchesThatTheModelHasNot) {
  const MeshData squares = test::square_mesh(kEdgePair);
  EXPECT_EQ(shown(failed(squares, nullptr)), "cell.vertex_links full.vertex_links ");
  const Model planar = test::square_model(all_blocks({2, 2, 0}));
  expect_found("full.vertex_links", squares, &planar);

  const MeshData at_vertex = test::cube_mesh(kVertexPair);
  EXPECT_EQ(shown(failed(at_vertex, nullptr)), "cell.vertex_links full.vertex_links ");
  const MeshData at_edge = test::cube_mesh(kEdgePair);
  const char* const all = "cell.edge_links cell.vertex_links full.edge_links full.vertex_links ";
  EXPECT_EQ(shown(failed(at_edge, nullptr)), all);
  for (const Model& model : {Model(test::cube_plc(all_blocks({2, 2, 2}))),
                             Model(test::cube_surface(all_blocks({2, 2, 2})))}) {
    expect_found("full.vertex_links", at_vertex, &model);
    expect_found("full.edge_links", at_edge, &model);
    expect_found("cell.edge_links", at_edge, &model);
  }
}

TEST(VerifyDamage, HangingNodes) {
  const MeshData squares = cracked(test::square_mesh(all_blocks({3, 3, 0})), 8, 1);
  EXPECT_EQ(shown(failed(squares, nullptr)), "full.hanging_nodes ");
  const Model planar = test::square_model(all_blocks({3, 3, 0}));
  expect_found("full.hanging_nodes", squares, &planar);
  expect_found("model.boundary", squares, &planar);

  const Blocks cubes = all_blocks({3, 3, 3});
  // A face inside the middle cube, far from the surface.
  const MeshData crack = cracked(test::cube_mesh(cubes), std::size_t{6} * 13, 1);
  EXPECT_EQ(shown(failed(crack, nullptr)), "full.hanging_nodes ");
  const Model plc = test::cube_plc(cubes);
  expect_found("full.hanging_nodes", crack, &plc);
  expect_found("model.boundary", crack, &plc);
  const Model surface = test::cube_surface(cubes);
  expect_found("model.topology", crack, &surface);
  expect_found("model.on_surface", crack, &surface);
}

TEST(VerifyDamage, MissingElements) {
  const Blocks cubes = all_blocks({3, 3, 3});
  const Model plc = test::cube_plc(cubes);
  const Model surface = test::cube_surface(cubes);
  const MeshData notched = without(test::cube_mesh(cubes), {0});
  expect_found("model.volume", notched, &plc);
  expect_found("model.facets", notched, &plc);
  expect_found("model.boundary", notched, &plc);
  expect_found("model.covered", notched, &surface);
  const MeshData hollow = without(test::cube_mesh(cubes), {std::size_t{6} * 13});
  expect_found("model.volume", hollow, &plc);
  expect_found("model.boundary", hollow, &plc);
  expect_found("model.topology", hollow, &surface);

  const MeshData squares = without(test::square_mesh(all_blocks({3, 3, 0})), {8});
  const Model planar = test::square_model(all_blocks({3, 3, 0}));
  expect_found("model.area", squares, &planar);
  expect_found("model.boundary", squares, &planar);
}

// The top of a cube with two opposite corners raised, divided along the other diagonal than the model's:
// all nodes and middles of faces are within the tolerance of 1.7e-3, the middle of the diagonal is not.
TEST(VerifyDamage, FacesThatBulgeBetweenTheirMiddles) {
  constexpr double kRaised = 2.2e-3;
  MeshData mesh = test::cube_mesh(all_blocks({1, 1, 1}));
  TriangleSurface surface = test::cube_surface(all_blocks({1, 1, 1}));
  for (std::vector<Point3>* points : {&mesh.points, &surface.vertices}) {
    for (Point3& p : *points) p.z += p.z > 0 && p.x == p.y ? kRaised : 0;
  }
  std::vector<std::size_t> top;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& v = surface.triangles[t];
    if (std::all_of(v.begin(), v.end(),
                    [&](std::int32_t i) { return surface.vertices[i].z > 0.5; })) {
      top.push_back(t);
    }
  }
  ASSERT_EQ(top.size(), 2U);
  TriangleSurface other = surface;
  const auto [a, b, c] = surface.triangles[top[0]];
  const std::int32_t d = surface.triangles[top[1]][2];
  ASSERT_TRUE(a != d && b != d && c != d);  // the square is a, b, c, d, divided by a and c
  other.triangles[top[0]] = {a, b, d};
  other.triangles[top[1]] = {b, c, d};
  const std::array<Model, 2> models{surface, other};
  const bool first = failed(mesh, &models[0]).empty();
  expect_good(mesh, models[first ? 0 : 1]);
  expect_found("model.on_surface", mesh, &models[first ? 1 : 0]);
}

TEST(VerifyDamage, MeshedVoids) {
  const Model plc = test::cube_plc(kU);
  const MeshData filled = test::cube_mesh(all_blocks({3, 2, 1}));
  expect_found("model.boundary_complete", filled, &plc);
  expect_found("model.boundary", filled, &plc);
  expect_found("model.volume", filled, &plc);
  const Model surface = test::cube_surface(kU);
  expect_found("model.volume", filled, &surface);
  const Model shell = test::cube_surface(kShell);
  expect_found("model.topology", test::cube_mesh(all_blocks({3, 3, 3})), &shell);

  const Model planar = test::square_model(all_blocks({3, 2, 0}, {{1, 1, 0}}));
  const MeshData squares = test::square_mesh(all_blocks({3, 2, 0}));
  expect_found("model.boundary_complete", squares, &planar);
  expect_found("model.area", squares, &planar);
}

// A tetrahedron laid across the gap between two arms, from an edge of one to an edge of the other.
TEST(VerifyDamage, ElementAcrossAGap) {
  MeshData mesh = test::cube_mesh(kU);
  const auto node = [&](const Point3& p) {
    return static_cast<std::int32_t>(std::ranges::find(mesh.points, p) - mesh.points.begin());
  };
  const std::array<std::int32_t, 4> across{node({1, 2, 1}), node({1, 1, 0}), node({2, 2, 0}),
                                           node({2, 2, 1})};
  mesh.elements.insert(mesh.elements.end(), across.begin(), across.end());
  mesh.regions.push_back(0);
  mesh.sectors.push_back(0);
  mesh.cell_elements.push_back(static_cast<std::int32_t>(mesh.element_count()) - 1);
  const Model plc = test::cube_plc(kU);
  expect_found("model.boundary", mesh, &plc);
  expect_found("full.edge_links", mesh, &plc);
  const Model surface = test::cube_surface(kU);
  expect_found("full.edge_links", mesh, &surface);
  expect_found("model.on_surface", mesh, &surface);
}

TEST(VerifyDamage, Pieces) {
  const Model planar = test::square_model(kApart);
  expect_found("full.pieces", test::square_mesh({kApart[0]}), &planar);
  for (const Model& model : {Model(test::cube_plc(kApart)), Model(test::cube_surface(kApart))}) {
    expect_found("full.pieces", test::cube_mesh({kApart[0]}), &model);
    expect_found("full.pieces", test::cube_mesh(all_blocks({4, 1, 1})), &model);
  }
  // A cavity is no piece.
  const Model shell = test::cube_surface(kShell);
  EXPECT_FALSE(failed(test::cube_mesh(kShell), &shell).contains("full.pieces"));
}

TEST(VerifyDamage, Vertices) {
  Pslg planar = test::square_model(all_blocks({2, 2, 0}));
  planar.vertices.push_back({1.25, 0.75});
  const Model loose = planar;
  expect_found("model.vertices", test::square_mesh(all_blocks({2, 2, 0})), &loose);
  Plc plc = test::cube_plc(all_blocks({2, 2, 2}));
  plc.vertices.push_back({1.25, 0.75, 0.5});
  const Model solid = plc;
  expect_found("model.vertices", test::cube_mesh(all_blocks({2, 2, 2})), &solid);
  // Outside the domain nothing is needed.
  planar.vertices.back() = {5, 5};
  const Model outside = planar;
  EXPECT_FALSE(
      failed(test::square_mesh(all_blocks({2, 2, 0})), &outside).contains("model.vertices"));
}

TEST(VerifyDamage, Duplicates) {
  // Two cubes that share a place and no node: the same place but for rounding.
  MeshData mesh = test::cube_mesh(all_blocks({2, 1, 1}));
  const std::int32_t shared = mesh.elements[3];  // the corner opposite the first one
  mesh.points.push_back(mesh.points[static_cast<std::size_t>(shared)] + Point3{1e-15, 0, 0});
  mesh.lower_to_higher.push_back(-1);
  for (std::size_t i = 24; i < mesh.elements.size(); ++i) {
    if (mesh.elements[i] == shared) {
      mesh.elements[i] = static_cast<std::int32_t>(mesh.points.size()) - 1;
    }
  }
  expect_found("cell.duplicates", mesh, nullptr);
}

TEST(VerifyDamage, RegionsAndTheirBounds) {
  Plc plc = test::cube_plc(all_blocks({2, 1, 1}));
  plc.regions.push_back({{0.3, 0.4, 0.45}, 0, 1.0});
  const MeshData mesh = test::cube_mesh(all_blocks({2, 1, 1}));
  expect_good(mesh, plc);
  plc.regions[0].max_volume = 0.1;  // an element has 1/6
  const Model tight = plc;
  EXPECT_EQ(shown(failed(mesh, &tight)), "model.region_measure ");
  MeshData other = mesh;
  other.regions[8] = 3;
  plc.regions[0].max_volume = 1;
  const Model wide = plc;
  EXPECT_EQ(shown(failed(other, &wide)), "model.region_borders ");

  Pslg planar = test::square_model(all_blocks({2, 1, 0}));
  planar.regions.push_back({{0.3, 0.4}, 0, 0.2});
  const Model small = planar;
  EXPECT_EQ(shown(failed(test::square_mesh(all_blocks({2, 1, 0})), &small)),
            "model.region_measure ");
}

TEST(VerifyDamage, MidNodes) {
  const MeshData good = test::quadratic(test::cube_mesh(all_blocks({1, 1, 1})));
  // Two mid nodes of one edge, at one place but for rounding.
  MeshData two = good;
  two.points.push_back(two.points[static_cast<std::size_t>(two.elements[4])] + Point3{1e-8, 0, 0});
  two.lower_to_higher.push_back(-1);
  two.elements[4] = static_cast<std::int32_t>(two.points.size()) - 1;
  const auto names = failed(two, nullptr);
  EXPECT_TRUE(names.contains("cell.mid_nodes")) << shown(names);
  MeshData moved = good;
  moved.points.back().x += 1e-4;
  expect_found("cell.mid_nodes", moved, nullptr);
  // The mid node of one edge given to another, in every element; no element has both.
  MeshData shared = good;
  const auto node = [&](const Point3& p) {
    return static_cast<std::int32_t>(std::ranges::find(good.points, p) - good.points.begin());
  };
  std::ranges::replace(shared.elements, node({0, 0.5, 0}), node({0.5, 0, 0}));
  shared = without(shared, {});
  expect_found("cell.mid_nodes", shared, nullptr);
}

}  // namespace
}  // namespace symcell
