// The quotient mesh of solids: one tetrahedron per orbit under C_n, flat arrays, neighbours with
// exponents. The axis of symmetry is the z axis.
//
// A vertex id names an orbit; its representative is `point(v)`. A corner is (orbit, exponent k) and
// lies at rotation^k(point); a vertex on the axis has exponent 0 always. A tetrahedron is stored in
// one frame (its gauge); "the tetrahedron at exponent e" is the stored one rotated by e.
//
//   Corners 0 1 2 3 are positively oriented: (v1 - v0) x (v2 - v0) . (v3 - v0) > 0 (VTK's order).
//   Face i is opposite corner i; kFaceCorners[i] lists it counter-clockwise seen from outside.
//   Half-face id: 4 * tetrahedron + i.   nb[i]: the half-face on the other side, kNoHalfFace
//   outside. off[i]: the neighbour at exponent off[i] touches this tetrahedron at exponent 0.
//
// Invariants (validate.hpp checks them):
// - nb is an involution and off[g] = -off[h] for g = nb[h];
// - corners agree across a face: orbit, and exponent up to off;
// - a face without neighbour is a subfacet; both sides of a subfacet name the same facet;
// - every subsegment of `edges` is an edge of some tetrahedron.
//
// A bound of the paper is wherever two neighbours' stored frames differ (off != 0): nothing here
// treats such a face specially, exponents are composed. Source: [paper] sec. 3-5.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/orbit_keys.hpp"
#include "core/geometry/orbit_vertex.hpp"
#include "core/geometry/point.hpp"
#include "core/geometry/rotation.hpp"

namespace symcell::solid {

using TetId = std::uint32_t;
using HalfFace = std::uint32_t;
// Beyond an outer face there is no neighbour; faces and edges inside lie on no facet or segment.
inline constexpr HalfFace kNoHalfFace = std::numeric_limits<HalfFace>::max();
inline constexpr std::int32_t kNoFacet = -1;
inline constexpr std::int32_t kNoSegment = -1;

inline constexpr std::uint32_t kFaceCorners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
inline constexpr std::uint32_t kEdgeCorners[6][2] = {{0, 1}, {0, 2}, {0, 3},
                                                     {1, 2}, {1, 3}, {2, 3}};

[[nodiscard]] constexpr TetId tet_of(HalfFace h) {
  return h >> 2;
}
[[nodiscard]] constexpr std::uint32_t face_of(HalfFace h) {
  return h & 3;
}

struct Tet {
  VertexId v[4];
  HalfFace nb[4];
  std::int16_t k[4];      // exponents of the corners, [0, n)
  std::int16_t off[4];    // exponents of the neighbours, [0, n)
  std::int32_t facet[4];  // facet of the input on face i, kNoFacet: none
  std::int32_t region;    // subdomain; < 0: free slot
  std::uint32_t version;  // grows whenever the slot gets another tetrahedron
  std::uint32_t stamp;    // scratch: last epoch that visited this slot
  std::int32_t scratch;   // meaningful only together with stamp
};

enum class VertexKind : std::uint8_t {
  kInput,    // of the model: never moved
  kSegment,  // on a subsegment chain (the axis included): slides along it
  kFacet,    // in the plane of one facet
  kFree,
  kDeleted
};

// A tetrahedron rotated by an exponent: a member of a cavity or star in the universal cover.
struct TetCopy {
  TetId t = 0;
  std::int32_t e = 0;
  friend bool operator==(const TetCopy&, const TetCopy&) = default;
};

// A tetrahedron to be made. facet[i] = kNoFacet: as the removed face in the same place, if any.
struct NewTet {
  OrbitVertex c[4];
  std::int32_t region = 0;
  std::int32_t facet[4] = {kNoFacet, kNoFacet, kNoFacet, kNoFacet};
};

class QuotientTetrahedralization {
 public:
  explicit QuotientTetrahedralization(std::int32_t fold) : rotations_(fold) {}

  [[nodiscard]] std::int32_t fold() const { return rotations_.fold(); }
  [[nodiscard]] const RotationTable& rotations() const { return rotations_; }

