// GET /v1/jobs/{id}/events: Server-Sent Events until the job ends.
//
//   event: state      data: the job, at the beginning and whenever its state changes
//   event: progress   data: its progress, when that changes, at most four times a second
//   event: end        data: the finished job; the stream ends
// A comment every few seconds keeps proxies from closing the stream and shows us a client's
// leaving. When the server stops or the job is deleted the stream ends without `end`.
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "server/http/call.hpp"
#include "server/http/job_document.hpp"
#include "server/http/problem_response.hpp"
#include "server/http/router.hpp"
#include "server/http/service_context.hpp"

namespace symcell::server {
namespace {

constexpr std::chrono::milliseconds kProgressInterval{250};
constexpr std::chrono::seconds kHeartbeat{5};
// A client that takes nothing for so long, or leaves so much, is taken for gone.
constexpr std::chrono::seconds kClientPatience{20};
constexpr std::size_t kMostUnsent = 256UL * 1024;

std::string event_text(std::string_view name, const nlohmann::ordered_json& data) {
  const std::string text =
      data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return "event: " + std::string(name) + "\ndata: " + text + "\n\n";
}

class EventStream final : public SuspendedCall {
 public:
  // `chunked`: as HTTP/1.1 has it; else the end of the connection is the stream's.
  EventStream(std::string id, JobService& jobs, Slots::Slot place, bool chunked)
      : id_(std::move(id)), jobs_(jobs), place_(std::move(place)), chunked_(chunked) {
    add("retry: 2000\n\n");
  }

  std::shared_ptr<void> watch(std::function<void()> wake) override {
    return jobs_.changes().watch(id_, [changed = changed_, wake = std::move(wake)] {
      *changed = true;
      wake();
    });
  }

  bool look(Connection& connection) override {
    if (!ended_) {
      gather();
      if (!ended_ && Clock::now() - last_sent_ > kHeartbeat) add(": still here\n\n");
      if (ended_ && chunked_) unsent_ += "0\r\n\r\n";
    }
    return !flush(connection) || (ended_ && unsent_.empty());
  }

  [[nodiscard]] Clock::time_point look_again_at() const override {
    const bool soon = !unsent_.empty() || state_ == JobState::kRunning;
    return Clock::now() + (soon ? kProgressInterval : std::chrono::milliseconds(kHeartbeat));
  }

  // Its head was sent by the handler.
  void answer(Call& /*call*/) override {}

 private:
  // The events the client has not seen yet.
  void gather() {
    // Between changes only the progress of what runs is of interest; where others run it, the row has it.
    if (!changed_->exchange(false) && state_ && !jobs_.store().shared()) {
      if (state_ == JobState::kRunning) add_progress(running_);
      ended_ = jobs_.stopping();
      return;
    }
    const auto job = jobs_.find(id_);
    if (!job) {
      ended_ = true;
      return;
    }
    if (state_ != job->state) {
      add(event_text("state", job_document(*job, jobs_, JobDetail::kSummary)));
      state_ = job->state;
    }
    running_ = *job;
    add_progress(*job);
    if (is_finished(job->state)) {
      add(event_text("end", job_document(*job, jobs_, JobDetail::kFull)));
    }
    ended_ = is_finished(job->state) || jobs_.stopping();
  }

  void add_progress(const Job& job) {
    std::string event = event_text("progress", progress_document(job, jobs_));
    if (event == last_progress_) return;
    add(event);
    last_progress_ = std::move(event);
  }

  void add(const std::string& text) {
    last_sent_ = Clock::now();
    if (!chunked_) {
      unsent_ += text;
      return;
    }
    std::array<char, 20> length{};
    const auto end = std::to_chars(length.data(), length.data() + length.size(), text.size(), 16);
    unsent_.append(length.data(), end.ptr).append("\r\n").append(text).append("\r\n");
  }

  // False: the client is gone, or takes nothing.
  bool flush(Connection& connection) {
    while (!unsent_.empty()) {
      const ssize_t sent = connection.send(unsent_.data(), unsent_.size());
      if (sent < 0 && errno == EINTR) continue;
      if (sent < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
        return unsent_.size() < kMostUnsent && Clock::now() - last_taken_ < kClientPatience;
      }
      if (sent <= 0) return false;
      unsent_.erase(0, static_cast<std::size_t>(sent));
      last_taken_ = Clock::now();
    }
    last_taken_ = Clock::now();
    return true;
  }

  const std::string id_;
  JobService& jobs_;
  Slots::Slot place_;
  const bool chunked_;
  // Apart, for the last call of a watch may come late.
  const std::shared_ptr<std::atomic<bool>> changed_ = std::make_shared<std::atomic<bool>>(true);
  std::optional<JobState> state_;
  Job running_;  // as it was when it changed last
  std::string last_progress_;
  std::string unsent_;
  bool ended_ = false;
  Clock::time_point last_sent_ = Clock::now();
  Clock::time_point last_taken_ = Clock::now();
};

void send_events(Call& call, ServiceContext& context) {
  if (!context.jobs.find(call.id)) {
    respond_problem(call, ServiceProblem::kNotFound, "there is no such job; it may have expired");
    return;
  }
  Slots::Slot place = context.streams.try_take(call.exchange.caller.client);
  if (!place) {
    respond_problem(call, ServiceProblem::kTooManyStreams,
                    "too many clients follow jobs; ask for the job's state instead");
    return;
  }
  call.response.set_header("Cache-Control", "no-store");
  call.response.set_header("X-Accel-Buffering", "no");
  call.exchange.close = true;
  const bool chunked = call.request.version != "HTTP/1.0";
  // httplib sends the head, and hears that there is no more for it to do.
  const auto provider = [&exchange = call.exchange, stream = std::make_shared<EventStream>(
                                                        call.id, context.jobs, std::move(place),
                                                        chunked)](std::size_t, httplib::DataSink&) {
    exchange.suspended = stream;
    return false;
  };
  if (chunked) {
    call.response.set_chunked_content_provider("text/event-stream", provider);
  } else {
    call.response.set_content_provider("text/event-stream", provider);
  }
}

}  // namespace

void add_event_routes(Router& router, ServiceContext& context) {
  router.add("GET", "/v1/jobs/{id}/events", [&context](Call& call) { send_events(call, context); });
}

}  // namespace symcell::server
