#include "core/solid/sector/surface_sector_source.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "core/base/random.hpp"
#include "core/geometry/self_intersections.hpp"
#include "core/geometry/spatial_order.hpp"
#include "core/geometry/surface_distance.hpp"
#include "core/model/describe.hpp"
#include "core/solid/groups/curve_boundary.hpp"
#include "core/solid/groups/label_boundary.hpp"
#include "core/solid/sector/glue_cuts.hpp"
#include "core/solid/sector/quotient_to_sector.hpp"
#include "core/solid/sector/wedge_cut.hpp"
#include "core/solid/sizes/size_sources.hpp"
#include "core/solid/sizes/wall_sizes.hpp"
#include "core/solid/surface/improve_surface.hpp"
#include "core/solid/surface/narrow_corners.hpp"
#include "core/solid/surface/planar_patches.hpp"

namespace symcell::solid {
namespace {

// A sector's volume times n against the input's: of the volume, or, where nothing comes so near, of
// a shell as thick as the symmetry error, by which sectors may differ.
constexpr double kVolumeRel = 1e-3;
constexpr double kShellShare = 0.5;
// Vertices nearer to a cut than a share of the tolerance are moved onto it. The first way is what
// worked best on real files; the others are for those it fails on. Wide tolerances move more than
// narrow sectors and small features bear: then less of them is used.
struct Way {
  double snap_share;       // of the tolerance
  double tolerance_share;  // of the tolerance
  double shell_share;      // of the symmetry error: kShellShare or none
  std::int32_t cuts;       // tried this way
};
constexpr std::array<Way, 9> kWays = {{{0.3, 1, 0, 12},
                                       {1, 1, 0, 4},
                                       {0, 1, 0, 6},
                                       {0.3, 1, kShellShare, 4},
                                       {0, 1, kShellShare, 3},
                                       {0.3, 0.25, kShellShare, 4},
                                       {0, 0.25, kShellShare, 2},
                                       {0.3, 0.06, kShellShare, 3},
                                       {0, 0.06, kShellShare, 2}}};
// Where nothing is cut; walls thinner than the tolerance need less of it.
constexpr std::array<double, 3> kWholeShares = {1, 0.06, 0.004};
// Cuts whose curves differ by more than so many tolerances do not match: of use are tolerances of
// half the symmetry error and above.
constexpr double kMatchTolerances = 2;
// Vertices of the two cut curves nearer than this share of the tolerance are one.
constexpr double kMergeShare = 0.3;
// Coordinates come in single precision or with six digits: noise as a share of the largest one, and
// of the diameter at least.
constexpr double kSinglePrecision = 2.5e-7;
constexpr double kLeastNoiseRel = 1e-6;
// Facets of CAD parts may be so far from flat, of the tolerance, by the axis' own error.
constexpr double kFlatShareOfTolerance = 0.02;
// Shares of what flat parts may be moved by, tried in turn where sheets are too near for more.
constexpr std::array<double, 2> kFlattenShares = {1, 0.01};
// Shares of the tolerance that the improvement of the triangles may use, tried in turn until hardly
// any thin triangle is left. With narrow corners two results are enough.
constexpr std::array<double, 9> kImproveShares = {0.35, 0.3, 0.25, 0.2, 0.1, 0.05, 0.01, 0.002, 0};
constexpr int kEnoughTaken = 2;
// From here on only where nothing else is the input's shape: sheets may be nearer than a larger share.
// They are tried after so many failures.
constexpr double kLastShares = 0.01;
constexpr int kEnoughFailed = 4;
// Likewise for what has been improved already. A pass that leaves more than that of the cost is the
// last one: passes end, as each but the last makes the cost smaller by a factor.
constexpr std::array<double, 2> kAgainShares = {0.3, 0.15};
constexpr double kWorthwhile = 0.85;
// Surfaces that must be divided for the sake of their shapes take their time: no more shares once
// the results have so many triangles, and so many times those given.
constexpr std::size_t kManyTriangles = 20'000;
constexpr std::size_t kManyTimes = 4;
// So many triangles of curved parts may be thin: height below a fifth of the longest side.
constexpr double kThinShape = 0.2;
constexpr double kThinShare = 0.002;
// Each narrow corner counts as so many elements, and any of them as so much more of all: a mesh
// without bad tetrahedra is worth some more good ones.
constexpr double kNarrowCost = 400;
constexpr double kNarrowFactor = 1.5;
// Boundary squared over area is 16 for a square and 4 times length over width for a strip, which
// takes two triangles for each square of its width.
constexpr double kSquareRound = 2;
// Of its longest side: no triangle counts as flatter.
constexpr double kLeastHeight = 1e-4;

// Moves the surface into the local frame.  Returns the noise of its coordinates.
double move_to_frame(IndexedSurface& surface, const Symmetry& symmetry) {
  double largest = 0;
  for (Point3& p : surface.points) {
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    p = symmetry.frame.to_local(p);
  }
  return std::max(kSinglePrecision * largest, kLeastNoiseRel * symmetry.diameter);
}

GroupingOptions grouping_of(const Symmetry& symmetry,
                            double tolerance,
                            double noise,
                            const MeshOptions& options) {
  GroupingOptions how;
  how.feature_angle_deg = options.feature_angle_deg;
  how.fold = symmetry.fold;
  how.frame = symmetry.frame;
  how.reach = kMatchTolerances * tolerance;
  how.noise = noise;
  how.sector = options.sector;
  return how;
}

IndexedSurface restored_sector(const QuotientSurface& s) {
  const RotationTable rotations(s.fold);
  IndexedSurface flat;
  std::vector<std::int32_t> lower(s.points.size(), -1), higher(s.points.size(), -1);
  for (const QuotientTriangle& t : s.triangles) {
    Triangle corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      std::int32_t& id = (t[i].exponent == 0 ? lower : higher)[t[i].orbit];
      if (id < 0) {
        id = static_cast<std::int32_t>(flat.points.size());
        flat.points.push_back(corner_point(s, rotations, t[i]));
      }
      corners[i] = id;
    }
    flat.triangles.push_back(corners);
  }
  return flat;
}

struct PatchFigures {
  double area = 0;
  double boundary = 0;
};

std::map<std::int32_t, PatchFigures> patch_figures(const QuotientSurface& s,
                                                   const RotationTable& rotations) {
  std::map<std::int32_t, PatchFigures> patches;
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    if (s.patch[t] < 0) continue;
    const QuotientTriangle& c = s.triangles[t];
    patches[s.patch[t]].area +=
        length(area_normal(corner_point(s, rotations, c[0]), corner_point(s, rotations, c[1]),
                           corner_point(s, rotations, c[2]))) /
        2;
  }
  const std::vector<QuotientEdgeUse> uses = sorted_edge_uses(s);
  for (std::size_t i = 0; i + 1 < uses.size(); i += 2) {
    const std::int32_t p = s.patch[uses[i].triangle], q = s.patch[uses[i + 1].triangle];
    if (p == q) continue;
    const QuotientTriangle& c = s.triangles[uses[i].triangle];
    const double side = distance(corner_point(s, rotations, c[uses[i].side]),
                                 corner_point(s, rotations, c[(uses[i].side + 1) % 3]));
    if (p >= 0) patches[p].boundary += side;
    if (q >= 0) patches[q].boundary += side;
  }
  return patches;
}

