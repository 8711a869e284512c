#include "core/solid/quotient/quotient_tetrahedralization.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/assert.hpp"
#include "core/geometry/spatial_order.hpp"

namespace symcell::solid {
namespace {

std::uint64_t hash(const FaceKey& key) {
  std::uint64_t x = key.high + 0x9e3779b97f4a7c15ULL * (key.low + 1);
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ULL;
  return x ^ (x >> 32);
}

template <class Id>
void undo_free(const std::vector<std::optional<Id>>& log, std::vector<Id>& free) {
  for (auto it = log.rbegin(); it != log.rend(); ++it) {
    if (*it) {
      free.push_back(**it);
    } else {
      free.pop_back();
    }
  }
}

}  // namespace

VertexId QuotientTetrahedralization::add_vertex(Point3 p,
                                                VertexKind kind,
                                                bool on_axis,
                                                std::int32_t parent) {
  Vertex v;
  v.point = p;
  v.kind = kind;
  v.on_axis = on_axis;
  v.parent = parent;
  if (!free_vertices_.empty()) {
    const VertexId id = free_vertices_.back();
    free_vertices_.pop_back();
    if (trial_.open) {
      keep(id);
      trial_.free_vertices.emplace_back(id);
    }
    vertices_[idx(id)] = v;
    return id;
  }
  vertices_.push_back(v);
  return static_cast<VertexId>(vertices_.size() - 1);
}

void QuotientTetrahedralization::release_vertex(VertexId v) {
  if (trial_.open) {
    keep(v);
    trial_.free_vertices.emplace_back(std::nullopt);
  }
  vertices_[idx(v)].kind = VertexKind::kDeleted;
  vertices_[idx(v)].tet = std::numeric_limits<TetId>::max();
  free_vertices_.push_back(v);
}

void QuotientTetrahedralization::set_pinched(VertexId v) {
  if (trial_.open) keep(v);
  vertices_[idx(v)].pinch = static_cast<std::int32_t>(pinch_tets_.size());
  pinch_tets_.emplace_back();
}

void QuotientTetrahedralization::set_pinched(std::span<const VertexId> vertices) {
  for (const VertexId v : vertices) set_pinched(v);
  for (TetId t = 0; t < tets_.size() && !vertices.empty(); ++t) {
    if (alive(t)) note_at_pinches(t);
  }
}

void QuotientTetrahedralization::note_at_pinches(TetId t) {
  for (const VertexId v : tets_[t].v) {
    if (pinched(v)) pinch_tets_[idx(vertex(v).pinch)].push_back(t);
  }
}

std::span<const TetId> QuotientTetrahedralization::tets_at_pinch(VertexId v) const {
  std::vector<TetId>& list = pinch_tets_[idx(vertex(v).pinch)];
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  std::erase_if(list, [&](TetId t) {
    return t >= tets_.size() || !alive(t) ||
           std::find(tets_[t].v, tets_[t].v + 4, v) == tets_[t].v + 4;
  });
  return list;
}

TetId QuotientTetrahedralization::take_slot() {
  ++live_tets_;
  if (!free_tets_.empty()) {
    const TetId t = free_tets_.back();
    free_tets_.pop_back();
    if (trial_.open) {
      keep(t);
      trial_.free_tets.emplace_back(t);
    }
    return t;
  }
  tets_.emplace_back();
  tets_.back().version = 0;
  tets_.back().stamp = 0;
  return static_cast<TetId>(tets_.size() - 1);
}

void QuotientTetrahedralization::link(HalfFace h, HalfFace g, std::int32_t off) {
  if (trial_.open) {
    keep(tet_of(h));
    keep(tet_of(g));
  }
  Tet& a = tets_[tet_of(h)];
  a.nb[face_of(h)] = g;
  a.off[face_of(h)] = static_cast<std::int16_t>(off);
  Tet& b = tets_[tet_of(g)];
  b.nb[face_of(g)] = h;
  b.off[face_of(g)] = static_cast<std::int16_t>(rotations_.subtract(0, off));
}

void QuotientTetrahedralization::reserve_face_slots(std::size_t count) {
  std::size_t capacity = face_table_.empty() ? 256 : face_table_.size();
  while (capacity < 2 * count) capacity *= 2;
  if (capacity != face_table_.size()) {
    face_table_.assign(capacity, {});
    face_epoch_ = 0;
  }
  ++face_epoch_;
}

QuotientTetrahedralization::FaceSlot& QuotientTetrahedralization::face_slot(const FaceKey& key) {
  const std::size_t mask = face_table_.size() - 1;
  std::size_t i = static_cast<std::size_t>(hash(key)) & mask;
  while (face_table_[i].epoch == face_epoch_ && !(face_table_[i].key == key)) i = (i + 1) & mask;
  FaceSlot& s = face_table_[i];
  if (s.epoch != face_epoch_) {
    s = {};
    s.key = key;
    s.epoch = face_epoch_;
  }
  return s;
}

// Exclusive or over the edges of faces: edges between two faces of one facet cancel.
std::uint64_t QuotientTetrahedralization::outline_hash(OrbitVertex a,
                                                       OrbitVertex b,
                                                       OrbitVertex c,
                                                       std::int32_t facet,
                                                       std::span<const EdgeKey> without) const {
  const auto edge = [&](OrbitVertex p, OrbitVertex q) -> std::uint64_t {
    const EdgeKey key = edge_key(p, q);
    if (std::find(without.begin(), without.end(), key) != without.end()) return 0;
    const auto u32 = [](std::int32_t i) {
      return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i));
    };
    return hash({u32(key.a) << 32 | u32(key.b), u32(key.exponent) << 32 | u32(facet)});
  };
  return edge(a, b) ^ edge(b, c) ^ edge(c, a);
}

