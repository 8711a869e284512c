#include "tests/unit/server/postgres_server.hpp"

#include <unistd.h>

#include <cstdlib>
#include <pqxx/pqxx>

#include "server/base/identifiers.hpp"

namespace symcell::server::test {
namespace {

namespace fs = std::filesystem;

std::filesystem::path newest_programs() {
  fs::path found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/usr/lib/postgresql", error)) {
    if (fs::exists(entry.path() / "bin" / "initdb")) found = std::max(found, entry.path() / "bin");
  }
  return found;
}

bool ran(const std::string& command) {
  return std::system(command.c_str()) == 0;
}

}  // namespace

PostgresServer* PostgresServer::instance() {
  static const std::unique_ptr<PostgresServer> server = [] {
    std::unique_ptr<PostgresServer> made(new PostgresServer);
    if (!made->start()) made.reset();
    return made;
  }();
  return server.get();
}

// It does not run as root.
std::string PostgresServer::as_user(const std::string& command) const {
  const std::string quiet = " > " + (folder_ / "log").string() + " 2>&1";
  if (::geteuid() != 0) return command + quiet;
  return "setpriv --reuid nobody --clear-groups " + command + quiet;
}

bool PostgresServer::start() {
  programs_ = newest_programs();
  if (programs_.empty()) return false;
  // Short: a socket's path has 107 characters at most.
  folder_ = fs::path("/tmp") / ("symcell-pg-" + make_random_hex());
  fs::create_directory(folder_);
  fs::permissions(folder_, fs::perms::all);
  const std::string data = (folder_ / "data").string();
  const std::string control = (programs_ / "pg_ctl").string() + " -D " + data;
  return ran("cd / && " + as_user((programs_ / "initdb").string() + " -D " + data +
                                  " -U symcell -A trust --no-sync -E UTF8")) &&
         ran("cd / && " + as_user(control + " -w -o \"-k " + folder_.string() +
                                  " -c listen_addresses= -c fsync=off\" start"));
}

PostgresServer::~PostgresServer() {
  if (folder_.empty()) return;
  static_cast<void>(ran("cd / && " + as_user((programs_ / "pg_ctl").string() + " -D " +
                                             (folder_ / "data").string() + " -m immediate stop")));
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

std::string PostgresServer::url() const {
  return "postgresql:///postgres?host=" + folder_.string() + "&user=symcell";
}

void PostgresServer::clear() const {
  pqxx::connection connection(url());
  pqxx::work transaction(connection);
  transaction.exec("DROP SCHEMA public CASCADE; CREATE SCHEMA public");
  transaction.commit();
}

}  // namespace symcell::server::test
