#include "core/plane/refine/local_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "core/geometry/rotation.hpp"

namespace symcell::plane {
namespace {

// Vertices are found where symmetrising left them: within this share of the diameter, beside the move
// that it reports.
constexpr double kPlaceRel = 1e-9;

// Points at which a segment asks for its size: more than that hardly change what lies between.
constexpr double kMostSourcesOnSegment = 1000;

constexpr const char* kPointer = "/options/sizes";

// The orbit with a copy at `p`, relative to the centre.
std::optional<std::size_t> orbit_at(const SymmetricPslg& symmetric,
                                    const RotationTable& rotations,
                                    Point2 p) {
  const double tolerance =
      (kPlaceRel + 2 * symmetric.symmetry_error_rel) * std::max(symmetric.diameter, length(p));
  std::optional<std::size_t> found;
  double nearest = tolerance;
  for (std::size_t i = 0; i < symmetric.orbit_points.size(); ++i) {
    const Point2 q = symmetric.orbit_points[i];
    if (std::abs(length(q) - length(p)) > nearest) continue;
    const double turn = std::atan2(cross(q, p), dot(q, p)) / (2 * std::numbers::pi);
    const auto k = static_cast<std::int32_t>(std::lround(turn * symmetric.fold));
    const double off = distance(rotations.rotate(q, rotations.reduce(k)), p);
    if (off > nearest) continue;
    nearest = off;
    found = i;
  }
  return found;
}

Result<void> size_segments(const SymmetricPslg& symmetric,
                           const SizeRequest& request,
                           std::vector<double>& of_segment) {
  of_segment.resize(symmetric.segments.size(), kInfinity);
  bool any = false;
  for (std::size_t s = 0; s < of_segment.size(); ++s) {
    if (!symmetric.has_marker(s, request.id)) continue;
    of_segment[s] = std::min(of_segment[s], request.size);
    any = true;
  }
  if (any) return {};
  return fail(ErrorCode::kBadOption,
              "sizes: no segment of the domain has marker " + std::to_string(request.id), {},
              kPointer);
}

}  // namespace

Result<LocalSizes> resolve_sizes(const Pslg& pslg,
                                 const SymmetricPslg& symmetric,
                                 const std::vector<SizeRequest>& sizes) {
  LocalSizes result;
  for (std::size_t s = 0; s < symmetric.segments.size(); ++s) {
    if (!symmetric.segments[s].divided) continue;
    result.kept_segment.resize(symmetric.segments.size(), 0);
    result.kept_segment[s] = 1;
  }
  if (sizes.empty()) return result;
  const RotationTable rotations(symmetric.fold);
  std::vector<std::int64_t> given(symmetric.orbit_points.size(), -1);  // by which vertex
  for (const SizeRequest& request : sizes) {
    if (request.kind == SizeRequest::Kind::kMarker) {
      SYMCELL_TRY(size_segments(symmetric, request, result.of_segment));
      continue;
    }
    result.at_vertex.resize(symmetric.orbit_points.size(), kInfinity);
    const auto vertex = static_cast<std::size_t>(request.id);
    if (request.id < 0 || vertex >= pslg.vertices.size()) {
      return fail(ErrorCode::kBadOption,
                  "sizes: the model has no vertex " + std::to_string(request.id) + "; it has " +
                      std::to_string(pslg.vertices.size()) + ", from 0",
                  {}, kPointer);
    }
    const Point2 p = pslg.vertices[vertex];
    const auto orbit = orbit_at(symmetric, rotations, p - symmetric.centre);
    char place[80];
    std::snprintf(place, sizeof place, "vertex %lld at (%.9g, %.9g)",
                  static_cast<long long>(request.id), p.x, p.y);
    if (!orbit) {
      return fail(ErrorCode::kBadOption,
                  std::string("sizes: ") + place + " is none of the domain that is meshed",
                  {request.id}, kPointer);
    }
    double& size = result.at_vertex[*orbit];
    if (size < kInfinity && size != request.size) {
      return fail(ErrorCode::kBadOption,
                  std::string("sizes: ") + place + " and vertex " + std::to_string(given[*orbit]) +
                      " are copies of each other under the " + std::to_string(symmetric.fold) +
                      "-fold symmetry and cannot have different sizes; give one size, or a fold "
                      "that keeps them apart",
                  {given[*orbit], request.id}, kPointer);
    }
    size = request.size;
    given[*orbit] = request.id;
  }
  return result;
}

GradedSize grade_sizes(const QuotientTriangulation& initial,
                       const LocalSizes& sizes,
                       double gradation,
                       double least) {
  std::vector<double> size(initial.vertex_slots(), kInfinity);
  for (std::size_t v = 0; v < sizes.at_vertex.size(); ++v) size[v] = sizes.at_vertex[v];
  std::vector<GradedSize::Source> sources;
  const auto add_copies = [&](Point2 p, bool is_centre, double h) {
    for (std::int32_t k = 0; k < (is_centre ? 1 : initial.fold()); ++k) {
      sources.push_back({initial.rotations().rotate(p, k), h});
    }
  };
  for (TriangleId t = 0; t < initial.triangle_slots(); ++t) {
    if (!initial.alive(t)) continue;
    const Triangle& tri = initial.triangle(t);
    for (std::uint32_t j = 0; j < 3; ++j) {
      const std::uint32_t i = next3(j), k = prev3(j);
      const Point2 a = initial.corner_point(tri, i), b = initial.corner_point(tri, k);
      double h = distance(a, b);
      if (tri.seg[j] != kNoSubsegment && !sizes.of_segment.empty()) {
        const auto parent = static_cast<std::size_t>(initial.subsegment(tri.seg[j]).parent);
        const double wanted = sizes.of_segment[parent];
        // Between its ends a segment asks for its size, too.
        const double parts = std::min(h / wanted, kMostSourcesOnSegment);
        const auto inner = static_cast<std::int32_t>(std::ceil(parts)) - 1;
        for (std::int32_t n = 1; n <= inner; ++n)
          add_copies(a + (n / parts) * (b - a), false, wanted);
        h = std::min(h, wanted);
      }
      for (const std::uint32_t end : {i, k}) {
        double& shortest = size[static_cast<std::size_t>(tri.v[end])];
        shortest = std::min(shortest, h);
      }
    }
  }
  for (std::size_t v = 0; v < size.size(); ++v) {
    const auto id = static_cast<VertexId>(v);
    if (size[v] == kInfinity) continue;
    add_copies(initial.point(id), id == initial.centre(), std::max(size[v], least));
  }
  return {std::move(sources), gradation};
}

}  // namespace symcell::plane
