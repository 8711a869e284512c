// The subcommands that run without a server. Each add_*_command registers one with CLI11; when it
// is chosen it does its work and sets `exit_code`.
#pragma once

namespace CLI {
class App;
}

namespace symcell::cli {

void add_mesh_command(CLI::App& app, int& exit_code);
void add_batch_command(CLI::App& app, int& exit_code);
void add_completion_command(CLI::App& app, int& exit_code);
void add_convert_command(CLI::App& app, int& exit_code);
void add_transfer_command(CLI::App& app, int& exit_code);
void add_inspect_command(CLI::App& app, int& exit_code);
void add_verify_command(CLI::App& app, int& exit_code);

}  // namespace symcell::cli
