#include "api/formats/vtu_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>

#include "api/formats/text_numbers.hpp"
#include "api/formats/vtu_arrays.hpp"
#include "api/printable.hpp"

namespace symcell {
namespace {

using internal::VtuArrays;

constexpr std::int64_t kMostNodes = std::numeric_limits<std::int32_t>::max();

struct ElementKind {
  std::int64_t vtk_type;
  std::int32_t dimension;
  std::int32_t order;
  std::int32_t nodes;
};

constexpr ElementKind kKinds[] = {{5, 2, 1, 3}, {22, 2, 2, 6}, {10, 3, 1, 4}, {24, 3, 2, 10}};

pugi::xml_node find_array(const pugi::xml_node& group, const char* name) {
  return group.find_child_by_attribute("DataArray", "Name", name);
}

class VtuReader {
 public:
  VtuReader(const pugi::xml_node& grid, const VtuArrays& arrays) : grid_(grid), arrays_(arrays) {}

  Result<MeshData> read() {
    auto done = read_counts();
    if (done) done = read_fields();
    if (done) done = read_points();
    if (done) done = read_cells();
    if (done) done = read_attributes();
    if (!done) return error_of(done);
    return std::move(mesh_);
  }

 private:
  Result<void> read_counts() {
    piece_ = grid_.child("Piece");
    if (!piece_) return fail(ErrorCode::kMissingField, "the file has no Piece");
    if (piece_.next_sibling("Piece")) {
      return fail(ErrorCode::kUnknownFormat, "the file has more than one Piece; merge them");
    }
    const auto nodes = parse_integer(piece_.attribute("NumberOfPoints").as_string());
    const auto elements = parse_integer(piece_.attribute("NumberOfCells").as_string());
    if (!nodes || !elements || *nodes < 0 || *elements < 0) {
      return fail(ErrorCode::kSyntax, "NumberOfPoints or NumberOfCells is no count");
    }
    if (*nodes > kMostNodes || *elements > kMostNodes / 4) {
      return fail(ErrorCode::kTooLarge, "the mesh has more nodes or elements than can be checked");
    }
    nodes_ = static_cast<std::uint64_t>(*nodes);
    elements_ = static_cast<std::uint64_t>(*elements);
    return {};
  }

  Result<void> read_fields() {
    const auto group = grid_.child("FieldData");
    const auto fold = arrays_.integers(find_array(group, "fold"), 1);
    if (!fold) return missing(fold.error(), "FieldData fold");
    if (fold->front() < 1 || fold->front() > std::numeric_limits<std::int32_t>::max()) {
      return fail(ErrorCode::kBadFold, "the fold " + std::to_string(fold->front()) + " is no fold");
    }
    mesh_.fold = static_cast<std::int32_t>(fold->front());
    for (const auto& [name, target] : {std::pair{"axis_origin", &mesh_.axis_origin},
                                       std::pair{"axis_direction", &mesh_.axis_direction}}) {
      const auto values = arrays_.reals(find_array(group, name), 3);
      if (!values) return missing(values.error(), std::string("FieldData ") + name);
      *target = {(*values)[0], (*values)[1], (*values)[2]};
    }
    if (const auto array = find_array(group, "shape_tolerance")) {
      const auto value = arrays_.reals(array, 1);
      if (!value) return error_of(value);
      mesh_.shape_tolerance_rel = value->front();
    }
    return {};
  }

  // Tells which array it was, if it was not there at all.
  static Failure missing(Error error, const std::string& name) {
    if (error.code == ErrorCode::kMissingField) error.message = name + " is missing";
    return fail(std::move(error));
  }

  Result<void> read_points() {
    const auto array = piece_.child("Points").child("DataArray");
    const auto values = arrays_.reals(array, nodes_ * 3);
    if (!values) return missing(values.error(), "Points");
    mesh_.single_precision = std::string_view(array.attribute("type").as_string()) != "Float64";
    mesh_.points.resize(static_cast<std::size_t>(nodes_));
    for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
      mesh_.points[i] = {(*values)[3 * i], (*values)[3 * i + 1], (*values)[3 * i + 2]};
      const Point3& p = mesh_.points[i];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
        return fail(ErrorCode::kNonFinite, "node " + std::to_string(i) + " is not finite");
      }
    }
    return {};
  }

