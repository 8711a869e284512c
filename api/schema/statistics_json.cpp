#include "api/schema/statistics_json.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include "api/schema/options.hpp"
#include "api/version.hpp"

namespace symcell {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json point(const Point3& p) {
  return Json::array({number(p.x), number(p.y), number(p.z)});
}

Json point(const Point2& p) {
  return Json::array({number(p.x), number(p.y)});
}

Json axis_to_json(const Point3& origin, const Point3& direction) {
  return {{"origin", point(origin)}, {"direction", point(direction)}};
}

Json cell_to_json(const Statistics::Cell& cell, bool planar) {
  return {{"elements", cell.elements},
          {"nodes", cell.nodes},
          {"symmetry_nodes", cell.symmetry_nodes},
          {"symmetry_facets", cell.symmetry_facets},
          {planar ? "area" : "volume", number(cell.measure)},
          {"min_angle_deg", number(cell.min_angle_deg)},
          {"max_angle_deg", number(cell.max_angle_deg)},
          {"max_radius_edge", number(cell.max_radius_edge)},
          {"min_dihedral_deg", planar ? Json(nullptr) : number(cell.min_dihedral_deg)},
          {"max_dihedral_deg", planar ? Json(nullptr) : number(cell.max_dihedral_deg)},
          {"aspect_ratio_histogram", cell.aspect_ratio_histogram}};
}

Json timings_to_json(const Statistics::TimingsMs& t) {
  return {{"parse", number(t.parse)},     {"symmetry", number(t.symmetry)},
          {"initial", number(t.initial)}, {"refine", number(t.refine)},
          {"cell", number(t.cell)},       {"check", number(t.check)},
          {"restore", number(t.restore)}, {"write", number(t.write)},
          {"total", number(t.total)}};
}

Json folds_to_json(const std::vector<FoldCandidate>& folds) {
  Json json = Json::array();
  for (const FoldCandidate& rung : folds) {
    json.push_back({{"fold", rung.fold},
                    {"error", number(rung.error_rel)},
                    {"accepted", rung.accepted},
                    {"worst", rung.worst ? point(*rung.worst) : Json(nullptr)}});
  }
  return json;
}

// "#rrggbb"
std::string hex_colour(std::int32_t rgb) {
  std::string text = "#000000";
  for (std::size_t i = text.size() - 1; i > 0; --i, rgb /= 16)
    text[i] = "0123456789abcdef"[rgb % 16];
  return text;
}

// Null: what a face of its kind has not.
Json groups_to_json(const std::vector<FaceGroup>& groups) {
  const auto maybe = [](const auto& value) { return value ? Json(*value) : Json(nullptr); };
  const auto place = [](const std::optional<Point3>& p) { return p ? point(*p) : Json(nullptr); };
  Json json = Json::array();
  for (const FaceGroup& g : groups) {
    json.push_back({{"marker", g.marker},
                    {"name", g.name},
                    {"kind", face_kind_name(g.kind)},
                    {"faces", g.faces},
                    {"area", number(g.area)},
                    {"centroid", point(g.centroid)},
                    {"point", point(g.point)},
                    {"normal", place(g.normal)},
                    {"axis", g.axis_origin ? Json{{"origin", point(*g.axis_origin)},
                                                  {"direction", place(g.axis_direction)}}
                                           : Json(nullptr)},
                    {"radius", maybe(g.radius)},
                    {"tube_radius", maybe(g.tube_radius)},
                    {"half_angle_deg", maybe(g.half_angle_deg)},
                    {"concave", g.concave}});
    if (g.colour >= 0) json.back()["color"] = hex_colour(g.colour);
  }
  return json;
}

Json inspected(const PslgInspection& inspection) {
  Json json;
  json["type"] = "pslg";
  json["dimension"] = 2;
  json["fold"] = inspection.fold;
  json["geometry_fold"] = inspection.geometry_fold;
  json["axis"] = axis_to_json({inspection.centre.x, inspection.centre.y, 0}, {0, 0, 1});
  json["symmetry_error"] = number(inspection.symmetry_error_rel);
  json["watertight"] = nullptr;  // of solids
  json["area"] = number(inspection.area);
  json["diameter"] = number(inspection.diameter);
  json["bounding_box"] = {{"min", point(inspection.bbox_min)}, {"max", point(inspection.bbox_max)}};
  json["vertices"] = inspection.vertices;
  json["segments"] = inspection.segments;
  json["holes"] = inspection.holes;
  json["regions"] = inspection.regions;
  json["components"] = inspection.components;
  json["min_input_angle_deg"] = number(inspection.min_input_angle_deg);
  json["folds"] = folds_to_json(inspection.folds);
  json["warnings"] = warnings_to_json(inspection.warnings);
  json["version"] = version();
  return json;
}

// Null: what the kind of model has not, or what meshing alone would find.
Json inspected(const SolidInspection& inspection) {
  const bool surface = inspection.kind == "surface";
  Json json;
  json["type"] = inspection.kind;
  json["dimension"] = 3;
  json["fold"] = inspection.fold;
  json["axis"] = axis_to_json(inspection.axis_origin, inspection.axis_direction);
  json["symmetry_error"] = number(inspection.symmetry_error_rel);
  json["watertight"] = inspection.watertight;
  json["volume"] = inspection.volume > 0 ? number(inspection.volume) : Json(nullptr);
  json["surface_area"] = surface ? number(inspection.surface_area) : Json(nullptr);
  json["diameter"] = number(inspection.diameter);
  json["bounding_box"] = {{"min", point(inspection.bbox_min)}, {"max", point(inspection.bbox_max)}};
  json["vertices"] = inspection.vertices;
  json[surface ? "triangles" : "facets"] = inspection.facets;
  if (surface) {
    json["shells"] = inspection.shells;
  } else {
    json["holes"] = inspection.holes;
    json["regions"] = inspection.regions;
  }
  json["repairs"] = inspection.repairs;
  if (surface) json["groups"] = groups_to_json(inspection.groups);
  json["folds"] = folds_to_json(inspection.folds);
  json["warnings"] = warnings_to_json(inspection.warnings);
  json["problem"] = inspection.problem.empty() ? Json(nullptr) : Json(inspection.problem);
  json["version"] = version();
  return json;
}

Json estimates_to_json(const std::vector<FoldEstimate>& candidates) {
  Json json = Json::array();
  for (const FoldEstimate& c : candidates) {
    json.push_back(
        {{"fold", c.fold}, {"elements", std::llround(c.elements)}, {"meshed", c.meshed}});
  }
  return json;
}

}  // namespace

