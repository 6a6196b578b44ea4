/// Options of methods are read as they describe themselves, those of a method from outside the library among them.

#include "integrators/all_methods.hpp"
#include "integrators/methods/newmark.hpp"
#include "scene/read_options.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

namespace {
enum class Side : std::uint8_t { left, right };

/// An option of each kind.
struct TiltedOptions {
  double tilt = 0.5;
  std::int64_t rounds = 1;
  bool twice = false;
  std::optional<double> angle = {};
  Side side = Side::left;
  std::string label = "plain";

  static constexpr auto describe();
  void check() const {
    if (!(tilt >= 0)) refuse_field("tilt", tilt, "leans to the wrong side; 0 or more is expected");
  }
};
}  // namespace

template <> struct EnumNames<Side> {
  static constexpr std::array<std::pair<Side, std::string_view>, 2> values{
      {{Side::left, "left"}, {Side::right, "right"}}};
};

namespace {

constexpr auto TiltedOptions::describe() {
  return part<TiltedOptions>("tilted", "options of a method from outside",
                             field<&TiltedOptions::tilt>("tilt", "1", "how far it leans"),
                             field<&TiltedOptions::rounds>("rounds", "1"), field<&TiltedOptions::twice>("twice", "1"),
                             field<&TiltedOptions::angle>("angle", "1"), field<&TiltedOptions::side>("side", "1"),
                             field<&TiltedOptions::label>("label", "1"));
}

/// y + tilt h f(t, y).
class Tilted final : public Method<double> {
 public:
  Tilted(const MethodInfo& info, const MethodOptions& options)
      : name_(info.name), options_(options.own.as<TiltedOptions>()) {}
  std::unique_ptr<Method<double>> clone() const override { return std::make_unique<Tilted>(*this); }
  MethodClaims claims() const override { return {.name = name_, .order = 0}; }
  void bind(const VectorField<double>& f) override { rate_.resize(f.size()); }
  StepResult step(VectorField<double>& f, const double& t, Vector<double>& y, double h) override {
    f.rate(t, y, rate_);
    y += options_.tilt * h * rate_;
    return {.h = h};
  }
  void save(SavedState& /*saved*/, const std::string& /*prefix*/) const override {}
  void load(const SavedState& /*saved*/, const std::string& /*prefix*/) override {}

 private:
  std::string_view name_;
  TiltedOptions options_;
  Vector<double> rate_;
};

std::unique_ptr<Method<double>> make_tilted(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<Tilted>(info, options);
}
const MethodInfo tilted{.name = "tilted_euler",
                        .aliases = "leaning",
                        .summary = "Euler's method with another slope",
                        .family = "runge-kutta",
                        .options = {&own_options<TiltedOptions>},
                        .make = make_tilted};

Parts parts() {
  Parts all = standard_parts();
  all.add_method(tilted);
  return all;
}

const std::string lorenz = "units = \"reduced\"\n[system]\ntype = \"lorenz\"\n[integrator]\n";
const std::string oscillator =
    "units = \"reduced\"\n[[particles.body]]\nname = \"one\"\nmass = 1\nx = [1, 0, 0]\nv = [0, 0, 0]\n[hamiltonian]\n"
    "type = \"kinetic_potential\"\n[[hamiltonian.force]]\ntype = \"harmonic_field\"\nk = 1\n[integrator]\n";

std::string refused(const std::string& text) {
  try {
    read_scene(text, "scene.toml", parts());
  } catch (const Error& error) {
    return error.message();
  }
  return "";
}

/// The lines of a method with steps of one length, or of its own.
std::string lines_of(const MethodInfo& info) {
  return fmt::format("method = \"{}\"\n{}", info.name, info.adaptive ? "until = 1\n" : "step = 0.01\nsteps = 10\n");
}

}  // namespace

