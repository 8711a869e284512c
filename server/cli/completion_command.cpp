// `symcell completion SHELL`: a script that completes commands and flags, made from the parser itself.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "api/version.hpp"
#include "server/cli/commands.hpp"

namespace symcell::cli {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : " ") + w;
  return text;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* c) { return !c->get_group().empty(); });
}

std::vector<std::string> flags_of(const CLI::App& command) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
  }
  return flags;
}

// Names of values, as "none|safe|all": words to choose from.
std::vector<std::string> choices_of(const CLI::Option& option) {
  // The parser's own words for a check of the value follow.
  const std::string named = option.get_type_name();
  const std::string type = named.substr(0, named.find(":{"));
  std::vector<std::string> words;
  if (type.find('|') == std::string::npos) return words;
  for (std::size_t begin = 0; begin <= type.size();) {
    const std::size_t end = std::min(type.find('|', begin), type.size());
    const std::string word = type.substr(begin, end - begin);
    // Capitals stand for something.
    if (!word.empty() && word.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string::npos) {
      words.push_back(word);
    }
    begin = end + 1;
  }
  return words;
}

// bash; zsh reads the same after bashcompinit.
std::string bash_script(const CLI::App& app) {
  std::vector<std::string> names;
  std::string cases, values;
  for (const CLI::App* command : commands_of(app)) {
    names.push_back(command->get_name());
    cases += "    " + command->get_name() + ") flags=\"" + joined(flags_of(*command)) + "\" ;;\n";
    for (const CLI::Option* option : command->get_options()) {
      const std::vector<std::string> choices = choices_of(*option);
      if (choices.empty()) continue;
      std::vector<std::string> befores;
      for (const std::string& name : option->get_lnames()) befores.push_back("--" + name);
      // What stands by itself comes first, after the command's name.
      if (option->get_positional()) befores.push_back(command->get_name());
      for (const std::string& before : befores) {
        values += "    " + command->get_name() + ":" + before + ") words=\"" + joined(choices) +
                  "\" ;;\n";
      }
    }
  }
  return R"(# Completion of symcell's commands and flags.
_symcell() {
  local current="${COMP_WORDS[COMP_CWORD]}" previous="${COMP_WORDS[COMP_CWORD-1]}"
  local command="${COMP_WORDS[1]}" flags="" words=""
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W ")" +
         joined(names) + R"( --help --version" -- "$current"))
    return
  fi
  case "$command" in
)" + cases +
         R"(  esac
  case "$command:$previous" in
)" + values +
         R"(  esac
  if [ -n "$words" ]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  elif [[ "$current" == -* ]]; then
    COMPREPLY=($(compgen -W "$flags" -- "$current"))
  else
    COMPREPLY=($(compgen -f -- "$current"))
  fi
}
complete -o filenames -F _symcell symcell
)";
}

std::string fish_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? ' ' : c;
  }
  return quoted + "'";
}

std::string fish_script(const CLI::App& app) {
  std::string script = "# Completion of symcell's commands and flags.\n";
  for (const CLI::App* command : commands_of(app)) {
    script += "complete -c symcell -n __fish_use_subcommand -a " + command->get_name() + " -d " +
              fish_quoted(command->get_description()) + "\n";
    for (const CLI::Option* option : command->get_options()) {
      const std::string choices = joined(choices_of(*option));
      if (option->get_positional() && !choices.empty()) {
        script += "complete -c symcell -n '__fish_seen_subcommand_from " + command->get_name() +
                  "' -f -a '" + choices + "'\n";
      }
      for (const std::string& name : option->get_lnames()) {
        script += "complete -c symcell -n '__fish_seen_subcommand_from " + command->get_name() +
                  "' -l " + name + (option->get_expected_min() > 0 ? " -r" : "") + " -d " +
                  fish_quoted(option->get_description()) + "\n";
      }
    }
  }
  return script;
}

// As the -man macros of roff want it: no line that begins with a dot, no bare backslash or hyphen.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) {
      out += "\\&";
      out += c;
    } else {
      out += c;
    }
  }
  return out;
}

std::string manual_of(const CLI::App& command) {
  std::string page =
      ".SS symcell " + roff(command.get_name()) + "\n" + roff(command.get_description()) + ".\n";
  for (const CLI::Option* option : command.get_options()) {
    page += ".TP\n";
    std::string names;
    for (const std::string& name : option->get_snames())
      names += (names.empty() ? "-" : ", -") + name;
    for (const std::string& name : option->get_lnames()) {
      names += (names.empty() ? "--" : ", --") + name;
    }
    if (names.empty()) names = option->get_name();
    const bool takes_value = option->get_expected_min() > 0 && names.starts_with('-');
    page += "\\fB" + roff(names) + "\\fR" +
            (takes_value ? " \\fI" + roff(option->get_type_name()) + "\\fR" : std::string()) +
            "\n" + roff(option->get_description()) + "\n";
  }
  if (!command.get_footer().empty()) {
    page += ".PP\n.nf\n" + roff(command.get_footer()) + "\n.fi\n";
  }
  return page;
}

std::string manual(const CLI::App& app) {
  std::string page =
      ".TH SYMCELL 1 \"\" \"symcell " + roff(std::string(version())) +
      "\" \"User Commands\"\n.SH NAME\nsymcell \\- symmetry cells of rotationally symmetric "
      "models, planar and solid\n.SH SYNOPSIS\n.B symcell\n\\fICOMMAND\\fR "
      "[\\fIoptions\\fR]\n.SH DESCRIPTION\n" +
      roff(app.get_description()) + "\n.SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app)) page += manual_of(*command);
  return page +
         ".SH EXIT STATUS\n0 done, 1 meshing failed, 2 wrong usage, 3 the model is not acceptable, "
         "4 a limit was reached.\n";
}

}  // namespace

void add_completion_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "completion", "Print a script for the shell's completion, or the manual page");
  const auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash, zsh, fish; man: the manual page, for man -l")
      ->required()
      ->type_name("bash|zsh|fish|man")
      ->option_text(" ")
      ->check(CLI::IsMember({"bash", "zsh", "fish", "man"}));
  command->footer(R"(Examples:
  source <(symcell completion bash)
  symcell completion bash > ~/.local/share/bash-completion/completions/symcell
  symcell completion man | man -l -
  symcell completion fish > ~/.config/fish/completions/symcell.fish
)");
  command->callback([&app, shell, &exit_code] {
    std::string script = *shell == "man"    ? manual(app)
                         : *shell == "fish" ? fish_script(app)
                                            : bash_script(app);
    if (*shell == "zsh") script.insert(0, "autoload -U +X bashcompinit && bashcompinit\n");
    exit_code = std::fputs(script.c_str(), stdout) < 0 || std::fflush(stdout) != 0 ? 1 : 0;
  });
}

}  // namespace symcell::cli
