#include "core/solid/initial/tetgen.hpp"

#include <tetgen.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/index.hpp"
#include "core/base/random.hpp"

namespace symcell::solid {
namespace {

struct ResultHeader {
  std::uint64_t points = 0;
  std::uint64_t tets = 0;
};

// tetgenio frees with delete[] what it is given; this child never frees at all (_exit), so the
// arrays are plain vectors and the tetgenio is leaked.
struct PlcArrays {
  std::vector<int> corners;
  std::vector<tetgenio::polygon> polygons;
  std::vector<tetgenio::facet> facets;
  std::vector<double> coordinates;
};

void fill(const TriangleComplex& complex, PlcArrays& arrays, tetgenio& in) {
  const std::size_t triangles = complex.triangles.size();
  const std::size_t facets = triangles + complex.edges.size();
  for (const Point3 p : complex.points) {
    arrays.coordinates.insert(arrays.coordinates.end(), {p.x, p.y, p.z});
  }
  for (const auto& t : complex.triangles) {
    arrays.corners.insert(arrays.corners.end(), t.begin(), t.end());
  }
  for (const auto& e : complex.edges) {
    arrays.corners.insert(arrays.corners.end(), e.begin(), e.end());
  }
  arrays.polygons.resize(facets);
  arrays.facets.resize(facets);
  for (std::size_t f = 0; f < facets; ++f) {
    const bool edge = f >= triangles;
    tetgenio::polygon& polygon = arrays.polygons[f];
    polygon.vertexlist =
        arrays.corners.data() + (edge ? 3 * triangles + 2 * (f - triangles) : 3 * f);
    polygon.numberofvertices = edge ? 2 : 3;
    arrays.facets[f] = {&polygon, 1, nullptr, 0};
  }
  in.firstnumber = 0;
  in.pointlist = arrays.coordinates.data();
  in.numberofpoints = static_cast<int>(complex.points.size());
  in.facetlist = arrays.facets.data();
  in.numberoffacets = static_cast<int>(facets);
}

bool tetgen_body(const TriangleComplex& complex,
                 const TetgenOptions& options,
                 ChildOutput& output) {
  if (options.before) options.before();
  auto* arrays = new PlcArrays;
  auto* in = new tetgenio;
  auto* out = new tetgenio;
  fill(complex, *arrays, *in);
  std::string switches = options.switches;
  tetgenbehavior behavior;
  if (!behavior.parse_commandline(switches.data())) return false;
  tetrahedralize(&behavior, in, out);
  if (out->numberoftetrahedra <= 0 || out->numberofcorners != 4) return false;
  const ResultHeader header{static_cast<std::uint64_t>(out->numberofpoints),
                            static_cast<std::uint64_t>(out->numberoftetrahedra)};
  output.write(std::as_bytes(std::span(&header, 1)));
  output.write(std::as_bytes(std::span(out->pointlist, 3 * header.points)));
  output.write(std::as_bytes(std::span(out->tetrahedronlist, 4 * header.tets)));
  return true;
}

Failure failed(const std::string& why) {
  return fail(ErrorCode::kTetrahedralizationFailed, "tetrahedralization of the sector: " + why);
}

Result<Tetrahedralization> parse(const TriangleComplex& complex, std::span<const std::byte> bytes) {
  ResultHeader header;
  if (bytes.size() < sizeof header) return failed("no result");
  std::memcpy(&header, bytes.data(), sizeof header);
  bytes = bytes.subspan(sizeof header);
  Tetrahedralization mesh;
  if (bytes.size() != header.points * sizeof(Point3) + header.tets * 4 * sizeof(std::int32_t)) {
    return failed("the result is cut off");
  }
  mesh.points.resize(header.points);
  mesh.tets.resize(header.tets);
  std::memcpy(mesh.points.data(), bytes.data(), header.points * sizeof(Point3));
  bytes = bytes.subspan(header.points * sizeof(Point3));
  std::memcpy(mesh.tets.data(), bytes.data(), bytes.size());
  const std::size_t given = complex.points.size();
  if (header.points < given ||
      std::memcmp(mesh.points.data(), complex.points.data(), given * sizeof(Point3)) != 0) {
    return failed("given vertices were changed");
  }
  for (const auto& t : mesh.tets) {
    for (const std::int32_t v : t) {
      if (v < 0 || static_cast<std::size_t>(v) >= mesh.points.size()) {
        return failed("a corner is out of range");
      }
    }
  }
  return mesh;
}

struct Shuffled {
  TriangleComplex complex;
  std::vector<std::int32_t> given;  // per shuffled point: its index as given
};

Shuffled shuffle(const TriangleComplex& complex, std::uint64_t seed) {
  Random random(seed);
  const auto mix = [&](auto& items) {
    for (std::size_t i = items.size(); i > 1; --i) {
      std::swap(items[i - 1], items[static_cast<std::size_t>(random.next() % i)]);
    }
  };
  Shuffled shuffled;
  shuffled.given.resize(complex.points.size());
  std::iota(shuffled.given.begin(), shuffled.given.end(), 0);
  mix(shuffled.given);
  std::vector<std::int32_t> place(complex.points.size());
  for (std::size_t i = 0; i < shuffled.given.size(); ++i) {
    place[at(shuffled.given[i])] = static_cast<std::int32_t>(i);
    shuffled.complex.points.push_back(complex.points[at(shuffled.given[i])]);
  }
  for (const auto& [a, b, c] : complex.triangles) {
    shuffled.complex.triangles.push_back({place[at(a)], place[at(b)], place[at(c)]});
  }
  for (const auto& [a, b] : complex.edges) {
    shuffled.complex.edges.push_back({place[at(a)], place[at(b)]});
  }
  mix(shuffled.complex.triangles);
  return shuffled;
}

Result<Tetrahedralization> run_as_given(const TriangleComplex& complex,
                                        const TetgenOptions& options,
                                        ExecutionContext& context) {
  const auto limits =
      tetgen_limits(complex.points.size() + complex.triangles.size() + complex.edges.size());
  auto child = run_in_child(
      [&](ChildOutput& output) { return tetgen_body(complex, options, output); }, limits, context);
  if (!child) return error_of(child);
  switch (child->failure) {
    case ChildFailure::kNone: return parse(complex, child->bytes);
    case ChildFailure::kRefused: return failed("refused by the tetrahedralizer");
    case ChildFailure::kCrashed: return failed("the tetrahedralizer crashed");
    case ChildFailure::kCpuLimit: return failed("the tetrahedralizer took too long");
  }
  return failed("no result");
}

}  // namespace

static_assert(sizeof(Point3) == 3 * sizeof(double), "points are copied as bytes");
static_assert(sizeof(int) == sizeof(std::int32_t));

ChildLimits tetgen_limits(std::size_t size) {
  // TetGen takes some 0.1 ms and 2 KB a point or triangle of a sector; what takes fifty times as
  // long goes round in circles.
  constexpr std::uint64_t kBaseSeconds = 10;
  constexpr std::uint64_t kSizePerSecond = 200;
  constexpr std::uint64_t kBaseBytes = 1ULL << 30;
  constexpr std::uint64_t kBytesEach = 8ULL << 10;
  return {kBaseSeconds + size / kSizePerSecond, kBaseBytes + kBytesEach * size};
}

Result<Tetrahedralization> run_tetgen(const TriangleComplex& complex,
                                      const TetgenOptions& options,
                                      ExecutionContext& context) {
  if (options.order == 0) return run_as_given(complex, options, context);
  const Shuffled shuffled = shuffle(complex, options.order);
  auto result = run_as_given(shuffled.complex, options, context);
  if (!result) return result;
  std::copy(complex.points.begin(), complex.points.end(), result->points.begin());
  for (auto& t : result->tets) {
    for (std::int32_t& v : t) {
      if (static_cast<std::size_t>(v) < shuffled.given.size()) v = shuffled.given[at(v)];
    }
  }
  return result;
}

}  // namespace symcell::solid
