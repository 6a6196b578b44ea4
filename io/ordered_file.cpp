#include "io/ordered_file.hpp"

#if NOETHER_HDF5

#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

namespace noether::io {

namespace {

using Bytes = std::vector<unsigned char>;

/// Part of what HDF5 calls metadata, on its way to the disk.
struct Piece {
  H5FD_mem_t kind = H5FD_MEM_DEFAULT;
  Bytes bytes;
};

/// When a piece is written: what is pointed at before what points at it.
///
/// Pieces in new space are seen by nobody yet. The superblock tells where the file ends. Names stand in heaps. Nodes of
/// a tree above others may point at new ones, so these have been written before them as new space; among old ones the
/// upper come first. Object headers hold the lengths of datasets, and so come last, those by which readers go at the
/// very end. Where datasets become shorter all this is turned around, and HDF5 wipes what is cut off: then data wait
/// too.
std::array<std::uint64_t, 2> turn(haddr_t address, const Piece& piece, haddr_t committed, bool last) {
  static constexpr std::string_view tree = "TREE";
  constexpr std::size_t level_at = 5;
  const bool is_tree = piece.bytes.size() > level_at && std::equal(tree.begin(), tree.end(), piece.bytes.begin());
  if (piece.kind == H5FD_MEM_SUPER) return {1, 0};
  if (address >= committed) return {0, address};
  if (piece.kind == H5FD_MEM_DRAW) return {1, 1};
  if (piece.kind == H5FD_MEM_LHEAP || piece.kind == H5FD_MEM_GHEAP) return {2, address};
  if (is_tree) return {3, std::uint64_t{255} - piece.bytes[level_at]};
  if (piece.kind == H5FD_MEM_BTREE) return {4, address};
  return {last ? 6U : 5U, ~std::uint64_t{address}};
}

/// What a superblock says of the end of the file; `otherwise` if it is none.
std::uint64_t end_in_superblock(std::span<const unsigned char> block, std::uint64_t otherwise) {
  static constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  constexpr std::size_t version_at = 8, old_end_at = 40, new_end_at = 28;
  if (block.size() < old_end_at + sizeof(haddr_t)) return otherwise;
  for (std::size_t k = 0; k < signature.size(); ++k) {
    if (block[k] != static_cast<unsigned char>(signature[k])) return otherwise;
  }
  const std::size_t at = block[version_at] == 0 ? old_end_at : new_end_at;
  haddr_t end = 0;
  for (std::size_t k = sizeof(haddr_t); k-- > 0;) end = end << 8 | block[at + k];
  return end;
}

/// As above, of an open file that has `size` bytes.
std::uint64_t read_end(int descriptor, std::uint64_t size) {
  Bytes superblock(std::min<std::size_t>(size, 96));
  const ssize_t read = ::pread(descriptor, superblock.data(), superblock.size(), 0);
  return read == static_cast<ssize_t>(superblock.size()) ? end_in_superblock(superblock, size) : size;
}

}  // namespace

/// Data that are new go to the disk at once, where nothing on disk points at them yet; all else waits for the flush.
class OrderedFile : public H5FD_t {
 public:
  OrderedFile(int descriptor, const struct stat& status)
      : H5FD_t{}, descriptor_(descriptor), identity_(status.st_dev, status.st_ino) {
    held_ = static_cast<haddr_t>(status.st_size);
    committed_ = read_end(descriptor_, held_);
  }
  OrderedFile(const OrderedFile&) = delete;
  OrderedFile& operator=(const OrderedFile&) = delete;
  ~OrderedFile() { ::close(descriptor_); }

  const std::pair<dev_t, ino_t>& identity() const { return identity_; }
  int error() const { return error_; }
  void begin_cut() { cutting_ = true; }
  void write_last(haddr_t header) { last_.insert(header); }
  void keep_in_memory() { in_memory_ = true; }

  haddr_t allocated() const { return allocated_; }
  void allocate(haddr_t end) { allocated_ = end; }
  haddr_t end() const {
    return pieces_.empty() ? held_ : std::max(held_, pieces_.rbegin()->first + pieces_.rbegin()->second.bytes.size());
  }

  bool read(haddr_t address, std::span<unsigned char> out) const {
    std::size_t done = 0;
    while (done < out.size()) {
      const ssize_t got =
          ::pread(descriptor_, out.data() + done, out.size() - done, static_cast<off_t>(address + done));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return false;
      if (got == 0) break;
      done += static_cast<std::size_t>(got);
    }
    std::fill(out.begin() + static_cast<std::ptrdiff_t>(done), out.end(), 0);
    for (auto at = first_touching(address); at != pieces_.end() && at->first < address + out.size(); ++at) {
      const haddr_t begin = std::max(address, at->first);
      const haddr_t end = std::min<haddr_t>(address + out.size(), at->first + at->second.bytes.size());
      std::copy_n(at->second.bytes.begin() + static_cast<std::ptrdiff_t>(begin - at->first), end - begin,
                  out.begin() + static_cast<std::ptrdiff_t>(begin - address));
    }
    return true;
  }

