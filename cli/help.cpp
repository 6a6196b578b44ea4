/// `noether help`: the program's help, or that of one command.

#include "cli/commands.hpp"
#include "numbers/error.hpp"
#include "numbers/suggest.hpp"
#include "scene/parts.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace noether {

namespace {

/// The program's own help; App::help() would be that of the command in use.
std::string help_of(const CLI::App& app) {
  return app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal);
}

std::string help_of(const CLI::App& app, const Parts& parts, const std::string& wanted) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == wanted) return command->help(app.get_name());
    names.push_back(command->get_name());
  }
  const std::vector<std::string> methods = parts.method_names();
  const bool is_method = std::find(methods.begin(), methods.end(), wanted) != methods.end();
  throw Error(fmt::format("there is no command '{}'{}", wanted,
                          is_method ? fmt::format("; `noether describe {}` describes the method of that name", wanted)
                                    : did_you_mean(wanted, names)));
}

}  // namespace

void add_help_command(CLI::App& app, const Parts& parts, int& exit_code) {
  const auto wanted = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("help", "this help, or the help of a command");
  command->add_option("command", *wanted, "a command, such as run")->type_name("COMMAND");
  command->callback([&app, &parts, wanted, &exit_code] {
    fmt::print("{}", wanted->empty() ? help_of(app) : help_of(app, parts, *wanted));
    exit_code = 0;
  });
}

}  // namespace noether
