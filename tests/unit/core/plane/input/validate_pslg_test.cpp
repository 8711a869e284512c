// What validate_pslg accepts and refuses, with the entities it names.
#include "core/plane/input/validate_pslg.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/plane/input/subdomains.hpp"
#include "core/plane/symmetry/symmetrise.hpp"
#include "tests/support/pslg_builders.hpp"
#include "tests/support/shape_models.hpp"

namespace symcell::plane {
namespace {

using Ids = std::vector<std::int64_t>;

Pslg square() {
  return {{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}, {}, {}};
}

void expect_error(const Pslg& pslg, ErrorCode code, const Ids& ids, const std::string& pointer) {
  ExecutionContext context;
  const auto result = validate_pslg(pslg, context);
  ASSERT_FALSE(result);
  EXPECT_EQ(error_code_name(result.error().code), error_code_name(code)) << result.error().message;
  EXPECT_EQ(result.error().elements, ids) << result.error().message;
  EXPECT_EQ(result.error().pointer, pointer) << result.error().message;
}

void expect_valid(const Pslg& pslg) {
  ExecutionContext context;
  const auto result = validate_pslg(pslg, context);
  EXPECT_TRUE(result) << result.error().message;
}

// An outline that is open by little encloses nothing, and what lies within it would be all that is meshed.
TEST(ValidatePslg, RefusesContoursThatAllButClose) {
  Pslg pslg{
      {{0, 0}, {40, 0}, {40, 40}, {0, 40}, {0, 0.01}}, {{0, 1}, {1, 2}, {2, 3}, {3, 4}}, {}, {}};
  test::add_loop(pslg, test::polygon(12, 5, 0, {20, 20}), 1);
  expect_error(pslg, ErrorCode::kDegenerateGeometry, {0, 4}, "/vertices/0");
  // In two parts, with two gaps.
  pslg.vertices.push_back({40, 39.995});
  pslg.segments[1].b = static_cast<std::int32_t>(pslg.vertices.size()) - 1;
  expect_error(pslg, ErrorCode::kDegenerateGeometry, {2, 17}, "/vertices/2");
  // A seed that is no fault of its own.
  pslg.holes = {{5, 5}};
  ExecutionContext context;
  const auto seed = validate_pslg(pslg, context);
  ASSERT_FALSE(seed);
  EXPECT_EQ(seed.error().code, ErrorCode::kUnreachableSeed);
  EXPECT_NE(seed.error().message.find("a contour is open at vertices 2"), std::string::npos)
      << seed.error().message;
}

// Lines that nobody drew to close anything.
TEST(ValidatePslg, AcceptsCentreLinesAndHatches) {
  Pslg pslg = square();
  const auto line = [&](Point2 a, Point2 b) {
    const auto first = static_cast<std::int32_t>(pslg.vertices.size());
    pslg.vertices.insert(pslg.vertices.end(), {a, b});
    pslg.segments.push_back({first, first + 1});
  };
  line({-3, 2}, {-1, 2});
  line({-2, 1}, {-2, 1.9});
  for (int i = 0; i < 20; ++i) line({6, 0.1 * i}, {9, 0.1 * i});
  expect_valid(pslg);
  ExecutionContext context;
  const auto found = symmetrise(pslg, {}, context);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_TRUE(std::ranges::any_of(found->warnings, [](const Warning& w) {
    return w.code == WarningCode::kEntitiesLeftOut && w.text.starts_with("22 pieces");
  }));
}

TEST(ValidatePslg, TellsOfOpenContoursWithinTheMesh) {
  Pslg pslg = square();
  pslg.vertices.insert(pslg.vertices.end(), {{1, 1}, {3, 1}, {3, 3}, {1, 3}, {1, 1.001}});
  for (std::int32_t i = 4; i < 8; ++i) pslg.segments.push_back({i, i + 1});
  ExecutionContext context;
  ASSERT_TRUE(validate_pslg(pslg, context));
  const auto found = symmetrise(pslg, {}, context);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_TRUE(std::ranges::any_of(
      found->warnings, [](const Warning& w) { return w.code == WarningCode::kOpenContour; }));
}

TEST(ValidatePslg, RefusesBadNumbersAndIndices) {
  Pslg pslg = square();
  pslg.vertices[2].y = std::nan("");
  expect_error(pslg, ErrorCode::kNonFinite, {2}, "/vertices/2");
  pslg = square();
  pslg.vertices[1].x = 1e61;
  expect_error(pslg, ErrorCode::kCoordinateRange, {1}, "/vertices/1");
  pslg = square();
  pslg.holes = {{1, 1}, {HUGE_VAL, 0}};
  expect_error(pslg, ErrorCode::kNonFinite, {1}, "/holes/1");
  pslg = square();
  pslg.segments[3].b = 4;
  expect_error(pslg, ErrorCode::kIndexOutOfRange, {3}, "/segments/3");
  pslg = square();
  pslg.segments[1].a = -1;
  expect_error(pslg, ErrorCode::kIndexOutOfRange, {1}, "/segments/1");
  pslg = square();
  pslg.segments.push_back({2, 2});
  expect_error(pslg, ErrorCode::kZeroLengthSegment, {4}, "/segments/4");
  pslg = square();
  pslg.vertices.push_back({4, 0});
  expect_error(pslg, ErrorCode::kDuplicateVertices, {1, 4}, "/vertices/4");
  pslg.vertices[4] = {4 + 1e-14, -1e-14};
  expect_error(pslg, ErrorCode::kDuplicateVertices, {1, 4}, "/vertices/4");
}

TEST(ValidatePslg, RefusesModelsWithoutArea) {
  expect_error({}, ErrorCode::kDegenerateGeometry, {}, "");
  Pslg pslg{{{0, 0}, {1, 1}, {2, 2}, {3, 3}}, {{0, 1}, {1, 2}, {2, 3}}, {}, {}};
  expect_error(pslg, ErrorCode::kDegenerateGeometry, {}, "");
  pslg = square();
  pslg.segments.pop_back();
  expect_error(pslg, ErrorCode::kDegenerateGeometry, {}, "");
  pslg = square();
  pslg.holes = {{1, 1}};
  expect_error(pslg, ErrorCode::kDegenerateGeometry, {}, "");
}

TEST(ValidatePslg, RefusesCrossingsAndOverlaps) {
  Pslg pslg = square();
  pslg.segments.push_back({0, 2});
  pslg.segments.push_back({1, 3});
  expect_error(pslg, ErrorCode::kSelfIntersection, {4, 5}, "/segments/5");
  pslg = square();
  pslg.vertices.push_back({2, 0});
  pslg.vertices.push_back({6, 0});
  pslg.segments.push_back({4, 5});
  expect_error(pslg, ErrorCode::kOverlappingSegments, {0, 4}, "/segments/4");
  pslg = square();
  pslg.segments.push_back({1, 0, 3});
  expect_error(pslg, ErrorCode::kOverlappingSegments, {0, 4}, "/segments/4");
}

TEST(ValidatePslg, AcceptsWhatIsUnusualButClear) {
  Pslg pslg = square();
  pslg.segments.push_back({1, 0, 0});  // given twice
  expect_valid(pslg);
  pslg = square();
  pslg.vertices.push_back({2, 0});  // on a segment, with a spoke
  pslg.vertices.push_back({2, 2});
  pslg.segments.push_back({4, 5});
  expect_valid(pslg);
  pslg.segments.push_back({0, 2});  // crossing at a vertex that lies on both
  pslg.segments.push_back({1, 3});
  expect_valid(pslg);
  pslg = square();
  pslg.vertices.push_back({9, 9});  // isolated, outside
  expect_valid(pslg);
}

TEST(ValidatePslg, LocatesSeeds) {
  Pslg pslg = square();
  pslg.holes = {{5, 5}};
  expect_error(pslg, ErrorCode::kUnreachableSeed, {0}, "/holes/0");
  pslg.holes = {pslg.vertices[0]};
  expect_error(pslg, ErrorCode::kUnreachableSeed, {0}, "/holes/0");
  pslg = square();
  pslg.regions = {{{1, 1}, 1}, {{4, 2}, 1}};
  expect_error(pslg, ErrorCode::kUnreachableSeed, {1}, "/regions/1");
  pslg.regions = {{{1, 1}, 1}, {{2, 2}, 2}};
  expect_error(pslg, ErrorCode::kConflictingSeeds, {0, 1}, "/regions/1");
  pslg.regions = {{{1, 1}, 1}, {{2, 2}, 1}};
  expect_valid(pslg);
  pslg.holes = {{3, 3}};
  expect_error(pslg, ErrorCode::kConflictingSeeds, {0, 0}, "/regions/0");
}

TEST(ValidatePslg, MissingHoleSeedIsTakenLiterally) {
  Pslg pslg = regular_ring(6, 2, 1);
  pslg.holes.clear();
  expect_valid(pslg);
}

// Against a check of all pairs, on integer grids, where all degeneracies happen.
TEST(ValidatePslg, FindsCrossingsAsAllPairsDo) {
  std::mt19937 engine(7);
  const auto sign = [](double x) { return (x > 0) - (x < 0); };
  int refused = 0;
  int accepted = 0;
  for (int round = 0; round < 4000; ++round) {
    Pslg pslg;
    const int size = 3 + round % 6;
    std::uniform_int_distribution<int> coordinate(0, size);
    while (pslg.vertices.size() < 8) {
      const Point2 p{double(coordinate(engine)), double(coordinate(engine))};
      bool fresh = true;
      for (const Point2 q : pslg.vertices) fresh = fresh && q != p;
      if (fresh) pslg.vertices.push_back(p);
    }
    std::uniform_int_distribution<int> vertex(0, 7);
    const int count = 2 + round % 5;
    for (int s = 0; s < count; ++s) {
      const int a = vertex(engine);
      const int b = vertex(engine);
      if (a != b) pslg.segments.push_back({a, b});
    }
    bool bad = false;
    const auto at = [&](std::int32_t v) { return pslg.vertices[static_cast<std::size_t>(v)]; };
    const auto side = [&](const PslgSegment& s, std::int32_t v) {
      return sign(cross(at(s.b) - at(s.a), at(v) - at(s.a)));
    };
    for (std::size_t i = 0; i < pslg.segments.size(); ++i) {
      for (std::size_t j = i + 1; j < pslg.segments.size(); ++j) {
        const PslgSegment s = pslg.segments[i];
        const PslgSegment t = pslg.segments[j];
        const int a = side(s, t.a), b = side(s, t.b), c = side(t, s.a), d = side(t, s.b);
        const bool same = (s.a == t.a && s.b == t.b) || (s.a == t.b && s.b == t.a);
        if (a == 0 && b == 0 && !same) {  // on one line: overlap?
          const Point2 u = at(s.b) - at(s.a);
          const double lo = std::min(dot(u, at(t.a) - at(s.a)), dot(u, at(t.b) - at(s.a)));
          const double hi = std::max(dot(u, at(t.a) - at(s.a)), dot(u, at(t.b) - at(s.a)));
          bad = bad || (lo < dot(u, u) && hi > 0);
        }
        if (a * b < 0 && c * d < 0) {
          bool exempt = false;
          for (std::int32_t v = 0; v < 8; ++v)
            exempt = exempt || (side(s, v) == 0 && side(t, v) == 0);
          bad = bad || !exempt;
        }
      }
    }
    ExecutionContext context;
    const auto map = make_planar_map(pslg.vertices, pslg.segments, {}, context);
    ASSERT_EQ(!map, bad) << "round " << round << (map ? "" : map.error().message);
    ++(bad ? refused : accepted);
    if (!map) continue;
    // Euler: V - E + F = 1 + C.
    std::vector<int> parent(8);
    for (int v = 0; v < 8; ++v) parent[static_cast<std::size_t>(v)] = v;
    const auto root = [&](int v) {
      while (parent[static_cast<std::size_t>(v)] != v) v = parent[static_cast<std::size_t>(v)];
      return v;
    };
    int components = 8;
    for (const PlanarPiece& piece : map->pieces) {
      const int a = root(piece.a);
      const int b = root(piece.b);
      if (a != b) --components;
      parent[static_cast<std::size_t>(a)] = b;
    }
    EXPECT_EQ(8 - static_cast<int>(map->pieces.size()) + map->face_count, 1 + components);
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(accepted, 500);
}

}  // namespace
}  // namespace symcell::plane
