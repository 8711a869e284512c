// The write-ahead log of an SQLite database whose commits do not wait for the disk: puts on the disk what was
// committed, for all who wait together, and reads the log into the database, beside those who write.
//
// A commit is in the log (file "-wal") when it returns. The log on the disk is the commits in their order, so
// what is there after a failure of the machine is all of them up to some moment, and never less than what
// reach() has promised.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <thread>

#include "server/jobs/group_sync.hpp"

namespace symcell::server {

class SqliteLog {
 public:
  // `writer`: the connection that writes, in WAL mode and after its first commit; must outlive the log.
  SqliteLog(std::filesystem::path database, SQLite::Database& writer);
  ~SqliteLog();
  SqliteLog(const SqliteLog&) = delete;
  SqliteLog& operator=(const SqliteLog&) = delete;

  // Returns once what was committed before is on the disk. Throws StoreError.
  void reach() { sync_.reach(); }

 private:
  static int on_commit(void* self, sqlite3* writer, const char* schema, int pages);
  void open_log();
  void synchronise();
  void begin_anew();
  void read_into_database(const std::stop_token& stop);

  const std::filesystem::path database_;
  const std::filesystem::path log_;
  SQLite::Database& writer_;
  int descriptor_ = -1;      // of the log; of whoever synchronises
  bool lost_trust_ = false;  // likewise: the disk refused, and the log on it may have holes
  GroupSync sync_{[this] { synchronise(); }};

  std::mutex mutex_;  // guards is_long_
  std::condition_variable_any wake_;
  bool is_long_ = false;
  std::jthread reader_;  // last: it uses all of the above
};

}  // namespace symcell::server
