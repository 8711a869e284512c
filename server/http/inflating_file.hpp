// A model being received: written to a file, unpacked if it is gzip'd itself, bounded either way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/base/files.hpp"
#include "server/http/gzip.hpp"
#include "server/http/json_guard.hpp"

namespace symcell::server {

class InflatingFile {
 public:
  // `held_bytes`: what is no longer than this is held in memory, and no file is made.
  InflatingFile(std::filesystem::path destination,
                std::size_t max_bytes,
                std::size_t held_bytes = 0);

  enum class Fault : std::uint8_t { kNone, kTooLarge, kTooDense, kDamaged, kRefused };

  // Is shown what is stored, before; where it refuses, that is the fault. Must outlive the file.
  void guard_by(JsonGuard& guard) { guard_ = &guard; }

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
  // After finish().
  [[nodiscard]] bool is_held() const { return !file_; }
  [[nodiscard]] std::string& held() { return held_; }

 private:
  [[nodiscard]] bool store(std::string_view piece);
  [[nodiscard]] bool pass_on(std::string_view piece);

  std::filesystem::path destination_;
  std::optional<FileWriter> file_;  // once there is too much to hold
  std::string held_;
  std::size_t max_bytes_;
  std::size_t held_bytes_;
  std::uint64_t size_ = 0;
  JsonGuard* guard_ = nullptr;
  Fault fault_ = Fault::kNone;
  std::uint64_t came_ = 0;
  bool counted_outside_ = false;
  std::string head_;  // until there are enough bytes to recognise gzip
  bool decided_ = false;
  std::unique_ptr<GzipInflater> inflater_;
};

}  // namespace symcell::server
