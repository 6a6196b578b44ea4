#pragma once
/// Frequency analysis: the quasi-periodic terms of a signal, and how they change.

#include <complex>
#include <cstddef>
#include <vector>

namespace noether {

/// A term A e^(i (nu t + phi)) of a signal.
struct FrequencyTerm {
  double frequency = 0;  ///< nu [rad/time]
  double amplitude = 0;  ///< A > 0
  double phase = 0;      ///< phi at time 0, from -pi to pi [rad]
};

struct FrequencyOptions {
  std::size_t terms = 10;  ///< how many are looked for
  int window = 1;          ///< power p of Hann's window (1 + cos)^p
  int sweeps = 2;          ///< how often each term is refined with all others taken out
};

/// Finds the largest terms of a signal, one after the other:
///
///     phi(nu) = <z, e^(i nu t)> is largest at nu,   <f, g> = 1/2T int_-T^T f g* chi_p(t/T) dt,
///     chi_p(u) = 2^p (p!)^2/(2p)! (1 + cos pi u)^p
///
/// The first frequency of each is that of the largest number in a Fourier transform; then |phi| is made largest to
/// rounding. Amplitudes of all terms are found together, so that terms need not be orthogonal. Of a sum of well
/// separated terms a frequency found alone is off by T^-(2p+2); where the others are taken out, which `sweeps` does, by
/// far less. Terms nearer to each other than 1/T cannot be told apart, and the search ends at such a pair.
/// @param values  at equal distances dt, the first at time `start`; at least 16 of them
/// @return from the largest on
/// @throws Error  for fewer values, or ones that are not finite
/// @cost a fast Fourier transform and about 60 sums over all values a term and sweep
/// @source Laskar1993
std::vector<FrequencyTerm> frequency_terms(const std::vector<std::complex<double>>& values, double start, double dt,
                                           const FrequencyOptions& options = {});

/// A term in both halves of a signal.
struct FrequencyChange {
  FrequencyTerm first, second;
  /// log10 of |1 - nu_2/nu_1|: how fast a frequency diffuses, over half the signal.
  double diffusion() const;
};

/// The largest terms of the first half, each beside the nearest of the second half by frequency, if it is nearer than a
/// resolution of 2 pi over the length of a half.
/// @throws Error  as `frequency_terms`
std::vector<FrequencyChange> frequency_changes(const std::vector<std::complex<double>>& values, double start, double dt,
                                               const FrequencyOptions& options = {});

}  // namespace noether
