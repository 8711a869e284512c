// What every target that meshes asks of the outcome.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "api/formats/mesh_writer.hpp"
#include "api/formats/vtu_reader.hpp"
#include "core/mesh_model.hpp"
#include "core/verify/verify_mesh.hpp"
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

inline void require_good_report(const VerifyReport& report) {
  for (const Check& check : report.checks) {
    if (check.status != Check::Status::kFail) continue;
    std::fprintf(stderr, "%s: %s\n", check.name.c_str(), check.detail.c_str());
  }
  require(report.ok(), "a mesh passes its checks");
}

// Whether the pairs of the cell name all of its nodes that are one in the full mesh. Where a model
// touches itself they can be two steps apart, and then only the full mesh as written has them once.
inline bool tells_all_images(const SymmetryCellMesh& mesh) {
  std::map<std::int32_t, std::set<std::int32_t>> exponents;
  for (const OrbitVertex& node : mesh.nodes) exponents[node.orbit].insert(node.exponent);
  return std::ranges::all_of(exponents, [&](const auto& orbit) {
    const std::set<std::int32_t>& all = orbit.second;
    const auto ends = std::ranges::count_if(
        all, [&](std::int32_t e) { return !all.contains((e + 1) % mesh.fold); });
    return ends <= 1;
  });
}

// Meshes the model within a budget of elements and seconds: an error that is not ours, or a mesh
// that holds against the model when it is written and read again.
// Returns whether there is a mesh.
inline bool mesh_and_check(const Model& model,
                           MeshOptions options,
                           std::uint64_t elements,
                           double seconds,
                           VerifyOptions checks = {}) {
  // On slow machines, or to look at one input.
  if (const char* more = std::getenv("SYMCELL_FUZZ_SECONDS")) seconds = std::strtod(more, nullptr);
  options.max_elements = elements;
  options.time_limit_s = seconds;
  ExecutionContext context;
  context.set_time_limit(seconds);
  context.set_max_elements(elements);
  const auto outcome = mesh_model(model, options, context);
  // With SYMCELL_FUZZ_TELL every outcome is printed.
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
  checks.most_restored_nodes = 100'000;
  const MeshData cell = written_and_read(outcome->mesh, MeshPart::kCell);
  const MeshData full = written_and_read(outcome->mesh, MeshPart::kFull);
  require_good_report(verify_mesh(cell, &full, &model, checks));
  // Where sectors may differ in their regions, the cell does not hold them all.
  if (!options.ignore_markers && tells_all_images(outcome->mesh)) {
    require_good_report(verify_mesh(cell, nullptr, &model, checks));
  }
  return true;
}

}  // namespace symcell::fuzz
