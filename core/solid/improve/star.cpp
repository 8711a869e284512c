// The star of a vertex, unrolled round its copy 0, and how good it would be elsewhere.
#include <algorithm>

#include "core/solid/improve/surgery.hpp"

namespace symcell::solid {

void Surgery::load_star_tet(TetCopy c, VertexId v, StarTet& s) const {
  s.region = mesh_.tet(c.t).region;
  s.own = 0;
  s.apex = 0;
  s.exempt = s.exempt_link = Exemption::kNone;
  for (std::uint32_t i = 0; i < 4; ++i) {
    s.c[i] = mesh_.corner(c, i);
    s.p[i] = mesh_.lift(s.c[i]);
    const Exemption exempt = criteria_.exemption(mesh_, s.c[i].orbit);
    s.exempt = std::max(s.exempt, exempt);
    if (s.c[i].orbit != v) {
      s.exempt_link = std::max(s.exempt_link, exempt);
      continue;
    }
    s.own = static_cast<std::uint8_t>(s.own | 1U << i);
    if (s.c[i].exponent == 0) s.apex = static_cast<std::uint8_t>(i);
  }
  const auto& f = kFaceCorners[s.apex];
  s.link = LinkFace(s.p[f[0]], s.p[f[1]], s.p[f[2]]);
}

// It is asked for once for each of the vertex' neighbours.
bool Surgery::load_star(VertexId v) {
  if (star_vertex_ == v && star_edits_ == edits_) return !star_.empty();
  star_vertex_ = v;
  star_edits_ = edits_;
  star_judged_ = false;
  star_.clear();
  mesh_.star(v, star_);
  if (star_.size() > kMaxStar) star_.clear();
  if (star_tets_.size() < star_.size()) star_tets_.resize(star_.size());
  star_order_.resize(star_.size());
  star_simple_ = true;
  star_volume_ = 0;
  star_limit_ = 0;
  const std::uint32_t epoch = mesh_.new_epoch();
  for (std::size_t n = 0; n < star_.size(); ++n) {
    StarTet& s = star_tets_[n];
    load_star_tet(star_[n], v, s);
    star_order_[n] = static_cast<std::uint8_t>(n);
    Tet& t = mesh_.tet(star_[n].t);
    if (t.stamp == epoch || (s.own & (s.own - 1)) != 0) star_simple_ = false;
    t.stamp = epoch;
    star_volume_ += six_volumes(s.p[0], s.p[1], s.p[2], s.p[3]) / 6;
    star_limit_ = std::max(star_limit_, criteria_.max_volume(s.region));
  }
  return !star_.empty();
}

const Surgery::Worth& Surgery::star_worth() {
  if (!star_judged_) {
    star_worth_ = star_worth_at(mesh_.point(star_vertex_), {-kFar, kFar, kFar});
    star_judged_ = true;
  }
  return star_worth_;
}

// Worst shape and excess of the star with the vertex at p; gives up as soon as a shape is at most
// the limits' or an excess above.
Surgery::Worth Surgery::star_worth_at(Point3 p, const Worth& limits) {
  Worth w;
  for (std::size_t n = 0; n < star_order_.size(); ++n) {
    const StarTet& s = star_tets_[star_order_[n]];
    LinkFace turned;
    const LinkFace* link = &s.link;
    if ((s.own & (s.own - 1)) != 0) {
      // Other copies of the vertex move as well.
      auto x = s.p;
      for (std::uint32_t i = 0; i < 4; ++i) {
        if ((s.own >> i & 1) != 0) x[i] = mesh_.rotations().rotate(p, s.c[i].exponent);
      }
      const auto& f = kFaceCorners[s.apex];
      turned = LinkFace(x[f[0]], x[f[1]], x[f[2]]);
      link = &turned;
    }
    const LinkTet t(p, *link, limits.shape);
    if (t.sine > limits.shape) {
      include(w, t.sine, t.measures, s.region, s.exempt);
      if (w.excess <= limits.excess && w.exempt <= limits.exempt) continue;
    } else {
      w.shape = std::min(w.shape, t.sine);
    }
    blame(n);
    return w;
  }
  return w;
}

std::span<const Surgery::Neighbour> Surgery::neighbours(VertexId v) {
  neighbours_.clear();
  if (!load_star(v)) return {};
  const Point3 x = mesh_.point(v);
  for (const StarTet& s : star_tets()) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (s.c[i].orbit == v) continue;
      const bool known = std::any_of(neighbours_.begin(), neighbours_.end(),
                                     [&](const Neighbour& n) { return n.corner == s.c[i]; });
      if (!known) neighbours_.push_back({squared_distance(x, s.p[i]), s.c[i]});
    }
  }
  std::sort(neighbours_.begin(), neighbours_.end(), [](const Neighbour& a, const Neighbour& b) {
    if (a.squared != b.squared) return a.squared < b.squared;
    return a.corner.orbit != b.corner.orbit ? a.corner.orbit < b.corner.orbit
                                            : a.corner.exponent < b.corner.exponent;
  });
  return neighbours_;
}

}  // namespace symcell::solid
