#include "server/cli/worker_command.hpp"

#include <sys/socket.h>
#include <sys/types.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "server/worker/worker_main.hpp"

namespace symcell {
namespace {

constexpr int kUsage = 2;

bool is_socket(int descriptor) {
  int type = 0;
  socklen_t size = sizeof type;
  return ::getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &type, &size) == 0;
}

}  // namespace

void add_worker_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("worker", "Run jobs for a server (started by serve)");
  command->group("");  // not in the help
  const auto parent = std::make_shared<pid_t>(0);
  command->add_option("PARENT", *parent, "process id of the server")->required();
  command->callback([parent, &exit_code] {
    if (!is_socket(STDIN_FILENO)) {
      std::cerr << "symcell worker: is started by symcell serve, not by hand\n";
      exit_code = kUsage;
      return;
    }
    exit_code = server::run_worker(STDIN_FILENO, *parent);
  });
}

}  // namespace symcell
