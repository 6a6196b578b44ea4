#pragma once
/// Bonds, angles, dihedrals and impropers: the terms that a structure brings.

#include "engine/any_force.hpp"
#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "forces/bonded_loop.hpp"
#include "forces/bonded_terms.hpp"
#include "numbers/parallel.hpp"
#include "numbers/simd_loop.hpp"

#include <array>
#include <memory>
#include <type_traits>
#include <vector>

namespace noether {

/// Every bonded term of the topology of the particles.
///
///     U = sum bonds U(r) + sum angles U(theta) + sum dihedrals U(phi) + sum impropers U(chi)
///
/// The potentials, with their parameters in the order of a `TermKind`:
///
///     bonds      harmonic            k, length                   k (r - length)^2 / 2
///                morse               depth, a, length            depth (1 - exp(-a (r - length)))^2
///                fene                k, longest, epsilon, sigma  -k longest^2/2 ln(1 - (r/longest)^2) + U_WCA(r)
///     angles     harmonic            k, angle                    k (theta - angle)^2 / 2
///                cosine              k                           k (1 + cos theta)
///                cosine_squared      k, angle                    k (cos theta - cos angle)^2 / 2
///                urey_bradley        k, angle, k_ends, length    k (theta - angle)^2 / 2 + k_ends (r - length)^2 / 2
///     dihedrals  periodic            k, n, phase                 k (1 + cos(n phi - phase))
///                ryckaert_bellemans  c0, c1, c2, c3, c4, c5      sum c_n cos^n(phi - 180 degrees)
///                one_four            epsilon, sigma, charges     4 epsilon ((sigma/r)^12 - (sigma/r)^6) + charges/r
///     impropers  harmonic            k, angle                    k (chi - angle)^2 / 2,  chi = |phi|
///                periodic            k, n, phase                 k (1 + cos(n phi - phase))
///
/// with r the distance of the first and the last particle of an angle or a dihedral. A term within a group of particles
/// that constraints hold rigid (`Topology::rigid`) is constant, and left out.
///
/// Bonded particles may lie on both sides of a periodic box: the nearest image counts. A dihedral of which three
/// particles are exactly in line has no angle and exerts no force. A `fene` bond of its greatest length or more ends
/// the run as `overstretch`. Terms are evaluated in blocks, then each particle sums its own in their order, so that any
/// number of threads gives the same bits. One object serves one thread at a time; a copy is another object.
/// @cost O(terms); the first call makes lists of 4 bytes for each particle of each term and of 5 for each particle, and
/// a thread keeps 24 for each bond and each particle of other terms. Bonds whose particles follow each other, as along
/// a chain, go in lanes all the way.
/// @source Allen2017, MacKerell1998
struct Bonded {
  static constexpr auto describe() {
    return part<Bonded>("bonded", "bonds, angles, dihedrals and impropers of the structure",
                        formula("U = sum bonds U(r) + sum angles U(theta) + sum dihedrals U(phi) + sum impropers "
                                "U(chi)"),
                        source("Allen2017"));
  }
  static constexpr std::string_view only_once = "so every bond would count twice; take one of them out";
  ForceClaims claims() const {
    return {.periodic = true, .bonded = true, .charges = false, .exclusions = false, .tangent = TangentPattern::sparse};
  }

  /// @throws Error  if the particles have no bonded terms, or terms of a potential or with parameters unknown to it
  template <class Real> void check(const ParticleSystem<Real>& s) const { terms_of(s.shared_topology(), s.size()); }

  /// @throws Error  as `check`, at the first call for a topology
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const;

  /// Its secants between two states, of doubles and Quad.
  template <class Real>
    requires(std::is_same_v<Real, double> || std::is_same_v<Real, Quad>)
  void add_secant_to(ForceSink<Real>& out, const ParticleSystem<Real>& from, const ParticleSystem<Real>& to) const;

 private:
  const BondedTerms& terms_of(const std::shared_ptr<const Topology>& topology, Index n) const;

  mutable std::shared_ptr<const BondedTerms> terms_;  ///< those of the last topology
};

namespace detail {

/// The largest of the doubles that a number holds.
template <class Real> double greatest(const Real& x) {
  if constexpr (requires { x.lane; }) {
    return *std::max_element(x.lane.begin(), x.lane.end());
  } else if constexpr (requires { x.slope; }) {
    return greatest(x.value);
  } else if constexpr (requires { static_cast<double>(x); }) {
    return static_cast<double>(x);
  } else {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

/// Why a run cannot go on with this bond. @param length  [length]
Failure overstretch(const BondedTerms& terms, Index bond, double length, const std::vector<std::string>& names);

}  // namespace detail

template <class Real> void Bonded::add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
  const BondedTerms& terms = terms_of(s.shared_topology(), s.size());
  thread_local VectorColumn<Real> memory;
  if (memory.size() < terms.slots()) memory = VectorColumn<Real>(terms.slots());
  VectorColumn<Real>& slots = memory;  // this thread's, written by all
  detail::BondedLoop<Real> loop(terms, s, slots, out.wants_energy(), out.wants_virial());
  if (out.wants_energy() || out.wants_virial()) {
    const auto totals =
        reduce(terms.terms(), detail::BondedTotals<Real>{}, [&](Index begin, Index end) { return loop(begin, end); });
    out.energy(totals.energy);
    out.virial(totals.virial);
  } else {
    for_blocks(terms.terms(), [&](Index begin, Index end) { loop(begin, end); });
  }
  std::array<const Real*, 3> of_slots;
  std::array<Real*, 3> accelerations;
  for (int c = 0; c < 3; ++c) {
    of_slots[static_cast<std::size_t>(c)] = slots.component(c);
    accelerations[static_cast<std::size_t>(c)] = out.accelerations().component(c);
  }
  const auto add = [] {
    if constexpr (std::is_same_v<Real, double>)
      return simd_loop<detail::add_slots<double>>();
    else
      return detail::add_slots<Real>;
  }();
  for_blocks(s.size(), [&](Index begin, Index end) {
    add(terms.places(), of_slots, s.masses().data(), begin, end, accelerations);
  });
  if (const Index bond = loop.overstretched(); bond >= 0) {
    const auto [i, j] = terms.topology().bonds[static_cast<std::size_t>(bond)].particles;
    const Vec3<Real> d = s.box().minimum_image(Vec3<Real>(s.positions()[i] - s.positions()[j]));
    out.fail(detail::overstretch(terms, bond, std::sqrt(detail::greatest(norm2(d))), s.names()));
  }
}

extern template void Bonded::add_to(ForceSink<double>&, const ParticleSystem<double>&) const;

namespace detail {  // compiled once, in bonded.cpp

extern template struct ForceModel<Bonded, double>;
extern template struct ForceModel<Bonded, Quad>;

}  // namespace detail

}  // namespace noether
