#pragma once
/// Where the time of a run goes: seconds by the parts that spend them.

#include <chrono>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace noether {

/// Seconds that parts of a run have spent, each without what others spent inside it, while this book is open.
///
/// A thread has at most one open book, and `Spent` of that thread writes into it. What no part claims is the first
/// entry, the integrator's. A run begins it anew.
class CostBook {
 public:
  /// What one part has spent. The kinds: "integrator", "force", "neighbors", "constraints", "thermostat", "monitor".
  struct Entry {
    std::string kind, name;  ///< the name is empty where there is one part of the kind
    double seconds = 0;
  };

  /// Opens it for this thread. @throws LogicError  if it has another one
  CostBook();
  ~CostBook();
  CostBook(const CostBook&) = delete;
  CostBook& operator=(const CostBook&) = delete;

  /// Forgets what has been charged: the book begins here.
  void begin_anew();
  /// The entries so far, the largest first.
  std::vector<Entry> entries() const;

  /// The open book of this thread; null if there is none.
  static CostBook* of_this_thread() { return open_; }

 private:
  friend class Spent;
  using WallClock = std::chrono::steady_clock;

  std::size_t begin(std::string_view kind, std::string_view name);
  void charge(std::size_t next);

  static inline thread_local CostBook* open_ = nullptr;
  std::vector<Entry> entries_{{"integrator", "", 0}};
  std::size_t current_ = 0;
  WallClock::time_point since_ = WallClock::now();
};

/// Charges the time of a block to a part, if a book is open.
///
///     const Spent spent("force", [&] { return force.name(); });
///
/// @cost a load and a branch where none is open, else two looks at the clock, some 100 ns
class Spent {
 public:
  explicit Spent(std::string_view kind, std::string_view name = "") : book_(CostBook::of_this_thread()) {
    if (book_ != nullptr) before_ = book_->begin(kind, name);
  }
  /// @param name  asked only if a book is open
  template <std::invocable Name> Spent(std::string_view kind, const Name& name) : book_(CostBook::of_this_thread()) {
    if (book_ != nullptr) before_ = book_->begin(kind, name());
  }
  ~Spent() {
    if (book_ != nullptr) book_->charge(before_);
  }
  Spent(const Spent&) = delete;
  Spent& operator=(const Spent&) = delete;

 private:
  CostBook* book_;
  std::size_t before_ = 0;
};

}  // namespace noether
