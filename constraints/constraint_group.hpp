#pragma once
/// Constraints of one type, side by side: types are erased per group, never per constraint.

#include "constraints/constraint.hpp"
#include "engine/column.hpp"
#include "engine/signature.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace noether {

/// Some constraints of one type and the particles they tie. Equations are numbered constraint by constraint; gradients
/// stand equation by equation, and in each of them particle by particle.
class ConstraintGroup {
 public:
  virtual ~ConstraintGroup() = default;
  virtual std::unique_ptr<ConstraintGroup> clone() const = 0;

  virtual std::string name() const = 0;
  /// Type, parameters and particles in text.
  virtual std::string signature() const = 0;
  /// Number of constraints, and of equations and particles of each.
  virtual Index size() const = 0;
  virtual Index equations() const = 0;
  virtual Index particles() const = 0;
  /// The particle in place `k` of a constraint.
  virtual Index particle(Index constraint, Index k) const = 0;
  /// How far an equation's value is from 0, relative to the scale of its constraint [1].
  virtual double residual(Index constraint, double g) const = 0;
  virtual double scale(Index constraint) const = 0;
  virtual bool keeps_momentum() const = 0;
  virtual bool keeps_angular_momentum() const = 0;

  /// Of constraints [first, last), one after the other; gradients shape (equations, particles of each).
  virtual void values(const VectorColumn<double>& x, Index first, Index last, double* g) const = 0;
  virtual void values(const VectorColumn<Quad>& x, Index first, Index last, Quad* g) const = 0;
  virtual void gradients(const VectorColumn<double>& x, Index first, Index last, Vec3<double>* gradients) const = 0;
  virtual void gradients(const VectorColumn<Quad>& x, Index first, Index last, Vec3<Quad>* gradients) const = 0;
  /// v . g_qq v.
  virtual void curvatures(const VectorColumn<double>& x, const VectorColumn<double>& v, double* out) const = 0;
  virtual void curvatures(const VectorColumn<Quad>& x, const VectorColumn<Quad>& v, Quad* out) const = 0;
};

/// The same for a known type.
template <Constraint C> class ConstraintsOf final : public ConstraintGroup {
 public:
  static constexpr std::size_t tied = C::particles, each = detail::equations<C>;
  using Particles = std::array<Index, tied>;

  void add(C constraint, const Particles& particles) {
    constraints_.push_back(std::move(constraint));
    particles_.push_back(particles);
  }

  std::unique_ptr<ConstraintGroup> clone() const override { return std::make_unique<ConstraintsOf>(*this); }
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
  Index size() const override { return static_cast<Index>(constraints_.size()); }
  Index equations() const override { return static_cast<Index>(each); }
  Index particles() const override { return static_cast<Index>(tied); }
  Index particle(Index constraint, Index k) const override {
    return particles_[static_cast<std::size_t>(constraint)][static_cast<std::size_t>(k)];
  }
  double residual(Index constraint, double g) const override { return detail::residual_of(at(constraint), g); }
  double scale(Index constraint) const override { return detail::scale_of(at(constraint)); }
  bool keeps_momentum() const override { return detail::keeps_momentum<C>(); }
  bool keeps_angular_momentum() const override {
    return std::all_of(constraints_.begin(), constraints_.end(), detail::keeps_angular_momentum<C>);
  }

  void values(const VectorColumn<double>& x, Index first, Index last, double* g) const override {
    write_values(x, first, last, g);
  }
  void values(const VectorColumn<Quad>& x, Index first, Index last, Quad* g) const override {
    write_values(x, first, last, g);
  }
  void gradients(const VectorColumn<double>& x, Index first, Index last, Vec3<double>* out) const override {
    write_gradients(x, first, last, out);
  }
  void gradients(const VectorColumn<Quad>& x, Index first, Index last, Vec3<Quad>* out) const override {
    write_gradients(x, first, last, out);
  }
  void curvatures(const VectorColumn<double>& x, const VectorColumn<double>& v, double* out) const override {
    write_curvatures(x, v, out);
  }
  void curvatures(const VectorColumn<Quad>& x, const VectorColumn<Quad>& v, Quad* out) const override {
    write_curvatures(x, v, out);
  }

 private:
  const C& at(Index constraint) const { return constraints_[static_cast<std::size_t>(constraint)]; }

  template <class Real> Points<Real, tied> gathered(const VectorColumn<Real>& column, Index constraint) const {
    Points<Real, tied> points;
    for (std::size_t k = 0; k < tied; ++k) points[k] = column[particles_[static_cast<std::size_t>(constraint)][k]];
    return points;
  }
  template <class Real> void write_values(const VectorColumn<Real>& x, Index first, Index last, Real* g) const {
    for (Index c = first; c < last; ++c) {
      for (const Real& value : detail::values_of<C, Real>(at(c), gathered(x, c))) *g++ = value;
    }
  }
  template <class Real>
  void write_gradients(const VectorColumn<Real>& x, Index first, Index last, Vec3<Real>* out) const {
    for (Index c = first; c < last; ++c) {
      for (const auto& equation : detail::gradients_of<C, Real>(at(c), gathered(x, c))) {
        for (const Vec3<Real>& gradient : equation) *out++ = gradient;
      }
    }
  }
  template <class Real>
  void write_curvatures(const VectorColumn<Real>& x, const VectorColumn<Real>& v, Real* out) const {
    for (Index c = 0; c < size(); ++c) {
      for (const Real& value : detail::curvatures_of<C, Real>(at(c), gathered(x, c), gathered(v, c))) *out++ = value;
    }
  }

  std::vector<C> constraints_;
  std::vector<Particles> particles_;
};

}  // namespace noether
