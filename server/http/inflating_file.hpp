// A model being received: written to a file, unpacked if it is gzip'd itself, bounded either way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "server/base/files.hpp"
#include "server/http/gzip.hpp"

namespace symcell::server {

class InflatingFile {
 public:
  InflatingFile(const std::filesystem::path& destination, std::size_t max_bytes);

  enum class Fault : std::uint8_t { kNone, kTooLarge, kTooDense, kDamaged };

  // Bytes that came for what is added from now on, where a coding was taken off before; else those
  // added count.
  void came(std::size_t bytes) {
    counted_outside_ = true;
    came_ += bytes;
  }
  // False: stop, fault() says why.
  [[nodiscard]] bool add(std::string_view piece);
  // After the last piece: true if the file is complete and kept, false with a fault.
  [[nodiscard]] bool finish();
  [[nodiscard]] Fault fault() const { return fault_; }

 private:
  [[nodiscard]] bool store(std::string_view piece);
  [[nodiscard]] bool pass_on(std::string_view piece);

  FileWriter file_;
  std::size_t max_bytes_;
  Fault fault_ = Fault::kNone;
  std::uint64_t came_ = 0;
  bool counted_outside_ = false;
  std::string head_;  // until there are enough bytes to recognise gzip
  bool decided_ = false;
  std::unique_ptr<GzipInflater> inflater_;
};

}  // namespace symcell::server