  Result<void> read_cells() {
    const auto group = piece_.child("Cells");
    const auto types = arrays_.integers(find_array(group, "types"), elements_);
    if (!types) return missing(types.error(), "Cells types");
    const std::int64_t type = types->empty() ? 5 : types->front();
    const auto* kind = std::ranges::find(kKinds, type, &ElementKind::vtk_type);
    const bool uniform = std::ranges::all_of(*types, [&](std::int64_t t) { return t == type; });
    if (kind == std::end(kKinds) || !uniform) {
      return fail(ErrorCode::kUnsupportedModel,
                  "elements must all be of one of the types 5, 22, 10, 24");
    }
    mesh_.dimension = kind->dimension;
    mesh_.order = kind->order;
    mesh_.nodes_per_element = kind->nodes;
    const auto k = static_cast<std::uint64_t>(kind->nodes);
    const auto offsets = arrays_.integers(find_array(group, "offsets"), elements_);
    if (!offsets) return missing(offsets.error(), "Cells offsets");
    for (std::size_t e = 0; e < offsets->size(); ++e) {
      if ((*offsets)[e] != static_cast<std::int64_t>((e + 1) * k)) {
        return fail(ErrorCode::kCountMismatch, "offset " + std::to_string(e) + " does not fit " +
                                                   std::to_string(k) + " nodes an element");
      }
    }
    const auto nodes = arrays_.integers(find_array(group, "connectivity"), elements_ * k);
    if (!nodes) return missing(nodes.error(), "Cells connectivity");
    mesh_.elements.resize(nodes->size());
    for (std::size_t i = 0; i < nodes->size(); ++i) {
      const std::int64_t node = (*nodes)[i];
      if (node < 0 || static_cast<std::uint64_t>(node) >= nodes_) {
        return fail(ErrorCode::kIndexOutOfRange, "element " + std::to_string(i / k) +
                                                     " names node " + std::to_string(node) +
                                                     ", which does not exist");
      }
      mesh_.elements[i] = static_cast<std::int32_t>(node);
    }
    return {};
  }

  // Optional arrays of small integers; empty if the file lacks them.
  Result<void> read_into(const char* group,
                         const char* name,
                         std::uint64_t count,
                         std::vector<std::int32_t>& target) {
    const auto array = find_array(piece_.child(group), name);
    if (!array) return {};
    const auto values = arrays_.integers(array, count);
    if (!values) return error_of(values);
    target.resize(values->size());
    for (std::size_t i = 0; i < target.size(); ++i) {
      const std::int64_t value = (*values)[i];
      if (value != static_cast<std::int32_t>(value)) {
        return fail(ErrorCode::kIndexOutOfRange,
                    std::string(name) + " " + std::to_string(i) + " does not fit 32 bits");
      }
      target[i] = static_cast<std::int32_t>(value);
    }
    return {};
  }

  Result<void> read_attributes() {
    auto done = read_into("PointData", "lower_to_higher", nodes_, mesh_.lower_to_higher);
    if (done) done = read_into("PointData", "marker", nodes_, mesh_.markers);
    if (done) done = read_into("CellData", "region", elements_, mesh_.regions);
    if (done) done = read_into("CellData", "sector", elements_, mesh_.sectors);
    if (done) done = read_into("CellData", "cell_element", elements_, mesh_.cell_elements);
    if (done && mesh_.regions.empty() && elements_ > 0) {
      return fail(ErrorCode::kMissingField, "CellData region is missing");
    }
    return done;
  }

  pugi::xml_node grid_;
  const VtuArrays& arrays_;
  pugi::xml_node piece_;
  std::uint64_t nodes_ = 0;
  std::uint64_t elements_ = 0;
  MeshData mesh_;
};

// An open file: what points into what.
struct OpenVtu {
  std::string head;
  pugi::xml_document document;
  pugi::xml_node grid;
  std::optional<VtuArrays> arrays;
};

