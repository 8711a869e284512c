#include <cmath>

#include "api/formats/byte_writer.hpp"
#include "api/formats/pslg_json.hpp"

namespace symcell {
namespace {

void write_point(ByteWriter& out, Point2 p) {
  out.text("[");
  out.real(p.x);
  out.text(",");
  out.real(p.y);
  out.text("]");
}

}  // namespace

std::string write_pslg_json(const Pslg& pslg) {
  std::string text;
  const Sink sink = [&](std::string_view piece) {
    text += piece;
    return true;
  };
  ByteWriter out(sink);
  out.text("{\"type\":\"pslg\",\"vertices\":[");
  const auto separate = [&](std::size_t i) { out.text(i == 0 ? "" : ","); };
  for (std::size_t i = 0; i < pslg.vertices.size(); ++i) {
    separate(i);
    write_point(out, pslg.vertices[i]);
  }
  out.text("],\"segments\":[");
  for (std::size_t i = 0; i < pslg.segments.size(); ++i) {
    const PslgSegment& s = pslg.segments[i];
    separate(i);
    const double bulge = pslg.bulge(i);
    out.text(bulge == 0 ? "[" : "{\"vertices\":[");
    out.integer(s.a);
    out.text(",");
    out.integer(s.b);
    if (bulge != 0) {
      out.text("],\"bulge\":");
      out.real(bulge);
    }
    if (s.marker != 0) {
      out.text(bulge == 0 ? "," : ",\"marker\":");
      out.integer(s.marker);
    }
    out.text(bulge == 0 ? "]" : "}");
  }
  out.text("],\"holes\":[");
  for (std::size_t i = 0; i < pslg.holes.size(); ++i) {
    separate(i);
    write_point(out, pslg.holes[i]);
  }
  out.text("],\"regions\":[");
  for (std::size_t i = 0; i < pslg.regions.size(); ++i) {
    const PslgRegion& r = pslg.regions[i];
    separate(i);
    out.text("{\"point\":");
    write_point(out, r.point);
    out.text(",\"attribute\":");
    out.integer(r.attribute);
    if (std::isfinite(r.max_area)) {
      out.text(",\"max_area\":");
      out.real(r.max_area);
    }
    out.text("}");
  }
  out.text("]}");
  (void)out.finish();
  return text;
}

}  // namespace symcell
