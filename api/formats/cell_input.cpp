#include "api/formats/cell_input.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "api/formats/byte_order_mark.hpp"
#include "api/formats/cell_archive.hpp"
#include "api/formats/gzip.hpp"
#include "api/formats/vtu_reader.hpp"
#include "core/base/index.hpp"
#include "core/geometry/axis_frame.hpp"
#include "core/model/mesh_options.hpp"
#include "core/verify/support.hpp"
#include "core/verify/verify_mesh.hpp"

namespace symcell {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxMeshBytes = std::size_t{16} << 30U;
constexpr std::string_view kArchive = "SYMCELL";
constexpr double kMostCoordinate = 1e60;   // as for the vertices of a model
constexpr double kLeastDirection = 1e-60;  // likewise

Failure misfit(const std::string& what) {
  return fail(ErrorCode::kSyntax, "this is no symmetry cell: " + what);
}

class Rebuilder {
 public:
  explicit Rebuilder(const LooseCell& loose) : loose_(loose), in_(loose.mesh) {}

  Result<SymmetryCellMesh> run() {
    SYMCELL_TRY(check_sizes());
    SYMCELL_TRY(name_nodes());
    out_.dimension = in_.dimension;
    out_.order = in_.order;
    out_.fold = in_.fold;
    out_.shape_tolerance_rel = static_cast<float>(in_.shape_tolerance_rel);
    out_.nodes_per_element = static_cast<std::int32_t>(nodes_per_element());
    out_.nodes_per_facet = static_cast<std::int32_t>(nodes_per_facet());
    out_.elements = in_.elements;
    out_.regions = in_.regions;
    out_.lower_to_higher = in_.lower_to_higher;
    out_.node_markers = in_.markers;
    out_.node_markers.resize(in_.points.size(), 0);
    out_.marker_names = loose_.marker_names;
    find_facets();
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::size_t corners() const { return in_.dimension == 2 ? 3 : 4; }
  [[nodiscard]] std::size_t nodes_per_element() const {
    return in_.order == 1 ? corners() : (in_.dimension == 2 ? 6 : 10);
  }
  [[nodiscard]] std::size_t facet_corners() const { return in_.dimension == 2 ? 2 : 3; }
  [[nodiscard]] std::size_t nodes_per_facet() const {
    return in_.order == 1 ? facet_corners() : (in_.dimension == 2 ? 3 : 6);
  }

  [[nodiscard]] Result<void> check_sizes() const {
    if (in_.fold < 1 || in_.order < 1 || in_.order > 2) return misfit("fold or order");
    if (in_.fold > kMaxFold) {
      return misfit("its fold is above " + std::to_string(kMaxFold));
    }
    if (in_.dimension != 2 && in_.dimension != 3) return misfit("dimension is neither 2 nor 3");
    if (static_cast<std::size_t>(in_.nodes_per_element) != nodes_per_element()) {
      return misfit("elements have another number of nodes than dimension and order say");
    }
    SYMCELL_TRY(check_places());
    if (in_.elements.size() != in_.regions.size() * nodes_per_element()) {
      return misfit("elements and regions differ in number");
    }
    if (in_.lower_to_higher.size() != in_.points.size()) {
      return fail(
          ErrorCode::kUnsupportedModel,
          "the file has no pairs of the bounds (lower_to_higher): give a cell, not a full mesh");
    }
    const auto count = static_cast<std::int32_t>(in_.points.size());
    const auto inside = [&](std::int32_t i) { return i >= 0 && i < count; };
    if (!std::ranges::all_of(in_.elements, inside))
      return misfit("an element's node does not exist");
    if (!std::ranges::all_of(loose_.boundary, inside))
      return misfit("a facet's node does not exist");
    if (!std::ranges::all_of(in_.lower_to_higher, [&](std::int32_t i) { return i < count; })) {
      return misfit("a pair's node does not exist");
    }
    if (loose_.boundary.size() != loose_.boundary_markers.size() * nodes_per_facet()) {
      return misfit("facets have other numbers of nodes than their order says");
    }
    return {};
  }

  [[nodiscard]] Result<void> check_places() const {
    const auto sound = [](Point3 p) {
      return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kMostCoordinate;
    };
    if (!std::ranges::all_of(in_.points, sound)) {
      return misfit("a coordinate is no number, or beyond 1e60");
    }
    if (!sound(in_.axis_origin) || !sound(in_.axis_direction) ||
        !(length(in_.axis_direction) >= kLeastDirection)) {
      return misfit("the axis has no direction");
    }
    return {};
  }

  // Chains of images: the first is the orbit's representative.
  Result<void> name_nodes() {
    const AxisFrame frame = AxisFrame::of_axis(in_.axis_origin, in_.axis_direction);
    out_.axis_origin = frame.origin;
    out_.axis_direction = frame.direction();
    out_.frame = frame.matrix;
    const std::size_t count = in_.points.size();
    std::vector<std::int32_t> before(count, -1);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t image = in_.lower_to_higher[i];
      if (image < 0 || at(image) == i) continue;
      if (before[at(image)] >= 0) return misfit("two nodes have one image");
      before[at(image)] = static_cast<std::int32_t>(i);
    }
    out_.nodes.assign(count, {-1, 0});
    const auto name_chain = [&](std::size_t first) {
      const auto orbit = static_cast<std::int32_t>(out_.orbit_points.size());
      Point3 local = frame.to_local(in_.points[first]);
      const bool axis = in_.fold > 1 && at(in_.lower_to_higher[first]) == first &&
                        in_.lower_to_higher[first] >= 0;
      if (axis) local.x = local.y = 0;
      out_.orbit_points.push_back(local);
      out_.on_axis.push_back(axis ? 1 : 0);
      std::int32_t exponent = 0;
      for (auto i = static_cast<std::int32_t>(first); i >= 0 && out_.nodes[at(i)].orbit < 0;
           i = in_.lower_to_higher[at(i)]) {
        out_.nodes[at(i)] = {orbit, exponent};
        exponent = (exponent + 1) % in_.fold;
      }
    };
    for (std::size_t i = 0; i < count; ++i) {
      if (before[i] < 0) name_chain(i);
    }
    // Rings of images, as of two nodes that are half a turn apart.
    for (std::size_t i = 0; i < count; ++i) {
      if (out_.nodes[i].orbit < 0) name_chain(i);
    }
    return {};
  }

