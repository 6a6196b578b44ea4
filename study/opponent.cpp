#include "study/opponent.hpp"

#include "engine/suggest.hpp"
#include "forces/gravity.hpp"
#include "integrators/methods.hpp"
#include "integrators/schemes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace noether {

namespace {

using Kind = SceneHamiltonian::Kind;

bool is_word(std::string_view name) {
  return !name.empty() && name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string_view::npos;
}

std::string_view name_of(Kind kind) { return kind == Kind::wisdom_holman ? "wisdom_holman" : "kinetic_potential"; }

/// The scene's Hamiltonian without its splitting: gravity becomes a force as any other.
void join_parts(SceneHamiltonian& hamiltonian) {
  if (hamiltonian.kind == Kind::kinetic_potential) return;
  SceneForce gravity{"gravity", SceneValue::table(), {}, {}};
  gravity.force = AnyForce<double>(Gravity{.G = hamiltonian.wisdom_holman.G});
  hamiltonian.forces.insert(hamiltonian.forces.begin(), std::move(gravity));
  hamiltonian.kind = Kind::kinetic_potential;
}

/// Whether the scene can be put together with a method. @return why not; empty if it can
std::string refusal(const Scene& scene, const Opponent& who) {
  try {
    const double step = scene.integrator.step > 0 ? scene.integrator.step : 1;
    assemble(variant(scene, who, {.step = who.adaptive ? 0 : step, .tolerance = who.adaptive ? 1e-6 : 0}));
  } catch (const Error& error) {
    return error.message();
  }
  return "";
}

Opponent make(const Scene& scene, const std::string& method, Kind kind, bool adaptive) {
  Opponent who{method, method, kind, adaptive};
  if (kind != scene.hamiltonian.kind) who.label = fmt::format("{}@{}", method, name_of(kind));
  return who;
}

}  // namespace

Opponent opponent(const Scene& scene, std::string_view name) {
  const std::size_t at = name.find('@');
  const std::string method(name.substr(0, at)), over(at == std::string_view::npos ? "" : name.substr(at + 1));
  if (!over.empty() && over != name_of(Kind::kinetic_potential) && over != name_of(Kind::wisdom_holman)) {
    throw Error(
        fmt::format("unknown hamiltonian '{}'{}", over, did_you_mean(over, {"kinetic_potential", "wisdom_holman"})));
  }
  if (over == name_of(Kind::wisdom_holman) && scene.hamiltonian.kind != Kind::wisdom_holman) {
    throw Error(fmt::format("'{}': the scene has no splitting into Kepler arcs; leave '@wisdom_holman' out", name));
  }
  const MethodInfo* info = methods::find(method);
  const Scheme* scheme = schemes::find(method);
  if (info == nullptr && scheme == nullptr && !is_word(method)) {
    const std::string near = suggest(method, methods::known_names());
    throw Error(fmt::format("unknown method '{}'; {}", method,
                            near.empty() ? "see `noether list methods`" : "did you mean '" + near + "'?"),
                {.value = method});
  }
  if (info != nullptr && scheme == nullptr) {
    const bool own = info->name == scene.integrator.method;
    const bool adaptive = own ? scene.integrator.adaptive() : info->adaptive;
    const Opponent who = make(scene, std::string(info->name), scene.hamiltonian.kind, adaptive);
    if (const std::string why = refusal(scene, who); !why.empty()) throw Error(why);
    return who;
  }
  const std::string full = scheme != nullptr ? std::string(scheme->name) : method;
  std::vector<Kind> kinds = {scene.hamiltonian.kind};
  if (over.empty() && scene.hamiltonian.kind == Kind::wisdom_holman) kinds.push_back(Kind::kinetic_potential);
  if (over == name_of(Kind::kinetic_potential)) kinds = {Kind::kinetic_potential};
  std::string why;
  for (const Kind kind : kinds) {
    const Opponent who = make(scene, full, kind, false);
    const std::string refused = refusal(scene, who);
    if (refused.empty()) return who;
    if (why.empty()) why = refused;
  }
  throw Error(why);
}

