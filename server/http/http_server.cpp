#include "server/http/http_server.hpp"

#include <fcntl.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "server/base/clock.hpp"
#include "server/base/identifiers.hpp"
#include "server/http/call.hpp"
#include "server/http/connection.hpp"
#include "server/http/crew.hpp"
#include "server/http/problem_response.hpp"
#include "server/http/site_policy.hpp"
#include "server/http/stop_signal.hpp"
#include "server/jobs/job.hpp"

namespace symcell::server {
namespace {

constexpr int kListenBacklog = 511;
constexpr std::size_t kMaxKeepAliveRequests = 1000;
constexpr std::size_t kProbeThreads = 2;
constexpr std::size_t kMostQueuedProbes = 256;
// That tell those who wait of their jobs. What they send is short, but a client may not read it.
constexpr std::size_t kResumingThreads = 16;
// What httplib reads where a call goes on whose request it has read before.
constexpr std::string_view kResumption = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";
// Ends of addresses whose answers are as long as a client is slow.
constexpr std::array kStreamedEnds{"/cell", "/full", "/model", "/statistics", "/v1/inspect"};
// What a form has besides its model; the body reader counts exactly.
constexpr std::size_t kFormOverheadBytes = 128UL * 1024;
// For requests under way when the server stops; the jobs have had their grace period before.
constexpr std::chrono::seconds kStopPatience{3};

// httplib's handlers get no data of the caller's; the thread that serves a connection leaves the
// exchange here.
thread_local Exchange* current_exchange = nullptr;

// Ids from outside go to logs and headers: only what can do no harm there.
bool is_usable_request_id(std::string_view id) {
  return !id.empty() && id.size() <= 128 && std::ranges::all_of(id, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  });
}

std::string take_header(httplib::Request& request, const char* name) {
  std::string value = request.get_header_value(name);
  request.headers.erase(name);
  return value;
}

}  // namespace

class HttpServer::Impl final : public httplib::Server {
 public:
  Impl(const HttpSettings& settings,
       const Router& router,
       Metrics& metrics,
       Logger& logger,
       std::atomic<std::size_t>& in_flight)
      : settings_(settings),
        router_(router),
        metrics_(metrics),
        logger_(logger),
        in_flight_(in_flight),
        sites_(settings.host, settings.allowed_hosts, settings.cors_origins),
        tls_(settings.tls.certificate.empty() ? nullptr
                                              : std::make_unique<TlsContext>(settings.tls)),
        lobby_(
            settings.lobby,
            [this](const std::shared_ptr<Connection>& connection) { return take(connection); },
            [this] { return refusal(); },
            tls_.get()),
        // A connection has one request at most that waits for a thread.
        quick_(settings.threads, settings.lobby.connections),
        patient_(settings.patient_threads, 0) {
    // A second line only: the body reader counts exactly, and forms need some room for headers.
    set_payload_max_length(settings_.max_body_bytes + (1UL << 20U));
    // SO_REUSEPORT, httplib's default, would let two servers share the port unnoticed.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
    set_tcp_nodelay(true);
    set_headers();
    set_handlers();
  }

  ~Impl() override {
    stop_accepting();
    if (listening_ != INVALID_SOCKET) ::close(listening_);
  }

  int bind() {
    const int port = settings_.port == 0 ? bind_to_any_port(settings_.host)
                     : bind_to_port(settings_.host, settings_.port) ? settings_.port
                                                                    : -1;
    if (port < 0) {
      throw std::runtime_error("cannot listen on " + settings_.host + ":" +
                               std::to_string(settings_.port));
    }
    // httplib's backlog of 5 refuses connections under the lightest burst.
    listening_ = svr_sock_;
    ::listen(listening_, kListenBacklog);
    ::fcntl(listening_, F_SETFL, ::fcntl(listening_, F_GETFL) | O_NONBLOCK);
    return port;
  }

