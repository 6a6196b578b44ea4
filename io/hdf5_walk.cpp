#include "io/hdf5_walk.hpp"

#include "io/hdf5_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <fstream>
#include <system_error>
#include <utility>

namespace noether::io {

namespace hdf5_pieces {

namespace {

/// Kinds of messages in the header of an object.
enum class Message : std::uint64_t {
  nil = 0,
  dataspace = 1,
  link_info = 2,
  datatype = 3,
  fill_value = 5,
  link = 6,
  layout = 8,
  group_info = 10,
  filter = 11,
  attribute = 12,
  comment = 13,
  modification_time = 18,
  continuation = 16,
  symbol_table = 17
};

/// The type of the elements of a dataset or an attribute.
struct Type {
  enum class Kind : std::uint8_t { number, text, reference, variable_text };
  Kind kind = Kind::number;
  std::uint64_t size = 0;  ///< bytes of an element
};

/// The types of elements that noether writes, byte for byte but for the length of a text.
Type read_type(const Block& block, const std::string& owner) {
  static constexpr std::string_view integer("\x10\x08\0\0\x08\0\0\0\0\0\x40\0", 12);
  static constexpr std::string_view real("\x11\x20\x3f\0\x08\0\0\0\0\0\x40\0\x34\x0b\0\x34\xff\x03\0\0", 20);
  static constexpr std::string_view reference("\x17\0\0\0\x08\0\0\0", 8);
  static constexpr std::string_view variable("\x19\x11\x01\0\x10\0\0\0\x10\0\0\0\x01\0\0\0\0\0\x08\0", 20);
  const std::string_view bytes = block.text(0, block.size());
  const auto is = [&](std::string_view form) {
    if (!bytes.starts_with(form)) return false;
    block.expect_zeros(form.size(), block.size() - form.size());
    return true;
  };
  if (is(integer) || is(real)) return {Type::Kind::number, 8};
  if (is(reference)) return {Type::Kind::reference, 8};
  if (is(variable)) return {Type::Kind::variable_text, 16};
  const std::uint64_t size = block.number(4, 4);
  expect(bytes.starts_with("\x13") && block.number(1, 1) <= 0x12 && block.number(2, 2) == 0 && size > 0, block.place(0),
         fmt::format("the type of {} is none that such files have", owner));
  block.expect_zeros(8, block.size() - 8);
  return {Type::Kind::text, size};
}

/// The lengths along each axis. @param bytes  no array has more elements than the file has bytes
std::vector<std::uint64_t> read_extent(const Block& block, const std::string& owner) {
  block.expect_number(0, 1, 1, fmt::format("the version of the shape of {}", owner));
  const std::uint64_t axes = block.number(1, 1), flags = block.number(2, 1);
  expect(flags <= 1, block.place(2), fmt::format("the shape of {} has the flags {}, 0 and 1 are known", owner, flags));
  block.expect_zeros(3, 5);
  std::vector<std::uint64_t> extent;
  for (std::uint64_t k = 0; k < axes; ++k) {
    extent.push_back(block.number(8 + 8 * k, 8));
    if (flags == 0) continue;
    const std::uint64_t offset = 8 + 8 * (axes + k), most = block.number(offset, 8);
    expect(most >= extent[k], block.place(offset),
           fmt::format("{} has {} rows, at most {} were allowed", owner, extent[k], most));
  }
  const std::uint64_t used = 8 + 8 * axes * (flags == 0 ? 1 : 2);
  block.expect_zeros(used, block.size() - used);
  return extent;
}

/// The product, as bytes. @throws Damage if that is more than the file has
std::uint64_t bytes_of(const std::vector<std::uint64_t>& extent, std::uint64_t element, std::uint64_t most,
                       std::uint64_t place, const std::string& owner) {
  if (std::find(extent.begin(), extent.end(), 0) != extent.end()) return 0;
  std::uint64_t bytes = element;
  for (const std::uint64_t count : extent) {
    expect(bytes <= most / count, place, fmt::format("{} would be larger than the file", owner));
    bytes *= count;
  }
  return bytes;
}

/// An object to be walked through.
struct Object {
  std::string path;
  Member member;
};

/// What its messages say of an object.
struct Header {
  std::optional<std::vector<std::uint64_t>> extent;
  std::optional<Type> type;
  std::optional<Block> layout, group;
  bool fill = false;
  bool filtered = false;  ///< chunks are compressed, as noether never does
  bool links = false;     ///< members stand in messages: somebody has added one of another kind
};

class Walk {
 public:
  Walk(std::istream& file, std::uint64_t size) : pieces_(file, size) {}

