#include "study/method_traits.hpp"

#include "study/stability_limit.hpp"
#include "study/trait_problems.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace noether {

namespace {

using traits::Walk;

using State = std::array<Quad, 4>;  ///< (x, y, u, v) of a particle in the plane

constexpr int some_steps = 24;  ///< beyond the start of every method with a past

ParticleSystem<Quad> particle_at(const State& z) {
  ParticleSystem<Quad> s = traits::one_particle(0, 0, 0, 0).as<Quad>();
  s.positions().set(0, Vec3<Quad>(z[0], z[1], Quad(0)));
  s.velocities().set(0, Vec3<Quad>(z[2], z[3], Quad(0)));
  return s;
}
State state_of(const ParticleSystem<Quad>& s) {
  const Vec3<Quad> x = s.positions()[0], v = s.velocities()[0];
  return {x[0], x[1], v[0], v[1]};
}
State start() { return {Quad(0.12), Quad(0.1), Quad(0.2), Quad(0.15)}; }
/// With more energy: what is not linear counts more in the errors.
State lively_start() { return {Quad(0.1), Quad(0.05), Quad(0.3), Quad(0.4)}; }

double distance(const State& a, const State& b) {
  double worst = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double difference = std::abs(static_cast<double>(a[k] - b[k]));
    if (!std::isfinite(difference)) return std::numeric_limits<double>::infinity();
    worst = std::max(worst, difference);
  }
  return worst;
}

/// Where a method is after some steps in the well; empty if it cannot make them.
std::optional<State> walked(const KnownMethod& known, const State& from, double h, std::int64_t steps) {
  Walk<Quad> walk(traits::integrator_of<Quad>(known, HenonHeiles{}), particle_at(from), h);
  if (!walk.go(steps)) return std::nullopt;
  return state_of(walk.particles());
}

constexpr double duration = 6;

/// Where a method with steps of its own is at t = 6, and the forces it took.
std::pair<State, double> travelled(const MethodInfo& info, const State& from, double tolerance) {
  const auto method = make_method<Quad>(info, {.rtol = tolerance, .atol = tolerance});
  ForceMotion<ForceField<Quad>, Quad> f(traits::field_of<Quad>(HenonHeiles{}));
  ParticleSystem<Quad> s = particle_at(from);
  f.bind(s);
  method->bind(f);
  Vector<Quad> y, slope;
  f.gather(s, y);
  Quad t(0);
  while (static_cast<double>(Quad(duration) - t) > 1e-14) {
    const StepResult made = method->step(f, t, y, static_cast<double>(Quad(duration) - t));
    if (made.failure) throw Error(made.failure->message);
    t += Quad(made.h);
  }
  const auto work = static_cast<double>(f.evaluations().force);
  // Steps are doubles: less than an ulp of them is left, and the tangent is as good as any method.
  f.rate(t, y, slope);
  f.scatter(y + (Quad(duration) - t) * slope, s);
  return {state_of(s), work};
}

/// The well at t = 6 from one of two starts, to more than 28 digits, by extrapolation.
const State& truth(bool lively) {
  const auto find = [](const State& from) {
    return travelled(*methods::find("gragg_bulirsch_stoer"), from, 1e-32).first;
  };
  static const State ends[2] = {find(start()), find(lively_start())};
  return ends[lively ? 1 : 0];
}

struct Rung {
  double x, error;  ///< step or work, and the error made with it
};

