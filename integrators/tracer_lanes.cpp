#include "integrators/tracer_lanes.hpp"

#include "integrators/tracers_simd.hpp"
#include "numbers/error.hpp"
#include "numbers/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

namespace noether {

void TracerLanes::bind(const PlanetSystem& system, const std::vector<std::int64_t>& tracers,
                       const std::vector<int>& levels) {
  *this = {};
  const double star = system.masses[0];
  jacobi_ = system.jacobi;
  star_mu_ = system.G * star;
  relativity_ = system.bend.value_or(0);
  far_ = 1e3 * system.size;
  planets_.assign(system.order.begin() + 1, system.order.end());
  double interior = star;
  mu_.push_back(star_mu_);
  for (const std::int64_t i : planets_) {
    const double mass = system.masses[static_cast<std::size_t>(i)];
    attraction_.push_back(system.G * mass);
    mu_.push_back(system.G * (interior += mass));
  }
  near_.assign(planets_.size(), 0);

  for (int level = 0; level < static_cast<int>(mu_.size()); ++level) {
    for (std::size_t k = 0; k < tracers.size(); ++k) {
      if (levels[k] == level) particle_.push_back(tracers[k]);
    }
    particle_.resize((particle_.size() + lanes - 1) / lanes * lanes, -1);
    level_.resize(particle_.size() / lanes, level);
  }
  s_.assign(particle_.size(), 0);
  next_s_ = s_;
}

void TracerLanes::watch_from(const EncounterWatch& watch) {
  const auto first = std::find_if(particle_.begin(), particle_.end(), [](std::int64_t i) { return i >= 0; });
  for (std::size_t j = 0; first != particle_.end() && j < planets_.size(); ++j) {
    const double near = watch.square_of_news(static_cast<Index>(*first), static_cast<Index>(planets_[j]));
    if (near == near_[j]) return;  // nothing has been noted since
    near_[j] = near;
  }
}

TracerLanes::Columns TracerLanes::columns_of(ParticleSystem<double>& s) {
  Columns columns;
  auto* low = s.low_words();
  columns.compensated = low != nullptr;
  for (int c = 0; c < 3; ++c) {
    columns.x[c] = s.positions().component(c);
    columns.v[c] = s.velocities().component(c);
    columns.x_low[c] = low != nullptr ? low->x.component(c) : nullptr;
    columns.v_low[c] = low != nullptr ? low->v.component(c) : nullptr;
  }
  return columns;
}

void TracerLanes::load_row(const Columns& from, std::size_t row, ArcRow& to) const {
  to = {};
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const std::size_t slot = row * lanes + lane;
    const std::int64_t i = particle_[slot];
    to.s[lane] = s_[slot];
    if (i < 0) {
      to.x[0][lane] = distance_of_none(slot);
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      to.x[c][lane] = from.x[c][i];
      to.v[c][lane] = from.v[c][i];
      if (!from.compensated) continue;
      to.x_low[c][lane] = from.x_low[c][i];
      to.v_low[c][lane] = from.v_low[c][i];
    }
    to.mu[lane] = mu_[static_cast<std::size_t>(level_[row])];
    to.moves[lane] = 1;
  }
}

void TracerLanes::store_row(const ArcRow& from, std::size_t row, const Columns& to) {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const std::size_t slot = row * lanes + lane;
    const std::int64_t i = particle_[slot];
    next_s_[slot] = from.s[lane];
    for (int c = 0; i >= 0 && c < 3; ++c) {
      to.x[c][i] = from.x[c][lane];
      to.v[c][i] = from.v[c][lane];
      if (!to.compensated) continue;
      to.x_low[c][i] = from.x_low[c][lane];
      to.v_low[c][i] = from.v_low[c][lane];
    }
  }
}

std::optional<TracerLanes::Lost> TracerLanes::follow(ParticleSystem<double>& s, const PlanetPath& path,
                                                     EncounterWatch& watch) {
  const Columns columns = columns_of(s);
  struct Watched {
    const TracerLanes* tracers;
    EncounterWatch* watch;
    bool backward;
  } watched{this, &watch, s.clock().direction() == Direction::backward};
  const auto note = [](void* to, std::ptrdiff_t tracer, std::ptrdiff_t planet, double r2, double nearer2, double time) {
    const Watched& at = *static_cast<const Watched*>(to);
    at.watch->note(static_cast<Index>(at.tracers->particle_[static_cast<std::size_t>(tracer)]),
                   static_cast<Index>(at.tracers->planets_[static_cast<std::size_t>(planet)]), r2, nearer2, time,
                   at.backward);
  };
  const TracerTask task{.letters = path.letters().data(),
                        .count = static_cast<std::ptrdiff_t>(path.letters().size()),
                        .numbers = path.numbers().data(),
                        .planets = static_cast<std::ptrdiff_t>(planets_.size()),
                        .attraction = attraction_.data(),
                        .near = near_.data(),
                        .star = star_mu_,
                        .relativity = relativity_,
                        .jacobi = jacobi_,
                        .compensated = columns.compensated,
                        .exact = exact_arc,
                        .note = note,
                        .watch = &watched};
  std::mutex mutex;
  std::ptrdiff_t lost_at = -1, lost = -1;
  for_blocks(static_cast<Index>(particle_.size()), [&](Index begin, Index end) {
    static_assert(rows_of_block * lanes == block_size);
    ArcRow rows[rows_of_block];
    const std::size_t first = static_cast<std::size_t>(begin) / lanes, last = static_cast<std::size_t>(end) / lanes;
    const auto count = static_cast<std::ptrdiff_t>(last - first);
    for (std::size_t k = first; k < last; ++k) load_row(columns, k, rows[k - first]);
    tracer_kernels().prepare(rows, count);
    const TracerReport report = tracer_kernels().follow(task, rows, level_.data() + first, count, begin);
    for (std::size_t k = first; k < last; ++k) store_row(rows[k - first], k, columns);
    if (report.lost_at < 0) return;
    const std::lock_guard<std::mutex> lock(mutex);
    if (lost_at < 0 || report.lost_at < lost_at || (report.lost_at == lost_at && report.lost < lost))
      lost_at = report.lost_at, lost = report.lost;
  });
  if (lost < 0) return {};
  return Lost{path.letters()[static_cast<std::size_t>(lost_at)].step,
              static_cast<Index>(particle_[static_cast<std::size_t>(lost)])};
}

void TracerLanes::save(SavedState& saved, const std::string& prefix, bool predicted) const {
  std::vector<double> s;
  for (std::size_t slot = 0; predicted && slot < particle_.size(); ++slot) {
    if (particle_[slot] >= 0) s.push_back(s_[slot]);
  }
  save_value(saved, prefix + "predicted", s);
}

bool TracerLanes::load(const SavedState& saved, const std::string& prefix, double last) {
  if (!saved.contains(prefix + "predicted")) return false;  // written when tracers went letter by letter
  std::vector<double> s;
  load_value(saved, prefix + "predicted", s);
  if (s.empty()) return false;
  std::size_t known = 0;
  for (std::size_t slot = 0; slot < particle_.size(); ++slot) {
    if (particle_[slot] < 0) {
      s_[slot] = last / distance_of_none(slot);
    } else if (known++ < s.size()) {
      s_[slot] = s[known - 1];
    }
  }
  if (known != s.size()) throw Error("the saved predictions of Kepler arcs do not match these tracers");
  return true;
}

}  // namespace noether
