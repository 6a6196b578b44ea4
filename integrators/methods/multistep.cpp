/// The multistep methods as lists show them.

#include "integrators/all_methods.hpp"
#include "integrators/methods/adams.hpp"
#include "integrators/methods/adams_pece.hpp"
#include "integrators/methods/stormer_cowell.hpp"

#include <limits>

namespace noether::methods {

namespace {

template <AdamsKind kind, class Real>
std::unique_ptr<Method<Real>> adams(const MethodInfo& info, const MethodOptions& /*options*/) {
  return std::make_unique<Adams<Real>>(info.name, kind, info.order);
}

/// Variable steps and orders, or with fixed steps predictor and corrector of order 4.
template <class Real> std::unique_ptr<Method<Real>> pece(const MethodInfo& info, const MethodOptions& options) {
  if (info.is_adaptive(options)) return std::make_unique<AdamsPece<Real>>(info, options);
  return std::make_unique<Adams<Real>>(info.name, AdamsKind::pece, 4);
}

template <class Real> std::unique_ptr<Method<Real>> stormer(const MethodInfo& info, const MethodOptions& /*options*/) {
  return std::make_unique<StormerCowell<Real>>(info.name, info.order);
}

template <AdamsKind kind>
constexpr MethodInfo adams_info(std::string_view name, std::string_view alias, int order, std::string_view summary,
                                std::string_view use, double limit) {
  return {.name = name,
          .aliases = alias,
          .summary = summary,
          .use = use,
          .source = "HairerNoersettWanner1993",
          .family = "multistep",
          .order = order,
          .evaluations = kind == AdamsKind::bashforth ? 1 : 0,
          .stability_limit = limit,
          .make = adams<kind, double>,
          .make_quad = adams<kind, Quad>};
}

constexpr MethodInfo stormer_cowell(std::string_view name, std::string_view alias, int order, double limit) {
  return {
      .name = name,
      .aliases = alias,
      .summary =
          "Stoermer's explicit predictor in summed form, Cowell's corrector in the start only, velocities by Adams's "
          "sums, for q'' = a(t, q); the number is the order; one evaluation per step after the start",
      .use = "planets on nearly circular orbits, errors at rounding, short steps of one length",
      .source = "HairerNoersettWanner1993",
      .family = "multistep",
      .order = order,
      .evaluations = 1,
      .stability_limit = limit,
      .make = stormer<double>,
      .make_quad = stormer<Quad>};
}

}  // namespace

std::span<const MethodInfo> multistep_list() {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();  // the iteration fails before
  static const MethodInfo list[] = {
      adams_info<AdamsKind::bashforth>("adams_bashforth_1", "ab1", 1,
                                       "Adams-Bashforth, order 1, one step: explicit Euler",
                                       "teaching: it is explicit Euler", 0),
      adams_info<AdamsKind::bashforth>("adams_bashforth_2", "ab2", 2,
                                       "Adams-Bashforth, order 2, two steps: one evaluation per step",
                                       "expensive forces with damping: oscillations grow", 0),
      adams_info<AdamsKind::bashforth>(
          "adams_bashforth_3", "ab3", 3, "Adams-Bashforth, order 3, three steps: one evaluation per step",
          "expensive forces, one evaluation per step, oscillations well resolved", 0.72363),
      adams_info<AdamsKind::bashforth>(
          "adams_bashforth_4", "ab4", 4, "Adams-Bashforth, order 4, four steps: one evaluation per step",
          "expensive forces, one evaluation per step, oscillations well resolved", 0.42999),
      adams_info<AdamsKind::bashforth>("adams_bashforth_5", "ab5", 5,
                                       "Adams-Bashforth, order 5, five steps: one evaluation per step",
                                       "comparison: oscillations grow, if slowly", 0),
      adams_info<AdamsKind::bashforth>("adams_bashforth_6", "ab6", 6,
                                       "Adams-Bashforth, order 6, six steps: one evaluation per step",
                                       "comparison: oscillations grow, if slowly", 0),
      adams_info<AdamsKind::moulton>(
          "adams_moulton_1", "am1", 1,
          "Adams-Moulton, order 1: backward Euler by fixed-point iteration, for problems that are not stiff",
          "comparison; backward_euler solves what its iteration cannot", unknown),
      adams_info<AdamsKind::moulton>("adams_moulton_2", "am2", 2,
                                     "Adams-Moulton, order 2, one step: the trapezoidal rule by fixed-point iteration",
                                     "comparison; trapezoidal solves what its iteration cannot", unknown),
      adams_info<AdamsKind::moulton>("adams_moulton_3", "am3", 3,
                                     "Adams-Moulton, order 3, two steps, by fixed-point iteration",
                                     "comparison: oscillations grow, if slowly", 0),
      adams_info<AdamsKind::moulton>("adams_moulton_4", "am4", 4,
                                     "Adams-Moulton, order 4, three steps, by fixed-point iteration",
                                     "comparison: oscillations grow, if slowly", 0),
      adams_info<AdamsKind::moulton>("adams_moulton_5", "am5", 5,
                                     "Adams-Moulton, order 5, four steps, by fixed-point iteration",
                                     "comparison: implicit order 5 without Jacobians", 1.21193),
      adams_info<AdamsKind::moulton>("adams_moulton_6", "am6", 6,
                                     "Adams-Moulton, order 6, five steps, by fixed-point iteration",
                                     "comparison: implicit order 6 without Jacobians", 1.37636),
      {.name = "adams_pece",
       .aliases = "adams abm shampine_gordon",
       .summary = "Adams predictor and corrector with steps and orders (1 to 12) chosen by the method, two evaluations "
                  "per step, dense output; with adaptive = false order 4 and fixed steps",
       .use = "expensive forces that are not stiff, at any accuracy, with steps chosen by the method",
       .source = "ShampineGordon1975",
       .family = "multistep",
       .order = 12,
       .evaluations = 2,
       .adaptive = true,
       .stability_limit = 0,
       .make = pece<double>,
       .make_quad = pece<Quad>},
      stormer_cowell("stormer_cowell_12", "stormer_12", 12, 0.12601),
      stormer_cowell("stormer_cowell_13", "stormer_13", 13, 0.09055),
      stormer_cowell("stormer_cowell_14", "stormer_14", 14, 0.06497),
  };
  return list;
}

}  // namespace noether::methods
