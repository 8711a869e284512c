// The program: one binary, a subcommand each for meshing, inspecting, verifying and serving.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "api/formats/cad.hpp"
#include "api/nearest_name.hpp"
#include "api/version.hpp"
#include "server/cli/commands.hpp"
#include "server/cli/keys_command.hpp"
#include "server/cli/report_error.hpp"
#include "server/cli/serve_command.hpp"
#include "server/cli/worker_command.hpp"

namespace {

constexpr int kWrongUsage = 2;

bool has_command(CLI::App& app, const std::string& name) {
  return !app.get_subcommands([&](const CLI::App* c) { return c->get_name() == name; }).empty();
}

// "; did you mean ...?" for the first flag that the command does not know; else empty.
std::string suggestion(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands()) {
    std::vector<std::string_view> names;
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) names.emplace_back(name);
    }
    for (const std::string& word : command->remaining()) {
      if (!word.starts_with("--")) continue;
      const std::string given = word.substr(2, word.find('=') - 2);
      const std::string_view best = symcell::nearest_name(given, names);
      return best.empty() ? "" : "; did you mean --" + std::string(best) + "?";
    }
  }
  return {};
}

std::string version_text() {
  const std::string cad(symcell::cad_library());
  return "symcell " + std::string(symcell::version()) +
         (cad.empty() ? "\nSTEP and IGES: not read by this build" : "\nSTEP and IGES: " + cad);
}

int run(int argc, char** argv) {
  CLI::App app(
      "Meshes one symmetry cell of an n-fold rotationally symmetric model, planar or solid, from "
      "which the full mesh is n rotated copies.");
  app.name("symcell");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.footer("symcell COMMAND --help tells more.");
  int exit_code = 0;
  symcell::cli::add_mesh_command(app, exit_code);
  symcell::cli::add_inspect_command(app, exit_code);
  symcell::add_serve_command(app, exit_code);
  symcell::add_keys_command(app, exit_code);
  symcell::add_worker_command(app, exit_code);
  symcell::cli::add_verify_command(app, exit_code);
  symcell::cli::add_batch_command(app, exit_code);
  symcell::cli::add_convert_command(app, exit_code);
  symcell::cli::add_transfer_command(app, exit_code);
  symcell::cli::add_completion_command(app, exit_code);
  // CLI11 would only say that a subcommand is missing.
  if (argc > 1 && argv[1][0] != '-' && !has_command(app, argv[1])) {
    std::fprintf(stderr, "symcell: there is no command \"%s\"; see symcell --help\n", argv[1]);
    return kWrongUsage;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::fprintf(stderr, "symcell: %s%s; see symcell --help\n", error.what(),
                 suggestion(app).c_str());
    return kWrongUsage;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  using symcell::Error;
  using symcell::ErrorCode;
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return symcell::cli::report_error(
        Error{ErrorCode::kMemoryLimit, "out of memory; relax the size bounds", {}, {}}, false);
  } catch (const std::exception& error) {
    return symcell::cli::report_error(Error{ErrorCode::kInternal, error.what(), {}, {}}, false);
  }
}