/// Slope of log(error) over log(x) by least squares.
double slope_of(const std::vector<Rung>& rungs) {
  const auto n = static_cast<double>(rungs.size());
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const Rung& rung : rungs) {
    const double u = std::log(rung.x), w = std::log(rung.error);
    x += u, y += w, xx += u * u, xy += u * w;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// Below it the digits of a table show: it breaks the conditions of its order by its last digit.
double floor_of(const KnownMethod& known) { return std::pow(10.0, 3 - std::min(known.printed_digits(), 26)); }

/// Errors over a ladder of 6, 8, 12, 16, 24, ... steps, the finest three above the floor; fewer if there are not so
/// many.
std::vector<Rung> finest_rungs(const KnownMethod& known, bool lively) {
  std::vector<Rung> rungs;
  for (std::int64_t n = 6; n <= 1024; n = n % 3 == 0 ? n / 3 * 4 : n / 2 * 3) {
    const double h = duration / static_cast<double>(n);
    const std::optional<State> end = walked(known, lively ? lively_start() : start(), h, n);
    const double error = end ? distance(*end, truth(lively)) : std::numeric_limits<double>::infinity();
    if (error < floor_of(known)) break;
    if (error < 0.1) rungs.push_back({h, error});
  }
  if (rungs.size() > 3) rungs.erase(rungs.begin(), rungs.end() - 3);
  return rungs;
}

/// The smaller slope of two orbits: an order is what holds for all of them. Empty if there are too few rungs.
std::optional<double> measured_order(const KnownMethod& known) {
  std::optional<double> order;
  for (const bool lively : {false, true}) {
    const std::vector<Rung> rungs = finest_rungs(known, lively);
    if (rungs.size() < 3) return std::nullopt;
    const double slope = slope_of(rungs);
    order = order ? std::min(*order, slope) : slope;
  }
  return order;
}

/// p of error ~ evaluations^-p, for methods whose steps are their own: between tolerances of 1e-9 and 1e-13.
double work_exponent(const MethodInfo& info) {
  std::vector<Rung> rungs;
  for (const double rtol : {1e-9, 1e-10, 1e-11, 1e-12, 1e-13}) {
    const auto [end, work] = travelled(info, lively_start(), rtol);
    rungs.push_back({work, distance(end, truth(true))});
  }
  return -slope_of(rungs);
}

/// Forces a step after the start, if every step costs the same, at two lengths of the step.
std::optional<double> measured_evaluations(const KnownMethod& known) {
  std::optional<std::int64_t> each;
  for (const double h : {0.01, 0.25}) {
    Walk<Quad> walk(traits::integrator_of<Quad>(known, HenonHeiles{}), particle_at(start()), h);
    if (!walk.go(some_steps)) return std::nullopt;
    for (int n = 0; n < 8; ++n) {
      const std::int64_t before = walk.evaluations();
      if (!walk.go(1)) return std::nullopt;
      const std::int64_t made = walk.evaluations() - before;
      if (each && *each != made) return std::nullopt;
      each = made;
    }
  }
  return static_cast<double>(*each);
}

/// Largest entry of M^T J M - J, M the Jacobian of some steps, by central differences of the fourth order.
double symplectic_defect(const KnownMethod& known, double h) {
  const double d = 1e-7;
  std::array<State, 4> m{};  // m[k]: derivative along coordinate k
  for (std::size_t k = 0; k < 4; ++k) {
    const auto moved = [&](double by) {
      State z = start();
      z[k] += Quad(by);
      return walked(known, z, h, some_steps);
    };
    const auto a = moved(-2 * d), b = moved(-d), c = moved(d), e = moved(2 * d);
    if (!a || !b || !c || !e) return std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 4; ++i) {
      m[k][i] = ((*a)[i] - Quad(8) * (*b)[i] + Quad(8) * (*c)[i] - (*e)[i]) / (Quad(12) * Quad(d));
    }
  }
  double worst = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t l = 0; l < 4; ++l) {
      const Quad area = m[k][0] * m[l][2] - m[k][2] * m[l][0] + m[k][1] * m[l][3] - m[k][3] * m[l][1];
      const Quad exact = l == k + 2 ? Quad(1) : k == l + 2 ? Quad(-1) : Quad(0);
      worst = std::max(worst, std::abs(static_cast<double>(area - exact)));
    }
  }
  return worst;
}

/// How far a run with its velocities turned ends from where it began.
double way_back(const KnownMethod& known, double h) {
  const auto turned = [](State z) {
    z[2] = -z[2], z[3] = -z[3];
    return z;
  };
  const auto there = walked(known, start(), h, some_steps);
  const auto back = there ? walked(known, turned(*there), h, some_steps) : std::nullopt;
  return back ? distance(turned(*back), start()) : std::numeric_limits<double>::infinity();
}

