// JSON with arrays in base64, little-endian: what a program loads in the time that it takes to copy.
//
// An array is {"type", "shape", "data"}, of a type that holds its values in the fewest bytes; "uint24"
// is three bytes, least first. One whose values are all the same is {"type", "shape", "value"}.
#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>

#include "api/formats/mesh_formats.hpp"

namespace symcell::internal {
namespace {

// Bytes on their way to base64: whole triples are turned into four characters at once.
class Base64Writer {
 public:
  explicit Base64Writer(ByteWriter& out) : out_(&out) {}

  void put(const void* bytes, std::size_t size) {
    const auto* at = static_cast<const std::uint8_t*>(bytes);
    for (std::size_t i = 0; i < size; ++i) {
      triple_ = triple_ << 8U | at[i];
      if (++held_ == 3) flush_triple();
    }
  }
  void finish() {
    if (held_ == 0) return;
    const std::size_t missing = 3 - held_;
    for (std::size_t i = 0; i < missing; ++i) triple_ <<= 8U;
    std::array<char, 4> text = characters();
    for (std::size_t i = 0; i < missing; ++i) text[3 - i] = '=';
    out_->raw(text.data(), text.size());
  }

 private:
  [[nodiscard]] std::array<char, 4> characters() const {
    constexpr std::string_view kAlphabet =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    return {kAlphabet[triple_ >> 18U & 63U], kAlphabet[triple_ >> 12U & 63U],
            kAlphabet[triple_ >> 6U & 63U], kAlphabet[triple_ & 63U]};
  }
  void flush_triple() {
    const std::array<char, 4> text = characters();
    out_->raw(text.data(), text.size());
    triple_ = 0;
    held_ = 0;
  }

  ByteWriter* out_;
  std::uint32_t triple_ = 0;
  std::size_t held_ = 0;
};

struct IntegerType {
  std::string_view name;
  std::size_t bytes;
  std::int64_t least;
  std::int64_t most;
};
constexpr std::array<IntegerType, 6> kIntegerTypes{{
    {"uint8", 1, 0, 0xFF},
    {"uint16", 2, 0, 0xFFFF},
    {"uint24", 3, 0, 0xFFFFFF},
    {"int32", 4, std::numeric_limits<std::int32_t>::min(),
     std::numeric_limits<std::int32_t>::max()},
    {"uint32", 4, 0, 0xFFFFFFFF},
    {"int64", 8, std::numeric_limits<std::int64_t>::min(),
     std::numeric_limits<std::int64_t>::max()},
}};

const IntegerType& type_for(std::int64_t least, std::int64_t most) {
  return *std::ranges::find_if(
      kIntegerTypes, [&](const IntegerType& t) { return t.least <= least && most <= t.most; });
}

class PackedJson {
 public:
  PackedJson(MeshStream& mesh, PackedReals reals, ByteWriter& out)
      : mesh_(mesh), cell_(mesh.cell()), reals_(reals), out_(out) {}

  void write() {
    write_head();
    write_nodes();
    const std::int64_t last_node = mesh_.node_count() - 1;
    write_integers(
        "elements", mesh_.element_count(), cell_.nodes_per_element, 0, last_node, [&](auto put) {
          mesh_.each_element([&](std::span<const std::int64_t> ids, std::size_t, std::int32_t) {
            for (const std::int64_t id : ids) put(id);
          });
        });
    write_labels();
    write_boundary(last_node);
    write_bounds(last_node);
    if (mesh_.full()) {
      out_.text(",\n\"cell_elements\":");
      out_.integer(static_cast<std::int64_t>(cell_.element_count()));
    }
    out_.text("}\n");
  }

 private:
  static constexpr std::int64_t kFlat = 0;  // no second extent

  void write_head() {
    out_.text("{\"packed\":\"");
    out_.text(reals_ == PackedReals::kFloat32 ? "float32" : "float64");
    out_.text("\",\"dimension\":");
    out_.integer(cell_.dimension);
    out_.text(",\"order\":");
    out_.integer(cell_.order);
    out_.text(",\"fold\":");
    out_.integer(cell_.fold);
    nlohmann::ordered_json axis;
    axis["origin"] = {cell_.axis_origin.x, cell_.axis_origin.y, cell_.axis_origin.z};
    axis["direction"] = {cell_.axis_direction.x, cell_.axis_direction.y, cell_.axis_direction.z};
    out_.text(",\"axis\":");
    out_.text(axis.dump());
    if (cell_.marker_names.empty()) return;
    nlohmann::ordered_json names;
    for (const MarkerName& n : cell_.marker_names) names[std::to_string(n.marker)] = n.name;
    constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;  // what is no UTF-8
    out_.text(",\n\"marker_names\":");
    out_.text(names.dump(-1, ' ', false, kReplace));
  }

  void begin(std::string_view name, std::string_view type, std::int64_t count, std::int64_t width) {
    out_.text(",\n\"");
    out_.text(name);
    out_.text("\":{\"type\":\"");
    out_.text(type);
    out_.text("\",\"shape\":[");
    out_.integer(count);
    if (width != kFlat) {
      out_.character(',');
      out_.integer(width);
    }
    out_.character(']');
  }

