#include "io/hdf5_file.hpp"

#include "io/files.hpp"
#include "io/hdf5_handle.hpp"
#include "io/near_file.hpp"
#include "io/ordered_file.hpp"
#include "io/padded_texts.hpp"
#include "numbers/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <numeric>
#include <utility>

#if NOETHER_HDF5

#include <hdf5.h>

namespace noether::io {

bool has_hdf5() noexcept { return true; }

std::string hdf5_version() {
  unsigned major = 0, minor = 0, patch = 0;
  H5get_libversion(&major, &minor, &patch);
  return fmt::format("{}.{}.{}", major, minor, patch);
}

void end_hdf5() {
  if (H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL) == 0) H5close();
}

using namespace hdf5;

namespace {

/// After a write that failed HDF5 goes on as if nothing were wrong: it must be able to close the file.
void check_written(const Context& file) {
  const int error = file->ordered != nullptr ? write_error(*file->ordered) : 0;
  if (error != 0) refuse(file, fmt::format("cannot write the file: {}", std::strerror(error)));
}

/// Old file format, and no locks: an open reader must not stop a run.
Hdf5Handle access_list(const std::filesystem::path& name) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Context file = std::make_shared<FileState>(FileState{.name = name.string()});
  Hdf5Handle list = own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, file, "cannot prepare the file");
  check(H5Pset_file_locking(list, false, true), list, "cannot prepare the file");
  return list;
}

hid_t on_disk(ElementType type) { return type == ElementType::real ? H5T_IEEE_F64LE : H5T_STD_I64LE; }
hid_t in_memory(ElementType type) { return type == ElementType::real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64; }

Hdf5Handle linking(const Context& file) {
  Hdf5Handle list = own(H5Pcreate(H5P_LINK_CREATE), H5Pclose, file, "cannot prepare a link");
  H5Pset_create_intermediate_group(list, 1);
  return list;
}

/// How datasets are made: without the time of day, so that equal contents are equal bytes.
Hdf5Handle dataset_layout(const Context& file, H5D_layout_t layout = H5D_CONTIGUOUS) {
  Hdf5Handle list = own(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, file, "cannot prepare a dataset");
  H5Pset_obj_track_times(list, false);
  H5Pset_layout(list, layout);
  return list;
}

/// Makes a fixed dataset and fills it.
void write_fixed(const Hdf5Handle& file, const std::string& path, hid_t stored, hid_t memory,
                 const std::vector<Index>& shape, const void* data, H5D_layout_t kind = H5D_CONTIGUOUS) {
  const Hdf5Handle space = space_of(shape, file.file());
  const Hdf5Handle links = linking(file.file());
  const Hdf5Handle layout = dataset_layout(file.file(), kind);
  const Hdf5Handle dataset = own(H5Dcreate2(file, path.c_str(), stored, space, links, layout, H5P_DEFAULT), H5Dclose,
                                 file.file(), writing(path));
  if (H5Sget_simple_extent_npoints(space) > 0) {
    check(H5Dwrite(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), file, writing(path));
  }
}

