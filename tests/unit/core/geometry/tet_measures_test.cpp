// Measures of a tetrahedron on a given face against those of its four corners.
#include "core/geometry/tet_measures.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/base/random.hpp"

namespace symcell {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(TetMeasures, OfALinkAreThoseOfTheCorners) {
  Random random(3);
  const auto point = [&] { return Point3{random.uniform(), random.uniform(), random.uniform()}; };
  int inverted = 0;
  for (int i = 0; i < 2000; ++i) {
    const double scale = std::exp2(static_cast<double>(i % 40) - 20);
    const Point3 p = scale * point(), a = scale * point(), b = scale * point(), c = scale * point();
    const LinkTet t(p, LinkFace(a, b, c), -kInfinite);
    const double sine = min_dihedral_sine(p, a, b, c);
    EXPECT_NEAR(t.sine, sine, 1e-10);
    inverted += sine < 0 ? 1 : 0;
    const TetMeasures m = measure_tet(p, a, b, c);
    EXPECT_NEAR(t.measures.volume, m.volume, 1e-12 * scale * scale * scale);
    EXPECT_NEAR(t.measures.shortest2, m.shortest2, 1e-12 * scale * scale);
    EXPECT_NEAR(t.measures.longest2, m.longest2, 1e-12 * scale * scale);
    if (std::abs(sine) > 0.01) {
      EXPECT_NEAR(t.measures.radius2 / m.radius2, 1, 1e-9);
    }
  }
  EXPECT_GT(inverted, 500);
}

TEST(TetMeasures, OfALinkEndWhereTheShapeWillNotDo) {
  const LinkFace face({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const LinkTet good({0.3, 0.3, -0.8}, face, 0.1), poor({0.3, 0.3, -0.01}, face, 0.1);
  EXPECT_GT(good.sine, 0.1);
  EXPECT_GT(good.measures.volume, 0);
  EXPECT_LE(poor.sine, 0.1);
  EXPECT_EQ(poor.measures.volume, 0);
}

// What is left out of the work changes neither what passes a least shape nor what is then measured.
TEST(TetMeasures, OfALinkPassALeastShapeAsWithoutOne) {
  Random random(5);
  const auto point = [&] { return Point3{random.uniform(), random.uniform(), random.uniform()}; };
  int passed = 0;
  for (int i = 0; i < 20'000; ++i) {
    const LinkFace face(point(), point(), point());
    const Point3 p = point();
    const LinkTet all(p, face, -kInfinite);
    // Limits at the shape itself and next to it, too.
    for (const double least : {0.0, 0.1, 0.3, all.sine, std::nextafter(all.sine, 0.0)}) {
      if (least < 0) continue;
      const LinkTet t(p, face, least);
      ASSERT_EQ(t.sine > least, all.sine > least);
      if (!(t.sine > least)) continue;
      ++passed;
      ASSERT_EQ(t.sine, all.sine);
      ASSERT_EQ(t.measures.radius2, all.measures.radius2);
    }
  }
  EXPECT_GT(passed, 5'000);
}

TEST(TetMeasures, OfFlatLinksAreInfinite) {
  const LinkTet flat({0.2, 0.2, 0}, LinkFace({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), -kInfinite);
  EXPECT_EQ(flat.sine, 0);
  EXPECT_EQ(flat.measures.radius2, kInfinite);
  const LinkTet degenerate({0, 0, 0}, LinkFace({0, 0, 0}, {1, 0, 0}, {2, 0, 0}), -kInfinite);
  EXPECT_EQ(degenerate.sine, -1);
}

}  // namespace
}  // namespace symcell
