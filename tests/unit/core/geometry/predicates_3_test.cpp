// Laws of the exact predicates of space, on generators that are near-degenerate on purpose, against
// multi-precision arithmetic, with a tally of the stage that decided.
#include "core/geometry/predicates_3.hpp"

#include <gtest/gtest.h>

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <random>

#include "core/solid/quotient/lifted_predicates.hpp"

namespace symcell {
namespace {

using Integer = boost::multiprecision::cpp_int;
using Exact3 = std::array<Integer, 3>;

class PointSource {
 public:
  explicit PointSource(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }

  Point3 generic() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }
  Point3 grid() {
    const auto g = [this] { return static_cast<double>(integer(-3, 3)); };
    return {g(), g(), g()};
  }
  Point3 near_plane(Point3 a, Point3 b, Point3 c) {
    return nudge(a + uniform(-2, 2) * (b - a) + uniform(-2, 2) * (c - a));
  }
  Point3 near_unit_sphere() {
    const Point3 p = generic();
    return nudge((1 / length(p)) * p);
  }
  Point3 nudge(Point3 p) {
    const auto move = [this](double x) {
      const int steps = integer(-2, 2);
      for (int i = 0; i < std::abs(steps); ++i) x = std::nextafter(x, steps < 0 ? -9e99 : 9e99);
      return x;
    };
    return {move(p.x), move(p.y), move(p.z)};
  }