  // Vertices.
  // `parent`: the segment or facet of kSegment and kFacet vertices, else ignored.
  VertexId add_vertex(Point3 p, VertexKind kind, bool on_axis, std::int32_t parent = -1);
  void release_vertex(VertexId v);
  [[nodiscard]] std::size_t vertex_slots() const { return vertices_.size(); }
  [[nodiscard]] Point3 point(VertexId v) const { return vertex(v).point; }
  void move_vertex(VertexId v, Point3 p) {
    if (trial_.open) keep(v);
    vertices_[idx(v)].point = p;
  }
  [[nodiscard]] VertexKind kind(VertexId v) const { return vertex(v).kind; }
  void set_kind(VertexId v, VertexKind kind, std::int32_t parent) {
    vertices_[idx(v)].kind = kind;
    vertices_[idx(v)].parent = parent;
  }
  [[nodiscard]] std::int32_t parent(VertexId v) const { return vertex(v).parent; }
  [[nodiscard]] bool on_axis(VertexId v) const { return vertex(v).on_axis; }
  // Vertices at which the boundary touches itself, those along an edge where it does among them:
  // their tetrahedra need not hang together by faces, yet star() and round_edge() find them all.
  [[nodiscard]] bool pinched(VertexId v) const { return vertex(v).pinch >= 0; }
  // Requires: v has no tetrahedra yet.
  void set_pinched(VertexId v);
  // Likewise of vertices that have. Cost: O(tetrahedra).
  void set_pinched(std::span<const VertexId> vertices);
  // A tetrahedron with the vertex as a corner.
  [[nodiscard]] TetId tet_at(VertexId v) const { return vertex(v).tet; }

  // Tetrahedra.
  [[nodiscard]] std::size_t tet_slots() const { return tets_.size(); }
  [[nodiscard]] std::size_t tet_count() const { return live_tets_; }
  [[nodiscard]] bool alive(TetId t) const { return tets_[t].region >= 0; }
  [[nodiscard]] Tet& tet(TetId t) { return tets_[t]; }
  [[nodiscard]] const Tet& tet(TetId t) const { return tets_[t]; }

  // Exponents and positions.
  [[nodiscard]] std::int32_t add(std::int32_t a, std::int32_t b) const {
    return rotations_.add(a, b);
  }
  [[nodiscard]] std::int32_t subtract(std::int32_t a, std::int32_t b) const {
    return rotations_.subtract(a, b);
  }
  // Exponent of a corner in a frame rotated by e; axis vertices keep 0.
  [[nodiscard]] std::int32_t shift(VertexId v, std::int32_t k, std::int32_t e) const {
    return on_axis(v) ? 0 : rotations_.add(k, e);
  }
  [[nodiscard]] OrbitVertex shift(OrbitVertex c, std::int32_t e) const {
    return {c.orbit, shift(c.orbit, c.exponent, e)};
  }
  [[nodiscard]] Point3 lift(VertexId v, std::int32_t k) const {
    return rotations_.rotate(vertices_[idx(v)].point, k);
  }
  [[nodiscard]] Point3 lift(OrbitVertex c) const { return lift(c.orbit, c.exponent); }
  [[nodiscard]] OrbitVertex corner(TetId t, std::uint32_t i) const {
    return {tets_[t].v[i], tets_[t].k[i]};
  }
  [[nodiscard]] OrbitVertex corner(TetCopy c, std::uint32_t i) const {
    return shift(corner(c.t, i), c.e);
  }
  [[nodiscard]] Point3 corner_point(TetId t, std::uint32_t i) const { return lift(corner(t, i)); }
  // The neighbour behind face i; the face must have one.
  [[nodiscard]] TetCopy neighbour(TetCopy c, std::uint32_t i) const {
    const Tet& t = tets_[c.t];
    return {tet_of(t.nb[i]), rotations_.add(c.e, t.off[i])};
  }

