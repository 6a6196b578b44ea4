#include "io/hdf5_file.hpp"

#include "engine/error.hpp"
#include "io/ordered_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <numeric>
#include <utility>

#if NOETHER_HDF5

#include <hdf5.h>

namespace noether::io {

bool has_hdf5() noexcept { return true; }

namespace {

/// What all handles of one file share.
struct FileState {
  std::string name;
  OrderedFile* ordered = nullptr;  ///< of a file that is written
};
using Context = std::shared_ptr<FileState>;

}  // namespace

class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle(hid_t id, Close close, Context file) : id_(id), close_(close), file_(std::move(file)) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, -1)), close_(other.close_), file_(std::move(other.file_)) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }  // NOLINT: stands wherever HDF5 wants an id
  const Context& file() const { return file_; }

 private:
  hid_t id_;
  Close close_;
  Context file_;
};

namespace {

/// Keeps the innermost description of HDF5's error stack, or the system's own words where it quotes them.
herr_t keep_reason(unsigned /*depth*/, const H5E_error2_t* entry, void* kept) {
  static constexpr std::string_view quote = "error message = '";
  auto& reason = *static_cast<std::string*>(kept);
  const std::string_view text = entry->desc == nullptr ? "" : entry->desc;
  if (const auto at = text.find(quote); at != std::string_view::npos) {
    const std::string_view rest = text.substr(at + quote.size());
    reason = rest.substr(0, rest.find('\''));
    return 1;
  }
  if (reason.empty()) reason = text;
  return 0;
}

[[noreturn]] void fail(const Context& file, const std::string& what) {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_reason, &reason);
  H5Eclear2(H5E_DEFAULT);
  throw FileError(reason.empty() ? what : fmt::format("{}: {}", what, reason), {.file = file->name});
}

/// Takes an id that HDF5 returned; a negative one is an error.
Hdf5Handle own(hid_t id, Hdf5Handle::Close close, const Context& file, const std::string& what) {
  if (id < 0) fail(file, what);
  return {id, close, file};
}
std::shared_ptr<Hdf5Handle> share(hid_t id, Hdf5Handle::Close close, const Context& file, const std::string& what) {
  if (id < 0) fail(file, what);
  return std::make_shared<Hdf5Handle>(id, close, file);
}
void check(herr_t status, const Hdf5Handle& handle, const std::string& what) {
  if (status < 0) fail(handle.file(), what);
}
/// After a write that failed HDF5 goes on as if nothing were wrong: it must be able to close the file.
void check_written(const Context& file) {
  const int error = file->ordered != nullptr ? write_error(*file->ordered) : 0;
  if (error != 0) throw FileError(fmt::format("cannot write the file: {}", std::strerror(error)), {.file = file->name});
}

std::string writing(const std::string& path) { return fmt::format("cannot write '{}'", path); }
std::string reading(const std::string& path) { return fmt::format("cannot read '{}'", path); }

/// Old file format, and no locks: an open reader must not stop a run.
Hdf5Handle access_list(const std::filesystem::path& name) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Context file = std::make_shared<FileState>(FileState{.name = name.string()});
  Hdf5Handle list = own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, file, "cannot prepare the file");
  check(H5Pset_file_locking(list, false, true), list, "cannot prepare the file");
  return list;
}

Hdf5Handle text_type(const Context& file) {
  Hdf5Handle type = own(H5Tcopy(H5T_C_S1), H5Tclose, file, "cannot prepare a type");
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

hid_t on_disk(ElementType type) { return type == ElementType::real ? H5T_IEEE_F64LE : H5T_STD_I64LE; }
hid_t in_memory(ElementType type) { return type == ElementType::real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64; }

Hdf5Handle space_of(const std::vector<Index>& shape, const Context& file, bool growing = false) {
  std::vector<hsize_t> now(shape.begin(), shape.end()), limit(now);
  if (growing) limit.at(0) = H5S_UNLIMITED;
  const hid_t id =
      shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(now.size()), now.data(), limit.data());
  return own(id, H5Sclose, file, "cannot prepare a shape");
}

Hdf5Handle linking(const Context& file) {
  Hdf5Handle list = own(H5Pcreate(H5P_LINK_CREATE), H5Pclose, file, "cannot prepare a link");
  H5Pset_create_intermediate_group(list, 1);
  return list;
}

/// How datasets are made: without the time of day, so that equal contents are equal bytes.
Hdf5Handle dataset_layout(const Context& file) {
  Hdf5Handle list = own(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, file, "cannot prepare a dataset");
  H5Pset_obj_track_times(list, false);
  return list;
}

/// Makes a fixed dataset and fills it.
void write_fixed(const Hdf5Handle& file, const std::string& path, hid_t stored, hid_t memory,
                 const std::vector<Index>& shape, const void* data) {
  const Hdf5Handle space = space_of(shape, file.file());
  const Hdf5Handle links = linking(file.file());
  const Hdf5Handle layout = dataset_layout(file.file());
  const Hdf5Handle dataset = own(H5Dcreate2(file, path.c_str(), stored, space, links, layout, H5P_DEFAULT), H5Dclose,
                                 file.file(), writing(path));
  if (H5Sget_simple_extent_npoints(space) > 0) {
    check(H5Dwrite(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), file, writing(path));
  }
}

