#pragma once
/// What the runs of a comparison are measured against.

#include "integrators/vector_field.hpp"
#include "scene/scene.hpp"
#include "study/sampling.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace noether {

/// What a scene is integrated as by y' = f(t, y), in extended precision.
struct WideScene {
  std::unique_ptr<VectorField<Quad>> field = {};       ///< null: there is none
  std::optional<AnyHamiltonian<Quad>> splitting = {};  ///< in its place, of a Hamiltonian that no y' = f tells
  ParticleSystem<Quad> start;                          ///< the run's doubles, widened
  std::string reason = {};                             ///< why there is none
};

/// The motion of a scene in extended precision: all its forces together, those that its Hamiltonian has in itself among
/// them, drag as the force a = -rate v; of a Hamiltonian that is more than forces, the accelerations that it tells; of
/// one that moves columns of its own, the splitting.
/// @throws never  a scene that has none says why
WideScene wide_scene(const Scene& scene);

/// Ends a question that a scene with noise cannot answer.
/// @throws SceneError  if the scene has a bath
void refuse_noise(const Scene& scene);

/// How the reference was made.
enum class TruthKind : std::uint8_t {
  quad,        ///< in extended precision, by two runs that agree
  finest_run,  ///< the finest of the runs compared; its error is its distance from the next
  invariants,  ///< none: only what the equations keep tells errors
};

/// States y = (x, v) at the moments of a sampling, the start among them.
struct Truth {
  TruthKind kind = TruthKind::invariants;
  std::string name = {};             ///< for the column `truth`: "dop853 in quad", "finest run", "invariants"
  std::string note = {};             ///< how it was made, or why there is no better one
  std::optional<double> error = {};  ///< largest distance between two ways to find it, relative as position errors are
  double seconds = 0;                ///< wall time it took
  std::vector<Vector<Quad>> y = {}, rate = {};  ///< rate: dy/dt, for moments that differ by a rounding error
  std::vector<double> energy = {};              ///< total [energy]; empty where nothing tells it

  bool has_states() const { return !y.empty(); }
};

/// How far a truth is driven.
struct TruthOptions {
  double budget = 120;              ///< seconds of wall time for all settings together
  std::optional<double> rtol = {};  ///< of the coarsest run of the first method; default: by the method
};

/// How positions (or the variables of a first-order system) are compared: over all bodies about the centre of mass,
/// where the equations keep it moving straight, relative to |x*|; a single body, and bodies in an outer field, are
/// compared where they stand, relative to the rms of |x*| over the moments, since x* may pass through 0.
class PositionError {
 public:
  PositionError(const ParticleSystem<double>& particles, bool about_center);

  /// Takes the sizes of all truth states. @param y  as in `Truth`
  void set_scale(const std::vector<Vector<Quad>>& y);
  /// norm(x - x*) / norm(x*); of a first-order system, once it knows their sizes, the root mean square over the
  /// variables of each one's error, relative to the largest it ever is: a trace of 1e-5 counts as much as what is
  /// whole.
  /// @param y, truth  shape (size of the state)
  double operator()(const Vector<Quad>& y, const Vector<Quad>& truth) const;
  /// norm(x), of what is compared.
  double size(const Vector<Quad>& y) const;

 private:
  std::vector<Quad> positions(const Vector<Quad>& y) const;

  std::vector<Quad> masses_;
  bool about_center_ = false;
  double scale_ = 0;           ///< 0: relative to |x*| of the moment
  std::vector<double> sizes_;  ///< of the variables of a first-order system: largest |y*|
};

/// Whether positions of a scene are compared about the centre of mass.
bool about_center(const Scene& scene);

/// The reference of a scene in extended precision, at the moments of a sampling.
///
/// The method of highest order that is known in extended precision, extrapolation, beside one of another family,
/// Gauss's 8 stages, which is run finer where the two differ by more than rounding in double precision; their
/// difference is the truth's own error bar. Where Gauss's iteration does not get on, as on stiff systems, extrapolation
/// stands beside itself at other tolerances, and the note says so. Where this cannot be had (a force written for
/// doubles only, constraints, a cost beyond the budget, chaos), the kind is `invariants`, and the note says why.
Truth find_truth(const Scene& scene, const Sampling& sampling, const TruthOptions& options = {});

}  // namespace noether
