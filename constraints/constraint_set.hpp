#pragma once
/// The constraints of a system, type by type, and how they are to be solved.

#include "constraints/constraint_group.hpp"
#include "constraints/constraint_method.hpp"
#include "constraints/rigid_bar.hpp"
#include "engine/equations.hpp"
#include "engine/particle_system.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace noether {

struct ConstraintOptions {
  ConstraintMethod solver = ConstraintMethod::newton;
  double tolerance = 1e-7;               ///< rattle, p_shake: largest relative violation that is left [1]
  std::optional<Index> iterations = {};  ///< rattle, p_shake: most sweeps of one stage; lincs: corrections of lengths
  Index order = 4;                       ///< lincs: powers of the series

  static constexpr auto describe() {
    return part<ConstraintOptions>(
        "constraint_solver", "how constraints are solved",
        field<&ConstraintOptions::solver>("solver", "1",
                                          "newton: to rounding; rattle: by sweeps to a tolerance; settle: rigid "
                                          "molecules of three sites in closed form; m_shake: each molecule by a dense "
                                          "matrix; p_shake: by a constant one, to a tolerance; lincs: by a series of "
                                          "an order; p_lincs: the same of all molecules together"),
        field<&ConstraintOptions::tolerance>("tolerance", "1",
                                             "for rattle and p_shake: largest relative violation that may remain"),
        field<&ConstraintOptions::iterations>("iterations", "1",
                                              "for rattle and p_shake: largest number of sweeps per stage, default "
                                              "1000; for lincs: corrections of lengths, default 1"),
        field<&ConstraintOptions::order>("order", "1", "for lincs: number of terms of the series"));
  }
  /// @throws Error  for a tolerance that is not above 0, a number of sweeps or an order below 1
  void check() const;
  SolverEnd end() const { return info_of(solver).end; }
  Index most_iterations() const { return iterations.value_or(info_of(solver).iterations); }
  /// The relative violation that is left on purpose; 0: rounding. That of a series depends on the step: about what
  /// bonds of molecules have at steps that are usual.
  double violation() const;
  std::string signature() const;
};

/// One equation of a set, found.
struct ConstraintPlace {
  const ConstraintGroup* group;
  Index constraint;  ///< within the group
};

template <class Real> class ConstraintSolver;

/// Holonomic constraints g(q) = 0.
///
///     ConstraintSet links;
///     links.add(s, Fixed{}, {0});
///     for (Index i = 1; i < s.size(); ++i) links.add(s, Distance{}, {i - 1, i});
///     auto rattle = compose(KineticPotential(UniformField{{0, 0, -9.81}}, links), schemes::verlet);
///
/// What a set asks of the particles is checked when an integrator is bound to them.
class ConstraintSet {
 public:
  template <class Real> using Solver = ConstraintSolver<Real>;
  static constexpr bool trivial = false;

  /// @throws Error  see ConstraintOptions::check
  explicit ConstraintSet(ConstraintOptions options = {});
  ConstraintSet(const ConstraintSet& other);
  ConstraintSet(ConstraintSet&&) noexcept = default;
  ConstraintSet& operator=(const ConstraintSet& other);
  ConstraintSet& operator=(ConstraintSet&&) noexcept = default;
  ~ConstraintSet() = default;

  /// Adds a constraint on particles of `s`; what it was not told it takes from their positions.
  /// @throws BadConstraints  for a particle that is not there, one that stands twice, one of mass 0
  /// @throws Error  for parameters the constraint refuses
  template <Constraint C>
  ConstraintSet& add(const ParticleSystem<double>& s, C constraint, const std::array<Index, C::particles>& particles) {
    check_particles(s, detail::name_of(constraint), particles.data(), particles.size());
    check_part(constraint);
    if constexpr (requires { constraint.at_start(Points<double, C::particles>{}); }) {
      constraint = constraint.at_start(ConstraintPositions<double>(s).of(particles, detail::keeps_momentum<C>()));
      check_part(constraint);
    }
    group_of<C>().add(std::move(constraint), particles);
    return *this;
  }

  const ConstraintOptions& options() const { return options_; }
  const std::vector<std::unique_ptr<ConstraintGroup>>& groups() const { return groups_; }
  bool empty() const { return groups_.empty(); }
  /// The same constraints, solved in another way. @throws Error  see ConstraintOptions::check
  ConstraintSet solved_by(ConstraintOptions options) const;
  /// A set of some of its constraints, solved in the same way. @param keep  by equation
  ConstraintSet only(const std::vector<bool>& keep) const;
  /// Number of equations: the degrees of freedom they take.
  Index equations() const;
  /// Finds its particles among those of a run, by their ids from the first time on.
  /// @throws Error  for a particle that has gone
  void find(const std::vector<std::int64_t>& ids) {
    for (const auto& group : groups_) group->find(ids);
  }
  /// The constraint that an equation belongs to. @param equation  in [0, equations())
  ConstraintPlace place(Index equation) const;
  /// A constraint in words: "distance of 'a' and 'b'".
  template <class Real> std::string words(Index equation, const ParticleSystem<Real>& s) const {
    return words_of(place(equation), s.names());
  }

  /// The equation that is violated most, relative to its scale.
  struct Worst {
    double residual = 0;
    Index equation = -1;
  };
  template <class Real> Worst worst(const ParticleSystem<Real>& s) const;

  /// The relative violation that is left on purpose; 0: rounding.
  double tolerance() const { return options_.violation(); }
  bool keeps_momentum() const;
  bool keeps_angular_momentum() const;
  /// g = 0 and dg/dt = 0 as equations of a state, for projections.
  template <class Real> std::unique_ptr<Equations<Real>> as_equations() const;
  /// Everything in text: a run goes on with the same set only.
  std::string signature() const;

 private:
  template <class C> ConstraintsOf<C>& group_of() {
    for (const auto& group : groups_) {
      if (auto* found = dynamic_cast<ConstraintsOf<C>*>(group.get())) return *found;
    }
    groups_.push_back(std::make_unique<ConstraintsOf<C>>());
    return static_cast<ConstraintsOf<C>&>(*groups_.back());
  }
  static void check_particles(const ParticleSystem<double>& s, const std::string& name, const Index* particles,
                              std::size_t count);
  static std::string words_of(const ConstraintPlace& place, const std::vector<std::string>& names);

  ConstraintOptions options_;
  std::vector<std::unique_ptr<ConstraintGroup>> groups_;
};

/// Puts particles on a rigid bar: the first and the last are its ends, the others stay in their places between them.
/// @throws BadConstraints  for fewer than two
ConstraintSet& add_rigid_bar(ConstraintSet& set, const ParticleSystem<double>& s, const std::vector<Index>& particles);

}  // namespace noether
