#pragma once
/// Python's signals, and who wants to know how far a run is, while the run goes on without Python's lock.

#include "engine/simulation.hpp"

#include <nanobind/nanobind.h>

#include <atomic>
#include <optional>
#include <utility>

namespace noether::python {

/// Looks ten times a second. What a signal or the function raises ends the run after its step, and is raised then.
class SignalWatch {
 public:
  /// @param tell  called as tell(step, time, seconds); None: nobody wants to know
  explicit SignalWatch(nanobind::object tell) : tell_(std::move(tell)) {}

  const std::atomic<bool>* flag() const { return &stop_; }
  void look(const Progress& progress) {
    const nanobind::gil_scoped_acquire locked;
    try {
      if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
      if (!tell_.is_none()) tell_(progress.step, progress.time, progress.seconds);
    } catch (nanobind::python_error& error) {
      if (!raised_) raised_.emplace(std::move(error));
      stop_ = true;
    }
  }
  void raise_again() {
    if (raised_) throw std::move(*raised_);
  }

 private:
  nanobind::object tell_;
  std::atomic<bool> stop_ = false;
  std::optional<nanobind::python_error> raised_;
};

}  // namespace noether::python