SectorShape shape_of(const QuotientSurface& s) {
  const RotationTable rotations(s.fold);
  std::size_t thin = 0;
  SectorShape shape;
  std::map<std::pair<std::int32_t, std::int32_t>, double> corners;  // of planar patches
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    std::array<Point3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = corner_point(s, rotations, s.triangles[t][i]);
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 u = p[(i + 1) % 3] - p[i], v = p[(i + 2) % 3] - p[i];
      const double angle = std::atan2(length(cross(u, v)), dot(u, v));
      if (s.patch[t] >= 0) {
        corners[{s.patch[t], s.triangles[t][i].orbit}] += angle;
      } else {
        shape.narrow += angle < kNarrowCorner ? 1 : 0;
      }
    }
    if (s.patch[t] >= 0) continue;
    const auto& [a, b, c] = p;
    const double longest2 =
        std::max({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
    const double twice_area = length(area_normal(a, b, c));
    thin += twice_area < kThinShape * longest2 ? 1 : 0;
    shape.cost += longest2 / std::max(twice_area, kLeastHeight * longest2);
  }
  for (const auto& [patch, figures] : patch_figures(s, rotations)) {
    shape.cost += figures.boundary * figures.boundary / (kSquareRound * figures.area);
  }
  for (const auto& [corner, angle] : corners) shape.narrow += angle < kNarrowCorner ? 1 : 0;
  shape.cost += kNarrowCost * static_cast<double>(shape.narrow);
  if (shape.narrow > 0) shape.cost *= kNarrowFactor;
  shape.thin = static_cast<double>(thin) / static_cast<double>(s.triangles.size());
  return shape;
}

}  // namespace

