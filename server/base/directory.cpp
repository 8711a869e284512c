#include "server/base/directory.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <system_error>
#include <utility>

namespace symcell::server {
namespace {

[[noreturn]] void throw_errno(const std::string& what, const std::filesystem::path& path) {
  throw std::system_error(errno, std::generic_category(), what + " " + path.string());
}

Directory::Kind kind_of(mode_t mode) {
  if (S_ISREG(mode)) return Directory::Kind::kFile;
  if (S_ISDIR(mode)) return Directory::Kind::kFolder;
  if (S_ISLNK(mode)) return Directory::Kind::kLink;
  return Directory::Kind::kOther;
}

}  // namespace

Directory::Directory(const std::filesystem::path& path)
    : descriptor_(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)), path_(path) {
  if (descriptor_ < 0) throw_errno("cannot open the folder", path);
}

Directory::Directory(int descriptor, std::filesystem::path path)
    : descriptor_(descriptor), path_(std::move(path)) {
}

Directory::Directory(Directory&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)) {
}

Directory::~Directory() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::vector<Directory::Entry> Directory::entries() const {
  // A descriptor of its own: the position in the folder belongs to it.
  const int copy = ::openat(descriptor_, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (copy < 0) throw_errno("cannot read the folder", path_);
  const std::unique_ptr<DIR, int (*)(DIR*)> stream(::fdopendir(copy), ::closedir);
  if (!stream) {
    ::close(copy);
    throw_errno("cannot read the folder", path_);
  }
  std::vector<Entry> entries;
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nobody else reads this stream.
  while (const dirent* found = ::readdir(stream.get())) {
    const std::string name = found->d_name;
    if (name == "." || name == "..") continue;
    struct stat status {};
    if (::fstatat(descriptor_, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) continue;
    entries.push_back({name, kind_of(status.st_mode), static_cast<std::uint64_t>(status.st_size)});
  }
  std::ranges::sort(entries, {}, &Entry::name);
  return entries;
}

bool Directory::has(const std::string& name) const {
  struct stat status {};
  return ::fstatat(descriptor_, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0;
}

Directory Directory::folder(const std::string& name) const {
  if (::mkdirat(descriptor_, name.c_str(), S_IRWXU) != 0 && errno != EEXIST) {
    throw_errno("cannot create", path_ / name);
  }
  const int found =
      ::openat(descriptor_, name.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (found < 0) throw_errno("this should be a folder, and no symbolic link:", path_ / name);
  return {found, path_ / name};
}

int Directory::open_file(const std::string& name) const {
  const int file = ::openat(descriptor_, name.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0 && errno != ENOENT) {
    throw_errno("this should be a file, and no symbolic link:", path_ / name);
  }
  return file;
}

int Directory::open_or_create_file(const std::string& name, bool& created) const {
  constexpr int kFlags = O_RDWR | O_NOFOLLOW | O_CLOEXEC;
  constexpr mode_t kOwner = S_IRUSR | S_IWUSR;
  int file = ::openat(descriptor_, name.c_str(), kFlags | O_CREAT | O_EXCL, kOwner);
  created = file >= 0;
  if (file < 0 && errno == EEXIST) file = ::openat(descriptor_, name.c_str(), kFlags);
  if (file < 0) throw_errno("cannot open", path_ / name);
  return file;
}

void Directory::write_file(const std::string& name, std::string_view text) const {
  const std::string part = name + ".part";
  remove_file(part);
  bool created = false;
  const int file = open_or_create_file(part, created);
  const bool written =
      ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      ::fsync(file) == 0;
  const int why = errno;
  const bool closed = ::close(file) == 0;
  if (!written) errno = why;  // what close() says of it is no matter
  if (!written || !closed) throw_errno("cannot write", path_ / part);
  move(part, *this, name);
  sync();
}

void Directory::remove_file(const std::string& name) const {
  if (::unlinkat(descriptor_, name.c_str(), 0) != 0 && errno != ENOENT) {
    throw_errno("cannot remove", path_ / name);
  }
}

void Directory::move(const std::string& name,
                     const Directory& to,
                     const std::string& new_name) const {
  if (::renameat(descriptor_, name.c_str(), to.descriptor_, new_name.c_str()) != 0) {
    throw_errno("cannot move", path_ / name);
  }
}

void Directory::sync() const {
  if (::fsync(descriptor_) != 0) throw_errno("cannot synchronise", path_);
}

}  // namespace symcell::server
