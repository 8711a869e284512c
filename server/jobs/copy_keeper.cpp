#include "server/jobs/copy_keeper.hpp"

#include <chrono>
#include <exception>

namespace symcell::server {
namespace {

// What the database grows by at most for copies, more or less.
constexpr std::uint64_t kManyBytes = std::uint64_t{32} << 20U;
// How long copies are kept at most, more or less.
constexpr std::chrono::seconds kInterval{10};

}  // namespace

void restore_copies(JobStore& store, const JobFiles& files, Logger& logger) {
  std::int64_t last = 0;
  std::int64_t restored = 0;
  for (auto copy = store.copy_after(0); copy; copy = store.copy_after(last)) {
    last = copy->number;
    const auto job = store.find(copy->job_id);
    const bool wanted = job && (copy->name != "model" || job->model_kept);
    if (wanted && files.restore(*copy)) ++restored;
  }
  if (last == 0) return;
  files.synchronise();
  store.forget_copies(last);
  if (restored > 0) logger.warning("files_restored", {{"count", restored}});
}

CopyKeeper::CopyKeeper(JobStore& store, const JobFiles& files, Logger& logger)
    : store_(store),
      files_(files),
      logger_(logger),
      thread_([this](const std::stop_token& stop) { work(stop); }) {
}

void CopyKeeper::poke() {
  if (store_.copied_bytes() >= kManyBytes) wake_.notify_one();
}

void CopyKeeper::work(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, kInterval, [this] { return store_.copied_bytes() >= kManyBytes; });
    }
    if (stop.stop_requested() || store_.copied_bytes() == 0) continue;
    try {
      const std::int64_t newest = store_.newest_copy();
      files_.synchronise();
      store_.forget_copies(newest);
    } catch (const std::exception& exception) {
      logger_.error("copies_not_forgotten", {{"what", exception.what()}});
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, kInterval, [] { return false; });
    }
  }
}

}  // namespace symcell::server