bool SectorShape::many_thin() const {
  return thin > kThinShare;
}

bool SectorShape::better_than(const SectorShape& other) const {
  return many_thin() != other.many_thin() ? other.many_thin() : cost < other.cost;
}

namespace {

BoundaryTopology topology_of(const IndexedSurface& surface) {
  std::vector<OrbitTriangle> triangles;
  triangles.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles) {
    triangles.push_back({OrbitVertex{t[0], 0}, OrbitVertex{t[1], 0}, OrbitVertex{t[2], 0}});
  }
  const std::vector<std::uint8_t> on_axis(surface.points.size(), 0);
  return boundary_topology(1, on_axis, triangles);
}

}  // namespace

SurfaceSectorSource::SurfaceSectorSource(CleanSurface clean, Symmetry symmetry, double tolerance)
    : symmetry_(std::move(symmetry)),
      repairs_(std::move(clean.repairs)),
      tolerance_(tolerance),
      allowed_(tolerance - clean.joined),
      volume_(clean.volume),
      area_(clean.area),
      full_(std::move(clean.surface)) {
  noise_ = move_to_frame(full_, symmetry_);
  topology_ = topology_of(full_);
  tree_ = TriangleTree(full_.points, full_.triangles);
  given_ = std::make_shared<const IndexedSurface>(full_);
  choose_candidates();
}

// Angles in the middle of the widest gaps between vertices, modulo the sector, each in a sector of
// its own; the same angles with each way of snapping.
void SurfaceSectorSource::choose_candidates() {
  if (symmetry_.fold == 1) {
    for (const double share : kWholeShares) candidates_.push_back({0, 0, share * tolerance_, 0});
    preferred_ = 1;
    return;
  }
  const double sector = 2 * std::numbers::pi / symmetry_.fold;
  std::vector<double> angles;
  const auto add_angles = [&](double least_radius) {
    for (const Point3& p : full_.points) {
      if (std::hypot(p.x, p.y) <= least_radius) continue;
      angles.push_back(std::fmod(std::atan2(p.y, p.x) + 2 * std::numbers::pi, sector));
    }
  };
  add_angles(tolerance_);
  if (angles.empty()) add_angles(0);  // a rod thinner than the tolerance
  std::sort(angles.begin(), angles.end());
  struct Gap {
    double width, middle;
  };
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double next = i + 1 < angles.size() ? angles[i + 1] : angles[0] + sector;
    gaps.push_back({next - angles[i], (angles[i] + next) / 2});
  }
  std::sort(gaps.begin(), gaps.end(), [](const Gap& a, const Gap& b) {
    return a.width != b.width ? a.width > b.width : a.middle < b.middle;
  });
  Random random(1);
  for (const Way& way : kWays) {
    const double tolerance = way.tolerance_share * tolerance_;
    if (way.tolerance_share < 1 &&
        kMatchTolerances * tolerance < symmetry_.error_rel * symmetry_.diameter) {
      break;
    }
    for (std::int32_t i = 0; i < way.cuts; ++i) {
      const auto which = std::min(static_cast<std::size_t>(i), gaps.size() - 1);
      const auto copy = static_cast<std::int32_t>(random.next() % symmetry_.fold);
      candidates_.push_back({gaps[which].middle + copy * sector, way.snap_share * tolerance,
                             tolerance, way.shell_share});
      preferred_ += way.shell_share == 0 ? 1 : 0;
    }
  }
}

