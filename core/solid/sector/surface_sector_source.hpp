// Exact sectors of a closed surface that is symmetric in shape but not in its triangles.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/triangle_tree.hpp"
#include "core/guard/boundary_topology.hpp"
#include "core/model/mesh_options.hpp"
#include "core/solid/groups/face_groups.hpp"
#include "core/solid/sector/sector_source.hpp"
#include "core/solid/surface/clean_surface.hpp"
#include "core/solid/surface/planar_patches.hpp"
#include "core/solid/surface/quotient_surface.hpp"

namespace symcell::solid {

// How well a sector's triangles can be meshed.
struct SectorShape {
  std::int64_t narrow = 0;  // corners of facets that no good tetrahedron fits into
  double thin = 0;          // share of thin triangles of curved parts
  // Elements that the surface takes: as long as a triangle or strip is high, along its length; and
  // what refinement adds at narrow corners in vain.
  double cost = 0;
  std::size_t made = 0;  // triangles, of this surface and others it was chosen from

  [[nodiscard]] bool many_thin() const;
  [[nodiscard]] bool better_than(const SectorShape& other) const;
};

class SurfaceSectorSource final : public SectorSource {
 public:
  // `clean`: without problem, input coordinates.  `tolerance`: input units.
  SurfaceSectorSource(CleanSurface clean, Symmetry symmetry, double tolerance);

  [[nodiscard]] const Symmetry& symmetry() const override { return symmetry_; }
  [[nodiscard]] const std::vector<std::string>& repairs() const override { return repairs_; }
  [[nodiscard]] std::int32_t candidates() const override {
    return static_cast<std::int32_t>(candidates_.size());
  }
  [[nodiscard]] std::int32_t preferred() const override { return preferred_; }
  [[nodiscard]] std::size_t effort() const override {
    return full_.triangles.size() / static_cast<std::size_t>(symmetry_.fold) + 1;
  }
  [[nodiscard]] Result<Sector> sector(std::int32_t index, ExecutionContext& context) const override;
  [[nodiscard]] Result<std::unique_ptr<SectorSource>> with_fold(
      std::int32_t fold, ExecutionContext& context) const override;
  [[nodiscard]] bool may_change_surface() const override { return true; }
  [[nodiscard]] std::unique_ptr<SectorSource> with_surface(
      const IndexedSurface& boundary) const override;
  [[nodiscard]] Result<void> check_boundary(const SymmetryCellMesh& cell,
                                            ExecutionContext& context) const override;
  [[nodiscard]] Result<void> label_boundary(SymmetryCellMesh& cell,
                                            ExecutionContext& context) const override;
  [[nodiscard]] std::unique_ptr<CurvedBoundary> curved_boundary(
      const SymmetryCellMesh& cell, const MeshOptions& options) const override;

  // Groups of the faces, alike in all copies of the fold as it is now; those with smaller folds keep
  // them.  `given`: the model as read.  Errors: limits.
  [[nodiscard]] Result<void> find_groups(const TriangleSurface& given,
                                         const MeshOptions& options,
                                         ExecutionContext& context);
  // What the options ask for of sizes, and the presets. After the groups.
  // Errors: kBadOption (unknown groups, regions), limits.
  [[nodiscard]] Result<void> find_sizes(const TriangleSurface& given,
                                        const MeshOptions& options,
                                        ExecutionContext& context);
  [[nodiscard]] std::shared_ptr<const SizeField> size_field() const override { return sizes_; }

 private:
  struct Candidate {
    double start_angle;
    // Lengths.
    double snap;
    double tolerance;
    double shell_share;  // see check_shape
  };
  void choose_candidates();
  [[nodiscard]] Result<SectorShape> flatten_and_improve(QuotientSurface& surface,
                                                        const Candidate& candidate,
                                                        ExecutionContext& context) const;
  [[nodiscard]] Result<SectorShape> improve(QuotientSurface& surface,
                                            const Candidate& candidate,
                                            const FlatnessTolerances& flatness,
                                            ExecutionContext& context) const;
  [[nodiscard]] Result<void> improve_again(QuotientSurface& surface,
                                           SectorShape& shape,
                                           const Candidate& candidate,
                                           const FlatnessTolerances& flatness,
                                           ExecutionContext& context) const;
  // Of the input's shells and Euler characteristic, and of its volume, or off by that share of a
  // shell as thick as the symmetry error at most; near the input everywhere; without crossings.
  [[nodiscard]] Result<void> check_shape(const QuotientSurface& surface,
                                         double shell_share,
                                         ExecutionContext& context) const;
  [[nodiscard]] Result<void> check_distances(const IndexedSurface& sector,
                                             ExecutionContext& context) const;

  void make_size_field();

  Symmetry symmetry_;
  std::vector<std::string> repairs_;
  double tolerance_;
  double allowed_;  // what is left of it after edges were collapsed: of the mesh from what is here
  double noise_;    // of coordinates
  double volume_;   // of the input
  double area_;     // likewise
  IndexedSurface full_;                          // that sectors are cut from; local frame
  bool of_mesh_ = false;                         // full_ is the boundary of a mesh
  BoundaryTopology topology_;                    // of the input
  TriangleTree tree_;                            // of the input
  std::shared_ptr<const IndexedSurface> given_;  // the input; local frame
  FaceGroups groups_;                            // of the input
  // Whether nodes of the boundary go to its faces.
  [[nodiscard]] bool curves(const MeshOptions& options) const;

  bool is_cad_ = false;  // groups have exact shapes
  std::vector<SizeSource> size_sources_;
  double gradation_ = kStandardGradation;
  std::shared_ptr<const SizeField> sizes_;  // of the sources, at this fold
  std::vector<Candidate> candidates_;
  std::int32_t preferred_ = 0;  // of them: with the whole tolerance
};

// The groups alone, which are listed without a mesh.  `surface`: cleaned, without problem, input
// coordinates.  `given`: the model as read.  Errors: limits.
[[nodiscard]] Result<std::vector<FaceGroup>> groups_of_surface(IndexedSurface surface,
                                                               const Symmetry& symmetry,
                                                               double tolerance,
                                                               const TriangleSurface& given,
                                                               const MeshOptions& options,
                                                               ExecutionContext& context);

}  // namespace symcell::solid
