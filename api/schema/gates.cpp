#include "api/schema/gates.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace symcell {
namespace {

// Longer ones first.
constexpr std::array<std::string_view, 6> kComparisons = {"<=", ">=", "==", "!=", "<", ">"};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

bool is_figure(std::string_view text) {
  return !text.empty() &&
         text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_.") == std::string_view::npos;
}

bool holds(double figure, const Gate& gate) {
  if (gate.comparison == "<") return figure < gate.bound;
  if (gate.comparison == "<=") return figure <= gate.bound;
  if (gate.comparison == ">") return figure > gate.bound;
  if (gate.comparison == ">=") return figure >= gate.bound;
  return (figure == gate.bound) == (gate.comparison == "==");
}

// The number at a path; a list's length.
std::optional<double> figure_at(const nlohmann::ordered_json& document, std::string_view path) {
  const nlohmann::ordered_json* at = &document;
  while (!path.empty()) {
    const std::string name(path.substr(0, path.find('.')));
    path.remove_prefix(std::min(path.size(), name.size() + 1));
    if (at->is_object() && at->contains(name)) {
      at = &(*at)[name];
      continue;
    }
    std::size_t index = 0;
    const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), index);
    const bool is_index = error == std::errc{} && stop == name.data() + name.size();
    if (!at->is_array() || !is_index || index >= at->size()) return std::nullopt;
    at = &(*at)[index];
  }
  if (at->is_array()) return static_cast<double>(at->size());
  if (at->is_boolean()) return at->get<bool>() ? 1 : 0;
  if (!at->is_number()) return std::nullopt;
  return at->get<double>();
}

}  // namespace

std::optional<Gate> parse_gate(std::string_view text) {
  const std::size_t begin = text.find_first_of("<>=!");
  if (begin == std::string_view::npos) return std::nullopt;
  Gate gate;
  gate.figure = trimmed(text.substr(0, begin));
  for (const std::string_view c : kComparisons) {
    if (!text.substr(begin).starts_with(c)) continue;
    gate.comparison = c;
    break;
  }
  if (gate.comparison.empty() || !is_figure(gate.figure)) return std::nullopt;
  const std::string_view bound = trimmed(text.substr(begin + gate.comparison.size()));
  const auto [stop, error] = std::from_chars(bound.data(), bound.data() + bound.size(), gate.bound);
  if (bound.empty() || error != std::errc{} || stop != bound.data() + bound.size()) {
    return std::nullopt;
  }
  return std::isfinite(gate.bound) ? std::optional(gate) : std::nullopt;
}

std::vector<GateResult> judge(const std::vector<std::string>& gates,
                              const nlohmann::ordered_json& statistics) {
  std::vector<GateResult> results;
  for (const std::string& text : gates) {
    GateResult result{text, true, "this is no comparison"};
    if (const auto gate = parse_gate(text)) {
      const auto figure = figure_at(statistics, gate->figure);
      result.failed = !figure || holds(*figure, *gate);
      result.detail = figure ? gate->figure + " is " + nlohmann::json(*figure).dump()
                             : "the statistics have no figure " + gate->figure;
    }
    results.push_back(std::move(result));
  }
  return results;
}

Result<void> check_gates(const std::vector<GateResult>& results) {
  std::string message;
  for (const GateResult& r : results) {
    if (r.failed) message += (message.empty() ? "" : "; ") + r.text + ": " + r.detail;
  }
  if (message.empty()) return {};
  return fail(ErrorCode::kGateFailed,
              "the mesh is not acceptable by fail_on: " + message +
                  "; relax the condition, or ask for another mesh",
              {}, "/options/fail_on");
}

}  // namespace symcell