TEST_CASE("a method from outside the library brings its options", "[scene][method_options]") {
  const std::string lines = lorenz + "method = \"leaning\"\nstep = 0.01\nsteps = 10\n";
  const Scene scene = read_scene(lines + "tilt = 0.25\nside = \"right\"\nangle = 2\n", "scene.toml", parts());
  const auto options = scene.integrator.classical->options.own.as<TiltedOptions>();
  CHECK(options.tilt == 0.25);
  CHECK(options.angle == 2.0);
  CHECK(options.side == Side::right);
  CHECK(options.label == "plain");
  CHECK(scene.effective_toml.find("method = \"tilted_euler\"\nstep = 0.01\nsteps = 10\ntilt = 0.25\nrounds = 1\n"
                                  "twice = false\nangle = 2\nside = \"right\"\nlabel = \"plain\"\n") !=
        std::string::npos);
  Simulation<double> run = assemble(scene);
  const double x = run.particles().variables()[0], y = run.particles().variables()[1];
  REQUIRE(run.run(1).ok());
  CHECK(std::abs(run.particles().variables()[0] - (x + 0.25 * 0.01 * 10 * (y - x))) < 1e-15);

  CHECK(refused(lines + "tilt = -1.0\n") == "tilt = -1.0 leans to the wrong side; 0 or more is expected");
  CHECK(refused(lines + "side = \"rigth\"\n") == "unknown side 'rigth'; did you mean 'right'?");
  CHECK(refused(lines + "rounds = 0.5\n") == "rounds = 0.5 is a number; a whole number is expected");
  CHECK(refused(lines + "twice = 1\n") == "twice = 1 is a whole number; true or false is expected");
  CHECK(refused(lines + "label = 1\n") == "label = 1 is a whole number; a text in quotes is expected");
  CHECK(refused(lines + "tlit = 1\n") == "unknown key 'tlit' in [integrator]; did you mean 'tilt'?");
  CHECK(refused(lorenz + "method = \"rk4\"\nstep = 0.01\nsteps = 10\ntilt = 1\n") ==
        "method 'rk4' has no tilt; take it out");
  CHECK(refused(lorenz + "method = \"leanin\"\nstep = 0.01\nsteps = 10\n") ==
        "unknown method 'leanin'; did you mean 'leaning'?");
}

TEST_CASE("a saved run of a method goes on with the same options of its own only", "[scene][method_options]") {
  const auto run = [](const char* tilt) {
    return assemble(read_scene(lorenz + "method = \"tilted_euler\"\nstep = 0.01\nsteps = 10\ntilt = " + tilt,
                               "scene.toml", parts()));
  };
  Simulation<double> one = run("0.25"), same = run("0.25"), other = run("0.75");
  REQUIRE(one.run(3).ok());
  CHECK_NOTHROW(same.restore(one.save()));
  CHECK_THROWS_WITH(other.restore(one.save()),
                    Catch::Matchers::Contains("tilt = 0.25") && Catch::Matchers::Contains("tilt = 0.75"));
}

TEST_CASE("every method takes the options that it describes and no others", "[scene][method_options]") {
  const Parts all = parts();
  std::size_t taken = 0, refusals = 0;
  for (const MethodInfo* info : all.methods()) {
    const std::string text = oscillator + lines_of(*info);
    const std::vector<FieldInfo> fields = fields_of(*info);
    for (const OptionGroup* group : all.method_options()) {
      for (const OptionValue& one : group->values({})) {
        const std::string value = one.kind == "flag"           ? "false"
                                  : one.kind == "whole number" ? "2"
                                  : one.kind == "number"       ? "0.25"
                                  : one.choices.empty()        ? "\"text\""
                                                               : fmt::format("\"{}\"", one.choices.front());
        CAPTURE(info->name, one.name, value);
        const std::string answer = refused(text + fmt::format("{} = {}\n", one.name, value));
        const bool described =
            std::any_of(fields.begin(), fields.end(), [&](const FieldInfo& field) { return field.name == one.name; });
        if (one.name == "adaptive") continue;  // of it, the other keys depend
        CHECK((answer.find("has no effect") == std::string::npos &&
               answer.find(fmt::format("has no {}", one.name)) == std::string::npos) == described);
        CHECK(described == info->takes(*group));
        ++(described ? taken : refusals);
      }
    }
  }
  CHECK(taken > 40);
  CHECK(refusals > 100);
}

TEST_CASE("options of a method's own are compared by their values", "[scene][method_options]") {
  const MethodOptions none, newmark{.own = NewmarkOptions{}}, other{.own = NewmarkOptions{.beta = 0.3}};
  CHECK(newmark == MethodOptions{.own = NewmarkOptions{}});
  CHECK_FALSE(newmark == other);
  CHECK_FALSE(newmark == none);
  CHECK(none.own.as<NewmarkOptions>().gamma == 0.5);
  CHECK_THROWS_AS(newmark.own.as<TiltedOptions>(), LogicError);
  CHECK(method("newmark", NewmarkOptions{.beta = 0.3}, {.jacobian = JacobianForm::dense}).options ==
        MethodOptions{.jacobian = JacobianForm::dense, .own = NewmarkOptions{.beta = 0.3}});
}

}  // namespace noether
