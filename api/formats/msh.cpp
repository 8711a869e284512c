// Entities: curves and surfaces (surfaces and volumes for solids) are discrete ones, numbered
// lower bound 1, higher bound 2, then one a boundary marker; regions from 1. Node and element tags
// are the ids of the other formats plus 1.
#include <algorithm>
#include <array>
#include <numbers>
#include <string>

#include "api/formats/mesh_formats.hpp"

namespace symcell::internal {
namespace {

constexpr std::int32_t kLowerTag = 1;
constexpr std::int32_t kHigherTag = 2;
constexpr std::int32_t kFirstMarkerTag = 3;

struct ElementTypes {
  int facet;
  int element;
};

ElementTypes gmsh_types(const SymmetryCellMesh& cell) {
  if (cell.dimension == 2) return cell.order == 1 ? ElementTypes{1, 2} : ElementTypes{8, 9};
  return cell.order == 1 ? ElementTypes{2, 4} : ElementTypes{9, 11};
}

// Gmsh's tetrahedron of 10 nodes has the last two mid-side nodes the other way round than VTK's.
constexpr std::array<std::size_t, 10> kGmshOrder{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};

// Positions in a sequence of things, grouped by a label; ascending labels, order kept in a group.
struct Groups {
  std::vector<std::int32_t> labels;
  std::vector<std::uint32_t> order;
  std::vector<std::size_t> first;  // of group g in `order`; one more at the end
};

template <class F>
Groups group_by(std::size_t count, F label) {
  Groups groups;
  groups.order.resize(count);
  for (std::size_t i = 0; i < count; ++i) groups.order[i] = static_cast<std::uint32_t>(i);
  std::ranges::stable_sort(groups.order, {}, label);
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t value = label(groups.order[i]);
    if (!groups.labels.empty() && groups.labels.back() == value) continue;
    groups.labels.push_back(value);
    groups.first.push_back(i);
  }
  groups.first.push_back(count);
  return groups;
}

struct Box {
  Point3 low{1e300, 1e300, 1e300};
  Point3 high{-1e300, -1e300, -1e300};
};

class MshWriter {
 public:
  MshWriter(MeshStream& mesh, ByteWriter& out)
      : mesh_(mesh), cell_(mesh.cell()), out_(out), dimension_(cell_.dimension) {
    bounds_ = !mesh.full() && !cell_.lower_facets.empty();
    // Where labels differ between sectors, (thing, sector) pairs are grouped instead of things.
    const auto n = static_cast<std::size_t>(cell_.fold);
    varied_regions_ = mesh.full() && !cell_.sector_regions.empty();
    varied_markers_ = mesh.full() && !cell_.sector_boundary_markers.empty();
    regions_ = group_by(cell_.element_count() * (varied_regions_ ? n : 1), [&](std::uint32_t i) {
      return varied_regions_ ? cell_.sector_regions[i] : cell_.regions[i];
    });
    for (std::size_t b = 0; b < cell_.facet_count(); ++b) {
      if (mesh.full() && cell_.boundary_is_higher_image[b] != 0) continue;
      facets_.push_back(static_cast<std::uint32_t>(b));
    }
    markers_ = group_by(facets_.size() * (varied_markers_ ? n : 1), [&](std::uint32_t i) {
      return varied_markers_ ? cell_.sector_boundary_markers[facets_[i / n] * n + i % n]
                             : cell_.boundary_markers[facets_[i]];
    });
  }

  void write() {
    out_.text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    write_names();
    write_entities();
    write_nodes();
    write_elements();
    if (bounds_) write_periodic();
  }

 private:
  template <class... T>
  void line(T... values) {
    bool first = true;
    const auto put = [&](auto value) {
      if (!first) out_.character(' ');
      first = false;
      if constexpr (std::is_floating_point_v<decltype(value)>) {
        out_.real(value);
      } else {
        out_.integer(static_cast<std::int64_t>(value));
      }
    };
    (put(values), ...);
    out_.character('\n');
  }

  void write_name(std::int32_t dimension, std::size_t tag, const std::string& name) {
    out_.integer(dimension);
    out_.character(' ');
    out_.integer(static_cast<std::int64_t>(tag));
    out_.text(" \"");
    out_.text(name);
    out_.text("\"\n");
  }

  void write_names() {
    out_.text("$PhysicalNames\n");
    line(regions_.labels.size() + markers_.labels.size() + (bounds_ ? 2u : 0u));
    if (bounds_) {
      write_name(dimension_ - 1, kLowerTag, "lower_bound");
      write_name(dimension_ - 1, kHigherTag, "higher_bound");
    }
    for (std::size_t g = 0; g < markers_.labels.size(); ++g) {
      write_name(dimension_ - 1, kFirstMarkerTag + g, marker_name(markers_.labels[g]));
    }
    for (std::size_t g = 0; g < regions_.labels.size(); ++g) {
      write_name(dimension_, g + 1, "region_" + std::to_string(regions_.labels[g]));
    }
    out_.text("$EndPhysicalNames\n");
  }

