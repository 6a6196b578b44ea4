#pragma once
/// What the name of a file that cannot be opened may have meant.

#include <filesystem>
#include <string>
#include <string_view>

namespace noether::io {

/// The end of a message about a file that is missing or is a folder: "; did you mean 'orbits.toml'?", or nothing.
///
/// @param inside  the name of the file that is meant where a folder is given, such as "run.h5"
/// @cost one look at the names in the folder, at most 10 000
std::string near_file(const std::filesystem::path& file, std::string_view inside) noexcept;

}  // namespace noether::io
