#include "core/plane/input/curve_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "core/base/index.hpp"
#include "core/geometry/arc.hpp"
#include "core/geometry/box_tree.hpp"
#include "core/geometry/point_grid.hpp"
#include "core/geometry/point_tree.hpp"

namespace symcell::plane {
namespace {

// A curve by its ends, as geometry.
struct Shape {
  Point2 a, b;
  double bulge = 0;
  Point2 centre;  // of an arc
  double radius = 0;
  double angle = 0;

  Shape(Point2 from, Point2 to, double with) : a(from), b(to), bulge(with) {
    if (bulge == 0) return;
    centre = arc_centre(a, b, bulge);
    radius = arc_radius(a, b, bulge);
    angle = angle_of_bulge(bulge);
  }

  // The share of the way from a at which the curve passes p, if it does within `tolerance`;
  // below 0 or above 1 where it does not.
  [[nodiscard]] double share_at(Point2 p, double tolerance) const {
    constexpr double kNone = -1;
    if (bulge == 0) {
      const Point2 d = b - a;
      const double size = length(d);
      if (std::abs(cross(d, p - a)) > tolerance * size) return kNone;
      return dot(p - a, d) / (size * size);
    }
    const Point2 u = a - centre, v = p - centre;
    if (std::abs(length(v) - radius) > tolerance) return kNone;
    double turn = std::copysign(1, angle) * std::atan2(cross(u, v), dot(u, v));
    if (turn < -tolerance / radius) turn += 2 * std::numbers::pi;
    return turn / std::abs(angle);
  }

