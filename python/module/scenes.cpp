#include "python/module/scenes.hpp"

#include "cli/comma_lists.hpp"
#include "cli/scene_reports.hpp"
#include "numbers/quantity.hpp"
#include "python/module/signal_watch.hpp"
#include "python/module/user_constraint.hpp"
#include "python/module/values.hpp"
#include "scene/evaluate.hpp"
#include "scene/json.hpp"
#include "scene/minimize.hpp"
#include "scene/run.hpp"
#include "scene/warnings.hpp"
#include "study/advise.hpp"
#include "study/compare_files.hpp"
#include "study/report.hpp"
#include "study/stability.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <utility>

namespace noether::python {

namespace {

SceneRun read(nb::handle source, const std::vector<std::string>& sets) {
  if (nb::isinstance<nb::dict>(source)) {
    SceneValue root = value_of(source, "");
    const nb::gil_scoped_release unlocked;
    return read_run(std::move(root), "scene", known_parts(), sets);
  }
  const auto file = nb::cast<std::string>(nb::str(source));
  const nb::gil_scoped_release unlocked;
  return load_run(file, known_parts(), sets);
}

/// Calls `tell(row, rows, share, what)` now and then, unless it is None; signals are looked for meanwhile.
TellShare share_teller(nb::handle tell) {
  return [tell](const Share& share) {
    const nb::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (!tell.is_none()) tell(share.row, share.rows, share.done, share.what);
  };
}

/// Works without Python's lock. What a function of one's own has raised comes out before what the engine made of it.
template <class Work> void without_lock(HeldScene& held, const Work& work) {
  std::exception_ptr failed;
  {
    const nb::gil_scoped_release unlocked;
    try {
      work();
    } catch (...) {
      failed = std::current_exception();
    }
  }
  held.raise_again();
  if (failed) std::rethrow_exception(failed);
}

nb::object run_scene(HeldScene& held, const std::string& out, const std::string& existing, bool cost,
                     double checkpoint_wall, nb::object tell) {
  RunOptions options;
  options.out = out;
  options.existing = existing == "resume" ? Existing::resume : existing == "fresh" ? Existing::fresh : Existing::keep;
  options.cost = cost;
  options.checkpoint_wall = checkpoint_wall;
  options.handle_signals = false;
  SignalWatch watch(tell);
  options.stop = watch.flag();
  options.tell = [&watch](const Progress& progress) { watch.look(progress); };
  std::string json, text;
  without_lock(held, [&] {
    const RunReport report = run(std::move(held.run()), options);
    json = to_json(report);
    text = to_text(report);
  });
  watch.raise_again();
  return nb::make_tuple(from_json(json), text);
}

std::vector<double> times_of(const std::vector<std::string>& texts, const UnitSystem& units) {
  std::vector<double> times;
  for (const std::string& text : texts) times.push_back(times_in(text, "steps", units).front());
  return times;
}

nb::object compare_scene(HeldScene& held, const std::vector<std::string>& methods,
                         const std::vector<std::string>& steps, const std::vector<double>& tolerances,
                         const std::optional<std::string>& until, int repeats, double budget, double truth_budget,
                         const std::string& out, nb::object tell) {
  CompareOptions options;
  options.methods = methods;
  options.steps = times_of(steps, *held.scene().units);
  options.tolerances = tolerances;
  if (until) options.until = times_in(*until, "until", *held.scene().units).front();
  options.repeats = repeats;
  options.row_budget = budget;
  options.truth.budget = truth_budget;
  options.progress = share_teller(tell);
  std::string json, text;
  without_lock(held, [&] {
    Scene scene = held.scene();
    begin_at_minimum(scene);
    Comparison comparison = compare(scene, options);
    comparison.command = "noether.compare";
    CompareFiles files;
    if (!out.empty()) files = write_files(comparison, out, report_html(comparison, solution_of(scene, comparison)));
    json = to_json(comparison, files);
    text = to_text(comparison);
  });
  return nb::make_tuple(from_json(json), text);
}

nb::object advise_scene(HeldScene& held, double error, const std::optional<std::string>& metric,
                        const std::vector<std::string>& methods, double budget, nb::object tell) {
  AdviseOptions options;
  options.error = error;
  if (metric) options.metric = *metric == "energy" ? Metric::energy : Metric::position;
  options.methods = methods;
  options.row_budget = budget;
  options.progress = share_teller(tell);
  std::string json, text;
  without_lock(held, [&] {
    Scene scene = held.scene();
    begin_at_minimum(scene);
    const Advice advice = advise(scene, options);
    json = to_json(advice, scene);
    text = to_text(advice, scene);
  });
  return nb::make_tuple(from_json(json), text);
}

nb::object stability_of(HeldScene& held, const std::vector<std::string>& methods, std::int64_t steps, double budget,
                        nb::object tell) {
  StabilityOptions options;
  options.methods = methods;
  options.confirm_steps = steps;
  options.row_budget = budget;
  options.progress = share_teller(tell);
  std::string json, text;
  without_lock(held, [&] {
    Scene scene = held.scene();
    begin_at_minimum(scene);
    const Stability found = find_stability(scene, options);
    json = to_json(found);
    text = to_text(found);
  });
  return nb::make_tuple(from_json(json), text);
}

nb::object evaluate_scene(HeldScene& held, bool check) {
  Evaluation found;
  std::string json;
  without_lock(held, [&] {
    found = evaluate(held.scene(), check);
    json = evaluation_json(held.scene(), found);
  });
  nb::dict result = nb::borrow<nb::dict>(from_json(json));
  nb::list forces;
  for (Index i = 0; i < held.scene().particles.size(); ++i) {
    const Vec3<double> f = found.forces[i];
    forces.append(nb::make_tuple(f[0], f[1], f[2]));
  }
  result["forces"] = forces;
  return result;
}

nb::object explain_scene(HeldScene& held) {
  std::string json;
  without_lock(held, [&] { json = explanation_json(held.scene()); });
  return from_json(json);
}

int traverse(PyObject* self, visitproc visit, void* arg) {
#if PY_VERSION_HEX >= 0x03090000
  Py_VISIT(Py_TYPE(self));
#endif
  if (!nb::inst_ready(self)) return 0;
  return traverse_functions(nb::inst_ptr<HeldScene>(self)->functions(), visit, arg);
}
int clear(PyObject* self) {
  clear_functions(nb::inst_ptr<HeldScene>(self)->functions());
  return 0;
}
PyType_Slot slots[] = {
    {Py_tp_traverse, reinterpret_cast<void*>(traverse)}, {Py_tp_clear, reinterpret_cast<void*>(clear)}, {0, nullptr}};

int traverse_function(PyObject* self, visitproc visit, void* arg) {
#if PY_VERSION_HEX >= 0x03090000
  Py_VISIT(Py_TYPE(self));
#endif
  if (!nb::inst_ready(self)) return 0;
  Py_VISIT(nb::inst_ptr<Callable>(self)->object());
  return 0;
}
int clear_function(PyObject* self) {
  nb::inst_ptr<Callable>(self)->clear();
  return 0;
}
PyType_Slot function_slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(traverse_function)},
                                {Py_tp_clear, reinterpret_cast<void*>(clear_function)},
                                {0, nullptr}};

}  // namespace

