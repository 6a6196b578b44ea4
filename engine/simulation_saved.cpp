// Saving and restoring a run.

#include "engine/simulation.hpp"

#include <fmt/format.h>

#include <utility>

namespace noether {

template <class Real> SavedRun Simulation<Real>::save() const {
  SavedRun saved;
  saved.particles = save_particles(raw_);
  SavedState& run = saved.parts["simulation"];
  save_value(run, "observed_through", observed_through_);
  save_value(run, "shown_at", shown_at_);
  integrator_.save(saved.parts["integrator"], "");
  for (const auto& scheduled : monitors_) {
    SavedState& state = saved.parts[scheduled.name];
    save_value(state, "observed", scheduled.observed);
    if (looks_between(scheduled)) save_value(state, "looks_between_steps", std::int64_t{1});
    scheduled.monitor.save(state, "state");
  }
  for (std::size_t k = 0; k < stops_.size(); ++k) stops_[k].check.save(saved.parts[fmt::format("stop_{}", k)], "state");
  return saved;
}

template <class Real> void Simulation<Real>::check_columns(const ParticleSystem<Real>& saved) const {
  for (const auto& column : raw_.columns()) {
    if (!column.info.moves()) continue;
    const auto* found = saved.columns().find(column.info.name);
    if (found != nullptr && found->info == column.info) continue;
    throw Error(fmt::format("the saved run has no column '{}' of {} numbers per particle, which this one moves",
                            column.info.name, column.info.width));
  }
}

template <class Real> void Simulation<Real>::restore(const SavedRun& saved) {
  const auto part = [&](const std::string& name) -> const SavedState& {
    const auto found = saved.parts.find(name);
    if (found == saved.parts.end())
      throw Error("the saved run has no part '" + name + "'; it was made with other parts");
    return found->second;
  };
  ParticleSystem<Real> particles = load_particles<Real>(saved.particles);
  particles.set_topology(raw_.shared_topology());
  particles.set_bodies(raw_.shared_bodies());
  if (particles.ids() != raw_.ids()) throw Error("the saved run has different particles from this one");
  if (particles.variables().size() != raw_.variables().size()) {
    throw Error(fmt::format("the saved run has {} variables, but this one has {}", particles.variables().size(),
                            raw_.variables().size()));
  }
  if (particles.clock().dt() != raw_.clock().dt()) {
    throw Error(
        fmt::format("the saved run has a step of {}, but this one has {}", particles.clock().dt(), raw_.clock().dt()));
  }
  if (particles.clock().direction() != raw_.clock().direction()) {
    const bool back = raw_.clock().direction() == Direction::backward;
    throw Error(fmt::format("the saved run goes {} in time, but this one goes {}", back ? "forward" : "back",
                            back ? "back" : "forward"));
  }
  check_columns(particles);
  integrator_.bind(particles);  // the masses may have been edited
  integrator_.load(part("integrator"), "");
  raw_ = std::move(particles);
  load_value(part("simulation"), "observed_through", observed_through_);
  load_value(part("simulation"), "shown_at", shown_at_);
  for (auto& scheduled : monitors_) {
    detail::Looks& looks = scheduled.schedule;
    const Clock<Real>& clock = raw_.clock();  // of the saved run, which may have begun at another time
    if (!looks.at_steps.empty())
      looks.at_steps = detail::steps_at(looks.times, clock.start(), clock.dt(), scheduled.name);
    if (looks.from) looks.first = detail::first_multiple(*looks.from, clock.start(), clock.dt(), looks.steps);
    load_value(part(scheduled.name), "observed", scheduled.observed);
    const bool of_old = looks_between(scheduled) && !part(scheduled.name).contains("looks_between_steps");
    if (of_old) detail::take_to_steps(looks, clock.start(), clock.dt());
    scheduled.monitor.load(part(scheduled.name), "state");
  }
  for (std::size_t k = 0; k < stops_.size(); ++k) stops_[k].check.load(part(fmt::format("stop_{}", k)), "state");
}

template void Simulation<double>::check_columns(const ParticleSystem<double>& saved) const;
template void Simulation<Quad>::check_columns(const ParticleSystem<Quad>& saved) const;
template SavedRun Simulation<double>::save() const;
template void Simulation<double>::restore(const SavedRun& saved);
template SavedRun Simulation<Quad>::save() const;
template void Simulation<Quad>::restore(const SavedRun& saved);

}  // namespace noether
