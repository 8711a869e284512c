// Gmsh 4.1: every group is a discrete entity and a physical group of one tag. Node tags are the ids
// of the other formats plus 1, element tags run on over the groups.
#include <algorithm>

#include "api/formats/gmsh_tags.hpp"
#include "api/formats/mesh_formats.hpp"
#include "api/formats/mesh_groups.hpp"
#include "api/formats/turn_map.hpp"

namespace symcell::internal {
namespace {

struct Box {
  Point3 low{1e300, 1e300, 1e300};
  Point3 high{-1e300, -1e300, -1e300};
};

class MshWriter {
 public:
  MshWriter(MeshStream& mesh, ByteWriter& out)
      : mesh_(mesh), cell_(mesh.cell()), out_(out), dimension_(cell_.dimension), groups_(mesh) {
    bounds_ = !mesh.full() && !cell_.lower_facets.empty();
    tags_ = gmsh_tags(groups_, bounds_);
  }

  void write() {
    out_.text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    write_physical_names(cell_, groups_, tags_, out_);
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

  // One discrete entity: tag, bounding box, its physical group (of the same tag), no boundary.
  void write_entity(std::int32_t tag, const Box& box) {
    line(tag, box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z, 1, tag, 0);
  }

  void write_entities() {
    Box box;
    mesh_.each_node([&](const Point3& p, std::int32_t) {
      box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
      box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
    });
    const std::size_t facets = tags_.markers.size() + (bounds_ ? 2 : 0);
    out_.text("$Entities\n");
    if (dimension_ == 2) {
      line(0, facets, tags_.regions.size(), 0);
    } else {
      line(0, 0, facets, tags_.regions.size());
    }
    if (bounds_) {
      write_entity(tags_.lower, box);
      write_entity(tags_.higher, box);
    }
    for (const std::int32_t tag : tags_.markers) write_entity(tag, box);
    for (const std::int32_t tag : tags_.regions) write_entity(tag, box);
    out_.text("$EndEntities\n");
  }

  void write_coordinates(const Point3& p) { line(p.x, p.y, p.z); }

  // Nodes on a bound belong to its entity, all others to the first region.
  void write_nodes() {
    const std::int64_t count = mesh_.node_count();
    out_.text("$Nodes\n");
    if (!bounds_) {
      line(1, count, 1, count);
      line(dimension_, tags_.regions.front(), 0, count);
      for (std::int64_t i = 1; i <= count && out_.ok(); ++i) line(i);
      mesh_.each_node([&](const Point3& p, std::int32_t) { write_coordinates(p); });
      out_.text("$EndNodes\n");
      return;
    }
    std::vector<std::int32_t> place(cell_.nodes.size(), 0);  // of a bound its tag
    for (const std::int32_t i : cell_.higher_facets)
      place[static_cast<std::size_t>(i)] = tags_.higher;
    for (const std::int32_t i : cell_.lower_facets)
      place[static_cast<std::size_t>(i)] = tags_.lower;
    const LabelGroups blocks = group_by(place.size(), [&](std::uint32_t i) { return place[i]; });
    line(blocks.count(), count, 1, count);
    for (std::size_t g = 0; g < blocks.count(); ++g) {
      const std::int32_t at = blocks.labels[g];
      const auto members = blocks.members(g);
      line(at == 0 ? dimension_ : dimension_ - 1, at == 0 ? tags_.regions.front() : at, 0,
           members.size());
      for (const std::uint32_t i : members) line(i + 1);
      for (const std::uint32_t i : members) write_coordinates(mesh_.view().cell_node_position(i));
    }
    out_.text("$EndNodes\n");
  }

  // The tags run on over all blocks.
  void write_element(std::span<const std::int64_t> nodes) {
    out_.integer(next_tag_++);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      out_.character(' ');
      out_.integer(nodes[gmsh_node(nodes.size(), i)] + 1);
    }
    out_.character('\n');
  }

  void write_bound(std::int32_t tag, int type, const std::vector<std::int32_t>& nodes) {
    const auto k = mesh_.nodes_per_facet();
    line(dimension_ - 1, tag, type, nodes.size() / k);
    const std::vector<std::int64_t> ids(nodes.begin(), nodes.end());
    for (std::size_t i = 0; i < ids.size(); i += k) write_element(std::span(ids).subspan(i, k));
  }

  // One block a group.
  void write_elements() {
    const GmshTypes types = gmsh_types(cell_);
    const std::size_t bound_facets =
        bounds_ ? 2 * cell_.lower_facets.size() / mesh_.nodes_per_facet() : 0;
    const std::int64_t total =
        mesh_.element_count() + mesh_.facet_count() + static_cast<std::int64_t>(bound_facets);
    out_.text("$Elements\n");
    line(tags_.regions.size() + tags_.markers.size() + (bounds_ ? 2u : 0u), total, 1, total);
    if (bounds_) {
      write_bound(tags_.lower, types.facet, cell_.lower_facets);
      write_bound(tags_.higher, types.facet, cell_.higher_facets);
    }
    const auto put = [this](std::span<const std::int64_t> nodes, std::size_t, std::int32_t) {
      write_element(nodes);
    };
    for (std::size_t g = 0; g < tags_.markers.size(); ++g) {
      line(dimension_ - 1, tags_.markers[g], types.facet, groups_.marker_size(g));
      groups_.each_facet(g, put);
    }
    for (std::size_t g = 0; g < tags_.regions.size(); ++g) {
      line(dimension_, tags_.regions[g], types.element, groups_.region_size(g));
      groups_.each_element(g, put);
    }
    out_.text("$EndElements\n");
  }

  // The higher bound is the image of the lower one under a turn of +360/n about the axis.
  void write_periodic() {
    out_.text("$Periodic\n1\n");
    line(dimension_ - 1, tags_.higher, tags_.lower);
    const TurnMap turn = turn_map(mesh_.view(), 1);
    out_.text("16");
    for (std::size_t i = 0; i < 3; ++i) {
      for (const double entry : turn.rotation[i]) {
        out_.character(' ');
        out_.real(entry);
      }
      out_.character(' ');
      out_.real(turn.offset[i]);
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
  MeshGroups groups_;
  GmshTags tags_;
  std::int64_t next_tag_ = 1;
};

}  // namespace

void write_msh(MeshStream& mesh, ByteWriter& out) {
  MshWriter(mesh, out).write();
}

}  // namespace symcell::internal
