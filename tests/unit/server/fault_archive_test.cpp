// Models of internal errors: kept, bounded, and never a cause of another failure.
#include "server/base/fault_archive.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/test_files.hpp"

namespace symcell::server {
namespace {

namespace fs = std::filesystem;
using symcell::test::read_file;
using symcell::test::write_file;

class FaultArchiveTest : public ::testing::Test {
 protected:
  FaultArchiveTest() { write_file(model_, "the model"); }

  // As if it had been kept so many hours after the first.
  void keep_at(const FaultArchive& archive, const std::string& name, int hours) {
    ASSERT_TRUE(archive.keep(name, model_, "{}", error_));
    fs::last_write_time(faults_ / name, start_ + std::chrono::hours(hours));
  }
  [[nodiscard]] bool kept(const std::string& name) const { return fs::exists(faults_ / name); }

  symcell::test::TemporaryFolder folder_;
  fs::path model_ = folder_ / "model.json";
  fs::path faults_ = folder_ / "state" / "faults";
  fs::file_time_type start_ = fs::file_time_type::clock::now() - std::chrono::hours(100);
  Error error_{ErrorCode::kInternal, "mesh check 'cell': no \xff UTF-8", {}, {}};
};

TEST_F(FaultArchiveTest, KeepsTheModelAndTheRequest) {
  const FaultArchive archive(faults_);
  const auto path = archive.keep("one", model_, R"({"fold": 3})", error_);
  ASSERT_TRUE(path);
  EXPECT_EQ(*path, faults_ / "one");
  EXPECT_EQ(read_file(*path / "model"), "the model");
  const auto request = nlohmann::json::parse(read_file(*path / "request.json"));
  EXPECT_EQ(request["options"]["fold"], 3);
  EXPECT_FALSE(request["version"].get<std::string>().empty());
  EXPECT_NE(request["error"]["detail"].get<std::string>().find("mesh check"), std::string::npos);
  EXPECT_EQ(fs::status(faults_).permissions(), fs::perms::owner_all);
}

TEST_F(FaultArchiveTest, TheSameNameAgainReplaces) {
  const FaultArchive archive(faults_);
  ASSERT_TRUE(archive.keep("one", model_, "{}", error_));
  write_file(folder_ / "other", "another");
  ASSERT_TRUE(archive.keep("one", folder_ / "other", "{}", error_));
  EXPECT_EQ(read_file(faults_ / "one" / "model"), "another");
}

TEST_F(FaultArchiveTest, TheOldestGoWhenThereAreTooMany) {
  const FaultArchive archive(faults_, 3);
  keep_at(archive, "d", 1);
  keep_at(archive, "c", 2);
  keep_at(archive, "b", 3);
  keep_at(archive, "a", 4);
  EXPECT_FALSE(kept("d"));
  EXPECT_TRUE(kept("c") && kept("b") && kept("a"));
  keep_at(archive, "e", 5);
  EXPECT_FALSE(kept("c"));
  EXPECT_TRUE(kept("b") && kept("a") && kept("e"));
}

TEST_F(FaultArchiveTest, TheOldestGoWhenTheyTakeTooMuchRoom) {
  write_file(model_, std::string(4000, 'x'));
  const FaultArchive archive(faults_, 50, 10'000);
  keep_at(archive, "a", 1);
  keep_at(archive, "b", 2);
  keep_at(archive, "c", 3);
  EXPECT_FALSE(kept("a"));
  EXPECT_TRUE(kept("b") && kept("c"));
}

TEST_F(FaultArchiveTest, AModelThatIsTooLargeIsNotKeptAndNothingGoesForIt) {
  const FaultArchive archive(faults_, 50, 1000);
  keep_at(archive, "small", 1);
  write_file(model_, std::string(1001, 'x'));
  EXPECT_FALSE(archive.keep("large", model_, "{}", error_));
  EXPECT_FALSE(kept("large"));
  EXPECT_TRUE(kept("small"));
}

TEST_F(FaultArchiveTest, RemovesOneCase) {
  const FaultArchive archive(faults_);
  archive.remove("one");  // nothing there yet
  ASSERT_TRUE(archive.keep("one", model_, "{}", error_));
  ASSERT_TRUE(archive.keep("two", model_, "{}", error_));
  archive.remove("one");
  archive.remove("three");
  EXPECT_FALSE(kept("one"));
  EXPECT_TRUE(kept("two"));
}

TEST_F(FaultArchiveTest, ADiskThatRefusesKeepsNothingAndThrowsNothing) {
  write_file(folder_ / "state", "a file where the folder would be");
  EXPECT_FALSE(FaultArchive(faults_).keep("one", model_, "{}", error_));
  FaultArchive(faults_).remove("one");
  EXPECT_FALSE(FaultArchive("/proc/no/such/place").keep("one", model_, "{}", error_));
}

TEST_F(FaultArchiveTest, NoHalvesAreLeft) {
  const FaultArchive archive(faults_);
  EXPECT_FALSE(archive.keep("one", folder_ / "no such model", "{}", error_));
  EXPECT_FALSE(archive.keep("one", model_, "no JSON", error_));
  EXPECT_FALSE(kept("one"));
}

TEST(Faults, AreOurErrorsOnly) {
  EXPECT_TRUE(is_fault(ErrorCode::kInternal));
  EXPECT_TRUE(is_fault(ErrorCode::kWorkerCrashed));
  EXPECT_FALSE(is_fault(ErrorCode::kNotSymmetric));
  EXPECT_FALSE(is_fault(ErrorCode::kCancelled));
  EXPECT_FALSE(is_fault(ErrorCode::kMemoryLimit));
}

}  // namespace
}  // namespace symcell::server
