#pragma once
/// Constraints of one type, side by side: types are erased per group, never per constraint.

#include "constraints/constraint.hpp"
#include "constraints/parameter_bits.hpp"
#include "engine/particle_system.hpp"
#include "engine/signature.hpp"
#include "engine/tied.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// Where constraints find their particles: in a column of positions, or in a periodic box at the nearest images.
///
/// In a box nothing but differences of positions in the cell, which are exact, and what particles have `moved` since
/// is summed: nothing depends on where the cell is cut.
template <class Real> class ConstraintPositions {
 public:
  /// Positions in open space.
  explicit ConstraintPositions(const VectorColumn<Real>& x) : x_(&x) {}
  /// Where particles are. @param moved  in a periodic box: how far each has gone from there [length]
  explicit ConstraintPositions(const ParticleSystem<Real>& s, const VectorColumn<Real>* moved = nullptr)
      : x_(&s.positions()), cell_(s.box().is_periodic() ? &s : nullptr), moved_(moved) {}

  /// The particles of a constraint. In a box the first one is the origin of those that know differences only, and
  /// stands where it would if it had never been wrapped for all others; each is at its image nearest to the one before.
  template <std::size_t n> Points<Real, n> of(const std::array<Index, n>& particles, bool differences_only) const {
    Points<Real, n> points;
    if (cell_ == nullptr) {
      for (std::size_t k = 0; k < n; ++k) points[k] = (*x_)[particles[k]];
      return points;
    }
    points[0] = Vec3<Real>::Zero();
    if (!differences_only) {
      points[0] = cell_->unwrapped(particles[0]);
      if (moved_ != nullptr) points[0] += (*moved_)[particles[0]];
    }
    for (std::size_t k = 1; k < n; ++k) {
      const Index i = particles[k - 1], j = particles[k];
      Vec3<Real> apart = cell_->box().minimum_image(Vec3<Real>((*x_)[j] - (*x_)[i]));
      if (moved_ != nullptr) apart += (*moved_)[j] - (*moved_)[i];
      points[k] = points[k - 1] + apart;
    }
    return points;
  }

 private:
  const VectorColumn<Real>* x_;
  const ParticleSystem<Real>* cell_ = nullptr;  ///< null in open space
  const VectorColumn<Real>* moved_ = nullptr;
};

/// Some constraints of one type and the particles they tie. Equations are numbered constraint by constraint; gradients
/// stand equation by equation, and in each of them particle by particle.
class ConstraintGroup {
 public:
  virtual ~ConstraintGroup() = default;
  virtual std::unique_ptr<ConstraintGroup> clone() const = 0;
  /// A copy of some of them; null where it is none. @param keep  by constraint
  virtual std::unique_ptr<ConstraintGroup> only(const std::vector<bool>& keep) const = 0;

  virtual std::string name() const = 0;
  /// Type, parameters and particles in text.
  virtual std::string signature() const = 0;
  /// The bits of a constraint's parameters: the same for those of the group that are equal in everything but particles.
  virtual std::string parameters(Index constraint) const = 0;
  /// Number of constraints, and of equations and particles of each.
  virtual Index size() const = 0;
  virtual Index equations() const = 0;
  virtual Index particles() const = 0;
  /// The particle in place `k` of a constraint.
  virtual Index particle(Index constraint, Index k) const = 0;
  /// Finds the particles among those of a run: from the first time on they are known by their ids, so that they stay
  /// the same particles when others are taken out. @throws Error  for a particle that has gone
  virtual void find(const std::vector<std::int64_t>& ids) = 0;
  /// How far an equation's value is from 0, relative to the scale of its constraint [1].
  virtual double residual(Index constraint, double g) const = 0;
  virtual double scale(Index constraint) const = 0;
  /// How far apart a constraint holds its particles [length]; 0 where it does not tell.
  virtual double reach(Index constraint) const = 0;
  virtual bool keeps_momentum() const = 0;
  virtual bool keeps_angular_momentum() const = 0;

  /// Of constraints [first, last), one after the other; gradients shape (equations, particles of each).
  virtual void values(const ConstraintPositions<double>& x, Index first, Index last, double* g) const = 0;
  virtual void values(const ConstraintPositions<Quad>& x, Index first, Index last, Quad* g) const = 0;
  virtual void gradients(const ConstraintPositions<double>& x, Index first, Index last,
                         Vec3<double>* gradients) const = 0;
  virtual void gradients(const ConstraintPositions<Quad>& x, Index first, Index last, Vec3<Quad>* gradients) const = 0;
  /// Positions of the particles, shape (particles of each).
  virtual void points(const ConstraintPositions<double>& x, Vec3<double>* out) const = 0;
  virtual void points(const ConstraintPositions<Quad>& x, Vec3<Quad>* out) const = 0;
  /// v . g_qq v.
  virtual void curvatures(const ConstraintPositions<double>& x, const VectorColumn<double>& v, double* out) const = 0;
  virtual void curvatures(const ConstraintPositions<Quad>& x, const VectorColumn<Quad>& v, Quad* out) const = 0;
};

