// Each warning from models that call for it, that its mend does what it says, and `strict`.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <variant>

#include "core/mesh_model.hpp"
#include "tests/support/plc_builders.hpp"
#include "tests/support/pslg_builders.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell {
namespace {

constexpr std::int32_t kSides = 18;

// A ring of points about the z axis; `sides` 0: one on the axis.
struct Ring {
  double radius = 1;
  double height = 0;
  std::int32_t sides = kSides;
  double notch = 1;  // every other point's radius / that of the others
};

// Closed: the first and the last ring are points.
TriangleSurface revolved(const std::vector<Ring>& rings) {
  TriangleSurface surface;
  std::int32_t below = 0, below_count = 0;
  for (const Ring& ring : rings) {
    const auto first = static_cast<std::int32_t>(surface.vertices.size());
    const std::int32_t count = std::max(ring.sides, 1);
    for (std::int32_t k = 0; k < count; ++k) {
      const double angle = 2 * std::numbers::pi * k / count;
      const double radius = ring.sides > 0 ? ring.radius * (k % 2 == 1 ? ring.notch : 1) : 0;
      surface.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), ring.height});
    }
    // Along both rings at once, by angle.
    std::int32_t a = 0, b = 0;
    while (below_count > 0 && (a < below_count || b < count)) {
      if (below_count == 1 && b == count) break;
      if (count == 1 && a == below_count) break;
      const bool upper = below_count == 1 || (count > 1 && (b + 1) * std::int64_t{below_count} <=
                                                               (a + 1) * std::int64_t{count});
      const std::int32_t p = below + a % below_count, q = first + b % count;
      if (upper) {
        surface.triangles.push_back({p, first + (b + 1) % count, q});
        ++b;
      } else {
        surface.triangles.push_back({p, below + (a + 1) % below_count, q});
        ++a;
      }
    }
    below = first;
    below_count = count;
  }
  return surface;
}

// With so many teeth, tapered, so that no axis lies across.
TriangleSurface surface_prism() {
  return revolved({{0, 0, 0}, {1, 0, 2 * kSides, 0.8}, {0.8, 1, 2 * kSides, 0.8}, {0, 1, 0}});
}

const double kPrismDiameter = std::sqrt(9.0);  // 2 x 2 x 1

void push_out(Point3& p, double by) {
  const double factor = 1 + by / std::hypot(p.x, p.y);
  p.x *= factor;
  p.y *= factor;
}

// Tooth `tooth` moved outwards.
void displace(TriangleSurface& prism, std::int32_t tooth, double by) {
  for (const std::int32_t first : {1, 1 + 2 * kSides}) {
    push_out(prism.vertices[static_cast<std::size_t>(first + 2 * tooth)], by);
  }
}

Plc plc_prism(double by) {
  Plc plc = test::prism(kSides, 1, 1);
  for (const std::size_t k : {0, 1, kSides, kSides + 1}) push_out(plc.vertices[k], by);
  return plc;
}

Pslg planar_ring(double by) {
  Pslg pslg = regular_ring(kSides, 1, 0.5);
  for (Point2& p : pslg.vertices) {
    if (length(p) < 0.9) continue;
    p = (1 + by) * p;
    break;
  }
  return pslg;
}

struct Found {
  std::int32_t fold = 0;
  std::vector<Warning> warnings;
  std::vector<FoldCandidate> folds;
  std::string problem;
};

Result<Found> inspected(const Model& model, const MeshOptions& options = {}) {
  ExecutionContext context;
  auto inspection = inspect_model(model, options, context);
  if (!inspection) return error_of(inspection);
  return std::visit(
      [](const auto& one) {
        Found found{one.fold, one.warnings, one.folds, ""};
        if constexpr (requires { one.problem; }) found.problem = one.problem;
        return found;
      },
      *inspection);
}

const Warning* find(const std::vector<Warning>& warnings, WarningCode code) {
  for (const Warning& warning : warnings) {
    if (warning.code == code) return &warning;
  }
  return nullptr;
}

std::string codes(const std::vector<Warning>& warnings) {
  std::string text;
  for (const Warning& warning : warnings) {
    text += (text.empty() ? "" : " ") + std::string(warning_code_name(warning.code));
  }
  return text;
}

// The fold is near, is not taken, and is taken with the tolerance that the warning gives.
void expect_near(const Model& model, std::int32_t fold, double error_rel, std::int32_t taken) {
  const auto found = inspected(model);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->fold, taken);
  const Warning* near = find(found->warnings, WarningCode::kNearSymmetry);
  ASSERT_NE(near, nullptr) << codes(found->warnings);
  ASSERT_TRUE(near->near_fold);
  EXPECT_EQ(near->near_fold->fold, fold);
  EXPECT_NEAR(near->near_fold->error_rel, error_rel, 0.3 * error_rel);
  EXPECT_GT(near->near_fold->tolerance_rel, near->near_fold->error_rel);
  EXPECT_LT(near->near_fold->tolerance_rel, 1.15 * near->near_fold->error_rel);
  EXPECT_NE(near->text.find(std::to_string(fold)), std::string::npos);
  EXPECT_NE(near->mend.find("symmetry_tolerance="), std::string::npos);
  EXPECT_EQ(find(found->warnings, WarningCode::kNoSymmetryFound) != nullptr, taken == 1);

  MeshOptions wider;
  wider.symmetry_tolerance_rel = near->near_fold->tolerance_rel;
  const auto mended = inspected(model, wider);
  ASSERT_TRUE(mended) << mended.error().message;
  EXPECT_EQ(mended->fold, fold);
}

