#include "engine/check_wanted.hpp"

#include "numbers/error.hpp"

#include <fmt/format.h>

namespace noether::detail {

std::string why_no_action(const IntegratorClaims& claims, bool has_action) {
  if (claims.clock == ClockMode::free) return fmt::format("method '{}' takes steps of varying length", claims.method);
  if (!claims.no_action.empty()) return std::string(claims.no_action);
  if (claims.dissipative) return "a force of this run is dissipative, so its motion has no action";
  if (claims.time_dependent)
    return "a force of this run depends on time, so no energy is conserved, not even the exact one";
  if (has_action) return "";
  return fmt::format("method '{}' does not compute it{}", claims.method,
                     claims.symplectic ? "" : "; it is not symplectic");
}

void check_wanted(const std::string& monitor, const Request& wanted, const IntegratorClaims& claims, const Told& told) {
  if (wanted.energy && !claims.energy) {
    throw Error(fmt::format("monitor '{}' needs the energy, but a force of this run does not compute one", monitor));
  }
  if (wanted.virial && !told.virial) {
    throw Error(fmt::format("monitor '{}' needs the virial, but {}", monitor,
                            claims.constraints > 0
                                ? "a force or constraint of this run has none: what holds particles in place does not "
                                  "contribute to the pressure"
                                : fmt::format("'{}' or one of its forces does not compute it", claims.hamiltonian)));
  }
  if (!wanted.action) return;
  const auto refuse = [&](const std::string& why) {
    throw Error(fmt::format("monitor '{}' needs the action of every step: {}", monitor, why));
  };
  if (const std::string why = why_no_action(claims, told.action); !why.empty()) refuse(why);
  if (!told.by_steps) refuse("attach it by steps, not by wall time");
}

}  // namespace noether::detail