  [[nodiscard]] Box3 box(double margin) const {
    Point2 low{std::min(a.x, b.x), std::min(a.y, b.y)},
        high{std::max(a.x, b.x), std::max(a.y, b.y)};
    if (bulge != 0) {
      for (int k = 0; k < 4; ++k) {
        const double t = k * std::numbers::pi / 2;
        const Point2 p = centre + radius * Point2{std::cos(t), std::sin(t)};
        const double share = share_at(p, 1e-9 * radius);
        if (!(share > 0 && share < 1)) continue;
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    }
    return {{low.x - margin, low.y - margin, 0}, {high.x + margin, high.y + margin, 0}};
  }
};

struct Places {
  std::array<Point2, 2> place;
  int count = 0;
  void add(Point2 p) { place[static_cast<std::size_t>(count++)] = p; }
};

void meet_lines(const Shape& s, const Shape& t, Places& out) {
  const Point2 d = s.b - s.a, e = t.b - t.a;
  const double turn = cross(d, e);
  // Parallel lines overlap if at all, and then end on each other.
  if (std::abs(turn) <= 1e-12 * length(d) * length(e)) return;
  out.add(s.a + cross(t.a - s.a, e) / turn * d);
}

void meet_line_and_circle(const Shape& line, const Shape& arc, double tolerance, Places& out) {
  const Point2 d = line.b - line.a;
  const double size2 = squared_length(d);
  const Point2 foot = line.a + dot(arc.centre - line.a, d) / size2 * d;
  const double off = distance(foot, arc.centre);
  if (off > arc.radius + tolerance) return;
  const double half = std::sqrt(std::max(0.0, (arc.radius - off) * (arc.radius + off) / size2));
  // Touching: one place.
  if (std::abs(off - arc.radius) <= tolerance) return out.add(foot);
  out.add(foot + half * d);
  out.add(foot - half * d);
}

void meet_circles(const Shape& s, const Shape& t, double tolerance, Places& out) {
  const Point2 d = t.centre - s.centre;
  const double apart = length(d);
  if (apart <= tolerance) return;  // one centre: they overlap, if at all
  if (apart > s.radius + t.radius + tolerance) return;
  if (apart < std::abs(s.radius - t.radius) - tolerance) return;
  const double along =
      (apart * apart + (s.radius - t.radius) * (s.radius + t.radius)) / (2 * apart);
  const Point2 foot = s.centre + along / apart * d;
  const double square = (s.radius - along) * (s.radius + along);
  if (!(square > tolerance * tolerance)) return out.add(foot);
  const double half = std::sqrt(square) / apart;
  out.add(foot + half * Point2{-d.y, d.x});
  out.add(foot - half * Point2{-d.y, d.x});
}

Places places_where_meet(const Shape& s, const Shape& t, double tolerance) {
  Places out;
  if (s.bulge == 0 && t.bulge == 0) {
    meet_lines(s, t, out);
  } else if (s.bulge == 0) {
    meet_line_and_circle(s, t, tolerance, out);
  } else if (t.bulge == 0) {
    meet_line_and_circle(t, s, tolerance, out);
  } else {
    meet_circles(s, t, tolerance, out);
  }
  return out;
}

bool passes(const Shape& s, Point2 p, double tolerance) {
  const double share = s.share_at(p, tolerance);
  return share >= 0 && share <= 1;
}

}  // namespace

std::vector<Point2> meeting_places(const Pslg& pslg,
                                   std::size_t s,
                                   std::size_t t,
                                   double tolerance) {
  const auto shape = [&](std::size_t i) {
    const PslgSegment& segment = pslg.segments[i];
    return Shape(pslg.vertices[at(segment.a)], pslg.vertices[at(segment.b)], pslg.bulge(i));
  };
  const Shape first = shape(s), second = shape(t);
  const Places places = places_where_meet(first, second, tolerance);
  std::vector<Point2> result;
  for (int i = 0; i < places.count; ++i) {
    const Point2 p = places.place[static_cast<std::size_t>(i)];
    if (passes(first, p, tolerance) && passes(second, p, tolerance)) result.push_back(p);
  }
  return result;
}

std::vector<std::int32_t> degrees_of(const Pslg& pslg) {
  std::vector<std::int32_t> degrees(pslg.vertices.size(), 0);
  for (const PslgSegment& s : pslg.segments) {
    ++degrees[at(s.a)];
    ++degrees[at(s.b)];
  }
  return degrees;
}

CurveSet::CurveSet(const Pslg& pslg, double tolerance)
    : tolerance_(tolerance), vertices_(pslg.vertices) {
  curves_.reserve(pslg.segments.size());
  for (std::size_t s = 0; s < pslg.segments.size(); ++s) {
    const PslgSegment& segment = pslg.segments[s];
    curves_.push_back({segment.a, segment.b, segment.marker, pslg.bulge(s), pslg.chord_angle(s),
                       static_cast<std::int32_t>(s), 1});
  }
}

CurveSet::Joined CurveSet::join(const std::vector<char>& may) {
  Joined joined;
  std::vector<std::int32_t> target(vertices_.size());
  PointGrid grid(tolerance_, vertices_.size());
  // First those that stay: a vertex that may move goes to them, whatever their numbers.
  for (const bool moves : {false, true}) {
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      if ((may[v] != 0) != moves) continue;
      const auto id = static_cast<std::int32_t>(v);
      const std::int32_t near = moves ? grid.nearest(vertices_[v]) : -1;
      target[v] = near >= 0 ? near : id;
      if (near < 0) {
        grid.insert(vertices_[v], id);
        continue;
      }
      ++joined.vertices;
      joined.widest = std::max(joined.widest, distance(vertices_[v], vertices_[at(near)]));
    }
  }
  if (joined.vertices > 0) renumber(target);
  return joined;
}

// `target`: per vertex the one that it becomes, itself if it stays.
void CurveSet::renumber(const std::vector<std::int32_t>& target) {
  std::vector<std::int32_t> number(vertices_.size(), -1);
  std::vector<Point2> kept;
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    if (target[v] != static_cast<std::int32_t>(v)) continue;
    number[v] = static_cast<std::int32_t>(kept.size());
    kept.push_back(vertices_[v]);
  }
  for (Curve& c : curves_) {
    c.a = number[at(target[at(c.a)])];
    c.b = number[at(target[at(c.b)])];
  }
  std::erase_if(curves_, [](const Curve& c) { return c.a == c.b; });
  vertices_ = std::move(kept);
}

Result<std::size_t> CurveSet::add_crossings(ExecutionContext& context) {
  std::vector<Shape> shapes;
  std::vector<Box3> boxes;
  for (const Curve& c : curves_) {
    shapes.emplace_back(vertices_[at(c.a)], vertices_[at(c.b)], c.bulge);
    boxes.push_back(shapes.back().box(tolerance_));
  }
  PointGrid grid(tolerance_, 2 * vertices_.size());
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    grid.insert(vertices_[v], static_cast<std::int32_t>(v));
  }
  const BoxTree tree(boxes);
  const std::size_t before = vertices_.size();
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    if (s % 256 == 0) {
      SYMCELL_TRY(context.check());
    }
    std::vector<std::int32_t> others;
    tree.visit(boxes[s], [&](std::int32_t t) {
      if (at(t) > s) others.push_back(t);
    });
    std::sort(others.begin(), others.end());
    for (const std::int32_t t : others) {
      const Places places = places_where_meet(shapes[s], shapes[at(t)], tolerance_);
      for (int i = 0; i < places.count; ++i) {
        const Point2 p = places.place[static_cast<std::size_t>(i)];
        if (!passes(shapes[s], p, tolerance_) || !passes(shapes[at(t)], p, tolerance_)) continue;
        if (grid.nearest(p) >= 0) continue;
        if (vertices_.size() >= kMaxPslgVertices) {
          return fail(ErrorCode::kTooLarge, "the segments cross in more than " +
                                                std::to_string(kMaxPslgVertices) + " places");
        }
        grid.insert(p, static_cast<std::int32_t>(vertices_.size()));
        vertices_.push_back(p);
      }
    }
  }
  return vertices_.size() - before;
}

