// Signs of lifted predicates against 100 digits: whatever is not kZero is true, and what is zero in
// truth is kZero.
#include "core/plane/quotient/lifted_predicates.hpp"

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include "tests/unit/core/plane/quotient_samples.hpp"

namespace symcell::plane {
namespace {

using Wide = boost::multiprecision::cpp_bin_float_100;
using test::Dice;

struct WidePoint {
  Wide x, y;
};

class LiftedPredicates : public ::testing::TestWithParam<std::int32_t> {
 protected:
  LiftedPredicates() : mesh_(GetParam(), -1) {
    const Wide step = 2 * boost::math::constants::pi<Wide>() / GetParam();
    for (std::int32_t k = 0; k < GetParam(); ++k) {
      turns_.push_back({cos(step * k), sin(step * k)});
    }
  }

  [[nodiscard]] WidePoint lift(OrbitVertex c) const {
    const Point2 p = mesh_.point(c.orbit);
    const WidePoint& e = turns_[static_cast<std::size_t>(c.exponent)];
    return {e.x * p.x - e.y * p.y, e.y * p.x + e.x * p.y};
  }

  [[nodiscard]] int true_orientation(OrbitVertex a, OrbitVertex b, OrbitVertex c) const {
    const WidePoint p = lift(a), q = lift(b), r = lift(c);
    return sign((p.x - r.x) * (q.y - r.y) - (p.y - r.y) * (q.x - r.x));
  }

  [[nodiscard]] int true_in_circle(OrbitVertex a,
                                   OrbitVertex b,
                                   OrbitVertex c,
                                   OrbitVertex d) const {
    const WidePoint o = lift(d);
    Wide m[3][3];
    const OrbitVertex corners[3] = {a, b, c};
    for (int i = 0; i < 3; ++i) {
      const WidePoint p = lift(corners[i]);
      m[i][0] = p.x - o.x;
      m[i][1] = p.y - o.y;
      m[i][2] = m[i][0] * m[i][0] + m[i][1] * m[i][1];
    }
    const Wide determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    return sign(determinant);
  }

  // What is zero to 100 digits is zero: coordinates are near 1.
  static int sign(const Wide& value) {
    if (abs(value) < Wide("1e-80")) return 0;
    return value > 0 ? 1 : -1;
  }

  // Points far apart, nearly on one circle about the centre, nearly on a line, copies of each
  // other.
  void add_points(Dice& dice) {
    for (int i = 0; i < 12; ++i) {
      const double angle = dice.uniform(0, 7), near = i % 3 == 0 ? 1e-15 : 1e-2;
      const double radius = i % 2 == 0 ? 1 + near * dice.uniform(-1, 1) : dice.uniform(0.1, 2);
      mesh_.add_vertex({radius * std::cos(angle), radius * std::sin(angle)}, VertexKind::kFree);
    }
    for (int i = 0; i < 6; ++i) {
      const double x = dice.uniform(0.5, 2);
      mesh_.add_vertex({x, 0.3 * x + 1e-16 * dice.uniform(-1, 1)}, VertexKind::kFree);
    }
  }

  OrbitVertex random_corner(Dice& dice) {
    return {static_cast<VertexId>(dice.below(mesh_.vertex_slots())),
            static_cast<std::int32_t>(dice.below(static_cast<std::size_t>(GetParam())))};
  }

  QuotientTriangulation mesh_;
  std::vector<WidePoint> turns_;
};

TEST_P(LiftedPredicates, OrientationIsNeverWrong) {
  Dice dice(17);
  add_points(dice);
  int certain = 0;
  for (int i = 0; i < 4000; ++i) {
    const OrbitVertex a = random_corner(dice), b = random_corner(dice), c = random_corner(dice);
    const int truth = true_orientation(a, b, c);
    const auto told = static_cast<int>(orientation(mesh_, a, b, c));
    if (told != 0) {
      ++certain;
      ASSERT_EQ(told, truth) << a.orbit << "^" << a.exponent << " " << b.orbit << "^" << b.exponent
                             << " " << c.orbit << "^" << c.exponent;
    }
  }
  EXPECT_GT(certain, 2000);
}

TEST_P(LiftedPredicates, InCircleIsNeverWrong) {
  Dice dice(18);
  add_points(dice);
  int certain = 0;
  for (int i = 0; i < 4000; ++i) {
    const OrbitVertex a = random_corner(dice), b = random_corner(dice), c = random_corner(dice),
                      d = random_corner(dice);
    const int truth = true_in_circle(a, b, c, d);
    const auto told = static_cast<int>(in_circle(mesh_, a, b, c, d));
    if (told != 0) {
      ++certain;
      ASSERT_EQ(told, truth);
    }
  }
  EXPECT_GT(certain, 1000);
}

TEST_P(LiftedPredicates, CopiesOfOneVertexAreCocircular) {
  if (GetParam() < 4) return;
  Dice dice(19);
  add_points(dice);
  for (int i = 0; i < 500; ++i) {
    const OrbitVertex a = random_corner(dice);
    OrbitVertex b = random_corner(dice), c = random_corner(dice), d = random_corner(dice);
    b.orbit = c.orbit = d.orbit = a.orbit;
    EXPECT_EQ(in_circle(mesh_, a, b, c, d), Sign::kZero);
  }
}

// A common rotation of all arguments never turns the sign round.
TEST_P(LiftedPredicates, RepresentativesDoNotMatter) {
  Dice dice(20);
  add_points(dice);
  for (int i = 0; i < 2000; ++i) {
    OrbitVertex c[4];
    for (OrbitVertex& corner : c) corner = random_corner(dice);
    const auto before = static_cast<int>(in_circle(mesh_, c[0], c[1], c[2], c[3]));
    const auto turn = static_cast<std::int32_t>(dice.below(static_cast<std::size_t>(GetParam())));
    for (OrbitVertex& corner : c) corner.exponent = mesh_.add(corner.exponent, turn);
    const auto after = static_cast<int>(in_circle(mesh_, c[0], c[1], c[2], c[3]));
    EXPECT_GE(before * after, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Folds, LiftedPredicates, ::testing::Values(1, 2, 3, 4, 6, 7, 17, 100));

}  // namespace
}  // namespace symcell::plane
