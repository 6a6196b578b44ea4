#include "tests/support/scene_table.hpp"

#include "tests/support/files.hpp"

#include <algorithm>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace noether::test {
namespace {

using Lines = std::vector<std::string>;

struct Line {
  int number;
  std::string text;
};

[[noreturn]] void refuse(const Line& line, const std::string& why) {
  throw std::runtime_error("line " + std::to_string(line.number) + ": '" + line.text + "' " + why);
}

std::string joined(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// What a line of TOML sets, or the line itself where it is a table.
std::string_view key_of(std::string_view line) {
  if (line.starts_with("[")) return line.substr(0, line.find("  #! "));
  return line.substr(0, line.find(" = "));
}

/// A scene with some of its lines changed; each change stands below the one before.
class Change {
 public:
  explicit Change(const Lines& good) : rest_(good) {}

  void apply(const Line& line) {
    const std::string& text = line.text;
    if (text.starts_with("#!")) {
      lines_.push_back(text);
      return;
    }
    if (text.empty() || text.size() == 2 || (text.size() > 2 && text[1] != ' ')) refuse(line, "is no change");
    const std::string argument = text.size() > 2 ? text.substr(2) : "";
    changed_ = changed_ || text[0] != ' ';
    switch (text[0]) {
      case '+':
        return lines_.push_back(argument);
      case '-':
        return take_until(line, [&](const std::string& other) { return other == argument; }, {});
      case ' ':
        return take_until(line, [&](const std::string& other) { return other == argument; }, {argument});
      case '=':
        return take_until(line, [&](const std::string& other) { return key_of(other) == key_of(argument); },
                          {argument});
      default:
        refuse(line, "begins with none of '+', '-', '=' and ' '");
    }
  }
  /// @return the scene; empty if nothing was changed
  Lines whole() {
    lines_.insert(lines_.end(), rest_.begin() + static_cast<std::ptrdiff_t>(next_), rest_.end());
    return changed_ || lines_.front().starts_with("#!") ? lines_ : Lines{};
  }

 private:
  template <class Test> void take_until(const Line& line, const Test& test, const Lines& instead) {
    const auto from = rest_.begin() + static_cast<std::ptrdiff_t>(next_);
    const auto found = std::find_if(from, rest_.end(), test);
    if (found == rest_.end()) refuse(line, "is not found in the scene that is changed, below the change before");
    lines_.insert(lines_.end(), from, found);
    lines_.insert(lines_.end(), instead.begin(), instead.end());
    next_ = static_cast<std::size_t>(found - rest_.begin()) + 1;
  }

  Lines rest_, lines_;
  std::size_t next_ = 0;
  bool changed_ = false;
};

/// The lines below a heading, without blank ones at their end.
struct Section {
  Line heading;
  std::vector<Line> lines;
};

std::vector<Section> sections_of(const std::string& text) {
  std::vector<Section> sections;
  std::istringstream source(text);
  int number = 0;
  for (std::string line; std::getline(source, line);) {
    ++number;
    if (line.starts_with("==")) {
      sections.push_back({{number, line}, {}});
    } else if (!sections.empty()) {
      sections.back().lines.push_back({number, line});
    }
  }
  for (Section& section : sections) {
    while (!section.lines.empty() && section.lines.back().text.empty()) section.lines.pop_back();
  }
  return sections;
}

/// Writes scenes into a folder. @return their files
std::vector<std::filesystem::path> written(const std::vector<TableScene>& scenes, const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const TableScene& scene : scenes) {
    files.push_back(folder / (scene.name + ".toml"));
    write_text(files.back(), scene.text);
  }
  return files;
}

}  // namespace

SceneTable scene_table(const std::string& text) {
  SceneTable table;
  Lines good;
  std::set<std::string> names;
  for (const Section& section : sections_of(text)) {
    const bool is_good = section.heading.text.starts_with("==== ");
    const std::string name = section.heading.text.substr(is_good ? 5 : 3);
    if (!names.insert(name).second) refuse(section.heading, "appears twice");
    if (is_good) {
      good.clear();
      for (const Line& line : section.lines) good.push_back(line.text);
      table.good.push_back({name, joined(good)});
      continue;
    }
    Change change(good);
    for (const Line& line : section.lines) change.apply(line);
    const Lines lines = change.whole();
    if (lines.empty()) refuse(section.heading, "changes nothing");
    table.bad.push_back({name, joined(lines)});
  }
  return table;
}

SceneFiles write_scene_table(const std::filesystem::path& folder) {
  const std::filesystem::path scenes = std::filesystem::path(NOETHER_SOURCE_DIR) / "tests" / "scenes";
  std::filesystem::copy(scenes / "good", folder / "good");
  std::filesystem::copy(scenes / "bad", folder / "bad");
  const SceneTable table = scene_table(read_text(scenes / "bad" / "scenes.txt"));
  return {written(table.good, folder / "bad"), written(table.bad, folder / "bad")};
}

}  // namespace noether::test
