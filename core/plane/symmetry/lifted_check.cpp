#include "core/plane/symmetry/lifted_check.hpp"

#include <memory>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/rotation.hpp"
#include "core/model/describe.hpp"
#include "core/plane/input/planar_map.hpp"

namespace symcell::plane {
namespace {

Failure degenerate(const std::string& what) {
  return fail(ErrorCode::kNotSymmetric,
              what +
                  " once the vertices are moved to symmetric places; lower the symmetry tolerance, "
                  "or mend the model where it is nearly degenerate");
}

// What each face of the lifted PSLG is meant to be, by the segments round it.
Result<std::vector<std::int32_t>> face_labels(const Pslg& lifted,
                                              const PlanarMap& map,
                                              const std::vector<ClosedOrbits::Sides>& sides) {
  constexpr std::int32_t kUnknown = kNotMeshed - 1;  // no segment of the face seen yet
  std::vector<std::int32_t> labels(at(map.face_count), kUnknown);
  labels.front() = kNotMeshed;
  for (std::size_t p = 0; p < map.pieces.size(); ++p) {
    const PlanarPiece& piece = map.pieces[p];
    ClosedOrbits::Sides side = sides[at(piece.segment)];
    if (lifted.segments[at(piece.segment)].a != piece.a) std::swap(side.left, side.right);
    std::int32_t& left = labels[at(map.face[2 * p])];
    std::int32_t& right = labels[at(map.face[2 * p + 1])];
    if ((left != kUnknown && left != side.left) || (right != kUnknown && right != side.right)) {
      return degenerate("subdomains of different kinds run together");
    }
    left = side.left;
    right = side.right;
  }
  return labels;
}

// Chooses the seeds: a hole seed for each bounded face that is not meshed, a region seed for each
// face that has one in the input.
class Seeding {
 public:
  Seeding(const Pslg& lifted, const PlanarMap& map, const std::vector<std::int32_t>& labels)
      : lifted_(lifted), map_(map), labels_(labels) {}

  void run(SymmetricPslg& pslg) {
    find_present();
    std::vector<Point2> holes;
    std::vector<PslgRegion> regions;
    for (std::int32_t face = 1; face < map_.face_count; ++face) {
      const std::int32_t label = labels_[at(face)];
      if (label == kNotMeshed) holes.push_back(seed_in(face));
      if (label < 0) continue;
      PslgRegion region = lifted_.regions[at(label)];
      region.point = seed_in(face);
      regions.push_back(region);
    }
    pslg.holes = std::move(holes);
    pslg.regions = std::move(regions);
  }

 private:
  // A seed of the right kind in each face, where there is one.
  void find_present() {
    present_.assign(labels_.size(), -1);
    const std::size_t holes = lifted_.holes.size();
    for (std::size_t q = 0; q < map_.query_face.size(); ++q) {
      const std::int32_t face = map_.query_face[q];
      if (face <= 0 || present_[at(face)] >= 0) continue;
      if ((q < holes) == (labels_[at(face)] == kNotMeshed)) {
        present_[at(face)] = static_cast<std::int32_t>(q);
      }
    }
  }

  Point2 seed_in(std::int32_t face) {
    const std::int32_t query = present_[at(face)];
    if (query < 0) return interior_point(face);
    const std::size_t holes = lifted_.holes.size();
    return at(query) < holes ? lifted_.holes[at(query)] : lifted_.regions[at(query) - holes].point;
  }

  // Beside the middle of the face's longest segment, nearer to it than to any other.
  Point2 interior_point(std::int32_t face) {
    if (index_ == nullptr) prepare_search();
    const std::int32_t h = longest_[at(face)];
    const Point2 a = lifted_.vertices[at(map_.origin(h))];
    const Point2 u = lifted_.vertices[at(map_.target(h))] - a;
    const Point2 middle = a + 0.5 * u;
    const double size = length(u);
    const auto other = [h](std::int32_t piece) { return piece != h >> 1; };
    const double room = std::min(size, index_->nearest(middle, size, other).distance);
    return middle + (0.5 * room / size) * Point2{-u.y, u.x};
  }

