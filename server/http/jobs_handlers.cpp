// POST and GET /v1/jobs, GET and DELETE /v1/jobs/{id}, POST /v1/jobs/{id}/cancel and rerun.
#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "api/printable.hpp"
#include "server/base/clock.hpp"
#include "server/http/body_reader.hpp"
#include "server/http/call.hpp"
#include "server/http/header_values.hpp"
#include "server/http/job_document.hpp"
#include "server/http/model_request.hpp"
#include "server/http/problem_response.hpp"
#include "server/http/router.hpp"
#include "server/http/service_context.hpp"

namespace symcell::server {
namespace {

constexpr std::int64_t kMaxWaitSeconds = 60;
constexpr std::int64_t kMaxListLimit = 500;
constexpr std::size_t kMaxKeyLength = 255;

void respond_job(Call& call, int status, const Job& job, ServiceContext& context) {
  call.response.status = status;
  call.response.set_header("Cache-Control", "no-store");
  call.response.set_content(json_text(job_document(job, context.jobs, JobDetail::kFull)),
                            "application/json");
}

void respond_stopping(Call& call) {
  call.exchange.close = true;
  respond_problem(call, ServiceProblem::kStopping,
                  "the server is stopping and takes no new jobs; try again elsewhere or later");
}

void respond_queue_full(Call& call, const ServiceContext& context) {
  respond_problem(call, ServiceProblem::kQueueFull,
                  "there are " + std::to_string(context.jobs.limits().queue_limit) +
                      " jobs waiting already, or as many as one client may have; try again later");
}

void respond_quota_spent(Call& call) {
  respond_problem(call, ServiceProblem::kQuotaSpent,
                  "the models sent with this key today, and this one, are more bytes than it may "
                  "send from midnight to midnight, UTC");
  constexpr std::int64_t kDayMs = std::int64_t{24} * 3600 * 1000;
  set_retry_after(call, (kDayMs - now_ms() % kDayMs) / 1000 + 1);
}

KeyLimits limits_of(const Caller& caller) {
  return caller.key ? caller.key->limits : KeyLimits{};
}

bool is_usable_key(const std::string& key) {
  return key.size() <= kMaxKeyLength &&
         std::ranges::all_of(key, [](char c) { return c >= 0x20 && c < 0x7f; });
}

// 201 with the finished job, else 202.
void respond_state(Call& call, const Job& job, ServiceContext& context) {
  // Only an end is known to last.
  if (!is_finished(job.state)) context.jobs.make_durable();
  respond_job(call, is_finished(job.state) ? 201 : 202, job, context);
}

// A submission whose sender waits for the job's end.
class WaitingCall final : public SuspendedCall {
 public:
  WaitingCall(Job job, ServiceContext& context, Clock::time_point deadline, Slots::Slot place)
      : job_(std::move(job)), context_(context), deadline_(deadline), place_(std::move(place)) {}

  std::shared_ptr<void> watch(std::function<void()> wake) override {
    return context_.jobs.changes().watch(job_.id, std::move(wake));
  }

  bool look(Connection& /*connection*/) override {
    if (Clock::now() >= deadline_ || context_.jobs.stopping()) return true;
    // What runs here has not ended; the runner tells when it has.
    if (context_.jobs.runner().progress(job_.id)) return false;
    const auto found = context_.jobs.find(job_.id);
    return !found || is_finished(found->state);
  }

  [[nodiscard]] Clock::time_point look_again_at() const override { return deadline_; }

  void answer(Call& call) override {
    if (auto found = context_.jobs.find(job_.id)) job_ = std::move(*found);
    place_.reset();
    respond_state(call, job_, context_);
  }

