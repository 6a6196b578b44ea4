/// `noether view`: a page that plays a run.

#include "cli/commands.hpp"
#include "cli/view_data.hpp"
#include "cli/view_page.hpp"
#include "numbers/error.hpp"
#include "numbers/text.hpp"
#include "scene/json.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

namespace noether {

namespace {

struct ViewOptions {
  std::string file, out;
  ViewWish wish;
  bool json = false;
};

/// Where the page goes. @throws Error  for what a browser would not open as a page
std::filesystem::path page_file(const ViewOptions& options) {
  if (options.out.empty()) return std::filesystem::path(options.file).replace_extension(".html");
  const std::filesystem::path out = options.out;
  if (out.extension() == ".html" || out.extension() == ".htm") return out;
  throw Error(fmt::format("a page '{}' does not end in .html; did you mean '{}'?", options.out,
                          std::filesystem::path(out).replace_extension(".html").string()));
}

void write_page(const std::filesystem::path& file, const std::string& html) {
  std::ofstream out(file, std::ios::binary);
  out << html;
  out.close();
  if (!out) throw FileError("the page could not be written", {.file = file.string()});
}

void tell_what_is_left_out(const ViewData& data, const ViewPage& page) {
  std::string left;
  if (page.frames < data.frames_in_file) left = fmt::format("{} of {} frames", page.frames, data.frames_in_file);
  if (data.particles() < data.particles_in_file) {
    left += fmt::format("{}{} of {} particles", left.empty() ? "" : " and ", data.particles(), data.particles_in_file);
  }
  if (!left.empty()) fmt::print(stderr, "{} are shown\n", left);
  if (data.failed_frames > 0) {
    fmt::print(stderr, "{} left out, because a number in {} is not finite\n",
               counted(static_cast<std::int64_t>(data.failed_frames), "frame is", "frames are"),
               data.failed_frames == 1 ? "it" : "them");
  }
}

void view(const ViewOptions& options, const Parts& parts) {
  const std::filesystem::path file = page_file(options);
  const ViewData data = read_view_data(options.file, options.wish, parts);
  const ViewPage page = view_page(data);
  write_page(file, page.html);
  tell_what_is_left_out(data, page);
  if (!options.json) {
    fmt::print("{}\n", file.string());
    return;
  }
  const auto count = [](std::size_t number) { return static_cast<std::int64_t>(number); };
  fmt::print("{}\n", Json::object({{"schema", "noether.view/1"},
                                   {"file", file.string()},
                                   {"frames", count(page.frames)},
                                   {"frames_in_file", count(data.frames_in_file)},
                                   {"particles", count(data.particles())},
                                   {"particles_in_file", count(data.particles_in_file)},
                                   {"bytes", count(page.html.size())}})
                         .text());
}

/// What is wrong with a number of frames; "" if nothing.
std::string wrong_number_of_frames(const std::string& text) {
  constexpr std::size_t most = 1'000'000'000;
  std::size_t frames = 0;
  const char* end = text.data() + text.size();
  const auto [read, error] = std::from_chars(text.data(), end, frames);
  if (error == std::errc() && read == end && frames >= 1 && frames <= most) return "";
  return fmt::format("'{}' is not a valid number of frames; give one from 1", text);
}

}  // namespace

void add_view_command(CLI::App& app, const Parts& parts, int& exit_code) {
  CLI::App* command = app.add_subcommand("view", "make a page that plays a run in a browser, without a server");
  const auto options = std::make_shared<ViewOptions>();
  command->add_option("FILE", options->file, "a run.h5")
      ->required()
      ->check([](const std::string& file) { return std::string(file.empty() ? "the name of the file is empty" : ""); })
      ->type_name("");
  command->add_option("--out", options->out, "the page, .html; default: FILE with .html")->type_name("PAGE");
  CLI::Option* frames =
      command->add_option("--frames", options->wish.frames, "show N frames, at equal distances; default: all that fit")
          ->check(wrong_number_of_frames)
          ->type_name("N");
  command->add_option("--every", options->wish.every, "show every K-th frame")
      ->check(wrong_number_of_frames)
      ->type_name("K")
      ->excludes(frames);
  command->add_flag("--json", options->json, "report as one line of JSON");
  command->callback([options, &parts, &exit_code] {
    view(*options, parts);
    exit_code = 0;
  });
}

}  // namespace noether
