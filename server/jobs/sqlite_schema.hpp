// The tables of the embedded database, their versions, and what a file that should be one turns out
// to be.
//
// The schema carries a version (PRAGMA user_version); older ones are migrated step by step.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "server/jobs/job_store.hpp"

namespace symcell::server {

// How long a statement waits for another process that holds the database, a backup for instance.
// Whoever must not fail for it asks again.
inline constexpr int kSqliteBusyPatienceMs = 2000;

enum class DatabaseState : std::uint8_t {
  kMissing,
  kEmpty,    // nothing in it, as a database that was truncated or never written
  kOurs,     // of any version
  kForeign,  // sound, and with tables, but without jobs
  kDamaged,
};

struct DatabaseFinding {
  DatabaseState state = DatabaseState::kMissing;
  std::string directory_id;  // of kOurs; empty: written by a version that gave none
  std::string fault;         // of kDamaged
};

// Reads all of the file and changes nothing.  Throws std::runtime_error if it cannot be read (no
// rights, a symbolic link, an error of the disk), which says nothing about its contents.
[[nodiscard]] DatabaseFinding examine_job_database(const std::filesystem::path& file);

// Creates the file, for its owner alone, if it is missing: SQLite would create it readable for all.
// Throws std::runtime_error.
const std::filesystem::path& create_job_database(const std::filesystem::path& file);
// Throws std::runtime_error if the schema is newer than this program.
void migrate_job_database(SQLite::Database& database);
[[nodiscard]] bool has_newest_schema(SQLite::Database& database);

[[nodiscard]] StoreError::Kind store_error_kind(const SQLite::Exception& exception);

// What `work` returns; exceptions of SQLite become StoreError.
template <class Work>
auto translate_sqlite_errors(const Work& work) {
  try {
    return work();
  } catch (const SQLite::Exception& exception) {
    throw StoreError(store_error_kind(exception), exception.what());
  }
}

}  // namespace symcell::server
