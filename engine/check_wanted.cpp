#include "engine/check_wanted.hpp"

#include "numbers/error.hpp"

#include <fmt/format.h>

namespace noether::detail {

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
  if (claims.clock == ClockMode::free) refuse(fmt::format("method '{}' takes steps of varying length", claims.method));
  if (!claims.no_action.empty()) refuse(std::string(claims.no_action));
  if (claims.dissipative) refuse("a force of this run is dissipative, so its motion has no action");
  if (claims.time_dependent)
    refuse("a force of this run depends on time, so no energy is conserved, not even the exact one");
  if (!told.action)
    refuse(fmt::format("method '{}' does not compute it{}", claims.method,
                       claims.symplectic ? "" : "; it is not symplectic"));
  if (!told.by_steps) refuse("attach it by steps, not by wall time");
}

}  // namespace noether::detail
