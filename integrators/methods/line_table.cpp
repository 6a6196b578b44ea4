#include "integrators/methods/line_table.hpp"

#include "integrators/methods/dense_factors.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace noether {

namespace {

/// P_0(c), ..., P_count(c) on [0, 1].
template <class Real> std::vector<Real> legendre_on_step(int count, const Real& c) {
  const Real x = Real(2) * c - Real(1);
  std::vector<Real> P = {Real(1), x};
  for (int n = 1; n < count; ++n) {
    const std::size_t last = P.size() - 1;
    P.push_back((Real(2 * n + 1) * x * P[last] - Real(n) * P[last - 1]) / Real(n + 1));
  }
  return P;
}

/// int_0^c P_j, where P are the polynomials at c.
Quad legendre_integral(const std::vector<Quad>& P, std::size_t j) {
  const auto width = static_cast<double>(2 * j + 1);
  return (P[j + 1] - (j == 0 ? Quad(-1) : P[j - 1])) / Quad(2 * width);
}

/// g_i of the integral of P_j: only neighbours have one.
Quad integral_onto(int i, int j) {
  if (i == 0 && j == 0) return Quad(1) / Quad(2);
  if (i == j + 1) return Quad(1) / Quad(2 * (2 * j + 1));
  return i == j - 1 ? Quad(-1) / Quad(2 * (2 * j + 1)) : Quad(0);
}

template <class Real> void split_word(const Quad& x, Real& high, Real& low) {
  high = static_cast<Real>(x);
  low = static_cast<Real>(x - Quad(high));
}

}  // namespace

GaussNodes gauss_nodes(int count) {
  NOETHER_EXPECTS(count >= 1, "a formula of Gauss has one node or more");
  GaussNodes nodes;
  for (int k = 0; k < count; ++k) {
    Quad c = (1 - std::cos(3.14159265358979323846 * (k + 0.75) / (count + 0.5))) / 2, slope = 0;
    for (int round = 0; round < 6; ++round) {
      const std::vector<Quad> P = legendre_on_step(count, c);
      const auto n = static_cast<std::size_t>(count);
      const Quad x = Quad(2) * c - Quad(1);
      slope = Quad(count) * (x * P[n] - P[n - 1]) / (x * x - Quad(1));
      c -= P[n] / slope / Quad(2);
    }
    nodes.c.push_back(c);
    nodes.b.push_back(Quad(1) / (Quad(4) * c * (Quad(1) - c) * slope * slope));
  }
  return nodes;
}

