#include "io/ensemble_journal.hpp"

#include "io/files.hpp"
#include "numbers/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

namespace noether::io {

namespace {

constexpr std::string_view rows_mark = "noether-ensemble-rows-1 ";
constexpr std::size_t row_fixed_bytes =
    9 * 8;  ///< of a row without values: four whole numbers, the digest and the time

/// FNV-1a: a row that was torn is not taken for one.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char one : bytes) hash = (hash ^ static_cast<unsigned char>(one)) * 0x100000001b3U;
  return hash;
}

std::uint64_t number_at(const char* bytes) {
  std::uint64_t number = 0;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

}  // namespace

std::filesystem::path ensemble_journal_of(const std::filesystem::path& file) { return file.string() + ".rows"; }

EnsembleJournal::EnsembleJournal(std::filesystem::path file, const EnsembleDefinition& definition, bool fresh)
    : file_(std::move(file)),
      width_(static_cast<std::size_t>(definition.width())),
      header_(std::string(rows_mark) + definition.digest() + "\n") {
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_APPEND, 0666);
  if (descriptor_ < 0) {
    throw FileError(fmt::format("the file cannot be written: {}", std::strerror(errno)), {.file = file_.string()});
  }
  try {
    lock();
    begin(fresh);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

EnsembleJournal::~EnsembleJournal() {
  ::close(descriptor_);  // and with it goes the lock
}

void EnsembleJournal::lock() {
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  if (errno != EWOULDBLOCK) {
    throw FileError(fmt::format("the file cannot be locked: {}", std::strerror(errno)), {.file = file_.string()});
  }
  throw SceneError("another process makes this ensemble; wait for it, or give another file with --out",
                   {.file = file_.string()});
}

void EnsembleJournal::begin(bool fresh) {
  const std::string bytes = fresh ? std::string() : read_bytes(file_);
  if (!bytes.empty() && bytes.starts_with(rows_mark) && !bytes.starts_with(header_) && bytes.size() >= header_.size()) {
    throw SceneError(
        "these are rows of another ensemble, which is unfinished; give another file with --out, or --fresh to discard "
        "them",
        {.file = file_.string()});
  }
  if (bytes.size() >= header_.size() && !bytes.starts_with(header_)) {
    throw SceneError("this file does not hold rows of an ensemble; give another file with --out",
                     {.file = file_.string()});
  }
  if (bytes.size() >= header_.size()) return read_rows(bytes);
  if (::ftruncate(descriptor_, 0) != 0 ||
      ::write(descriptor_, header_.data(), header_.size()) != static_cast<ssize_t>(header_.size())) {
    throw FileError(fmt::format("the file cannot be written: {}", std::strerror(errno)), {.file = file_.string()});
  }
}

void EnsembleJournal::read_rows(const std::string& bytes) {
  const std::size_t row = row_fixed_bytes + width_ * sizeof(double), whole = row + sizeof(std::uint64_t);
  std::size_t at = header_.size();
  for (; at + whole <= bytes.size(); at += whole) {
    if (checksum({bytes.data() + at, row}) != number_at(bytes.data() + at + row)) break;
    rows_.push_back(EnsembleRow::from_bytes(bytes.data() + at, width_));
  }
  if (::ftruncate(descriptor_, static_cast<off_t>(at)) != 0) {
    throw FileError(fmt::format("the file cannot be written: {}", std::strerror(errno)), {.file = file_.string()});
  }
}

void EnsembleJournal::append(EnsembleRow row) {
  NOETHER_EXPECTS(row.values.size() == width_, "a row has as many values as the ensemble has columns");
  std::string bytes = row.bytes();
  const std::uint64_t sum = checksum(bytes);
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  errno = 0;
  if (::write(descriptor_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
    throw FileError(fmt::format("the file cannot be written: {}", std::strerror(errno != 0 ? errno : ENOSPC)),
                    {.file = file_.string()});
  }
  rows_.push_back(std::move(row));
}

void EnsembleJournal::remove() {
  if (::unlink(file_.c_str()) == 0) return;
  throw FileError(fmt::format("the file cannot be removed: {}", std::strerror(errno)), {.file = file_.string()});
}

}  // namespace noether::io
