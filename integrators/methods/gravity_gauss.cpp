#include "integrators/methods/gravity_gauss.hpp"

#include "integrators/methods/collocation_simd.hpp"
#include "integrators/methods/gravity_gauss_simd.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace noether {

namespace {

/// Above, forces have their lanes filled with particles.
constexpr Index most_bodies = 64;
/// A sweep that changes a rate by this part of itself is followed by changes of a hundredth of it, and what these leave
/// in the step is a hundredth again.
constexpr double settled_change = 1e-14;
constexpr int most_sweeps = 40;
/// Of displacements, relative to these, by which rates of two sweeps may differ for ever.
constexpr double rounding_of_displacements = 0x1p-50;
/// A step becomes longer if it may have more than so many times its length: by more than two rungs, and by more where
/// it has become shorter before, or it would climb and fall with every orbit.
constexpr double after_longer = 1.25, after_shorter = 1.5;
/// Sweeps after which a change that is rounding of the parts of a rate, but not of their sum, is looked for.
constexpr int many_sweeps = 12;

double signed_as(double size, double sign) { return std::copysign(size, sign); }

}  // namespace

GravityGauss::GravityGauss(const MethodInfo& info, const MethodOptions& options, const CollocationTable& table,
                           bool symplectic)
    : general_(info, options, table, symplectic),
      table_(table),
      order_(info.order),
      mirrored_(symplectic && table.stages() == stages),
      adaptive_(info.is_adaptive(options)),
      rtol_(options.rtol.value_or(info.rtol)),
      first_(options.first.value_or(0)),
      tolerance_(adaptive_ ? std::max(settled_change, 1e-2 * rtol_) : settled_change),
      control_(table, mirrored_, rtol_),
      predictor_(table) {
  for (std::size_t j = 0; j < table.stages(); ++j) {
    const Quad odd = table.b[j] * (Quad(0.5) - table.c[j]);
    odd_[j] = static_cast<double>(odd);
    odd_low_[j] = static_cast<double>(odd - Quad(odd_[j]));
  }
  const auto twice = table.twice();
  for (std::size_t j = 0; j < table.stages(); ++j) {
    for (std::size_t i = 0; i < stages; ++i) {
      const Quad entry = twice[i < table.stages() ? i : 0][j];
      unit_twice_[j][i] = static_cast<double>(entry);
      unit_twice_low_[j][i] = static_cast<double>(entry - Quad(unit_twice_[j][i]));
    }
  }
}

void GravityGauss::bind(const VectorField<double>& f) {
  general_.bind(f);
  n_ = f.particles();
  pairs_ = 0;
  in_use_ = (adaptive_ || table_.stages == lane_count) && n_ >= 2 && n_ <= most_bodies && f.gravity_of_points() &&
            !f.has_forces_beside_gravity() && bind_masses(f);
  if (!in_use_) return;
  if (adaptive_) predictor_.reserve();
  const auto padded = static_cast<std::size_t>((3 * n_ + 7) / 8 * 8);
  for (auto* all : {&made_[0], &made_[1], &now_, &before_, &known_, &d_}) all->assign(stages * padded, 0);
  low_.assign(static_cast<std::size_t>(6 * n_), 0);
  on_grid_.assign(static_cast<std::size_t>(6 * n_), 0);
  apart_.assign(3 * stages * static_cast<std::size_t>(pairs_), 0);
  sizes_.assign(static_cast<std::size_t>(n_), 0);
  h_ = h_before_ = next_ = length_ = ratio_ = 0;
  grids_ = {};
  longer_ = after_longer;
  sweeps_ = 0;
}

