// Who calls, and whether he may: every call of the service's own addresses passes here before its
// handler sees it.
//
// A key comes as `Authorization: Bearer KEY` or `X-API-Key: KEY`. Where keys are required a call
// without one is refused; a wrong one is refused everywhere. Jobs of others do not exist for a key
// without the scope admin.
#pragma once

#include <string>
#include <string_view>

#include "server/base/log.hpp"
#include "server/base/metrics.hpp"
#include "server/jobs/job_service.hpp"

namespace symcell::server {

struct Call;

struct AccessRules {
  bool require_key =
      false;  // also where only this machine can reach the server, behind a proxy say
  bool insecure_open = false;  // never
};

class Gate {
 public:
  // `host`: the address listened on. Keys are required where that is not a loopback address, and as
  // soon as there are any.
  Gate(const AccessRules& rules,
       const std::string& host,
       JobService& jobs,
       Metrics& metrics,
       Logger& logger);

  // False: the call is answered. `route`: the template that fits the path.
  [[nodiscard]] bool admit(Call& call, std::string_view route) const;
  [[nodiscard]] bool key_required() const;

 private:
  [[nodiscard]] bool identify(Call& call) const;
  [[nodiscard]] bool check_scope(Call& call, std::string_view route) const;
  [[nodiscard]] bool check_rate(Call& call) const;
  [[nodiscard]] bool check_job(Call& call, std::string_view route) const;
  void note_refusal(const Call& call, std::string_view why) const;

  AccessRules rules_;
  bool loopback_;
  JobService& jobs_;
  Metrics& metrics_;
  Logger& logger_;
};

}  // namespace symcell::server
