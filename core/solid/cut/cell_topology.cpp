#include "core/solid/cut/cell_topology.hpp"

#include <algorithm>
#include <cstdlib>
#include <tuple>
#include <utility>

#include "core/base/assert.hpp"

namespace symcell::solid {
namespace {

std::uint64_t name(TetId t, std::int32_t e) {
  return static_cast<std::uint64_t>(t) << 32 | static_cast<std::uint32_t>(e);
}

}  // namespace

std::string_view cell_flaw_name(CellFlawKind kind) {
  // In the order of CellFlawKind.
  constexpr std::string_view kNames[kCellFlawKinds] = {"two split faces at an edge",
                                                       "symmetry edge without a symmetry face",
                                                       "symmetry vertex without a symmetry face",
                                                       "closed cap",
                                                       "several patches at a vertex",
                                                       "disconnected piece",
                                                       "face two sectors away"};
  return kNames[static_cast<std::size_t>(kind)];
}

void CellTopology::load_star(VertexId v) {
  star_.vertex = v;
  star_.on_axis = mesh_->on_axis(v);
  star_.members.clear();
  copies_.clear();
  mesh_->fan(v, copies_);
  order_.clear();
  for (const TetCopy& c : copies_) {
    const std::int32_t e = star_.on_axis ? 0 : c.e;
    order_.emplace_back(name(c.t, e), static_cast<std::int32_t>(order_.size()));
    LabelledStar::Member m;
    m.copy = {c.t, e};
    for (std::uint32_t i = 0; i < 4; ++i) {
      m.corners[i] = mesh_->corner(m.copy, i);
      if (m.corners[i].orbit == v && (star_.on_axis || m.corners[i].exponent == 0)) m.apex = i;
    }
    star_.members.push_back(m);
  }
  std::sort(order_.begin(), order_.end());
  for (LabelledStar::Member& m : star_.members) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      m.neighbours[i] = -1;
      if (i == m.apex || mesh_->tet(m.copy.t).nb[i] == kNoHalfFace) continue;
      const TetCopy g = mesh_->neighbour(m.copy, i);
      const std::uint64_t wanted = name(g.t, star_.on_axis ? 0 : g.e);
      const auto it = std::lower_bound(order_.begin(), order_.end(), std::pair(wanted, -1));
      SYMCELL_ASSERT(it != order_.end() && it->first == wanted);
      m.neighbours[i] = it->second;
    }
  }
  if (star_.on_axis || star_.members.empty()) return;
  // The star is a ball or half of one: labels follow from the jumps along any way.
  group_.assign(star_.members.size(), -1);
  group_[0] = 0;
  stack_.assign(1, 0);
  const auto at = [](std::int32_t i) { return static_cast<std::size_t>(i); };
  star_.members[0].label = cell_->exponent(star_.members[0].copy.t) - star_.members[0].copy.e;
  while (!stack_.empty()) {
    const LabelledStar::Member& m = star_.members[at(stack_.back())];
    stack_.pop_back();
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::int32_t j = m.neighbours[i];
      if (j < 0 || group_[at(j)] == 0) continue;
      group_[at(j)] = 0;
      star_.members[at(j)].label = m.label - cell_->jump(4 * m.copy.t + i);
      stack_.push_back(j);
    }
  }
}

std::int32_t CellTopology::groups(const OrbitVertex* other,
                                  std::vector<std::int32_t>& group,
                                  Joined by) const {
  const auto counts = [&](const LabelledStar::Member& m) {
    return other == nullptr ||
           std::find(m.corners.begin(), m.corners.end(), *other) != m.corners.end();
  };
  group.assign(star_.members.size(), -1);
  std::int32_t count = 0;
  for (std::size_t seed = 0; seed < star_.members.size(); ++seed) {
    if (group[seed] >= 0 || !counts(star_.members[seed])) continue;
    group[seed] = count;
    stack_.assign(1, static_cast<std::int32_t>(seed));
    while (!stack_.empty()) {
      const LabelledStar::Member& m = star_.members[static_cast<std::size_t>(stack_.back())];
      stack_.pop_back();
      for (std::uint32_t i = 0; i < 4; ++i) {
        // Faces round the edge are those that contain the other corner too.
        if (m.neighbours[i] < 0 || (other != nullptr && m.corners[i] == *other)) continue;
        const auto j = static_cast<std::size_t>(m.neighbours[i]);
        if (group[j] >= 0) continue;
        if (by == Joined::kByInnerFaces && !cell_->is_inside(4 * m.copy.t + i)) continue;
        group[j] = count;
        stack_.push_back(m.neighbours[i]);
      }
    }
    ++count;
  }
  return count;
}

void CellTopology::add(CellFlawKind kind, std::vector<CellFlaw>* out, std::int32_t& count) const {
  ++count;
  if (out != nullptr) out->push_back({kind, star_.vertex, star_.members.front().copy.t});
}