/// Sets an attribute, replacing one of the same name.
void write_attribute(const Hdf5Handle& file, const std::string& path, const std::string& name, hid_t stored,
                     hid_t memory, const std::vector<Index>& shape, const void* data) {
  const std::string what = fmt::format("cannot write attribute '{}' of '{}'", name, path);
  const Hdf5Handle object = own(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, file.file(), what);
  if (H5Aexists(object, name.c_str()) > 0) check(H5Adelete(object, name.c_str()), file, what);
  const Hdf5Handle space = space_of(shape, file.file());
  const Hdf5Handle attribute =
      own(H5Acreate2(object, name.c_str(), stored, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, file.file(), what);
  check(H5Awrite(attribute, memory, data), file, what);
}

std::vector<const char*> pointers(const std::vector<std::string>& texts) {
  std::vector<const char*> result;
  for (const std::string& text : texts) result.push_back(text.c_str());
  return result;
}

ElementType element_type(hid_t type) {
  if (H5Tget_class(type) == H5T_FLOAT) return ElementType::real;
  if (H5Tget_class(type) == H5T_INTEGER) return ElementType::integer;
  return H5Tis_variable_str(type) > 0 ? ElementType::text : ElementType::other;
}

/// Whether every group on the way to `path`, and `path` itself, is there.
bool exists(const Hdf5Handle& file, const std::string& path) {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    const std::string part = path.substr(0, end);
    if (part != "/" && H5Lexists(file, part.c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

/// Opens an attribute if it is there and a scalar of the expected type; else the id is negative.
Hdf5Handle find_attribute(const Hdf5Handle& file, const std::string& path, const std::string& name,
                          ElementType expected) {
  const Hdf5Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, file.file());
  if (object < 0 || H5Aexists(object, name.c_str()) <= 0) return {-1, H5Aclose, file.file()};
  Hdf5Handle attribute = own(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, file.file(), reading(path));
  const Hdf5Handle type = own(H5Aget_type(attribute), H5Tclose, file.file(), reading(path));
  const Hdf5Handle space = own(H5Aget_space(attribute), H5Sclose, file.file(), reading(path));
  if (element_type(type) != expected || H5Sget_simple_extent_npoints(space) != 1) {
    throw FileError(
        fmt::format("attribute '{}' of '{}' has an unexpected type; was the file written by noether?", name, path),
        {.file = file.file()->name});
  }
  return attribute;
}

}  // namespace

// ---- datasets ------------------------------------------------------------------------------------------------------

std::vector<Index> Hdf5Dataset::shape() const {
  const Hdf5Handle space = own(H5Dget_space(*handle_), H5Sclose, handle_->file(), reading(path_));
  std::vector<hsize_t> axes(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  check(H5Sget_simple_extent_dims(space, axes.data(), nullptr), *handle_, reading(path_));
  return {axes.begin(), axes.end()};
}

Index Hdf5Dataset::rows() const {
  const std::vector<Index> axes = shape();
  return axes.empty() ? 1 : axes.front();
}

ElementType Hdf5Dataset::type() const {
  return element_type(own(H5Dget_type(*handle_), H5Tclose, handle_->file(), reading(path_)));
}

void Hdf5Dataset::require(ElementType expected) const {
  if (type() == expected) return;
  throw FileError(fmt::format("'{}' has an unexpected type; was the file written by noether?", path_),
                  {.file = handle_->file()->name});
}

void Hdf5Dataset::resize(Index rows) {
  std::vector<Index> axes = shape();
  axes.at(0) = rows;
  const std::vector<hsize_t> extent(axes.begin(), axes.end());
  check(H5Dset_extent(*handle_, extent.data()), *handle_, writing(path_));
  check_written(handle_->file());
}

void Hdf5Dataset::append_raw(const void* rows, std::size_t values, ElementType type) {
  const std::vector<Index> axes = shape();
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
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(target)));
  if (values.empty()) return values;
  check(H5Dread(*handle_, H5T_NATIVE_DOUBLE, target, source, H5P_DEFAULT, values.data()), *handle_, reading(path_));
  return values;
}

std::vector<std::int64_t> Hdf5Dataset::read_integers() const {
  require(ElementType::integer);
  const Hdf5Handle space = own(H5Dget_space(*handle_), H5Sclose, handle_->file(), reading(path_));
  std::vector<std::int64_t> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  if (values.empty()) return values;
  check(H5Dread(*handle_, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), *handle_, reading(path_));
  return values;
}

std::vector<std::string> Hdf5Dataset::read_texts() const {
  require(ElementType::text);
  const Hdf5Handle space = own(H5Dget_space(*handle_), H5Sclose, handle_->file(), reading(path_));
  std::vector<char*> raw(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)), nullptr);
  if (raw.empty()) return {};
  const Hdf5Handle type = text_type(handle_->file());
  check(H5Dread(*handle_, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, raw.data()), *handle_, reading(path_));
  std::vector<std::string> texts;
  for (const char* text : raw) texts.emplace_back(text == nullptr ? "" : text);
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, raw.data());
  return texts;
}

