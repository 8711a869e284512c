#include "server/jobs/sqlite_log.hpp"

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

#include "server/jobs/sqlite_schema.hpp"

namespace symcell::server {
namespace {

// Of the log, in pages of 4 KiB. From the first on it is read into the database, SQLite's own measure; from
// the second on by whoever commits, who waits for it.
constexpr int kLongLog = 1000;
constexpr int kVeryLongLog = 16384;
// Between two times that it is read.
constexpr std::chrono::milliseconds kPause{100};

StoreError::Kind kind_of(int error) {
  return error == ENOSPC || error == EDQUOT ? StoreError::Kind::kFull : StoreError::Kind::kOther;
}

[[noreturn]] void throw_refused(int error) {
  throw StoreError(kind_of(error), "the job database cannot be synchronised: " +
                                       std::generic_category().message(error));
}

}  // namespace

SqliteLog::SqliteLog(std::filesystem::path database, SQLite::Database& writer)
    : database_(std::move(database)),
      log_(database_.string() + "-wal"),
      writer_(writer),
      reader_([this](const std::stop_token& stop) { read_into_database(stop); }) {
  sqlite3_wal_hook(writer_.getHandle(), on_commit, this);
  // What was written before.
  sync_.committed();
}

SqliteLog::~SqliteLog() {
  sqlite3_wal_hook(writer_.getHandle(), nullptr, nullptr);
  reader_.request_stop();
  reader_.join();
  if (descriptor_ >= 0) ::close(descriptor_);
}

int SqliteLog::on_commit(void* self, sqlite3* writer, const char* /*schema*/, int pages) {
  auto& log = *static_cast<SqliteLog*>(self);
  log.sync_.committed();
  if (pages >= kVeryLongLog) {
    sqlite3_wal_checkpoint_v2(writer, nullptr, SQLITE_CHECKPOINT_PASSIVE, nullptr, nullptr);
  } else if (pages >= kLongLog) {
    {
      const std::lock_guard lock(log.mutex_);
      log.is_long_ = true;
    }
    log.wake_.notify_one();
  }
  return SQLITE_OK;
}

// SQLite keeps the file while a connection is open; should it be another one, that is the one to synchronise.
void SqliteLog::open_log() {
  struct stat status {};
  if (descriptor_ >= 0 && ::fstat(descriptor_, &status) == 0 && status.st_nlink > 0) return;
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = ::open(log_.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor_ < 0) throw_refused(errno);
}

void SqliteLog::synchronise() {
  if (lost_trust_) begin_anew();
  open_log();
  if (::fdatasync(descriptor_) == 0) {
    lost_trust_ = false;
    return;
  }
  const int error = errno;
  lost_trust_ = true;
  throw_refused(error);
}

// The kernel takes pages that it could not write for written, and says yes when asked again: what it has of the
// log on the disk may have holes for ever. The kernel shows the pages still. They go to the database, which is
// synchronised, and the log is emptied; that it is empty lasts when it is synchronised by a descriptor that has
// heard of no refusal.
void SqliteLog::begin_anew() {
  translate_sqlite_errors([&] {
    SQLite::Database database(database_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_NOFOLLOW);
    database.setBusyTimeout(kSqliteBusyPatienceMs);
    database.exec("PRAGMA synchronous = FULL");
    const int done = sqlite3_wal_checkpoint_v2(database.getHandle(), nullptr,
                                               SQLITE_CHECKPOINT_TRUNCATE, nullptr, nullptr);
    if (done != SQLITE_OK) throw SQLite::Exception(database.getHandle(), done);
  });
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

void SqliteLog::read_into_database(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (wake_.wait(lock, stop, [this] { return std::exchange(is_long_, false); })) {
    lock.unlock();
    try {
      SQLite::Database database(database_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_NOFOLLOW);
      // Holds nobody up. The second time there is little left, so that whoever writes next begins the log
      // anew.
      for (int round = 0; round < 2; ++round) {
        sqlite3_wal_checkpoint_v2(database.getHandle(), nullptr, SQLITE_CHECKPOINT_PASSIVE, nullptr,
                                  nullptr);
      }
    } catch (const SQLite::Exception&) {
      // The next time, or whoever commits when the log is very long.
    }
    lock.lock();
    wake_.wait_for(lock, stop, kPause, [] { return false; });
  }
}

}  // namespace symcell::server
