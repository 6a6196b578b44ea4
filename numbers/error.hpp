#pragma once
/// The exceptions of noether, and the two checks on a programmer's faults.

#include <cassert>
#include <stdexcept>
#include <string>

namespace noether {

/// Where in the input an error stands; what is not known stays empty (line: 0).
struct ErrorLocation {
  std::string file = {};
  int line = 0;
  std::string key = {};    ///< dotted key of the scene, such as "integrator.step"
  std::string value = {};  ///< the offending value as it was written
};

/// Root of all exceptions of noether.
///
/// `what()` is one line, "file:line: message" when a location is known; `message()` is the same without the location.
/// Messages are lower case and name the offending value, what was expected and what to do.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message);
  Error(const std::string& message, ErrorLocation location);

  /// What the program returns to the shell: 2, the request is wrong.
  /// @throws never
  virtual int exit_code() const noexcept { return 2; }

  const std::string& message() const noexcept { return message_; }
  const ErrorLocation& location() const noexcept { return location_; }
  const std::string& file() const noexcept { return location_.file; }
  int line() const noexcept { return location_.line; }
  const std::string& key() const noexcept { return location_.key; }
  const std::string& value() const noexcept { return location_.value; }

 private:
  std::string message_;
  ErrorLocation location_;
};

/// The scene asks for what cannot be done: exit code 2.
class SceneError : public Error {
 public:
  using Error::Error;
};

/// A file cannot be read or written, or is damaged: exit code 3.
class FileError : public Error {
 public:
  using Error::Error;
  int exit_code() const noexcept override { return 3; }
};

/// A scheme does not fit the Hamiltonian it is asked to walk: exit code 2.
class SchemeMismatch : public Error {
 public:
  using Error::Error;
};

/// Constraints that no motion can keep, or that the particles do not keep at the start: exit code 2.
class BadConstraints : public Error {
 public:
  using Error::Error;
};

/// A part needs a column that the particles do not have: exit code 2.
class MissingColumn : public Error {
 public:
  using Error::Error;
};

/// A C++ program uses the library against its contract: exit code 4.
class LogicError : public Error {
 public:
  using Error::Error;
  int exit_code() const noexcept override { return 4; }
};

/// A branch in lanes that does not agree (numbers/pack.hpp, `Mask`): whoever asked for eight lanes at once takes them
/// one by one. Code of one's own over packs may write `select` instead, or ask for `any` and `all`.
class LanesDiffer : public LogicError {
 public:
  LanesDiffer() : LogicError("a condition holds in some lanes and not in others; write select(condition, a, b)") {}
};

}  // namespace noether

/// Checks an invariant of the library itself, in debug builds only; the condition is compiled, never run, in others.
#ifdef NDEBUG
#define NOETHER_ASSERT(condition) static_cast<void>(sizeof((condition) ? 1 : 0))
#else
#define NOETHER_ASSERT(condition) assert(condition)
#endif

/// Checks what a caller must grant, in every build; the message is built only on failure.
/// @throws LogicError
#define NOETHER_EXPECTS(condition, message)                 \
  do {                                                      \
    if (!(condition)) throw ::noether::LogicError(message); \
  } while (false)
