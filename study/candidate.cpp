#include "study/candidate.hpp"

#include "engine/bodies.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "numbers/suggest.hpp"
#include "scene/fields.hpp"
#include "scene/foreign_names.hpp"
#include "study/sampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace noether {

namespace {

bool is_word(std::string_view name) {
  return !name.empty() && name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string_view::npos;
}

const Parts::HamiltonianKind& plain(const Scene& scene) { return scene.parts->hamiltonians().front(); }
bool is_plain(const Scene& scene) { return scene.hamiltonian.splitting.name == plain(scene).info.name; }
/// Whether its Hamiltonian has forces in itself, and can be written as these over the plain one.
bool may_be_joined(const Scene& scene) {
  const SceneSplitting& splitting = scene.hamiltonian.splitting;
  return splitting.only_forces && !splitting.own.empty();
}

/// The scene's Hamiltonian without its splitting: what that has in itself becomes forces as all others.
void join_parts(Scene& scene) {
  SceneHamiltonian& hamiltonian = scene.hamiltonian;
  hamiltonian.forces.insert(hamiltonian.forces.begin(), hamiltonian.splitting.own.begin(),
                            hamiltonian.splitting.own.end());
  const SceneContext context{.source = scene.source, .units = scene.units};
  const SceneValue empty = SceneValue::table();
  TableReader reader(context, empty, "[hamiltonian]", "hamiltonian");
  hamiltonian.splitting = plain(scene).read(reader);
}

/// Whether the scene can be put together with a method. @return why not; empty if it can
std::string refusal(const Scene& scene, const Candidate& who) {
  try {
    const double step = scene.integrator.step > 0 ? scene.integrator.step : 1;
    assemble(variant(scene, who, {.step = who.adaptive ? 0 : step, .tolerance = who.adaptive ? 1e-6 : 0}));
  } catch (const Error& error) {
    return error.message();
  }
  return "";
}

Candidate make(const Scene& scene, const std::string& method, bool joined, bool adaptive) {
  Candidate who{method, method, joined, adaptive};
  const MethodInfo* info = scene.parts->find_method(method);
  who.below_rounding = info != nullptr && make_method<double>(*info, {})->claims().second_words;
  if (joined) who.label = fmt::format("{}@{}", method, plain(scene).info.name);
  return who;
}

std::vector<Candidate> those_that_serve(const Scene& scene, const std::vector<std::string>& names) {
  std::vector<Candidate> all;
  for (const std::string& name : names) {
    try {
      Candidate who = candidate(scene, name);
      if (std::find(all.begin(), all.end(), who) == all.end()) all.push_back(std::move(who));
    } catch (const Error&) {
      continue;  // it cannot serve this scene
    }
  }
  return all;
}

}  // namespace

Candidate candidate(const Scene& scene, std::string_view name) {
  const std::size_t at = name.find('@');
  const std::string method(name.substr(0, at)), over(at == std::string_view::npos ? "" : name.substr(at + 1));
  const std::string &own_name = scene.hamiltonian.splitting.name, &plain_name = plain(scene).info.name;
  if (const auto known = names_of(scene.parts->hamiltonians());
      !over.empty() && std::find(known.begin(), known.end(), over) == known.end()) {
    throw Error(fmt::format("unknown hamiltonian '{}'{}", over, did_you_mean(over, known)));
  }
  if (!over.empty() && over != own_name && over != plain_name) {
    throw Error(fmt::format("'{}': the scene has no splitting '{}'; leave '@{}' out", name, over, over));
  }
  if (over == plain_name && !scene.system && !is_plain(scene) && !may_be_joined(scene)) {
    throw Error(fmt::format("'{}': '{}' has parts that are not forces; leave '@{}' out", name, own_name, over));
  }
  const MethodInfo* info = scene.parts->find_method(method);
  const Scheme* scheme = schemes::find(method);
  if (info == nullptr && scheme == nullptr && !is_word(method)) {
    throw Error(fmt::format("unknown method '{}'{}", method,
                            proposal(method, scene.parts->method_names(), "; see `noether list methods`")),
                {.value = method});
  }
  if (info != nullptr && scheme == nullptr) {
    const bool own = info->name == scene.integrator.method;
    const bool adaptive = own ? scene.integrator.adaptive() : info->adaptive;
    const Candidate who = make(scene, std::string(info->name), false, adaptive);
    if (const std::string why = refusal(scene, who); !why.empty()) throw Error(why);
    return who;
  }
  const std::string full = scheme != nullptr ? std::string(scheme->name) : method;
  std::vector<bool> ways = {over == plain_name && may_be_joined(scene)};
  if (over.empty() && may_be_joined(scene)) ways.push_back(true);
  std::string why;
  for (const bool joined : ways) {
    const Candidate who = make(scene, full, joined, false);
    const std::string refused = refusal(scene, who);
    if (refused.empty()) return who;
    if (why.empty()) why = refused;
  }
  throw Error(why);
}

namespace {
/// Whether a scene's own method is `verlet` over a basic word that begins with drifts, by either of its names.
bool is_verlet_of_drifts(const Scene& scene) {
  const std::string& own = scene.integrator.method;
  return (own == "verlet" || own == "verlet_aba") && scene.hamiltonian.splitting.claims().basic == "ABA";
}
}  // namespace

