#include "study/turning_traits.hpp"

#include "engine/bodies.hpp"
#include "forces/external_fields.hpp"
#include "forces/on_sites.hpp"
#include "integrators/all_methods.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/lie/body_motion.hpp"
#include "integrators/rotating.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace noether {

namespace {

constexpr int until = 2;  // units of time
constexpr int kicks_in_a_unit = 60;

ParticleSystem<Quad> heavy_top() {
  ParticleSystem<double> s(unit_system("reduced"));
  add_body(s, top("top", 1, {2, 1, 2. / 3}, {0.2, 0.3, 0.5}), {.spin = Vec3<double>(0.6, -0.4, 0.9)});
  return s.as<Quad>();
}

ForceField<Quad> weight() {
  ForceField<Quad> on_site, on_top;
  on_site.add(UniformField{{0, 0, -1}});
  on_top.add(OnSites<Quad>(std::move(on_site)));
  return on_top;
}

/// A scheme over the top. @throws SchemeMismatch  where it cannot be
Composition<AnyHamiltonian<Quad>> over_turns(const Scheme& scheme, Rotor rotor) {
  return {AnyHamiltonian<Quad>(Rotating<AnyHamiltonian<Quad>>(
              AnyHamiltonian<Quad>(KineticPotential<ForceField<Quad>, Quad>(weight())), {.rotor = rotor})),
          scheme};
}

/// A method on the group of the top, with steps of one length.
Classical<Quad> on_group(const MethodInfo& info) {
  MethodOptions options;
  if (info.adaptive) options.adaptive = false;
  return {std::make_unique<BodyMotion<Quad>>(weight()), {&info, options}};
}

/// The orientation of the top at the end, as a matrix.
template <class Integrator> Mat3<Quad> turned(Integrator along, int steps) {
  ParticleSystem<Quad> s = heavy_top();
  s.clock() = Clock<Quad>::fixed(0, static_cast<double>(until) / steps);
  along.bind(s);
  along.advance(s, {.steps = steps});
  ParticleSystem<Quad> settled = s;
  along.settle(s, settled, {}, {}, true);
  return rotation_matrix<Quad>(std::as_const(settled).column<BodyOrientation>()[0]);
}

double apart(const Mat3<Quad>& a, const Mat3<Quad>& b) {
  double most = 0;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) most = std::max(most, static_cast<double>(abs(a(i, k) - b(i, k))));
  }
  return most;
}

template <class Integrator> void measure(MeasuredTurns& turns, const Integrator& along, const Mat3<Quad>& truth) {
  turns.order = std::log2(apart(turned(along, 16 * until), truth) / apart(turned(along, 32 * until), truth));
  const double steps = until * kicks_in_a_unit / turns.kicks;
  turns.error = apart(turned(along, std::max(1, static_cast<int>(std::lround(steps)))), truth);
}

}  // namespace

std::string_view MeasuredTurns::turns() const { return rotor ? rotor_name(*rotor) : "exponential"; }

std::vector<MeasuredTurns> measured_turns() {
  const Mat3<Quad> truth = turned(over_turns(*schemes::find("kahan_li_10_s33"), Rotor::exact), 128);
  std::vector<MeasuredTurns> all;
  for (const Rotor rotor : {Rotor::exact, Rotor::axes, Rotor::variational}) {
    for (const Scheme* scheme : schemes::all()) {
      // Compositions of the discrete body are as those of turns axis by axis.
      if (rotor == Rotor::variational && scheme->rotor != rotor_name(rotor)) continue;
      try {
        const auto along = over_turns(*scheme, rotor);
        all.push_back({.method = std::string(scheme->name), .rotor = rotor, .claimed_order = along.claims().order});
        all.back().kicks = scheme->evaluations();
        measure(all.back(), along, truth);
      } catch (const SchemeMismatch&) {
        continue;  // it needs other parts, or exact ones
      }
    }
  }
  for (const MethodInfo* info : methods::all()) {
    if (!info->on_groups || !info->fixed) continue;
    all.push_back({.method = std::string(info->name), .claimed_order = info->order});
    all.back().kicks = info->evaluations;
    measure(all.back(), on_group(*info), truth);
  }
  return all;
}

std::string turning_section(const std::vector<MeasuredTurns>& measured) {
  std::string section =
      "\n## turns of rigid bodies\n\n"
      "Schemes over turns and kicks of a heavy top of three different moments, and methods on its group, in 113 bits: "
      "the\n"
      "order of the error of its orientation between steps of 1/16 and 1/32, kicks per step, and the error at t = 2 "
      "with\n"
      "about 60 kicks in a unit of time. Exact turns serve every scheme, turns axis by axis those that take a part of\n"
      "order 2; methods on groups turn by exponentials.\n\n"
      "| method | rotor | order | kicks | error |\n|---|---|---|---|---|\n";
  for (const MeasuredTurns& one : measured) {
    const double whole = std::round(one.order);
    const std::string order =
        std::abs(one.order - whole) < 0.35 ? fmt::format("{:.0f}", whole) : fmt::format("{:.1f}", one.order);
    section +=
        fmt::format("| {} | {} | {} | {:.0f} | {:.1e} |\n", one.method, one.turns(), order, one.kicks, one.error);
  }
  return section;
}

}  // namespace noether