  // Canonical names of faces and edges, equal for all copies; see orbit_keys.hpp.
  [[nodiscard]] KeyedFace face_key(OrbitVertex a, OrbitVertex b, OrbitVertex c) const {
    return make_face_key(rotations_, {a, b, c},
                         {on_axis(a.orbit), on_axis(b.orbit), on_axis(c.orbit)});
  }
  [[nodiscard]] EdgeKey edge_key(OrbitVertex a, OrbitVertex b) const {
    return make_edge_key(rotations_, a, b, on_axis(a.orbit), on_axis(b.orbit));
  }

  // Subsegments: edges on segments of the input or on the axis.
  [[nodiscard]] const EdgeMap& edges() const { return edges_; }
  // kNoSegment: the edge is none of a segment.
  void set_segment(const EdgeKey& edge, std::int32_t segment);
  // Segment of the edge, kNoSegment.
  [[nodiscard]] std::int32_t segment_of(OrbitVertex a, OrbitVertex b) const {
    if (kind(a.orbit) > VertexKind::kSegment || kind(b.orbit) > VertexKind::kSegment) {
      return kNoSegment;
    }
    return edges_.find(edge_key(a, b));
  }

  // Replaces `removed` (each tetrahedron at most once) by `added`, which must fill the same space
  // in the same frame: links follow from the faces' canonical names, so that tetrahedra may meet
  // their own copies. The caller has checked orientation. Ids of the new tetrahedra: added_ids().
  // False, with nothing changed, if the faces do not fit together, if the two sides of a face name
  // different facets, or if the subfacets of a facet that go and those that come do not have the
  // same outline. `segment_edges`: subsegments that go and come in their place, in the same line;
  // outlines may differ in these.
  [[nodiscard]] bool replace(std::span<const TetCopy> removed,
                             std::span<const NewTet> added,
                             std::span<const EdgeKey> segment_edges = {}) {
    return replace(removed, added, Outlines::kCompared, segment_edges);
  }
  [[nodiscard]] std::span<const TetId> added_ids() const { return added_ids_; }

  // From scratch: as replace with nothing removed; faces that occur once must have a facet.
  [[nodiscard]] bool build(std::span<const NewTet> tets) {
    return replace({}, tets, Outlines::kNew, {});
  }

  // Edits that may turn out to be of no use: what they overwrite is kept from begin() on,
  // until they are to stay or everything is as it was. Trials do not nest, and nothing is compacted
  // meanwhile.
  void begin();
  void commit() { trial_.open = false; }
  // Returns the tetrahedra whose slots were written to.
  std::vector<TetId> roll_back();
  // A tetrahedron whose corners were moved is another one.
  void bump_version(TetId t) {
    if (trial_.open) keep(t);
    ++tets_[t].version;
  }

  // The tetrahedra at vertex copy (v, 0) in the universal cover; at an axis vertex every
  // tetrahedron once, at exponent 0 of its gauge. Appends nothing if v has none.
  void star(VertexId v, std::vector<TetCopy>& out) const;
  // Of a pinched vertex those that hang together by faces with tet_at(v); of others all.
  void fan(VertexId v, std::vector<TetCopy>& out) const;
  // The tetrahedra round edge (a, b), in order; `from` contains both. `closed` is false if the edge
  // lies on the boundary: then the row begins and ends at faces without neighbour. For an edge on
  // the axis one period of the ring.
  [[nodiscard]] bool ring(TetCopy from,
                          OrbitVertex a,
                          OrbitVertex b,
                          std::vector<TetCopy>& out) const;

  // All tetrahedra at edge (a, b), also where they are several rows that touch there only; in no
  // order. `from` contains both. For an edge on the axis one period.
  void round_edge(TetCopy from, OrbitVertex a, OrbitVertex b, std::vector<TetCopy>& out) const;

  // Next visit mark for Tet::stamp.
  std::uint32_t new_epoch();

  // Rewrites the slots of tetrahedra without gaps, near ones near each other. New id -> old one.
  std::vector<TetId> compact_tets();
  // Rewrites those of vertices, in the order of the tetrahedra. Old id -> new one (-1: was
  // deleted).
  std::vector<VertexId> compact_vertices();
  std::vector<VertexId> compact() {
    compact_tets();
    return compact_vertices();
  }