/// Relative changes of momentum and angular momentum of three bodies over some steps.
std::pair<double, double> momenta_lost(const KnownMethod& known, double h) {
  struct Sums {
    Vec3<Quad> p = Vec3<Quad>::Zero(), l = Vec3<Quad>::Zero();
    Quad p_scale = Quad(0), l_scale = Quad(0);
  };
  const auto sums = [](const ParticleSystem<Quad>& s) {
    Sums made;
    for (Index i = 0; i < s.size(); ++i) {
      const Vec3<Quad> x = s.positions()[i], p = s.masses()[i] * Vec3<Quad>(s.velocities()[i]), l = cross(x, p);
      made.p += p, made.l += l;
      made.p_scale += sqrt(norm2(p)), made.l_scale += sqrt(norm2(x) * norm2(p));
    }
    return made;
  };
  Walk<Quad> walk(traits::integrator_of<Quad>(known, Gravity{.G = 1}), traits::three_bodies().as<Quad>(), h);
  const Sums before = sums(walk.particles());
  if (!walk.go(some_steps)) return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const Sums after = sums(walk.particles());
  return {static_cast<double>(sqrt(norm2(Vec3<Quad>(after.p - before.p))) / before.p_scale),
          static_cast<double>(sqrt(norm2(Vec3<Quad>(after.l - before.l))) / before.l_scale)};
}

/// Largest energy errors, relative, of the first and the last eighth of many periods. Not finite where it escapes.
std::pair<double, double> energy_errors(const KnownMethod& known, double h) {
  Walk<Quad> walk(traits::integrator_of<Quad>(known, HenonHeiles{}), particle_at(start()), h);
  const Quad before = walk.energy();
  const auto steps = static_cast<std::int64_t>(std::ceil(628 / h)), eighth = steps / 8, looks = std::int64_t{128};
  const std::pair<double, double> lost(0, std::numeric_limits<double>::infinity());
  std::array<double, 8> worst{};
  for (auto& largest : worst) {
    for (std::int64_t n = 0; n < looks; ++n) {
      if (!walk.go(eighth * (n + 1) / looks - eighth * n / looks)) return lost;
      const double error = std::abs(static_cast<double>(walk.energy() / before - Quad(1)));
      if (!(error < 0.5)) return lost;
      largest = std::max(largest, error);
    }
  }
  return {worst[0], worst[7]};
}

/// Steps long enough to show what a method loses, but well within its stability.
double long_step(int order, const std::optional<StabilityLimit>& limit) {
  const double wanted = order >= 12 ? 1.0 : order >= 8 ? 0.5 : 0.25;
  return limit && limit->z > 0 ? std::min(wanted, limit->z / 3) : wanted;
}

/// Whether a method chooses its steps if it is let: lengths of its first ones, asked for ten units of time.
bool chooses_steps(const MethodInfo& info) {
  const auto method = make_method<double>(info, {});
  ForceMotion<ForceField<double>, double> f(traits::field_of<double>(HenonHeiles{}));
  ParticleSystem<double> s = traits::one_particle(0.12, 0.1, 0.2, 0.15);
  f.bind(s);
  method->bind(f);
  Vector<double> y;
  f.gather(s, y);
  double t = 0, shortest = 10, longest = 0;
  for (int n = 0; n < 8; ++n) {
    const StepResult made = method->step(f, t, y, 10);
    if (made.failure) return false;
    t += made.h;
    shortest = std::min(shortest, made.h), longest = std::max(longest, made.h);
  }
  return longest < 10 && shortest < longest;
}

std::string text_of(const std::optional<double>& x) { return x ? fmt::format("{:.4g}", *x) : "nothing"; }
}  // namespace

std::string_view text_of(EnergyError energy) {
  return energy == EnergyError::kept ? "kept" : energy == EnergyError::bounded ? "bounded" : "drifts";
}

MethodTraits claimed_traits(const KnownMethod& known) {
  const bool in_quad = known.info == nullptr || known.info->make_quad != nullptr;
  const IntegratorClaims claims = in_quad ? traits::integrator_of<Quad>(known, Gravity{.G = 1}).claims()
                                          : traits::integrator_of<double>(known, Gravity{.G = 1}).claims();
  MethodTraits traits;
  traits.order = claims.order;
  traits.symplectic = claims.symplectic;
  traits.reversible = claims.reversible;
  traits.momentum = claims.keeps_momentum;
  traits.angular_momentum = claims.keeps_angular_momentum;
  // Of a regular orbit: near-by integrals exist for symplectic maps, and for reversible ones too.
  // Methods for gravity alone are Gauss's, but for errors far below those of their steps.
  // Tao's is symplectic in twice the dimensions, near the motion that is shown.
  const bool nearly = known.info != nullptr && (known.info->gravity_only || known.info->name.starts_with("tao_"));
  const bool bounded = claims.symplectic || claims.reversible || nearly;
  traits.energy = claims.energy_exact ? EnergyError::kept : bounded ? EnergyError::bounded : EnergyError::drifts;
  const double limit = known.scheme != nullptr ? known.scheme->stability_limit : known.info->stability_limit;
  if (!std::isnan(limit)) traits.stability_limit = limit;
  if (known.scheme != nullptr) {
    traits.evaluations = known.scheme->evaluations();
  } else {
    if (known.info->evaluations > 0) traits.evaluations = known.info->evaluations;
    traits.fixed_steps = known.info->fixed;
    traits.own_steps = known.info->adaptive;
  }
  return traits;
}

