#include "server/cli/option_flags.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "api/schema/options.hpp"

namespace symcell::cli {
namespace {
constexpr std::string_view kMemoryLimit = "memory_limit";
}  // namespace

void OptionFlags::add_to(CLI::App& command) {
  for (const OptionInfo& info : mesh_option_table()) {
    const std::string name(info.name);
    std::string flag = "--" + name;
    std::ranges::replace(flag, '_', '-');
    if (name == "sizes") flag += ",--size";
    std::string help(info.help);
    if (!info.standard.empty()) help += " [" + std::string(info.standard) + "]";
    CLI::Option* option = nullptr;
    if (info.metavar.empty()) {
      option = command.add_flag_callback(
          flag, [this, name] { given_.emplace_back(name, ""); }, help);
    } else {
      option = command.add_option_function<std::string>(
          flag, [this, name](const std::string& value) { given_.emplace_back(name, value); }, help);
      option->type_name(std::string(info.metavar));
      // --size bore=0.5 --size rim=1
      if (info.is_list) {
        option->delimiter(',')->multi_option_policy(CLI::MultiOptionPolicy::Join);
      } else {
        option->multi_option_policy(CLI::MultiOptionPolicy::Throw);
      }
    }
    option->group("Meshing");
  }
}

Result<MeshOptions> OptionFlags::options() const {
  return options_from_texts(given_);
}

void add_memory_limit(CLI::App& command, std::string& target) {
  const auto row = std::ranges::find(mesh_option_table(), kMemoryLimit, &OptionInfo::name);
  command.add_option("--memory-limit", target, std::string(row->help))
      ->type_name(std::string(row->metavar));
}

Result<std::uint64_t> memory_limit_bytes(const std::string& given) {
  if (given.empty()) return 0;
  const Result<MeshOptions> options = options_from_texts({{std::string(kMemoryLimit), given}});
  if (!options) return error_of(options);
  return options->memory_limit_bytes;
}

}  // namespace symcell::cli
