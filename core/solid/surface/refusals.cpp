#include "core/solid/surface/refusals.hpp"

#include <algorithm>

#include "core/model/describe.hpp"

namespace symcell::solid {
namespace {

constexpr std::size_t kNamed = 5;     // edges, pairs or places named in a message
constexpr std::size_t kPlaces = 3;    // of a mend
constexpr std::size_t kListed = 100;  // edges or pairs whose triangles are listed in an error

template <class Wanted>
std::vector<OddEdge> edges_of(const IndexedSurface& surface, const Wanted& wanted) {
  std::vector<OddEdge> edges;
  const std::vector<EdgeUse> uses = sorted_edge_uses(surface.triangles);
  for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
    if (!wanted(end - begin)) return;
    edges.push_back({uses[begin].low, uses[begin].high, uses[begin].triangle, end - begin});
  });
  return edges;
}

}  // namespace

std::vector<OddEdge> odd_edges(const IndexedSurface& surface) {
  return edges_of(surface, [](std::size_t uses) { return uses % 2 == 1; });
}

std::vector<OddEdge> branching_edges(const IndexedSurface& surface) {
  return edges_of(surface, [](std::size_t uses) { return uses > 2 && uses % 2 == 0; });
}

std::string plural(std::size_t count, const std::string& noun) {
  const std::string counted = std::to_string(count) + " ";
  if (count == 1) return counted + noun;
  if (noun.ends_with("ex")) return counted + noun.substr(0, noun.size() - 2) + "ices";
  return counted + noun + "s";
}

std::string such_as_at(std::span<const Point3> places) {
  std::string text;
  for (std::size_t i = 0; i < places.size() && i < kPlaces; ++i) {
    text += (i == 0 ? (places.size() > kPlaces ? ", such as at " : " at ") : "; ") +
            describe_point(places[i]);
  }
  return text;
}

std::string near_triangle(const IndexedSurface& surface, std::int32_t triangle) {
  const Triangle& v = surface.triangles[triangle];
  const Point3 middle =
      (1.0 / 3) * (surface.points[v[0]] + surface.points[v[1]] + surface.points[v[2]]);
  return " near " + describe_point(middle);
}

std::vector<std::int64_t> listed(std::vector<std::int64_t> triangles) {
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  // Triangles that mending made have no number in the file.
  if (!triangles.empty() && triangles.front() < 0) triangles.erase(triangles.begin());
  return triangles;
}

Error refuse_open(const IndexedSurface& surface,
                  const std::vector<OddEdge>& edges,
                  const std::string& help) {
  std::string message = "the surface is not closed: " + plural(edges.size(), "edge") +
                        (edges.size() == 1 ? " does" : " do") + " not have two triangles, such as";
  std::vector<std::int64_t> elements;
  for (std::size_t i = 0; i < edges.size() && i < kNamed; ++i) {
    const OddEdge& e = edges[i];
    message += (i == 0 ? " " : "; ") + std::string("the edge from ") +
               describe_point(surface.points[e.a]) + " to " + describe_point(surface.points[e.b]) +
               " of triangle " + std::to_string(surface.source[e.triangle]) + " (" +
               plural(e.uses, "triangle") + ")";
  }
  for (std::size_t i = 0; i < edges.size() && i < kListed; ++i) {
    elements.push_back(surface.source[edges[i].triangle]);
  }
  return {ErrorCode::kNotWatertight, message + ". " + help, listed(std::move(elements)), {}};
}

Error refuse_touching(const IndexedSurface& surface,
                      std::span<const Point3> places,
                      const std::string& help) {
  const std::vector<OddEdge> edges = branching_edges(surface);
  if (!edges.empty()) return refuse_open(surface, edges, help);
  return {ErrorCode::kSelfIntersection,
          "the solid touches itself at " + plural(places.size(), "corner") + such_as_at(places) +
              ". " + help,
          {},
          {}};
}

Error refuse_intersecting(const IndexedSurface& surface,
                          std::span<const std::pair<std::int32_t, std::int32_t>> pairs,
                          bool more,
                          const std::string& reason,
                          const std::string& help) {
  std::string message = std::string("the surface intersects itself: ") +
                        (more ? "more than " : "") + plural(pairs.size(), "pair") +
                        " of triangles, such as";
  std::vector<std::int64_t> elements;
  for (std::size_t i = 0; i < pairs.size() && i < kListed; ++i) {
    const auto [s, t] = pairs[i];
    elements.push_back(surface.source[s]);
    elements.push_back(surface.source[t]);
    if (i >= kNamed) continue;
    message += (i == 0 ? " " : "; ") + std::to_string(surface.source[s]) + " and " +
               std::to_string(surface.source[t]) + near_triangle(surface, s);
  }
  if (!reason.empty()) message += "; " + reason;
  return {ErrorCode::kSelfIntersection, message + ". " + help, listed(std::move(elements)), {}};
}

}  // namespace symcell::solid
