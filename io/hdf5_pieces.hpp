#pragma once
/// Pieces of an HDF5 file as bytes, for those who walk through its structure.

#include "io/hdf5_fault.hpp"

#include <cstddef>
#include <cstdint>
#include <istream>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noether::io::hdf5_pieces {

/// An address that points nowhere.
inline constexpr std::uint64_t nowhere = ~std::uint64_t{0};

/// The structure is damaged: the walk ends. It never leaves walk_hdf5.
struct Damage {
  Hdf5Fault fault;
};

/// @throws Damage unless it holds
inline void expect(bool holds, std::uint64_t byte, const std::string& what) {
  if (!holds) throw Damage{{byte, what}};
}

/// The bytes of one piece, and where it stands.
class Block {
 public:
  Block(std::uint64_t at, std::string bytes) : at_(at), bytes_(std::move(bytes)) {}

  std::uint64_t size() const { return bytes_.size(); }
  /// Where a byte of the block stands in the file.
  std::uint64_t place(std::uint64_t offset) const { return at_ + offset; }
  /// An unsigned number of so many bytes, the lowest first. @throws Damage beyond the end
  std::uint64_t number(std::uint64_t offset, std::uint64_t width) const;
  /// @throws Damage beyond the end
  std::string_view text(std::uint64_t offset, std::uint64_t length) const;
  /// A part of the block as a block. @throws Damage beyond the end
  Block part(std::uint64_t offset, std::uint64_t length) const;
  /// @throws Damage where a byte of a reserved field is not 0
  void expect_zeros(std::uint64_t offset, std::uint64_t width) const;
  /// @throws Damage where a number is not what it must be
  void expect_number(std::uint64_t offset, std::uint64_t width, std::uint64_t expected, std::string_view what) const;

 private:
  std::uint64_t at_;
  std::string bytes_;
};

/// A file of which pieces are taken; each byte belongs to one.
class Pieces {
 public:
  Pieces(std::istream& file, std::uint64_t size) : file_(file), size_(size) {}

  /// The file is no longer than this.
  void end_at(std::uint64_t size) { size_ = size; }
  std::uint64_t size() const { return size_; }
  /// The bytes of a piece, which are nobody else's. @param pointer  where its address stands
  /// @throws Damage if it is not inside the file, or overlaps another
  Block take(std::uint64_t at, std::uint64_t size, const std::string& what, std::uint64_t pointer);
  /// The same without reading it.
  void claim(std::uint64_t at, std::uint64_t size, const std::string& what, std::uint64_t pointer);
  /// Reads bytes and takes none.
  Block look(std::uint64_t at, std::uint64_t size, const std::string& what, std::uint64_t pointer) const;
  /// Within a piece these bytes are not used.
  void leave(std::uint64_t begin, std::uint64_t end);
  /// What is not used, in order; `whole` is the number of bytes on disk.
  std::vector<ByteRange> unused(std::uint64_t whole) const;
  /// Rows that a header has and that were never written.
  void note_unwritten(std::uint64_t byte, const std::string& what) { unwritten_.push_back({byte, what}); }
  const std::vector<Hdf5Fault>& unwritten() const { return unwritten_; }

 private:
  void check_inside(std::uint64_t at, std::uint64_t size, const std::string& what, std::uint64_t pointer) const;

  struct Piece {
    std::uint64_t end;
    std::string what;
  };
  std::istream& file_;
  std::uint64_t size_;
  std::map<std::uint64_t, Piece> taken_;  ///< by begin
  std::vector<ByteRange> left_;
  std::vector<Hdf5Fault> unwritten_;
};

/// How a dataset in chunks is laid out, as its header says.
struct Chunks {
  std::uint64_t tree = nowhere;       ///< address of the root
  std::uint64_t pointer = 0;          ///< where that address stands
  std::vector<std::uint64_t> extent;  ///< elements along each axis
  std::vector<std::uint64_t> chunk;   ///< elements of a chunk along each axis
  std::uint64_t element = 0;          ///< bytes
};

/// Walks through the tree of a dataset and takes its chunks. @throws Damage
void walk_chunks(Pieces& pieces, const Chunks& chunks, const std::string& path);

/// A member of a group.
struct Member {
  std::string name;
  std::uint64_t header = nowhere;
  std::uint64_t pointer = 0;  ///< where the address of the header stands
  bool cached = false;        ///< tree and heap of a group are told beside its name, too
  std::uint64_t tree = nowhere, heap = nowhere;
};

/// Walks through a group's tree, nodes and heap. @throws Damage
std::vector<Member> walk_group(Pieces& pieces, std::uint64_t tree, std::uint64_t heap, std::uint64_t pointer,
                               const std::string& path);

/// Objects in a heap that many may use, by number: how many bytes each has. @throws Damage
std::map<std::uint64_t, std::uint64_t> walk_global_heap(Pieces& pieces, std::uint64_t at, std::uint64_t pointer);

/// One node of a tree, as it stands.
struct Node {
  std::uint64_t at = 0, pointer = 0, level = 0, left = nowhere, right = nowhere;
  std::vector<std::vector<std::uint64_t>> keys;  ///< one more than children
  std::vector<std::uint64_t> children;
  std::uint64_t place(std::size_t child) const;  ///< where the address of a child stands
  std::uint64_t key_place(std::size_t key) const;
  std::uint64_t key_size = 0;
};

/// What all trees have in common.
struct TreeKind {
  std::uint64_t type = 0, most = 0;       ///< 0 for groups, 1 for chunks; children a node has room for
  std::vector<std::uint64_t> key_fields;  ///< the widths of the numbers in a key
  std::string what;                       ///< "the tree of '/particles'"
};

/// The nodes of level 0 from left to right. @throws Damage
std::vector<Node> walk_tree(Pieces& pieces, const TreeKind& kind, std::uint64_t root, std::uint64_t pointer);

}  // namespace noether::io::hdf5_pieces
