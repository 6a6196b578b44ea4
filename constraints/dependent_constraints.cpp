#include "constraints/dependent_constraints.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <numeric>
#include <vector>

namespace noether {

namespace {

/// G M^-1 G^T, every element.
template <class Real>
Eigen::MatrixXd coupling(const ConstraintLayout<Real>& layout, const ConstraintGradients<Real>& g) {
  const Index n = layout.equations();
  const auto first = [&](Index e) { return static_cast<std::size_t>(layout.first[static_cast<std::size_t>(e)]); };
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (Index e = 0; e < n; ++e) {
    for (Index f = 0; f < n; ++f) {
      for (std::size_t a = first(e); a < first(e + 1); ++a) {
        for (std::size_t b = first(f); b < first(f + 1); ++b) {
          if (layout.particle[a] != layout.particle[b]) continue;
          matrix(e, f) += static_cast<double>(layout.inverse_mass[a] * dot(g[a], g[b]));
        }
      }
    }
  }
  return matrix;
}

/// Constraints with a share in a mode, the largest first; but one of each kind before all others: of a chain between
/// two fixed ends the many links say less than the ends.
template <class Real>
std::vector<std::string> most_involved(const ConstraintSet& set, const ParticleSystem<Real>& s,
                                       const Eigen::VectorXd& share) {
  std::vector<Index> order(static_cast<std::size_t>(share.size()));
  std::iota(order.begin(), order.end(), Index(0));
  std::stable_sort(order.begin(), order.end(), [&](Index e, Index f) { return share[e] > share[f] + 1e-9; });
  std::vector<std::string> named, kinds, others;
  const auto has = [](const std::vector<std::string>& list, const std::string& text) {
    return std::find(list.begin(), list.end(), text) != list.end();
  };
  for (const Index e : order) {
    const std::string words = set.words(e, s), kind = set.place(e).group->name();
    if (share[e] < 0.01 * share.maxCoeff()) break;
    if (has(named, words) || has(others, words)) continue;
    (has(kinds, kind) ? others : named).push_back(words);
    kinds.push_back(kind);
  }
  named.insert(named.end(), others.begin(), others.end());
  return named;
}

}  // namespace

template <class Real>
std::string dependent_words(const ConstraintSet& set, const ParticleSystem<Real>& s,
                            const ConstraintLayout<Real>& layout, const ConstraintGradients<Real>& g, Index equation) {
  constexpr Index most = 600;  // equations; of more the one that was found
  constexpr std::size_t most_named = 4;
  std::vector<std::string> named = {set.words(equation, s)};
  if (layout.equations() <= most) {
    const Eigen::MatrixXd matrix = coupling(layout, g);
    for (Index e = 0; e < matrix.rows(); ++e) {
      if (matrix(e, e) > 0) continue;
      return set.words(e, s) +
             " cannot act there, because its gradient vanishes; use rigid_bar for particles on a line";
    }
    const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(scale.asDiagonal() * matrix * scale.asDiagonal());
    named = most_involved(set, s, modes.eigenvectors().col(0).cwiseAbs());
  }
  const std::size_t left_out = named.size() > most_named ? named.size() - most_named : 0;
  named.resize(named.size() - left_out);
  return fmt::format("constraints depend on each other: {}{}; take one out", fmt::join(named, ", "),
                     left_out > 0 ? fmt::format(" and {} more", left_out) : "");
}

template std::string dependent_words(const ConstraintSet&, const ParticleSystem<double>&,
                                     const ConstraintLayout<double>&, const ConstraintGradients<double>&, Index);
template std::string dependent_words(const ConstraintSet&, const ParticleSystem<Quad>&, const ConstraintLayout<Quad>&,
                                     const ConstraintGradients<Quad>&, Index);

}  // namespace noether
