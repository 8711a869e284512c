// Finished cells of both dimensions pass; whatever is damaged in their arrays is found.
#include "core/guard/check_cell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/index.hpp"
#include "core/base/random.hpp"
#include "core/mesh_model.hpp"
#include "core/solid/cut/cut_cell.hpp"
#include "core/solid/mesh_solid.hpp"
#include "core/solid/sector/symmetrise.hpp"
#include "tests/support/plc_builders.hpp"
#include "tests/support/pslg_builders.hpp"
#include "tests/support/solid_samples.hpp"

namespace symcell {
namespace {

struct Sample {
  std::string name;
  SymmetryCellMesh cell;
  BoundaryTopology boundary;  // of solids
};

SymmetryCellMesh planar_cell(const Pslg& model, std::int32_t fold, double max_area) {
  ExecutionContext context;
  MeshOptions options;
  options.fold = fold;
  options.max_area = max_area;
  auto made = mesh_model(model, options, context);
  EXPECT_TRUE(made) << made.error().message;
  return made ? made->mesh : SymmetryCellMesh{};
}

SymmetryCellMesh solid_cell(const Plc& model, std::int32_t fold, double max_volume) {
  ExecutionContext context;
  MeshOptions options;
  options.fold = fold;
  options.max_volume = max_volume;
  const auto source = solid::symmetrise_plc(model, options, context);
  EXPECT_TRUE(source) << source.error().message;
  if (!source) return {};
  auto made = solid::mesh_solid(**source, options, context);
  EXPECT_TRUE(made) << made.error().message;
  return made ? made->mesh : SymmetryCellMesh{};
}

const std::vector<Sample>& samples() {
  static const std::vector<Sample> all = [] {
    std::vector<Sample> result;
    for (const std::int32_t fold : {1, 2, 3, 6}) {
      const std::string n = std::to_string(fold);
      result.push_back({"star " + n, planar_cell(star(6, 2, 1), fold, 0.3), {}});
      result.push_back({"ring " + n, planar_cell(regular_ring(6, 2, 1), fold, 0.3), {}});
      result.push_back({"wheel " + n, planar_cell(spoked_wheel(6, 2), fold, 0.4), {}});
      BoundaryTopology ball, torus;
      ball.shells = torus.shells = 1;
      ball.euler = 2;
      result.push_back({"prism " + n, solid_cell(test::prism(6, 1, 1), fold, 0.05), ball});
      test::PrismShape shape;
      shape.inner_radius = 1;
      shape.inner_facet = true;
      result.push_back(
          {"plated ring " + n, solid_cell(test::prism_model(shape), fold, 0.3), torus});
    }
    return result;
  }();
  return all;
}

const BoundaryTopology* boundary_of(const Sample& s) {
  return s.cell.dimension == 3 ? &s.boundary : nullptr;
}

// The fault's description; empty: none.
std::string fault(const SymmetryCellMesh& cell, const BoundaryTopology* boundary = nullptr) {
  const auto ok = check_cell(cell, boundary);
  return ok ? "" : ok.error().message;
}

class CheckCell : public testing::TestWithParam<std::size_t> {
 protected:
  using Damage = std::function<bool(SymmetryCellMesh&, Random&)>;

