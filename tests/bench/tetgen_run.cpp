#include "tests/bench/tetgen_run.hpp"

#include <tetgen.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstring>
#include <span>

#include "core/base/child_process.hpp"
#include "core/cell/measure_cell.hpp"

namespace symcell::bench {
namespace {

constexpr std::uint64_t kCpuSeconds = 20;

// All that is made here is left to the end of the process: tetgenio would free it by its own ways.
void fill(const PeerInput& input, tetgenio& in) {
  const auto doubles = [](const std::vector<Point3>& points) {
    auto* list = new double[3 * points.size() + 1];
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::memcpy(list + 3 * i, &points[i], sizeof(Point3));
    }
    return list;
  };
  in.firstnumber = 0;
  in.pointlist = doubles(input.points);
  in.numberofpoints = static_cast<int>(input.points.size());
  in.holelist = doubles(input.holes);
  in.numberofholes = static_cast<int>(input.holes.size());
  in.numberoffacets = static_cast<int>(input.facets.size());
  in.facetlist = new tetgenio::facet[input.facets.size()];
  in.facetmarkerlist = new int[input.facets.size()];
  for (std::size_t f = 0; f < input.facets.size(); ++f) {
    const PeerFacet& given = input.facets[f];
    tetgenio::facet& facet = in.facetlist[f];
    facet.numberofpolygons = static_cast<int>(given.polygons.size());
    facet.polygonlist = new tetgenio::polygon[given.polygons.size()];
    for (std::size_t p = 0; p < given.polygons.size(); ++p) {
      auto* corners = new int[given.polygons[p].size()];
      std::copy(given.polygons[p].begin(), given.polygons[p].end(), corners);
      facet.polygonlist[p] = {corners, static_cast<int>(given.polygons[p].size())};
    }
    facet.numberofholes = static_cast<int>(given.holes.size());
    facet.holelist = doubles(given.holes);
    in.facetmarkerlist[f] = given.marker;
  }
}

bool run_body(const PeerInput& input, std::string switches, ChildOutput& output) {
  auto* in = new tetgenio;
  auto* out = new tetgenio;
  fill(input, *in);
  tetgenbehavior behavior;
  if (!behavior.parse_commandline(switches.data())) return false;
  tetrahedralize(&behavior, in, out);
  const std::vector<std::uint64_t> header{static_cast<std::uint64_t>(out->numberoftetrahedra),
                                          static_cast<std::uint64_t>(out->numberofpoints),
                                          static_cast<std::uint64_t>(out->numberoftrifaces)};
  output.write_array(header);
  output.write(std::as_bytes(std::span(out->pointlist, 3 * header[1])));
  output.write(std::as_bytes(std::span(out->trifacelist, 3 * header[2])));
  output.write(std::as_bytes(std::span(out->trifacemarkerlist, header[2])));
  output.write(std::as_bytes(std::span(out->tetrahedronlist, 4 * header[0])));
  return true;
}

Statistics::Cell figures_of(const std::vector<Point3>& points,
                            const std::vector<std::int32_t>& tets) {
  SymmetryCellMesh mesh;
  mesh.dimension = 3;
  mesh.orbit_points = points;
  mesh.on_axis.assign(points.size(), 0);
  for (std::size_t v = 0; v < points.size(); ++v) {
    mesh.nodes.push_back({static_cast<std::int32_t>(v), 0});
  }
  mesh.node_markers.assign(points.size(), 0);
  mesh.lower_to_higher.assign(points.size(), -1);
  mesh.nodes_per_element = 4;
  mesh.nodes_per_facet = 3;
  mesh.elements = tets;
  Statistics statistics;
  measure_cell_3(mesh, statistics);
  return statistics.cell;
}

}  // namespace

std::string switches_of(const char* base, PeerBounds bounds) {
  const auto number = [](double x) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
    return std::string(text.data(), end);
  };
  std::string s = std::string(base) + "q" + number(bounds.radius_edge) + "b0Q";
  if (bounds.max_volume > 0) s += "a" + number(bounds.max_volume);
  return s;
}

Result<PeerOutput> run_peer(const PeerInput& input, const std::string& switches) {
  ExecutionContext context;
  const auto start = std::chrono::steady_clock::now();
  const auto child =
      run_in_child([&](ChildOutput& output) { return run_body(input, switches, output); },
                   {.cpu_seconds = kCpuSeconds}, context);
  if (!child) return error_of(child);
  if (child->failure != ChildFailure::kNone) {
    return fail(ErrorCode::kTetrahedralizationFailed,
                child->failure == ChildFailure::kCpuLimit ? "too long" : "crash");
  }
  PeerOutput output;
  std::array<std::uint64_t, 3> header{};
  std::memcpy(header.data(), child->bytes.data(), sizeof header);
  std::size_t from = sizeof header;
  const auto read = [&](auto& list, std::uint64_t count) {
    list.resize(count);
    const std::size_t size = count * sizeof list[0];
    std::memcpy(list.data(), child->bytes.data() + from, size);
    from += size;
  };
  output.count.tets = header[0];
  read(output.points, header[1]);
  read(output.faces, header[2]);
  read(output.markers, header[2]);
  std::vector<std::int32_t> tets;
  read(tets, 4 * header[0]);
  output.count.figures = figures_of(output.points, tets);
  output.count.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return output;
}

}  // namespace symcell::bench