const Parts& known_parts() {
  static const Parts all = [] {
    Parts parts = standard_parts();
    parts.add_force<UserForce>();
    parts.add_monitor<UserMonitor>();
    add_user_constraints(parts);
    return parts;
  }();
  return all;
}

HeldScene::HeldScene(nb::object source, const std::vector<std::string>& sets,
                     std::vector<std::shared_ptr<Callable>> functions)
    : functions_(std::move(functions)) {
  try {
    run_ = std::make_unique<SceneRun>(read(source, sets));
  } catch (...) {
    raise_again();  // what a function has raised says more than what the scene makes of it
    throw;
  }
  raise_again();
}

void HeldScene::raise_again() { noether::python::raise_again(functions_); }

int traverse_functions(const std::vector<std::shared_ptr<Callable>>& functions, visitproc visit, void* arg) {
  for (const auto& function : functions) {
    // A reference that a scene and its simulation share would be visited twice: it counts as held from elsewhere.
    if (function.use_count() == 1) Py_VISIT(nb::find(*function).ptr());
  }
  return 0;
}
void clear_functions(std::vector<std::shared_ptr<Callable>>& functions) {
  const auto dropped = std::exchange(functions, {});  // others may go on with them
}

void bind_scenes(nb::module_& m) {
  nb::class_<Callable>(m, "Function", nb::type_slots(function_slots))
      .def_prop_ro("id", &Callable::id)
      .def("raise_again", &Callable::raise_again);
  m.def("function", &make_callable, nb::arg("object"), nb::arg("address"));

  nb::class_<HeldScene>(m, "Scene", nb::type_slots(slots))
      .def(nb::init<nb::object, const std::vector<std::string>&, std::vector<std::shared_ptr<Callable>>>(),
           nb::arg("source"), nb::arg("sets"), nb::arg("functions"))
      .def_prop_ro("toml", [](const HeldScene& s) { return s.scene().effective_toml; })
      .def_prop_ro("tree", [](const HeldScene& s) { return object_of(s.scene().effective); })
      .def_prop_ro("title", [](const HeldScene& s) { return s.scene().title; })
      .def_prop_ro("units", [](const HeldScene& s) { return std::string(s.scene().units->name); })
      .def_prop_ro("notes", [](const HeldScene& s) { return s.scene().notes; })
      .def_prop_ro("warnings", [](const HeldScene& s) { return warnings_of(s.scene()); })
      .def_prop_ro("names", [](const HeldScene& s) { return s.scene().particles.names(); })
      .def_prop_ro("has_end", [](const HeldScene& s) { return s.scene().integrator.length().has_value(); })
      .def_prop_ro("is_system", [](const HeldScene& s) { return s.scene().system.has_value(); })
      .def_prop_ro("positions",
                   [](nb::handle self) {
                     const auto& x = nb::cast<HeldScene&>(self).scene().particles.positions();
                     return vectors_of(x.component(0), x.size(), x.stride(), self);
                   })
      .def_prop_ro("velocities",
                   [](nb::handle self) {
                     const auto& v = nb::cast<HeldScene&>(self).scene().particles.velocities();
                     return vectors_of(v.component(0), v.size(), v.stride(), self);
                   })
      .def_prop_ro("masses",
                   [](nb::handle self) {
                     const auto& mass = nb::cast<HeldScene&>(self).scene().particles.masses();
                     return numbers_of(mass.data(), mass.size(), self);
                   })
      .def("run", &run_scene, nb::arg("out"), nb::arg("existing"), nb::arg("cost"), nb::arg("checkpoint_wall"),
           nb::arg("tell").none())
      .def("compare", &compare_scene, nb::arg("methods"), nb::arg("steps"), nb::arg("tolerances"),
           nb::arg("until").none(), nb::arg("repeats"), nb::arg("budget"), nb::arg("truth_budget"), nb::arg("out"),
           nb::arg("tell").none())
      .def("advise", &advise_scene, nb::arg("error"), nb::arg("metric").none(), nb::arg("methods"), nb::arg("budget"),
           nb::arg("tell").none())
      .def("stability", &stability_of, nb::arg("methods"), nb::arg("steps"), nb::arg("budget"), nb::arg("tell").none())
      .def("evaluate", &evaluate_scene, nb::arg("check"))
      .def("explain", &explain_scene);
}

}  // namespace noether::python
