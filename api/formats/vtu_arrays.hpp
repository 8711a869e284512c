// The <DataArray> elements of a VTU file as checked lists of numbers.  Used by vtu_reader only.
#pragma once

#include <cstdint>
#include <pugixml.hpp>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace symcell::internal {

class VtuArrays {
 public:
  // `root`: the <VTKFile> element. `appended`: the bytes behind '_' of <AppendedData>, or nothing.
  // Errors: kUnknownFormat (byte order, header type or compressor that are not read).
  [[nodiscard]] static Result<VtuArrays> open(const pugi::xml_node& root,
                                              std::string_view appended);

  // Exactly `count` numbers.  Errors: kCountMismatch, kTruncated, kSyntax, kUnknownFormat.
  [[nodiscard]] Result<std::vector<double>> reals(const pugi::xml_node& array,
                                                  std::uint64_t count) const;
  // Integer types only; unsigned values beyond 63 bits are refused.
  [[nodiscard]] Result<std::vector<std::int64_t>> integers(const pugi::xml_node& array,
                                                           std::uint64_t count) const;

 private:
  template <class T>
  [[nodiscard]] Result<std::vector<T>> read(const pugi::xml_node& array, std::uint64_t count) const;
  template <class T>
  [[nodiscard]] Result<std::vector<T>> read_ascii(const pugi::xml_node& array,
                                                  std::uint64_t count) const;
  // The array's bytes, unpacked.
  [[nodiscard]] Result<std::string> payload(const pugi::xml_node& array, std::uint64_t bytes) const;
  [[nodiscard]] Result<std::string> unpack(std::string_view data, std::uint64_t bytes) const;
  // A word of the file's header type; `data` holds enough.
  [[nodiscard]] std::uint64_t word(std::string_view data, std::size_t index) const;

  std::string_view appended_;
  std::size_t word_size_ = 4;
  bool compressed_ = false;
};

}  // namespace symcell::internal
