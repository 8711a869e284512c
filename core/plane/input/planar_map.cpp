#include "core/plane/input/planar_map.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>
#include <string>

#include "core/base/index.hpp"
#include "core/base/union_find.hpp"
#include "core/geometry/predicates.hpp"
#include "core/model/describe.hpp"

namespace symcell::plane {
namespace {

constexpr std::int32_t kNone = -1;  // no vertex, segment, piece or face

bool before(Point2 p, Point2 q) {
  return p.x < q.x || (p.x == q.x && p.y < q.y);
}

// A segment that meets the sweep line. `lo` is where its current piece began: a vertex exactly on
// the segment, so predicates on (lo, hi) are exact for the whole segment right of lo.
struct Active {
  Point2 lo;
  Point2 hi;
  std::int32_t hi_vertex = kNone;
  std::int32_t segment = kNone;
  mutable std::int32_t piece = kNone;
};

// Bottom to top along the sweep line. Well defined for segments that do not cross left of it.
struct Below {
  using is_transparent = void;
  bool operator()(const Active& s, const Active& t) const {
    if (s.lo == t.lo) return orientation(s.lo, s.hi, t.hi) == Sign::kPositive;
    if (before(s.lo, t.lo)) {
      const Sign at_lo = orientation(s.lo, s.hi, t.lo);
      return (at_lo != Sign::kZero ? at_lo : orientation(s.lo, s.hi, t.hi)) == Sign::kPositive;
    }
    const Sign at_lo = orientation(t.lo, t.hi, s.lo);
    return (at_lo != Sign::kZero ? at_lo : orientation(t.lo, t.hi, s.hi)) == Sign::kNegative;
  }
  // An end of the segment is on it: the common case, which the filter could not decide.
  bool operator()(const Active& s, Point2 p) const {
    return p != s.hi && orientation(s.lo, s.hi, p) == Sign::kPositive;
  }
  bool operator()(Point2 p, const Active& s) const {
    return p != s.hi && orientation(s.lo, s.hi, p) == Sign::kNegative;
  }
};

class Sweep {
 public:
  Sweep(std::span<const Point2> vertices,
        std::span<const PslgSegment> segments,
        std::span<const Point2> queries,
        ExecutionContext& context)
      : vertices_(vertices), segments_(segments), queries_(queries), context_(context) {}

  Result<PlanarMap> run() {
    prepare();
    for (std::size_t i = 0; i < events_.size(); ++i) {
      if ((i & 0xfff) == 0) {
        SYMCELL_TRY(context_.check());
      }
      if (events_[i] >= vertex_count()) {
        locate_query(events_[i] - vertex_count());
        continue;
      }
      SYMCELL_TRY(check_distinct(i));
      SYMCELL_TRY(visit(events_[i]));
    }
    label_faces();
    return std::move(map_);
  }

 private:
  using Status = std::set<Active, Below>;

  [[nodiscard]] std::int32_t vertex_count() const {
    return static_cast<std::int32_t>(vertices_.size());
  }
  [[nodiscard]] Point2 event_point(std::int32_t event) const {
    return event < vertex_count() ? vertices_[at(event)] : queries_[at(event - vertex_count())];
  }
  [[nodiscard]] std::int32_t lower_end(const PslgSegment& s) const {
    return before(vertices_[at(s.a)], vertices_[at(s.b)]) ? s.a : s.b;
  }