std::vector<Opponent> default_opponents(const Scene& scene) {
  std::vector<std::string> names = {scene.integrator.method};
  const bool split = scene.hamiltonian.kind == Kind::wisdom_holman;
  if (scene.particles.size() == 0) {
    names.insert(names.end(), {"rk4", "dormand_prince_5", "dop853", "gauss_8", "gauss_radau_15", "adams_pece",
                               "trapezoidal", "sdirk_4", "rodas_4", "rodas_5p", "bdf"});
  } else {
    if (split) names.insert(names.end(), {"aba_10_6_4", "verlet_aba", "verlet@kinetic_potential"});
    if (!split) names.insert(names.end(), {"verlet", "yoshida_4"});
    names.insert(names.end(), {"blanes_moan_s6@kinetic_potential", "srkn14a@kinetic_potential",
                               "kahan_li_8_s17@kinetic_potential", "rk4", "dormand_prince_5", "dop853", "gauss_8",
                               "gauss_radau_15", "gragg_bulirsch_stoer", "stormer_cowell_13"});
  }
  std::vector<Opponent> all;
  for (const std::string& name : names) {
    try {
      Opponent who = opponent(scene, name);
      if (std::find(all.begin(), all.end(), who) == all.end()) all.push_back(std::move(who));
    } catch (const Error&) {
      continue;  // it cannot serve this scene
    }
  }
  return all;
}

Scene variant(const Scene& scene, const Opponent& who, const Setting& setting) {
  Scene made = scene;
  made.watches.clear();
  made.stops.clear();
  if (who.hamiltonian != scene.hamiltonian.kind) join_parts(made.hamiltonian);
  SceneIntegrator& integrator = made.integrator;
  const bool own = who.method == scene.integrator.method;
  const std::optional<MethodChoice> before = std::exchange(integrator.classical, std::nullopt);
  integrator.method = who.method;
  integrator.step = who.adaptive ? 0 : setting.step;
  integrator.steps.reset();
  integrator.until.reset();
  if (scene.particles.size() == 0 && methods::find(who.method) == nullptr) {
    throw Error(
        fmt::format("'{}' splits a Hamiltonian, and a system of first order has none; use a method for y' = f, "
                    "such as 'dop853' or 'rodas_5p'",
                    who.method));
  }
  if (const Scheme* scheme = schemes::find(who.method)) {
    integrator.scheme = *scheme;
  } else if (const MethodInfo* info = methods::find(who.method)) {
    if (!scene.hamiltonian.constraints.empty()) {
      throw Error(
          fmt::format("method '{}' knows no constraints; use a splitting scheme, such as 'verlet'", who.method));
    }
    MethodOptions options = own && before ? before->options : MethodOptions{};
    options.rtol.reset();
    options.atol.reset();
    options.first.reset();
    options.adaptive.reset();
    if (who.adaptive) {
      options.rtol = setting.tolerance;
      options.atol = absolute_tolerance(scene, setting.tolerance);
    } else if (info->adaptive) {
      options.adaptive = false;
    }
    integrator.classical = MethodChoice{info, options};
    integrator.compensated = false;
  } else {
    integrator.scheme = word(who.method);
  }
  return made;
}

double absolute_tolerance(const Scene& scene, double relative) {
  double ratio = 1e-3;
  if (scene.integrator.adaptive()) {
    const MethodChoice& own = *scene.integrator.classical;
    const double rtol = own.options.rtol.value_or(own.info->rtol), atol = own.options.atol.value_or(own.info->atol);
    if (rtol > 0 && atol > 0) ratio = atol / rtol;
  }
  return ratio * relative;
}

double evaluations_per_step(const Scene& scene, const Opponent& who, double step) {
  if (who.adaptive) return 0;
  constexpr std::int64_t begin = 20, count = 20;  // multistep methods start in other ways
  Simulation<double> sim = assemble(variant(scene, who, {.step = step, .tolerance = 0}));
  if (!sim.run(begin).ok()) return 0;
  const std::int64_t before = sim.evaluations().force;
  if (!sim.run(count).ok()) return 0;
  return static_cast<double>(sim.evaluations().force - before) / static_cast<double>(count);
}

}  // namespace noether
