#include "core/solid/surface/weld.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/base/union_find.hpp"

namespace symcell::solid {
namespace {

bool lexicographic(const Point3& p, const Point3& q) {
  return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
}

bool has_equal_corners(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

// Smallest corner first, cyclic order kept.
Triangle rotated_to_smallest(const Triangle& t) {
  if (t[1] < t[0] && t[1] < t[2]) return {t[1], t[2], t[0]};
  if (t[2] < t[0] && t[2] < t[1]) return {t[2], t[0], t[1]};
  return t;
}

// Per point: the first one at the same place.
std::vector<std::int32_t> first_of_equals(const std::vector<Point3>& points) {
  struct Place {
    Point3 p;
    std::int32_t index;
  };
  std::vector<Place> places;
  places.reserve(points.size());
  for (const Point3& p : points) places.push_back({p, static_cast<std::int32_t>(places.size())});
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.p == b.p ? a.index < b.index : lexicographic(a.p, b.p);
  });
  std::vector<std::int32_t> first(points.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const bool same = k > 0 && places[k].p == places[k - 1].p;
    first[places[k].index] = same ? first[places[k - 1].index] : places[k].index;
  }
  return first;
}

// `group[i]`: any label of the cluster of point i; clusters are numbered by first use.
IndexedSurface merge_points(const IndexedSurface& surface, const std::vector<std::int32_t>& group) {
  IndexedSurface merged;
  std::vector<std::int32_t> number(surface.points.size(), -1);
  std::vector<Point3> sums;
  std::vector<std::int32_t> counts;
  std::vector<std::int32_t> of_point(surface.points.size());
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    std::int32_t& n = number[group[i]];
    if (n < 0) {
      n = static_cast<std::int32_t>(merged.points.size());
      merged.points.push_back(surface.points[i]);
      sums.push_back({});
      counts.push_back(0);
    }
    of_point[i] = n;
    // Relative to the cluster's first point: no digits are lost far from the origin.
    sums[n] = sums[n] + (surface.points[i] - merged.points[n]);
    ++counts[n];
  }
  for (std::size_t n = 0; n < sums.size(); ++n) {
    if (counts[n] > 1) merged.points[n] = merged.points[n] + (1.0 / counts[n]) * sums[n];
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& v = surface.triangles[t];
    const Triangle w{of_point[v[0]], of_point[v[1]], of_point[v[2]]};
    if (has_equal_corners(w)) continue;
    merged.triangles.push_back(w);
    merged.source.push_back(surface.source[t]);
  }
  return merged;
}

}  // namespace

IndexedSurface weld_exactly(const TriangleSurface& surface) {
  IndexedSurface all;
  all.points.reserve(surface.vertices.size());
  // Adding 0 turns -0 into 0.
  for (const Point3& p : surface.vertices) all.points.push_back({p.x + 0.0, p.y + 0.0, p.z + 0.0});
  all.triangles = surface.triangles;
  all.source = surface.source_face;
  if (all.source.empty()) {
    all.source.resize(all.triangles.size());
    std::iota(all.source.begin(), all.source.end(), 0);
  }
  return weld_exactly(all);
}

IndexedSurface weld_exactly(const IndexedSurface& surface) {
  IndexedSurface merged = merge_points(surface, first_of_equals(surface.points));
  drop_unused_points(merged);
  return merged;
}

IndexedSurface weld_within(const IndexedSurface& surface, double tolerance) {
  const auto& points = surface.points;
  UnionFind near(points.size());
  std::vector<std::int32_t> order(points.size());
  std::iota(order.begin(), order.end(), std::int32_t{0});
  // Sweep along x: each point meets those whose x is not farther than the tolerance.
  std::sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) {
    return points[i] == points[j] ? i < j : lexicographic(points[i], points[j]);
  });
  // Planes x = const hold many points: cells of y and z, as wide as the tolerance, keep it fast.
  struct Cell {
    std::int64_t y, z;
    std::int32_t point;
  };
  const double width = 2 * tolerance;
  const Box3 box = bounding_box(points);
  const auto row = [width](double offset) {
    return static_cast<std::int64_t>(std::floor(offset / width));
  };
  std::vector<Cell> cells;
  cells.reserve(8 * points.size());
  // Each point is put into the cells of the grid that its ball meets (four in y, z at most).
  for (const std::int32_t i : order) {
    const Point3 p = points[i] - box.low;
    const std::int64_t y0 = row(p.y - tolerance), y1 = row(p.y + tolerance);
    const std::int64_t z0 = row(p.z - tolerance), z1 = row(p.z + tolerance);
    for (std::int64_t y = y0; y <= y1; ++y) {
      for (std::int64_t z = z0; z <= z1; ++z) cells.push_back({y, z, i});
    }
  }
  std::stable_sort(cells.begin(), cells.end(),
                   [](const Cell& a, const Cell& b) { return a.y != b.y ? a.y < b.y : a.z < b.z; });
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const Point3& p = points[cells[k].point];
    for (std::size_t m = k + 1; m < cells.size(); ++m) {
      if (cells[m].y != cells[k].y || cells[m].z != cells[k].z) break;
      const Point3& q = points[cells[m].point];
      if (q.x - p.x > tolerance) break;
      if (squared_distance(p, q) > tolerance * tolerance) continue;
      near.join(cells[k].point, cells[m].point);
    }
  }
  std::vector<std::int32_t> group(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    group[i] = near.root(static_cast<std::int32_t>(i));
  }
  IndexedSurface merged = merge_points(surface, group);
  drop_doubled_triangles(merged);
  drop_unused_points(merged);
  return merged;
}

