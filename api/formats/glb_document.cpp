#include "api/formats/glb_document.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace symcell {
namespace {

using Json = nlohmann::ordered_json;

// The numbers of glTF 2.0.
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr int kModeLines = 1;
constexpr int kModeTriangles = 4;
constexpr std::uint32_t kMagic = 0x46546C67;
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

double three_digits(double value) {
  return std::round(value * 1000) / 1000;
}

}  // namespace

GlbColour glb_palette(std::size_t number) {
  // Hues from yellow to cyan and from violet to pink; red (0) and blue (240) belong to the bounds.
  constexpr double kGolden = 0.6180339887498949;
  constexpr double kFrom = 35, kGreens = 150, kGap = 95;
  constexpr double kHues = 205;
  const double along = std::fmod(0.1 + kGolden * static_cast<double>(number), 1) * kHues;
  const double hue = kFrom + along + (along > kGreens ? kGap : 0);
  const double saturation = 0.55, value = 0.72;
  const auto channel = [&](double n) {
    const double k = std::fmod(n + hue / 60, 6);
    const double shade = std::clamp(std::min(k, 4 - k), 0.0, 1.0);
    // To linear light, near enough to sRGB's curve for a palette.
    const double encoded = value * (1 - saturation * shade);
    return three_digits(encoded * encoded);
  };
  return {channel(5), channel(3), channel(1)};
}

GlbDocument::GlbDocument() {
  json_["asset"] = {{"version", "2.0"}, {"generator", "symcell"}};
  json_["scene"] = 0;
  json_["scenes"] = Json::array({{{"nodes", Json::array({kRoot})}}});
  const double half = std::sqrt(0.5);
  nodes_.push_back({{"name", "z is up"}, {"rotation", {-half, 0, 0, half}}});
}

std::size_t GlbDocument::add_accessor(Json accessor, std::size_t bytes, int target) {
  const std::size_t view = json_["bufferViews"].size();
  json_["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", bytes}, {"target", target}});
  accessor["bufferView"] = view;
  json_["accessors"].push_back(std::move(accessor));
  return view;
}

std::size_t GlbDocument::add_positions(const std::vector<Point3>& points) {
  std::array<float, 3> least{}, most{};
  least.fill(std::numeric_limits<float>::max());
  most.fill(std::numeric_limits<float>::lowest());
  const std::size_t offset = numbers_.size() * sizeof(float);
  numbers_.reserve(numbers_.size() + 3 * points.size());
  for (const Point3& p : points) {
    const std::array<double, 3> coordinates{p.x, p.y, p.z};
    for (std::size_t i = 0; i < 3; ++i) {
      // What single precision cannot hold is at its end: a picture has no infinities.
      constexpr double kMost = std::numeric_limits<float>::max();
      const auto c = static_cast<float>(std::clamp(coordinates[i], -kMost, kMost));
      least[i] = std::min(least[i], c);
      most[i] = std::max(most[i], c);
      numbers_.push_back(c);
    }
  }
  const std::size_t accessor =
      add_accessor({{"componentType", kFloat},
                    {"count", points.size()},
                    {"type", "VEC3"},
                    {"min", {double{least[0]}, double{least[1]}, double{least[2]}}},
                    {"max", {double{most[0]}, double{most[1]}, double{most[2]}}}},
                   3 * sizeof(float) * points.size(), kArrayBuffer);
  json_["bufferViews"].back()["byteOffset"] = offset;
  return accessor;
}

std::size_t GlbDocument::add_indices(const std::vector<std::uint32_t>& indices) {
  const std::size_t offset = indices_.size() * sizeof(std::uint32_t);
  indices_.insert(indices_.end(), indices.begin(), indices.end());
  const std::size_t accessor =
      add_accessor({{"componentType", kUnsignedInt}, {"count", indices.size()}, {"type", "SCALAR"}},
                   sizeof(std::uint32_t) * indices.size(), kElementArrayBuffer);
  json_["bufferViews"].back()["byteOffset"] = offset;
  index_views_.push_back(accessor);
  return accessor;
}

