#include "api/formats/turn_map.hpp"

namespace symcell {

TurnMap turn_map(const FullMeshView& view, std::int32_t exponent) {
  const SymmetryCellMesh& cell = view.cell();
  const Point2 turned = view.rotations().rotate(Point2{1, 0}, cell.fold > 1 ? exponent : 0);
  const double c = turned.x;
  const double s = turned.y;
  // Rodrigues: R = c I + (1 - c) u u^T + s [u]x, and the translation o - R o.
  const Point3& u = cell.axis_direction;
  const Point3& o = cell.axis_origin;
  const double t = 1 - c;
  TurnMap map;
  map.rotation = {{{c + t * u.x * u.x, t * u.x * u.y - s * u.z, t * u.x * u.z + s * u.y},
                   {t * u.x * u.y + s * u.z, c + t * u.y * u.y, t * u.y * u.z - s * u.x},
                   {t * u.x * u.z - s * u.y, t * u.y * u.z + s * u.x, c + t * u.z * u.z}}};
  const std::array<double, 3> origin{o.x, o.y, o.z};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& r = map.rotation[i];
    map.offset[i] = origin[i] - (r[0] * o.x + r[1] * o.y + r[2] * o.z);
  }
  return map;
}

}  // namespace symcell