  // Damages copies at random places; false: there is no such place. Found without being given what
  // the boundary is to be.
  void expect_found(const Damage& damage, const std::string& word = "", bool told = false) const {
    for (std::uint64_t seed = 0; seed < 25; ++seed) {
      Random random(seed);
      SymmetryCellMesh cell = sample().cell;
      if (!damage(cell, random)) continue;
      const std::string found = fault(cell, told ? boundary_of(sample()) : nullptr);
      EXPECT_NE(found, "") << sample().name << ", seed " << seed;
      EXPECT_NE(found.find(word), std::string::npos) << found;
    }
  }
  [[nodiscard]] const Sample& sample() const { return samples()[GetParam()]; }
};

INSTANTIATE_TEST_SUITE_P(Samples, CheckCell, testing::Range<std::size_t>(0, 20));

std::size_t below(Random& random, std::size_t n) {
  return static_cast<std::size_t>(random.next() % n);
}

std::size_t corners(const SymmetryCellMesh& cell) {
  return static_cast<std::size_t>(cell.nodes_per_element);
}

void erase_facet(SymmetryCellMesh& cell, std::size_t i) {
  const auto d = static_cast<std::ptrdiff_t>(cell.dimension);
  const auto b = static_cast<std::ptrdiff_t>(i);
  cell.boundary.erase(cell.boundary.begin() + d * b, cell.boundary.begin() + d * (b + 1));
  cell.boundary_markers.erase(cell.boundary_markers.begin() + b);
  cell.boundary_is_higher_image.erase(cell.boundary_is_higher_image.begin() + b);
}

void erase_element(SymmetryCellMesh& cell, std::size_t e) {
  const auto c = static_cast<std::ptrdiff_t>(corners(cell));
  const auto i = static_cast<std::ptrdiff_t>(e);
  cell.elements.erase(cell.elements.begin() + c * i, cell.elements.begin() + c * (i + 1));
  cell.regions.erase(cell.regions.begin() + i);
}

TEST_P(CheckCell, GoodCellsPass) {
  ASSERT_GT(sample().cell.element_count(), 4U);
  EXPECT_EQ(fault(sample().cell, boundary_of(sample())), "") << sample().name;
}

TEST_P(CheckCell, FindsTwoCornersSwapped) {
  expect_found([](SymmetryCellMesh& cell, Random& random) {
    const std::size_t first = corners(cell) * below(random, cell.element_count());
    const std::size_t i = below(random, corners(cell));
    std::swap(cell.elements[first + i], cell.elements[first + (i + 1) % corners(cell)]);
    return true;
  });
}

TEST_P(CheckCell, FindsAllTurnedInsideOut) {
  expect_found(
      [](SymmetryCellMesh& cell, Random&) {
        for (std::size_t e = 0; e < cell.element_count(); ++e) {
          std::swap(cell.elements[corners(cell) * e], cell.elements[corners(cell) * e + 1]);
        }
        return true;
      },
      "inside out");
}

TEST_P(CheckCell, FindsAnElementThatIsGone) {
  expect_found([](SymmetryCellMesh& cell, Random& random) {
    erase_element(cell, below(random, cell.element_count()));
    return true;
  });
}

TEST_P(CheckCell, FindsAnElementThatIsThereTwice) {
  expect_found([](SymmetryCellMesh& cell, Random& random) {
    const std::size_t e = below(random, cell.element_count());
    for (std::size_t i = 0; i < corners(cell); ++i) {
      cell.elements.push_back(cell.elements[corners(cell) * e + i]);
    }
    cell.regions.push_back(0);
    return true;
  });
}

TEST_P(CheckCell, FindsACornerAtAnotherNode) {
  expect_found([](SymmetryCellMesh& cell, Random& random) {
    std::int32_t& corner = cell.elements[below(random, cell.elements.size())];
    const auto other = static_cast<std::int32_t>(below(random, cell.nodes.size()));
    return std::exchange(corner, other) != other;
  });
  expect_found(
      [](SymmetryCellMesh& cell, Random& random) {
        cell.elements[below(random, cell.elements.size())] =
            static_cast<std::int32_t>(cell.nodes.size());
        return true;
      },
      "no node");
}

TEST_P(CheckCell, FindsBrokenPairs) {
  expect_found([](SymmetryCellMesh& cell, Random& random) {
    if (cell.lower_facets.empty()) return false;
    cell.lower_to_higher[at(cell.lower_facets[below(random, cell.lower_facets.size())])] = -1;
    return true;
  });
  expect_found(
      [](SymmetryCellMesh& cell, Random& random) {
        auto& image = cell.lower_to_higher[below(random, cell.nodes.size())];
        const auto other = static_cast<std::int32_t>(below(random, cell.nodes.size()));
        if (cell.fold == 1 || image == other) return false;
        if (image < 0) {  // where a node and its image are both there, they may be paired
          const OrbitVertex v =
              cell.nodes[static_cast<std::size_t>(&image - &cell.lower_to_higher[0])];
          const OrbitVertex w = cell.nodes[at(other)];
          if (v.orbit == w.orbit) return false;
        }
        image = other;
        return true;
      },
      "paired");
  expect_found([](SymmetryCellMesh& cell, Random&) {
    cell.lower_to_higher.pop_back();
    return true;
  });
}

TEST_P(CheckCell, FindsHigherFacetsSwapped) {
  expect_found([](SymmetryCellMesh& cell, Random& random) {
    const auto d = static_cast<std::size_t>(cell.dimension);
    const std::size_t count = cell.higher_facets.size() / d;
    if (count < 2) return false;
    const std::size_t i = below(random, count);
    const std::size_t j = (i + 1 + below(random, count - 1)) % count;
    for (std::size_t k = 0; k < d; ++k) {
      std::swap(cell.higher_facets[i * d + k], cell.higher_facets[j * d + k]);
    }
    return true;
  });
}

TEST_P(CheckCell, FindsABoundPairThatIsGoneOrThereTwice) {
  expect_found([](SymmetryCellMesh& cell, Random&) {
    if (cell.lower_facets.empty()) return false;
    cell.lower_facets.resize(cell.lower_facets.size() - static_cast<std::size_t>(cell.dimension));
    cell.higher_facets.resize(cell.lower_facets.size());
    return true;
  });
  expect_found([](SymmetryCellMesh& cell, Random&) {
    if (cell.lower_facets.empty()) return false;
    for (auto* list : {&cell.lower_facets, &cell.higher_facets}) {
      for (std::int32_t k = 0; k < cell.dimension; ++k) list->push_back((*list)[at(k)]);
    }
    return true;
  });
  // The bounds change places.
  expect_found([](SymmetryCellMesh& cell, Random&) {
    if (cell.lower_facets.empty() || cell.fold == 2) return false;
    std::swap(cell.lower_facets, cell.higher_facets);
    return true;
  });
}

// The listed facets that are of one element only and on no bound; the others stand inside.
std::vector<std::size_t> open_facets(const SymmetryCellMesh& cell) {
  std::map<std::vector<std::int32_t>, int> uses;
  const std::size_t c = corners(cell);
  for (std::size_t e = 0; e < cell.element_count(); ++e) {
    for (std::size_t skip = 0; skip < c; ++skip) {
      std::vector<std::int32_t> f;
      for (std::size_t i = 0; i < c; ++i) {
        if (i != skip) f.push_back(cell.elements[e * c + i]);
      }
      std::sort(f.begin(), f.end());
      ++uses[f];
    }
  }
  const auto facet = [&](const std::vector<std::int32_t>& list, std::size_t i) {
    const auto first = list.begin() + static_cast<std::ptrdiff_t>(i) * cell.dimension;
    std::vector<std::int32_t> f(first, first + cell.dimension);
    std::sort(f.begin(), f.end());
    return f;
  };
  for (std::size_t i = 0; i < cell.lower_facets.size() / (c - 1); ++i) {
    ++uses[facet(cell.lower_facets, i)];
    ++uses[facet(cell.higher_facets, i)];
  }
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < cell.facet_count(); ++i) {
    if (uses[facet(cell.boundary, i)] == 1) result.push_back(i);
  }
  return result;
}

TEST_P(CheckCell, FindsABoundaryFacetThatIsGone) {
  const auto open = open_facets(sample().cell);
  for (const std::size_t i : open) {
    SymmetryCellMesh damaged = sample().cell;
    erase_facet(damaged, i);
    EXPECT_NE(fault(damaged).find("open"), std::string::npos);
  }
  EXPECT_GT(open.size(), 2U);
}

TEST_P(CheckCell, FindsABoundaryFacetThatIsNoneOrListedTwice) {
  expect_found([](SymmetryCellMesh& cell, Random& random) {
    const std::size_t i = below(random, cell.facet_count());
    for (std::int32_t k = 0; k < cell.dimension; ++k) {
      cell.boundary.push_back(cell.boundary[i * static_cast<std::size_t>(cell.dimension) + at(k)]);
    }
    cell.boundary_markers.push_back(1);
    cell.boundary_is_higher_image.push_back(cell.boundary_is_higher_image[i]);
    return true;
  });
  expect_found([](SymmetryCellMesh& cell, Random& random) {
    const auto open = open_facets(cell);
    const auto d = static_cast<std::size_t>(cell.dimension);
    std::int32_t& n = cell.boundary[d * open[below(random, open.size())] + below(random, d)];
    const auto other = static_cast<std::int32_t>(below(random, cell.nodes.size()));
    return std::exchange(n, other) != other;
  });
  expect_found([](SymmetryCellMesh& cell, Random& random) {
    std::uint8_t& flag = cell.boundary_is_higher_image[below(random, cell.facet_count())];
    flag = flag != 0 ? 0 : 1;
    return true;
  });
}

TEST_P(CheckCell, FindsNodesThatAreNotWhatTheyShouldBe) {
  expect_found([](SymmetryCellMesh& cell, Random& random) {
    const std::size_t i = below(random, cell.nodes.size()), j = below(random, cell.nodes.size());
    if (i == j) return false;
    cell.nodes[i] = cell.nodes[j];
    return true;
  });
  expect_found(
      [](SymmetryCellMesh& cell, Random& random) {
        cell.nodes[below(random, cell.nodes.size())].exponent =
            random.next() % 2 == 0 ? -1 : cell.fold;
        return true;
      },
      "no copy");
  expect_found(
      [](SymmetryCellMesh& cell, Random&) {
        cell.nodes.push_back({0, 0});
        cell.node_markers.push_back(0);
        cell.lower_to_higher.push_back(-1);
        return true;
      },
      "not used");
  expect_found(
      [](SymmetryCellMesh& cell, Random&) {
        cell.orbit_points.push_back({});
        cell.on_axis.push_back(0);
        return true;
      },
      "no node");
  expect_found([](SymmetryCellMesh& cell, Random& random) {
    cell.orbit_points[below(random, cell.orbit_points.size())].y =
        std::numeric_limits<double>::quiet_NaN();
    return true;
  });
  // Beyond the opposite facet of an element.
  expect_found([](SymmetryCellMesh& cell, Random& random) {
    const std::size_t c = corners(cell), first = c * below(random, cell.element_count());
    const RotationTable rotations(cell.fold);
    const OrbitVertex own = cell.nodes[at(cell.elements[first])];
    Point3 middle;
    for (std::size_t i = 1; i < c; ++i) {
      const OrbitVertex v = cell.nodes[at(cell.elements[first + i])];
      if (v.orbit == own.orbit) return false;
      const double share = 1 / static_cast<double>(c - 1);
      middle = middle + share * rotations.rotate(cell.orbit_points[at(v.orbit)], v.exponent);
    }
    Point3& p = cell.orbit_points[at(own.orbit)];
    p = 2 * rotations.rotate(middle, rotations.reduce(-own.exponent)) - p;
    return true;
  });
}

TEST_P(CheckCell, FindsAnotherTopology) {
  if (sample().cell.dimension == 2) return;
  for (const int which : {0, 1, 2, 3}) {
    BoundaryTopology other = sample().boundary;
    if (which == 0) ++other.shells;
    if (which == 1) other.euler -= 2 * sample().cell.fold;
    if (which == 2) ++other.pinched_edges;
    if (which == 3) other.pinched_vertices = {0};
    EXPECT_NE(fault(sample().cell, &other), "");
  }
}

TEST_P(CheckCell, FindsArraysThatDoNotFit) {
  const std::vector<std::function<void(SymmetryCellMesh&)>> cuts = {
      [](SymmetryCellMesh& c) { c.regions.pop_back(); },
      [](SymmetryCellMesh& c) { c.elements.pop_back(); },
      [](SymmetryCellMesh& c) { c.node_markers.pop_back(); },
      [](SymmetryCellMesh& c) { c.on_axis.pop_back(); },
      [](SymmetryCellMesh& c) { c.boundary.pop_back(); },
      [](SymmetryCellMesh& c) { c.boundary_is_higher_image.pop_back(); },
      [](SymmetryCellMesh& c) { c.sector_regions.push_back(1); },
      [](SymmetryCellMesh& c) { c.lower_facets.push_back(0); },
      [](SymmetryCellMesh& c) { c.boundary.front() = -1; },
  };
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    SymmetryCellMesh damaged = sample().cell;
    cuts[i](damaged);
    EXPECT_NE(fault(damaged), "") << i;
  }
}