  void prepare() {
    events_.resize(vertices_.size() + queries_.size());
    std::iota(events_.begin(), events_.end(), 0);
    std::sort(events_.begin(), events_.end(), [this](std::int32_t i, std::int32_t j) {
      const Point2 p = event_point(i);
      const Point2 q = event_point(j);
      return before(p, q) || (!before(q, p) && i < j);
    });
    // Segments by their lower end, in one array.
    first_start_.assign(vertices_.size() + 1, 0);
    for (const PslgSegment& s : segments_) ++first_start_[at(lower_end(s)) + 1];
    std::partial_sum(first_start_.begin(), first_start_.end(), first_start_.begin());
    starts_.resize(segments_.size());
    std::vector<std::int32_t> fill(first_start_.begin(), first_start_.end() - 1);
    for (std::size_t s = 0; s < segments_.size(); ++s) {
      starts_[at(fill[at(lower_end(segments_[s]))]++)] = static_cast<std::int32_t>(s);
    }
    map_.pieces.reserve(segments_.size());
    map_.next.reserve(2 * segments_.size());
    map_.vertex_face.assign(vertices_.size(), kNone);
    map_.query_face.assign(queries_.size(), kNone);
    map_.query_piece.assign(queries_.size(), kNone);
    query_below_.assign(queries_.size(), kNone);
  }

  std::int32_t add_piece(std::int32_t a, std::int32_t segment) {
    map_.pieces.push_back({a, kNone, segment});
    map_.next.push_back(kNone);
    map_.next.push_back(kNone);
    return static_cast<std::int32_t>(map_.pieces.size()) - 1;
  }

  // Equal vertices are neighbours among the events.
  Result<void> check_distinct(std::size_t i) const {
    if (i == 0 || events_[i - 1] >= vertex_count()) return {};
    const std::int32_t u = events_[i - 1];
    const std::int32_t v = events_[i];
    if (vertices_[at(u)] != vertices_[at(v)]) return {};
    return fail(ErrorCode::kDuplicateVertices,
                describe_duplicates(u, v, describe_point(vertices_[at(v)]), "segments"), {u, v},
                "/vertices/" + std::to_string(v));
  }

  void locate_query(std::int32_t query) {
    const auto [first, last] = status_.equal_range(queries_[at(query)]);
    if (first != last) {
      map_.query_piece[at(query)] = first->piece;
      return;
    }
    query_below_[at(query)] = first == status_.begin() ? kNone : std::prev(first)->piece;
  }

  Result<void> visit(std::int32_t v) {
    const Point2 p = vertices_[at(v)];
    auto [first, last] = status_.equal_range(p);
    const std::int32_t below = first == status_.begin() ? kNone : std::prev(first)->piece;
    enders_.clear();
    rising_.clear();
    for (auto it = first; it != last; ++it) {
      map_.pieces[at(it->piece)].b = v;
      enders_.push_back(it->piece);
      if (it->hi_vertex != v) {
        rising_.push_back({p, it->hi, it->hi_vertex, it->segment});
        ++map_.cuts;
      }
    }
    for (std::int32_t i = first_start_[at(v)]; i < first_start_[at(v) + 1]; ++i) {
      const std::int32_t s = starts_[at(i)];
      const PslgSegment& segment = segments_[at(s)];
      const std::int32_t hi = segment.a == v ? segment.b : segment.a;
      rising_.push_back({p, vertices_[at(hi)], hi, s});
    }
    SYMCELL_TRY(sort_rising());
    status_.erase(first, last);
    for (Active& s : rising_) {
      s.piece = add_piece(v, s.segment);
      status_.insert(last, s);
    }
    link_round(v, below);
    return check_neighbours(last);
  }

  // Bottom to top; drops repeated segments, refuses overlapping ones.
  Result<void> sort_rising() {
    if (rising_.size() < 2) return {};
    std::sort(rising_.begin(), rising_.end(), [](const Active& s, const Active& t) {
      const Sign turn = orientation(s.lo, s.hi, t.hi);
      return turn == Sign::kPositive || (turn == Sign::kZero && s.segment < t.segment);
    });
    std::size_t kept = 1;
    for (std::size_t i = 1; i < rising_.size(); ++i) {
      const Active& s = rising_[kept - 1];
      const Active& t = rising_[i];
      if (orientation(s.lo, s.hi, t.hi) != Sign::kZero) {
        rising_[kept++] = t;
        continue;
      }
      const PslgSegment& u = segments_[at(s.segment)];
      const PslgSegment& w = segments_[at(t.segment)];
      const bool repeated = (u.a == w.a && u.b == w.b) || (u.a == w.b && u.b == w.a);
      if (!repeated || u.marker != w.marker) return overlap(s.segment, t.segment, repeated);
    }
    rising_.resize(kept);
    return {};
  }

