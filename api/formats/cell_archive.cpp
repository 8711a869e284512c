// Layout, all little-endian:
//   8 bytes   magic "SYMCELL" and the version
//   5 int32   dimension, order, fold, nodes an element, nodes a facet; 1 int32 of padding
//   15 double axis origin, axis direction, frame
//   14 uint64 sizes of the arrays in entries, in the order of `each_array`
//   the arrays, one after the other
//   the names of markers, up to the last 4 bytes: each its marker in decimals, a space, the name and a
//             line feed
//   uint32    CRC-32 of all bytes before
#include "api/formats/cell_archive.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <string>

#include "api/formats/byte_writer.hpp"
#include "core/model/mesh_options.hpp"

namespace symcell {
namespace {

constexpr std::string_view kMagic("SYMCELL\x01", 8);
constexpr std::size_t kArrays = 14;
constexpr std::size_t kHeaderBytes = 8 + 6 * 4 + 15 * 8 + kArrays * 8;

static_assert(sizeof(Point3) == 24 && sizeof(OrbitVertex) == 8, "arrays are stored as they lie");

// The one order of the arrays, for reading and writing.
template <class Mesh, class F>
void each_array(Mesh& m, F f) {
  f(m.orbit_points);
  f(m.on_axis);
  f(m.nodes);
  f(m.node_markers);
  f(m.elements);
  f(m.regions);
  f(m.boundary);
  f(m.boundary_markers);
  f(m.boundary_is_higher_image);
  f(m.lower_facets);
  f(m.higher_facets);
  f(m.lower_to_higher);
  f(m.sector_regions);
  f(m.sector_boundary_markers);
}

template <class T>
std::uint64_t entry_size(const std::vector<T>&) {
  return sizeof(T);
}

// The header's numbers, written and read alike.
struct Header {
  std::array<std::int32_t, 6> whole{};
  std::array<double, 15> real{};
};

// Names hold no line feeds: readers of models see to that.
std::string names_text(const SymmetryCellMesh& m) {
  std::string text;
  for (const MarkerName& n : m.marker_names) {
    text += std::to_string(n.marker) + " " + n.name + "\n";
  }
  return text;
}

// Whether the text is one.
bool read_names(std::string_view text, std::vector<MarkerName>& names) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n'), space = text.find(' ');
    if (end == std::string_view::npos || space >= end) return false;
    MarkerName name;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + space, name.marker);
    if (error != std::errc{} || stop != text.data() + space) return false;
    name.name = text.substr(space + 1, end - space - 1);
    names.push_back(std::move(name));
    text.remove_prefix(end + 1);
  }
  return true;
}

Header header_of(const SymmetryCellMesh& m) {
  Header h{{m.dimension, m.order, m.fold, m.nodes_per_element, m.nodes_per_facet,
            std::bit_cast<std::int32_t>(m.shape_tolerance_rel)},
           {}};
  h.real = {m.axis_origin.x,    m.axis_origin.y,    m.axis_origin.z,
            m.axis_direction.x, m.axis_direction.y, m.axis_direction.z};
  std::ranges::copy(m.frame, h.real.begin() + 6);
  return h;
}

void apply(const Header& h, SymmetryCellMesh& m) {
  m.dimension = h.whole[0];
  m.order = h.whole[1];
  m.fold = h.whole[2];
  m.nodes_per_element = h.whole[3];
  m.nodes_per_facet = h.whole[4];
  m.shape_tolerance_rel = std::bit_cast<float>(h.whole[5]);
  m.axis_origin = {h.real[0], h.real[1], h.real[2]};
  m.axis_direction = {h.real[3], h.real[4], h.real[5]};
  std::copy(h.real.begin() + 6, h.real.end(), m.frame.begin());
}

Result<Header> read_header(std::string_view bytes) {
  if (bytes.substr(0, kMagic.size()) != kMagic) {
    return fail(ErrorCode::kUnknownFormat, "not a symmetry cell archive of version 1");
  }
  if (bytes.size() < kHeaderBytes + 4) {
    return fail(ErrorCode::kTruncated, "the archive ends within its header");
  }
  Header header;
  const char* at = bytes.data() + kMagic.size();
  std::memcpy(&header.whole, at, sizeof header.whole);
  std::memcpy(&header.real, at + sizeof header.whole, sizeof header.real);
  return header;
}

bool all_below(const std::vector<std::int32_t>& indices,
               std::size_t limit,
               std::int32_t least = 0) {
  return std::ranges::all_of(indices, [&](std::int32_t i) {
    return i >= least && (i < 0 || static_cast<std::size_t>(i) < limit);
  });
}

