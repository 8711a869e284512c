// The whole pipeline of solids on exact sectors of prisms.
#include "core/solid/mesh_solid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/cell/full_mesh.hpp"
#include "core/geometry/tet_measures.hpp"
#include "core/solid/sector/symmetrise.hpp"
#include "tests/support/solid_sectors.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell::solid {
namespace {

constexpr double kHalfBlock = 0.25;

// `count` blocks on rhombs about the z axis, from the corner of one to that of the next: the
// corners of a ring of radius 1, the middles of its sides moved in and out by the same.
Plc blocks_that_touch(std::int32_t count) {
  Plc plc;
  const double sector = 2 * std::numbers::pi / count;
  const auto polar = [](double r, double angle, double z) {
    return Point3{r * std::cos(angle), r * std::sin(angle), z};
  };
  for (const double z : {0.0, 0.5}) {
    for (std::int32_t i = 0; i < count; ++i) {
      const double middle = std::cos(0.5 * sector);
      plc.vertices.push_back(polar(1, i * sector, z));
      plc.vertices.push_back(polar(middle - kHalfBlock, (i + 0.5) * sector, z));
      plc.vertices.push_back(polar(middle + kHalfBlock, (i + 0.5) * sector, z));
    }
  }
  const std::int32_t up = 3 * count;
  for (std::int32_t i = 0; i < count; ++i) {
    const std::array<std::int32_t, 4> rhomb{3 * i, 3 * i + 2, 3 * ((i + 1) % count), 3 * i + 1};
    PlcFacet bottom{{{rhomb.begin(), rhomb.end()}}, {}, 0}, top = bottom;
    for (std::int32_t& v : top.polygons[0]) v += up;
    plc.facets.push_back(bottom);
    plc.facets.push_back(top);
    for (std::size_t j = 0; j < 4; ++j) {
      const std::int32_t a = rhomb[j], b = rhomb[(j + 1) % 4];
      plc.facets.push_back({{{a, b, b + up, a + up}}, {}, 0});
    }
  }
  return plc;
}

// A drum of three layers over 2 * fold sectors; in the one in the middle every other wedge round the
// axis and the pockets in its rim between the wedges are void: what is left touches itself along
// upright edges, and hangs together above and below them.
Plc drum_with_pockets(std::int32_t fold) {
  const std::int32_t n = 2 * fold, level = 2 * n + 1;
  Plc plc;
  for (const double z : {0.0, 1.0, 2.0, 3.0}) {
    plc.vertices.push_back({0, 0, z});
    for (const double r : {1.0, 2.0}) {
      for (std::int32_t i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        plc.vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
      }
    }
  }
  const auto inner = [&](std::int32_t i) { return 1 + i % n; };
  const auto outer = [&](std::int32_t i) { return 1 + n + i % n; };
  const auto wall = [&](std::int32_t l, std::int32_t a, std::int32_t b) {
    a += l * level;
    b += l * level;
    plc.facets.push_back({{{a, b, b + level, a + level}}, {}, 0});
  };
  for (const std::int32_t z : {0, 3 * level}) {
    PlcFacet disc{{{}}, {}, 0};
    for (std::int32_t i = 0; i < n; ++i) disc.polygons[0].push_back(z + outer(i));
    plc.facets.push_back(disc);
  }
  for (std::int32_t i = 0; i < n; ++i) {
    for (const std::int32_t l : {0, 2}) wall(l, outer(i), outer(i + 1));
    wall(1, inner(i), inner(i + 1));  // between a wedge and the part of the rim beyond it
    wall(1, 0, inner(i));
    wall(1, inner(i), outer(i));
    const bool pocket = i % 2 == 0;
    if (!pocket) wall(1, outer(i), outer(i + 1));
    for (const std::int32_t z : {level, 2 * level}) {
      plc.facets.push_back(
          pocket
              ? PlcFacet{{{z + inner(i), z + outer(i), z + outer(i + 1), z + inner(i + 1)}}, {}, 0}
              : PlcFacet{{{z, z + inner(i), z + inner(i + 1)}}, {}, 0});
    }
    if (!pocket) {
      const Point3 a = plc.vertices[static_cast<std::size_t>(inner(i))];
      const Point3 b = plc.vertices[static_cast<std::size_t>(inner(i + 1))];
      plc.holes.push_back(Point3{0, 0, 1.5} + 0.25 * (a + b));
    }
  }
  return plc;
}

// One sector, or none that can be cut.
class PrismSource final : public SectorSource {
 public:
  explicit PrismSource(const test::PrismSpec& spec, int failing = 0)
      : sector_(test::prism_sector(spec)), failing_(failing) {
    symmetry_.fold = spec.fold;
    symmetry_.diameter = 2.5;
  }
  [[nodiscard]] const Symmetry& symmetry() const override { return symmetry_; }
  [[nodiscard]] const std::vector<std::string>& repairs() const override { return repairs_; }
  [[nodiscard]] std::int32_t candidates() const override { return 3; }
  [[nodiscard]] Result<Sector> sector(std::int32_t index,
                                      ExecutionContext& /*context*/) const override {
    ++asked;
    if (index < failing_) {
      return fail(ErrorCode::kInternal, "cut number " + std::to_string(index) + " fails");
    }
    return sector_;
  }
  [[nodiscard]] Result<std::unique_ptr<SectorSource>> with_fold(std::int32_t,
                                                                ExecutionContext&) const override {
    return fail(ErrorCode::kBadFold, "there is but one fold");
  }
  [[nodiscard]] double volume() const { return sector_.expected_volume; }

