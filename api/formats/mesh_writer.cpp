#include "api/formats/mesh_writer.hpp"

#include "api/formats/mesh_formats.hpp"

namespace symcell {

Result<void> write_mesh(const SymmetryCellMesh& cell,
                        MeshPart part,
                        MeshFormat format,
                        const WriteOptions& options,
                        const Sink& sink) {
  if (format == MeshFormat::kSvg && cell.dimension != 2) {
    return fail(ErrorCode::kUnsupportedModel, "svg shows planar meshes only; take vtu");
  }
  ByteWriter out(sink);
  MeshStream mesh(cell, part);
  mesh.stop_when([&out] { return !out.ok(); });
  switch (format) {
    case MeshFormat::kJson: internal::write_json_mesh(mesh, out); break;
    case MeshFormat::kVtu: internal::write_vtu(mesh, options.vtu_encoding, out); break;
    case MeshFormat::kMsh: internal::write_msh(mesh, out); break;
    case MeshFormat::kSvg: internal::write_svg(mesh, out); break;
  }
  return out.finish();
}

}  // namespace symcell
