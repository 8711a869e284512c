// What every target that meshes asks of the outcome.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include "api/formats/mesh_writer.hpp"
#include "api/formats/vtu_reader.hpp"
#include "core/cells/verify_mesh.hpp"
#include "core/mesh_model.hpp"
#include "tests/fuzz/fuzz_support.hpp"

namespace symcell::fuzz {

inline MeshData written_and_read(const SymmetryCellMesh& mesh, MeshPart part) {
  std::string bytes;
  const auto written = write_mesh(mesh, part, MeshFormat::kVtu, {}, [&](std::string_view piece) {
    bytes += piece;
    return true;
  });
  require(written.has_value(), "a mesh can be written");
  auto read = read_vtu(bytes);
  require(read.has_value(), "a written mesh can be read");
  return std::move(*read);
}

// Meshes the model within a budget of elements and seconds: an error that is not ours, or a mesh
// that holds against the model when it is written and read again.
// Returns whether there is a mesh.
inline bool mesh_and_check(const Model& model,
                           MeshOptions options,
                           std::uint64_t elements,
                           double seconds,
                           VerifyOptions checks = {}) {
  options.max_elements = elements;
  options.time_limit_s = seconds;
  ExecutionContext context;
  context.set_time_limit(seconds);
  context.set_max_elements(elements);
  const auto outcome = mesh_model(model, options, context);
  // With SYMCELL_FUZZ_TELL every outcome is told.
  const bool tell = std::getenv("SYMCELL_FUZZ_TELL") != nullptr;
  if (!outcome) {
    const Error& error = outcome.error();
    if (tell || error.code == ErrorCode::kInternal) {
      std::fprintf(stderr, "%s: %s\n", error_code_name(error.code).data(), error.message.c_str());
    }
    require_good_message(outcome.error());
    return false;
  }
  if (tell) {
    const Statistics& told = outcome->statistics;
    std::fprintf(stderr, "meshed: fold %d, %llu elements\n", outcome->mesh.fold,
                 static_cast<unsigned long long>(told.cell.elements));
  }
  require(outcome->statistics.cell.elements > 0, "a mesh has elements");
  require(outcome->statistics.cell.measure > 0, "and an area or volume");
  const MeshData cell = written_and_read(outcome->mesh, MeshPart::kCell);
  // Where sectors may differ in their regions, the cell does not tell them all.
  std::optional<MeshData> full;
  if (options.ignore_markers) full = written_and_read(outcome->mesh, MeshPart::kFull);
  checks.most_restored_nodes = 100'000;
  const VerifyReport report = verify_mesh(cell, full ? &*full : nullptr, &model, checks);
  for (const Check& check : report.checks) {
    if (check.status != Check::Status::kFail) continue;
    std::fprintf(stderr, "%s: %s\n", check.name.c_str(), check.detail.c_str());
  }
  require(report.ok(), "a mesh passes its checks");
  return true;
}

}  // namespace symcell::fuzz
