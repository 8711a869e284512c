// Whose a data directory is, and that nothing in it is lost with its database.
#include "server/jobs/data_directory.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "server/jobs/sqlite_job_store.hpp"
#include "server/jobs/sqlite_schema.hpp"
#include "tests/support/test_files.hpp"
#include "tests/unit/server/service_under_test.hpp"

namespace symcell::server::test {
namespace {

namespace fs = std::filesystem;
using symcell::test::read_file;
using symcell::test::TemporaryFolder;
using symcell::test::write_file;

// Every path below a folder, relative to it.
std::vector<std::string> tree_of(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    names.push_back(fs::relative(entry.path(), folder).string());
  }
  std::ranges::sort(names);
  return names;
}

// The file in the quarantine whose path ends so; empty if there is none.
fs::path in_quarantine(const fs::path& root, const std::string& end) {
  if (!fs::exists(root / "quarantine")) return {};
  for (const auto& entry : fs::recursive_directory_iterator(root / "quarantine")) {
    if (entry.path().string().ends_with(end)) return entry.path();
  }
  return {};
}

TEST(DataDirectory, AFolderOfSomebodyElseIsRefusedUntouched) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "jobs/2024/report");
  fs::create_directories(folder / "incoming");
  write_file(folder / "jobs/2024/report/letter.txt", "dear");
  write_file(folder / "incoming/photo.jpg", "cheese");
  fs::permissions(folder / "jobs", fs::perms(0755));
  const auto before = tree_of(folder.path());
  Logger logger(LogLevel::kOff, LogFormat::kText);
  EXPECT_THROW(DataDirectory(folder.path(), logger), std::runtime_error);
  EXPECT_EQ(tree_of(folder.path()), before);
  EXPECT_EQ(fs::status(folder / "jobs").permissions(), fs::perms(0755));
}

TEST(DataDirectory, ADatabaseOfSomebodyElseIsRefusedUntouched) {
  const TemporaryFolder folder;
  {
    SQLite::Database other((folder / "jobs.sqlite").string(),
                           SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    other.exec("CREATE TABLE vacancies (title TEXT)");
  }
  Logger logger(LogLevel::kOff, LogFormat::kText);
  EXPECT_THROW(DataDirectory(folder.path(), logger), std::runtime_error);
  EXPECT_EQ(tree_of(folder.path()), std::vector<std::string>{"jobs.sqlite"});
}

TEST(DataDirectory, AnEmptyFolderGetsAMarkerThatTheDatabaseRepeats) {
  ServiceUnderTest service;
  const std::string marker = read_file(service.folder / "symcell-data");
  ASSERT_TRUE(service.close());
  const auto finding = examine_job_database(service.folder / "jobs.sqlite");
  EXPECT_EQ(finding.state, DatabaseState::kOurs);
  EXPECT_FALSE(finding.directory_id.empty());
  EXPECT_EQ(marker, "symcell-data 1 " + finding.directory_id + "\n");
}

TEST(DataDirectory, WhatSymcellMeshKeptOfFaultsDoesNotMakeItForeign) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "faults/abc");
  Logger logger(LogLevel::kOff, LogFormat::kText);
  const DataDirectory directory(folder.path(), logger);
  EXPECT_TRUE(fs::exists(folder / "symcell-data"));
}

class DataDirectoryTest : public ::testing::Test {
 protected:
  void SetUp() override {
    id_ = service_.submit().job.id;
    ASSERT_TRUE(service_.reaches(id_, JobState::kSucceeded));
    cell_ = read_file(service_.jobs->files().cell(id_));
    service_.forget_copies();
    ASSERT_TRUE(service_.close());
  }
  [[nodiscard]] fs::path root() const { return service_.folder.path(); }
  // After a start: the database does not know the job, and its results are put away, whole.
  void expect_results_in_quarantine() {
    EXPECT_FALSE(service_.jobs->find(id_));
    const fs::path kept = in_quarantine(root(), "jobs/" + id_ + "/cell");
    ASSERT_FALSE(kept.empty());
    EXPECT_EQ(read_file(kept), cell_);
    EXPECT_FALSE(fs::exists(root() / "jobs" / id_));
    // And the server serves on.
    const std::string next = service_.submit().job.id;
    EXPECT_TRUE(service_.reaches(next, JobState::kSucceeded));
  }

