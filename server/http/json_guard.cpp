#include "server/http/json_guard.hpp"

#include <utility>

#include "core/model/pslg.hpp"

namespace symcell::server {
namespace {

// Of names that lists have; what is longer is none of them.
constexpr std::size_t kMostNameBytes = 16;

// The same for planar models and solids: segments of a planar graph are three to a vertex at most.
std::uint64_t limit_of(std::string_view name) {
  if (name == "vertices") return kMaxPslgVertices;
  if (name == "segments") return 3 * kMaxPslgVertices;
  return 0;
}

}  // namespace

bool JsonGuard::refuse(ErrorCode code, std::string message) {
  error_ = Error{code, std::move(message), {}, "/model"};
  return false;
}

bool JsonGuard::open(bool is_list) {
  if (depth_ == kMostDepth) {
    return refuse(ErrorCode::kJsonSyntax,
                  "more than " + std::to_string(kMostDepth - 1) + " nested lists or objects");
  }
  const bool is_named = depth_ > 0 && !levels_[depth_ - 1].is_list;
  levels_[depth_++] = {is_list, is_list && is_named ? limit_of(text_) : 0, 0};
  return true;
}

bool JsonGuard::count_member() {
  if (depth_ == 0) return true;
  Level& level = levels_[depth_ - 1];
  // A comma stands between two members.
  if (level.limit == 0 || ++level.members < level.limit) return true;
  return refuse(ErrorCode::kTooLarge,
                "the model has more than " + std::to_string(level.limit) +
                    (level.limit == kMaxPslgVertices ? " vertices" : " segments"));
}

bool JsonGuard::pass(std::string_view piece) {
  for (const char c : piece) {
    if (in_string_) {
      if (escaped_) {
        escaped_ = false;
      } else if (c == '\\') {
        escaped_ = true;
      } else if (c == '"') {
        in_string_ = false;
      }
      if (in_string_ && text_.size() < kMostNameBytes) text_.push_back(c);
      continue;
    }
    switch (c) {
      case '"':
        in_string_ = true;
        text_.clear();
        break;
      case '[':
      case '{':
        if (!open(c == '[')) return false;
        break;
      case ']':
      case '}':
        if (depth_ > 0) --depth_;
        break;
      case ',':
        if (!count_member()) return false;
        break;
      default: break;
    }
  }
  return true;
}

}  // namespace symcell::server
