// `symcell worker`: what `symcell serve` starts, not a user. See server/worker/worker_main.hpp.
#pragma once

namespace CLI {
class App;
}

namespace symcell {

void add_worker_command(CLI::App& app, int& exit_code);

}  // namespace symcell