/// @return whether all masses, and their products, stay in the range of doubles
bool GravityGauss::bind_masses(const VectorField<double>& f) {
  const double G = *f.gravity_of_points();
  const Vector<double> all = f.masses();
  std::vector<double> masses(all.data(), all.data() + n_);
  const double heaviest = *std::max_element(masses.begin(), masses.end());
  if (!std::all_of(masses.begin(), masses.end(), [](double m) { return m >= 0 && std::isfinite(m); })) return false;
  if (!(heaviest > 0)) return false;
  massive_.clear();
  tracers_.clear();
  for (Index i = 0; i < n_; ++i) (masses[static_cast<std::size_t>(i)] > 0 ? massive_ : tracers_).push_back(i);
  const double unit = std::ldexp(1.0, std::ilogb(heaviest));
  bool in_range = true;
  const auto put = [&](const Quad& exact, std::vector<double>& high, std::vector<double>& low, bool relative) {
    const auto rounded = static_cast<double>(exact);
    in_range = in_range && rounded > 1e-120 && rounded < 1e120;
    const Quad lost = exact - Quad(rounded);
    high.push_back(rounded);
    low.push_back(static_cast<double>(relative && in_range ? lost / Quad(rounded) : lost));
  };
  for (auto* numbers : {&weight_, &weight_low_, &inverse_, &inverse_low_}) numbers->clear();
  const auto mass = [&](std::ptrdiff_t i) { return Quad(masses[static_cast<std::size_t>(i)]); };
  for (std::size_t k = 0; k < massive_.size(); ++k) {
    put(Quad(unit) / mass(massive_[k]), inverse_, inverse_low_, false);
    for (std::size_t l = k + 1; l < massive_.size(); ++l)
      put(Quad(G) * mass(massive_[k]) * (mass(massive_[l]) / Quad(unit)), weight_, weight_low_, true);
  }
  for (std::size_t k = 0; k < tracers_.size(); ++k) {
    for (const std::ptrdiff_t j : massive_) put(Quad(G) * mass(j), weight_, weight_low_, true);
  }
  pairs_ = static_cast<Index>(weight_.size());
  control_.bind(masses);
  return in_range;
}

AttractingBodies GravityGauss::bodies() const {
  return {massive_.data(),
          tracers_.data(),
          static_cast<std::ptrdiff_t>(massive_.size()),
          static_cast<std::ptrdiff_t>(tracers_.size()),
          weight_.data(),
          weight_low_.data(),
          inverse_.data(),
          inverse_low_.data()};
}

double GravityGauss::next_step(VectorField<double>& f, const double& t, const Vector<double>& y, double h) {
  if (!in_use_) return general_.next_step(f, t, y, h);
  if (next_ == 0) {
    next_ =
        first_ > 0 ? signed_as(first_, h) : first_step(f, t, y, order_, Tolerance(std::max(rtol_, 1e-14), 1e-300), h);
    ladder_ = StepLadder::around(std::abs(next_));
    if (first_ <= 0) next_ = signed_as(ladder_.unit(), next_);
  }
  return shorter(next_, h);
}

StepResult GravityGauss::step(VectorField<double>& f, const double& t, Vector<double>& y, double h) {
  if (in_use_ && adaptive_) return adaptive_step(f, t, y, h);
  if (in_use_) {
    set_length(h);
    if (solve(f, y)) {
      finish(y);
      StepResult made;
      made.h = h;
      return made;
    }
    general_.go_on_from(low_, made_[0], 0);
    in_use_ = false;
  }
  return general_.step(f, t, y, h);
}

