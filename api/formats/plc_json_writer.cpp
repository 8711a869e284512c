#include <cmath>

#include "api/formats/byte_writer.hpp"
#include "api/formats/plc_json.hpp"

namespace symcell {
namespace {

void write_point(ByteWriter& out, const Point3& p) {
  out.text("[");
  out.real(p.x);
  out.text(",");
  out.real(p.y);
  out.text(",");
  out.real(p.z);
  out.text("]");
}

// `write`: one item.
template <class List, class Write>
void write_list(ByteWriter& out, const List& list, const Write& write) {
  out.text("[");
  bool first = true;
  for (const auto& item : list) {
    if (!first) out.text(",");
    first = false;
    write(item);
  }
  out.text("]");
}

void write_facet(ByteWriter& out, const PlcFacet& facet) {
  out.text("{\"polygons\":");
  write_list(out, facet.polygons, [&](const std::vector<std::int32_t>& polygon) {
    write_list(out, polygon, [&](std::int32_t v) { out.integer(v); });
  });
  if (!facet.holes.empty()) {
    out.text(",\"holes\":");
    write_list(out, facet.holes, [&](const Point3& p) { write_point(out, p); });
  }
  if (facet.marker != 0) {
    out.text(",\"marker\":");
    out.integer(facet.marker);
  }
  out.text("}");
}

void write_segment(ByteWriter& out, const PlcSegment& segment) {
  out.text("[");
  out.integer(segment.a);
  out.text(",");
  out.integer(segment.b);
  if (segment.marker != 0) {
    out.text(",");
    out.integer(segment.marker);
  }
  out.text("]");
}

void write_region(ByteWriter& out, const PlcRegion& region) {
  out.text("{\"point\":");
  write_point(out, region.point);
  out.text(",\"attribute\":");
  out.integer(region.attribute);
  if (std::isfinite(region.max_volume)) {
    out.text(",\"max_volume\":");
    out.real(region.max_volume);
  }
  out.text("}");
}

}  // namespace

std::string write_plc_json(const Plc& plc) {
  std::string text;
  const Sink sink = [&](std::string_view piece) {
    text += piece;
    return true;
  };
  ByteWriter out(sink);
  out.text("{\"type\":\"plc\",\"vertices\":");
  write_list(out, plc.vertices, [&](const Point3& p) { write_point(out, p); });
  out.text(",\"facets\":");
  write_list(out, plc.facets, [&](const PlcFacet& f) { write_facet(out, f); });
  out.text(",\"segments\":");
  write_list(out, plc.segments, [&](const PlcSegment& s) { write_segment(out, s); });
  out.text(",\"holes\":");
  write_list(out, plc.holes, [&](const Point3& p) { write_point(out, p); });
  out.text(",\"regions\":");
  write_list(out, plc.regions, [&](const PlcRegion& r) { write_region(out, r); });
  out.text("}");
  (void)out.finish();
  return text;
}

}  // namespace symcell
