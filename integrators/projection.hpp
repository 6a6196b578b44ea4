#pragma once
/// What a projection is asked for: which invariants, along which directions.

#include "engine/description.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace noether {

/// What every step is brought back to.
enum class Invariant : std::uint8_t { energy, momentum, angular_momentum, constraints };

/// Along which directions.
enum class Projection : std::uint8_t { orthogonal, oblique, symmetric, hamiltonian };

/// What is small in an orthogonal projection.
enum class ProjectionNorm : std::uint8_t { mass, plain };

/// What an oblique projection moves.
enum class Moves : std::uint8_t { velocities, positions };

template <> struct EnumNames<Invariant> {
  static constexpr std::array<std::pair<Invariant, std::string_view>, 4> values = {
      {{Invariant::energy, "energy"},
       {Invariant::momentum, "momentum"},
       {Invariant::angular_momentum, "angular_momentum"},
       {Invariant::constraints, "constraints"}}};
};
template <> struct EnumNames<Projection> {
  static constexpr std::array<std::pair<Projection, std::string_view>, 4> values = {
      {{Projection::orthogonal, "orthogonal"},
       {Projection::oblique, "oblique"},
       {Projection::symmetric, "symmetric"},
       {Projection::hamiltonian, "hamiltonian"}}};
};
template <> struct EnumNames<ProjectionNorm> {
  static constexpr std::array<std::pair<ProjectionNorm, std::string_view>, 2> values = {
      {{ProjectionNorm::mass, "mass"}, {ProjectionNorm::plain, "plain"}}};
};
template <> struct EnumNames<Moves> {
  static constexpr std::array<std::pair<Moves, std::string_view>, 2> values = {
      {{Moves::velocities, "velocities"}, {Moves::positions, "positions"}}};
};

/// The name of a value, as scenes write it.
template <class E> std::string choice_name(E one) {
  for (const auto& [value, name] : EnumNames<E>::values) {
    if (value == one) return std::string(name);
  }
  return "";
}

/// A projection as a part of scenes: `[integrator.projection]`.
struct ProjectionOptions {
  std::vector<Invariant> onto = {};
  Projection how = Projection::orthogonal;
  std::optional<Moves> moves = {};     ///< oblique
  std::vector<double> direction = {};  ///< oblique, of one equation: a direction of y, shape (size of y)
  ProjectionNorm norm = ProjectionNorm::mass;
  double time_scale = 1;         ///< weighs velocities against positions [time]
  double tolerance = 0;          ///< relative error of an invariant that may be left [1]; 0: rounding
  std::int64_t iterations = 50;  ///< most of a step

  static constexpr auto describe() {
    return part<ProjectionOptions>(
        "projection", "brings every step back to invariants of the motion",
        formula("y -> y + D(y) lambda, g(y + D(y) lambda) = 0; orthogonal: D = W^-1 g'(y)^T"),
        source("HairerLubichWanner2006"),
        field<&ProjectionOptions::onto>("onto", "1", "what every step is brought back to").required("[\"energy\"]"),
        field<&ProjectionOptions::how>(
            "how", "1",
            "orthogonal: along gradients; oblique: along a given direction; symmetric: along gradients before and "
            "after each step, which keeps it reversible; hamiltonian: along the flows of the invariants themselves"),
        field<&ProjectionOptions::moves>("moves", "1", "for oblique: the part of gradients that is the direction"),
        field<&ProjectionOptions::direction>(
            "direction", "1", "for oblique, instead of moves: a direction for all x, y, z, then all velocities"),
        field<&ProjectionOptions::norm>("norm", "1",
                                        "W weighs particles by their masses, or all alike; mass keeps the center of "
                                        "mass where it is"),
        field<&ProjectionOptions::time_scale>("time_scale", "time",
                                              "W weighs velocities by its square against positions"),
        field<&ProjectionOptions::tolerance>("tolerance", "1",
                                             "relative error of an invariant that may be left; 0: rounding"),
        field<&ProjectionOptions::iterations>("iterations", "1", "largest number of iterations for one step"));
  }
  /// @throws Error  for nothing to project onto, one invariant twice, and options that do not go together
  void check() const;
  /// The same where there may be equations beside `onto`.
  void check_directions() const;

  bool has(Invariant one) const;
  /// What it adds to a step, in words.
  std::string cost() const;
  /// "energy, angular_momentum".
  std::string words() const;
  std::string signature() const;
};

}  // namespace noether
