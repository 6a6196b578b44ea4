#pragma once
/// SIGINT and SIGTERM end a run after its step; a second one ends the program at once.

#include <atomic>

namespace noether {

/// While one of these lives, the first SIGINT or SIGTERM sets a flag, and the next acts as the system would.
class StopOnSignals {
 public:
  StopOnSignals();
  ~StopOnSignals();
  StopOnSignals(const StopOnSignals&) = delete;
  StopOnSignals& operator=(const StopOnSignals&) = delete;

  const std::atomic<bool>* flag() const;
};

}  // namespace noether
