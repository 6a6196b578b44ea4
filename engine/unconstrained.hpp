#pragma once
/// No constraints: what a Hamiltonian is made with unless somebody gives it some.

namespace noether {

/// A set of constraints that holds nothing and costs nothing. A set with something in it offers, beside `trivial`,
/// `equations()` and `options().tolerance`, a `Solver<Real>` with `bind`, `advance_positions`, `project_velocities`,
/// `constrain`, `virial`, `failure` (constraints/constraint_solver.hpp): constraints reach the flows as a template
/// parameter, so that these two rooms need not see each other.
struct Unconstrained {
  static constexpr bool trivial = true;
  template <class Real> struct Solver {
    explicit Solver(const Unconstrained& /*none*/) {}
  };
};

}  // namespace noether