std::vector<Candidate> default_opponents(const Scene& scene) {
  std::vector<std::string> names = {scene.integrator.method};
  const bool split = may_be_joined(scene);
  if (scene.particles.size() == 0) {
    names.insert(names.end(), {"rk4", "dormand_prince_5", "dop853", "gauss_8", "gauss_radau_15", "adams_pece",
                               "trapezoidal", "sdirk_4", "rodas_4", "rodas_5p", "bdf", "galerkin_gauss_4", "magnus_6"});
  } else {
    if (split) names.insert(names.end(), {"aba_10_6_4", "verlet_aba", "verlet@" + plain(scene).info.name});
    if (!split) {
      if (!is_verlet_of_drifts(scene)) names.emplace_back("verlet");
      names.emplace_back("yoshida_4");
    }
    const std::string plainly = split || is_plain(scene) ? "@" + plain(scene).info.name : "";
    for (const char* name : {"blanes_moan_s6", "srkn14a", "kahan_li_8_s17"}) names.push_back(name + plainly);
    const bool liquid = scene.particles.box().is_periodic() || scene.particles.size() > most_bodies;
    if (liquid) {  // the others are for few bodies and errors near rounding
      names.insert(names.end(), {"rk4", "dop853"});
    } else {
      names.insert(names.end(), {"rk4", "dormand_prince_5", "dop853", "gauss_8", "gauss_radau_15",
                                 "gragg_bulirsch_stoer", "stormer_cowell_13"});
      if (has_bodies(scene.particles)) names.emplace_back("rkmk_dop853");
    }
  }
  return those_that_serve(scene, names);
}

std::vector<Candidate> opponents_below_rounding(const Scene& scene) {
  std::vector<std::string> names;
  for (const MethodInfo* info : methods::all()) {
    if (make_method<double>(*info, {})->claims().second_words) names.emplace_back(info->name);
  }
  return those_that_serve(scene, names);
}

Scene variant(const Scene& scene, const Candidate& who, const Setting& setting) {
  Scene made = scene;
  made.watches.clear();
  made.stops.clear();
  if (who.joined) join_parts(made);
  SceneIntegrator& integrator = made.integrator;
  const bool own = who.method == scene.integrator.method;
  const std::optional<MethodChoice> before = std::exchange(integrator.classical, std::nullopt);
  integrator.method = who.method;
  integrator.step = who.adaptive ? 0 : setting.step;
  integrator.steps.reset();
  integrator.until.reset();
  if (scene.particles.size() == 0 && scene.parts->find_method(who.method) == nullptr) {
    throw Error(
        fmt::format("'{}' splits a Hamiltonian, but a first-order system has none; use a method for y' = f, "
                    "such as 'dop853' or 'rodas_5p'",
                    who.method));
  }
  if (!own || who.joined) integrator.composition = integrator.composition.as_written();
  if (const Scheme* scheme = schemes::find(who.method)) {
    integrator.scheme = *scheme;
  } else if (const MethodInfo* info = scene.parts->find_method(who.method)) {
    if (!scene.hamiltonian.constraints.empty()) {
      throw Error(fmt::format("method '{}' does not support constraints; use a splitting scheme, such as 'verlet'",
                              who.method));
    }
    MethodOptions options;
    if (own && before) options = before->options.without_error_control();
    if (who.adaptive) {
      if (scene.integrator.adaptive()) options.max_step = scene.integrator.classical->options.max_step;
      options.rtol = setting.tolerance;
      options.atol = absolute_tolerance(scene, setting.tolerance);
    } else if (info->adaptive) {
      options.adaptive = false;
    }
    integrator.classical = MethodChoice{info, options};
    integrator.composition = {};
  } else {
    integrator.scheme = word(who.method);
  }
  return made;
}

std::optional<double> absolute_tolerance(const Scene& scene, double relative) {
  double ratio = 1e-3;
  const bool given = scene.integrator.adaptive() && scene.integrator.classical->options.atol.value_or(0) > 0;
  if (!scene.system && !given) return {};
  if (scene.integrator.adaptive()) {
    const MethodOptions own = scene.integrator.classical->resolved();
    const double rtol = *own.rtol, atol = *own.atol;
    if (rtol > 0 && atol > 0) ratio = atol / rtol;
  }
  return ratio * relative;
}

double evaluations_per_step(const Scene& scene, const Candidate& who, double step, double* spent) {
  if (who.adaptive) return 0;
  // Multistep methods start in other ways, and implicit ones do not always take as many iterations.
  const MethodInfo* info = scene.parts->find_method(who.method);
  const bool the_same = info == nullptr || info->family.starts_with("runge-kutta");
  const std::int64_t begin = the_same ? 1 : 20, count = the_same ? 2 : 20;
  Simulation<double> sim = assemble(variant(scene, who, {.step = step, .tolerance = 0}));
  const bool begun = sim.run(begin).ok();
  const std::int64_t before = sim.evaluations().force;
  const bool ok = begun && sim.run(count).ok();
  const std::int64_t all = sim.evaluations().force;
  if (spent != nullptr) *spent += static_cast<double>(all);
  return ok ? static_cast<double>(all - before) / static_cast<double>(count) : 0;
}

}  // namespace noether
