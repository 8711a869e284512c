// `symcell serve`: the HTTP service as a subcommand.
#pragma once

namespace CLI {
class App;
}

namespace symcell {

// Adds the subcommand; when it is chosen it serves until SIGTERM or SIGINT and sets `exit_code`.
void add_serve_command(CLI::App& app, int& exit_code);

}  // namespace symcell
