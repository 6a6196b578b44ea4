#include "study/frequencies.hpp"

#include "numbers/error.hpp"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#define POCKETFFT_NO_MULTITHREADING
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#include <third_party/pocketfft/pocketfft_hdronly.h>
#pragma GCC diagnostic pop

namespace noether {

namespace {

using Complex = std::complex<double>;

constexpr std::size_t fewest_values = 16;
constexpr double full_circle = 2 * std::numbers::pi;

/// A signal under its window, in time from its middle on in units of half its length, -1 to 1.
class Windowed {
 public:
  Windowed(std::vector<Complex> values, int power) : left_(std::move(values)), window_(left_.size()) {
    double norm = 1;
    for (int k = 1; k <= power; ++k) norm *= 2.0 * k * k / ((2.0 * k) * (2.0 * k - 1.0));
    for (std::size_t i = 0; i < size(); ++i) {
      const bool end = i == 0 || i + 1 == size();  // of the trapezoidal rule, exact here for smooth signals
      window_[i] = (end ? 0.5 : 1.0) * norm * std::pow(1 + std::cos(std::numbers::pi * time(i)), power) /
                   static_cast<double>(size() - 1);
    }
  }

  std::size_t size() const { return left_.size(); }
  double time(std::size_t i) const { return 2 * static_cast<double>(i) / static_cast<double>(size() - 1) - 1; }
  /// Resolution: frequencies nearer than this cannot be told apart.
  static constexpr double resolution = std::numbers::pi;

  /// <z, e^(i nu t)> of what is left, and its derivative by nu.
  std::pair<Complex, Complex> product(double frequency) const {
    Complex sum(0, 0), slope(0, 0);
    for (std::size_t i = 0; i < size(); ++i) {
      const double t = time(i);
      const Complex part = left_[i] * window_[i] * std::polar(1.0, -frequency * t);
      sum += part;
      slope += Complex(0, -t) * part;
    }
    return {sum, slope};
  }
  /// <e^(i a t), e^(i b t)>.
  double overlap(double a, double b) const {
    double sum = 0;
    for (std::size_t i = 0; i < size(); ++i) sum += window_[i] * std::cos((a - b) * time(i));
    return sum;
  }
  /// What is left where each of these terms is taken out of the signal.
  void take_out(const std::vector<Complex>& values, const std::vector<double>& frequencies,
                const Eigen::VectorXcd& amplitudes, std::size_t except) {
    left_ = values;
    for (std::size_t k = 0; k < frequencies.size(); ++k) {
      if (k == except) continue;
      for (std::size_t i = 0; i < size(); ++i)
        left_[i] -= amplitudes[static_cast<Eigen::Index>(k)] * std::polar(1.0, frequencies[k] * time(i));
    }
  }
  /// The frequency of the largest number of the Fourier transform of what is left, padded to twice its length.
  double coarse_peak() const {
    const std::size_t n = 2 * size();
    std::vector<Complex> padded(n, Complex(0, 0)), waves(n);
    for (std::size_t i = 0; i < size(); ++i) padded[i] = left_[i] * window_[i];
    const auto one = static_cast<std::ptrdiff_t>(sizeof(Complex));
    pocketfft::c2c({n}, {one}, {one}, {0}, true, padded.data(), waves.data(), 1.0, 1);
    const auto peak = std::max_element(waves.begin(), waves.end(),
                                       [](const Complex& a, const Complex& b) { return std::norm(a) < std::norm(b); });
    auto k = static_cast<double>(peak - waves.begin());
    if (k > static_cast<double>(n) / 2) k -= static_cast<double>(n);
    return k * full_circle / static_cast<double>(n) * static_cast<double>(size() - 1) / 2;
  }
  /// Where |phi| is largest near `guess`: its derivative changes sign there.
  double peak_near(double guess) const {
    const auto rise = [&](double nu) {
      const auto [value, slope] = product(nu);
      return std::real(std::conj(value) * slope);
    };
    double low = guess - resolution / 2, high = guess + resolution / 2, at_low = rise(low), at_high = rise(high);
    if (!(at_low > 0 && at_high < 0)) return guess;
    // Regula falsi in Illinois' way, to rounding.
    for (int round = 0, side = 0; round < 100; ++round) {
      const double nu = (low * at_high - high * at_low) / (at_high - at_low), at = rise(nu);
      if (at == 0 || nu == low || nu == high) return nu;
      if (at > 0) {
        low = nu, at_low = at;
        if (side == 1) at_high /= 2;
        side = 1;
      } else {
        high = nu, at_high = at;
        if (side == -1) at_low /= 2;
        side = -1;
      }
      if (high - low < 4e-16 * (std::abs(low) + 1)) break;
    }
    return (low + high) / 2;
  }

