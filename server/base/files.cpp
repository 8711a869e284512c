#include "server/base/files.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace symcell::server {
namespace {

constexpr std::size_t kPieceBytes = 64UL * 1024;
// Up to here to read a file takes less than to map it: to take a map away halts all processors.
constexpr std::size_t kReadBytes = 64UL * 1024;

[[noreturn]] void throw_errno(const std::string& what, const std::filesystem::path& path) {
  throw std::system_error(errno, std::generic_category(), what + " " + path.string());
}

int flag_of(Links links) {
  return links == Links::kRefuse ? O_NOFOLLOW : 0;
}

// A descriptor that is closed on every way out.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags)
      : value_(::open(path.c_str(), flags | O_CLOEXEC)) {
    if (value_ < 0) throw_errno("cannot open", path);
  }
  ~Descriptor() { ::close(value_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return value_; }

 private:
  int value_;
};

}  // namespace

FileWriter::FileWriter(std::filesystem::path path)
    : path_(std::move(path)),
      descriptor_(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)) {
  if (descriptor_ < 0) throw_errno("cannot create", path_);
}

FileWriter::~FileWriter() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(path_.c_str());
}

void FileWriter::write(std::string_view bytes) {
  size_ += bytes.size();
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0) {
      if (errno == EINTR) continue;
      throw_errno("cannot write", path_);
    }
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void FileWriter::truncate() {
  if (::ftruncate(descriptor_, 0) != 0 || ::lseek(descriptor_, 0, SEEK_SET) != 0) {
    throw_errno("cannot truncate", path_);
  }
  size_ = 0;
}

void FileWriter::commit_as(const std::filesystem::path& destination) {
  if (::fsync(descriptor_) != 0) throw_errno("cannot synchronise", path_);
  std::filesystem::rename(path_, destination);
  close();
  sync_directory(destination.parent_path());
}

void FileWriter::keep() {
  close();
}

void FileWriter::close() {
  ::close(descriptor_);
  descriptor_ = -1;
}

FileReader::FileReader(const std::filesystem::path& path, Links links)
    : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | flag_of(links))),
      buffer_(kPieceBytes, '\0') {
  if (descriptor_ < 0) throw_errno("cannot open", path);
}

FileReader::~FileReader() {
  ::close(descriptor_);
}

std::string_view FileReader::next() {
  while (true) {
    const ssize_t got = ::read(descriptor_, buffer_.data(), buffer_.size());
    if (got >= 0) return std::string_view(buffer_).substr(0, static_cast<std::size_t>(got));
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "cannot read");
  }
}

MappedFile::MappedFile(const std::filesystem::path& path, Links links) {
  const Descriptor file(path, O_RDONLY | flag_of(links));
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) throw_errno("cannot look at", path);
  size_ = static_cast<std::size_t>(status.st_size);
  if (size_ == 0) return;
  if (size_ <= kReadBytes) {
    address_ = ::operator new(size_);
    std::size_t got = 0;
    while (got < size_) {
      const ssize_t n = ::read(file.get(), static_cast<char*>(address_) + got, size_ - got);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) break;
      got += static_cast<std::size_t>(n);
    }
    if (got == size_) return;
    ::operator delete(std::exchange(address_, nullptr));
    throw_errno("cannot read", path);
  }
  address_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.get(), 0);
  if (address_ == MAP_FAILED) {
    address_ = nullptr;
    throw_errno("cannot map", path);
  }
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : address_(std::exchange(other.address_, nullptr)), size_(std::exchange(other.size_, 0)) {
}

MappedFile::~MappedFile() {
  if (size_ <= kReadBytes) {
    ::operator delete(address_);
  } else if (address_ != nullptr) {
    ::munmap(address_, size_);
  }
}

void rename_durably(const std::filesystem::path& from, const std::filesystem::path& to) {
  sync_file(from);
  std::filesystem::rename(from, to);
  sync_directory(to.parent_path());
}

void sync_file(const std::filesystem::path& file) {
  const Descriptor opened(file, O_RDONLY | O_NOFOLLOW);
  if (::fsync(opened.get()) != 0) throw_errno("cannot synchronise", file);
}

void sync_directory(const std::filesystem::path& directory) {
  const Descriptor folder(directory, O_RDONLY | O_DIRECTORY);
  if (::fsync(folder.get()) != 0) throw_errno("cannot synchronise", directory);
}

}  // namespace symcell::server
