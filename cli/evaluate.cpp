#include "cli/commands.hpp"
#include "cli/scene_reports.hpp"

#include "engine/bodies.hpp"
#include "numbers/error.hpp"
#include "numbers/parallel.hpp"
#include "numbers/quantity.hpp"
#include "numbers/text.hpp"
#include "scene/evaluate.hpp"
#include "scene/json.hpp"
#include "scene/warnings.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace noether {

namespace {

struct EvaluateArguments {
  std::string scene, forces;
  std::vector<std::string> sets;
  int threads = 0;
  bool check = false, json = false;
};

void write_forces(const std::string& file, const Scene& scene, const Evaluation& result) {
  std::ofstream out(file);
  out << "id,fx,fy,fz\n";
  for (Index i = 0; i < scene.particles.size(); ++i) {
    const Vec3<double> f = result.forces[i];
    out << fmt::format("{},{:.17g},{:.17g},{:.17g}\n", scene.particles.ids()[static_cast<std::size_t>(i)], f[0], f[1],
                       f[2]);
  }
  out.flush();
  if (!out) throw FileError("the forces could not be written", {.file = file});
}

/// The table of forces must not take the place of what was read.
void check_forces_file(const std::filesystem::path& file, const Scene& scene) {
  if (file.extension() != ".csv") {
    throw Error(fmt::format("the table of forces '{}' must end in .csv", file.string()), {.value = file.string()});
  }
  const SceneValue* bodies = scene.effective.find("particles")->find("bodies");
  if (bodies == nullptr) return;
  std::error_code absent;
  if (std::filesystem::equivalent(scene.file.parent_path() / *bodies->get<std::string>(), file, absent)) {
    throw Error(fmt::format("'{}' holds the bodies of the scene; give another name", file.string()),
                {.value = file.string()});
  }
}

Json json_of(const LatticeAccuracy& of) {
  Json::Members members = {{"asked", of.asked},     {"expected", of.expected},
                           {"reached", of.reached}, {"sampled", std::int64_t{of.sampled}},
                           {"alpha", of.alpha},     {"kmax", of.kmax ? Json(*of.kmax) : Json()}};
  if (of.order > 0) {
    members.emplace_back("mesh", Json::list({of.mesh[0], of.mesh[1], of.mesh[2]}));
    members.emplace_back("order", of.order);
  }
  return Json::object(members);
}

Json json_of(const Evaluation& e, const std::vector<std::string>& warnings) {
  Json::Members terms;
  for (const auto& [name, energy] : e.terms) terms.emplace_back(name, energy);
  std::vector<Json> rows;
  for (int r = 0; r < 3; ++r) rows.push_back(Json::list({e.virial(r, 0), e.virial(r, 1), e.virial(r, 2)}));
  Json::Members members = {{"schema", "noether.evaluate/1"},
                           {"outcome", name(e.outcome.kind)},
                           {"message", e.outcome.message},
                           {"energy", Json::object({{"total", e.kinetic + e.potential},
                                                    {"kinetic", e.kinetic},
                                                    {"potential", e.potential},
                                                    {"terms", Json::object(terms)}})},
                           {"virial", Json::list(rows)},
                           {"pressure", e.pressure},
                           {"force_max", e.force_max},
                           {"gradient_error", e.gradient_error}};
  if (!e.lattices.empty()) {
    Json::Members lattices;
    for (const auto& [name, one] : e.lattices) lattices.emplace_back(name, json_of(one));
    members.emplace_back("force_errors", Json::object(lattices));
  }
  if (!warnings.empty()) members.emplace_back("warnings", Json::list_of(warnings));
  return Json::object(members);
}

/// How far a sum over a lattice of charges is from Ewald's, and what it has chosen.
void print_accuracy(const std::string& name, const LatticeAccuracy& of, const UnitSystem& units, std::size_t width) {
  const std::string per_length = units.is_reduced() ? "" : fmt::format(" 1/{}", units.length);
  const std::string waves = of.kmax ? fmt::format("waves up to {:.4g}{}", *of.kmax, per_length)
                                    : fmt::format("a mesh of {} x {} x {}, splines of order {}", of.mesh[0], of.mesh[1],
                                                  of.mesh[2], of.order);
  fmt::print("{:<{}}{:.2g} of C <q^2> (n/V)^(2/3), against Ewald's sum in 113 bits at {}{}\n", "error of forces", width,
             of.reached, of.sampled < of.charged ? fmt::format("{} of ", of.sampled) : "",
             counted(of.charged, "charge"));
  fmt::print("  {:<{}}asked {:.2g}, expected {:.2g}; alpha {:.4g}{}, {}\n", name, width - 2, of.asked, of.expected,
             of.alpha, per_length, waves);
}

void print_text(const Scene& scene, const Evaluation& e) {
  const auto with_unit = [&](double value, const Dimension& dimension) {
    const std::string unit = unit_of(dimension, *scene.units);
    return std::isnan(value) ? "unknown" : format_number(value) + (unit == "1" ? "" : " " + unit);
  };
  const auto energy = [&](double value) { return with_unit(value, dimensions::energy); };
  std::size_t width = 22;
  for (const auto& [name, value] : e.terms) width = std::max(width, name.size() + 5);
  fmt::print("{:<{}}{}\n", "total energy", width, energy(e.kinetic + e.potential));
  fmt::print("{:<{}}{}\n", "  kinetic", width, energy(e.kinetic));
  fmt::print("{:<{}}{}\n", "  potential", width, energy(e.potential));
  for (const auto& [name, value] : e.terms) fmt::print("    {:<{}}{}\n", name, width - 4, energy(value));
  fmt::print("{:<{}}{}\n", "trace of the virial", width, energy(e.virial.trace()));
  if (e.pressure) {
    const UnitSystem& units = *scene.units;
    fmt::print("{:<{}}{}{}\n", "pressure", width, format_number(*e.pressure),
               units.is_reduced() ? "" : fmt::format(" {}/{}^3", units.energy, units.length));
  }
  fmt::print("{:<{}}{}\n", "largest force", width, with_unit(e.force_max, dimensions::force));
  for (const auto& [name, one] : e.lattices) print_accuracy(name, one, *scene.units, width);
  if (!e.gradient_error) return;
  const Index particles = scene.particles.size(), asked = e.gradient_asked;
  fmt::print("{:<{}}{:.2g} of the largest force{}{}\n", "force against -grad U", width, *e.gradient_error,
             has_bodies(scene.particles) ? " or torque" : "",
             asked < particles ? fmt::format(", checked at {} of {}", asked, counted(particles, "particle")) : "");
}

int evaluate_scene(const EvaluateArguments& given, const Parts& parts) {
  if (given.threads != 0) set_thread_count(given.threads);
  const Scene scene = load_scene(given.scene, parts, given.sets);
  tell_notes(scene.notes);
  if (!given.forces.empty() && !scene.system) check_forces_file(given.forces, scene);
  const Evaluation result = evaluate(scene, given.check);
  const bool failed = !result.outcome.ok();
  if (failed) fmt::print(stderr, "{}\n", escaped(to_text(result.outcome)));
  if (!given.forces.empty() && !failed) write_forces(given.forces, scene, result);
  if (given.json) {
    fmt::print("{}\n", evaluation_json(scene, result));
  } else {
    print_text(scene, result);
    for (const std::string& warning : warnings_of(scene)) fmt::print("warning: {}\n", warning);
  }
  return exit_code(result.outcome);
}

}  // namespace

std::string evaluation_json(const Scene& scene, const Evaluation& found) {
  return json_of(found, warnings_of(scene)).text();
}

void add_evaluate_command(CLI::App& app, const Parts& parts, int& exit_code) {
  const auto given = std::make_shared<EvaluateArguments>();
  CLI::App* command = app.add_subcommand("evaluate", "energy by term, virial and forces of the initial state");
  command->add_option("scene", given->scene, "scene file")->required()->type_name("SCENE");
  command->add_option("--forces", given->forces, "write id,fx,fy,fz with 17 digits")->type_name("FILE.csv");
  add_threads_option(*command, given->threads);
  command->add_option("--set", given->sets, "change a key of the scene: key.path=value")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_flag("--check", given->check,
                    "compare every force with differences of its energy, and Ewald's sums with 113 bits");
  command->add_flag("--json", given->json, "report as one line of JSON");
  command->callback([given, &parts, &exit_code] { exit_code = evaluate_scene(*given, parts); });
}

}  // namespace noether
