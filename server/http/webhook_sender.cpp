#include "server/http/webhook_sender.hpp"

#include <httplib.h>

#include <array>
#include <exception>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "server/base/clock.hpp"
#include "server/http/job_document.hpp"

namespace symcell::server {
namespace {

using std::chrono::milliseconds;

// Pauses before each further try; after the last one a message is given up.
constexpr std::array<std::chrono::seconds, 8> kPauses{
    std::chrono::seconds(5),     std::chrono::seconds(60),   std::chrono::seconds(300),
    std::chrono::seconds(1800),  std::chrono::seconds(7200), std::chrono::seconds(18000),
    std::chrono::seconds(43200), std::chrono::seconds(86400)};
// What a receiver may take to connect and to answer; for longer nobody else may try.
constexpr int kPatienceSeconds = 10;
constexpr std::chrono::seconds kClaim{60};
// How soon an end is told of: changes of jobs wake the sender, others' are looked for.
constexpr milliseconds kLookInterval{1000};
constexpr std::size_t kMostAnswerBytes = 64UL * 1024;

httplib::Headers headers_of(const std::string& secret,
                            const Job& job,
                            const std::string& timestamp,
                            const std::string& body) {
  const std::string id = "msg_" + job.id;
  httplib::Headers headers{{"webhook-id", id},
                           {"webhook-timestamp", timestamp},
                           {"webhook-signature", webhook_signature(secret, id, timestamp, body)},
                           {"User-Agent", "symcell"}};
  if (!job.traceparent.empty()) headers.emplace("traceparent", job.traceparent);
  return headers;
}

}  // namespace

WebhookSender::WebhookSender(WebhookSettings settings,
                             const WebhookRules& rules,
                             JobService& jobs,
                             Metrics& metrics,
                             Logger& logger)
    : settings_(std::move(settings)),
      rules_(rules),
      jobs_(jobs),
      metrics_(metrics),
      logger_(logger) {
  metrics_.declare_counter("symcell_webhooks_total",
                           "Messages about finished jobs, by what became of the try.");
}

WebhookSender::~WebhookSender() {
  stop();
}

void WebhookSender::start() {
  if (settings_.secret.empty()) return;
  thread_ = std::thread([this] { work(); });
}

void WebhookSender::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  stopped_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void WebhookSender::work() {
  while (true) {
    bool sent = false;
    const std::uint64_t seen = jobs_.changes().version();
    try {
      sent = send_next();
    } catch (const std::exception& exception) {
      logger_.error("webhooks_not_looked_at", {{"what", exception.what()}});
    }
    if (!sent) jobs_.changes().wait_beyond(seen, ChangeSignal::Clock::now() + kLookInterval);
    std::unique_lock lock(mutex_);
    // A moment for others: every change of every job wakes this thread.
    if (stopped_.wait_for(lock, milliseconds(sent ? 0 : 20), [this] { return stopping_; })) return;
  }
}

bool WebhookSender::send_next() {
  const auto delivery = jobs_.store().claim_delivery(kClaim);
  if (!delivery) return false;
  // Nobody is told of an end that a failure of the machine might undo.
  jobs_.make_durable();
  const auto job = jobs_.find(delivery->job_id);
  if (!job) return true;  // deleted, and its message with it
  const std::string fault = post(*delivery, *job);
  const auto tries = static_cast<std::size_t>(delivery->tries);
  const bool again = !fault.empty() && tries < kPauses.size();
  const char* outcome = fault.empty() ? "delivered" : again ? "failed" : "given_up";
  metrics_.count("symcell_webhooks_total", {{"outcome", outcome}});
  logger_.log(fault.empty() ? LogLevel::kInfo : LogLevel::kWarning, "webhook",
              {{"job", std::string_view(job->id)},
               {"outcome", outcome},
               {"what", std::string_view(fault)},
               {"tries", static_cast<std::int64_t>(tries + 1)},
               {"trace", trace_id_of(job->traceparent)}});
  if (fault.empty()) {
    jobs_.store().delivered(job->id);
  } else if (again) {
    jobs_.store().delivery_failed(job->id, milliseconds(kPauses[tries]));
  } else {
    jobs_.store().delivery_failed(job->id, std::nullopt);
  }
  jobs_.make_durable();
  return true;
}

std::string WebhookSender::post(const Delivery& delivery, const Job& job) const {
  const auto target = parse_webhook_target(delivery.address);
  if (!target) return "not an address";
  std::string fault;
  // Resolved once, looked at, and that very address connected to: a name may mean another a moment
  // later.
  const auto address = rules_.resolve(*target, fault);
  if (!address) return fault;
  nlohmann::ordered_json document;
  document["type"] = "job.finished";
  document["timestamp"] = format_timestamp(job.finished_ms.value_or(now_ms()));
  document["data"] = job_document(job, jobs_, JobDetail::kSummary);
  const std::string body =
      document.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  const std::string timestamp = std::to_string(now_ms() / 1000);
  const bool six = target->host.find(':') != std::string::npos;
  httplib::Client client((target->tls ? "https://" : "http://") +
                         (six ? "[" + target->host + "]" : target->host) + ":" +
                         std::to_string(target->port));
  client.set_hostname_addr_map({{target->host, *address}});
  client.set_follow_location(false);
  client.set_connection_timeout(kPatienceSeconds);
  client.set_read_timeout(kPatienceSeconds);
  client.set_write_timeout(kPatienceSeconds);
  // The answer is of no interest, and need not end.
  std::size_t got = 0;
  httplib::Request request;
  request.method = "POST";
  request.path = target->path;
  request.headers = headers_of(settings_.secret, job, timestamp, body);
  request.headers.emplace("Content-Type", "application/json");
  request.body = body;
  request.content_receiver = [&](const char*, std::size_t size, std::uint64_t, std::uint64_t) {
    got += size;
    return got < kMostAnswerBytes;
  };
  int status = 0;
  request.response_handler = [&](const httplib::Response& response) {
    status = response.status;
    return true;
  };
  const auto answer = client.send(request);
  if (status == 0) return "no answer: " + httplib::to_string(answer.error());
  return status >= 200 && status < 300 ? std::string() : "answered " + std::to_string(status);
}

}  // namespace symcell::server