  void prepare_search() {
    std::vector<IndexedSegment> pieces;
    pieces.reserve(map_.pieces.size());
    longest_.assign(labels_.size(), -1);
    std::vector<double> size(labels_.size(), -1);
    for (std::size_t p = 0; p < map_.pieces.size(); ++p) {
      const Point2 a = lifted_.vertices[at(map_.pieces[p].a)];
      const Point2 b = lifted_.vertices[at(map_.pieces[p].b)];
      pieces.push_back({a, b});
      for (const std::size_t h : {2 * p, 2 * p + 1}) {
        const std::size_t face = at(map_.face[h]);
        if (distance(a, b) <= size[face]) continue;
        size[face] = distance(a, b);
        longest_[face] = static_cast<std::int32_t>(h);
      }
    }
    index_ = std::make_unique<SegmentIndex>(pieces);
  }

  const Pslg& lifted_;
  const PlanarMap& map_;
  const std::vector<std::int32_t>& labels_;
  std::vector<std::int32_t> present_;  // per face: query, -1
  std::vector<std::int32_t> longest_;  // per face: half-edge
  std::unique_ptr<SegmentIndex> index_;
};

}  // namespace

Pslg lift_pslg(const SymmetricPslg& symmetric) {
  const RotationTable rotations(symmetric.fold);
  const std::int32_t fold = symmetric.fold;
  const auto orbits = static_cast<std::int32_t>(symmetric.orbit_points.size());
  Pslg lifted;
  // The centre has one copy: orbits behind it move up by one orbit.
  const std::int32_t centre = symmetric.centre_orbit;
  const auto index_of = [&](OrbitVertex v, std::int32_t turn) {
    if (v.orbit == centre) return (orbits - 1) * fold;
    const std::int32_t row = centre >= 0 && v.orbit > centre ? v.orbit - 1 : v.orbit;
    return row * fold + rotations.add(v.exponent, turn);
  };
  for (std::int32_t o = 0; o < orbits; ++o) {
    if (o == centre) continue;
    for (std::int32_t k = 0; k < fold; ++k) {
      lifted.vertices.push_back(rotations.rotate(symmetric.orbit_points[at(o)], k));
    }
  }
  if (centre >= 0) lifted.vertices.push_back({0, 0});
  for (std::size_t s = 0; s < symmetric.segments.size(); ++s) {
    const SymmetricSegment& segment = symmetric.segments[s];
    for (std::int32_t k = 0; k < fold; ++k) {
      lifted.segments.push_back(
          {index_of(segment.a, k), index_of(segment.b, k), symmetric.segment_marker(s, k)});
    }
  }
  lifted.holes = symmetric.holes;
  lifted.regions = symmetric.regions;
  return lifted;
}

Result<void> check_and_seed(ClosedOrbits& closed, ExecutionContext& context) {
  const Pslg lifted = lift_pslg(closed.pslg);
  std::vector<Point2> seeds = lifted.holes;
  for (const PslgRegion& region : lifted.regions) seeds.push_back(region.point);
  const auto map = make_planar_map(lifted.vertices, lifted.segments, seeds, context);
  if (!map) {
    const Error& error = map.error();
    const bool geometric = error.code == ErrorCode::kSelfIntersection ||
                           error.code == ErrorCode::kOverlappingSegments ||
                           error.code == ErrorCode::kDuplicateVertices;
    if (!geometric) return fail(error);
    return degenerate("segments cross, overlap or shrink to nothing");
  }
  if (map->cuts > 0 || map->pieces.size() != lifted.segments.size()) {
    return degenerate("a vertex comes to lie on a segment");
  }
  const auto labels = face_labels(lifted, *map, closed.sides);
  if (!labels) return error_of(labels);
  Seeding seeding(lifted, *map, *labels);
  seeding.run(closed.pslg);
  return {};
}

}  // namespace symcell::plane
