#include "engine/simulation.hpp"

#include "io/digest.hpp"
#include "monitors/monitors.hpp"
#include "numbers/quantity.hpp"
#include "python/module/scenes.hpp"
#include "python/module/signal_watch.hpp"
#include "python/module/values.hpp"
#include "scene/named_parts.hpp"
#include "scene/read_integrator.hpp"

#include <fmt/format.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <map>
#include <optional>
#include <utility>

namespace noether::python {

namespace {

/// What the monitors of a run have told, in memory.
struct Record {
  struct Column {
    std::string dimension;
    std::vector<std::string> columns;
    std::vector<Index> shape;
    std::vector<double> values;  ///< one sample after the other
  };
  std::vector<double> times;
  std::vector<std::int64_t> steps;
  std::vector<std::pair<std::string, Column>> quantities;
};
using Records = std::map<std::string, Record, std::less<>>;

/// Keeps every sample of every monitor.
struct Recorder {
  std::shared_ptr<Records> kept;

  void observe(const Snapshot<double>& /*now*/) {}
  void record(const Sample& sample) {
    Record& record = (*kept)[std::string(sample.monitor)];
    if (!record.steps.empty() && record.steps.back() == sample.step && record.times.back() == sample.time) return;
    record.times.push_back(sample.time);
    record.steps.push_back(sample.step);
    if (record.quantities.empty()) {
      for (const Series& one : sample.series) {
        record.quantities.emplace_back(one.name, Record::Column{one.dimension, one.columns, one.shape, {}});
      }
    }
    for (std::size_t k = 0; k < sample.series.size() && k < record.quantities.size(); ++k) {
      std::vector<double>& all = record.quantities[k].second.values;
      all.insert(all.end(), sample.series[k].values.begin(), sample.series[k].values.end());
    }
  }
};

/// Frames in memory.
struct Movie {
  std::vector<double> times, positions, velocities;
};
struct FrameRecorder {
  std::shared_ptr<Movie> kept;

  void observe(const Snapshot<double>& now) {
    const ParticleSystem<double>& s = now.state();
    if (!kept->times.empty() && kept->times.back() == s.time()) return;
    kept->times.push_back(s.time());
    for (Index i = 0; i < s.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        kept->positions.push_back(s.positions().component(k)[i]);
        kept->velocities.push_back(s.velocities().component(k)[i]);
      }
    }
  }
};

/// Python's own copy of numbers.
nb::object array_of(const std::vector<double>& numbers, const std::vector<std::size_t>& shape) {
  auto* held = new std::vector<double>(numbers);  // NOLINT: the capsule owns it
  const nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });  // NOLINT
  return nb::cast(nb::ndarray<nb::numpy, double>(held->data(), shape.size(), shape.data(), owner));
}

class HeldSimulation {
 public:
  HeldSimulation(HeldScene& scene, const std::string& trajectory, const std::string& checkpoint)
      : functions_(scene.functions()),
        units_(scene.scene().units),
        constraints_(constraints_of(scene.scene())),
        integrator_(scene.scene().integrator),
        sim_(scene.run().assemble({.trajectory = trajectory, .checkpoint = checkpoint})) {
    scene.run().forget();
    sim_.attach(AnyMonitor<double>(Recorder{records_}), {.steps = std::int64_t{1} << 62});
  }

  HeldSimulation(const HeldSimulation&) = delete;
  HeldSimulation& operator=(const HeldSimulation&) = delete;

  std::vector<std::shared_ptr<Callable>>& functions() { return functions_; }
  Simulation<double>& sim() { return sim_; }
  const Records& records() const { return *records_; }
  const UnitSystem& units() const { return *units_; }

  /// Attaches a monitor by its name; what it looks at was settled before.
  /// @param when  `every`, `steps` or `times`, and `after`, as a scene has them
  void attach(const std::string& name, nb::handle values, nb::handle when, nb::object function) {
    expect_at_rest();
    if (!function.is_none()) functions_.push_back(nb::cast<std::shared_ptr<Callable>>(function));
    NamedFrom from;
    from.parts = &known_parts();
    from.units = units_;
    from.particles = &particles();
    const Cadence cadence = cadence_of(when);
    detail::attach(sim_, cadence, make_monitor(name, value_of(values, name), from, constraints_));
  }
  void record_frames(nb::handle when) {
    expect_at_rest();
    detail::attach(sim_, cadence_of(when), AnyMonitor<double>(FrameRecorder{movie_}));
  }
  nb::dict frames() {
    const std::size_t looks = movie_->times.size(), n = static_cast<std::size_t>(sim_.particles().size());
    nb::dict told;
    told["time"] = array_of(movie_->times, {looks});
    told["positions"] = array_of(movie_->positions, {looks, n, 3});
    told["velocities"] = array_of(movie_->velocities, {looks, n, 3});
    const Box& box = sim_.particles().box();
    told["box"] =
        box.is_periodic() ? nb::object(nb::make_tuple(box.edges()[0], box.edges()[1], box.edges()[2])) : nb::none();
    return told;
  }

