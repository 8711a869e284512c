// The numbers that decide how much work goes into a solid, in one place, so that a benchmark can
// sweep them: mesh_solid takes them as an argument. The values are those at which further work took
// off less than a few percent of the tetrahedra of the benchmark's models (docs/benchmarks.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace symcell::solid {

// How many sectors are cut and meshed. What a cut does to the surface's triangles and to the first
// tetrahedralization shows in meshes that no size bound determines, up to twice as many tetrahedra.
// Wanted are the fewest bad tetrahedra, then the fewest of all, where a poor angle counts as more.
struct StartLimits {
  // Cutting. Sectors that are tried before a model is given up.
  std::int32_t sectors = 40;
  // Triangles that are worked on for the sake of a better cut, and sectors that are compared.
  std::size_t compare_budget = 60'000;
  std::size_t compared = 8;
  // After so many triangles a sector without narrow corners is good enough, and at once where two
  // in a row cost the same up to this factor.
  std::size_t enough_compared = 7'000;
  double alike = 1.001;
  double later_cost = 0.05;  // what a sector costs more than the one before, for the same triangles
  // Sectors from which a mesh larger than the best one by this factor is expected are left out.
  double most_costlier = 2.5;

  // Meshing. Meshes from different cuts, and where bad tetrahedra are left.
  int meshes = 4;
  int meshes_if_bad = 8;
  int cells = 6;  // meshes made for want of one that a symmetry cell can be cut from
  // Larger cells are meshed once, but for bad tetrahedra, and up to the second of these.
  std::uint64_t small_cell = 8'000;
  std::uint64_t mendable_cell = 60'000;
  // Meshes made from the boundary of the one before, as long as each takes off more than a share or
  // has fewer bad tetrahedra; cuts that are compared for one, and tried before it is given up. A third
  // takes off a few percent more, for as much time again.
  int meshes_again = 2;
  double worthwhile_again = 0.95;
  std::size_t compared_again = 2;
  std::int32_t sectors_again = 8;
  std::uint64_t cell_again = 20'000;      // larger cells are left as they are,
  std::uint64_t mendable_again = 80'000;  // but for bad tetrahedra up to these
  // Before its improvement a mesh of a further start may be larger than the best one by this factor.
  std::uint64_t most_times_larger = 2;
  std::uint64_t most_times_larger_if_bad = 4;  // where many tetrahedra of that one are
  // Triangles that are worked on for the sake of better or fewer tetrahedra.
  std::size_t mend_budget = 40'000;
  std::size_t start_budget = 4'000;
  double sized_share = 2.5;  // of the tetrahedra that a size bound asks for: less, and it decides
  // A mesh with a dihedral angle of a sine below this counts as larger by a factor.
  double poor_sine = 0.26;          // 15 degrees
  double poor_exempt_sine = 0.087;  // 5 degrees: the input may have few more
  double sized_poor_sine = 0.174;   // 10 degrees: large meshes take their time
  double poor_factor = 1.5;
};

