#include "server/cli/keys_command.hpp"

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "server/base/clock.hpp"
#include "server/base/fault_archive.hpp"
#include "server/base/log.hpp"
#include "server/jobs/data_directory.hpp"
#include "server/jobs/job_files.hpp"
#include "server/jobs/sqlite_job_store.hpp"
#include "server/keys/postgres_key_store.hpp"
#include "server/keys/sqlite_key_store.hpp"

namespace symcell {
namespace {

using server::ApiKey;
using server::KeyStore;

constexpr int kFailure = 1;
constexpr int kUsage = 2;

struct KeysFlags {
  std::string store;
  std::string data_dir;
  std::string name;
  std::string scopes = "submit,read";
  std::string id;
  server::KeyLimits limits;
  std::int32_t priority = 1;
};

// A running server has the directory; then only its database is opened.
std::unique_ptr<KeyStore> open_keys(const KeysFlags& flags) {
  if (!flags.store.empty()) return std::make_unique<server::PostgresKeyStore>(flags.store);
  const std::filesystem::path directory = flags.data_dir.empty()
                                              ? server::default_state_directory()
                                              : std::filesystem::path(flags.data_dir);
  if (directory.empty()) {
    throw std::runtime_error("no place for data: set --data-dir, XDG_STATE_HOME or HOME");
  }
  server::Logger logger(server::LogLevel::kWarning, server::LogFormat::kText);
  try {
    const server::DataDirectory own(directory, logger);
    const server::JobFiles files(own.path());
    // Makes the database where there is none.
    const server::SqliteJobStore jobs(files.database(), own.id());
    return std::make_unique<server::SqliteKeyStore>(files.database(), true);
  } catch (const server::DirectoryInUse&) {
    return std::make_unique<server::SqliteKeyStore>(directory / "jobs.sqlite", false);
  }
}

int create(const KeysFlags& flags) {
  const auto scopes = server::parse_scopes(flags.scopes);
  if (!scopes) {
    std::cerr << "symcell keys: scopes are submit, read and admin, with commas between them\n";
    return kUsage;
  }
  const server::NewKey made = server::make_key();
  ApiKey key;
  key.id = made.id;
  key.name = flags.name;
  key.hash = made.hash;
  key.scopes = *scopes;
  key.limits = flags.limits;
  key.priority = flags.priority;
  key.created_ms = server::now_ms();
  open_keys(flags)->insert(key);
  std::cerr << "symcell keys: key " << made.id << " of \"" << flags.name
            << "\" is made; it is shown this once:\n";
  std::cout << made.text << std::endl;
  return 0;
}

int list(const KeysFlags& flags) {
  for (const ApiKey& key : open_keys(flags)->list()) {
    std::cout << key.id << "  " << server::format_timestamp(key.created_ms) << "  "
              << server::scopes_text(key.scopes) << "  priority " << key.priority;
    const auto limit = [](const char* what, std::int64_t value) {
      if (value != 0) std::cout << ", " << what << " " << value;
    };
    limit("waiting jobs", key.limits.queued);
    limit("running jobs", key.limits.running);
    limit("bytes a day", key.limits.bytes_per_day);
    limit("requests a minute", key.limits.requests_per_minute);
    if (key.revoked_ms) std::cout << "  revoked " << server::format_timestamp(*key.revoked_ms);
    std::cout << "  " << key.name << "\n";
  }
  return 0;
}

int revoke(const KeysFlags& flags) {
  if (open_keys(flags)->revoke(flags.id, server::now_ms())) {
    std::cerr << "symcell keys: " << flags.id << " is revoked; servers refuse it within a second\n";
    return 0;
  }
  std::cerr << "symcell keys: there is no key " << flags.id << "\n";
  return kFailure;
}

int guarded(int (*command)(const KeysFlags&), const KeysFlags& flags) {
  try {
    return command(flags);
  } catch (const std::exception& exception) {
    std::cerr << "symcell keys: " << exception.what() << "\n";
    return kFailure;
  }
}

void add_limits(CLI::App& command, KeysFlags& flags) {
  command.add_option("--max-queued", flags.limits.queued, "Jobs that may wait; 0: no limit")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--max-running", flags.limits.running, "Jobs at once; 0: no limit")
      ->check(CLI::NonNegativeNumber);
  command
      .add_option("--bytes-per-day", flags.limits.bytes_per_day,
                  "Bytes of models a day (UTC), also as 1GiB; 0: no limit")
      ->transform(CLI::AsSizeValue(false));
  command
      .add_option("--requests-per-minute", flags.limits.requests_per_minute,
                  "Calls a minute, of each server; 0: no limit")
      ->check(CLI::Range(0, 1'000'000));
  command
      .add_option("--priority", flags.priority,
                  "Jobs for one of a key of priority 1, while both wait")
      ->check(CLI::Range(1, server::kMostPriority))
      ->capture_default_str();
}

}  // namespace

void add_keys_command(CLI::App& app, int& exit_code) {
  auto* command =
      app.add_subcommand("keys", "Make, list and revoke the keys of a server's callers");
  command->require_subcommand(1);
  const auto flags = std::make_shared<KeysFlags>();
  auto* make = command->add_subcommand("create", "Make a key and print it");
  make->add_option("--name", flags->name, "Whose it is")->required();
  make->add_option("--scope", flags->scopes,
                   "submit, read, admin, with commas between them; admin includes the others")
      ->capture_default_str();
  add_limits(*make, *flags);
  auto* show = command->add_subcommand("list", "List all keys, revoked ones too");
  auto* end = command->add_subcommand("revoke", "Make a key worthless");
  end->add_option("id", flags->id, "As the list has it")->required();
  for (CLI::App* each : {make, show, end}) {
    each->add_option("--data-dir", flags->data_dir, "Of the server; default as for serve")
        ->envname("SYMCELL_DATA_DIR");
    each->add_option("--store", flags->store, "postgres://..., where the server has that")
        ->envname("SYMCELL_STORE");
  }
  make->callback([flags, &exit_code] { exit_code = guarded(create, *flags); });
  show->callback([flags, &exit_code] { exit_code = guarded(list, *flags); });
  end->callback([flags, &exit_code] { exit_code = guarded(revoke, *flags); });
}

}  // namespace symcell