// Turns of the smaller fold are turns of the larger one, so its error is no larger.
Result<std::unique_ptr<SectorSource>> SurfaceSectorSource::with_fold(
    std::int32_t fold, ExecutionContext& /*context*/) const {
  auto other = std::make_unique<SurfaceSectorSource>(*this);
  other->symmetry_.fold = fold;
  other->candidates_.clear();
  other->preferred_ = 0;
  other->choose_candidates();
  other->make_size_field();
  return other;
}

std::unique_ptr<SectorSource> SurfaceSectorSource::with_surface(
    const IndexedSurface& boundary) const {
  auto other = std::make_unique<SurfaceSectorSource>(*this);
  other->full_ = boundary;
  other->of_mesh_ = true;
  other->candidates_.clear();
  other->choose_candidates();
  return other;
}

// Sheets that are nearer to each other than what flat parts may be moved by may come to cross: then less
// is moved, as long as the surface before is the input's shape.
Result<SectorShape> SurfaceSectorSource::flatten_and_improve(QuotientSurface& surface,
                                                             const Candidate& candidate,
                                                             ExecutionContext& context) const {
  const QuotientSurface given = surface;
  Result<SectorShape> first = fail(ErrorCode::kInternal, "");
  for (const double share : kFlattenShares) {
    surface = given;
    const double noise = share * noise_;
    const FlatnessTolerances flatness{
        noise, std::max(noise, share * kFlatShareOfTolerance * candidate.tolerance)};
    Result<SectorShape> shape = fail(ErrorCode::kInternal, "");
    if (const auto flat = flatten_planar_patches(surface, flatness, context); flat) {
      shape = improve(surface, candidate, flatness, context);
    } else {
      shape = error_of(flat);
    }
    if (shape || is_limit(shape.error().code)) return shape;
    if (share == kFlattenShares.front()) first = std::move(shape);
    if (!check_shape(given, candidate.shell_share, context)) {
      SYMCELL_TRY(context.check());
      break;
    }
  }
  return first;
}

// What each share of the tolerance leads to differs from part to part, and how much of it the
// symmetry error has used up from place to place: a result that is no longer the input's shape is
// none.
Result<SectorShape> SurfaceSectorSource::improve(QuotientSurface& surface,
                                                 const Candidate& candidate,
                                                 const FlatnessTolerances& flatness,
                                                 ExecutionContext& context) const {
  const QuotientSurface given = surface;
  Error last;
  std::optional<SectorShape> best;
  int taken = 0, failed = 0;
  std::size_t made = 0;
  for (const double share : kImproveShares) {
    if (best && share <= kLastShares) break;
    if (failed >= kEnoughFailed && share > kLastShares) continue;
    QuotientSurface improved = given;
    if (share > 0) {
      SYMCELL_TRY(improve_surface(improved, share * candidate.tolerance, flatness, context));
    }
    const SectorShape shape = shape_of(improved);
    ++taken;
    made += improved.triangles.size();
    if (!best || shape.better_than(*best)) {
      if (auto same = check_shape(improved, candidate.shell_share, context); !same) {
        SYMCELL_TRY(context.check());
        // A cut that is off before anything is improved is off at every share.
        if (last.message.empty() && !check_shape(given, candidate.shell_share, context)) {
          return error_of(same);
        }
        last = same.error();
        --taken;
        ++failed;
        continue;
      }
      surface = std::move(improved);
      best = shape;
    }
    if (!best->many_thin() && (best->narrow == 0 || taken >= kEnoughTaken)) break;
    if (made > kManyTriangles + kManyTimes * given.triangles.size()) break;
  }
  if (!best) return fail(last);
  if (!of_mesh_ && (best->narrow > 0 || best->many_thin())) {
    SYMCELL_TRY(improve_again(surface, *best, candidate, flatness, context));
  }
  best->made += made;
  return *best;
}