void CellTopology::look_at_group(const OrbitVertex* other,
                                 std::vector<CellFlaw>* out,
                                 std::int32_t& count) {
  const std::int32_t parts = groups(other, group_);
  const std::size_t before = out == nullptr ? 0 : out->size();
  std::int32_t found = 0;
  look_at_parts(other, parts, out, found);
  if (found > 0 && other != nullptr) {
    // Where the solid touches itself along the edge, each side of it is an edge of its own.
    const std::int32_t rings = groups(other, ring_, Joined::kByAllFaces);
    if (rings > 1) {
      if (out != nullptr) out->resize(before);
      found = 0;
      whole_.swap(group_);
      for (std::int32_t r = 0; r < rings; ++r) {
        group_ = whole_;
        std::vector<std::uint8_t> has(static_cast<std::size_t>(parts), 0);
        for (std::size_t i = 0; i < group_.size(); ++i) {
          if (ring_[i] != r) group_[i] = -1;
          if (group_[i] >= 0) has[static_cast<std::size_t>(group_[i])] = 1;
        }
        const auto own = static_cast<std::int32_t>(std::count(has.begin(), has.end(), 1));
        look_at_parts(other, own, out, found);
      }
    }
  }
  count += found;
}

// `parts`: the number of groups of the members in group_.
void CellTopology::look_at_parts(const OrbitVertex* other,
                                 std::int32_t parts,
                                 std::vector<CellFlaw>* out,
                                 std::int32_t& count) {
  const bool edge = other != nullptr;
  if (star_.on_axis) {
    for (std::int32_t i = 1; i < parts; ++i) {
      add(edge ? CellFlawKind::kSplitEdge : CellFlawKind::kSeveralPatches, out, count);
    }
    return;
  }
  // Nodes that take part, by exponent, and whether a face of the bounds joins one to its image.
  const std::int32_t fold = mesh_->fold();
  const auto reduce = [&](std::int32_t label) { return mesh_->rotations().reduce(label); };
  struct Level {
    std::int32_t exponent;
    bool witnessed;
  };
  std::array<Level, 8> few;
  std::vector<Level> many;
  std::size_t levels = 0;
  const auto level = [&](std::int32_t exponent) -> Level* {
    Level* const begin = many.empty() ? few.data() : many.data();
    for (std::size_t i = 0; i < levels; ++i) {
      if (begin[i].exponent == exponent) return begin + i;
    }
    return nullptr;
  };
  const auto add_level = [&](std::int32_t exponent) {
    if (level(exponent) != nullptr) return;
    if (many.empty() && levels == few.size()) many.assign(few.begin(), few.end());
    if (many.empty()) {
      few[levels] = {exponent, false};
    } else {
      many.push_back({exponent, false});
    }
    ++levels;
  };
  for (std::size_t i = 0; i < star_.members.size(); ++i) {
    if (group_[i] >= 0) add_level(reduce(star_.members[i].label));
  }
  for (std::int32_t i = static_cast<std::int32_t>(levels); i < parts; ++i) {
    add(edge ? CellFlawKind::kSplitEdge : CellFlawKind::kSeveralPatches, out, count);
  }
  if (levels == 1) return;
  for (std::size_t i = 0; i < star_.members.size(); ++i) {
    if (group_[i] < 0) continue;
    const LabelledStar::Member& m = star_.members[i];
    for (std::uint32_t f = 0; f < 4; ++f) {
      if (m.neighbours[f] < 0 || (edge && m.corners[f] == *other)) continue;
      // The lower side decides; for n = 2 either side may.
      const std::int32_t jump = cell_->jump(4 * m.copy.t + f);
      if (jump == -1 || (fold == 2 && jump == 1)) level(reduce(m.label))->witnessed = true;
    }
  }
  for (std::size_t i = 0; i < levels; ++i) {
    const Level here = many.empty() ? few[i] : many[i];
    if (here.witnessed || level(reduce(here.exponent + 1)) == nullptr) continue;
    add(edge ? CellFlawKind::kEdgeWithoutFace : CellFlawKind::kVertexWithoutFace, out, count);
  }
}

std::int32_t CellTopology::flaws_at(VertexId v, std::vector<CellFlaw>* out) {
  load_star(v);
  std::int32_t count = 0;
  if (star_.members.empty()) return 0;
  bool plain = true;
  for (const LabelledStar::Member& m : star_.members) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (m.neighbours[i] < 0) continue;
      const HalfFace h = 4 * m.copy.t + i;
      if (cell_->jump(h) == 0) continue;
      plain = false;
      if (cell_->jump(h) > 1 && !cell_->is_inside(h)) add(CellFlawKind::kFarFace, out, count);
    }
  }
  if (plain) return count;
  look_at_group(nullptr, out, count);
  others_.clear();
  for (const LabelledStar::Member& m : star_.members) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      // Edges off the axis are looked at from their ends off the axis.
      if (i != m.apex && (!star_.on_axis || mesh_->on_axis(m.corners[i].orbit))) {
        others_.push_back(m.corners[i]);
      }
    }
  }
  const auto less = [](OrbitVertex a, OrbitVertex b) {
    return std::tie(a.orbit, a.exponent) < std::tie(b.orbit, b.exponent);
  };
  std::sort(others_.begin(), others_.end(), less);
  others_.erase(std::unique(others_.begin(), others_.end()), others_.end());
  for (const OrbitVertex& u : others_) look_at_group(&u, out, count);
  return count;
}

