#include "constraints/constraint_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace noether {

void ConstraintOptions::check() const {
  if (!(tolerance > 0 && tolerance < 1)) {
    refuse_field("tolerance", tolerance, "is not a valid relative violation; a number between 0 and 1 is expected");
  }
  if (most_iterations() < 1) {
    refuse_field("iterations", static_cast<double>(most_iterations()),
                 "is not a valid number of sweeps; at least 1 is expected");
  }
  if (order < 1 || order > 1000) {
    refuse_field("order", static_cast<double>(order),
                 "is not a valid order of a series; a number from 1 to 1000 is expected");
  }
}

double ConstraintOptions::violation() const {
  switch (end()) {
    case SolverEnd::rounding:
      return 0;
    case SolverEnd::tolerance:
      return tolerance;
    case SolverEnd::order:
      break;
  }
  // Bonds turn by some degrees in a step: a power of the series gains a factor of 2, a correction of 20.
  const double by_series = 0.01 * std::pow(0.5, static_cast<double>(order));
  const double by_corrections = 1e-4 * std::pow(0.05, static_cast<double>(most_iterations() - 1));
  return std::max({by_series, by_corrections, 1e-15});
}

std::string ConstraintOptions::signature() const {
  std::string text = fmt::format("constraint_solver(solver = {}, tolerance = {}, iterations = {}",
                                 static_cast<int>(solver), detail::value_text(tolerance), most_iterations());
  if (end() == SolverEnd::order) text += fmt::format(", order = {}", order);
  return text + ")";
}

ConstraintSet::ConstraintSet(ConstraintOptions options) : options_(options) { options_.check(); }

ConstraintSet::ConstraintSet(const ConstraintSet& other) : options_(other.options_) {
  for (const auto& group : other.groups_) groups_.push_back(group->clone());
}
ConstraintSet& ConstraintSet::operator=(const ConstraintSet& other) { return *this = ConstraintSet(other); }

ConstraintSet ConstraintSet::solved_by(ConstraintOptions options) const {
  options.check();
  ConstraintSet same(*this);
  same.options_ = options;
  return same;
}

ConstraintSet ConstraintSet::only(const std::vector<bool>& keep) const {
  ConstraintSet kept(options_);
  std::size_t equation = 0;
  for (const auto& group : groups_) {
    std::vector<bool> own;
    for (Index c = 0; c < group->size(); ++c, equation += static_cast<std::size_t>(group->equations())) {
      own.push_back(keep[equation]);
    }
    if (auto some = group->only(own)) kept.groups_.push_back(std::move(some));
  }
  return kept;
}

Index ConstraintSet::equations() const {
  Index count = 0;
  for (const auto& group : groups_) count += group->size() * group->equations();
  return count;
}

ConstraintPlace ConstraintSet::place(Index equation) const {
  for (const auto& group : groups_) {
    const Index count = group->size() * group->equations();
    if (equation < count) return {group.get(), equation / group->equations()};
    equation -= count;
  }
  throw LogicError("there is no such equation of constraints");
}

std::string ConstraintSet::words_of(const ConstraintPlace& place, const std::vector<std::string>& names) {
  std::string text = place.group->name();
  const Index count = place.group->particles();
  for (Index k = 0; k < count; ++k) {
    text += k == 0 ? " of " : k + 1 == count ? " and " : ", ";
    text += "'" + names[static_cast<std::size_t>(place.group->particle(place.constraint, k))] + "'";
  }
  return text;
}

template <class Real> ConstraintSet::Worst ConstraintSet::worst(const ParticleSystem<Real>& s) const {
  Worst worst;
  Index equation = 0;
  std::vector<Real> values;
  for (const auto& group : groups_) {
    values.resize(static_cast<std::size_t>(group->equations()));
    for (Index c = 0; c < group->size(); ++c) {
      group->values(ConstraintPositions<Real>(s), c, c + 1, values.data());
      for (const Real& value : values) {
        const double residual = group->residual(c, static_cast<double>(value));
        if (worst.equation < 0 || residual > worst.residual) worst = {residual, equation};
        ++equation;
      }
    }
  }
  return worst;
}
template ConstraintSet::Worst ConstraintSet::worst(const ParticleSystem<double>&) const;
template ConstraintSet::Worst ConstraintSet::worst(const ParticleSystem<Quad>&) const;

bool ConstraintSet::keeps_momentum() const {
  return std::all_of(groups_.begin(), groups_.end(), [](const auto& group) { return group->keeps_momentum(); });
}
bool ConstraintSet::keeps_angular_momentum() const {
  return std::all_of(groups_.begin(), groups_.end(), [](const auto& group) { return group->keeps_angular_momentum(); });
}

std::string ConstraintSet::signature() const {
  std::string text = detail::signature_of(options_);
  for (const auto& group : groups_) text += ", " + group->signature();
  return text;
}

void ConstraintSet::check_particles(const ParticleSystem<double>& s, const std::string& name, const Index* particles,
                                    std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) {
    const Index i = particles[k];
    if (i < 0 || i >= s.size()) {
      throw BadConstraints(fmt::format("{} names particle {}, but there are {}", name, i, s.size()));
    }
    if (std::find(particles, particles + k, i) != particles + k) {
      throw BadConstraints(fmt::format("{} ties '{}' to itself; different particles are expected", name, s.name(i)));
    }
    if (!(s.masses()[i] > 0)) {
      throw BadConstraints(
          fmt::format("{} ties '{}', a tracer of mass 0, which no force can hold; give it a mass", name, s.name(i)));
    }
  }
}

ConstraintSet& add_rigid_bar(ConstraintSet& set, const ParticleSystem<double>& s, const std::vector<Index>& particles) {
  if (particles.size() < 2) {
    throw BadConstraints(fmt::format("a rigid bar ties 2 or more particles, not {}", particles.size()));
  }
  set.add(s, Distance{}, {particles.front(), particles.back()});
  for (std::size_t k = 1; k + 1 < particles.size(); ++k) {
    set.add(s, OnBar{}, {particles.front(), particles[k], particles.back()});
  }
  return set;
}

}  // namespace noether
