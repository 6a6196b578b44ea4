#pragma once
/// Where a run writes unless told.

#include <filesystem>

namespace noether::io {

/// The folder that a scene writes to unless told, in the working directory: NAME.out, where NAME is the scene's file
/// without `.toml`, or its folder where the file is called `scene.toml`.
std::filesystem::path default_output_folder(const std::filesystem::path& scene);

}  // namespace noether::io