 private:
  std::vector<Complex> left_;
  std::vector<double> window_;
};

/// Amplitudes of all terms together, by least squares under the window.
Eigen::VectorXcd amplitudes_of(const Windowed& signal, const std::vector<double>& frequencies) {
  const auto n = static_cast<Eigen::Index>(frequencies.size());
  Eigen::MatrixXcd products(n, n);
  Eigen::VectorXcd right(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    right[j] = signal.product(frequencies[static_cast<std::size_t>(j)]).first;
    for (Eigen::Index k = 0; k < n; ++k)
      products(j, k) =
          signal.overlap(frequencies[static_cast<std::size_t>(k)], frequencies[static_cast<std::size_t>(j)]);
  }
  return products.partialPivLu().solve(right);
}

}  // namespace

std::vector<FrequencyTerm> frequency_terms(const std::vector<Complex>& values, double start, double dt,
                                           const FrequencyOptions& options) {
  if (values.size() < fewest_values) {
    throw Error(fmt::format("a signal of {} samples is too short for a frequency analysis; {} or more are expected",
                            values.size(), fewest_values));
  }
  for (const Complex& z : values) {
    if (!std::isfinite(z.real()) || !std::isfinite(z.imag()))
      throw Error("a sample of the signal is not finite, as of an orbit that is not bound");
  }
  const Windowed whole(values, options.window);
  Windowed left = whole;
  std::vector<double> frequencies;
  Eigen::VectorXcd amplitudes;
  while (frequencies.size() < options.terms) {
    const double found = left.peak_near(left.coarse_peak());
    const auto is_near = [&](double known) { return std::abs(known - found) < Windowed::resolution; };
    if (std::any_of(frequencies.begin(), frequencies.end(), is_near)) break;
    if (std::abs(left.product(found).first) == 0) break;
    frequencies.push_back(found);
    amplitudes = amplitudes_of(whole, frequencies);
    left.take_out(values, frequencies, amplitudes, frequencies.size());
  }
  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    for (std::size_t k = 0; k < frequencies.size(); ++k) {
      left.take_out(values, frequencies, amplitudes, k);
      frequencies[k] = left.peak_near(frequencies[k]);
    }
    if (!frequencies.empty()) amplitudes = amplitudes_of(whole, frequencies);
  }
  const double half = dt * static_cast<double>(values.size() - 1) / 2, middle = start + half;
  std::vector<FrequencyTerm> terms;
  for (std::size_t k = 0; k < frequencies.size(); ++k) {
    const Complex amplitude = amplitudes[static_cast<Eigen::Index>(k)];
    const double nu = frequencies[k] / half;
    terms.push_back({nu, std::abs(amplitude), std::remainder(std::arg(amplitude) - nu * middle, full_circle)});
  }
  std::stable_sort(terms.begin(), terms.end(),
                   [](const FrequencyTerm& a, const FrequencyTerm& b) { return a.amplitude > b.amplitude; });
  return terms;
}

double FrequencyChange::diffusion() const { return std::log10(std::abs(1 - second.frequency / first.frequency)); }

std::vector<FrequencyChange> frequency_changes(const std::vector<Complex>& values, double start, double dt,
                                               const FrequencyOptions& options) {
  const std::size_t half = values.size() / 2;
  const std::vector<Complex> early(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half));
  const std::vector<Complex> late(values.end() - static_cast<std::ptrdiff_t>(half), values.end());
  const double begin_of_late = start + dt * static_cast<double>(values.size() - half);
  const std::vector<FrequencyTerm> first = frequency_terms(early, start, dt, options);
  const std::vector<FrequencyTerm> second = frequency_terms(late, begin_of_late, dt, options);
  const double resolution = full_circle / (std::abs(dt) * static_cast<double>(half - 1));
  std::vector<FrequencyChange> changes;
  for (const FrequencyTerm& one : first) {
    const auto distance = [&](const FrequencyTerm& other) { return std::abs(other.frequency - one.frequency); };
    const auto nearest =
        std::min_element(second.begin(), second.end(),
                         [&](const FrequencyTerm& a, const FrequencyTerm& b) { return distance(a) < distance(b); });
    if (nearest != second.end() && distance(*nearest) < resolution) changes.push_back({one, *nearest});
  }
  return changes;
}

}  // namespace noether
