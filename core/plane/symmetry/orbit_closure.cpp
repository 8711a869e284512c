#include "core/plane/symmetry/orbit_closure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/base/index.hpp"
#include "core/geometry/point_grid.hpp"
#include "core/geometry/rotation.hpp"
#include "core/model/describe.hpp"
#include "core/plane/symmetry/edge_orbits.hpp"

namespace symcell::plane {
namespace {

// A vertex that cuts an edge: its place along the edge and which it is.
struct Cut {
  std::int32_t edge = 0;
  double along = 0;
  OrbitVertex vertex;
};

class Closure {
 public:
  Closure(const PreparedPslg& prepared,
          const SegmentIndex& index,
          const ClosureRequest& request,
          ExecutionContext& context)
      : prepared_(prepared),
        index_(index),
        request_(request),
        context_(context),
        rotations_(request.fold),
        sector_(2 * std::numbers::pi / request.fold) {}

  Result<ClosedOrbits> run() {
    result_.pslg.fold = request_.fold;
    result_.pslg.centre = request_.centre;
    result_.pslg.ignore_markers = prepared_.ignore_markers;
    choose_sector();
    assign_orbits();
    average();
    SYMCELL_TRY(cut_edges());
    SYMCELL_TRY(close_edges());
    if (error_ > request_.tolerance) {
      return not_symmetric("moving the vertices into symmetric places takes " + relative(error_),
                           worst_);
    }
    result_.pslg.symmetry_error_rel = error_ / prepared_.diameter;
    result_.worst_vertex = worst_;
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::int32_t fold() const { return request_.fold; }
  [[nodiscard]] Point2 local(std::int32_t point) const {
    return prepared_.points[at(point)] - request_.centre;
  }
  [[nodiscard]] Point2 position(OrbitVertex v) const {
    return rotations_.rotate(result_.pslg.orbit_points[at(v.orbit)], v.exponent);
  }
  [[nodiscard]] bool is_centre(std::int32_t orbit) const {
    return orbit == result_.pslg.centre_orbit;
  }
  [[nodiscard]] std::string relative(double distance) const {
    return describe_rounded(distance / prepared_.diameter) + " of the diameter";
  }
  [[nodiscard]] double angle_of(Point2 q) const { return std::atan2(q.y, q.x); }

  void note_error(double error, std::int32_t point) {
    if (error <= error_) return;
    error_ = error;
    worst_ = point;
  }

  [[nodiscard]] Failure not_symmetric(std::string what, std::int32_t point) const {
    const std::int32_t vertex = point < 0 ? -1 : prepared_.input_vertex[at(point)];
    Error error{ErrorCode::kNotSymmetric, std::move(what), {}, {}};
    if (vertex >= 0) {
      error.elements = {vertex};
      error.pointer = "/vertices/" + std::to_string(vertex);
    }
    return fail(std::move(error));
  }

  // The sector's first ray: the direction, modulo one sector, that the fewest edges cross, so that
  // most segments join representatives.
  void choose_sector() {
    if (fold() == 1) return;
    constexpr int kBins = 256;  // directions tried, of one sector
    std::vector<std::int64_t> change(kBins + 1, 0);
    const auto bin_of = [this](double angle) {
      const double turns = angle / sector_;
      const double part = turns - std::floor(turns);
      return std::min(static_cast<int>(part * kBins), kBins - 1);
    };
    for (const PreparedEdge& edge : prepared_.edges) {
      const Point2 a = local(edge.a);
      const Point2 b = local(edge.b);
      const double sweep = std::abs(std::atan2(cross(a, b), dot(a, b)));
      if (!(sweep < sector_)) continue;  // crosses every ray, or ends at the centre
      int first = bin_of(angle_of(cross(a, b) >= 0 ? a : b));
      int last = bin_of(angle_of(cross(a, b) >= 0 ? b : a));
      ++change[static_cast<std::size_t>(first)];
      --change[static_cast<std::size_t>(last) + 1];
      if (last < first) {
        ++change[0];
        --change[kBins];
      }
    }
    std::int64_t crossed = 0;
    std::int64_t fewest = std::numeric_limits<std::int64_t>::max();
    for (int bin = 0; bin < kBins; ++bin) {
      crossed += change[static_cast<std::size_t>(bin)];
      if (crossed >= fewest) continue;
      fewest = crossed;
      first_ray_ = sector_ * (bin + 0.5) / kBins;
    }
  }

  // Each vertex is turned into the first sector; those that meet there are one orbit.
  void assign_orbits() {
    std::vector<Point2>& orbits = result_.pslg.orbit_points;
    vertex_.resize(prepared_.points.size());
    if (fold() == 1) {
      orbits.resize(prepared_.points.size());
      for (std::size_t i = 0; i < orbits.size(); ++i) {
        vertex_[i] = {static_cast<std::int32_t>(i), 0};
        orbits[i] = local(static_cast<std::int32_t>(i));
      }
      return;
    }
    PointGrid grid(request_.link, prepared_.points.size() / at(fold()) + 1);
    for (std::size_t i = 0; i < vertex_.size(); ++i) {
      const Point2 q = local(static_cast<std::int32_t>(i));
      if (length(q) <= request_.link) {
        vertex_[i] = {centre_orbit(), 0};
        continue;
      }
      vertex_[i] = match(grid, q);
    }
  }

  std::int32_t centre_orbit() {
    std::int32_t& orbit = result_.pslg.centre_orbit;
    if (orbit < 0) {
      orbit = static_cast<std::int32_t>(result_.pslg.orbit_points.size());
      result_.pslg.orbit_points.push_back({0, 0});
    }
    return orbit;
  }

  OrbitVertex match(PointGrid& grid, Point2 q) {
    const double turns = (angle_of(q) - first_ray_) / sector_;
    const double whole = std::floor(turns);
    const std::int32_t k = rotations_.reduce(static_cast<std::int64_t>(whole));
    const Point2 base = rotations_.rotate(q, rotations_.reduce(-std::int64_t{k}));
    if (const std::int32_t orbit = grid.nearest(base); orbit >= 0) return {orbit, k};
    // Near a bound of the sector, the partner may have fallen just beyond the other bound.
    const double reach = 2 * request_.link;
    const double radius = length(q);
    if ((turns - whole) * sector_ * radius <= reach) {
      const std::int32_t orbit = grid.nearest(rotations_.rotate(base, 1));
      if (orbit >= 0) return {orbit, rotations_.subtract(k, 1)};
    }
    if ((whole + 1 - turns) * sector_ * radius <= reach) {
      const std::int32_t orbit = grid.nearest(rotations_.rotate(base, fold() - 1));
      if (orbit >= 0) return {orbit, rotations_.add(k, 1)};
    }
    const auto orbit = static_cast<std::int32_t>(result_.pslg.orbit_points.size());
    result_.pslg.orbit_points.push_back(base);
    grid.insert(base, orbit);
    return {orbit, k};
  }

  // The representative becomes the mean of the copies turned back; members of each orbit are
  // listed by exponent.
  void average() {
    std::vector<Point2>& orbits = result_.pslg.orbit_points;
    first_member_.assign(orbits.size() + 1, 0);
    for (const OrbitVertex v : vertex_) ++first_member_[at(v.orbit) + 1];
    for (std::size_t o = 0; o < orbits.size(); ++o) first_member_[o + 1] += first_member_[o];
    member_.resize(vertex_.size());
    std::vector<std::int32_t> fill(first_member_.begin(), first_member_.end() - 1);
    for (std::size_t i = 0; i < vertex_.size(); ++i) {
      member_[at(fill[at(vertex_[i].orbit)]++)] = static_cast<std::int32_t>(i);
    }
    if (fold() == 1) return;
    Point2 shift;
    std::size_t shifted = 0;
    for (std::size_t o = 0; o < orbits.size(); ++o) {
      const auto first = member_.begin() + first_member_[o];
      const auto last = member_.begin() + first_member_[o + 1];
      std::sort(first, last, [this](std::int32_t i, std::int32_t j) {
        return std::pair(vertex_[at(i)].exponent, i) < std::pair(vertex_[at(j)].exponent, j);
      });
      Point2 sum;
      Point2 plain_sum;
      for (auto it = first; it != last; ++it) {
        const Point2 q = local(*it);
        plain_sum = plain_sum + q;
        sum =
            sum + rotations_.rotate(q, rotations_.reduce(-std::int64_t{vertex_[at(*it)].exponent}));
      }
      const auto count = static_cast<double>(last - first);
      if (!is_centre(static_cast<std::int32_t>(o))) orbits[o] = (1 / count) * sum;
      if (last - first ==
          fold()) {  // the copies of a whole orbit sum to zero about the true centre
        shift = shift + plain_sum;
        shifted += static_cast<std::size_t>(fold());
      }
      for (auto it = first; it != last; ++it) {
        note_error(distance(position(vertex_[at(*it)]), local(*it)), *it);
      }
    }
    if (shifted > 0) result_.centre_shift = (1 / static_cast<double>(shifted)) * shift;
  }

  // Cuts edges at the vertices that lie on them within the link distance, among them the copies
  // that the input's vertices lack.
  Result<void> cut_edges() {
    const auto orbit_count = static_cast<std::int32_t>(result_.pslg.orbit_points.size());
    for (std::int32_t o = 0; o < orbit_count; ++o) {
      if ((o & 0xff) == 0) {
        SYMCELL_TRY(context_.check());
      }
      if (is_centre(o)) {
        cut_at({o, 0}, -1);
        continue;
      }
      SYMCELL_TRY(cut_at_orbit(o));
    }
    if (fold() > 1 && result_.pslg.centre_orbit < 0 &&
        index_.nearest(request_.centre, request_.link).segment >= 0) {
      cut_at({centre_orbit(), 0}, -1);
    }
    std::sort(cuts_.begin(), cuts_.end(), [](const Cut& c, const Cut& d) {
      return std::tie(c.edge, c.along, c.vertex.orbit, c.vertex.exponent) <
             std::tie(d.edge, d.along, d.vertex.orbit, d.vertex.exponent);
    });
    return {};
  }

  // A whole orbit that lies on no other edge at one copy lies on none at the others.
  Result<void> cut_at_orbit(std::int32_t o) {
    const auto first = first_member_[at(o)];
    const auto last = first_member_[at(o) + 1];
    std::int32_t present = 0;
    for (auto i = first; i < last; ++i) {
      if (i == first || exponent_of(i) != exponent_of(i - 1)) ++present;
    }
    if (present == fold()) {
      if (!cut_at({o, exponent_of(first)}, member_[at(first)])) return {};
      for (std::int32_t k = 0; k < fold(); ++k) {
        if (k != exponent_of(first)) cut_at({o, k}, member_[at(first)]);
      }
      return {};
    }
    if (!request_.may_add) {
      return not_symmetric(describe_input(member_[at(first)]) + " has not all its copies",
                           member_[at(first)]);
    }
    created_ += static_cast<std::size_t>(fold() - present);
    if (created_ > kMaxPslgVertices) {
      return fail(ErrorCode::kTooLarge, "the symmetric copies of the vertices exceed " +
                                            std::to_string(kMaxPslgVertices) +
                                            "; ask for a lower fold");
    }
    auto next = first;
    for (std::int32_t k = 0; k < fold(); ++k) {
      const bool exists = next < last && exponent_of(next) == k;
      while (next < last && exponent_of(next) == k) ++next;
      if (cut_at({o, k}, member_[at(first)]) || exists) continue;
      const std::int32_t worst = member_[at(first)];
      const auto hit = index_.nearest(position({o, k}) + request_.centre, prepared_.diameter);
      return not_symmetric("the image of " + describe_input(worst) + " under " +
                               std::to_string(rotations_.subtract(k, vertex_[at(worst)].exponent)) +
                               "/" + std::to_string(fold()) + " of a turn lies " +
                               relative(hit.distance) + " from the nearest segment",
                           worst);
    }
    return {};
  }

  [[nodiscard]] std::int32_t exponent_of(std::int32_t member) const {
    return vertex_[at(member_[at(member)])].exponent;
  }
  [[nodiscard]] std::string describe_input(std::int32_t point) const {
    return "vertex " + std::to_string(prepared_.input_vertex[at(point)]) + " at " +
           describe_point(prepared_.points[at(point)]);
  }

  // Whether any edge not ending there passes the vertex. `source`: a point of the orbit, for
  // errors.
  bool cut_at(OrbitVertex v, std::int32_t source) {
    bool found = false;
    const Point2 p = position(v) + request_.centre;
    index_.within(p, request_.link, [&](std::int32_t e, double off) {
      const PreparedEdge& edge = prepared_.edges[at(e)];
      if (vertex_[at(edge.a)] == v || vertex_[at(edge.b)] == v) return;
      const Point2 a = prepared_.points[at(edge.a)];
      const Point2 u = prepared_.points[at(edge.b)] - a;
      const double along = dot(p - a, u) / squared_length(u);
      if (along <= 0 || along >= 1) return;
      cuts_.push_back({e, along, v});
      note_error(off, source >= 0 ? source : edge.a);
      found = true;
    });
    return found;
  }

  Result<void> close_edges() {
    std::size_t next = 0;
    EdgeOrbits orbits(rotations_, result_.pslg.centre_orbit, prepared_.ignore_markers);
    orbits.reserve(prepared_.edges.size() + cuts_.size());
    for (std::size_t e = 0; e < prepared_.edges.size(); ++e) {
      if ((e & 0xfff) == 0) {
        SYMCELL_TRY(context_.check());
      }
      const PreparedEdge& edge = prepared_.edges[e];
      OrbitVertex from = vertex_[at(edge.a)];
      for (; next < cuts_.size() && at(cuts_[next].edge) == e; ++next) {
        orbits.add(from, cuts_[next].vertex, edge);
        from = cuts_[next].vertex;
      }
      orbits.add(from, vertex_[at(edge.b)], edge);
    }
    return orbits.close(result_);
  }

  const PreparedPslg& prepared_;
  const SegmentIndex& index_;
  const ClosureRequest& request_;
  ExecutionContext& context_;
  RotationTable rotations_;
  double sector_;
  double first_ray_ = 0;
  ClosedOrbits result_;
  std::vector<OrbitVertex> vertex_;         // per point
  std::vector<std::int32_t> first_member_;  // per orbit, into member_
  std::vector<std::int32_t> member_;        // points by orbit, exponent
  std::vector<Cut> cuts_;
  std::size_t created_ = 0;
  double error_ = 0;
  std::int32_t worst_ = -1;
};

}  // namespace

Result<ClosedOrbits> close_orbits(const PreparedPslg& prepared,
                                  const SegmentIndex& index,
                                  const ClosureRequest& request,
                                  ExecutionContext& context) {
  return Closure(prepared, index, request, context).run();
}

}  // namespace symcell::plane
