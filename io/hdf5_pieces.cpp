#include "io/hdf5_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace noether::io::hdf5_pieces {

// ---- bytes ---------------------------------------------------------------------------------------------------------

std::uint64_t Block::number(std::uint64_t offset, std::uint64_t width) const {
  std::uint64_t value = 0;
  const std::string_view bytes = text(offset, width);
  for (std::size_t k = bytes.size(); k-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes[k]);
  return value;
}

std::string_view Block::text(std::uint64_t offset, std::uint64_t length) const {
  expect(offset <= size() && length <= size() - offset, at_, "a piece is too short for what it holds");
  return std::string_view(bytes_).substr(offset, length);
}

Block Block::part(std::uint64_t offset, std::uint64_t length) const {
  return {place(offset), std::string(text(offset, length))};
}

void Block::expect_zeros(std::uint64_t offset, std::uint64_t width) const {
  const std::string_view bytes = text(offset, width);
  for (std::size_t k = 0; k < bytes.size(); ++k)
    expect(bytes[k] == 0, place(offset + k),
           fmt::format("a reserved byte is {}, it must be 0", static_cast<unsigned char>(bytes[k])));
}

void Block::expect_number(std::uint64_t offset, std::uint64_t width, std::uint64_t expected,
                          std::string_view what) const {
  const std::uint64_t found = number(offset, width);
  expect(found == expected, place(offset), fmt::format("{} is {}, it must be {}", what, found, expected));
}

void Pieces::check_inside(std::uint64_t at, std::uint64_t size, const std::string& what, std::uint64_t pointer) const {
  expect(at <= size_ && size <= size_ - at, pointer,
         fmt::format("{} would reach from byte {} beyond the end of the file at {}", what, at, size_));
}

void Pieces::claim(std::uint64_t at, std::uint64_t size, const std::string& what, std::uint64_t pointer) {
  check_inside(at, size, what, pointer);
  expect(size > 0, pointer, fmt::format("{} has no bytes", what));
  const auto next = taken_.lower_bound(at);
  if (next != taken_.end())
    expect(next->first >= at + size, pointer,
           fmt::format("{} at byte {} overlaps {} at {}", what, at, next->second.what, next->first));
  if (next != taken_.begin()) {
    const auto& [begin, piece] = *std::prev(next);
    expect(piece.end <= at, pointer, fmt::format("{} at byte {} overlaps {} at {}", what, at, piece.what, begin));
  }
  taken_.emplace_hint(next, at, Piece{at + size, what});
}

Block Pieces::look(std::uint64_t at, std::uint64_t size, const std::string& what, std::uint64_t pointer) const {
  check_inside(at, size, what, pointer);
  std::string bytes(size, '\0');
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(at));
  file_.read(bytes.data(), static_cast<std::streamsize>(size));
  expect(file_.gcount() == static_cast<std::streamsize>(size), at, fmt::format("{} cannot be read", what));
  return {at, std::move(bytes)};
}

Block Pieces::take(std::uint64_t at, std::uint64_t size, const std::string& what, std::uint64_t pointer) {
  claim(at, size, what, pointer);
  return look(at, size, what, pointer);
}

void Pieces::leave(std::uint64_t begin, std::uint64_t end) {
  if (begin < end) left_.push_back({begin, end});
}

std::vector<ByteRange> Pieces::unused(std::uint64_t whole) const {
  std::vector<ByteRange> all = left_;
  std::uint64_t at = 0;
  for (const auto& [begin, piece] : taken_) {
    if (at < begin) all.push_back({at, begin});
    at = piece.end;
  }
  if (at < whole) all.push_back({at, whole});
  std::sort(all.begin(), all.end(), [](const ByteRange& a, const ByteRange& b) { return a.begin < b.begin; });
  return all;
}

// ---- trees ---------------------------------------------------------------------------------------------------------

