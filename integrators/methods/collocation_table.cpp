#include "integrators/methods/collocation_table.hpp"

#include "numbers/error.hpp"

#include <array>
#include <functional>
#include <utility>

namespace noether {

namespace {

/// The Legendre polynomial of degree n on [-1, 1] and its derivative.
std::pair<Quad, Quad> legendre(int n, Quad x) {
  Quad before = 1, here = x;
  if (n == 0) return {Quad(1), Quad(0)};
  for (int k = 1; k < n; ++k) {
    const Quad next = (Quad(2 * k + 1) * x * here - Quad(k) * before) / Quad(k + 1);
    before = std::exchange(here, next);
  }
  return {here, Quad(n) * (x * here - before) / (x * x - Quad(1))};
}

/// The zero of f between a and b, by bisection to the last bit.
Quad zero(const std::function<Quad(Quad)>& f, Quad a, Quad b) {
  const bool rising = f(a) < Quad(0);
  for (int k = 0; k < 130; ++k) {
    const Quad middle = (a + b) / Quad(2);
    ((f(middle) < Quad(0)) == rising ? a : b) = middle;
  }
  return (a + b) / Quad(2);
}

/// All zeros of f in (-1, 1), found by changes of sign on a fine grid.
std::vector<Quad> zeros(const std::function<Quad(Quad)>& f, int expected) {
  std::vector<Quad> found;
  // Neighbours near the ends are about 3 / n^2 apart.
  const int pieces = 8 * expected * expected + 7;
  for (int k = 0; k < pieces; ++k) {
    // The ends themselves are left out: the function may be none there.
    const Quad a = Quad(-1) + Quad(2 * k + 0.5) / Quad(pieces), b = Quad(-1) + Quad(2 * k + 2.5) / Quad(pieces);
    if (k + 1 < pieces && (f(a) < Quad(0)) != (f(b) < Quad(0))) found.push_back(zero(f, a, b));
  }
  return found;
}

/// The coefficients of the Lagrange polynomial of node j, lowest power first.
std::vector<Quad> lagrange(const std::vector<Quad>& c, std::size_t j) {
  std::vector<Quad> p = {1};
  Quad scale = 1;
  for (std::size_t k = 0; k < c.size(); ++k) {
    if (k == j) continue;
    p.push_back(0);
    for (std::size_t n = p.size(); n-- > 1;) p[n] = p[n - 1] - c[k] * p[n];
    p[0] = -c[k] * p[0];
    scale *= c[j] - c[k];
  }
  for (Quad& x : p) x /= scale;
  return p;
}

Quad integral(const std::vector<Quad>& p, Quad to) {
  Quad sum = 0;
  for (std::size_t n = p.size(); n-- > 0;) sum = sum * to + p[n] / Quad(static_cast<double>(n + 1));
  return sum * to;
}

CollocationTable table_of(std::vector<Quad> nodes, int order) {
  CollocationTable table;
  table.c = std::move(nodes);
  table.order = order;
  const std::size_t s = table.c.size();
  table.a.assign(s, std::vector<Quad>(s));
  for (std::size_t j = 0; j < s; ++j) {
    const std::vector<Quad> p = lagrange(table.c, j);
    table.b.push_back(integral(p, 1));
    for (std::size_t i = 0; i < s; ++i) table.a[i][j] = integral(p, table.c[i]);
  }
  return table;
}

}  // namespace

std::vector<std::vector<Quad>> CollocationTable::twice() const {
  const std::size_t s = stages();
  std::vector<std::vector<Quad>> product(s, std::vector<Quad>(s, Quad(0)));
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < s; ++j) {
      for (std::size_t k = 0; k < s; ++k) product[i][j] += a[i][k] * a[k][j];
    }
  }
  return product;
}

std::vector<Quad> CollocationTable::twice_end() const {
  std::vector<Quad> product(stages(), Quad(0));
  for (std::size_t j = 0; j < stages(); ++j) {
    for (std::size_t k = 0; k < stages(); ++k) product[j] += b[k] * a[k][j];
  }
  return product;
}

std::vector<Quad> CollocationTable::last_coefficient() const {
  const int n = static_cast<int>(stages()) - 1;
  std::vector<Quad> weights;
  for (std::size_t j = 0; j < stages(); ++j) {
    weights.push_back(Quad(2 * n + 1) * b[j] * legendre(n, Quad(2) * c[j] - Quad(1)).first);
  }
  return weights;
}

namespace {

CollocationTable make_gauss(int stages) {
  std::vector<Quad> nodes;
  if (stages == 1) {
    nodes = {Quad(1) / Quad(2)};
  } else {
    for (const Quad& x : zeros([&](Quad at) { return legendre(stages, at).first; }, stages)) {
      nodes.push_back((x + Quad(1)) / Quad(2));
    }
  }
  return table_of(std::move(nodes), 2 * stages);
}

CollocationTable make_lobatto(int stages) {
  // Between the ends the derivative of P_(s-1) vanishes.
  std::vector<Quad> nodes = {0};
  if (stages == 3) nodes.push_back(Quad(1) / Quad(2));
  if (stages > 3) {
    for (const Quad& x : zeros([&](Quad at) { return legendre(stages - 1, at).second; }, stages - 2))
      nodes.push_back((x + Quad(1)) / Quad(2));
  }
  nodes.push_back(1);
  return table_of(std::move(nodes), 2 * stages - 2);
}

CollocationTable make_radau_left(int stages) {
  // P_(s-1) + P_s vanishes at -1; the other zeros are those of the quotient by 1 + x.
  const auto inner = [&](Quad x) {
    return (legendre(stages - 1, x).first + legendre(stages, x).first) / (Quad(1) + x);
  };
  std::vector<Quad> nodes = {0};
  for (const Quad& x : zeros(inner, stages)) nodes.push_back((x + Quad(1)) / Quad(2));
  return table_of(std::move(nodes), 2 * stages - 1);
}

}  // namespace

const CollocationTable& gauss_table(int stages) {
  static const auto all = [] {
    std::array<CollocationTable, 8> tables;
    for (int s = 1; s <= 8; ++s) tables[static_cast<std::size_t>(s - 1)] = make_gauss(s);
    return tables;
  }();
  NOETHER_EXPECTS(stages >= 1 && stages <= 8, "a Gauss method has 1 to 8 stages");
  return all[static_cast<std::size_t>(stages - 1)];
}

const CollocationTable& lobatto_table(int stages) {
  static const auto all = [] {
    std::array<CollocationTable, 8> tables;
    for (int s = 2; s <= 9; ++s) tables[static_cast<std::size_t>(s - 2)] = make_lobatto(s);
    return tables;
  }();
  NOETHER_EXPECTS(stages >= 2 && stages <= 9, "a Lobatto table has 2 to 9 nodes");
  return all[static_cast<std::size_t>(stages - 2)];
}

const CollocationTable& radau_left_table() {
  static const CollocationTable table = make_radau_left(8);
  return table;
}

const CollocationTable* collocation_of(std::string_view name) {
  if (name == "implicit_midpoint") return &gauss_table(1);
  if (name == "gauss_radau_15") return &radau_left_table();
  constexpr std::string_view gauss = "gauss_";
  const bool one_digit = name.starts_with(gauss) && name.size() == gauss.size() + 1;
  return one_digit && name.back() >= '2' && name.back() <= '8' ? &gauss_table(name.back() - '0') : nullptr;
}

}  // namespace noether