std::vector<VertexId> bound_vertices(const Representatives& cell) {
  const QuotientTetrahedralization& mesh = cell.mesh();
  std::vector<VertexId> result;
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (cell.jump(4 * t + i) == 0) continue;
      for (const std::uint32_t c : kFaceCorners[i]) result.push_back(mesh.tet(t).v[c]);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

namespace {

// Components of tetrahedra, by all faces or by faces inside the cell.
std::vector<std::int32_t> components(const Representatives& cell, bool inside_only) {
  const QuotientTetrahedralization& mesh = cell.mesh();
  std::vector<std::int32_t> part(mesh.tet_slots(), -1);
  std::vector<TetId> stack;
  std::int32_t count = 0;
  for (TetId seed = 0; seed < mesh.tet_slots(); ++seed) {
    if (!mesh.alive(seed) || part[seed] >= 0) continue;
    part[seed] = count;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const TetId t = stack.back();
      stack.pop_back();
      for (std::uint32_t i = 0; i < 4; ++i) {
        const HalfFace g = mesh.tet(t).nb[i];
        if (g == kNoHalfFace || part[tet_of(g)] >= 0) continue;
        if (inside_only && !cell.is_inside(4 * t + i)) continue;
        part[tet_of(g)] = count;
        stack.push_back(tet_of(g));
      }
    }
    ++count;
  }
  return part;
}

// Whether an edge of a symmetry face of the piece lies on the surface or on the axis.
bool ends_somewhere(const Representatives& cell, const std::vector<TetId>& tets) {
  const QuotientTetrahedralization& mesh = cell.mesh();
  std::vector<TetCopy> ring;
  for (const TetId t : tets) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      if (mesh.tet(t).nb[i] == kNoHalfFace || cell.is_inside(4 * t + i)) continue;
      for (std::uint32_t c = 0; c < 3; ++c) {
        const OrbitVertex a = mesh.corner(t, kFaceCorners[i][c]);
        const OrbitVertex b = mesh.corner(t, kFaceCorners[i][(c + 1) % 3]);
        ring.clear();
        if (!mesh.ring({t, 0}, a, b, ring) || (mesh.on_axis(a.orbit) && mesh.on_axis(b.orbit)))
          return true;
      }
    }
  }
  return false;
}

}  // namespace

std::vector<LoosePiece> find_loose_pieces(const Representatives& cell) {
  const std::vector<std::int32_t> piece = components(cell, true);
  const std::vector<std::int32_t> whole = components(cell, false);
  const auto count_of = [](const std::vector<std::int32_t>& part) {
    const auto it = std::max_element(part.begin(), part.end());
    return it == part.end() ? std::size_t{0} : static_cast<std::size_t>(*it + 1);
  };
  const std::size_t pieces = count_of(piece), wholes = count_of(whole);
  if (pieces == wholes) return {};
  std::vector<std::size_t> size(pieces, 0), home(pieces, 0);
  for (TetId t = 0; t < piece.size(); ++t) {
    if (piece[t] < 0) continue;
    ++size[static_cast<std::size_t>(piece[t])];
    home[static_cast<std::size_t>(piece[t])] = static_cast<std::size_t>(whole[t]);
  }
  std::vector<std::size_t> largest(wholes, pieces);
  for (std::size_t p = 0; p < pieces; ++p) {
    std::size_t& l = largest[home[p]];
    if (l == pieces || size[p] > size[l]) l = p;
  }
  std::vector<LoosePiece> loose;
  std::vector<std::size_t> place(pieces, pieces);
  for (std::size_t p = 0; p < pieces; ++p) {
    if (largest[home[p]] == p) continue;
    place[p] = loose.size();
    loose.emplace_back();
  }
  for (TetId t = 0; t < piece.size(); ++t) {
    if (piece[t] < 0) continue;
    const std::size_t at = place[static_cast<std::size_t>(piece[t])];
    if (at < loose.size()) loose[at].tets.push_back(t);
  }
  for (LoosePiece& p : loose) p.closed_cap = !ends_somewhere(cell, p.tets);
  return loose;
}

std::vector<CellFlaw> find_cell_flaws(const Representatives& cell) {
  std::vector<CellFlaw> flaws;
  if (cell.mesh().fold() == 1) return flaws;
  CellTopology topology(cell);
  for (const VertexId v : bound_vertices(cell)) topology.flaws_at(v, &flaws);
  for (const LoosePiece& p : find_loose_pieces(cell)) {
    flaws.push_back({p.closed_cap ? CellFlawKind::kClosedCap : CellFlawKind::kDisconnected, -1,
                     p.tets.front()});
  }
  return flaws;
}

}  // namespace symcell::solid
