// Where messages about finished jobs may go. An address comes from whoever sends a model, and what is
// sent there is sent by this machine: hosts must be on the operator's list, and may not turn out to be
// addresses of his own network.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace symcell::server {

struct WebhookSettings {
  std::vector<std::string> hosts;  // that may be told, "*.part.example" too; "*": any; empty: none
  bool allow_private = false;      // also loopback, link-local and private addresses
  std::string secret;              // by which messages are signed, decoded
};

struct WebhookTarget {
  bool tls = false;
  std::string host;
  int port = 0;
  std::string path;  // with the query
};

class WebhookRules {
 public:
  explicit WebhookRules(const WebhookSettings& settings) : settings_(settings) {}

  // Why this address is not acceptable, for its sender; empty: it is.
  [[nodiscard]] std::string refusal_of(const std::string& address) const;
  // A numeric address of the host that may be connected to; nullopt with a reason in `fault`.
  [[nodiscard]] std::optional<std::string> resolve(const WebhookTarget& target,
                                                   std::string& fault) const;

 private:
  [[nodiscard]] bool allows_host(std::string_view host) const;

  WebhookSettings settings_;
};

// Only http and https, without user or fragment; nullopt: nothing of that kind.
[[nodiscard]] std::optional<WebhookTarget> parse_webhook_target(const std::string& address);
// A numeric address that lies in nobody's own network.
[[nodiscard]] bool is_public_address(const std::string& numeric);

// "whsec_" and base64, as Standard Webhooks has it; nullopt: not of that form, or under 24 bytes.
[[nodiscard]] std::optional<std::string> parse_webhook_secret(std::string_view text);
// The value of webhook-signature.
[[nodiscard]] std::string webhook_signature(const std::string& secret,
                                            const std::string& id,
                                            const std::string& timestamp,
                                            const std::string& body);

}  // namespace symcell::server
