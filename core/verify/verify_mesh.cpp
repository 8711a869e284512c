#include "core/verify/verify_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/point_tree.hpp"
#include "core/geometry/resolution.hpp"
#include "core/verify/against_model.hpp"
#include "core/verify/model_as_meshed.hpp"
#include "core/verify/support.hpp"
#include "core/verify/symmetry.hpp"

namespace symcell {
namespace {

using internal::Checks;
using internal::ExaminedModel;
using internal::FacetedMesh;
using internal::ModelPinches;
using internal::shown;

// A mesh is symmetric and the model only nearly: nodes may be off by the model's own asymmetry and
// by as much again where it was averaged, on either side of a vertex.
constexpr double kAsymmetries = 4;
// Rounding of a sum over all elements, and what a tessellation may differ by, as shares.
constexpr double kExactMeasureRel = 1e-9;
constexpr double kSurfaceMeasureRel = 1e-2;
// The largest symmetry tolerance there is: no mesh may say that it was made with a larger one.
constexpr double kMostShapeToleranceRel = 0.1;
// Units in the last place, of the largest coordinate, that nodes of a correct mesh may be off by.
constexpr double kRoundings = 16;
// The same of what is one but written twice, as by two rotations that take it to one place. A quarter
// of what validation takes vertices of a model for one within, so that the edges which refinement
// makes beside the nearest two that it lets pass are no faults.
constexpr double kRoundingsApart = 8;
// Of an edge: by which its mid-side node may be off the middle of the edge or of its arc.
constexpr double kOnArc = 1e-5;

class Verifier {
 public:
  Verifier(const MeshData& cell,
           const MeshData* full,
           const Model* model,
           const VerifyOptions& options,
           VerifyReport& report)
      : cell_(cell),
        full_(full),
        model_(model),
        options_(options),
        checks_(report,
                options.exempt_elements * static_cast<std::size_t>(std::max(cell.fold, 1))) {}

  void run() {
    if (!internal::check_fields(cell_, "cell", checks_)) return;
    const internal::Turns turns(cell_);
    examine_model(turns);
    diameter_ = the_diameter(turns);
    magnitude_ = magnitude();
    const double rounding = std::numeric_limits<double>::epsilon() * magnitude_;
    apart_ = kRoundingsApart * rounding;
    rounding_ = kRoundings * rounding;
    tolerance_ = std::max(options_.tolerance_rel * diameter_, rounding_);
    if (model_known_) set_model_tolerance(turns);
    const FacetedMesh cell(cell_);
    if (!internal::check_elements(cell, "cell", apart_, checks_)) return;
    internal::tell_quality(cell_, checks_);
    internal::check_links(cell, "cell", pinches(), checks_);
    if (!internal::check_pairs(cell_, turns, {tolerance_, apart_}, checks_)) return;
    const internal::CellBounds bounds =
        internal::check_bounds(cell, turns, tolerance_, pinches(), checks_);
    if (full_ != nullptr) {
      look_at_full(cell, bounds, turns, *full_);
      return;
    }
    const std::size_t nodes = cell_.points.size() * static_cast<std::size_t>(cell_.fold);
    if (nodes <= options_.most_restored_nodes) {
      look_at_full(cell, bounds, turns, internal::restore(cell_, turns));
      return;
    }
    checks_.skip("full.fields", "the full mesh is too large to be restored here; give its file");
    check_model_measure(internal::total_measure(cell_) * cell_.fold);
  }

 private:
  [[nodiscard]] bool plane() const { return cell_.dimension == 2; }

  void examine_model(const internal::Turns& turns) {
    if (model_ == nullptr) return;
    if (is_planar(kind_of(*model_)) != plane()) {
      checks_.add("model.valid", false, "the model has another dimension than the mesh");
      return;
    }
    if (!make_as_meshed(turns)) return;
    Result<ExaminedModel> examined = internal::examine_model(as_meshed_ ? *as_meshed_ : *model_);
    checks_.add("model.valid", examined.has_value(), examined ? "" : examined.error().message);
    if (!examined) return;
    examined_ = std::move(*examined);
    model_known_ = true;
  }

