#include "server/cli/serve_command.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "api/version.hpp"
#include "server/base/fault_archive.hpp"
#include "server/base/files.hpp"
#include "server/base/log.hpp"
#include "server/http/service.hpp"
#include "server/worker/worker_engine.hpp"

namespace symcell {
namespace {

using server::LogFormat;
using server::Logger;
using server::LogLevel;

constexpr int kUsage = 2;
constexpr int kFailure = 1;

// What the flags say, before it becomes settings.
struct ServeFlags {
  std::string host = "127.0.0.1";
  int port = 8080;
  std::string port_file;
  std::string data_dir;
  std::string store;
  std::string role = "all";
  std::size_t workers = std::max(1U, std::thread::hardware_concurrency());
  std::size_t http_threads = 16;
  std::size_t patient_threads = 512;
  std::size_t max_waiting = 4096;
  std::size_t max_connections = 4096;
  std::size_t max_connections_per_client = 1024;
  std::size_t queue_limit = 100;
  std::size_t max_body_bytes = 512UL << 20U;
  std::uint64_t max_elements = 10'000'000;
  double time_limit_s = 3600;
  std::uint64_t worker_memory_bytes = std::uint64_t{4} << 30U;
  std::uint64_t cpu_limit_s = 0;
  std::size_t worker_jobs = 200;
  double grace_s = 10;
  std::string log_level = "info";
  std::string log_format = "text";
  std::vector<std::string> cors_origins;
  bool require_key = false;
  bool insecure_open = false;
  std::string tls_certificate;
  std::string tls_key;
  std::vector<std::string> webhook_hosts;
  std::string webhook_secret_file;
  bool webhook_private = false;
  std::vector<std::string> allowed_hosts;
  std::int64_t retention_hours = 24L * 7;
  std::int64_t retention_jobs = 10'000;
  std::int64_t retention_bytes = std::int64_t{20} << 30U;
  std::int64_t failed_model_hours = 24;
};

void add_network_flags(CLI::App& command, ServeFlags& flags) {
  command.add_option("--host", flags.host, "Address to listen on; 0.0.0.0: every one")
      ->envname("SYMCELL_HOST")
      ->capture_default_str();
  command.add_option("--port", flags.port, "Port; 0: any free one, which is logged")
      ->envname("SYMCELL_PORT")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command.add_option("--port-file", flags.port_file, "File that gets the port once it is open")
      ->envname("SYMCELL_PORT_FILE");
  command.add_option("--http-threads", flags.http_threads, "Short requests answered at once")
      ->envname("SYMCELL_HTTP_THREADS")
      ->check(CLI::Range(2, 1024))
      ->capture_default_str();
  command
      .add_option("--patient-threads", flags.patient_threads,
                  "Requests at once that wait for their client: uploads, downloads")
      ->envname("SYMCELL_PATIENT_THREADS")
      ->check(CLI::Range(2, 8192))
      ->capture_default_str();
  command
      .add_option("--max-waiting", flags.max_waiting,
                  "Event streams and calls that wait for a job, at once; no client gets more than "
                  "half of them. They take no thread")
      ->envname("SYMCELL_MAX_WAITING")
      ->check(CLI::Range(2, 1'000'000))
      ->capture_default_str();
  command
      .add_option("--max-connections", flags.max_connections,
                  "Connections open at once, idle ones included")
      ->envname("SYMCELL_MAX_CONNECTIONS")
      ->check(CLI::Range(10, 100'000))
      ->capture_default_str();
  command
      .add_option("--max-connections-per-client", flags.max_connections_per_client,
                  "Of one address; a proxy counts as one client")
      ->envname("SYMCELL_MAX_CONNECTIONS_PER_CLIENT")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  command
      .add_option("--max-body-bytes", flags.max_body_bytes,
                  "Largest request body, after decompression too")
      ->envname("SYMCELL_MAX_BODY_BYTES")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1} << 40U))
      ->capture_default_str();
  command
      .add_option("--cors-origin", flags.cors_origins,
                  "Origins whose pages may call the service, with commas between them, or *; "
                  "default: none")
      ->envname("SYMCELL_CORS_ORIGIN")
      ->delimiter(',');
  command
      .add_option("--allowed-host", flags.allowed_hosts,
                  "Names, with commas between them, that the service may be reached under besides "
                  "localhost and the address it listens on, or *")
      ->envname("SYMCELL_ALLOWED_HOST")
      ->delimiter(',');
}

void add_access_flags(CLI::App& command, ServeFlags& flags) {
  command
      .add_flag("--require-key", flags.require_key,
                "Ask every caller for an API key, also on a loopback address; so it is anyway as "
                "soon as there is a key, and on other addresses")
      ->envname("SYMCELL_REQUIRE_KEY");
  command
      .add_flag("--insecure-open", flags.insecure_open,
                "Serve whoever reaches the port, without a key, on any address")
      ->envname("SYMCELL_INSECURE_OPEN")
      ->excludes("--require-key");
  command
      .add_option("--tls-certificate", flags.tls_certificate,
                  "Serve over TLS: file with the certificate and its chain, PEM; read again on "
                  "SIGHUP")
      ->envname("SYMCELL_TLS_CERTIFICATE");
  command.add_option("--tls-key", flags.tls_key, "File with the certificate's private key, PEM")
      ->envname("SYMCELL_TLS_KEY");
  command
      .add_option("--webhook-host", flags.webhook_hosts,
                  "Hosts, with commas between them, that may be told of finished jobs; *.name: all "
                  "below it, *: any; default: none")
      ->envname("SYMCELL_WEBHOOK_HOST")
      ->delimiter(',');
  command
      .add_option("--webhook-secret-file", flags.webhook_secret_file,
                  "File with the secret that signs webhooks: whsec_ and base64")
      ->envname("SYMCELL_WEBHOOK_SECRET_FILE");
  command
      .add_flag("--webhook-private", flags.webhook_private,
                "Webhooks may go to private addresses, too")
      ->envname("SYMCELL_WEBHOOK_PRIVATE");
}

void add_job_flags(CLI::App& command, ServeFlags& flags) {
  command
      .add_option("--data-dir", flags.data_dir,
                  "Where jobs and results are kept; default: $XDG_STATE_HOME/symcell or "
                  "~/.local/state/symcell")
      ->envname("SYMCELL_DATA_DIR");
  command
      .add_option("--store", flags.store,
                  "postgres://USER:PASSWORD@HOST/DATABASE of servers that share their jobs; they "
                  "share --data-dir as well; default: a database in --data-dir")
      ->envname("SYMCELL_STORE");
  command
      .add_option("--role", flags.role,
                  "api: answers callers, and leaves meshing to others of the same --store; worker: "
                  "meshes, and answers probes alone; all")
      ->envname("SYMCELL_ROLE")
      ->check(CLI::IsMember({"all", "api", "worker"}))
      ->capture_default_str();
  command.add_option("--workers", flags.workers, "Jobs that run at once")
      ->envname("SYMCELL_WORKERS")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command.add_option("--queue-limit", flags.queue_limit, "Jobs that may wait; more get 429")
      ->envname("SYMCELL_QUEUE_LIMIT")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command.add_option("--max-elements", flags.max_elements, "Most elements of a symmetry cell")
      ->envname("SYMCELL_MAX_ELEMENTS")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--time-limit", flags.time_limit_s, "Seconds a job may run")
      ->envname("SYMCELL_TIME_LIMIT")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      .add_option("--grace", flags.grace_s,
                  "Seconds that running jobs get when the server stops; then they are left for the "
                  "next start")
      ->envname("SYMCELL_GRACE")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str();
}

void add_worker_flags(CLI::App& command, ServeFlags& flags) {
  command
      .add_option("--worker-memory", flags.worker_memory_bytes,
                  "Bytes that one worker process may take, also as 4GiB; 0: no limit")
      ->envname("SYMCELL_WORKER_MEMORY")
      ->transform(CLI::AsSizeValue(false))
      ->default_str("4GiB");
  command
      .add_option("--cpu-limit", flags.cpu_limit_s,
                  "Seconds of processor time a job may take; 0: as many as --time-limit")
      ->envname("SYMCELL_CPU_LIMIT")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      .add_option("--worker-jobs", flags.worker_jobs,
                  "Jobs that one worker process runs before a fresh one replaces it")
      ->envname("SYMCELL_WORKER_JOBS")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

void add_retention_flags(CLI::App& command, ServeFlags& flags) {
  command
      .add_option("--retention-hours", flags.retention_hours,
                  "Hours that finished jobs are kept; 0: for ever")
      ->envname("SYMCELL_RETENTION_HOURS")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  command
      .add_option("--retention-jobs", flags.retention_jobs, "Finished jobs that are kept; 0: all")
      ->envname("SYMCELL_RETENTION_JOBS")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      .add_option("--failed-model-hours", flags.failed_model_hours,
                  "Hours that models of jobs without a result are kept; 0: as long as the jobs")
      ->envname("SYMCELL_FAILED_MODEL_HOURS")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  command
      .add_option(
          "--retention-bytes", flags.retention_bytes,
          "Bytes of models and results above which the oldest finished jobs go; 0: no bound")
      ->envname("SYMCELL_RETENTION_BYTES")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

void add_log_flags(CLI::App& command, ServeFlags& flags) {
  command.add_option("--log-level", flags.log_level, "Least level that is logged")
      ->envname("SYMCELL_LOG_LEVEL")
      ->check(CLI::IsMember({"debug", "info", "warning", "error", "off"}))
      ->capture_default_str();
  command.add_option("--log-format", flags.log_format, "One line an event, as text or JSON")
      ->envname("SYMCELL_LOG_FORMAT")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
}

server::ServerRole role_of(const ServeFlags& flags) {
  if (flags.role == "api") return server::ServerRole::kApi;
  return flags.role == "worker" ? server::ServerRole::kWorker : server::ServerRole::kAll;
}

server::WebhookSettings webhook_settings_of(const ServeFlags& flags) {
  server::WebhookSettings settings{flags.webhook_hosts, flags.webhook_private, {}};
  if (flags.webhook_secret_file.empty()) return settings;
  std::ifstream file(flags.webhook_secret_file);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto secret = server::parse_webhook_secret(text);
  if (!secret) {
    throw std::runtime_error(
        flags.webhook_secret_file +
        " holds no secret for webhooks: whsec_ and base64 of 24 bytes or more");
  }
  settings.secret = *secret;
  return settings;
}

server::ServiceSettings settings_of(const ServeFlags& flags) {
  server::ServiceSettings settings;
  settings.http.host = flags.host;
  settings.http.port = flags.port;
  settings.http.threads = flags.http_threads;
  settings.http.patient_threads = flags.patient_threads;
  settings.http.max_waiting = flags.max_waiting;
  settings.http.lobby.connections = flags.max_connections;
  settings.http.lobby.connections_per_client = flags.max_connections_per_client;
  settings.http.max_body_bytes = flags.max_body_bytes;
  settings.http.cors_origins = flags.cors_origins;
  settings.http.allowed_hosts = flags.allowed_hosts;
  settings.role = role_of(flags);
  settings.jobs.workers = settings.role == server::ServerRole::kApi ? 0 : flags.workers;
  settings.jobs.store_url = flags.store;
  settings.jobs.queue_limit = flags.queue_limit;
  settings.jobs.time_limit_s = flags.time_limit_s;
  settings.jobs.max_elements = flags.max_elements;
  settings.jobs.retention = {flags.retention_hours * 3600, flags.retention_jobs,
                             flags.retention_bytes, flags.failed_model_hours * 3600};
  settings.access = {flags.require_key, flags.insecure_open};
  settings.http.tls = {flags.tls_certificate, flags.tls_key};
  settings.webhooks = webhook_settings_of(flags);
  settings.data_directory = flags.data_dir.empty() ? server::default_state_directory()
                                                   : std::filesystem::path(flags.data_dir);
  settings.grace = std::chrono::milliseconds(static_cast<std::int64_t>(flags.grace_s * 1000));
  return settings;
}

// Replaced as a whole: whoever waits for the file never reads half a number.
void write_port_file(const std::string& path, int port) {
  if (path.empty()) return;
  const std::string temporary = path + ".part";
  std::filesystem::remove(temporary);
  server::FileWriter file(temporary);
  file.write(std::to_string(port) + "\n");
  file.commit_as(std::filesystem::absolute(path));
}

server::WorkerSettings worker_settings_of(const ServeFlags& flags) {
  server::WorkerSettings settings;
  // One for an inspection; who leaves meshing to others reads models and inspects all the same.
  settings.pool.ahead = flags.role == "api" ? 2 : flags.workers + 1;
  settings.pool.requests_per_worker = flags.worker_jobs;
  settings.memory_bytes = flags.worker_memory_bytes;
  settings.cpu_seconds = flags.cpu_limit_s;
  return settings;
}

sigset_t stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGHUP);
  return signals;
}

// A parent may have closed standard input, output and error. Their numbers must not go to other
// files: a worker process gets its connection by them.
void open_standard_streams() {
  int descriptor = 0;
  do {
    descriptor = ::open("/dev/null", O_RDWR);
  } while (descriptor >= 0 && descriptor <= STDERR_FILENO);
  if (descriptor >= 0) ::close(descriptor);
}

// A connection is a file, and the usual limit of 1024 is there for programs that use select.
void raise_file_limit(std::size_t connections, Logger& logger) {
  constexpr rlim_t kOtherFiles = 512;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  const rlim_t wanted = connections + kOtherFiles;
  if (limit.rlim_cur >= wanted) return;
  limit.rlim_cur = std::min(wanted, limit.rlim_max);
  ::setrlimit(RLIMIT_NOFILE, &limit);
  if (limit.rlim_cur < wanted) {
    logger.warning("few_files_may_be_open",
                   {{"limit", static_cast<std::int64_t>(limit.rlim_cur)},
                    {"max_connections", static_cast<std::int64_t>(connections)}});
  }
}

std::uint64_t machine_memory_bytes() {
  const long pages = ::sysconf(_SC_PHYS_PAGES);
  const long page_bytes = ::sysconf(_SC_PAGESIZE);
  return pages > 0 && page_bytes > 0
             ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page_bytes)
             : 0;
}