  mutable int asked = 0;

 private:
  Sector sector_;
  int failing_;
  Symmetry symmetry_;
  std::vector<std::string> repairs_;
};

// A prism of twelve sides, given as a 12 / corners-fold one.
test::PrismSpec prism(std::int32_t fold, double bore = 0) {
  test::PrismSpec spec;
  spec.fold = fold;
  spec.corners = 12 / fold;
  spec.inner_radius = bore;
  spec.start_angle = 0;
  return spec;
}

Result<MeshOutcome> mesh(const PrismSource& source, const MeshOptions& options) {
  ExecutionContext context;
  context.set_max_elements(options.max_elements);
  return mesh_solid(source, options, context);
}

MeshOptions sized(const PrismSource& source, int elements = 1500) {
  MeshOptions options;
  options.max_volume = source.volume() / elements;
  return options;
}

// Every element positive and within the bounds of size; the volume of the cell.
double check_elements(const SymmetryCellMesh& cell, const MeshOptions& options) {
  const FullMeshView full(cell);
  double volume = 0;
  const auto per = static_cast<std::size_t>(cell.nodes_per_element);
  for (std::size_t e = 0; e < cell.element_count(); ++e) {
    std::array<Point3, 4> x;
    for (std::size_t i = 0; i < 4; ++i) {
      x[i] = full.cell_node_position(static_cast<std::size_t>(cell.elements[e * per + i]));
    }
    const TetMeasures m = measure_tet(x[0], x[1], x[2], x[3]);
    EXPECT_GT(m.volume, 0);
    EXPECT_LE(m.volume, options.max_volume);
    EXPECT_LE(m.longest2, options.max_edge * options.max_edge);
    volume += m.volume;
  }
  return volume;
}

// Tetrahedra over the ratio that nothing in the model exempts.
std::uint64_t left_over(const Statistics& statistics) {
  std::uint64_t sum = 0;
  for (const ExemptCount& e : statistics.exempt) {
    sum += e.reason == "near_small_feature" ? e.elements : 0;
  }
  return sum;
}

// Of the faces between two tetrahedra of the cell, the share that is not locally Delaunay.
double share_not_delaunay(const SymmetryCellMesh& cell) {
  const FullMeshView full(cell);
  std::map<std::array<std::int32_t, 3>, std::vector<std::array<std::size_t, 2>>> faces;
  for (std::size_t e = 0; e < cell.element_count(); ++e) {
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<std::int32_t, 3> f{};
      for (std::size_t j = 0; j < 3; ++j) f[j] = cell.elements[4 * e + (i + 1 + j) % 4];
      std::sort(f.begin(), f.end());
      faces[f].push_back({e, i});
    }
  }
  const auto at = [&](std::size_t e, std::size_t i) {
    return full.cell_node_position(static_cast<std::size_t>(cell.elements[4 * e + i]));
  };
  std::size_t inner = 0, wrong = 0;
  for (const auto& [face, sides] : faces) {
    if (sides.size() != 2) continue;
    ++inner;
    const std::size_t e = sides[0][0];
    const TetMeasures m = measure_tet(at(e, 0), at(e, 1), at(e, 2), at(e, 3));
    const Point3 behind = at(sides[1][0], sides[1][1]);
    wrong += squared_distance(behind, m.centre) < m.radius2 * (1 - 1e-7) ? 1 : 0;
  }
  return static_cast<double>(wrong) / static_cast<double>(inner);
}