  void run() {
    superblock();
    while (!waiting_.empty()) {
      const Object object = std::move(waiting_.front());
      waiting_.pop_front();
      walk(object);
    }
    for (const auto& [header, links] : links_) {
      const auto [told, place] = told_links_.at(header);
      expect(told == links || (others_ && told > links), place,
             fmt::format("an object is said to have {} names, it has {}", told, links));
    }
    for (const auto& [target, place] : references_)
      expect(links_.count(target) > 0, place,
             fmt::format("a reference leads to byte {}, where no object begins", target));
  }
  std::vector<ByteRange> unused(std::uint64_t whole) const { return pieces_.unused(whole); }
  const std::vector<Hdf5Fault>& unwritten() const { return pieces_.unwritten(); }
  /// Whether another program wrote the file, as far as its root could be read.
  bool is_foreign() const { return foreign_; }

 private:
  void superblock() {
    const Block block = pieces_.take(0, 96, "the superblock", 0);
    for (const std::uint64_t at : {9, 10, 11, 12, 15}) block.expect_zeros(at, 1);
    block.expect_number(13, 1, 8, "the size of addresses");
    block.expect_number(14, 1, 8, "the size of lengths");
    block.expect_number(16, 2, 4, "the size of nodes of names");
    block.expect_number(18, 2, 16, "the size of nodes of groups");
    block.expect_zeros(20, 4);
    block.expect_zeros(24, 8);
    block.expect_number(32, 8, nowhere, "the address of free space");
    block.expect_number(48, 8, nowhere, "the address of a driver's block");
    const std::uint64_t end = block.number(40, 8);
    expect(end <= pieces_.size(), block.place(40),
           fmt::format("the file should end at byte {}, but has {} bytes", end, pieces_.size()));
    pieces_.end_at(end);
    expect(end >= block.size(), block.place(40),
           fmt::format("the file should end at byte {}, within its superblock", end));
    block.expect_zeros(56, 8);
    block.expect_number(72, 4, 1, "the kind of the root's entry");
    block.expect_zeros(76, 4);
    add({"", {"", block.number(64, 8), block.place(64), true, block.number(80, 8), block.number(88, 8)}});
  }

  /// Another name for an object, or the first. Names of groups make no circles: a group has one.
  void add(const Object& object) {
    if (++links_[object.member.header] > 1) return;
    waiting_.push_back(object);
  }

  void walk(const Object& object) {
    const std::string name = object.path.empty() ? "/" : object.path;
    const Header header = read_header(object.member.header, object.member.pointer, name);
    if (header.links) return;
    if (header.group) {
      expect(!header.layout && !header.type && !header.extent && !header.fill, object.member.header,
             fmt::format("'{}' is both a group and a dataset", name));
      return walk_members(object, *header.group, name);
    }
    expect(header.extent && header.type && header.layout, object.member.header,
           fmt::format("the header of '{}' has no shape, no type or no layout", name));
    expect(!object.member.cached, object.member.pointer + 8, fmt::format("'{}' is called a group, and is none", name));
    if (!header.filtered) walk_data(header, name);
  }

