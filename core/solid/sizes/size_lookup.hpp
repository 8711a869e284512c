// A size field asked very often near the same places, as refinement and improvement do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/geometry/point.hpp"
#include "core/solid/sizes/size_field.hpp"

namespace symcell::solid {

// An octree that grows where it is asked. A cube knows the few sources that decide anywhere in it, so an
// answer costs a descent and a look at these. Not for several threads at once.
class SizeLookup {
 public:
  // `centre`, `half`: a cube about the model, in the field's frame, input units. Places outside cost more.
  SizeLookup(std::shared_ptr<const SizeField> field, Point3 centre, double half);

  // As SizeField::max_edge, but for rounding.
  [[nodiscard]] double max_edge(Point3 p, double enough);
  [[nodiscard]] double least() const { return field_->least(); }

 private:
  enum class State : std::uint8_t { kNew, kDivided, kListed, kCrowded };

  struct Cube {
    State state = State::kNew;
    std::int32_t count = 0;  // of sources listed
    std::size_t first = 0;   // of its eight children, or in listed_
    double least = 0;        // nowhere in it is less allowed
    double most = 0;         // nowhere in it is more allowed
  };

  void explore(std::size_t id, Point3 centre, double half);

  std::shared_ptr<const SizeField> field_;
  Point3 centre_;
  double half_ = 0;
  std::vector<Cube> cubes_;
  std::vector<std::int32_t> listed_;
};

}  // namespace symcell::solid
