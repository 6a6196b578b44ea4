/// Optional members that are nearly right are found, so that the seams can refuse them.

#include "engine/any_force.hpp"
#include "engine/monitor.hpp"
#include "forces/bonded.hpp"
#include "forces/gravity.hpp"
#include "monitors/monitors.hpp"
#include "tests/support/catch.hpp"

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

struct Watch {
  void observe(const Snapshot<double>&) {}
};
struct ChangingReport : Watch {
  MonitorReport report() { return {}; }  // not const
};
struct FinishOfNothing : Watch {
  void finish() {}
};

}  // namespace

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
