#include "core/solid/surface/improve_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <span>
#include <utility>

#include "core/geometry/indexed_surface.hpp"
#include "core/solid/surface/constrained_fit.hpp"
#include "core/solid/surface/deviation_guard.hpp"
#include "core/solid/surface/dissolve_patches.hpp"
#include "core/solid/surface/editable_surface.hpp"
#include "core/solid/surface/narrow_corners.hpp"
#include "core/solid/surface/surface_edits.hpp"

namespace symcell::solid {
namespace {

// Shape of a triangle: height over longest side; 0.87 is equilateral. A collapse may leave shapes
// this good, or no worse than they were; flips and moves mend them. At 0.3 regular fine meshes stay
// as they are, at 0.15 shapes suffer for few triangles less.
constexpr double kGoodTriangle = 0.25;
// Triangles in planar patches get flipped later anyhow: they must only not be needles.
constexpr double kGoodPlanarShape = 0.05;
// Thinner ones keep the normal of the input, as their own is noise.
constexpr double kSliverShape = 0.02;
// Most passes that collapse or settle flips, and rounds that shape, in case they go on undoing each
// other: they end earlier where little is gained.
constexpr int kMostPasses = 12;
constexpr int kRounds = 10;
// Triangles of curved parts flatter than this are split, down to sides of so many deviations.
constexpr double kWantedShape = 0.42;
constexpr double kLeastSplit = 10;
// A neighbour's side is halved first if it is longer by this factor, squared.
constexpr double kLonger = 1.0001;
constexpr int kMostPropagation = 100;  // steps from neighbour to neighbour
// A pass that changes less than this share of the surface is the last one.
constexpr double kWorthwhile = 0.005;
// A flip or a move must raise the worst shape by this factor.
constexpr double kBetter = 1.02;
// A Delaunay flip must lower the sum of the angles opposite to the edge by so much.
constexpr double kDelaunayGain = 0.02;
// A fit may lower it to this share.
constexpr double kFitShape = 0.95;
// Rounding that a vertex may be off the planes of its patches, of the extent.
constexpr double kPlaneRounding = 1e-11;
constexpr std::size_t kCheckEvery = 256;  // triangles or vertices: some cost nothing

// A triangle that has changed its place shows its own normal, unless it is a sliver.
void refresh_normals(QuotientSurface& surface) {
  const RotationTable rotations(surface.fold);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    std::array<Point3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = corner_point(surface, rotations, surface.triangles[t][i]);
    }
    if (shape_of(p) < kSliverShape) continue;
    const Point3 n = area_normal(p[0], p[1], p[2]);
    surface.normals[t] = (1 / length(n)) * n;
  }
}

class Improver {
 public:
  Improver(EditableSurface surface, DeviationGuard& guard, ExecutionContext& context)
      : mesh_(std::move(surface)), guard_(guard), context_(context) {
    for (const Point3& p : mesh_.surface().points) extent_ = std::max(extent_, length(p));
  }

  // Fewer triangles.
  Result<std::vector<std::array<std::uint8_t, 3>>> coarsen() {
    for (int pass = 0; pass < kMostPasses; ++pass) {
      auto collapsed = collapse_pass();
      if (!collapsed) return error_of(collapsed);
      auto ok = steps({&Improver::flip_pass, &Improver::move_pass});
      if (!ok) return error_of(ok);
      if (static_cast<double>(*collapsed) <= kWorthwhile * count()) break;
    }
    guard_.renumber(mesh_.compact());
    return mesh_.marks();
  }

  // Better triangles.
  Result<void> shape() {
    shaping_ = true;
    for (int round = 0; round < kRounds; ++round) {
      auto cut = split_pass();
      if (!cut) return error_of(cut);
      auto ok = steps({&Improver::flip_pass, &Improver::move_pass, &Improver::collapse_pass,
                       &Improver::flip_pass, &Improver::move_pass});
      if (!ok) return ok;
      if (static_cast<double>(*cut) <= kWorthwhile * count()) break;
    }
    auto ok = steps({&Improver::fit_pass, &Improver::flip_pass, &Improver::fit_pass});
    if (!ok) return ok;
    settling_ = true;
    begun_ = {};  // flips are judged in another way now
    for (int pass = 0; pass < kMostPasses; ++pass) {
      auto flipped = flip_pass();
      if (!flipped) return error_of(flipped);
      if (*flipped == 0) break;
    }
    ok = NarrowCorners(mesh_, guard_, kPlaneRounding * extent_, context_).open();
    if (!ok) return ok;
    guard_.renumber(mesh_.compact());
    return ok;
  }