StepResult GravityGauss::adaptive_step(VectorField<double>& f, const double& t, Vector<double>& y, double most) {
  StepResult made;
  while (true) {
    made.h = next_step(f, t, y, most);
    const double h = std::abs(made.h), at_hand = std::abs(next_);
    set_length(made.h);
    const bool converged = solve(f, y);
    StageControl::Lengths may;
    if (converged) may = control_.lengths(now_.data(), h, at_hand);
    if (converged && may.made >= StageControl::kept * h) {
      double next = at_hand;
      if (may.next < at_hand) next = ladder_.below(std::max(may.next, 0.2 * at_hand));
      if (may.next > longer_ * at_hand) next = ladder_.below(std::min(0.98 * may.next, 3 * at_hand));
      if (next != at_hand) longer_ = next < at_hand ? after_shorter : after_longer;
      next_ = signed_as(next, made.h);
      finish(y);
      return made;
    }
    ++made.rejected;
    next_ = signed_as(ladder_.below(h * (converged ? std::clamp(may.made / h, 0.2, 0.9) : 0.5)), made.h);
    longer_ = after_shorter;
    made.failure = underflow(t, next_);
    if (made.failure) return made;
  }
}

/// What depends on the length of a step.
void GravityGauss::set_length(double h) {
  if (h == length_) return;
  length_ = h;
  for (std::size_t i = 0; i < stages; ++i) {
    const DoubleDouble both = DoubleDouble::product(table_.c[i], h);
    c_h_[i] = both.high;
    c_h_low_[i] = both.low + table_.c_low[i] * h;
  }
  const DoubleDouble h2 = DoubleDouble::product(h, h);
  gravity_gauss_kernels().scale_table(h2.high, h2.low, unit_twice_[0].data(), unit_twice_low_[0].data(),
                                      twice_[0].data(), twice_low_[0].data());
}

/// Takes a grid that reaches four times as far as positions, or velocities, where one of them is beyond half of the one
/// at hand.
void GravityGauss::widen_grids(const Vector<double>& y) {
  for (Index half = 0; half < 2; ++half) {
    double& grid = grids_[static_cast<std::size_t>(half)];
    double most = 0;
    for (Index k = 0; k < 3 * n_; ++k) most = std::max(most, std::abs(y[3 * n_ * half + k]));
    if (2 * most <= grid) continue;
    int exponent = 0;
    static_cast<void>(std::frexp(4 * most, &exponent));
    grid = std::ldexp(1.0, exponent);
  }
}

void GravityGauss::begin(const Vector<double>& y) {
  widen_grids(y);
  const StepBeginning beginning{
      n_, y.data(), low_.data(), c_h_.data(), c_h_low_.data(), {grids_[0], grids_[1]}, on_grid_.data(), known_.data()};
  gravity_gauss_kernels().begin(beginning);
  gravity_gauss_kernels().separations(bodies(), beginning, apart_.data());
}

/// The first displacements of a step.
void GravityGauss::predict() {
  if (h_ == 0) {
    std::copy(known_.begin(), known_.end(), d_.begin());
    return;
  }
  const double* const rates = made_[0].data();
  const double h2 = length_ * length_;
  // A step that is shortened, to be shown or by `max_step`, has a length of its own, which may not be met again.
  const bool shown = adaptive_ && length_ != next_ && length_ != h_;
  if (!shown && StepPredictor::serves(length_, h_, h_before_)) {
    gravity_gauss_kernels().first_displacements(
        3 * n_, rates, made_[1].data(), predictor_.weights(length_, h_, h_before_), h2, known_.data(), d_.data());
    return;
  }
  if (const double ratio = length_ / h_; ratio != ratio_) {
    StageMatrix<double> polynomial{};
    StageArithmetic<double>{}.extrapolation(table_.stages, table_.c, table_.barycentric, ratio, polynomial);
    collocation_kernels().combine({lane_count, polynomial[0].data(), nullptr, nullptr, 0, 0, 0}, table_.twice[0].data(),
                                  extrapolation_[0].data());
    ratio_ = ratio;
  }
  gravity_gauss_kernels().first_displacements(3 * n_, rates, nullptr, extrapolation_[0].data(), h2, known_.data(),
                                              d_.data());
}

/// Rates of all stages at their displacements. @return whether all distances are in the range of doubles
bool GravityGauss::attract(VectorField<double>& f, Numbers& rates) {
  f.evaluations().force += table_.stages;
  return gravity_gauss_kernels().attract(bodies(), n_, d_.data(), apart_.data(), pairs_, rates.data()) > 1e-200;
}

