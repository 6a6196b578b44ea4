#include "io/near_file.hpp"

#include "io/output_folder_name.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace noether::io {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_names = 10'000;

/// Whether a file may be meant where this one is missed: it ends in the same way, or as a scene or a run does and the
/// missed one ends in nothing or almost so, as "orbits.tml" and "orbits.hdf5" do.
bool may_be_meant(const fs::path& name, const fs::path& missed) {
  const std::string end = name.extension().string(), wanted = missed.extension().string();
  if (end == wanted) return true;
  if (end != ".toml" && end != ".h5") return false;
  return wanted.size() < 2 || (wanted[1] == end[1] && edit_distance(wanted, end) <= 2);
}

/// The names of the files in a folder that may be meant.
std::vector<std::string> names_beside(const fs::path& file) {
  std::vector<std::string> names;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (names.size() == most_names) break;
    const fs::path name = entry.path().filename();
    if (may_be_meant(name, file) && entry.is_regular_file()) names.push_back(name.string());
  }
  return names;
}

bool is_scene(const fs::path& file) { return file.extension() == ".toml"; }

/// The nearest name, one with the same end before all others.
fs::path near_name(const fs::path& file) {
  const std::vector<std::string> all = names_beside(file);
  std::vector<std::string> alike;
  for (const std::string& name : all) {
    if (fs::path(name).extension() == file.extension()) alike.push_back(name);
  }
  const std::string missed = file.filename().string();
  std::string name = suggest(missed, alike);
  if (name.empty()) name = suggest(missed, all);
  return name.empty() ? fs::path() : file.parent_path() / name;
}

/// What is in a folder that is given in place of a file.
std::string in_folder(const fs::path& folder, std::string_view inside) {
  if (fs::is_regular_file(folder / inside)) {
    return fmt::format("; did you mean '{}'?", (folder / inside).string());
  }
  for (const auto& [name, what] : {std::pair{"run.h5", "a run"}, std::pair{"checkpoint.h5", "a checkpoint"}}) {
    if (fs::is_regular_file(folder / name)) {
      return fmt::format("; the folder holds {}, '{}'", what, (folder / name).string());
    }
  }
  return "";
}

/// The run of a scene that is given in its place, or how to make one.
std::string of_scene(const fs::path& scene, std::string_view inside) {
  const fs::path run = default_output_folder(scene) / inside;
  if (fs::is_regular_file(run)) return fmt::format("; did you mean '{}'?", run.string());
  return fmt::format("; `noether run {}` makes a run of it", scene.string());
}

}  // namespace

std::string near_file(const fs::path& file, std::string_view inside) noexcept {
  try {
    if (fs::is_directory(file)) return in_folder(file, inside);
    if (fs::exists(file)) return is_scene(file) && inside.ends_with(".h5") ? of_scene(file, inside) : "";
    const fs::path found = near_name(file);
    return found.empty() ? "" : fmt::format("; did you mean '{}'?", found.string());
  } catch (const std::exception&) {
    return "";  // A proposal is a help; the message that it ends is what counts.
  }
}

}  // namespace noether::io
