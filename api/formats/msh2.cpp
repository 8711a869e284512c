// Gmsh 2.2 ASCII, for programs that read no 4.1 (Netgen, MFEM, ElmerGrid). Elements carry the tag of
// their group. There is no $Periodic: MFEM takes its pairs for one node each and would glue the cell
// to a ring without turning it.
#include "api/formats/gmsh_tags.hpp"
#include "api/formats/mesh_formats.hpp"
#include "api/formats/mesh_groups.hpp"

namespace symcell::internal {
namespace {

class Msh2Writer {
 public:
  Msh2Writer(MeshStream& mesh, ByteWriter& out)
      : mesh_(mesh), cell_(mesh.cell()), out_(out), groups_(mesh) {
    bounds_ = !mesh.full() && !cell_.lower_facets.empty();
    tags_ = gmsh_tags(groups_, bounds_);
  }

  void write() {
    out_.text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
    write_physical_names(cell_, groups_, tags_, out_);
    write_nodes();
    write_elements();
  }

 private:
  void count(std::int64_t n) {
    out_.integer(n);
    out_.character('\n');
  }

  void write_nodes() {
    out_.text("$Nodes\n");
    count(mesh_.node_count());
    std::int64_t tag = 0;
    mesh_.each_node([&](const Point3& p, std::int32_t) {
      out_.integer(++tag);
      for (const double c : {p.x, p.y, p.z}) {
        out_.character(' ');
        out_.real(c);
      }
      out_.character('\n');
    });
    out_.text("$EndNodes\n");
  }

  void write_element(std::span<const std::int64_t> nodes, int type, std::int32_t tag) {
    out_.integer(next_tag_++);
    for (const std::int64_t value :
         {std::int64_t{type}, std::int64_t{2}, std::int64_t{tag}, std::int64_t{tag}}) {
      out_.character(' ');
      out_.integer(value);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      out_.character(' ');
      out_.integer(nodes[gmsh_node(nodes.size(), i)] + 1);
    }
    out_.character('\n');
  }

  void write_bound(std::int32_t tag, int type, const std::vector<std::int32_t>& nodes) {
    const auto k = mesh_.nodes_per_facet();
    const std::vector<std::int64_t> ids(nodes.begin(), nodes.end());
    for (std::size_t i = 0; i < ids.size(); i += k) {
      write_element(std::span(ids).subspan(i, k), type, tag);
    }
  }

  void write_elements() {
    const GmshTypes types = gmsh_types(cell_);
    const std::size_t bound_facets =
        bounds_ ? 2 * cell_.lower_facets.size() / mesh_.nodes_per_facet() : 0;
    out_.text("$Elements\n");
    count(mesh_.element_count() + mesh_.facet_count() + static_cast<std::int64_t>(bound_facets));
    if (bounds_) {
      write_bound(tags_.lower, types.facet, cell_.lower_facets);
      write_bound(tags_.higher, types.facet, cell_.higher_facets);
    }
    for (std::size_t g = 0; g < tags_.markers.size(); ++g) {
      groups_.each_facet(g, [&](std::span<const std::int64_t> nodes, std::size_t, std::int32_t) {
        write_element(nodes, types.facet, tags_.markers[g]);
      });
    }
    for (std::size_t g = 0; g < tags_.regions.size(); ++g) {
      groups_.each_element(g, [&](std::span<const std::int64_t> nodes, std::size_t, std::int32_t) {
        write_element(nodes, types.element, tags_.regions[g]);
      });
    }
    out_.text("$EndElements\n");
  }

  MeshStream& mesh_;
  const SymmetryCellMesh& cell_;
  ByteWriter& out_;
  MeshGroups groups_;
  bool bounds_ = false;  // the file names lower and higher bound
  GmshTags tags_;
  std::int64_t next_tag_ = 1;
};

}  // namespace

void write_msh2(MeshStream& mesh, ByteWriter& out) {
  Msh2Writer(mesh, out).write();
}

}  // namespace symcell::internal
