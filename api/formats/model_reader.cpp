#include "api/formats/model_reader.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <utility>

#include "api/formats/byte_order_mark.hpp"
#include "api/formats/cad.hpp"
#include "api/formats/dxf.hpp"
#include "api/formats/dxf_scan.hpp"
#include "api/formats/fem.hpp"
#include "api/formats/gzip.hpp"
#include "api/formats/obj.hpp"
#include "api/formats/off.hpp"
#include "api/formats/plc_json.hpp"
#include "api/formats/ply.hpp"
#include "api/formats/poly.hpp"
#include "api/formats/pslg_json.hpp"
#include "api/formats/stl.hpp"
#include "api/formats/tetgen_poly.hpp"

namespace symcell {
namespace {

constexpr const char* kKnown =
    "send JSON (a planar or a solid model), DXF, FEMM's .fem, .poly, .smesh, STEP, IGES, STL, OFF, "
    "PLY "
    "or OBJ";

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string_view without_leading_blank(std::string_view bytes) {
  bytes = without_byte_order_mark(bytes);
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  return begin == std::string_view::npos ? std::string_view() : bytes.substr(begin);
}

// Formats whose first bytes are plain: they count whatever a name says.
std::optional<ModelFormat> plain_format(std::string_view bytes, std::string_view text) {
  // First: after a head of blanks the count of triangles may look like a brace.
  if (has_size_of_binary_stl(bytes)) return ModelFormat::kStl;
  if (text.starts_with('{')) {
    return json_model_kind(bytes) == ModelKind::kPlc ? ModelFormat::kPlcJson
                                                     : ModelFormat::kPslgJson;
  }
  const std::string head = lower(text.substr(0, 512));
  if (head.starts_with("ply\n") || head.starts_with("ply\r")) return ModelFormat::kPly;
  if (head.starts_with("solid") && head.find("facet") != std::string::npos) {
    return ModelFormat::kStl;
  }
  if (is_off_keyword(text.substr(0, text.find_first_of(" \t\r\n")))) return ModelFormat::kOff;
  if (looks_like_step(bytes)) return ModelFormat::kStep;
  if (looks_like_iges(bytes)) return ModelFormat::kIges;
  if (looks_like_dxf(bytes)) return ModelFormat::kDxf;
  if (looks_like_fem(bytes)) return ModelFormat::kFem;
  if (looks_like_binary_stl(bytes)) return ModelFormat::kStl;
  return std::nullopt;
}

// From the content alone, where nothing is plain and no name helps.
std::optional<ModelFormat> guessed_format(std::string_view text) {
  if (text.starts_with('[')) return ModelFormat::kPslgJson;
  const std::string head = lower(text.substr(0, 512));
  if (head.starts_with("solid")) return ModelFormat::kStl;
  const bool printable = std::ranges::all_of(head, [](char c) {
    const auto u = static_cast<unsigned char>(c);
    return u >= ' ' || u == '\t' || u == '\n' || u == '\r';
  });
  if (!printable) return std::nullopt;
  // An OBJ file, too, may begin with a comment.
  if (head.starts_with("v ") || head.find("\nv ") != std::string::npos) return ModelFormat::kObj;
  const auto first = static_cast<unsigned char>(text.front());
  if (first == '#' || std::isdigit(first) != 0) return ModelFormat::kPoly;
  return std::nullopt;
}

// Formats that are known and not read, by how their files begin.
constexpr std::array kNotRead{
    std::pair{"iso-10303",
              "this is a STEP file in another form than ISO 10303-21; export it as that"},
    std::pair{"ac10", "this is a DWG file; save it as an ASCII DXF from the CAD program"},
    std::pair{"$meshformat",
              "this is a Gmsh mesh, not a model; export the geometry as STEP, STL or DXF"},
    std::pair{"<svg", "this is an SVG picture; convert its paths to DXF"},
    std::pair{"dbrep_drawable", "this is a BREP file; export a solid as STEP, a drawing as DXF"},
    std::pair{"%pdf", "this is a PDF file; export the drawing as DXF"},
};

Failure unknown_format(std::string_view text) {
  const std::string head = lower(text.substr(0, 80));
  for (const auto& [begin, what] : kNotRead) {
    if (!head.starts_with(begin)) continue;
    return fail(ErrorCode::kUnsupportedModel, std::string(what) + "; " + kKnown);
  }
  if (head.starts_with("pk\3\4")) {
    return fail(
        ErrorCode::kUnknownFormat,
        "this is a ZIP archive (a 3MF file is one, too); unpack it, or export as STEP or STL");
  }
  const char* what = head.starts_with('<') ? "this is a web page or other XML, not a model; "
                                           : "the format is not known from the first bytes; ";
  return fail(ErrorCode::kUnknownFormat, std::string(what) + kKnown);
}

template <class Read>
Result<Model> widened(Result<Read> model) {
  if (!model) return error_of(model);
  return Model(std::move(*model));
}

Result<Model> read_as_cad(CadFormat format, std::string_view bytes, const ReadOptions& options) {
  ExecutionContext no_limits;  // but those of the child that reads
  return widened(read_cad(bytes, format, options.cad_chord_error_rel, no_limits));
}

Result<Model> read_as(ModelFormat format, std::string_view bytes, const ReadOptions& options) {
  switch (format) {
    case ModelFormat::kPslgJson: return widened(read_pslg_json(bytes));
    case ModelFormat::kPlcJson: return widened(read_plc_json(bytes));
    case ModelFormat::kPoly: return widened(read_poly(bytes));
    case ModelFormat::kTetgenPoly: return widened(read_tetgen(bytes, TetgenForm::kPoly));
    case ModelFormat::kSmesh: return widened(read_tetgen(bytes, TetgenForm::kSmesh));
    case ModelFormat::kStl: return widened(read_stl(bytes));
    case ModelFormat::kOff: return widened(read_off(bytes));
    case ModelFormat::kPly: return widened(read_ply(bytes));
    case ModelFormat::kObj: return widened(read_obj(bytes));
    case ModelFormat::kDxf: return widened(read_dxf(bytes));
    case ModelFormat::kFem: return widened(read_fem(bytes));
    case ModelFormat::kStep: return read_as_cad(CadFormat::kStep, bytes, options);
    case ModelFormat::kIges: return read_as_cad(CadFormat::kIges, bytes, options);
  }
  return fail(ErrorCode::kUnknownFormat, kKnown);
}

}  // namespace

ReadOptions reading_for(const MeshOptions& options) {
  ReadOptions reading;
  if (options.chord_error_given) {
    reading.cad_chord_error_rel = std::min(reading.cad_chord_error_rel, options.chord_error_rel);
  }
  return reading;
}

Result<Model> read_model(std::string_view bytes,
                         std::optional<ModelFormat> format,
                         ModelFormat* recognised,
                         const ReadOptions& options) {
  if (is_gzip(bytes)) {
    const Result<std::string> text = gunzip(bytes, kMaxModelBytes);
    if (!text) return error_of(text);
    // Packed twice is no model: the reader below says so.
    if (!is_gzip(*text)) return read_model(*text, format, recognised, options);
  }
  if (bytes.size() > kMaxModelBytes) {
    return fail(ErrorCode::kTooLarge, "the model has " + std::to_string(bytes.size()) +
                                          " bytes; at most " + std::to_string(kMaxModelBytes) +
                                          " are taken");
  }
  const std::string_view text = without_leading_blank(bytes);
  if (text.empty()) {
    return fail(ErrorCode::kEmptyFile, "the model is empty (" + std::to_string(bytes.size()) +
                                           " bytes); was the file written completely?");
  }
  if (text.starts_with('<') && !has_size_of_binary_stl(bytes)) return unknown_format(text);
  std::optional<ModelFormat> found = plain_format(bytes, text);
  if (!found) found = format;
  if (!found) found = guessed_format(text);
  if (!found) return unknown_format(text);
  const bool poly = *found == ModelFormat::kPoly || *found == ModelFormat::kTetgenPoly;
  if (const auto dimension = poly ? poly_dimension(bytes) : std::nullopt) {
    found = *dimension == 3 ? ModelFormat::kTetgenPoly : ModelFormat::kPoly;
  }
  auto model = read_as(*found, bytes, options);
  // Nothing but the sense they make distinguishes TetGen's two forms.
  if (!model && !format && *found == ModelFormat::kTetgenPoly) {
    if (auto other = read_as(ModelFormat::kSmesh, bytes, options)) {
      found = ModelFormat::kSmesh;
      model = std::move(other);
    }
  }
  if (recognised != nullptr) *recognised = *found;
  return model;
}

}  // namespace symcell
