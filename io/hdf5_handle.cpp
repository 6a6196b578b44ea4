#include "io/hdf5_handle.hpp"

#include "io/hdf5_error.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>

#if NOETHER_HDF5

#include <hdf5.h>

namespace noether::io::hdf5 {

void fail(const Context& file, const std::string& what) {
  const std::string reason = take_hdf5_error();
  throw FileError(reason.empty() ? what : fmt::format("{}: {}", what, reason), {.file = file->name});
}
void refuse(const Context& file, const std::string& what) { throw FileError(what, {.file = file->name}); }

Hdf5Handle own(Hdf5Id id, Hdf5Handle::Close close, const Context& file, const std::string& what) {
  if (id < 0) fail(file, what);
  return {id, close, file};
}
std::shared_ptr<Hdf5Handle> share(Hdf5Id id, Hdf5Handle::Close close, const Context& file, const std::string& what) {
  if (id < 0) fail(file, what);
  return std::make_shared<Hdf5Handle>(id, close, file);
}
void check(int status, const Hdf5Handle& handle, const std::string& what) {
  if (status < 0) fail(handle.file(), what);
}

std::string writing(const std::string& path) { return fmt::format("cannot write '{}'", path); }
std::string reading(const std::string& path) { return fmt::format("cannot read '{}'", path); }

Hdf5Handle text_type(const Context& file, std::size_t size) {
  Hdf5Handle type = own(H5Tcopy(H5T_C_S1), H5Tclose, file, "cannot prepare a type");
  H5Tset_size(type, std::max<std::size_t>(size, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

Hdf5Handle space_of(const std::vector<Index>& shape, const Context& file, bool growing) {
  std::vector<hsize_t> now(shape.begin(), shape.end()), limit(now);
  if (growing) limit.at(0) = H5S_UNLIMITED;
  const hid_t id =
      shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(now.size()), now.data(), limit.data());
  return own(id, H5Sclose, file, "cannot prepare a shape");
}

ElementType element_type(Hdf5Id type) {
  if (H5Tequal(type, H5T_IEEE_F64LE) > 0) return ElementType::real;
  if (H5Tequal(type, H5T_STD_I64LE) > 0) return ElementType::integer;
  const bool text = H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0;
  return text ? ElementType::text : ElementType::other;
}

}  // namespace noether::io::hdf5

#endif
