#include "io/output_folder_name.hpp"

#include <system_error>

namespace noether::io {

std::filesystem::path default_output_folder(const std::filesystem::path& scene) {
  namespace fs = std::filesystem;
  fs::path name = scene.filename();
  if (name == "scene.toml") {
    std::error_code error;
    name = scene.parent_path().lexically_normal().filename();
    if (name.empty() || name == "." || name == "..")
      name = fs::weakly_canonical(fs::absolute(scene), error).parent_path().filename();
    if (name.empty()) name = "scene";
    return name.string() + ".out";
  }
  if (name.extension() == ".toml") name.replace_extension();
  return name.string() + ".out";
}

}  // namespace noether::io
