// write_prisms DIRECTORY: quotient meshes made by hand and mixed by random flips, cut and written
// as cell and full mesh with their models: what the cut and the writers do, without the mesher.
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "api/formats/mesh_writer.hpp"
#include "api/formats/plc_json.hpp"
#include "core/solid/cut/cut_cell.hpp"
#include "tests/support/solid_samples.hpp"
#include "tests/support/test_files.hpp"

namespace symcell {
namespace {

// The frame of case `i`, and the model in it.
Plc placed(Plc plc, const AxisFrame& frame) {
  for (Point3& p : plc.vertices) p = frame.to_model(p);
  for (PlcRegion& r : plc.regions) r.point = frame.to_model(r.point);
  for (PlcFacet& f : plc.facets) {
    for (Point3& h : f.holes) h = frame.to_model(h);
  }
  return plc;
}

bool write_case(const std::string& base, int i) {
  constexpr std::int32_t kFolds[] = {1, 2, 3, 6, 17};
  test::PrismShape shape;
  shape.fold = kFolds[static_cast<std::size_t>(i) % std::size(kFolds)];
  shape.steps = (shape.fold == 1 ? 5 : shape.fold == 2 ? 2 : 1) + i / 10;
  shape.rings = 1 + i % 4;
  shape.layers = 2 + i % 3;
  shape.inner_radius = i % 2 == 0 ? 0 : 1;
  shape.inner_facet = shape.layers % 2 == 0 && i % 3 == 0;
  solid::InitialTetrahedralization solid = test::prism(shape);
  test::random_flips(solid.mesh, 300, static_cast<std::uint64_t>(i));
  test::shuffle_gauge(solid.mesh, static_cast<std::uint64_t>(i));
  solid::Symmetry symmetry;
  symmetry.fold = shape.fold;
  if (i % 3 != 0) symmetry.frame = AxisFrame::of_axis({10, -3, 5}, {1, 2, 3});
  ExecutionContext context;
  const auto cut = solid::cut_cell(solid.mesh, context);
  if (!cut) {
    std::fprintf(stderr, "%s\n", cut.error().message.c_str());
    return false;
  }
  const SymmetryCellMesh mesh = solid::build_cell_mesh(solid, *cut, symmetry);
  test::write_file(base + ".json",
                   write_plc_json(placed(test::prism_model(shape), symmetry.frame)));
  for (const MeshPart part : {MeshPart::kCell, MeshPart::kFull}) {
    std::ofstream file(base + (part == MeshPart::kCell ? ".cell.vtu" : ".full.vtu"),
                       std::ios::binary);
    const auto sink = [&](std::string_view bytes) {
      file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      return file.good();
    };
    if (!write_mesh(mesh, part, MeshFormat::kVtu, {}, sink)) return false;
  }
  return true;
}

}  // namespace
}  // namespace symcell

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: write_prisms DIRECTORY\n", stderr);
    return 2;
  }
  for (int i = 0; i < 20; ++i) {
    if (!symcell::write_case(std::string(argv[1]) + "/" + std::to_string(i), i)) return 1;
  }
  return 0;
}