std::size_t GlbDocument::add_material(const std::string& name, const GlbColour& colour, bool lit) {
  Json material{{"name", name},
                {"pbrMetallicRoughness",
                 {{"baseColorFactor", {colour[0], colour[1], colour[2], 1}},
                  {"metallicFactor", 0},
                  {"roughnessFactor", 0.8}}},
                {"doubleSided", true}};
  if (!lit) {
    material["extensions"] = {{"KHR_materials_unlit", Json::object()}};
    json_["extensionsUsed"] = Json::array({"KHR_materials_unlit"});
  }
  json_["materials"].push_back(std::move(material));
  return json_["materials"].size() - 1;
}

std::size_t GlbDocument::add_mesh(const std::string& name) {
  json_["meshes"].push_back({{"name", name}, {"primitives", Json::array()}});
  return json_["meshes"].size() - 1;
}

void GlbDocument::add_primitive(std::size_t mesh,
                                Shape shape,
                                std::size_t positions,
                                std::size_t indices,
                                std::size_t material,
                                Json extras) {
  Json primitive{{"attributes", {{"POSITION", positions}}},
                 {"indices", indices},
                 {"material", material},
                 {"mode", shape == Shape::kLines ? kModeLines : kModeTriangles}};
  if (!extras.is_null()) primitive["extras"] = std::move(extras);
  json_["meshes"][mesh]["primitives"].push_back(std::move(primitive));
}

std::size_t GlbDocument::add_node(const std::string& name,
                                  std::size_t parent,
                                  const Point3& translation,
                                  const std::array<double, 4>& rotation) {
  const std::size_t node = nodes_.size();
  Json made{{"name", name}};
  if (translation.x != 0 || translation.y != 0 || translation.z != 0) {
    made["translation"] = {translation.x, translation.y, translation.z};
  }
  if (rotation[3] != 1) made["rotation"] = rotation;
  nodes_.push_back(std::move(made));
  nodes_[parent]["children"].push_back(node);
  return node;
}

void GlbDocument::set_mesh(std::size_t node, std::size_t mesh) {
  nodes_[node]["mesh"] = mesh;
}

void GlbDocument::set_turned_copies(std::size_t parent, std::vector<std::size_t> meshes) {
  copies_ = {parent, std::move(meshes)};
}

std::string GlbDocument::nodes_text() const {
  const std::size_t count = copies_.meshes.size();
  std::string text = "[";
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (i > 0) text += ',';
    text += nodes_[i].dump();
    if (count == 0 || i != copies_.parent) continue;
    text.pop_back();  // the brace
    text += ",\"children\":[";
    for (std::size_t s = 0; s < count; ++s) {
      if (s > 0) text += ',';
      text += std::to_string(nodes_.size() + s);
    }
    text += "]}";
  }
  for (std::size_t s = 0; s < count; ++s) {
    const double half_angle = M_PI * static_cast<double>(s) / static_cast<double>(count);
    Json node{{"name", "sector " + std::to_string(s)}, {"mesh", copies_.meshes[s]}};
    if (s > 0) node["rotation"] = {0, 0, std::sin(half_angle), std::cos(half_angle)};
    text += ',' + node.dump();
  }
  return text + "]";
}

void GlbDocument::set_extras(Json extras) {
  json_["scenes"][0]["extras"] = std::move(extras);
}

Result<void> GlbDocument::write(ByteWriter& out) const {
  Json json = json_;
  const std::size_t position_bytes = numbers_.size() * sizeof(float);
  const std::size_t bytes = position_bytes + indices_.size() * sizeof(std::uint32_t);
  for (const std::size_t view : index_views_) {
    json["bufferViews"][view]["byteOffset"] =
        json["bufferViews"][view]["byteOffset"].get<std::size_t>() + position_bytes;
  }
  json["buffers"] = Json::array({{{"byteLength", bytes}}});
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.pop_back();  // the brace
  text += ",\"nodes\":" + nodes_text() + "}";
  while (text.size() % 4 != 0) text += ' ';
  const std::size_t total = kHeaderBytes + 2 * kChunkHeaderBytes + text.size() + bytes;
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    return fail(ErrorCode::kTooLarge,
                "the surface has more triangles than a GLB file can hold; take vtu");
  }
  const auto number = [&out](std::size_t value) { out.value(static_cast<std::uint32_t>(value)); };
  number(kMagic);
  number(kVersion);
  number(total);
  number(text.size());
  number(kJsonChunk);
  out.text(text);
  number(bytes);
  number(kBinaryChunk);
  out.raw(numbers_.data(), position_bytes);
  out.raw(indices_.data(), bytes - position_bytes);
  return {};
}

}  // namespace symcell
