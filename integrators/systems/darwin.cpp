#include "integrators/systems/darwin.hpp"

#include <limits>

namespace noether {

Vector<double> Darwin::own_momenta(const Vector<double>& v) const {
  Vector<double> own = v;
  for (Index i = 0; i < std::ssize(masses); ++i) {
    const double grown = 1 + norm2(of_charge(v, i)) / (2 * c * c);
    own.segment<3>(3 * i) *= masses[static_cast<std::size_t>(i)] * grown;
  }
  return own;
}

std::vector<double> Darwin::start() const {
  std::vector<double> state = positions;
  const Vector<double> q = Eigen::Map<const Vector<double>>(positions.data(), size()),
                       v = Eigen::Map<const Vector<double>>(velocities.data(), size());
  Vector<double> p = own_momenta(v);
  for (Index i = 0; i < std::ssize(masses); ++i) {
    for (Index j = 0; j < std::ssize(masses); ++j) {
      if (j == i) continue;
      const double coupling = k * charges[static_cast<std::size_t>(i)] * charges[static_cast<std::size_t>(j)];
      const PairPlace<double> at = place_of_pair(Vec3<double>(of_charge(q, i) - of_charge(q, j)));
      p.segment<3>(3 * i) += potential_momentum(at, coupling, c, of_charge(v, j));
    }
  }
  state.insert(state.end(), p.begin(), p.end());
  return state;
}

MomentumSharing Darwin::momentum_sharing() const {
  return [system = *this](const Eigen::VectorXd& y) {
    const Index n = system.size();
    const Vector<double> q = y.head(n), p = y.tail(n);
    Vector<double> v;
    LagrangianMotion<Darwin, double> motion(system);
    if (motion.velocity(0, q, p, v)) v.setConstant(n, std::numeric_limits<double>::quiet_NaN());
    return shares_of_charges(system.lists(), q, v, system.own_momenta(v));
  };
}

template class LagrangianMotion<Darwin, double>;
template class LagrangianMotion<Darwin, Quad>;

}  // namespace noether
