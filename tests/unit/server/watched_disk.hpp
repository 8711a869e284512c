// The disk as this process meets it in fsync, fdatasync and syncfs, which stand in the place of libc's for the
// whole test program: what they are asked for is noted, and they may be told to refuse. After a refusal they say
// yes again, as the kernel does, which then takes what it could not write for written.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace symcell::server::test {

// One at a time; everything is granted when it has gone.
class WatchedDisk {
 public:
  enum class Call : std::uint8_t { kFile, kData, kFileSystem };  // fsync, fdatasync, syncfs
  struct Sync {
    Call call = Call::kFile;
    std::string path;
    std::int64_t bytes = 0;  // of the file at that moment
  };

  WatchedDisk();
  ~WatchedDisk();
  WatchedDisk(const WatchedDisk&) = delete;
  WatchedDisk& operator=(const WatchedDisk&) = delete;

  // The next `times` calls of this kind for files whose paths end so fail.
  static void refuse(Call call, std::string_view ending, int times);
  // Granted since the beginning, or since forget().
  [[nodiscard]] static std::vector<Sync> granted(Call call, std::string_view ending);
  static void forget();
};

}  // namespace symcell::server::test
