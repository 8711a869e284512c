// Where jobs are kept: an interface, so that an embedded and a shared database can stand behind it.
//
// Every call is atomic and seen by every other once it returns. It lasts from the next make_durable() on that
// returns, or sooner: so whoever commits need not wait for the disk, and what a call throws says always that it
// has changed nothing. Any thread may call. A failing database throws StoreError (see server/base/files.hpp for
// why).
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "server/jobs/job.hpp"

namespace symcell::server {

// The database does not do what it was asked, and has changed nothing: it is locked, full, damaged or
// gone. What was asked may be asked again. Thrown by make_durable(): what was written before is seen, and may
// be undone by a failure of the machine.
class StoreError : public std::runtime_error {
 public:
  enum class Kind : std::uint8_t { kBusy, kFull, kDamaged, kOther };
  StoreError(Kind kind, const std::string& what) : std::runtime_error(what), kind_(kind) {}
  [[nodiscard]] Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

// How long a run of a shared store is taken to be alive without a sign.
inline constexpr std::chrono::seconds kLease{15};

// A caller's promise that requests with the same key are the same request.
struct IdempotencyKey {
  std::string key;
  std::string digest;      // of the request
  std::string owner = {};  // two clients may have the same key
};

enum class InsertResult : std::uint8_t {
  kInserted,
  kReplayed,    // the key is known with this digest: the job in the outcome is the earlier one
  kConflict,    // the key is known with another digest
  kQueueFull,   // in all, or with jobs of this client
  kBytesSpent,  // the owner has sent as many bytes today as he may
};

// A small file of a job, kept beside its row until the file itself is known to be on the disk: to write twice
// costs less than to wait for the disk for every file by itself.
struct FileCopy {
  std::string name;  // within the job's folder
  std::string bytes;
  std::string job_id = {};  // these two are given by the store
  std::int64_t number = 0;
};

// What a job must find to be taken: places in the queue, and for its client.
struct Admission {
  std::int64_t queued = std::numeric_limits<std::int64_t>::max();
  std::int64_t queued_of_client = std::numeric_limits<std::int64_t>::max();
  std::int64_t bytes_per_day =
      std::numeric_limits<std::int64_t>::max();  // of the owner, if it has one
};

// What a client has at present.
struct ClientUsage {
  std::int64_t queued = 0;
  std::int64_t running = 0;
  std::int64_t bytes_today = 0;  // of models that owners sent, from midnight, UTC
  std::int64_t jobs_today = 0;
};

struct InsertOutcome {
  InsertResult result = InsertResult::kInserted;
  Job job;
};

struct JobFilter {
  std::optional<JobState> state;
  std::optional<std::string> owner;
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
  // Of its results; of stores that keep copies.
  std::vector<FileCopy> copies = {};
};

struct StoreTotals {
  std::array<std::int64_t, 5> by_state{};  // indexed by JobState
  std::int64_t bytes = 0;                  // models and results
};

// A run as the server that has it tells of it, and what it is told.
struct RunState {
  std::string id;
  std::int32_t attempt = 0;
  Progress progress;
};
struct RunOrder {
  std::string id;
  bool lost = false;    // deleted, or started again elsewhere: the run is of no use any more
  bool cancel = false;  // somebody asked for its end
};

// A message about a finished job, on its way to whoever asked to be told.
struct Delivery {
  std::string job_id;
  std::string address;
  std::int32_t tries = 0;  // so far
};

class JobStore {
 public:
  virtual ~JobStore() = default;

