#include "core/plane/refine/criteria.hpp"

#include <numbers>

#include "tests/unit/core/plane/quotient_samples.hpp"

namespace symcell::plane {
namespace {

using test::QuotientSample;

constexpr double kRadian = std::numbers::pi / 180;

Criteria criteria_of(const QuotientSample& sample, const MeshOptions& options) {
  return Criteria(sample.start.mesh, sample.start.subdomains, options);
}

MeshOptions with_angle(double degrees) {
  MeshOptions options;
  options.min_angle_deg = degrees;
  return options;
}

// The isosceles triangle over the unit edge with these angles at it.
Assessment assess_isosceles(const Criteria& criteria, double base_deg) {
  return criteria.assess({0, 0}, {1, 0}, {0.5, 0.5 * std::tan(base_deg * kRadian)}, 0);
}

TEST(Criteria, AnglesAreJudgedAtTheBound) {
  const QuotientSample sample = test::wheel(6, false);
  const Criteria criteria = criteria_of(sample, with_angle(30));
  EXPECT_EQ(assess_isosceles(criteria, 30.001).verdict, Verdict::kGood);
  EXPECT_EQ(assess_isosceles(criteria, 29.999).verdict, Verdict::kAngle);
  EXPECT_EQ(assess_isosceles(criteria, 74.999).verdict, Verdict::kGood);   // apex 30.002
  EXPECT_EQ(assess_isosceles(criteria, 75.001).verdict, Verdict::kAngle);  // apex 29.998
  EXPECT_EQ(assess_isosceles(criteria, 80).shortest, 2U);
  EXPECT_DOUBLE_EQ(assess_isosceles(criteria, 80).shortest2, 1);
  const Criteria none = criteria_of(sample, with_angle(0));
  EXPECT_EQ(assess_isosceles(none, 0.01).verdict, Verdict::kGood);
}

TEST(Criteria, SizesAreJudgedAtTheBound) {
  const QuotientSample sample = test::wheel(6, false);
  MeshOptions options = with_angle(20);
  options.max_area = std::sqrt(3.0) / 4 * 1.001;
  EXPECT_EQ(assess_isosceles(criteria_of(sample, options), 60).verdict, Verdict::kGood);
  options.max_area = std::sqrt(3.0) / 4 * 0.999;
  EXPECT_EQ(assess_isosceles(criteria_of(sample, options), 60).verdict, Verdict::kSize);
  options.max_area = kInfinity;
  options.max_edge = 1.001;
  EXPECT_EQ(assess_isosceles(criteria_of(sample, options), 60).verdict, Verdict::kGood);
  options.max_edge = 0.999;
  EXPECT_EQ(assess_isosceles(criteria_of(sample, options), 60).verdict, Verdict::kSize);
}

TEST(Criteria, TheLensIsWhereTheSegmentIsSeenUnderAWideAngle) {
  const QuotientSample sample = test::wheel(6, false);
  test::Dice dice(1);
  for (const double bound : {20.0, 30.0, 38.0}) {
    const Criteria criteria = criteria_of(sample, with_angle(bound));
    for (int i = 0; i < 2000; ++i) {
      const Point2 a{dice.uniform(-1, 1), dice.uniform(-1, 1)},
          b{dice.uniform(-1, 1), dice.uniform(-1, 1)}, p{dice.uniform(-1, 1), dice.uniform(-1, 1)};
      const double seen = std::abs(std::atan2(cross(a - p, b - p), dot(a - p, b - p))) / kRadian;
      if (std::abs(seen - (180 - 2 * bound)) < 1e-3) continue;
      EXPECT_EQ(criteria.in_lens(a, b, p), seen > 180 - 2 * bound) << seen;
    }
  }
}

TEST(Criteria, TipsOfAStarAreExempt) {
  // Tips of 12 degrees.
  const double tip = 10, notch = tip * std::sin(6 * kRadian) / std::sin((180 - 6 - 36) * kRadian);
  const QuotientSample sample = test::triangulated(star(5, tip, notch), 5);
  const QuotientTriangulation& mesh = sample.start.mesh;
  const Criteria criteria = criteria_of(sample, with_angle(30));
  int exempt = 0;
  for (const TriangleId t : test::live_triangles(mesh)) {
    const Assessment a = criteria.assess(mesh, mesh.triangle(t));
    exempt += a.verdict == Verdict::kAngle &&
                      criteria.exemption(mesh, t, a) == Exemption::kSmallInputAngle
                  ? 1
                  : 0;
  }
  EXPECT_GE(exempt, 1);
  const Criteria lax = criteria_of(sample, with_angle(11));
  for (const TriangleId t : test::live_triangles(mesh)) {
    const Assessment a = lax.assess(mesh, mesh.triangle(t));
    EXPECT_NE(lax.exemption(mesh, t, a), Exemption::kSmallInputAngle);
  }
}

TEST(Criteria, TheCentreIsExemptOnlyWhereTheFoldForbidsTheBound) {
  const auto exemption = [](std::int32_t fold, bool spokes, double bound) {
    const QuotientSample sample = test::wheel(fold, spokes);
    const QuotientTriangulation& mesh = sample.start.mesh;
    const Criteria criteria = criteria_of(sample, with_angle(bound));
    const TriangleId t = test::live_triangles(mesh).front();
    return criteria.exemption(mesh, t, criteria.assess(mesh, mesh.triangle(t)));
  };
  EXPECT_EQ(exemption(24, false, 30), Exemption::kFoldAngleAtCentre);
  EXPECT_EQ(exemption(24, false, 14), Exemption::kNone);
  // Between a spoke and its own next copy is the fold's angle, no corner of the input.
  EXPECT_EQ(exemption(24, true, 30), Exemption::kFoldAngleAtCentre);
  EXPECT_EQ(exemption(5, false, 30), Exemption::kNone);
}

// Sectors of exactly the bound can be met, and must not be refined without end.
TEST(Criteria, SectorsOfExactlyTheBoundAreGood) {
  for (const auto& [fold, bound] : {std::pair{12, 30.0}, {18, 20.0}, {10, 36.0}, {9, 40.0}}) {
    const QuotientSample sample = test::wheel(fold, false);
    const Criteria criteria = criteria_of(sample, with_angle(bound));
    const QuotientTriangulation& mesh = sample.start.mesh;
    EXPECT_FALSE(criteria.is_bad(mesh, test::live_triangles(mesh).front()))
        << fold << " sectors at " << bound << " degrees";
  }
}

}  // namespace
}  // namespace symcell::plane
