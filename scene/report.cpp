#include "scene/json.hpp"
#include "scene/run.hpp"

#include "numbers/text.hpp"
#include "numbers/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

namespace {

/// What a monitor's missing figures have as reason, where a run is fine otherwise.
std::string message_of(const RunReport& report) {
  if (!report.outcome.message.empty()) return report.outcome.message;
  for (const auto& [name, monitor] : report.monitors) {
    if (!monitor.reason.empty()) return name + ": " + monitor.reason;
  }
  return "";
}

Json json_of(const MonitorReport& monitor) {
  Json::Members members = {{"first", monitor.first},
                           {"last", monitor.last},
                           {"worst", monitor.worst},
                           {"rms", monitor.rms},
                           {"slope", monitor.slope},
                           {"slope_error", monitor.slope_error},
                           {"slope_unit", monitor.slope_unit.empty() ? Json() : Json(monitor.slope_unit)},
                           {"scale", monitor.scale},
                           {"samples", monitor.samples}};
  if (!monitor.orders.empty()) {
    members.emplace_back("orders", Json::list_of(monitor.orders));
    members.emplace_back("fluctuation", Json::list_of(monitor.fluctuation));
    members.emplace_back("best_order", monitor.best_order);
    members.emplace_back("verdict", monitor.verdict);
  }
  if (monitor.drift) {
    members.emplace_back("drift", monitor.drift);
    members.emplace_back("drift_error", monitor.drift_error);
    members.emplace_back("drift_unit", monitor.drift_unit);
  }
  if (!monitor.reason.empty()) members.emplace_back("reason", monitor.reason);
  if (!monitor.note.empty()) members.emplace_back("note", monitor.note);
  return Json::object(members);
}

Json json_of(const std::filesystem::path& file) { return file.empty() ? Json() : Json(file.string()); }

Json per_second(double amount, double seconds) { return seconds > 0 ? Json(amount / seconds) : Json(); }

double seconds_of(const std::vector<CostBook::Entry>& cost) {
  double all = 0;
  for (const CostBook::Entry& one : cost) all += one.seconds;
  return all;
}

Json json_of(const std::vector<CostBook::Entry>& cost) {
  const double all = seconds_of(cost);
  std::vector<Json> entries;
  for (const CostBook::Entry& one : cost) {
    entries.push_back(Json::object({{"kind", one.kind},
                                    {"name", one.name.empty() ? Json() : Json(one.name)},
                                    {"seconds", one.seconds},
                                    {"share", all > 0 ? Json(one.seconds / all) : Json()}}));
  }
  return Json::list(entries);
}

Json particle_of(const Outcome& outcome) {
  if (!outcome.particle) return {};
  return Json::object(
      {{"index", outcome.particle->index}, {"id", outcome.particle->id}, {"name", outcome.particle->name}});
}

}  // namespace