  Result<void> overlap(std::int32_t s, std::int32_t t, bool repeated) const {
    const std::string what = repeated ? " are the same segment with different markers"
                                      : " overlap: they run along the same line";
    return fail(ErrorCode::kOverlappingSegments,
                describe_segment(vertices_, segments_, s) + " and " +
                    describe_segment(vertices_, segments_, t) + what +
                    "; keep one of them, or split them so that each part is given once",
                {s, t}, "/segments/" + std::to_string(std::max(s, t)));
  }

  // The half-edges round v in counter-clockwise order: those that rise from the bottom up, then
  // those that ended from the top down. Each arriving half-edge goes on to its clockwise neighbour.
  void link_round(std::int32_t v, std::int32_t below) {
    round_.clear();
    for (const Active& s : rising_) round_.push_back(2 * s.piece);
    for (std::size_t i = enders_.size(); i-- > 0;) round_.push_back(2 * enders_[i] + 1);
    if (round_.empty()) {
      lone_.push_back({v, below});
      return;
    }
    std::int32_t previous = round_.back();
    for (const std::int32_t out : round_) {
      map_.next[at(out ^ 1)] = previous;
      previous = out;
    }
    // Left of a vertex where nothing ends lies the face above the segment below it.
    if (enders_.empty()) joins_.push_back({round_.back(), below});
  }

  // `last`: what follows the segments just inserted.
  Result<void> check_neighbours(Status::iterator last) {
    if (last != status_.end() && last != status_.begin()) {
      SYMCELL_TRY(check_pair(*std::prev(last), *last));
    }
    if (rising_.empty()) return {};
    const auto first = std::prev(last, static_cast<std::ptrdiff_t>(rising_.size()));
    if (first == status_.begin()) return {};
    return check_pair(*std::prev(first), *first);
  }

  Result<void> check_pair(const Active& s, const Active& t) const {
    if (s.hi_vertex == t.hi_vertex || s.lo == t.lo) return {};
    const auto opposite = [](Sign u, Sign w) { return u != Sign::kZero && u == -w; };
    if (!opposite(orientation(s.lo, s.hi, t.lo), orientation(s.lo, s.hi, t.hi))) return {};
    if (!opposite(orientation(t.lo, t.hi, s.lo), orientation(t.lo, t.hi, s.hi))) return {};
    if (vertex_at_crossing(s, t)) return {};
    const Point2 q = approximate_crossing(s, t).point;
    return fail(ErrorCode::kSelfIntersection,
                describe_segment(vertices_, segments_, s.segment) + " and " +
                    describe_segment(vertices_, segments_, t.segment) + " cross near " +
                    describe_point(q) + "; add a vertex there and split both, or correct the input",
                {s.segment, t.segment},
                "/segments/" + std::to_string(std::max(s.segment, t.segment)));
  }

  struct Crossing {
    Point2 point;
    double error = 0;  // bound on the distance from the true crossing
  };

  static Crossing approximate_crossing(const Active& s, const Active& t) {
    const Point2 u = s.hi - s.lo;
    const Point2 w = t.hi - t.lo;
    const Point2 d = t.lo - s.lo;
    const double denominator = cross(u, w);
    const double size = length(u) + length(w) + length(d);
    const double rounding = 1e-14 * size * size;
    if (std::abs(denominator) <= 4 * rounding) return {s.lo + 0.5 * u, size};
    const double parameter = std::clamp(cross(d, w) / denominator, 0.0, 1.0);
    const double magnitude = std::abs(s.lo.x) + std::abs(s.lo.y) + size;
    return {s.lo + parameter * u,
            4 * rounding / std::abs(denominator) * length(u) + 1e-14 * magnitude};
  }

