#include "api/formats/ply.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/formats/ply_header.hpp"
#include "api/formats/surface_reading.hpp"
#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"

namespace symcell {
namespace {

using internal::PlyElement;
using internal::PlyEncoding;
using internal::PlyHeader;
using internal::PlyProperty;
using internal::PlyScalar;

// The numbers of the body, one after the other. All types fit a double.
class PlyBody {
 public:
  PlyBody(std::string_view bytes, PlyEncoding encoding) : rest_(bytes), encoding_(encoding) {}

  // nullopt: the body is at its end, or (ASCII) what stands there is no number.
  std::optional<double> next(PlyScalar type) {
    return encoding_ == PlyEncoding::kAscii ? next_word() : next_binary(type);
  }

  // Of the word that was no number; empty at the end of the body.
  [[nodiscard]] std::string_view word() const { return word_; }

  [[nodiscard]] bool only_blank_left() const {
    return std::ranges::all_of(
        rest_, [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\0'; });
  }

 private:
  std::optional<double> next_word() {
    constexpr std::string_view kBlank = " \t\r\n\v\f";
    const std::size_t begin = std::min(rest_.find_first_not_of(kBlank), rest_.size());
    const std::size_t end = std::min(rest_.find_first_of(kBlank, begin), rest_.size());
    word_ = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    const ParsedNumber number = parse_number(word_);
    if (number.kind == NumberKind::kNoNumber) return std::nullopt;
    return number.value;
  }

  std::optional<double> next_binary(PlyScalar type) {
    word_ = {};
    const std::size_t size = internal::size_of(type);
    if (rest_.size() < size) return std::nullopt;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t from = encoding_ == PlyEncoding::kBigEndian ? i : size - 1 - i;
      bits = bits << 8U | static_cast<unsigned char>(rest_[from]);
    }
    rest_.remove_prefix(size);
    switch (type) {
      case PlyScalar::kInt8: return static_cast<std::int8_t>(bits);
      case PlyScalar::kUint8:
      case PlyScalar::kUint16:
      case PlyScalar::kUint32: return static_cast<double>(bits);
      case PlyScalar::kInt16: return static_cast<std::int16_t>(bits);
      case PlyScalar::kInt32: return static_cast<std::int32_t>(bits);
      case PlyScalar::kFloat32: return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
      case PlyScalar::kFloat64: return std::bit_cast<double>(bits);
    }
    return std::nullopt;
  }

  std::string_view rest_;
  std::string_view word_;
  PlyEncoding encoding_;
};

class PlyReader {
 public:
  explicit PlyReader(const PlyHeader& header)
      : header_(header), body_(header.body, header.encoding) {}

  Result<TriangleSurface> read() {
    bool vertices = false;
    bool faces = false;
    for (const PlyElement& element : header_.elements) {
      // One without properties takes no bytes, however many the header counts.
      if (element.properties.empty()) continue;
      auto done = Result<void>{};
      if (element.name == "vertex" && !vertices) {
        vertices = true;
        done = read_vertices(element);
      } else if (element.name == "face" && !faces) {
        faces = true;
        // Kept for later: vertices may follow.
        done = read_faces(element);
      } else {
        done = skip(element);
      }
      if (!done) return error_of(done);
    }
    if (!vertices || !faces) {
      return fail(ErrorCode::kMissingField, std::string("the PLY file has no element \"") +
                                                (vertices ? "face" : "vertex") +
                                                "\"; a solid needs vertices and faces");
    }
    if (!body_.only_blank_left()) {
      return fail(ErrorCode::kCountMismatch,
                  "the PLY file goes on after its last element; are the counts right?");
    }
    SYMCELL_TRY(append_faces());
    return internal::finished(std::move(surface_), "PLY");
  }

 private:
  // Where reading stands, for messages.
  struct Place {
    const PlyElement& element;
    std::uint64_t index;
  };

  static std::string name_of(const Place& place) {
    return printable(place.element.name) + " " + std::to_string(place.index) + " of " +
           std::to_string(place.element.count);
  }

  [[nodiscard]] Failure no_number(const Place& place) const {
    if (body_.word().empty()) {
      return fail(ErrorCode::kTruncated, "the PLY file ends in " + name_of(place));
    }
    return fail(ErrorCode::kSyntax,
                "PLY: " + name_of(place) + ": \"" + printable(body_.word()) + "\" is no number");
  }

  Result<double> number(PlyScalar type, const Place& place) {
    const std::optional<double> value = body_.next(type);
    if (!value) return no_number(place);
    return *value;
  }

