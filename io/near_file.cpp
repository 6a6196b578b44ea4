#include "io/near_file.hpp"

#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <exception>
#include <vector>

namespace noether::io {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_names = 10'000;

/// The names of the files in a folder that end as the one that is missed does.
std::vector<std::string> names_beside(const fs::path& file) {
  std::vector<std::string> names;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (names.size() == most_names) break;
    const fs::path name = entry.path().filename();
    if (name.extension() == file.extension() && entry.is_regular_file()) names.push_back(name.string());
  }
  return names;
}

fs::path meant(const fs::path& file, std::string_view inside) {
  if (fs::is_directory(file)) return fs::is_regular_file(file / inside) ? file / inside : fs::path();
  if (fs::exists(file)) return {};
  const std::string name = suggest(file.filename().string(), names_beside(file));
  return name.empty() ? fs::path() : file.parent_path() / name;
}

}  // namespace

std::string near_file(const fs::path& file, std::string_view inside) noexcept {
  try {
    const fs::path found = meant(file, inside);
    return found.empty() ? "" : fmt::format("; did you mean '{}'?", found.string());
  } catch (const std::exception&) {
    return "";  // A proposal is a help; the message that it ends is what counts.
  }
}

}  // namespace noether::io