// What readers of the mesh rely on; empty if it holds, else what does not.
std::string_view broken_rule(const SymmetryCellMesh& m) {
  const bool known_kind = (m.dimension == 2 || m.dimension == 3) && (m.order == 1 || m.order == 2);
  if (!known_kind || m.fold < 1 || m.fold > kMaxFold) return "dimension, order or fold";
  const std::int32_t element = m.dimension == 2 ? (m.order == 1 ? 3 : 6) : (m.order == 1 ? 4 : 10);
  const std::int32_t facet = m.dimension == 2 ? (m.order == 1 ? 2 : 3) : (m.order == 1 ? 3 : 6);
  if (m.nodes_per_element != element || m.nodes_per_facet != facet) return "nodes an element";
  const std::size_t nodes = m.nodes.size();
  const std::size_t elements = m.regions.size();
  const std::size_t facets = m.boundary_markers.size();
  const auto n = static_cast<std::size_t>(m.fold);
  const auto ke = static_cast<std::size_t>(element);
  const auto kf = static_cast<std::size_t>(facet);
  const bool sizes_fit =
      m.on_axis.size() == m.orbit_points.size() && m.node_markers.size() == nodes &&
      m.lower_to_higher.size() == nodes && m.elements.size() == elements * ke &&
      m.boundary.size() == facets * kf && m.boundary_is_higher_image.size() == facets &&
      m.lower_facets.size() % kf == 0 && m.higher_facets.size() == m.lower_facets.size() &&
      (m.sector_regions.empty() || m.sector_regions.size() == elements * n) &&
      (m.sector_boundary_markers.empty() || m.sector_boundary_markers.size() == facets * n);
  if (!sizes_fit) return "sizes of the arrays";
  const bool nodes_fit = std::ranges::all_of(m.nodes, [&](const OrbitVertex& v) {
    return v.orbit >= 0 && static_cast<std::size_t>(v.orbit) < m.orbit_points.size() &&
           v.exponent >= 0 && v.exponent < m.fold;
  });
  if (!nodes_fit) return "orbits or exponents of nodes";
  const bool indices_fit = all_below(m.elements, nodes) && all_below(m.boundary, nodes) &&
                           all_below(m.lower_facets, nodes) && all_below(m.higher_facets, nodes) &&
                           all_below(m.lower_to_higher, nodes, -1);
  return indices_fit ? std::string_view() : "indices of nodes";
}

}  // namespace

Result<void> write_cell_archive(const SymmetryCellMesh& cell, const Sink& sink) {
  uLong crc = crc32(0, nullptr, 0);
  const Sink summing = [&](std::string_view piece) {
    crc = crc32_z(crc, reinterpret_cast<const Bytef*>(piece.data()), piece.size());
    return sink(piece);
  };
  ByteWriter out(summing);
  out.text(kMagic);
  const Header header = header_of(cell);
  out.value(header.whole);
  out.value(header.real);
  each_array(cell, [&](const auto& array) { out.value(std::uint64_t{array.size()}); });
  each_array(cell,
             [&](const auto& array) { out.raw(array.data(), array.size() * entry_size(array)); });
  out.text(names_text(cell));
  out.flush();
  out.value(static_cast<std::uint32_t>(crc));
  return out.finish();
}

Result<std::int32_t> cell_archive_dimension(std::string_view bytes) {
  const Result<Header> header = read_header(bytes);
  if (!header) return error_of(header);
  return header->whole[0];
}

Result<SymmetryCellMesh> read_cell_archive(std::string_view bytes) {
  const Result<Header> header = read_header(bytes);
  if (!header) return error_of(header);
  std::array<std::uint64_t, kArrays> sizes{};
  std::memcpy(&sizes, bytes.data() + kHeaderBytes - sizeof sizes, sizeof sizes);
  // The sizes must make up the file exactly; no size is trusted before that.
  SymmetryCellMesh mesh;
  apply(*header, mesh);
  std::uint64_t expected = kHeaderBytes + 4;
  std::size_t i = 0;
  bool fits = true;
  each_array(mesh, [&](const auto& array) {
    fits = fits && sizes[i] <= (bytes.size() - expected) / entry_size(array);
    if (fits) expected += sizes[i] * entry_size(array);
    ++i;
  });
  if (!fits) return fail(ErrorCode::kTruncated, "the archive is shorter than its header says");
  std::uint32_t stored = 0;
  std::memcpy(&stored, bytes.data() + bytes.size() - 4, 4);
  const uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size() - 4);
  if (crc != stored) return fail(ErrorCode::kSyntax, "the archive's checksum does not match");
  const char* at = bytes.data() + kHeaderBytes;
  i = 0;
  each_array(mesh, [&](auto& array) {
    array.resize(static_cast<std::size_t>(sizes[i++]));
    const std::size_t size = array.size() * entry_size(array);
    if (size > 0) std::memcpy(array.data(), at, size);
    at += size;
  });
  const auto name_bytes = static_cast<std::size_t>(bytes.data() + bytes.size() - 4 - at);
  if (!read_names({at, name_bytes}, mesh.marker_names)) {
    return fail(ErrorCode::kSyntax, "the archive is longer than its header says");
  }
  if (const std::string_view rule = broken_rule(mesh); !rule.empty()) {
    return fail(ErrorCode::kSyntax, "the archive is damaged: " + std::string(rule) + " do not fit");
  }
  return mesh;
}

}  // namespace symcell
