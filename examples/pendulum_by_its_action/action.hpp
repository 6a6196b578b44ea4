#pragma once
/// A pendulum by its Lagrangian, and by a discrete Lagrangian: both as a user writes them.

#include "integrators/variational/discrete_lagrangian.hpp"
#include "integrators/variational/lagrangian_system.hpp"

#include <cmath>
#include <string>

/// L = theta'^2 / 2 + cos(theta)
struct Pendulum {
  noether::Index size() const { return 1; }
  std::string name() const { return "pendulum"; }

  template <class Real>
  Real lagrangian(const Real& /*t*/, const noether::Vector<Real>& q, const noether::Vector<Real>& v) const {
    using std::cos;
    return v[0] * v[0] / Real(2) + cos(q[0]);
  }
};

/// The action of a straight path, its potential by Simpson's rule.
struct StraightPath {
  int order() const { return 2; }

  template <class Real>
  Real operator()(const noether::Vector<Real>& q0, const noether::Vector<Real>& q1, const Real& h) const {
    using std::cos;
    const Real v = (q1[0] - q0[0]) / h, middle = (q0[0] + q1[0]) / Real(2);
    return h * (v * v / Real(2) + (cos(q0[0]) + Real(4) * cos(middle) + cos(q1[0])) / Real(6));
  }
};
