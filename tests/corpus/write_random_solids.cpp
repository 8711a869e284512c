// write_random_solids DIRECTORY KIND FIRST COUNT: random solids as files, random_SEED.json (PLC) or
// .stl, each with its fold, volume and description in a companion (.txt), for checks by programs
// that share no code with the mesher. Kinds: bodies, layers and
// tabs, and these as triangles: surfaces, tab_surfaces.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "api/formats/plc_json.hpp"
#include "tests/support/random_layers.hpp"
#include "tests/support/random_plc.hpp"
#include "tests/support/test_files.hpp"

namespace symcell {
namespace {

// Seventeen digits give every double back.
std::string ascii_stl(const TriangleSurface& surface) {
  std::string text = "solid random\n";
  for (const auto& t : surface.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::int32_t v : t) {
      const Point3 p = surface.vertices[static_cast<std::size_t>(v)];
      char line[128];
      std::snprintf(line, sizeof line, "vertex %.17g %.17g %.17g\n", p.x, p.y, p.z);
      text += line;
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid random\n";
}

void write_companion(const std::string& base,
                     std::int32_t fold,
                     double volume,
                     const std::string& description) {
  char text[64];
  std::snprintf(text, sizeof text, "%d %.17g ", fold, volume);
  test::write_file(base + ".txt", text + description + "\n");
}

int run(const std::string& directory,
        const std::string& kind,
        std::uint64_t first,
        std::uint64_t count) {
  test::RandomLayersOptions options;
  // What the checker cannot judge in solids.
  options.pinches = false;
  options.loose = false;
  options.touching = false;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const std::string base = directory + "/random_" + std::to_string(seed);
    options.tabs = kind.starts_with("tab");
    if (kind == "surfaces" || kind == "tab_surfaces") {
      const test::RandomSurface model = test::make_random_layer_surface(seed, options);
      test::write_file(base + ".stl", ascii_stl(model.surface));
      write_companion(base, model.fold, model.volume, model.description);
      continue;
    }
    if (kind != "bodies" && kind != "layers" && kind != "tabs") return 2;
    const test::RandomPlc model =
        kind == "bodies" ? test::make_random_plc(seed) : test::make_random_layers(seed, options);
    test::write_file(base + ".json", write_plc_json(model.plc));
    write_companion(base, model.fold, model.volume, model.description);
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
    std::fputs("usage: write_random_solids DIRECTORY KIND FIRST COUNT\n", stderr);
  }
  return status;
}