 private:
  std::mt19937_64 engine_;
};

// Doubles as integers in units of 2^-`bits`: exact while |x| >= 2^(52 - bits) or x = 0.
Exact3 exact(Point3 p, int bits) {
  const auto to = [bits](double x) {
    int exponent = 0;
    const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
    const int shift = exponent - 53 + bits;
    return shift >= 0 ? Integer(mantissa) << shift : Integer(mantissa) >> -shift;
  };
  return {to(p.x), to(p.y), to(p.z)};
}
Exact3 minus(const Exact3& a, const Exact3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Integer triple(const Exact3& a, const Exact3& b, const Exact3& c) {
  return (a[1] * b[2] - a[2] * b[1]) * c[0] + (a[2] * b[0] - a[0] * b[2]) * c[1] +
         (a[0] * b[1] - a[1] * b[0]) * c[2];
}
Sign sign_of(const Integer& x) {
  return x > 0 ? Sign::kPositive : x < 0 ? Sign::kNegative : Sign::kZero;
}

Sign brute_orientation(const std::array<Point3, 4>& p, int bits) {
  const Exact3 a = exact(p[0], bits);
  return sign_of(triple(minus(exact(p[1], bits), a), minus(exact(p[2], bits), a),
                        minus(exact(p[3], bits), a)));
}
// The lifted determinant by minors of the last column, about the last point.
Sign brute_in_sphere(const std::array<Point3, 5>& p, int bits) {
  std::array<Exact3, 4> d;
  std::array<Integer, 4> lift;
  for (std::size_t i = 0; i < 4; ++i) {
    d[i] = minus(exact(p[i], bits), exact(p[4], bits));
    lift[i] = d[i][0] * d[i][0] + d[i][1] * d[i][1] + d[i][2] * d[i][2];
  }
  return sign_of(lift[0] * triple(d[1], d[2], d[3]) - lift[1] * triple(d[0], d[2], d[3]) +
                 lift[2] * triple(d[0], d[1], d[3]) - lift[3] * triple(d[0], d[1], d[2]));
}

struct Tally {
  int filter = 0;
  int exact_nonzero = 0;
  int exact_zero = 0;
  void count(Sign by_filter, Sign s) {
    if (by_filter != Sign::kZero) {
      ++filter;
    } else {
      ++(s == Sign::kZero ? exact_zero : exact_nonzero);
    }
  }
};

struct Scale {
  double factor;
  int bits;  // unit of the exact check; grid points and unit points lie on it
};
// Powers of two: grids stay grids.
constexpr Scale kScales[] = {
    {1.0, 1200}, {0x1p-14, 1200}, {0x1p14, 1200}, {0x1p-190, 1200}, {0x1p196, 1200}};

Point3 scaled(Point3 p, double scale, Point3 offset) {
  return scale * p + offset;
}

TEST(Predicates3, OrientationKeepsItsLawsNearDegeneracy) {
  Tally tally;
  PointSource source(1);
  for (int i = 0; i < 12000; ++i) {
    const Scale& scale = kScales[static_cast<std::size_t>(source.integer(0, 4))];
    const Point3 offset =
        source.integer(0, 1) != 0 ? scale.factor * 1000.0 * source.generic() : Point3{};
    const bool on_grid = source.integer(0, 2) == 0;
    std::array<Point3, 4> p;
    for (Point3& q : p)
      q = scaled(on_grid ? source.grid() : source.generic(), scale.factor, offset);
    if (!on_grid && source.integer(0, 1) != 0) p[3] = source.near_plane(p[0], p[1], p[2]);
    const Sign s = orientation_3(p[0], p[1], p[2], p[3]);
    ASSERT_EQ(s, brute_orientation(p, scale.bits));
    ASSERT_EQ(s, internal::orientation_3_exact(p[0], p[1], p[2], p[3]));
    ASSERT_EQ(s, -orientation_3(p[1], p[0], p[2], p[3]));
    ASSERT_EQ(s, -orientation_3(p[0], p[1], p[3], p[2]));
    ASSERT_EQ(s, orientation_3(p[1], p[2], p[0], p[3]));
    ASSERT_EQ(s, orientation_3(p[2], p[3], p[0], p[1]));
    tally.count(internal::orientation_3_filter(p[0], p[1], p[2], p[3]), s);
  }
  EXPECT_GT(tally.filter, 3000);
  EXPECT_GT(tally.exact_nonzero, 300);
  EXPECT_GT(tally.exact_zero, 100);
}

TEST(Predicates3, InSphereKeepsItsLawsNearDegeneracy) {
  Tally tally;
  PointSource source(2);
  for (int i = 0; i < 12000; ++i) {
    const Scale& scale = kScales[static_cast<std::size_t>(source.integer(0, 4))];
    const int kind = source.integer(0, 2);
    std::array<Point3, 5> p;
    for (Point3& q : p) {
      q = scale.factor * (kind == 0   ? source.generic()
                          : kind == 1 ? source.grid()
                                      : source.near_unit_sphere());
    }
    const Sign s = in_sphere(p[0], p[1], p[2], p[3], p[4]);
    ASSERT_EQ(s, brute_in_sphere(p, scale.bits));
    ASSERT_EQ(s, internal::in_sphere_exact(p[0], p[1], p[2], p[3], p[4]));
    ASSERT_EQ(s, -in_sphere(p[1], p[0], p[2], p[3], p[4]));
    ASSERT_EQ(s, -in_sphere(p[0], p[1], p[2], p[4], p[3]));
    ASSERT_EQ(s, in_sphere(p[1], p[2], p[0], p[3], p[4]));
    tally.count(internal::in_sphere_filter(p[0], p[1], p[2], p[3], p[4]), s);
  }
  EXPECT_GT(tally.filter, 3000);
  EXPECT_GT(tally.exact_nonzero, 300);
  EXPECT_GT(tally.exact_zero, 100);
}

TEST(Predicates3, SignsAreAsDocumented) {
  const Point3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{0, 0, 1};
  EXPECT_EQ(orientation_3(a, b, c, d), Sign::kPositive);
  EXPECT_EQ(orientation_3(a, b, c, {3, 4, 0}), Sign::kZero);
  EXPECT_EQ(in_sphere(a, b, c, d, {0.5, 0.5, 0.5}), Sign::kPositive);
  EXPECT_EQ(in_sphere(a, b, c, d, {1, 1, 1}), Sign::kZero);
  EXPECT_EQ(in_sphere(a, b, c, d, {2, 2, 2}), Sign::kNegative);
}

TEST(Predicates3, TinyDifferencesDoNotUnderflowToZero) {
  // The determinants are about 1e-360 and 1e-350.
  EXPECT_EQ(orientation_3({0, 0, 0}, {1e-120, 0, 0}, {0, 1e-120, 0}, {0, 0, 1e-120}),
            Sign::kPositive);
  EXPECT_EQ(
      in_sphere({0, 0, 0}, {1e-70, 0, 0}, {0, 1e-70, 0}, {0, 0, 1e-70}, {5e-71, 5e-71, 5e-71}),
      Sign::kPositive);
}

// Coplanar and cospherical copies of points: the lifted predicates must not call a sign that the
// rounding of the rotations made.
TEST(LiftedPredicates3, RoundedRotationsAreNoSign) {
  PointSource source(3);
  int uncertain = 0, certain = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::int32_t fold = source.integer(5, 64);
    solid::QuotientTetrahedralization mesh(fold);
    const double scale = std::exp(source.uniform(-8, 8));
    const Point3 p = scale * source.generic(), q = scale * source.generic();
    const VertexId v = mesh.add_vertex(p, solid::VertexKind::kFree, false);
    const VertexId w = mesh.add_vertex(q, solid::VertexKind::kFree, false);
    const VertexId axis = mesh.add_vertex({0, 0, q.z}, solid::VertexKind::kSegment, true);
    const auto k = [&] { return source.integer(0, fold - 1); };
    // Four copies of one point lie in a plane and on every sphere about the axis with two of them.
    const OrbitVertex a{v, 0}, b{v, 1}, c{v, 2}, d{v, 3};
    EXPECT_EQ(orientation_3(mesh, a, b, c, d), Sign::kZero);
    const OrbitVertex apex{w, k()};
    const Sign up = orientation_3(mesh, a, b, c, apex);
    ++(up == Sign::kZero ? uncertain : certain);
    if (up == Sign::kPositive) {
      EXPECT_EQ(in_sphere(mesh, a, b, c, apex, d), Sign::kZero);
    }
    // One sign for every common rotation.
    const std::int32_t turn = k();
    const auto turned = [&](OrbitVertex x) { return mesh.shift(x, turn); };
    EXPECT_EQ(orientation_3(mesh, turned(a), turned(b), turned(c), turned(apex)), up);
    const OrbitVertex r{w, k()}, s{axis, 0};
    EXPECT_EQ(orientation_3(mesh, a, r, s, b),
              orientation_3(mesh, turned(a), turned(r), s, turned(b)));
  }
  EXPECT_GT(certain, 2000);
  EXPECT_LT(uncertain, 100);
}

}  // namespace
}  // namespace symcell