std::vector<Point3> drop_doubled_triangles(IndexedSurface& surface, IndexedSurface* cancelled) {
  struct Entry {
    Triangle corners;  // ascending
    std::int32_t triangle;
    bool even;  // the triangle's cyclic order is the ascending one
  };
  std::vector<Entry> entries;
  entries.reserve(surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Triangle first = rotated_to_smallest(surface.triangles[t]);
    const bool even = first[1] < first[2];
    const Triangle ascending = even ? first : Triangle{first[0], first[2], first[1]};
    entries.push_back({ascending, static_cast<std::int32_t>(t), even});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.corners, a.triangle) < std::tie(b.corners, b.triangle);
  });
  std::vector<bool> dropped(surface.triangles.size(), false);
  for (auto begin = entries.begin(); begin != entries.end();) {
    bool has_even = false, has_odd = false;
    auto end = begin;
    for (; end != entries.end() && end->corners == begin->corners; ++end) {
      (end->even ? has_even : has_odd) = true;
    }
    if (!(has_even && has_odd)) {
      ++begin;
    } else if (cancelled != nullptr) {
      cancelled->triangles.push_back(surface.triangles[begin->triangle]);
      cancelled->source.push_back(surface.source[begin->triangle]);
    }
    for (; begin != end; ++begin) dropped[begin->triangle] = true;
  }
  std::size_t out = 0;
  std::vector<Point3> places;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (dropped[t]) {
      places.push_back(surface.points[surface.triangles[t][0]]);
      continue;
    }
    surface.triangles[out] = surface.triangles[t];
    surface.source[out] = surface.source[t];
    ++out;
  }
  surface.triangles.resize(out);
  surface.source.resize(out);
  return places;
}

std::size_t restore_needed(IndexedSurface& surface, const IndexedSurface& cancelled) {
  std::vector<Triangle> all = cancelled.triangles;
  const auto count = static_cast<std::int32_t>(all.size());
  all.insert(all.end(), surface.triangles.begin(), surface.triangles.end());
  const std::vector<EdgeUse> uses = sorted_edge_uses(all);
  // Neighbours among the cancelled, where nothing else has the edge; elsewhere one other triangle
  // must be waiting there for a group to be needed.
  UnionFind groups(all.size());
  std::vector<bool> fits(all.size(), true), waited_for(all.size(), false);
  for (const bool joining : {true, false}) {
    for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
      std::vector<std::int32_t> back;
      for (std::size_t i = begin; i < end; ++i) {
        if (uses[i].triangle < count) back.push_back(uses[i].triangle);
      }
      if (back.empty()) return;
      const std::size_t others = end - begin - back.size();
      if (joining && others == 0 && back.size() == 2) groups.join(back[0], back[1]);
      if (joining || (others == 0 && back.size() == 2)) return;
      if (others == 1 && back.size() == 1) {
        waited_for[groups.root(back[0])] = true;
        return;
      }
      for (const std::int32_t t : back) fits[groups.root(t)] = false;
    });
  }
  std::size_t restored = 0;
  for (std::int32_t t = 0; t < count; ++t) {
    const std::int32_t group = groups.root(t);
    if (!fits[group] || !waited_for[group]) continue;
    surface.triangles.push_back(cancelled.triangles[t]);
    surface.source.push_back(cancelled.source[t]);
    ++restored;
  }
  return restored;
}

void drop_unused_points(IndexedSurface& surface) {
  std::vector<std::int32_t> number(surface.points.size(), -1);
  for (const Triangle& t : surface.triangles) {
    for (const std::int32_t v : t) number[v] = 0;
  }
  std::int32_t next = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] < 0) continue;
    surface.points[next] = surface.points[i];
    number[i] = next++;
  }
  surface.points.resize(static_cast<std::size_t>(next));
  for (Triangle& t : surface.triangles) {
    for (std::int32_t& v : t) v = number[v];
  }
}

}  // namespace symcell::solid
