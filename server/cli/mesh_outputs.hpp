// Where meshes go and in which format: flags that commands share.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "api/formats/mesh_writer.hpp"
#include "core/base/error.hpp"
#include "server/cli/atomic_output.hpp"

namespace CLI {
class App;
}

namespace symcell::cli {

struct OutputArguments {
  std::string cell;
  std::string full;
  std::string format;
  std::string encoding = "raw";
  std::string packed = "false";
  std::vector<std::pair<std::string, std::string>> deck;  // names and values as given
};

// Keeps a reference to `arguments`, which must outlive the parsing.
void add_output_flags(CLI::App& command, OutputArguments& arguments);

// Errors: kBadOption.
[[nodiscard]] Result<WriteOptions> write_options(const OutputArguments& arguments);

struct MeshOutput {
  MeshPart part;
  MeshFormat format;
  WriteOptions options;  // what of the command line is for this format
  AtomicOutput file;
};

// Opens all outputs.  Errors: kBadOption (a format that is none, options of another), kWriteFailed.
[[nodiscard]] Result<std::vector<MeshOutput>> open_outputs(const OutputArguments& arguments);

}  // namespace symcell::cli