  /// Goes on by steps, or to a time. @return outcome as a dict
  nb::object run(std::optional<std::int64_t> steps, std::optional<double> until, nb::object tell) {
    expect_at_rest();
    const Running running(*this);
    std::exception_ptr failed;
    SignalWatch watch(std::move(tell));
    sim_.stop_on(watch.flag());
    sim_.on_progress([&](const Progress& progress) { watch.look(progress); });
    Outcome outcome;
    {
      const nb::gil_scoped_release unlocked;
      try {
        outcome = steps ? sim_.run(*steps) : sim_.run_until(*until);
      } catch (...) {
        failed = std::current_exception();
      }
    }
    sim_.on_progress({});
    sim_.stop_on(nullptr);
    if (!failed) sim_.for_each_monitor([](const std::string&, AnyMonitor<double>& monitor) { monitor.flush(); });
    raise_again();
    if (failed) std::rethrow_exception(failed);
    watch.raise_again();
    running_ = false;
    static_cast<void>(particles());  // views that are held show where the run stands
    nb::dict told;
    told["outcome"] = std::string(name(outcome.kind));
    told["text"] = to_text(outcome);
    told["message"] = outcome.message;
    told["step"] = outcome.step;
    told["time"] = outcome.time;
    told["ok"] = outcome.ok();
    if (outcome.particle) told["particle"] = outcome.particle->name;
    return told;
  }

  /// Marks files as complete.
  void finish(const std::string& kind) {
    Outcome outcome;
    if (kind == "interrupted") outcome.kind = Outcome::Kind::interrupted;
    outcome.step = sim_.step();
    outcome.time = sim_.time();
    sim_.for_each_monitor([&](const std::string&, AnyMonitor<double>& monitor) { monitor.finish(outcome); });
  }

  void edit(nb::handle change, nb::handle self) {
    expect_at_rest();
    const Running running(*this);
    sim_.edit([&](ParticleSystem<double>& s) {
      change(vectors_of(s.positions().component(0), s.size(), s.positions().stride(), self, true),
             vectors_of(s.velocities().component(0), s.size(), s.velocities().stride(), self, true),
             numbers_of(s.masses().data(), s.size(), self, true));
      if (!s.positions().all().allFinite() || !s.velocities().all().allFinite() || !s.masses().all().allFinite()) {
        throw Error("the edit left a position, a velocity or a mass that is not finite; the state is as it was before");
      }
      s.wrap();
    });
    running_ = false;
    static_cast<void>(particles());
  }

  /// The particles where the run stands. Settling them may take a force: what that raises comes out.
  const ParticleSystem<double>& particles() {
    expect_at_rest();
    const ParticleSystem<double>& settled = sim_.particles();
    raise_again();
    return settled;
  }
  void raise_again() { noether::python::raise_again(functions_); }

  double time_of(const std::string& text) const { return parse_quantity(text, dimensions::time, *units_); }

  /// @throws nb::value_error  while a run is on
  void expect_at_rest() const {
    if (running_) throw std::runtime_error("the simulation is running; ask again when run() has returned");
  }

 private:
  Cadence cadence_of(nb::handle when) const {
    SceneContext context;
    context.units = units_;
    context.start_time = integrator_.start;
    const SceneValue table = value_of(when, "");
    TableReader reader(context, table, "every", "every");
    SceneValue effective = SceneValue::table();
    Cadence cadence = read_cadence(reader, false, integrator_, effective);
    read_after(reader, integrator_, cadence, effective);
    reader.finish();
    return cadence;
  }

  struct Running {
    explicit Running(HeldSimulation& held) : of(held) { of.running_ = true; }
    ~Running() { of.running_ = false; }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    HeldSimulation& of;
  };

  std::vector<std::shared_ptr<Callable>> functions_;
  const UnitSystem* units_;
  ConstraintSet constraints_;
  SceneIntegrator integrator_;
  std::shared_ptr<Records> records_ = std::make_shared<Records>();
  std::shared_ptr<Movie> movie_ = std::make_shared<Movie>();
  Simulation<double> sim_;
  bool running_ = false;
};

nb::object report_of(HeldSimulation& held) {
  nb::dict all;
  const auto put = [](nb::dict& into, const char* key, const std::optional<double>& value) {
    if (value) into[key] = *value;
  };
  held.sim().for_each_monitor([&](const std::string& name, AnyMonitor<double>& monitor) {
    const std::optional<MonitorReport> report = monitor.report();
    if (!report) return;
    nb::dict one;
    put(one, "first", report->first);
    put(one, "last", report->last);
    put(one, "worst", report->worst);
    put(one, "rms", report->rms);
    put(one, "slope", report->slope);
    put(one, "slope_error", report->slope_error);
    put(one, "scale", report->scale);
    put(one, "drift", report->drift);
    put(one, "drift_error", report->drift_error);
    one["samples"] = report->samples;
    if (!report->reason.empty()) one["reason"] = report->reason;
    if (!report->note.empty()) one["note"] = report->note;
    if (!report->verdict.empty()) one["verdict"] = report->verdict;
    all[name.c_str()] = one;
  });
  return all;
}