  // As the model calls it; names are in quotes and hold none.
  [[nodiscard]] std::string marker_name(std::int32_t marker) const {
    const auto& names = mesh_.cell().marker_names;
    const auto known = std::ranges::find(names, marker, &MarkerName::marker);
    if (known == names.end()) return "boundary_" + std::to_string(marker);
    std::string name = known->name;
    std::ranges::replace(name, '"', '\'');
    return name;
  }

  // One discrete entity: tag, bounding box, its physical group (of the same tag), no boundary.
  void write_entity(std::size_t tag, const Box& box) {
    line(static_cast<std::int64_t>(tag), box.low.x, box.low.y, box.low.z, box.high.x, box.high.y,
         box.high.z, 1, static_cast<std::int64_t>(tag), 0);
  }

  void write_entities() {
    Box box;
    mesh_.each_node([&](const Point3& p, std::int32_t) {
      box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
      box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
    });
    const std::size_t facets = markers_.labels.size() + (bounds_ ? 2 : 0);
    out_.text("$Entities\n");
    if (dimension_ == 2) {
      line(0, facets, regions_.labels.size(), 0);
    } else {
      line(0, 0, facets, regions_.labels.size());
    }
    if (bounds_) {
      write_entity(kLowerTag, box);
      write_entity(kHigherTag, box);
    }
    for (std::size_t g = 0; g < markers_.labels.size(); ++g) write_entity(kFirstMarkerTag + g, box);
    for (std::size_t g = 0; g < regions_.labels.size(); ++g) write_entity(g + 1, box);
    out_.text("$EndEntities\n");
  }

  void write_coordinates(const Point3& p) { line(p.x, p.y, p.z); }

  // Nodes on a bound belong to its entity, all others to the first region.
  void write_nodes() {
    const std::int64_t count = mesh_.node_count();
    out_.text("$Nodes\n");
    if (!bounds_) {
      line(1, count, 1, count);
      line(dimension_, 1, 0, count);
      for (std::int64_t i = 1; i <= count && out_.ok(); ++i) line(i);
      mesh_.each_node([&](const Point3& p, std::int32_t) { write_coordinates(p); });
      out_.text("$EndNodes\n");
      return;
    }
    std::vector<std::uint8_t> place(cell_.nodes.size(), 0);  // 0 region, 1 lower, 2 higher
    for (const std::int32_t i : cell_.higher_facets)
      place[static_cast<std::size_t>(i)] = kHigherTag;
    for (const std::int32_t i : cell_.lower_facets) place[static_cast<std::size_t>(i)] = kLowerTag;
    const Groups groups = group_by(place.size(), [&](std::uint32_t i) { return place[i]; });
    line(groups.labels.size(), count, 1, count);
    for (std::size_t g = 0; g < groups.labels.size(); ++g) {
      const std::int32_t at = groups.labels[g];
      const auto members =
          std::span(groups.order).subspan(groups.first[g], groups.first[g + 1] - groups.first[g]);
      line(at == 0 ? dimension_ : dimension_ - 1, at == 0 ? 1 : at, 0, members.size());
      for (const std::uint32_t i : members) line(i + 1);
      for (const std::uint32_t i : members) write_coordinates(mesh_.view().cell_node_position(i));
    }
    out_.text("$EndNodes\n");
  }

  // The tags run on over all blocks.
  void write_element(std::span<const std::int32_t> nodes, std::span<const std::int64_t> table) {
    out_.integer(next_tag_++);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::int32_t node = nodes[nodes.size() == kGmshOrder.size() ? kGmshOrder[i] : i];
      out_.character(' ');
      out_.integer(table[static_cast<std::size_t>(node)] + 1);
    }
    out_.character('\n');
  }

  // A block of one entity: facets or elements of one label in all sectors.
  template <class Nodes>
  void write_block(const Groups& groups,
                   std::size_t g,
                   bool varied,
                   std::int64_t entity_dimension,
                   std::size_t tag,
                   int type,
                   Nodes nodes_of) {
    const std::size_t size = groups.first[g + 1] - groups.first[g];
    const auto members = std::span(groups.order).subspan(groups.first[g], size);
    const auto sectors = static_cast<std::size_t>(mesh_.sectors());
    line(entity_dimension, tag, type, varied ? size : size * sectors);
    if (!varied) {
      for (std::int32_t s = 0; s < mesh_.sectors() && out_.ok(); ++s) {
        const auto table = mesh_.node_table(s);
        for (const std::uint32_t i : members) write_element(nodes_of(i), table);
      }
      return;
    }
    // Members are (thing, sector) pairs with the sector running fastest: go by sectors.
    for (std::size_t s = 0; s < sectors && out_.ok(); ++s) {
      const auto table = mesh_.node_table(static_cast<std::int32_t>(s));
      for (const std::uint32_t i : members) {
        if (i % sectors == s) {
          write_element(nodes_of(static_cast<std::uint32_t>(i / sectors)), table);
        }
      }
    }
  }

