#include "tests/support/shape_models.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace symcell::test {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::int32_t kFolds[] = {2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 16, 20};

double sagitta(std::int32_t sides, double radius) {
  return radius * (1 - std::cos(std::numbers::pi / sides));
}

Point2 polar(double radius, double angle) {
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

class Maker {
 public:
  explicit Maker(std::uint64_t seed) : engine_(seed * 0x9e3779b97f4a7c15ULL + 1) {
    model_.fold = kFolds[engine_() % std::size(kFolds)];
  }

  ShapeModel run() {
    switch (engine_() % 5) {
      case 0: flange(); break;
      case 1: profile(); break;
      case 2: left_overs(); break;
      case 3: rotor(); break;
      default: noisy(); break;
    }
    model_.description += ", fold " + std::to_string(fold());
    return std::move(model_);
  }

 private:
  [[nodiscard]] std::int32_t fold() const { return model_.fold; }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  std::int32_t number(std::int32_t low, std::int32_t high) {
    return std::uniform_int_distribution<std::int32_t>(low, high)(engine_);
  }
  bool chance(double share) { return uniform(0, 1) < share; }
  void add(const std::vector<Point2>& points, std::int32_t marker = 0) {
    add_loop(model_.pslg, points, marker);
  }
  void add_hole(Point2 p) { model_.pslg.holes.push_back(p); }

  // Polygons of numbers of sides that have nothing to do with the fold.
  void flange() {
    model_.description = "flange";
    const std::int32_t rim = number(std::max(24, 3 * fold()), 90);
    add(polygon(rim, 1, uniform(0, 6), {}), 1);
    double error = sagitta(rim, 1);
    if (chance(0.7)) {
      const std::int32_t bore = number(std::max(16, 3 * fold()), 80);
      const double radius = uniform(0.2, 0.45);
      add(polygon(bore, radius, uniform(0, 6), {}), chance(0.5) ? 2 : 0);
      error = std::max(error, sagitta(bore, radius));
      if (chance(0.6)) {
        add_hole({0, 0});
      } else if (chance(0.5)) {
        model_.pslg.regions.push_back({{0.01, 0.005}, 3, kFar});
      }
    }
    constexpr std::int32_t kSides[] = {5, 7, 9, 13, 16, 17, 19, 24, 31};
    const std::int32_t sides = kSides[engine_() % std::size(kSides)];
    const double radius = std::min(0.14, 0.45 * std::sin(std::numbers::pi / fold()));
    const double first = uniform(0, 6);
    for (std::int32_t i = 0; i < fold(); ++i) {
      const Point2 centre = polar(0.7, first + kTurn * i / fold());
      add(polygon(sides, radius, chance(0.5) ? uniform(0, 6) : 0, centre));
      add_hole(centre);
    }
    model_.tolerance_rel = 1.6 * std::max(error, sagitta(sides, radius)) / std::sqrt(8.0);
  }

  // A wavy outline with a number of vertices that has nothing to do with the fold.
  void profile() {
    model_.description = "profile";
    const double a_sector = uniform(9, 24);
    const auto count = static_cast<std::int32_t>(a_sector * fold());
    const double first = uniform(0, 6), height = uniform(0.05, 0.2) * std::min(1.0, 8.0 / fold());
    std::vector<Point2> points;
    for (std::int32_t i = 0; i < count; ++i) {
      const double t = first + kTurn * i / count;
      points.push_back(polar(
          1 + height * std::sin(fold() * t + 1) + 0.3 * height * std::sin(2 * fold() * t), t));
    }
    add(points);
    const double step = kTurn / a_sector;
    model_.tolerance_rel = 0.5 * (sagitta(count, 1) + 0.3 * height * step * step);
    if (!chance(0.6)) return;
    const std::int32_t bore = number(std::max(14, 2 * fold() + 1), 60);
    add(polygon(bore, 0.4, uniform(0, 6), {}));
    model_.tolerance_rel = std::max(model_.tolerance_rel, 0.67 * sagitta(bore, 0.4));
    if (chance(0.7)) add_hole({0, 0});
  }

  // Straight sides with vertices that mean nothing.
  void left_overs() {
    model_.description = "left-overs";
    const double first = uniform(0, 6);
    std::vector<Point2> outer = polygon(std::max(fold(), 4), 1, first, {});
    std::vector<Point2> inner = polygon(std::max(fold(), 4), 0.5, first + 0.3, {});
    if (fold() == 2) {
      for (Point2& p : outer) p.x *= 2;
      for (Point2& p : inner) p.x *= 2;
    }
    add(with_left_overs(outer), chance(0.5) ? 7 : 0);
    add(with_left_overs(inner));
    if (fold() == 3) {
      model_.pslg = {};
      add(with_left_overs(polygon(3, 1, first, {})));
      add(with_left_overs(polygon(3, 0.4, first, {})));
    }
    if (chance(0.7)) add_hole({0, 0});
    model_.tolerance_rel = 1e-6;
    if (!chance(0.5)) return;
    add_noise(std::pow(10, -number(6, 9)));
    model_.tolerance_rel = 1e-5;
  }

  std::vector<Point2> with_left_overs(const std::vector<Point2>& corners) {
    std::vector<Point2> result;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point2 a = corners[i], b = corners[(i + 1) % corners.size()];
      std::vector<double> shares(static_cast<std::size_t>(number(0, 3)));
      for (double& s : shares) s = uniform(0.02, 0.98);
      std::sort(shares.begin(), shares.end());
      result.push_back(a);
      for (const double s : shares) result.push_back(a + s * (b - a));
    }
    return result;
  }

  // Arcs that are sampled at multiples of one angle, whatever the sector, and slots between.
  void rotor() {
    model_.description = "rotor";
    const double step = uniform(4, 11) * kTurn / 360, gap = 0.25 * std::numbers::pi / fold();
    std::vector<Point2> points;
    for (std::int32_t i = 0; i < fold(); ++i) {
      const double begin = kTurn * i / fold() + gap, end = kTurn * (i + 1) / fold() - gap;
      points.push_back(polar(1, begin));
      for (double k = std::floor(begin / step + 0.1) + 1; k * step < end - 0.1 * step; ++k) {
        points.push_back(polar(1, k * step));
      }
      points.push_back(polar(1, end));
      points.push_back(polar(0.6, end + 0.2 * gap));
      points.push_back(polar(0.6, end + 1.8 * gap));
    }
    add(points);
    const std::int32_t bore = number(std::max(16, 2 * fold() + 1), 70);
    add(polygon(bore, 0.35, uniform(0, 6), {}), 4);
    if (chance(0.5)) add_hole({0, 0});
    model_.tolerance_rel = 0.6 * std::max(1 - std::cos(0.55 * step), sagitta(bore, 0.35));
  }

  // Vertices that are copies of each other but for noise, and a few that are not.
  void noisy() {
    model_.description = "noisy";
    const std::int32_t count = fold() * number(6, 14);
    const double height = 0.15 * std::min(1.0, 8.0 / fold());
    std::vector<Point2> corners, points;
    for (std::int32_t i = 0; i < count; ++i) {
      const double t = kTurn * i / count;
      corners.push_back(
          polar(1 + height * std::sin(fold() * t) + 0.2 * height * std::cos(2 * fold() * t), t));
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point2 a = corners[i], b = corners[(i + 1) % corners.size()];
      points.push_back(a);
      if (chance(6.0 / count)) points.push_back(a + uniform(0.2, 0.8) * (b - a));
    }
    add(points);
    add(polygon(fold() * number(2, 5), 0.4, 0.2, {}));
    if (chance(0.7)) add_hole({0, 0});
    const double noise = std::pow(10, -number(5, 7));
    add_noise(noise);
    model_.tolerance_rel = 8 * noise;
  }

  void add_noise(double amount) {
    for (Point2& p : model_.pslg.vertices) {
      p.x += uniform(-amount, amount);
      p.y += uniform(-amount, amount);
    }
  }

  static constexpr double kFar = std::numeric_limits<double>::infinity();

  std::mt19937_64 engine_;
  ShapeModel model_;
};

}  // namespace

