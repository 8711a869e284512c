// Tells whoever asked for it that a job has ended: a POST with the job's document, signed by the
// scheme of Standard Webhooks.
//
// What is to be sent stands in the job store from the moment the job's end does, so that a death of
// the server loses no message; one may come twice, with the same webhook-id. What fails is tried
// again with longer and longer pauses, over some two days.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "server/base/log.hpp"
#include "server/base/metrics.hpp"
#include "server/http/webhook_rules.hpp"
#include "server/jobs/job_service.hpp"

namespace symcell::server {

class WebhookSender {
 public:
  // All must outlive the sender.
  WebhookSender(WebhookSettings settings,
                const WebhookRules& rules,
                JobService& jobs,
                Metrics& metrics,
                Logger& logger);
  ~WebhookSender();

  // Nothing is sent where there is no secret.
  void start();
  void stop();

 private:
  void work();
  // False: nothing was due.
  bool send_next();
  // Empty: it arrived.
  [[nodiscard]] std::string post(const Delivery& delivery, const Job& job) const;

  WebhookSettings settings_;
  const WebhookRules& rules_;
  JobService& jobs_;
  Metrics& metrics_;
  Logger& logger_;
  std::mutex mutex_;  // guards stopping_
  std::condition_variable stopped_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace symcell::server