  void walk_members(const Object& object, const Block& message, const std::string& name) {
    const std::uint64_t tree = message.number(0, 8), heap = message.number(8, 8);
    if (object.member.cached)
      expect(tree == object.member.tree && heap == object.member.heap, message.place(0),
             fmt::format("the header of '{}' and the entry that leads to it have different trees or heaps", name));
    expect(name.size() <= most_of_path, object.member.pointer,
           fmt::format("a path has more than {} bytes", most_of_path));
    std::vector<Member> members = walk_group(pieces_, tree, heap, message.place(0), name);
    if (object.path.empty()) {
      foreign_ = std::none_of(members.begin(), members.end(), [](const Member& one) { return one.name == "noether"; });
    }
    for (Member& member : members) {
      if (object.path.empty() && !is_written(member.name)) {
        others_ = true;
        continue;
      }
      const std::string path = object.path + "/" + member.name;
      add({path, std::move(member)});
    }
  }

  static constexpr std::size_t most_of_path = 1024;

  /// Whether noether writes such a member of the root. Others may have added more, in other ways.
  static bool is_written(std::string_view name) {
    return name == "h5md" || name == "noether" || name == "particles" || name == "connectivity";
  }

  void walk_data(const Header& header, const std::string& name) {
    const Block& block = *header.layout;
    const std::vector<std::uint64_t>& extent = *header.extent;
    const std::string owner = "'" + name + "'";
    block.expect_number(0, 1, 3, fmt::format("the version of the layout of {}", owner));
    const std::uint64_t kind = block.number(1, 1);
    if (kind == 2) return walk_chunked(block, extent, header.type->size, name);
    const std::uint64_t bytes = bytes_of(extent, header.type->size, pieces_.size(), block.place(0), owner);
    if (kind == 0) {
      block.expect_number(2, 2, bytes, fmt::format("the number of bytes of {}", owner));
      static_cast<void>(block.text(4, bytes));  // they are there
      pieces_.leave(block.place(4 + bytes), block.place(block.size()));
      return;
    }
    expect(kind == 1, block.place(1), fmt::format("the layout of {} is of kind {}, 0 to 2 are known", owner, kind));
    block.expect_number(10, 8, bytes, fmt::format("the number of bytes of {}", owner));
    block.expect_zeros(18, block.size() - 18);
    const std::uint64_t at = block.number(2, 8);
    if (bytes > 0) return pieces_.claim(at, bytes, owner, block.place(2));
    expect(at == nowhere, block.place(2), fmt::format("{} has no bytes, but an address", owner));
  }

  void walk_chunked(const Block& block, const std::vector<std::uint64_t>& extent, std::uint64_t element,
                    const std::string& name) {
    block.expect_number(2, 1, extent.size() + 1, fmt::format("the number of axes of chunks of '{}'", name));
    expect(!extent.empty(), block.place(2), fmt::format("'{}' has chunks and no axis", name));
    Chunks chunks{
        .tree = block.number(3, 8), .pointer = block.place(3), .extent = extent, .chunk = {}, .element = element};
    for (std::size_t k = 0; k < extent.size(); ++k) {
      const std::uint64_t offset = 11 + 4 * k, edge = block.number(offset, 4);
      chunks.chunk.push_back(edge);
      if (k > 0)
        block.expect_number(offset, 4, std::max<std::uint64_t>(extent[k], 1),
                            fmt::format("the edge of chunks of '{}'", name));
      expect(edge > 0, block.place(offset), fmt::format("chunks of '{}' have no rows", name));
    }
    const std::uint64_t end = 11 + 4 * extent.size();
    block.expect_number(end, 4, element, fmt::format("the size of elements of '{}'", name));
    block.expect_zeros(end + 4, block.size() - end - 4);
    walk_chunks(pieces_, chunks, name);
  }