std::size_t CurveSet::split() {
  std::vector<Point3> places;
  places.reserve(vertices_.size());
  for (const Point2 p : vertices_) places.push_back({p.x, p.y, 0});
  const PointTree tree(places);
  std::size_t cuts = 0;
  std::vector<Curve> parts;
  std::vector<std::pair<double, std::int32_t>> on;
  for (const Curve& c : curves_) {
    const Shape shape(vertices_[at(c.a)], vertices_[at(c.b)], c.bulge);
    const Box3 box = shape.box(tolerance_);
    on.clear();
    tree.within_box(box.low, box.high, [&](std::int32_t v) {
      if (v == c.a || v == c.b) return;
      const double share = shape.share_at(vertices_[at(v)], tolerance_);
      if (share > 0 && share < 1) on.emplace_back(share, v);
    });
    std::sort(on.begin(), on.end());
    cuts += on.size();
    on.emplace_back(1, c.b);
    double from = 0;
    Curve part = c;
    for (const auto& [share, v] : on) {
      part.b = v;
      if (c.bulge != 0) part.bulge = bulge_of_angle((share - from) * shape.angle);
      parts.push_back(part);
      part.a = v;
      from = share;
    }
  }
  curves_ = std::move(parts);
  return cuts;
}

// Whether their middles are the same place, of curves between the same vertices.
bool CurveSet::alike(const Curve& x, const Curve& y) const {
  const auto middle = [&](const Curve& c) {
    return arc_middle(vertices_[at(c.a)], vertices_[at(c.b)], c.bulge);
  };
  return distance(middle(x), middle(y)) <= 2 * tolerance_;
}

std::size_t CurveSet::merge() {
  std::vector<std::size_t> order(curves_.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto key = [&](std::size_t i) {
    const Curve& c = curves_[i];
    const auto ends = std::minmax(c.a, c.b);
    // Lines and arcs by their bulges, so that equal ones stand together.
    return std::tuple(ends.first, ends.second, c.a < c.b ? c.bulge : -c.bulge, i);
  };
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return key(i) < key(j); });
  std::vector<char> keep(curves_.size(), 1);
  std::size_t merged = 0;
  for (std::size_t i = 0; i < order.size();) {
    Curve& first = curves_[order[i]];
    std::size_t j = i + 1;
    for (; j < order.size(); ++j) {
      const Curve& other = curves_[order[j]];
      if (std::minmax(other.a, other.b) != std::minmax(first.a, first.b)) break;
      if (!alike(first, other)) break;
      if (other.marker != 0 && (first.marker == 0 || other.marker < first.marker)) {
        first.marker = other.marker;
      }
      first.count += other.count;
      keep[order[j]] = 0;
      ++merged;
    }
    i = j;
  }
  std::size_t out = 0;
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    if (keep[i] != 0) curves_[out++] = curves_[i];
  }
  curves_.resize(out);
  return merged;
}

void CurveSet::remove_curves(const std::vector<char>& keep) {
  std::vector<char> had(vertices_.size(), 0), has(vertices_.size(), 0);
  std::size_t out = 0;
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    const Curve c = curves_[i];
    had[at(c.a)] = had[at(c.b)] = 1;
    if (keep[i] == 0) continue;
    has[at(c.a)] = has[at(c.b)] = 1;
    curves_[out++] = c;
  }
  curves_.resize(out);
  std::vector<std::int32_t> target(vertices_.size());
  for (std::size_t v = 0; v < target.size(); ++v) {
    target[v] = had[v] != 0 && has[v] == 0 ? -1 : static_cast<std::int32_t>(v);
  }
  renumber(target);
}

void CurveSet::write(Pslg& pslg) const {
  pslg.vertices = vertices_;
  pslg.segments.clear();
  pslg.bulges.clear();
  pslg.chord_angles.clear();
  for (const Curve& c : curves_) {
    pslg.segments.push_back({c.a, c.b, c.marker});
    pslg.bulges.push_back(c.bulge);
    pslg.chord_angles.push_back(c.chord_angle);
  }
  if (!pslg.has_arcs()) {
    pslg.bulges.clear();
    pslg.chord_angles.clear();
  }
}

}  // namespace symcell::plane
