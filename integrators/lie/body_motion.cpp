#include "integrators/lie/body_motion.hpp"

#include "integrators/kinetic_potential.hpp"
#include "integrators/lie/rotations.hpp"
#include "integrators/particle_vector.hpp"
#include "neighbors/neighbor_list.hpp"
#include "numbers/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace noether {

namespace {

/// Where columns begin in y and in elements, in numbers per particle.
constexpr Index of_velocity = 3, of_orientation = 6, of_spin = 10, of_twist = 9;

/// Row i of a column of vectors, or of quaternions, that begins after `from` numbers per particle.
template <class Real> Vec3<Real> vector_at(const Vector<Real>& y, Index from, Index i, Index n) {
  return Vec3<Real>(y[from * n + i], y[(from + 1) * n + i], y[(from + 2) * n + i]);
}
template <class Real> void set_vector(Vector<Real>& y, Index from, Index i, Index n, const Vec3<Real>& v) {
  for (int k = 0; k < 3; ++k) y[(from + k) * n + i] = v[k];
}
template <class Real> Quaternion<Real> orientation_at(const Vector<Real>& y, Index i, Index n) {
  return Quaternion<Real>(y[of_orientation * n + i], y[(of_orientation + 1) * n + i], y[(of_orientation + 2) * n + i],
                          y[(of_orientation + 3) * n + i]);
}
template <class Real> void set_orientation(Vector<Real>& y, Index i, Index n, const Quaternion<Real>& q) {
  for (int k = 0; k < 4; ++k) y[(of_orientation + k) * n + i] = q[k];
}

}  // namespace

template <class Real> FieldClaims BodyMotion<Real>::claims() const {
  const ForceClaims forces = forces_.claims();
  const bool held = work_.bodies() != nullptr && work_.bodies()->any_held();
  return {.name = name_,
          .time_dependent = forces.time_dependent,
          .energy = forces.energy,
          .dissipative = forces.dissipative,
          .no_action = "methods on groups have no action; 'lie_group_variational' has one",
          .keeps_momentum = forces.keeps_momentum && !held,
          .keeps_angular_momentum = forces.keeps_angular_momentum && !held && !work_.box().is_periodic()};
}

template <class Real> void BodyMotion<Real>::bind(const ParticleSystem<Real>& s) {
  if (!has_bodies(s)) throw Error("there are no rigid bodies to turn; add some, or use classical over the forces");
  for (const AnyForce<Real>& force : forces_.terms()) {
    if (!force.claims().velocity_dependent || force.name() != "on_sites") continue;
    throw Error("a force on the sites of rigid bodies depends on velocities, which sites do not have; take it out");
  }
  bind_force(forces_, s);
  workspace_ = Workspace();
  workspace_.put(NeighborList(forces_.claims().range));
  work_ = s;
  work_.keep_low_words(false);
  work_.clock() = Clock<Real>::free(0);
  a_ = torque_ = VectorColumn<Real>(s.size());
  coupling_ = Coupling::of(forces_.claims(), s.units().G);
  turns_.assign(static_cast<std::size_t>(s.size()), 0);
  const auto& inertia = s.template column<BodyInertia>();
  for (Index i = 0; i < s.size(); ++i)
    turns_[static_cast<std::size_t>(i)] = turning_freedoms<Real>(Vec3<Real>(inertia[i])) > 0 ? 1 : 0;
  this->forget_scales();
}

template <class Real> void BodyMotion<Real>::gather(const ParticleSystem<Real>& s, Vector<Real>& y) const {
  const Index n = s.size();
  const auto& q = s.template column<BodyOrientation>();
  const auto& spin = s.template column<BodySpin>();
  y.resize(13 * n);
  for (int k = 0; k < 3; ++k) {
    std::copy_n(s.positions().component(k), n, y.data() + k * n);
    std::copy_n(s.velocities().component(k), n, y.data() + (of_velocity + k) * n);
    std::copy_n(spin.component(k), n, y.data() + (of_spin + k) * n);
  }
  for (int k = 0; k < 4; ++k) std::copy_n(q.component(k), n, y.data() + (of_orientation + k) * n);
}

template <class Real> void BodyMotion<Real>::scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const {
  const Index n = s.size();
  detail::scatter_particles(y, s);
  auto& q = s.template column<BodyOrientation>();
  auto& spin = s.template column<BodySpin>();
  for (int k = 0; k < 4; ++k) std::copy_n(y.data() + (of_orientation + k) * n, n, q.component(k));
  for (int k = 0; k < 3; ++k) std::copy_n(y.data() + (of_spin + k) * n, n, spin.component(k));
}