bool QuotientTetrahedralization::match_faces(std::span<const TetCopy> removed,
                                             std::span<const NewTet> added,
                                             Outlines outlines,
                                             std::span<const EdgeKey> segment_edges) {
  const bool compared = outlines == Outlines::kCompared;
  reserve_face_slots(4 * (removed.size() + added.size()));
  const std::uint32_t epoch = new_epoch();
  for (const TetCopy& c : removed) {
    if (tets_[c.t].stamp == epoch) return false;
    tets_[c.t].stamp = epoch;
  }
  std::uint64_t difference = 0;  // of the outlines
  std::size_t uncovered = 0;
  for (const TetCopy& c : removed) {
    const Tet& t = tets_[c.t];
    for (std::uint32_t i = 0; i < 4; ++i) {
      const OrbitVertex p = corner(c.t, kFaceCorners[i][0]), q = corner(c.t, kFaceCorners[i][1]),
                        r = corner(c.t, kFaceCorners[i][2]);
      const KeyedFace face = face_key(p, q, r);
      FaceSlot& slot = face_slot(face.key);
      const bool outside = t.nb[i] != kNoHalfFace && tets_[tet_of(t.nb[i])].stamp != epoch;
      if (!slot.removed && !outside && t.facet[i] != kNoFacet && compared) {
        difference ^= outline_hash(p, q, r, t.facet[i], segment_edges);
      }
      slot.removed = true;
      slot.facet = t.facet[i];
      slot.hull = t.nb[i] == kNoHalfFace;
      if (!outside) continue;
      slot.outside = t.nb[i];
      // The neighbour at `off` touches this one: its reference corner in its own frame.
      slot.outside_ref = rotations_.subtract(face.reference, t.off[i]);
      ++uncovered;
    }
  }
  new_faces_.clear();
  new_refs_.clear();
  for (std::size_t n = 0; n < added.size(); ++n) {
    const NewTet& t = added[n];
    for (std::uint32_t i = 0; i < 4; ++i) {
      const OrbitVertex p = t.c[kFaceCorners[i][0]], q = t.c[kFaceCorners[i][1]],
                        r = t.c[kFaceCorners[i][2]];
      const KeyedFace face = face_key(p, q, r);
      FaceSlot& slot = face_slot(face.key);
      const bool outside = slot.outside != kNoHalfFace;
      const std::int32_t facet = t.facet[i] != kNoFacet || !slot.removed ? t.facet[i] : slot.facet;
      if (outside && facet != slot.facet) return false;
      if (slot.uses == (slot.hull || outside ? 1 : 2)) return false;
      if (slot.uses++ == 0) {
        slot.first = static_cast<HalfFace>(4 * n + i);
        slot.first_ref = face.reference;
        slot.new_facet = facet;
        if (outside) {
          --uncovered;
        } else if (facet != kNoFacet && compared) {
          difference ^= outline_hash(p, q, r, facet, segment_edges);
        }
      } else if (slot.new_facet != facet) {
        return false;
      }
      new_faces_.push_back(&slot);
      new_refs_.push_back(face.reference);
    }
  }
  if (uncovered != 0 || difference != 0) return false;
  for (const FaceSlot* slot : new_faces_) {
    // A face that occurs once lies on the hull and belongs to a facet.
    if (slot->outside == kNoHalfFace && slot->uses == 1 && slot->new_facet == kNoFacet) {
      return false;
    }
  }
  return true;
}