// Whether elements round a node, or an edge, do not hang together by faces.
bool has_pinch(const SymmetryCellMesh& cell) {
  std::map<std::vector<std::int32_t>, std::vector<std::size_t>> places;  // nodes and edges
  const auto element = [&](std::size_t e) {
    std::vector<std::int32_t> n(cell.elements.begin() + static_cast<std::ptrdiff_t>(4 * e),
                                cell.elements.begin() + static_cast<std::ptrdiff_t>(4 * e + 4));
    std::sort(n.begin(), n.end());
    return n;
  };
  for (std::size_t e = 0; e < cell.element_count(); ++e) {
    const auto n = element(e);
    for (std::size_t i = 0; i < 4; ++i) {
      places[{n[i]}].push_back(e);
      for (std::size_t j = 0; j < i; ++j) places[{n[j], n[i]}].push_back(e);
    }
  }
  for (const auto& [place, around] : places) {
    std::vector<std::size_t> reached = {around.front()};
    std::set<std::size_t> seen = {around.front()};
    for (std::size_t k = 0; k < reached.size(); ++k) {
      const auto n = element(reached[k]);
      for (const std::size_t e : around) {
        std::vector<std::int32_t> common;
        const auto m = element(e);
        std::set_intersection(n.begin(), n.end(), m.begin(), m.end(), std::back_inserter(common));
        if (common.size() == 3 && seen.insert(e).second) reached.push_back(e);
      }
    }
    if (reached.size() != around.size()) return true;
  }
  return false;
}

