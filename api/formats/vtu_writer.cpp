#include <limits>

#include "api/formats/mesh_formats.hpp"
#include "api/formats/vtu_encoder.hpp"

namespace symcell::internal {
namespace {

std::uint8_t vtk_type(const SymmetryCellMesh& cell) {
  if (cell.dimension == 2) return cell.order == 1 ? 5 : 22;
  return cell.order == 1 ? 10 : 24;
}

template <class T>
VtuArray array_of(std::string_view name,
                  std::string_view type,
                  std::uint64_t components,
                  std::int64_t tuples,
                  std::function<void(VtuValues&)> generate) {
  return {
      name, type, sizeof(T), components, static_cast<std::uint64_t>(tuples), std::move(generate)};
}

VtuArray int32_array(std::string_view name, std::int64_t n, std::function<void(VtuValues&)> f) {
  return array_of<std::int32_t>(name, "Int32", 1, n, std::move(f));
}

VtuArray vector_array(std::string_view name, const Point3& v) {
  return array_of<double>(name, "Float64", 3, 1, [v](VtuValues& out) {
    out.put(v.x);
    out.put(v.y);
    out.put(v.z);
  });
}

// Where the arrays of one file begin, by section.
struct Layout {
  std::vector<VtuArray> arrays;
  std::size_t point_data = 0;
  std::size_t cell_data = 0;
  std::size_t points = 0;
  std::size_t cells = 0;
};

// Ids as 32 bits where they fit: half the bytes of the largest array.
template <class Id>
void add_cells(MeshStream& mesh, std::string_view type, Layout& layout) {
  const std::int64_t n = mesh.element_count();
  const auto k = static_cast<std::int64_t>(mesh.nodes_per_element());
  layout.arrays.push_back(array_of<Id>("connectivity", type, 1, n * k, [&mesh](VtuValues& out) {
    mesh.each_element([&](std::span<const std::int64_t> nodes, std::size_t, std::int32_t) {
      for (const std::int64_t node : nodes) out.put(static_cast<Id>(node));
    });
  }));
  layout.arrays.push_back(array_of<Id>("offsets", type, 1, n, [n, k](VtuValues& out) {
    for (std::int64_t i = 1; i <= n; ++i) out.put(static_cast<Id>(i * k));
  }));
}

Layout lay_out(MeshStream& mesh, std::span<const NodeVectors> fields) {
  const SymmetryCellMesh& cell = mesh.cell();
  const std::int64_t nodes = mesh.node_count();
  const std::int64_t elements = mesh.element_count();
  Layout layout;
  auto& arrays = layout.arrays;
  arrays.push_back(int32_array("fold", 1, [&cell](VtuValues& out) { out.put(cell.fold); }));
  arrays.push_back(vector_array("axis_origin", cell.axis_origin));
  arrays.push_back(vector_array("axis_direction", cell.axis_direction));
  if (cell.shape_tolerance_rel > 0) {
    arrays.push_back(array_of<double>("shape_tolerance", "Float64", 1, 1, [&cell](VtuValues& out) {
      out.put(double{cell.shape_tolerance_rel});
    }));
  }
  layout.point_data = arrays.size();
  if (!mesh.full()) {
    arrays.push_back(
        array_of<std::int64_t>("lower_to_higher", "Int64", 1, nodes, [&cell](VtuValues& out) {
          for (const std::int32_t i : cell.lower_to_higher) out.put(std::int64_t{i});
        }));
  }
  arrays.push_back(int32_array("marker", nodes, [&mesh](VtuValues& out) {
    mesh.each_node_marker([&](std::int32_t marker) { out.put(marker); });
  }));
  for (const NodeVectors& field : fields) {
    arrays.push_back(array_of<double>(field.name, "Float64", field.components, nodes,
                                      [&mesh, &field](VtuValues& out) {
                                        mesh.each_node_copy([&](OrbitVertex v) {
                                          const Point3 value = field.value(v);
                                          out.put(value.x);
                                          if (field.components == 1) return;
                                          out.put(value.y);
                                          out.put(value.z);
                                        });
                                      }));
  }
  layout.cell_data = arrays.size();
  arrays.push_back(int32_array("region", elements, [&mesh, &cell](VtuValues& out) {
    mesh.each_element_index([&](std::size_t e, std::int32_t s) { out.put(cell.region(e, s)); });
  }));
  if (mesh.full()) {
    arrays.push_back(int32_array("sector", elements, [&mesh](VtuValues& out) {
      mesh.each_element_index([&](std::size_t, std::int32_t s) { out.put(s); });
    }));
    arrays.push_back(int32_array("cell_element", elements, [&mesh](VtuValues& out) {
      mesh.each_element_index(
          [&](std::size_t e, std::int32_t) { out.put(static_cast<std::int32_t>(e)); });
    }));
  }
  layout.points = arrays.size();
  arrays.push_back(array_of<double>("Points", "Float64", 3, nodes, [&mesh](VtuValues& out) {
    mesh.each_node([&](const Point3& p, std::int32_t) {
      out.put(p.x);
      out.put(p.y);
      out.put(p.z);
    });
  }));
  layout.cells = arrays.size();
  const auto largest =
      static_cast<double>(elements) * static_cast<double>(mesh.nodes_per_element());
  if (largest < std::numeric_limits<std::int32_t>::max()) {
    add_cells<std::int32_t>(mesh, "Int32", layout);
  } else {
    add_cells<std::int64_t>(mesh, "Int64", layout);
  }
  const std::uint8_t type = vtk_type(cell);
  arrays.push_back(
      array_of<std::uint8_t>("types", "UInt8", 1, elements, [elements, type](VtuValues& out) {
        for (std::int64_t i = 0; i < elements; ++i) {
          out.put(type);
        }
      }));
  return layout;
}

void write_section(const VtuEncoder& encoder,
                   std::string_view tag,
                   std::size_t begin,
                   std::size_t end,
                   ByteWriter& out) {
  out.text("<");
  out.text(tag);
  out.text(">\n");
  for (std::size_t i = begin; i < end; ++i) encoder.write_element(out, i, tag == "FieldData");
  out.text("</");
  out.text(tag);
  out.text(">\n");
}

}  // namespace

void write_vtu(MeshStream& mesh,
               VtuEncoding encoding,
               ByteWriter& out,
               std::span<const NodeVectors> fields) {
  Layout layout = lay_out(mesh, fields);
  const std::size_t count = layout.arrays.size();
  const VtuEncoder encoder(encoding, std::move(layout.arrays));
  out.text(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\"");
  if (encoding == VtuEncoding::kAppendedZlib) out.text(" compressor=\"vtkZLibDataCompressor\"");
  out.text(">\n<UnstructuredGrid>\n");
  write_section(encoder, "FieldData", 0, layout.point_data, out);
  out.text("<Piece NumberOfPoints=\"");
  out.integer(mesh.node_count());
  out.text("\" NumberOfCells=\"");
  out.integer(mesh.element_count());
  out.text("\">\n");
  write_section(encoder, "PointData", layout.point_data, layout.cell_data, out);
  write_section(encoder, "CellData", layout.cell_data, layout.points, out);
  write_section(encoder, "Points", layout.points, layout.cells, out);
  write_section(encoder, "Cells", layout.cells, count, out);
  out.text("</Piece>\n</UnstructuredGrid>\n");
  if (encoding != VtuEncoding::kAscii) {
    out.text("<AppendedData encoding=\"raw\">\n_");
    encoder.write_appended(out);
    out.text("\n</AppendedData>\n");
  }
  out.text("</VTKFile>\n");
}

}  // namespace symcell::internal