bool QuotientTetrahedralization::replace(std::span<const TetCopy> removed,
                                         std::span<const NewTet> added,
                                         Outlines outlines,
                                         std::span<const EdgeKey> segment_edges) {
  if (!match_faces(removed, added, outlines, segment_edges)) return false;
  for (const TetCopy& c : removed) {
    if (trial_.open) {
      keep(c.t);
      trial_.free_tets.emplace_back(std::nullopt);
    }
    tets_[c.t].region = -1;
    ++tets_[c.t].version;
    --live_tets_;
    free_tets_.push_back(c.t);
  }
  added_ids_.clear();
  for (const NewTet& n : added) {
    const TetId id = take_slot();
    added_ids_.push_back(id);
    Tet& t = tets_[id];
    for (std::uint32_t i = 0; i < 4; ++i) {
      t.v[i] = n.c[i].orbit;
      t.k[i] = static_cast<std::int16_t>(n.c[i].exponent);
      t.nb[i] = kNoHalfFace;
      t.off[i] = 0;
      if (trial_.open) keep(n.c[i].orbit);
      vertices_[idx(n.c[i].orbit)].tet = id;
    }
    t.region = n.region;
    ++t.version;
    if (!pinch_tets_.empty()) note_at_pinches(id);
  }
  for (std::size_t n = 0; n < added.size(); ++n) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const FaceSlot& slot = *new_faces_[4 * n + i];
      const HalfFace h = 4 * added_ids_[n] + i;
      tets_[added_ids_[n]].facet[i] = slot.new_facet;
      const std::int32_t ref = new_refs_[4 * n + i];
      if (slot.outside != kNoHalfFace) {
        link(h, slot.outside, rotations_.subtract(ref, slot.outside_ref));
      } else if (slot.uses == 2 && slot.first != 4 * n + i) {
        const HalfFace g = 4 * added_ids_[slot.first / 4] + slot.first % 4;
        link(h, g, rotations_.subtract(ref, slot.first_ref));
      }
    }
  }
  return true;
}

void QuotientTetrahedralization::set_segment(const EdgeKey& edge, std::int32_t segment) {
  if (trial_.open) trial_.edges.emplace_back(edge, edges_.find(edge));
  if (segment == kNoSegment) {
    edges_.erase(edge);
  } else {
    edges_.set(edge, segment);
  }
}

void QuotientTetrahedralization::begin() {
  SYMCELL_ASSERT(!trial_.open);
  trial_.open = true;
  trial_.tets.clear();
  trial_.vertices.clear();
  trial_.edges.clear();
  trial_.tet_slots = tets_.size();
  trial_.vertex_slots = vertices_.size();
  trial_.live_tets = live_tets_;
  trial_.free_tets.clear();
  trial_.free_vertices.clear();
}

std::vector<TetId> QuotientTetrahedralization::roll_back() {
  SYMCELL_ASSERT(trial_.open);
  trial_.open = false;
  std::vector<TetId> written;
  // The last first: of what was overwritten more than once the oldest counts.
  for (auto it = trial_.tets.rbegin(); it != trial_.tets.rend(); ++it) {
    tets_[it->first] = it->second;
    if (it->first < trial_.tet_slots) written.push_back(it->first);
  }
  for (auto it = trial_.vertices.rbegin(); it != trial_.vertices.rend(); ++it) {
    vertices_[idx(it->first)] = it->second;
  }
  for (auto it = trial_.edges.rbegin(); it != trial_.edges.rend(); ++it) {
    set_segment(it->first, it->second);
  }
  tets_.resize(trial_.tet_slots);
  vertices_.resize(trial_.vertex_slots);
  live_tets_ = trial_.live_tets;
  undo_free(trial_.free_tets, free_tets_);
  undo_free(trial_.free_vertices, free_vertices_);
  std::sort(written.begin(), written.end());
  written.erase(std::unique(written.begin(), written.end()), written.end());
  for (const TetId t : written) {
    if (!pinch_tets_.empty() && alive(t)) note_at_pinches(t);
  }
  return written;
}

