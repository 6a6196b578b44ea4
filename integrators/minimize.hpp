#pragma once
/// From a bad start to the next minimum of the potential energy.
///
/// It stands beside the integrators because it moves particles by forces; a scene calls it before its first step.

#include "engine/description.hpp"
#include "engine/erasure.hpp"
#include "engine/outcome.hpp"

#include <cstdint>
#include <optional>

namespace noether {

struct MinimizeOptions {
  double max_force = 0.0;         ///< largest |f_i| that ends it [force]
  std::int64_t steps = 10000;     ///< at most so many force evaluations
  double max_displacement = 0.0;  ///< of a particle in one step [length]; 0: a twentieth of the mean distance

  static constexpr auto describe() {
    return part<MinimizeOptions>(
        "minimize", "moves the particles to a minimum of the energy before the first step",
        formula("v -> (1 - alpha) v + alpha |v| f/|f| along f.v > 0, v -> 0 against it"), source("BitzekEtAl2006"),
        field<&MinimizeOptions::max_force>("max_force", "force",
                                           "the minimization ends when no particle has a larger force")
            .required("\"10 kJ/mol/nm\""),
        field<&MinimizeOptions::steps>("steps", "1", "largest number of force evaluations"),
        field<&MinimizeOptions::max_displacement>(
            "max_displacement", "length",
            "largest displacement of a particle in one step; 0: a twentieth of the mean distance"));
  }
  /// @throws Error  for what is no force, number of steps or length
  void check() const;
};

/// How a minimization ended.
struct Minimized {
  std::int64_t steps = 0;          ///< force evaluations
  double force = 0;                ///< largest |f_i| at the end [force]
  std::optional<Failure> failure;  ///< why it did not come to `max_force`

  bool converged() const { return !failure.has_value(); }
};

/// What holds particles while they go downhill: constraints, of which integrators know no more than this.
class MinimizeAlong {
 public:
  virtual ~MinimizeAlong() = default;
  /// Takes the particles onto the constraints. @throws Error  where they are too far from them
  virtual void bind(ParticleSystem<double>& s) = 0;
  /// x += h v along the constraints; v follows.
  virtual void advance_positions(ParticleSystem<double>& s, double h) = 0;
  /// Takes from velocities what leads off the constraints. @param h  of the step that comes [time]
  virtual void project_velocities(ParticleSystem<double>& s, double h) = 0;
  /// Makes accelerations by forces those of motion along the constraints.
  virtual void constrain(const ParticleSystem<double>& s, VectorColumn<double>& a) = 0;
  /// Why one of these could not be done since the last time it was asked.
  virtual std::optional<Failure> take_failure() = 0;
};

/// Moves particles downhill until no force is above `max_force`: FIRE, the fast inertial relaxation engine.
///
/// All particles run as if they had one mass, along their forces; whenever the power f.v is negative they go back half
/// a step, stand still, and begin again with half the time step, which stays below the limit of
/// the stiffest motion seen of late. No particle moves further than `max_displacement` in a
/// step, so that forces of overlapping particles, however large, drive them apart and not away. Where a force cannot be
/// computed the last step is taken back. Along constraints the forces that count are those that they leave over, and
/// particles end on them to their tolerance. Velocities of the particles are left as they are; sums are in fixed
/// blocks, so that any number of threads gives the same bits.
/// @throws Error  if a force depends on velocities or time, or dissipates: it has no minimum
/// @cost `steps` evaluations of the forces at most
/// @source BitzekEtAl2006, GuenoleEtAl2020
/// @param along  null: particles are free
Minimized minimize(ParticleSystem<double>& s, const AnyForce<double>& forces, const MinimizeOptions& options,
                   MinimizeAlong* along = nullptr);

}  // namespace noether
