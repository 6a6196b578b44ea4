// The same functions in a build without HDF5: opening a file throws, and nothing else can be reached.
#include "io/hdf5_file.hpp"
#include "io/ordered_file.hpp"
#include "numbers/error.hpp"

#if !NOETHER_HDF5

namespace noether::io {

bool has_hdf5() noexcept { return false; }

std::string hdf5_version() { return ""; }
void end_hdf5() {}

class Hdf5Handle {};

std::uint64_t expected_size(const std::filesystem::path&) { return 0; }

namespace {

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw FileError("this build has no HDF5: configure with -DNOETHER_HDF5=ON, or use the preset release",
                  {.file = file.string()});
}
[[noreturn]] void unreachable() { throw LogicError("a dataset is used in a build without HDF5"); }

}  // namespace

Index Hdf5Dataset::rows() const { unreachable(); }
std::vector<Index> Hdf5Dataset::shape() const { unreachable(); }
std::vector<Index> Hdf5Dataset::growing_shape() const { unreachable(); }
Index Hdf5Dataset::rows_within(std::uint64_t) const { unreachable(); }
bool Hdf5Dataset::grows() const { unreachable(); }
ElementType Hdf5Dataset::type() const { unreachable(); }
void Hdf5Dataset::append(std::span<const double>) { unreachable(); }
void Hdf5Dataset::append(std::span<const std::int64_t>) { unreachable(); }
void Hdf5Dataset::resize(Index) { unreachable(); }
void Hdf5Dataset::write_last() const { unreachable(); }
std::vector<double> Hdf5Dataset::read_reals() const { unreachable(); }
std::vector<double> Hdf5Dataset::read_reals(Index, Index) const { unreachable(); }
std::vector<std::int64_t> Hdf5Dataset::read_integers() const { unreachable(); }
std::vector<std::int64_t> Hdf5Dataset::read_integers(Index, Index) const { unreachable(); }
std::vector<std::string> Hdf5Dataset::read_texts() const { unreachable(); }

Hdf5File Hdf5File::create(const std::filesystem::path& file) { refuse(file); }
Hdf5File Hdf5File::open_to_read(const std::filesystem::path& file) { refuse(file); }
Hdf5File Hdf5File::open_to_append(const std::filesystem::path& file) { refuse(file); }
Hdf5File Hdf5File::open_to_rehearse(const std::filesystem::path& file) { refuse(file); }
Hdf5File Hdf5File::create_in_memory(const std::filesystem::path& name) { refuse(name); }
Hdf5File Hdf5File::open_bytes(const std::string&, const std::filesystem::path& name) { refuse(name); }
const std::string& Hdf5File::name() const { unreachable(); }
std::string Hdf5File::to_bytes() const { unreachable(); }
void Hdf5File::begin_cut() const { unreachable(); }
void Hdf5File::flush() const { unreachable(); }
void Hdf5File::take_name() const { unreachable(); }
void Hdf5File::make_group(const std::string&) const { unreachable(); }
bool Hdf5File::has(const std::string&) const { unreachable(); }
bool Hdf5File::is_group(const std::string&) const { unreachable(); }
std::vector<std::string> Hdf5File::children(const std::string&) const { unreachable(); }
void Hdf5File::link(const std::string&, const std::string&) const { unreachable(); }
void Hdf5File::write(const std::string&, std::span<const double>, const std::vector<Index>&) const { unreachable(); }
void Hdf5File::write(const std::string&, std::span<const std::int64_t>, const std::vector<Index>&) const {
  unreachable();
}
void Hdf5File::write(const std::string&, const std::vector<std::string>&) const { unreachable(); }
void Hdf5File::write_text(const std::string&, const std::string&) const { unreachable(); }
Hdf5Dataset Hdf5File::create_growing(const std::string&, ElementType, const std::vector<Index>&, Index) const {
  unreachable();
}
Hdf5Dataset Hdf5File::open(const std::string&) const { unreachable(); }
std::string Hdf5File::read_text(const std::string&) const { unreachable(); }
std::vector<std::string> Hdf5File::attributes(const std::string&) const { unreachable(); }
std::string Hdf5File::attribute_bytes(const std::string&, const std::string&) const { unreachable(); }
bool Hdf5File::has_attribute(const std::string&, const std::string&) const { unreachable(); }
void Hdf5File::set_attribute(const std::string&, const std::string&, const std::string&) const { unreachable(); }
void Hdf5File::set_attribute(const std::string&, const std::string&, std::int64_t) const { unreachable(); }
void Hdf5File::set_attribute(const std::string&, const std::string&, double) const { unreachable(); }
void Hdf5File::set_attribute(const std::string&, const std::string&, const std::vector<std::int64_t>&) const {
  unreachable();
}
void Hdf5File::set_attribute(const std::string&, const std::string&, const std::vector<std::string>&) const {
  unreachable();
}
void Hdf5File::set_variable_text(const std::string&, const std::string&, const std::string&) const { unreachable(); }
void Hdf5File::set_reference(const std::string&, const std::string&, const std::string&) const { unreachable(); }
std::string Hdf5File::text_attribute(const std::string&, const std::string&) const { unreachable(); }
std::int64_t Hdf5File::integer_attribute(const std::string&, const std::string&) const { unreachable(); }
std::vector<std::int64_t> Hdf5File::integers_attribute(const std::string&, const std::string&) const { unreachable(); }
double Hdf5File::real_attribute(const std::string&, const std::string&) const { unreachable(); }

}  // namespace noether::io

#endif
