// Edge collapses.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/improve/solid_surgery.hpp"

namespace symcell {
namespace {

// Stars this large are at hubs of the input.
constexpr std::size_t kMaxStar = 120;
// Where the tetrahedra that are left would fill more than this share of the volume bound on
// average, one of them would break it: not worth a closer look.
constexpr double kMaxFilling = 0.92;
// Whatever was there before: no tetrahedra flatter than this.
constexpr double kLeastShape = 1e-4;

}  // namespace

// Fills star_ and new_tets_: what goes, and what comes with the corner merged in place.
bool SolidSurgery::plan_collapse(TetId t, std::uint32_t from, std::uint32_t to, Collapse& plan) {
  const Corner u = mesh_.corner(t, from);
  plan.kind = mesh_.kind(u.v);
  if (plan.kind == SolidVertexKind::kInput) return false;
  // The star of an axis vertex is a period, not a ball.
  if (mesh_.on_axis(u.v) && mesh_.fold() > 1) return false;
  // In the frame where the vertex that goes has exponent 0.
  const Corner self{u.v, 0}, w = mesh_.shift(mesh_.corner(t, to), mesh_.subtract(0, u.k));
  if (w.v == u.v) return false;
  plan.goes = self;
  plan.stays = w;
  plan.behind = {-1, 0};
  plan.segment = mesh_.segment_of(self, w);
  const bool on_segment = plan.kind == SolidVertexKind::kSegment;
  if (on_segment && plan.segment == kNoSegment) return false;
  load_collapse_star(u.v);
  if (star_.size() > kMaxStar) return false;
  // No tetrahedron twice: a vertex next to its own copy stays.
  const std::uint32_t epoch = mesh_.new_epoch();
  bool in_facet = plan.kind == SolidVertexKind::kFree;
  new_tets_.clear();
  for (const TetCopy& c : star_) {
    Tet& tet = mesh_.tet(c.t);
    if (tet.stamp == epoch) return false;
    tet.stamp = epoch;
    std::array<Corner, 4> x;
    std::uint32_t own = 4;
    bool goes = false;
    for (std::uint32_t i = 0; i < 4; ++i) {
      x[i] = mesh_.corner(c, i);
      if (x[i] == self) {
        own = i;
      } else if (x[i].v == u.v) {
        return false;
      } else if (x[i] == w) {
        goes = true;
      }
    }
    for (std::uint32_t i = 0; on_segment && i < 4; ++i) {
      if (i != own && x[i] != w && mesh_.segment_of(self, x[i]) == plan.segment) plan.behind = x[i];
    }
    for (std::uint32_t f = 0; goes && !in_facet && f < 4; ++f) {
      // A subfacet with both the vertex and its target.
      in_facet = tet.facet[f] == mesh_.parent(u.v) && f != own && !(x[f] == w);
    }
    if (goes) continue;
    NewTet n;
    n.region = tet.region;
    for (std::uint32_t i = 0; i < 4; ++i) {
      n.c[i] = i == own ? w : x[i];
      if (i != own) n.facet[i] = tet.facet[i];
    }
    new_tets_.push_back(n);
  }
  return on_segment ? plan.behind.v >= 0 : in_facet;
}

// The star of a vertex is asked for once for each of its neighbours.
void SolidSurgery::load_collapse_star(VertexId v) {
  if (star_vertex_ == v && star_edits_ == edits_) return;
  star_.clear();
  mesh_.star(v, star_);
  star_vertex_ = v;
  star_edits_ = edits_;
}

bool SolidSurgery::may_shrink(std::span<const TetCopy> tets, std::size_t left) const {
  double volume = 0, limit = 0;
  for (const TetCopy& c : tets) {
    volume += editor_.measures(c.t).volume;
    limit = std::max(limit, criteria_.max_volume(mesh_.tet(c.t).region));
  }
  return volume <= kMaxFilling * limit * static_cast<double>(left);
}

bool SolidSurgery::do_collapse(const Collapse& plan) {
  // Two subsegments in one line become one: the outline of the facets there loses a corner.
  const bool on_segment = plan.kind == SolidVertexKind::kSegment;
  if (!apply(star_, new_tets_, on_segment ? Outline::kChanged : Outline::kKept)) return false;
  if (on_segment) {
    mesh_.edges().erase(mesh_.edge_key(plan.goes, plan.stays));
    mesh_.edges().erase(mesh_.edge_key(plan.goes, plan.behind));
    mesh_.edges().set(mesh_.edge_key(plan.stays, plan.behind), plan.segment);
  }
  mesh_.release_vertex(plan.goes.v);
  star_vertex_ = -1;
  editor_.count_collapse();
  return true;
}

bool SolidSurgery::collapse(
    TetId t, std::uint32_t from, std::uint32_t to, double floor, Bounds bounds) {
  Collapse plan;
  if (!plan_collapse(t, from, to, plan)) return false;
  if (bounds == Bounds::kKept && !may_shrink(star_, new_tets_.size())) {
    return merge_in_the_middle(plan, floor);
  }
  const Worth before = worth_of(star_);
  const double most =
      bounds == Bounds::kFree ? std::numeric_limits<double>::infinity() : most_excess(before);
  if (all_within(new_tets_, nullptr, least_shape(floor, before), most) && do_collapse(plan)) {
    return true;
  }
  return bounds == Bounds::kKept && merge_in_the_middle(plan, floor);
}

double SolidSurgery::most_excess(const Worth& before) const {
  return std::max(allowed_excess_, before.excess * (1 - kExcessGain));
}

double SolidSurgery::least_shape(double floor, const Worth& before) {
  return std::max(kLeastShape, std::min(floor, before.shape * (1 + kGain)));
}

bool SolidSurgery::merge_in_the_middle(const Collapse& plan, double floor) {
  const VertexId v = plan.stays.v;
  if (mesh_.kind(v) != plan.kind || mesh_.on_axis(v)) return false;
  if (plan.kind != SolidVertexKind::kFree && mesh_.parent(v) != mesh_.parent(plan.goes.v)) {
    return false;
  }
  other_star_.clear();
  mesh_.star(v, other_star_);
  if (other_star_.size() > kMaxStar) return false;
  Moved moved{plan.stays, 0.5 * (mesh_.lift(plan.goes) + mesh_.lift(plan.stays))};
  stretched_.clear();
  std::vector<TetCopy>& both = ring_.tets;
  both.assign(star_.begin(), star_.end());
  for (TetCopy& c : other_star_) {
    c.e = mesh_.add(c.e, plan.stays.k);
    NewTet n;
    n.region = mesh_.tet(c.t).region;
    bool shared = false;
    int copies = 0;
    for (std::uint32_t i = 0; i < 4; ++i) {
      n.c[i] = mesh_.corner(c, i);
      shared = shared || n.c[i] == plan.goes;
      copies += n.c[i].v == v ? 1 : 0;
      // A copy of the vertex that goes, elsewhere in the other's star.
      if (n.c[i].v == plan.goes.v && n.c[i] != plan.goes) return false;
    }
    if (copies > 1) return false;
    if (shared) continue;
    stretched_.push_back(n);
    both.push_back(c);
  }
  for (const NewTet& n : new_tets_) {
    for (const Corner& x : n.c) {
      if (x.v == v && x != plan.stays) return false;
    }
  }
  if (!may_shrink(both, new_tets_.size() + stretched_.size())) return false;
  const Worth before = worth_of(both);
  const double least = least_shape(floor, before), most = most_excess(before);
  if (!all_within(new_tets_, &moved, least, most) || !all_within(stretched_, &moved, least, most)) {
    return false;
  }
  if (!do_collapse(plan)) return false;
  mesh_.move_vertex(v, mesh_.rotations().rotate(moved.place, mesh_.subtract(0, plan.stays.k)));
  other_star_.clear();
  mesh_.star(v, other_star_);
  touched_.clear();
  for (const TetCopy& c : other_star_) {
    refresh(c.t);
    touched_.push_back(c.t);
  }
  return true;
}

}  // namespace symcell
