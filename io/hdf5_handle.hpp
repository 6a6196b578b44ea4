#pragma once
/// What the files that speak with HDF5 share: an id that is closed with its owner, and errors that name the file. It
/// needs no header of HDF5: an id is an integer, a status another.

#include "io/element_type.hpp"
#include "io/ordered_file.hpp"
#include "numbers/types.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace noether::io {

namespace hdf5 {

/// What all handles of one file share.
struct FileState {
  std::string name;
  OrderedFile* ordered = nullptr;  ///< of a file that is written
};
using Context = std::shared_ptr<FileState>;

}  // namespace hdf5

class Hdf5Handle {
 public:
  using Close = int (*)(Hdf5Id);

  Hdf5Handle(Hdf5Id id, Close close, hdf5::Context file) : id_(id), close_(close), file_(std::move(file)) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, -1)), close_(other.close_), file_(std::move(other.file_)) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator Hdf5Id() const { return id_; }  // NOLINT: stands wherever HDF5 wants an id
  const hdf5::Context& file() const { return file_; }

 private:
  Hdf5Id id_;
  Close close_;
  hdf5::Context file_;
};

namespace hdf5 {

/// What HDF5 could not do, with its own reason. @throws FileError always
[[noreturn]] void fail(const Context& file, const std::string& what);
/// What HDF5 is content with, but noether is not. @throws FileError always
[[noreturn]] void refuse(const Context& file, const std::string& what);
/// Takes an id that HDF5 returned. @throws FileError if it is negative
Hdf5Handle own(Hdf5Id id, Hdf5Handle::Close close, const Context& file, const std::string& what);
std::shared_ptr<Hdf5Handle> share(Hdf5Id id, Hdf5Handle::Close close, const Context& file, const std::string& what);
/// @throws FileError if a status is negative
void check(int status, const Hdf5Handle& handle, const std::string& what);

std::string writing(const std::string& path);
std::string reading(const std::string& path);

/// Texts of one length, padded by zeros: those of variable length stand in a heap that HDF5 reads without a check.
Hdf5Handle text_type(const Context& file, std::size_t size);
/// No shape: a scalar.
Hdf5Handle space_of(const std::vector<Index>& shape, const Context& file, bool growing = false);
/// Only what noether writes is known, so that HDF5 never converts what a damaged file calls a number.
ElementType element_type(Hdf5Id type);

}  // namespace hdf5

}  // namespace noether::io
