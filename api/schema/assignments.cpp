#include "api/schema/assignments.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace symcell::internal {
namespace {

constexpr double kMostCoordinate = 1e60;  // as for the vertices of a model

// The whole of `text` as a number.
template <class Number>
bool read_whole(std::string_view text, Number& into) {
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), into);
  return !text.empty() && error == std::errc{} && stop == text.data() + text.size();
}

// "1.5/0/2"
bool read_place(std::string_view text, Point3& into) {
  for (double* part : {&into.x, &into.y, &into.z}) {
    const std::string_view one = text.substr(0, text.find('/'));
    if (!read_whole(one, *part) || !(std::abs(*part) <= kMostCoordinate)) return false;
    text.remove_prefix(std::min(text.size(), one.size() + 1));
  }
  return text.empty();
}

// What an assignment is of: "marker:3", or a name.
bool read_subject(std::string_view text, Assignment& next) {
  const auto taken = [&](std::string_view word) {
    if (!text.starts_with(word) || text.size() <= word.size()) return false;
    const char after = text[word.size()];
    if (after != ':' && after != ' ') return false;
    text.remove_prefix(word.size() + 1);
    return true;
  };
  using Of = SizeRequest::Kind;
  for (const auto& [word, kind] : {std::pair<std::string_view, Of>{"marker", Of::kMarker},
                                   {"vertex", Of::kVertex},
                                   {"region", Of::kRegion}}) {
    next.kind = kind;
    if (taken(word)) return read_whole(text, next.id);
  }
  next.kind = Of::kPoint;
  if (taken("point")) return read_place(text, next.point);
  next.kind = Of::kGroup;
  const bool said = taken("group");
  next.name = text;
  // A number alone could be a marker, a vertex or a region.
  double number = 0;
  return !text.empty() && (said || !read_whole(text, number));
}

}  // namespace

std::optional<std::vector<Assignment>> read_assignments(std::string_view text) {
  std::vector<Assignment> all;
  std::string_view rest = text;
  while (true) {
    std::string_view one = rest.substr(0, rest.find(','));
    const bool last = one.size() == rest.size();
    rest.remove_prefix(std::min(rest.size(), one.size() + 1));
    one.remove_prefix(std::min(one.find_first_not_of(' '), one.size()));
    // Names may hold what they like but commas; numbers hold no equals sign.
    const std::size_t equals = one.rfind('=');
    Assignment next;
    const bool read = equals != std::string_view::npos &&
                      read_subject(one.substr(0, equals), next) &&
                      read_whole(one.substr(equals + 1), next.value) && next.value > 0 &&
                      std::isfinite(next.value);
    if (!read) return std::nullopt;
    all.push_back(std::move(next));
    if (last) return all;
  }
}

std::string sizes_as_text(const std::vector<SizeRequest>& sizes) {
  std::string text;
  for (const SizeRequest& s : sizes) {
    if (!text.empty()) text += ',';
    switch (s.kind) {
      case SizeRequest::Kind::kMarker: text += "marker:" + std::to_string(s.id); break;
      case SizeRequest::Kind::kVertex: text += "vertex:" + std::to_string(s.id); break;
      case SizeRequest::Kind::kRegion: text += "region:" + std::to_string(s.id); break;
      case SizeRequest::Kind::kGroup: text += "group:" + s.group; break;
      case SizeRequest::Kind::kPoint:
        text += "point:" + nlohmann::json(s.point.x).dump() + '/' +
                nlohmann::json(s.point.y).dump() + '/' + nlohmann::json(s.point.z).dump();
        break;
    }
    text += '=' + nlohmann::json(s.size).dump();
  }
  return text;
}

}  // namespace symcell::internal
