// Facets, segments and kinds of vertices of a sector.
#include "core/solid/sector/quotient_to_sector.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace symcell::solid {
namespace {

// The unit cube, its faces in the order bottom, top, and round; vertex 8 on the top.
QuotientSurface cube(Point3 on_top) {
  QuotientSurface s;
  s.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1},
              {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, on_top};
  s.on_axis.assign(s.points.size(), 0);
  s.on_cut.assign(s.points.size(), 0);
  s.planes = {{{0, 0, -1}, 0}, {{0, 0, 1}, 1}, {{0, -1, 0}, 0},
              {{1, 0, 0}, 1},  {{0, 1, 0}, 1}, {{-1, 0, 0}, 0}};
  return s;
}

void add(QuotientSurface& s, std::int32_t patch, std::array<std::int32_t, 3> t) {
  s.triangles.push_back({OrbitVertex{t[0], 0}, {t[1], 0}, {t[2], 0}});
  s.normals.push_back(s.planes[static_cast<std::size_t>(patch)].normal);
  s.patch.push_back(patch);
  s.frame.push_back(0);
}

void add_sides_but_front(QuotientSurface& s) {
  add(s, 0, {0, 2, 1});
  add(s, 0, {0, 3, 2});
  add(s, 3, {1, 2, 6});
  add(s, 3, {1, 6, 5});
  add(s, 4, {2, 3, 7});
  add(s, 4, {2, 7, 6});
  add(s, 5, {3, 0, 4});
  add(s, 5, {3, 4, 7});
}

std::int32_t segment_of(const Sector& sector, std::int32_t a, std::int32_t b) {
  for (const SectorEdge& e : sector.edges) {
    if ((e.a == a && e.b == b) || (e.a == b && e.b == a)) return e.segment;
  }
  return -1;
}

TEST(QuotientToSector, AVertexInTheMiddleOfAnEdgeIsOnItsSegment) {
  QuotientSurface s = cube({0.5, 0, 1});
  add_sides_but_front(s);
  add(s, 2, {0, 1, 8});
  add(s, 2, {0, 8, 4});
  add(s, 2, {1, 5, 8});
  add(s, 1, {4, 8, 7});
  add(s, 1, {8, 6, 7});
  add(s, 1, {8, 5, 6});
  const auto sector = quotient_to_sector(s);
  ASSERT_TRUE(sector) << sector.error().message;
  EXPECT_EQ(sector->kinds[8], SectorVertexKind::kOnSegment);
  EXPECT_EQ(segment_of(*sector, 4, 8), segment_of(*sector, 8, 5));
}

// Two patches in nearly one plane have a corner in common that is no point of a line: taken for one, it
// was merged along it, and the facet between lost its outline.
TEST(QuotientToSector, ACornerBetweenTwoPatchesOfNearlyOnePlaneIsFixed) {
  QuotientSurface s = cube({0.5, 0.3, 1});
  s.planes.push_back({{0, 1e-9, 1}, 1});
  add_sides_but_front(s);
  add(s, 2, {0, 1, 5});
  add(s, 2, {0, 5, 4});
  add(s, 6, {4, 5, 8});
  add(s, 1, {5, 6, 8});
  add(s, 1, {6, 7, 8});
  add(s, 1, {7, 4, 8});
  const auto sector = quotient_to_sector(s);
  ASSERT_TRUE(sector) << sector.error().message;
  EXPECT_EQ(sector->kinds[8], SectorVertexKind::kFixed);
  EXPECT_NE(segment_of(*sector, 4, 8), -1);
  EXPECT_NE(segment_of(*sector, 4, 8), segment_of(*sector, 8, 5));
}

}  // namespace
}  // namespace symcell::solid
