#pragma once
/// Saving a classical method on its way, and going on from there.

#include "integrators/classical.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/planets.hpp"

namespace noether::test {

/// 2 n steps in one go, and n before and n behind a saved state, end in the same bits at the same cost.
/// @param dt  of methods with steps of one length [time]
inline void check_goes_on(const Classical<double>& method, const ParticleSystem<double>& start, std::int64_t n,
                          double dt) {
  auto whole = method, first = method, second = method;
  ParticleSystem<double> s = start;
  s.clock() = method.claims().clock == ClockMode::free ? Clock<double>::free(0) : Clock<double>::fixed(0, dt);
  ParticleSystem<double> half = s;
  whole.bind(s);
  REQUIRE(whole.advance(s, {.steps = 2 * n}).steps == 2 * n);
  first.bind(half);
  REQUIRE(first.advance(half, {.steps = n}).steps == n);
  SavedState saved;
  first.save(saved, "");
  second.bind(half);
  second.load(saved, "");
  REQUIRE(second.advance(half, {.steps = n}).steps == n);
  CHECK(s.time() == half.time());
  CHECK(same_bits(s, half));
  CHECK(s.variables() == half.variables());
  CHECK(whole.evaluations().force == second.evaluations().force);
  CHECK(whole.evaluations().jacobian == second.evaluations().jacobian);
}

}  // namespace noether::test
