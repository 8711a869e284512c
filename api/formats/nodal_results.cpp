#include "api/formats/nodal_results.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include "api/formats/mesh_formats.hpp"
#include "api/formats/vtu_reader.hpp"
#include "core/base/index.hpp"
#include "core/geometry/axis_frame.hpp"

namespace symcell {
namespace {

bool is_finite(Point3 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

// A number in a field of fixed width, with blanks before it.
template <class Number>
bool read_field(std::string_view line, std::size_t begin, std::size_t width, Number& into) {
  if (line.size() < begin + 1) return false;
  std::string_view field = line.substr(begin, width);
  field.remove_prefix(std::min(field.find_first_not_of(' '), field.size()));
  while (!field.empty() && (field.back() == ' ' || field.back() == '\r')) field.remove_suffix(1);
  if (field.starts_with('+')) field.remove_prefix(1);
  const auto [stop, error] = std::from_chars(field.data(), field.data() + field.size(), into);
  return !field.empty() && error == std::errc{} && stop == field.data() + field.size();
}

class FrdReader {
 public:
  FrdReader(std::string_view bytes, std::size_t nodes) : rest_(bytes), nodes_(nodes) {}

  Result<std::vector<NodalResult>> read() {
    std::optional<std::int32_t> diameter;
    double value = 0;
    while (next_line()) {
      if (line_.starts_with("    1PHID")) {
        std::int32_t k = 0;
        if (read_field(line_, 9, 40, k)) diameter = k;
      } else if (line_.starts_with("  100C")) {
        static_cast<void>(read_field(line_, 12, 12, value));
      } else if (line_.starts_with(" -4")) {
        const std::string name = word(line_.substr(std::min<std::size_t>(5, line_.size())));
        SYMCELL_TRY(read_block(name, value, diameter));
      }
    }
    if (results_.empty()) {
      return fail(ErrorCode::kSyntax,
                  "the file has no vectors at nodes: it must be an ASCII .frd with *NODE FILE, U");
    }
    return std::move(results_);
  }

 private:
  bool next_line() {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    return true;
  }

  static std::string word(std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
    const std::size_t end = std::min(text.find_first_of(" \r", begin), text.size());
    return std::string(text.substr(begin, end - begin));
  }

  [[nodiscard]] Failure complain(ErrorCode code, const std::string& what) const {
    return fail(code, "line " + std::to_string(number_) + ": " + what);
  }

  // Three components and their length make a vector; others are passed over.
  Result<void> read_block(const std::string& name,
                          double value,
                          std::optional<std::int32_t> diameter) {
    std::size_t components = 0;
    std::vector<Point3> vectors;
    std::vector<char> seen;
    std::size_t found = 0;
    while (next_line()) {
      if (line_.starts_with(" -5")) {
        ++components;
      } else if (line_.starts_with(" -3")) {
        break;
      } else if (line_.starts_with(" -1") && components == 4) {
        std::int64_t node = 0;
        Point3 v;
        const bool read = read_field(line_, 3, 10, node) && read_field(line_, 13, 12, v.x) &&
                          read_field(line_, 25, 12, v.y) && read_field(line_, 37, 12, v.z);
        if (!read)
          return complain(ErrorCode::kSyntax, "a node with three numbers should stand here");
        if (node < 1 || static_cast<std::uint64_t>(node) > nodes_) {
          return complain(ErrorCode::kCountMismatch,
                          "node " + std::to_string(node) + " is none of the cell's " +
                              std::to_string(nodes_) + "; are the results of this cell?");
        }
        const auto place = static_cast<std::size_t>(node - 1);
        vectors.resize(nodes_);
        seen.resize(nodes_, 0);
        if (seen[place] != 0) {
          return complain(
              ErrorCode::kCountMismatch,
              "node " + std::to_string(node) + " stands here for the second time in " + name);
        }
        if (!is_finite(v)) {
          return complain(ErrorCode::kNonFinite,
                          "node " + std::to_string(node) + " has no finite vector");
        }
        vectors[place] = v;
        seen[place] = 1;
        ++found;
      }
    }
    if (found == 0) return {};
    if (found != nodes_) {
      return complain(ErrorCode::kCountMismatch, name + " has " + std::to_string(found) +
                                                     " nodes, the cell " + std::to_string(nodes_));
    }
    const bool imaginary = name.size() > 1 && name.back() == 'I' && !results_.empty() &&
                           results_.back().name == name.substr(0, name.size() - 1) &&
                           results_.back().imaginary.empty();
    if (imaginary) {
      results_.back().imaginary = std::move(vectors);
    } else {
      results_.push_back({name, value, diameter, std::move(vectors), {}});
    }
    return {};
  }

  std::string_view rest_;
  std::string_view line_;
  std::size_t nodes_;
  std::size_t number_ = 0;
  std::vector<NodalResult> results_;
};

struct Complex3 {
  Point3 real, imaginary;
};

// Vectors in the frame of the axis, turned and shifted from sector to sector.
class Waves {
 public:
  Waves(const SymmetryCellMesh& cell, const NodalResult& result)
      : result_(result), axes_{{0, 0, 0}, cell.frame}, rotations_(cell.fold) {}

  // By a whole number of sectors.
  struct Shift {
    double cosine = 1, sine = 0;  // of the phase
    std::int32_t turn = 0;        // exponent
  };
  [[nodiscard]] Shift shift(std::int32_t sectors, std::int32_t diameter) const {
    const double angle = 2 * std::numbers::pi * diameter * sectors / rotations_.fold();
    return {std::cos(angle), std::sin(angle), rotations_.reduce(sectors)};
  }

  [[nodiscard]] Complex3 local(std::size_t node) const {
    return {axes_.to_local(result_.real[node]),
            result_.imaginary.empty() ? Point3{} : axes_.to_local(result_.imaginary[node])};
  }

  [[nodiscard]] Complex3 turned(const Complex3& v, std::int32_t exponent) const {
    return {rotations_.rotate(v.real, exponent), rotations_.rotate(v.imaginary, exponent)};
  }

  [[nodiscard]] Complex3 moved(const Complex3& v, const Shift& by) const {
    return turned(shifted(v, by), by.turn);
  }

  // In its phase alone.
  [[nodiscard]] static Complex3 shifted(const Complex3& v, const Shift& by) {
    return {by.cosine * v.real - by.sine * v.imaginary, by.sine * v.real + by.cosine * v.imaginary};
  }

  [[nodiscard]] Point3 to_model(Point3 p) const { return axes_.to_model(p); }

 private:
  const NodalResult& result_;
  AxisFrame axes_;  // of vectors, which have no origin
  RotationTable rotations_;
};

}  // namespace

Result<std::vector<NodalResult>> read_frd(std::string_view bytes, std::size_t nodes) {
  return FrdReader(bytes, nodes).read();
}

Result<NodalResult> read_vtu_result(std::string_view bytes,
                                    std::size_t nodes,
                                    const std::string& array,
                                    const std::string& imaginary) {
  NodalResult result;
  result.name = array;
  for (const auto& [name, into] :
       {std::pair{&array, &result.real}, {&imaginary, &result.imaginary}}) {
    if (name->empty()) continue;
    auto vectors = read_vtu_vectors(bytes, *name);
    if (!vectors) return error_of(vectors);
    if (vectors->size() != nodes) {
      return fail(ErrorCode::kCountMismatch, "the results have " + std::to_string(vectors->size()) +
                                                 " nodes, the cell " + std::to_string(nodes));
    }
    *into = std::move(*vectors);
  }
  return result;
}

NodalDiameter find_nodal_diameter(const SymmetryCellMesh& cell,
                                  const NodalResult& result,
                                  std::optional<std::int32_t> wanted) {
  const Waves waves(cell, result);
  double largest = 0;
  for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
    const Complex3 v = waves.local(i);
    largest = std::max(largest, std::sqrt(dot(v.real, v.real) + dot(v.imaginary, v.imaginary)));
  }
  // At the bounds, turned on by a sector, beside what stands there.
  struct Pair {
    Complex3 turned, there;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
    const std::int32_t image = cell.lower_to_higher[i];
    if (image < 0 || at(image) == i) continue;
    pairs.push_back({waves.turned(waves.local(i), cell.fold > 1 ? 1 : 0), waves.local(at(image))});
  }
  NodalDiameter best{0, std::numeric_limits<double>::infinity()};
  const std::int32_t half = cell.fold / 2;
  for (std::int32_t k = std::max(0, wanted.value_or(0)); k <= std::min(half, wanted.value_or(half));
       ++k) {
    for (const std::int32_t signed_k : {k, -k}) {
      const Waves::Shift by = waves.shift(1, signed_k);
      double off = 0;
      for (const Pair& pair : pairs) {
        const Complex3 moved = Waves::shifted(pair.turned, by);
        const Point3 a = moved.real - pair.there.real, b = moved.imaginary - pair.there.imaginary;
        off = std::max(off, std::sqrt(dot(a, a) + dot(b, b)));
        if (off >= best.mismatch) break;  // another fits better already
      }
      if (off < best.mismatch) best = {signed_k, off};
    }
  }
  if (!std::isfinite(best.mismatch)) best.mismatch = 0;
  if (largest > 0) best.mismatch /= largest;
  return best;
}

Result<void> write_full_result(const SymmetryCellMesh& cell,
                               const NodalResult& result,
                               std::int32_t signed_diameter,
                               double phase,
                               const std::string& name,
                               VtuEncoding encoding,
                               const Sink& sink) {
  // One node of the cell an orbit; others of it are the same but for rounding.
  std::vector<std::int32_t> node(cell.orbit_points.size(), -1);
  for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
    std::int32_t& own = node[at(cell.nodes[i].orbit)];
    if (own < 0) own = static_cast<std::int32_t>(i);
  }
  const Waves waves(cell, result);
  std::vector<Waves::Shift> shifts;  // by how many sectors
  shifts.reserve(at(cell.fold));
  for (std::int32_t k = 0; k < cell.fold; ++k) shifts.push_back(waves.shift(k, signed_diameter));
  const auto moved = [&](OrbitVertex v) {
    const std::size_t own = at(node[at(v.orbit)]);
    const std::int32_t sectors = v.exponent - cell.nodes[own].exponent;
    return waves.moved(waves.local(own), shifts[at(sectors < 0 ? sectors + cell.fold : sectors)]);
  };
  const double c = std::cos(phase), s = std::sin(phase);
  const std::vector<internal::NodeVectors> fields{
      {name, 3,
       [&](OrbitVertex v) {
         const Complex3 w = moved(v);
         return waves.to_model(c * w.real - s * w.imaginary);
       }},
      {name + "_amplitude", 1, [&](OrbitVertex v) {
         const Complex3 w = moved(v);
         return Point3{std::sqrt(dot(w.real, w.real) + dot(w.imaginary, w.imaginary)), 0, 0};
       }}};
  ByteWriter out(sink);
  MeshStream mesh(cell, MeshPart::kFull);
  mesh.stop_when([&out] { return !out.ok(); });
  internal::write_vtu(mesh, encoding, out, fields);
  return out.finish();
}

}  // namespace symcell