  // Planar models are compared as they were meshed.
  bool make_as_meshed(const internal::Turns& turns) {
    if (const auto* surface = std::get_if<TriangleSurface>(model_)) return make_whole(*surface);
    const auto* pslg = std::get_if<Pslg>(model_);
    if (pslg == nullptr) return true;
    std::function<Point3(const Point3&)> rotate;
    if (cell_.fold > 1) rotate = [&](const Point3& p) { return turns.rotated(p, 1); };
    auto made = internal::model_as_meshed(*pslg, corners_of_full(turns), rotate, options_);
    if (!made) {
      checks_.add("model.valid", false, made.error().message);
      return false;
    }
    if (!*made) return true;
    if (pslg->has_arcs()) {
      const std::string& coarse = (*made)->coarse;
      const std::string beside = mid_node_beside_arcs(turns, (*made)->arc_middles);
      checks_.add("model.arcs", coarse.empty() && beside.empty(), coarse + beside);
    }
    as_meshed_ = std::move((*made)->pslg);
    return true;
  }

  // All sectors of which a surface bounds one, about the cell's axis.
  bool make_whole(const TriangleSurface& surface) {
    if (!options_.sector) return true;
    auto whole = internal::all_sectors(
        surface, *options_.sector, AxisFrame::of_axis(cell_.axis_origin, cell_.axis_direction),
        options_.symmetry_tolerance_rel.value_or(
            options_.model_tolerance_rel.value_or(kSurfaceSymmetryToleranceRel)));
    if (!whole) {
      checks_.add("model.valid", false, whole.error().message);
      return false;
    }
    as_meshed_ = std::move(*whole);
    return true;
  }

  [[nodiscard]] std::vector<Point3> corners_of_full(const internal::Turns& turns) const {
    const MeshData& mesh = full_ != nullptr ? *full_ : cell_;
    std::vector<char> is_corner(mesh.points.size(), 0);
    const auto k = static_cast<std::size_t>(mesh.nodes_per_element);
    for (std::size_t e = 0; e < mesh.elements.size(); e += k) {
      for (std::size_t i = 0; i < 3; ++i)
        is_corner[static_cast<std::size_t>(mesh.elements[e + i])] = 1;
    }
    std::vector<Point3> corners;
    for (std::int32_t s = 0; s < (full_ != nullptr ? 1 : cell_.fold); ++s) {
      for (std::size_t i = 0; i < is_corner.size(); ++i) {
        if (is_corner[i] != 0) corners.push_back(turns.rotated(mesh.points[i], s));
      }
    }
    return corners;
  }

  // Names a mid-side node of the cell that is neither at its midpoint nor on an arc.
  [[nodiscard]] std::string mid_node_beside_arcs(const internal::Turns& turns,
                                                 const std::vector<Point3>& arc_middles) const {
    if (cell_.order != 2) return {};
    const PointTree tree(arc_middles);
    for (std::size_t e = 0; e < cell_.element_count(); ++e) {
      const std::int32_t* node = &cell_.elements[6 * e];
      const auto place = [&](std::size_t i) {
        return cell_.points[static_cast<std::size_t>(node[i])];
      };
      for (std::size_t i = 0; i < 3; ++i) {
        const Point3 a = place(i), b = place((i + 1) % 3), m = place(3 + i);
        const double size = distance(a, b);
        if (distance(m, 0.5 * (a + b)) <= kOnArc * size) continue;
        bool on = false;
        for (std::int32_t s = 0; s < cell_.fold && !on; ++s) {
          on = tree.nearest(turns.rotated(m, s)).distance <= kOnArc * size;
        }
        if (!on) return "mid-side node " + std::to_string(node[3 + i]) + " is beside its arc";
      }
    }
    return {};
  }