template <class Real> EnergyTerms<Real> BodyMotion<Real>::energy(const ParticleSystem<Real>& s) {
  ForceSink<Real> sink(a_, s, {.energy = true}, &workspace_);
  sink.set_torques(torque_);
  forces_.add_to(sink, s);
  return {kinetic_energy(s) + turning_energy_of(s), sink.potential()};
}

template <class Real> std::optional<Mat3<Real>> BodyMotion<Real>::virial(const ParticleSystem<Real>& s) {
  if (!forces_.claims().virial || s.bodies()->any_held()) return {};
  ForceSink<Real> sink(a_, s, {.virial = true}, &workspace_);
  sink.set_torques(torque_);
  forces_.add_to(sink, s);
  return sink.virial();
}

/// Fixed points stay where they are.
template <class Real> void hold_fixed_points(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  if (!s.bodies()->any_held()) return;
  for (Index i = 0; i < s.size(); ++i) {
    if (s.bodies()->is_held(i)) a.set(i, Vec3<Real>::Zero());
  }
}

template <class Real> void BodyMotion<Real>::accelerations(const ParticleSystem<Real>& s, VectorColumn<Real>& a) {
  ForceSink<Real> sink(a, s, {}, &workspace_);
  sink.set_torques(torque_);
  forces_.add_to(sink, s);
  hold_fixed_points(s, a);
}

template <class Real> void BodyMotion<Real>::sum(const Real& t, const Vector<Real>& y) {
  scatter(y, work_);
  work_.clock().set_stage_offset(t);
  work_.wrap();
  ForceSink<Real> sink(a_, work_, {}, &workspace_);
  sink.set_torques(torque_);
  forces_.add_to(sink, work_);
  hold_fixed_points(work_, a_);
  if (!sink.failure()) return;
  this->note(sink.failure());
  for (int k = 0; k < 3; ++k) std::fill_n(a_.component(k), a_.size(), Real(std::numeric_limits<double>::quiet_NaN()));
}

template <class Real> void BodyMotion<Real>::find_velocity(const Real& t, const Vector<Real>& y, Vector<Real>& a) {
  const Index n = work_.size();
  sum(t, y);
  const auto& inertia = std::as_const(work_).template column<BodyInertia>();
  const bool screws = options_.group == BodyGroup::se3, in_body = options_.spin_axes == SpinAxes::body;
  for_blocks(n, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Vec3<Real> v = vector_at(y, of_velocity, i, n), pull = std::as_const(a_)[i];
      if (!turns(i)) {
        set_vector(a, 0, i, n, v);
        set_vector(a, of_velocity, i, n, pull);
        for (Index from : {of_orientation, of_twist}) set_vector<Real>(a, from, i, n, Vec3<Real>::Zero());
        continue;
      }
      const Mat3<Real> r = rotation_matrix<Real>(orientation_at(y, i, n));
      const Vec3<Real> spin = to_body<Real>(r, vector_at(y, of_spin, i, n)), torque = std::as_const(torque_)[i];
      const Vec3<Real> rate = rate_in_body<Real>(spin, inertia[i]);
      set_vector(a, of_orientation, i, n, rate);
      set_vector<Real>(a, of_twist, i, n,
                       in_body ? Vec3<Real>(cross<Real>(spin, rate) + to_body<Real>(r, torque)) : torque);
      const Vec3<Real> speed = screws ? to_body<Real>(r, v) : v;
      set_vector(a, 0, i, n, speed);
      const bool turning_speed = screws && in_body;
      set_vector<Real>(a, of_velocity, i, n,
                       turning_speed ? Vec3<Real>(cross<Real>(speed, rate) + to_body<Real>(r, pull)) : pull);
    }
  });
}

/// The rates of the numbers of y, whatever the group.
template <class Real> void BodyMotion<Real>::evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) {
  const Index n = work_.size();
  sum(t, y);
  dy.resize(size());
  const auto& inertia = std::as_const(work_).template column<BodyInertia>();
  for (Index i = 0; i < n; ++i) {
    const Quaternion<Real> q = orientation_at(y, i, n);
    const Vec3<Real> rate = rate_in_body<Real>(spin_in_body<Real>(q, vector_at(y, of_spin, i, n)), inertia[i]);
    set_vector(dy, 0, i, n, vector_at(y, of_velocity, i, n));
    set_vector<Real>(dy, of_velocity, i, n, std::as_const(a_)[i]);
    set_orientation<Real>(dy, i, n, quaternion_product<Real>(q, quaternion<Real>(Real(0), rate / Real(2))));
    set_vector<Real>(dy, of_spin, i, n,
                     turns(i) ? Vec3<Real>(std::as_const(torque_)[i]) : Vec3<Real>(Vec3<Real>::Zero()));
  }
}

