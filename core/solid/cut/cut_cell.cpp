#include "core/solid/cut/cut_cell.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/solid/cut/cell_topology.hpp"
#include "core/solid/cut/minimise_bound.hpp"
#include "core/solid/cut/repair_cell.hpp"
#include "core/solid/cut/representatives.hpp"

namespace symcell::solid {
namespace {

constexpr std::int32_t kUnset = -1;  // part of a tetrahedron not yet visited

// Parts of the solid that touch in no face may be turned one by one: brings them next to the
// largest, and that one to the sector that begins at the x axis.
class PieceGatherer {
 public:
  explicit PieceGatherer(Representatives& cell)
      : cell_(cell), mesh_(cell.mesh()), part_(mesh_.tet_slots(), kUnset) {}

  void run() {
    find_parts();
    if (sums_.empty()) return;
    const auto largest = static_cast<std::size_t>(
        std::max_element(volumes_.begin(), volumes_.end()) - volumes_.begin());
    const double sector = 2 * std::numbers::pi / static_cast<double>(mesh_.fold());
    std::vector<std::int32_t> turn(sums_.size(), 0);
    for (std::size_t id = 0; id < sums_.size(); ++id) {
      const Point2 r = id == largest ? Point2{1, 0} : sums_[largest];
      const double angle = std::atan2(cross(r, sums_[id]), dot(r, sums_[id]));
      const double steps = id == largest ? std::floor(angle / sector) : std::round(angle / sector);
      turn[id] = -static_cast<std::int32_t>(steps);
    }
    for (std::size_t id = 0; id < sums_.size(); ++id) {
      if (id != largest) turn[id] += turn[largest];
    }
    // Neighbours move alike, so only the exponents change.
    for (TetId t = 0; t < mesh_.tet_slots(); ++t) {
      if (mesh_.alive(t)) cell_.move(t, turn[static_cast<std::size_t>(part_[t])]);
    }
  }

 private:
  void find_parts() {
    std::vector<TetId> stack;
    for (TetId seed = 0; seed < mesh_.tet_slots(); ++seed) {
      if (!mesh_.alive(seed) || part_[seed] != kUnset) continue;
      const auto id = static_cast<std::int32_t>(sums_.size());
      sums_.emplace_back();
      volumes_.push_back(0);
      part_[seed] = id;
      stack.assign(1, seed);
      while (!stack.empty()) {
        const TetId t = stack.back();
        stack.pop_back();
        add(t, static_cast<std::size_t>(id));
        for (const HalfFace g : mesh_.tet(t).nb) {
          if (g == kNoHalfFace || part_[tet_of(g)] != kUnset) continue;
          part_[tet_of(g)] = id;
          stack.push_back(tet_of(g));
        }
      }
    }
  }

  void add(TetId t, std::size_t id) {
    const Point3 a = mesh_.corner_point(t, 0), b = mesh_.corner_point(t, 1),
                 c = mesh_.corner_point(t, 2), d = mesh_.corner_point(t, 3);
    const double volume = dot(cross(b - a, c - a), d - a);
    const Point3 s = volume * (a + b + c + d);
    const std::int32_t e = mesh_.rotations().reduce(cell_.exponent(t));
    sums_[id] = sums_[id] + mesh_.rotations().rotate(Point2{s.x, s.y}, e);
    volumes_[id] += volume;
  }

  Representatives& cell_;
  const QuotientTetrahedralization& mesh_;
  std::vector<std::int32_t> part_;  // per tetrahedron
  std::vector<Point2> sums_;        // per part: centroid times volume
  std::vector<double> volumes_;
};

CellCut as_cut(const Representatives& cell) {
  const QuotientTetrahedralization& mesh = cell.mesh();
  CellCut cut;
  cut.exponent.assign(mesh.tet_slots(), 0);
  for (TetId t = 0; t < mesh.tet_slots(); ++t) {
    if (!mesh.alive(t)) continue;
    cut.exponent[t] = mesh.rotations().reduce(cell.exponent(t));
    for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
      if (cell.jump(h) < 0 && !cell.is_inside(h)) cut.lower.push_back(h);
    }
  }
  cut.symmetry_faces = cut.lower.size();
  return cut;
}

// Raises the weights of symmetry faces at flaws, so that the next minimum avoids them. Of a loose
// piece the faces towards one side only: which, alternates from round to round.
void raise_weights(const Representatives& cell,
                   const std::vector<CellFlaw>& flaws,
                   int round,
                   FaceWeights& weights) {
  const QuotientTetrahedralization& mesh = cell.mesh();
  if (weights.empty()) weights.assign(4 * mesh.tet_slots(), 1);
  constexpr std::uint8_t kMost = 200;  // faces; below the 255 that a weight can hold
  const auto raise = [&](HalfFace h) {
    const HalfFace g = mesh.tet(tet_of(h)).nb[face_of(h)];
    if (cell.jump(h) == 0 || weights[h] >= kMost) return;
    weights[g] = ++weights[h];
  };
  std::vector<TetCopy> star;
  for (const CellFlaw& f : flaws) {
    if (f.vertex < 0) continue;
    star.clear();
    mesh.star(f.vertex, star);
    for (const TetCopy& c : star) {
      for (HalfFace h = 4 * c.t; h < 4 * c.t + 4; ++h) raise(h);
    }
  }
  for (const LoosePiece& piece : find_loose_pieces(cell)) {
    for (const TetId t : piece.tets) {
      for (HalfFace h = 4 * t; h < 4 * t + 4; ++h) {
        if ((cell.jump(h) > 0) == (round % 2 == 0)) raise(h);
      }
    }
  }
}

}  // namespace

Result<CellCut> cut_cell(const QuotientTetrahedralization& mesh, ExecutionContext& context) {
  if (mesh.fold() == 1) return as_cut(Representatives(mesh));
  // Flaws that no move of tetrahedra repairs are avoided by another minimum.
  constexpr int kRounds = 40;
  Representatives least(mesh, Representatives::best_share(mesh));
  FaceWeights weights;
  std::vector<CellFlaw> flaws;
  for (int round = 0; round < kRounds; ++round) {
    SYMCELL_TRY(minimise_bound(least, context, weights));
    Representatives cell = least;
    const auto usable = repair_cell(cell, context);
    if (!usable) return error_of(usable);
    if (*usable) {
      SYMCELL_TRY(avoid_chains(cell, context));
      PieceGatherer(cell).run();
      return as_cut(cell);
    }
    flaws = find_cell_flaws(least);
    raise_weights(least, flaws, round, weights);
  }
  std::string what = "no symmetry cell without flaws was found";
  std::vector<std::int64_t> where;
  for (const CellFlaw& f : flaws) {
    if (where.empty()) what += "; the first: " + std::string(cell_flaw_name(f.kind));
    where.push_back(static_cast<std::int64_t>(f.tet));
  }
  return fail(ErrorCode::kInternal, std::move(what), std::move(where));
}

}  // namespace symcell::solid
