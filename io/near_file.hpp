#pragma once
/// What the name of a file that cannot be opened may have meant.

#include <filesystem>
#include <string>
#include <string_view>

namespace noether::io {

/// The end of a message about a file that is missing or is a folder: "; did you mean 'orbits.toml'?", or nothing.
///
/// Names with the same extension are nearest, then scenes and HDF5 files with nearly the same; of a folder that holds a
/// run or its checkpoint instead of the file that is meant, that is said: "; the folder holds a run,
/// 'orbits.out/run.h5'". Of a scene that is given in place of its run the run is named.
/// @param inside  the name of the file that is meant where a folder is given, such as "run.h5"
/// @cost one look at the names in the folder, at most 10 000
std::string near_file(const std::filesystem::path& file, std::string_view inside) noexcept;

}  // namespace noether::io
