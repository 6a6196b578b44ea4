#pragma once
/// Shearing sheets of tests.

#include "integrators/shearing_sheet.hpp"
#include "tests/support/drivers.hpp"

#include <utility>

namespace noether::test {

/// The Hamiltonian of a shearing sheet with these forces.
template <class Real, class... Fs> AnyHamiltonian<Real> sheet(const ShearingSheetOptions& options, Fs... forces) {
  return options.split<Real>(field_of<Real>(std::move(forces)...));
}

}  // namespace noether::test
