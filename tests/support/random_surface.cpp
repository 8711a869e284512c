#include "tests/support/random_surface.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "tests/support/surface_builders.hpp"

namespace symcell::test {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr Point3 kOrigin{0, 0, 0};

// Points by two parameters in [0, 1), the first one round the axis; rows close up or end.
using Shape = std::function<Point3(double u, double v)>;

class Builder {
 public:
  explicit Builder(std::uint64_t seed) : random_(seed) {
    made_.fold = 2 + static_cast<std::int32_t>(random_.next() % 23);
  }

  RandomSurface build(std::uint64_t kind) {
    switch (kind % 4) {
      case 0: torus(); break;
      case 1: lobed(); break;
      case 2: gear(); break;
      default: twisted(); break;
    }
    TriangleSurface& s = made_.surface;
    if (enclosed() < 0) turn_inside_out(s);
    const double size = std::pow(10, between(-2, 3));
    const double far = size * static_cast<double>(random_.next() % 3);
    for (Point3& p : s.vertices) p = size * p;
    move_to_axis(s, {far * between(-1, 1), far * between(-1, 1), far * between(-1, 1)},
                 {between(-1, 1), between(-1, 1), between(0.1, 1)});
    made_.volume = enclosed();
    made_.area = surface_area({s.vertices, s.triangles, {}});
    made_.description += ", " + std::to_string(made_.fold) + "-fold, " +
                         std::to_string(s.triangles.size()) + " triangles";
    return std::move(made_);
  }

 private:
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  std::int32_t any(std::int32_t low, std::int32_t high) {
    return low + static_cast<std::int32_t>(random_.next() % static_cast<std::uint64_t>(high - low));
  }
  double enclosed() const {
    const TriangleSurface& s = made_.surface;
    return enclosed_volume({s.vertices, s.triangles, {}}, s.vertices.front());
  }
  std::int32_t add(Point3 p) {
    made_.surface.vertices.push_back(p);
    return static_cast<std::int32_t>(made_.surface.vertices.size()) - 1;
  }
  void triangle(std::int32_t a, std::int32_t b, std::int32_t c) {
    if (a != b && b != c && c != a) made_.surface.triangles.push_back({a, b, c});
  }

  // A multiple of the fold and one more: no two sectors are divided alike.
  std::int32_t rounds(double low, double high) {
    return static_cast<std::int32_t>(made_.fold * between(low, high)) + 1;
  }

  // ids[i][j], with diagonals this way and that.
  std::vector<std::vector<std::int32_t>> grid(const Shape& shape,
                                              std::int32_t round,
                                              std::int32_t rows,
                                              bool rows_close) {
    std::vector<std::vector<std::int32_t>> ids(static_cast<std::size_t>(round));
    const double last = rows_close ? rows : rows - 1;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      for (std::int32_t j = 0; j < rows; ++j) {
        ids[i].push_back(add(shape(static_cast<double>(i) / round, j / last)));
      }
    }
    return ids;
  }
  void fill(const std::vector<std::vector<std::int32_t>>& ids, bool rows_close) {
    const std::size_t round = ids.size(), rows = ids.front().size();
    for (std::size_t i = 0; i < round; ++i) {
      for (std::size_t j = 0; j + (rows_close ? 0 : 1) < rows; ++j) {
        const std::size_t k = (i + 1) % round, l = (j + 1) % rows;
        if ((7 * i + 3 * j) % 2 == 1) {
          triangle(ids[i][j], ids[k][j], ids[k][l]);
          triangle(ids[i][j], ids[k][l], ids[i][l]);
        } else {
          triangle(ids[i][j], ids[k][j], ids[i][l]);
          triangle(ids[k][j], ids[k][l], ids[i][l]);
        }
      }
    }
  }

