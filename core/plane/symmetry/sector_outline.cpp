#include "core/plane/symmetry/sector_outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/outline_distance.hpp"
#include "core/geometry/rotation.hpp"
#include "core/plane/symmetry/chain_fit.hpp"
#include "core/plane/symmetry/chain_orbits.hpp"
#include "core/plane/symmetry/edge_orbits.hpp"

namespace symcell::plane {
namespace {

// A vertex is the centre if it is nearer to it than this share of its shortest edge.
constexpr double kCentreShare = 0.25;
// Polylines are made finer, if they are off by more than the tolerance, until they pass what they skip
// at less than so many asymmetries.
constexpr double kFewestAsymmetries = 0.25;
// Where a loop is cut, other copies' vertices count as those of the first within so many times what
// the copies differ by, and this share of the shorter edge.
constexpr double kLinkAsymmetries = 2;
constexpr double kLinkShare = 0.3;
// Turns by which a loop is compared with itself, and places in each.
constexpr std::int32_t kMostTurns = 16;
constexpr std::size_t kMostPlaces = 4000;

PreparedPslg cut_at_centre(PreparedPslg prepared, std::int32_t edge, Point2 centre) {
  PreparedEdge rest = prepared.edges[at(edge)];
  prepared.input_vertex.push_back(prepared.input_vertex[at(rest.a)]);
  rest.a = static_cast<std::int32_t>(prepared.points.size());
  prepared.points.push_back(centre);
  prepared.edges[at(edge)].b = rest.a;
  prepared.edges.push_back(rest);
  return prepared;
}

std::vector<IndexedSegment> segments_of(const std::vector<Point2>& line) {
  std::vector<IndexedSegment> result;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) result.push_back({line[i], line[i + 1]});
  return result;
}

// A closed polyline, to be cut at given places.
class Loop {
 public:
  explicit Loop(std::vector<Point2> points) : points_(std::move(points)) {
    std::vector<Point2> closed = points_;
    closed.push_back(points_.front());
    segments_ = segments_of(closed);
  }

  struct Place {
    std::size_t segment = 0;
    double along = 0;  // share of the segment
    Point2 point;
    [[nodiscard]] double position() const { return static_cast<double>(segment) + along; }
  };

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] Point2 point(std::size_t i) const { return points_[i % points_.size()]; }
  [[nodiscard]] const std::vector<IndexedSegment>& segments() const { return segments_; }

  [[nodiscard]] double spacing(std::size_t i) const {
    return std::min(distance(point(i), point(i + 1)), distance(point(i), point(i + size() - 1)));
  }

  // The vertex at which the loop turns most, the first of equals.
  [[nodiscard]] std::size_t sharpest() const {
    std::size_t best = 0;
    double most = -1;
    for (std::size_t i = 0; i < size(); ++i) {
      const Point2 in = point(i) - point(i + size() - 1), out = point(i + 1) - point(i);
      const double turn = std::abs(std::atan2(cross(in, out), dot(in, out)));
      if (turn <= most * (1 + kSameTurn)) continue;
      most = turn;
      best = i;
    }
    return best;
  }

  [[nodiscard]] Place foot(const SegmentIndex& index, Point2 p) const {
    const auto s =
        static_cast<std::size_t>(index.nearest(p, std::numeric_limits<double>::infinity()).segment);
    const Point2 u = segments_[s].b - segments_[s].a;
    const double along = std::clamp(dot(p - segments_[s].a, u) / squared_length(u), 0.0, 1.0);
    return {s, along, segments_[s].a + along * u};
  }

  // A vertex no farther from p than `link` and a share of its edges, near the place.
  [[nodiscard]] std::optional<std::size_t> vertex_at(const Place& place,
                                                     Point2 p,
                                                     double link) const {
    for (const std::size_t v : {place.segment, (place.segment + 1) % size()}) {
      if (distance(points_[v], p) <= std::min(link, kLinkShare * spacing(v))) return v;
    }
    return std::nullopt;
  }

  // From one place to another, on in the loop's direction: all the way round if they are the same.
  [[nodiscard]] std::vector<Point2> part(const Place& from, const Place& to) const {
    std::vector<Point2> result{from.point};
    double end = to.position();
    while (end <= from.position()) end += static_cast<double>(size());
    for (std::size_t v = from.segment + 1; static_cast<double>(v) < end; ++v) {
      if (point(v) != result.back()) result.push_back(point(v));
    }
    if (result.back() == to.point && result.size() > 1) result.pop_back();
    result.push_back(to.point);
    return result;
  }

 private:
  static constexpr double kSameTurn = 1e-6;  // by which equal turns of rounded places may differ

  std::vector<Point2> points_;
  std::vector<IndexedSegment> segments_;
};

