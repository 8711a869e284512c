// Connections to a PostgreSQL database, as many as are needed at once up to a number, and renewed when
// they break.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <pqxx/pqxx>
#include <string>
#include <vector>

#include "server/jobs/job_store.hpp"

namespace symcell::server {

// Says what a failure of the database means. Rethrows what is none.
[[noreturn]] void throw_store_error(const std::exception& exception);

class PostgresConnections {
 public:
  // `url`: postgres:// or postgresql://. Limits on waiting are added to it: a network that is cut is
  // noticed within seconds.
  explicit PostgresConnections(const std::string& url, std::size_t most = 16);

  // What `work` returns, in a transaction that is committed after it. Nothing is done twice; a
  // connection that broke meanwhile is an error, and may be asked again.
  template <class Work>
  auto transact(const Work& work) {
    try {
      Lease lease(*this);
      pqxx::work transaction(lease.connection());
      if constexpr (std::is_void_v<decltype(work(transaction))>) {
        work(transaction);
        transaction.commit();
      } else {
        auto result = work(transaction);
        transaction.commit();
        return result;
      }
    } catch (const StoreError&) {
      throw;
    } catch (const std::exception& exception) {
      throw_store_error(exception);
    }
  }

  // One more, for who listens.
  [[nodiscard]] std::unique_ptr<pqxx::connection> open() const;

 private:
  // A connection while somebody uses it; broken ones are not given back.
  class Lease {
   public:
    explicit Lease(PostgresConnections& owner) : owner_(owner), connection_(owner.take()) {}
    ~Lease() { owner_.give_back(std::move(connection_)); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;

    [[nodiscard]] pqxx::connection& connection() { return *connection_; }

   private:
    PostgresConnections& owner_;
    std::unique_ptr<pqxx::connection> connection_;
  };

  std::unique_ptr<pqxx::connection> take();
  void give_back(std::unique_ptr<pqxx::connection> connection);

  const std::string url_;
  const std::size_t most_;
  std::mutex mutex_;  // guards all below
  std::condition_variable free_;
  std::vector<std::unique_ptr<pqxx::connection>> idle_;
  std::size_t used_ = 0;
};

// Brings the tables to this program's version, one server at a time. Throws std::runtime_error if they
// are of a newer one.
void migrate_postgres(PostgresConnections& connections);

}  // namespace symcell::server
