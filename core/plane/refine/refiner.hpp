// Symmetry-constrained Delaunay refinement of the quotient mesh.
//
// [Ruppert95] with Shewchuk's diametral lenses, off-centres [Ungor04], concentric shells at small
// input angles, and, before a point is inserted, relocation: a free vertex is moved if its whole
// star can be made good, and an inserted point is put where its whole star is good if there is such
// a place [Erten-Ungor09]. All of it on orbits: one step here is n simultaneous steps in the full
// mesh [paper sec. 4].
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/base/random.hpp"
#include "core/plane/delaunay/insert.hpp"
#include "core/plane/delaunay/locate.hpp"
#include "core/plane/refine/bad_triangle_queue.hpp"
#include "core/plane/refine/criteria.hpp"
#include "core/plane/refine/star_surgery.hpp"

namespace symcell::plane {

struct RefineCounters {
  std::uint64_t inserted = 0;
  std::uint64_t splits = 0;
  std::uint64_t relocations = 0;
  std::uint64_t removed = 0;
};

class Refiner {
 public:
  struct Settings {
    Point2 centre;         // of the model, for messages
    bool relocate = true;  // moves and star-optimal insertion
    // Points tried round a bad triangle for one with a good star before its off-centre is taken.
    int samples = 0;
    std::uint64_t seed = 0;  // of the samples
    // The mesh is given up, with kElementLimit, beyond about this many triangles.
    std::size_t most_triangles = std::numeric_limits<std::size_t>::max();
  };

  Refiner(Editor& editor, Criteria& criteria, const Settings& settings, ExecutionContext& context);

  // Refines until no triangle is bad. Errors: limits, kBoundUnreachable (names the place).
  [[nodiscard]] Result<void> run();

  [[nodiscard]] const RefineCounters& counters() const { return counters_; }
  [[nodiscard]] StarSurgery& surgery() { return surgery_; }

 private:
  enum class Outcome : std::uint8_t { kDone, kExempt, kRetry, kStuck };
  enum class Encroachment : std::uint8_t { kNone, kQueued, kRefused };

  void enqueue_all();
  void enqueue_subsegment(SubsegmentId s);
  void look_at_subsegment(SubsegmentId s);
  void enqueue_created();
  [[nodiscard]] bool encroached(SubsegmentId s) const;
  [[nodiscard]] Result<void> split_queued_subsegments();
  [[nodiscard]] Result<void> split(SubsegmentId s);
  void split_if_allowed(SubsegmentId s);
  [[nodiscard]] bool may_split(SubsegmentId s) const;
  [[nodiscard]] bool made_short_edge() const;
  void clear_lens(SubsegmentId s);
  [[nodiscard]] Point2 split_point(OrbitVertex a, OrbitVertex b) const;
  void settle_star();
  [[nodiscard]] Outcome treat(TriangleId t);
  [[nodiscard]] Outcome improve(TriangleId t, const Assessment& assessment);
  [[nodiscard]] bool relocate_corner_of(TriangleId t);
  [[nodiscard]] Outcome insert_for(TriangleId t, Point2 x);
  [[nodiscard]] bool insert_sampled(TriangleId t, const Assessment& assessment);
  [[nodiscard]] std::optional<Point2> good_star_near(TriangleId home, Point2 x);
  [[nodiscard]] Outcome insert_at(TriangleId home, Point2 x, bool optimal, std::int32_t exponent);
  [[nodiscard]] Point2 off_centre(TriangleId t, const Assessment& assessment, bool farther) const;
  [[nodiscard]] Encroachment encroachment(const Cavity& cavity, Point2 x);
  [[nodiscard]] Result<void> tick();
  [[nodiscard]] Error unreachable(TriangleId t) const;

  Editor& editor_;
  QuotientTriangulation& mesh_;
  Criteria& criteria_;
  Settings settings_;
  bool relocate_;
  ExecutionContext& context_;
  Random random_;
  StarSurgery surgery_;
  RefineCounters counters_;
  BadTriangleQueue queue_;
  std::vector<SubsegmentId> segments_;
  std::vector<SubsegmentId> encroached_;
  std::vector<std::uint8_t> refused_;  // per subsegment: 1 if it must not be split
  std::vector<std::uint8_t> moves_;    // per vertex: relocations so far
  Cavity cavity_;
  std::vector<StarEdge> star_edges_;
  double shortest_allowed2_ = 0;  // edges below this mean that the bound is out of reach
  double unit_ = 1;               // of the shells
  std::uint64_t steps_ = 0;
};

}  // namespace symcell::plane
