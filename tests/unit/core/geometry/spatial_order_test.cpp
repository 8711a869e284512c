// The space-filling curve, and tetrahedra along it.
#include "core/geometry/spatial_order.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <vector>

#include "tests/unit/core/solid/solid_checks.hpp"

namespace symcell {
namespace {

// The first 16^3 places fill the corner of the cube, each a step from the one before.
TEST(SpatialOrder, FollowsTheHilbertCurve) {
  constexpr std::uint32_t kSide = 16;
  std::vector<std::array<int, 3>> at(kSide * kSide * kSide, {-1, -1, -1});
  for (std::uint32_t x = 0; x < kSide; ++x) {
    for (std::uint32_t y = 0; y < kSide; ++y) {
      for (std::uint32_t z = 0; z < kSide; ++z) {
        const std::uint64_t place = hilbert_place(x, y, z);
        ASSERT_LT(place, at.size());
        ASSERT_EQ(at[place][0], -1);
        at[place] = {static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)};
      }
    }
  }
  for (std::size_t i = 1; i < at.size(); ++i) {
    int steps = 0;
    for (std::size_t c = 0; c < 3; ++c) steps += std::abs(at[i][c] - at[i - 1][c]);
    EXPECT_EQ(steps, 1) << i;
  }
}

TEST(SpatialOrder, CutsOffWhatIsBeyondTheCube) {
  constexpr std::uint32_t kMost = (1U << kHilbertBits) - 1;
  EXPECT_EQ(hilbert_place(kMost + 7, 3, kMost + 1), hilbert_place(kMost, 3, kMost));
}

// Compacting changes names, nothing else; copies in other frames come to lie beside each other.
TEST(SpatialOrder, CompactedMeshesStayWhatTheyWere) {
  for (const std::int32_t fold : {1, 2, 6, 64}) {
    auto solid = test::prism(solid::test::prism_shape(fold));
    const double volume = solid::test::quotient_volume(solid.mesh);
    const std::size_t count = solid.mesh.tet_count();
    test::shuffle_gauge(solid.mesh, 7);
    solid.mesh.compact_tets();
    EXPECT_EQ(solid.mesh.tet_count(), count);
    EXPECT_EQ(solid.mesh.tet_slots(), count);
    EXPECT_TRUE(solid::test::is_valid(solid.mesh, volume));
  }
}

}  // namespace
}  // namespace symcell
