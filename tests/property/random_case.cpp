#include "tests/property/random_case.hpp"

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

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

}  // namespace

RandomCase make_random_case(std::uint64_t seed) {
  std::mt19937_64 engine(seed ^ 0x5ca1ab1e0ddba11ULL);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  const auto chance = [&](double probability) { return uniform(0, 1) < probability; };
  const auto pick = [&](const auto& values) { return values[engine() % std::size(values)]; };

  RandomCase c;
  c.seed = seed;
  const std::int32_t fold =
      chance(0.8) ? pick(kFolds) : static_cast<std::int32_t>(1 + engine() % 100);
  c.model = random_symmetric_pslg(seed, fold, &c.traits);
  c.options.min_angle_deg = pick(kAnglesDeg);
  c.options.plain = chance(0.35);
  const double elements = uniform(5, 250);
  const double area = c.traits.area / (elements * fold);
  if (chance(0.25)) c.options.max_area = area;
  if (chance(0.2)) c.options.max_edge = 1.5 * std::sqrt(area);
  if (chance(0.2)) c.options.fold = fold;
  c.options.max_elements = kMaxElements;
  c.options.time_limit_s = kTimeLimitSeconds;
  c.must_succeed = !c.options.plain || c.options.min_angle_deg <= kSurePlainAngleDeg;
  return c;
}

std::ostream& operator<<(std::ostream& out, const RandomCase& c) {
  out << "seed " << c.seed << ": fold " << c.traits.fold << ", min_angle "
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