template <class Real> void BodyMotion<Real>::act(const Vector<Real>& u, const Vector<Real>& y, Vector<Real>& out) {
  const Index n = work_.size();
  const bool screws = options_.group == BodyGroup::se3, in_body = options_.spin_axes == SpinAxes::body;
  out.resize(y.size());
  for_blocks(n, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Quaternion<Real> q = orientation_at(y, i, n);
      const Vec3<Real> x = vector_at(y, 0, i, n), v = vector_at(y, of_velocity, i, n),
                       spin = vector_at(y, of_spin, i, n);
      const Vec3<Real> way = vector_at(u, 0, i, n), push = vector_at(u, of_velocity, i, n);
      if (!turns(i)) {
        set_vector<Real>(out, 0, i, n, x + way);
        set_vector<Real>(out, of_velocity, i, n, v + push);
        set_orientation(out, i, n, q);
        set_vector(out, of_spin, i, n, spin);
        continue;
      }
      const Vec3<Real> turn = vector_at(u, of_orientation, i, n), twist = vector_at(u, of_twist, i, n);
      const Quaternion<Real> after = renormalized<Real>(quaternion_product<Real>(q, rotation_by<Real>(turn)));
      set_orientation(out, i, n, after);
      if (!screws && !in_body) {
        set_vector<Real>(out, 0, i, n, x + way);
        set_vector<Real>(out, of_velocity, i, n, v + push);
        set_vector<Real>(out, of_spin, i, n, spin + twist);
        continue;
      }
      const Mat3<Real> from = rotation_matrix<Real>(q), to = rotation_matrix<Real>(after);
      const auto carried = [&](const Vec3<Real>& momentum, const Vec3<Real>& change) {
        return to_space<Real>(to, Vec3<Real>(to_body<Real>(from, momentum) + change));
      };
      set_vector<Real>(out, 0, i, n, x + (screws ? to_space<Real>(from, way_of_motion<Real>(turn, way)) : way));
      set_vector<Real>(out, of_velocity, i, n, screws && in_body ? carried(v, push) : Vec3<Real>(v + push));
      set_vector<Real>(out, of_spin, i, n, in_body ? carried(spin, twist) : Vec3<Real>(spin + twist));
    }
  });
}

/// Rotations of the body's own axes stand to the right of R, so that brackets have the other sign.
template <class Real> void BodyMotion<Real>::bracket(const Vector<Real>& u, const Vector<Real>& v, Vector<Real>& out) {
  const Index n = work_.size();
  out.setZero(algebra());
  for_blocks(n, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Vec3<Real> a = vector_at(u, of_orientation, i, n), c = vector_at(v, of_orientation, i, n);
      set_vector<Real>(out, of_orientation, i, n, cross<Real>(c, a));
      if (options_.group == BodyGroup::so3) continue;
      const Vec3<Real> b = vector_at(u, 0, i, n), d = vector_at(v, 0, i, n);
      set_vector<Real>(out, 0, i, n, cross<Real>(c, b) + cross<Real>(d, a));
    }
  });
}

template <class Real>
void BodyMotion<Real>::sizes(const Vector<Real>& y, const Vector<Real>& y1, double h, Vector<double>& out) const {
  const Index n = work_.size();
  out.setZero(algebra());
  const auto& inertia = work_.template column<BodyInertia>();
  const auto length = [&](const Vector<Real>& of, Index i) {
    return std::sqrt(static_cast<double>(norm2(vector_at(of, of_spin, i, n))));
  };
  for (Index i = 0; i < n; ++i) {
    // A spin that turns the body by an angle of 1 in the step is large, whatever it had before.
    const double moment = static_cast<double>(std::max({inertia[i][0], inertia[i][1], inertia[i][2]}));
    const double spin = std::max({length(y, i), length(y1, i), moment / std::abs(h)});
    for (int k = 0; k < 3; ++k) {
      out[(of_orientation + k) * n + i] = turns(i) ? 1 : 0;
      out[(of_twist + k) * n + i] = spin;
    }
  }
}

template <class Real>
void BodyMotion<Real>::measure_particles(const Vector<Real>& y, double rtol, ParticleScales& scales) {
  scatter(y, work_);
  work_.wrap();
  measure(work_, coupling_, workspace_.find<NeighborList>(), rtol, scales);
}

template class BodyMotion<double>;
template class BodyMotion<Quad>;

}  // namespace noether
