#include "study/multistep_roots.hpp"

#include "integrators/eigenvalues.hpp"
#include "integrators/methods/stormer_cowell.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

namespace {

using Complex = std::complex<double>;
using Polynomial = std::vector<Complex>;  // c_0 x^n + ... + c_n

/// Eigenvalues of the companion matrix, written in real numbers: those of the polynomial and of its conjugate.
std::vector<Complex> roots_of(const Polynomial& c) {
  const Index n = static_cast<Index>(c.size()) - 1;
  Matrix<double> companion = Matrix<double>::Zero(2 * n, 2 * n);
  for (Index j = 0; j < n; ++j) {
    const Complex first = -c[static_cast<std::size_t>(j) + 1] / c[0];
    companion(0, j) = companion(n, n + j) = first.real();
    companion(n, j) = first.imag();
    companion(0, n + j) = -first.imag();
  }
  for (Index j = 1; j < n; ++j) companion(j, j - 1) = companion(n + j, n + j - 1) = 1;
  const auto roots = eigenvalues_of(companion);
  return roots ? *roots : std::vector<Complex>();
}

/// y_1 = y_0 + mu (sum of weights and rates), explicit, implicit, or the second with the first's rate as the new one.
Polynomial adams(AdamsKind kind, const std::vector<double>& ahead, const std::vector<double>& corrected, Complex mu) {
  Polynomial c(std::max<std::size_t>(ahead.size() + 1, corrected.size()), Complex(0));
  c[0] += 1;
  c[1] -= 1;
  if (kind == AdamsKind::bashforth) {
    for (std::size_t j = 0; j < ahead.size(); ++j) c[j + 1] -= mu * ahead[j];
    return c;
  }
  for (std::size_t j = 1; j < corrected.size(); ++j) c[j] -= mu * corrected[j];
  if (kind == AdamsKind::moulton) {
    c[0] -= mu * corrected[0];
    return c;
  }
  c[1] -= mu * corrected[0];
  for (std::size_t j = 0; j < ahead.size(); ++j) c[j + 1] -= mu * mu * corrected[0] * ahead[j];
  return c;
}

/// sum_(j = 1..k) (1 - 1/x)^j / j = mu.
Polynomial backward_differences(int order, Complex mu) {
  Polynomial c(static_cast<std::size_t>(order) + 1, Complex(0));
  std::vector<double> power = {1};  // (1 - 1/x)^j
  for (int j = 1; j <= order; ++j) {
    power.push_back(0);
    for (std::size_t i = power.size() - 1; i > 0; --i) power[i] -= power[i - 1];
    for (std::size_t i = 0; i < power.size(); ++i) c[i] += power[i] / j;
  }
  c[0] -= mu;
  return c;
}

/// (1 - 1/x)^2 [x q_n - sum g_i A_(n-i)] = A_n with A = mu^2 q.
Polynomial stoermer(const std::vector<double>& weights, Complex mu) {
  Polynomial q = {1.0};
  for (const double g : weights) q.push_back(-mu * mu * g);
  Polynomial c(q.size() + 2, Complex(0));
  for (std::size_t i = 0; i < q.size(); ++i) {
    c[i] += q[i];
    c[i + 1] -= 2.0 * q[i];
    c[i + 2] += q[i];
  }
  c[1] -= mu * mu;
  return c;
}

std::vector<Complex> directions_of(const Mode& mode) {
  if (mode.lambda) return {*mode.lambda / mode.scale()};
  if (mode.rate == 0) return {Complex(0, 1)};
  const double g = mode.rate / mode.omega / 2;
  const Complex root = std::sqrt(Complex(g * g - 1, 0));
  return {-g + root, -g - root};
}

MultistepRoots with_polynomial(const Mode& mode, std::function<Polynomial(Complex mu)> of) {
  MultistepRoots found{.exact = directions_of(mode), .roots = {}, .solver = {}};
  found.roots = [of = std::move(of), exact = found.exact](std::size_t k, double z) {
    return roots_of(of(exact[k] * z));
  };
  return found;
}

}  // namespace

double MultistepRoots::growth(double z) const {
  double largest = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    for (const Complex& root : roots(k, z)) largest = std::max(largest, std::abs(root));
  }
  return largest - 1;
}

double MultistepRoots::error(double z) const {
  double worst = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    double least = std::numeric_limits<double>::infinity();
    for (const Complex& root : roots(k, z)) {
      least = std::min(least, std::abs(std::log(root) / (exact[k] * z) - 1.0));
    }
    worst = std::max(worst, least);
  }
  return worst;
}

MultistepRoots adams_roots(AdamsKind kind, int order, const Mode& mode) {
  const Adams<double> method("adams", kind, order);
  const auto &ahead = method.explicit_weights(), &corrected = method.implicit_weights();
  MultistepRoots found = with_polynomial(mode, [=](Complex mu) { return adams(kind, ahead, corrected, mu); });
  if (kind == AdamsKind::moulton) {
    found.solver = std::pow(std::numeric_limits<double>::epsilon(), 1.0 / adams_iterations) / corrected[0];
  }
  return found;
}

MultistepRoots stoermer_roots(int order) {
  const StormerCowell<double> method("stormer", order);
  return with_polynomial({.omega = 1, .rate = 0, .lambda = {}},
                         [g = method.position_weights()](Complex mu) { return stoermer(g, mu); });
}

std::optional<MultistepRoots> multistep_roots(const Scene& scene, const Candidate& who, const Mode& mode) {
  if (!scene.integrator.decorators.empty()) return {};
  const Scene made = variant(scene, who, {.step = 1, .tolerance = 0});
  if (!made.integrator.classical || !(mode.scale() > 0)) return {};
  const std::string_view name = made.integrator.classical->info->name;
  const int order = made.integrator.classical->info->order;
  if (name.starts_with("adams_bashforth_")) return adams_roots(AdamsKind::bashforth, order, mode);
  if (name.starts_with("adams_moulton_")) return adams_roots(AdamsKind::moulton, order, mode);
  if (name == "adams_pece") return adams_roots(AdamsKind::pece, 4, mode);  // as with steps of one length
  if (name.starts_with("bdf_")) {
    return with_polynomial(mode, [=](Complex mu) { return backward_differences(order, mu); });
  }
  if (name.starts_with("stormer_cowell_") && !mode.lambda && mode.rate == 0) return stoermer_roots(order);
  return {};
}

}  // namespace noether
