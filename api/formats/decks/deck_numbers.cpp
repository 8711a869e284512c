#include "api/formats/decks/deck_numbers.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace symcell::internal {
namespace {

constexpr int kMostDigits = 17;

// A turn of a point leaves rounding of this share of its size where 0 is meant.
constexpr double kRounding = 1e-14;

}  // namespace

std::string fitting_number(double value, std::size_t width) {
  if (value == 0) return "0";  // also -0
  std::array<char, 64> text{};
  auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  for (int digits = kMostDigits; static_cast<std::size_t>(end - text.data()) > width && digits > 0;
       --digits) {
    end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general,
                        digits)
              .ptr;
  }
  return {text.data(), end};
}

std::string nastran_number(double value, std::size_t width) {
  // One byte is left for the point where the number has none.
  std::string text = fitting_number(value, width - 1);
  const std::size_t e = text.find('e');
  if (text.find('.') == std::string::npos) text.insert(std::min(e, text.size()), ".");
  const std::size_t exponent = text.find('e');
  if (exponent != std::string::npos) text.erase(exponent, 1);
  return text;
}

Point3 without_rounding(const Point3& p, double size) {
  const auto clean = [size](double c) { return std::abs(c) < kRounding * size ? 0.0 : c; };
  return {clean(p.x), clean(p.y), clean(p.z)};
}

}  // namespace symcell::internal
