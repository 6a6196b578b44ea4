#include "integrators/all_methods.hpp"
#include "integrators/variational/galerkin.hpp"

#include <limits>

namespace noether::methods {

namespace {

/// "galerkin_gauss_3": 3; the rules that have names of their own are the first of their families.
int nodes_in(std::string_view name) {
  if (name == "variational_midpoint") return 1;
  return name == "variational_trapezoidal" ? 2 : name.back() - '0';
}

template <class Real> std::unique_ptr<Method<Real>> galerkin_gauss(const MethodInfo& info, const MethodOptions&) {
  return std::make_unique<Galerkin<Real>>(info, galerkin_gauss_table(nodes_in(info.name)));
}
template <class Real> std::unique_ptr<Method<Real>> galerkin_lobatto(const MethodInfo& info, const MethodOptions&) {
  return std::make_unique<Galerkin<Real>>(info, galerkin_lobatto_table(nodes_in(info.name)));
}

MethodInfo galerkin_info(std::string_view name, std::string_view aliases, std::string_view summary,
                         std::string_view use, int order, double limit, bool gauss, int evaluations = 0) {
  return {.name = name,
          .aliases = aliases,
          .summary = summary,
          .use = use,
          .source = "MarsdenWest2001",
          .family = "variational",
          .order = order,
          .evaluations = evaluations,
          .stability_limit = limit,
          .make = gauss ? galerkin_gauss<double> : galerkin_lobatto<double>,
          .make_quad = gauss ? galerkin_gauss<Quad> : galerkin_lobatto<Quad>};
}

constexpr double never = std::numeric_limits<double>::infinity();

MethodInfo gauss_path(std::string_view name, std::string_view summary, int nodes) {
  return galerkin_info(name, "", summary, "a Lagrangian of your own, smooth motion at a high order", 2 * nodes, never,
                       true);
}
MethodInfo lobatto_path(std::string_view name, std::string_view summary, int nodes, double limit) {
  return galerkin_info(name, "", summary, "a Lagrangian of your own whose forces act at the ends of steps",
                       2 * nodes - 2, limit, false);
}

}  // namespace

std::span<const MethodInfo> variational_list() {
  static const MethodInfo list[] = {
      galerkin_info("variational_midpoint", "galerkin_gauss_1 weber_weak",
                    "the action of a step by the midpoint rule, made stationary: implicit_midpoint over any Lagrangian",
                    "a Lagrangian of your own, robust at low order, stiff motion too", 2, never, true),
      gauss_path("galerkin_gauss_2", "the action of a quadratic path by 2 nodes of Gauss, made stationary", 2),
      gauss_path("galerkin_gauss_3", "the action of a cubic path by 3 nodes of Gauss, made stationary", 3),
      gauss_path("galerkin_gauss_4", "the action of a path of degree 4 by 4 nodes of Gauss, made stationary", 4),
      gauss_path("galerkin_gauss_5", "the action of a path of degree 5 by 5 nodes of Gauss, made stationary", 5),
      gauss_path("galerkin_gauss_6", "the action of a path of degree 6 by 6 nodes of Gauss, made stationary", 6),
      galerkin_info("variational_trapezoidal", "galerkin_lobatto_2",
                    "the action of a step by the trapezoidal rule, made stationary: verlet over any Lagrangian",
                    "a Lagrangian of your own at the lowest cost", 2, 2, false, 4),
      lobatto_path("galerkin_lobatto_3", "the action of a quadratic path by 3 nodes of Lobatto, made stationary", 3,
                   2.8284),
      lobatto_path("galerkin_lobatto_4", "the action of a cubic path by 4 nodes of Lobatto, made stationary", 4,
                   3.1127),
      lobatto_path("galerkin_lobatto_5", "the action of a path of degree 4 by 5 nodes of Lobatto, made stationary", 5,
                   3.1404),
      lobatto_path("galerkin_lobatto_6", "the action of a path of degree 5 by 6 nodes of Lobatto, made stationary", 6,
                   3.1416),
  };
  return list;
}

}  // namespace noether::methods
