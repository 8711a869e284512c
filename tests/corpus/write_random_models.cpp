// write_random_models DIRECTORY COUNT: random symmetric models as PSLG JSON files, for checks by
// programs that share no code with the mesher. Models symmetric in shape only are left out: an
// independent checker judges them by their own asymmetric vertices.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/support/pslg_builders.hpp"

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

int run(const std::string& directory, int count) {
  constexpr std::int32_t kFolds[] = {1, 2, 3, 4, 5, 6, 7, 8, 12, 17, 36, 100};
  int written = 0;
  for (std::uint64_t seed = 0; written < count; ++seed) {
    RandomPslgTraits traits;
    const Pslg pslg = random_symmetric_pslg(seed, kFolds[seed % std::size(kFolds)], &traits);
    if (traits.geometry_only) continue;
    const std::string path = directory + "/random_" + std::to_string(seed) + ".json";
    std::FILE* out = std::fopen(path.c_str(), "w");
    if (out == nullptr) {
      std::fprintf(stderr, "cannot write %s\n", path.c_str());
      return 1;
    }
    write_json(pslg, out);
    std::fclose(out);
    ++written;
  }
  return 0;
}

}  // namespace
}  // namespace symcell

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: write_random_models DIRECTORY COUNT\n", stderr);
    return 2;
  }
  return symcell::run(argv[1], std::atoi(argv[2]));
}