namespace {

constexpr std::uint64_t node_head = 24, address_size = 8;

Node read_node(Pieces& pieces, const TreeKind& kind, std::uint64_t at, std::uint64_t pointer) {
  Node node{.at = at, .pointer = pointer, .keys = {}, .children = {}};
  for (const std::uint64_t width : kind.key_fields) node.key_size += width;
  const std::string what = "a node of " + kind.what;
  const Block block =
      pieces.take(at, node_head + kind.most * (node.key_size + address_size) + node.key_size, what, pointer);
  expect(block.text(0, 4) == "TREE", at, what + " does not begin with TREE");
  block.expect_number(4, 1, kind.type, "the type of " + what);
  node.level = block.number(5, 1);
  const std::uint64_t count = block.number(6, 2);
  expect(count <= kind.most, block.place(6), fmt::format("{} has {} children, at most {} fit", what, count, kind.most));
  node.left = block.number(8, 8);
  node.right = block.number(16, 8);
  const auto rest = [&](std::uint64_t from) {
    if (kind.type == 0) return block.expect_zeros(from, block.size() - from);  // HDF5 clears them in trees of groups
    pieces.leave(at + from, at + block.size());
  };
  if (count == 0) {
    rest(node_head);
    return node;
  }
  std::uint64_t offset = node_head;
  for (std::uint64_t k = 0; k <= count; ++k) {
    std::vector<std::uint64_t>& key = node.keys.emplace_back();
    for (const std::uint64_t width : kind.key_fields) {
      key.push_back(block.number(offset, width));
      offset += width;
    }
    if (k == count) break;
    node.children.push_back(block.number(offset, address_size));
    offset += address_size;
  }
  rest(offset);
  return node;
}

/// Where a node was divided and its writer was killed before it wrote the left half, that half still has what now
/// stands at the beginning of its right neighbor. No reader looks there: the node above leads to the neighbor.
void forget_divided(Node& node, const Node& next) {
  const auto same = std::find(node.children.begin(), node.children.end(), next.children.front());
  if (same == node.children.end()) return;
  const auto kept = static_cast<std::size_t>(same - node.children.begin());
  const std::size_t moved = node.children.size() - kept;
  if (kept == 0 || moved > next.children.size()) return;
  for (std::size_t k = 0; k < moved; ++k) {
    if (node.children[kept + k] != next.children[k] || node.keys[kept + k] != next.keys[k]) return;
  }
  node.children.resize(kept);
  node.keys.resize(kept + 1);
}

/// A neighbor is the one that the nodes above tell, or none: a writer that was killed while it removed the neighbor, or
/// before it told of a new one, may have left it like that.
void check_neighbors(const std::vector<Node>& row, const TreeKind& kind) {
  for (std::size_t k = 0; k < row.size(); ++k) {
    const std::uint64_t left = k > 0 ? row[k - 1].at : nowhere, right = k + 1 < row.size() ? row[k + 1].at : nowhere;
    expect(row[k].left == left || row[k].left == nowhere, row[k].at + 8,
           fmt::format("a node of {} has a left neighbor at byte {} instead of {}", kind.what, row[k].left,
                       left == nowhere ? "none" : std::to_string(left)));
    expect(row[k].right == right || row[k].right == nowhere, row[k].at + 16,
           fmt::format("a node of {} has a right neighbor at byte {} instead of {}", kind.what, row[k].right,
                       right == nowhere ? "none" : std::to_string(right)));
  }
}

}  // namespace

std::uint64_t Node::key_place(std::size_t key) const { return at + node_head + key * (key_size + address_size); }
std::uint64_t Node::place(std::size_t child) const { return key_place(child) + key_size; }

std::vector<Node> walk_tree(Pieces& pieces, const TreeKind& kind, std::uint64_t root, std::uint64_t pointer) {
  std::vector<Node> row = {read_node(pieces, kind, root, pointer)};
  while (true) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      expect(
          row[k].level == row[0].level, row[k].at + 5,
          fmt::format("a node of {} is of level {} among others of level {}", kind.what, row[k].level, row[0].level));
      expect(!row[k].children.empty() || row[k].at == root, row[k].at + 6,
             fmt::format("a node of {} has no children", kind.what));
      if (k > 0) forget_divided(row[k - 1], row[k]);
    }
    check_neighbors(row, kind);
    if (row[0].level == 0) return row;
    expect(!row[0].children.empty(), row[0].at + 6, fmt::format("a node of {} has no children", kind.what));
    std::vector<Node> below;
    for (const Node& node : row) {
      for (std::size_t k = 0; k < node.children.size(); ++k) {
        Node child = read_node(pieces, kind, node.children[k], node.place(k));
        expect(child.level + 1 == node.level, child.at + 5,
               fmt::format("a node of {} is of level {} below one of level {}", kind.what, child.level, node.level));
        expect(!child.keys.empty() && child.keys.front() == node.keys[k], node.key_place(k),
               fmt::format("a key of {} differs from that of the node below it", kind.what));
        below.push_back(std::move(child));
      }
    }
    row = std::move(below);
  }
}