// ---- files ---------------------------------------------------------------------------------------------------------

Hdf5File Hdf5File::create(const std::filesystem::path& file) {
  const Hdf5Handle access = access_list(file);
  if (!use_ordered_driver(access)) fail(access.file(), "cannot prepare the file");
  // The name is given to a file that can be opened, if only an empty one.
  const std::string unnamed = file.string() + ".new";
  const Hdf5File made(share(H5Fcreate(unnamed.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, access.file(),
                            "cannot create the file"));
  access.file()->ordered = ordered_file(*made.handle_);
  made.flush();
  std::error_code error;
  std::filesystem::rename(unnamed, file, error);
  if (error) throw FileError("cannot create the file: " + error.message(), {.file = file.string()});
  return made;
}

namespace {
std::shared_ptr<Hdf5Handle> open_file(const std::filesystem::path& file, bool writing) {
  const Hdf5Handle access = access_list(file);
  if (writing && !use_ordered_driver(access)) fail(access.file(), "cannot prepare the file");
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) throw FileError("there is no such file", {.file = file.string()});
  if (!std::filesystem::is_regular_file(file, ignored)) throw FileError("this is no file", {.file = file.string()});
  const hid_t id = H5Fopen(file.c_str(), writing ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access);
  auto handle = share(id, H5Fclose, access.file(), "cannot be opened as an HDF5 file");
  if (writing) access.file()->ordered = ordered_file(id);
  return handle;
}
}  // namespace

Hdf5File Hdf5File::open_to_read(const std::filesystem::path& file) { return Hdf5File(open_file(file, false)); }
Hdf5File Hdf5File::open_to_append(const std::filesystem::path& file) { return Hdf5File(open_file(file, true)); }

namespace {
/// A name for a file in memory: HDF5 refuses one that is on disk, and nothing lies below a file.
std::string name_in_memory(const std::filesystem::path& name) { return (name / "in memory").string(); }
}  // namespace

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
  const Hdf5Handle type = text_type(handle_->file());
  write_fixed(*handle_, path, type, type, {static_cast<Index>(values.size())}, pointers(values).data());
}
void Hdf5File::write_text(const std::string& path, const std::string& text) const {
  if (has(path)) check(H5Ldelete(*handle_, path.c_str(), H5P_DEFAULT), *handle_, writing(path));
  const Hdf5Handle type = text_type(handle_->file());
  const char* pointer = text.c_str();
  write_fixed(*handle_, path, type, type, {}, &pointer);
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
  if (!has(path)) throw FileError(fmt::format("there is no '{}' in the file", path), {.file = handle_->file()->name});
  return {share(H5Dopen2(*handle_, path.c_str(), H5P_DEFAULT), H5Dclose, handle_->file(), reading(path)), path};
}

std::string Hdf5File::read_text(const std::string& path) const {
  const std::vector<std::string> texts = open(path).read_texts();
  return texts.empty() ? "" : texts.front();
}

// ---- attributes ----------------------------------------------------------------------------------------------------

bool Hdf5File::has_attribute(const std::string& path, const std::string& name) const {
  return has(path) && H5Aexists_by_name(*handle_, path.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

void Hdf5File::set_attribute(const std::string& path, const std::string& name, const std::string& text) const {
  const Hdf5Handle type = text_type(handle_->file());
  const char* pointer = text.c_str();
  write_attribute(*handle_, path, name, type, type, {}, &pointer);
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
  const Hdf5Handle type = text_type(handle_->file());
  write_attribute(*handle_, path, name, type, type, {static_cast<Index>(values.size())}, pointers(values).data());
}

std::string Hdf5File::text_attribute(const std::string& path, const std::string& name) const {
  const Hdf5Handle attribute = find_attribute(*handle_, path, name, ElementType::text);
  if (attribute < 0) return "";
  const Hdf5Handle type = text_type(handle_->file());
  char* raw = nullptr;
  check(H5Aread(attribute, type, &raw), *handle_, reading(path));
  std::string text = raw == nullptr ? "" : raw;
  H5free_memory(raw);
  return text;
}
std::int64_t Hdf5File::integer_attribute(const std::string& path, const std::string& name) const {
  const Hdf5Handle attribute = find_attribute(*handle_, path, name, ElementType::integer);
  std::int64_t value = 0;
  if (attribute >= 0) check(H5Aread(attribute, H5T_NATIVE_INT64, &value), *handle_, reading(path));
  return value;
}
double Hdf5File::real_attribute(const std::string& path, const std::string& name) const {
  const Hdf5Handle attribute = find_attribute(*handle_, path, name, ElementType::real);
  double value = 0;
  if (attribute >= 0) check(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), *handle_, reading(path));
  return value;
}

}  // namespace noether::io

#endif