// The kernel kills where memory runs out, and does not always choose the culprit.
void warn_of_memory(const ServeFlags& flags, Logger& logger) {
  const std::uint64_t machine = machine_memory_bytes();
  const bool fits = flags.worker_memory_bytes <= machine / flags.workers;
  if (machine == 0 || (flags.worker_memory_bytes != 0 && fits)) return;
  logger.warning("workers_may_exceed_memory",
                 {{"workers", static_cast<std::int64_t>(flags.workers)},
                  {"worker_memory", static_cast<std::int64_t>(flags.worker_memory_bytes)},
                  {"machine_memory", static_cast<std::int64_t>(machine)}});
}

// The signal that ends the server.
int wait_for_end(const sigset_t& signals, server::Service& service, Logger& logger) {
  while (true) {
    int signal = 0;
    sigwait(&signals, &signal);
    if (signal != SIGHUP) return signal;
    try {
      service.reload_tls();
      logger.info("reloaded");
    } catch (const std::exception& exception) {
      logger.error("not_reloaded", {{"what", exception.what()}});
    }
  }
}

// What is wrong with flags that are sound each by itself; empty: nothing.
std::string contradiction_in(const ServeFlags& flags) {
  if (flags.tls_certificate.empty() != flags.tls_key.empty()) {
    return "--tls-certificate and --tls-key go together";
  }
  if (!flags.webhook_hosts.empty() && flags.webhook_secret_file.empty()) {
    return "--webhook-host needs --webhook-secret-file, by which webhooks are signed";
  }
  if (!flags.store.empty() && !flags.store.starts_with("postgres://") &&
      !flags.store.starts_with("postgresql://")) {
    return "--store is postgres://...; without it the jobs are in --data-dir";
  }
  if (flags.role != "all" && flags.store.empty()) {
    return "--role " + flags.role + " needs a --store that others have as well";
  }
  return {};
}

