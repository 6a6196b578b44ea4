#pragma once
/// Plain files: whole contents in and out, flushed to disk, with errors that name the file.

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

namespace noether::io {

/// The bytes of a file or a pipe, all of them or the first `most`.
/// @throws FileError  if it cannot be read, or is a device: some of them never end
std::string read_bytes(const std::filesystem::path& file, std::size_t most = std::numeric_limits<std::size_t>::max());

/// Writes a file and waits until it is on disk. @throws FileError; what was written of it is removed
void write_and_sync(const std::filesystem::path& file, std::string_view bytes);

/// Writes a text through a stream, for people and other programs: it is not waited for until it is on disk.
/// @throws FileError
void write_text_file(const std::filesystem::path& file, const std::function<void(std::ofstream&)>& write);

/// Makes a folder, and those it lies in, where they are not there yet. @throws FileError
void make_folder(const std::filesystem::path& folder);

/// Waits until the content of a file is on disk. @throws FileError
void sync_file(const std::filesystem::path& file);

/// Renames a file, replacing another; nothing happens where there is none. @throws FileError
void rename_if_there(const std::filesystem::path& from, const std::filesystem::path& to);

/// Waits until the names in a folder are on disk. @throws FileError
void sync_folder(const std::filesystem::path& folder);

}  // namespace noether::io
