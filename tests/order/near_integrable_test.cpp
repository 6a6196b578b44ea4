#include "integrators/all_schemes.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/order_fit.hpp"
#include "tests/support/problems.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace noether {
namespace {

using namespace noether::test;

constexpr double half_turn = 3;      // of the inner planet
constexpr double mass_ratio = 1e-7;  // epsilon: masses of two planets are 1, 2, 3 times this

/// Positions of the planets after half a turn, shape (6).
std::vector<Quad> outcome(const Scheme& scheme, double mass, long n, Coordinates coordinates,
                          const CompositionOptions& options = {}) {
  const auto hamiltonian = wisdom_holman<Quad>({.coordinates = coordinates});
  const auto end =
      run(hamiltonian, scheme, planets(mass, 2).as<Quad>(), half_turn / static_cast<double>(n), n, options);
  std::vector<Quad> x;
  for (Index i = 1; i < end.size(); ++i) {
    for (int k = 0; k < 3; ++k) x.push_back(end.positions()[i][k]);
  }
  return x;
}

/// Sizes of e1, e2, e3 in error(eps) = eps e1 + eps^2 e2 + eps^3 e3 + ..., from three values of eps.
std::array<double, 3> expansion(const std::array<std::vector<Quad>, 3>& end,
                                const std::array<std::vector<Quad>, 3>& exact) {
  std::array<double, 3> size{};
  const Quad eps(mass_ratio);
  for (std::size_t k = 0; k < end[0].size(); ++k) {
    const Quad u = end[0][k] - exact[0][k], v = end[1][k] - exact[1][k], w = end[2][k] - exact[2][k];
    const std::array<Quad, 3> e = {(Quad(18) * u - Quad(9) * v + Quad(2) * w) / (Quad(6) * eps),
                                   (Quad(-5) * u + Quad(4) * v - w) / (Quad(2) * eps * eps),
                                   (Quad(3) * u - Quad(3) * v + w) / (Quad(6) * eps * eps * eps)};
    for (std::size_t p = 0; p < 3; ++p) size[p] = std::max(size[p], static_cast<double>(abs(e[p])));
  }
  return size;
}

std::array<std::vector<Quad>, 3> outcomes(const Scheme& scheme, long n, Coordinates coordinates,
                                          const CompositionOptions& options = {}) {
  std::array<std::vector<Quad>, 3> all;
  for (std::size_t k = 0; k < 3; ++k)
    all[k] = outcome(scheme, static_cast<double>(k + 1) * mass_ratio, n, coordinates, options);
  return all;
}

/// The three orders of every scheme that claims them and fits the coordinates, against `exact`.
/// @return how many were tested
int check_orders(Coordinates coordinates, const std::array<std::vector<Quad>, 3>& exact) {
  const std::string_view inexact = wisdom_holman<Quad>({.coordinates = coordinates}).claims().inexact;
  int tested = 0;
  for (const Scheme* scheme : schemes::all()) {
    if (scheme->scheme_class != SchemeClass::near_integrable) continue;
    if (!inexact.empty() && scheme->exact.find(inexact) != std::string_view::npos) continue;
    ++tested;
    std::array<std::vector<ErrorPoint>, 3> points;
    for (const long n : ladder(16, 48)) {
      const auto size = expansion(outcomes(*scheme, n, coordinates), exact);
      for (std::size_t p = 0; p < 3; ++p) points[p].push_back({half_turn / static_cast<double>(n), size[p]});
    }
    for (std::size_t p = 0; p < 3; ++p) {
      const int claim = scheme->order.near_integrable[p];
      if (claim == 0) continue;
      const auto used = finest(points[p], 1e-20, 0.1);
      INFO(scheme->name << " claims order " << claim << " in epsilon^" << p + 1 << ", measured " << fitted_slope(used)
                        << "\n"
                        << to_text(points[p]));
      CHECK(used.size() == 3);
      CHECK(std::fabs(fitted_slope(used) - claim) < 0.2);
    }
  }
  return tested;
}

TEST_CASE("near-integrable schemes have their order in each power of epsilon", "[order][slow]") {
  check_orders(Coordinates::jacobi, outcomes(schemes::sofroniou_spaletta_10_s35, 192, Coordinates::jacobi));
}

TEST_CASE("near-integrable schemes have their orders in democratic coordinates too", "[order][slow]") {
  check_orders(Coordinates::democratic, outcomes(schemes::sofroniou_spaletta_10_s35, 192, Coordinates::democratic));
}

/// A corrector or a kernel, and the orders in epsilon and epsilon^2 that it gives a scheme.
struct Processed {
  const Scheme* scheme;
  CompositionOptions options;
  int first, second;
};

void check_processed(const Processed& made, Coordinates coordinates, const std::array<std::vector<Quad>, 3>& exact) {
  std::array<std::vector<ErrorPoint>, 2> points;
  for (const long n : ladder(24, 96)) {
    const auto size = expansion(outcomes(*made.scheme, n, coordinates, made.options), exact);
    for (std::size_t p = 0; p < 2; ++p) points[p].push_back({half_turn / static_cast<double>(n), size[p]});
  }
  const int claims[] = {made.first, made.second};
  for (std::size_t p = 0; p < 2; ++p) {
    const auto used = finest(points[p], 1e-20, 0.1);
    INFO(made.scheme->name << " with " << made.options.processing_text() << ", epsilon^" << p + 1 << ": measured "
                           << fitted_slope(used) << "\n"
                           << to_text(points[p]));
    CHECK(used.size() == 3);
    CHECK(std::fabs(fitted_slope(used) - claims[p]) < 0.3);
  }
}

TEST_CASE("correctors and kernels have their orders in the powers of epsilon", "[order][slow]") {
  const auto exact = outcomes(schemes::sofroniou_spaletta_10_s35, 192, Coordinates::jacobi);
  const StepKernel modified = StepKernel::modified, composed = StepKernel::composed, lazy = StepKernel::lazy;
  const Processed list[] = {
      {&schemes::verlet_aba, {.corrector = 3}, 4, 2},
      {&schemes::verlet, {.corrector = 5}, 6, 2},
      {&schemes::verlet_aba, {.corrector = 7}, 8, 2},
      {&schemes::verlet_aba, {.corrector = 7, .kernel = modified}, 8, 4},
      {&schemes::verlet, {.corrector = 7, .kernel = modified}, 8, 4},
      {&schemes::verlet_aba, {.corrector = 7, .kernel = composed}, 8, 4},
      {&schemes::verlet_aba, {.corrector = 7, .kernel = lazy}, 8, 4},
      {&schemes::verlet_aba, {.corrector = 7, .kernel = lazy, .second_corrector = true}, 8, 4},
      {&schemes::saba_2, {.kernel = modified}, 4, 4},
      {&schemes::saba_3, {.kernel = modified}, 6, 4},
      {&schemes::saba_4, {.kernel = modified}, 8, 4},
  };
  for (const Processed& made : list) check_processed(made, Coordinates::jacobi, exact);
}

TEST_CASE("correctors have their orders in coordinates where kicks are of order 2 too", "[order][slow]") {
  for (const Coordinates coordinates : {Coordinates::democratic, Coordinates::whds, Coordinates::barycentric}) {
    CAPTURE(static_cast<int>(coordinates));
    const auto exact = outcomes(schemes::sofroniou_spaletta_10_s35, 192, coordinates);
    check_processed({&schemes::verlet_aba, {.corrector = 5}, 6, 2}, coordinates, exact);
  }
}

TEST_CASE("those that take kicks of order 2 have their orders where velocities are scaled", "[order][slow]") {
  for (const Coordinates coordinates : {Coordinates::whds, Coordinates::barycentric}) {
    CAPTURE(static_cast<int>(coordinates));
    CHECK(check_orders(coordinates, outcomes(schemes::sofroniou_spaletta_10_s35, 192, coordinates)) == 7);
  }
}

}  // namespace
}  // namespace noether