  ServiceUnderTest service_;
  std::string id_;
  std::string cell_;
};

// The schema of the version that wrote no marker, word for word, with one finished job in it.
constexpr const char* kFirstVersion = R"sql(
CREATE TABLE jobs (
  sequence INTEGER PRIMARY KEY AUTOINCREMENT,
  id TEXT NOT NULL UNIQUE,
  state TEXT NOT NULL,
  created_ms INTEGER NOT NULL,
  started_ms INTEGER,
  finished_ms INTEGER,
  model_format TEXT NOT NULL,
  model_name TEXT NOT NULL,
  options_json TEXT NOT NULL,
  error_code TEXT NOT NULL DEFAULT '',
  error_json TEXT NOT NULL DEFAULT '',
  model_bytes INTEGER NOT NULL,
  result_bytes INTEGER NOT NULL DEFAULT 0,
  crashes INTEGER NOT NULL DEFAULT 0
) STRICT;
CREATE INDEX jobs_by_state ON jobs (state, sequence);
CREATE TABLE idempotency_keys (
  key TEXT PRIMARY KEY,
  digest TEXT NOT NULL,
  job_id TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE
) STRICT;
CREATE INDEX idempotency_keys_by_job ON idempotency_keys (job_id);
PRAGMA user_version = 1;
)sql";

