#include "api/formats/mesh_writer.hpp"

#include "api/formats/mesh_formats.hpp"

namespace symcell {

Result<void> write_mesh(const SymmetryCellMesh& cell,
                        MeshPart part,
                        MeshFormat format,
                        const WriteOptions& options,
                        const Sink& sink) {
  auto done = check_mesh_format(format, cell.dimension);
  if (!done) return done;
  ByteWriter out(sink);
  MeshStream mesh(cell, part);
  mesh.stop_when([&out] { return !out.ok(); });
  switch (format) {
    case MeshFormat::kJson: internal::write_json_mesh(mesh, out); break;
    case MeshFormat::kVtu: internal::write_vtu(mesh, options.vtu_encoding, out); break;
    case MeshFormat::kMsh: internal::write_msh(mesh, out); break;
    case MeshFormat::kSvg: internal::write_svg(mesh, out); break;
    case MeshFormat::kStl: done = internal::write_stl(mesh, options.stl_ascii, out); break;
  }
  if (!done) return done;
  return out.finish();
}

}  // namespace symcell