  // Instead of httplib's own loop, which gives every connection a thread.
  void run() {
    lobby_.run(listening_);
    for (Crew* crew : {&quick_, &patient_, &probes_}) crew->shutdown();
    suspended_.shutdown();
    lobby_.finish(kStopPatience);
  }

  // httplib looks at its socket to see whether a stream should end.
  void stop_accepting() {
    if (svr_sock_.exchange(INVALID_SOCKET) == INVALID_SOCKET) return;
    ::shutdown(listening_, SHUT_RDWR);
    lobby_.stop();
  }

  void reload_tls() {
    if (tls_) tls_->reload();
  }

  void stop_connections() { stop_.raise(kStopPatience); }

 private:
  void set_headers() {
    httplib::Headers headers{
        {"X-Content-Type-Options", "nosniff"},
        {"X-Frame-Options", "DENY"},
        {"Referrer-Policy", "no-referrer"},
        {"Content-Security-Policy",
         "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'none'"},
        {"Accept-Ranges", "none"},
    };
    if (!settings_.cors_origins.empty()) {
      headers.emplace("Access-Control-Allow-Methods", "GET, HEAD, POST, DELETE, OPTIONS");
      headers.emplace("Access-Control-Max-Age", "600");
      headers.emplace(
          "Access-Control-Allow-Headers",
          "Content-Type, Content-Encoding, Prefer, Idempotency-Key, If-None-Match, "
          "If-Range, Range, Webhook-Url, traceparent, X-Request-Id, Authorization, X-API-Key");
      headers.emplace("Access-Control-Expose-Headers",
                      "Location, ETag, Retry-After, X-Request-Id, Content-Disposition, "
                      "Content-Range, RateLimit, "
                      "RateLimit-Policy");
      headers.emplace("Vary", "Origin");
    }
    set_default_headers(std::move(headers));
  }