template <class Real>
LineTable<Real>::LineTable(int nodes_, int coefficients_) : nodes(nodes_), coefficients(coefficients_) {
  const GaussNodes gauss = gauss_nodes(nodes);
  const auto S = static_cast<std::size_t>(coefficients), K = static_cast<std::size_t>(nodes);
  std::array<std::array<Quad, lane_count>, lane_count> X{};
  for (std::size_t j = 0; j < S; ++j) {
    for (std::size_t i = 0; i < S; ++i) {
      X[i][j] = integral_onto(static_cast<int>(i), static_cast<int>(j));
      once[j][i] = static_cast<Real>(X[i][j]);
    }
  }
  for (std::size_t j = 0; j < S; ++j) {
    for (std::size_t i = 0; i < S; ++i) {
      Quad sum = 0;
      for (std::size_t m = 0; m < S; ++m) sum += X[i][m] * X[m][j];
      twice[j][i] = static_cast<Real>(sum);
    }
  }
  eights.resize((K + lane_count - 1) / lane_count);
  spectrum.assign(K, std::vector<StageLanes<Real>>(eights.size(), StageLanes<Real>{}));
  for (std::size_t at = 0; at < eights.size() * lane_count; ++at) {
    Eight& eight = eights[at / lane_count];
    const std::size_t lane = at % lane_count, k = at < K ? at : at - lane;
    const std::vector<Quad> P = legendre_on_step(static_cast<int>(std::max<std::size_t>(K, lane_count)), gauss.c[k]);
    split_word(gauss.c[k], eight.c[lane], eight.c_low[lane]);
    for (std::size_t j = 0; j < S; ++j) {
      Quad bend = 0;
      for (std::size_t m = 0; m < S; ++m) bend += X[m][j] * legendre_integral(P, m);
      eight.path[j][lane] = static_cast<Real>(legendre_integral(P, j));
      eight.bend[j][lane] = static_cast<Real>(bend);
    }
    if (at >= K) continue;
    eight.nodes = static_cast<int>(lane) + 1;
    for (std::size_t m = 0; m < K; ++m) {
      const Real weight = static_cast<Real>(Quad(static_cast<double>(2 * m + 1)) * gauss.b[k] * P[m]);
      spectrum[m][at / lane_count][lane] = weight;
      if (m < lane_count) eight.beyond[lane][m] = weight;
      if (m < S) eight.onto[lane][m] = weight;
    }
    if (eights.size() > 1) continue;
    split_word(gauss.b[k], ends[0][lane], ends[1][lane]);
    split_word(S > 1 ? gauss.b[k] * (Quad(1) - gauss.c[k]) : gauss.b[k] / Quad(2), ends[2][lane], ends[3][lane]);
  }
  word_ends[0][0] = word_ends[0][1] = Real(1);
  word_ends[2][0] = word_ends[2][1] = static_cast<Real>(X[0][0]);
  if (S > 1) {
    split_word(X[0][1], word_ends[2][2], word_ends[3][2]);
    word_ends[2][3] = word_ends[2][2];
  }
  Matrix<Quad> all(coefficients, coefficients);
  for (Index i = 0; i < coefficients; ++i) {
    for (Index j = 0; j < coefficients; ++j) all(i, j) = integral_onto(static_cast<int>(i), static_cast<int>(j));
  }
  DenseFactors<Quad> factors;
  factors.resize(coefficients);
  factors.compute(all);
  Vector<Quad> right = Vector<Quad>::Zero(coefficients), in_rest;
  right[0] = Quad(1);
  factors.solve(right, in_rest);
  for (std::size_t j = 0; j < S; ++j) resting[j] = static_cast<Real>(in_rest[static_cast<Index>(j)]);
}

template <class Real> const LineTable<Real>& line_table(int nodes, int coefficients) {
  NOETHER_EXPECTS(1 <= coefficients && coefficients <= lane_count && coefficients <= nodes && nodes <= 64,
                  "a line integral method has 1 to 8 coefficients, and at least as many nodes, 64 at most");
  static std::mutex guard;
  static std::map<std::pair<int, int>, std::unique_ptr<LineTable<Real>>> tables;
  const std::lock_guard lock(guard);
  auto& table = tables[{nodes, coefficients}];
  if (!table) table = std::make_unique<LineTable<Real>>(nodes, coefficients);
  return *table;
}

template <class Real> StageMatrix<Real> legendre_ahead(int count, const Real& ratio) {
  static const GaussNodes gauss = gauss_nodes(lane_count);
  StageMatrix<Real> ahead{};
  for (std::size_t k = 0; k < lane_count; ++k) {
    const Real c = static_cast<Real>(gauss.c[k]), b = static_cast<Real>(gauss.b[k]);
    const std::vector<Real> from = legendre_on_step<Real>(lane_count, Real(1) + c * ratio);
    const std::vector<Real> onto = legendre_on_step<Real>(lane_count, c);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      for (std::size_t j = 0; j <= i; ++j) ahead[i][j] += Real(static_cast<double>(2 * j + 1)) * b * onto[j] * from[i];
    }
  }
  return ahead;
}

template struct LineTable<double>;
template struct LineTable<Quad>;
template const LineTable<double>& line_table(int nodes, int coefficients);
template const LineTable<Quad>& line_table(int nodes, int coefficients);
template StageMatrix<double> legendre_ahead(int count, const double& ratio);
template StageMatrix<Quad> legendre_ahead(int count, const Quad& ratio);

}  // namespace noether