class Outline {
 public:
  Outline(const PreparedPslg& prepared,
          const SegmentIndex& index,
          const ClosureRequest& request,
          ExecutionContext& context)
      : prepared_(prepared),
        index_(index),
        request_(request),
        context_(context),
        rotations_(request.fold) {}

  Result<ClosedOrbits> run() {
    result_.pslg.fold = request_.fold;
    result_.pslg.centre = request_.centre;
    result_.pslg.ignore_markers = prepared_.ignore_markers;
    const std::int32_t centre = centre_point();
    const Chains chains = make_chains(prepared_, centre);
    if (chains.mixed_markers) {
      return fail(ErrorCode::kNotSymmetric, "markers change in places that differ between sectors");
    }
    chains_ = &chains;
    const auto orbits = find_chain_orbits(prepared_, index_, chains, request_.fold, request_.centre,
                                          centre, 2 * request_.tolerance);
    if (!orbits) return error_of(orbits);
    add_points(*orbits, centre);
    EdgeOrbits edges(rotations_, result_.pslg.centre_orbit, prepared_.ignore_markers);
    for (const std::vector<ChainCopy>& copies : orbits->chains) {
      SYMCELL_TRY(add_chain(copies, edges));
    }
    SYMCELL_TRY(edges.close(result_));
    result_.pslg.symmetry_error_rel = error_ / prepared_.diameter;
    result_.worst_vertex = worst_;
    if (shifted_ > 0) result_.centre_shift = (1 / static_cast<double>(shifted_)) * shift_;
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::int32_t fold() const { return request_.fold; }
  [[nodiscard]] Point2 local(std::int32_t point) const {
    return prepared_.points[at(point)] - request_.centre;
  }
  // Turned back from copy k to copy 0.
  [[nodiscard]] Point2 turned_back(std::int32_t point, std::size_t k) const {
    return rotations_.rotate(local(point), rotations_.reduce(-static_cast<std::int64_t>(k)));
  }
  [[nodiscard]] Point2 position(OrbitVertex v) const {
    return rotations_.rotate(result_.pslg.orbit_points[at(v.orbit)], v.exponent);
  }
  std::int32_t add_orbit(Point2 p) {
    result_.pslg.orbit_points.push_back(p);
    return static_cast<std::int32_t>(result_.pslg.orbit_points.size()) - 1;
  }

  void note_error(double error, std::int32_t point) {
    if (error <= error_) return;
    error_ = error;
    worst_ = point;
  }

  [[nodiscard]] std::int32_t centre_point() const {
    std::int32_t nearest = -1;
    double least = request_.tolerance;
    for (std::size_t i = 0; i < prepared_.points.size(); ++i) {
      const double off = length(local(static_cast<std::int32_t>(i)));
      if (off > least) continue;
      least = off;
      nearest = static_cast<std::int32_t>(i);
    }
    if (nearest < 0) return -1;
    for (const PreparedEdge& e : prepared_.edges) {
      if (e.a != nearest && e.b != nearest) continue;
      const double size = distance(prepared_.points[at(e.a)], prepared_.points[at(e.b)]);
      if (least > kCentreShare * size) return -1;
    }
    return nearest;
  }

  void add_points(const ChainOrbits& orbits, std::int32_t centre) {
    vertex_.assign(prepared_.points.size(), {-1, 0});
    if (centre >= 0) {
      result_.pslg.centre_orbit = add_orbit({0, 0});
      vertex_[at(centre)] = {result_.pslg.centre_orbit, 0};
      note_error(length(local(centre)), centre);
    }
    for (const std::vector<std::int32_t>& orbit : orbits.points) {
      Point2 sum;
      for (std::size_t k = 0; k < orbit.size(); ++k) sum = sum + turned_back(orbit[k], k);
      const std::int32_t o = add_orbit((1 / static_cast<double>(fold())) * sum);
      for (std::size_t k = 0; k < orbit.size(); ++k) {
        vertex_[at(orbit[k])] = {o, static_cast<std::int32_t>(k)};
        note_error(distance(position(vertex_[at(orbit[k])]), local(orbit[k])), orbit[k]);
        // The copies of a whole orbit sum to zero about the true centre.
        shift_ = shift_ + local(orbit[k]);
      }
      shifted_ += orbit.size();
    }
  }

  // The points of a chain's copy k, in the direction and frame of copy 0.
  [[nodiscard]] std::vector<Point2> line_of(const ChainCopy& copy, std::size_t k) const {
    std::vector<Point2> line;
    for (const std::int32_t p : chains_->chains[at(copy.chain)].points) {
      line.push_back(turned_back(p, k));
    }
    if (copy.reversed) std::reverse(line.begin(), line.end());
    return line;
  }

  Result<void> add_chain(const std::vector<ChainCopy>& copies, EdgeOrbits& edges) {
    const Chain& chain = chains_->chains[at(copies.front().chain)];
    lines_.clear();
    OrbitVertex from, to;
    if (!chain.loop) {
      for (std::size_t k = 0; k < copies.size(); ++k) lines_.push_back(line_of(copies[k], k));
      from = vertex_[at(chain.first())];
      to = vertex_[at(chain.last())];
    } else if (copies.size() == 1 && fold() > 1) {
      SYMCELL_TRY(cut_round_loop(copies.front()));
      from = {static_cast<std::int32_t>(result_.pslg.orbit_points.size()) - 1, 0};
      to = {from.orbit, 1};
    } else {
      SYMCELL_TRY(cut_loops(copies));
      from = to = {static_cast<std::int32_t>(result_.pslg.orbit_points.size()) - 1, 0};
    }
    ChainFitRequest request{position(from), position(to), request_.tolerance,
                            prepared_.resolution()};
    std::vector<Point2> line;
    auto fitted = fit_chain(lines_, request, context_);
    for (;; fitted = fit_chain(lines_, request, context_)) {
      if (!fitted) return error_of(fitted);
      line.assign(1, request.first);
      line.insert(line.end(), fitted->points.begin(), fitted->points.end());
      line.push_back(request.last);
      const auto error = compare(line);
      if (!error) return error_of(error);
      if (*error <= request_.tolerance) {
        note_error(*error, chain.points.front());
        break;
      }
      // Finer, down to all vertices of the copies.
      if (request.most_asymmetries < kFewestAsymmetries) return runs_apart(copies.front());
      request.most_asymmetries /= 2;
    }
    for (std::size_t k = 0; k < fitted->shifts.size(); ++k) {
      shift_ = shift_ + rotations_.rotate(fitted->shifts[k], static_cast<std::int32_t>(k));
    }
    shifted_ += fitted->shared * at(fold());

    std::vector<OrbitVertex> vertices{from};
    for (const Point2 p : fitted->points) vertices.push_back({add_orbit(p), 0});
    vertices.push_back(to);
    for (std::int32_t k = 0; k < fold(); ++k) {
      const ChainCopy& copy = copies[copies.size() == 1 ? 0 : at(k)];
      const PreparedEdge kind = kind_of(copy);
      for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
        edges.add(turned(vertices[i], k), turned(vertices[i + 1], k), kind);
      }
    }
    return {};
  }