// `file`: must stay where it is.
Result<void> open_vtu(std::string_view bytes, OpenVtu& file) {
  if (bytes.empty()) return fail(ErrorCode::kEmptyFile, "the mesh file is empty");
  // The appended section is no XML: it is cut out before parsing.
  const std::size_t cut = bytes.find("<AppendedData");
  std::string& head = file.head;
  head = bytes.substr(0, cut);
  std::string_view appended;
  if (cut != std::string_view::npos) {
    head += "</VTKFile>";
    const std::size_t open_end = bytes.find('>', cut);
    const std::size_t begin = bytes.find('_', open_end);
    if (open_end == std::string_view::npos || begin == std::string_view::npos) {
      return fail(ErrorCode::kTruncated, "the appended data are cut off");
    }
    if (bytes.substr(cut, open_end - cut).find("\"raw\"") == std::string_view::npos) {
      return fail(ErrorCode::kUnknownFormat, "appended data are read in raw encoding only");
    }
    constexpr std::string_view kClosing = "</AppendedData>";
    const std::size_t end = bytes.rfind(kClosing);
    if (end == std::string_view::npos || end < begin ||
        bytes.find("</VTKFile>", end + kClosing.size()) == std::string_view::npos) {
      return fail(ErrorCode::kTruncated, "the appended data do not end; is the file complete?");
    }
    appended = bytes.substr(begin + 1, end - begin - 1);
  }
  const pugi::xml_parse_result parsed = file.document.load_buffer_inplace(
      head.data(), head.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!parsed) {
    const std::string_view start = bytes.substr(0, 512);
    const bool vtu = start.find("VTKFile") != std::string_view::npos;
    return fail(vtu ? ErrorCode::kSyntax : ErrorCode::kUnknownFormat,
                std::string("not a VTU file: ") + parsed.description() + " at byte " +
                    std::to_string(parsed.offset));
  }
  const pugi::xml_node root = file.document.child("VTKFile");
  const pugi::xml_node grid = root.child("UnstructuredGrid");
  if (std::string_view(root.attribute("type").as_string()) != "UnstructuredGrid" || !grid) {
    return fail(ErrorCode::kUnknownFormat, "not a VTKFile of type UnstructuredGrid");
  }
  Result<VtuArrays> arrays = VtuArrays::open(root, appended);
  if (!arrays) return error_of(arrays);
  file.grid = grid;
  file.arrays = *arrays;
  return {};
}

}  // namespace

Result<MeshData> read_vtu(std::string_view bytes) {
  OpenVtu file;
  SYMCELL_TRY(open_vtu(bytes, file));
  return VtuReader(file.grid, *file.arrays).read();
}

Result<std::vector<Point3>> read_vtu_vectors(std::string_view bytes, const std::string& name) {
  OpenVtu file;
  SYMCELL_TRY(open_vtu(bytes, file));
  const pugi::xml_node piece = file.grid.child("Piece");
  std::string others;
  for (const pugi::xml_node array : piece.child("PointData").children("DataArray")) {
    const std::string own = array.attribute("Name").as_string();
    others += (others.empty() ? "" : ", ") + printable(own);
    if (own != name) continue;
    if (array.attribute("NumberOfComponents").as_int(1) != 3) {
      return fail(ErrorCode::kCountMismatch,
                  "the array " + printable(name) + " has not three components");
    }
    const std::uint64_t nodes = piece.attribute("NumberOfPoints").as_ullong();
    // No count of the file is believed beyond what its bytes can hold.
    if (nodes > bytes.size())
      return fail(ErrorCode::kTruncated, "more points than the file can hold");
    const auto values = file.arrays->reals(array, 3 * nodes);
    if (!values) return error_of(values);
    std::vector<Point3> vectors(static_cast<std::size_t>(nodes));
    for (std::size_t i = 0; i < vectors.size(); ++i) {
      vectors[i] = {(*values)[3 * i], (*values)[3 * i + 1], (*values)[3 * i + 2]};
      if (std::isfinite(vectors[i].x) && std::isfinite(vectors[i].y) &&
          std::isfinite(vectors[i].z)) {
        continue;
      }
      return fail(ErrorCode::kNonFinite,
                  "node " + std::to_string(i) + " has no finite vector in " + printable(name));
    }
    return vectors;
  }
  return fail(ErrorCode::kMissingField, "the file has no point data " + printable(name) +
                                            (others.empty() ? "" : "; it has " + others));
}

}  // namespace symcell
