/// Nothing is allocated inside `advance`, nor by settling a copy once its storage is there.

#include "engine/simulation.hpp"
#include "forces/bonded.hpp"
#include "forces/ewald.hpp"
#include "forces/external_fields.hpp"
#include "forces/gravity.hpp"
#include "forces/oblateness.hpp"
#include "forces/particle_mesh_ewald.hpp"
#include "forces/sum.hpp"
#include "integrators/all_schemes.hpp"
#include "integrators/classical.hpp"
#include "integrators/composition.hpp"
#include "integrators/damped.hpp"
#include "integrators/kinetic_potential.hpp"
#include "integrators/langevin.hpp"
#include "integrators/lie/body_motion.hpp"
#include "integrators/systems/weber.hpp"
#include "integrators/variational/discrete_lagrangian.hpp"
#include "integrators/variational/lagrangian_system.hpp"
#include "integrators/wisdom_holman.hpp"
#include "tests/allocation/watched.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charged_liquid.hpp"
#include "tests/support/mechanisms.hpp"
#include "tests/support/molecules.hpp"
#include "tests/support/planets.hpp"
#include "tests/support/rigid_bodies.hpp"
#include "tests/support/settings.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

std::atomic<std::size_t> noether::test::watched_bytes{0};
std::atomic<long> noether::test::watched_allocations{0};

namespace {
std::atomic<long> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  if (size == noether::test::watched_bytes) ++noether::test::watched_allocations;
  void* p = alignment > alignof(std::max_align_t)
                ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                : std::malloc(size > 0 ? size : 1);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}

/// Not inlined: g++ would see std::free of what operator new returned, and warn.
[[gnu::noinline]] void give_back(void* p) noexcept { std::free(p); }
}  // namespace

void* operator new(std::size_t size) { return counted(size, 0); }
void* operator new[](std::size_t size) { return counted(size, 0); }
void* operator new(std::size_t size, std::align_val_t a) { return counted(size, static_cast<std::size_t>(a)); }
void operator delete(void* p) noexcept { give_back(p); }
void operator delete[](void* p) noexcept { give_back(p); }
void operator delete(void* p, std::size_t /*size*/) noexcept { give_back(p); }
void operator delete[](void* p, std::size_t /*size*/) noexcept { give_back(p); }
void operator delete(void* p, std::align_val_t /*alignment*/) noexcept { give_back(p); }
void operator delete(void* p, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept { give_back(p); }

using namespace noether;

namespace {

constexpr double G = test::outer_G;

/// Allocations of 20 steps and of settling, after a first step.
template <class I>
std::pair<long, long> allocations_of(I integrator, ParticleSystem<double> s = test::outer_planets()) {
  s.clock() = Clock<double>::fixed(0, 30);
  integrator.bind(s);
  integrator.advance(s, {.steps = 1});
  ParticleSystem<double> copy = s;
  integrator.settle(s, copy, {.energy = true}, std::nullopt, true);
  const long start = allocations;
  integrator.advance(s, {.steps = 20});
  const long stepped = allocations;
  integrator.settle(s, copy, {.energy = true}, std::nullopt, true);
  return {stepped - start, allocations - stepped};
}

template <class I> void check_none(const I& integrator, const ParticleSystem<double>& s = test::outer_planets()) {
  const auto [stepping, settling] = allocations_of(integrator, s);
  CHECK(stepping == 0);
  CHECK(settling == 0);
}

/// A force that allocates: the count must see it.
struct Careless {
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    const std::vector<double> scratch(static_cast<std::size_t>(s.size()) + 100);
    out.energy(Real(scratch.back()));
  }
};

}  // namespace

TEST_CASE("nothing is allocated inside advance, nor by settling", "[allocation]") {
  for (const char* name : {"verlet", "yoshida_8", "aba_10_6_4"}) {
    const Scheme& scheme = *schemes::find(name);
    CAPTURE(name);
    check_none(compose(KineticPotential(Gravity{.G = G}), scheme));
    check_none(compose(KineticPotential(Gravity{.G = G}), scheme, {.compensated = true}));
    check_none(compose(WisdomHolman({.G = G}), scheme));
    ForceField forces;
    forces.add(Gravity{.G = G}).add(UniformField{.acceleration = {1e-9, 0, 0}});
    check_none(compose(AnyHamiltonian<double>(KineticPotential<ForceField<double>>{forces}), scheme));
    check_none(AnyIntegrator<double>(compose(WisdomHolman({.G = G}), scheme)));
  }
  for (const bool compensated : {false, true}) {
    check_none(compose(WisdomHolman({.G = G}), schemes::verlet_aba, {.compensated = compensated}),
               test::planets_with_tracers(30));
  }
  for (const Coordinates coordinates : {Coordinates::democratic, Coordinates::whds, Coordinates::barycentric}) {
    check_none(compose(WisdomHolman({.G = G, .coordinates = coordinates}), schemes::verlet_aba));
  }
  for (const StepKernel kernel : {StepKernel::plain, StepKernel::modified, StepKernel::composed, StepKernel::lazy}) {
    check_none(compose(WisdomHolman({.G = G}), schemes::verlet_aba, {.corrector = 17, .kernel = kernel}));
    check_none(compose(WisdomHolman<double, Oblateness>({.G = G}, {.J2 = 1e-7, .radius = 0.005}), schemes::verlet_aba,
                       {.corrector = 17, .kernel = kernel}));
  }
  ForceField slow;
  slow.add(UniformField{.acceleration = {1e-9, 0, 0}}).add(AnyForce<double>(Gravity{.G = G}).in_kick('C'));
  const AnyHamiltonian<double> nested(KineticPotential<ForceField<double>>{slow});
  for (const bool compensated : {false, true})
    check_none(compose(nested, schemes::respa, {.compensated = compensated, .inner_steps = {3}}));
  check_none(compose(Damped(KineticPotential(Gravity{.G = G}), {.rate = 1e-6}), schemes::verlet));
  const Langevin bath(KineticPotential(Gravity{.G = G}), {.temperature = 300, .friction = 1e-6});
  for (const char* letters : {"BAOAB", "OBABO"}) check_none(compose(bath, word(letters)));
}