// What has been improved is a better surface to improve: strips that were merged, and corners that
// were opened, let more be merged. Where no corner is narrow there is little to gain, and chance
// decides. The result counts if it is still the input's shape.
Result<void> SurfaceSectorSource::improve_again(QuotientSurface& surface,
                                                SectorShape& shape,
                                                const Candidate& candidate,
                                                const FlatnessTolerances& flatness,
                                                ExecutionContext& context) const {
  std::size_t made = 0;
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (const double share : kAgainShares) {
      QuotientSurface improved = surface;
      auto done = flatten_planar_patches(improved, flatness, context);
      if (done) done = improve_surface(improved, share * candidate.tolerance, flatness, context);
      SYMCELL_TRY(context.check());
      made += improved.triangles.size();
      if (!done) continue;
      const SectorShape better = shape_of(improved);
      if (!better.better_than(shape)) continue;
      const auto same = check_shape(improved, candidate.shell_share, context);
      SYMCELL_TRY(context.check());
      if (!same) continue;
      goes_on = better.cost < kWorthwhile * shape.cost;
      shape = better;
      surface = std::move(improved);
      break;
    }
  }
  shape.made = made;
  return {};
}

Result<void> SurfaceSectorSource::check_shape(const QuotientSurface& surface,
                                              double shell_share,
                                              ExecutionContext& context) const {
  const BoundaryTopology topology =
      boundary_topology(surface.fold, surface.on_axis, surface.triangles);
  if (topology.shells != topology_.shells || topology.euler != topology_.euler) {
    return fail(
        ErrorCode::kInternal,
        "the sector has another topology than the surface: " + std::to_string(topology.shells) +
            " shells, Euler characteristic " + std::to_string(topology.euler) + ", for " +
            std::to_string(topology_.shells) + " and " + std::to_string(topology_.euler));
  }
  const double volume = full_volume(surface);
  const double error = symmetry_.error_rel * symmetry_.diameter;
  const double most = std::max(kVolumeRel * std::abs(volume_), shell_share * error * area_);
  if (!(std::abs(volume - volume_) <= most)) {
    return fail(ErrorCode::kInternal, "the sector's volume is wrong: " + describe_rounded(volume) +
                                          " for " + describe_rounded(volume_));
  }
  const IndexedSurface restored = restored_sector(surface);
  SYMCELL_TRY(check_distances(restored, context));
  auto crossing = self_intersections(restored, 1, context);
  if (!crossing) return error_of(crossing);
  if (!crossing->empty()) return fail(ErrorCode::kInternal, "the sector intersects itself");
  return {};
}

