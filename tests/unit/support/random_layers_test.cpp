// The random solids of stacked prisms are what they claim: valid, of their volume and topology, and
// symmetric.
#include "tests/support/random_layers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/geometry/indexed_surface.hpp"
#include "core/geometry/self_intersections.hpp"
#include "core/solid/plc/validate_plc.hpp"
#include "core/solid/sector/symmetrise.hpp"
#include "tests/support/sector_grid.hpp"

namespace symcell {
namespace {

using test::make_random_layers;

TEST(SectorGrid, CellsAreSeenFromTheirMiddlesAndEdgesLieBetween) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    const auto grid = test::make_sector_grid(random, 1 + static_cast<std::int32_t>(seed % 12));
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + grid.description);
    const auto at = [](std::int32_t i) { return static_cast<std::size_t>(i); };
    for (std::size_t c = 0; c < grid.cells.size(); ++c) {
      const auto& corners = grid.cells[c].corners;
      const Point2 middle = grid.middle(static_cast<std::int32_t>(c));
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::int32_t p = corners[i], q = corners[(i + 1) % corners.size()];
        EXPECT_GT(cross(grid.points[at(p)] - middle, grid.points[at(q)] - middle), 0);
        EXPECT_GE(grid.edge_between(p, q), 0);
      }
    }
    std::map<std::int32_t, std::set<std::int32_t>> on_line;
    for (const auto& e : grid.edges) {
      const Point2 a = grid.points[at(e.a)], b = grid.points[at(e.b)];
      EXPECT_TRUE(e.left >= 0 || e.right >= 0);
      if (e.left >= 0) {
        EXPECT_GT(cross(b - a, grid.middle(e.left) - a), 0);
      }
      if (e.right >= 0) {
        EXPECT_LT(cross(b - a, grid.middle(e.right) - a), 0);
      }
      on_line[e.line].insert({e.a, e.b});
    }
    for (const auto& [line, points] : on_line) {
      const Point2 a = grid.points[at(*points.begin())], b = grid.points[at(*points.rbegin())];
      for (const std::int32_t p : points) {
        EXPECT_LE(std::abs(cross(b - a, grid.points[at(p)] - a)), 1e-14);
      }
    }
  }
}

TEST(RandomLayers, ModelsAreValidAndAsTold) {
  std::map<std::string, int> seen;
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    test::RandomLayersOptions options;
    options.tabs = seed % 4 == 0;
    const auto model = make_random_layers(seed, options);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + model.description);
    ExecutionContext context;
    const auto valid = solid::validate_plc(model.plc, context);
    if (!valid) {  // an edge ends beside another one by rounding
      EXPECT_EQ(valid.error().code, ErrorCode::kSelfIntersection) << valid.error().message;
      ++refused;
      continue;
    }
    EXPECT_NEAR(valid->cells.volume, model.volume, 1e-9 * model.volume);
    const auto topology = test::boundary_topology(*valid);
    EXPECT_EQ(topology.pieces, model.boundary->pieces);
    EXPECT_EQ(topology.euler, model.boundary->euler);
    for (const char* word : {"pinched", "cavities", "divided", "arms", "thin", "fan", "bore",
                             "tapered", "1-fold", "rectangles", "materials"}) {
      if (model.description.find(word) != std::string::npos) ++seen[word];
    }
    for (const PlcFacet& f : model.plc.facets) {
      if (f.holes.size() > 1) ++seen["facets with several holes"];
      if (!f.holes.empty()) ++seen["facets with holes"];
    }
  }
  for (const auto& [word, count] : seen) {
    RecordProperty(word, count);
    EXPECT_GE(count, 5) << word;
  }
  EXPECT_EQ(seen.size(), 13u);
  EXPECT_LE(refused, 2);
}

TEST(RandomLayers, ModelsAreSymmetric) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const auto model = make_random_layers(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + model.description);
    ExecutionContext context;
    MeshOptions options;
    options.fold = model.fold;
    options.axis_origin = model.axis_origin;
    options.axis_direction = model.axis_direction;
    const auto source = solid::symmetrise_plc(model.plc, options, context);
    if (!source) {
      ADD_FAILURE() << error_code_name(source.error().code) << ": " << source.error().message;
      continue;
    }
    EXPECT_LE((*source)->symmetry().error_rel, 1e-10);
  }
}

// Triangles by their corners' places: what files say, whose triangles stand apart.
IndexedSurface welded(const TriangleSurface& surface) {
  IndexedSurface result;
  std::map<std::array<double, 3>, std::int32_t> index;
  for (Triangle t : surface.triangles) {
    for (std::int32_t& v : t) {
      const Point3 p = surface.vertices[static_cast<std::size_t>(v)];
      const auto [place, fresh] =
          index.try_emplace({p.x, p.y, p.z}, static_cast<std::int32_t>(result.points.size()));
      if (fresh) result.points.push_back(p);
      v = place->second;
    }
    result.triangles.push_back(t);
  }
  return result;
}

TEST(RandomLayers, SurfacesAreClosedAndAsTold) {
  std::size_t several = 0, handles = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    test::RandomLayersOptions options;
    options.tabs = seed % 4 == 0;
    const auto model = test::make_random_layer_surface(seed, options);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + model.description);
    const IndexedSurface s = welded(model.surface);
    const auto uses = sorted_edge_uses(s.triangles);
    for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
      EXPECT_EQ(end - begin, 2u);
      EXPECT_NE(uses[begin].forward, uses[end - 1].forward);
    });
    const auto found = test::boundary_topology(model.surface);
    EXPECT_EQ(found.pieces, model.boundary->pieces);
    EXPECT_EQ(found.euler, model.boundary->euler);
    EXPECT_NEAR(enclosed_volume(s, s.points.front()), model.volume, 1e-9 * model.volume);
    ExecutionContext context;
    const auto crossing = self_intersections(s, 1, context);
    ASSERT_TRUE(crossing);
    EXPECT_TRUE(crossing->empty());
    several += found.pieces > 1 ? 1 : 0;
    handles += found.euler < 2 ? 1 : 0;
  }
  EXPECT_GE(several, 20u);
  EXPECT_GE(handles, 50u);
}

}  // namespace
}  // namespace symcell
