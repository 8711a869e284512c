#include "core/solid/surface/clean_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/base/union_find.hpp"
#include "core/geometry/limits.hpp"
#include "core/geometry/predicates.hpp"
#include "core/geometry/self_intersections.hpp"
#include "core/geometry/surface_distance.hpp"
#include "core/geometry/triangle_tree.hpp"
#include "core/model/describe.hpp"
#include "core/solid/surface/close_holes.hpp"
#include "core/solid/surface/contacts.hpp"
#include "core/solid/surface/mend_surface.hpp"
#include "core/solid/surface/refusals.hpp"
#include "core/solid/surface/resolve_crossings.hpp"
#include "core/solid/surface/shells.hpp"
#include "core/solid/surface/t_junctions.hpp"
#include "core/solid/surface/weld.hpp"
#include "core/solid/surface/wrap_surface.hpp"

namespace symcell::solid {
namespace {

// Welding tolerances tried in turn, of the diameter: the first that closes the surface. The last is
// well below the symmetry tolerance, so features a mesh could show survive.
constexpr std::array<double, 8> kWeldTolerances = {1e-8, 1e-7, 5e-7, 1e-6, 2e-6, 5e-6, 1e-5, 3e-5};
constexpr int kJunctionRounds = 3;  // a triangle with several split edges takes one a round
// Intersecting pairs looked for: to be named, to be mended.
constexpr std::size_t kMostNamedPairs = 200;
constexpr std::size_t kMostPairs = 100'000;
// What is closed by default, beside holes below the tolerance: planar ones of few edges, of the
// diameter at most, and so flat.
constexpr std::size_t kSimpleHoleEdges = 6;
constexpr double kSimpleHoleRel = 0.02;
constexpr double kFlatHoleRel = 1e-6;
// Shares of the tolerance up to which edges are collapsed, tried until the surface does not cross
// itself.
constexpr std::array<double, 3> kJoinShares = {0.1, 0.03, 0.01};
// Of the volume: what that may change, as much as a sector's may.
constexpr double kJoinVolumeRel = 1e-3;
// What rounding moves corners by, of the larger of the diameter and the largest coordinate: that of six
// decimal digits, or of single precision, a few times. And of the tolerance at most.
constexpr double kContactRel = 2e-6;
constexpr double kMostContact = 0.01;
// Of the tolerance. Wraps narrower than the least share of the diameter would take forever.
constexpr double kWrapAlpha = 10;
constexpr double kWrapOffset = 0.5;
constexpr double kLeastWrapRel = 2e-4;

const char* const kSafeHelps = "repair=safe mends it where the shape stays as it is";
const char* const kSafeAndAllHelp =
    "repair=safe mends it where the shape stays as it is, repair=all closes holes, too";
const char* const kWrapHelps =
    "mend it in the CAD program and export again, or wrap the triangles by repair=wrap";

bool lie_in_line(const IndexedSurface& s, const Triangle& t) {
  const Point3 &a = s.points[t[0]], &b = s.points[t[1]], &c = s.points[t[2]];
  return orientation(Point2{a.x, a.y}, Point2{b.x, b.y}, Point2{c.x, c.y}) == Sign::kZero &&
         orientation(Point2{a.y, a.z}, Point2{b.y, b.z}, Point2{c.y, c.z}) == Sign::kZero &&
         orientation(Point2{a.z, a.x}, Point2{b.z, b.x}, Point2{c.z, c.x}) == Sign::kZero;
}

class Cleaner {
 public:
  Cleaner(const TriangleSurface& input,
          ExecutionContext& context,
          double tolerance_rel,
          Repair repair)
      : input_(input), context_(context), tolerance_rel_(tolerance_rel), repair_(repair) {}