 private:
  using Pass = Result<std::size_t> (Improver::*)();

  Result<void> steps(std::initializer_list<Pass> passes) {
    for (const Pass pass : passes) {
      auto done = (this->*pass)();
      if (!done) return error_of(done);
    }
    return {};
  }

  // What a pass has looked at in vain need not be looked at again before it has changed.
  enum PassKind : std::uint8_t { kCollapses, kFlips, kMoves };
  void begin(PassKind kind) {
    since_ = begun_[kind];
    begun_[kind] = ++now_;
    changed_.resize(mesh_.surface().triangles.size(), 0);
  }
  [[nodiscard]] bool has_changed(std::int32_t t) const { return changed_[t] >= since_; }
  [[nodiscard]] bool star_has_changed(std::int32_t v) const {
    const auto& star = mesh_.star(v);
    return std::any_of(star.begin(), star.end(), [this](std::int32_t t) { return has_changed(t); });
  }
  void commit(std::span<const std::int32_t> gone, std::span<const PlannedTriangle> planned) {
    guard_.commit(gone, planned);
    for (const PlannedTriangle& p : planned) {
      if (changed_.size() <= static_cast<std::size_t>(p.id)) changed_.resize(p.id + 1, 0);
      changed_[p.id] = now_;
    }
  }

  struct Candidate {
    double squared;
    std::int32_t triangle, side;
  };

  [[nodiscard]] double count() const {
    return static_cast<double>(mesh_.surface().triangles.size());
  }
  [[nodiscard]] bool planar(std::int32_t t) const { return mesh_.surface().patch[t] >= 0; }

  [[nodiscard]] std::vector<Candidate> edges_by_length() const {
    std::vector<Candidate> edges;
    const auto count = static_cast<std::int32_t>(mesh_.surface().triangles.size());
    for (std::int32_t t = 0; t < count; ++t) {
      if (!mesh_.alive(t)) continue;
      const auto p = mesh_.points(t);
      const QuotientTriangle& c = mesh_.surface().triangles[t];
      for (std::int32_t i = 0; i < 3; ++i) {
        if (c[i].orbit > c[(i + 1) % 3].orbit) continue;  // from one of its two triangles
        edges.push_back({squared_distance(p[i], p[(i + 1) % 3]), t, i});
      }
    }
    std::sort(edges.begin(), edges.end(), [](const Candidate& a, const Candidate& b) {
      return a.squared != b.squared
                 ? a.squared < b.squared
                 : (a.triangle != b.triangle ? a.triangle < b.triangle : a.side < b.side);
    });
    return edges;
  }

