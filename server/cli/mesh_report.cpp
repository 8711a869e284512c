#include "server/cli/mesh_report.hpp"

#include <cstdio>

#include "api/problem.hpp"

namespace symcell::cli {
namespace {

using Json = nlohmann::ordered_json;

bool has_mesh(const MeshReport& report) {
  return !report.error || report.error->code == ErrorCode::kGateFailed;
}

std::size_t failures(const MeshReport& report) {
  std::size_t count = 0;
  for (const GateResult& g : report.gates) count += g.failed ? 1 : 0;
  return count;
}

std::string seconds_of(const MeshReport& report) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", report.seconds);
  return text;
}

std::string suite_of(const MeshReport& report) {
  const bool error = !has_mesh(report);
  const std::string name = xml_escaped(report.model), time = seconds_of(report);
  std::string xml = "  <testsuite name=\"" + name + "\" tests=\"" +
                    std::to_string(1 + report.gates.size()) + "\" failures=\"" +
                    std::to_string(failures(report)) + "\" errors=\"" + (error ? "1" : "0") +
                    "\" time=\"" + time + "\">\n";
  xml += "    <testcase classname=\"" + name + "\" name=\"mesh\" time=\"" + time + "\"";
  if (error) {
    xml += ">\n      <error type=\"" + std::string(error_code_name(report.error->code)) +
           "\" message=\"" + xml_escaped(report.error->message) + "\"/>\n    </testcase>\n";
  } else {
    xml += "/>\n";
  }
  for (const GateResult& g : report.gates) {
    xml += "    <testcase classname=\"" + name + "\" name=\"" + xml_escaped(g.text) + "\"";
    if (!g.failed) {
      xml += "/>\n";
      continue;
    }
    xml += ">\n      <failure type=\"gate_failed\" message=\"" + xml_escaped(g.detail) +
           "\"/>\n    </testcase>\n";
  }
  return xml + "  </testsuite>\n";
}

}  // namespace

std::string report_status(const MeshReport& report) {
  if (!report.error) return "ok";
  return has_mesh(report) ? "failed" : "error";
}

Json report_to_json(const MeshReport& report) {
  Json json;
  json["model"] = report.model;
  json["status"] = report_status(report);
  json["error"] = report.error ? problem_document(*report.error, "", "/model") : Json(nullptr);
  json["warnings"] = report.warnings;
  json["gates"] = Json::array();
  for (const GateResult& g : report.gates) {
    json["gates"].push_back({{"gate", g.text}, {"passed", !g.failed}, {"detail", g.detail}});
  }
  json["seconds"] = report.seconds;
  json["statistics"] = report.statistics;
  return json;
}

std::string reports_to_junit(const std::vector<MeshReport>& reports) {
  std::size_t tests = 0, failed = 0, errors = 0;
  for (const MeshReport& r : reports) {
    tests += 1 + r.gates.size();
    failed += failures(r);
    errors += has_mesh(r) ? 0 : 1;
  }
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"symcell\" tests=\"" +
      std::to_string(tests) + "\" failures=\"" + std::to_string(failed) + "\" errors=\"" +
      std::to_string(errors) + "\">\n";
  for (const MeshReport& r : reports) xml += suite_of(r);
  return xml + "</testsuites>\n";
}

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: {
        // Names of files need not be UTF-8, and most control characters are not allowed.
        const auto u = static_cast<unsigned char>(c);
        out += u >= ' ' && u < 0x7f ? std::string(1, c) : std::string("?");
      }
    }
  }
  return out;
}

}  // namespace symcell::cli