TEST_F(DataDirectoryTest, WhatTheVersionBeforeWroteIsAdopted) {
  for (const char* name : {"symcell-data", "jobs.sqlite"}) fs::remove(root() / name);
  {
    SQLite::Database old((root() / "jobs.sqlite").string(),
                         SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    old.exec(kFirstVersion);
    SQLite::Statement row(
        old,
        "INSERT INTO jobs (id, state, created_ms, started_ms, finished_ms, "
        "model_format, model_name, options_json, model_bytes, result_bytes, "
        "crashes) VALUES (?, 'succeeded', 1, 2, 3, 'pslg_json', '', '{}', ?, 9, 2)");
    row.bind(1, id_);
    row.bind(2, static_cast<std::int64_t>(square_json().size()));
    row.exec();
  }
  service_.open();
  ASSERT_TRUE(service_.jobs->find(id_));
  EXPECT_EQ(service_.jobs->find(id_)->finished_ms, 3);
  EXPECT_EQ(read_file(service_.jobs->files().cell(id_)), cell_);
  EXPECT_TRUE(fs::exists(root() / "symcell-data"));
  EXPECT_FALSE(fs::exists(root() / "quarantine"));
}

TEST_F(DataDirectoryTest, ALostDatabaseCostsNoResult) {
  for (const char* name : {"jobs.sqlite", "jobs.sqlite-wal", "jobs.sqlite-shm"}) {
    fs::remove(root() / name);
  }
  service_.open();
  expect_results_in_quarantine();
}

TEST_F(DataDirectoryTest, AnEmptyDatabaseCostsNoResult) {
  fs::resize_file(root() / "jobs.sqlite", 0);
  service_.open();
  expect_results_in_quarantine();
}

TEST_F(DataDirectoryTest, ADamagedDatabaseCostsNoResultAndIsPutAwayItself) {
  const std::string garbage(20000, 'x');
  write_file(root() / "jobs.sqlite", garbage);
  service_.open();
  expect_results_in_quarantine();
  const fs::path kept = in_quarantine(root(), "/jobs.sqlite");
  ASSERT_FALSE(kept.empty());
  EXPECT_EQ(read_file(kept), garbage);
}

TEST_F(DataDirectoryTest, ADatabaseWithDamagedPagesCostsNoResult) {
  const auto size = fs::file_size(root() / "jobs.sqlite");
  std::fstream file(root() / "jobs.sqlite", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(4096);
  file << std::string(size - 4096, '\xaa');
  file.close();
  service_.open();
  expect_results_in_quarantine();
}

TEST_F(DataDirectoryTest, AnOlderDatabaseCostsNoResult) {
  fs::copy_file(root() / "jobs.sqlite", root() / "backup");
  service_.open();
  const std::string later = service_.submit().job.id;
  ASSERT_TRUE(service_.reaches(later, JobState::kSucceeded));
  ASSERT_TRUE(service_.close());
  fs::rename(root() / "backup", root() / "jobs.sqlite");
  service_.open();
  EXPECT_TRUE(service_.jobs->find(id_));
  EXPECT_FALSE(service_.jobs->find(later));
  EXPECT_EQ(read_file(in_quarantine(root(), "jobs/" + later + "/cell")), cell_);
}

TEST_F(DataDirectoryTest, TheDatabaseOfAnotherDirectoryIsRefused) {
  ServiceUnderTest other;
  ASSERT_TRUE(other.close());
  fs::copy_file(other.folder / "jobs.sqlite", root() / "jobs.sqlite",
                fs::copy_options::overwrite_existing);
  const auto before = tree_of(root());
  EXPECT_THROW(service_.open(), std::runtime_error);
  EXPECT_EQ(tree_of(root()), before);
}

TEST_F(DataDirectoryTest, WhatADeathLeftOfADeletedJobIsRemoved) {
  {
    SqliteJobStore store(root() / "jobs.sqlite");
    ASSERT_TRUE(store.erase(id_));
  }
  service_.open();
  EXPECT_FALSE(fs::exists(root() / "jobs" / id_));
  EXPECT_FALSE(fs::exists(root() / "quarantine"));
  EXPECT_FALSE(service_.jobs->find(id_));
}

// A death between a model's arrival and its row, and one between the row and the folder's name.
TEST_F(DataDirectoryTest, AModelThatWasPromisedToNobodyIsRemovedAndOneThatWasIsKept) {
  const std::string stranger(id_.size(), '0');
  fs::create_directory(root() / "jobs" / (stranger + ".new"));
  write_file(root() / "jobs" / (stranger + ".new") / "model", square_json());
  fs::rename(root() / "jobs" / id_, root() / "jobs" / (id_ + ".new"));
  service_.open();
  EXPECT_EQ(read_file(service_.jobs->files().cell(id_)), cell_);
  EXPECT_FALSE(fs::exists(root() / "jobs" / (stranger + ".new")));
  EXPECT_FALSE(fs::exists(root() / "quarantine"));
}

TEST_F(DataDirectoryTest, LinksAreNeverFollowed) {
  const TemporaryFolder precious;
  fs::create_directories(precious / "inside");
  write_file(precious / "inside/file", "keep me");
  fs::create_directory_symlink(precious.path(), root() / "jobs/unknown");
  fs::create_directory_symlink(precious.path(), root() / "incoming/0123456789abcdef");
  service_.open();
  EXPECT_EQ(read_file(precious / "inside/file"), "keep me");
  EXPECT_TRUE(fs::is_symlink(in_quarantine(root(), "jobs/unknown")));
  ASSERT_TRUE(service_.close());

  fs::rename(root() / "jobs", root() / "elsewhere");
  fs::create_directory_symlink(precious.path(), root() / "jobs");
  EXPECT_THROW(service_.open(), std::runtime_error);
  EXPECT_EQ(read_file(precious / "inside/file"), "keep me");
  EXPECT_EQ(tree_of(precious.path()).size(), 2U);
}

TEST_F(DataDirectoryTest, ALinkInThePlaceOfAJobOrAResultIsNotServed) {
  const TemporaryFolder precious;
  write_file(precious / "cell", cell_);
  fs::remove_all(root() / "jobs" / id_);
  fs::create_directory_symlink(precious.path(), root() / "jobs" / id_);
  service_.open();
  EXPECT_TRUE(fs::is_symlink(in_quarantine(root(), "jobs/" + id_)));
  EXPECT_THROW(FileReader(service_.jobs->files().cell(id_), Links::kRefuse), std::system_error);
  ASSERT_TRUE(service_.jobs->erase(id_));
  EXPECT_EQ(read_file(precious / "cell"), cell_);
}

TEST_F(DataDirectoryTest, TheDatabaseIsItsOwnersAlone) {
  struct stat status {};
  ASSERT_EQ(::stat((root() / "jobs.sqlite").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

}  // namespace
}  // namespace symcell::server::test
