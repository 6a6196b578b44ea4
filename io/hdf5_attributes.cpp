#include "io/hdf5_file.hpp"
#include "io/hdf5_handle.hpp"
#include "io/padded_texts.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

#if NOETHER_HDF5

#include <hdf5.h>

namespace noether::io {

using namespace hdf5;

namespace {

/// Writes an attribute where it is, if it is there with this type and shape. A new one may move others between the
/// blocks of a header, and a process can be killed between two blocks.
bool write_in_place(const Hdf5Handle& file, const Hdf5Handle& object, const std::string& name, hid_t stored,
                    hid_t memory, const Hdf5Handle& space, const void* data, const std::string& what) {
  const Hdf5Handle attribute = own(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, file.file(), what);
  const Hdf5Handle type = own(H5Aget_type(attribute), H5Tclose, file.file(), what);
  const Hdf5Handle extent = own(H5Aget_space(attribute), H5Sclose, file.file(), what);
  if (H5Tequal(type, stored) <= 0 || H5Sextent_equal(extent, space) <= 0) return false;
  check(H5Awrite(attribute, memory, data), file, what);
  return true;
}

/// Sets an attribute, replacing one of the same name.
void write_attribute(const Hdf5Handle& file, const std::string& path, const std::string& name, hid_t stored,
                     hid_t memory, const std::vector<Index>& shape, const void* data) {
  const std::string what = fmt::format("cannot write attribute '{}' of '{}'", name, path);
  const Hdf5Handle object = own(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, file.file(), what);
  const Hdf5Handle space = space_of(shape, file.file());
  if (H5Aexists(object, name.c_str()) > 0) {
    if (write_in_place(file, object, name, stored, memory, space, data, what)) return;
    check(H5Adelete(object, name.c_str()), file, what);
  }
  const Hdf5Handle attribute =
      own(H5Acreate2(object, name.c_str(), stored, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, file.file(), what);
  check(H5Awrite(attribute, memory, data), file, what);
}

/// Opens an attribute if it is there; else the id is negative. It must be of the expected type, and hold 1 to `most`
/// values.
Hdf5Handle find_attribute(const Hdf5Handle& file, const std::string& path, const std::string& name,
                          ElementType expected, hssize_t most = 1) {
  const Hdf5Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, file.file());
  if (object < 0 || H5Aexists(object, name.c_str()) <= 0) return {-1, H5Aclose, file.file()};
  Hdf5Handle attribute = own(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, file.file(), reading(path));
  const Hdf5Handle type = own(H5Aget_type(attribute), H5Tclose, file.file(), reading(path));
  const Hdf5Handle space = own(H5Aget_space(attribute), H5Sclose, file.file(), reading(path));
  const hssize_t values = H5Sget_simple_extent_npoints(space);
  if (element_type(type) != expected || values < 1 || values > most) {
    refuse(file.file(),
           fmt::format("attribute '{}' of '{}' has an unexpected type; the file may not be written by noether", name,
                       path));
  }
  return attribute;
}

}  // namespace

bool Hdf5File::has_attribute(const std::string& path, const std::string& name) const {
  return has(path) && H5Aexists_by_name(*handle_, path.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5File::attributes(const std::string& path) const {
  const Hdf5Handle object = own(H5Oopen(*handle_, path.c_str(), H5P_DEFAULT), H5Oclose, handle_->file(), reading(path));
  const auto keep = [](hid_t, const char* name, const H5A_info_t*, void* kept) -> herr_t {
    static_cast<std::vector<std::string>*>(kept)->emplace_back(name);
    return 0;
  };
  std::vector<std::string> names;
  check(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, keep, &names), *handle_, reading(path));
  return names;
}

std::string Hdf5File::attribute_bytes(const std::string& path, const std::string& name) const {
  constexpr hssize_t most = 65536;  // attributes stand in headers, which are short
  const std::string what = fmt::format("cannot read attribute '{}' of '{}'", name, path);
  const Hdf5Handle object = own(H5Oopen(*handle_, path.c_str(), H5P_DEFAULT), H5Oclose, handle_->file(), what);
  const Hdf5Handle attribute = own(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, handle_->file(), what);
  const Hdf5Handle type = own(H5Aget_type(attribute), H5Tclose, handle_->file(), what);
  const Hdf5Handle space = own(H5Aget_space(attribute), H5Sclose, handle_->file(), what);
  const auto size = static_cast<hssize_t>(H5Tget_size(type)), values = H5Sget_simple_extent_npoints(space);
  std::string bytes = fmt::format("{} of {} x {}:", static_cast<int>(element_type(type)), values, size);
  if (H5Tis_variable_str(type) != 0 || H5Tdetect_class(type, H5T_VLEN) != 0 || values < 1) return bytes;
  if (size < 1 || size > most || values > most / size) refuse(handle_->file(), what);
  const std::size_t begin = bytes.size();
  bytes.resize(begin + static_cast<std::size_t>(size * values));
  check(H5Aread(attribute, type, bytes.data() + begin), *handle_, what);
  return bytes;
}

void Hdf5File::set_attribute(const std::string& path, const std::string& name, const std::string& text) const {
  const PaddedTexts padded = pad({text});
  const Hdf5Handle type = text_type(handle_->file(), padded.size);
  write_attribute(*handle_, path, name, type, type, {}, padded.bytes.data());
}
void Hdf5File::set_variable_text(const std::string& path, const std::string& name, const std::string& text) const {
  const Hdf5Handle type = text_type(handle_->file(), H5T_VARIABLE);
  const char* pointer = text.c_str();
  write_attribute(*handle_, path, name, type, type, {}, &pointer);
}
void Hdf5File::set_reference(const std::string& path, const std::string& name, const std::string& target) const {
  hobj_ref_t reference = 0;
  check(H5Rcreate(&reference, *handle_, target.c_str(), H5R_OBJECT, -1), *handle_, writing(path));
  write_attribute(*handle_, path, name, H5T_STD_REF_OBJ, H5T_STD_REF_OBJ, {}, &reference);
}
void Hdf5File::set_attribute(const std::string& path, const std::string& name, std::int64_t value) const {
  write_attribute(*handle_, path, name, H5T_STD_I64LE, H5T_NATIVE_INT64, {}, &value);
}
void Hdf5File::set_attribute(const std::string& path, const std::string& name, double value) const {
  write_attribute(*handle_, path, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {}, &value);
}
void Hdf5File::set_attribute(const std::string& path, const std::string& name,
                             const std::vector<std::int64_t>& values) const {
  write_attribute(*handle_, path, name, H5T_STD_I64LE, H5T_NATIVE_INT64, {static_cast<Index>(values.size())},
                  values.data());
}
void Hdf5File::set_attribute(const std::string& path, const std::string& name,
                             const std::vector<std::string>& values) const {
  const PaddedTexts padded = pad(values);
  const Hdf5Handle type = text_type(handle_->file(), padded.size);
  write_attribute(*handle_, path, name, type, type, {static_cast<Index>(values.size())}, padded.bytes.data());
}

std::string Hdf5File::text_attribute(const std::string& path, const std::string& name) const {
  const Hdf5Handle attribute = find_attribute(*handle_, path, name, ElementType::text);
  if (attribute < 0) return "";
  const Hdf5Handle stored = own(H5Aget_type(attribute), H5Tclose, handle_->file(), reading(path));
  PaddedTexts raw{H5Tget_size(stored), ""};
  // Attributes stand in headers, which are short.
  if (raw.size > 65536)
    refuse(handle_->file(), fmt::format("damaged: the length of attribute '{}' of '{}'", name, path));
  raw.bytes.resize(raw.size);
  const Hdf5Handle type = text_type(handle_->file(), raw.size);
  check(H5Aread(attribute, type, raw.bytes.data()), *handle_, reading(path));
  return unpad(raw).at(0);
}
std::int64_t Hdf5File::integer_attribute(const std::string& path, const std::string& name) const {
  const Hdf5Handle attribute = find_attribute(*handle_, path, name, ElementType::integer);
  std::int64_t value = 0;
  if (attribute >= 0) check(H5Aread(attribute, H5T_NATIVE_INT64, &value), *handle_, reading(path));
  return value;
}
std::vector<std::int64_t> Hdf5File::integers_attribute(const std::string& path, const std::string& name) const {
  constexpr hssize_t most = 4096;  // attributes stand in headers, which are short
  const Hdf5Handle attribute = find_attribute(*handle_, path, name, ElementType::integer, most);
  if (attribute < 0) return {};
  const Hdf5Handle space = own(H5Aget_space(attribute), H5Sclose, handle_->file(), reading(path));
  std::vector<std::int64_t> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  check(H5Aread(attribute, H5T_NATIVE_INT64, values.data()), *handle_, reading(path));
  return values;
}
double Hdf5File::real_attribute(const std::string& path, const std::string& name) const {
  const Hdf5Handle attribute = find_attribute(*handle_, path, name, ElementType::real);
  double value = 0;
  if (attribute >= 0) check(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), *handle_, reading(path));
  return value;
}

}  // namespace noether::io

#endif
