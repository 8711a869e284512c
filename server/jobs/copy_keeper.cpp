#include "server/jobs/copy_keeper.hpp"

#include <exception>
#include <filesystem>

#include "server/jobs/staged_model.hpp"

namespace symcell::server {
namespace {

// What the database grows by at most for copies, more or less.
constexpr std::uint64_t kManyBytes = std::uint64_t{32} << 20U;

// While the service runs a job's folder may lack its name still, and must not get a second one.
void settle_if_staged(const JobFiles& files, const std::string& id) {
  try {
    settle_model(files, id);
  } catch (const std::filesystem::filesystem_error&) {
    // The folder is lost, and comes back with its files.
  }
}

}  // namespace

void restore_copies(JobStore& store, const JobFiles& files, Logger& logger) {
  std::int64_t last = 0;
  std::int64_t restored = 0;
  for (auto copy = store.copy_after(0); copy; copy = store.copy_after(last)) {
    last = copy->number;
    const auto job = store.find(copy->job_id);
    if (!job || (copy->name == "model" && !job->model_kept)) continue;
    settle_if_staged(files, copy->job_id);
    if (files.restore(*copy)) ++restored;
  }
  if (last == 0) return;
  files.synchronise();
  store.forget_copies(last);
  if (restored > 0) logger.warning("files_restored", {{"count", restored}});
}

CopyKeeper::CopyKeeper(JobStore& store,
                       const JobFiles& files,
                       Logger& logger,
                       std::chrono::milliseconds interval)
    : store_(store),
      files_(files),
      logger_(logger),
      interval_(interval),
      thread_([this](const std::stop_token& stop) { work(stop); }) {
}

void CopyKeeper::poke() {
  if (store_.copied_bytes() >= kManyBytes) wake_.notify_one();
}

void CopyKeeper::work(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, interval_, [this] { return store_.copied_bytes() >= kManyBytes; });
    }
    if (stop.stop_requested() || store_.copied_bytes() == 0) continue;
    try {
      forget();
    } catch (const std::exception& exception) {
      logger_.error("copies_not_forgotten", {{"what", exception.what()}});
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, interval_, [] { return false; });
    }
  }
}

void CopyKeeper::forget() {
  if (lost_trust_) {
    restore_copies(store_, files_, logger_);
    lost_trust_ = false;
    return;
  }
  const std::int64_t newest = store_.newest_copy();
  lost_trust_ = true;
  files_.synchronise();
  lost_trust_ = false;
  store_.forget_copies(newest);
}

}  // namespace symcell::server
