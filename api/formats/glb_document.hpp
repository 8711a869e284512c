// A binary glTF 2.0 file in the making: arrays in one buffer, materials, meshes of triangles and lines, a
// tree of nodes. Written by hand because the arrays are to go out as they are, once, in bounded pieces.
//
// Positions are single precision: what needs more digits than that is placed by its node. glTF's up is
// y and models' is z: the root node turns one into the other.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "api/formats/byte_writer.hpp"
#include "core/base/error.hpp"
#include "core/geometry/point.hpp"

namespace symcell {

using GlbColour = std::array<double, 3>;  // linear red, green, blue, 0 to 1

// Well apart for neighbouring numbers, of whatever number: hues by the golden section, never the red and
// the blue of bounds.
[[nodiscard]] GlbColour glb_palette(std::size_t number);

class GlbDocument {
 public:
  enum class Shape : std::uint8_t { kTriangles, kLines };

  GlbDocument();

  // Each returns the number by which others refer to it.
  // Requires: `points` is not empty.
  std::size_t add_positions(const std::vector<Point3>& points);
  // Corners of triangles or ends of lines, numbers of points.  Requires: not empty.
  std::size_t add_indices(const std::vector<std::uint32_t>& indices);
  std::size_t add_material(const std::string& name, const GlbColour& colour, bool lit);
  std::size_t add_mesh(const std::string& name);
  void add_primitive(std::size_t mesh,
                     Shape shape,
                     std::size_t positions,
                     std::size_t indices,
                     std::size_t material,
                     nlohmann::ordered_json extras = nullptr);

  // A node below `parent`, or below the root.  `rotation`: a unit quaternion x, y, z, w.
  std::size_t add_node(const std::string& name,
                       std::size_t parent,
                       const Point3& translation,
                       const std::array<double, 4>& rotation);
  void set_mesh(std::size_t node, std::size_t mesh);
  // One node a sector below `parent`, which must have no other: node s shows meshes[s], turned about z by
  // s of as many steps as there are meshes. Kept as this rule, for folds of thousands.
  void set_turned_copies(std::size_t parent, std::vector<std::size_t> meshes);
  // What the file says beside glTF's own words, in the scene's `extras`.
  void set_extras(nlohmann::ordered_json extras);

  static constexpr std::size_t kRoot = 0;

  // Errors: kTooLarge (4 GiB, which the format cannot count).
  [[nodiscard]] Result<void> write(ByteWriter& out) const;

 private:
  std::size_t add_accessor(nlohmann::ordered_json accessor, std::size_t bytes, int target);

  [[nodiscard]] std::string nodes_text() const;

  struct Copies {
    std::size_t parent = 0;
    std::vector<std::size_t> meshes;
  };

  nlohmann::ordered_json json_;  // but for the nodes
  std::vector<nlohmann::ordered_json> nodes_;
  Copies copies_;
  std::vector<float> numbers_;            // of positions, which come first in the buffer
  std::vector<std::uint32_t> indices_;    // after them
  std::vector<std::size_t> index_views_;  // buffer views whose offset is known at the end
};

}  // namespace symcell
