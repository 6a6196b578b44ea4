#include "study/turning_traits.hpp"

#include "engine/bodies.hpp"
#include "forces/external_fields.hpp"
#include "forces/on_sites.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/rotating.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

/// A scheme over the top. @throws SchemeMismatch  where it cannot be
Composition<AnyHamiltonian<Quad>> over_turns(const Scheme& scheme, Rotor rotor) {
  ForceField<Quad> on_site, on_top;
  on_site.add(UniformField{{0, 0, -1}});
  on_top.add(OnSites<Quad>(std::move(on_site)));
  return {AnyHamiltonian<Quad>(Rotating<AnyHamiltonian<Quad>>(
              AnyHamiltonian<Quad>(KineticPotential<ForceField<Quad>, Quad>(std::move(on_top))), {.rotor = rotor})),
          scheme};
}

/// The orientation of the top at the end, as a matrix.
Mat3<Quad> turned(const Scheme& scheme, Rotor rotor, int steps) {
  auto along = over_turns(scheme, rotor);
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

}  // namespace

std::vector<MeasuredTurns> measured_turns() {
  const Mat3<Quad> truth = turned(*schemes::find("kahan_li_10_s33"), Rotor::exact, 128);
  std::vector<MeasuredTurns> all;
  for (const Rotor rotor : {Rotor::exact, Rotor::axes, Rotor::variational}) {
    for (const Scheme* scheme : schemes::all()) {
      // Compositions of the discrete body are as those of turns axis by axis.
      if (rotor == Rotor::variational && scheme->rotor != rotor_name(rotor)) continue;
      try {
        const auto along = over_turns(*scheme, rotor);
        MeasuredTurns turns{.method = std::string(scheme->name), .rotor = rotor, .claimed_order = along.claims().order};
        turns.kicks = scheme->evaluations();
        const double coarse = apart(turned(*scheme, rotor, 16 * until), truth),
                     fine = apart(turned(*scheme, rotor, 32 * until), truth);
        turns.order = std::log2(coarse / fine);
        const double steps = until * kicks_in_a_unit / turns.kicks;
        turns.error = apart(turned(*scheme, rotor, std::max(1, static_cast<int>(std::lround(steps)))), truth);
        all.push_back(turns);
      } catch (const SchemeMismatch&) {
        continue;  // it needs other parts, or exact ones
      }
    }
  }
  return all;
}

std::string turning_section(const std::vector<MeasuredTurns>& measured) {
  std::string section =
      "\n## turns of rigid bodies\n\n"
      "Schemes over turns and kicks of a heavy top of three different moments, in 113 bits: the order of the error of\n"
      "its orientation between steps of 1/16 and 1/32, kicks per step, and the error at t = 2 with about 60 kicks in "
      "a\n"
      "unit of time. Exact turns serve every scheme, turns axis by axis those that take a part of order 2.\n\n"
      "| method | rotor | order | kicks | error |\n|---|---|---|---|---|\n";
  for (const MeasuredTurns& one : measured) {
    const double whole = std::round(one.order);
    const std::string order =
        std::abs(one.order - whole) < 0.35 ? fmt::format("{:.0f}", whole) : fmt::format("{:.1f}", one.order);
    section += fmt::format("| {} | {} | {} | {:.0f} | {:.1e} |\n", one.method, rotor_name(one.rotor), order, one.kicks,
                           one.error);
  }
  return section;
}

}  // namespace noether
