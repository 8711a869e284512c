// What the laws of how elements hang together share, in the plane (planar_link_laws.cpp) and in
// space (link_laws.cpp).
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace symcell {

inline constexpr double kPinchTolerance = 1e-9;  // of the model's diameter: rounding of places
inline constexpr double kHanging = 1e-10;        // likewise: how near a node lies in a facet

// One line of text, numbers with 12 digits.
template <class... Parts>
[[nodiscard]] std::string law_text(const Parts&... parts) {
  std::ostringstream text;
  text.precision(12);
  (text << ... << parts);
  return text.str();
}

// Elements as they stand at nodes or edges, one entry a place, joined where they share a facet.
// First add() all, then finish(), then join().
template <class Place>
class Fans {
 public:
  void add(const Place& place, std::size_t element) { places_.emplace_back(place, element); }
  void finish() {
    std::sort(places_.begin(), places_.end());
    up_.resize(places_.size());
    std::iota(up_.begin(), up_.end(), std::size_t{0});
  }
  void join(const Place& place, std::size_t a, std::size_t b) {
    up_[root(find(place, a))] = root(find(place, b));
  }
  // Places with more than one fan, ascending.
  [[nodiscard]] std::vector<Place> parted() {
    std::vector<Place> result;
    for (std::size_t i = 1; i < places_.size(); ++i) {
      const bool same = places_[i].first == places_[i - 1].first;
      if (same && root(i) != root(i - 1)) result.push_back(places_[i].first);
    }
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

 private:
  [[nodiscard]] std::size_t find(const Place& place, std::size_t element) const {
    const std::pair<Place, std::size_t> wanted(place, element);
    return static_cast<std::size_t>(std::lower_bound(places_.begin(), places_.end(), wanted) -
                                    places_.begin());
  }
  [[nodiscard]] std::size_t root(std::size_t i) {
    while (up_[i] != i) i = up_[i] = up_[up_[i]];
    return i;
  }

  std::vector<std::pair<Place, std::size_t>> places_;
  std::vector<std::size_t> up_;
};

}  // namespace symcell
