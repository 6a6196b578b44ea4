#pragma once
/// Legendre's polynomials over a step, at Gauss's nodes: what line integral methods are made of.

#include "integrators/methods/stage_arithmetic.hpp"

#include <array>
#include <vector>

namespace noether {

/// Gauss's nodes c and weights b in [0, 1], which integrate polynomials up to degree 2 K - 1.
struct GaussNodes {
  std::vector<Quad> c, b;
};
GaussNodes gauss_nodes(int count);

/// The path y(t + c h) = y + h sum_j int_0^c P_j g_j, of S coefficients g_j of the rates in Legendre's polynomials P_j
/// on [0, 1], P_j(1) = 1, and the coefficients of rates known at K nodes, g_j = (2 j + 1) sum_k b_k P_j(c_k) F_k.
///
/// Nodes stand side by side in eights; lanes beyond the last node repeat the first of their eight, and nothing is taken
/// from them. Each list that ends a step comes with what rounding has taken from it, as in `StageTable`.
template <class Real> struct LineTable {
  struct Eight {
    int nodes = 0;
    StageLanes<Real> c{}, c_low{};
    StageMatrix<Real> path{}, bend{};  ///< [j][k]: what node k takes from g_j, once h; of accelerations, h^2
    StageMatrix<Real> onto{};          ///< [k][j]: what g_j takes from node k, j < S
    StageMatrix<Real> beyond{};        ///< the same for all j < 8 that K nodes know
  };

  int nodes = 0, coefficients = 0;
  std::vector<Eight> eights;
  std::vector<std::vector<StageLanes<Real>>> spectrum;  ///< [m][eight]: weights of coefficient m, m < K
  StageMatrix<Real> once{}, twice{};                    ///< X, [j][i]: g_i of the integral of P_j, i and j < S; X X
  StageLanes<Real> resting{};                           ///< x of X x = (1, 0, ...)
  std::array<StageLanes<Real>, 4> ends{};       ///< of eight nodes: b, and what positions take, each with its low words
  std::array<StageLanes<Real>, 4> word_ends{};  ///< the same of g_0 and g_1, two words of each

  LineTable(int nodes_, int coefficients_);
};

/// The table of K nodes and S coefficients, made when it is first asked for; 1 <= S <= 8, S <= K <= 64.
template <class Real> const LineTable<Real>& line_table(int nodes, int coefficients);

/// [i][j]: coefficient j on the next step of P_i, continued over it; `ratio` of the next length to this one. Of all i
/// below `count`.
template <class Real> StageMatrix<Real> legendre_ahead(int count, const Real& ratio);

extern template struct LineTable<double>;
extern template struct LineTable<Quad>;
extern template const LineTable<double>& line_table(int nodes, int coefficients);
extern template const LineTable<Quad>& line_table(int nodes, int coefficients);
extern template StageMatrix<double> legendre_ahead(int count, const double& ratio);
extern template StageMatrix<Quad> legendre_ahead(int count, const Quad& ratio);

}  // namespace noether