class MeshSolidFold : public testing::TestWithParam<std::int32_t> {};
INSTANTIATE_TEST_SUITE_P(Folds, MeshSolidFold, testing::Values(2, 3, 6, 12));

TEST_P(MeshSolidFold, AgreesWithTheWholeModel) {
  for (const double bore : {0.0, 0.5}) {
    const PrismSource source(prism(GetParam(), bore)), whole(prism(1, bore));
    // Round the axis a narrow sector asks for small tetrahedra: less matters in a finer mesh.
    const MeshOptions options = sized(source, GetParam() == 12 ? 6000 : 1500);
    const auto parts = mesh(source, options), one = mesh(whole, options);
    ASSERT_TRUE(parts) << parts.error().message;
    ASSERT_TRUE(one) << one.error().message;
    EXPECT_NEAR(source.volume(), whole.volume(), 1e-12);
    for (const auto* o : {&*parts, &*one}) {
      const double fold = o->mesh.fold;
      EXPECT_NEAR(fold * check_elements(o->mesh, options), source.volume(), 1e-9);
      EXPECT_NEAR(fold * o->statistics.cell.measure, source.volume(), 1e-9);
      EXPECT_LE(50 * left_over(o->statistics), o->statistics.cell.elements);
      if (o->statistics.exempt.empty()) {
        EXPECT_LE(o->statistics.cell.max_radius_edge, 1.414);
      }
    }
    const FullMeshView full(parts->mesh);
    EXPECT_EQ(static_cast<std::uint64_t>(full.element_count()), parts->statistics.full.elements);
    EXPECT_EQ(static_cast<std::uint64_t>(full.node_count()), parts->statistics.full.nodes);
    EXPECT_EQ(full.sectors(), GetParam());
    const auto many = static_cast<double>(full.element_count());
    const auto few = static_cast<double>(one->mesh.element_count());
    // Twelvefold with the axis inside: 2.05 times, and more in coarser meshes.
    EXPECT_LT(many, (GetParam() == 12 && bore == 0 ? 2.2 : 2) * few);
    EXPECT_LT(few, 2 * many);
  }
}

TEST(MeshSolid, StatisticsAreSensible) {
  const PrismSource source(prism(6));
  const auto made = mesh(source, sized(source));
  ASSERT_TRUE(made) << made.error().message;
  const Statistics& s = made->statistics;
  EXPECT_EQ(s.cell.elements, made->mesh.element_count());
  EXPECT_EQ(s.cell.nodes, made->mesh.nodes.size());
  EXPECT_EQ(s.full.elements, 6 * s.cell.elements);
  EXPECT_GT(s.cell.symmetry_nodes, 0U);
  EXPECT_GT(s.cell.symmetry_facets, 0U);
  EXPECT_GT(s.cell.min_dihedral_deg, 5);
  EXPECT_LT(s.cell.max_dihedral_deg, 170);
  EXPECT_GT(s.cell.max_radius_edge, 0.6);  // 0.612 is the regular tetrahedron's
  EXPECT_GT(s.refinement.steiner_points, 0U);
  EXPECT_GT(s.refinement.flips, 0U);
  EXPECT_GT(s.refinement.crossings, 0U);
  EXPECT_GT(s.refinement.relocations, 0U);
  std::uint64_t binned = 0;
  for (const std::uint64_t b : s.cell.aspect_ratio_histogram) binned += b;
  EXPECT_EQ(binned, s.cell.elements);
}