 private:
  struct Vertex {
    Point3 point;
    TetId tet = std::numeric_limits<TetId>::max();
    std::int32_t parent = -1;
    std::int32_t pinch = -1;  // of pinched vertices: index in pinch_tets_
    VertexKind kind = VertexKind::kFree;
    bool on_axis = false;
  };
  struct FaceSlot {
    FaceKey key;
    std::uint32_t epoch = 0;
    HalfFace outside = kNoHalfFace;  // kept neighbour behind a removed face
    std::int32_t outside_ref = 0;    // reference exponent of that half-face in its own frame
    std::int32_t facet = kNoFacet;
    bool removed = false;          // a removed face has this key
    bool hull = false;             // and no neighbour
    HalfFace first = kNoHalfFace;  // a new half-face with this key, as 4 * index + face
    std::int32_t first_ref = 0;
    std::int32_t new_facet = kNoFacet;
    std::int8_t uses = 0;
  };

  [[nodiscard]] static std::size_t idx(VertexId v) { return static_cast<std::size_t>(v); }
  [[nodiscard]] const Vertex& vertex(VertexId v) const { return vertices_[idx(v)]; }
  [[nodiscard]] FaceSlot& face_slot(const FaceKey& key);
  void reserve_face_slots(std::size_t count);
  enum class Outlines : std::uint8_t { kCompared, kNew };
  [[nodiscard]] bool replace(std::span<const TetCopy> removed,
                             std::span<const NewTet> added,
                             Outlines outlines,
                             std::span<const EdgeKey> segment_edges);
  [[nodiscard]] bool match_faces(std::span<const TetCopy> removed,
                                 std::span<const NewTet> added,
                                 Outlines outlines,
                                 std::span<const EdgeKey> segment_edges);
  [[nodiscard]] std::uint64_t outline_hash(OrbitVertex a,
                                           OrbitVertex b,
                                           OrbitVertex c,
                                           std::int32_t facet,
                                           std::span<const EdgeKey> without) const;
  TetId take_slot();
  [[nodiscard]] std::span<const TetId> tets_at_pinch(VertexId v) const;
  void note_at_pinches(TetId t);
  void keep(TetId t) { trial_.tets.emplace_back(t, tets_[t]); }
  void keep(VertexId v) { trial_.vertices.emplace_back(v, vertices_[idx(v)]); }
  [[nodiscard]] std::vector<TetId> spatial_order() const;
  void link(HalfFace h, HalfFace g, std::int32_t off);

  RotationTable rotations_;
  std::vector<Tet> tets_;
  std::vector<Vertex> vertices_;
  EdgeMap edges_;
  std::vector<TetId> free_tets_;
  std::vector<VertexId> free_vertices_;
  std::size_t live_tets_ = 0;
  std::uint32_t epoch_ = 0;

  // What a trial has overwritten, in order.
  struct Trial {
    bool open = false;
    std::vector<std::pair<TetId, Tet>> tets;
    std::vector<std::pair<VertexId, Vertex>> vertices;
    std::vector<std::pair<EdgeKey, std::int32_t>> edges;
    std::size_t tet_slots = 0, vertex_slots = 0, live_tets = 0;
    // Slots taken from the lists of free ones, or none where one was added.
    std::vector<std::optional<TetId>> free_tets;
    std::vector<std::optional<VertexId>> free_vertices;
  };
  Trial trial_;

  // Of each pinched vertex its tetrahedra, and others that once were: looked through when asked
  // for.
  mutable std::vector<std::vector<TetId>> pinch_tets_;

  // Of star(): the copy of each tetrahedron that was met first.
  struct Seen {
    std::uint32_t epoch = 0;
    std::int32_t e = 0;
  };
  mutable std::vector<Seen> seen_;
  mutable std::uint32_t seen_epoch_ = 0;

  // Of replace().
  std::vector<FaceSlot> face_table_;
  std::uint32_t face_epoch_ = 0;
  std::vector<TetId> added_ids_;
  std::vector<FaceSlot*> new_faces_;  // slot of every new half-face
  std::vector<std::int32_t> new_refs_;
};

}  // namespace symcell::solid
