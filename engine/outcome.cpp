#include "engine/outcome.hpp"

namespace noether {

std::string_view name(Outcome::Kind kind) noexcept {
  switch (kind) {
    case Outcome::Kind::completed:
      return "completed";
    case Outcome::Kind::stopped:
      return "stopped";
    case Outcome::Kind::interrupted:
      return "interrupted";
    case Outcome::Kind::diverged:
      return "diverged";
    case Outcome::Kind::constraint_failure:
      return "constraint_failure";
    case Outcome::Kind::solver_failure:
      return "solver_failure";
    case Outcome::Kind::step_underflow:
      return "step_underflow";
    case Outcome::Kind::overlap:
      return "overlap";
    case Outcome::Kind::overstretch:
      return "overstretch";
    case Outcome::Kind::inverted_element:
      return "inverted_element";
  }
  return "completed";
}

int exit_code(const Outcome& outcome) noexcept {
  if (outcome.ok()) return 0;
  return outcome.kind == Outcome::Kind::interrupted ? 130 : 1;
}

namespace {

std::string label(const ParticleRef& particle) {
  return particle.name.empty() ? fmt::format("particle {}", particle.id) : particle.name;
}

/// What it happened to: the quantity, the particle, or one of the other.
std::string subject(const Outcome& outcome) {
  if (!outcome.particle) return outcome.quantity;
  if (outcome.quantity.empty()) return label(*outcome.particle);
  return fmt::format("{} of {}", outcome.quantity, label(*outcome.particle));
}

std::string reason(const Outcome& outcome) {
  if (!outcome.message.empty()) return outcome.message;
  const std::string what = subject(outcome);
  return outcome.kind == Outcome::Kind::diverged && !what.empty() ? what + " is not finite" : what;
}

}  // namespace

std::string to_text(const Outcome& outcome) {
  const std::string why = reason(outcome);
  return fmt::format("{} at step {}{}{}", name(outcome.kind), outcome.step, why.empty() ? "" : ": ", why);
}

}  // namespace noether

fmt::format_context::iterator fmt::formatter<noether::Outcome>::format(const noether::Outcome& outcome,
                                                                       fmt::format_context& context) const {
  return fmt::formatter<std::string_view>::format(noether::to_text(outcome), context);
}
