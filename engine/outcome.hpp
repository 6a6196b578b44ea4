#pragma once
/// How a run ended: what is normal in a simulation is a value, not an exception.

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace noether {

/// The particle an outcome speaks of.
struct ParticleRef {
  std::int64_t index = 0;  ///< where it stands in the arrays
  std::int64_t id = 0;     ///< its identity, never reused
  std::string name;        ///< empty where particles have no names

  bool operator==(const ParticleRef&) const = default;
};

/// Why and where a run ended.
struct [[nodiscard]] Outcome {
  enum class Kind {
    completed,           ///< the end that was asked for
    stopped,             ///< an event that the scene asked for: escape, collision
    interrupted,         ///< a signal; the checkpoint is written
    diverged,            ///< the state is not finite
    constraint_failure,  ///< a constraint solver did not converge
    solver_failure,      ///< an implicit step did not converge
    step_underflow,      ///< the error controller asked for a step below the resolution of time
    overlap,             ///< two particles came closer than the potential is defined
    overstretch,         ///< a bond is longer than its potential allows
    inverted_element     ///< a tetrahedron of a body that deforms has been turned inside out
  };

  Kind kind = Kind::completed;
  std::int64_t step = 0;                ///< last whole step: of a run that failed, the one before the failure
  double time = 0;                      ///< time of that step [time]
  std::optional<ParticleRef> particle;  ///< whom it happened to, where it was one particle
  std::string quantity;                 ///< what went wrong with it, such as "position"; may be empty
  std::string message;                  ///< one phrase, such as "escape of Pluto, distance 101.2"; may be empty
  /// How often a pair may have met between two looks of a stop that were too far apart to tell.
  std::int64_t unresolved = 0;

  /// Whether the run ended as asked: completed or stopped.
  /// @throws never
  bool ok() const noexcept { return kind == Kind::completed || kind == Kind::stopped; }
};

/// Why a step could not be done.
struct Failure {
  Outcome::Kind kind = Outcome::Kind::solver_failure;
  std::ptrdiff_t particle = -1;  ///< -1: no particle in particular
  std::string quantity;
  std::string message;
};

/// The kind as reports write it, such as "constraint_failure".
/// @throws never
std::string_view name(Outcome::Kind kind) noexcept;

/// What the program returns to the shell: 0 completed or stopped, 130 interrupted, 1 everything else.
/// @throws never
int exit_code(const Outcome& outcome) noexcept;

/// One line: "stopped at step 400: escape of Pluto, distance 101.2".
///
/// Without a message, particle and quantity are told: "diverged at step 7: position of Mercury is not finite".
/// @throws never
std::string to_text(const Outcome& outcome);

}  // namespace noether

/// Prints `to_text`, with the width and alignment of a string.
template <> struct fmt::formatter<noether::Outcome> : fmt::formatter<std::string_view> {
  fmt::format_context::iterator format(const noether::Outcome& outcome, fmt::format_context& context) const;
};