  // The model's own where it is known: a box round a skew solid is larger than one along its axis.
  [[nodiscard]] double the_diameter(const internal::Turns& turns) const {
    if (model_known_) return examined_.facts.diameter;
    return full_ != nullptr ? internal::diameter(full_->points) : restored_diameter(turns);
  }

  [[nodiscard]] double restored_diameter(const internal::Turns& turns) const {
    if (cell_.fold == 1) return internal::diameter(cell_.points);
    double reach = 0;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Point3& p : cell_.points) {
      const Point3 local = turns.local(p);
      reach = std::max(reach, length(internal::planar(local)));
      low = std::min(low, local.z);
      high = std::max(high, local.z);
    }
    return std::hypot(2 * reach, high - low);
  }

  [[nodiscard]] double magnitude() const {
    const auto size = [](const Point3& p) {
      return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    };
    double largest = size(cell_.axis_origin);
    for (const Point3& p : cell_.points) largest = std::max(largest, size(p));
    return largest;
  }

  [[nodiscard]] bool is_surface() const { return kind_of(*model_) == ModelKind::kSurface; }

  void set_model_tolerance(const internal::Turns& turns) {
    if (cell_.fold > 1) {
      asymmetry_ = internal::model_asymmetry(examined_,
                                             [&](const Point3& p) { return turns.rotated(p, 1); });
    }
    if (options_.model_tolerance_rel) {
      model_tolerance_ = *options_.model_tolerance_rel * diameter_;
    } else if (cell_.shape_tolerance_rel > 0) {
      model_tolerance_ = std::min(cell_.shape_tolerance_rel, kMostShapeToleranceRel) * diameter_;
    } else if (is_surface()) {
      model_tolerance_ = kSurfaceSymmetryToleranceRel * diameter_;
    } else {
      model_tolerance_ = kAsymmetries * asymmetry_;
    }
    // Facets have planes of their own, which their vertices lie in to within the resolution only.
    const double least = plane() ? rounding_ : resolution_of(diameter_, magnitude_);
    model_tolerance_ = std::max(model_tolerance_, least);
    examined_.facts.pinches.tolerance = model_tolerance_;
    auto* planar_model = std::get_if<internal::PlanarModel>(&examined_.geometry);
    if (planar_model != nullptr) planar_model->by_shape = by_shape();
  }

  // A cell that follows the model's outline, in the words of its file, need not have its vertices.
  [[nodiscard]] bool by_shape() const { return cell_.fold > 1 && cell_.shape_tolerance_rel > 0; }

  // Without a model nothing exempts a pinch.
  [[nodiscard]] const ModelPinches& pinches() const { return examined_.facts.pinches; }

  void look_at_full(const FacetedMesh& cell,
                    const internal::CellBounds& bounds,
                    const internal::Turns& turns,
                    const MeshData& mesh) {
    if (!internal::check_fields(mesh, "full", checks_)) return;
    const FacetedMesh full(mesh);
    if (!internal::check_elements(full, "full", apart_, checks_)) return;
    const bool copies =
        internal::check_copies(cell_, mesh, turns, tolerance_, every_region(), checks_);
    if (copies) internal::check_cell_in_full(cell, bounds, full, tolerance_, checks_);
    internal::check_links(full, "full", pinches(), checks_);
    internal::check_hanging_nodes(full, apart_, checks_);
    check_pieces(full);
    check_measure(mesh);
    const std::vector<char> constrained = check_full_model(full);
    internal::tell_delaunay(full, constrained, checks_);
    check_angles(full, constrained);
  }

  // Regions of a model need not be copies of each other, if they were ignored: then they are
  // compared with the model's seeds instead.
  [[nodiscard]] bool every_region() const {
    if (model_ == nullptr) return true;
    if (const auto* pslg = std::get_if<Pslg>(model_)) return pslg->regions.empty();
    const auto* plc = std::get_if<Plc>(model_);
    return plc == nullptr || plc->regions.empty();
  }