void walk_chunks(Pieces& pieces, const Chunks& chunks, const std::string& path) {
  constexpr std::uint64_t room = 64;
  const std::size_t axes = chunks.chunk.size();
  TreeKind kind{1, room, {4, 4}, fmt::format("the tree of '{}'", path)};
  kind.key_fields.resize(2 + axes + 1, 8);
  std::uint64_t bytes = chunks.element;
  for (const std::uint64_t edge : chunks.chunk) {
    expect(edge > 0 && bytes <= nowhere / edge, chunks.pointer, fmt::format("chunks of '{}' have no size", path));
    bytes *= edge;
  }
  const std::uint64_t rows = chunks.extent[0];
  if (chunks.tree == nowhere) {
    if (rows > 0)
      pieces.note_unwritten(chunks.pointer, fmt::format("'{}' has {} rows and no tree of chunks", path, rows));
    return;
  }
  // Only the first axis grows; each chunk covers the others.
  const auto is_number = [&](const std::vector<std::uint64_t>& key, std::uint64_t number) {
    return key[2] == number * chunks.chunk[0] && std::all_of(key.begin() + 3, key.end(), [](auto o) { return o == 0; });
  };
  std::uint64_t number = 0;
  const std::vector<Node> leaves = walk_tree(pieces, kind, chunks.tree, chunks.pointer);
  for (const Node& leaf : leaves) {
    for (std::size_t k = 0; k < leaf.children.size(); ++k, ++number) {
      const std::vector<std::uint64_t>& key = leaf.keys[k];
      const std::string what = fmt::format("chunk {} of '{}'", number, path);
      expect(key[0] == bytes, leaf.key_place(k), fmt::format("{} has {} bytes instead of {}", what, key[0], bytes));
      expect(key[1] == 0, leaf.key_place(k) + 4, fmt::format("{} has the filter mask {} instead of 0", what, key[1]));
      expect(is_number(key, number), leaf.key_place(k) + 8,
             fmt::format("{} does not begin at row {}", what, number * chunks.chunk[0]));
      pieces.claim(leaf.children[k], bytes, what, leaf.place(k));
    }
  }
  expect(rows / chunks.chunk[0] + (rows % chunks.chunk[0] > 0 ? 1 : 0) <= number, leaves.back().at + 6,
         fmt::format("'{}' has {} rows, but only {} chunks of {}", path, rows, number, chunks.chunk[0]));
}

// ---- heaps ---------------------------------------------------------------------------------------------------------

namespace {

/// The names of a group.
class Names {
 public:
  Names(Pieces& pieces, std::uint64_t at, std::uint64_t pointer, const std::string& path)
      : pieces_(pieces), what_(fmt::format("the heap of '{}'", path)), data_(data_of(pieces, at, pointer)) {}

