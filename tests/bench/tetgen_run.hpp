// One run of TetGen on a complex of polygons, in a process of its own, with what it made of the
// boundary. For comparisons only: the program's own way to it is core/solid/initial/tetgen.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/geometry/point.hpp"
#include "tests/bench/tetgen_peer.hpp"

namespace symcell::bench {

struct PeerFacet {
  std::vector<std::vector<std::int32_t>> polygons;
  std::vector<Point3> holes;
  int marker = 0;
};

struct PeerInput {
  std::vector<Point3> points;
  std::vector<PeerFacet> facets;
  std::vector<Point3> holes;
};

struct PeerOutput {
  PeerCount count;
  std::vector<Point3> points;
  std::vector<std::array<std::int32_t, 3>> faces;  // of boundary and internal facets
  std::vector<std::int32_t> markers;               // per face
};

// "p..." and the bounds, without TetGen's Hilbert sort, which crashes at times.
[[nodiscard]] std::string switches_of(const char* base, PeerBounds bounds);

// Errors: kTetrahedralizationFailed.
[[nodiscard]] Result<PeerOutput> run_peer(const PeerInput& input, const std::string& switches);

}  // namespace symcell::bench