  void write(H5FD_mem_t kind, haddr_t address, std::span<const unsigned char> bytes) {
    if (error_ != 0) return;
    forget(address, bytes.size());
    if (kind == H5FD_MEM_DRAW && !cutting_ && !in_memory_) {
      put(address, bytes);
    } else {
      pieces_[address] = {kind, Bytes(bytes.begin(), bytes.end())};
    }
  }

  /// Makes the file on disk what HDF5 believes it to be.
  void commit() {
    if (error_ != 0 || in_memory_ || (pieces_.empty() && allocated_ == committed_)) return;
    if (allocated_ > held_) stretch(allocated_);
    for (const auto& [turn, address] : order()) {
      if (error_ == 0) put(address, pieces_.at(address).bytes);
    }
    if (allocated_ < held_) stretch(allocated_);
    if (error_ != 0) return;
    pieces_.clear();
    committed_ = allocated_;
  }

 private:
  using Pieces = std::map<haddr_t, Piece>;

  Pieces::const_iterator first_touching(haddr_t address) const {
    auto at = pieces_.upper_bound(address);
    if (at != pieces_.begin() && std::prev(at)->first + std::prev(at)->second.bytes.size() > address) --at;
    return at;
  }

  /// Cuts a range out of what waits.
  void forget(haddr_t address, std::size_t size) {
    for (auto at = first_touching(address); at != pieces_.end() && at->first < address + size;) {
      const haddr_t begin = at->first, end = begin + at->second.bytes.size();
      Piece piece = at->second;
      at = pieces_.erase(at);
      if (end > address + size) {
        const auto kept = static_cast<std::ptrdiff_t>(address + size - begin);
        pieces_[address + size] = {piece.kind, Bytes(piece.bytes.begin() + kept, piece.bytes.end())};
      }
      if (begin < address) {
        piece.bytes.resize(address - begin);
        pieces_[begin] = std::move(piece);
      }
    }
  }

  std::vector<std::pair<std::array<std::uint64_t, 2>, haddr_t>> order() const {
    std::vector<std::pair<std::array<std::uint64_t, 2>, haddr_t>> all;
    for (const auto& [address, piece] : pieces_)
      all.emplace_back(turn(address, piece, committed_, last_.count(address) > 0), address);
    std::sort(all.begin(), all.end());
    if (!cutting_) return all;
    const auto old = std::find_if(all.begin(), all.end(), [](const auto& one) { return one.first[0] != 0; });
    std::reverse(old, all.end());
    return all;
  }

  void put(haddr_t address, std::span<const unsigned char> bytes) {
    while (!bytes.empty()) {
      const ssize_t put = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(address));
      if (put < 0 && errno == EINTR) continue;
      if (put <= 0) {
        error_ = put < 0 ? errno : ENOSPC;
        return;
      }
      bytes = bytes.subspan(static_cast<std::size_t>(put));
      address += static_cast<haddr_t>(put);
      held_ = std::max(held_, address);
    }
  }

  void stretch(haddr_t end) {
    if (::ftruncate(descriptor_, static_cast<off_t>(end)) == 0) {
      held_ = end;
    } else {
      error_ = errno;
    }
  }

  int descriptor_;
  std::pair<dev_t, ino_t> identity_;
  haddr_t allocated_ = 0;   ///< end of what HDF5 has allocated
  haddr_t committed_ = 0;   ///< end of the file as of its last flush
  haddr_t held_ = 0;        ///< size on disk
  Pieces pieces_;           ///< by address; none overlaps another
  std::set<haddr_t> last_;  ///< headers that are written after all others
  bool cutting_ = false, in_memory_ = false;
  int error_ = 0;
};

