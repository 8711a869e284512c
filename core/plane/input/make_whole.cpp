#include "core/plane/input/make_whole.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/base/index.hpp"
#include "core/cell/warning.hpp"
#include "core/geometry/point_grid.hpp"
#include "core/geometry/rotation.hpp"
#include "core/model/describe.hpp"
#include "core/plane/input/curve_set.hpp"
#include "core/plane/input/discretise_arcs.hpp"
#include "core/plane/input/subdomains.hpp"

namespace symcell::plane {
namespace {

// By which areas may differ beyond what chords make of arcs: bounds match to the tolerance.
constexpr double kAreaRel = 1e-3;

// Vertices of two copies that are so many tolerances apart, and more than one, were meant to be one:
// what is left between them would be meshed as a step in the part.
constexpr double kNearMisses = 100;

// The faces of a model, arcs as chords.
struct Faces {
  ChordedPslg chorded;
  Subdomains subdomains;

  [[nodiscard]] const Subdomain& left_of(std::int32_t half_edge) const {
    return subdomains.left_of(half_edge);
  }
  // Segment of the model on which a piece lies.
  [[nodiscard]] std::size_t segment(std::size_t piece) const {
    return at(chorded.source[at(subdomains.map.pieces[piece].segment)]);
  }
  // The side of that segment, from its first vertex to its second, on which a half-edge's face is:
  // 0 left, 1 right.
  [[nodiscard]] std::size_t side(const Pslg& model, std::int32_t half_edge) const {
    const std::size_t p = at(half_edge / 2), c = at(subdomains.map.pieces[p].segment);
    const PslgSegment& chord = chorded.pslg.segments[c];
    const std::vector<Point2>& v = chorded.pslg.vertices;
    const Point2 along =
        v[at(subdomains.map.target(half_edge))] - v[at(subdomains.map.origin(half_edge))];
    bool same = dot(along, v[at(chord.b)] - v[at(chord.a)]) > 0;
    // Chords of arcs that were joined may run against theirs, and then turn the other way.
    if (model.bulge(segment(p)) * chorded.pslg.bulge(c) < 0) same = !same;
    return same ? 0 : 1;
  }
  [[nodiscard]] double area() const {
    double sum = 0;
    for (const Subdomain& face : subdomains.faces) sum += face.meshed ? face.area : 0;
    return sum;
  }
};

// Seeds need not lie in faces of their own yet, so they take no part in cutting arcs.
Result<Faces> faces_of(const Pslg& pslg, const MeshOptions& options, ExecutionContext& context) {
  Faces faces;
  if (pslg.has_arcs()) {
    Pslg seedless = pslg;
    seedless.holes.clear();
    seedless.regions.clear();
    auto made = discretise_arcs(seedless, options, context);
    if (!made) return error_of(made);
    faces.chorded = std::move(*made);
    faces.chorded.pslg.holes = pslg.holes;
    faces.chorded.pslg.regions = pslg.regions;
  } else {
    faces.chorded.pslg = pslg;
    faces.chorded.source.resize(pslg.segments.size());
    std::iota(faces.chorded.source.begin(), faces.chorded.source.end(), 0);
  }
  auto subdomains = make_subdomains(faces.chorded.pslg, context);
  if (!subdomains) return error_of(subdomains);
  faces.subdomains = std::move(*subdomains);
  return faces;
}

Result<Pslg> copies_of(const Pslg& sector, std::int32_t sectors, Point2 centre) {
  if (sectors < 2) {
    return fail(ErrorCode::kBadFold,
                "a model of " + std::to_string(sectors) +
                    " sectors is no sector; give 2 or more, or leave sector out",
                {}, "/options/sector");
  }
  const auto n = static_cast<std::size_t>(sectors);
  if (n * sector.vertices.size() > kMaxPslgVertices ||
      n * sector.segments.size() > 3 * kMaxPslgVertices) {
    return fail(ErrorCode::kTooLarge,
                std::to_string(sectors) + " copies of the sector have more than " +
                    std::to_string(kMaxPslgVertices) + " vertices",
                {}, "/options/sector");
  }
  const RotationTable rotations(sectors);
  Pslg whole;
  whole.marker_names = sector.marker_names;
  whole.notes = sector.notes;
  for (std::int32_t k = 0; k < sectors; ++k) {
    const auto moved = [&](Point2 p) { return centre + rotations.rotate(p - centre, k); };
    const auto first = static_cast<std::int32_t>(whole.vertices.size());
    for (const Point2 p : sector.vertices) whole.vertices.push_back(moved(p));
    for (std::size_t s = 0; s < sector.segments.size(); ++s) {
      PslgSegment segment = sector.segments[s];
      segment.a += first;
      segment.b += first;
      whole.segments.push_back(segment);
      whole.bulges.push_back(sector.bulge(s));
      whole.chord_angles.push_back(sector.chord_angle(s));
    }
    for (const Point2 hole : sector.holes) whole.holes.push_back(moved(hole));
    for (PslgRegion region : sector.regions) {
      region.point = moved(region.point);
      whole.regions.push_back(region);
    }
  }
  return whole;
}

// Copies 0 and all others stand for all pairs.
Result<void> check_near_misses(const Pslg& whole,
                               std::size_t sector_vertices,
                               double tolerance,
                               const MeshOptions& options) {
  PointGrid near(kNearMisses * tolerance, whole.vertices.size());
  for (std::size_t v = sector_vertices; v < whole.vertices.size(); ++v) {
    near.insert(whole.vertices[v], static_cast<std::int32_t>(v));
  }
  double widest = tolerance;
  std::size_t of = 0, other = 0;
  for (std::size_t v = 0; v < sector_vertices; ++v) {
    const std::int32_t met = near.nearest(whole.vertices[v]);
    if (met < 0) continue;
    const double off = distance(whole.vertices[v], whole.vertices[at(met)]);
    if (off <= widest) continue;
    widest = off;
    of = v;
    other = at(met) % sector_vertices;
  }
  if (widest <= tolerance) return {};
  const double tolerance_rel = options.symmetry_tolerance_rel.value_or(kExactSymmetryToleranceRel);
  const double off_rel = widest / tolerance * tolerance_rel;
  return fail(ErrorCode::kNotSymmetric,
              "vertex " + std::to_string(of) + " at " + describe_point(whole.vertices[of]) +
                  " and the copy of vertex " + std::to_string(other) + " in another sector are " +
                  describe_rounded(off_rel) + " of the diameter apart, the tolerance is " +
                  describe_number(tolerance_rel) +
                  "; give symmetry_tolerance=" + describe_number(tolerance_that_takes(off_rel)) +
                  ", or coordinates with more digits",
              {static_cast<std::int64_t>(of), static_cast<std::int64_t>(other)}, "/options/sector");
}

bool same_material(const Pslg& pslg, const Subdomain& left, const Subdomain& right) {
  if (!left.meshed || !right.meshed) return false;
  if ((left.region < 0) != (right.region < 0)) return false;
  if (left.region < 0) return true;
  const PslgRegion& l = pslg.regions[at(left.region)];
  const PslgRegion& r = pslg.regions[at(right.region)];
  return l.attribute == r.attribute && l.max_area == r.max_area;
}

// Per segment of a sector and side of it whether something of it has material there.
std::vector<std::array<char, 2>> sides_with_material(const Pslg& sector, const Faces& faces) {
  std::vector<std::array<char, 2>> sides(sector.segments.size(), {0, 0});
  const auto half_edges = static_cast<std::int32_t>(faces.subdomains.map.face.size());
  for (std::int32_t h = 0; h < half_edges; ++h) {
    if (faces.left_of(h).meshed) sides[faces.segment(at(h / 2))][faces.side(sector, h)] = 1;
  }
  return sides;
}

// Half-way from the middle of a half-edge to what lies on its left.
Point2 place_left_of(const Faces& faces, std::int32_t half_edge) {
  const std::vector<Point2>& vertices = faces.chorded.pslg.vertices;
  const PlanarMap& map = faces.subdomains.map;
  const Point2 a = vertices[at(map.origin(half_edge))], b = vertices[at(map.target(half_edge))];
  const Point2 m = 0.5 * (a + b), inwards{a.y - b.y, b.x - a.x};
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < map.pieces.size(); ++p) {
    if (static_cast<std::int32_t>(p) == half_edge / 2) continue;
    const Point2 c = vertices[at(map.pieces[p].a)], d = vertices[at(map.pieces[p].b)] - c;
    const double turn = cross(inwards, d);
    if (turn == 0) continue;
    const double along = cross(c - m, d) / turn, share = cross(c - m, inwards) / turn;
    if (along > 0 && share >= 0 && share <= 1) nearest = std::min(nearest, along);
  }
  return m + 0.5 * nearest * inwards;
}

// What the copies enclose together and none of them holds, as the bore of a ring, is no material:
// faces round which every curve bounds a single sector, seen from outside.
void add_holes_between(const CurveSet& curves,
                       const std::vector<std::array<char, 2>>& material_sides,
                       const Faces& faces,
                       Pslg& whole) {
  const PlanarMap& map = faces.subdomains.map;
  const std::size_t count = faces.subdomains.faces.size();
  std::vector<char> material(count, 0);
  std::vector<std::int32_t> longest(count, -1);
  std::vector<double> size(count, 0);
  for (std::int32_t h = 0; at(h) < map.face.size(); ++h) {
    const std::size_t face = at(map.face[at(h)]), segment = faces.segment(at(h / 2));
    const CurveSet::Curve& curve = curves.curves()[segment];
    const std::array<char, 2>& sides = material_sides[at(curve.source) % material_sides.size()];
    if (curve.count > 1 || sides[faces.side(whole, h)] != 0) material[face] = 1;
    const std::vector<Point2>& vertices = faces.chorded.pslg.vertices;
    const double length = distance(vertices[at(map.origin(h))], vertices[at(map.target(h))]);
    if (length <= size[face]) continue;
    size[face] = length;
    longest[face] = h;
  }
  for (std::size_t f = 1; f < count; ++f) {
    const Subdomain& face = faces.subdomains.faces[f];
    if (!face.meshed || face.region >= 0 || material[f] != 0 || longest[f] < 0) continue;
    whole.holes.push_back(place_left_of(faces, longest[f]));
  }
}

// Per curve whether it stays: 0 for those that two sectors share and that part nothing.
std::vector<char> curves_that_stay(const CurveSet& curves, const Pslg& whole, const Faces& faces) {
  std::vector<char> stays(curves.curves().size(), 1);
  for (std::size_t i = 0; i < stays.size(); ++i) {
    if (curves.curves()[i].count > 1) stays[i] = 0;
  }
  const PlanarMap& map = faces.subdomains.map;
  for (std::size_t p = 0; p < map.pieces.size(); ++p) {
    const std::size_t s = faces.segment(p);
    if (curves.curves()[s].count < 2) continue;
    const auto h = static_cast<std::int32_t>(2 * p);
    if (!same_material(whole, faces.left_of(h), faces.left_of(h + 1))) stays[s] = 1;
  }
  return stays;
}

// Of the copies of a sound sector.
Failure overlap(const Error& error, std::int32_t sectors) {
  if (is_limit(error.code)) return fail(error);
  return fail(ErrorCode::kNotSymmetric,
              std::to_string(sectors) + " copies of the sector overlap (" + error.message +
                  "); correct the number of sectors or the centre",
              {}, "/options/sector");
}

// Copies that overlap and share parts of their outlines may make a sound model, but not this one.
Result<void> check_area(double all, double one, std::int32_t sectors, const MeshOptions& options) {
  const double wanted = one * sectors;
  if (std::abs(all - wanted) <= (kAreaRel + 2 * options.chord_error_rel) * wanted) return {};
  return fail(ErrorCode::kNotSymmetric,
              std::to_string(sectors) + " copies of the sector cover an area of " +
                  describe_rounded(all) + " and not " + std::to_string(sectors) + " times its " +
                  describe_rounded(one) +
                  ": they overlap or leave gaps; correct the number of sectors or the centre",
              {}, "/options/sector");
}

}  // namespace