std::string to_json(const RunReport& r) {
  Json::Members monitors;
  for (const auto& [name, monitor] : r.monitors) monitors.emplace_back(name, json_of(monitor));
  const auto steps = static_cast<double>(r.steps_made);
  Json::Members members = {
      {"schema", "noether.run/1"},
      {"version", version()},
      {"commit", commit()},
      {"scene", r.scene},
      {"scene_sha256", r.scene_sha256},
      {"outcome", name(r.outcome.kind)},
      {"exit_code", r.exit_code()},
      {"message", message_of(r)},
      {"particle", particle_of(r.outcome)},
      {"quantity", r.outcome.quantity.empty() ? Json() : Json(r.outcome.quantity)},
      {"unresolved", r.outcome.unresolved},
      {"step", r.outcome.step},
      {"time", r.outcome.time},
      {"time_unit", r.time_unit},
      {"dt", r.dt},
      {"particles", std::int64_t{r.particles}},
      {"resumed_from_step", r.resumed_from_step},
      {"threads", r.threads},
      {"simd", r.simd},
      {"evaluations", Json::object({{"force", r.evaluations.force},
                                    {"kepler", r.evaluations.kepler},
                                    {"jacobian", r.evaluations.jacobian},
                                    {"constraint", r.evaluations.constraint.iterations},
                                    {"rejected", r.evaluations.rejected},
                                    {"unsettled", r.evaluations.unsettled}})},
      {"wall_s", r.wall_s},
      {"steps_per_s", per_second(steps, r.wall_s)},
      {"particle_steps_per_s", per_second(steps * static_cast<double>(r.particles), r.wall_s)},
      {"digest", r.digest},
      {"monitors", Json::object(monitors)},
      {"files", Json::object({{"trajectory", json_of(r.trajectory)}, {"checkpoint", json_of(r.checkpoint)}})}};
  if (const auto& list = r.evaluations.neighbors) {
    members.emplace_back("neighbors", Json::object({{"updates", list->updates},
                                                    {"searches", list->searches},
                                                    {"search_seconds", list->search_seconds},
                                                    {"sorts", list->sorts},
                                                    {"sort_seconds", list->sort_seconds},
                                                    {"pairs_per_particle", list->pairs},
                                                    {"skin", list->skin}}));
  }
  if (r.solver) {
    const ConstraintWork& work = r.evaluations.constraint;
    const Json contraction = work.measured > 0 ? Json(work.contraction()) : Json();
    members.emplace_back("constraints", Json::object({{"solver", std::string(info_of(*r.solver).name)},
                                                      {"direct", info_of(*r.solver).direct},
                                                      {"iterations", work.iterations},
                                                      {"contraction", contraction}}));
  }
  if (const ProjectionWork& work = r.evaluations.projection; work.steps > 0) {
    members.emplace_back("projection",
                         Json::object({{"steps", work.steps}, {"iterations", work.iterations}, {"mean", work.mean()}}));
  }
  if (!r.cost.empty()) members.emplace_back("cost", json_of(r.cost));
  if (r.minimized) {
    members.emplace_back("minimized", Json::object({{"force", r.minimized->force}, {"steps", r.minimized->steps}}));
  }
  if (!r.epoch.empty()) members.emplace_back("epoch", r.epoch);
  if (r.start_time != 0) members.emplace_back("start_time", r.start_time);
  if (!r.warnings.empty()) members.emplace_back("warnings", Json::list_of(r.warnings));
  if (!r.notes.empty()) members.emplace_back("notes", Json::list_of(r.notes));
  return Json::object(members).text();
}

namespace {

/// Whether there are figures, and none of them is a number.
bool saw_only_nan(const MonitorReport& m) {
  bool seen = false, number = false;
  for (const auto& value : {m.first, m.last, m.worst, m.rms}) {
    seen = seen || value;
    number = number || (value && !std::isnan(*value));
  }
  return seen && !number;
}

std::string figures(const MonitorReport& m) {
  std::string text;
  const auto add = [&](const char* name, const std::optional<double>& value, const std::string& unit) {
    if (value && !std::isnan(*value))
      text += fmt::format("{}{} {:.3g}{}{}", text.empty() ? "" : ", ", name, *value, unit.empty() ? "" : " ", unit);
  };
  add("worst", m.worst, "");
  add("rms", m.rms, "");
  add("slope", m.slope, m.slope_unit == "1" ? "" : m.slope_unit);
  if (m.slope && m.slope_error && !std::isnan(*m.slope_error)) text += fmt::format(" +- {:.1g}", *m.slope_error);
  if (!m.worst) add("last", m.last, "");
  if (!m.verdict.empty()) text += fmt::format("{}{}", text.empty() ? "" : "; ", m.verdict);
  if (text.empty() && saw_only_nan(m)) text = "no finite value was recorded";
  for (const std::string& words : {m.reason, m.note}) {
    if (!words.empty()) text += fmt::format("{}{}", text.empty() ? "" : "; ", words);
  }
  return text.empty() ? "watched" : text;
}

/// "cost: force lennard_jones 71.3 % (1.2 s), neighbors 20.1 % (0.34 s), integrator 8.6 % (0.15 s)"
std::string cost_in_words(const std::vector<CostBook::Entry>& cost) {
  const double all = seconds_of(cost);
  std::string text;
  for (const CostBook::Entry& one : cost) {
    text += fmt::format("{}{}{} {:.1f} % ({:.3g} s)", text.empty() ? "cost: " : ", ", one.kind,
                        one.name.empty() ? "" : " " + one.name, all > 0 ? 100 * one.seconds / all : 0, one.seconds);
  }
  return text.empty() ? text : text + "\n";
}

/// "constraints: 52932 iterations in all, 7.06 for each force evaluation; one leaves 0.023 of the violation"
std::string constraints_in_words(const RunReport& r) {
  const ConstraintWork& work = r.evaluations.constraint;
  if (!r.solver || (work.iterations == 0 && !info_of(*r.solver).direct)) return "";
  const ConstraintMethodInfo& info = info_of(*r.solver);
  std::string text = "constraints: ";
  if (info.direct)
    text += fmt::format("solved directly by {}{}", info.name, work.iterations > 0 ? "; beyond it, " : "");
  if (work.iterations > 0) {
    const bool series = info.end == SolverEnd::order;
    text += fmt::format(
        "{} in all, {:.3g} for each force evaluation",
        series ? counted(work.iterations, "power of the series", "powers of the series")
               : counted(work.iterations, "iteration"),
        static_cast<double>(work.iterations) / static_cast<double>(std::max<std::int64_t>(r.evaluations.force, 1)));
    if (work.measured > 0) text += fmt::format("; one leaves {:.2g} of the violation", work.contraction());
  }
  return text + "\n";
}

}  // namespace

