#include "integrators/methods/step_predictor.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <mutex>

namespace noether {

namespace {

/// Of eight stages; with s of them, fits have the first 3 s / 2 + 1 terms.
constexpr std::size_t fit_nodes = 2 * lane_count, fit_terms = 13;
/// On a ladder of eight rungs orbits of any eccentricity meet fewer pairs of ratios than there are tables.
constexpr int fit_set_bits = 6;
constexpr std::size_t fit_ways = 4;

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
/// @param terms  of the fit, the first ones; nodes beyond those of the fit are 0
template <class Real>
void solve_normal(std::size_t terms, std::array<std::array<Real, fit_terms>, fit_terms>& normal,
                  std::array<std::array<Real, fit_nodes>, fit_terms>& fit) {
  for (std::size_t p = 0; p < terms; ++p) {
    const Real scale = Real(1) / normal[p][p];
    for (Real& x : normal[p]) x *= scale;
    for (Real& x : fit[p]) x *= scale;
    for (std::size_t a = 0; a < terms; ++a) {
      if (a == p) continue;
      const Real factor = normal[a][p];
      for (std::size_t b = p; b < terms; ++b) normal[a][b] -= factor * normal[p][b];
      for (std::size_t r = 0; r < fit_nodes; ++r) fit[a][r] -= factor * fit[p][r];
    }
  }
}

/// @param next, before  lengths of the next step and the one before the last, in units of the last one
template <class Real>
std::array<double, fit_nodes * lane_count> fit_weights(std::size_t stages, const StageLanes<Real>& c,
                                                       const StageMatrix<Real>& twice, const Real& next,
                                                       const Real& before) {
  const std::size_t terms = 3 * stages / 2 + 1;
  // The steps before begin at -1 - before and -1, the next one at 0.
  const Real half = (Real(1) + before) / Real(2);
  const auto basis_at = [&](const Real& t) { return legendre_terms<Real>(t / half + Real(1)); };
  std::array<std::array<Real, fit_terms>, fit_terms> normal{};
  std::array<std::array<Real, fit_nodes>, fit_terms> fit{};
  const auto row_of = [&](std::size_t r) { return r < stages ? r : lane_count + r - stages; };
  for (std::size_t r = 0; r < 2 * stages; ++r) {
    const Real left = Real(1) - c[r % stages];
    const auto basis = basis_at(r < stages ? -left : -(Real(1) + before * left));
    for (std::size_t a = 0; a < terms; ++a) {
      fit[a][row_of(r)] = basis[a];
      for (std::size_t b = 0; b < terms; ++b) normal[a][b] += basis[a] * basis[b];
    }
  }
  solve_normal(terms, normal, fit);
  std::array<std::array<Real, fit_terms>, lane_count> at{};
  for (std::size_t k = 0; k < stages; ++k) at[k] = basis_at(next * c[k]);
  std::array<double, fit_nodes * lane_count> weights{};
  for (std::size_t r = 0; r < fit_nodes; ++r) {
    std::array<Real, lane_count> sum{};
    for (std::size_t k = 0; k < stages; ++k) {
      Real rate(0);
      for (std::size_t a = 0; a < terms; ++a) rate += at[k][a] * fit[a][r];
      for (std::size_t i = 0; i < lane_count; ++i) sum[i] += twice[k][i] * rate;
    }
    for (std::size_t i = 0; i < lane_count; ++i) weights[lane_count * r + i] = static_cast<double>(sum[i]);
  }
  return weights;
}

/// The first of the places that these lengths may have.
std::size_t fit_set(double next, double before) {
  const std::uint64_t mixed = std::bit_cast<std::uint64_t>(next) * 0x9e3779b97f4a7c15U ^
                              std::rotl(std::bit_cast<std::uint64_t>(before) * 0xd6e8feb86659fd93U, 32);
  return fit_ways * static_cast<std::size_t>(mixed * 0x9e3779b97f4a7c15U >> (64 - fit_set_bits));
}

}  // namespace

StepPredictor::StepPredictor(const CollocationTable& table) : stages_(table.stages()) {
  StageLanes<Quad> c{};
  StageMatrix<Quad> twice{};
  const auto rows = table.twice();
  for (std::size_t i = 0; i < lane_count; ++i) {
    const std::size_t stage = i < stages_ ? i : 0;  // lanes beyond the stages repeat the first
    c[i] = table.c[stage];
    c_[i] = static_cast<double>(c[i]);
    for (std::size_t k = 0; k < stages_; ++k) {
      twice[k][i] = rows[stage][k];
      twice_[k][i] = static_cast<double>(rows[stage][k]);
    }
  }
  static std::mutex one_at_a_time;
  static std::map<int, Weights> made;  // once for each table
  const std::lock_guard lock(one_at_a_time);
  auto found = made.find(table.order);
  if (found == made.end())
    found = made.emplace(table.order, fit_weights<Quad>(stages_, c, twice, Quad(1), Quad(1))).first;
  same_ = found->second;
}

bool StepPredictor::serves(double h, double last, double before) {
  const auto near = [&](double length) { return length / last >= least_ratio && length / last <= most_ratio; };
  return last != 0 && near(h) && near(before);
}

void StepPredictor::reserve() { tables_.all.resize(fit_ways << fit_set_bits); }

const double* StepPredictor::weights(double h, double last, double before) {
  if (h == last && before == last) return same_.data();
  reserve();
  const double next_ratio = h / last, before_ratio = before / last;
  Tables::Table* const first = tables_.all.data() + fit_set(next_ratio, before_ratio);
  Tables::Table* const end = first + fit_ways;
  Tables::Table* at = std::find_if(
      first, end, [&](const Tables::Table& one) { return one.next == next_ratio && one.before == before_ratio; });
  if (at == end) {
    at = std::min_element(first, end, [](const Tables::Table& a, const Tables::Table& b) { return a.asked < b.asked; });
    *at = {next_ratio, before_ratio, 0, fit_weights<double>(stages_, c_, twice_, next_ratio, before_ratio)};
  }
  at->asked = ++tables_.now;
  return at->weights.data();
}

}  // namespace noether