// Rounds of refinement and improvement of one mesh.
struct RoundLimits {
  // Of the tetrahedra whose spheres hold a point for the sake of shape so many may be hidden from
  // it, run by run; any number after these. A first mesh that keeps needles and fans of the input is
  // far from Delaunay: where points go in at once they cascade, and where they are refused for good
  // a third of the mesh stays bad. What is clear goes first, and each round of improvement makes
  // more of it clear: a rim took 3,750 tetrahedra with 858 bad ones at 40 throughout, 17,100 with
  // none at any, 5,500 with none so.
  std::array<std::size_t, 4> most_hidden = {4, 16, 64, 256};
  std::size_t most_hidden_alone = 40;  // where no improvement follows
  // The improvement works on tetrahedra with a dihedral angle below this or above its supplement.
  double goal_deg = 26;
  double costly_goal_deg = 25;  // and may cost a vertex, or a detour, below this
  int last_passes = 3;
  // Full rounds: the second takes off 5 to 10 % of the tetrahedra, the third 2 to 5 %, each for a
  // quarter more time, which large meshes are not given.
  std::size_t rounds = 3;
  std::size_t rounds_if_large = 2;
  std::size_t large_cell = 5'000;
  // Bad tetrahedra that are mended without a full round.
  std::size_t few_bad = 10;
  double few_bad_share = 5e-4;
  // Rounds after which more than this share of the bad tetrahedra is left are the last: what is bad
  // is the input's fault, and refinement only adds to it.
  double least_progress = 0.9;
  // Where many are bad, a run that leaves more of them than it found by a factor is undone and the last:
  // points cause others in a cascade, and improvement does not make up for it. Before any number may be
  // hidden, factors up to 7 were made up for on real parts (a fan, a knob), 9.2 was not (a gear with
  // 6,302 of 114,000 went on to 300,000 of 614,000); later ones up to 3.3, and from 6.4 on not.
  double cascade = 8;
  double late_cascade = 4;
  // Meshes that have no more tetrahedra then are followed to their end: it costs little, and a rim with
  // 459 of 1,138 bad, a rotor with 453 of 6,505, came out with none of 5,430 and of 9,749.
  std::uint64_t cascade_from = 20'000;
  // Of a mesh up to so many tetrahedra the boundary is to be meshed again: where more than a share is bad,
  // detours are left to that mesh. They took 13 s of a handlebar's 57. From 0.01 on a fan ended with
  // 94 bad ones for 43: its first mesh had 424 of 41,000, which detours made 180.
  std::uint64_t most_followed = 0;
  double lost_share = 0.1;
  // What later runs of refinement add for the sake of shape is little in models without acute
  // input. Where it is not, it is a cascade.
  std::uint64_t most_growth = 4;
  std::uint64_t least_growth = 2'000;
  // Where more bad tetrahedra are left than this share, and than a few, the mesh may grow on, by a factor
  // at a time, as long as that leaves less than a share of them: a frame had 5,694 of 41,703, and has 139
  // of 128,906 then; where acute facets make every point cause others, they become more.
  double many_bad_share = 0.01;
  std::size_t many_bad = 20;
  std::uint64_t more_growth = 2;
  double least_decline = 0.7;
  int most_growths = 4;
  // More than that come of the input, whatever the cut; a few may not.
  [[nodiscard]] bool is_many_bad(std::size_t bad, std::size_t count) const {
    return bad > many_bad && static_cast<double>(bad) > many_bad_share * static_cast<double>(count);
  }
  // For the sake of shape no edge gets shorter than this share of the shortest one of the first
  // mesh, whatever the runs: into spikes of the input they would shrink without end.
  double least_distance = 1.0 / 256;
};

// The choice of a fold. Cells of one mesh each are compared.
struct FoldLimits {
  std::int32_t least = 8;  // sectors of smaller folds are wide enough
  int most_meshed = 10;    // folds that are tried
  // Tetrahedra of a mesh before it is improved, at which a fold is given up; of all meshes, and
  // triangles worked on for their sake, after which no other fold is tried: a second's work or two.
  std::uint64_t most_refined = 10'000;
  std::uint64_t most_made = 30'000;
  // Folds are tried that promise fewer tetrahedra than so many times the smallest cell so far. Half
  // the fold promises twice as many where the sector keeps nothing small, and 1.75 times where a
  // seventh of them is; estimates do not see what the surface has to do for a narrow sector.
  double hope = 1.9;
  // Where a cell is too large to be compared, the sector may be the cause of it from this fold on.
  std::int32_t narrow = 24;
  // Cuts that are compared for a mesh, and triangles worked on for their sake: at some folds the
  // first cut is far from the best.
  std::size_t compared_cuts = 4;
  std::size_t compare_budget = 10'000;
  std::int32_t sectors = 8;  // that are tried before a fold is given up
  double worthwhile = 0.95;  // of the tetrahedra at the largest fold: a smaller one must have fewer
};

struct Tuning {
  StartLimits starts;
  RoundLimits rounds;
  FoldLimits folds;
};

}  // namespace symcell::solid
