#pragma once
/// A first-order system of one's own: three substances and three reactions.

#include "engine/description.hpp"
#include "integrators/first_order_system.hpp"

#include <string>
#include <vector>

/// Robertson's kinetics: A -> B slowly, B + B -> C + B very fast, B + C -> A + C fast.
///
///     A' = -k1 A + k3 B C,   B' = k1 A - k2 B^2 - k3 B C,   C' = k2 B^2
struct Kinetics {
  double k1 = 0.04, k2 = 3e7, k3 = 1e4;  ///< [1/time]

  static constexpr auto describe() {
    using namespace noether;
    return part<Kinetics>("robertson", "chemical kinetics of three substances, rates nine decades apart",
                          source("Robertson1966"), field<&Kinetics::k1>("k1", "1/time", "of A -> B"),
                          field<&Kinetics::k2>("k2", "1/time", "of B + B -> C + B"),
                          field<&Kinetics::k3>("k3", "1/time", "of B + C -> A + C"));
  }

  noether::Index size() const { return 3; }
  std::vector<double> start() const { return {1, 0, 0}; }
  std::vector<std::string> names() const { return {"A", "B", "C"}; }

  template <class Real> void rates(const Real& /*t*/, const noether::Vector<Real>& y, noether::Vector<Real>& dy) const {
    const Real made = Real(k1) * y[0], back = Real(k3) * y[1] * y[2], used = Real(k2) * y[1] * y[1];
    dy[0] = back - made;
    dy[1] = made - back - used;
    dy[2] = used;
  }
};
