#include "tests/support/files.hpp"

#include <unistd.h>

#include <atomic>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace noether::test {

ScratchFolder::ScratchFolder() {
  static std::atomic<int> count{0};
  const auto base = std::filesystem::temp_directory_path();
  path_ = base / ("noether-test-" + std::to_string(::getpid()) + "-" + std::to_string(count++)) / "scene";
  std::filesystem::create_directories(path_);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_.parent_path(), ignored);
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream source(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(source), {}};
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream source(text);
  for (std::string line; std::getline(source, line);) lines.push_back(line);
  return lines;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  if (at == std::string::npos) throw std::runtime_error("there is no '" + what + "' to replace in: " + text);
  return text.replace(at, what.size(), by);
}

double number_after(const std::string& text, const std::string& word, int n) {
  auto at = text.find(word);
  for (; n > 0 && at != std::string::npos; --n) at = text.find(word, at + 1);
  if (at == std::string::npos) throw std::runtime_error("there is no '" + word + "' in: " + text);
  return std::stod(text.substr(at + word.size()));
}

}  // namespace noether::test