nb::object series_of(const HeldSimulation& held, const std::string& monitor) {
  const auto found = held.records().find(monitor);
  if (found == held.records().end()) throw nb::key_error(monitor.c_str());
  const Record& record = found->second;
  nb::dict told;
  const std::size_t looks = record.times.size();
  told["time"] = array_of(record.times, {looks});
  nb::list steps;
  for (const std::int64_t step : record.steps) steps.append(step);
  told["step"] = steps;
  nb::dict quantities;
  for (const auto& [name, column] : record.quantities) {
    std::vector<std::size_t> shape = {looks};
    std::size_t size = 1;
    for (const Index extent : column.shape) {
      shape.push_back(static_cast<std::size_t>(extent));
      size *= static_cast<std::size_t>(extent);
    }
    // A monitor whose sizes change from look to look (a list of molecules) is told as it came.
    if (column.values.size() != looks * size) shape = {column.values.size()};
    nb::dict one;
    one["values"] = array_of(column.values, shape);
    one["dimension"] = column.dimension;
    one["columns"] = column.columns;
    quantities[name.c_str()] = one;
  }
  told["quantities"] = quantities;
  return told;
}

int traverse(PyObject* self, visitproc visit, void* arg) {
#if PY_VERSION_HEX >= 0x03090000
  Py_VISIT(Py_TYPE(self));
#endif
  if (!nb::inst_ready(self)) return 0;
  return traverse_functions(nb::inst_ptr<HeldSimulation>(self)->functions(), visit, arg);
}
int clear(PyObject* self) {
  clear_functions(nb::inst_ptr<HeldSimulation>(self)->functions());
  return 0;
}
PyType_Slot slots[] = {
    {Py_tp_traverse, reinterpret_cast<void*>(traverse)}, {Py_tp_clear, reinterpret_cast<void*>(clear)}, {0, nullptr}};

}  // namespace

void bind_simulations(nb::module_& m) {
  using Held = HeldSimulation;
  nb::class_<Held>(m, "Simulation", nb::type_slots(slots))
      .def(nb::init<HeldScene&, const std::string&, const std::string&>(), nb::arg("scene"), nb::arg("trajectory"),
           nb::arg("checkpoint"))
      .def("attach", &Held::attach, nb::arg("name"), nb::arg("values"), nb::arg("when"), nb::arg("function").none())
      .def("record_frames", &Held::record_frames, nb::arg("when"))
      .def("frames", &Held::frames)
      .def("run", &Held::run, nb::arg("steps").none(), nb::arg("until").none(), nb::arg("tell").none())
      .def("finish", &Held::finish, nb::arg("outcome"))
      .def(
          "edit", [](nb::handle self, nb::object change) { nb::cast<Held&>(self).edit(change, self); },
          nb::arg("change"))
      .def(
          "change_step",
          [](Held& held, double step) {
            held.expect_at_rest();
            held.sim().change_step(step);
          },
          nb::arg("step"))
      .def(
          "steps_in", [](Held& held, double duration) { return held.sim().steps_in(duration); }, nb::arg("duration"))
      .def("time_of", &Held::time_of, nb::arg("text"))
      .def_prop_ro("step", [](Held& held) { return held.sim().step(); })
      .def_prop_ro("time", [](Held& held) { return held.sim().time(); })
      .def_prop_ro("seconds", [](Held& held) { return held.sim().seconds(); })
      .def_prop_ro("names", [](Held& held) { return held.particles().names(); })
      .def_prop_ro("units", [](Held& held) { return std::string(held.units().name); })
      .def_prop_ro("digest", [](Held& held) { return io::digest(held.particles()); })
      .def_prop_ro("positions",
                   [](nb::handle self) {
                     auto& held = nb::cast<Held&>(self);
                     const auto& x = held.particles().positions();
                     return vectors_of(x.component(0), x.size(), x.stride(), self);
                   })
      .def_prop_ro("velocities",
                   [](nb::handle self) {
                     auto& held = nb::cast<Held&>(self);
                     const auto& v = held.particles().velocities();
                     return vectors_of(v.component(0), v.size(), v.stride(), self);
                   })
      .def_prop_ro("masses",
                   [](nb::handle self) {
                     auto& held = nb::cast<Held&>(self);
                     const auto& mass = held.particles().masses();
                     return numbers_of(mass.data(), mass.size(), self);
                   })
      .def_prop_ro("variables",
                   [](Held& held) {
                     const auto& y = held.particles().variables();
                     return array_of(y, {y.size()});
                   })
      .def_prop_ro("variable_names", [](Held& held) { return held.particles().variable_names(); })
      .def_prop_ro("force_evaluations", [](Held& held) { return held.sim().evaluations().force; })
      .def_prop_ro("monitors",
                   [](const Held& held) {
                     std::vector<std::string> names;
                     for (const auto& [name, record] : held.records()) names.push_back(name);
                     return names;
                   })
      .def("report", &report_of)
      .def("series", &series_of, nb::arg("monitor"));
}

}  // namespace noether::python
