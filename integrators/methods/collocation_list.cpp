#include "integrators/all_methods.hpp"
#include "integrators/methods/gravity_gauss.hpp"

#include <limits>

namespace noether {

namespace methods {

namespace {

template <class Real> std::unique_ptr<Method<Real>> gauss(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<Collocation<Real>>(info, options, *collocation_of(info.name), true);
}
/// Gauss's methods of six stages and more have a form of their own for gravity; with fewer, errors at rounding are no
/// larger without it, since steps are so much shorter.
std::unique_ptr<Method<double>> gauss_of_gravity(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<GravityGauss>(info, options, *collocation_of(info.name), true);
}
std::unique_ptr<Method<double>> radau(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<GravityGauss>(info, options, radau_left_table(), false);
}
std::unique_ptr<Method<Quad>> radau_in_quad(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<Collocation<Quad>>(info, options, radau_left_table(), false);
}

MethodInfo gauss_info(std::string_view name, std::string_view summary, std::string_view use, int stages) {
  return {.name = name,
          .aliases = stages == 1 ? "gauss_1" : "",
          .summary = summary,
          .use = use,
          .source = "Butcher1964",
          .family = "collocation",
          .options = {linear_solver},
          .order = 2 * stages,
          .adaptive = stages > 2,
          .rtol = 1e-16,
          .atol = 0,
          .stability_limit = std::numeric_limits<double>::infinity(),
          .make = stages >= 6 ? gauss_of_gravity : gauss<double>,
          .make_quad = gauss<Quad>};
}

}  // namespace

std::span<const MethodInfo> collocation_list() {
  static const MethodInfo list[] = {
      gauss_info("implicit_midpoint", "the implicit midpoint rule: symplectic, symmetric, by iteration to rounding",
                 "forces that depend on velocities and stiff springs, where a symmetric step of low order will do", 1),
      gauss_info("gauss_2", "Gauss and Legendre's collocation with 2 stages, to rounding",
                 "any forces at order 4, where a composition would have to split them", 2),
      gauss_info("gauss_3", "Gauss and Legendre's collocation with 3 stages, to rounding",
                 "any forces at order 6, where a composition would have to split them", 3),
      gauss_info("gauss_4", "Gauss and Legendre's collocation with 4 stages, to rounding",
                 "any forces at order 8, where a composition would have to split them", 4),
      gauss_info("gauss_5", "Gauss and Legendre's collocation with 5 stages, to rounding",
                 "any forces at order 10, where a composition would have to split them", 5),
      gauss_info("gauss_6", "Gauss and Legendre's collocation with 6 stages, to rounding",
                 "any forces at order 12, where a composition would have to split them", 6),
      gauss_info("gauss_7", "Gauss and Legendre's collocation with 7 stages, to rounding",
                 "any forces at order 14, where a composition would have to split them", 7),
      gauss_info("gauss_8", "Gauss and Legendre's collocation with 8 stages in lanes: the reference, to rounding",
                 "errors at rounding level, close encounters and eccentric orbits included", 8),
      {.name = "gauss_radau_15",
       .aliases = "ias15",
       .summary = "Gauss-Radau collocation of order 15, the nodes of IAS15, to rounding",
       .use = "runs that are to be compared with IAS15, planets for some 1e5 years; `gauss_8` is symplectic",
       .source = "ReinSpiegel2015",
       .family = "collocation",
       .options = {linear_solver},
       .order = 15,
       .adaptive = true,
       .rtol = 1e-16,
       .atol = 0,
       .stability_limit = 1.3613,
       .make = radau,
       .make_quad = radau_in_quad},
  };
  return list;
}

}  // namespace methods

}  // namespace noether
