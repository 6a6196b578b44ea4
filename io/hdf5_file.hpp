#pragma once
/// The part of HDF5 that noether's files use, without showing HDF5: every call checks, every error names its file.
///
/// In a build without HDF5 every function that opens a file throws FileError.

#include "io/element_type.hpp"
#include "numbers/types.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace noether::io {

/// Whether this build reads and writes HDF5 files.
bool has_hdf5() noexcept;

/// The version of HDF5 in use, such as "1.10.8"; empty in a build without it.
std::string hdf5_version();

/// Ends HDF5 in this process if none of its files is open, and so gives all of its memory back. Where it has written
/// beyond a block, as it can while it changes a damaged file, the process crashes here.
void end_hdf5();

/// One HDF5 object, closed with its last owner.
class Hdf5Handle;

/// A dataset, open. Its first axis counts rows; the others are one sample.
class Hdf5Dataset {
 public:
  Hdf5Dataset() = default;

  /// Number of rows; 1 for a scalar.
  Index rows() const;
  /// All axes; empty for a scalar.
  std::vector<Index> shape() const;
  /// All axes, of which there is at least one. @throws FileError
  std::vector<Index> growing_shape() const;
  ElementType type() const;
  /// Rows before the first of which not every byte is among the first `bytes` bytes of the file. @throws FileError
  Index rows_within(std::uint64_t bytes) const;

  /// Adds rows, one after the other. @throws FileError if the disk refuses
  void append(std::span<const double> rows);
  void append(std::span<const std::int64_t> rows);
  /// Cuts the dataset to `rows` rows, or lengthens it.
  void resize(Index rows);

  /// Whether it can have more rows.
  bool grows() const;

  /// From now on, in each flush, its length grows on disk after those of all others, and shrinks before them.
  void write_last() const;

  std::vector<double> read_reals() const;
  /// Rows [first, first + count).
  std::vector<double> read_reals(Index first, Index count) const;
  std::vector<std::int64_t> read_integers() const;
  std::vector<std::int64_t> read_integers(Index first, Index count) const;
  std::vector<std::string> read_texts() const;

 private:
  /// @param type  of HDF5, in memory
  template <class Number> std::vector<Number> read_rows(std::int64_t type, Index first, Index count) const;
  friend class Hdf5File;
  Hdf5Dataset(std::shared_ptr<Hdf5Handle> handle, std::string path)
      : handle_(std::move(handle)), path_(std::move(path)) {}
  void append_raw(const void* rows, std::size_t values, ElementType type);
  void require(ElementType expected) const;

  std::shared_ptr<Hdf5Handle> handle_;
  std::string path_;
};

/// An open HDF5 file. Paths are absolute ("/noether/scene"); groups on the way are made as needed.
class Hdf5File {
 public:
  /// Makes a new file; until take_name() it stands beside, as FILE.new. @throws FileError
  static Hdf5File create(const std::filesystem::path& file);
  /// @throws FileError if it is missing or no HDF5 file
  static Hdf5File open_to_read(const std::filesystem::path& file);
  static Hdf5File open_to_append(const std::filesystem::path& file);
  /// As open_to_append(), but nothing that is written reaches the disk.
  static Hdf5File open_to_rehearse(const std::filesystem::path& file);
  /// A file in memory only; `name` stands in messages.
  static Hdf5File create_in_memory(const std::filesystem::path& name);
  /// Reads a file that is in memory already.
  static Hdf5File open_bytes(const std::string& bytes, const std::filesystem::path& name);

  /// As messages name it.
  const std::string& name() const;
  /// The bytes that a file of this content has.
  std::string to_bytes() const;
  /// Hands everything to the operating system. What a kill or a full disk leaves is the file as of the last flush.
  /// @throws FileError if the disk refuses, now or since
  void flush() const;
  /// Flushes a new file and gives it its name, replacing an old one. @throws FileError
  void take_name() const;
  /// Says that datasets are about to become shorter; after the flush the file must be closed before it grows again.
  void begin_cut() const;

  void make_group(const std::string& path) const;
  bool has(const std::string& path) const;
  bool is_group(const std::string& path) const;
  /// Names below a group, sorted.
  std::vector<std::string> children(const std::string& path) const;
  /// Gives an object a second path.
  void link(const std::string& existing, const std::string& path) const;

  /// A fixed dataset, shape given; no shape: a scalar.
  void write(const std::string& path, std::span<const double> values, const std::vector<Index>& shape) const;
  void write(const std::string& path, std::span<const std::int64_t> values, const std::vector<Index>& shape) const;
  void write(const std::string& path, const std::vector<std::string>& values) const;
  /// One text, replaced where it exists.
  void write_text(const std::string& path, const std::string& text) const;

  /// A dataset that grows by rows: (unlimited, sample...), `chunk` rows to a piece on disk.
  Hdf5Dataset create_growing(const std::string& path, ElementType type, const std::vector<Index>& sample,
                             Index chunk) const;
  /// @throws FileError also if its shape is one that the file cannot hold
  Hdf5Dataset open(const std::string& path) const;
  std::string read_text(const std::string& path) const;

  bool has_attribute(const std::string& path, const std::string& name) const;
  /// Names of the attributes of an object, sorted. @throws FileError
  std::vector<std::string> attributes(const std::string& path) const;
  /// An attribute as it stands in the file, its type and shape in front; of a text of variable length nothing else.
  /// @throws FileError
  std::string attribute_bytes(const std::string& path, const std::string& name) const;
  /// Attributes are replaced where they exist.
  void set_attribute(const std::string& path, const std::string& name, const std::string& text) const;
  void set_attribute(const std::string& path, const std::string& name, const char* text) const {
    set_attribute(path, name, std::string(text));
  }
  void set_attribute(const std::string& path, const std::string& name, std::int64_t value) const;
  void set_attribute(const std::string& path, const std::string& name, double value) const;
  void set_attribute(const std::string& path, const std::string& name, const std::vector<std::int64_t>& values) const;
  void set_attribute(const std::string& path, const std::string& name, const std::vector<std::string>& values) const;
  /// A text as MDAnalysis wants that of `unit`: of variable length. noether reads none, because damage to one can crash
  /// HDF5.
  void set_variable_text(const std::string& path, const std::string& name, const std::string& text) const;
  /// Points at another object of the file, as H5MD's `particles_group` does. noether reads none.
  void set_reference(const std::string& path, const std::string& name, const std::string& target) const;
  /// Empty text, 0, or an empty list where there is no such attribute.
  std::string text_attribute(const std::string& path, const std::string& name) const;
  std::int64_t integer_attribute(const std::string& path, const std::string& name) const;
  std::vector<std::int64_t> integers_attribute(const std::string& path, const std::string& name) const;
  double real_attribute(const std::string& path, const std::string& name) const;

 private:
  explicit Hdf5File(std::shared_ptr<Hdf5Handle> handle) : handle_(std::move(handle)) {}

  std::shared_ptr<Hdf5Handle> handle_;
};

}  // namespace noether::io
