#include "tests/unit/server/watched_disk.hpp"

#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <mutex>

namespace symcell::server::test {
namespace {

struct Refusal {
  WatchedDisk::Call call = WatchedDisk::Call::kFile;
  std::string ending;
  int times = 0;
};

std::mutex mutex;  // guards the next two
std::vector<WatchedDisk::Sync> syncs;
Refusal refusal;

int met(WatchedDisk::Call call, int descriptor, long number) {
  std::error_code ignored;
  const std::string path =
      std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), ignored);
  struct stat status {};
  ::fstat(descriptor, &status);
  {
    const std::lock_guard lock(mutex);
    if (refusal.times > 0 && refusal.call == call && path.ends_with(refusal.ending)) {
      --refusal.times;
      errno = EIO;
      return -1;
    }
    syncs.push_back({call, path, status.st_size});
  }
  return static_cast<int>(::syscall(number, descriptor));
}

}  // namespace

WatchedDisk::WatchedDisk() {
  forget();
}

WatchedDisk::~WatchedDisk() {
  refuse(Call::kFile, "", 0);
}

void WatchedDisk::refuse(Call call, std::string_view ending, int times) {
  const std::lock_guard lock(mutex);
  refusal = {call, std::string(ending), times};
}

std::vector<WatchedDisk::Sync> WatchedDisk::granted(Call call, std::string_view ending) {
  const std::lock_guard lock(mutex);
  std::vector<Sync> found;
  for (const Sync& sync : syncs) {
    if (sync.call == call && sync.path.ends_with(ending)) found.push_back(sync);
  }
  return found;
}

void WatchedDisk::forget() {
  const std::lock_guard lock(mutex);
  syncs.clear();
}

}  // namespace symcell::server::test

// The linker takes these before those of libc, for SQLite's library, too.
extern "C" {
int fsync(int descriptor) {
  using symcell::server::test::WatchedDisk;
  return symcell::server::test::met(WatchedDisk::Call::kFile, descriptor, SYS_fsync);
}
int fdatasync(int descriptor) {
  using symcell::server::test::WatchedDisk;
  return symcell::server::test::met(WatchedDisk::Call::kData, descriptor, SYS_fdatasync);
}
int syncfs(int descriptor) noexcept {
  using symcell::server::test::WatchedDisk;
  return symcell::server::test::met(WatchedDisk::Call::kFileSystem, descriptor, SYS_syncfs);
}
}
