#include "tests/property/solid_case.hpp"

#include <cmath>
#include <utility>

#include "core/base/execution_context.hpp"
#include "core/base/random.hpp"
#include "core/solid/mesh_solid.hpp"
#include "core/solid/sector/symmetrise.hpp"

namespace symcell {

SolidCase make_solid_case(std::uint64_t seed, test::RandomPlc model) {
  SolidCase c;
  c.seed = seed;
  c.model = std::move(model);
  Random random(seed + 0x5eed);
  const auto chance = [&](double p) { return random.uniform() < p; };
  c.options.radius_edge = chance(0.7) ? 1.414 : 1.2 + 1.3 * random.uniform();
  // The cell gets up to some hundred elements by the volume bound, more where the model is fine.
  const double elements = 20 + 400 * random.uniform();
  const double volume = c.model.volume / (elements * c.model.fold);
  if (chance(0.5)) c.options.max_volume = volume;
  if (chance(0.1)) c.options.max_edge = 2 * std::cbrt(volume);
  if (chance(0.15)) c.options.delaunay = true;
  if (chance(0.1)) c.options.plain = true;
  if (chance(0.7)) c.options.fold = c.model.fold;
  if (chance(0.3)) {
    c.options.axis_origin = c.model.axis_origin;
    c.options.axis_direction = c.model.axis_direction;
  }
  c.options.max_elements = 300'000;
  c.options.time_limit_s = 60;
  return c;
}

std::ostream& operator<<(std::ostream& out, const SolidCase& c) {
  out << "seed " << c.seed << ": " << c.model.description << ", radius_edge "
      << c.options.radius_edge << (c.options.delaunay ? ", delaunay" : "")
      << (c.options.plain ? ", plain" : "");
  if (c.options.max_volume < kInfinity) out << ", max_volume " << c.options.max_volume;
  if (c.options.max_edge < kInfinity) out << ", max_edge " << c.options.max_edge;
  if (c.options.fold) out << ", fold given";
  if (c.options.axis_origin) out << ", axis given";
  return out << " (SYMCELL_PROPERTY_RUNS=1 SYMCELL_PROPERTY_SEED=" << c.seed << ")";
}

Result<MeshOutcome> mesh(const SolidCase& c) {
  ExecutionContext context;
  context.set_max_elements(c.options.max_elements);
  context.set_time_limit(c.options.time_limit_s);
  auto source = solid::symmetrise_plc(c.model.plc, c.options, context);
  if (!source) return error_of(source);
  return solid::mesh_solid(**source, c.options, context);
}

}  // namespace symcell
