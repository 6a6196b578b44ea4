#include "scene/check.hpp"

#include "integrators/all_schemes.hpp"
#include "integrators/composition.hpp"
#include "neighbors/neighbor_images.hpp"
#include "numbers/text.hpp"
#include "scene/body_tables.hpp"
#include "scene/foreign_names.hpp"
#include "scene/read_constraints.hpp"
#include "scene/read_particles.hpp"
#include "scene/toml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace noether {

namespace {

class SceneCheck {
 public:
  SceneCheck(const SceneContext& context, const SceneValue& root, const Scene& scene)
      : context_(context), root_(root), parts_(*scene.parts), scene_(scene) {}

  /// Puts the parts together once, as the run has them. Only where they refuse something they are put together anew,
  /// piece by piece, to tell its place in the scene.
  Simulation<double> check(TableReader& top) {
    if (!scene_.system) check_before(top);
    std::optional<Simulation<double>> run;
    try {
      run.emplace(detail::assemble_start(scene_));
    } catch (const Error& error) {
      find_fault(top);
      if (dynamic_cast<const SceneError*>(&error) != nullptr) throw;
      refuse_monitor(top);
      top.fail(nullptr, "", error.message());
    }
    if (scene_.system) {
      check_rates(top);
    } else {
      check_backward(top);
      check_places();
    }
    return std::move(*run);
  }

 private:
  /// Ends at what refuses to be put together, unless it is a monitor.
  void find_fault(TableReader& top) {
    if (scene_.system) {
      find_fault_of_system(top);
    } else {
      find_fault_of_hamiltonian(top);
    }
    check_decorators(top);
  }

  /// Puts the decorators around the method one by one: each refuses what it cannot stand around.
  void check_decorators(TableReader& top) const {
    TableReader integrator(context_, *top.find("integrator"), "[integrator]", "integrator");
    const auto tables = tables_of(integrator, "decorator");
    const std::vector<SceneDecorator>& decorators = scene_.integrator.decorators;
    const std::size_t named = decorators.size() - tables.size();
    for (std::size_t k = 0; k < decorators.size(); ++k) {
      ParticleSystem<double> s = scene_.particles;
      s.clock() = clock_of(scene_.integrator);
      try {
        integrator_of(scene_, k + 1).bind(s);
      } catch (const Error& error) {
        const SceneValue& table = k < named ? *integrator.find(decorators[k].name) : *tables[k - named];
        TableReader decorator(context_, table, k < named ? "[" + decorators[k].path + "]" : "[[integrator.decorator]]",
                              decorators[k].path);
        decorator.find("type");
        const bool own = !error.key().empty() && table.find(error.key()) != nullptr;
        if (!own && k < named) decorator.fail(nullptr, "", error.message());
        decorator.fail(own ? error.key() : "type", error.message());
      }
    }
  }

  void find_fault_of_system(TableReader& top) {
    TableReader integrator(context_, *top.find("integrator"), "[integrator]", "integrator");
    ParticleSystem<double> s = scene_.particles;
    try {
      integrator_of(scene_, 0).bind(s);
    } catch (const SchemeMismatch& error) {
      integrator.fail(error.key().empty() ? "method" : error.key(), error.message());
    } catch (const Error& error) {
      TableReader system(context_, *top.find("system"), "[system]", "system");
      system.fail(error.key().empty() ? "type" : error.key(), error.message());
    }
    check_rates(top);
  }

  void check_rates(TableReader& top) const {
    const ParticleSystem<double>& s = scene_.particles;
    const std::unique_ptr<VectorField<double>> field = scene_.system->field();
    Vector<double> y, dy;
    field->gather(s, y);
    field->rate(scene_.integrator.start, y, dy);
    for (Index i = 0; i < dy.size(); ++i) {
      if (std::isfinite(dy[i])) continue;
      TableReader(context_, *top.find("system"), "[system]", "system")
          .fail(nullptr, "start", fmt::format("the rate of {} is not finite at the start", s.variable_name(i)));
    }
  }

