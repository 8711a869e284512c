// How well a model's shape fits each fold, and which folds are worth trying.
//
// The error of fold n is the largest distance between a sample point (vertex, middle of a segment)
// turned by a multiple of 2 pi / n and the segments of the same kind. "The largest n under the
// tolerance" would be wrong: a fine polygon passes every fold for a circle, and a 64-fold disc
// passes 65. A fold is kept if
//   1. its error is much smaller than that of an arbitrary angle, or vertices fall on vertices;
//   2. no other fold, neither dividing the other, has less than a quarter of its error.
// Neither rule knows the tolerance, so that a larger one never loses a fold.
#pragma once

#include <vector>

#include "core/base/execution_context.hpp"
#include "core/geometry/segment_index.hpp"
#include "core/plane/symmetry/prepared_pslg.hpp"
#include "core/plane/symmetry/symmetrise.hpp"

namespace symcell::plane {

struct FoldFit {
  std::int32_t fold = 1;
  Point2 centre;
  double error = 0;               // input units
  std::int32_t worst_point = -1;  // of the prepared PSLG
  bool vertices_match = false;
  bool kept = false;
  bool accepted = false;  // whether the fold, if given, would be; set by inspection
};

class FoldDetector {
 public:
  // `tolerance`: input units.  `center`: nullptr to find the centre of each fold.
  FoldDetector(const PreparedPslg& prepared,
               const SegmentIndex& index,
               double tolerance,
               const Point2* centre);

  // The folds above 1 with errors up to `reach` (those above kMostNearFold: up to the tolerance),
  // ascending, judged by the rules above.
  // Cost: a few searches for each fold up to the number of vertices, thousands for those that fit.
  [[nodiscard]] Result<std::vector<FoldFit>> ladder(double reach, ExecutionContext& context) const;

  // One fold, measured; the error may exceed the tolerance.
  [[nodiscard]] FoldFit fit(std::int32_t fold) const;

 private:
  struct Sample {
    Point2 point;
    std::int32_t vertex = -1;  // point of the prepared PSLG (an end, for the middle of an edge)
    std::int32_t edge = -1;    // the edge it is the middle of, -1: a vertex
    bool isolated = false;
    double spacing = 0;  // length of the shortest edge at the vertex
  };

  // What a measurement may cost, and from where on its result is of no interest.
  struct Effort {
    double reach = 0;           // input units
    std::int64_t searches = 0;  // of the nearest segment
  };

  // Edges with one marker and the same classes of faces on their two sides, whichever is which.
  struct Kind {
    std::vector<std::int32_t> edges;  // of the prepared PSLG
    SegmentIndex index;               // of these
  };

  void sort_by_kind();
  void collect_samples();
  void count_radii();
  void keep_discriminating_samples();
  [[nodiscard]] double miss(
      const Sample& sample, Point2 image, double cosine, double sine, double reach) const;
  [[nodiscard]] bool fits(
      const Sample& sample, Point2 image, double cosine, double sine, double reach) const;
  [[nodiscard]] bool alike(std::int32_t id, const PreparedEdge& edge, Point2 along) const;
  [[nodiscard]] double arbitrary_angle_error(double enough) const;
  [[nodiscard]] bool fits_turn(double angle,
                               double reach,
                               std::size_t samples,
                               std::vector<std::int32_t>& order) const;
  [[nodiscard]] bool passes_first_look(std::int32_t fold,
                                       double reach,
                                       std::vector<std::int32_t>& order) const;
  [[nodiscard]] Result<std::vector<std::int32_t>> candidates(double arbitrary,
                                                             double reach,
                                                             ExecutionContext& context) const;
  [[nodiscard]] bool divides_a_class(std::int32_t fold) const;
  [[nodiscard]] Point2 refine_centre(double angle, Point2 centre, double reach) const;
  [[nodiscard]] FoldFit fit(std::int32_t fold, const Effort& effort) const;
  void measure(FoldFit& fit, const Effort& effort) const;
  [[nodiscard]] bool vertices_match(const FoldFit& fit) const;
  void judge(std::vector<FoldFit>& fits, double arbitrary) const;

  const PreparedPslg& prepared_;
  const SegmentIndex& index_;
  SegmentIndex isolated_;
  double tolerance_;
  bool centre_given_;
  Point2 centre_;
  std::vector<Kind> kinds_;
  std::vector<std::int32_t> kind_of_;  // per edge of the prepared PSLG
  mutable std::int64_t looks_ = 0;     // at samples, by fits_turn; reset by candidates
  std::vector<Sample> samples_;        // the most selective first
  // Numbers of vertices that share a radius, the fewest, by several notions of sharing.
  std::vector<std::int64_t> class_sizes_;
};

}  // namespace symcell::plane