namespace {

OrderedFile& ours(H5FD_t* file) { return *static_cast<OrderedFile*>(file); }
const OrderedFile& ours(const H5FD_t* file) { return *static_cast<const OrderedFile*>(file); }

H5FD_t* refuse(const char* name) {
  H5Epush2(H5E_DEFAULT, __FILE__, __func__, __LINE__, H5E_ERR_CLS, H5E_FILE, H5E_CANTOPENFILE,
           "unable to open file '%s', error message = '%s'", name, std::strerror(errno));
  return nullptr;
}

H5FD_t* open_ordered(const char* name, unsigned flags, hid_t /*access*/, haddr_t /*most*/) {
  int mode = O_CLOEXEC | ((flags & H5F_ACC_RDWR) != 0 ? O_RDWR : O_RDONLY);
  if ((flags & H5F_ACC_CREAT) != 0) mode |= O_CREAT;
  if ((flags & H5F_ACC_TRUNC) != 0) mode |= O_TRUNC;
  if ((flags & H5F_ACC_EXCL) != 0) mode |= O_EXCL;
  const int descriptor = ::open(name, mode, 0666);
  struct stat status = {};
  if (descriptor < 0 || ::fstat(descriptor, &status) != 0) return refuse(name);
  return std::make_unique<OrderedFile>(descriptor, status).release();  // close_ordered takes it back
}

herr_t close_ordered(H5FD_t* file) {
  const std::unique_ptr<OrderedFile> taken(&ours(file));
  return 0;
}

int compare(const H5FD_t* a, const H5FD_t* b) {
  if (ours(a).identity() == ours(b).identity()) return 0;
  return ours(a).identity() < ours(b).identity() ? -1 : 1;
}

/// No feature is asked for: above all no gathering of metadata, so that each piece arrives by itself.
herr_t features(const H5FD_t* /*file*/, unsigned long* flags) {
  if (flags != nullptr) *flags = H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

/// The driver as HDF5 wants it: a table of functions.
hid_t driver() {
  static const hid_t id = [] {
    static H5FD_class_t table = {};
#if H5_VERSION_GE(1, 13, 0)
    table.version = H5FD_CLASS_VERSION;
    table.value = static_cast<H5FD_class_value_t>(H5_VFD_RESERVED + 1);
#endif
    table.name = "noether_ordered";
    table.maxaddr = (haddr_t{1} << 62) - 1;
    table.fc_degree = H5F_CLOSE_WEAK;
    table.open = open_ordered;
    table.close = close_ordered;
    table.cmp = compare;
    table.query = features;
    table.get_eoa = [](const H5FD_t* file, H5FD_mem_t) { return ours(file).allocated(); };
    table.set_eoa = [](H5FD_t* file, H5FD_mem_t, haddr_t end) {
      ours(file).allocate(end);
      return herr_t{0};
    };
    table.get_eof = [](const H5FD_t* file, H5FD_mem_t) { return ours(file).end(); };
    table.get_handle = [](H5FD_t* file, hid_t, void** handle) {
      *handle = &ours(file);
      return herr_t{0};
    };
    table.read = [](H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, std::size_t size, void* out) {
      return herr_t{ours(file).read(address, {static_cast<unsigned char*>(out), size}) ? 0 : -1};
    };
    table.write = [](H5FD_t* file, H5FD_mem_t kind, hid_t, haddr_t address, std::size_t size, const void* in) {
      ours(file).write(kind, address, {static_cast<const unsigned char*>(in), size});
      return herr_t{0};
    };
    table.flush = [](H5FD_t* file, hid_t, hbool_t) {
      ours(file).commit();
      return herr_t{0};
    };
    const std::array<H5FD_mem_t, H5FD_MEM_NTYPES> separate = H5FD_FLMAP_DICHOTOMY;
    std::copy(separate.begin(), separate.end(), std::begin(table.fl_map));
    return H5FDregister(&table);
  }();
  return id;
}

}  // namespace

bool use_ordered_driver(Hdf5Id access) {
  // Every piece stands alone, on pages of its own where it is large; chunks are written as they are, past the cache.
  return driver() >= 0 && H5Pset_driver(access, driver(), nullptr) >= 0 && H5Pset_alignment(access, 512, 4096) >= 0 &&
         H5Pset_meta_block_size(access, 0) >= 0 && H5Pset_small_data_block_size(access, 0) >= 0 &&
         H5Pset_cache(access, 0, 521, 1, 1.0) >= 0;
}

OrderedFile* ordered_file(Hdf5Id file) {
  void* handle = nullptr;
  return H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0 ? nullptr : static_cast<OrderedFile*>(handle);
}

int write_error(const OrderedFile& file) noexcept { return file.error(); }
void write_last(OrderedFile& file, std::uint64_t header) { file.write_last(header); }
void begin_cut(OrderedFile& file) noexcept { file.begin_cut(); }

std::uint64_t expected_size(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status = {};
  if (descriptor < 0) return 0;
  const bool known = ::fstat(descriptor, &status) == 0;
  const std::uint64_t end = known ? read_end(descriptor, static_cast<std::uint64_t>(status.st_size)) : 0;
  ::close(descriptor);
  return end;
}

void keep_in_memory(OrderedFile& file) noexcept { file.keep_in_memory(); }

}  // namespace noether::io

#endif
