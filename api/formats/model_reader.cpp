#include "api/formats/model_reader.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <string>

#include "api/formats/gzip.hpp"
#include "api/formats/poly.hpp"
#include "api/formats/pslg_json.hpp"

namespace symcell {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string_view without_leading_blank(std::string_view bytes) {
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  return begin == std::string_view::npos ? std::string_view() : bytes.substr(begin);
}

// A binary STL says in bytes 80-83 how many triangles of 50 bytes follow.
bool is_binary_stl(std::string_view bytes) {
  if (bytes.size() < 84) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return bytes.size() == 84 + std::uint64_t{50} * count;
}

// What else a file can be that a user may send; nullptr: nothing that is known.
const char* solid_format(std::string_view bytes, std::string_view text) {
  if (is_binary_stl(bytes)) return "a binary STL file";
  const std::string head = lower(text.substr(0, 512));
  if (head.starts_with("solid") && head.find("facet") != std::string::npos) return "an STL file";
  if (head.starts_with("off\n") || head.starts_with("off\r") || head.starts_with("off ")) {
    return "an OFF file";
  }
  if (head.starts_with("ply\n") || head.starts_with("ply\r")) return "a PLY file";
  if (head.starts_with("v ") || head.find("\nv ") != std::string::npos) return "an OBJ file";
  if (head.starts_with("iso-10303")) return "a STEP file";
  return nullptr;
}

tl::unexpected<Error> unknown_format(std::string_view bytes, std::string_view text) {
  if (const char* name = solid_format(bytes, text)) {
    return fail(
        ErrorCode::kUnsupportedModel,
        std::string("this is ") + name +
            ", a solid model; only planar models (PSLG JSON or Triangle .poly) are meshed so "
            "far, solids come later");
  }
  const std::string_view head = text.substr(0, 512);
  if (head.starts_with('<')) {
    return fail(ErrorCode::kUnknownFormat,
                "this is a web page or other XML, not a model; send PSLG JSON or a Triangle .poly");
  }
  return fail(ErrorCode::kUnknownFormat,
              "the format is not known from the first bytes; send PSLG JSON or a Triangle .poly");
}

std::optional<ModelFormat> guess_format(std::string_view bytes, std::string_view text) {
  if (text.starts_with('{') || text.starts_with('[')) return ModelFormat::kPslgJson;
  if (is_binary_stl(bytes)) return std::nullopt;
  const auto first = static_cast<unsigned char>(text.front());
  const std::string_view head = text.substr(0, 512);
  const bool printable = std::ranges::all_of(head, [](char c) {
    const auto u = static_cast<unsigned char>(c);
    return u >= ' ' || u == '\t' || u == '\n' || u == '\r';
  });
  if (printable && (first == '#' || std::isdigit(first) != 0)) {
    // An OBJ file, too, may begin with a comment.
    return solid_format(bytes, text) == nullptr ? std::optional(ModelFormat::kPoly) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::optional<ModelFormat> model_format_from_name(std::string_view file_name) {
  std::string name = lower(file_name);
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  if (name.ends_with(".json")) return ModelFormat::kPslgJson;
  if (name.ends_with(".poly")) return ModelFormat::kPoly;
  return std::nullopt;
}

std::optional<ModelFormat> model_format_from_media_type(std::string_view media_type) {
  std::string type = lower(media_type.substr(0, media_type.find(';')));
  while (!type.empty() && type.back() == ' ') type.pop_back();
  if (type == "application/json" || type.ends_with("+json")) return ModelFormat::kPslgJson;
  if (type == "model/x-triangle-poly" || type == "text/x-poly") return ModelFormat::kPoly;
  return std::nullopt;
}

Result<Pslg> read_model(std::string_view bytes, std::optional<ModelFormat> format) {
  if (is_gzip(bytes)) {
    const Result<std::string> text = gunzip(bytes, kMaxModelBytes);
    if (!text) return tl::unexpected(text.error());
    // Packed twice is no model: the reader below says so.
    if (!is_gzip(*text)) return read_model(*text, format);
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
  const std::optional<ModelFormat> guess = guess_format(bytes, text);
  // A name may be wrong: a solid named .poly is told as what it is.
  if (!guess && (!format || solid_format(bytes, text) != nullptr)) {
    return unknown_format(bytes, text);
  }
  // An opening brace is JSON whatever the name says.
  if (text.starts_with('{')) format = ModelFormat::kPslgJson;
  switch (format.value_or(guess.value_or(ModelFormat::kPslgJson))) {
    case ModelFormat::kPslgJson: return read_pslg_json(bytes);
    case ModelFormat::kPoly: return read_poly(bytes);
  }
  return unknown_format(bytes, text);
}

}  // namespace symcell