void GravityGauss::displace(const Numbers& rates) {
  gravity_gauss_kernels().displacements(3 * n_, rates.data(), twice_[0].data(), known_.data(), d_.data());
}

/// What rounding has taken from the table, which would be a drift: rates of the first sweep are good enough for it.
void GravityGauss::complete_known(const Numbers& rates) {
  gravity_gauss_kernels().displacements(3 * n_, rates.data(), twice_low_[0].data(), known_.data(), known_.data());
}

/// Sweeps, and leaves the rates in `now_`: as many as the last step has taken, then the test; one less is tried next
/// time where it would have done. @return whether they converge
bool GravityGauss::solve(VectorField<double>& f, const Vector<double>& y) {
  begin(y);
  predict();
  const auto moved = [&](double tolerance) {
    return gravity_gauss_kernels().moved(n_, now_.data(), before_.data(), tolerance);
  };
  const int least = h_ != 0 ? std::max(2, sweeps_) : 3;
  attract(f, before_);
  complete_known(before_);
  displace(before_);
  int swept = 2;
  for (; swept < least; ++swept) {
    attract(f, before_);
    displace(before_);
  }
  bool far = attract(f, now_);
  if (far && !moved(tolerance_)) {
    sweeps_ = moved(0.02 * tolerance_) ? least : std::max(2, least - 1);
    return true;
  }
  while (swept < most_sweeps) {
    std::swap(now_, before_);
    displace(before_);
    far = attract(f, now_);
    sweeps_ = std::min(++swept, many_sweeps);
    if (far && (!moved(tolerance_) || (swept > many_sweeps && is_rounding()))) return true;
  }
  return false;
}

/// Whether the last sweep has changed rates by no more than rounding of the pulls that they are sums of, which may
/// nearly cancel, and of displacements, which two bodies may have in common.
bool GravityGauss::is_rounding() {
  const auto n = static_cast<std::size_t>(n_);
  for (std::size_t k = 0; k < stages; ++k) {
    const auto component = [&](const Numbers& of, std::ptrdiff_t body, std::size_t axis) {
      return of[stages * (n * axis + static_cast<std::size_t>(body)) + k];
    };
    std::fill(sizes_.begin(), sizes_.end(), 0.0);
    std::size_t pair = 0;
    const auto pull = [&](std::ptrdiff_t i, std::ptrdiff_t j) {  // by its size
      double r2 = 0, d2 = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double apart = apart_[stages * (static_cast<std::size_t>(pairs_) * axis + pair) + k];
        const double x = (component(d_, j, axis) - component(d_, i, axis)) + apart;
        r2 += x * x;
        d2 += component(d_, i, axis) * component(d_, i, axis);
      }
      return weight_[pair++] / r2 * std::max(1.0, rounding_of_displacements / settled_change * std::sqrt(d2 / r2));
    };
    for (std::size_t a = 0; a < massive_.size(); ++a) {
      for (std::size_t b = a + 1; b < massive_.size(); ++b) {
        const double both = pull(massive_[a], massive_[b]);
        sizes_[static_cast<std::size_t>(massive_[a])] += both * inverse_[a];
        sizes_[static_cast<std::size_t>(massive_[b])] += both * inverse_[b];
      }
    }
    for (const std::ptrdiff_t i : tracers_) {
      for (const std::ptrdiff_t j : massive_) sizes_[static_cast<std::size_t>(i)] += pull(i, j);
    }
    for (std::size_t i = 0; i < n; ++i) {
      double change2 = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto body = static_cast<std::ptrdiff_t>(i);
        const double change = component(now_, body, axis) - component(before_, body, axis);
        change2 += change * change;
      }
      if (!(std::sqrt(change2) <= settled_change * sizes_[i])) return false;
    }
  }
  return true;
}

