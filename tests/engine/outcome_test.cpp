#include "engine/outcome.hpp"

#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>

namespace noether {
namespace {

Outcome outcome_of(Outcome::Kind kind, std::int64_t step = 7) {
  Outcome outcome;
  outcome.kind = kind;
  outcome.step = step;
  return outcome;
}

struct Promise {
  Outcome::Kind kind;
  std::string_view name;
  int exit_code;
};

constexpr std::array promises = {
    Promise{Outcome::Kind::completed, "completed", 0},
    Promise{Outcome::Kind::stopped, "stopped", 0},
    Promise{Outcome::Kind::interrupted, "interrupted", 130},
    Promise{Outcome::Kind::diverged, "diverged", 1},
    Promise{Outcome::Kind::constraint_failure, "constraint_failure", 1},
    Promise{Outcome::Kind::solver_failure, "solver_failure", 1},
    Promise{Outcome::Kind::step_underflow, "step_underflow", 1},
    Promise{Outcome::Kind::overlap, "overlap", 1},
    Promise{Outcome::Kind::overstretch, "overstretch", 1},
    Promise{Outcome::Kind::inverted_element, "inverted_element", 1},
};

TEST_CASE("every kind of outcome has its name and its exit code", "[outcome]") {
  for (const Promise& promise : promises) {
    const Outcome outcome = outcome_of(promise.kind);
    CHECK(name(promise.kind) == promise.name);
    CHECK(exit_code(outcome) == promise.exit_code);
    CHECK(outcome.ok() == (promise.exit_code == 0));
  }
}

TEST_CASE("an outcome prints as one line", "[outcome]") {
  CHECK(fmt::format("{}", outcome_of(Outcome::Kind::completed, 36525)) == "completed at step 36525");

  Outcome escape = outcome_of(Outcome::Kind::stopped, 400);
  escape.message = "escape of Pluto, distance 101.2";
  escape.particle = ParticleRef{.index = 5, .id = 9, .name = "Pluto"};
  CHECK(fmt::format("{}", escape) == "stopped at step 400: escape of Pluto, distance 101.2");
  CHECK(fmt::format("{:>54}|", escape) == "  stopped at step 400: escape of Pluto, distance 101.2|");
}

TEST_CASE("without a message the particle and its quantity are told", "[outcome]") {
  Outcome outcome = outcome_of(Outcome::Kind::diverged);
  outcome.quantity = "position";
  CHECK(to_text(outcome) == "diverged at step 7: position is not finite");
  outcome.particle = ParticleRef{.index = 1, .id = 1, .name = "Mercury"};
  CHECK(to_text(outcome) == "diverged at step 7: position of Mercury is not finite");
  outcome.particle->name.clear();
  outcome.particle->id = 40;
  CHECK(to_text(outcome) == "diverged at step 7: position of particle 40 is not finite");
  outcome.kind = Outcome::Kind::overlap;
  outcome.quantity.clear();
  CHECK(to_text(outcome) == "overlap at step 7: particle 40");
}

}  // namespace
}  // namespace noether
