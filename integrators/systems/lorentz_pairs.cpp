#include "integrators/systems/lorentz_pairs.hpp"

namespace noether {

std::vector<double> LorentzPairs::start() const {
  std::vector<double> state = positions;
  for (std::size_t d = 0; d < velocities.size(); ++d) state.push_back(masses[d / 3] * velocities[d]);
  return state;
}

MomentumSharing LorentzPairs::momentum_sharing() const {
  return [system = *this](const Eigen::VectorXd& y) {
    const Index n = system.size();
    const Vector<double> q = y.head(n), p = y.tail(n);
    Vector<double> v = p;
    for (Index d = 0; d < n; ++d) v[d] /= system.masses[static_cast<std::size_t>(d / 3)];
    return shares_of_charges(system.lists(), q, v, p);
  };
}

template class LagrangianMotion<LorentzPairs, double>;
template class LagrangianMotion<LorentzPairs, Quad>;

}  // namespace noether