TEST(MeshSolid, SameBytesTwice) {
  const PrismSource source(prism(6, 0.4));
  const auto a = mesh(source, sized(source)), b = mesh(source, sized(source));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->mesh.elements, b->mesh.elements);
  ASSERT_EQ(a->mesh.orbit_points.size(), b->mesh.orbit_points.size());
  EXPECT_EQ(0, std::memcmp(a->mesh.orbit_points.data(), b->mesh.orbit_points.data(),
                           a->mesh.orbit_points.size() * sizeof(Point3)));
}

TEST(MeshSolid, DelaunayOnlyAndPlain) {
  for (const std::int32_t fold : {1, 3, 6}) {
    const PrismSource source(prism(fold));
    MeshOptions options = sized(source);
    const auto improved = mesh(source, options);
    options.delaunay = true;
    const auto delaunay = mesh(source, options);
    options.delaunay = false;
    options.plain = true;
    const auto plain = mesh(source, options);
    ASSERT_TRUE(improved && delaunay && plain);
    EXPECT_EQ(plain->statistics.refinement.relocations, 0U);
    EXPECT_EQ(share_not_delaunay(delaunay->mesh), 0);
    EXPECT_TRUE(delaunay->statistics.delaunay) << fold;
    EXPECT_LT(delaunay->mesh.element_count(),
              1.2 * static_cast<double>(plain->mesh.element_count()));
    EXPECT_GT(improved->statistics.cell.min_dihedral_deg, plain->statistics.cell.min_dihedral_deg);
    EXPECT_LT(improved->mesh.element_count(), plain->mesh.element_count());
    for (const auto* o : {&*improved, &*delaunay, &*plain}) {
      EXPECT_NEAR(fold * check_elements(o->mesh, options), source.volume(), 1e-9);
    }
  }
}

TEST(MeshSolid, SecondOrder) {
  const PrismSource source(prism(6));
  MeshOptions options = sized(source, 600);
  const auto linear = mesh(source, options);
  options.order = 2;
  const auto quadratic = mesh(source, options);
  ASSERT_TRUE(linear && quadratic);
  EXPECT_EQ(quadratic->mesh.nodes_per_element, 10);
  EXPECT_EQ(quadratic->mesh.nodes_per_facet, 6);
  EXPECT_EQ(quadratic->mesh.element_count(), linear->mesh.element_count());
  EXPECT_GT(quadratic->mesh.nodes.size(), 4 * linear->mesh.nodes.size());
  EXPECT_NEAR(6 * check_elements(quadratic->mesh, options), source.volume(), 1e-9);
}

TEST(MeshSolid, LongestEdge) {
  const PrismSource source(prism(6));
  MeshOptions options;
  options.max_edge = 0.3;
  const auto made = mesh(source, options);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_NEAR(6 * check_elements(made->mesh, options), source.volume(), 1e-9);
}

TEST(MeshSolid, TooManyElementsAreRefusedBeforehand) {
  const PrismSource source(prism(6));
  MeshOptions options = sized(source, 2'000'000'000);
  options.max_elements = 1'000'000;
  const auto start = std::chrono::steady_clock::now();
  const auto made = mesh(source, options);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kElementLimit);
  EXPECT_NE(made.error().message.find("max_volume"), std::string::npos);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  // One that only refinement finds out.
  options = sized(source, 3000);
  options.max_elements = 520;
  const auto late = mesh(source, options);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, ErrorCode::kElementLimit);
}

TEST(MeshSolid, AnotherSectorIsTriedAndTheLastFaultTold) {
  const PrismSource second(prism(6), 2);
  EXPECT_TRUE(mesh(second, {}));
  EXPECT_EQ(second.asked, 3);
  const PrismSource none(prism(6), 3);
  const auto made = mesh(none, {});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kTetrahedralizationFailed);
  EXPECT_NE(made.error().message.find("cut number 2 fails"), std::string::npos);
}

TEST(MeshSolid, CancelAndTimeLimit) {
  const PrismSource source(prism(6));
  ExecutionContext cancelled;
  cancelled.cancel();
  const auto a = mesh_solid(source, sized(source), cancelled);
  ASSERT_FALSE(a);
  EXPECT_EQ(a.error().code, ErrorCode::kCancelled);
  ExecutionContext late;
  late.set_time_limit(1e-9);
  const auto b = mesh_solid(source, sized(source), late);
  ASSERT_FALSE(b);
  EXPECT_EQ(b.error().code, ErrorCode::kTimeLimit);
}

