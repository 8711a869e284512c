// A PostgreSQL server of Debian's for the tests of one program, on a Unix socket in a folder of its own.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "tests/support/test_files.hpp"

namespace symcell::server::test {

class PostgresServer {
 public:
  // The one that all tests of the program use; null where none is installed or it does not start.
  [[nodiscard]] static PostgresServer* instance();

  ~PostgresServer();
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  [[nodiscard]] std::string url() const;
  // Drops all tables.
  void clear() const;

 private:
  PostgresServer() = default;
  [[nodiscard]] bool start();
  [[nodiscard]] std::string as_user(const std::string& command) const;

  std::filesystem::path folder_;
  std::filesystem::path programs_;
};

}  // namespace symcell::server::test