TEST_CASE("bonded terms allocate nothing after their first evaluation", "[allocation]") {
  auto topology = std::make_shared<Topology>();
  topology->bond_kinds = {{"harmonic", {1e-9, 5}}};
  topology->angle_kinds = {{"harmonic", {1e-9, 2}}};
  topology->dihedral_kinds = {{"periodic", {1e-9, 3, 0}}};
  topology->bonds = {{{0, 1}, 0}, {{1, 2}, 0}, {{2, 3}, 0}};
  topology->angles = {{{0, 1, 2}, 0}};
  topology->dihedrals = {{{0, 1, 2, 3}, 0}};
  ParticleSystem<double> s = test::outer_planets();
  s.set_topology(topology);
  s.clock() = Clock<double>::fixed(0, 30);
  auto integrator = compose(KineticPotential(Bonded{}), schemes::yoshida_4);
  integrator.bind(s);
  integrator.advance(s, {.steps = 1});
  ParticleSystem<double> copy = s;
  const long start = allocations;
  CHECK(integrator.advance(s, {.steps = 20}).steps == 20);
  integrator.settle(s, copy, {.energy = true}, std::nullopt, true);
  CHECK(allocations == start);
}

TEST_CASE("sums over a lattice of charges allocate nothing after their first evaluation", "[allocation]") {
  ParticleSystem<double> s = test::with_special_pairs(test::charged_liquid(5));
  const auto check = [&](const auto& force) {
    auto integrator = compose(KineticPotential(AnyForce<double>(force)), schemes::verlet);
    ParticleSystem<double> moved = s;
    moved.clock() = Clock<double>::fixed(0, 1e-6);  // within one list of neighbors
    integrator.bind(moved);
    integrator.advance(moved, {.steps = 2});
    ParticleSystem<double> copy = moved;
    integrator.settle(moved, copy, {.energy = true, .virial = true}, std::nullopt, true);
    const long start = allocations;
    const Advance done = integrator.advance(moved, {.steps = 5});
    const long made = allocations - start;
    CHECK(done.steps == 5);
    CHECK(made == 0);
  };
  for (const int threads : {1, 3}) {
    const test::Threads count(threads);
    check(Ewald{.cutoff = 2.4, .relative_error = 1e-2});
    for (const PairPrecision precision : {PairPrecision::full, PairPrecision::mixed})
      check(ParticleMeshEwald{.cutoff = 2.4, .relative_error = 1e-3, .precision = precision});
  }
}

TEST_CASE("no classical method allocates inside advance", "[allocation]") {
  for (const MethodInfo* info : methods::all()) {
    for (const bool adaptive : {false, true}) {
      if (adaptive ? !info->adaptive : !info->fixed) continue;
      MethodOptions options;
      if (info->adaptive && info->fixed) options.adaptive = adaptive;
      auto integrator = classical(Gravity{.G = G}, method(info->name, options));
      ParticleSystem<double> s = test::outer_planets();
      s.clock() = adaptive ? Clock<double>::free(0) : Clock<double>::fixed(0, 20);
      integrator.bind(s);
      integrator.advance(s, {.steps = 20});  // the start of multistep methods among them
      const long start = allocations;
      const Advance done = integrator.advance(s, {.steps = 20});
      const long made = allocations - start;
      CAPTURE(info->name, adaptive);
      CHECK(done.steps == 20);
      CHECK(made == 0);
    }
  }
}

TEST_CASE("no method on a group allocates inside advance", "[allocation][lie]") {
  for (const char* name : {"rkmk_rk4", "rkmk_dop853", "crouch_grossman_4", "commutator_free_4"}) {
    const bool adaptive = methods::find(name)->adaptive;
    auto integrator = lie(test::weight_on_sites(), method(name));
    ParticleSystem<double> s = test::heavy_top();
    s.clock() = adaptive ? Clock<double>::free(0) : Clock<double>::fixed(0, 0.1);
    integrator.bind(s);
    integrator.advance(s, {.steps = 20});
    const long start = allocations;
    const Advance done = integrator.advance(s, {.steps = 20});
    const long made = allocations - start;
    CAPTURE(name);
    CHECK(done.steps == 20);
    CHECK(made == 0);
  }
}