  void check_pieces(const FacetedMesh& full) {
    if (!model_known_ || !examined_.facts.pieces) {
      checks_.skip("full.pieces", "needs a model that is enclosed");
      return;
    }
    UnionFind parts(full.mesh.element_count());
    internal::each_inner_facet(full, [&](std::int32_t a, std::int32_t b) { parts.join(a, b); });
    const std::size_t found = parts.class_count(), wanted = *examined_.facts.pieces;
    checks_.add("full.pieces", found == wanted,
                std::to_string(found) + " connected pieces, the model " + std::to_string(wanted));
  }

  void check_measure(const MeshData& full) {
    const double expected = internal::total_measure(cell_) * cell_.fold;
    const double found = internal::total_measure(full);
    // What a layer of one tolerance round the mesh holds.
    const double layer = 4 * diameter_ * (plane() ? 1 : diameter_);
    const double allowed = kExactMeasureRel * expected + tolerance_ * layer;
    checks_.add(plane() ? "full.area" : "full.volume", std::abs(found - expected) <= allowed,
                shown(found) + ", cell times fold " + shown(expected));
    check_model_measure(found);
  }

  void check_model_measure(double found) {
    std::optional<double> wanted = options_.model_measure;
    if (!wanted && model_known_) wanted = examined_.facts.measure;
    if (!wanted) return;
    const bool surface = model_ != nullptr && is_surface();
    // A boundary moved by a distance changes what it encloses by that distance times its size.
    const bool within = options_.model_tolerance_rel || by_shape();
    const double moved = within ? model_tolerance_ : std::max(2 * asymmetry_, rounding_);
    const double allowed = (surface ? kSurfaceMeasureRel : kExactMeasureRel) * std::abs(*wanted) +
                           moved * examined_.facts.boundary_size;
    checks_.add(plane() ? "model.area" : "model.volume", std::abs(found - *wanted) <= allowed,
                shown(found) + ", the model's " + shown(*wanted) + ", off by " +
                    shown(std::abs(found - *wanted)));
  }

  void check_angles(const FacetedMesh& full, const std::vector<char>& constrained) {
    if (!options_.min_angle_deg) return;
    if (!model_known_ || !plane()) {
      checks_.skip("full.min_angle", plane() ? "no model was given" : "the mesh is no planar one");
      return;
    }
    internal::check_angles(full, constrained, {*options_.min_angle_deg, tolerance_}, checks_);
  }

  std::vector<char> check_full_model(const FacetedMesh& full) {
    if (!model_known_) {
      if (model_ == nullptr) checks_.skip("model.boundary", "no model was given");
      return std::vector<char>(full.group_count(), 0);
    }
    return std::visit(
        [&](const auto& model) {
          return internal::check_model(full, model, model_tolerance_, diameter_, checks_);
        },
        examined_.geometry);
  }

  const MeshData& cell_;
  const MeshData* full_;
  const Model* model_;
  std::optional<Model> as_meshed_;
  const VerifyOptions& options_;
  Checks checks_;
  ExaminedModel examined_;
  bool model_known_ = false;
  double diameter_ = 0;
  double magnitude_ = 0;  // largest absolute coordinate
  // Two nodes, or a node and a facet, that are farther from each other may be features of a sound
  // model, however small they are beside it.
  double apart_ = 0;
  double rounding_ = 0;
  double tolerance_ = 0;        // of pairs and copies
  double model_tolerance_ = 0;  // of nodes against the model
  double asymmetry_ = 0;
};

}  // namespace

VerifyReport verify_mesh(const MeshData& cell,
                         const MeshData* full,
                         const Model* model,
                         const VerifyOptions& options) {
  VerifyReport report;
  Verifier(cell, full, model, options, report).run();
  return report;
}

}  // namespace symcell