// Blocks in a ring, each of which touches the next along an edge: what one does to that edge, the
// other must do as well. They are copies of each other, or two kinds of them.
TEST(MeshSolid, BlocksThatTouchAlongEdges) {
  for (const std::int32_t fold : {1, 2, 3, 6}) {
    for (const std::int32_t order : {1, 2}) {
      SCOPED_TRACE("fold " + std::to_string(fold) + ", order " + std::to_string(order));
      const Plc plc = blocks_that_touch(6);
      MeshOptions options;
      options.fold = fold;
      options.order = order;
      options.max_edge = 0.3;
      ExecutionContext context;
      const auto source = symmetrise_plc(plc, options, context);
      ASSERT_TRUE(source) << source.error().message;
      const auto made = mesh_solid(**source, options, context);
      ASSERT_TRUE(made) << made.error().message;
      EXPECT_NEAR(made->statistics.cell.measure * fold, 6 * kHalfBlock * 0.5, 1e-9);
      const SymmetryCellMesh& cell = made->mesh;
      const auto place = [&](OrbitVertex v) { return std::pair(v.orbit, v.exponent); };
      std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> index;
      for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
        index[place(cell.nodes[i])] = static_cast<std::int32_t>(i);
      }
      for (std::size_t i = 0; i < cell.nodes.size() && fold > 2; ++i) {
        OrbitVertex image = cell.nodes[i];
        image.exponent = (image.exponent + 1) % fold;
        const auto found = index.find(place(image));
        EXPECT_EQ(cell.lower_to_higher[i], found == index.end() ? -1 : found->second);
      }
    }
  }
}

// Both sides of such an edge are in the cell, one turned against the other: no flaw of the cell.
TEST(MeshSolid, TouchesItselfBetweenWholeLayers) {
  for (const std::int32_t fold : {2, 3, 6}) {
    SCOPED_TRACE("fold " + std::to_string(fold));
    MeshOptions options;
    options.fold = fold;
    ExecutionContext context;
    const auto source = symmetrise_plc(drum_with_pockets(fold), options, context);
    ASSERT_TRUE(source) << source.error().message;
    const auto made = mesh_solid(**source, options, context);
    ASSERT_TRUE(made) << made.error().message;
    const double sector = std::sin(std::numbers::pi / fold);
    EXPECT_NEAR(made->statistics.cell.measure, sector * (2 * 4 + 2), 1e-9);
  }
}

// The boundary of a mesh is a better surface to start from: fewer tetrahedra, no more bad ones, and
// the same solid.
TEST(MeshSolid, MeshesItsOwnBoundaryAgain) {
  PrismShape shape;
  shape.fold = 7;
  shape.twist = 0.3;
  shape.layers = 12;
  shape.pieces = 6;
  MeshOptions options;
  options.fold = shape.fold;
  options.axis_origin = Point3{};
  options.axis_direction = Point3{0, 0, 1};
  options.symmetry_tolerance_rel = 3e-3;
  std::uint64_t once_all = 0, again_all = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    ExecutionContext context;
    const auto source = symmetrise_surface(asymmetric_prism(shape, seed), options, context);
    ASSERT_TRUE(source) << source.error().message;
    Tuning tuning;
    const auto again = mesh_solid(**source, options, context, tuning);
    tuning.starts.meshes_again = 0;
    const auto once = mesh_solid(**source, options, context, tuning);
    ASSERT_TRUE(once && again);
    const auto bad = [](const MeshOutcome& outcome) {
      std::uint64_t count = 0;
      for (const auto& e : outcome.statistics.exempt) count += e.elements;
      return count;
    };
    EXPECT_LE(bad(*again), bad(*once));
    EXPECT_NEAR(again->statistics.cell.measure, once->statistics.cell.measure,
                1e-3 * once->statistics.cell.measure);
    once_all += once->statistics.cell.elements;
    again_all += again->statistics.cell.elements;
  }
  EXPECT_LT(again_all, once_all);
}