TEST(Warnings, OfNearSymmetryOfASurface) {
  TriangleSurface prism = surface_prism();
  // An axis half as far off would make it twofold.
  displace(prism, 3, 2.5e-3 * kPrismDiameter);
  expect_near(prism, kSides, 2.5e-3, 1);
}

TEST(Warnings, OfNearSymmetryWhereASmallerFoldIsTaken) {
  TriangleSurface prism = surface_prism();
  for (const std::int32_t tooth : {1, 7, 13}) displace(prism, tooth, 2e-3 * kPrismDiameter);
  // Threefold to within the tolerance, but not exactly: nothing larger would be taken then.
  displace(prism, 4, 9e-4 * kPrismDiameter);
  expect_near(prism, kSides, 2e-3, 3);
}

TEST(Warnings, OfNearSymmetryOfAPlc) {
  expect_near(plc_prism(4e-6 * kPrismDiameter), kSides, 4e-6, 1);
}

TEST(Warnings, OfNearSymmetryInThePlane) {
  expect_near(planar_ring(4e-6 * std::sqrt(8.0)), kSides, 4e-6, 1);
}

TEST(Warnings, NoneOfWhatIsSymmetricOrFarFromIt) {
  TriangleSurface far = surface_prism();
  displace(far, 3, 0.02 * kPrismDiameter);
  for (const Model& model : {Model(surface_prism()), Model(plc_prism(0)), Model(planar_ring(0))}) {
    const auto found = inspected(model);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found->fold, kSides);
    EXPECT_EQ(codes(found->warnings), "");
  }
  for (const Model& model : {Model(far), Model(plc_prism(1e-4)), Model(planar_ring(1e-4))}) {
    const auto found = inspected(model);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(codes(found->warnings), "no_symmetry_found");
    MeshOptions whole;
    whole.fold = 1;
    const auto given = inspected(model, whole);
    ASSERT_TRUE(given);
    EXPECT_EQ(codes(given->warnings), "");
  }
}

// In the list of folds, all of them with the place of the error, and what giving them leads to.
TEST(Warnings, AcceptedFoldsAreThoseThatCanBeGiven) {
  TriangleSurface near = surface_prism();
  for (const std::int32_t tooth : {1, 7, 13}) displace(near, tooth, 3e-3 * kPrismDiameter);
  const auto round = revolved({{0, 0, 0}, {1, 0, 60}, {1, 1, 60}, {0, 1, 0}});
  for (const Model& model : {Model(near), Model(round), Model(plc_prism(4e-6)),
                             Model(planar_ring(4e-6)), Model(regular_ring(64, 1, 0))}) {
    const auto found = inspected(model);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_FALSE(found->folds.empty());
    for (const FoldCandidate& rung : found->folds) {
      MeshOptions options;
      options.fold = rung.fold;
      const auto given = inspected(model, options);
      EXPECT_EQ(given && given->problem.empty(), rung.accepted)
          << rung.fold << ' ' << rung.error_rel;
      EXPECT_TRUE(rung.worst) << rung.fold;
    }
  }
}

TEST(Warnings, OfACubeNameItsAxes) {
  Plc plc = test::box({-1, -1, -1}, {1, 1, 1});
  for (const Model& model : {Model(box_surface({-1, -1, -1}, {1, 1, 1})), Model(plc)}) {
    for (const std::int32_t given : {0, 3}) {
      MeshOptions options;
      if (given > 0) options.fold = given;
      const auto found = inspected(model, options);
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_EQ(codes(found->warnings), "axis_ambiguous");
      EXPECT_NE(found->warnings.front().mend.find("axis_direction="), std::string::npos);
    }
    MeshOptions settled;
    settled.axis_direction = Point3{0, 0, 1};
    const auto found = inspected(model, settled);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(codes(found->warnings), "");
  }
}

TEST(Warnings, OfRepairsTellHowMany) {
  TriangleSurface prism = surface_prism();
  turn_inside_out(prism);
  ExecutionContext context;
  const auto outcome = mesh_model(prism, {}, context);
  ASSERT_TRUE(outcome) << outcome.error().message;
  const Warning* repaired = find(outcome->statistics.warnings, WarningCode::kSurfaceRepaired);
  ASSERT_NE(repaired, nullptr);
  EXPECT_NE(repaired->text.find("1 way"), std::string::npos) << repaired->text;
  EXPECT_NE(repaired->text.find(outcome->statistics.repairs.front()), std::string::npos);
}