Json warnings_to_json(const std::vector<Warning>& warnings) {
  Json json = Json::array();
  for (const Warning& warning : warnings) {
    Json entry = {{"code", warning_code_name(warning.code)},
                  {"detail", warning.text},
                  {"mend", warning.mend}};
    if (warning.near_fold) {
      entry["fold"] = warning.near_fold->fold;
      entry["error_rel"] = number(warning.near_fold->error_rel);
      entry["tolerance"] = number(warning.near_fold->tolerance_rel);
    }
    json.push_back(std::move(entry));
  }
  return json;
}

Json statistics_to_json(const Statistics& statistics, const MeshOptions& options, ModelKind kind) {
  const Statistics::Symmetry& symmetry = statistics.symmetry;
  const Statistics::Refinement& refinement = statistics.refinement;
  Json json;
  json["cell"] = cell_to_json(statistics.cell, is_planar(kind));
  json["full"] = {{"elements", statistics.full.elements}, {"nodes", statistics.full.nodes}};
  json["symmetry"] = {{"fold", symmetry.fold},
                      {"axis", axis_to_json(symmetry.axis_origin, symmetry.axis_direction)},
                      {"error", number(symmetry.error_rel)},
                      {"detected", symmetry.detected}};
  if (symmetry.antiperiodic) json["symmetry"]["antiperiodic"] = true;
  if (!symmetry.candidates.empty()) {
    json["symmetry"]["candidates"] = estimates_to_json(symmetry.candidates);
  }
  json["refinement"] = {{"steiner_points", refinement.steiner_points},
                        {"splits", refinement.splits},
                        {"flips", refinement.flips},
                        {"crossings", refinement.crossings},
                        {"relocations", refinement.relocations},
                        {"removed", refinement.removed}};
  json["exempt"] = Json::array();
  for (const ExemptCount& exempt : statistics.exempt) {
    json["exempt"].push_back({{"reason", exempt.reason}, {"elements", exempt.elements}});
  }
  if (const Statistics::Target& target = statistics.target; target.elements > 0) {
    json["target"] = {{"elements", target.elements},
                      {"max_edge", target.max_edge > 0 ? Json(target.max_edge) : Json(nullptr)},
                      {"meshes", target.meshes}};
  }
  if (const std::optional<Curving>& c = statistics.curving) {
    json["curved"] = {{"faces", c->faces},
                      {"other_faces", c->other_faces},
                      {"vertices", c->vertices},
                      {"left", c->left},
                      {"sides", c->sides},
                      {"straightened", c->straightened},
                      {"farthest", number(c->farthest)}};
  }
  json["warnings"] = warnings_to_json(statistics.warnings);
  if (!is_planar(kind)) {
    json["delaunay"] = statistics.delaunay;
    json["repairs"] = statistics.repairs;
  }
  json["timings_ms"] = timings_to_json(statistics.timings_ms);
  json["peak_memory_bytes"] = statistics.peak_memory_bytes;
  json["settings"] = options_to_json(options, kind);
  json["version"] = version();
  return json;
}

Json inspection_to_json(const Inspection& inspection) {
  return std::visit([](const auto& found) { return inspected(found); }, inspection);
}

}  // namespace symcell
