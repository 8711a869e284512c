#include "api/formats/mesh_writer.hpp"
#include "api/formats/model_reader.hpp"
#include "api/formats/vtu_reader.hpp"
#include "core/cells/verify_mesh.hpp"
#include "core/mesh_model.hpp"
#include "tests/fuzz/fuzz_support.hpp"

// From bytes to a mesh with a small budget: an error that is not ours, or a mesh that holds.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  if (size > 20'000) return 0;
  const auto model = read_model(fuzz::text_of(data, size), std::nullopt);
  if (!model) return 0;
  MeshOptions options;
  options.min_angle_deg = 20;
  options.max_elements = 2'000;
  options.time_limit_s = 2;
  ExecutionContext context;
  context.set_time_limit(options.time_limit_s);
  context.set_max_elements(options.max_elements);
  const auto outcome = mesh_model(*model, options, context);
  if (!outcome) {
    fuzz::require(outcome.error().code != ErrorCode::kInternal, "no input is an internal error");
    return 0;
  }
  std::string bytes;
  const auto written =
      write_mesh(outcome->mesh, MeshPart::kCell, MeshFormat::kVtu, {}, [&](std::string_view piece) {
        bytes += piece;
        return true;
      });
  fuzz::require(written.has_value(), "a mesh can be written");
  const auto cell = read_vtu(bytes);
  fuzz::require(cell.has_value(), "a written mesh can be read");
  VerifyOptions checks;
  checks.most_restored_nodes = 100'000;
  checks.model_tolerance_rel = 1e-5;
  const VerifyReport report = verify_mesh(*cell, nullptr, &*model, checks);
  for (const Check& check : report.checks) {
    if (check.status != Check::Status::kFail) continue;
    std::fprintf(stderr, "%s: %s\n", check.name.c_str(), check.detail.c_str());
  }
  fuzz::require(report.ok(), "a mesh passes its checks");
  return 0;
}