  [[nodiscard]] OrbitVertex turned(OrbitVertex v, std::int32_t k) const {
    if (v.orbit == result_.pslg.centre_orbit) return v;
    return {v.orbit, rotations_.add(v.exponent, k)};
  }

  [[nodiscard]] PreparedEdge kind_of(const ChainCopy& copy) const {
    PreparedEdge kind = chains_->chains[at(copy.chain)].kind;
    if (copy.reversed) {
      std::swap(kind.left, kind.right);
      std::swap(kind.left_label, kind.right_label);
    }
    return kind;
  }

  // Copies of a loop that is not round the centre are cut where they come by the sharpest corner of
  // the first, which becomes an orbit.
  Result<void> cut_loops(const std::vector<ChainCopy>& copies) {
    const Loop first(line_of(copies.front(), 0));
    const SegmentIndex index(first.segments());
    const std::size_t corner = first.sharpest();
    const Point2 p = first.point(corner);
    Point2 sum = p;
    double count = 1;
    std::vector<Loop> loops{first};
    std::vector<Loop::Place> places{{corner, 0, p}};
    for (std::size_t k = 1; k < copies.size(); ++k) {
      const Loop loop(line_of(copies[k], k));
      double asymmetry = prepared_.resolution();
      for (std::size_t i = 0; i < loop.size(); ++i) {
        asymmetry = std::max(asymmetry, index.nearest(loop.point(i), kFar).distance);
      }
      const SegmentIndex own(loop.segments());
      Loop::Place place = loop.foot(own, p);
      if (distance(place.point, p) > 2 * request_.tolerance) return runs_apart(copies[k]);
      const double link =
          std::min(kLinkAsymmetries * asymmetry, kLinkShare * first.spacing(corner));
      if (const auto v = loop.vertex_at(place, p, link)) {
        place = {*v, 0, loop.point(*v)};
        sum = sum + place.point;
        ++count;
      }
      places.push_back(place);
      loops.push_back(loop);
    }
    add_orbit((1 / count) * sum);
    for (std::size_t k = 0; k < loops.size(); ++k) {
      lines_.push_back(loops[k].part(places[k], places[k]));
    }
    return {};
  }

