#include "api/formats/ply_header.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"

namespace symcell::internal {
namespace {

// No real header comes near it.
constexpr std::size_t kMostProperties = 10'000;

constexpr std::array kScalars{
    std::pair{"char", PlyScalar::kInt8},      std::pair{"int8", PlyScalar::kInt8},
    std::pair{"uchar", PlyScalar::kUint8},    std::pair{"uint8", PlyScalar::kUint8},
    std::pair{"short", PlyScalar::kInt16},    std::pair{"int16", PlyScalar::kInt16},
    std::pair{"ushort", PlyScalar::kUint16},  std::pair{"uint16", PlyScalar::kUint16},
    std::pair{"int", PlyScalar::kInt32},      std::pair{"int32", PlyScalar::kInt32},
    std::pair{"uint", PlyScalar::kUint32},    std::pair{"uint32", PlyScalar::kUint32},
    std::pair{"float", PlyScalar::kFloat32},  std::pair{"float32", PlyScalar::kFloat32},
    std::pair{"double", PlyScalar::kFloat64}, std::pair{"float64", PlyScalar::kFloat64}};

std::optional<PlyScalar> scalar_of(std::string_view word) {
  const auto* found =
      std::ranges::find_if(kScalars, [&](const auto& s) { return word == s.first; });
  if (found == kScalars.end()) return std::nullopt;
  return found->second;
}

bool is_whole(PlyScalar type) {
  return type != PlyScalar::kFloat32 && type != PlyScalar::kFloat64;
}

// The words of one line; the further ones of a long line are of no interest.
std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::size_t kMostWords = 8;
  std::vector<std::string_view> words;
  while (words.size() < kMostWords) {
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) break;
    const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
  return words;
}

class HeaderReader {
 public:
  explicit HeaderReader(std::string_view bytes) : rest_(bytes) {}

  Result<PlyHeader> read() {
    std::vector<std::string_view> words;
    while (next_line(words)) {
      if (words.empty()) continue;
      if (words[0] == "end_header") {
        if (!encoding_known_) return complain(ErrorCode::kSyntax, "the header has no format line");
        header_.lines = line_;
        header_.body = rest_;
        return std::move(header_);
      }
      SYMCELL_TRY(take(words));
    }
    return complain(ErrorCode::kTruncated, "the file ends before \"end_header\"");
  }

 private:
  // A line ends with \n, \r\n or, on old systems, \r.
  bool next_line(std::vector<std::string_view>& words) {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    words = words_of(rest_.substr(0, end));
    const bool both = rest_.substr(end).starts_with("\r\n");
    rest_.remove_prefix(std::min(end + (both ? 2 : 1), rest_.size()));
    ++line_;
    return true;
  }

  [[nodiscard]] Failure complain(ErrorCode code, const std::string& what) const {
    return fail(code, "line " + std::to_string(line_) + ": " + what);
  }
  [[nodiscard]] Failure not_understood(const std::vector<std::string_view>& words) const {
    return complain(ErrorCode::kSyntax, "a line that begins with \"" + printable(words[0]) +
                                            "\" is not understood in the header of a PLY file");
  }

  Result<void> take(const std::vector<std::string_view>& words) {
    if (words[0] == "ply" || words[0] == "comment" || words[0] == "obj_info") return {};
    if (words[0] == "format" && words.size() > 1) return take_format(words[1]);
    if (words[0] == "element" && words.size() > 2) return take_element(words);
    if (words[0] == "property" && words.size() > 2) return take_property(words);
    return not_understood(words);
  }

  Result<void> take_format(std::string_view word) {
    encoding_known_ = true;
    if (word == "ascii") {
      header_.encoding = PlyEncoding::kAscii;
    } else if (word == "binary_little_endian") {
      header_.encoding = PlyEncoding::kLittleEndian;
    } else if (word == "binary_big_endian") {
      header_.encoding = PlyEncoding::kBigEndian;
    } else {
      return complain(ErrorCode::kUnsupportedModel,
                      "the format \"" + printable(word) +
                          "\" is not known; ascii, binary_little_endian and binary_big_endian are");
    }
    return {};
  }

  Result<void> take_element(const std::vector<std::string_view>& words) {
    const std::optional<std::int64_t> count = parse_integer(words[2]);
    if (!count || *count < 0) {
      return complain(ErrorCode::kSyntax,
                      "\"" + printable(words[2]) + "\" is no number of " + printable(words[1]));
    }
    if (words[1] == "tristrips" && *count > 0) {
      return complain(ErrorCode::kUnsupportedModel,
                      "triangle strips are not read; write the faces as polygons");
    }
    if (++entries_ > kMostProperties) return too_long();
    header_.elements.push_back({std::string(words[1]), static_cast<std::uint64_t>(*count), {}});
    return {};
  }

  Result<void> take_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) return not_understood(words);
    PlyProperty property;
    property.list = words[1] == "list";
    const std::size_t first = property.list ? 2 : 1;
    if (words.size() < (property.list ? 5U : 3U)) return not_understood(words);
    if (property.list) {
      const std::optional<PlyScalar> count = scalar_of(words[first]);
      if (!count || !is_whole(*count)) return unknown_type(words[first]);
      property.count_type = *count;
    }
    const std::string_view type_word = words[property.list ? first + 1 : first];
    const std::optional<PlyScalar> type = scalar_of(type_word);
    if (!type) return unknown_type(type_word);
    property.type = *type;
    property.name = words[property.list ? 4 : 2];
    if (++entries_ > kMostProperties) return too_long();
    header_.elements.back().properties.push_back(std::move(property));
    return {};
  }

  [[nodiscard]] Failure unknown_type(std::string_view word) const {
    return complain(ErrorCode::kSyntax, "\"" + printable(word) + "\" is no type that fits here");
  }
  [[nodiscard]] Failure too_long() const {
    return complain(
        ErrorCode::kTooLarge,
        "the header has more than " + std::to_string(kMostProperties) + " elements and properties");
  }

  std::string_view rest_;
  std::size_t line_ = 0;
  std::size_t entries_ = 0;
  bool encoding_known_ = false;
  PlyHeader header_;
};

}  // namespace

std::size_t size_of(PlyScalar type) {
  switch (type) {
    case PlyScalar::kInt8:
    case PlyScalar::kUint8: return 1;
    case PlyScalar::kInt16:
    case PlyScalar::kUint16: return 2;
    case PlyScalar::kInt32:
    case PlyScalar::kUint32:
    case PlyScalar::kFloat32: return 4;
    case PlyScalar::kFloat64: return 8;
  }
  return 8;
}

Result<PlyHeader> read_ply_header(std::string_view bytes) {
  return HeaderReader(bytes).read();
}

}  // namespace symcell::internal
