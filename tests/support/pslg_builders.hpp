// Plane models built by rule: rings, stars, gears, flanges, and random ones that are valid and
// n-fold symmetric by construction, for property tests.
#pragma once

#include <cstdint>
#include <vector>

#include "core/model/pslg.hpp"

namespace symcell {

// Builds a PSLG from one sector about the origin: whatever is added comes in `fold` copies.
class SectorBuilder {
 public:
  // The copy 2 pi * exponent / fold further of a vertex that was added.
  struct Vertex {
    std::int32_t first = 0;     // index of copy 0
    std::int32_t exponent = 0;  // any integer
    bool centre = false;
  };

  explicit SectorBuilder(std::int32_t fold) : fold_(fold) {}

  Vertex add_vertex(Point2 p);
  Vertex add_centre();
  void add_segment(Vertex a, Vertex b, std::int32_t marker);
  // A loop round the origin: the vertices in order, then on to the first one's next copy.
  void add_loop(const std::vector<Vertex>& vertices, std::int32_t marker);
  // A loop within the sector.
  void add_closed(const std::vector<Vertex>& vertices, std::int32_t marker);
  void add_hole(Point2 p);
  void add_region(Point2 p, std::int32_t attribute, double max_area);
  // Segment between copies `exponent` and `exponent + fold / 2` of a vertex, through the origin.
  void add_diameter(Vertex v, std::int32_t marker);

  [[nodiscard]] Point2 turned(Point2 p, std::int32_t exponent) const;
  [[nodiscard]] Point2 position(Vertex v) const;
  [[nodiscard]] std::int32_t fold() const { return fold_; }
  [[nodiscard]] Pslg& pslg() { return pslg_; }

 private:
  [[nodiscard]] std::int32_t index(Vertex v, std::int32_t exponent) const;

  std::int32_t fold_;
  std::int32_t centre_ = -1;
  Pslg pslg_;
};

// Regular polygon of `fold` vertices; with `inner` > 0 a second one is the hole.
[[nodiscard]] Pslg regular_ring(std::int32_t fold, double outer, double inner);
// `fold` tips at radius `outer`, the notches between at `inner`; no hole.
[[nodiscard]] Pslg star(std::int32_t fold, double outer, double inner);
// Trapezoid teeth and a bore with one vertex a tooth.
[[nodiscard]] Pslg gear(std::int32_t teeth, double outer, double root, double bore);
// Disc with `bolts` round holes of 12 vertices and a bore.
[[nodiscard]] Pslg flange(std::int32_t bolts, double outer, double pitch, double bolt, double bore);
// Polygon of `fold` sides with straight spokes to a centre vertex; each sector its own region.
[[nodiscard]] Pslg spoked_wheel(std::int32_t fold, double outer);

[[nodiscard]] Pslg transformed(Pslg pslg, double scale, double angle, Point2 offset);
// Another order of vertices and segments, and segments turned round: the same model.
[[nodiscard]] Pslg shuffled(const Pslg& pslg, std::uint64_t seed);

// What random_symmetric_pslg made.
struct RandomPslgTraits {
  std::int32_t fold = 1;  // the full rotation group, not only a subgroup
  Point2 center;
  double scale = 1;         // about the outer radius
  double area = 0;          // of the meshed domain, by the shoelace formula
  std::int32_t curves = 0;  // loops round the centre
  bool centre_vertex = false;
  bool centre_meshed = false;   // the centre lies in the domain
  bool through_centre = false;  // segments through the centre without a vertex there (fold 2)
  bool regions = false;
  bool islands = false;  // pieces of the domain apart from each other
  bool small_holes = false;
  bool dangling = false;       // segments with a loose end, swirls among them
  bool isolated = false;       // vertices without a segment
  bool spokes = false;         // segments from loop to loop
  bool geometry_only = false;  // extra vertices on some copies: the shape alone is symmetric
};

// Valid and symmetric by construction: loops at shrinking radii, star-shaped about the centre; in
// the bands between: holes, swirls (straight segments over several sectors), isolated vertices,
// spokes, regions, voids.  Rotated, scaled by 1e-4 to 1e4 and shifted.  The same seed gives the
// same model.  `traits` may be null.  Requires: fold >= 1.
[[nodiscard]] Pslg random_symmetric_pslg(std::uint64_t seed,
                                         std::int32_t fold,
                                         RandomPslgTraits* traits);

}  // namespace symcell