  // `job.sequence` is given by the store, and so is its turn among those that wait. `copies`: of its model; of
  // stores that keep copies.
  virtual InsertOutcome insert(const Job& job,
                               const std::optional<IdempotencyKey>& key,
                               const Admission& admission,
                               const std::vector<FileCopy>& copies) = 0;
  InsertOutcome insert(const Job& job,
                       const std::optional<IdempotencyKey>& key,
                       const Admission& admission) {
    return insert(job, key, admission, {});
  }
  // All that was written before is on the disk when this returns. Callers that come together wait for the
  // disk together.
  virtual void make_durable() {}
  // Whether copies of small files are kept. Then files of jobs need not be synchronised one by one if their
  // copies go with insert() or apply(); now and then all are synchronised, and the copies forgotten.
  [[nodiscard]] virtual bool keeps_copies() const { return false; }
  // How many bytes there are at most.
  [[nodiscard]] virtual std::uint64_t copied_bytes() { return 0; }
  // The number of the newest one. What it is a copy of was written before it.
  [[nodiscard]] virtual std::int64_t newest_copy() { return 0; }
  // The oldest one with a higher number.
  [[nodiscard]] virtual std::optional<FileCopy> copy_after(std::int64_t /*number*/) { return {}; }
  // Those up to this one are of no use any more.
  virtual void forget_copies(std::int64_t /*number*/) {}
  // kReplayed or kConflict; nullopt if the key is unknown.
  [[nodiscard]] virtual std::optional<InsertOutcome> find_key(const IdempotencyKey& key) = 0;
  [[nodiscard]] virtual std::optional<Job> find(std::string_view id) = 0;
  // Newest first.
  [[nodiscard]] virtual std::vector<Job> list(const JobFilter& filter) = 0;
  // Oldest first.
  [[nodiscard]] virtual std::vector<Job> unfinished() = 0;
  // When the job came that waits longest, by the clock of created_ms; nullopt: none waits.
  [[nodiscard]] virtual std::optional<std::int64_t> oldest_waiting_ms() = 0;
  // Jobs without a result that ended before this time of clock_ms() and still have their models.
  [[nodiscard]] virtual std::vector<Job> spent_models(std::int64_t before_clock_ms,
                                                      std::size_t limit) = 0;
  // The model was removed, or is about to be.
  virtual void forget_model(std::string_view id) = 0;
  // A message that is due at this time of clock_ms(), and is due again only after `patience`: for a
  // server that dies over it. nullopt: none.
  virtual std::optional<Delivery> claim_delivery(std::chrono::milliseconds patience) = 0;
  // It arrived, or will be tried again after `pause`, or nullopt: is given up.
  virtual void delivered(std::string_view job_id) = 0;
  virtual void delivery_failed(std::string_view job_id,
                               std::optional<std::chrono::milliseconds> pause) = 0;
  // Finished jobs, oldest first.
  [[nodiscard]] virtual std::vector<Job> oldest_finished(std::size_t limit) = 0;
  [[nodiscard]] virtual ClientUsage usage(std::string_view client, std::int64_t time_ms) = 0;
  // Starts the job whose turn it is, of those whose client may run one more: clients take turns, as many jobs each as their weight, and each
  // one's jobs go in the order they came. nullopt: none waits that may run.
  virtual std::optional<Job> claim(std::int64_t time_ms) = 0;
  // Whether other servers have the same jobs. Then a run must be renewed by keep() more often than
  // every kLease, or it is taken to be dead and given to another by rescue().
  [[nodiscard]] virtual bool shared() const { return false; }
  [[nodiscard]] virtual std::vector<RunOrder> keep(const std::vector<RunState>& runs) {
    static_cast<void>(runs);
    return {};
  }
  // Queues runs again that nobody keeps. Returns how many.
  virtual std::size_t rescue() { return 0; }
  // Asks whoever runs the job to end it.
  virtual void request_cancel(std::string_view id) { static_cast<void>(id); }
  // `changed`: called, from a thread of the store's, when another server has changed the job with this id;
  // without one: any may have changed.
  virtual void listen(const std::function<void(std::string_view id)>& /*changed*/) {}
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
  // Those that tidy(mark) forgets. Of a store that is shared, none: whoever ran a job removes its files.
  [[nodiscard]] virtual std::vector<std::string> erased_up_to(std::int64_t /*mark*/) { return {}; }
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