/// A chain of pendulums between walls, by its action; and the midpoint rule over it as a user writes it.
struct PendulumChain {
  Index size() const { return 6; }
  std::vector<double> start() const { return {0.3, 0.1, -0.2, 0.4, 0.2, -0.1, 0, 0.2, 0.1, 0, -0.1, 0.3}; }
  template <class Real> Real lagrangian(const Real& /*t*/, const Vector<Real>& q, const Vector<Real>& v) const {
    using std::cos;
    Real sum(0);
    for (Index i = 0; i < q.size(); ++i) {
      sum += v[i] * v[i] / Real(2) + cos(q[i]);
      if (i > 0) sum -= (q[i] - q[i - 1]) * (q[i] - q[i - 1]) / Real(2);
    }
    return sum;
  }
};
struct OfPendulumChain {
  template <class Real> Real operator()(const Vector<Real>& q0, const Vector<Real>& q1, const Real& h) const {
    using std::cos;
    Real sum(0);
    for (Index i = 0; i < q0.size(); ++i) {
      const Real v = (q1[i] - q0[i]) / h, q = (q0[i] + q1[i]) / Real(2);
      sum += v * v / Real(2) + cos(q);
      if (i == 0) continue;
      const Real before = (q0[i - 1] + q1[i - 1]) / Real(2);
      sum -= (q - before) * (q - before) / Real(2);
    }
    return h * sum;
  }
};

TEST_CASE("no method over an action allocates inside advance", "[allocation][variational]") {
  std::vector<std::pair<std::string, Classical<double>>> all = {
      {"own", variational(PendulumChain{}, Variational{OfPendulumChain{}})}};
  for (const char* name : {"variational_midpoint", "galerkin_gauss_3", "galerkin_lobatto_4", "rk4"}) {
    all.emplace_back(name, variational(PendulumChain{}, method(name)));
  }
  const auto check = [](const std::string& name, Classical<double>& integrator, ParticleSystem<double> s) {
    s.clock() = Clock<double>::fixed(0, 0.1);
    integrator.bind(s);
    integrator.advance(s, {.steps = 5});
    const long before = allocations;
    const Advance done = integrator.advance(s, {.steps = 20});
    const long made = allocations - before;
    CAPTURE(name);
    CHECK(done.steps == 20);
    CHECK(made == 0);
  };
  for (auto& [name, integrator] : all) check(name, integrator, initial_state(PendulumChain{}));
  for (const char* name : {"weber_implicit", "weber_extrapolated", "variational_midpoint"}) {
    Classical<double> integrator = variational(Weber{}, method(name));
    check(name, integrator, initial_state(Weber{}));
  }
}

TEST_CASE("constraints allocate nothing inside advance, solved all at once or by sweeps", "[allocation][constraints]") {
  const auto check = [](const test::Mechanism& mechanism, const Scheme& scheme) {
    CAPTURE(scheme.name, static_cast<int>(mechanism.constraints.options().solver));
    auto integrator = compose(test::hamiltonian_of(mechanism), scheme);
    ParticleSystem<double> s = mechanism.particles;
    s.clock() = Clock<double>::fixed(0, 0.005);
    integrator.bind(s);
    integrator.advance(s, {.steps = 1});
    ParticleSystem<double> copy = s;
    integrator.settle(s, copy, {.energy = true}, std::nullopt, true);
    const long start = allocations;
    CHECK(integrator.advance(s, {.steps = 20}).steps == 20);
    integrator.settle(s, copy, {.energy = true}, std::nullopt, true);
    CHECK(allocations == start);
  };
  for (const ConstraintMethod solver :
       {ConstraintMethod::newton, ConstraintMethod::rattle, ConstraintMethod::m_shake, ConstraintMethod::p_shake}) {
    for (const Scheme* scheme : {&schemes::verlet, &schemes::yoshida_4}) {
      check(test::hanging_chain(40, {.solver = solver}), *scheme);
      check(test::molecular_liquid(2, 4.0, {.solver = solver}), *scheme);
    }
  }
}

TEST_CASE("a force that allocates is seen by the count", "[allocation]") {
  CHECK(allocations_of(compose(KineticPotential(Careless{}), schemes::verlet)).first >=
        19);  // settling shares one evaluation
}

TEST_CASE("energies in 113 bits keep what they work with", "[allocation]") {
  auto integrator = classical(Gravity{.G = G}, method("encke_gauss_8"));
  ParticleSystem<double> s = test::outer_planets();
  s.clock() = Clock<double>::fixed(0, 200);
  integrator.bind(s);
  integrator.advance(s, {.steps = 5});
  const auto first = integrator.wide_energy(s);
  const long start = allocations;
  const auto second = integrator.wide_energy(s);
  CHECK(allocations == start);
  REQUIRE((first && second));
  CHECK((first->total() == second->total()));
}
