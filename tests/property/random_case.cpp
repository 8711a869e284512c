#include "tests/property/random_case.hpp"

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>

#include "tests/support/random_planar_cells.hpp"

namespace symcell {
namespace {

constexpr double kAnglesDeg[] = {0, 20, 25, 30, 33, 35, 38};
constexpr std::int32_t kFolds[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 17, 24, 36, 64, 72, 100};
constexpr double kSurePlainAngleDeg = 25;
// No case comes near these unless refinement runs away.
constexpr std::uint64_t kMaxElements = 200'000;
constexpr double kTimeLimitSeconds = 60;

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::stoull(text);
}

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  bool operator()(double probability) { return uniform(0, 1) < probability; }
  std::uint64_t number() { return engine_(); }
  template <class Values>
  auto pick(const Values& values) {
    return values[engine_() % std::size(values)];
  }

 private:
  std::mt19937_64 engine_;
};

void choose_options(Chance& chance, RandomCase& c) {
  c.options.min_angle_deg = chance.pick(kAnglesDeg);
  c.options.plain = chance(0.35);
  const double elements = chance.uniform(5, 250);
  const double area = c.traits.area / (elements * c.traits.fold);
  if (chance(0.25)) c.options.max_area = area;
  if (chance(0.2)) c.options.max_edge = 1.5 * std::sqrt(area);
  if (chance(0.2)) c.options.fold = c.traits.fold;
  c.options.max_elements = kMaxElements;
  c.options.time_limit_s = kTimeLimitSeconds;
  c.must_succeed = !c.options.plain || c.options.min_angle_deg <= kSurePlainAngleDeg;
}

}  // namespace

RandomCase make_random_case(std::uint64_t seed) {
  Chance chance(seed ^ 0x5ca1ab1e0ddba11ULL);
  RandomCase c;
  c.seed = seed;
  const std::int32_t fold =
      chance(0.8) ? chance.pick(kFolds) : static_cast<std::int32_t>(1 + chance.number() % 100);
  c.model = random_symmetric_pslg(seed, fold, &c.traits);
  choose_options(chance, c);
  return c;
}

RandomCase make_random_cells_case(std::uint64_t seed) {
  Chance chance(seed ^ 0xce115ULL);
  test::RandomPlanarCells made = test::make_random_planar_cells(seed);
  RandomCase c;
  c.seed = seed;
  c.model = std::move(made.pslg);
  c.description = std::move(made.description);
  c.pinches = std::move(made.pinches);
  c.traits.fold = made.fold;
  c.traits.center = made.center;
  c.traits.scale = made.scale;
  c.traits.area = made.area;
  choose_options(chance, c);
  return c;
}

std::ostream& operator<<(std::ostream& out, const RandomCase& c) {
  out << "seed " << c.seed << ": fold " << c.traits.fold
      << (c.description.empty() ? "" : ", " + c.description) << ", min_angle "
      << c.options.min_angle_deg << (c.options.plain ? ", plain" : ", improved");
  if (c.options.max_area < kInfinity) out << ", max_area " << c.options.max_area;
  if (c.options.max_edge < kInfinity) out << ", max_edge " << c.options.max_edge;
  if (c.options.fold) out << ", fold given";
  return out << " (SYMCELL_PROPERTY_RUNS=1 SYMCELL_PROPERTY_SEED=" << c.seed << ")";
}

SeedRange property_seeds(std::uint64_t usual) {
  const std::uint64_t begin = from_environment("SYMCELL_PROPERTY_SEED", 0);
  return {begin, begin + from_environment("SYMCELL_PROPERTY_RUNS", usual)};
}

}  // namespace symcell