/// The same for a known type.
template <Constraint C> class ConstraintsOf final : public ConstraintGroup {
 public:
  static constexpr std::size_t tied = C::particles, each = detail::equations<C>;
  using Particles = std::array<Index, tied>;

  void add(C constraint, const Particles& particles) {
    constraints_.push_back(std::move(constraint));
    particles_.push_back(particles);
    ids_.clear();
  }
  void find(const std::vector<std::int64_t>& ids) override {
    std::vector<Index> places;
    for (const Particles& of : particles_) places.insert(places.end(), of.begin(), of.end());
    const auto is_there = [&](Index i) { return i >= 0 && i < std::ssize(ids); };
    if (ids_.empty() && !std::all_of(places.begin(), places.end(), is_there))
      return;  // told when equations are laid out
    detail::find_tied(ids, places, ids_);
    auto place = places.begin();
    for (Particles& of : particles_) {
      for (Index& i : of) i = *place++;
    }
  }

  const C& constraint(Index k) const { return constraints_[static_cast<std::size_t>(k)]; }

  std::unique_ptr<ConstraintGroup> clone() const override { return std::make_unique<ConstraintsOf>(*this); }
  std::unique_ptr<ConstraintGroup> only(const std::vector<bool>& keep) const override {
    auto kept = std::make_unique<ConstraintsOf>();
    for (std::size_t k = 0; k < constraints_.size(); ++k) {
      if (keep[k]) kept->add(constraints_[k], particles_[k]);
    }
    if (kept->constraints_.empty()) return nullptr;
    return kept;
  }
  std::string name() const override {
    const std::string name = detail::name_of(constraints_.front());
    return name.empty() ? "constraint" : name;
  }
  std::string signature() const override {
    std::string text;
    for (std::size_t k = 0; k < constraints_.size(); ++k) {
      text += fmt::format("{}{} of {}", k == 0 ? "" : ", ", detail::signature_of(constraints_[k]),
                          fmt::join(particles_[k], " "));
    }
    return text;
  }
  std::string parameters(Index constraint) const override { return detail::parameter_bits(at(constraint), constraint); }
  Index size() const override { return static_cast<Index>(constraints_.size()); }
  Index equations() const override { return static_cast<Index>(each); }
  Index particles() const override { return static_cast<Index>(tied); }
  Index particle(Index constraint, Index k) const override {
    return particles_[static_cast<std::size_t>(constraint)][static_cast<std::size_t>(k)];
  }
  double residual(Index constraint, double g) const override { return detail::residual_of(at(constraint), g); }
  double scale(Index constraint) const override { return detail::scale_of(at(constraint)); }
  double reach(Index constraint) const override { return detail::reach_of(at(constraint)); }
  bool keeps_momentum() const override { return detail::keeps_momentum<C>(); }
  bool keeps_angular_momentum() const override {
    return std::all_of(constraints_.begin(), constraints_.end(), detail::keeps_angular_momentum<C>);
  }

  void values(const ConstraintPositions<double>& x, Index first, Index last, double* g) const override {
    write_values(x, first, last, g);
  }
  void values(const ConstraintPositions<Quad>& x, Index first, Index last, Quad* g) const override {
    write_values(x, first, last, g);
  }
  void gradients(const ConstraintPositions<double>& x, Index first, Index last, Vec3<double>* out) const override {
    write_gradients(x, first, last, out);
  }
  void gradients(const ConstraintPositions<Quad>& x, Index first, Index last, Vec3<Quad>* out) const override {
    write_gradients(x, first, last, out);
  }
  void points(const ConstraintPositions<double>& x, Vec3<double>* out) const override { write_points(x, out); }
  void points(const ConstraintPositions<Quad>& x, Vec3<Quad>* out) const override { write_points(x, out); }
  void curvatures(const ConstraintPositions<double>& x, const VectorColumn<double>& v, double* out) const override {
    write_curvatures(x, v, out);
  }
  void curvatures(const ConstraintPositions<Quad>& x, const VectorColumn<Quad>& v, Quad* out) const override {
    write_curvatures(x, v, out);
  }

 private:
  const C& at(Index constraint) const { return constraints_[static_cast<std::size_t>(constraint)]; }

  template <class Real> Points<Real, tied> gathered(const ConstraintPositions<Real>& x, Index constraint) const {
    return x.of(particles_[static_cast<std::size_t>(constraint)], detail::keeps_momentum<C>());
  }
  template <class Real> void write_values(const ConstraintPositions<Real>& x, Index first, Index last, Real* g) const {
    for (Index c = first; c < last; ++c) {
      for (const Real& value : detail::values_of<C, Real>(at(c), gathered(x, c))) *g++ = value;
    }
  }
  template <class Real>
  void write_gradients(const ConstraintPositions<Real>& x, Index first, Index last, Vec3<Real>* out) const {
    for (Index c = first; c < last; ++c) {
      for (const auto& equation : detail::gradients_of<C, Real>(at(c), gathered(x, c))) {
        for (const Vec3<Real>& gradient : equation) *out++ = gradient;
      }
    }
  }
  template <class Real> void write_points(const ConstraintPositions<Real>& x, Vec3<Real>* out) const {
    for (Index c = 0; c < size(); ++c) {
      for (const Vec3<Real>& point : gathered(x, c)) *out++ = point;
    }
  }
  template <class Real>
  void write_curvatures(const ConstraintPositions<Real>& x, const VectorColumn<Real>& v, Real* out) const {
    for (Index c = 0; c < size(); ++c) {
      Points<Real, tied> rates;
      for (std::size_t k = 0; k < tied; ++k) rates[k] = v[particles_[static_cast<std::size_t>(c)][k]];
      for (const Real& value : detail::curvatures_of<C, Real>(at(c), gathered(x, c), rates)) *out++ = value;
    }
  }

  std::vector<C> constraints_;
  std::vector<Particles> particles_;
  std::vector<std::int64_t> ids_;  ///< of the particles, once they are known by them
};

}  // namespace noether