std::string to_text(const RunReport& r) { return headline_of(r) + "\n" + details_of(r); }

std::string headline_of(const RunReport& r, bool why) {
  const std::string unit = r.time_unit == "1" ? "" : " " + r.time_unit;
  const std::string how = why ? to_text(r.outcome) : fmt::format("{} at step {}", name(r.outcome.kind), r.outcome.step);
  return fmt::format("{}, time {:.9g}{}", how, r.outcome.time, unit);
}

std::string details_of(const RunReport& r) {
  const std::string unit = r.time_unit == "1" ? "" : " " + r.time_unit;
  std::string text;
  if (r.minimized) {
    text += fmt::format("minimized: largest force {:.3g}{}{} after {}\n", r.minimized->force,
                        r.force_unit == "1" ? "" : " ", r.force_unit == "1" ? "" : r.force_unit,
                        counted(r.minimized->steps, "force evaluation"));
  }
  if (r.outcome.unresolved > 0) {
    text += fmt::format(
        "stop: {} a pair may have met between two checks that were too far apart to tell; check more often, or take "
        "shorter steps\n",
        counted(r.outcome.unresolved, "time"));
  }
  const std::string begun = r.start_time == 0 ? "" : fmt::format("time {:.9g}{}", r.start_time, unit);
  if (!r.epoch.empty()) text += fmt::format("bodies: as of {}{}\n", r.epoch, begun.empty() ? "" : ", at " + begun);
  if (r.epoch.empty() && !begun.empty()) text += fmt::format("begun at {}\n", begun);
  for (const std::string& warning : r.warnings) text += fmt::format("warning: {}\n", warning);
  if (r.resumed_from_step) text += fmt::format("resumed from step {}\n", *r.resumed_from_step);
  for (const auto& [name, monitor] : r.monitors) {
    text += fmt::format("{}: {} ({})\n", name, figures(monitor), counted(monitor.samples, "sample"));
  }
  if (r.wall_s > 0 && r.steps_made > 0) {
    text += fmt::format("{} of {} over {} in {:.3g} s: {:.3g} steps/s on {}", counted(r.steps_made, "step"), r.method,
                        r.hamiltonian, r.wall_s, static_cast<double>(r.steps_made) / r.wall_s,
                        counted(r.threads, "thread"));
    if (const auto& list = r.evaluations.neighbors) {
      text += fmt::format(", {:.2g} s of it in searches for neighbors, with {} into cells in {:.2g} s",
                          list->search_seconds, counted(list->sorts, "sort"), list->sort_seconds);
    }
    text += "\n";
  }
  text += cost_in_words(r.cost);
  text += constraints_in_words(r);
  if (const ProjectionWork& work = r.evaluations.projection; work.steps > 0) {
    text += fmt::format("projection: {} for {}, {:.3g} for each\n", counted(work.iterations, "iteration"),
                        counted(work.steps, "step"), work.mean());
  }
  if (const auto& list = r.evaluations.neighbors) {
    text +=
        fmt::format("neighbors: {} in {}, {:.3g} listed for each particle\n",
                    counted(list->searches, "search", "searches"), counted(list->updates, "evaluation"), list->pairs);
  }
  for (const std::filesystem::path& file : {r.trajectory, r.checkpoint}) {
    if (!file.empty()) text += fmt::format("wrote {}\n", file.string());
  }
  return text + r.digest + "\n";
}

}  // namespace noether
