/// Optional members that are nearly right are found, so that the seams can refuse them.

#include "engine/any_force.hpp"
#include "engine/monitor.hpp"
#include "forces/bonded.hpp"
#include "forces/gravity.hpp"
#include "forces/sum.hpp"
#include "integrators/kinetic_potential.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"

#include <string>

namespace noether {
namespace {

struct Push {
  template <class Real> void add_to(ForceSink<Real>&, const ParticleSystem<Real>&) const {}
};
struct ClaimsOfParticles : Push {
  static ForceClaims claims(const ParticleSystem<double>&) { return {}; }
};
struct OtherClaims : Push {
  static IntegratorClaims claims() { return {}; }
};
struct FieldOfClaims : Push {
  ForceClaims claims;
};
struct CheckOfNumber : Push {
  void check(int) const {}
};
struct SecantOfOneState : Push {
  void add_secant_to(ForceSink<double>&, const ParticleSystem<double>&) const {}
};

struct Climas : Push {
  static ForceClaims climas() { return {}; }
};
struct Refernece : Push {
  template <class Real> Push refernece(Real /*any*/) const { return {}; }
};

struct Watch {
  void observe(const Snapshot<double>&) {}
};
struct ChangingReport : Watch {
  MonitorReport report() { return {}; }  // not const
};
struct Reprot : Watch {
  MonitorReport reprot() const { return {}; }
};
struct FinishOfNothing : Watch {
  void finish() {}
};

/// As far as members are looked for.
struct Flows {
  using real = double;
};
struct VirialOfNothing : Flows {
  Mat3<double> virial() { return Mat3<double>::Zero(); }
};
struct Viriel : Flows {
  Mat3<double> viriel(const ParticleSystem<double>&) { return Mat3<double>::Zero(); }
};
struct ProjectsWithoutTime : Flows {
  void project_velocities(ParticleSystem<double>&) {}
};
struct ActionInWords : Flows {
  std::string has_action() const { return "yes"; }
};
struct GoesOnFromItself : Flows {
  void go_on_from(ParticleSystem<double>&) {}
};
struct GoesOnFrom : Flows {
  void goes_on_from(const ParticleSystem<double>&, ParticleSystem<double>&) {}
};

}  // namespace

TEST_CASE("an optional member of a Hamiltonian or an integrator that is nearly right is found", "[engine][members]") {
  using detail::HamiltonianMembers, detail::IntegratorMembers;
  using Whole = KineticPotential<ForceField<double>>;
  STATIC_REQUIRE(HamiltonianMembers<Flows>::virial);
  STATIC_REQUIRE_FALSE(HamiltonianMembers<VirialOfNothing>::virial);
  STATIC_REQUIRE_FALSE(HamiltonianMembers<Viriel>::virial);
  STATIC_REQUIRE(HamiltonianMembers<Viriel>::project_velocities);
  STATIC_REQUIRE_FALSE(HamiltonianMembers<ProjectsWithoutTime>::project_velocities);
  STATIC_REQUIRE(detail::finds_virial<Whole>());
  STATIC_REQUIRE(HamiltonianMembers<Whole>::virial);
  STATIC_REQUIRE(HamiltonianMembers<Whole>::project_velocities);
  STATIC_REQUIRE(IntegratorMembers<Flows>::has_action);
  STATIC_REQUIRE_FALSE(IntegratorMembers<ActionInWords>::has_action);
  STATIC_REQUIRE_FALSE(IntegratorMembers<VirialOfNothing>::virial);
  STATIC_REQUIRE(IntegratorMembers<Flows>::go_on_from);
  STATIC_REQUIRE_FALSE(IntegratorMembers<GoesOnFromItself>::go_on_from);
  STATIC_REQUIRE_FALSE(IntegratorMembers<GoesOnFrom>::go_on_from);
}

TEST_CASE("an optional member whose name is misspelt is found", "[engine][members]") {
  STATIC_REQUIRE_FALSE(detail::ForceMembers<Climas>::claims);
  STATIC_REQUIRE_FALSE(detail::ForceMembers<Refernece>::reference);
  STATIC_REQUIRE(detail::ForceMembers<Climas>::check);
  STATIC_REQUIRE_FALSE(detail::MonitorMembers<Reprot>::report);
  STATIC_REQUIRE(detail::MonitorMembers<Reprot>::record);
}

TEST_CASE("an optional member of a force that is nearly right is found", "[engine][members]") {
  using detail::ForceMembers;
  STATIC_REQUIRE(ForceMembers<Push>::claims);
  STATIC_REQUIRE_FALSE(ForceMembers<ClaimsOfParticles>::claims);
  STATIC_REQUIRE_FALSE(ForceMembers<OtherClaims>::claims);
  STATIC_REQUIRE_FALSE(ForceMembers<FieldOfClaims>::claims);
  STATIC_REQUIRE(ForceMembers<OtherClaims>::check);
  STATIC_REQUIRE_FALSE(ForceMembers<CheckOfNumber>::check);
  STATIC_REQUIRE_FALSE(ForceMembers<SecantOfOneState>::secant);
  STATIC_REQUIRE(detail::finds_claims<Gravity>());
  STATIC_REQUIRE(detail::finds_check<Bonded>());
  STATIC_REQUIRE_FALSE(detail::finds_claims<Push>());
  STATIC_REQUIRE_FALSE(detail::finds_claims<double>());
}

TEST_CASE("an optional member of a monitor that is nearly right is found", "[engine][members]") {
  using detail::MonitorMembers;
  STATIC_REQUIRE(MonitorMembers<Watch>::report);
  STATIC_REQUIRE_FALSE(MonitorMembers<ChangingReport>::report);
  STATIC_REQUIRE(MonitorMembers<ChangingReport>::finish);
  STATIC_REQUIRE_FALSE(MonitorMembers<FinishOfNothing>::finish);
  STATIC_REQUIRE(detail::finds_report<Energy>());
}

}  // namespace noether
