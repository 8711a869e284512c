// GET /v1/jobs/{id}/events: Server-Sent Events until the job ends.
//
//   event: state      data: the job, at the beginning and whenever its state changes
//   event: progress   data: its progress, when that changes, at most four times a second
//   event: end        data: the finished job; the stream ends
// A comment every few seconds keeps proxies from closing the stream and shows us a client's
// leaving. When the server stops or the job is deleted the stream ends without `end`.
#include <chrono>
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

using Clock = ChangeSignal::Clock;
constexpr std::chrono::milliseconds kProgressInterval{250};
constexpr std::chrono::seconds kHeartbeat{5};

std::string event_text(std::string_view name, const nlohmann::ordered_json& data) {
  const std::string text =
      data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return "event: " + std::string(name) + "\ndata: " + text + "\n\n";
}

class EventStream {
 public:
  EventStream(std::string id, JobService& jobs, Slots::Slot place)
      : id_(std::move(id)), jobs_(jobs), place_(std::move(place)) {}

  // False: the client is gone.
  bool run(httplib::DataSink& sink) {
    if (!send(sink, "retry: 2000\n\n")) return false;
    ChangeWaiter waiter(jobs_.changes(), id_);
    while (true) {
      const auto job = jobs_.find(id_);
      if (!job) break;
      if (!send(sink, news_of(*job))) return false;
      if (is_finished(job->state) || jobs_.stopping()) break;
      if (Clock::now() - last_sent_ > kHeartbeat && !send(sink, ": still here\n\n")) return false;
      waiter.wait_until(Clock::now() + kProgressInterval);
    }
    sink.done();
    return true;
  }

 private:
  // The events the client has not seen yet; may be empty.
  std::string news_of(const Job& job) {
    std::string events;
    if (state_ != job.state) {
      events += event_text("state", job_document(job, jobs_, JobDetail::kSummary));
      state_ = job.state;
    }
    const nlohmann::ordered_json progress = progress_document(job, jobs_);
    std::string progress_event = event_text("progress", progress);
    if (progress_event != last_progress_) {
      events += progress_event;
      last_progress_ = std::move(progress_event);
    }
    if (is_finished(job.state)) {
      events += event_text("end", job_document(job, jobs_, JobDetail::kFull));
    }
    return events;
  }

  bool send(httplib::DataSink& sink, const std::string& text) {
    if (text.empty()) return true;
    last_sent_ = Clock::now();
    return sink.is_writable() && sink.write(text.data(), text.size());
  }

  std::string id_;
  JobService& jobs_;
  Slots::Slot place_;
  std::optional<JobState> state_;
  std::string last_progress_;
  Clock::time_point last_sent_ = Clock::now();
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
  const auto stream = std::make_shared<EventStream>(call.id, context.jobs, std::move(place));
  const auto provider = [stream](std::size_t, httplib::DataSink& sink) {
    return stream->run(sink);
  };
  if (call.request.version == "HTTP/1.0") {
    call.response.set_content_provider("text/event-stream", provider);
  } else {
    call.response.set_chunked_content_provider("text/event-stream", provider);
  }
}

}  // namespace

void add_event_routes(Router& router, ServiceContext& context) {
  router.add("GET", "/v1/jobs/{id}/events", [&context](Call& call) { send_events(call, context); });
}

}  // namespace symcell::server
