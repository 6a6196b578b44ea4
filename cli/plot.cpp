/// `noether plot`: a picture of a run, drawn by gnuplot.

#include "cli/comma_lists.hpp"
#include "cli/commands.hpp"
#include "cli/plot_data.hpp"
#include "cli/plot_script.hpp"
#include "numbers/error.hpp"
#include "scene/json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>

extern char** environ;

namespace noether {

namespace {

/// A folder of its own below the system's, gone at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "noether_plot_").string() + std::string(6, 'X');
    if (mkdtemp(name.data()) == nullptr) {
      throw FileError(fmt::format("{}: no folder could be made for the script: {}", name, std::strerror(errno)));
    }
    path_ = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

std::string first_line(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    if (line.find_first_not_of(" \t^") != std::string::npos) return line;
  }
  return "it printed no message";
}

/// Runs `gnuplot script` with its output in `log`.
/// @throws Error if there is no gnuplot or it refuses the script
void run_gnuplot(const std::filesystem::path& script, const std::filesystem::path& log) {
  std::string program = "gnuplot", argument = script.string(), messages = log.string();
  char* arguments[] = {program.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed == ENOENT) {
    throw Error("gnuplot is not installed, and it draws the pictures; install the package gnuplot-nox");
  }
  if (failed != 0) throw Error(fmt::format("gnuplot could not be started: {}", std::strerror(failed)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0) throw Error("gnuplot could not draw the picture: " + first_line(log));
}

PictureFormat format_of(const std::filesystem::path& picture) {
  const std::string ending = picture.extension().string();
  if (ending == ".svg") return PictureFormat::svg;
  if (ending == ".png") return PictureFormat::png;
  if (ending == ".pdf") return PictureFormat::pdf;
  throw Error(fmt::format("a picture '{}' has no supported format; give a name that ends in .svg, .png or .pdf",
                          picture.string()));
}

/// @return the picture
std::filesystem::path plot(const std::filesystem::path& file, std::filesystem::path picture, const Parts& parts,
                           const PlotOptions& wanted) {
  if (picture.empty()) picture = std::filesystem::path(file).replace_extension(".svg");
  const PictureFormat format = format_of(picture);
  const PlotData data = read_plot_data(file, parts, wanted);
  const ScratchFolder scratch;
  const std::filesystem::path script = scratch / "script.gp", drawn = scratch / "picture";
  std::ofstream(script) << plot_script(data, format, drawn.string());
  run_gnuplot(script, scratch / "log");

  std::ifstream in(drawn, std::ios::binary);
  std::ofstream out(picture, std::ios::binary);
  out << in.rdbuf();
  out.close();
  if (!in || !out) throw FileError(fmt::format("{}: the picture could not be written", picture.string()));
  return picture;
}

}  // namespace

void add_plot_command(CLI::App& app, const Parts& parts, int& exit_code) {
  struct Options {
    std::string file, out, what, projection;
    std::optional<std::int64_t> frame;
    bool json = false;
  };
  CLI::App* command = app.add_subcommand(
      "plot", "draw a run or an ensemble: orbits or a liquid, errors, elements, g(r), maps ... (needs gnuplot)");
  const auto options = std::make_shared<Options>();
  command->add_option("FILE", options->file, "a run.h5, or the file of an ensemble")
      ->required()
      ->check([](const std::string& file) { return std::string(file.empty() ? "the name of the file is empty" : ""); })
      ->type_name("");
  command->add_option("--out", options->out, "the picture, .svg, .png or .pdf; default: FILE with .svg")
      ->type_name("PICTURE");
  command
      ->add_option(
          "--what", options->what,
          fmt::format("a list of {}; of an ensemble figures of its table, such as megno_mean; default: what fits",
                      fmt::join(plot_subjects(), ", ")))
      ->type_name("A,B,...");
  command
      ->add_option("--projection", options->projection,
                   "xy, xz, yz or all three; default: the plane where bodies move, and the side of a thick one")
      ->type_name("PLANE");
  command->add_option("--frame", options->frame, "the frame that is shown, from 0; -1, the default, is the last")
      ->type_name("N");
  command->add_flag("--json", options->json, "report as one line of JSON");
  command->callback([options, &parts, &exit_code] {
    PlotOptions wanted{.frame = options->frame, .what = {}, .projection = options->projection};
    if (!options->what.empty()) wanted.what = texts_in(options->what, "--what");
    const std::string picture = plot(options->file, options->out, parts, wanted).string();
    if (options->json) {
      fmt::print("{}\n", Json::object({{"schema", "noether.plot/1"}, {"file", picture}}).text());
    } else {
      fmt::print("{}\n", picture);
    }
    exit_code = 0;
  });
}

}  // namespace noether