  // Corners outwards as its element sees them, then the nodes between.
  [[nodiscard]] std::vector<std::int32_t> facet_nodes(const internal::HalfFacet& facet) const {
    std::vector<std::int32_t> nodes(facet.nodes.begin(), facet.nodes.end());
    nodes.resize(facet_corners());
    if (!facet.even) std::swap(nodes[nodes.size() - 2], nodes.back());
    if (in_.order == 1) return nodes;
    const std::int32_t* own = in_.elements.data() + at(facet.element) * nodes_per_element();
    const auto sides = internal::edge_corners(in_.dimension);
    for (std::size_t i = 0; nodes.size() < nodes_per_facet(); ++i) {
      const std::int32_t a = nodes[i], b = nodes[(i + 1) % facet_corners()];
      const auto side = std::ranges::find_if(sides, [&](const auto& s) {
        return (own[s[0]] == a && own[s[1]] == b) || (own[s[0]] == b && own[s[1]] == a);
      });
      nodes.push_back(own[corners() + static_cast<std::size_t>(side - sides.begin())]);
    }
    return nodes;
  }

  // The group of a facet by its nodes, corners first; as many as there are groups: none.
  [[nodiscard]] std::size_t group_of(const internal::FacetedMesh& faceted,
                                     std::span<const std::int32_t> nodes) const {
    std::array<std::int32_t, 3> key{nodes[0], nodes[1], in_.dimension == 2 ? -1 : nodes[2]};
    internal::sort_facet(key, in_.dimension);
    return faceted.find(key);
  }

  // Nothing where a node has no image.
  [[nodiscard]] std::vector<std::int32_t> image_of(const std::vector<std::int32_t>& nodes) const {
    std::vector<std::int32_t> image;
    for (const std::int32_t n : nodes) {
      const std::int32_t to = in_.lower_to_higher[at(n)];
      if (to < 0) return {};
      image.push_back(to);
    }
    return image;
  }

