// A cell and its full mesh, streamed to nobody, against CGAL's Delaunay mesher on the whole model,
// to the same bounds on angle and area.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "api/formats/mesh_writer.hpp"
#include "tests/bench/bench_models.hpp"

namespace symcell::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Tds = CGAL::Triangulation_data_structure_2<CGAL::Delaunay_mesh_vertex_base_2<Kernel>,
                                                 CGAL::Delaunay_mesh_face_base_2<Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Tds>;
using SizeCriteria = CGAL::Delaunay_mesh_size_criteria_2<Cdt>;

constexpr std::int32_t kFold = 6;
constexpr double kTriangles = 1e5;

// CGAL's criteria of angle and size, with the area for the size where CGAL's own has the edge.
class AreaCriteria : public SizeCriteria {
 public:
  AreaCriteria(double min_angle_deg, double max_area)
      : SizeCriteria(squared_sine(min_angle_deg)), max_area_(max_area) {}

  class Is_bad : public SizeCriteria::Is_bad {
   public:
    Is_bad(double bound, double max_area)
        : SizeCriteria::Is_bad(bound, 0, Kernel()), max_area_(max_area) {}
    using SizeCriteria::Is_bad::operator();
    CGAL::Mesh_2::Face_badness operator()(const Cdt::Face_handle& face, Quality& quality) const {
      SizeCriteria::Is_bad::operator()(face, quality);  // the sine
      const double area =
          CGAL::area(face->vertex(0)->point(), face->vertex(1)->point(), face->vertex(2)->point());
      quality.second = area / max_area_;
      return (*this)(quality);
    }

   private:
    double max_area_;
  };

  [[nodiscard]] Is_bad is_bad_object() const { return Is_bad(bound(), max_area_); }

 private:
  static double squared_sine(double degrees) {
    const double sine = std::sin(degrees * std::numbers::pi / 180);
    return sine * sine;
  }

  double max_area_;
};

Cdt constrained_triangulation(const Pslg& model) {
  Cdt cdt;
  std::vector<Cdt::Vertex_handle> handles;
  for (const Point2& p : model.vertices) handles.push_back(cdt.insert(Cdt::Point(p.x, p.y)));
  for (const PslgSegment& s : model.segments) {
    cdt.insert_constraint(handles[static_cast<std::size_t>(s.a)],
                          handles[static_cast<std::size_t>(s.b)]);
  }
  return cdt;
}

void whole_model_cgal(benchmark::State& state) {
  const Pslg model = flange_of(kFold);
  const MeshOptions options = sized_options(model, kFold, kTriangles, true);
  double triangles = 0;
  for (auto _ : state) {
    Cdt cdt = constrained_triangulation(model);
    CGAL::Delaunay_mesher_2<Cdt, AreaCriteria> mesher(
        cdt, AreaCriteria(options.min_angle_deg, options.max_area));
    std::vector<Cdt::Point> seeds;
    for (const Point2& p : model.holes) seeds.emplace_back(p.x, p.y);
    mesher.set_seeds(seeds.begin(), seeds.end(), false);
    mesher.refine_mesh();
    triangles = 0;
    for (auto face = cdt.finite_faces_begin(); face != cdt.finite_faces_end(); ++face) {
      triangles += face->is_in_domain() ? 1 : 0;
    }
  }
  state.counters["full"] = triangles;
}
BENCHMARK(whole_model_cgal)->Unit(benchmark::kMillisecond);

void cell_and_restoration(benchmark::State& state) {
  const Pslg model = flange_of(kFold);
  MeshOptions options = sized_options(model, kFold, kTriangles, true);
  options.plain = state.range(0) != 0;
  std::uint64_t bytes = 0;
  MeshOutcome outcome;
  for (auto _ : state) {
    outcome = mesh(model, options);
    const auto written = write_mesh(outcome.mesh, MeshPart::kFull, MeshFormat::kVtu, {},
                                    [&](std::string_view piece) {
                                      bytes += piece.size();
                                      return true;
                                    });
    if (!written) state.SkipWithError(written.error().message.c_str());
  }
  benchmark::DoNotOptimize(bytes);
  state.counters["full"] = static_cast<double>(outcome.statistics.full.elements);
}
BENCHMARK(cell_and_restoration)->ArgName("plain")->Arg(1)->Arg(0)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace symcell::bench
