// Names of faces and edges are equal exactly where a rotation maps one onto the other, found here
// by trying all rotations; the map of subsegments against std::map.
#include "core/geometry/orbit_keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "core/base/random.hpp"

namespace symcell {
namespace {

constexpr VertexId kAxisVertices = 2;  // ids below lie on the axis

bool axis(VertexId v) {
  return v < kAxisVertices;
}

class Source {
 public:
  Source(std::uint64_t seed, std::int32_t fold) : random_(seed), rotations_(fold) {}

  std::int32_t below(std::int32_t n) {
    return static_cast<std::int32_t>(random_.next() % static_cast<std::uint64_t>(n));
  }
  // Few orbits, so that faces with two or three corners of one orbit are frequent.
  OrbitVertex corner() {
    const VertexId v = below(5);
    return {v, axis(v) ? 0 : below(rotations_.fold())};
  }
  template <std::size_t N>
  std::array<OrbitVertex, N> corners() {
    std::array<OrbitVertex, N> c;
    for (;;) {
      for (OrbitVertex& x : c) x = corner();
      bool good = std::any_of(c.begin(), c.end(), [](OrbitVertex x) { return !axis(x.orbit); });
      for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t j = 0; j < i; ++j) good = good && !(c[i] == c[j]);
      }
      if (good) return c;
    }
  }
  template <std::size_t N>
  void shuffle(std::array<OrbitVertex, N>& c) {
    for (std::size_t i = N; i > 1; --i) {
      std::swap(c[i - 1], c[static_cast<std::size_t>(below(static_cast<std::int32_t>(i)))]);
    }
  }
  template <std::size_t N>
  std::array<OrbitVertex, N> turned(std::array<OrbitVertex, N> c, std::int32_t e) const {
    for (OrbitVertex& x : c) x.exponent = axis(x.orbit) ? 0 : rotations_.add(x.exponent, e);
    return c;
  }
  [[nodiscard]] const RotationTable& rotations() const { return rotations_; }

 private:
  Random random_;
  RotationTable rotations_;
};

template <std::size_t N>
bool same_set(std::array<OrbitVertex, N> a, std::array<OrbitVertex, N> b) {
  const auto less = [](OrbitVertex x, OrbitVertex y) {
    return std::tie(x.orbit, x.exponent) < std::tie(y.orbit, y.exponent);
  };
  std::sort(a.begin(), a.end(), less);
  std::sort(b.begin(), b.end(), less);
  return std::equal(a.begin(), a.end(), b.begin());
}

template <std::size_t N>
bool congruent(const Source& source,
               const std::array<OrbitVertex, N>& a,
               const std::array<OrbitVertex, N>& b) {
  for (std::int32_t e = 0; e < source.rotations().fold(); ++e) {
    if (same_set(source.turned(a, e), b)) return true;
  }
  return false;
}

KeyedFace face_key(const Source& source, const std::array<OrbitVertex, 3>& c) {
  return make_face_key(source.rotations(), c,
                       {axis(c[0].orbit), axis(c[1].orbit), axis(c[2].orbit)});
}
EdgeKey edge_key(const Source& source, const std::array<OrbitVertex, 2>& c) {
  return make_edge_key(source.rotations(), c[0], c[1], axis(c[0].orbit), axis(c[1].orbit));
}

TEST(OrbitKeys, FaceNamesAreEqualExactlyForCopies) {
  for (const std::int32_t fold : {1, 2, 3, 4, 6, 9}) {
    Source source(static_cast<std::uint64_t>(fold), fold);
    if (fold == 1) continue;  // five orbits give no face without an axis pair
    int equal = 0;
    for (int i = 0; i < 20000; ++i) {
      const auto a = source.corners<3>();
      auto b = i % 2 == 0 ? source.corners<3>() : source.turned(a, source.below(fold));
      source.shuffle(b);
      const KeyedFace ka = face_key(source, a), kb = face_key(source, b);
      ASSERT_EQ(ka.key == kb.key, congruent(source, a, b));
      if (!(ka.key == kb.key)) continue;
      ++equal;
      // The references give the rotation between them.
      const std::int32_t e = source.rotations().subtract(kb.reference, ka.reference);
      ASSERT_TRUE(same_set(source.turned(a, e), b));
    }
    EXPECT_GT(equal, 5000);
  }
}

TEST(OrbitKeys, EdgeNamesAreEqualExactlyForCopies) {
  for (const std::int32_t fold : {2, 3, 4, 6, 9}) {
    Source source(static_cast<std::uint64_t>(fold), fold);
    for (int i = 0; i < 20000; ++i) {
      const auto a = source.corners<2>();
      auto b = i % 2 == 0 ? source.corners<2>() : source.turned(a, source.below(fold));
      source.shuffle(b);
      ASSERT_EQ(edge_key(source, a) == edge_key(source, b), congruent(source, a, b));
    }
  }
}

TEST(EdgeMap, IsAMap) {
  Random random(1);
  EdgeMap map;
  std::map<std::tuple<VertexId, VertexId, std::int32_t>, std::int32_t> reference;
  EXPECT_EQ(map.find({1, 2, 0}), -1);
  map.erase({1, 2, 0});
  for (std::int32_t i = 0; i < 200000; ++i) {
    const auto pick = [&](std::uint64_t n) { return static_cast<std::int32_t>(random.next() % n); };
    const EdgeKey key{pick(30), pick(30), pick(3)};
    const std::tuple name(key.a, key.b, key.exponent);
    // Growing and shrinking in turn.
    if (pick(8) < (i / 20000 % 2 == 0 ? 5 : 2)) {
      map.set(key, i);
      reference[name] = i;
    } else {
      map.erase(key);
      reference.erase(name);
    }
    ASSERT_EQ(map.size(), reference.size());
    const EdgeKey probe{pick(30), pick(30), pick(3)};
    const auto it = reference.find({probe.a, probe.b, probe.exponent});
    ASSERT_EQ(map.find(probe), it == reference.end() ? -1 : it->second);
  }
  std::size_t visited = 0;
  map.for_each([&](const EdgeKey& key, std::int32_t segment) {
    ++visited;
    EXPECT_EQ(reference.at({key.a, key.b, key.exponent}), segment);
  });
  EXPECT_EQ(visited, reference.size());
  map.clear();
  EXPECT_EQ(map.size(), 0U);
  EXPECT_EQ(map.find({1, 2, 0}), -1);
}

}  // namespace
}  // namespace symcell
