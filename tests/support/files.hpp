#pragma once
/// Files and text for tests: folders of their own, whole files read and written.

#include <filesystem>
#include <string>
#include <vector>

namespace noether::test {

/// A new folder for one test, removed with everything in it. It is called `scene`: runs of a scene.toml there write to
/// scene.out.
class ScratchFolder {
 public:
  ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);

bool has(const std::string& text, const std::string& part);
std::vector<std::string> lines_of(const std::string& text);
/// A text with the first `what` in it replaced. @throws std::runtime_error if there is none
std::string replaced(std::string text, const std::string& what, const std::string& by);
/// The number behind the `n`-th `word` of a text, counted from 0. @throws std::runtime_error if there is none
double number_after(const std::string& text, const std::string& word, int n = 0);

}  // namespace noether::test
