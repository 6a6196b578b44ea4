#pragma once
/// The commands of the program: each adds itself to the parser and sets the exit code when it has run. Scenes may name
/// the parts that it is given.

namespace CLI {
class App;
}

namespace noether {

class Parts;

/// Adds the option `--threads` to a command.
void add_threads_option(CLI::App& command, int& threads);

void add_run_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_evaluate_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_explain_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_compare_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_advise_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_stability_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_ensemble_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_merge_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_list_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_describe_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_info_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_verify_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_convert_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_frequencies_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_plot_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_help_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_version_command(CLI::App& app, const Parts& parts, int& exit_code);
void add_view_command(CLI::App& app, const Parts& parts, int& exit_code);

}  // namespace noether
