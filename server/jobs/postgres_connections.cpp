#include "server/jobs/postgres_connections.hpp"

#include <stdexcept>
#include <string_view>

namespace symcell::server {
namespace {

// How long somebody waits for a connection that others use.
constexpr std::chrono::seconds kPatience{5};

// Seconds and milliseconds after which a dead network is taken for dead.
constexpr std::string_view kNetworkLimits =
    "connect_timeout=5&keepalives_idle=5&keepalives_interval=2&keepalives_count=3&"
    "tcp_user_timeout=10000&application_name=symcell&"
    // In milliseconds. Not set by statements: a connection that is made again by itself would lose them.
    "options=-c%20statement_timeout%3D10000%20-c%20lock_timeout%3D5000%20-c%20"
    "idle_in_transaction_session_timeout%3D30000";

std::string with_limits(const std::string& url) {
  return url + (url.find('?') == std::string::npos ? "?" : "&") + std::string(kNetworkLimits);
}

StoreError::Kind kind_of(const pqxx::sql_error& error) {
  const std::string state = error.sqlstate();
  if (state == "53100" || state == "53200") return StoreError::Kind::kFull;
  if (state.starts_with("XX")) return StoreError::Kind::kDamaged;
  // Deadlocks, conflicts, locks, cancelled statements, a server that starts or stops.
  if (state.starts_with("40") || state.starts_with("55") || state.starts_with("57")) {
    return StoreError::Kind::kBusy;
  }
  return StoreError::Kind::kOther;
}

}  // namespace

void throw_store_error(const std::exception& exception) {
  if (const auto* sql = dynamic_cast<const pqxx::sql_error*>(&exception)) {
    throw StoreError(kind_of(*sql), sql->what());
  }
  if (dynamic_cast<const pqxx::failure*>(&exception) != nullptr) {
    throw StoreError(StoreError::Kind::kBusy, exception.what());
  }
  throw std::runtime_error(exception.what());
}

PostgresConnections::PostgresConnections(const std::string& url, std::size_t most)
    : url_(with_limits(url)), most_(most) {
}

std::unique_ptr<pqxx::connection> PostgresConnections::open() const {
  return std::make_unique<pqxx::connection>(url_);
}

std::unique_ptr<pqxx::connection> PostgresConnections::take() {
  {
    std::unique_lock lock(mutex_);
    if (!free_.wait_for(lock, kPatience, [this] { return !idle_.empty() || used_ < most_; })) {
      throw StoreError(StoreError::Kind::kBusy, "all connections to the database are in use");
    }
    ++used_;
    if (!idle_.empty()) {
      auto connection = std::move(idle_.back());
      idle_.pop_back();
      return connection;
    }
  }
  try {
    return open();
  } catch (...) {
    give_back(nullptr);
    throw;
  }
}

void PostgresConnections::give_back(std::unique_ptr<pqxx::connection> connection) {
  {
    const std::lock_guard lock(mutex_);
    --used_;
    if (connection && connection->is_open()) idle_.push_back(std::move(connection));
  }
  free_.notify_one();
}

}  // namespace symcell::server