/// All axes; none of a scalar.
std::vector<hsize_t> axes_of(const Hdf5Handle& dataset, const std::string& path) {
  const Hdf5Handle space = own(H5Dget_space(dataset), H5Sclose, dataset.file(), reading(path));
  std::vector<hsize_t> axes(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  check(H5Sget_simple_extent_dims(space, axes.data(), nullptr), dataset, reading(path));
  return axes;
}

/// The bytes of one element. @throws FileError also for 0
std::size_t element_size(const Hdf5Handle& dataset, const std::string& path) {
  const Hdf5Handle type = own(H5Dget_type(dataset), H5Tclose, dataset.file(), reading(path));
  if (const std::size_t size = H5Tget_size(type); size > 0) return size;
  fail(dataset.file(), reading(path));
}

/// A damaged shape must not ask for more than there can be: noether writes every element of every dataset.
void check_size(const Hdf5Handle& file, const Hdf5Handle& dataset, const std::string& path) {
  hsize_t size = 0;
  check(H5Fget_filesize(file, &size), file, reading(path));
  const std::vector<hsize_t> axes = axes_of(dataset, path);
  hsize_t room = size / element_size(dataset, path);
  for (const hsize_t axis : axes) {
    if (axis == 0) return;
    room /= axis;
  }
  const std::string shape = fmt::format("{}", fmt::join(axes, ", "));
  if (room == 0)
    refuse(file.file(), fmt::format("damaged: '{}' of shape ({}) would be larger than the file", path, shape));
}

/// Rows to a piece of a dataset on disk; 0 if the dataset is in one.
hsize_t chunk_rows(const Hdf5Handle& dataset, const std::string& path) {
  const Hdf5Handle layout = own(H5Dget_create_plist(dataset), H5Pclose, dataset.file(), reading(path));
  if (H5Pget_layout(layout) != H5D_CHUNKED) return 0;
  std::array<hsize_t, H5S_MAX_RANK> axes{};
  if (H5Pget_chunk(layout, H5S_MAX_RANK, axes.data()) <= 0 || axes[0] == 0) fail(dataset.file(), reading(path));
  return axes[0];
}

haddr_t chunk_address(const Hdf5Handle& dataset, const std::vector<hsize_t>& corner, const std::string& path) {
  unsigned filters = 0;
  haddr_t at = HADDR_UNDEF;
  hsize_t size = 0;
  check(H5Dget_chunk_info_by_coord(dataset, corner.data(), &filters, &at, &size), dataset, reading(path));
  return at;
}

/// Whether every group on the way to `path`, and `path` itself, is there.
bool exists(const Hdf5Handle& file, const std::string& path) {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    const std::string part = path.substr(0, end);
    if (part != "/" && H5Lexists(file, part.c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

}  // namespace

// ---- datasets ------------------------------------------------------------------------------------------------------

std::vector<Index> Hdf5Dataset::shape() const {
  const std::vector<hsize_t> axes = axes_of(*handle_, path_);
  return {axes.begin(), axes.end()};
}

Index Hdf5Dataset::rows() const {
  const std::vector<hsize_t> axes = axes_of(*handle_, path_);
  if (axes.empty()) return 1;
  // Of a process that was killed within its first write to a header, half may be there: rows without data.
  const bool is_written = axes[0] == 0 || chunk_rows(*handle_, path_) == 0 ||
                          chunk_address(*handle_, std::vector<hsize_t>(axes.size(), 0), path_) != HADDR_UNDEF;
  return is_written ? static_cast<Index>(axes[0]) : 0;
}

Index Hdf5Dataset::rows_within(std::uint64_t bytes) const {
  std::vector<hsize_t> axes = axes_of(*handle_, path_);
  if (axes.empty()) axes = {1};
  const hsize_t count = axes[0], at_once = chunk_rows(*handle_, path_);
  if (at_once == 0) {
    const haddr_t at = H5Dget_offset(*handle_);  // none: it stands in the header, which has been read
    return static_cast<Index>(at == HADDR_UNDEF || at + H5Dget_storage_size(*handle_) <= bytes ? count : 0);
  }
  const hsize_t row = std::accumulate(axes.begin() + 1, axes.end(), element_size(*handle_, path_), std::multiplies<>());
  std::vector<hsize_t> corner(axes.size(), 0);
  for (hsize_t& first = corner[0]; first < count; first += at_once) {
    const haddr_t at = chunk_address(*handle_, corner, path_);
    const hsize_t wanted = std::min(at_once, count - first);
    const hsize_t held = at < bytes && row > 0 ? std::min(wanted, (bytes - at) / row) : 0;
    if (held < wanted) return static_cast<Index>(first + held);
  }
  return static_cast<Index>(count);
}

bool Hdf5Dataset::grows() const {
  const Hdf5Handle space = own(H5Dget_space(*handle_), H5Sclose, handle_->file(), reading(path_));
  std::vector<hsize_t> most(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  check(H5Sget_simple_extent_dims(space, nullptr, most.data()), *handle_, reading(path_));
  return !most.empty() && most[0] == H5S_UNLIMITED;
}

ElementType Hdf5Dataset::type() const {
  return element_type(own(H5Dget_type(*handle_), H5Tclose, handle_->file(), reading(path_)));
}

void Hdf5Dataset::require(ElementType expected) const {
  if (type() != expected)
    refuse(handle_->file(), fmt::format("'{}' has an unexpected type; the file may not be written by noether", path_));
}

std::vector<Index> Hdf5Dataset::growing_shape() const {
  std::vector<Index> axes = shape();
  if (axes.empty()) refuse(handle_->file(), fmt::format("damaged: '{}' has no rows", path_));
  return axes;
}

void Hdf5Dataset::resize(Index rows) {
  std::vector<Index> axes = growing_shape();
  axes[0] = rows;
  const std::vector<hsize_t> extent(axes.begin(), axes.end());
  check(H5Dset_extent(*handle_, extent.data()), *handle_, writing(path_));
  check_written(handle_->file());
}

void Hdf5Dataset::write_last() const {
#if H5_VERSION_GE(1, 12, 0)
  H5O_info1_t header{};
#else
  H5O_info_t header{};
#endif
  check(H5Oget_info1(*handle_, &header), *handle_, reading(path_));
  if (handle_->file()->ordered != nullptr) io::write_last(*handle_->file()->ordered, header.addr);
}

void Hdf5Dataset::append_raw(const void* rows, std::size_t values, ElementType type) {
  require(type);  // HDF5 would convert to whatever a damaged file calls a number
  const std::vector<Index> axes = growing_shape();
  const Index to_a_row = std::accumulate(axes.begin() + 1, axes.end(), Index{1}, std::multiplies<>());
  NOETHER_EXPECTS(to_a_row > 0 && static_cast<Index>(values) % to_a_row == 0,
                  fmt::format("a row of '{}' has {} values, {} were given", path_, to_a_row, values));
  std::vector<hsize_t> first(axes.size(), 0), count(axes.begin(), axes.end()), extent(count);
  first.at(0) = count[0];
  count[0] = values / static_cast<hsize_t>(to_a_row);
  extent[0] = first[0] + count[0];
  check(H5Dset_extent(*handle_, extent.data()), *handle_, writing(path_));
  const Hdf5Handle target = own(H5Dget_space(*handle_), H5Sclose, handle_->file(), writing(path_));
  H5Sselect_hyperslab(target, H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr);
  const Hdf5Handle source = space_of({count.begin(), count.end()}, handle_->file());
  check(H5Dwrite(*handle_, in_memory(type), source, target, H5P_DEFAULT, rows), *handle_, writing(path_));
  check_written(handle_->file());
}

void Hdf5Dataset::append(std::span<const double> rows) { append_raw(rows.data(), rows.size(), ElementType::real); }
void Hdf5Dataset::append(std::span<const std::int64_t> rows) {
  append_raw(rows.data(), rows.size(), ElementType::integer);
}

std::vector<double> Hdf5Dataset::read_reals() const { return read_reals(0, rows()); }

std::vector<double> Hdf5Dataset::read_reals(Index first, Index count) const {
  require(ElementType::real);
  return read_rows<double>(H5T_NATIVE_DOUBLE, first, count);
}

std::vector<std::int64_t> Hdf5Dataset::read_integers() const { return read_integers(0, rows()); }

std::vector<std::int64_t> Hdf5Dataset::read_integers(Index first, Index count) const {
  require(ElementType::integer);
  return read_rows<std::int64_t>(H5T_NATIVE_INT64, first, count);
}

template <class Number> std::vector<Number> Hdf5Dataset::read_rows(std::int64_t type, Index first, Index count) const {
  const std::vector<Index> axes = shape();
  std::vector<hsize_t> start(axes.size(), 0), extent(axes.begin(), axes.end());
  const Hdf5Handle source = own(H5Dget_space(*handle_), H5Sclose, handle_->file(), reading(path_));
  if (!axes.empty()) {
    start[0] = static_cast<hsize_t>(first);
    extent[0] = static_cast<hsize_t>(count);
    check(H5Sselect_hyperslab(source, H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr), *handle_,
          reading(path_));
  }
  const Hdf5Handle target = space_of({extent.begin(), extent.end()}, handle_->file());
  std::vector<Number> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(target)));
  if (values.empty()) return values;
  check(H5Dread(*handle_, type, target, source, H5P_DEFAULT, values.data()), *handle_, reading(path_));
  return values;
}

std::vector<std::string> Hdf5Dataset::read_texts() const {
  require(ElementType::text);
  const Hdf5Handle space = own(H5Dget_space(*handle_), H5Sclose, handle_->file(), reading(path_));
  const Hdf5Handle stored = own(H5Dget_type(*handle_), H5Tclose, handle_->file(), reading(path_));
  PaddedTexts raw{H5Tget_size(stored), ""};
  raw.bytes.resize(raw.size * static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  if (raw.bytes.empty()) return {};
  const Hdf5Handle type = text_type(handle_->file(), raw.size);
  check(H5Dread(*handle_, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, raw.bytes.data()), *handle_, reading(path_));
  return unpad(raw);
}

// ---- files ---------------------------------------------------------------------------------------------------------

Hdf5File Hdf5File::create(const std::filesystem::path& file) {
  const Hdf5Handle access = access_list(file);
  if (!use_ordered_driver(access)) fail(access.file(), "cannot prepare the file");
  const std::string unnamed = file.string() + ".new";
  const Hdf5File made(share(H5Fcreate(unnamed.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, access.file(),
                            "cannot create the file"));
  access.file()->ordered = ordered_file(*made.handle_);
  return made;
}

void Hdf5File::take_name() const {
  flush();
  rename_if_there(name() + ".new", name());
}

namespace {

std::shared_ptr<Hdf5Handle> open_file(const std::filesystem::path& file, bool writing) {
  const Hdf5Handle access = access_list(file);
  if (writing && !use_ordered_driver(access)) fail(access.file(), "cannot prepare the file");
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    refuse(access.file(), "there is no such file" + near_file(file, "run.h5"));
  if (!std::filesystem::is_regular_file(file, ignored))
    refuse(access.file(), "this is not a regular file" + near_file(file, "run.h5"));
  const hid_t id = H5Fopen(file.c_str(), writing ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access);
  const std::uintmax_t size = id < 0 ? std::filesystem::file_size(file, ignored) : 0;
  if (id < 0 && size < expected_size(file))
    refuse(access.file(), fmt::format("cut short: only {} of {} bytes are there", size, expected_size(file)));
  if (id < 0 && file.extension() == ".toml") {
    refuse(access.file(), "this is a scene, and a file of a run is expected" + near_file(file, "run.h5"));
  }
  auto handle = share(id, H5Fclose, access.file(), "cannot be opened as an HDF5 file");
  if (writing) access.file()->ordered = ordered_file(id);
  return handle;
}

/// A name for a file in memory: HDF5 refuses one that is on disk, and nothing lies below a file.
std::string name_in_memory(const std::filesystem::path& name) { return (name / "in memory").string(); }

}  // namespace

Hdf5File Hdf5File::open_to_read(const std::filesystem::path& file) { return Hdf5File(open_file(file, false)); }
Hdf5File Hdf5File::open_to_append(const std::filesystem::path& file) { return Hdf5File(open_file(file, true)); }
Hdf5File Hdf5File::open_to_rehearse(const std::filesystem::path& file) {
  Hdf5File opened = open_to_append(file);
  keep_in_memory(*opened.handle_->file()->ordered);
  return opened;
}

Hdf5File Hdf5File::create_in_memory(const std::filesystem::path& name) {
  const Hdf5Handle access = access_list(name);
  check(H5Pset_fapl_core(access, 1 << 20, false), access, "cannot prepare the file");
  return Hdf5File(share(H5Fcreate(name_in_memory(name).c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose,
                        access.file(), "cannot prepare the file"));
}

Hdf5File Hdf5File::open_bytes(const std::string& bytes, const std::filesystem::path& name) {
  const Hdf5Handle access = access_list(name);
  check(H5Pset_fapl_core(access, 1 << 20, false), access, "cannot read the file");
  // HDF5 copies the image and does not change it.
  check(H5Pset_file_image(access, const_cast<char*>(bytes.data()), bytes.size()), access, "cannot read the file");
  return Hdf5File(share(H5Fopen(name_in_memory(name).c_str(), H5F_ACC_RDONLY, access), H5Fclose, access.file(),
                        "cannot be opened as an HDF5 file"));
}

const std::string& Hdf5File::name() const { return handle_->file()->name; }

std::string Hdf5File::to_bytes() const {
  flush();
  const ssize_t size = H5Fget_file_image(*handle_, nullptr, 0);
  std::string bytes(static_cast<std::size_t>(std::max<ssize_t>(size, 0)), '\0');
  if (size <= 0 || H5Fget_file_image(*handle_, bytes.data(), bytes.size()) != size) {
    fail(handle_->file(), "cannot take the bytes of the file");
  }
  return bytes;
}

void Hdf5File::flush() const {
  check(H5Fflush(*handle_, H5F_SCOPE_LOCAL), *handle_, "cannot write the file");
  check_written(handle_->file());
}

void Hdf5File::begin_cut() const {
  if (handle_->file()->ordered != nullptr) io::begin_cut(*handle_->file()->ordered);
}

void Hdf5File::make_group(const std::string& path) const {
  if (has(path)) return;
  const Hdf5Handle links = linking(handle_->file());
  own(H5Gcreate2(*handle_, path.c_str(), links, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, handle_->file(), writing(path));
}

bool Hdf5File::has(const std::string& path) const { return exists(*handle_, path); }

bool Hdf5File::is_group(const std::string& path) const {
  if (!has(path)) return false;
  const Hdf5Handle object(H5Oopen(*handle_, path.c_str(), H5P_DEFAULT), H5Oclose, handle_->file());
  return object >= 0 && H5Iget_type(object) == H5I_GROUP;
}

std::vector<std::string> Hdf5File::children(const std::string& path) const {
  std::vector<std::string> names;
  if (!is_group(path)) return names;
  const Hdf5Handle group = own(H5Gopen2(*handle_, path.c_str(), H5P_DEFAULT), H5Gclose, handle_->file(), reading(path));
  const auto keep = [](hid_t, const char* name, const H5L_info_t*, void* kept) -> herr_t {
    static_cast<std::vector<std::string>*>(kept)->emplace_back(name);
    return 0;
  };
  check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, keep, &names), *handle_, reading(path));
  return names;
}

void Hdf5File::link(const std::string& existing, const std::string& path) const {
  const Hdf5Handle links = linking(handle_->file());
  check(H5Lcreate_hard(*handle_, existing.c_str(), *handle_, path.c_str(), links, H5P_DEFAULT), *handle_,
        writing(path));
}

void Hdf5File::write(const std::string& path, std::span<const double> values, const std::vector<Index>& shape) const {
  write_fixed(*handle_, path, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, shape, values.data());
}
void Hdf5File::write(const std::string& path, std::span<const std::int64_t> values,
                     const std::vector<Index>& shape) const {
  write_fixed(*handle_, path, H5T_STD_I64LE, H5T_NATIVE_INT64, shape, values.data());
}
void Hdf5File::write(const std::string& path, const std::vector<std::string>& values) const {
  const PaddedTexts padded = pad(values);
  const Hdf5Handle type = text_type(handle_->file(), padded.size);
  write_fixed(*handle_, path, type, type, {static_cast<Index>(values.size())}, padded.bytes.data());
}
void Hdf5File::write_text(const std::string& path, const std::string& text) const {
  if (has(path)) check(H5Ldelete(*handle_, path.c_str(), H5P_DEFAULT), *handle_, writing(path));
  const PaddedTexts padded = pad({text});
  const Hdf5Handle type = text_type(handle_->file(), padded.size);
  // Within the dataset's header, where it fits, a text reaches the disk in its turn, as a part of the file's metadata.
  constexpr std::size_t fits = 60'000;
  write_fixed(*handle_, path, type, type, {}, padded.bytes.data(), padded.size < fits ? H5D_COMPACT : H5D_CONTIGUOUS);
}

Hdf5Dataset Hdf5File::create_growing(const std::string& path, ElementType type, const std::vector<Index>& sample,
                                     Index chunk) const {
  std::vector<Index> shape{0}, piece{chunk};
  for (const Index axis : sample) {
    shape.push_back(axis);
    piece.push_back(std::max<Index>(axis, 1));
  }
  const Hdf5Handle space = space_of(shape, handle_->file(), true);
  const Hdf5Handle links = linking(handle_->file());
  const Hdf5Handle layout = dataset_layout(handle_->file());
  const std::vector<hsize_t> axes(piece.begin(), piece.end());
  check(H5Pset_chunk(layout, static_cast<int>(axes.size()), axes.data()), *handle_, writing(path));
  check(H5Pset_fill_time(layout, H5D_FILL_TIME_NEVER), *handle_, writing(path));
  return {share(H5Dcreate2(*handle_, path.c_str(), on_disk(type), space, links, layout, H5P_DEFAULT), H5Dclose,
                handle_->file(), writing(path)),
          path};
}

Hdf5Dataset Hdf5File::open(const std::string& path) const {
  if (!has(path)) refuse(handle_->file(), fmt::format("there is no '{}' in the file", path));
  auto dataset = share(H5Dopen2(*handle_, path.c_str(), H5P_DEFAULT), H5Dclose, handle_->file(), reading(path));
  check_size(*handle_, *dataset, path);
  return {std::move(dataset), path};
}

std::string Hdf5File::read_text(const std::string& path) const {
  const std::vector<std::string> texts = open(path).read_texts();
  return texts.empty() ? "" : texts.front();
}

}  // namespace noether::io

#endif