TEST(Warnings, OfExemptElementsGiveTheReasons) {
  ExecutionContext context;
  const auto outcome = mesh_model(star(5, 2, 0.3), {}, context);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(codes(outcome->statistics.warnings), "exempt_elements");
  EXPECT_NE(outcome->statistics.warnings.front().text.find("small_input_angle"), std::string::npos);
  EXPECT_FALSE(exempt_elements_warning({{"small_input_angle", 5}}, 1000));
  EXPECT_TRUE(exempt_elements_warning({{"small_input_angle", 5}, {"x", 1}}, 1000));
  // Each is told what helps it.
  const auto curved = exempt_elements_warning({{"curved_boundary", 9}}, 1000);
  ASSERT_TRUE(curved);
  EXPECT_NE(curved->mend.find("curved=false"), std::string::npos);
  const auto both = exempt_elements_warning({{"curved_boundary", 5}, {"min_edge", 5}}, 1000);
  ASSERT_TRUE(both);
  EXPECT_NE(both->mend.find("relax the bound"), std::string::npos);
}

TEST(Warnings, AreErrorsWhereStrict) {
  MeshOptions strict;
  strict.strict = true;
  ExecutionContext context;
  for (const Model& model : {Model(star(5, 2, 0.3)), Model(test::box({-1, -1, -1}, {1, 1, 1})),
                             Model(planar_ring(4e-6 * std::sqrt(8.0)))}) {
    const auto refused = mesh_model(model, strict, context);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kStrictWarnings);
  }
  const auto listed = inspected(planar_ring(4e-6 * std::sqrt(8.0)), strict);
  ASSERT_FALSE(listed);
  EXPECT_EQ(listed.error().code, ErrorCode::kStrictWarnings);
  for (const char* what : {"2 warnings", "near_symmetry", "no_symmetry_found"}) {
    EXPECT_NE(listed.error().message.find(what), std::string::npos) << listed.error().message;
  }
  EXPECT_TRUE(mesh_model(planar_ring(0), strict, context));
}

TEST(Warnings, TolerancesAreRoundedUpToTwoDigits) {
  EXPECT_EQ(tolerance_that_takes(1.06e-3), 1.1e-3);
  EXPECT_EQ(tolerance_that_takes(9.99e-7), 1.1e-6);
  EXPECT_EQ(tolerance_that_takes(1e-3), 1.1e-3);
  EXPECT_EQ(tolerance_that_takes(0.0834), 0.084);
  EXPECT_EQ(tolerance_that_takes(0), 0);
}

TEST(Warnings, OfASmallerFoldNameBoth) {
  const Warning warning = fold_not_largest_warning(4, 20, "it fits exactly");
  EXPECT_EQ(codes({warning}), "fold_not_largest");
  EXPECT_NE(warning.text.find("20"), std::string::npos);
  EXPECT_NE(warning.mend.find("fold=20"), std::string::npos);
}

// What is refused as one of revolution names a fold that is accepted.
void expect_proposal(const TriangleSurface& surface, bool nearly) {
  const auto found = inspected(surface);
  ASSERT_TRUE(found) << found.error().message;
  const std::string& text = found->problem;
  EXPECT_NE(text.find(nearly ? "nearly one of revolution" : "is one of revolution"),
            std::string::npos)
      << text;
  const auto number_after = [&](const std::string& name) {
    const std::size_t at = text.find(name);
    return at == std::string::npos ? 0.0 : std::stod(text.substr(at + name.size()));
  };
  MeshOptions options;
  options.fold = static_cast<std::int32_t>(number_after("for example fold="));
  const double tolerance = number_after("symmetry_tolerance=");
  if (tolerance > 0) options.symmetry_tolerance_rel = tolerance;
  ASSERT_GT(*options.fold, 1) << text;
  const auto given = inspected(surface, options);
  ASSERT_TRUE(given) << given.error().message;
  EXPECT_EQ(given->problem, "");
  EXPECT_EQ(given->fold, *options.fold);
}

TEST(Revolution, ProposesAFold) {
  expect_proposal(revolved({{0, 0, 0}, {1, 0, 97}, {0.9, 0.5, 89}, {0, 0.5, 0}}), false);
}

TEST(Revolution, IsRecognisedWhereItIsCoarse) {
  expect_proposal(revolved({{0, 0, 0}, {1, 0, 29}, {0.8, 0.5, 38}, {0, 0.5, 0}}), true);
}

// Coarsely divided, but all round alike: these have the fold of their division.
TEST(Revolution, OfOneDivisionHasItsFold) {
  for (const std::int32_t n : {8, 13, 24, 30, 40}) {
    const auto cone = revolved({{0, 0, 0}, {1, 0, n}, {0, 2, 0}});
    const auto ball = revolved({{0, -1, 0}, {0.8, -0.6, n}, {1, 0, n}, {0.8, 0.6, n}, {0, 1, 0}});
    for (const TriangleSurface& surface : {cone, ball}) {
      const auto found = inspected(surface);
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_EQ(found->fold, n) << found->problem;
      EXPECT_EQ(codes(found->warnings), "");
    }
  }
}

}  // namespace
}  // namespace symcell