  Result<std::uint64_t> list_length(const PlyProperty& property, const Place& place) {
    const Result<double> count = number(property.count_type, place);
    if (!count) return error_of(count);
    if (*count >= 0 && *count <= 0x1p32 && std::floor(*count) == *count) {
      return static_cast<std::uint64_t>(*count);
    }
    return fail(ErrorCode::kSyntax, "PLY: " + name_of(place) + " has a list of no sane length");
  }

  // A property that is of no interest.
  Result<void> skip(const PlyProperty& property, const Place& place) {
    std::uint64_t count = 1;
    if (property.list) {
      const auto length = list_length(property, place);
      if (!length) return error_of(length);
      count = *length;
    }
    for (std::uint64_t i = 0; i < count; ++i) {
      SYMCELL_TRY(number(property.type, place));
    }
    return {};
  }

  Result<void> skip(const PlyElement& element) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        if (auto done = skip(property, {element, i}); !done) return done;
      }
    }
    return {};
  }

  Result<void> read_vertices(const PlyElement& element) {
    constexpr std::array<std::string_view, 3> kNames{"x", "y", "z"};
    for (const std::string_view name : kNames) {
      const bool has = std::ranges::any_of(
          element.properties, [&](const PlyProperty& p) { return p.name == name && !p.list; });
      if (!has) {
        return fail(ErrorCode::kMissingField,
                    "the vertices of the PLY file have no property \"" + std::string(name) + "\"");
      }
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const Place place{element, i};
      if (i == kMaxSurfaceTriangles) {
        return fail(ErrorCode::kTooLarge, "more than " + std::to_string(i) + " vertices");
      }
      std::array<double, 3> xyz{};
      for (const PlyProperty& property : element.properties) {
        const auto* axis = property.list ? kNames.end() : std::ranges::find(kNames, property.name);
        if (axis == kNames.end()) {
          SYMCELL_TRY(skip(property, place));
          continue;
        }
        const Result<double> value = number(property.type, place);
        if (!value) return error_of(value);
        if (!std::isfinite(*value)) {
          return fail(ErrorCode::kNonFinite,
                      "PLY: " + name_of(place) + " has a coordinate that is not finite",
                      {static_cast<std::int64_t>(i)}, "/vertices/" + std::to_string(i));
        }
        xyz[static_cast<std::size_t>(axis - kNames.begin())] = *value;
      }
      surface_.vertices.push_back({xyz[0], xyz[1], xyz[2]});
    }
    return {};
  }

  Result<void> read_faces(const PlyElement& element) {
    const auto is_corners = [](const PlyProperty& p) {
      return p.list && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (std::ranges::none_of(element.properties, is_corners)) {
      return fail(ErrorCode::kMissingField,
                  "the faces of the PLY file have no list \"vertex_indices\"");
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PlyProperty& property : element.properties) {
        const bool wanted = is_corners(property);
        auto done = wanted ? read_corners(property, {element, i}) : skip(property, {element, i});
        if (!done) return done;
      }
      face_ends_.push_back(corners_.size());
    }
    return {};
  }

  Result<void> read_corners(const PlyProperty& property, const Place& place) {
    const auto length = list_length(property, place);
    if (!length) return error_of(length);
    for (std::uint64_t c = 0; c < *length; ++c) {
      const Result<double> corner = number(property.type, place);
      if (!corner) return error_of(corner);
      if (std::floor(*corner) != *corner || std::abs(*corner) > 0x1p53) {
        return fail(ErrorCode::kSyntax, "PLY: " + name_of(place) + " has a corner that is no index",
                    {static_cast<std::int64_t>(place.index)});
      }
      corners_.push_back(static_cast<std::int64_t>(*corner));
    }
    return {};
  }

  Result<void> append_faces() {
    std::size_t begin = 0;
    for (std::size_t f = 0; f < face_ends_.size(); ++f) {
      const std::span<const std::int64_t> corners(corners_.data() + begin, face_ends_[f] - begin);
      SYMCELL_TRY(internal::append_face(corners, f, "PLY: ", surface_));
      begin = face_ends_[f];
    }
    return {};
  }

  const PlyHeader& header_;
  PlyBody body_;
  std::vector<std::int64_t> corners_;   // of all faces
  std::vector<std::size_t> face_ends_;  // into corners_
  TriangleSurface surface_;
};

}  // namespace

Result<TriangleSurface> read_ply(std::string_view bytes) {
  const Result<PlyHeader> header = internal::read_ply_header(bytes);
  if (!header) return error_of(header);
  return PlyReader(*header).read();
}

}  // namespace symcell
