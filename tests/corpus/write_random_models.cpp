// write_random_models DIRECTORY KIND FIRST COUNT: random planar models as files, random_SEED.json
// (PSLG), each with its fold, a 0 and a description in a companion (.txt), for checks by programs
// that share no code with the mesher. Kinds: loops, cells. Models symmetric in shape only are left
// out: an independent checker judges them by their own asymmetric vertices.
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string>
#include <utility>

#include "tests/support/pslg_builders.hpp"
#include "tests/support/random_planar_cells.hpp"
#include "tests/support/test_files.hpp"

namespace symcell {
namespace {

// Seventeen digits give every double back.
void write_json(const Pslg& pslg, std::FILE* out) {
  std::fputs("{\"type\":\"pslg\",\"vertices\":[", out);
  const char* comma = "";
  for (const Point2 p : pslg.vertices) {
    std::fprintf(out, "%s[%.17g,%.17g]", comma, p.x, p.y);
    comma = ",";
  }
  std::fputs("],\"segments\":[", out);
  comma = "";
  for (const PslgSegment& s : pslg.segments) {
    std::fprintf(out, "%s[%d,%d,%d]", comma, s.a, s.b, s.marker);
    comma = ",";
  }
  std::fputs("],\"holes\":[", out);
  comma = "";
  for (const Point2 p : pslg.holes) {
    std::fprintf(out, "%s[%.17g,%.17g]", comma, p.x, p.y);
    comma = ",";
  }
  std::fputs("],\"regions\":[", out);
  comma = "";
  for (const PslgRegion& r : pslg.regions) {
    std::fprintf(out, "%s{\"point\":[%.17g,%.17g],\"attribute\":%d", comma, r.point.x, r.point.y,
                 r.attribute);
    if (r.max_area < 1e300) std::fprintf(out, ",\"max_area\":%.17g", r.max_area);
    std::fputs("}", out);
    comma = ",";
  }
  std::fputs("]}\n", out);
}

// False: left out.
bool make(const std::string& kind, std::uint64_t seed, Pslg& pslg, std::string& told) {
  if (kind == "cells") {
    test::RandomPlanarCells made = test::make_random_planar_cells(seed);
    told = std::to_string(made.fold) + " 0 " + made.description;
    pslg = std::move(made.pslg);
    return true;
  }
  constexpr std::int32_t kFolds[] = {1, 2, 3, 4, 5, 6, 7, 8, 12, 17, 36, 100};
  RandomPslgTraits traits;
  pslg = random_symmetric_pslg(seed, kFolds[seed % std::size(kFolds)], &traits);
  told = std::to_string(traits.fold) + " 0 " + std::to_string(traits.fold) + "-fold loops";
  return !traits.geometry_only;
}

int run(const std::string& directory,
        const std::string& kind,
        std::uint64_t first,
        std::uint64_t count) {
  if (kind != "loops" && kind != "cells") return 2;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    Pslg pslg;
    std::string told;
    if (!make(kind, seed, pslg, told)) continue;
    const std::string base = directory + "/random_" + std::to_string(seed);
    test::write_file(base + ".txt", told + "\n");
    std::FILE* out = std::fopen((base + ".json").c_str(), "w");
    if (out == nullptr) {
      std::fprintf(stderr, "cannot write %s\n", base.c_str());
      return 1;
    }
    write_json(pslg, out);
    std::fclose(out);
  }
  return 0;
}

}  // namespace
}  // namespace symcell

int main(int argc, char** argv) {
  const int status = argc != 5 ? 2
                               : symcell::run(argv[1], argv[2], std::strtoull(argv[3], nullptr, 10),
                                              std::strtoull(argv[4], nullptr, 10));
  if (status == 2) {
    std::fputs("usage: write_random_models DIRECTORY loops|cells FIRST COUNT\n", stderr);
  }
  return status;
}