MethodTraits measured_traits(const KnownMethod& known) {
  if (known.info != nullptr && known.info->gravity_only) return measured_gravity_traits(known);
  MethodTraits traits;
  const bool fixed = traits::integrator_of<Quad>(known, HenonHeiles{}).claims().clock == ClockMode::fixed;
  traits.fixed_steps = fixed;
  traits.own_steps = known.info != nullptr && chooses_steps(*known.info);
  traits.order = fixed ? measured_order(known) : work_exponent(*known.info);
  if (fixed) traits.evaluations = measured_evaluations(known);
  const std::optional<StabilityLimit> limit = stability_limit_of(known);
  if (limit) {
    traits.stability_limit = limit->z;
    traits.limit_of_iteration = limit->of_iteration;
  }
  const double h = long_step(static_cast<int>(std::lround(traits.order.value_or(2))), limit);
  const auto [momentum, angular] = momenta_lost(known, std::min(h, traits.order.value_or(2) < 3.5 ? 0x1p-5 : 0.25));
  traits.momentum = momentum < 1e-29;
  traits.angular_momentum = angular < 1e-29;
  traits.symplectic = symplectic_defect(known, h) < 1e-22;
  traits.reversible = way_back(known, h) < 1e-29;
  const auto [early, late] = energy_errors(known, h);
  traits.energy = late < 1e-28 ? EnergyError::kept : late < 1.5 * early ? EnergyError::bounded : EnergyError::drifts;
  return traits;
}

MeasuredMethod measured_method(const KnownMethod& known) {
  MeasuredMethod made{
      .name = std::string(known.name()), .measured = measured_traits(known), .claimed = claimed_traits(known)};
  if (known.scheme != nullptr) {
    made.family = "splitting";
    made.use = known.scheme->use;
    made.highest_order = known.scheme->order.classical;
  } else {
    made.family = known.info->family;
    made.use = known.info->use.empty() ? known.info->summary : known.info->use;
    made.highest_order = known.info->order;
  }
  return made;
}

std::vector<std::string> MeasuredMethod::differences() const {
  std::vector<std::string> found;
  const auto check = [&](bool same, std::string_view cell, const std::string& claim, const std::string& fact) {
    if (!same) found.push_back(fmt::format("{}: claims {}, measured {}", cell, claim, fact));
  };
  const auto flag = [&](bool claim, bool fact, std::string_view cell) {
    check(claim == fact, cell, claim ? "yes" : "no", fact ? "yes" : "no");
  };
  const MethodTraits &c = claimed, &m = measured;
  const double p = m.order.value_or(0);
  // The work exponent of a method that varies its order lies below the highest of them, and above a third.
  check(m.fixed_steps ? std::abs(p - *c.order) < 0.35 : p < *c.order + 0.35 && p > *c.order / 3, "order",
        text_of(c.order), text_of(m.order));
  check(c.evaluations == m.evaluations || !m.fixed_steps, "evaluations", text_of(c.evaluations),
        text_of(m.evaluations));
  flag(c.symplectic, m.symplectic, "symplectic");
  flag(c.reversible, m.reversible, "reversible");
  flag(c.momentum, m.momentum, "momentum");
  flag(c.angular_momentum, m.angular_momentum, "angular momentum");
  check(c.energy == m.energy, "energy", std::string(text_of(c.energy)), std::string(text_of(m.energy)));
  flag(c.fixed_steps, m.fixed_steps, "steps of one length");
  flag(c.own_steps, m.own_steps, "steps of its own");
  // Claims are those of the map; what its iteration cannot solve is measured only.
  const bool same_limit = !c.stability_limit || c.stability_limit == m.stability_limit ||
                          (std::isinf(*c.stability_limit) && m.limit_of_iteration) ||
                          (m.stability_limit && std::abs(*c.stability_limit - *m.stability_limit) < 5e-4);
  check(same_limit, "stability limit", text_of(c.stability_limit), text_of(m.stability_limit));
  return found;
}

}  // namespace noether