  // A loop round the centre is cut at all copies of its sharpest corner: its parts are copies of
  // each other.
  Result<void> cut_round_loop(const ChainCopy& copy) {
    const Loop loop(line_of(copy, 0));
    const SegmentIndex index(loop.segments());
    const std::size_t corner = loop.sharpest();
    const Point2 p = loop.point(corner);
    const double link =
        std::min(kLinkAsymmetries * asymmetry_of(loop, index), kLinkShare * loop.spacing(corner));
    Point2 sum = p;
    double count = 1;
    std::vector<Loop::Place> places{{corner, 0, p}};
    double before = 0;  // the way round so far, in edges
    for (std::int32_t k = 1; k < fold(); ++k) {
      const Point2 q = rotations_.rotate(p, k);
      Loop::Place place = loop.foot(index, q);
      if (distance(place.point, q) > 2 * request_.tolerance) return runs_apart(copy);
      if (const auto v = loop.vertex_at(place, q, link)) {
        place = {*v, 0, loop.point(*v)};
        sum = sum + rotations_.rotate(place.point, rotations_.reduce(-std::int64_t{k}));
        ++count;
      }
      // On from the one before, or the loop comes by in another order than the copies.
      double way = place.position() - static_cast<double>(corner);
      if (way < 0) way += static_cast<double>(loop.size());
      if (way <= before) return runs_apart(copy);
      before = way;
      places.push_back(place);
    }
    add_orbit((1 / count) * sum);
    for (std::int32_t k = 0; k < fold(); ++k) {
      std::vector<Point2> line = loop.part(places[at(k)], places[at((k + 1) % fold())]);
      for (Point2& q : line) q = rotations_.rotate(q, rotations_.reduce(-std::int64_t{k}));
      lines_.push_back(std::move(line));
    }
    return {};
  }

  [[nodiscard]] double asymmetry_of(const Loop& loop, const SegmentIndex& index) const {
    double worst = prepared_.resolution();
    const std::int32_t step = std::max(1, (fold() - 1) / kMostTurns);
    const std::size_t stride = 1 + loop.size() / kMostPlaces;
    for (std::int32_t k = 1; k < fold(); k += step) {
      for (std::size_t i = 0; i < loop.size(); i += stride) {
        const Point2 q = rotations_.rotate(loop.point(i), k);
        worst = std::max(worst, index.nearest(q, kFar).distance);
      }
    }
    return worst;
  }

  [[nodiscard]] Failure runs_apart(const ChainCopy& copy) const {
    const std::int32_t segment = chains_->chains[at(copy.chain)].kind.segment;
    return fail(ErrorCode::kNotSymmetric,
                "segment " + std::to_string(segment) +
                    " belongs to an outline that runs apart from its counterparts",
                {segment}, "/segments/" + std::to_string(segment));
  }

  // Both ways, between the polyline taken and all copies.
  Result<double> compare(const std::vector<Point2>& line) {
    const SegmentIndex taken(segments_of(line));
    double error = 0;
    for (const std::vector<Point2>& copy : lines_) {
      SYMCELL_TRY(context_.check());
      const SegmentIndex given(segments_of(copy));
      for (std::size_t i = 0; i + 1 < copy.size(); ++i) {
        error =
            std::max(error, outline_distance(taken, copy[i], copy[i + 1], prepared_.resolution()));
      }
      for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        error =
            std::max(error, outline_distance(given, line[i], line[i + 1], prepared_.resolution()));
      }
    }
    return error;
  }

  static constexpr double kFar = std::numeric_limits<double>::infinity();

  const PreparedPslg& prepared_;
  const SegmentIndex& index_;
  const ClosureRequest& request_;
  ExecutionContext& context_;
  RotationTable rotations_;
  const Chains* chains_ = nullptr;
  ClosedOrbits result_;
  std::vector<OrbitVertex> vertex_;  // of junctions and lone vertices, per point
  std::vector<std::vector<Point2>>
      lines_;  // copies of the chain at hand, in the frame of the first
  Point2 shift_;
  std::size_t shifted_ = 0;
  double error_ = 0;
  std::int32_t worst_ = -1;
};

}  // namespace

Result<ClosedOrbits> outline_sector(const PreparedPslg& prepared,
                                    const SegmentIndex& index,
                                    const ClosureRequest& request,
                                    ExecutionContext& context) {
  // A segment that is its own image under half a turn is cut at the centre.
  const SegmentIndex::Hit through = index.nearest(request.centre, request.tolerance);
  const auto at_centre = [&](Point2 p) { return distance(p, request.centre) <= request.tolerance; };
  if (request.fold == 2 && through.segment >= 0 &&
      std::none_of(prepared.points.begin(), prepared.points.end(), at_centre)) {
    const PreparedPslg cut = cut_at_centre(prepared, through.segment, request.centre);
    std::vector<IndexedSegment> segments;
    for (const PreparedEdge& e : cut.edges)
      segments.push_back({cut.points[at(e.a)], cut.points[at(e.b)]});
    return Outline(cut, SegmentIndex(segments), request, context).run();
  }
  return Outline(prepared, index, request, context).run();
}

}  // namespace symcell::plane