 private:
  Job job_;
  ServiceContext& context_;
  const Clock::time_point deadline_;
  Slots::Slot place_;
};

// At once, or when the job has ended, as the caller prefers.
void respond_accepted(Call& call, const Job& job, ServiceContext& context) {
  call.response.set_header("Location", job_path(job));
  const auto wait = prefer_wait_seconds(call.header("Prefer"));
  // No place among those who wait: a preference may be left unmet.
  Slots::Slot place = wait ? context.streams.try_take(call.exchange.caller.client) : nullptr;
  if (!place) {
    context.jobs.make_durable();
    respond_job(call, 202, job, context);
    return;
  }
  const std::int64_t seconds = std::min(*wait, kMaxWaitSeconds);
  call.response.set_header("Preference-Applied", "wait=" + std::to_string(seconds));
  if (is_finished(job.state)) {
    respond_state(call, job, context);
    return;
  }
  call.exchange.suspended = std::make_shared<WaitingCall>(
      job, context, SuspendedCall::Clock::now() + std::chrono::seconds(seconds), std::move(place));
}

void respond_unknown_job(Call& call) {
  respond_problem(call, ServiceProblem::kNotFound, "there is no such job; it may have expired");
}

void respond_bad_key(Call& call) {
  respond_problem(call, ServiceProblem::kBadRequest,
                  "an Idempotency-Key has 1 to 255 printable ASCII characters");
}

// Who is to be told of the job's end, "" for nobody; nullopt: not acceptable, the call is answered.
std::optional<std::string> webhook_of(Call& call, const ServiceContext& context) {
  std::string address = call.header("Webhook-Url");
  if (address.empty()) return address;
  const std::string fault = context.webhooks.refusal_of(address);
  if (fault.empty()) return address;
  respond_problem(call, ServiceProblem::kWebhookRefused, fault);
  return std::nullopt;
}

// All but model and options.
Submission submission_of(const Call& call, const std::string& key, const std::string& webhook) {
  const Caller& caller = call.exchange.caller;
  Submission submission;
  submission.idempotency_key = key;
  submission.client = caller.client;
  submission.owner = caller.owner();
  submission.limits = limits_of(caller);
  submission.priority = caller.key ? caller.key->priority : 1;
  submission.request_id = call.exchange.request_id;
  submission.traceparent = call.exchange.traceparent;
  submission.webhook = webhook;
  submission.durable_soon = true;
  return submission;
}

void respond_outcome(Call& call, const SubmitOutcome& outcome, ServiceContext& context) {
  call.exchange.job = outcome.job.id;
  switch (outcome.status) {
    case SubmitStatus::kReplayed:
      call.response.set_header("Idempotency-Replayed", "true");
      respond_accepted(call, outcome.job, context);
      return;
    case SubmitStatus::kAccepted:
      context.logger.info("job_accepted",
                          {{"job", std::string_view(outcome.job.id)},
                           {"key", std::string_view(outcome.job.owner)},
                           {"client", std::string_view(call.exchange.client)},
                           {"request_id", std::string_view(call.exchange.request_id)},
                           {"trace", trace_id_of(call.exchange.traceparent)}});
      respond_accepted(call, outcome.job, context);
      return;
    case SubmitStatus::kKeyConflict:
      respond_problem(call, ServiceProblem::kIdempotencyConflict,
                      "this Idempotency-Key came before with another model or other options; "
                      "take a new key for a new request");
      return;
    case SubmitStatus::kQueueFull: respond_queue_full(call, context); return;
    case SubmitStatus::kBytesSpent: respond_quota_spent(call); return;
    case SubmitStatus::kStopping: respond_stopping(call); return;
  }
}

void submit_job(Call& call, ServiceContext& context) {
  const std::string key = call.header("Idempotency-Key");
  if (!is_usable_key(key)) return respond_bad_key(call);
  // Before the body is read: refusing early saves both sides the transfer. A repeated request is
  // answered however full the queue is.
  if (context.jobs.stopping()) return respond_stopping(call);
  const Caller& caller = call.exchange.caller;
  if (key.empty() && context.jobs.queue_is_full(caller.client, limits_of(caller))) {
    return respond_queue_full(call, context);
  }
  const auto webhook = webhook_of(call, context);
  if (!webhook) return;
  const auto request = receive_model_request(call, context, context.max_body_bytes);
  if (!request) return;
  Submission submission = submission_of(call, key, *webhook);
  submission.model = request->model.path();
  submission.model_format = request->format;
  submission.model_name = request->model_name;
  submission.options = request->options;
  respond_outcome(call, context.jobs.submit(submission), context);
}

void rerun_job(Call& call, ServiceContext& context) {
  const std::string key = call.header("Idempotency-Key");
  if (!is_usable_key(key)) return respond_bad_key(call);
  // Whoever sends options means another mesh than the one that would be made.
  if (!call.query.empty()) {
    respond_problem(call, ServiceProblem::kBadRequest,
                    "a job is run again with its own options: there is no parameter \"" +
                        printable(call.query.begin()->first) +
                        "\" here; for others submit its model to /v1/jobs");
    return;
  }
  if (!receive_nothing(call)) return;
  const auto job = context.jobs.find(call.id);
  if (!job) return respond_unknown_job(call);
  if (context.jobs.stopping()) return respond_stopping(call);
  if (!is_finished(job->state)) {
    respond_problem(call, ServiceProblem::kNotFinished, "the job has not ended yet");
    return;
  }
  if (!job->model_kept) {
    respond_problem(call, ServiceProblem::kModelGone,
                    "models of jobs without a result are kept for a day; send it again");
    return;
  }
  const auto webhook = webhook_of(call, context);
  if (!webhook) return;
  respond_outcome(call, context.jobs.rerun(*job, submission_of(call, key, *webhook)), context);
}

// False: a parameter is not acceptable, the call is answered.
bool parse_filter(Call& call, JobFilter& filter) {
  if (call.has_parameter("state")) {
    filter.state = job_state_from_name(call.parameter("state"));
    if (!filter.state) {
      respond_problem(call, ServiceProblem::kBadRequest,
                      "state is one of queued, running, succeeded, failed, cancelled");
      return false;
    }
  }
  if (call.has_parameter("limit")) {
    const auto limit = parse_whole_number(call.parameter("limit"));
    if (!limit || *limit < 1 || *limit > kMaxListLimit) {
      respond_problem(call, ServiceProblem::kBadRequest,
                      "limit is a whole number from 1 to " + std::to_string(kMaxListLimit));
      return false;
    }
    filter.limit = static_cast<std::size_t>(*limit);
  }
  if (call.has_parameter("cursor")) {
    filter.before_sequence = parse_whole_number(call.parameter("cursor"));
    if (!filter.before_sequence) {
      respond_problem(call, ServiceProblem::kBadRequest,
                      "cursor is what next_cursor of the page before said");
      return false;
    }
  }
  return true;
}

void list_jobs(Call& call, ServiceContext& context) {
  JobFilter filter;
  if (!parse_filter(call, filter)) return;
  const Caller& caller = call.exchange.caller;
  if (!caller.sees_all) filter.owner = caller.owner();
  // For administrators; others see their own jobs whatever they ask for.
  if (caller.sees_all && call.has_parameter("key")) filter.owner = call.parameter("key");
  const std::size_t limit = filter.limit;
  ++filter.limit;  // one more shows whether there is another page
  auto jobs = context.jobs.list(filter);
  nlohmann::ordered_json document;
  document["jobs"] = nlohmann::ordered_json::array();
  document["next_cursor"] = nullptr;
  if (jobs.size() > limit) {
    jobs.resize(limit);
    document["next_cursor"] = std::to_string(jobs.back().sequence);
  }
  for (const Job& job : jobs) {
    document["jobs"].push_back(job_document(job, context.jobs, JobDetail::kSummary));
  }
  call.response.set_header("Cache-Control", "no-store");
  call.response.set_content(json_text(document), "application/json");
}

void show_job(Call& call, ServiceContext& context) {
  const auto job = context.jobs.find(call.id);
  if (!job) return respond_unknown_job(call);
  respond_job(call, 200, *job, context);
}

void cancel_job(Call& call, ServiceContext& context) {
  const auto before = context.jobs.find(call.id);
  if (!before) return respond_unknown_job(call);
  if (is_finished(before->state) && before->state != JobState::kCancelled) {
    respond_problem(call, ServiceProblem::kAlreadyFinished,
                    "the job is " + std::string(job_state_name(before->state)) +
                        " and can no longer be cancelled");
    return;
  }
  const auto job = context.jobs.cancel(call.id);
  if (!job) return respond_unknown_job(call);
  // A running job ends within a second; then its state is cancelled.
  respond_job(call, is_finished(job->state) ? 200 : 202, *job, context);
}

void delete_job(Call& call, ServiceContext& context) {
  if (!context.jobs.erase(call.id)) return respond_unknown_job(call);
  call.response.status = 204;
}

}  // namespace

void add_job_routes(Router& router, ServiceContext& context) {
  // The last two for clients made from openapi.yaml, which has one form of body an operation.
  for (const char* path : {"/v1/jobs", "/v1/jobs/file", "/v1/jobs/form"}) {
    router.add("POST", path, [&context](Call& call) { submit_job(call, context); });
  }
  router.add("GET", "/v1/jobs", [&context](Call& call) { list_jobs(call, context); });
  router.add("GET", "/v1/jobs/{id}", [&context](Call& call) { show_job(call, context); });
  router.add("DELETE", "/v1/jobs/{id}", [&context](Call& call) { delete_job(call, context); });
  router.add("POST", "/v1/jobs/{id}/rerun", [&context](Call& call) { rerun_job(call, context); });
  router.add("POST", "/v1/jobs/{id}/cancel", [&context](Call& call) { cancel_job(call, context); });
}

}  // namespace symcell::server
