// A symmetric solid from which exact sectors can be cut at several angles: where one candidate
// fails (the cut meets the surface badly, or its tetrahedralization fails), the next is tried.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/execution_context.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/geometry/indexed_surface.hpp"
#include "core/solid/groups/curve_boundary.hpp"
#include "core/solid/sector/sector.hpp"
#include "core/solid/sizes/size_field.hpp"
#include "core/solid/symmetry/solid_symmetry.hpp"

namespace symcell::solid {

class SectorSource {
 public:
  virtual ~SectorSource() = default;

  [[nodiscard]] virtual const Symmetry& symmetry() const = 0;
  [[nodiscard]] virtual const std::vector<std::string>& repairs() const = 0;

  // The number of different sectors that may be asked for, >= 1.
  [[nodiscard]] virtual std::int32_t candidates() const = 0;
  // The first so many may be chosen from; the others are for those models that all of them fail on.
  [[nodiscard]] virtual std::int32_t preferred() const { return candidates(); }
  // Triangles that are worked on for one candidate. 0: candidates differ in nothing but the cut.
  [[nodiscard]] virtual std::size_t effort() const { return 0; }
  // Candidate `index` in [0, candidates()), the most promising first.  Errors: kInternal or a model
  // code if this candidate cannot be cut; limits.
  [[nodiscard]] virtual Result<Sector> sector(std::int32_t index,
                                              ExecutionContext& context) const = 0;

  // The same model with a fold that divides this one's, about the same axis.
  // Errors: as symmetrising it with that fold given.
  [[nodiscard]] virtual Result<std::unique_ptr<SectorSource>> with_fold(
      std::int32_t fold, ExecutionContext& context) const = 0;

  // Whether a mesh's boundary need only be near the model's surface. Where not, it keeps the facets.
  [[nodiscard]] virtual bool may_change_surface() const { return false; }
  // The same model with the boundary of a mesh, in the local frame, with all of its copies, as the
  // surface that sectors are cut from; they are held against the model as ever.
  // Null unless may_change_surface.
  [[nodiscard]] virtual std::unique_ptr<SectorSource> with_surface(
      const IndexedSurface& /*boundary*/) const {
    return nullptr;
  }

  // How long edges may be from place to place, in the local frame; null: no bounds but those for all.
  [[nodiscard]] virtual std::shared_ptr<const SizeField> size_field() const { return nullptr; }

  // Looks at the boundary of a finished mesh, with all of its copies: whether nodes and middles of
  // facets are as near to the model's surface as the tolerance says. Where a mesh keeps the
  // facets as given, which other checks see to, there is nothing to look at.
  // `cell`: of order 1.  Errors: kInternal, limits.
  [[nodiscard]] virtual Result<void> check_boundary(const SymmetryCellMesh& /*cell*/,
                                                    ExecutionContext& /*context*/) const {
    return {};
  }

  // The faces that the cell's boundary may lie on, for a cell with their markers; they refer to this source.
  // Null: there are none, or the options do not ask for it.
  [[nodiscard]] virtual std::unique_ptr<CurvedBoundary> curved_boundary(
      const SymmetryCellMesh& /*cell*/, const MeshOptions& /*options*/) const {
    return nullptr;
  }

  // Marks a finished cell's boundary facets and nodes with groups, where the model has facets without
  // markers of its own.  Errors: limits.
  [[nodiscard]] virtual Result<void> label_boundary(SymmetryCellMesh& /*cell*/,
                                                    ExecutionContext& /*context*/) const {
    return {};
  }
};

}  // namespace symcell::solid