void GravityGauss::finish(Vector<double>& y) {
  const DoubleDouble h2 = DoubleDouble::product(length_, length_);
  double *const x = y.data(), *const v = x + 3 * n_;
  gravity_gauss_kernels().finish({3 * n_, now_.data(), table_.ends[0].data(), table_.ends[1].data(), odd_.data(),
                                  odd_low_.data(), mirrored_, table_.stages / 2, length_, 0.5 * h2.high, 0.5 * h2.low,
                                  x, low_.data(), v, low_.data() + 3 * n_});
  std::swap(made_[0], made_[1]);
  std::swap(made_[0], now_);
  h_before_ = h_;
  h_ = length_;
}

double GravityGauss::action(VectorField<double>& f, const double& t, const Vector<double>& y) {
  if (in_use_) general_.go_on_from(low_, made_[0], h_);
  return general_.action(f, t, y);
}

void GravityGauss::moved(VectorField<double>& f, const double& t, const Vector<double>& y) {
  if (in_use_) {
    std::fill(low_.begin(), low_.end(), 0.0);
  } else {
    general_.moved(f, t, y);
  }
}

void GravityGauss::save(SavedState& saved, const std::string& prefix) const {
  if (!in_use_) {
    general_.save(saved, prefix);
    if (pairs_ > 0) save_value(saved, prefix + "gravity", false);
    return;
  }
  save_value(saved, prefix + "gravity", true);
  save_value(saved, prefix + "next", next_);
  save_value(saved, prefix + "ladder", ladder_.unit());
  save_value(saved, prefix + "longer", longer_);
  save_value(saved, prefix + "h", h_);
  save_value(saved, prefix + "h_before", h_before_);
  save_value(saved, prefix + "grids", std::vector<double>(grids_.begin(), grids_.end()));
  save_value(saved, prefix + "swept", std::int64_t{sweeps_});
  save_value(saved, prefix + "low", std::vector<double>(low_.begin(), low_.end()));
  save_value(saved, prefix + "previous", std::vector<double>(made_[0].begin(), made_[0].end()));
  save_value(saved, prefix + "before", std::vector<double>(made_[1].begin(), made_[1].end()));
}

/// Runs of versions without a form for gravity have the rates of one step, and no grid.
void GravityGauss::load(const SavedState& saved, const std::string& prefix) {
  bool gravity = in_use_;
  if (saved.contains(prefix + "gravity")) load_value(saved, prefix + "gravity", gravity);
  in_use_ = in_use_ && gravity;
  if (!in_use_) return general_.load(saved, prefix);
  load_value(saved, prefix + "next", next_);
  load_value(saved, prefix + "h", h_);
  std::int64_t sweeps = 0;
  load_value(saved, prefix + "swept", sweeps);
  sweeps_ = static_cast<int>(std::clamp<std::int64_t>(sweeps, 0, many_sweeps));
  const auto load_all = [&](const std::string& name, Numbers& into) {
    std::vector<double> read;
    load_value(saved, prefix + name, read);
    for (std::size_t k = 0; k < into.size(); ++k) into[k] = detail::element(read, k);
  };
  load_all("low", low_);
  load_all("previous", made_[0]);
  h_before_ = 0;
  grids_ = {};
  longer_ = after_longer;
  if (next_ != 0) ladder_ = StepLadder::around(std::abs(next_));
  if (!saved.contains(prefix + "before")) return;
  double unit = 1;
  load_value(saved, prefix + "ladder", unit);
  ladder_ = StepLadder(unit);
  load_value(saved, prefix + "longer", longer_);
  load_value(saved, prefix + "h_before", h_before_);
  std::vector<double> grids;
  load_value(saved, prefix + "grids", grids);
  for (std::size_t k = 0; k < grids_.size(); ++k) grids_[k] = detail::element(grids, k);
  load_all("before", made_[1]);
}

}  // namespace noether
