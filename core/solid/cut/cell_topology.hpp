// What makes a choice of representatives no usable cell, by the names of [paper] sec. 5.2, and
// where.
//
// Round a vertex copy the tetrahedra of the universal cover carry labels: the exponent at which the
// vertex stands where the tetrahedron stands in the cell. Tetrahedra with one label share a node of
// the cell; faces between different labels lie on the bounds. On the axis all share one node.
//   kSplitEdge          two split faces (or more) at an edge: the tetrahedra that share the edge in
//                       the cell are not joined by faces round it;
//   kEdgeWithoutFace    an edge and its image are both in the cell, but no symmetry face at the
//   edge
//                       says so;
//   kVertexWithoutFace  the same of a vertex;
//   kClosedCap          symmetry faces close on themselves and part the cell;
//   kSeveralPatches     several patches of the cell's boundary meet at a vertex: the tetrahedra
//   that
//                       share the node are not joined by faces round it;
//   kDisconnected       a piece that no face joins to the rest of its component.
// One more that exponents in Z can have:
//   kFarFace            a face towards a copy two or more sectors away: on no bound.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/solid/cut/representatives.hpp"

namespace symcell::solid {

enum class CellFlawKind : std::uint8_t {
  kSplitEdge,
  kEdgeWithoutFace,
  kVertexWithoutFace,
  kClosedCap,
  kSeveralPatches,
  kDisconnected,
  kFarFace
};
inline constexpr std::size_t kCellFlawKinds = 7;  // enumerators above

[[nodiscard]] std::string_view cell_flaw_name(CellFlawKind kind);

struct CellFlaw {
  CellFlawKind kind = CellFlawKind::kSplitEdge;
  VertexId vertex = -1;  // an end of the edge, a corner of the face; -1: a piece
  TetId tet = 0;         // of the star, or of the piece
};

// The tetrahedra round a vertex copy (v, 0), with labels and neighbours among them; round a vertex
// on the axis each tetrahedron once.
struct LabelledStar {
  struct Member {
    TetCopy copy;
    std::array<OrbitVertex, 4> corners;      // in the star's frame
    std::array<std::int32_t, 4> neighbours;  // indices of members, -1: none round the vertex
    std::uint32_t apex = 0;                  // local index of the vertex
    std::int32_t label = 0;                  // lifted: differences are jumps
  };
  VertexId vertex = -1;
  bool on_axis = false;
  std::vector<Member> members;
};

// Keeps scratch space: one object for many vertices.
class CellTopology {
 public:
  explicit CellTopology(const Representatives& cell) : cell_(&cell), mesh_(&cell.mesh()) {}

  // Flaws at v, at the edges from it and at its faces; appends them if `out` is given.
  std::int32_t flaws_at(VertexId v, std::vector<CellFlaw>* out = nullptr);
  // The star as it was looked at last.
  [[nodiscard]] const LabelledStar& star() const { return star_; }
  void load_star(VertexId v);

  // Members of the star in groups joined by faces inside the cell: all of them, or those at the
  // edge to `other` (a corner in the star's frame), joined round that edge. Group per member, -1
  // for members that do not count; the number of groups.
  enum class Joined : std::uint8_t { kByInnerFaces, kByAllFaces };
  std::int32_t groups(const OrbitVertex* other,
                      std::vector<std::int32_t>& group,
                      Joined by = Joined::kByInnerFaces) const;

 private:
  void look_at_group(const OrbitVertex* other, std::vector<CellFlaw>* out, std::int32_t& count);
  void look_at_parts(const OrbitVertex* other,
                     std::int32_t parts,
                     std::vector<CellFlaw>* out,
                     std::int32_t& count);
  void add(CellFlawKind kind, std::vector<CellFlaw>* out, std::int32_t& count) const;

  const Representatives* cell_;
  const QuotientTetrahedralization* mesh_;
  LabelledStar star_;
  std::vector<TetCopy> copies_;
  std::vector<std::pair<std::uint64_t, std::int32_t>> order_;  // of the members, by name
  std::vector<OrbitVertex> others_;
  std::vector<std::int32_t> group_, ring_, whole_;
  mutable std::vector<std::int32_t> stack_;
};

// A piece of the cell that no inner face joins to the largest piece of its component.
struct LoosePiece {
  std::vector<TetId> tets;
  bool closed_cap = false;  // its symmetry faces end neither at the surface nor at the axis
};
[[nodiscard]] std::vector<LoosePiece> find_loose_pieces(const Representatives& cell);

// All flaws of the cell. Cost: O(tetrahedra).
[[nodiscard]] std::vector<CellFlaw> find_cell_flaws(const Representatives& cell);

// Vertices of symmetry faces, ascending: no other one can have a flaw.
[[nodiscard]] std::vector<VertexId> bound_vertices(const Representatives& cell);

}  // namespace symcell::solid