  /// All messages of a header, wherever it goes on.
  Header read_header(std::uint64_t at, std::uint64_t pointer, const std::string& name) {
    const std::string what = fmt::format("the header of '{}'", name);
    const Block head = pieces_.take(at, 16, what, pointer);
    head.expect_number(0, 1, 1, "the version of " + what);
    head.expect_zeros(1, 1);
    head.expect_zeros(12, 4);
    told_links_[at] = {head.number(4, 4), head.place(4)};
    std::deque<Block> blocks;
    blocks.push_back(pieces_.take(at + 16, head.number(8, 4), what, head.place(8)));
    Header header;
    std::uint64_t count = 0;
    for (; !blocks.empty(); blocks.pop_front()) {
      const Block& block = blocks.front();
      for (std::uint64_t offset = 0; offset < block.size(); ++count) {
        const std::uint64_t size = block.number(offset + 2, 2);
        const auto kind = static_cast<Message>(block.number(offset, 2));
        block.expect_zeros(offset + 5, 3);
        expect(size % 8 == 0 && size <= block.size() - offset - 8, block.place(offset + 2),
               fmt::format("a message of {} has {} bytes, {} are left", what, size, block.size() - offset - 8));
        const Block content = block.part(offset + 8, size);
        if (kind == Message::continuation) {
          blocks.push_back(pieces_.take(content.number(0, 8), content.number(8, 8), what, content.place(0)));
          content.expect_zeros(16, size - 16);
        }
        const std::uint64_t flags = block.number(offset + 4, 1);
        take_message(header, kind, flags, content, name);
        offset += 8 + size;
      }
    }
    head.expect_number(2, 2, count, "the number of messages of " + what);
    return header;
  }

  void take_message(Header& header, Message kind, std::uint64_t flags, const Block& content, const std::string& name) {
    const std::string owner = "'" + name + "'";
    const auto type = static_cast<std::uint64_t>(kind);
    const auto once = [&](bool there) {
      expect(!there, content.place(0) - 8, fmt::format("the header of {} has two messages of type {}", owner, type));
    };
    if (name == "/" && is_added(kind)) {
      header.links = header.links || kind == Message::link_info || kind == Message::link;
      return pieces_.leave(content.place(0), content.place(content.size()));
    }
    const std::uint64_t constant = kind == Message::datatype || kind == Message::fill_value ? 1 : 0;
    expect(flags == constant, content.place(0) - 4,
           fmt::format("a message of type {} of {} has the flags {} instead of {}", type, owner, flags, constant));
    switch (kind) {
      case Message::nil:
        return pieces_.leave(content.place(0), content.place(content.size()));
      case Message::dataspace:
        once(header.extent.has_value());
        header.extent = read_extent(content, owner);
        return;
      case Message::datatype:
        once(header.type.has_value());
        header.type = read_type(content, owner);
        return;
      case Message::fill_value:
        once(header.fill);
        header.fill = true;
        return check_fill(content, owner);
      case Message::layout:
        once(header.layout.has_value());
        header.layout = content;
        return;
      case Message::attribute:
        return read_attribute(content, owner);
      case Message::modification_time:
        content.expect_number(0, 1, 1, fmt::format("the version of the time of {}", owner));
        return content.expect_zeros(1, 3);
      case Message::continuation:
        return;
      case Message::filter:
        header.filtered = true;
        return pieces_.leave(content.place(0), content.place(content.size()));
      case Message::symbol_table:
        once(header.group.has_value());
        header.group = content;
        return content.expect_zeros(16, content.size() - 16);
      default:
        expect(false, content.place(0) - 8,
               fmt::format("the header of {} has a message of type {}, which no such file has", owner, type));
    }
  }

  /// Whether somebody else may have put such a message to the root, which has none of noether's attributes.
  static bool is_added(Message kind) {
    return kind == Message::link_info || kind == Message::link || kind == Message::group_info ||
           kind == Message::attribute || kind == Message::comment;
  }

  static void check_fill(const Block& content, const std::string& owner) {
    content.expect_number(0, 1, 2, fmt::format("the version of the fill value of {}", owner));
    const std::uint64_t allocated = content.number(1, 1), written = content.number(2, 1);
    expect(allocated >= 1 && allocated <= 3, content.place(1),
           fmt::format("the space of {} is allocated at time {}, 1 to 3 are known", owner, allocated));
    expect(written <= 2, content.place(2),
           fmt::format("the fill value of {} is written at time {}, 0 to 2 are known", owner, written));
    content.expect_number(3, 1, 1, fmt::format("whether {} has a fill value", owner));
    content.expect_zeros(4, content.size() - 4);
  }

