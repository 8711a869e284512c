// Models made from bytes, for structured fuzzing: whatever the bytes are, what comes out is a
// sensible model, and neighbouring bytes make neighbouring models.
//
// A model is a grid whose cells are void or belong to a region: squares about the centre, or rings
// cut into sectors; solids stack layers of it. Faces between cells of different regions are the
// model's, and walls between like ones where the bytes say so: thus tabs, ribs, combs, pockets,
// T-junctions and facets in the shape of a U, which touch each other at edges and corners. In
// solids faces of one plane may be joined to facets with outlines of any shape.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/model/mesh_options.hpp"
#include "core/model/plc.hpp"
#include "core/model/pslg.hpp"

namespace symcell::fuzz {

// Reads bytes one by one; behind the end all are 0.
class ByteSource {
 public:
  ByteSource(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : 0; }
  // Of 0 .. count - 1.
  std::int32_t below(std::int32_t count) { return byte() % count; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

template <class Geometry>
struct GeneratedModel {
  Geometry geometry;
  MeshOptions options;
  double measure = 0;  // area or volume of the meshed domain
};

[[nodiscard]] GeneratedModel<Pslg> generate_planar(ByteSource& bytes);
[[nodiscard]] GeneratedModel<Plc> generate_solid(ByteSource& bytes);

}  // namespace symcell::fuzz
