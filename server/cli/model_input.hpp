// Input files of the commands: a path, or "-" for standard input.
#pragma once

#include <string>

#include "api/formats/model_reader.hpp"
#include "core/base/error.hpp"
#include "core/cell/symmetry_cell_mesh.hpp"
#include "core/model/model.hpp"
#include "core/verify/mesh_data.hpp"

namespace symcell::cli {

// All bytes.  Errors: kUnreadable (with the system's words), kTooLarge.
[[nodiscard]] Result<std::string> read_input(const std::string& path);

// A model; its format by the file's ending, else by content.
[[nodiscard]] Result<Model> read_model_file(const std::string& path,
                                            const ReadOptions& options = {});

// The same of a file of a mesh, which may be larger than a model.
[[nodiscard]] Result<std::string> read_mesh_input(const std::string& path);

// A cell as symcell wrote it, JSON, VTU or a job's.
[[nodiscard]] Result<SymmetryCellMesh> read_cell_file(const std::string& path);

// A VTU mesh, also gzip'd.
[[nodiscard]] Result<MeshData> read_mesh_file(const std::string& path);

}  // namespace symcell::cli