  // Single precision counts from the axis, so that a model far from the origin keeps its digits.
  void write_nodes() {
    const bool single = reals_ == PackedReals::kFloat32;
    if (single) {
      nlohmann::ordered_json origin = {cell_.axis_origin.x, cell_.axis_origin.y};
      if (cell_.dimension == 3) origin.push_back(cell_.axis_origin.z);
      out_.text(",\n\"origin\":");
      out_.text(origin.dump());
    }
    begin("nodes", single ? "float32" : "float64", mesh_.node_count(), cell_.dimension);
    out_.text(",\"data\":\"");
    Base64Writer base64(out_);
    const auto put = [&](double c, double from) {
      if (single) {
        const auto value = static_cast<float>(c - from);
        base64.put(&value, sizeof value);
      } else {
        base64.put(&c, sizeof c);
      }
    };
    mesh_.each_node([&](const Point3& p, std::int32_t) {
      put(p.x, cell_.axis_origin.x);
      put(p.y, cell_.axis_origin.y);
      if (cell_.dimension == 3) put(p.z, cell_.axis_origin.z);
    });
    base64.finish();
    out_.text("\"}");
  }

  // `generate` calls its argument for every value, which lies within [least, most].
  template <class Generate>
  void write_integers(std::string_view name,
                      std::int64_t count,
                      std::int64_t width,
                      std::int64_t least,
                      std::int64_t most,
                      Generate generate) {
    const IntegerType& type = type_for(least, most);
    begin(name, type.name, count, width);
    if (least == most && count > 0) {
      out_.text(",\"value\":");
      out_.integer(least);
      out_.character('}');
      return;
    }
    out_.text(",\"data\":\"");
    Base64Writer base64(out_);
    // Little-endian: the first bytes of a value are its least.
    generate([&](std::int64_t value) { base64.put(&value, type.bytes); });
    base64.finish();
    out_.text("\"}");
  }

  struct Range {
    std::int64_t least = 0;
    std::int64_t most = 0;
  };
  static Range range_of(const std::vector<std::int32_t>& a, const std::vector<std::int32_t>& b) {
    Range range{std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min()};
    for (const auto* values : {&a, &b}) {
      for (const std::int32_t value : *values) {
        range.least = std::min<std::int64_t>(range.least, value);
        range.most = std::max<std::int64_t>(range.most, value);
      }
    }
    return range.least > range.most ? Range{} : range;
  }

  void write_labels() {
    const Range regions = range_of(cell_.regions, cell_.sector_regions);
    write_integers(
        "regions", mesh_.element_count(), kFlat, regions.least, regions.most, [&](auto put) {
          mesh_.each_element_index([&](std::size_t e, std::int32_t s) { put(cell_.region(e, s)); });
        });
    const Range markers = range_of(cell_.node_markers, {});
    write_integers("markers", mesh_.node_count(), kFlat, markers.least, markers.most,
                   [&](auto put) { mesh_.each_node_marker([&](std::int32_t m) { put(m); }); });
  }

  void write_boundary(std::int64_t last_node) {
    const std::int64_t facets = mesh_.facet_count();
    write_integers("boundary", facets, cell_.nodes_per_facet, 0, last_node, [&](auto put) {
      mesh_.each_facet([&](std::span<const std::int64_t> ids, std::int32_t) {
        for (const std::int64_t id : ids) put(id);
      });
    });
    const Range markers = range_of(cell_.boundary_markers, cell_.sector_boundary_markers);
    write_integers("boundary_markers", facets, kFlat, markers.least, markers.most, [&](auto put) {
      mesh_.each_facet([&](std::span<const std::int64_t>, std::int32_t marker) { put(marker); });
    });
  }

  // In the ids of sector 0.
  void write_bounds(std::int64_t last_node) {
    const auto table = mesh_.node_table(0);
    const auto id = [&](std::int32_t node) { return table[static_cast<std::size_t>(node)]; };
    const auto pairs =
        std::ranges::count_if(cell_.lower_to_higher, [](std::int32_t image) { return image >= 0; });
    for (const bool lower : {true, false}) {
      write_integers(lower ? "lower" : "higher", pairs, kFlat, 0, last_node, [&](auto put) {
        for (std::size_t i = 0; i < cell_.lower_to_higher.size(); ++i) {
          const std::int32_t image = cell_.lower_to_higher[i];
          if (image >= 0) put(id(lower ? static_cast<std::int32_t>(i) : image));
        }
      });
    }
    const auto width = static_cast<std::int64_t>(cell_.nodes_per_facet);
    for (const bool lower : {true, false}) {
      const auto& facets = lower ? cell_.lower_facets : cell_.higher_facets;
      write_integers(lower ? "lower_facets" : "higher_facets",
                     static_cast<std::int64_t>(facets.size()) / width, width, 0, last_node,
                     [&](auto put) {
                       for (const std::int32_t node : facets) put(id(node));
                     });
    }
  }

  MeshStream& mesh_;
  const SymmetryCellMesh& cell_;
  PackedReals reals_;
  ByteWriter& out_;
};

}  // namespace

void write_packed_json(MeshStream& mesh, PackedReals reals, ByteWriter& out) {
  PackedJson(mesh, reals, out).write();
}

}  // namespace symcell::internal