  void read_attribute(const Block& content, const std::string& object) {
    const auto padded = [](std::uint64_t size) { return (size + 7) / 8 * 8; };
    content.expect_number(0, 1, 1, fmt::format("the version of an attribute of {}", object));
    content.expect_zeros(1, 1);
    const std::uint64_t name_size = content.number(2, 2), type_size = content.number(4, 2),
                        extent_size = content.number(6, 2);
    const std::string_view name = content.text(8, name_size);
    expect(name.size() > 1 && name.find('\0') == name.size() - 1, content.place(2),
           fmt::format("the name of an attribute of {} does not have {} bytes", object, name_size));
    const std::string owner = fmt::format("attribute '{}' of {}", name.substr(0, name.size() - 1), object);
    std::uint64_t offset = 8 + padded(name_size);
    content.expect_zeros(8 + name_size, padded(name_size) - name_size);
    const Type type = read_type(content.part(offset, padded(type_size)), owner);
    offset += padded(type_size);
    const std::vector<std::uint64_t> extent = read_extent(content.part(offset, padded(extent_size)), owner);
    offset += padded(extent_size);
    const std::uint64_t bytes = bytes_of(extent, type.size, content.size(), content.place(6), owner);
    expect(offset + bytes <= content.size() && content.size() - offset - bytes < 8, content.place(0) - 6,
           fmt::format("{} has {} bytes in a message of {}", owner, bytes, content.size()));
    pieces_.leave(content.place(offset + bytes), content.place(content.size()));
    if (type.kind == Type::Kind::reference)
      for (std::uint64_t k = 0; k < bytes; k += 8)
        references_.emplace_back(content.number(offset + k, 8), content.place(offset + k));
    if (type.kind == Type::Kind::variable_text)
      for (std::uint64_t k = 0; k < bytes; k += 16) check_text(content.part(offset + k, 16), owner);
  }

  void check_text(const Block& pointer, const std::string& owner) {
    const std::uint64_t length = pointer.number(0, 4), heap = pointer.number(4, 8), index = pointer.number(12, 4);
    if (heaps_.count(heap) == 0) heaps_[heap] = walk_global_heap(pieces_, heap, pointer.place(4));
    const auto& objects = heaps_[heap];
    const auto found = objects.find(index);
    expect(found != objects.end(), pointer.place(12), fmt::format("the text of {} is not in its heap", owner));
    expect(found->second == length, pointer.place(0),
           fmt::format("{} has {} bytes, its heap {}", owner, length, found->second));
  }

  Pieces pieces_;
  bool foreign_ = false, others_ = false;  ///< others: the root has members that are not noether's
  std::deque<Object> waiting_;
  std::map<std::uint64_t, std::uint64_t> links_;                                 ///< names of each header
  std::map<std::uint64_t, std::pair<std::uint64_t, std::uint64_t>> told_links_;  ///< as it says, and where
  std::vector<std::pair<std::uint64_t, std::uint64_t>> references_;              ///< target, and where it stands
  std::map<std::uint64_t, std::map<std::uint64_t, std::uint64_t>> heaps_;
};

}  // namespace

}  // namespace hdf5_pieces

Hdf5Walk walk_hdf5(std::istream& file, std::uint64_t size) {
  static constexpr std::string_view signature_and_version("\x89HDF\r\n\x1a\n\0", 9);
  Hdf5Walk result;
  std::string begin(signature_and_version.size(), '\0');
  file.clear();
  file.seekg(0);
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  if (file.gcount() < static_cast<std::streamsize>(begin.size()) || begin != signature_and_version) return result;
  hdf5_pieces::Walk walk(file, size);
  try {
    walk.run();
    result.unused = walk.unused(size);
    result.unwritten = walk.unwritten();
  } catch (const hdf5_pieces::Damage& damage) {
    if (!walk.is_foreign()) result.fault = damage.fault;
  }
  return result;
}

Hdf5Walk walk_hdf5(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(file, error);
  return in && !error ? walk_hdf5(in, size) : Hdf5Walk{};
}

std::string to_text(const Hdf5Fault& fault) {
  return fmt::format("the structure of the file is damaged at byte {}: {}", fault.byte, fault.what);
}

}  // namespace noether::io
