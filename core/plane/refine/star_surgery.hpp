// Operations on whole stars: moving a vertex, replacing several vertices by one, removing a vertex.
//
// Each looks for a position at which the whole new star keeps all bounds (feasible_region.hpp) and
// changes nothing if there is none. Stars that meet a copy of themselves are left alone: moving one
// vertex there would move its own link.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

#include "core/plane/delaunay/insert.hpp"
#include "core/plane/refine/criteria.hpp"
#include "core/plane/refine/feasible_region.hpp"

namespace symcell::plane {

class StarSurgery {
 public:
  StarSurgery(Editor& editor, const Criteria& criteria);

  // Moves a Steiner point so that its whole star is good; then flips. False: not possible.
  // editor.created() then lists what changed, the star included.
  [[nodiscard]] bool relocate(VertexId v);

  // Replaces two adjacent Steiner points (corners in one frame, kept.exponent = 0) by one with a good
  // star: `kept` is moved, `removed` is gone. If one lies on a segment, `kept` does.
  [[nodiscard]] bool merge(OrbitVertex kept, OrbitVertex removed);

  // Removes a free vertex whatever the quality of what remains, keeping the mesh Delaunay.
  // False if its star meets a copy of itself or has no valid triangulation by a fan.
  [[nodiscard]] bool remove(VertexId v);

  // Removes a Steiner point from its segment, which becomes one subsegment there; else as `remove`.
  [[nodiscard]] bool unsplit(VertexId v);

  // Fills `out` with the star edges of a cavity, lifted.
  void lift_edges(const std::vector<CavityEdge>& edges, std::vector<StarEdge>& out) const;

  [[nodiscard]] FeasibleRegion& region() { return region_; }

 private:
  struct SegmentEnds {
    OrbitVertex a, b;  // ends of the chain of subsegments, in the frame
    std::vector<SubsegmentId> chain;
  };

  [[nodiscard]] bool gather_cavity(OrbitVertex v);
  [[nodiscard]] bool gather_cavity(OrbitVertex v, OrbitVertex w);
  [[nodiscard]] bool append_star(OrbitVertex v, const OrbitVertex* other, bool first);
  [[nodiscard]] bool cavity_meets_itself() const;
  // Whether a copy of a removed vertex is an end of a side.
  [[nodiscard]] static bool touches(const std::vector<CavityEdge>& edges,
                                    std::initializer_list<OrbitVertex> removed);
  [[nodiscard]] bool gather_star(OrbitVertex v, std::vector<CavityTriangle>& region) const;
  [[nodiscard]] bool gather_union(std::initializer_list<OrbitVertex> removed);
  [[nodiscard]] bool segment_ends(std::initializer_list<OrbitVertex> removed,
                                  SegmentEnds& ends) const;
  [[nodiscard]] bool merge_free(OrbitVertex kept, OrbitVertex removed);
  [[nodiscard]] bool merge_on_segment(std::initializer_list<OrbitVertex> removed);
  [[nodiscard]] bool collect_sides(std::initializer_list<OrbitVertex> removed,
                                   const SegmentEnds& ends);
  [[nodiscard]] bool keep_if_lengths_hold(bool transaction);
  [[nodiscard]] std::optional<std::size_t> fan_apex(const std::vector<CavityEdge>& polygon) const;
  void fill_fan(const std::vector<CavityEdge>& polygon,
                std::size_t apex,
                const CavityTriangle* triangles,
                std::size_t count);
  void finish_star();
  void settle_filled();

  Editor& editor_;
  QuotientTriangulation& mesh_;
  const Criteria& criteria_;
  FeasibleRegion region_;
  Cavity cavity_, side_;
  std::vector<CavityTriangle> union_;
  std::vector<StarEdge> star_edges_;
  std::vector<CavityEdge> fan_, polygon_[2];
  std::vector<TriangleId> filled_;
  SegmentEnds ends_;
};

}  // namespace symcell::plane