  void torus() {
    made_.description = "torus";
    const double tube = between(0.15, 0.4), wave = between(0.05, 0.3), sway = between(0, 0.3);
    const double phase = between(0, kTurn);
    const std::int32_t n = made_.fold;
    fill(grid(
             [=](double u, double v) {
               const double t = kTurn * u, p = kTurn * v, s = p + sway * std::sin(n * t);
               const double r = tube * (1 + wave * std::cos(n * t + phase) * std::cos(2 * p));
               const double out = 1 + r * std::cos(s);
               return Point3{out * std::cos(t), out * std::sin(t), r * std::sin(s)};
             },
             rounds(5, 12), any(9, 28), true),
         true);
  }

  void lobed() {
    made_.description = "lobed";
    const double lobe = between(0.05, 0.35), height = between(0.5, 1.5);
    const std::int32_t n = made_.fold, m = any(1, 4);
    auto ids = grid(
        [=](double u, double v) {
          const double t = kTurn * u, p = std::numbers::pi * v, sine = std::sin(p);
          const double r = sine * (1 + lobe * sine * sine * std::cos(n * t + 0.3));
          return Point3{r * std::cos(t), r * std::sin(t),
                        height * std::cos(p) * (1 + 0.1 * std::cos(m * p))};
        },
        rounds(4, 10), any(8, 25), false);
    for (auto& row : ids) {  // the poles are one vertex each
      row.front() = ids.front().front();
      row.back() = ids.front().back();
    }
    fill(ids, false);
  }

  // Walls of random teeth, some of them divided, between flat rings.
  void gear() {
    made_.description = "gear";
    std::vector<std::pair<double, double>> tooth;  // place, radius
    for (std::int32_t i = any(3, 7); i > 0; --i)
      tooth.emplace_back(random_.uniform(), between(0.8, 1.2));
    std::sort(tooth.begin(), tooth.end());
    std::vector<Point2> outline;
    for (std::int32_t s = 0; s < made_.fold; ++s) {
      for (const auto& [place, radius] : tooth) {
        const double t = kTurn * (s + place) / made_.fold;
        const Point2 next{radius * std::cos(t), radius * std::sin(t)};
        if (!outline.empty() && any(0, 3) == 0) {
          outline.push_back(outline.back() + between(0.2, 0.8) * (next - outline.back()));
        }
        outline.push_back(next);
      }
    }
    const double bore = between(0.2, 0.6), height = between(0.1, 1);
    const auto corner = [&](std::size_t i, double reach, double z) {
      const Point2 p = outline[i];
      const double scale = reach / (reach == 1 ? 1 : std::hypot(p.x, p.y));
      return add({scale * p.x, scale * p.y, z});
    };
    std::vector<std::vector<std::int32_t>> ids;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      ids.push_back(
          {corner(i, 1, 0), corner(i, 1, height), corner(i, bore, height), corner(i, bore, 0)});
    }
    fill(ids, true);
  }

  void twisted() {
    made_.description = "twisted";
    const double lobe = between(0.1, 0.45), twist = between(-1.5, 1.5), height = between(0.5, 2);
    const std::int32_t n = made_.fold, sharp = any(1, 4);
    const auto ids = grid(
        [=](double u, double v) {
          const double r = 1 + lobe * std::tanh(sharp * std::cos(n * kTurn * u));
          const double t = kTurn * u + twist * v;
          return Point3{r * std::cos(t), r * std::sin(t), height * v};
        },
        rounds(6, 14), any(3, 14), false);
    fill(ids, false);
    const std::int32_t bottom = add(kOrigin), top = add({0, 0, height});
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const auto& a = ids[i];
      const auto& b = ids[(i + 1) % ids.size()];
      triangle(bottom, b.front(), a.front());
      triangle(top, a.back(), b.back());
    }
  }

  Random random_;
  RandomSurface made_;
};

}  // namespace

RandomSurface make_random_surface(std::uint64_t seed) {
  return Builder(seed + 0x50f7).build(seed);
}

}  // namespace symcell::test
