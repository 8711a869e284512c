#include "core/cell/mesh_to_count.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace symcell {
namespace {

constexpr double kWithin = 0.1;  // of the count asked for
constexpr int kMostMeshes = 10;
// Meshes of so many times the count, and a few, are given up while they are refined: the longest edge was
// too short.
constexpr std::uint64_t kTooMany = 4;
constexpr std::uint64_t kFew = 200;
// Area or volume of an element by its longest edge, in the mean, where that is bounded.
constexpr double kShareOfSquare = 0.25;
constexpr double kShareOfCube = 0.04;
// A step changes the edge by this factor at most, so that one strange mesh does not lead far away.
constexpr double kLongestStep = 4;
// An answer is looked for between two edges at a place no nearer to either than this, as a share.
constexpr double kWithinBracket = 0.1;

// Longest edges and what they gave, in logarithms: counts fall as a power of the edge.
class EdgeSearch {
 public:
  // `first`: the edge that promises the count.
  EdgeSearch(double target, int dimension, double first)
      : target_(std::log(target)), power_(dimension), last_{std::log(first), target_} {}

  // `count`: elements at that edge.
  void record(double edge, double count) {
    last_ = {std::log(edge), std::log(count)};
    if (last_.count > target_) {
      if (last_.edge > many_.edge) many_ = last_;
    } else if (last_.edge < few_.edge) {
      few_ = last_;
    }
  }

  [[nodiscard]] double next() const {
    const double apart = few_.edge - many_.edge, fall = many_.count - few_.count;
    if (std::isfinite(apart) && apart > 0 && fall > 0) {
      const double share = (many_.count - target_) / fall;
      return std::exp(many_.edge + std::clamp(share, kWithinBracket, 1 - kWithinBracket) * apart);
    }
    const double most = std::log(kLongestStep);
    return std::exp(last_.edge + std::clamp((last_.count - target_) / power_, -most, most));
  }

 private:
  struct Tried {
    double edge;
    double count;
  };
  double target_;
  double power_;
  // The nearest above and below.
  Tried many_{-kInfinity, 0}, few_{kInfinity, 0};
  Tried last_;
};

// As long as it lives, no mesh may have more elements.
class Budget {
 public:
  Budget(ExecutionContext& context, std::uint64_t most)
      : context_(context), before_(context.max_elements()) {
    context.set_max_elements(std::min(before_, most));
  }
  ~Budget() { context_.set_max_elements(before_); }
  Budget(const Budget&) = delete;
  Budget& operator=(const Budget&) = delete;

 private:
  ExecutionContext& context_;
  std::uint64_t before_;
};

double promising_edge(const MeshOutcome& made, double target) {
  const double element = made.statistics.cell.measure / target;
  return made.mesh.dimension == 2 ? std::sqrt(element / kShareOfSquare)
                                  : std::cbrt(element / kShareOfCube);
}

}  // namespace

Result<MeshOutcome> mesh_to_count(
    const std::function<Result<MeshOutcome>(const MeshOptions&)>& mesh,
    const MeshOptions& options,
    ExecutionContext& context) {
  const auto target = static_cast<double>(options.target_elements);
  auto first = mesh(options);
  if (!first) return first;
  MeshOutcome best = std::move(*first);
  const auto off_by = [&](const MeshOutcome& made) {
    return static_cast<double>(made.statistics.cell.elements) / target - 1;
  };
  double off = off_by(best);
  double edge = std::isfinite(options.max_edge) ? options.max_edge : 0;
  EdgeSearch search(target, best.mesh.dimension, promising_edge(best, target));
  MeshOptions own = options;
  const std::uint64_t most = kTooMany * options.target_elements + kFew;
  const Budget budget(context, most);
  int meshes = 1;
  // Without a shorter edge there may be too many already: then none is looked for.
  const bool too_few = off < -kWithin;
  for (; too_few && meshes < kMostMeshes && std::abs(off) > kWithin; ++meshes) {
    SYMCELL_TRY(context.check());
    own.max_edge = std::min(options.max_edge, search.next());
    auto made = mesh(own);
    if (!made && made.error().code != ErrorCode::kElementLimit) return made;
    if (!made) {
      search.record(own.max_edge, static_cast<double>(most));
      continue;
    }
    search.record(own.max_edge, static_cast<double>(made->statistics.cell.elements));
    const double now = off_by(*made);
    if (std::abs(now) >= std::abs(off)) continue;
    off = now;
    edge = own.max_edge;
    best = std::move(*made);
  }
  best.statistics.target = {options.target_elements, edge, meshes};
  if (std::abs(off) > kWithin) {
    best.statistics.warnings.push_back(
        elements_missed_warning(options.target_elements, best.statistics.cell.elements));
  }
  return best;
}

}  // namespace symcell