  /// The name that begins there. @param pointer  where this offset stands
  std::string at(std::uint64_t offset, std::uint64_t pointer) {
    expect(offset < data_.size() && offset % 8 == 0, pointer,
           fmt::format("a name of {} would begin at its byte {}", what_, offset));
    const std::string_view rest = data_.text(offset, data_.size() - offset);
    const std::size_t length = rest.find('\0');
    expect(length != std::string_view::npos, pointer, fmt::format("a name of {} does not end", what_));
    return std::string(rest.substr(0, length));
  }
  /// The same, for the one who owns the name.
  std::string take(std::uint64_t offset, std::uint64_t pointer) {
    std::string name = at(offset, pointer);
    const std::uint64_t end = offset + (name.size() + 8) / 8 * 8;
    expect(!name.empty(), pointer, fmt::format("a name of {} is empty", what_));
    claim(offset, std::min(end, data_.size()), pointer);
    pieces_.leave(data_.place(offset + name.size() + 1), data_.place(std::min(end, data_.size())));
    return name;
  }
  /// Blocks that are free are neither inside others nor inside names, and what belongs to nobody is not used.
  void finish() {
    claim(0, std::min<std::uint64_t>(8, data_.size()), data_.place(0));
    data_.expect_zeros(0, std::min<std::uint64_t>(8, data_.size()));
    std::uint64_t pointer = free_pointer_;
    for (std::uint64_t offset = free_; offset != no_more;) {
      expect(offset <= data_.size() && data_.size() - offset >= 16 && offset % 8 == 0, pointer,
             fmt::format("a free block of {} would begin at its byte {}", what_, offset));
      const std::uint64_t size = data_.number(offset + 8, 8);
      expect(size >= 16 && size <= data_.size() - offset && size % 8 == 0, data_.place(offset + 8),
             fmt::format("a free block of {} would have {} bytes", what_, size));
      claim(offset, offset + size, pointer);
      pieces_.leave(data_.place(offset + 16), data_.place(offset + size));
      pointer = data_.place(offset);
      offset = data_.number(offset, 8);
    }
    std::uint64_t end = 0;
    for (const auto& [begin, until] : taken_) {
      pieces_.leave(data_.place(end), data_.place(begin));
      end = until;
    }
    pieces_.leave(data_.place(end), data_.place(data_.size()));
  }

 private:
  static constexpr std::uint64_t no_more = 1;

  Block data_of(Pieces& pieces, std::uint64_t at, std::uint64_t pointer) {
    const Block head = pieces.take(at, 32, what_, pointer);
    expect(head.text(0, 4) == "HEAP", at, what_ + " does not begin with HEAP");
    head.expect_number(4, 1, 0, "the version of " + what_);
    head.expect_zeros(5, 3);
    expect(head.number(8, 8) % 8 == 0, head.place(8), "the size of " + what_ + " is not a multiple of 8");
    free_ = head.number(16, 8);
    free_pointer_ = head.place(16);
    return pieces.take(head.number(24, 8), head.number(8, 8), "the names in " + what_, head.place(24));
  }
  void claim(std::uint64_t begin, std::uint64_t end, std::uint64_t pointer) {
    const auto next = taken_.lower_bound(begin);
    expect((next == taken_.end() || next->first >= end) && (next == taken_.begin() || std::prev(next)->second <= begin),
           pointer, fmt::format("two pieces of {} overlap at its byte {}", what_, begin));
    taken_.emplace_hint(next, begin, end);
  }

  Pieces& pieces_;
  std::string what_;
  std::uint64_t free_ = no_more, free_pointer_ = 0;
  Block data_;
  std::map<std::uint64_t, std::uint64_t> taken_;
};

/// The entries of one node of names.
/// @param last  name in the node, as the tree says; a writer that divided the node and was killed before it wrote this
///              half has left further ones, which its neighbor has too: no reader looks for them here
/// @return those
std::vector<std::string> walk_names(Pieces& pieces, std::uint64_t at, std::uint64_t pointer, Names& names,
                                    const std::string& last, const std::string& path, std::vector<Member>& members) {
  constexpr std::uint64_t most = 8, entry = 40, head = 8;
  const std::string what = fmt::format("a node of names of '{}'", path);
  const Block block = pieces.take(at, head + most * entry, what, pointer);
  expect(block.text(0, 4) == "SNOD", at, what + " does not begin with SNOD");
  block.expect_number(4, 1, 1, "the version of " + what);
  block.expect_zeros(5, 1);
  const std::uint64_t count = block.number(6, 2);
  expect(count > 0 && count <= most, block.place(6), fmt::format("{} has {} names, 1 to {} fit", what, count, most));
  std::vector<std::string> moved;
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::uint64_t offset = head + k * entry;
    if (std::string name = names.at(block.number(offset, 8), block.place(offset)); name > last) {
      moved.push_back(std::move(name));
      continue;
    }
    Member member{.name = names.take(block.number(offset, 8), block.place(offset)),
                  .header = block.number(offset + 8, 8),
                  .pointer = block.place(offset + 8)};
    expect(members.empty() || members.back().name < member.name, block.place(offset),
           fmt::format("the names of '{}' are not in order: '{}' follows '{}'", path, member.name,
                       members.empty() ? "" : members.back().name));
    const std::uint64_t kind = block.number(offset + 16, 4);
    if (kind == 2 && path == "/") {  // a link that somebody has added
      members.push_back(std::move(member));
      continue;
    }
    expect(kind <= 1, block.place(offset + 16),
           fmt::format("the entry '{}' of '{}' is of kind {}, 0 and 1 are known", member.name, path, kind));
    block.expect_zeros(offset + 20, 4);
    member.cached = kind == 1;
    if (member.cached) {
      member.tree = block.number(offset + 24, 8);
      member.heap = block.number(offset + 32, 8);
    } else {
      block.expect_zeros(offset + 24, 16);
    }
    members.push_back(std::move(member));
  }
  block.expect_zeros(head + count * entry, block.size() - head - count * entry);
  return moved;
}

}  // namespace

