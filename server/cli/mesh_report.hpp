// What a run of the mesher was like, for pipelines: a JSON document and JUnit XML.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "api/schema/gates.hpp"
#include "core/base/error.hpp"

namespace symcell::cli {

// One model.
struct MeshReport {
  std::string model;
  std::optional<Error> error;  // no mesh, or a gate that failed
  nlohmann::ordered_json warnings = nlohmann::ordered_json::array();
  std::vector<GateResult> gates;      // empty where there is no mesh
  nlohmann::ordered_json statistics;  // null where there is no mesh
  double seconds = 0;
};

// {"model", "status": "ok" | "failed" | "error", "error", "warnings", "gates", "seconds", "statistics"}:
// failed: a gate; error: there is no mesh.
[[nodiscard]] nlohmann::ordered_json report_to_json(const MeshReport& report);

[[nodiscard]] std::string report_status(const MeshReport& report);

// A test suite a model: "mesh" is an error if there is none, each gate a test that fails or not.
[[nodiscard]] std::string reports_to_junit(const std::vector<MeshReport>& reports);

// `text` as it may stand in XML 1.0.
[[nodiscard]] std::string xml_escaped(const std::string& text);

}  // namespace symcell::cli
