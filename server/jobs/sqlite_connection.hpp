// A connection to an SQLite database that keeps its statements: to read one's text takes longer than to run it.
// One thread at a time.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <memory>
#include <string>
#include <unordered_map>

namespace symcell::server {

class SqliteConnection : public SQLite::Database {
 public:
  using SQLite::Database::Database;

 private:
  friend class Prepared;
  [[nodiscard]] SQLite::Statement& statement(const std::string& sql);

  std::unordered_map<std::string, std::unique_ptr<SQLite::Statement>> statements_;
};

// A statement of the connection while it is used. No other of the same text may be used meanwhile.
class Prepared {
 public:
  Prepared(SqliteConnection& connection, const std::string& sql)
      : statement_(connection.statement(sql)) {}
  // Its read ends, and nothing that was bound is kept.
  ~Prepared();
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;

  template <class Value>
  void bind(int place, const Value& value) {
    statement_.bind(place, value);
  }
  // Without a copy: `bytes` must outlive the use of the statement.
  void bind_blob(int place, const std::string& bytes) {
    statement_.bindNoCopy(place, bytes.data(), static_cast<int>(bytes.size()));
  }
  int exec() { return statement_.exec(); }
  bool step() { return statement_.executeStep(); }
  void reset() { statement_.reset(); }
  [[nodiscard]] SQLite::Column column(int index) const { return statement_.getColumn(index); }

 private:
  SQLite::Statement& statement_;
};

}  // namespace symcell::server
