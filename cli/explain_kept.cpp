#include "cli/explain_kept.hpp"

#include "engine/bodies.hpp"
#include "engine/check_wanted.hpp"
#include "integrators/method.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <vector>

namespace noether {

namespace {

/// "L not, because of henon_heiles": of the forces and the method that do not keep it, else of the box.
std::string lost_text(const Scene& scene, const char* symbol, bool ForceClaims::*keeps, bool method_keeps,
                      bool box_loses) {
  std::vector<std::string> because;
  for (const SceneForce& force : scene.hamiltonian.forces) {
    if (!(force.force.claims().*keeps)) because.push_back(force.name);
  }
  if (because.empty() && box_loses && scene.particles.box().is_periodic()) because.emplace_back("the periodic box");
  if (because.empty() || !method_keeps) because.emplace_back("the method");
  return fmt::format("{} not, because of {}", symbol, fmt::join(because, ", "));
}

}  // namespace

std::string kept_text(const Scene& scene, const IntegratorClaims& claims) {
  const std::optional<MethodChoice>& own = scene.integrator.classical;
  const MethodClaims method = own ? make_method<double>(*own->info, own->options)->claims()
                                  : MethodClaims{.name = "", .keeps_angular_momentum = true};
  const bool conserved = claims.energy && !claims.dissipative && !claims.time_dependent;
  if (!claims.energy_exact && conserved && method.exact_degree > 2) {
    return fmt::format("keeps E where it is a polynomial of degree {} or less", method.exact_degree);
  }
  if (!claims.energy_exact) return "";
  if (scene.system) return "keeps E";
  std::vector<std::string> kept = {"E"}, lost;
  const auto tell = [&](const char* symbol, bool keeps, bool ForceClaims::*by_forces, bool by_method, bool box_loses) {
    if (keeps) {
      kept.emplace_back(symbol);
    } else {
      lost.push_back(lost_text(scene, symbol, by_forces, by_method, box_loses));
    }
  };
  tell("p", claims.keeps_momentum, &ForceClaims::keeps_momentum, method.keeps_momentum, false);
  tell("L", claims.keeps_angular_momentum, &ForceClaims::keeps_angular_momentum, method.keeps_angular_momentum, true);
  const std::string all = kept.size() == 3 ? "E, p and L" : fmt::format("{}", fmt::join(kept, " and "));
  return fmt::format("keeps {}{}{}", all, lost.empty() ? "" : "; ", fmt::join(lost, "; "));
}

std::string shadow_text(const Scene& scene, const AnyIntegrator<double>& integrator) {
  const IntegratorClaims claims = integrator.claims();
  if (!claims.energy || !(scene.system || has_bodies(scene.particles))) return "";
  constexpr std::string_view monitor = "shadow_hamiltonian";
  const std::string why = detail::why_no_action(claims, integrator.has_action());
  return why.empty() ? fmt::format("monitor '{}' can watch: every step has its action", monitor)
                     : fmt::format("monitor '{}' cannot watch: {}", monitor, why);
}

}  // namespace noether
