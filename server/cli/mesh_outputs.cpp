#include "server/cli/mesh_outputs.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>

namespace symcell::cli {
namespace {

Result<MeshFormat> output_format(const std::string& path, const std::string& format) {
  std::string name = format;
  if (name.empty() && path == "-") name = "vtu";
  if (name.empty()) name = std::filesystem::path(path).extension().string();
  if (const std::optional<MeshFormat> found = mesh_format_from_name(name)) return *found;
  const std::string whose = format.empty() ? "the ending of " + path : "--format " + format;
  return fail(ErrorCode::kBadOption,
              whose + " names no format for meshes; take " + mesh_format_list());
}

}  // namespace

void add_output_flags(CLI::App& command, OutputArguments& arguments) {
  const auto add = [&](const char* name, std::string& target, const std::string& help,
                       const char* value) {
    command.add_option(name, target, help)->type_name(value)->group("Output");
  };
  add("--cell", arguments.cell, "the symmetry cell; - : standard output", "FILE");
  add("--full", arguments.full, "the full mesh, all n sectors", "FILE");
  add("--format", arguments.format, "of both meshes, whatever the endings: " + mesh_format_list(),
      "NAME");
  add("--encoding,--vtu-encoding", arguments.encoding,
      "of VTU and VTP files [raw]; of STL ascii or not", "raw|zlib|ascii");
  add("--packed", arguments.packed,
      "of JSON files: arrays in base64, coordinates in 32 bits (true) or 64 (exact) [false]",
      "true|exact|false");
  for (const DeckOptionInfo& info : deck_option_table()) {
    const std::string name(info.name);
    std::string help(info.help);
    if (!info.standard.empty()) help += " [" + std::string(info.standard) + "]";
    command
        .add_option_function<std::string>(
            "--" + name,
            [deck = &arguments.deck, name](const std::string& value) {
              deck->emplace_back(name, value);
            },
            help)
        ->type_name(std::string(info.metavar))
        ->multi_option_policy(CLI::MultiOptionPolicy::Throw)
        ->group("Decks");
  }
}

Result<WriteOptions> write_options(const OutputArguments& arguments) {
  WriteOptions options;
  for (const auto& [name, value] : arguments.deck) {
    SYMCELL_TRY(set_deck_option(options.deck, name, value));
  }
  const auto packed = packed_reals_from_name(arguments.packed);
  if (!packed) {
    return fail(ErrorCode::kBadOption,
                "--packed must be true, exact or false, not " + arguments.packed);
  }
  options.packed = *packed;
  const auto encoding = vtu_encoding_from_name(arguments.encoding);
  if (!encoding) {
    return fail(ErrorCode::kBadOption,
                "--encoding must be raw, zlib or ascii, not " + arguments.encoding);
  }
  options.vtu_encoding = *encoding;
  return options;
}

Result<std::vector<MeshOutput>> open_outputs(const OutputArguments& arguments) {
  const Result<WriteOptions> writing = write_options(arguments);
  if (!writing) return error_of(writing);
  std::vector<MeshOutput> outputs;
  for (const auto& [part, path] :
       {std::pair{MeshPart::kCell, arguments.cell}, std::pair{MeshPart::kFull, arguments.full}}) {
    if (path.empty()) continue;
    const Result<MeshFormat> format = output_format(path, arguments.format);
    if (!format) return error_of(format);
    Result<AtomicOutput> file = AtomicOutput::open(path);
    if (!file) return error_of(file);
    WriteOptions own = *writing;
    if (!takes_deck_options(*format)) own.deck = {};
    outputs.push_back({part, *format, own, std::move(*file)});
  }
  const bool deck = std::ranges::any_of(
      outputs, [](const MeshOutput& output) { return takes_deck_options(output.format); });
  if (!deck && !arguments.deck.empty()) {
    return fail(ErrorCode::kBadOption,
                "--" + arguments.deck.front().first +
                    " is for a deck: give --cell or --full as .inp, .bdf or .cdb");
  }
  for (const MeshOutput& output : outputs) {
    SYMCELL_TRY(check_write_options(output.format, output.options));
  }
  return outputs;
}

}  // namespace symcell::cli
