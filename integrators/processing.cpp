#include "integrators/processing.hpp"

#include "integrators/schemes/correctors.hpp"
#include "integrators/schemes/low_order.hpp"
#include "integrators/schemes/near_integrable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

namespace noether {

namespace {

bool same(const Word& a, const Word& b) { return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin()); }

Word joined(const Word& first, const Word& second) {
  Word all = first;
  for (const Stage& stage : second) all.push_back(stage);
  return all;
}

std::string name_of(StepKernel kernel) {
  std::string known;
  for (const auto& [value, name] : EnumNames<StepKernel>::values) known = value == kernel ? name : known;
  return known;
}

std::string key_of(const CompositionOptions& options) {
  if (options.corrector != 0) return "corrector";
  return options.kernel != StepKernel::plain ? "kernel" : "second_corrector";
}

void check_orders(const CompositionOptions& options) {
  const auto& orders = schemes::corrector_orders;
  if (options.corrector != 0 && std::find(orders.begin(), orders.end(), options.corrector) == orders.end()) {
    throw SchemeMismatch(
        fmt::format("there is no corrector of order {}; give 3, 5, 7, 11 or 17, or 0 for none", options.corrector),
        {.key = "corrector", .value = std::to_string(options.corrector)});
  }
  if (options.second_corrector && (options.corrector == 0 || options.kernel == StepKernel::plain)) {
    throw SchemeMismatch(
        "second_corrector = true needs a corrector and a kernel other than \"plain\"; give both, or take it out",
        {.key = "second_corrector", .value = "true"});
  }
}

/// The step in the place of a drift, a kick and a drift.
Word kernel_word(StepKernel kernel) {
  if (kernel == StepKernel::plain) return schemes::verlet_aba.word;
  Word word;
  if (kernel == StepKernel::composed) {
    for (std::size_t k = 0; k < schemes::composed_kernel_drifts.size(); ++k) {
      word.push_back({'A', schemes::composed_kernel_drifts[k]});
      if (k < schemes::composed_kernel_kicks.size()) word.push_back({'B', schemes::composed_kernel_kicks[k]});
    }
    return word;
  }
  word.push_back({'A', 0.5_q});
  word.push_back({kernel == StepKernel::lazy ? 'L' : 'B', 1_q});
  if (kernel == StepKernel::modified) word.push_back({'G', 1_q / 24_q});
  word.push_back({'A', 0.5_q});
  return word;
}

/// Always drift first: words around the run must not drift as a whole, or forces that depend on time see it displaced.
Scheme corrected(const Scheme& scheme, const CompositionOptions& options) {
  Scheme made = scheme;
  made.word = kernel_word(options.kernel);
  made.substep_count = 0;
  made.exact = "A";
  Word before = schemes::corrector_word(options.corrector);
  if (options.second_corrector) before = joined(before, schemes::second_corrector_word());
  made.before = before;
  made.after = schemes::inverse(before);
  const bool kernel = options.kernel != StepKernel::plain;
  if (options.corrector != 0) {
    const int first = static_cast<int>(options.corrector) + 1;
    made.order = {kernel ? 4 : 2, {first, kernel ? 4 : 2, 0}};
    if (options.kernel == StepKernel::composed) made.order.outside_class = 3;
  }
  made.scheme_class = SchemeClass::near_integrable;
  return made;
}

/// `saba_n` with the gradient of its kicks at both ends; where steps meet the two are one.
Scheme with_gradient(const Scheme& scheme, std::size_t n) {
  Scheme made = scheme;
  const Quad weight = schemes::saba_corrections[n - 1];
  made.word = Word();
  made.word.push_back({'G', weight});
  made.word = joined(made.word, scheme.word);
  made.word.push_back({'G', weight});
  made.exact = "AB";
  made.order = n == 1 ? Order{2, {2, 2, 0}} : Order{4, {static_cast<int>(2 * n), 4, 0}};
  return made;
}

}  // namespace

std::string CompositionOptions::processing_text() const {
  std::string text;
  const auto add = [&](const std::string& one) { text += (text.empty() ? "" : ", ") + one; };
  if (corrector != 0) add(fmt::format("corrector = {}", corrector));
  if (kernel != StepKernel::plain) add(fmt::format("kernel = \"{}\"", name_of(kernel)));
  if (second_corrector) add("second_corrector = true");
  if (!inner_steps.empty()) add("inner_steps = " + inner_steps.text());
  return text;
}

Scheme processed(const Scheme& scheme, const CompositionOptions& options) {
  if (!options.changes_scheme()) return scheme;
  check_orders(options);
  if (options.kernel == StepKernel::modified && options.corrector == 0) {
    const std::array saba = {&schemes::saba_1, &schemes::saba_2, &schemes::saba_3, &schemes::saba_4};
    for (std::size_t n = 1; n <= saba.size(); ++n) {
      if (scheme.name == saba[n - 1]->name) return with_gradient(scheme, n);
    }
  }
  if (scheme.before.size() > 0 || scheme.after.size() > 0) {
    throw SchemeMismatch(
        fmt::format("{} is not for scheme '{}', which has words around the run of its own; take it out",
                    options.processing_text(), scheme.name),
        {.key = key_of(options)});
  }
  const bool kick_first = same(scheme.word, schemes::verlet.word) && !scheme.nested;
  if (kick_first || same(scheme.word, schemes::verlet_aba.word)) return corrected(scheme, options);
  const std::string_view remedy = options.corrector == 0 && options.kernel == StepKernel::modified
                                      ? "use 'verlet_aba', or one of 'saba_1' to 'saba_4'"
                                      : "use 'verlet_aba'";
  throw SchemeMismatch(fmt::format("{} is not for method '{}'; {}", options.processing_text(), scheme.name, remedy),
                       {.key = key_of(options)});
}

}  // namespace noether