  void find_facets() {
    const internal::FacetedMesh faceted(in_);
    const std::size_t groups = faceted.group_count();
    std::vector<char> lower(groups, 0), higher(groups, 0);
    for (std::size_t g = 0; g < groups && in_.fold > 1; ++g) {
      if (faceted.sides(g) != 1) continue;
      const std::vector<std::int32_t> nodes = facet_nodes(faceted.first(g));
      const std::vector<std::int32_t> image = image_of(nodes);
      if (image.empty()) continue;
      const std::size_t other = group_of(faceted, image);
      if (other == g || other == groups || faceted.sides(other) != 1) continue;
      out_.lower_facets.insert(out_.lower_facets.end(), nodes.begin(), nodes.end());
      out_.higher_facets.insert(out_.higher_facets.end(), image.begin(), image.end());
      lower[g] = higher[other] = 1;
    }
    if (loose_.has_boundary) {
      out_.boundary = loose_.boundary;
      out_.boundary_markers = loose_.boundary_markers;
    } else {
      for (std::size_t g = 0; g < groups; ++g) {
        if (faceted.sides(g) != 1 || lower[g] != 0 || higher[g] != 0) continue;
        const std::vector<std::int32_t> nodes = facet_nodes(faceted.first(g));
        out_.boundary.insert(out_.boundary.end(), nodes.begin(), nodes.end());
        out_.boundary_markers.push_back(common_marker(nodes));
      }
    }
    const std::size_t per = nodes_per_facet();
    for (std::size_t b = 0; b < out_.boundary_markers.size(); ++b) {
      const std::size_t g = group_of(faceted, std::span(out_.boundary).subspan(b * per, per));
      out_.boundary_is_higher_image.push_back(g < groups && higher[g] != 0 ? 1 : 0);
    }
  }

  // A node between two groups has the smaller marker: the largest at the facet's nodes is its own, as a
  // rule, and certainly where all have the same.
  [[nodiscard]] std::int32_t common_marker(const std::vector<std::int32_t>& nodes) const {
    if (in_.markers.empty()) return 0;
    std::int32_t most = 0;
    for (const std::int32_t n : nodes) {
      const std::int32_t marker = in_.markers[at(n)];
      if (marker == 0) return 0;
      most = std::max(most, marker);
    }
    return most;
  }

  const LooseCell& loose_;
  const MeshData& in_;
  SymmetryCellMesh out_;
};

// An integer of 32 bits: others would come out as another one.  Throws where it is none.
std::int32_t int_of(const Json& json) {
  const bool whole = json.is_number_unsigned()
                         ? json.get<std::uint64_t>() <= INT32_MAX
                         : json.is_number_integer() && json.get<std::int64_t>() >= INT32_MIN;
  if (!whole) throw std::out_of_range("no integer of 32 bits");
  return json.get<std::int32_t>();
}

// A key of "marker_names".  Throws where it is no integer.
std::int32_t marker_of(const std::string& key) {
  std::int32_t marker = 0;
  const char* end = key.data() + key.size();
  const auto [read, error] = std::from_chars(key.data(), end, marker);
  if (error != std::errc() || read != end) throw std::out_of_range("no integer of 32 bits");
  return marker;
}

// Throws where it is no list of them.
std::vector<std::int32_t> ints_of(const Json& json) {
  if (!json.is_array()) throw std::out_of_range("no list of integers");
  std::vector<std::int32_t> values;
  values.reserve(json.size());
  for (const Json& value : json) values.push_back(int_of(value));
  return values;
}

Point3 point_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(),
          json.size() > 2 ? json.at(2).get<double>() : 0};
}

// Formats of solvers end a name with its line.
std::string on_one_line(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return static_cast<unsigned char>(c) < ' '; }, '_');
  return name;
}

