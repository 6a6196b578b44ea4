#include "integrators/variational/galerkin_table.hpp"

#include "integrators/methods/collocation_table.hpp"

#include <cstddef>
#include <utility>

namespace noether {

std::vector<Quad> lagrange_values(const std::vector<Quad>& d, Quad x) {
  std::vector<Quad> all;
  for (std::size_t k = 0; k < d.size(); ++k) {
    Quad product = 1;
    for (std::size_t j = 0; j < d.size(); ++j) {
      if (j != k) product *= (x - d[j]) / (d[k] - d[j]);
    }
    all.push_back(product);
  }
  return all;
}

namespace {

/// l_k'(x), all k: each factor is left out in turn.
std::vector<Quad> lagrange_slopes(const std::vector<Quad>& d, Quad x) {
  std::vector<Quad> all;
  for (std::size_t k = 0; k < d.size(); ++k) {
    Quad sum = 0;
    for (std::size_t out = 0; out < d.size(); ++out) {
      if (out == k) continue;
      Quad product = Quad(1) / (d[k] - d[out]);
      for (std::size_t j = 0; j < d.size(); ++j) {
        if (j != k && j != out) product *= (x - d[j]) / (d[k] - d[j]);
      }
      sum += product;
    }
    all.push_back(sum);
  }
  return all;
}

/// The inverse of a small matrix, by elimination with pivots by rows.
std::vector<std::vector<Quad>> inverse_of(std::vector<std::vector<Quad>> a) {
  const std::size_t n = a.size();
  std::vector<std::vector<Quad>> x(n, std::vector<Quad>(n, Quad(0)));
  for (std::size_t i = 0; i < n; ++i) x[i][i] = 1;
  for (std::size_t p = 0; p < n; ++p) {
    std::size_t best = p;
    for (std::size_t i = p; i < n; ++i) {
      if (abs(a[i][p]) > abs(a[best][p])) best = i;
    }
    std::swap(a[p], a[best]);
    std::swap(x[p], x[best]);
    const Quad pivot = a[p][p];
    for (std::size_t j = 0; j < n; ++j) {
      a[p][j] /= pivot;
      x[p][j] /= pivot;
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (i == p) continue;
      const Quad factor = a[i][p];
      for (std::size_t j = 0; j < n; ++j) {
        a[i][j] -= factor * a[p][j];
        x[i][j] -= factor * x[p][j];
      }
    }
  }
  return x;
}

GalerkinTable table_of_paths(const CollocationTable& points, const CollocationTable& quadrature) {
  GalerkinTable table;
  table.points = points.c;
  table.c = quadrature.c;
  table.b = quadrature.b;
  table.order = quadrature.order;
  for (const Quad& c : table.c) {
    table.value.push_back(lagrange_values(table.points, c));
    table.slope.push_back(lagrange_slopes(table.points, c));
  }
  const std::size_t s = table.points.size() - 1;
  std::vector<std::vector<Quad>> kinetic(s, std::vector<Quad>(s, Quad(0)));
  for (std::size_t i = 0; i < table.c.size(); ++i) {
    for (std::size_t j = 0; j < s; ++j) {
      for (std::size_t k = 0; k < s; ++k) kinetic[j][k] += table.b[i] * table.slope[i][j] * table.slope[i][k + 1];
    }
  }
  table.inverse = inverse_of(std::move(kinetic));
  return table;
}

}  // namespace

GalerkinTable galerkin_gauss_table(int nodes) { return table_of_paths(lobatto_table(nodes + 1), gauss_table(nodes)); }
GalerkinTable galerkin_lobatto_table(int nodes) { return table_of_paths(lobatto_table(nodes), lobatto_table(nodes)); }

}  // namespace noether