int serve(const ServeFlags& flags) {
  if (const std::string fault = contradiction_in(flags); !fault.empty()) {
    std::cerr << "symcell serve: " << fault << "\n";
    return kUsage;
  }
  open_standard_streams();
  Logger logger(*server::log_level_from_name(flags.log_level),
                flags.log_format == "json" ? LogFormat::kJson : LogFormat::kText);
  const server::ServiceSettings settings = settings_of(flags);
  if (settings.data_directory.empty()) {
    std::cerr << "symcell serve: no place for data: set --data-dir, XDG_STATE_HOME or HOME\n";
    return kUsage;
  }
  // Blocked before any thread starts, so that every thread inherits it and sigwait gets them.
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  warn_of_memory(flags, logger);
  raise_file_limit(flags.max_connections, logger);
  server::WorkerEngine engine(worker_settings_of(flags), logger);
  auto service = std::make_unique<server::Service>(settings, engine, logger);
  const int port = service->start();
  write_port_file(flags.port_file, port);
  std::cout << "symcell: listening on " << (flags.tls_certificate.empty() ? "http://" : "https://")
            << settings.http.host << ":" << port << std::endl;
  const std::string data_directory = settings.data_directory.string();
  logger.info("listening", {{"host", settings.http.host},
                            {"port", std::int64_t{port}},
                            {"data_dir", data_directory},
                            {"role", std::string_view(flags.role)},
                            {"workers", static_cast<std::int64_t>(settings.jobs.workers)},
                            {"version", version()}});

  const int signal = wait_for_end(signals, *service, logger);
  logger.info("stopping", {{"signal", std::int64_t{signal}}});
  const bool joined = service->stop();
  logger.info("stopped");
  if (!joined) {
    // A job ignores its cancellation. It is stored and runs again at the next start; waiting for it
    // would make the stop hang, and destroying what its thread uses would crash.
    logger.warning("worker_left_behind");
    std::_Exit(0);
  }
  return 0;
}

}  // namespace

void add_serve_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("serve", "Serve meshing jobs over HTTP");
  const auto flags = std::make_shared<ServeFlags>();
  add_network_flags(*command, *flags);
  add_access_flags(*command, *flags);
  add_job_flags(*command, *flags);
  add_worker_flags(*command, *flags);
  add_retention_flags(*command, *flags);
  add_log_flags(*command, *flags);
  command->callback([flags, &exit_code] {
    try {
      exit_code = serve(*flags);
    } catch (const std::exception& exception) {
      std::cerr << "symcell serve: " << exception.what() << "\n";
      exit_code = kFailure;
    }
  });
}

}  // namespace symcell