void QuotientTetrahedralization::star(VertexId v, std::vector<TetCopy>& out) const {
  if (!pinched(v)) {
    fan(v, out);
    return;
  }
  for (const TetId t : tets_at_pinch(v)) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (tets_[t].v[i] != v) continue;
      out.push_back({t, on_axis(v) ? 0 : rotations_.subtract(0, tets_[t].k[i])});
    }
  }
}

void QuotientTetrahedralization::fan(VertexId v, std::vector<TetCopy>& out) const {
  const TetId start = vertex(v).tet;
  if (start == std::numeric_limits<TetId>::max()) return;
  const std::size_t begin = out.size();
  const bool axis = on_axis(v);
  const auto corner_at = [&](TetId t, std::int32_t k) -> std::int32_t {
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (tets_[t].v[i] == v && (axis || tets_[t].k[i] == k)) return static_cast<std::int32_t>(i);
    }
    return -1;
  };
  TetCopy first{start, 0};
  if (!axis) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (tets_[start].v[i] == v) {
        first.e = rotations_.subtract(0, tets_[start].k[i]);
        break;
      }
    }
  }
  // A tetrahedron is met again as the copy noted at its slot as a rule; a second copy of it is rare
  // and looked for in the list.
  if (seen_.size() < tets_.size()) seen_.resize(tets_.capacity());
  const std::uint32_t epoch = ++seen_epoch_;
  const auto known = [&](const TetCopy& c) {
    Seen& s = seen_[c.t];
    if (s.epoch != epoch) {
      s = {epoch, c.e};
      return false;
    }
    if (axis || s.e == c.e) return true;
    return std::find(out.begin() + static_cast<std::ptrdiff_t>(begin), out.end(), c) != out.end();
  };
  static_cast<void>(known(first));
  out.push_back(first);
  for (std::size_t at = begin; at < out.size(); ++at) {
    const TetCopy c = out[at];
    const std::int32_t apex = corner_at(c.t, rotations_.subtract(0, c.e));
    SYMCELL_ASSERT(apex >= 0);
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (static_cast<std::int32_t>(i) == apex || tets_[c.t].nb[i] == kNoHalfFace) continue;
      TetCopy g = neighbour(c, i);
      if (axis) g.e = 0;
      if (!known(g)) out.push_back(g);
    }
  }
}

bool QuotientTetrahedralization::ring(TetCopy from,
                                      OrbitVertex a,
                                      OrbitVertex b,
                                      std::vector<TetCopy>& out) const {
  const bool axis = on_axis(a.orbit) && on_axis(b.orbit);
  const auto index = [&](const TetCopy& c, const OrbitVertex& x) -> std::uint32_t {
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (corner(c, i) == x) return i;
    }
    SYMCELL_ASSERT(false);
    return 4;
  };
  // The two corners off the edge: `to` is the one whose opposite face is left through.
  const auto others = [&](const TetCopy& c) -> std::array<std::uint32_t, 2> {
    const std::uint32_t i = index(c, a), j = index(c, b);
    std::array<std::uint32_t, 2> o{};
    std::size_t n = 0;
    for (std::uint32_t m = 0; m < 4; ++m) {
      if (m != i && m != j) o[n++] = m;
    }
    return o;
  };
  // Walks from `from` through the face opposite corner `leave` until it comes round or falls out.
  const auto walk = [&](std::uint32_t leave, std::vector<TetCopy>& found) {
    TetCopy c = from;
    while (true) {
      const Tet& t = tets_[c.t];
      if (t.nb[leave] == kNoHalfFace) return false;
      const TetCopy g = neighbour(c, leave);
      const std::uint32_t entered = face_of(t.nb[leave]);
      if (g.t == from.t && (axis || g.e == from.e)) return true;
      found.push_back(g);
      const auto o = others(g);
      leave = o[0] == entered ? o[1] : o[0];
      c = g;
    }
  };
  const auto o = others(from);
  std::vector<TetCopy> forth;
  if (walk(o[0], forth)) {
    out.push_back(from);
    out.insert(out.end(), forth.begin(), forth.end());
    return true;
  }
  std::vector<TetCopy> back;
  const bool round = walk(o[1], back);
  SYMCELL_ASSERT(!round);
  out.insert(out.end(), back.rbegin(), back.rend());
  out.push_back(from);
  out.insert(out.end(), forth.begin(), forth.end());
  return false;
}

