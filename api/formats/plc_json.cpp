#include "api/formats/plc_json.hpp"

#include <cmath>

#include "api/formats/json_walker.hpp"
#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"

namespace symcell {
namespace {

using internal::JsonNumbers;
using internal::JsonPlace;
using internal::JsonShape;

constexpr JsonPlace kModel{0, JsonShape::kObject, "an object with type, vertices, facets"};
constexpr JsonPlace kType{1, JsonShape::kText, "the string \"plc\""};
constexpr JsonPlace kVertices{2, JsonShape::kList, "a list"};
constexpr JsonPlace kVertex{3, JsonShape::kList, "[x, y, z]"};
constexpr JsonPlace kFacets{4, JsonShape::kList, "a list"};
constexpr JsonPlace kFacet{5, JsonShape::kObject,
                           "an object {\"polygons\": [[i, j, k, ...]], ...}"};
constexpr JsonPlace kPolygons{6, JsonShape::kList, "a list of lists of vertex indices"};
constexpr JsonPlace kPolygon{7, JsonShape::kList, "[i, j, k, ...]"};
constexpr JsonPlace kFacetHoles{8, JsonShape::kList, "a list"};
constexpr JsonPlace kFacetHole{9, JsonShape::kList, "[x, y, z]"};
constexpr JsonPlace kMarker{10, JsonShape::kNumberOrNull, "a number"};
constexpr JsonPlace kSegments{11, JsonShape::kList, "a list"};
constexpr JsonPlace kSegment{12, JsonShape::kList, "[i, j] or [i, j, marker]"};
constexpr JsonPlace kHoles{13, JsonShape::kList, "a list"};
constexpr JsonPlace kHole{14, JsonShape::kList, "[x, y, z]"};
constexpr JsonPlace kRegions{15, JsonShape::kList, "a list"};
constexpr JsonPlace kRegion{16, JsonShape::kObject, "an object {\"point\": [x, y, z], ...}"};
constexpr JsonPlace kPoint{17, JsonShape::kList, "[x, y, z]"};
constexpr JsonPlace kAttribute{18, JsonShape::kNumber, "a number"};
constexpr JsonPlace kMaxVolume{19, JsonShape::kNumberOrNull, "a number"};
constexpr JsonPlace kNumber{20, JsonShape::kNumber, "a number"};
constexpr JsonPlace kIndex{21, JsonShape::kNumber, "a vertex index"};
constexpr JsonPlace kComment{22, JsonShape::kIgnored, ""};

struct NamedPlace {
  std::string_view name;
  const JsonPlace* place;
};

constexpr NamedPlace kModelKeys[] = {
    {"type", &kType},         {"vertices", &kVertices}, {"facets", &kFacets},
    {"segments", &kSegments}, {"holes", &kHoles},       {"regions", &kRegions},
    {"name", &kComment},      {"comment", &kComment},   {"units", &kComment}};
constexpr NamedPlace kFacetKeys[] = {
    {"polygons", &kPolygons}, {"holes", &kFacetHoles}, {"marker", &kMarker}};
constexpr NamedPlace kRegionKeys[] = {
    {"point", &kPoint}, {"attribute", &kAttribute}, {"max_volume", &kMaxVolume}};

class PlcReader final : public internal::JsonWalker {
 public:
  using JsonWalker::JsonWalker;

  Result<Plc> read() {
    SYMCELL_TRY(walk());
    return std::move(plc_);
  }

 private:
  [[nodiscard]] const JsonPlace& root() const override { return kModel; }

  [[nodiscard]] const JsonPlace* member(const JsonPlace& object,
                                        std::string_view key) const override {
    const auto find = [&](const auto& keys) -> const JsonPlace* {
      for (const NamedPlace& known : keys) {
        if (known.name == key) return known.place;
      }
      return nullptr;
    };
    if (object.id == kFacet.id) return find(kFacetKeys);
    if (object.id == kRegion.id) return find(kRegionKeys);
    return find(kModelKeys);
  }

