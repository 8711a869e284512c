// The lines and arcs of a PSLG while they are joined, split and merged by position.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/model/pslg.hpp"

namespace symcell::plane {

class CurveSet {
 public:
  struct Curve {
    std::int32_t a = 0;
    std::int32_t b = 0;
    std::int32_t marker = 0;
    double bulge = 0;
    double chord_angle = 0;
    std::int32_t source = 0;  // segment of the PSLG
    std::int32_t count = 1;   // of curves that this one stands for
  };

  // `tolerance` > 0: distance by which positions may differ that are meant to be one.
  // Requires: check_entities(pslg) passed.
  CurveSet(const Pslg& pslg, double tolerance);

  struct Joined {
    std::size_t vertices = 0;
    double widest = 0;  // largest distance of those
  };
  // Vertices within the tolerance of one with a smaller number, and for which `may` holds, become
  // that one. Curves that lose their length thereby go.
  Joined join(const std::vector<char>& may);

  // Vertices where curves cross or touch and none stands.  Returns their number.
  // Errors: kTooLarge, limits.  Cost: O((N + K) log N) for K pairs whose boxes meet.
  [[nodiscard]] Result<std::size_t> add_crossings(ExecutionContext& context);

  // Curves are cut at the vertices within the tolerance of them.  Returns the number of cuts.
  std::size_t split();

  // Curves that run alike between the same vertices become one, with the smallest marker but 0.
  // Returns how many went.
  std::size_t merge();

  // Curves for which `keep` is 0 go, and then vertices that had curves and have none.
  void remove_curves(const std::vector<char>& keep);

  [[nodiscard]] const std::vector<Point2>& vertices() const { return vertices_; }
  [[nodiscard]] const std::vector<Curve>& curves() const { return curves_; }

  // Vertices and segments of `pslg` become these; its seeds, names and notes stay.
  void write(Pslg& pslg) const;

 private:
  void renumber(const std::vector<std::int32_t>& target);
  [[nodiscard]] bool alike(const Curve& x, const Curve& y) const;

  double tolerance_;
  std::vector<Point2> vertices_;
  std::vector<Curve> curves_;
};

// Where two segments of a model, lines or arcs, meet or touch, within `tolerance`; ends count.
[[nodiscard]] std::vector<Point2> meeting_places(const Pslg& pslg,
                                                 std::size_t s,
                                                 std::size_t t,
                                                 double tolerance);

// How many segments end at each vertex.
[[nodiscard]] std::vector<std::int32_t> degrees_of(const Pslg& pslg);

}  // namespace symcell::plane
