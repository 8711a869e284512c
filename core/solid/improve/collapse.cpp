// Merges of a vertex into a neighbour (edge collapses).
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/solid/improve/surgery.hpp"

namespace symcell::solid {
namespace {

// Where the tetrahedra that are left would fill more than this share of the volume bound on
// average, one of them would break it: not worth a closer look.
constexpr double kMaxFilling = 0.92;
// Whatever was there before: no tetrahedra flatter than this.
constexpr double kLeastShape = 1e-4;

}  // namespace

// Loads the star of what goes; false where the two cannot be one vertex.
bool Surgery::plan_collapse(OrbitVertex goes, OrbitVertex stays, Collapse& plan) {
  plan.kind = mesh_.kind(goes.orbit);
  if (plan.kind == VertexKind::kInput || stays.orbit == goes.orbit) return false;
  // The star of an axis vertex is a period, not a ball.
  if (mesh_.on_axis(goes.orbit) && mesh_.fold() > 1) return false;
  plan.goes = goes;
  plan.stays = stays;
  plan.segment = mesh_.segment_of(goes, stays);
  const bool on_segment = plan.kind == VertexKind::kSegment;
  if (on_segment && plan.segment == kNoSegment) return false;
  // No tetrahedron twice: a vertex next to its own copy stays.
  if (!load_star(goes.orbit) || !star_simple_) return false;
  bool in_facet = plan.kind == VertexKind::kFree;
  for (std::size_t n = 0; n < star_.size(); ++n) {
    const StarTet& s = star_tets_[n];
    for (std::uint32_t i = 0; on_segment && i < 4; ++i) {
      if (i == s.apex || s.c[i] == stays) continue;
      if (mesh_.segment_of(goes, s.c[i]) == plan.segment) plan.behind = s.c[i];
    }
    if (!s.has(stays)) continue;
    ++plan.shared;
    for (std::uint32_t f = 0; !in_facet && f < 4; ++f) {
      // A subfacet with both the vertex and its target.
      in_facet = mesh_.tet(star_[n].t).facet[f] == mesh_.parent(goes.orbit) && f != s.apex &&
                 !(s.c[f] == stays);
    }
  }
  return plan.shared > 0 && (on_segment ? plan.behind.orbit >= 0 : in_facet);
}

bool Surgery::may_shrink(double volume, double limit, std::size_t left) const {
  return lenient_ || volume <= kMaxFilling * limit * static_cast<double>(left);
}

// Whether what is left of the star, drawn to a place for the vertex that stays, is good enough.
bool Surgery::link_within(const Collapse& plan, Point3 place, const Worth& limits) {
  const Exemption exempt = criteria_.exemption(mesh_, plan.stays.orbit);
  for (std::size_t n = 0; n < star_order_.size(); ++n) {
    const StarTet& s = star_tets_[star_order_[n]];
    if (s.has(plan.stays)) continue;
    const LinkTet t(place, s.link, limits.shape);
    if (within(t, s.region, std::max(exempt, s.exempt_link), limits)) continue;
    blame(n);
    return false;
  }
  return true;
}

// Requires: the star of what goes is loaded and has been looked at.
bool Surgery::do_collapse(const Collapse& plan) {
  new_tets_.clear();
  for (std::size_t n = 0; n < star_.size(); ++n) {
    const StarTet& s = star_tets_[n];
    if (s.has(plan.stays)) continue;
    NewTet& tet = new_tets_.emplace_back();
    tet.region = s.region;
    for (std::uint32_t i = 0; i < 4; ++i) {
      tet.c[i] = i == s.apex ? plan.stays : s.c[i];
      if (i != s.apex) tet.facet[i] = mesh_.tet(star_[n].t).facet[i];
    }
  }
  // Two subsegments in one line become one: the outline of the facets there loses a corner.
  const bool on_segment = plan.kind == VertexKind::kSegment;
  std::array<EdgeKey, 3> edges;
  if (on_segment) {
    edges = {mesh_.edge_key(plan.goes, plan.stays), mesh_.edge_key(plan.goes, plan.behind),
             mesh_.edge_key(plan.stays, plan.behind)};
  }
  if (!apply(star_, new_tets_, {edges.data(), on_segment ? edges.size() : 0})) return false;
  if (on_segment) {
    mesh_.set_segment(edges[0], kNoSegment);
    mesh_.set_segment(edges[1], kNoSegment);
    mesh_.set_segment(edges[2], plan.segment);
  }
  mesh_.release_vertex(plan.goes.orbit);
  editor_.count_collapse();
  return true;
}

bool Surgery::merge(VertexId goes, OrbitVertex stays, double floor, Bounds bounds) {
  Collapse plan;
  if (!plan_collapse({goes, 0}, stays, plan)) return false;
  const std::size_t left = star_.size() - plan.shared;
  const bool kept = bounds == Bounds::kKept;
  if (kept && !may_shrink(star_volume_, star_limit_, left)) return merge_in_the_middle(plan, floor);
  Worth limits = merge_limits(floor, star_worth());
  if (!kept) limits.excess = limits.exempt = std::numeric_limits<double>::infinity();
  if (link_within(plan, mesh_.lift(stays), limits) && do_collapse(plan)) return true;
  return kept && merge_in_the_middle(plan, floor);
}

Surgery::Worth Surgery::merge_limits(double floor, const Worth& before) const {
  if (lenient_) return {kOpeningShape, lenient_excess(), kFar};
  return {std::max(kLeastShape, std::min(floor, before.shape * (1 + kGain))),
          std::max(allowed_excess_, before.excess * (1 - kExcessGain)),
          std::max(allowed_excess_, before.exempt * (1 - kExcessGain))};
}

bool Surgery::merge_in_the_middle(const Collapse& plan, double floor) {
  const VertexId v = plan.stays.orbit;
  if (mesh_.kind(v) != plan.kind || mesh_.on_axis(v)) return false;
  if (plan.kind != VertexKind::kFree && mesh_.parent(v) != mesh_.parent(plan.goes.orbit)) {
    return false;
  }
  for (const StarTet& s : star_tets()) {
    for (const OrbitVertex& x : s.c) {
      if (x.orbit == v && x != plan.stays) return false;
    }
  }
  // Half of what is to be looked at is there already, and mostly decides.
  const Moved moved{plan.stays, 0.5 * (mesh_.point(plan.goes.orbit) + mesh_.lift(plan.stays))};
  Worth before = star_worth();
  if (!link_within(plan, moved.place, merge_limits(floor, before))) return false;
  other_star_.clear();
  mesh_.star(v, other_star_);
  if (other_star_.size() > kMaxStar) return false;
  stretched_.clear();
  double volume = star_volume_, limit = star_limit_;
  for (TetCopy& c : other_star_) {
    c.e = mesh_.add(c.e, plan.stays.exponent);
    NewTet n;
    n.region = mesh_.tet(c.t).region;
    bool shared = false;
    int copies = 0;
    for (std::uint32_t i = 0; i < 4; ++i) {
      n.c[i] = mesh_.corner(c, i);
      shared = shared || n.c[i] == plan.goes;
      copies += n.c[i].orbit == v ? 1 : 0;
      // A copy of the vertex that goes, elsewhere in the other's star.
      if (n.c[i].orbit == plan.goes.orbit && n.c[i] != plan.goes) return false;
    }
    if (copies > 1) return false;
    if (shared) continue;
    stretched_.push_back(n);
    const TetMeasures& m = editor_.measures(c.t);
    volume += m.volume;
    limit = std::max(limit, criteria_.max_volume(n.region));
    include(before, shapes_[c.t], m, n.region, exemption_of(n.c));
  }
  const std::size_t left = star_.size() - plan.shared + stretched_.size();
  if (!may_shrink(volume, limit, left)) return false;
  if (!all_within(stretched_, moved, merge_limits(floor, before))) return false;
  if (!do_collapse(plan)) return false;
  mesh_.move_vertex(v,
                    mesh_.rotations().rotate(moved.place, mesh_.subtract(0, plan.stays.exponent)));
  ++edits_;
  other_star_.clear();
  mesh_.star(v, other_star_);
  touched_.clear();
  for (const TetCopy& c : other_star_) {
    refresh(c.t);
    touched_.push_back(c.t);
  }
  return true;
}

}  // namespace symcell::solid
