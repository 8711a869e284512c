// Quadratic tetrahedra: ten nodes in VTK's order, corners first, then the middles of the edges 01, 12, 20,
// 03, 13, 23.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/geometry/point.hpp"

namespace symcell {

using QuadraticTet = std::array<Point3, 10>;

// A node so near to the middle of its side, in shares of the side, makes no difference to a volume.
inline constexpr double kStraightRel = 1e-12;

// Whether all sides are straight with their nodes in the middle: an element as of order 1.
[[nodiscard]] inline bool is_straight(const QuadraticTet& p) {
  constexpr std::array<std::array<std::size_t, 2>, 6> kSides = {
      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  for (std::size_t s = 0; s < kSides.size(); ++s) {
    const Point3& a = p[kSides[s][0]];
    const Point3& b = p[kSides[s][1]];
    const double beside2 = squared_distance(p[4 + s], 0.5 * (a + b));
    if (!(beside2 <= kStraightRel * kStraightRel * squared_distance(a, b))) return false;
  }
  return true;
}

// The twenty Bezier coefficients of the Jacobian determinant, which is a cubic: their least is a lower bound
// of it everywhere, and six volumes times one for an element with straight sides and middles.
[[nodiscard]] inline std::array<double, 20> jacobian_coefficients(const QuadraticTet& p) {
  // Control points c[i][j] of the edges; c[i][i] are the corners.
  constexpr std::array<std::array<std::size_t, 4>, 4> kNode = {
      {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}}};
  std::array<std::array<Point3, 4>, 4> c;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      c[i][j] = i == j ? p[i] : 2 * p[kNode[i][j]] - 0.5 * (p[i] + p[j]);
    }
  }
  // The derivative towards corner d is linear, with these values at the corners.
  std::array<std::array<Point3, 4>, 3> slope;
  for (std::size_t d = 0; d < 3; ++d) {
    for (std::size_t i = 0; i < 4; ++i) slope[d][i] = 2 * (c[i][d + 1] - c[i][0]);
  }
  const auto det = [&](std::size_t i, std::size_t j, std::size_t k) {
    return dot(cross(slope[0][i], slope[1][j]), slope[2][k]);
  };
  std::array<double, 20> b{};
  std::size_t n = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i; j < 4; ++j) {
      for (std::size_t k = j; k < 4; ++k) {
        b[n++] = (det(i, j, k) + det(j, k, i) + det(k, i, j) + det(i, k, j) + det(k, j, i) +
                  det(j, i, k)) /
                 6;
      }
    }
  }
  return b;
}

[[nodiscard]] inline double volume_of(const std::array<double, 20>& coefficients) {
  double sum = 0;
  for (const double b : coefficients) sum += b;
  return sum / 120;
}

}  // namespace symcell
