// write_random_solids DIRECTORY FIRST COUNT: random symmetric PLCs as JSON files, each with its
// fold and volume in its name's companion (.txt), for checks by programs that share no code with
// the mesher.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "api/formats/plc_json.hpp"
#include "tests/support/random_plc.hpp"
#include "tests/support/test_files.hpp"

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: write_random_solids DIRECTORY FIRST COUNT\n", stderr);
    return 2;
  }
  using namespace symcell;
  const std::uint64_t first = std::strtoull(argv[2], nullptr, 10);
  const std::uint64_t count = std::strtoull(argv[3], nullptr, 10);
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const test::RandomPlc model = test::make_random_plc(seed);
    const std::string base = std::string(argv[1]) + "/random_" + std::to_string(seed);
    test::write_file(base + ".json", write_plc_json(model.plc));
    char text[256];
    std::snprintf(text, sizeof text, "%d %.17g %s\n", model.fold, model.volume,
                  model.description.c_str());
    test::write_file(base + ".txt", text);
  }
  return 0;
}