  /// What can be told before anything is put together.
  void check_before(TableReader& top) const {
    check_range(top);
    TableReader integrator(context_, *top.find("integrator"), "[integrator]", "integrator");
    if (scene_.hamiltonian.neighbors && scene_.integrator.classical) {
      integrator.fail(
          "method",
          fmt::format(
              "method '{}' uses its own neighbor list; [hamiltonian.neighbors] is for splittings, so take it out",
              scene_.integrator.method));
    }
    if (scene_.hamiltonian.thermostat && scene_.integrator.classical) {
      integrator.fail(
          "method",
          fmt::format("method '{}' does not support a thermostat; use \"BAOAB\", or a scheme such as 'verlet'",
                      scene_.integrator.method));
    }
  }

  void check_backward(TableReader& top) const {
    if (!scene_.hamiltonian.thermostat || !(scene_.integrator.step < 0)) return;
    TableReader(context_, *top.find("integrator"), "[integrator]", "integrator")
        .fail("step", fmt::format("step = {} goes back in time, which a thermostat does not support; a step above 0 is "
                                  "expected",
                                  scene_.integrator.step_text));
  }

  void find_fault_of_hamiltonian(TableReader& top) {
    TableReader hamiltonian(context_, *top.find("hamiltonian"), "[hamiltonian]", "hamiltonian");
    TableReader integrator(context_, *top.find("integrator"), "[integrator]", "integrator");
    refuse_constraints(context_, tables_of(hamiltonian, "constraint"), scene_);
    try {
      if (!scene_.integrator.classical) scene_.hamiltonian.check_kicks(hamiltonian_of(scene_).claims().kicks);
    } catch (const Error& error) {
      hamiltonian.fail("type", error.message());
    }
    check_backward(top);
    std::optional<AnyIntegrator<double>> made;
    try {
      made = integrator_of(scene_, 0);
    } catch (const SchemeMismatch& error) {
      integrator.fail(error.key().empty() ? "method" : error.key(),
                      error.message() + std::string(who_has_noise()) + name_in_capitals());
    }
    ParticleSystem<double> s = scene_.particles;
    s.clock() = Clock<double>::fixed(scene_.integrator.start, scene_.integrator.step);
    try {
      made->bind(s);
    } catch (const SchemeMismatch& error) {
      integrator.fail(error.key().empty() ? "method" : error.key(), error.message());
    } catch (const Error& error) {
      hamiltonian.fail("type", error.message());
    }
    check_places();
  }

  /// What a word may have been meant as, if it is the name of a method: "SABA" has the letters A and B too.
  std::string name_in_capitals() const {
    const std::string& method = scene_.integrator.method;
    if (scene_.integrator.classical || schemes::find(method) != nullptr) return "";
    return proposal_by_name(method, scene_.parts->method_names());
  }

  /// Ends at the monitor that this run cannot serve, if one is the reason why it cannot be assembled: at the key that
  /// is wrong, else at its type.
  void refuse_monitor(TableReader& top) const {
    const auto tables = tables_of(top, "every");
    for (std::size_t k = 0; k < tables.size() && k < scene_.watches.size(); ++k) {
      Scene alone = scene_;
      alone.watches = {scene_.watches[k]};
      try {
        assemble(alone);
      } catch (const Error& error) {
        const bool own = !error.key().empty() && tables[k]->find(error.key()) != nullptr;
        TableReader(context_, *tables[k], "[[every]]", fmt::format("every.{}", k))
            .fail(own ? error.key() : "type", error.message());
      }
    }
  }

  /// Refuses a box that is too small for the range of the forces before somebody looks for neighbors there.
  void check_range(TableReader& top) const {
    double range = 0;
    for (const SceneForce& force : scene_.hamiltonian.forces) {
      range = std::max(range, force.force.claims().range);
    }
    try {
      check_images(scene_.particles.box(), range, scene_.hamiltonian.neighbors.value_or(NeighborOptions{}).skin);
    } catch (const Error& error) {
      if (error.key() == "skin") {
        TableReader hamiltonian(context_, *top.find("hamiltonian"), "[hamiltonian]", "hamiltonian");
        TableReader(context_, *hamiltonian.find("neighbors"), "[hamiltonian.neighbors]", "hamiltonian.neighbors")
            .fail("skin", error.message());
      }
      TableReader particles(context_, *top.find("particles"), "[particles]", "particles");
      particles.fail(particles.find("box"), "box", error.message());
    }
  }