Result<Pslg> make_whole(const Pslg& pslg,
                        std::int32_t sectors,
                        Point2 centre,
                        double tolerance,
                        const MeshOptions& options,
                        ExecutionContext& context) {
  auto whole = copies_of(pslg, sectors, centre);
  if (!whole) return error_of(whole);
  SYMCELL_TRY(check_near_misses(*whole, pslg.vertices.size(), tolerance, options));
  CurveSet curves(*whole, tolerance);
  curves.join(std::vector<char>(whole->vertices.size(), 1));
  curves.split();
  if (curves.merge() == 0) {
    return fail(ErrorCode::kNotSymmetric,
                "copies of the sector, turned about " + describe_point(centre) + " by 360/" +
                    std::to_string(sectors) +
                    " degrees, have no bounds in common; correct the number of sectors, the centre "
                    "or the model's two radial sides",
                {}, "/options/sector");
  }
  curves.write(*whole);
  MeshOptions of_one = options;
  of_one.fold = 1;
  const auto sector = faces_of(pslg, of_one, context);
  if (!sector) return error_of(sector);
  auto faces = faces_of(*whole, options, context);
  if (!faces) return overlap(faces.error(), sectors);
  const std::size_t holes = whole->holes.size();
  add_holes_between(curves, sides_with_material(pslg, *sector), *faces, *whole);
  if (whole->holes.size() > holes) {
    faces = faces_of(*whole, options, context);
    if (!faces) return error_of(faces);
  }
  SYMCELL_TRY(check_area(faces->area(), sector->area(), sectors, options));
  curves.remove_curves(curves_that_stay(curves, *whole, *faces));
  curves.write(*whole);
  return whole;
}

}  // namespace symcell::plane
