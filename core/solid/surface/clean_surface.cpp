#include "core/solid/surface/clean_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/geometry/limits.hpp"
#include "core/geometry/self_intersections.hpp"
#include "core/geometry/surface_distance.hpp"
#include "core/model/describe.hpp"
#include "core/solid/surface/mend_surface.hpp"
#include "core/solid/surface/shells.hpp"
#include "core/solid/surface/t_junctions.hpp"
#include "core/solid/surface/weld.hpp"

namespace symcell::solid {
namespace {

// Welding tolerances tried in turn, of the diameter: the first that closes the surface. The last is
// well below the symmetry tolerance, so features a mesh could show survive.
constexpr std::array<double, 8> kWeldTolerances = {1e-8, 1e-7, 5e-7, 1e-6, 2e-6, 5e-6, 1e-5, 3e-5};
constexpr std::size_t kNamed = 5;        // edges or pairs named in a message
constexpr std::size_t kListed = 100;     // triangles listed in an error
constexpr std::size_t kMostPairs = 200;  // intersecting pairs looked for

// Mending slivers that cross each other changes the volume by far less.
constexpr double kMendedVolumeRel = 1e-4;

std::string plural(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

struct OpenEdge {
  std::int32_t a, b;
  std::int32_t triangle;
  std::size_t uses;
};

std::vector<OpenEdge> open_edges(const IndexedSurface& surface) {
  std::vector<OpenEdge> open;
  const std::vector<EdgeUse> uses = sorted_edge_uses(surface.triangles);
  for_each_edge(uses, [&](std::size_t begin, std::size_t end) {
    if (end - begin == 2) return;
    open.push_back({uses[begin].low, uses[begin].high, uses[begin].triangle, end - begin});
  });
  return open;
}

class Cleaner {
 public:
  Cleaner(const TriangleSurface& input, ExecutionContext& context, double tolerance_rel)
      : input_(input), context_(context), tolerance_rel_(tolerance_rel) {}

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
    for (auto step : {&Cleaner::close, &Cleaner::orient, &Cleaner::remove_flat,
                      &Cleaner::check_intersections}) {
      auto done = (this->*step)();
      if (!done) return error_of(done);
      if (result_.problem) break;
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

  Result<void> close() {
    const std::size_t doubled = drop_doubled_triangles(surface());
    if (doubled > 0) result_.repairs.push_back(plural(doubled, "doubled triangle") + " removed");
    if (surface().triangles.empty()) {
      return fail(ErrorCode::kDegenerateGeometry,
                  "every triangle of the surface occurs from both sides: sheets enclose no volume; "
                  "give each face once, seen from outside");
    }
    std::vector<OpenEdge> open = open_edges(surface());
    if (open.empty()) return {};
    for (const double tolerance : kWeldTolerances) {
      SYMCELL_TRY(context_.check());
      IndexedSurface welded = weld_within(surface(), tolerance * result_.diameter);
      if (welded.triangles.empty() || !open_edges(welded).empty()) continue;
      result_.repairs.push_back(
          "vertices welded within " + describe_rounded(tolerance * result_.diameter) + ": " +
          plural(surface().points.size() - welded.points.size(), "vertex pair") + " joined, " +
          plural(surface().triangles.size() - welded.triangles.size(), "triangle") + " dropped");
      surface() = std::move(welded);
      return {};
    }
    IndexedSurface split = surface();
    const std::size_t joints = split_at_t_junctions(split, kJunctionRel * result_.diameter);
    if (joints > 0 && open_edges(split).empty()) {
      surface() = std::move(split);
      result_.repairs.push_back(plural(joints, "vertex") +
                                " inside edges of other triangles joined");
      return {};
    }
    report_open(open);
    return {};
  }

  void report_open(const std::vector<OpenEdge>& open) {
    std::string message = "the surface is not closed: " + plural(open.size(), "edge") +
                          (open.size() == 1 ? " does" : " do") + " not have two triangles, such as";
    std::vector<std::int64_t> elements;
    for (std::size_t i = 0; i < open.size() && i < kNamed; ++i) {
      const OpenEdge& e = open[i];
      message += (i == 0 ? " " : "; ") + std::string("the edge from ") +
                 describe_point(surface().points[e.a]) + " to " +
                 describe_point(surface().points[e.b]) + " of triangle " +
                 std::to_string(surface().source[e.triangle]) + " (" + plural(e.uses, "triangle") +
                 ")";
    }
    for (std::size_t i = 0; i < open.size() && i < kListed; ++i) {
      elements.push_back(surface().source[open[i].triangle]);
    }
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    result_.problem = Error{ErrorCode::kNotWatertight,
                            message + ". Close the holes in the CAD program and export again",
                            std::move(elements),
                            {}};
  }

  Result<void> orient() {
    auto shells = orient_shells(surface(), context_);
    if (!shells) {
      const ErrorCode code = shells.error().code;
      if (code != ErrorCode::kNotWatertight && code != ErrorCode::kDegenerateGeometry) {
        return error_of(shells);
      }
      result_.problem = shells.error();
      return {};
    }
    result_.shells = shells->count;
    if (shells->flipped_alone > 0) {
      result_.repairs.push_back(plural(shells->flipped_alone, "triangle") +
                                " flipped to agree with their neighbours");
    }
    if (shells->flipped_shells > 0) {
      result_.repairs.push_back(plural(shells->flipped_shells, "closed shell") +
                                " turned inside out");
    }
    return {};
  }

  Result<void> remove_flat() {
    std::optional<IndexedSurface> cleaned = remove_flat_triangles(surface());
    // What stays is left to the checks of the sector.
    if (!cleaned || cleaned->triangles.empty() || !open_edges(*cleaned).empty()) return {};
    const std::size_t before = surface().triangles.size();
    const std::size_t after = cleaned->triangles.size();
    if (before != after) {
      result_.repairs.push_back("triangles without area removed by flips and collapses: " +
                                plural(before - after, "triangle") + " less");
    }
    surface() = std::move(*cleaned);
    return {};
  }

  Result<void> check_intersections() {
    auto pairs = self_intersections(surface(), kMostPairs, context_);
    if (!pairs) return error_of(pairs);
    if (pairs->empty()) return {};
    if (pairs->size() < kMostPairs) {
      auto mended = mend(pairs->size());
      if (!mended) return error_of(mended);
      if (*mended) return {};
    }
    const std::string count = pairs->size() == kMostPairs ? "more than " : "";
    std::string message = "the surface intersects itself: " + count +
                          plural(pairs->size(), "pair") + " of triangles, such as";
    std::vector<std::int64_t> elements;
    for (std::size_t i = 0; i < pairs->size() && i < kListed; ++i) {
      const auto [s, t] = (*pairs)[i];
      elements.push_back(surface().source[s]);
      elements.push_back(surface().source[t]);
      if (i >= kNamed) continue;
      const Triangle& v = surface().triangles[s];
      const Point3 centre =
          (1.0 / 3) * (surface().points[v[0]] + surface().points[v[1]] + surface().points[v[2]]);
      message += (i == 0 ? " " : "; ") + std::to_string(surface().source[s]) + " and " +
                 std::to_string(surface().source[t]) + " near " + describe_point(centre);
    }
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    result_.problem =
        Error{ErrorCode::kSelfIntersection,
              message + ". Unite overlapping bodies in the CAD program and export again",
              std::move(elements),
              {}};
    return {};
  }

  // Takes the mended surface if nothing is wrong with it, and its volume and places are those of
  // before.
  Result<bool> mend(std::size_t count) {
    std::optional<IndexedSurface> mended = mend_intersections(surface());
    if (!mended) return false;
    const Point3 centre = 0.5 * (result_.box.low + result_.box.high);
    const double before = enclosed_volume(surface(), centre);
    const double after = enclosed_volume(*mended, centre);
    if (std::abs(after - before) > kMendedVolumeRel * std::abs(before)) return false;
    if (!open_edges(*mended).empty()) return false;
    auto left = self_intersections(*mended, 1, context_);
    if (!left) return error_of(left);
    if (!left->empty()) return false;
    // What lies between shells that overlap may be filled, or cut away.
    if (!are_near(surface(), *mended, tolerance_rel_ * result_.diameter)) return false;
    result_.repairs.push_back(plural(count, "pair") + " of intersecting triangles mended, volume " +
                              "changed by " + describe_rounded(after - before));
    surface() = std::move(*mended);
    return true;
  }

  const TriangleSurface& input_;
  ExecutionContext& context_;
  double tolerance_rel_;
  CleanSurface result_;
};

}  // namespace

Result<CleanSurface> clean_surface(const TriangleSurface& input,
                                   ExecutionContext& context,
                                   double tolerance_rel) {
  return Cleaner(input, context, tolerance_rel).run();
}

}  // namespace symcell::solid
