#include "core/cell/regions_alternate.hpp"

#include <algorithm>
#include <map>

namespace symcell {

bool regions_alternate(const SymmetryCellMesh& cell) {
  if (cell.sector_regions.empty() || cell.fold % 2 != 0) return false;
  const auto n = static_cast<std::size_t>(cell.fold);
  std::map<std::int32_t, std::int32_t> next;  // attribute: in the next sector
  for (std::size_t e = 0; e < cell.element_count(); ++e) {
    const std::int32_t* of_sector = &cell.sector_regions[e * n];
    for (std::size_t s = 0; s < n; ++s) {
      const auto [known, fresh] = next.try_emplace(of_sector[s], of_sector[(s + 1) % n]);
      if (!fresh && known->second != of_sector[(s + 1) % n]) return false;
    }
  }
  return std::ranges::any_of(next, [](const auto& m) { return m.first != m.second; }) &&
         std::ranges::all_of(next, [&](const auto& m) {
           const auto back = next.find(m.second);
           return back != next.end() && back->second == m.first;
         });
}

}  // namespace symcell
