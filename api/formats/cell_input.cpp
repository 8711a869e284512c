#include "api/formats/cell_input.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "api/formats/cell_archive.hpp"
#include "api/formats/gzip.hpp"
#include "api/formats/vtu_reader.hpp"
#include "core/geometry/axis_frame.hpp"
#include "core/verify/verify_mesh.hpp"

namespace symcell {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMaxMeshBytes = std::size_t{16} << 30U;
constexpr std::string_view kArchive = "SYMCELL";
constexpr double kMostCoordinate = 1e60;   // as for the vertices of a model
constexpr double kLeastDirection = 1e-60;  // likewise

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

Failure misfit(const std::string& what) {
  return fail(ErrorCode::kSyntax, "this is no symmetry cell: " + what);
}

// Facets of an element by its corners, outwards; and of order 2 the mid-side nodes between them.
constexpr std::array<std::array<std::size_t, 3>, 4> kTetFaces = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
constexpr std::array<std::array<std::size_t, 2>, 3> kTriangleSides = {{{0, 1}, {1, 2}, {2, 0}}};
// Of two corners the place of the node between them, in VTK's order.
std::size_t mid_of(std::int32_t dimension, std::size_t a, std::size_t b) {
  if (a > b) std::swap(a, b);
  if (dimension == 2) return 3 + (a == 0 ? (b == 1 ? 0 : 2) : 1);
  constexpr std::array<std::array<std::size_t, 4>, 4> kMid = {
      {{0, 4, 6, 7}, {4, 0, 5, 8}, {6, 5, 0, 9}, {7, 8, 9, 0}}};
  return kMid[a][b];
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
  // The corners of a facet, ascending, by which it is known.
  using Corners = std::vector<std::int32_t>;

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
    if (in_.dimension != 2 && in_.dimension != 3) return misfit("dimension is neither 2 nor 3");
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

  // Facet f of element e, corners first.
  [[nodiscard]] std::vector<std::int32_t> facet_nodes(std::size_t e, std::size_t f) const {
    const std::int32_t* own = in_.elements.data() + e * nodes_per_element();
    std::vector<std::size_t> local;
    if (in_.dimension == 2) {
      local.assign(kTriangleSides[f].begin(), kTriangleSides[f].end());
    } else {
      local.assign(kTetFaces[f].begin(), kTetFaces[f].end());
    }
    std::vector<std::int32_t> nodes;
    nodes.reserve(nodes_per_facet());
    for (const std::size_t c : local) nodes.push_back(own[c]);
    if (in_.order == 1) return nodes;
    for (std::size_t i = 0; i < (local.size() == 2 ? 1 : local.size()); ++i) {
      nodes.push_back(own[mid_of(in_.dimension, local[i], local[(i + 1) % local.size()])]);
    }
    return nodes;
  }

  [[nodiscard]] Corners key_of(const std::vector<std::int32_t>& nodes) const {
    Corners key(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(facet_corners()));
    std::ranges::sort(key);
    return key;
  }

  void find_facets() {
    std::map<Corners, std::vector<std::int32_t>>
        outer;  // of one element: its nodes as that has them
    for (std::size_t e = 0; e < in_.regions.size(); ++e) {
      for (std::size_t f = 0; f < corners(); ++f) {
        std::vector<std::int32_t> nodes = facet_nodes(e, f);
        const Corners key = key_of(nodes);
        const auto [place, fresh] = outer.try_emplace(key, std::move(nodes));
        if (!fresh) outer.erase(place);
      }
    }
    std::map<Corners, char> higher;
    const auto image_of = [&](const std::vector<std::int32_t>& nodes) {
      std::vector<std::int32_t> image;
      for (const std::int32_t n : nodes) {
        const std::int32_t to = in_.lower_to_higher[at(n)];
        if (to < 0) return std::vector<std::int32_t>();
        image.push_back(to);
      }
      return image;
    };
    std::map<Corners, char> lower;
    for (const auto& [key, nodes] : outer) {
      const std::vector<std::int32_t> image = image_of(nodes);
      if (image.empty() || in_.fold == 1) continue;
      const Corners other = key_of(image);
      if (other == key || !outer.contains(other)) continue;
      out_.lower_facets.insert(out_.lower_facets.end(), nodes.begin(), nodes.end());
      out_.higher_facets.insert(out_.higher_facets.end(), image.begin(), image.end());
      higher[other] = 1;
      lower[key] = 1;
    }
    if (loose_.has_boundary) {
      out_.boundary = loose_.boundary;
      out_.boundary_markers = loose_.boundary_markers;
    } else {
      for (const auto& [key, nodes] : outer) {
        if (higher.contains(key) || lower.contains(key)) continue;
        out_.boundary.insert(out_.boundary.end(), nodes.begin(), nodes.end());
        out_.boundary_markers.push_back(common_marker(nodes));
      }
    }
    const std::size_t per = nodes_per_facet();
    for (std::size_t b = 0; b < out_.boundary_markers.size(); ++b) {
      const std::vector<std::int32_t> nodes(
          out_.boundary.begin() + static_cast<std::ptrdiff_t>(b * per),
          out_.boundary.begin() + static_cast<std::ptrdiff_t>((b + 1) * per));
      out_.boundary_is_higher_image.push_back(higher.contains(key_of(nodes)) ? 1 : 0);
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
    if (!json.at(name).is_number_integer()) return misfit(std::string(name) + " is no integer");
  }
  LooseCell cell;
  MeshData& mesh = cell.mesh;
  mesh.dimension = json.at("dimension").get<std::int32_t>();
  mesh.order = json.at("order").get<std::int32_t>();
  mesh.fold = json.at("fold").get<std::int32_t>();
  mesh.axis_origin = point_of(json.at("axis").at("origin"));
  mesh.axis_direction = point_of(json.at("axis").at("direction"));
  for (const Json& p : json.at("nodes")) mesh.points.push_back(point_of(p));
  for (const Json& e : json.at("elements")) {
    for (const Json& n : e) mesh.elements.push_back(n.get<std::int32_t>());
  }
  mesh.regions = json.at("regions").get<std::vector<std::int32_t>>();
  mesh.markers = json.at("markers").get<std::vector<std::int32_t>>();
  const Json names = json.value("marker_names", Json::object());
  for (const auto& [marker, name] : names.items()) {
    cell.marker_names.push_back({std::stoi(marker), on_one_line(name.get<std::string>())});
  }
  cell.has_boundary = true;
  for (const Json& facet : json.at("boundary")) {
    for (const Json& n : facet.at("nodes")) cell.boundary.push_back(n.get<std::int32_t>());
    cell.boundary_markers.push_back(facet.at("marker").get<std::int32_t>());
  }
  mesh.lower_to_higher.assign(mesh.points.size(), -1);
  const auto lower = json.at("lower").get<std::vector<std::int32_t>>();
  const auto higher = json.at("higher").get<std::vector<std::int32_t>>();
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
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  const char first = begin == std::string_view::npos ? ' ' : bytes[begin];
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
  mesh.nodes_per_element = cell->nodes_per_element;  // which JSON does not tell
  mesh.curved = true;                                // it may have been asked for
  SYMCELL_TRY(check_loose(mesh));
  return cell;
}

}  // namespace symcell
