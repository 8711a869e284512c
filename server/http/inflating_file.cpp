#include "server/http/inflating_file.hpp"

namespace symcell::server {
namespace {
constexpr std::string_view kGzipMagic = "\x1f\x8b";
}  // namespace

InflatingFile::InflatingFile(const std::filesystem::path& destination, std::size_t max_bytes)
    : file_(destination), max_bytes_(max_bytes) {
}

bool InflatingFile::store(std::string_view piece) {
  if (file_.size() + piece.size() > max_bytes_) {
    fault_ = Fault::kTooLarge;
    return false;
  }
  file_.write(piece);
  return true;
}

bool InflatingFile::pass_on(std::string_view piece) {
  if (!inflater_) return store(piece);
  if (inflater_->write(piece)) return true;
  if (fault_ == Fault::kNone) fault_ = Fault::kDamaged;
  return false;
}

bool InflatingFile::add(std::string_view piece) {
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
  file_.keep();
  return true;
}

}  // namespace symcell::server
