#include "integrators/encounters.hpp"

#include "numbers/error.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <tuple>

namespace noether {

void EncounterWatch::bind(const std::vector<double>& masses, const std::vector<std::int64_t>& ids) {
  masses_ = masses;
  ids_ = ids;
  reach_.clear();
  // The sum of two is at least the reach of both masses together, by which `note` goes.
  for (const double m : masses) reach_.push_back(encounter_hill_radii * std::cbrt(m / masses[0] / 3));
  known_ = closest_.has_value();
}

void EncounterWatch::note(Index i, Index j, double r2, double nearer_to_primary2, double time, bool backward) {
  const auto first = static_cast<std::size_t>(j), second = static_cast<std::size_t>(i);
  const double hill = std::cbrt((masses_[first] + masses_[second]) / masses_[0] / 3) * std::sqrt(nearer_to_primary2);
  Encounter seen{ids_[first], ids_[second], std::sqrt(r2) / hill, time, time};
  if (!(seen.hill_radii < encounter_hill_radii)) return;
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  if (closest_ && (known_ || (closest_->since < time) != backward)) seen.since = closest_->since;
  const auto rank = [](const Encounter& e) { return std::tuple(e.hill_radii, e.first, e.second); };
  const double since = seen.since;
  if (!closest_ || rank(seen) < rank(*closest_)) closest_ = seen;
  closest_->since = since;
}

double EncounterWatch::square_of_news(Index i, Index j) const {
  if (i == 0 || j == 0) return 0;
  const double bound = closest_ ? std::min(closest_->hill_radii, encounter_hill_radii) : encounter_hill_radii;
  const double masses = masses_[static_cast<std::size_t>(i)] + masses_[static_cast<std::size_t>(j)];
  const double ratio = bound * std::cbrt(masses / masses_[0] / 3);
  return ratio * ratio * (1 + 1e-12);
}

void EncounterWatch::save(SavedState& saved, const std::string& prefix) const {
  std::vector<std::int64_t> ids;
  std::vector<double> numbers;
  if (closest_) {
    ids = {closest_->first, closest_->second};
    numbers = {closest_->hill_radii, closest_->time, closest_->since};
  }
  save_value(saved, prefix + "ids", ids);
  save_value(saved, prefix + "numbers", numbers);
}

void EncounterWatch::load(const SavedState& saved, const std::string& prefix) {
  closest_.reset();
  known_ = false;
  if (!saved.contains(prefix + "ids")) return;  // written before encounters were noted
  std::vector<std::int64_t> ids;
  std::vector<double> numbers;
  load_value(saved, prefix + "ids", ids);
  load_value(saved, prefix + "numbers", numbers);
  if (ids.empty() && numbers.empty()) return;
  if (ids.size() != 2 || numbers.size() != 3) throw Error("the saved encounter of two bodies is damaged");
  closest_ = Encounter{ids[0], ids[1], numbers[0], numbers[1], numbers[2]};
  known_ = true;
}

}  // namespace noether