  /// The line of the table of a particle; that of all particles where it has none, or cannot be told from others.
  int line_of_body(const SceneValue& particles, Index of) const {
    if (const auto place = place_of_body(particles, scene_.particles.name(of))) return place->table->line;
    const SceneValue* tables = particles.find("body");
    const auto* points = tables != nullptr ? tables->get<SceneValue::Array>() : nullptr;
    const bool all_there = points != nullptr && std::ssize(*points) == scene_.particles.size();
    return all_there ? (*points)[static_cast<std::size_t>(of)].line : particles.line;
  }

  /// Refuses two bodies in one place, where the force between them is no number.
  void check_places() const {
    const auto pair = coincident_bodies(scene_.particles);
    if (!pair) return;
    ParticleSystem<double> s = scene_.particles;
    s.clock() = Clock<double>::fixed(scene_.integrator.start, scene_.integrator.step);
    AnyIntegrator<double> made = integrator_of(scene_, 0);  // the run must not know that it was asked
    made.bind(s);
    VectorColumn<double> a(s.size());
    made.accelerations(s, a);
    const Vec3<double> one = a[pair->first], other = a[pair->second];
    if (one.allFinite() && other.allFinite()) return;
    const SceneValue* particles = root_.find("particles");
    throw scene_error(
        scene_.source, line_of_body(*particles, pair->second), "particles", "",
        fmt::format("'{}' and '{}' are in the same place, where {}", s.name(pair->first), s.name(pair->second),
                    scene_.hamiltonian.is_keplerian() ? "their attraction is infinite; move one, or give gravity a "
                                                        "softening"
                                                      : "a force between them is not a number; move one"));
  }

  /// Ends the refusal of a word with noise where there is none.
  std::string who_has_noise() const {
    if (!scene_.hamiltonian.splitting.claims().inertial) return "";
    for (const Stage& stage : scene_.integrator.scheme.word) {
      for (const auto& kind : parts_.thermostats()) {
        if (kind.info.meaning(stage.letter).empty()) continue;
        const auto& given = scene_.hamiltonian.thermostat;
        if (given && given->name == kind.info.name) continue;
        return fmt::format("; {} is the letter of the thermostat '{}': {} [hamiltonian.thermostat]", stage.letter,
                           kind.info.name, given ? "give it as the type in" : "add");
      }
    }
    return "";
  }

  const SceneContext& context_;
  const SceneValue& root_;
  const Parts& parts_;
  const Scene& scene_;
};

void check_value(const SceneValue& value, const std::string& path, int depth, const SceneSource& source) {
  const auto fail = [&](const std::string& message) { throw scene_error(source, value.line, path, "", message); };
  if (depth > deepest_table) {
    fail(fmt::format("tables and lists are nested more than {} levels deep; a scene needs far fewer", deepest_table));
  }
  if (const auto* text = value.get<std::string>(); text != nullptr && !is_utf8(*text)) {
    fail(fmt::format("{} is not UTF-8; give text in that encoding", path));
  }
  if (const auto* list = value.get<SceneValue::Array>()) {
    for (std::size_t k = 0; k < list->size(); ++k)
      check_value((*list)[k], fmt::format("{}.{}", path, k), depth + 1, source);
  }
  const auto* table = value.get<SceneValue::Table>();
  if (table == nullptr) return;
  std::set<std::string_view> keys;
  for (const auto& [key, entry] : *table) {
    const std::string below = path.empty() ? key : path + "." + key;
    if (!is_utf8(key)) fail(fmt::format("a key below '{}' is not UTF-8; give text in that encoding", path));
    if (!keys.insert(key).second) fail(fmt::format("the key '{}' appears twice; give it once", below));
    check_value(entry, below, depth + 1, source);
  }
}

}  // namespace

Simulation<double> check_scene(const SceneContext& context, const SceneValue& root, const Scene& scene) {
  TableReader top(context, root, "", "");
  return SceneCheck(context, root, scene).check(top);
}

void check_tree(const SceneValue& root, const SceneSource& source) { check_value(root, "", 0, source); }

}  // namespace noether