std::vector<Member> walk_group(Pieces& pieces, std::uint64_t tree, std::uint64_t heap, std::uint64_t pointer,
                               const std::string& path) {
  constexpr std::uint64_t room = 32;
  const TreeKind kind{0, room, {8}, fmt::format("the tree of '{}'", path)};
  Names names(pieces, heap, pointer + 8, path);
  std::vector<Member> members;
  std::vector<std::string> moved;
  const auto is_there = [&](const std::string& name) {
    return std::any_of(members.begin(), members.end(), [&](const Member& one) { return one.name == name; });
  };
  for (const Node& leaf : walk_tree(pieces, kind, tree, pointer)) {
    for (std::size_t k = 0; k < leaf.children.size(); ++k) {
      const std::string before = names.at(leaf.keys[k][0], leaf.key_place(k));
      const std::string last = names.at(leaf.keys[k + 1][0], leaf.key_place(k + 1));
      const std::size_t first = members.size();
      std::vector<std::string> later = walk_names(pieces, leaf.children[k], leaf.place(k), names, last, path, members);
      // The key is written before the node: the last name of which it tells may be missing where a writer was killed.
      expect(members.size() > first && before < members[first].name &&
                 (first == 0 ? leaf.keys[k][0] == 0 && before.empty() : members[first - 1].name <= before),
             leaf.key_place(k),
             fmt::format("a key of {} is '{}', which is not between the nodes on both sides", kind.what, before));
      expect(std::all_of(moved.begin(), moved.end(), is_there), leaf.place(k),
             fmt::format("a name of '{}' is missing in the next node", path));
      moved = std::move(later);
    }
  }
  expect(moved.empty(), pointer, fmt::format("a node of '{}' has names after the last one of its tree", path));
  names.finish();
  return members;
}

std::map<std::uint64_t, std::uint64_t> walk_global_heap(Pieces& pieces, std::uint64_t at, std::uint64_t pointer) {
  constexpr std::uint64_t head = 16;
  const std::string what = "a heap of texts";
  const Block begin = pieces.look(at, head, what, pointer);
  expect(begin.text(0, 4) == "GCOL", pointer, fmt::format("there is no heap of texts at byte {}", at));
  begin.expect_number(4, 1, 1, "the version of " + what);
  begin.expect_zeros(5, 3);
  const Block block = pieces.take(at, begin.number(8, 8), what, begin.place(8));
  std::map<std::uint64_t, std::uint64_t> objects;
  std::uint64_t offset = head;
  while (offset < block.size() && block.size() - offset >= head) {
    const std::uint64_t index = block.number(offset, 2), size = block.number(offset + 8, 8);
    if (index == 0) {
      block.expect_number(offset + 8, 8, block.size() - offset, "the number of free bytes of " + what);
      block.expect_zeros(offset + 2, 6);
      pieces.leave(block.place(offset + head), block.place(block.size()));
      return objects;
    }
    block.expect_zeros(offset + 4, 4);
    expect(size <= block.size() - offset - head, block.place(offset + 8),
           fmt::format("an object of {} would have {} bytes", what, size));
    expect(objects.emplace(index, size).second, block.place(offset),
           fmt::format("{} has two objects of number {}", what, index));
    const std::uint64_t end = offset + head + (size + 7) / 8 * 8;
    pieces.leave(block.place(offset + head + size), block.place(std::min(end, block.size())));
    offset = end;
  }
  pieces.leave(block.place(std::min(offset, block.size())), block.place(block.size()));
  return objects;
}

}  // namespace noether::io::hdf5_pieces