  // Two segments may cross where a vertex lies exactly on both: both will be cut there.
  bool vertex_at_crossing(const Active& s, const Active& t) const {
    const Crossing q = approximate_crossing(s, t);
    const double x_end = q.point.x + q.error;
    const auto first_from = [this](Point2 p) {
      return std::lower_bound(events_.begin(), events_.end(), p, [this](std::int32_t i, Point2 r) {
        return before(event_point(i), r);
      });
    };
    auto it = first_from({q.point.x - q.error, q.point.y - q.error});
    while (it != events_.end()) {
      const Point2 p = event_point(*it);
      if (p.x > x_end) return false;
      if (p.y < q.point.y - q.error) {
        it = first_from({p.x, q.point.y - q.error});
      } else if (p.y > q.point.y + q.error) {
        it = first_from(
            {std::nextafter(p.x, std::numeric_limits<double>::infinity()), q.point.y - q.error});
      } else {
        if (*it < vertex_count() && orientation(s.lo, s.hi, p) == Sign::kZero &&
            orientation(t.lo, t.hi, p) == Sign::kZero) {
          return true;
        }
        ++it;
      }
    }
    return false;
  }

  // Cycles of half-edges become faces: every cycle left of a local minimum belongs to the face
  // above the piece below it.
  void label_faces() {
    std::vector<std::int32_t> cycle(map_.next.size(), kNone);
    std::int32_t cycles = 1;  // 0 stands for the unbounded face
    for (std::size_t h = 0; h < cycle.size(); ++h) {
      if (cycle[h] != kNone) continue;
      auto g = static_cast<std::int32_t>(h);
      while (cycle[at(g)] == kNone) {
        cycle[at(g)] = cycles;
        g = map_.next[at(g)];
      }
      ++cycles;
    }
    UnionFind faces(at(cycles));
    const auto above = [&cycle](std::int32_t piece) {
      return piece == kNone ? 0 : cycle[at(2 * piece)];
    };
    for (const Join& join : joins_) {
      faces.join(cycle[at(join.item)], above(join.below));
    }
    std::vector<std::int32_t> face_of(at(cycles), kNone);
    for (std::int32_t c = 0; c < cycles; ++c) {
      std::int32_t& face = face_of[at(faces.root(c))];
      if (face == kNone) face = map_.face_count++;
      face_of[at(c)] = face;
    }
    map_.face.resize(cycle.size());
    for (std::size_t h = 0; h < cycle.size(); ++h) map_.face[h] = face_of[at(cycle[h])];
    for (const Join& lone : lone_) map_.vertex_face[at(lone.item)] = face_of[at(above(lone.below))];
    for (std::size_t q = 0; q < queries_.size(); ++q) {
      if (map_.query_piece[q] == kNone) map_.query_face[q] = face_of[at(above(query_below_[q]))];
    }
  }

  struct Join {
    std::int32_t item;
    std::int32_t below;  // piece, or kNone
  };

  std::span<const Point2> vertices_;
  std::span<const PslgSegment> segments_;
  std::span<const Point2> queries_;
  ExecutionContext& context_;
  PlanarMap map_;
  Status status_;
  std::vector<std::int32_t> events_;       // vertices, then queries, in lexicographic order
  std::vector<std::int32_t> first_start_;  // per vertex, into starts_
  std::vector<std::int32_t> starts_;       // segments by their lower end
  std::vector<std::int32_t> query_below_;
  std::vector<Join> joins_;  // half-edge left of a local minimum, piece below it
  std::vector<Join> lone_;   // vertices without a piece
  // Scratch of one event.
  std::vector<std::int32_t> enders_;
  std::vector<Active> rising_;
  std::vector<std::int32_t> round_;
};

}  // namespace

Result<PlanarMap> make_planar_map(std::span<const Point2> vertices,
                                  std::span<const PslgSegment> segments,
                                  std::span<const Point2> queries,
                                  ExecutionContext& context) {
  return Sweep(vertices, segments, queries, context).run();
}

}  // namespace symcell::plane
