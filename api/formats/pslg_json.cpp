#include "api/formats/pslg_json.hpp"

#include <cmath>

#include "api/formats/json_walker.hpp"
#include "api/formats/text_numbers.hpp"
#include "api/printable.hpp"
#include "core/model/arc_centres.hpp"

namespace symcell {
namespace {

using internal::JsonNumbers;
using internal::JsonPlace;
using internal::JsonShape;

constexpr JsonPlace kModel{0, JsonShape::kObject, "an object with type, vertices, segments"};
constexpr JsonPlace kType{1, JsonShape::kText, "the string \"pslg\""};
constexpr JsonPlace kVertices{2, JsonShape::kList, "a list"};
constexpr JsonPlace kVertex{3, JsonShape::kList, "[x, y]"};
constexpr JsonPlace kSegments{4, JsonShape::kList, "a list"};
constexpr JsonPlace kSegment{5, JsonShape::kList, "[i, j] or [i, j, marker]"};
constexpr JsonPlace kHoles{6, JsonShape::kList, "a list"};
constexpr JsonPlace kHole{7, JsonShape::kList, "[x, y]"};
constexpr JsonPlace kRegions{8, JsonShape::kList, "a list"};
constexpr JsonPlace kRegion{9, JsonShape::kObject, "an object {\"point\": [x, y], ...}"};
constexpr JsonPlace kPoint{10, JsonShape::kList, "[x, y]"};
constexpr JsonPlace kAttribute{11, JsonShape::kNumber, "a number"};
constexpr JsonPlace kMaxArea{12, JsonShape::kNumberOrNull, "a number"};
constexpr JsonPlace kNumber{13, JsonShape::kNumber, "a number"};
constexpr JsonPlace kComment{14, JsonShape::kIgnored, ""};
// A segment may be an object, too: what is more than ends and a marker has a name.
constexpr JsonPlace kSegmentObject{15, JsonShape::kObject, "[i, j] or {\"vertices\": [i, j], ...}"};
constexpr JsonPlace kEnds{16, JsonShape::kList, "[i, j]"};
constexpr JsonPlace kMarker{17, JsonShape::kNumber, "a whole number"};
constexpr JsonPlace kBulge{18, JsonShape::kNumber, "a number"};
constexpr JsonPlace kCenter{19, JsonShape::kList, "[x, y]"};

class PslgReader final : public internal::JsonWalker {
 public:
  using JsonWalker::JsonWalker;

  Result<Pslg> read() {
    SYMCELL_TRY(walk());
    SYMCELL_TRY(resolve_arcs(centres_, pslg_));
    return std::move(pslg_);
  }

 private:
  [[nodiscard]] const JsonPlace& root() const override { return kModel; }

  [[nodiscard]] const JsonPlace* member(const JsonPlace& object,
                                        std::string_view key) const override {
    if (object.id == kRegion.id) {
      if (key == "point") return &kPoint;
      if (key == "attribute") return &kAttribute;
      if (key == "max_area") return &kMaxArea;
      return nullptr;
    }
    if (object.id == kSegmentObject.id) {
      if (key == "vertices") return &kEnds;
      if (key == "marker") return &kMarker;
      if (key == "bulge") return &kBulge;
      if (key == "center") return &kCenter;
      return nullptr;
    }
    if (key == "type") return &kType;
    if (key == "vertices") return &kVertices;
    if (key == "segments") return &kSegments;
    if (key == "holes") return &kHoles;
    if (key == "regions") return &kRegions;
    if (key == "name" || key == "comment" || key == "units") return &kComment;
    return nullptr;
  }

  [[nodiscard]] const JsonPlace& item(const JsonPlace& list) const override {
    switch (list.id) {
      case kVertices.id: return kVertex;
      case kSegments.id: return kSegment;
      case kHoles.id: return kHole;
      case kRegions.id: return kRegion;
      default: return kNumber;
    }
  }

  [[nodiscard]] const JsonPlace* other_shape(const JsonPlace& place,
                                             JsonShape shape) const override {
    return place.id == kSegment.id && shape == JsonShape::kObject ? &kSegmentObject : nullptr;
  }

  [[nodiscard]] const char* keys_of(const JsonPlace& object) const override {
    if (object.id == kSegmentObject.id) return "a segment has vertices, marker, bulge or center";
    return object.id == kRegion.id
               ? "a region has point, attribute, max_area"
               : "a planar model has type, vertices, segments, holes, regions (and name, comment, "
                 "units); a solid one is of type \"plc\"";
  }

  void begin(const JsonPlace& place) override {
    numbers_ = {};
    if (place.id == kRegion.id) region_ = {};
    if (place.id == kSegmentObject.id) {
      segment_ = {};
      bulge_ = 0;
      centre_ = {};
    }
  }

  void text(const JsonPlace& /*place*/, const std::string& value) override {
    if (value == "pslg") return;
    complain(
        ErrorCode::kWrongType,
        "the type \"" + printable(value) +
            "\" is not known; a planar model is of type \"pslg\", a solid one of type \"plc\"");
  }

  void number(const JsonPlace& place, double value) override {
    if (place.id == kAttribute.id) {
      const std::optional<std::int32_t> whole = whole_int32(value);
      if (!whole) complain(ErrorCode::kWrongType, "an attribute is a whole number of 32 bits");
      region_.attribute = whole.value_or(0);
    } else if (place.id == kMaxArea.id) {
      if (!(value > 0)) {
        complain(ErrorCode::kWrongType, "max_area must be positive; leave it out for no bound");
      }
      region_.max_area = value;
    } else if (place.id == kMarker.id) {
      segment_.marker = marker(value, "");
    } else if (place.id == kBulge.id) {
      bulge_ = value;
    } else {
      numbers_.add(value);
    }
  }

