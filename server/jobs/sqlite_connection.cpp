#include "server/jobs/sqlite_connection.hpp"

#include <exception>

namespace symcell::server {

SQLite::Statement& SqliteConnection::statement(const std::string& sql) {
  auto& kept = statements_[sql];
  if (!kept) kept = std::make_unique<SQLite::Statement>(*this, sql);
  return *kept;
}

Prepared::~Prepared() {
  // Tells again of a failure that exec() or step() have thrown already.
  statement_.tryReset();
  try {
    statement_.clearBindings();
  } catch (const std::exception&) {
    // Fails for no statement that could be bound to.
  }
}

}  // namespace symcell::server
