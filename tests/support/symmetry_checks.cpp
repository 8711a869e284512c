#include "tests/support/symmetry_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/plane/input/subdomains.hpp"
#include "core/plane/input/validate_pslg.hpp"
#include "core/plane/symmetry/lifted_check.hpp"

namespace symcell {
namespace {

struct Measures {
  double area = 0;
  double boundary = 0;
};

Measures measures_of(const Pslg& pslg) {
  ExecutionContext context;
  const auto subdomains = plane::make_subdomains(pslg, context);
  EXPECT_TRUE(subdomains) << subdomains.error().message;
  Measures result;
  if (!subdomains) return result;
  for (const plane::Subdomain& face : subdomains->faces) {
    if (face.meshed) result.area += face.area;
  }
  for (const plane::PlanarPiece& piece : subdomains->map.pieces) {
    result.boundary += distance(pslg.vertices[static_cast<std::size_t>(piece.a)],
                                pslg.vertices[static_cast<std::size_t>(piece.b)]);
  }
  return result;
}

void expect_well_formed(const plane::SymmetricPslg& s) {
  const auto orbits = static_cast<std::int32_t>(s.orbit_points.size());
  std::set<std::tuple<std::int32_t, std::int32_t, std::int32_t>> seen;
  for (const plane::SymmetricSegment& segment : s.segments) {
    ASSERT_TRUE(segment.a.orbit >= 0 && segment.a.orbit < orbits);
    ASSERT_TRUE(segment.b.orbit >= 0 && segment.b.orbit < orbits);
    ASSERT_TRUE(segment.b.exponent >= 0 && segment.b.exponent < s.fold);
    EXPECT_EQ(segment.a.exponent, 0);
    EXPECT_NE(segment.a.orbit, s.centre_orbit);
    EXPECT_FALSE(segment.a == segment.b);
    EXPECT_TRUE(segment.b.orbit != s.centre_orbit || segment.b.exponent == 0);
    EXPECT_TRUE(segment.a.orbit != segment.b.orbit || 2 * segment.b.exponent != s.fold);
    EXPECT_TRUE(seen.insert({segment.a.orbit, segment.b.orbit, segment.b.exponent}).second);
  }
  if (s.centre_orbit >= 0) {
    EXPECT_EQ(s.orbit_points[static_cast<std::size_t>(s.centre_orbit)], (Point2{0, 0}));
  }
  const std::size_t copies = s.uniform_markers ? 1 : static_cast<std::size_t>(s.fold);
  EXPECT_EQ(s.segment_markers.size(), s.segments.size() * copies);
}

}  // namespace

void expect_symmetric_invariants(const plane::SymmetricPslg& symmetric, const Pslg& input) {
  expect_well_formed(symmetric);
  if (::testing::Test::HasFatalFailure()) return;
  const Pslg lifted = plane::lift_pslg(symmetric);
  ExecutionContext context;
  const auto valid = plane::validate_pslg(lifted, context);
  EXPECT_TRUE(valid) << valid.error().message;
  const auto subdomains = plane::make_subdomains(lifted, context);
  ASSERT_TRUE(subdomains);
  EXPECT_EQ(subdomains->map.cuts, 0U);
  EXPECT_EQ(subdomains->map.pieces.size(), lifted.segments.size());
  const Measures before = measures_of(input);
  const Measures after = measures_of(lifted);
  const double moved = (symmetric.symmetry_error_rel + 4e-15) * symmetric.diameter +
                       4e-16 * length(symmetric.centre);
  EXPECT_NEAR(after.area, before.area, 2 * moved * before.boundary + 1e-13 * before.area);
}

}  // namespace symcell
