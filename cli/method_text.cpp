#include "cli/method_text.hpp"

#include "integrators/lie/rkmk.hpp"
#include "numbers/text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace noether {

int order_in_quad(const MethodInfo& info) {
  return info.make_quad == nullptr ? info.order : info.make_quad(info, {})->claims().order;
}

std::string order_text(const MethodInfo& info) {
  const int wide = order_in_quad(info);
  const std::string in_quad = wide == info.order ? "" : fmt::format(", in Quad to {}", wide);
  if (!info.fixed) return fmt::format("varies, to {}{}", info.order, in_quad);
  MethodOptions fixed;
  if (info.adaptive) fixed.adaptive = false;
  const int order = info.make(info, fixed)->claims().order;
  return order == info.order ? fmt::format("{}", order) : fmt::format("{}, to {}{}", order, info.order, in_quad);
}

std::string evaluations_text(const MethodInfo& info) {
  if (info.evaluations > 0) return fmt::format("{}", info.evaluations);
  return info.fixed ? "iterates" : "-";
}

std::string group_work_text(const GroupWork& work) {
  std::string text = fmt::format("{}, {} and {} a step on a group", counted(work.evaluations, "evaluation"),
                                 counted(work.exponentials, "exponential"), counted(work.commutators, "commutator"));
  if (work.least_commutators >= 0 && work.least_commutators < work.commutators)
    text += fmt::format("; commutators could be reduced to {}", work.least_commutators);
  return text;
}

std::string dexp_text(const MethodInfo& info, const MethodOptions& options) {
  const int terms = dexp_terms_of(info, options);
  return terms < 0 ? "" : fmt::format("; {} in dexp^-1 of a stage", counted(terms, "nested commutator"));
}

Json group_work_json(const GroupWork& work) {
  return Json::object({{"evaluations", work.evaluations},
                       {"exponentials", work.exponentials},
                       {"commutators", work.commutators},
                       {"least_commutators", work.least_commutators >= 0 ? Json(work.least_commutators) : Json()}});
}

std::string limit_text(double limit) {
  if (std::isnan(limit)) return "-";
  if (limit == 0) return "never";
  return std::isinf(limit) ? "always" : fmt::format("{:.4g}", limit);
}

Json limit_json(double limit) {
  if (std::isnan(limit)) return {};
  return std::isinf(limit) ? Json("always") : Json(limit);
}

}  // namespace noether