  Result<CleanSurface> run() {
    SYMCELL_TRY(check_input());
    surface() = weld_exactly(input_);
    if (surface().triangles.empty()) {
      return fail(ErrorCode::kDegenerateGeometry,
                  "no triangle of the surface has three different corners; check the file");
    }
    result_.box = bounding_box(surface().points);
    result_.diameter = result_.box.diagonal();
    if (!(result_.diameter > 1 / kMaxCoordinate)) {
      return fail(ErrorCode::kDegenerateGeometry,
                  "the surface is too small: " + describe_number(result_.diameter) +
                      " across; check its units");
    }
    SYMCELL_TRY(mend_with_contacts());
    if (result_.problem && repair_ == Repair::kWrap) {
      SYMCELL_TRY(wrap());
    }
    const Point3 centre = 0.5 * (result_.box.low + result_.box.high);
    result_.area = surface_area(surface());
    result_.volume = enclosed_volume(surface(), centre);
    if (!result_.problem && !(std::abs(result_.volume) > 0)) {
      return fail(ErrorCode::kDegenerateGeometry,
                  "the surface encloses no volume; check for parts that cancel each other");
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] IndexedSurface& surface() { return result_.surface; }
  [[nodiscard]] double tolerance() const { return tolerance_rel_ * result_.diameter; }
  [[nodiscard]] bool untouched() const { return repair_ == Repair::kNone; }
  // Holes and small parts too.
  [[nodiscard]] bool bold() const { return repair_ == Repair::kAll || repair_ == Repair::kWrap; }

  void refuse(ErrorCode code, std::string message, std::vector<std::int64_t> triangles) {
    result_.problem = Error{code, std::move(message), listed(std::move(triangles)), {}};
  }

  // Bodies that touch become one solid, or stay apart, at all copies alike; where that cannot be, as they
  // are.
  Result<void> mend_with_contacts() {
    auto done = mend();
    if (deepened_.triangles.empty()) return done;
    const auto again = [&](IndexedSurface from) {
      CleanSurface fresh;
      fresh.box = result_.box;
      fresh.diameter = result_.diameter;
      result_ = std::move(fresh);
      surface() = std::move(from);
      turned_shells_ = 0;
      turned_sources_.clear();
      if (contact_ > 0) {
        result_.repairs.push_back(
            plural(contacts_.size(), "corner") + " of bodies that touch others within " +
            describe_rounded(contact_) +
            " put as far inside of them, so that all are treated alike" + such_as_at(contacts_));
      }
      return mend();
    };
    done = again(std::exchange(deepened_, {}));
    if (done ? !result_.problem : is_limit(done.error().code)) return done;
    contact_ = 0;
    return again(weld_exactly(input_));
  }

  // Where parts of the surface as read meet: whether it is to be mended from the start with bodies that
  // touch put into each other.
  Result<bool> contacts_found() {
    if (untouched() || contacts_looked_for_) return false;
    contacts_looked_for_ = true;
    const double largest = std::max(result_.box.magnitude(), result_.diameter);
    const double reach = std::min(kContactRel * largest, kMostContact * tolerance());
    IndexedSurface deepened = weld_exactly(input_);
    auto places = deepen_contacts(deepened, reach, context_);
    if (!places) return error_of(places);
    if (places->empty()) return false;
    deepened_ = std::move(deepened);
    contact_ = reach;
    contacts_ = std::move(*places);
    return true;
  }

  Result<void> mend() {
    for (auto step :
         {&Cleaner::drop_doubled, &Cleaner::drop_small, &Cleaner::close, &Cleaner::orient,
          &Cleaner::remove_flat, &Cleaner::resolve, &Cleaner::join_near}) {
      auto done = (this->*step)();
      if (!done) return done;
      if (result_.problem || !deepened_.triangles.empty()) break;
    }
    if (turned_shells_ > 0) {
      result_.repairs.push_back(plural(turned_shells_, "closed shell") + " turned inside out");
    }
    return {};
  }

  [[nodiscard]] Result<void> check_input() const {
    if (input_.triangles.empty()) {
      return fail(ErrorCode::kEmptyFile, "the model has no triangles");
    }
    const auto count = static_cast<std::int32_t>(input_.vertices.size());
    for (std::size_t t = 0; t < input_.triangles.size(); ++t) {
      // As the file counts: polygons were cut into triangles.
      const std::int64_t id =
          input_.source_face.empty() ? static_cast<std::int64_t>(t) : input_.source_face[t];
      for (const std::int32_t v : input_.triangles[t]) {
        if (v < 0 || v >= count) {
          return fail(ErrorCode::kIndexOutOfRange,
                      "triangle " + std::to_string(id) + " names vertex " + std::to_string(v) +
                          " of " + std::to_string(count),
                      {id});
        }
        const Point3& p = input_.vertices[v];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
          return fail(ErrorCode::kNonFinite,
                      "triangle " + std::to_string(id) + " has a corner " + describe_point(p) +
                          "; coordinates must be finite",
                      {id});
        }
        if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kMaxCoordinate) {
          return fail(ErrorCode::kCoordinateRange,
                      "triangle " + std::to_string(id) + " has a corner " + describe_point(p) +
                          "; coordinates beyond " + describe_number(kMaxCoordinate) +
                          " are not accepted",
                      {id});
        }
      }
    }
    return {};
  }