  void set_handlers() {
    const Handler plain = [this](const httplib::Request& request, httplib::Response& response) {
      dispatch(request, response, nullptr);
    };
    const HandlerWithContentReader with_body =
        [this](const httplib::Request& request, httplib::Response& response,
               const httplib::ContentReader& reader) { dispatch(request, response, &reader); };
    const std::string everything = "[\\s\\S]*";
    Get(everything, plain);
    Options(everything, plain);
    // The form with a reader also where no body is wanted: otherwise httplib reads any body whole
    // into memory first.
    Post(everything, with_body);
    Put(everything, with_body);
    Patch(everything, with_body);
    Delete(everything, with_body);
    // httplib has no place for handlers of these; the router tells which methods an address takes.
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      if (request.method != "TRACE" && request.method != "CONNECT") {
        return HandlerResponse::Unhandled;
      }
      dispatch(request, response, nullptr);
      return HandlerResponse::Handled;
    });
    // Asked before the body is sent: a client that waits for the answer need not send what is refused.
    set_expect_100_continue_handler(
        [this](const httplib::Request& request, httplib::Response& response) {
          constexpr int kContinue = 100;
          if (current_exchange->declared_bytes <= settings_.max_body_bytes + kFormOverheadBytes) {
            return kContinue;
          }
          current_exchange->close = true;
          const ServiceProblem problem = ServiceProblem::kBodyTooLarge;
          response.status = service_problem_row(problem).http_status;
          response.set_header("Connection", "close");
          response.set_content(
              service_problem_json(problem,
                                   "the body may have " + std::to_string(settings_.max_body_bytes) +
                                       " bytes at most, after decompression too",
                                   request.path),
              "application/problem+json");
          return response.status;
        });
    set_error_handler([](const httplib::Request& request, httplib::Response& response) {
      if (current_exchange != nullptr && current_exchange->method.empty()) {
        // The headers were not understood: where the next request begins is anyone's guess.
        current_exchange->close = true;
        response.set_header("Connection", "close");
      }
      if (!response.body.empty()) return;
      // httplib refused by itself, before or after the dispatcher.
      const ServiceProblem problem = service_problem_for_status(response.status);
      response.set_content(
          service_problem_json(problem, service_problem_row(problem).title, request.path),
          "application/problem+json");
    });
    set_post_routing_handler([](const httplib::Request&, httplib::Response& response) {
      response.set_header("Date", format_http_date(now_ms()));
      // httplib adds a length of 0, which says something wrong about these.
      if (response.status == 204 || response.status == 304) {
        response.headers.erase("Content-Length");
      }
      if (current_exchange == nullptr) return;
      response.set_header("X-Request-Id", current_exchange->request_id);
      current_exchange->status = response.status;
    });
  }

  void dispatch(const httplib::Request& request,
                httplib::Response& response,
                const httplib::ContentReader* reader) {
    Exchange& exchange = *current_exchange;
    Call call{request, response, reader, exchange, parse_query(request.target), {}, {}};
    response.status = 200;
    const std::string shared = sites_.shared_with(call.header("Origin"));
    if (!shared.empty()) response.set_header("Access-Control-Allow-Origin", shared);
    if (exchange.resumed) {
      for (const auto& [name, value] : exchange.kept_headers) {
        if (!response.has_header(name)) response.set_header(name, value);
      }
      router_.resume(call, [&](Call& resumed) { exchange.suspended->answer(resumed); });
    } else if (check_site(call)) {
      router_.dispatch(call);
    }
    if (exchange.suspended && !exchange.resumed) {
      exchange.silent = true;
      exchange.kept_headers = response.headers;
    }
    if (exchange.body_expected && !exchange.body_consumed) exchange.close = true;
    if (exchange.close) response.set_header("Connection", "close");
    if (!call.error_code.empty()) {
      metrics_.count("symcell_request_errors_total", {{"code", call.error_code}});
    }
  }

  // True if the page that made a browser send this, if one did, may do so; else the call is
  // answered.
  bool check_site(Call& call) const {
    const std::string host = call.header("Host");
    const std::string& path = call.request.path;
    // Probes come under whatever name a balancer knows, and tell nothing.
    const bool probe = path == "/healthz" || path == "/readyz";
    if (!probe && !sites_.allows_host(host)) {
      respond_problem(call, ServiceProblem::kHostNotAllowed,
                      "this server is not reached as \"" + host +
                          "\"; if it is meant to be, start it with --allowed-host " + host);
      return false;
    }
    const std::string& method = call.request.method;
    if (method == "GET" || method == "HEAD" || method == "OPTIONS") return true;
    const std::string origin = call.header("Origin");
    if (sites_.allows_change(host, origin, call.header("Sec-Fetch-Site"))) return true;
    respond_problem(call, ServiceProblem::kCrossSite,
                    "a page of " + (origin.empty() ? std::string("another site") : origin) +
                        " asks for this; if it may, start the server with --cors-origin and its "
                        "origin");
    return false;
  }

  // Called by httplib once the headers are read.
  static void prepare(httplib::Request& request, Exchange& exchange) {
    if (exchange.resumed) {
      exchange.body_expected = false;
      return;
    }
    exchange.method = request.method;
    exchange.path = request.path;
    const std::string id = request.get_header_value("X-Request-Id");
    if (is_usable_request_id(id)) exchange.request_id = id;
    const std::string trace = request.get_header_value("traceparent");
    if (is_traceparent(trace)) exchange.traceparent = trace;
    // httplib would compress, and inflate without a bound, by itself.
    exchange.accept_encoding = take_header(request, "Accept-Encoding");
    exchange.content_encoding = take_header(request, "Content-Encoding");
    const std::string length = request.get_header_value("Content-Length");
    exchange.body_expected =
        request.has_header("Transfer-Encoding") || (!length.empty() && length != "0");
  }

  enum class Lane : std::uint8_t { kProbe, kQuick, kPatient };

  static Lane lane_of(const Connection& connection) {
    const RequestHead& head = connection.head.head();
    // Refused at once.
    if (connection.too_long || connection.head.fault().status != 0) return Lane::kQuick;
    const std::string_view target = head.target;
    const std::string_view path = target.substr(0, target.find('?'));
    if (path == "/healthz" || path == "/readyz" || path == "/metrics") return Lane::kProbe;
    const bool arrived = !head.chunked && !head.expects_continue &&
                         connection.bytes.size() >= connection.head.length() + head.content_length;
    const bool streams =
        std::ranges::any_of(kStreamedEnds, [&](const char* end) { return path.ends_with(end); });
    return arrived && !streams ? Lane::kQuick : Lane::kPatient;
  }

  // False: nobody is free.
  bool take(const std::shared_ptr<Connection>& connection) {
    Crew* crew = &quick_;
    switch (lane_of(*connection)) {
      case Lane::kProbe: crew = &probes_; break;
      case Lane::kQuick: break;
      case Lane::kPatient: crew = &patient_; break;
    }
    return crew->try_enqueue([this, connection] { serve(connection); });
  }

  void serve(const std::shared_ptr<Connection>& connection) {
    auto exchange = std::make_shared<Exchange>();
    exchange->request_id = make_random_hex();
    exchange->client = connection->client();
    exchange->declared_bytes = connection->head.head().content_length;
    exchange->range = connection->head.head().range;
    exchange->sent_before = connection->sent();
    const bool last = ++connection->served == kMaxKeepAliveRequests;
    go_on(connection, exchange, answer(*connection, *exchange, last));
  }

  // What becomes of a connection after httplib had it. `goes_on`: it can serve another request.
  void go_on(const std::shared_ptr<Connection>& connection,
             const std::shared_ptr<Exchange>& exchange,
             bool goes_on) {
    if (exchange->suspended && !exchange->resumed) {
      suspended_.add(exchange->suspended, connection, [this, connection, exchange, goes_on] {
        resume(connection, exchange, goes_on);
      });
    } else if (goes_on && !exchange->close) {
      lobby_.give_back(connection);  // which drops it where the server stops
    } else {
      lobby_.let_go(connection);
    }
  }

  // The call is over; unless it has sent all by itself, httplib writes its answer.
  void resume(const std::shared_ptr<Connection>& connection,
              const std::shared_ptr<Exchange>& exchange,
              bool goes_on) {
    exchange->resumed = true;
    if (!exchange->silent) {
      record(*exchange, connection->sent() - exchange->sent_before);
      lobby_.let_go(connection);
      return;
    }
    exchange->silent = false;
    std::string next = std::exchange(connection->bytes, std::string(kResumption));
    connection->head = {};
    static_cast<void>(connection->head.add(connection->bytes));
    const bool sound = answer(*connection, *exchange, !goes_on || exchange->close);
    connection->bytes.append(next);
    go_on(connection, exchange, sound && goes_on);
  }

  // Has httplib answer a request. False: the connection must be closed.
  bool answer(Connection& connection, Exchange& exchange, bool last) {
    ++in_flight_;
    current_exchange = &exchange;
    ConnectionLimits limits;
    limits.window = settings_.pace_window;
    ConnectionStream stream(connection, stop_, limits);
    stream.silence_by(exchange.silent);
    bool closed = false;
    bool sound = false;
    const HeadFault& fault = connection.head.fault();
    if (connection.too_long) {
      refuse_head(stream, exchange, 431, "request line and headers are too long");
    } else if (fault.status != 0) {
      refuse_head(stream, exchange, fault.status, fault.detail);
    } else {
      // What produces a body on its way, a stored file for instance, may fail beyond all answers.
      try {
        sound = process_request(stream, last || svr_sock_ == INVALID_SOCKET, closed,
                                [&](httplib::Request& request) { prepare(request, exchange); });
      } catch (const std::exception& exception) {
        logger_.error("answer_broke_off", {{"request_id", std::string_view(exchange.request_id)},
                                           {"what", exception.what()}});
        metrics_.count("symcell_internal_errors_total", {{"where", "http"}});
      }
    }
    current_exchange = nullptr;
    --in_flight_;
    const bool over = !exchange.suspended || exchange.resumed;
    if (exchange.status != 0 && over) record(exchange, connection.sent() - exchange.sent_before);
    return sound && !closed && !last;
  }

  // Where the next request begins is anyone's guess: the connection ends.
  static void refuse_head(ConnectionStream& stream,
                          Exchange& exchange,
                          int status,
                          const std::string& detail) {
    const std::string answer =
        problem_answer(service_problem_for_status(status), detail, exchange.request_id);
    stream.write(answer.data(), answer.size());
    exchange.status = status;
    exchange.close = true;
  }

  // An answer that httplib has no part in.
  static std::string problem_answer(ServiceProblem problem,
                                    std::string_view detail,
                                    const std::string& request_id) {
    const int status = service_problem_row(problem).http_status;
    const std::string body = service_problem_json(problem, detail, "");
    std::string answer = "HTTP/1.1 " + std::to_string(status) + " " +
                         std::string(service_problem_row(problem).title) +
                         "\r\nDate: " + format_http_date(now_ms()) +
                         "\r\nContent-Type: application/problem+json\r\n"
                         "X-Content-Type-Options: nosniff\r\nConnection: close\r\n";
    if (status == 503) answer += "Retry-After: 1\r\n";
    if (!request_id.empty()) answer += "X-Request-Id: " + request_id + "\r\n";
    return answer + "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
  }

  // For a connection that no thread is free for, or that is one too many.
  std::string refusal() {
    metrics_.count("symcell_http_refused_connections_total");
    return problem_answer(ServiceProblem::kOverloaded, "too many connections", "");
  }

  void record(const Exchange& exchange, std::uint64_t bytes) {
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - exchange.start).count();
    const std::string status = std::to_string(exchange.status);
    const std::string_view route =
        exchange.route.empty() ? "none" : std::string_view(exchange.route);
    const std::string_view method =
        exchange.method.empty() ? "none" : std::string_view(exchange.method);
    metrics_.count("symcell_http_requests_total",
                   {{"route", route}, {"method", method}, {"status", status}});
    metrics_.observe("symcell_http_request_duration_seconds", seconds, {{"route", route}});
    const std::string owner = exchange.caller.owner();
    // Probes would drown everything else.
    const bool probe = route == "/healthz" || route == "/readyz" || route == "/metrics";
    logger_.log(probe ? LogLevel::kDebug : LogLevel::kInfo, "http_request",
                {{"request_id", exchange.request_id},
                 {"method", method},
                 {"path", exchange.path},
                 {"client", std::string_view(exchange.client)},
                 {"key", std::string_view(owner)},
                 {"job", std::string_view(exchange.job)},
                 {"trace", trace_id_of(exchange.traceparent)},
                 {"status", std::int64_t{exchange.status}},
                 {"bytes", static_cast<std::int64_t>(bytes)},
                 {"seconds", seconds}});
  }

  HttpSettings settings_;
  const Router& router_;
  Metrics& metrics_;
  Logger& logger_;
  std::atomic<std::size_t>& in_flight_;
  const SitePolicy sites_;
  StopSignal stop_;
  const std::unique_ptr<TlsContext> tls_;
  int listening_ = INVALID_SOCKET;  // closed by the destructor: the lobby's thread may look at it
  Lobby lobby_;
  // They give connections back to the lobby.
  Crew probes_{kProbeThreads, kMostQueuedProbes};
  Crew quick_;
  Crew patient_;
  SuspendedCalls suspended_{kResumingThreads};
};

HttpServer::HttpServer(const HttpSettings& settings,
                       const Router& router,
                       Metrics& metrics,
                       Logger& logger)
    : impl_(std::make_unique<Impl>(settings, router, metrics, logger, in_flight_)) {
}

HttpServer::~HttpServer() = default;

int HttpServer::bind() {
  return impl_->bind();
}

void HttpServer::run() {
  impl_->run();
}

void HttpServer::reload_tls() {
  impl_->reload_tls();
}

void HttpServer::stop() {
  impl_->stop_accepting();
  impl_->stop_connections();
}

}  // namespace symcell::server
