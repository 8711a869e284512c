// `symcell keys`: makes, lists and revokes the keys of a server's callers.
#pragma once

namespace CLI {
class App;
}

namespace symcell {

void add_keys_command(CLI::App& app, int& exit_code);

}  // namespace symcell
