#include "integrators/methods/step_predictor.hpp"

#include <array>
#include <bit>
#include <cstdint>

namespace noether {

namespace {

constexpr std::size_t fit_stages = lane_count, fit_nodes = 2 * fit_stages, fit_terms = 13;
/// Orbits of any eccentricity meet fewer pairs of ratios than this on a ladder of eight rungs.
constexpr int fit_table_bits = 7;

/// Legendre polynomials of degrees below `fit_terms` at x.
template <class Real> std::array<Real, fit_terms> legendre_terms(const Real& x) {
  std::array<Real, fit_terms> p{};
  p[0] = Real(1);
  p[1] = x;
  for (std::size_t k = 1; k + 1 < fit_terms; ++k) {
    const Real n(static_cast<double>(k));
    p[k + 1] = ((Real(2) * n + Real(1)) * x * p[k] - n * p[k - 1]) / (n + Real(1));
  }
  return p;
}

/// Solves normal equations for all nodes by the elimination of Gauss and Jordan: the matrix is positive definite.
template <class Real>
void solve_normal(std::array<std::array<Real, fit_terms>, fit_terms>& normal,
                  std::array<std::array<Real, fit_nodes>, fit_terms>& fit) {
  for (std::size_t p = 0; p < fit_terms; ++p) {
    const Real scale = Real(1) / normal[p][p];
    for (Real& x : normal[p]) x *= scale;
    for (Real& x : fit[p]) x *= scale;
    for (std::size_t a = 0; a < fit_terms; ++a) {
      if (a == p) continue;
      const Real factor = normal[a][p];
      for (std::size_t b = p; b < fit_terms; ++b) normal[a][b] -= factor * normal[p][b];
      for (std::size_t r = 0; r < fit_nodes; ++r) fit[a][r] -= factor * fit[p][r];
    }
  }
}

/// @param next, before  lengths of the next step and the one before the last, in units of the last one
template <class Real>
std::array<double, fit_nodes * fit_stages> fit_weights(const StageLanes<Real>& c, const StageMatrix<Real>& twice,
                                                       const Real& next, const Real& before) {
  // The steps before begin at -1 - before and -1, the next one at 0.
  const Real half = (Real(1) + before) / Real(2);
  const auto basis_at = [&](const Real& t) { return legendre_terms<Real>(t / half + Real(1)); };
  std::array<std::array<Real, fit_terms>, fit_terms> normal{};
  std::array<std::array<Real, fit_nodes>, fit_terms> fit{};
  for (std::size_t r = 0; r < fit_nodes; ++r) {
    const Real left = Real(1) - c[r % fit_stages];
    const auto basis = basis_at(r < fit_stages ? -left : -(Real(1) + before * left));
    for (std::size_t a = 0; a < fit_terms; ++a) {
      fit[a][r] = basis[a];
      for (std::size_t b = 0; b < fit_terms; ++b) normal[a][b] += basis[a] * basis[b];
    }
  }
  solve_normal(normal, fit);
  std::array<std::array<Real, fit_terms>, fit_stages> at;
  for (std::size_t k = 0; k < fit_stages; ++k) at[k] = basis_at(next * c[k]);
  std::array<double, fit_nodes * fit_stages> weights{};
  for (std::size_t r = 0; r < fit_nodes; ++r) {
    std::array<Real, fit_stages> sum{};
    for (std::size_t k = 0; k < fit_stages; ++k) {
      Real rate(0);
      for (std::size_t a = 0; a < fit_terms; ++a) rate += at[k][a] * fit[a][r];
      for (std::size_t i = 0; i < fit_stages; ++i) sum[i] += twice[k][i] * rate;
    }
    for (std::size_t i = 0; i < fit_stages; ++i) weights[fit_stages * r + i] = static_cast<double>(sum[i]);
  }
  return weights;
}

std::size_t fit_place(double next, double before) {
  const std::uint64_t mixed = std::bit_cast<std::uint64_t>(next) * 0x9e3779b97f4a7c15U ^
                              std::rotl(std::bit_cast<std::uint64_t>(before) * 0xd6e8feb86659fd93U, 32);
  return static_cast<std::size_t>(mixed * 0x9e3779b97f4a7c15U >> (64 - fit_table_bits));
}

}  // namespace

StepPredictor::StepPredictor(const CollocationTable& table) {
  StageLanes<Quad> c{};
  StageMatrix<Quad> twice{};
  const auto rows = table.twice();
  for (std::size_t i = 0; i < fit_stages; ++i) {
    c[i] = table.c[i];
    c_[i] = static_cast<double>(c[i]);
    for (std::size_t k = 0; k < fit_stages; ++k) {
      twice[k][i] = rows[i][k];
      twice_[k][i] = static_cast<double>(rows[i][k]);
    }
  }
  static const Weights same = fit_weights<Quad>(c, twice, Quad(1), Quad(1));
  same_ = same;
}

bool StepPredictor::serves(double h, double last, double before) {
  const auto near = [&](double length) { return length / last >= least_ratio && length / last <= most_ratio; };
  return last != 0 && near(h) && near(before);
}

void StepPredictor::reserve() { tables_.all.resize(std::size_t{1} << fit_table_bits); }

const double* StepPredictor::weights(double h, double last, double before) {
  if (h == last && before == last) return same_.data();
  reserve();
  const double next_ratio = h / last, before_ratio = before / last;
  Tables::Table& table = tables_.all[fit_place(next_ratio, before_ratio)];
  if (table.next != next_ratio || table.before != before_ratio)
    table = {next_ratio, before_ratio, fit_weights<double>(c_, twice_, next_ratio, before_ratio)};
  return table.weights.data();
}

}  // namespace noether
