#include "numbers/cost_book.hpp"

#include "numbers/error.hpp"

#include <algorithm>

namespace noether {

CostBook::CostBook() {
  if (open_ != nullptr) throw LogicError("another book of costs is open");
  open_ = this;
}

CostBook::~CostBook() { open_ = nullptr; }

void CostBook::begin_anew() {
  for (Entry& one : entries_) one.seconds = 0;
  since_ = WallClock::now();
}

std::vector<CostBook::Entry> CostBook::entries() const {
  std::vector<Entry> entries = entries_;
  entries[current_].seconds += std::chrono::duration<double>(WallClock::now() - since_).count();
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.seconds > b.seconds; });
  return entries;
}

/// Goes over to a part. @return the one before
std::size_t CostBook::begin(std::string_view kind, std::string_view name) {
  std::size_t next = 0;
  while (next < entries_.size() && (entries_[next].kind != kind || entries_[next].name != name)) ++next;
  if (next == entries_.size()) entries_.push_back({std::string(kind), std::string(name), 0});
  const std::size_t before = current_;
  charge(next);
  return before;
}

/// Charges the time since the last look at the clock to the part that runs, and goes over to another one.
void CostBook::charge(std::size_t next) {
  const WallClock::time_point now = WallClock::now();
  entries_[current_].seconds += std::chrono::duration<double>(now - since_).count();
  since_ = now;
  current_ = next;
}

}  // namespace noether
