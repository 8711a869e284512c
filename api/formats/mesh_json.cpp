#include <nlohmann/json.hpp>
#include <string>

#include "api/formats/mesh_formats.hpp"

namespace symcell::internal {
namespace {

// Writes the commas of one list.
class Commas {
 public:
  explicit Commas(ByteWriter& out) : out_(&out) {}
  void next() {
    if (!first_) out_->character(',');
    first_ = false;
  }

 private:
  ByteWriter* out_;
  bool first_ = true;
};

void write_point(ByteWriter& out, const Point3& p, int dimension) {
  out.character('[');
  out.real(p.x);
  out.character(',');
  out.real(p.y);
  if (dimension == 3) {
    out.character(',');
    out.real(p.z);
  }
  out.character(']');
}

template <class Id>
void write_ids(ByteWriter& out, std::span<const Id> ids) {
  out.character('[');
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (i > 0) out.character(',');
    out.integer(static_cast<std::int64_t>(ids[i]));
  }
  out.character(']');
}

// Pairs of the bounds as two lists, in the ids of sector 0.
void write_bounds(MeshStream& mesh, ByteWriter& out) {
  const SymmetryCellMesh& cell = mesh.cell();
  const auto table = mesh.node_table(0);
  for (const bool lower : {true, false}) {
    out.text(lower ? ",\n\"lower\":[" : ",\n\"higher\":[");
    Commas commas(out);
    for (std::size_t i = 0; i < cell.lower_to_higher.size(); ++i) {
      const std::int32_t image = cell.lower_to_higher[i];
      if (image < 0) continue;
      commas.next();
      out.integer(table[lower ? i : static_cast<std::size_t>(image)]);
    }
    out.character(']');
  }
}

// Facets of the bounds as lists of nodes, pairwise, in the ids of sector 0.
void write_bound_facets(MeshStream& mesh, ByteWriter& out) {
  const SymmetryCellMesh& cell = mesh.cell();
  const auto table = mesh.node_table(0);
  for (const bool lower : {true, false}) {
    out.text(lower ? ",\n\"lower_facets\":[" : ",\n\"higher_facets\":[");
    const auto& facets = lower ? cell.lower_facets : cell.higher_facets;
    Commas commas(out);
    std::vector<std::int64_t> ids(mesh.nodes_per_facet());
    for (std::size_t i = 0; i < facets.size(); i += ids.size()) {
      for (std::size_t c = 0; c < ids.size(); ++c) {
        ids[c] = table[static_cast<std::size_t>(facets[i + c])];
      }
      commas.next();
      write_ids(out, std::span<const std::int64_t>(ids));
    }
    out.character(']');
  }
}

void write_head(const SymmetryCellMesh& cell, ByteWriter& out) {
  out.text("{\"dimension\":");
  out.integer(cell.dimension);
  out.text(",\"order\":");
  out.integer(cell.order);
  out.text(",\"fold\":");
  out.integer(cell.fold);
  out.text(",\"axis\":{\"origin\":");
  write_point(out, cell.axis_origin, 3);
  out.text(",\"direction\":");
  write_point(out, cell.axis_direction, 3);
  out.character('}');
  if (cell.marker_names.empty()) return;
  out.text(",\n\"marker_names\":");
  nlohmann::ordered_json names;
  for (const MarkerName& n : cell.marker_names) names[std::to_string(n.marker)] = n.name;
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;  // what is no UTF-8
  out.text(names.dump(-1, ' ', false, kReplace));
}

// Per-element integers.
template <class F>
void write_per_element(const MeshStream& mesh, std::string_view name, ByteWriter& out, F value) {
  out.text(",\n\"");
  out.text(name);
  out.text("\":[");
  Commas commas(out);
  mesh.each_element_index([&](std::size_t e, std::int32_t s) {
    commas.next();
    out.integer(static_cast<std::int64_t>(value(e, s)));
  });
  out.character(']');
}

}  // namespace

void write_json_mesh(MeshStream& mesh, ByteWriter& out) {
  const SymmetryCellMesh& cell = mesh.cell();
  write_head(cell, out);
  out.text(",\n\"nodes\":[");
  Commas nodes(out);
  mesh.each_node([&](const Point3& p, std::int32_t) {
    nodes.next();
    write_point(out, p, cell.dimension);
  });
  out.text("],\n\"elements\":[");
  Commas elements(out);
  mesh.each_element([&](std::span<const std::int64_t> ids, std::size_t, std::int32_t) {
    elements.next();
    write_ids(out, ids);
  });
  out.character(']');
  write_per_element(mesh, "regions", out,
                    [&](std::size_t e, std::int32_t s) { return cell.region(e, s); });
  out.text(",\n\"markers\":[");
  Commas markers(out);
  mesh.each_node_marker([&](std::int32_t marker) {
    markers.next();
    out.integer(marker);
  });
  out.text("],\n\"boundary\":[");
  Commas facets(out);
  mesh.each_facet([&](std::span<const std::int64_t> ids, std::int32_t marker) {
    facets.next();
    out.text("{\"nodes\":");
    write_ids(out, ids);
    out.text(",\"marker\":");
    out.integer(marker);
    out.character('}');
  });
  out.character(']');
  write_bounds(mesh, out);
  write_bound_facets(mesh, out);
  if (mesh.full()) {
    write_per_element(mesh, "sector", out, [](std::size_t, std::int32_t s) { return s; });
    write_per_element(mesh, "cell_element", out, [](std::size_t e, std::int32_t) { return e; });
  }
  out.text("}\n");
}

}  // namespace symcell::internal
