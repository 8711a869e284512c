#include "core/solid/sector/match_curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/segment_index.hpp"

namespace symcell::solid {
namespace {

constexpr std::size_t kMostTableCells = 60'000'000;  // 60 MB; curves of 7,700 vertices

enum class Step : std::uint8_t { kNone, kBoth, kOnlyA, kOnlyB };

double one_way(std::span<const Point2> from, std::span<const Point2> to) {
  double worst = 0;
  for (const Point2& p : from) {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < to.size() && best > worst; ++i) {
      best = std::min(best, squared_distance_to_segment(p, to[i], to[i + 1]));
    }
    worst = std::max(worst, best);
  }
  return worst;
}

}  // namespace

double curve_distance(std::span<const Point2> a, std::span<const Point2> b) {
  return std::sqrt(std::max(one_way(a, b), one_way(b, a)));
}

std::vector<CurveMatch> match_curves(std::span<const Point2> a,
                                     std::span<const Point2> b,
                                     double lone_cost) {
  const std::size_t rows = a.size(), columns = b.size();
  if (rows < 2 || columns < 2 || rows > kMostTableCells / columns) return {};
  const double lone = lone_cost * lone_cost;
  constexpr double kNever = std::numeric_limits<double>::infinity();  // cost of what is not reached
  std::vector<Step> steps(rows * columns, Step::kNone);
  std::vector<double> previous(columns, kNever), current(columns, kNever);
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      if (i == 0 && j == 0) {
        current[0] = 0;
        continue;
      }
      double best = kNever;
      Step step = Step::kNone;
      if (i > 0 && j > 0) {
        best = previous[j - 1] + squared_distance(a[i], b[j]);
        step = Step::kBoth;
      }
      // The ends match each other, so no lone vertex comes after the last one of the other.
      if (i > 0 && i + 1 < rows && j + 1 < columns) {
        const double cost = previous[j] + lone + squared_distance_to_segment(a[i], b[j], b[j + 1]);
        if (cost < best) {
          best = cost;
          step = Step::kOnlyA;
        }
      }
      if (j > 0 && j + 1 < columns && i + 1 < rows) {
        const double cost =
            current[j - 1] + lone + squared_distance_to_segment(b[j], a[i], a[i + 1]);
        if (cost < best) {
          best = cost;
          step = Step::kOnlyB;
        }
      }
      current[j] = best;
      steps[i * columns + j] = step;
    }
    std::swap(previous, current);
  }
  std::vector<CurveMatch> matches;
  std::size_t i = rows - 1, j = columns - 1;
  while (i > 0 || j > 0) {
    const auto ia = static_cast<std::int32_t>(i), jb = static_cast<std::int32_t>(j);
    switch (steps[i * columns + j]) {
      case Step::kBoth:
        matches.push_back({ia, jb});
        --i;
        --j;
        break;
      case Step::kOnlyA:
        matches.push_back({ia, -1});
        --i;
        break;
      case Step::kOnlyB:
        matches.push_back({-1, jb});
        --j;
        break;
      case Step::kNone: return {};
    }
  }
  matches.push_back({0, 0});
  std::reverse(matches.begin(), matches.end());
  return matches;
}

}  // namespace symcell::solid