void QuotientTetrahedralization::round_edge(TetCopy from,
                                            OrbitVertex a,
                                            OrbitVertex b,
                                            std::vector<TetCopy>& out) const {
  if (!pinched(a.orbit) || !pinched(b.orbit)) {
    static_cast<void>(ring(from, a, b, out));
    return;
  }
  // Of an edge that ends on the axis the other end determines the copy.
  if (on_axis(a.orbit)) std::swap(a, b);
  std::vector<TetCopy> copies;
  star(a.orbit, copies);
  for (TetCopy c : copies) {
    c.e = on_axis(a.orbit) ? 0 : rotations_.add(c.e, a.exponent);
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (corner(c, i) == b) out.push_back(c);
    }
  }
}

std::uint32_t QuotientTetrahedralization::new_epoch() {
  if (++epoch_ == 0) {
    for (Tet& t : tets_) t.stamp = 0;
    epoch_ = 1;
  }
  return epoch_;
}

// By the place of centroids along a space-filling curve, all in one sector whatever their frames.
std::vector<TetId> QuotientTetrahedralization::spatial_order() const {
  std::vector<TetId> living;
  std::vector<Point3> centres;
  living.reserve(live_tets_);
  centres.reserve(live_tets_);
  const double sector = 2 * std::numbers::pi / fold();
  for (TetId t = 0; t < tets_.size(); ++t) {
    if (!alive(t)) continue;
    Point3 c;
    for (std::uint32_t i = 0; i < 4; ++i) c = c + 0.25 * corner_point(t, i);
    if (fold() > 1) {
      const auto turns = static_cast<std::int32_t>(std::floor(std::atan2(c.y, c.x) / sector));
      c = rotations_.rotate(c, rotations_.reduce(-turns));
    }
    living.push_back(t);
    centres.push_back(c);
  }
  std::vector<TetId> order;
  order.reserve(living.size());
  for (const std::size_t i : hilbert_order(centres)) order.push_back(living[i]);
  return order;
}

std::vector<TetId> QuotientTetrahedralization::compact_tets() {
  std::vector<TetId> order = spatial_order();
  std::vector<TetId> place(tets_.size(), 0);
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<TetId>(i);
  std::vector<Tet> tets;
  tets.reserve(order.size());
  for (const TetId old : order) {
    Tet t = tets_[old];
    t.stamp = 0;
    for (std::uint32_t i = 0; i < 4; ++i) {
      vertices_[idx(t.v[i])].tet = static_cast<TetId>(tets.size());
      if (t.nb[i] != kNoHalfFace) t.nb[i] = 4 * place[tet_of(t.nb[i])] + face_of(t.nb[i]);
    }
    tets.push_back(t);
  }
  tets_ = std::move(tets);
  free_tets_.clear();
  epoch_ = 0;
  for (auto& list : pinch_tets_) list.clear();
  for (TetId t = 0; t < tets_.size() && !pinch_tets_.empty(); ++t) note_at_pinches(t);
  return order;
}

std::vector<VertexId> QuotientTetrahedralization::compact_vertices() {
  std::vector<VertexId> new_vertex(vertices_.size(), -1);
  std::vector<Vertex> vertices;
  for (Tet& t : tets_) {
    for (VertexId& corner : t.v) {
      VertexId& v = new_vertex[idx(corner)];
      if (v < 0) {
        v = static_cast<VertexId>(vertices.size());
        vertices.push_back(vertices_[idx(corner)]);
      }
      corner = v;
    }
  }
  std::vector<std::pair<EdgeKey, std::int32_t>> kept;
  edges_.for_each(
      [&](const EdgeKey& key, std::int32_t segment) { kept.emplace_back(key, segment); });
  edges_.clear();
  const auto axis = [&](VertexId v) { return vertices[idx(v)].on_axis; };
  for (const auto& [key, segment] : kept) {
    const VertexId a = new_vertex[idx(key.a)], b = new_vertex[idx(key.b)];
    edges_.set(make_edge_key(rotations_, {a, 0}, {b, key.exponent}, axis(a), axis(b)), segment);
  }
  vertices_ = std::move(vertices);
  free_vertices_.clear();
  return new_vertex;
}

}  // namespace symcell::solid
