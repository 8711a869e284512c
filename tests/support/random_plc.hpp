// Random solid models with a known symmetry, made from a seed alone: prisms and frustums with
// bores, layers, cavities, partitions and baffles, antiprisms, bipyramids, rings of loose blocks;
// on any axis, of any size, blunt or acute.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/model/plc.hpp"
#include "tests/support/model_topology.hpp"

namespace symcell::test {

struct RandomPlcOptions {
  std::int32_t max_fold = 64;
  std::optional<std::int32_t> fold;  // nullopt: random
  bool acute = true;                 // knife edges and spikes may occur
};

struct RandomPlc {
  Plc plc;
  std::string description;
  std::int32_t fold = 1;  // the model may happen to have a multiple of it
  Point3 axis_origin;
  Point3 axis_direction;
  double volume = 0;    // of the meshed domain
  double diameter = 0;  // of the bounding box
  bool axis_inside = false;
  bool acute = false;
  // Every segment bounds two facets, and what they enclose is all meshed.
  bool plain_surface = true;
  Pinches pinches;
  std::optional<BoundaryTopology> boundary;  // where the generator knows it
};

[[nodiscard]] RandomPlc make_random_plc(std::uint64_t seed, const RandomPlcOptions& options = {});

}  // namespace symcell::test