// The lower bound for other exponents; false: a tetrahedron stands two sectors from a neighbour.
bool find_lower(const solid::QuotientTetrahedralization& mesh, solid::CellCut& cut) {
  cut.lower.clear();
  for (solid::TetId t = 0; t < mesh.tet_slots(); ++t) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const solid::HalfFace g = mesh.tet(t).nb[i];
      if (g == solid::kNoHalfFace) continue;
      const std::int32_t behind = mesh.add(cut.exponent[t], mesh.tet(t).off[i]);
      const std::int32_t ahead = mesh.subtract(cut.exponent[solid::tet_of(g)], behind);
      if (ahead == 1) cut.lower.push_back(4 * t + i);
      if (ahead != 0 && ahead != 1 && ahead != mesh.fold() - 1) return false;
    }
  }
  return true;
}

// Every element of a small cell in the sector before or after: the cell is refused if it pinches,
// and only then.
TEST(CheckCellPinches, AnElementInAnotherSector) {
  int pinched = 0, sound = 0;
  for (const std::int32_t fold : {3, 4, 6}) {
    for (const double bore : {0.0, 1.0}) {
      test::PrismShape shape;
      shape.fold = fold;
      shape.steps = 2;
      shape.rings = 2;
      shape.layers = 2;
      shape.inner_radius = bore;
      const solid::InitialTetrahedralization solid = test::prism(shape);
      ExecutionContext context;
      const auto cut = solid::cut_cell(solid.mesh, context);
      ASSERT_TRUE(cut) << cut.error().message;
      solid::Symmetry symmetry;
      symmetry.fold = fold;
      BoundaryTopology boundary;
      boundary.shells = 1;
      boundary.euler = bore > 0 ? 0 : 2;
      for (solid::TetId t = 0; t < solid.mesh.tet_slots(); ++t) {
        for (const std::int32_t by : {1, fold - 1}) {
          solid::CellCut moved = *cut;
          moved.exponent[t] = solid.mesh.add(moved.exponent[t], by);
          if (!find_lower(solid.mesh, moved)) continue;
          const SymmetryCellMesh cell = solid::build_cell_mesh(solid, moved, symmetry);
          const std::string found = fault(cell, &boundary);
          const bool pinch = has_pinch(cell);
          ++(pinch ? pinched : sound);
          EXPECT_EQ(found != "", pinch) << "fold " << fold << ", element " << t << ": " << found;
          EXPECT_EQ(pinch, found.find("touch there only") != std::string::npos) << found;
        }
      }
    }
  }
  EXPECT_GT(pinched, 50);
  EXPECT_GT(sound, 20);
}

}  // namespace
}  // namespace symcell