  void end(const JsonPlace& place, std::uint32_t seen) override {
    switch (place.id) {
      case kVertex.id: return add_point(pslg_.vertices);
      case kHole.id: return add_point(pslg_.holes);
      case kSegment.id: return add_segment();
      case kSegmentObject.id: return add_arc(seen);
      case kEnds.id: return take_ends();
      case kCenter.id:
        if (is_point()) centre_ = {numbers_.values[0], numbers_.values[1]};
        return;
      case kRegion.id: return add_region(seen);
      case kModel.id: return check_complete(seen);
      case kPoint.id:
        if (is_point()) region_.point = {numbers_.values[0], numbers_.values[1]};
        return;
      default: return;
    }
  }

  bool is_point() {
    if (numbers_.count == 2) return true;
    complain(ErrorCode::kWrongType,
             "a point is [x, y]; here are " + std::to_string(numbers_.count) + " numbers");
    return false;
  }

  template <class List>
  bool has_room(const List& list, std::size_t most) {
    if (list.size() < most) return true;
    stop(ErrorCode::kTooLarge, "more than " + std::to_string(most) + " entries; split the model");
    return false;
  }

  void add_point(std::vector<Point2>& points) {
    if (is_point() && has_room(points, kMaxPslgVertices)) {
      points.push_back({numbers_.values[0], numbers_.values[1]});
    }
  }

  // `place` continues the pointer.
  std::int32_t index(double value, const std::string& place) {
    const std::optional<std::int32_t> whole = whole_int32(value);
    if (whole) return *whole;
    const bool integral = std::floor(value) == value;
    complain(integral ? ErrorCode::kIndexOutOfRange : ErrorCode::kWrongType,
             integral ? "there is no vertex of this index" : "a vertex index is a whole number",
             place);
    return 0;
  }

  void add_segment() {
    if (numbers_.count != 2 && numbers_.count != 3) {
      return complain(ErrorCode::kWrongType, "a segment is [i, j] or [i, j, marker]; here are " +
                                                 std::to_string(numbers_.count) + " numbers");
    }
    PslgSegment segment;
    segment.a = index(numbers_.values[0], "/0");
    segment.b = index(numbers_.values[1], "/1");
    if (numbers_.count == 3) segment.marker = marker(numbers_.values[2], "/2");
    push_segment(segment);
  }

  std::int32_t marker(double value, const std::string& place) {
    const std::optional<std::int32_t> marker = whole_int32(value);
    if (!marker) complain(ErrorCode::kWrongType, "a marker is a whole number of 32 bits", place);
    return marker.value_or(0);
  }

  void push_segment(const PslgSegment& segment) {
    if (!has_room(pslg_.segments, 4 * kMaxPslgVertices)) return;
    pslg_.segments.push_back(segment);
    if (!pslg_.bulges.empty()) pslg_.bulges.push_back(0);
  }

  void take_ends() {
    if (numbers_.count != 2) {
      return complain(ErrorCode::kWrongType, "the ends of a segment are [i, j]; here are " +
                                                 std::to_string(numbers_.count) + " numbers");
    }
    segment_.a = index(numbers_.values[0], "/0");
    segment_.b = index(numbers_.values[1], "/1");
  }

  void add_arc(std::uint32_t seen) {
    if (!has(seen, kEnds)) {
      return complain(ErrorCode::kMissingField,
                      "the segment has no \"vertices\": its two ends, [i, j]");
    }
    if (has(seen, kBulge) && has(seen, kCenter)) {
      return complain(ErrorCode::kWrongType,
                      "a segment has a bulge or a center, not both; leave out one of them");
    }
    push_segment(segment_);
    if (!has(seen, kBulge) && !has(seen, kCenter)) return;
    pslg_.bulges.resize(pslg_.segments.size(), 0);
    pslg_.bulges.back() = bulge_;
    const auto last = static_cast<std::int32_t>(pslg_.segments.size()) - 1;
    if (has(seen, kCenter)) centres_.push_back({last, centre_});
  }

  void add_region(std::uint32_t seen) {
    if (!has(seen, kPoint)) {
      return complain(ErrorCode::kMissingField,
                      "the region has no \"point\": any point inside it, [x, y]");
    }
    if (has_room(pslg_.regions, kMaxPslgVertices)) pslg_.regions.push_back(region_);
  }

  void check_complete(std::uint32_t seen) {
    for (const auto& [place, name] : {std::pair{&kType, "type"}, std::pair{&kVertices, "vertices"},
                                      std::pair{&kSegments, "segments"}}) {
      if (has(seen, *place)) continue;
      return complain(ErrorCode::kMissingField,
                      std::string("the model has no \"") + name +
                          "\"; a planar model is {\"type\": \"pslg\", \"vertices\": [[x, y], ...], "
                          "\"segments\": [[i, j], ...]}",
                      std::string("/") + name);
    }
  }

  Pslg pslg_;
  JsonNumbers numbers_;
  PslgRegion region_;
  PslgSegment segment_;
  double bulge_ = 0;
  Point2 centre_;
  std::vector<ArcCentre> centres_;
};

}  // namespace

Result<Pslg> read_pslg_json(std::string_view bytes) {
  return PslgReader(bytes).read();
}

}  // namespace symcell
