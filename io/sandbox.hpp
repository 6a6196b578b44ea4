#pragma once
/// Work on a file that may be damaged, tried in a child process first: HDF5 may crash on such a file, or never come
/// back.

#include <filesystem>
#include <functional>

namespace noether::io {

/// Does the work in a child process; returns if that comes back.
///
/// The child is a copy of this process, memory and all, so what it survives this process survives, if it does the same
/// next. Its computing and its memory are limited by the size of the file. Work within the work is not tried once more.
/// Exceptions of the work other than noether's own are passed over: they will come again. Where no process can be made
/// nothing is tried.
/// @throws FileError with the message of the work's own Error; or that the file is damaged, where the child was killed
/// or ran out of memory
void try_in_child(const std::filesystem::path& file, const std::function<void()>& work);

/// Does the work in a child process, and if that comes back, here. @throws FileError as above; what the work throws
template <class Work> auto try_first(const std::filesystem::path& file, const Work& work) {
  try_in_child(file, [&] { static_cast<void>(work()); });
  return work();
}

}  // namespace noether::io
