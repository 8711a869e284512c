// Where jobs are kept: an interface, so that an embedded and a shared database can stand behind it.
//
// Every call is atomic and, once it returns, durable. Any thread may call. A failing database
// throws StoreError (see server/base/files.hpp for why).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "server/jobs/job.hpp"

namespace symcell::server {

// The database does not do what it was asked, and has changed nothing: it is locked, full, damaged or
// gone. What was asked may be asked again.
class StoreError : public std::runtime_error {
 public:
  enum class Kind : std::uint8_t { kBusy, kFull, kDamaged, kOther };
  StoreError(Kind kind, const std::string& what) : std::runtime_error(what), kind_(kind) {}
  [[nodiscard]] Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

// A caller's promise that requests with the same key are the same request.
struct IdempotencyKey {
  std::string key;
  std::string digest;  // of the request
};

enum class InsertResult : std::uint8_t {
  kInserted,
  kReplayed,   // the key is known with this digest: the job in the outcome is the earlier one
  kConflict,   // the key is known with another digest
  kQueueFull,  // in all, or with jobs of this client
};

// What a job must find to be taken: places in the queue, and for its client.
struct Admission {
  std::int64_t queued = std::numeric_limits<std::int64_t>::max();
  std::int64_t queued_of_client = std::numeric_limits<std::int64_t>::max();
};

// What a client has at present.
struct ClientUsage {
  std::int64_t queued = 0;
};

struct InsertOutcome {
  InsertResult result = InsertResult::kInserted;
  Job job;
};

struct JobFilter {
  std::optional<JobState> state;
  std::size_t limit = 50;
  std::optional<std::int64_t> before_sequence;  // only jobs accepted earlier
};

// What a transition writes besides the state.
struct JobChange {
  // By the machine's clock. Where that was set back, a job starts no earlier than it came and ends
  // no earlier than it started.
  std::int64_t time_ms = 0;
  // Of the run that writes. Where the job was started again since, nothing is written: a run that was
  // given up may still go on somewhere.
  std::optional<std::int32_t> attempt = {};
  std::string error_code = {};
  std::string error_json = {};
  std::int64_t result_bytes = 0;
  std::string statistics_sha256 = {};
};

struct StoreTotals {
  std::array<std::int64_t, 5> by_state{};  // indexed by JobState
  std::int64_t bytes = 0;                  // models and results
};

class JobStore {
 public:
  virtual ~JobStore() = default;

  // `job.sequence` is given by the store, and so is its turn among those that wait.
  virtual InsertOutcome insert(const Job& job,
                               const std::optional<IdempotencyKey>& key,
                               const Admission& admission) = 0;
  // kReplayed or kConflict; nullopt if the key is unknown.
  [[nodiscard]] virtual std::optional<InsertOutcome> find_key(const IdempotencyKey& key) = 0;
  [[nodiscard]] virtual std::optional<Job> find(std::string_view id) = 0;
  // Newest first.
  [[nodiscard]] virtual std::vector<Job> list(const JobFilter& filter) = 0;
  // Oldest first.
  [[nodiscard]] virtual std::vector<Job> unfinished() = 0;
  // Finished jobs, oldest first.
  [[nodiscard]] virtual std::vector<Job> oldest_finished(std::size_t limit) = 0;
  [[nodiscard]] virtual ClientUsage usage(std::string_view client) = 0;
  // Starts the job whose turn it is: clients take turns, as many jobs each as their weight, and each
  // one's jobs go in the order they came. nullopt: none waits that may run.
  virtual std::optional<Job> claim(std::int64_t time_ms) = 0;
  // The job after the event; nullopt if it is gone or the event is not allowed in its state,
  // or `change.attempt` is not its attempt.
  virtual std::optional<Job> apply(std::string_view id,
                                   JobEvent event,
                                   const JobChange& change) = 0;
  // One more worker was killed while it ran this job.
  virtual void count_lost_worker(std::string_view id) = 0;
  // Forgets the job and its idempotency key, all but its id; false if it is unknown.
  virtual bool erase(std::string_view id) = 0;
  // Files may outlive their job if the server dies before it has removed them: whether a job was
  // erased tells them from files that the database never heard of.
  [[nodiscard]] virtual bool was_erased(std::string_view id) = 0;
  // Forgets those erased up to the mark, of which no files are left, and notes the clock. Returns the
  // mark of now. To be called now and then.
  virtual std::int64_t tidy(std::int64_t mark) = 0;
  // Milliseconds of a clock by which ages are measured. It goes on from start to start and never
  // jumps, whatever is done to the machine's: a start counts the time since the last note as the
  // machine's clock has it, but not below zero and for a day at most.
  [[nodiscard]] virtual std::int64_t clock_ms() = 0;
  // Never waits and never fails.
  [[nodiscard]] virtual StoreTotals totals() = 0;
  // Throws if the database cannot be read or written, or does not answer at once.
  virtual void check_health() = 0;
};

}  // namespace symcell::server
