#include "integrators/methods/difference_formulas.hpp"

namespace noether {

namespace differences {

namespace {

using Series = std::vector<Quad>;

/// -ln(1 - x) / x up to x^(n-1).
Series logarithm(std::size_t n) {
  Series c;
  for (std::size_t j = 0; j < n; ++j) c.push_back(Quad(1) / Quad(j + 1));
  return c;
}

/// a / b.
Series quotient(Series a, const Series& b) {
  for (std::size_t j = 0; j < a.size(); ++j) {
    for (std::size_t i = 1; i <= j; ++i) a[j] -= b[i] * a[j - i];
    a[j] /= b[0];
  }
  return a;
}

/// a / (1 - x).
Series summed(Series a) {
  for (std::size_t j = 1; j < a.size(); ++j) a[j] += a[j - 1];
  return a;
}

Series one(std::size_t n) {
  Series c(n, Quad(0));
  if (n > 0) c[0] = 1;
  return c;
}

}  // namespace

std::vector<Quad> adams_moulton(int n) {
  const auto size = static_cast<std::size_t>(n);
  return quotient(one(size), logarithm(size));
}
std::vector<Quad> adams_bashforth(int n) { return summed(adams_moulton(n)); }
std::vector<Quad> cowell(int n) { return quotient(adams_moulton(n), logarithm(static_cast<std::size_t>(n))); }
std::vector<Quad> stoermer(int n) { return summed(cowell(n)); }

}  // namespace differences

std::vector<Quad> ordinates(const std::vector<Quad>& c) {
  std::vector<Quad> weights(c.size(), Quad(0));
  std::vector<Quad> binomial;  // of the difference D^j, signs included
  for (std::size_t j = 0; j < c.size(); ++j) {
    binomial.push_back(j == 0 ? 1 : 0);
    for (std::size_t i = j; i > 0; --i) binomial[i] -= binomial[i - 1];  // D^j = D^(j-1) (1 - E^-1)
    for (std::size_t i = 0; i <= j; ++i) weights[i] += c[j] * binomial[i];
  }
  return weights;
}

}  // namespace noether
