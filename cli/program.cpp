#include "cli/program.hpp"

#include "cli/commands.hpp"

#include "numbers/error.hpp"
#include "numbers/suggest.hpp"
#include "numbers/text.hpp"
#include "numbers/version.hpp"
#include "scene/json.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>
#include <vector>

namespace noether {

namespace {

/// Says what went wrong: one line on stderr and, where reports are JSON, one on stdout.
int complain(const ErrorLocation& at, const std::string& message, const std::string& line, int code, bool json) {
  std::fputs((escaped(line) + "\n").c_str(), stderr);  // where that cannot be written, nothing can be said
  if (json) {
    const auto text = [](const std::string& t) { return t.empty() ? Json() : Json(t); };
    const Json report = Json::object({{"schema", "noether.error/1"},
                                      {"exit_code", code},
                                      {"file", text(at.file)},
                                      {"line", at.line > 0 ? Json(at.line) : Json()},
                                      {"key", text(at.key)},
                                      {"value", text(at.value)},
                                      {"message", message}});
    std::fputs((report.text() + "\n").c_str(), stdout);
  }
  return code;
}

/// Another library's words in the form of ours: one line, lower case, no final stop.
std::string in_our_words(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  const bool word = text.size() > 1 && std::islower(static_cast<unsigned char>(text[1]));
  if (word) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

/// The launcher of a checkout, `./noether`, has commands of its own, and says that it is there.
bool under_launcher() { return std::getenv("NOETHER_LAUNCHER") != nullptr; }
const std::vector<std::string> launcher_commands = {"build", "test", "bench", "wheel"};
constexpr const char* launcher_help =
    "In a checkout:\n"
    "  ./noether build             build everything, or for another preset\n"
    "  ./noether test              build and run the tests, all or those of some folders\n"
    "  ./noether bench             build and run one benchmark, or all\n"
    "  ./noether wheel             make a wheel of the Python package\n";

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// What the first argument nobody knows may have meant.
std::string unknown_argument(const CLI::App& app, const std::string& argument) {
  const auto used = app.get_subcommands();
  const CLI::App& command = used.empty() ? app : *used.front();
  const std::string of = used.empty() ? "" : " of '" + command.get_name() + "'";
  if (argument[0] != '-') return fmt::format("unexpected argument '{}'{}", argument, of);
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  const std::string name = argument.substr(0, argument.find('='));
  return fmt::format("unknown option '{}'{}{}", name, of, did_you_mean(name, known));
}

/// What is wrong with the first argument; "" if it is a command or an option of the program itself.
std::string wrong_first_argument(const CLI::App& app, const std::string& first) {
  if (first.empty()) return "no command is given; see `noether --help`";
  if (std::find(launcher_commands.begin(), launcher_commands.end(), first) != launcher_commands.end()) {
    return fmt::format("'{}' is a command of the launcher in a checkout: ./noether {}", first, first);
  }
  const bool option = first[0] == '-';
  std::vector<std::string> known = {"--help", "--version"};
  if (!option) known = command_names(app);
  if (!option && under_launcher()) known.insert(known.end(), launcher_commands.begin(), launcher_commands.end());
  if (first == "-h" || std::find(known.begin(), known.end(), first) != known.end()) return "";
  if (first.ends_with(".toml")) return fmt::format("'{0}' is not a command; did you mean `noether run {0}`?", first);
  return fmt::format("unknown {} '{}'{}{}", option ? "option" : "command", first, option ? " before a command" : "",
                     did_you_mean(first, known));
}

/// What the parser says, in our words.
std::string parser_message(const CLI::ParseError& error) {
  const std::string text = error.what();
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr) return in_our_words(text);
  const std::string option = text.substr(0, text.find_first_of(": "));
  if (text.ends_with(" missing")) return option + " needs a value";
  return text.ends_with("override") ? "--" + option + " takes no value" : option + " can be given only once";
}

int parse(CLI::App& app, int argc, char** argv, int& exit_code, bool json) {
  const std::string wrong = wrong_first_argument(app, argc > 1 ? argv[1] : "");
  if (!wrong.empty()) return complain({}, wrong, wrong, 2, json);
  try {
    app.parse(argc, argv);
    return exit_code;
  } catch (const CLI::CallForHelp&) {
    const auto used = app.get_subcommands();
    fmt::print("{}", used.empty() ? app.help() : used.front()->help(app.get_name()));
    return 0;
  } catch (const CLI::CallForVersion&) {
    fmt::print("noether {} ({})\n", version(), commit());
    return 0;
  } catch (const CLI::ExtrasError&) {
    const auto rest = app.remaining(true);
    const std::string message = unknown_argument(app, rest.empty() ? std::string("?") : rest.front());
    return complain({}, message, message, 2, json);
  } catch (const CLI::ParseError& error) {
    for (const std::string& rest : app.remaining(true)) {
      const std::string unknown = unknown_argument(app, rest);
      if (rest.starts_with('-')) return complain({}, unknown, unknown, 2, json);
    }
    const auto used = app.get_subcommands();
    const std::string help = used.empty() ? "noether --help" : "noether " + used.front()->get_name() + " --help";
    std::string message = parser_message(error);
    if (!message.ends_with('?')) message += fmt::format("; see `{}`", help);
    return complain({}, message, message, 2, json);
  }
}

/// In the order of the help.
constexpr void (*all_commands[])(CLI::App&, const Parts&, int&) = {
    add_run_command,       add_evaluate_command, add_explain_command, add_compare_command,     add_advise_command,
    add_stability_command, add_ensemble_command, add_merge_command,   add_list_command,        add_describe_command,
    add_info_command,      add_verify_command,   add_convert_command, add_frequencies_command, add_plot_command,
    add_view_command,      add_help_command,     add_version_command,
};

int run_command(int argc, char** argv, const Parts& parts, bool json) {
  try {
    CLI::App app("Long, honest integrations of mechanical systems", "noether");
    if (under_launcher()) app.footer(launcher_help);
    app.set_version_flag("--version", "");
    app.require_subcommand(1);
    app.option_defaults()->disable_flag_override();
    int exit_code = 0;
    for (const auto add : all_commands) add(app, parts, exit_code);
    return parse(app, argc, argv, exit_code, json);
  } catch (const Error& error) {
    return complain(error.location(), error.message(), error.what(), error.exit_code(), json);
  } catch (const std::bad_alloc&) {
    return complain({}, "out of memory", "out of memory", 4, json);
  } catch (const std::filesystem::filesystem_error& error) {
    const std::string file = error.path1().string(), message = in_our_words(error.code().message());
    return complain({.file = file}, message, file + ": " + message, 3, json);
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) return 3;  // told at the end
    return complain({}, in_our_words(error.what()), in_our_words(error.what()), 3, json);
  } catch (const std::exception& error) {
    const std::string message = fmt::format("internal fault: {}; this is a bug of noether", in_our_words(error.what()));
    return complain({}, message, message, 4, json);
  }
}

}  // namespace

int program(int argc, char** argv, const Parts& parts) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error of the write, and told as one
  const bool json = std::any_of(argv + 1, argv + argc, [](const char* one) { return std::string(one) == "--json"; });
  const int code = run_command(argc, argv, parts, json);
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  const std::string message = fmt::format("standard output: {}", in_our_words(std::strerror(errno)));
  return complain({}, message, message, code == 0 ? 3 : code, false);
}

}  // namespace noether
