// full.min_angle: what is below the bound must be forced by the model.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/verify/verify_mesh.hpp"

namespace symcell {
namespace {

Point3 on_circle(std::int32_t i, std::int32_t sides) {
  const double angle = 2 * std::numbers::pi * i / sides;
  return {std::cos(angle), std::sin(angle), 0};
}

Pslg polygon(std::int32_t sides) {
  Pslg model;
  for (std::int32_t i = 0; i < sides; ++i) {
    const Point3 p = on_circle(i, sides);
    model.vertices.push_back({p.x, p.y});
    model.segments.push_back({i, (i + 1) % sides, 0});
  }
  return model;
}

// A sector of a disc: a fan of triangles from the centre to the sides of the polygon.
MeshData fan(std::int32_t fold, std::int32_t sides_a_sector) {
  MeshData cell;
  cell.fold = fold;
  cell.points.push_back({0, 0, 0});
  for (std::int32_t i = 0; i <= sides_a_sector; ++i) {
    cell.points.push_back(on_circle(i, fold * sides_a_sector));
  }
  for (std::int32_t i = 1; i <= sides_a_sector; ++i) {
    cell.elements.insert(cell.elements.end(), {0, i, i + 1});
    cell.regions.push_back(0);
  }
  cell.lower_to_higher.assign(cell.points.size(), -1);
  cell.lower_to_higher[0] = 0;
  cell.lower_to_higher[1] = sides_a_sector + 1;
  return cell;
}

Check::Status angle_check(const MeshData& cell, const Model& model, double bound) {
  VerifyOptions options;
  options.min_angle_deg = bound;
  const VerifyReport report = verify_mesh(cell, nullptr, &model, options);
  for (const Check& c : report.checks) {
    if (c.name == "full.min_angle") return c.status;
    EXPECT_NE(c.status, Check::Status::kFail) << c.name << ": " << c.detail;
  }
  ADD_FAILURE() << "not looked at";
  return Check::Status::kSkip;
}

TEST(VerifyAngles, TheFoldForcesOneTriangleAtTheCentre) {
  for (const std::int32_t fold : {16, 30}) {
    EXPECT_EQ(angle_check(fan(fold, 1), polygon(fold), 30), Check::Status::kPass);
    EXPECT_EQ(angle_check(fan(fold, 2), polygon(2 * fold), 30), Check::Status::kFail);
    EXPECT_EQ(angle_check(fan(fold, 2), polygon(2 * fold), 180.0 / fold - 1), Check::Status::kPass);
  }
}

TEST(VerifyAngles, SegmentsAtTheCentreForceWhatIsBetweenThem) {
  constexpr std::int32_t kFold = 16;
  Pslg model = polygon(2 * kFold);
  model.vertices.push_back({0, 0});
  for (std::int32_t i = 0; i < 2 * kFold; i += 2) model.segments.push_back({2 * kFold, i, 1});
  EXPECT_EQ(angle_check(fan(kFold, 2), model, 30), Check::Status::kFail) << "half a sector each";
  for (std::int32_t i = 1; i < 2 * kFold; i += 2) model.segments.push_back({2 * kFold, i, 2});
  EXPECT_EQ(angle_check(fan(kFold, 2), model, 30), Check::Status::kPass);
}

TEST(VerifyAngles, NeedsAModel) {
  VerifyOptions options;
  options.min_angle_deg = 30;
  for (const Check& c : verify_mesh(fan(16, 1), nullptr, nullptr, options).checks) {
    EXPECT_TRUE(c.name != "full.min_angle" || c.status == Check::Status::kSkip);
  }
}

}  // namespace
}  // namespace symcell