  void write_bound(std::int32_t tag, int type, const std::vector<std::int32_t>& nodes) {
    const auto k = mesh_.nodes_per_facet();
    line(dimension_ - 1, tag, type, nodes.size() / k);
    const auto table = mesh_.node_table(0);
    for (std::size_t i = 0; i < nodes.size(); i += k) {
      write_element(std::span(nodes).subspan(i, k), table);
    }
  }

  void write_elements() {
    const ElementTypes types = gmsh_types(cell_);
    const auto kf = mesh_.nodes_per_facet();
    const auto ke = mesh_.nodes_per_element();
    const std::size_t bound_facets =
        bounds_ ? (cell_.lower_facets.size() + cell_.higher_facets.size()) / kf : 0;
    const std::int64_t total =
        mesh_.element_count() + mesh_.facet_count() + static_cast<std::int64_t>(bound_facets);
    out_.text("$Elements\n");
    line(regions_.labels.size() + markers_.labels.size() + (bounds_ ? 2u : 0u), total, 1, total);
    if (bounds_) {
      write_bound(kLowerTag, types.facet, cell_.lower_facets);
      write_bound(kHigherTag, types.facet, cell_.higher_facets);
    }
    for (std::size_t g = 0; g < markers_.labels.size(); ++g) {
      write_block(
          markers_, g, varied_markers_, dimension_ - 1, kFirstMarkerTag + g, types.facet,
          [&](std::uint32_t i) { return std::span(cell_.boundary).subspan(facets_[i] * kf, kf); });
    }
    for (std::size_t g = 0; g < regions_.labels.size(); ++g) {
      write_block(regions_, g, varied_regions_, dimension_, g + 1, types.element,
                  [&](std::uint32_t i) { return std::span(cell_.elements).subspan(i * ke, ke); });
    }
    out_.text("$EndElements\n");
  }

  // The higher bound is the image of the lower one under a turn of +360/n about the axis.
  void write_periodic() {
    out_.text("$Periodic\n1\n");
    line(dimension_ - 1, kHigherTag, kLowerTag);
    const RotationTable& rotations = mesh_.view().rotations();
    const Point2 turned = rotations.rotate(Point2{1, 0}, cell_.fold > 1 ? 1 : 0);
    const double c = turned.x;
    const double s = turned.y;
    // Rodrigues: R = c I + (1 - c) u u^T + s [u]x, and the translation o - R o.
    const Point3& u = cell_.axis_direction;
    const Point3& o = cell_.axis_origin;
    const double t = 1 - c;
    const double r[3][3] = {{c + t * u.x * u.x, t * u.x * u.y - s * u.z, t * u.x * u.z + s * u.y},
                            {t * u.x * u.y + s * u.z, c + t * u.y * u.y, t * u.y * u.z - s * u.x},
                            {t * u.x * u.z - s * u.y, t * u.y * u.z + s * u.x, c + t * u.z * u.z}};
    out_.text("16");
    const double origin[3] = {o.x, o.y, o.z};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        out_.character(' ');
        out_.real(r[i][j]);
      }
      out_.character(' ');
      out_.real(origin[i] - (r[i][0] * o.x + r[i][1] * o.y + r[i][2] * o.z));
    }
    out_.text(" 0 0 0 1\n");
    const auto pairs =
        std::ranges::count_if(cell_.lower_to_higher, [](std::int32_t image) { return image >= 0; });
    line(pairs);
    for (std::size_t i = 0; i < cell_.lower_to_higher.size(); ++i) {
      const std::int32_t image = cell_.lower_to_higher[i];
      if (image >= 0) line(image + 1, i + 1);
    }
    out_.text("$EndPeriodic\n");
  }

  MeshStream& mesh_;
  const SymmetryCellMesh& cell_;
  ByteWriter& out_;
  std::int32_t dimension_;
  bool bounds_ = false;  // the file names lower and higher bound
  bool varied_regions_ = false;
  bool varied_markers_ = false;
  Groups regions_;                     // of elements, or (element, sector) pairs
  std::vector<std::uint32_t> facets_;  // boundary facets that are written
  Groups markers_;                     // of positions in facets_, or (position, sector) pairs
  std::int64_t next_tag_ = 1;
};

}  // namespace

void write_msh(MeshStream& mesh, ByteWriter& out) {
  MshWriter(mesh, out).write();
}

}  // namespace symcell::internal