  [[nodiscard]] const JsonPlace& item(const JsonPlace& list) const override {
    switch (list.id) {
      case kVertices.id: return kVertex;
      case kFacets.id: return kFacet;
      case kPolygons.id: return kPolygon;
      case kPolygon.id: return kIndex;
      case kFacetHoles.id: return kFacetHole;
      case kSegments.id: return kSegment;
      case kHoles.id: return kHole;
      case kRegions.id: return kRegion;
      default: return kNumber;
    }
  }

  [[nodiscard]] const char* keys_of(const JsonPlace& object) const override {
    if (object.id == kFacet.id) return "a facet has polygons, holes, marker";
    if (object.id == kRegion.id) return "a region has point, attribute, max_volume";
    return "a solid model has type, vertices, facets, segments, holes, regions (and name, comment, "
           "units)";
  }

  void begin(const JsonPlace& place) override {
    switch (place.id) {
      case kFacet.id: facet_ = {}; return;
      // Counted as a corner: empty ones cost memory too.
      case kPolygon.id:
        if (has_room(corners_++, kMaxPlcCorners)) facet_.polygons.emplace_back();
        return;
      case kRegion.id: region_ = {}; return;
      default: numbers_ = {}; return;
    }
  }

  void text(const JsonPlace& /*place*/, const std::string& value) override {
    if (value == "plc") return;
    complain(ErrorCode::kWrongType, "the type \"" + printable(value) +
                                        "\" is not known; a solid model is of type \"plc\"");
  }

  void number(const JsonPlace& place, double value) override {
    switch (place.id) {
      case kIndex.id: return add_index(value);
      case kMarker.id: facet_.marker = label(value, "a marker"); return;
      case kAttribute.id: region_.attribute = label(value, "an attribute"); return;
      case kMaxVolume.id:
        if (!(value > 0)) {
          complain(ErrorCode::kWrongType, "max_volume must be positive; leave it out for no bound");
        }
        region_.max_volume = value;
        return;
      default: numbers_.add(value); return;
    }
  }

  void end(const JsonPlace& place, std::uint32_t seen) override {
    switch (place.id) {
      case kVertex.id: return add_point(plc_.vertices);
      case kFacetHole.id: return add_point(facet_.holes);
      case kFacet.id: return add_facet(seen);
      case kSegment.id: return add_segment();
      case kHole.id: return add_point(plc_.holes);
      case kPoint.id:
        if (is_point()) region_.point = point();
        return;
      case kRegion.id: return add_region(seen);
      case kModel.id: return check_complete(seen);
      default: return;
    }
  }

  // --- Numbers. ---------------------------------------------------------------------------------
  [[nodiscard]] Point3 point() const {
    return {numbers_.values[0], numbers_.values[1], numbers_.values[2]};
  }

  bool is_point() {
    if (numbers_.count == 3) return true;
    complain(ErrorCode::kWrongType,
             "a point is [x, y, z]; here are " + std::to_string(numbers_.count) + " numbers");
    return false;
  }

  std::int32_t label(double value, const char* what) {
    const std::optional<std::int32_t> whole = whole_int32(value);
    if (!whole)
      complain(ErrorCode::kWrongType, std::string(what) + " is a whole number of 32 bits");
    return whole.value_or(0);
  }

  // `place` continues the pointer.
  std::int32_t index(double value, const std::string& place = {}) {
    const std::optional<std::int32_t> whole = whole_int32(value);
    if (whole) return *whole;
    const bool integral = std::floor(value) == value;
    complain(integral ? ErrorCode::kIndexOutOfRange : ErrorCode::kWrongType,
             integral ? "there is no vertex of this index" : "a vertex index is a whole number",
             place);
    return 0;
  }

  // --- Entries. ---------------------------------------------------------------------------------
  bool has_room(std::size_t size, std::size_t most) {
    if (size < most) return true;
    stop(ErrorCode::kTooLarge, "more than " + std::to_string(most) + " entries; split the model");
    return false;
  }

  void add_point(std::vector<Point3>& points) {
    if (is_point() && has_room(points.size(), kMaxPlcVertices)) points.push_back(point());
  }

