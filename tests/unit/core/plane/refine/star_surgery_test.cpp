#include "core/plane/refine/star_surgery.hpp"

#include "core/plane/quotient/star.hpp"
#include "core/plane/refine/refiner.hpp"
#include "tests/unit/core/plane/quotient_samples.hpp"

namespace symcell::plane {
namespace {

using test::QuotientSample;

// A refined mesh with the tools that worked on it.
class Workshop {
 public:
  Workshop(std::uint64_t seed, std::int32_t fold, double min_angle_deg)
      : sample_(test::random_sample(seed, fold)),
        options_(options(min_angle_deg)),
        criteria_(mesh(), sample_.start.subdomains, options_),
        editor_(mesh()),
        refiner_(editor_, criteria_, settings(), context_) {
    const auto ok = refiner_.run();
    EXPECT_TRUE(ok) << ok.error().message;
  }

  QuotientTriangulation& mesh() { return sample_.mesh(); }
  StarSurgery& surgery() { return refiner_.surgery(); }
  const Criteria& criteria() const { return criteria_; }

  [[nodiscard]] std::size_t bad_triangles() {
    std::size_t count = 0;
    for (const TriangleId t : test::live_triangles(mesh())) {
      count += criteria_.is_bad(mesh(), t) ? 1 : 0;
    }
    return count;
  }

  void expect_valid(const char* what, VertexId v) {
    const auto ok = validate(mesh(), ValidationLevel::kDelaunay);
    ASSERT_TRUE(ok) << what << " of vertex " << v << ": " << ok.error().message;
  }

 private:
  static MeshOptions options(double min_angle_deg) {
    MeshOptions result;
    result.min_angle_deg = min_angle_deg;
    return result;
  }
  Refiner::Settings settings() const {
    Refiner::Settings result;
    result.relocate = false;
    return result;
  }

  ExecutionContext context_;
  QuotientSample sample_;
  MeshOptions options_;
  Criteria criteria_;
  Editor editor_;
  Refiner refiner_;
};

constexpr std::int32_t kFolds[] = {1, 2, 3, 6, 17};

template <class Visit>
void for_each_vertex(QuotientTriangulation& mesh, VertexKind kind, const Visit& visit) {
  const std::size_t slots = mesh.vertex_slots();
  for (std::size_t id = 0; id < slots; ++id) {
    const auto v = static_cast<VertexId>(id);
    if (mesh.kind(v) == kind && mesh.corner_of(v) != kNoHalfEdge) visit(v);
  }
}

TEST(StarSurgery, RelocatedStarsAreGood) {
  int moved = 0;
  for (const std::int32_t fold : kFolds) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      Workshop work(seed, fold, 25);
      const std::size_t triangles = work.mesh().triangle_count();
      const double area = test::area(work.mesh());
      for (const VertexKind kind : {VertexKind::kFree, VertexKind::kSegment}) {
        for_each_vertex(work.mesh(), kind, [&](VertexId v) {
          moved += work.surgery().relocate(v) ? 1 : 0;
          work.expect_valid("move", v);
        });
      }
      EXPECT_EQ(work.mesh().triangle_count(), triangles);
      EXPECT_EQ(work.bad_triangles(), 0U);
      EXPECT_NEAR(test::area(work.mesh()), area, 1e-9 * area);
    }
  }
  EXPECT_GT(moved, 100);
}

TEST(StarSurgery, RemovedVerticesLeaveADelaunayMesh) {
  int removed = 0;
  for (const std::int32_t fold : kFolds) {
    for (std::uint64_t seed = 4; seed < 8; ++seed) {
      Workshop work(seed, fold, 25);
      const double area = test::area(work.mesh());
      for_each_vertex(work.mesh(), VertexKind::kFree, [&](VertexId v) {
        const std::size_t triangles = work.mesh().triangle_count();
        const bool done = work.surgery().remove(v);
        removed += done ? 1 : 0;
        EXPECT_EQ(work.mesh().triangle_count(), triangles - (done ? 2 : 0));
        EXPECT_EQ(work.mesh().kind(v), done ? VertexKind::kDeleted : VertexKind::kFree);
        work.expect_valid("removal", v);
      });
      EXPECT_NEAR(test::area(work.mesh()), area, 1e-11 * area);
    }
  }
  EXPECT_GT(removed, 100);
}

TEST(StarSurgery, UnsplitSegmentsAreWholeAgain) {
  int joined = 0;
  for (const std::int32_t fold : kFolds) {
    for (std::uint64_t seed = 8; seed < 12; ++seed) {
      Workshop work(seed, fold, 25);
      const double area = test::area(work.mesh());
      for_each_vertex(work.mesh(), VertexKind::kSegment, [&](VertexId v) {
        const std::size_t subsegments = test::live_subsegments(work.mesh());
        const bool done = work.surgery().unsplit(v);
        joined += done ? 1 : 0;
        EXPECT_EQ(test::live_subsegments(work.mesh()), subsegments - (done ? 1 : 0));
        work.expect_valid("unsplit", v);
      });
      EXPECT_NEAR(test::area(work.mesh()), area, 1e-9 * area);
    }
  }
  EXPECT_GT(joined, 20);
}

TEST(StarSurgery, MergedVerticesLeaveAGoodMesh) {
  int merged = 0;
  for (const std::int32_t fold : kFolds) {
    for (std::uint64_t seed = 12; seed < 16; ++seed) {
      Workshop work(seed, fold, 22);
      const double area = test::area(work.mesh());
      for_each_vertex(work.mesh(), VertexKind::kFree, [&](VertexId v) {
        StarItem item = star_item(work.mesh(), work.mesh().corner_of(v));
        if (to_star_begin(work.mesh(), item)) return;
        const OrbitVertex other = star_corner(work.mesh(), item, 1);
        if (work.mesh().kind(other.orbit) == VertexKind::kInput || other.orbit == v) return;
        // If one lies on a segment, that one is kept: in its frame.
        const bool on_segment = work.mesh().kind(other.orbit) == VertexKind::kSegment;
        const OrbitVertex kept = on_segment ? OrbitVertex{other.orbit, 0} : OrbitVertex{v, 0};
        const OrbitVertex gone =
            on_segment ? OrbitVertex{v, work.mesh().subtract(0, other.exponent)} : other;
        const std::size_t triangles = work.mesh().triangle_count();
        if (work.surgery().merge(kept, gone)) {
          ++merged;
          EXPECT_LT(work.mesh().triangle_count(), triangles);
          EXPECT_EQ(work.mesh().kind(gone.orbit), VertexKind::kDeleted);
        }
        work.expect_valid("merge", v);
      });
      EXPECT_EQ(work.bad_triangles(), 0U);
      EXPECT_NEAR(test::area(work.mesh()), area, 1e-9 * area);
    }
  }
  EXPECT_GT(merged, 20);
}

}  // namespace
}  // namespace symcell::plane