ShapeModel make_shape_model(std::uint64_t seed) {
  ShapeModel model = Maker(seed).run();
  model.description += " (seed " + std::to_string(seed) + ")";
  return model;
}

std::vector<Point2> polygon(std::int32_t sides, double radius, double phase, Point2 centre) {
  std::vector<Point2> points;
  for (std::int32_t i = 0; i < sides; ++i) {
    points.push_back(centre + polar(radius, phase + kTurn * i / sides));
  }
  return points;
}

Pslg wavy_ring() {
  constexpr int kRim = 2000, kBore = 1000, kWaves = 7;
  std::vector<Point2> rim;
  for (int i = 0; i < kRim; ++i) {
    const double angle = kTurn * i / kRim;
    rim.push_back(polar(1 + 0.05 * std::sin(kWaves * angle), angle));
  }
  Pslg pslg;
  add_loop(pslg, rim, 0);
  add_loop(pslg, polygon(kBore, 0.5, 0.1, {}), 0);
  pslg.holes.push_back({0, 0});
  return pslg;
}

void add_loop(Pslg& pslg, const std::vector<Point2>& points, std::int32_t marker) {
  const auto first = static_cast<std::int32_t>(pslg.vertices.size());
  const auto count = static_cast<std::int32_t>(points.size());
  pslg.vertices.insert(pslg.vertices.end(), points.begin(), points.end());
  for (std::int32_t i = 0; i < count; ++i) {
    pslg.segments.push_back({first + i, first + (i + 1) % count, marker});
  }
}

}  // namespace symcell::test
