#include "tests/support/plc_files.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

namespace symcell::test {

Plc read_plc_json(const std::filesystem::path& path) {
  using Json = nlohmann::json;
  std::ifstream file(path);
  const Json json = Json::parse(file);
  const auto point = [](const Json& p) {
    return Point3{p.at(0).get<double>(), p.at(1).get<double>(), p.at(2).get<double>()};
  };
  const auto points = [&](const Json& object) {
    std::vector<Point3> result;
    for (const Json& p : object.value("holes", Json::array())) result.push_back(point(p));
    return result;
  };
  Plc plc;
  for (const Json& v : json.at("vertices")) plc.vertices.push_back(point(v));
  for (const Json& f : json.at("facets")) {
    PlcFacet facet;
    facet.polygons = f.at("polygons").get<std::vector<std::vector<std::int32_t>>>();
    facet.holes = points(f);
    facet.marker = f.value("marker", 0);
    plc.facets.push_back(std::move(facet));
  }
  plc.holes = points(json);
  for (const Json& r : json.value("regions", Json::array())) {
    PlcRegion region{point(r.at("point")), r.value("attribute", 0)};
    if (r.contains("max_volume") && r["max_volume"].is_number())
      region.max_volume = r["max_volume"];
    plc.regions.push_back(region);
  }
  return plc;
}

}  // namespace symcell::test
