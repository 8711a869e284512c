#include "server/http/inflating_file.hpp"

#include <algorithm>
#include <utility>

namespace symcell::server {
namespace {
constexpr std::string_view kGzipMagic = "\x1f\x8b";
// What may be kept of a byte that was sent. Models of meshers shrink to a fifth, those of computers
// to a tenth; small ones may be as regular as they like.
constexpr std::uint64_t kMostDensity = 20;
constexpr std::uint64_t kDenseBytes = std::uint64_t{8} << 20U;
}  // namespace

InflatingFile::InflatingFile(std::filesystem::path destination,
                             std::size_t max_bytes,
                             std::size_t held_bytes)
    : destination_(std::move(destination)), max_bytes_(max_bytes), held_bytes_(held_bytes) {
  if (held_bytes_ == 0) file_.emplace(destination_);
}

bool InflatingFile::store(std::string_view piece) {
  if (size_ + piece.size() > max_bytes_) {
    fault_ = Fault::kTooLarge;
    return false;
  }
  // Half a megabyte of gzip would else keep half a gigabyte of disk for days.
  if (size_ + piece.size() > std::max<std::uint64_t>(kDenseBytes, kMostDensity * came_)) {
    fault_ = Fault::kTooDense;
    return false;
  }
  if (guard_ != nullptr && !guard_->pass(piece)) {
    fault_ = Fault::kRefused;
    return false;
  }
  size_ += piece.size();
  if (!file_ && size_ <= held_bytes_) {
    held_.append(piece);
    return true;
  }
  if (!file_) {
    file_.emplace(destination_);
    file_->write(held_);
    held_ = {};
  }
  file_->write(piece);
  return true;
}

bool InflatingFile::pass_on(std::string_view piece) {
  if (!inflater_) return store(piece);
  if (inflater_->write(piece)) return true;
  if (fault_ == Fault::kNone) fault_ = Fault::kDamaged;
  return false;
}

bool InflatingFile::add(std::string_view piece) {
  if (!counted_outside_) came_ += piece.size();
  if (decided_) return pass_on(piece);
  head_.append(piece);
  if (head_.size() < kGzipMagic.size()) return true;
  decided_ = true;
  if (head_.starts_with(kGzipMagic)) {
    inflater_ = std::make_unique<GzipInflater>([this](std::string_view out) { return store(out); });
  }
  return pass_on(head_);
}

bool InflatingFile::finish() {
  if (!decided_ && !store(head_)) return false;
  if (inflater_ && !inflater_->complete()) {
    fault_ = Fault::kDamaged;
    return false;
  }
  if (file_) file_->keep();
  return true;
}

}  // namespace symcell::server