  void add_index(double value) {
    if (has_room(corners_++, kMaxPlcCorners)) facet_.polygons.back().push_back(index(value));
  }

  void add_facet(std::uint32_t seen) {
    if (!has(seen, kPolygons)) {
      return complain(ErrorCode::kMissingField,
                      "the facet has no \"polygons\": lists of vertex indices");
    }
    if (has_room(plc_.facets.size(), kMaxPlcCorners)) plc_.facets.push_back(std::move(facet_));
  }

  void add_segment() {
    if (numbers_.count != 2 && numbers_.count != 3) {
      return complain(ErrorCode::kWrongType, "a segment is [i, j] or [i, j, marker]; here are " +
                                                 std::to_string(numbers_.count) + " numbers");
    }
    PlcSegment segment;
    segment.a = index(numbers_.values[0], "/0");
    segment.b = index(numbers_.values[1], "/1");
    if (numbers_.count == 3) segment.marker = label(numbers_.values[2], "a marker");
    if (has_room(plc_.segments.size(), kMaxPlcCorners)) plc_.segments.push_back(segment);
  }

  void add_region(std::uint32_t seen) {
    if (!has(seen, kPoint)) {
      return complain(ErrorCode::kMissingField,
                      "the region has no \"point\": any point inside it, [x, y, z]");
    }
    if (has_room(plc_.regions.size(), kMaxPlcVertices)) plc_.regions.push_back(region_);
  }

  void check_complete(std::uint32_t seen) {
    for (const auto& [place, name] : {std::pair{&kType, "type"}, std::pair{&kVertices, "vertices"},
                                      std::pair{&kFacets, "facets"}}) {
      if (has(seen, *place)) continue;
      return complain(ErrorCode::kMissingField,
                      std::string("the model has no \"") + name +
                          "\"; a solid model is {\"type\": \"plc\", \"vertices\": [[x, y, z], "
                          "...], \"facets\": [{\"polygons\": [[i, j, k, ...]]}, ...]}",
                      std::string("/") + name);
    }
  }

  Plc plc_;
  JsonNumbers numbers_;
  PlcFacet facet_;
  PlcRegion region_;
  std::size_t corners_ = 0;  // of all polygons
};

// Looks at the keys of the outermost object only, and no further than it must.
class KindFinder {
 public:
  [[nodiscard]] ModelKind kind() const { return kind_; }

  bool null() { return true; }
  bool boolean(bool /*value*/) { return true; }
  bool number_integer(std::int64_t /*value*/) { return true; }
  bool number_unsigned(std::uint64_t /*value*/) { return true; }
  bool number_float(double /*value*/, const std::string& /*text*/) { return true; }
  bool binary(std::vector<std::uint8_t>& /*data*/) { return true; }
  bool string(std::string& value) {
    if (depth_ != 1 || !at_type_) return true;
    if (value == "plc") kind_ = ModelKind::kPlc;
    return false;
  }
  bool start_object(std::size_t /*count*/) { return ++depth_ < 64; }
  bool start_array(std::size_t /*count*/) { return ++depth_ < 64; }
  bool end_object() { return --depth_ > 0; }
  bool end_array() { return --depth_ > 0; }
  bool key(std::string& name) {
    if (depth_ != 1) return true;
    at_type_ = name == "type";
    if (name == "facets") kind_ = ModelKind::kPlc;
    return name != "facets";
  }
  bool parse_error(std::size_t /*position*/,
                   const std::string& /*last_token*/,
                   const nlohmann::detail::exception& /*exception*/) {
    return false;
  }

 private:
  ModelKind kind_ = ModelKind::kPslg;
  int depth_ = 0;
  bool at_type_ = false;
};

}  // namespace

Result<Plc> read_plc_json(std::string_view bytes) {
  return PlcReader(bytes).read();
}

ModelKind json_model_kind(std::string_view bytes) {
  KindFinder finder;
  nlohmann::json::sax_parse(bytes.begin(), bytes.end(), &finder);
  return finder.kind();
}

}  // namespace symcell