  Result<std::size_t> collapse_pass() {
    std::size_t done = 0, seen = 0;
    begin(kCollapses);
    touched_.assign(mesh_.surface().points.size(), false);
    for (const Candidate& e : edges_by_length()) {
      if (++seen % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      if (!mesh_.alive(e.triangle)) continue;
      const QuotientTriangle& c = mesh_.surface().triangles[e.triangle];
      const std::int32_t a = c[e.side].orbit, b = c[(e.side + 1) % 3].orbit;
      if (touched_[a] || touched_[b]) continue;
      if (!star_has_changed(a) && !star_has_changed(b)) continue;
      done += try_collapse(e.triangle, e.side) ? 1 : 0;
    }
    return done;
  }

  // The better of the two directions, if either is allowed.
  bool try_collapse(std::int32_t t, std::int32_t side) {
    struct Option {
      CollapsePlan plan;
      double shape;
    };
    std::vector<Option> options;
    for (const bool to_start : {false, true}) {
      if (!mesh_.may_leave(t, side, !to_start)) continue;
      auto plan = mesh_.plan_collapse(t, side, to_start);
      if (!plan) continue;
      const auto shape = acceptable_shape(*plan);
      if (shape) options.push_back({std::move(*plan), *shape});
    }
    std::stable_sort(options.begin(), options.end(),
                     [](const Option& a, const Option& b) { return a.shape > b.shape; });
    for (Option& option : options) {
      const CollapsePlan& plan = option.plan;
      const std::vector<std::int32_t> gone = gone_of(plan);
      const bool flat =
          std::all_of(gone.begin(), gone.end(), [this](std::int32_t g) { return planar(g); });
      if (flat) {
        guard_.follow(gone, plan.changed);
      } else if (!guard_.allows(gone, plan.changed)) {
        continue;
      }
      commit(gone, plan.changed);
      mesh_.collapse(plan);
      for (const PlannedTriangle& p : plan.changed) {
        for (const OrbitVertex& v : p.corners) touched_[v.orbit] = true;
      }
      return true;
    }
    return false;
  }

  // The worst shape that would result, if planes are kept, nothing turns over and no shape gets
  // worse than it may.
  [[nodiscard]] std::optional<double> acceptable_shape(const CollapsePlan& plan) const {
    double before = 1, before_planar = 1, after = 1, after_planar = 1;
    const auto note = [this](std::int32_t t, const std::array<Point3, 3>& p, double& curved,
                             double& flat) {
      double& worst = planar(t) ? flat : curved;
      worst = std::min(worst, shape_of(p));
    };
    for (const std::int32_t t : plan.removed) note(t, mesh_.points(t), before, before_planar);
    for (const PlannedTriangle& p : plan.changed) {
      note(p.id, mesh_.points(p.id), before, before_planar);
      note(p.id, p.points, after, after_planar);
      if (planar(p.id) && !keeps_plane(p)) return std::nullopt;
    }
    if (shaping_ ? after <= kBetter * before : after < std::min(before, kGoodTriangle)) {
      return std::nullopt;
    }
    if (after_planar < std::min(before_planar, kGoodPlanarShape)) return std::nullopt;
    return std::min(after, after_planar);
  }

  [[nodiscard]] bool keeps_plane(const PlannedTriangle& p) const {
    return symcell::solid::keeps_plane(mesh_, p, kPlaneRounding * extent_);
  }

  struct Side {
    std::int32_t triangle, side;
  };
  [[nodiscard]] double squared_length(Side s) const {
    const auto p = mesh_.points(s.triangle);
    return squared_distance(p[s.side], p[(s.side + 1) % 3]);
  }
  [[nodiscard]] Side longest_side(std::int32_t t) const {
    Side longest{t, 0};
    for (const std::int32_t i : {1, 2}) {
      if (squared_length({t, i}) > squared_length(longest)) longest = {t, i};
    }
    return longest;
  }

  // From a triangle's longest side on to the neighbour's, as long as that is longer: halving a side
  // that is not the longest makes thin triangles, and they others. Source: [Rivara97].
  [[nodiscard]] Side terminal_side(Side s) const {
    for (int step = 0; step < kMostPropagation; ++step) {
      const QuotientNeighbour other = mesh_.across(s.triangle, s.side);
      if (other.triangle < 0 || planar(other.triangle)) break;
      const Side next = longest_side(other.triangle);
      if (squared_length(next) <= kLonger * squared_length(s)) break;
      s = next;
    }
    return s;
  }

  // Triangles of curved parts that are too thin are halved across their longest side.
  Result<std::size_t> split_pass() {
    std::size_t done = 0;
    const auto count = static_cast<std::int32_t>(mesh_.surface().triangles.size());
    const double least = kLeastSplit * guard_.most();
    for (std::int32_t t = 0; t < count; ++t) {
      if (static_cast<std::size_t>(t) % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      if (!mesh_.alive(t) || planar(t)) continue;
      const auto p = mesh_.points(t);
      if (shape_of(p) >= kWantedShape) continue;
      const Side longest = longest_side(t);
      const double side2 = squared_length(longest);
      if (side2 < least * least) continue;
      // Bands thinner than the deviation, between edges that stay: halving makes more of them.
      if (length(area_normal(p[0], p[1], p[2])) < guard_.most() * std::sqrt(side2)) continue;
      const Side terminal = terminal_side(longest);
      const QuotientNeighbour other = mesh_.across(terminal.triangle, terminal.side);
      const std::vector<PlannedTriangle> changed = mesh_.split(terminal.triangle, terminal.side);
      if (changed.empty()) continue;
      const std::array<std::int32_t, 2> gone{terminal.triangle, other.triangle};
      guard_.follow(gone, changed);
      commit(gone, changed);
      ++done;
    }
    return done;
  }

  Result<std::size_t> flip_pass() {
    std::size_t done = 0;
    begin(kFlips);
    const auto count = static_cast<std::int32_t>(mesh_.surface().triangles.size());
    for (std::int32_t t = 0; t < count; ++t) {
      if (static_cast<std::size_t>(t) % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      for (std::int32_t side = 0; side < 3 && mesh_.alive(t); ++side) {
        done += try_flip(t, side) ? 1 : 0;
      }
    }
    return done;
  }

  bool try_flip(std::int32_t t, std::int32_t side) {
    const QuotientNeighbour other = mesh_.across(t, side);
    if (!has_changed(t) && (other.triangle < 0 || !has_changed(other.triangle))) return false;
    const auto plan = plan_inner_flip(mesh_, t, side);
    if (!plan) return false;
    const std::array<std::int32_t, 2> gone{plan->changed[0].id, plan->changed[1].id};
    if (!betters(*plan, mesh_.points(gone[0]), mesh_.points(gone[1]))) return false;
    if (planar(t)) {
      if (!keeps_plane(plan->changed[0]) || !keeps_plane(plan->changed[1])) return false;
      guard_.follow(gone, plan->changed);
    } else if (!guard_.allows(gone, plan->changed)) {
      return false;
    }
    commit(gone, plan->changed);
    mesh_.flip(*plan);
    return true;
  }

  // At first the worse of the two shapes counts; at last, where the surface hardly turns, that the
  // diagonal be the Delaunay one: else four vertices make a tetrahedron without height.
  [[nodiscard]] bool betters(const FlipPlan& plan,
                             const std::array<Point3, 3>& p,
                             const std::array<Point3, 3>& q) const {
    const std::array<Point3, 3>&r = plan.changed[0].points, &s = plan.changed[1].points;
    const double before = std::min(shape_of(p), shape_of(q));
    const double after = std::min(shape_of(r), shape_of(s));
    if (!settling_) return after > kBetter * before;
    // With corners (a, q, p) and (q, b, p): the new diagonal faces a and b.
    const double old_sum = angle_at(r[2], r[0], s[1]) + angle_at(r[1], r[0], s[1]);
    const double new_sum = angle_at(r[0], r[1], r[2]) + angle_at(s[1], s[0], s[2]);
    return old_sum > new_sum + kDelaunayGain && after > kFitShape * std::min(before, kGoodTriangle);
  }

  Result<std::size_t> move_pass() {
    std::size_t done = 0;
    begin(kMoves);
    const QuotientSurface& s = mesh_.surface();
    for (std::size_t i = 0; i < s.points.size(); ++i) {
      if (i % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      done += try_move(static_cast<std::int32_t>(i)) ? 1 : 0;
    }
    return done;
  }

  // Of a vertex inside a curved part, by area.
  [[nodiscard]] std::optional<Point3> middle_of_neighbours(std::int32_t v) const {
    const QuotientSurface& s = mesh_.surface();
    if (s.on_cut[v] != 0 || mesh_.star(v).empty()) return std::nullopt;
    double weight = 0;
    Point3 middle;
    for (const std::int32_t t : mesh_.star(v)) {
      if (planar(t)) return std::nullopt;
      for (std::int32_t i = 0; i < 3; ++i) {
        const QuotientTriangle& c = s.triangles[t];
        const bool at = c[i].orbit == v || c[(i + 1) % 3].orbit == v;
        if (at && mesh_.mark(t, i) != 0) return std::nullopt;
      }
      const auto p = mesh_.points(t);
      const double area = length(area_normal(p[0], p[1], p[2]));
      weight += area;
      middle = middle + (area / 3) * (p[0] + p[1] + p[2]);
    }
    if (!(weight > 0)) return std::nullopt;
    return (1 / weight) * middle;
  }

  // To the middle of its neighbours, on the old surface.
  bool try_move(std::int32_t v) {
    if (!star_has_changed(v)) return false;
    const auto middle = middle_of_neighbours(v);
    if (!middle) return false;
    double before = 1, after = 1;
    for (const std::int32_t t : mesh_.star(v)) before = std::min(before, shape_of(mesh_.points(t)));
    const auto hit = guard_.nearest(*middle, 10 * guard_.most());
    if (hit.triangle < 0) return false;
    const std::vector<PlannedTriangle> planned = mesh_.plan_move(v, hit.point);
    for (const PlannedTriangle& p : planned) after = std::min(after, shape_of(p.points));
    if (after <= kBetter * before) return false;
    const std::vector<std::int32_t> gone = mesh_.star(v);
    if (!guard_.allows(gone, planned)) return false;
    commit(gone, planned);
    mesh_.move(v, hit.point);
    return true;
  }

  // Vertices of curved parts, so that the surface runs through the middle of what it stands for:
  // chords inside a convex part would lose volume.
  Result<std::size_t> fit_pass() {
    std::size_t done = 0;
    const QuotientSurface& s = mesh_.surface();
    // All heights first: where all vertices of a triangle follow, it follows once.
    heights_.assign(s.triangles.size(), 0);
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
      const auto id = static_cast<std::int32_t>(t);
      if (mesh_.alive(id) && !planar(id)) heights_[t] = guard_.mean_height(id, mesh_.points(id));
    }
    for (std::size_t i = 0; i < s.points.size(); ++i) {
      if (i % kCheckEvery == 0) {
        SYMCELL_TRY(context_.check());
      }
      done += try_fit(static_cast<std::int32_t>(i)) ? 1 : 0;
    }
    return done;
  }

  bool try_fit(std::int32_t v) {
    const QuotientSurface& s = mesh_.surface();
    if (s.on_axis[v] != 0 || mesh_.star(v).empty()) return false;
    ConstrainedFit fit;
    if (s.on_cut[v] != 0) fit.keep({-std::sin(s.start_angle), std::cos(s.start_angle), 0});
    double before = 1;
    bool curved = false;
    for (const std::int32_t t : mesh_.star(v)) {
      const auto p = mesh_.points(t);
      before = std::min(before, shape_of(p));
      const Point3 n = area_normal(p[0], p[1], p[2]);
      const double twice = length(n);
      if (!(twice > 0)) return false;
      const Point3 here = mesh_.in_frame_of(v, t, (1 / twice) * n);
      if (planar(t)) {
        fit.keep(here);
        continue;
      }
      curved = true;
      fit.pull(here, heights_[t], twice);
    }
    if (!curved) return false;
    const Point3 place = s.points[v] + fit.displacement();
    const std::vector<PlannedTriangle> planned = mesh_.plan_move(v, place);
    double after = 1;
    for (const PlannedTriangle& p : planned) {
      after = std::min(after, shape_of(p.points));
      if (planar(p.id) && !keeps_plane(p)) return false;
    }
    if (after < kFitShape * before) return false;
    const std::vector<std::int32_t> gone = mesh_.star(v);
    if (!guard_.allows(gone, planned)) return false;
    commit(gone, planned);
    mesh_.move(v, place);
    return true;
  }

  EditableSurface mesh_;
  DeviationGuard& guard_;
  ExecutionContext& context_;
  std::vector<bool> touched_;
  std::vector<std::uint32_t> changed_;    // per triangle: when it last was, by now_
  std::array<std::uint32_t, 3> begun_{};  // the last pass of each kind
  std::uint32_t now_ = 0;
  std::uint32_t since_ = 0;      // the pass before this one
  std::vector<double> heights_;  // per triangle: of the old surface over it
  bool shaping_ = false;         // now only better shapes count, not fewer triangles
  bool settling_ = false;        // now only Delaunay flips
  double extent_ = 0;
};

}  // namespace

Result<void> improve_surface(QuotientSurface& surface,
                             double most,
                             const FlatnessTolerances& flatness,
                             ExecutionContext& context) {
  SYMCELL_TRY(dissolve_narrow_patches(surface, most));
  DeviationGuard guard(surface, most);
  auto editable = EditableSurface::create(surface);
  if (!editable) return error_of(editable);
  auto marks = Improver(std::move(*editable), guard, context).coarsen();
  if (!marks) return error_of(marks);
  refresh_normals(surface);
  SYMCELL_TRY(flatten_planar_patches(surface, flatness, context));
  SYMCELL_TRY(dissolve_sharp_patches(surface, most));
  editable = EditableSurface::create(surface, std::move(*marks));
  if (!editable) return error_of(editable);
  SYMCELL_TRY(Improver(std::move(*editable), guard, context).shape());
  drop_bent_triangles(surface);
  return {};
}

}  // namespace symcell::solid
