#pragma once
/// What the READMEs of examples/ print as expected output, and which of it must be found again.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace examples {

inline const std::filesystem::path folder = std::filesystem::path(NOETHER_SOURCE_DIR) / "examples";

/// Whether the last digit of a mathematical function can change a run: only figures far above rounding are then fixed.
enum class Bits : std::uint8_t { everywhere, of_this_machine };

inline std::string readme_of(const std::string& example) {
  std::ifstream in(folder / example / "README.md");
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The blocks fenced by ```text, in order: what the program prints, what the scene reports.
inline std::vector<std::string> outputs_in(const std::string& readme) {
  static constexpr std::string_view begin = "```text\n", end = "```\n";
  std::vector<std::string> blocks;
  for (std::size_t at = readme.find(begin); at != readme.npos; at = readme.find(begin, at)) {
    at += begin.size();
    const std::size_t stop = readme.find(end, at);
    if (stop == readme.npos) break;
    blocks.push_back(readme.substr(at, stop - at));
    at = stop + end.size();
  }
  return blocks;
}

/// The lines that are physics: without times of the machine and names of files, and without what bits decide where
/// these are of this machine only: the digest, the iterations of a solver, and figures of 1e-12 and less.
inline std::string physics(const std::string& output, Bits bits) {
  static const std::regex machine("steps/s on|^wrote "), decided("^sha256:|^constraints: "),
      rounding("-?[0-9.]+e-(1[2-9]|[2-9][0-9])");
  std::string kept;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_search(line, machine)) continue;
    if (bits == Bits::of_this_machine && std::regex_search(line, decided)) continue;
    if (bits == Bits::of_this_machine) line = std::regex_replace(line, rounding, "(rounding)");
    kept += line + "\n";
  }
  return kept;
}

/// The word that begins with "sha256:"; empty if there is none.
inline std::string digest_in(const std::string& output) {
  const std::size_t begin = output.find("sha256:");
  return begin == std::string::npos ? "" : output.substr(begin, output.find_first_of(" \n", begin) - begin);
}

}  // namespace examples