// Over the whole model: every copy near the input, all of the input near a copy.
Result<void> SurfaceSectorSource::check_distances(const IndexedSurface& sector,
                                                  ExecutionContext& context) const {
  const auto is_near = [](DistanceBound& bound, const IndexedSurface& surface) {
    return std::all_of(surface.triangles.begin(), surface.triangles.end(), [&](const Triangle& t) {
      return !bound.beyond({surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]});
    });
  };
  const auto failure = fail(ErrorCode::kInternal, "the sector is too far from the surface");
  const RotationTable rotations(symmetry_.fold);
  DistanceBound from_input(tree_, allowed_);
  IndexedSurface all;
  for (std::int32_t k = 0; k < symmetry_.fold; ++k) {
    SYMCELL_TRY(context.check());
    IndexedSurface copy;
    copy.triangles = sector.triangles;
    for (const Point3& p : sector.points) copy.points.push_back(rotations.rotate(p, k));
    if (!is_near(from_input, copy)) return failure;
    const auto first = static_cast<std::int32_t>(all.points.size());
    all.points.insert(all.points.end(), copy.points.begin(), copy.points.end());
    for (const Triangle& t : sector.triangles) {
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  SYMCELL_TRY(context.check());
  const TriangleTree copies(all.points, all.triangles);
  DistanceBound from_copies(copies, allowed_);
  return is_near(from_copies, *given_) ? Result<void>{} : failure;
}

// What the sector's check did not show may show here: rounding, and what became of facets. The distance
// from a triangle is convex: a facet whose nodes are all near one triangle is near it everywhere.
Result<void> SurfaceSectorSource::check_boundary(const SymmetryCellMesh& cell,
                                                 ExecutionContext& context) const {
  const RotationTable rotations(symmetry_.fold);
  std::vector<Point3> places(cell.nodes.size());
  std::vector<std::int32_t> near(cell.nodes.size(), -1);  // item of the tree; -1: not looked for
  std::int32_t last = -1;
  DistanceBound bound(tree_, allowed_);
  const auto too_far = [&](Point3 p) {
    return fail(ErrorCode::kInternal,
                "the mesh's boundary is farther from the surface than the tolerance of " +
                    describe_rounded(allowed_) + " at " +
                    describe_point(symmetry_.frame.to_model(p)));
  };
  for (std::int32_t k = 0; k < symmetry_.fold; ++k) {
    SYMCELL_TRY(context.check());
    std::fill(near.begin(), near.end(), -1);
    for (std::size_t i = 0; i + 2 < cell.boundary.size(); i += 3) {
      bool is_near_one = true;
      std::array<Point3, 3> corners;
      for (std::size_t j = 0; j < 3; ++j) {
        const auto node = static_cast<std::size_t>(cell.boundary[i + j]);
        if (near[node] < 0) {
          const OrbitVertex v = cell.nodes[node];
          places[node] = rotations.rotate(cell.orbit_points[static_cast<std::size_t>(v.orbit)],
                                          rotations.reduce(std::int64_t{v.exponent} + k));
          if (!tree_.within(places[node], allowed_, last)) return too_far(places[node]);
          near[node] = last;
        } else {
          last = near[node];
        }
        corners[j] = places[node];
        is_near_one = is_near_one && near[node] == near[static_cast<std::size_t>(cell.boundary[i])];
      }
      if (is_near_one) continue;
      if (const auto beyond = bound.beyond(corners)) return too_far(*beyond);
    }
  }
  return {};
}

Result<void> SurfaceSectorSource::label_boundary(SymmetryCellMesh& cell,
                                                 ExecutionContext& context) const {
  return solid::label_boundary(groups_, full_, tree_, cell, context);
}

bool SurfaceSectorSource::curves(const MeshOptions& options) const {
  // Of a tessellation order 1 is as good as the mesh's own triangles.
  return options.curved.value_or(is_cad_) && (is_cad_ || options.order == 2);
}

std::unique_ptr<CurvedBoundary> SurfaceSectorSource::curved_boundary(
    const SymmetryCellMesh& cell, const MeshOptions& options) const {
  if (groups_.piece_fits.empty() || !curves(options)) return nullptr;
  const CurvingBounds bounds{allowed_,           options.radius_edge, options.max_edge,
                             options.max_volume, sizes_.get(),        is_cad_};
  return std::make_unique<CurvedBoundary>(groups_, tree_, cell, bounds);
}

Result<void> SurfaceSectorSource::find_groups(const TriangleSurface& given,
                                              const MeshOptions& options,
                                              ExecutionContext& context) {
  GroupingOptions how = grouping_of(symmetry_, tolerance_, noise_, options);
  is_cad_ = given.cad_notes.has_value();
  how.pieces = curves(options);
  how.farthest = allowed_;
  auto found = find_face_groups(full_, tree_, given, how, context);
  if (!found) return error_of(found);
  groups_ = std::move(*found);
  return {};
}

Result<std::vector<FaceGroup>> groups_of_surface(IndexedSurface surface,
                                                 const Symmetry& symmetry,
                                                 double tolerance,
                                                 const TriangleSurface& given,
                                                 const MeshOptions& options,
                                                 ExecutionContext& context) {
  const double noise = move_to_frame(surface, symmetry);
  const TriangleTree tree(surface.points, surface.triangles);
  auto found = find_face_groups(surface, tree, given,
                                grouping_of(symmetry, tolerance, noise, options), context);
  if (!found) return error_of(found);
  return std::move(found->groups);
}

Result<void> SurfaceSectorSource::find_sizes(const TriangleSurface& given,
                                             const MeshOptions& options,
                                             ExecutionContext& context) {
  SizedModel model{full_, groups_.of_triangle, {}, {}, given.vertices, symmetry_.frame};
  for (const FaceGroup& g : groups_.groups) model.names.push_back({g.marker, g.name});
  auto asked = size_sources(model, options);
  if (!asked) return error_of(asked);
  size_sources_ = std::move(asked->sources);
  symmetry_.warnings.insert(symmetry_.warnings.end(), asked->warnings.begin(),
                            asked->warnings.end());
  const auto add = [this](const std::vector<SizeSource>& more) {
    size_sources_.insert(size_sources_.end(), more.begin(), more.end());
  };
  if (options.chord_error_given) add(curvature_sources(full_, groups_, options.chord_error_rel));
  if (options.preset != Preset::kNone) {
    // All copies: another fold may be taken.
    const auto walls = wall_sizes(full_, tree_, elements_across(options.preset), false, context);
    if (!walls) return error_of(walls);
    add(*walls);
  }
  if (std::isfinite(options.gradation)) gradation_ = options.gradation;
  make_size_field();
  return {};
}

void SurfaceSectorSource::make_size_field() {
  if (size_sources_.empty()) return;
  // Parts that the file names may be in one sector alone.
  const auto sources =
      groups_.named ? size_sources_ : of_first_sector(size_sources_, symmetry_.fold);
  sizes_ = std::make_shared<const SizeField>(sources, gradation_, symmetry_.fold);
}

Result<Sector> SurfaceSectorSource::sector(std::int32_t index, ExecutionContext& context) const {
  const Candidate& candidate = candidates_[index];
  QuotientSurface quotient;
  if (symmetry_.fold == 1) {
    quotient.points = full_.points;
    quotient.on_axis.assign(full_.points.size(), 0);
    quotient.on_cut.assign(full_.points.size(), 0);
    for (const Triangle& t : full_.triangles) {
      quotient.triangles.push_back({OrbitVertex{t[0], 0}, {t[1], 0}, {t[2], 0}});
      const Point3 n = area_normal(full_, t);
      quotient.normals.push_back((1 / length(n)) * n);
    }
  } else {
    auto patch = cut_wedge(full_, symmetry_.fold, candidate.start_angle, candidate.snap);
    if (!patch) return error_of(patch);
    auto glued = glue_cuts(std::move(*patch), kMatchTolerances * candidate.tolerance,
                           kMergeShare * candidate.tolerance, context);
    if (!glued) return error_of(glued);
    quotient = std::move(glued->surface);
  }
  const auto shape = flatten_and_improve(quotient, candidate, context);
  if (!shape) return error_of(shape);
  auto sector = quotient_to_sector(quotient);
  if (sector) {
    sector->narrow_corners = shape->narrow;
    sector->meshing_cost = shape->cost;
    sector->triangles_made = shape->made;
  }
  return sector;
}

}  // namespace symcell::solid
