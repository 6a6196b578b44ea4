#pragma once
/// What a splitting takes beside its scheme.

#include "engine/description.hpp"
#include "integrators/inner_steps.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace noether {

/// What a step of Wisdom-Holman is made of, so that its error of second order in the masses goes.
enum class StepKernel : std::uint8_t {
  plain,     ///< a drift, a kick, a drift
  modified,  ///< the kick with the gradient of the square of its own force
  composed,  ///< five kicks
  lazy,      ///< the kick by the force a little further along itself
};

template <> struct EnumNames<StepKernel> {
  static constexpr std::array<std::pair<StepKernel, std::string_view>, 4> values = {{{StepKernel::plain, "plain"},
                                                                                     {StepKernel::modified, "modified"},
                                                                                     {StepKernel::composed, "composed"},
                                                                                     {StepKernel::lazy, "lazy"}}};
};

/// Options of a composition, whatever its scheme.
struct CompositionOptions {
  bool compensated = false;               ///< keep the rounding errors of x and v and add them back (Kahan, Neumaier)
  std::int64_t corrector = 0;             ///< order of the symplectic corrector; 0: none
  StepKernel kernel = StepKernel::plain;  ///< of Verlet over Kepler arcs; modified: also of `saba_n`
  bool second_corrector = false;          ///< with a kernel, beside the first one
  InnerSteps inner_steps = {};            ///< of `respa`

  static constexpr auto describe() {
    return part<CompositionOptions>(
        "composition", "options of splittings in addition to the scheme",
        field<&CompositionOptions::compensated>("compensated", "1",
                                                "keeps the rounding errors of sums and adds them again later"),
        field<&CompositionOptions::corrector>("corrector", "1",
                                              "order of a symplectic corrector: 3, 5, 7, 11 or 17; 0 for none; for "
                                              "verlet and verlet_aba on wisdom_holman"),
        field<&CompositionOptions::kernel>("kernel", "1",
                                           "of verlet and verlet_aba on wisdom_holman; modified: also of saba_1 to "
                                           "saba_4; composed: in all coordinates; with a corrector the step is of "
                                           "order 4 in jacobi, 3 in democratic, 2 in others"),
        field<&CompositionOptions::second_corrector>("second_corrector", "1",
                                                     "beside a corrector, for kernels that are not plain"),
        field<&CompositionOptions::inner_steps>("inner_steps", "1",
                                                "of respa: steps of the kicks B in one of the next letter, of these in "
                                                "one of the letter after it, and so on"));
  }
  /// Why methods for y' = f do not have an option.
  static constexpr std::string_view elsewhere(std::string_view name) {
    return name == "compensated" ? "sums in its own way" : "does not split";
  }
  /// Whether a scheme is walked otherwise than its table says.
  constexpr bool changes_scheme() const { return corrector != 0 || kernel != StepKernel::plain || second_corrector; }
  /// The same for a scheme that is walked as its table says.
  constexpr CompositionOptions as_written() const { return {.compensated = compensated}; }

  /// The changes in words, inner steps among them; empty without any.
  std::string processing_text() const;

  /// Refuses what does not go with constraints. @throws Error
  void check_with_constraints() const {
    if (compensated) {
      refuse_field("compensated", "true",
                   "does not work with constraints, which are solved to the rounding of plain sums");
    }
  }
};

}  // namespace noether
