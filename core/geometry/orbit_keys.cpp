#include "core/geometry/orbit_keys.hpp"

#include <algorithm>
#include <utility>

#include "core/base/mix.hpp"

namespace symcell {
namespace {

struct Named {
  VertexId v;
  std::int32_t k;
  bool operator<(const Named& o) const { return v != o.v ? v < o.v : k < o.k; }
};

FaceKey pack(const std::array<Named, 3>& c) {
  const auto u32 = [](std::int32_t i) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i));
  };
  return {u32(c[0].v) << 32 | u32(c[1].v), u32(c[2].v) << 32 | u32(c[1].k) << 16 | u32(c[2].k)};
}

bool less(const FaceKey& a, const FaceKey& b) {
  return a.high != b.high ? a.high < b.high : a.low < b.low;
}

std::uint64_t hash(const EdgeKey& key) {
  const auto u32 = [](std::int32_t i) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i));
  };
  return mix((u32(key.a) << 32 | u32(key.b)) + 0x9e3779b97f4a7c15ULL * u32(key.exponent));
}

}  // namespace

KeyedFace make_face_key(const RotationTable& rotations,
                        std::array<OrbitVertex, 3> corners,
                        std::array<bool, 3> on_axis) {
  // Three compare-exchanges sort by vertex id.
  const auto order = [&](std::size_t i, std::size_t j) {
    if (corners[j].orbit < corners[i].orbit) {
      std::swap(corners[i], corners[j]);
      std::swap(on_axis[i], on_axis[j]);
    }
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  // Axis corners are named (v, 0) in every frame; k of the first corner is not part of the name, so
  // an axis corner in front needs the others' exponents relative to the reference, as any does.
  const auto named_by = [&](std::size_t ref) {
    const std::int32_t k0 = corners[ref].exponent;
    std::array<Named, 3> c;
    for (std::size_t i = 0; i < 3; ++i) {
      c[i] = {corners[i].orbit, on_axis[i] ? 0 : rotations.subtract(corners[i].exponent, k0)};
    }
    if (c[2] < c[1]) std::swap(c[1], c[2]);
    return c;
  };
  std::size_t ref = 0;
  while (ref < 2 && on_axis[ref]) ++ref;
  const bool twin = ref < 2 && corners[ref].orbit == corners[ref + 1].orbit;
  if (!twin) return {pack(named_by(ref)), corners[ref].exponent};
  KeyedFace best;
  bool first = true;
  for (std::size_t i = ref; i < 3 && corners[i].orbit == corners[ref].orbit; ++i) {
    auto c = named_by(i);
    std::sort(c.begin(), c.end());
    const FaceKey key = pack(c);
    if (first || less(key, best.key)) best = {key, corners[i].exponent};
    first = false;
  }
  return best;
}

EdgeKey make_edge_key(
    const RotationTable& rotations, OrbitVertex a, OrbitVertex b, bool a_on_axis, bool b_on_axis) {
  if (b.orbit < a.orbit) {
    std::swap(a, b);
    std::swap(a_on_axis, b_on_axis);
  }
  if (a_on_axis || b_on_axis) return {a.orbit, b.orbit, 0};
  const std::int32_t forth = rotations.subtract(b.exponent, a.exponent);
  if (a.orbit != b.orbit) return {a.orbit, b.orbit, forth};
  return {a.orbit, b.orbit, std::min(forth, rotations.subtract(a.exponent, b.exponent))};
}

std::size_t EdgeMap::place(const EdgeKey& key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = static_cast<std::size_t>(hash(key)) & mask;
  while (slots_[i].state == State::kErased ||
         (slots_[i].state == State::kUsed && !(slots_[i].key == key))) {
    i = (i + 1) & mask;
  }
  return i;
}

void EdgeMap::grow() {
  std::vector<Slot> old = std::move(slots_);
  std::size_t capacity = 64;
  while (capacity < 4 * (size_ + 1)) capacity *= 2;
  slots_.assign(capacity, {});
  erased_ = 0;
  for (const Slot& s : old) {
    if (s.state == State::kUsed) slots_[place(s.key)] = s;
  }
}

void EdgeMap::set(const EdgeKey& key, std::int32_t segment) {
  if (2 * (size_ + erased_ + 1) > slots_.size()) grow();
  Slot& s = slots_[place(key)];
  if (s.state != State::kUsed) ++size_;
  s = {key, segment, State::kUsed};
}

void EdgeMap::erase(const EdgeKey& key) {
  if (slots_.empty()) return;
  Slot& s = slots_[place(key)];
  if (s.state != State::kUsed) return;
  s.state = State::kErased;
  --size_;
  ++erased_;
}

std::int32_t EdgeMap::find(const EdgeKey& key) const {
  if (slots_.empty()) return -1;
  const Slot& s = slots_[place(key)];
  return s.state == State::kUsed ? s.segment : -1;
}

void EdgeMap::clear() {
  slots_.clear();
  size_ = 0;
  erased_ = 0;
}

}  // namespace symcell
