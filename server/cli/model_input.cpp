#include "server/cli/model_input.hpp"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "api/formats/cell_input.hpp"
#include "api/formats/gzip.hpp"
#include "api/formats/model_reader.hpp"
#include "api/formats/vtu_reader.hpp"

namespace symcell::cli {
namespace {

// Meshes are larger than models.
constexpr std::size_t kMaxMeshBytes = std::size_t{16} << 30;

struct CloseFile {
  void operator()(std::FILE* file) const {
    if (file != stdin) std::fclose(file);
  }
};

Result<std::string> read_up_to(const std::string& path, std::size_t most) {
  const auto unreadable = [&] {
    return fail(ErrorCode::kUnreadable,
                "cannot read " + path + ": " + std::generic_category().message(errno));
  };
  const std::unique_ptr<std::FILE, CloseFile> file(path == "-" ? stdin
                                                               : std::fopen(path.c_str(), "rb"));
  if (!file) return unreadable();
  std::string bytes;
  std::string piece(std::size_t{1} << 18, '\0');
  while (true) {
    const std::size_t count = std::fread(piece.data(), 1, piece.size(), file.get());
    bytes.append(piece, 0, count);
    if (bytes.size() > most) {
      return fail(ErrorCode::kTooLarge, path + " has more than " + std::to_string(most) + " bytes");
    }
    if (count < piece.size()) break;
  }
  if (std::ferror(file.get()) != 0) return unreadable();
  return bytes;
}

}  // namespace

Result<std::string> read_input(const std::string& path) {
  return read_up_to(path, kMaxModelBytes);
}

Result<Model> read_model_file(const std::string& path, const ReadOptions& options) {
  const Result<std::string> bytes = read_input(path);
  if (!bytes) return error_of(bytes);
  return read_model(*bytes, model_format_from_name(path), nullptr, options);
}

Result<std::string> read_mesh_input(const std::string& path) {
  return read_up_to(path, kMaxMeshBytes);
}

Result<SymmetryCellMesh> read_cell_file(const std::string& path) {
  const Result<std::string> bytes = read_mesh_input(path);
  if (!bytes) return error_of(bytes);
  auto cell = read_cell(*bytes);
  if (!cell) cell.error().message = path + ": " + cell.error().message;
  return cell;
}

Result<MeshData> read_mesh_file(const std::string& path) {
  const Result<std::string> bytes = read_mesh_input(path);
  if (!bytes) return error_of(bytes);
  auto mesh = [&]() -> Result<MeshData> {
    if (!is_gzip(*bytes)) return read_vtu(*bytes);
    const Result<std::string> text = gunzip(*bytes, kMaxMeshBytes);
    if (!text) return error_of(text);
    return read_vtu(*text);
  }();
  if (mesh) return mesh;
  Error& error = mesh.error();
  error.message = path + ": " + error.message;
  if (error.code == ErrorCode::kUnknownFormat) {
    error.message += "; meshes are checked as VTU, which \"symcell convert " + path +
                     " --cell c.vtu\" makes of a cell in JSON or of a job";
  }
  return mesh;
}

}  // namespace symcell::cli