// A source that finds every boundary too far away once nodes were asked to go to their faces.
class RefusesMoves final : public SectorSource {
 public:
  explicit RefusesMoves(const SectorSource& source) : source_(source) {}

  [[nodiscard]] const Symmetry& symmetry() const override { return source_.symmetry(); }
  [[nodiscard]] const std::vector<std::string>& repairs() const override {
    return source_.repairs();
  }
  [[nodiscard]] std::int32_t candidates() const override { return source_.candidates(); }
  [[nodiscard]] Result<Sector> sector(std::int32_t index,
                                      ExecutionContext& context) const override {
    return source_.sector(index, context);
  }
  [[nodiscard]] Result<std::unique_ptr<SectorSource>> with_fold(
      std::int32_t fold, ExecutionContext& context) const override {
    return source_.with_fold(fold, context);
  }
  [[nodiscard]] Result<void> check_boundary(const SymmetryCellMesh& cell,
                                            ExecutionContext& context) const override {
    if (moved_) return fail(ErrorCode::kInternal, "too far");
    return source_.check_boundary(cell, context);
  }
  [[nodiscard]] std::unique_ptr<CurvedBoundary> curved_boundary(
      const SymmetryCellMesh& cell, const MeshOptions& options) const override {
    moved_ = true;
    return source_.curved_boundary(cell, options);
  }
  [[nodiscard]] Result<void> label_boundary(SymmetryCellMesh& cell,
                                            ExecutionContext& context) const override {
    return source_.label_boundary(cell, context);
  }

 private:
  const SectorSource& source_;
  mutable bool moved_ = false;
};

// A ring with the cylinders that a CAD file would say it has, which its chords' middles are beside.
TriangleSurface cad_ring() {
  TriangleSurface ring = ring_surface(48, 4, 2, 3);
  const auto face = [&](FaceKind kind, double radius, double z) {
    AnalyticSurface s;
    s.kind = kind;
    s.origin = {0, 0, z};
    s.direction = {0, 0, 1};
    s.radius = radius;
    ring.cad_faces.push_back({s, "", -1});
  };
  face(FaceKind::kCylinder, 4, 0);
  face(FaceKind::kCylinder, 2, 0);
  face(FaceKind::kPlane, 0, 3);
  face(FaceKind::kPlane, 0, 0);
  // Two triangles of each a side, in that order.
  for (std::size_t t = 0; t < ring.triangles.size(); ++t) {
    ring.cad_face.push_back(static_cast<std::int32_t>(t / 2 % 4));
  }
  ring.cad_notes.emplace();
  return ring;
}

TEST(MeshSolid, TellsOfMovesOntoFacesThatWereRefused) {
  for (const std::int32_t order : {1, 2}) {
    MeshOptions options;
    options.fold = 8;
    options.axis_origin = Point3{0, 0, 0};
    options.axis_direction = Point3{0, 0, 1};
    options.order = order;
    options.max_edge = 1.2;
    ExecutionContext context;
    const auto source = symmetrise_surface(cad_ring(), options, context);
    ASSERT_TRUE(source) << source.error().message;
    const auto told = [](const MeshOutcome& outcome) {
      return std::ranges::any_of(outcome.statistics.warnings, [](const Warning& w) {
        return w.code == WarningCode::kFacesAsChords &&
               w.text.find("vertices lie beside") != std::string::npos;
      });
    };
    Tuning tuning;
    tuning.starts.meshes_again = 0;
    const auto moved = mesh_solid(**source, options, context, tuning);
    ASSERT_TRUE(moved) << moved.error().message;
    const RefusesMoves refusing(**source);
    const auto left = mesh_solid(refusing, options, context, tuning);
    ASSERT_TRUE(left) << left.error().message;
    ASSERT_TRUE(moved->statistics.curving && left->statistics.curving);
    EXPECT_GT(moved->statistics.curving->vertices, 0U);
    EXPECT_EQ(left->statistics.curving->vertices, 0U);
    EXPECT_GE(left->statistics.curving->left, moved->statistics.curving->vertices);
    EXPECT_TRUE(told(*left)) << order;
  }
}

}  // namespace
}  // namespace symcell::solid