// Throws what the JSON library throws.
Result<LooseCell> loose_from_json(const Json& json) {
  if (!json.is_object() || !json.contains("elements") || !json.contains("lower")) {
    return misfit("the JSON has no elements and bounds; give what symcell wrote as a cell");
  }
  if (json.contains("sector")) {
    return fail(ErrorCode::kUnsupportedModel, "this is a full mesh; give the cell");
  }
  if (json.contains("packed")) {
    return fail(
        ErrorCode::kUnsupportedModel,
        "packed JSON is for programs that draw; give JSON that was written without --packed");
  }
  for (const char* name : {"dimension", "order", "fold"}) {
    const Json& value = json.at(name);
    if (!value.is_number_integer() || value.get<double>() > INT32_MAX) {
      return misfit(std::string(name) + " is no integer, or far too large");
    }
  }
  LooseCell cell;
  MeshData& mesh = cell.mesh;
  mesh.dimension = int_of(json.at("dimension"));
  mesh.order = int_of(json.at("order"));
  mesh.fold = int_of(json.at("fold"));
  // Other dimensions are refused when the cell is rebuilt.
  mesh.nodes_per_element = mesh.dimension == 2 ? 3 : 4;
  if (mesh.order == 2) mesh.nodes_per_element = mesh.dimension == 2 ? 6 : 10;
  mesh.axis_origin = point_of(json.at("axis").at("origin"));
  mesh.axis_direction = point_of(json.at("axis").at("direction"));
  for (const Json& p : json.at("nodes")) mesh.points.push_back(point_of(p));
  for (const Json& e : json.at("elements")) {
    for (const Json& n : e) mesh.elements.push_back(int_of(n));
  }
  mesh.regions = ints_of(json.at("regions"));
  mesh.markers = ints_of(json.at("markers"));
  const Json names = json.value("marker_names", Json::object());
  for (const auto& [marker, name] : names.items()) {
    cell.marker_names.push_back({marker_of(marker), on_one_line(name.get<std::string>())});
  }
  cell.has_boundary = true;
  for (const Json& facet : json.at("boundary")) {
    for (const Json& n : facet.at("nodes")) cell.boundary.push_back(int_of(n));
    cell.boundary_markers.push_back(int_of(facet.at("marker")));
  }
  mesh.lower_to_higher.assign(mesh.points.size(), -1);
  const auto lower = ints_of(json.at("lower"));
  const auto higher = ints_of(json.at("higher"));
  if (lower.size() != higher.size()) return misfit("lower and higher differ in number");
  for (std::size_t i = 0; i < lower.size(); ++i) {
    if (lower[i] < 0 || at(lower[i]) >= mesh.points.size())
      return misfit("a pair's node does not exist");
    mesh.lower_to_higher[at(lower[i])] = higher[i];
  }
  if (mesh.markers.size() != mesh.points.size())
    return misfit("markers and nodes differ in number");
  return cell;
}

Result<LooseCell> read_json(std::string_view bytes) {
  try {
    return loose_from_json(Json::parse(bytes));
  } catch (const Json::parse_error& error) {
    return fail(ErrorCode::kSyntax,
                "this is no JSON: it goes wrong at byte " + std::to_string(error.byte));
  } catch (const std::exception&) {
    return misfit("its JSON lacks something, or has another type than symcell writes");
  }
}

Result<LooseCell> read_vtu_cell(std::string_view bytes) {
  Result<MeshData> data = read_vtu(bytes);
  if (!data) return error_of(data);
  LooseCell cell;
  cell.mesh = std::move(*data);
  return cell;
}

// What a checker of files says of it: a cell whose copies do not fit would become a wrong full mesh.
Result<void> check_loose(const MeshData& mesh) {
  VerifyOptions options;
  options.most_restored_nodes = 0;  // the cell alone
  for (const Check& check : verify_mesh(mesh, nullptr, nullptr, options).checks) {
    if (check.status == Check::Status::kFail) return misfit(check.name + ": " + check.detail);
  }
  return {};
}

}  // namespace

Result<SymmetryCellMesh> cell_of(const LooseCell& loose) {
  return Rebuilder(loose).run();
}

Result<SymmetryCellMesh> read_cell(std::string_view bytes) {
  if (is_gzip(bytes)) {
    const Result<std::string> text = gunzip(bytes, kMaxMeshBytes);
    if (!text) return error_of(text);
    if (!is_gzip(*text)) return read_cell(*text);
  }
  if (bytes.starts_with(kArchive)) return read_cell_archive(bytes);
  const std::string_view text = without_byte_order_mark(bytes);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  const char first = begin == std::string_view::npos ? ' ' : text[begin];
  const bool json = first == '{';
  if (!json && first != '<') {
    return fail(ErrorCode::kSyntax,
                "this is no mesh that is read: give JSON or VTU of a cell, or a job's cell");
  }
  Result<LooseCell> loose = json ? read_json(bytes) : read_vtu_cell(bytes);
  if (!loose) return error_of(loose);
  auto cell = cell_of(*loose);
  if (!cell) return cell;
  MeshData& mesh = loose->mesh;
  mesh.curved = true;  // it may have been asked for
  SYMCELL_TRY(check_loose(mesh));
  return cell;
}

}  // namespace symcell