  Result<void> drop_doubled() {
    IndexedSurface cancelled;
    IndexedSurface single = surface();
    const std::vector<Point3> dropped = drop_doubled_triangles(single, &cancelled);
    if (dropped.empty()) return {};
    if (untouched()) {
      refuse(ErrorCode::kSelfIntersection,
             plural(dropped.size(), "triangle") + (dropped.size() == 1 ? " is" : " are") +
                 " given more than once" + such_as_at(dropped) + "; " + kSafeHelps,
             {});
      return {};
    }
    const auto contacts = contacts_found();
    if (!contacts) return error_of(contacts);
    if (*contacts) return {};
    surface() = std::move(single);
    // One triangle given from both sides may be part of the surface all the same.
    const std::size_t restored = restore_needed(surface(), cancelled);
    result_.repairs.push_back(plural(dropped.size() - restored, "doubled triangle") + " removed" +
                              such_as_at(dropped));
    if (surface().triangles.empty()) {
      return fail(ErrorCode::kDegenerateGeometry,
                  "every triangle of the surface occurs from both sides: sheets enclose no volume; "
                  "give each face once, seen from outside");
    }
    return {};
  }

  // Pieces over common edges whose box is below the tolerance.
  Result<void> drop_small() {
    if (!bold()) return {};
    UnionFind pieces(surface().triangles.size());
    const std::vector<EdgeUse> uses = sorted_edge_uses(surface().triangles);
    for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin + 1; i < end; ++i) {
        pieces.join(uses[begin].triangle, uses[i].triangle);
      }
    });
    std::map<std::int32_t, std::vector<Point3>> corners;
    const auto count = static_cast<std::int32_t>(surface().triangles.size());
    for (std::int32_t t = 0; t < count; ++t) {
      for (const std::int32_t v : surface().triangles[t]) {
        corners[pieces.root(t)].push_back(surface().points[v]);
      }
    }
    std::vector<Point3> dropped;
    std::vector<bool> small(surface().triangles.size(), false);
    for (const auto& [piece, points] : corners) {
      small[piece] = bounding_box(points).diagonal() <= tolerance();
      if (small[piece]) dropped.push_back(points.front());
    }
    if (dropped.empty() || dropped.size() == corners.size()) return {};
    IndexedSurface kept;
    kept.points = surface().points;
    for (std::int32_t t = 0; t < count; ++t) {
      if (small[pieces.root(t)]) continue;
      kept.triangles.push_back(surface().triangles[t]);
      kept.source.push_back(surface().source[t]);
    }
    drop_unused_points(kept);
    surface() = std::move(kept);
    result_.repairs.push_back(plural(dropped.size(), "part") + " no larger than " +
                              describe_rounded(tolerance()) + " dropped" + such_as_at(dropped));
    return {};
  }

  // Leaves no edge with an odd number of triangles; first without any that has four.
  Result<void> close() {
    const std::vector<OddEdge> odd = odd_edges(surface());
    if (untouched()) {
      const std::vector<OddEdge> four = branching_edges(surface());
      if (!odd.empty() || !four.empty()) {
        result_.problem = refuse_open(surface(), odd.empty() ? four : odd,
                                      odd.empty() ? kSafeHelps : kSafeAndAllHelp);
      }
      return {};
    }
    if (odd.empty()) return {};
    Best best{surface(), odd.size(), {}};
    for (const bool branching : {false, true}) {
      for (const double share : kWeldTolerances) {
        SYMCELL_TRY(context_.check());
        IndexedSurface welded = weld_within(surface(), share * result_.diameter);
        if (welded.triangles.empty()) continue;
        const std::string sentence =
            "vertices welded within " + describe_rounded(share * result_.diameter) + ": " +
            plural(surface().points.size() - welded.points.size(), "vertex pair") + " joined, " +
            plural(surface().triangles.size() - welded.triangles.size(), "triangle") + " dropped";
        if (take_closed(std::move(welded), sentence, branching, best)) return {};
      }
    }
    IndexedSurface split = surface();
    std::size_t joints = 0;
    for (int i = 0; i < kJunctionRounds; ++i) {
      const std::size_t more = split_at_t_junctions(split, kJunctionRel * result_.diameter);
      joints += more;
      if (more == 0) break;
    }
    if (joints > 0 &&
        take_closed(std::move(split),
                    plural(joints, "vertex") + " inside edges of other triangles joined", true,
                    best)) {
      return {};
    }
    return close_holes_of(std::move(best), odd);
  }

  // The way of welding that leaves the fewest odd edges.
  struct Best {
    IndexedSurface surface;
    std::size_t odd = 0;
    std::string sentence;
  };

  bool take_closed(IndexedSurface candidate,
                   const std::string& sentence,
                   bool branching,
                   Best& best) {
    const std::size_t odd = odd_edges(candidate).size();
    if (odd == 0 && (branching || branching_edges(candidate).empty())) {
      surface() = std::move(candidate);
      result_.repairs.push_back(sentence);
      return true;
    }
    if (odd > 0 && odd < best.odd) best = {std::move(candidate), odd, sentence};
    return false;
  }

  Result<void> close_holes_of(Best best, const std::vector<OddEdge>& odd) {
    const double flat = kFlatHoleRel * result_.diameter;
    const HoleLimits limits =
        bold() ? every_hole(flat, tolerance())
               : HoleLimits{tolerance(), kSimpleHoleEdges, kSimpleHoleRel * result_.diameter, flat,
                            tolerance()};
    auto closed = close_holes(best.surface, limits, context_);
    if (!closed) return error_of(closed);
    const std::vector<OddEdge> left = odd_edges(best.surface);
    if (left.empty()) {
      surface() = std::move(best.surface);
      if (!best.sentence.empty()) result_.repairs.push_back(best.sentence);
      result_.repairs.push_back(plural(closed->count, "hole") + " up to " +
                                describe_rounded(closed->largest) + " across closed by " +
                                plural(closed->triangles, "triangle") + such_as_at(closed->places));
      return {};
    }
    std::string help = bold() ? std::string(kWrapHelps)
                              : "Close the holes in the CAD program and export again, or let "
                                "repair=all close them";
    if (!closed->sheets.empty()) {
      help =
          plural(closed->sheets.size(), "part") + (closed->sheets.size() == 1 ? " is" : " are") +
          " an open sheet without thickness" + such_as_at(closed->sheets) +
          ": no closing of holes makes it solid; give it a thickness in the CAD program, or wrap "
          "the triangles by repair=wrap";
    }
    // What stays is told of the surface as it was read.
    result_.problem = refuse_open(surface(), odd, help);
    return {};
  }

  Result<void> orient() {
    IndexedSurface oriented = surface();
    auto shells = orient_shells(oriented, context_);
    if (!shells) {
      const ErrorCode code = shells.error().code;
      if (code != ErrorCode::kNotWatertight && code != ErrorCode::kDegenerateGeometry) {
        return error_of(shells);
      }
      result_.problem = shells.error();
      return {};
    }
    if (untouched() && (shells->flipped_alone > 0 || shells->flipped_shells > 0)) {
      std::vector<Point3> places;
      std::vector<std::int64_t> triangles;
      for (std::size_t t = 0; t < oriented.triangles.size(); ++t) {
        if (oriented.triangles[t] == surface().triangles[t]) continue;
        places.push_back(surface().points[surface().triangles[t][0]]);
        triangles.push_back(surface().source[t]);
      }
      refuse(ErrorCode::kNotWatertight,
             plural(places.size(), "triangle") + (places.size() == 1 ? " is" : " are") +
                 " seen from outside the wrong way round" + such_as_at(places) + "; " + kSafeHelps,
             std::move(triangles));
      return {};
    }
    surface() = std::move(oriented);
    result_.shells = shells->count;
    if (shells->flipped_alone > 0) {
      result_.repairs.push_back(plural(shells->flipped_alone, "triangle") +
                                " flipped to agree with their neighbours");
    }
    turned_shells_ = shells->flipped_shells;
    for (std::size_t t = 0; t < surface().triangles.size(); ++t) {
      if (shells->turned[shells->of_triangle[t]]) turned_sources_.push_back(surface().source[t]);
    }
    std::sort(turned_sources_.begin(), turned_sources_.end());
    return {};
  }

  Result<void> remove_flat() {
    if (untouched()) {
      for (std::size_t t = 0; t < surface().triangles.size(); ++t) {
        if (!lie_in_line(surface(), surface().triangles[t])) continue;
        refuse(ErrorCode::kDegenerateGeometry,
               "triangle " + std::to_string(surface().source[t]) +
                   near_triangle(surface(), static_cast<std::int32_t>(t)) + " has no area; " +
                   kSafeHelps,
               {surface().source[t]});
        return {};
      }
      return {};
    }
    std::optional<IndexedSurface> cleaned = remove_flat_triangles(surface());
    // What stays is left to the checks of the sector.
    if (!cleaned || cleaned->triangles.empty() || !odd_edges(*cleaned).empty() ||
        branching_edges(*cleaned).size() > branching_edges(surface()).size()) {
      return {};
    }
    const std::size_t before = surface().triangles.size();
    const std::size_t after = cleaned->triangles.size();
    if (before != after) {
      result_.repairs.push_back("triangles without area removed by flips and collapses: " +
                                plural(before - after, "triangle") + " less");
    }
    surface() = std::move(*cleaned);
    return {};
  }

  // Where triangles intersect or edges have four triangles: the boundary of what is inside.
  Result<void> resolve() {
    const std::size_t most = untouched() ? kMostNamedPairs : kMostPairs;
    auto pairs = self_intersections(surface(), most, context_);
    if (!pairs) return error_of(pairs);
    std::vector<Point3> places;
    const Touching touching = touching_places(surface(), &places);
    if (pairs->empty() && touching.none()) return {};
    const auto contacts = contacts_found();
    if (!contacts) return error_of(contacts);
    if (*contacts) return {};
    std::string reason;
    const bool more = pairs->size() == most;
    if (!untouched() && !more) {
      auto resolved = resolved_surface(*pairs, reason);
      if (!resolved) return error_of(resolved);
      if (*resolved) {
        record(**resolved, *pairs, places);
        surface() = std::move((*resolved)->surface);
        return orient_resolved();
      }
    }
    const std::string help = untouched()
                                 ? std::string(kSafeHelps)
                                 : "Unite overlapping bodies in the CAD program and export again, "
                                   "or wrap the triangles by repair=wrap";
    if (!pairs->empty()) {
      result_.problem = refuse_intersecting(surface(), *pairs, more, reason, help);
    } else {
      result_.problem =
          refuse_touching(surface(), places, (reason.empty() ? "" : reason + ". ") + help);
    }
    return {};
  }

  Result<std::optional<Resolved>> resolved_surface(
      const std::vector<std::pair<std::int32_t, std::int32_t>>& pairs, std::string& reason) {
    // Which shells lie in which is another question for those that meet: as they were read.
    IndexedSurface oriented = surface();
    for (std::size_t t = 0; t < oriented.triangles.size(); ++t) {
      Triangle& corners = oriented.triangles[t];
      if (std::binary_search(turned_sources_.begin(), turned_sources_.end(), oriented.source[t])) {
        std::swap(corners[1], corners[2]);
      }
    }
    const auto shells = orient_shells(oriented, context_, pairs);
    if (!shells) {
      if (is_limit(shells.error().code)) return error_of(shells);
      reason = shells.error().message;
      return std::optional<Resolved>();
    }
    const std::vector<bool>& turned = shells->turned;
    for (const auto& [s, t] : pairs) {
      const std::int32_t a = shells->of_triangle[s], b = shells->of_triangle[t];
      if (bold() || a == b || shells->depth[a] != shells->depth[b] || turned[a] == turned[b]) {
        continue;
      }
      reason = "shells meet" + near_triangle(surface(), s) +
               " that look to different sides: whether one is a body or a hollow is not known "
               "(repair=all takes both as bodies)";
      return std::optional<Resolved>();
    }
    for (std::size_t t = 0; t < oriented.triangles.size(); ++t) {
      const std::int32_t shell = shells->of_triangle[t];
      if (bold() || !shells->in_overlap[shell] || shells->depth[shell] % 2 == 0) continue;
      reason = "the closed part" + near_triangle(oriented, static_cast<std::int32_t>(t)) +
               " lies where bodies overlap: whether it is a hollow of all of them or of one, which "
               "the others fill, is not known (repair=all fills it)";
      return std::optional<Resolved>();
    }
    auto resolved = resolve_crossings(oriented, pairs, tolerance(), contact_, context_, reason);
    if (resolved && *resolved) {
      turned_shells_ = static_cast<std::size_t>(std::count(turned.begin(), turned.end(), true));
    }
    return resolved;
  }

  void record(const Resolved& resolved,
              const std::vector<std::pair<std::int32_t, std::int32_t>>& pairs,
              const std::vector<Point3>& places) {
    if (!pairs.empty()) {
      std::string sentence = plural(pairs.size(), "pair") +
                             " of intersecting triangles cut along each other" +
                             near_triangle(surface(), pairs.front().first) +
                             (pairs.size() > 1 ? " and elsewhere" : "");
      if (resolved.overlap_volume > 0) {
        sentence += "; a volume of " + describe_rounded(resolved.overlap_volume) +
                    " that was covered more than once is united";
      }
      if (resolved.inverted_volume > 0) {
        sentence += "; a volume of " + describe_rounded(resolved.inverted_volume) +
                    " that was inside out is left out";
      }
      if (resolved.cancelled_area > 0) {
        sentence += "; faces that lay on each other from both sides, an area of " +
                    describe_rounded(resolved.cancelled_area) + ", are left out";
      }
      if (resolved.voids > 0) {
        sentence += "; " + plural(resolved.voids, "void") + " thinner than " +
                    describe_rounded(tolerance()) + " filled, a volume of " +
                    describe_rounded(resolved.void_volume);
      }
      result_.repairs.push_back(std::move(sentence));
    }
    if (resolved.gap > 0) {
      const auto& [edges, corners] = resolved.split;
      result_.repairs.push_back((edges > 0 ? plural(edges, "edge") : "") +
                                (edges > 0 && corners > 0 ? " and " : "") +
                                (corners > 0 ? plural(corners, "corner") : "") +
                                " at which the solid touches itself split, the sheets moved apart "
                                "by twice " +
                                describe_rounded(resolved.gap) + such_as_at(places));
    }
  }

  Result<void> orient_resolved() {
    const auto shells = orient_shells(surface(), context_);
    if (!shells) {
      if (is_limit(shells.error().code)) return error_of(shells);
      result_.problem = shells.error();
      return {};
    }
    result_.shells = shells->count;
    return remove_flat();
  }

  // Edges far below the tolerance say nothing of the shape, and would be resolved by tetrahedra of
  // their size: a bushing took 170,000 for 50,000. But of a plate or a rod they may be the thickness:
  // a box of 12 triangles lost two thirds of its volume with them.
  Result<void> join_near() {
    if (untouched()) return {};
    const Point3 centre = 0.5 * (result_.box.low + result_.box.high);
    const double volume = enclosed_volume(surface(), centre);
    for (const double share : kJoinShares) {
      auto joined = collapse_short_edges(surface(), share * tolerance());
      if (!joined) continue;
      const double change = std::abs(enclosed_volume(*joined, centre) - volume);
      if (!(change <= kJoinVolumeRel * std::abs(volume))) continue;
      auto crossing = self_intersections(*joined, 1, context_);
      if (!crossing) return error_of(crossing);
      if (!crossing->empty()) continue;
      surface() = std::move(*joined);
      result_.joined = share * tolerance();
      return {};
    }
    return {};
  }

  // The last resort: from the triangles as they were read.
  Result<void> wrap() {
    const IndexedSurface soup = weld_exactly(input_);
    const double unit = std::max(tolerance(), kLeastWrapRel * result_.diameter);
    const double offset = kWrapOffset * tolerance();
    auto wrapped = wrap_surface(soup, kWrapAlpha * unit, offset, context_);
    if (!wrapped) {
      if (is_limit(wrapped.error().code)) return error_of(wrapped);
      result_.problem->message += "; " + wrapped.error().message;
      return {};
    }
    auto left = self_intersections(*wrapped, 1, context_);
    if (!left) return error_of(left);
    if (!left->empty()) {
      result_.problem->message += "; the wrap of the triangles intersects itself";
      return {};
    }
    const double reach = farthest_sample(*wrapped, soup);
    const double within = farthest_sample(soup, *wrapped);
    const std::string why = result_.problem->message;
    result_.problem.reset();
    surface() = std::move(*wrapped);
    SYMCELL_TRY(orient());
    result_.repairs = {"the triangles were wrapped by a surface " + describe_rounded(offset) +
                       " outside of them that closes gaps below " +
                       describe_rounded(kWrapAlpha * unit) + ", at most " +
                       describe_rounded(reach) + " away, because " + why};
    if (within > kWrapAlpha * unit + offset) {
      result_.repairs.push_back("what lies within the wrap is filled, up to " +
                                describe_rounded(within) +
                                " from it: hollows that nothing leads into, and inner walls");
    }
    return {};
  }

  // Of `from`, its farthest sample from `to`.
  static double farthest_sample(const IndexedSurface& from, const IndexedSurface& to) {
    const TriangleTree tree(to.points, to.triangles);
    double farthest2 = 0;
    std::int32_t last = -1;
    for (const Point3& p : samples_of(from)) {
      const auto hit = tree.nearest(p, std::numeric_limits<double>::infinity(), last);
      farthest2 = std::max(farthest2, hit.squared);
    }
    return std::sqrt(farthest2);
  }

  const TriangleSurface& input_;
  ExecutionContext& context_;
  double tolerance_rel_;
  Repair repair_;
  CleanSurface result_;
  bool contacts_looked_for_ = false;
  double contact_ = 0;  // how deep bodies that touch were put into each other
  std::vector<Point3> contacts_;
  IndexedSurface deepened_;  // the surface as read with them; empty: none, or taken
  std::size_t turned_shells_ = 0;
  std::vector<std::int32_t> turned_sources_;  // of triangles of shells that were turned, ascending
};

}  // namespace

Result<CleanSurface> clean_surface(const TriangleSurface& input,
                                   ExecutionContext& context,
                                   double tolerance_rel,
                                   Repair repair) {
  return Cleaner(input, context, tolerance_rel, repair).run();
}

}  // namespace symcell::solid
