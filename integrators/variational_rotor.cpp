#include "integrators/variational_rotor.hpp"

#include "numbers/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace noether {

namespace {

/// w I z + z x I z = part of h Pi/2, for one body.
template <class Real> class DiscreteTurn {
 public:
  DiscreteTurn(const Vec3<Real>& inertia, const Vec3<Real>& half) : inertia_(inertia), half_(half) {}

  /// From the turn of a smaller part of h Pi to that of `part`. @return whether there is one, which z then is
  bool go_to(const Real& part, Vec3<Real>& z) const {
    constexpr int most = 50;
    const Real rounding = std::numeric_limits<Real>::epsilon();
    Vec3<Real> found = z;
    Real before(0);
    for (int n = 0; n < most; ++n) {
      const Real square = norm2(found);
      if (!(square < Real(1))) return false;
      const Real w = root(Real(1) - square);
      const Vec3<Real> momentum(inertia_[0] * found[0], inertia_[1] * found[1], inertia_[2] * found[2]);
      const Vec3<Real> missing = momentum * w + cross<Real>(found, momentum) - half_ * part;
      const Mat3<Real> slope = slope_at(found, momentum, w);
      const Real volume = determinant(slope);
      // The way from the turn of 0 ends where it folds back.
      if (!(volume > Real(0))) return false;
      const Vec3<Real> step = solved(slope, volume, missing);
      found -= step;
      const Real length = norm2(step);
      if (!(length > rounding * rounding * norm2(found))) return finish(found, z);
      // Rounding alone is left where steps no longer shrink: of the square root of it where the way is about to end.
      if (n > 6 && !(length < before / Real(4)) && length < rounding * Real(64)) return finish(found, z);
      before = length;
    }
    return false;
  }

 private:
  static Real root(const Real& x) {
    using std::sqrt;
    return sqrt(x);
  }
  bool finish(const Vec3<Real>& found, Vec3<Real>& z) const {
    z = found;
    return norm2(found) < Real(1);
  }
  /// w I - (I z) z^T/w + hat(z) I - hat(I z)
  Mat3<Real> slope_at(const Vec3<Real>& z, const Vec3<Real>& momentum, const Real& w) const {
    Mat3<Real> slope;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) slope(i, k) = -(momentum[i] * z[k]) / w;
      slope(i, i) += w * inertia_[i];
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      slope(i, j) += momentum[k] - z[k] * inertia_[j];
      slope(i, k) += z[j] * inertia_[k] - momentum[j];
    }
    return slope;
  }
  static Real determinant(const Mat3<Real>& m) {
    return m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1)) - m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0)) +
           m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
  }
  static Vec3<Real> solved(const Mat3<Real>& m, const Real& volume, const Vec3<Real>& right) {
    const Vec3<Real> a(m(0, 0), m(1, 0), m(2, 0)), b(m(0, 1), m(1, 1), m(2, 1)), c(m(0, 2), m(1, 2), m(2, 2));
    const Vec3<Real> bc = cross<Real>(b, c), ca = cross<Real>(c, a), ab = cross<Real>(a, b);
    const auto along = [&](const Vec3<Real>& n) {
      return (n[0] * right[0] + n[1] * right[1] + n[2] * right[2]) / volume;
    };
    return Vec3<Real>(along(bc), along(ca), along(ab));
  }

  Vec3<Real> inertia_, half_;
};

/// The angle that a body would turn by in the time `h` at its rate [rad].
template <class Real> double free_angle(const Vec3<Real>& in_body, const Vec3<Real>& inertia, const Real& h) {
  const Vec3<Real> rate = rate_in_body<Real>(in_body, inertia);
  return std::sqrt(static_cast<double>(norm2(rate))) * std::fabs(static_cast<double>(h));
}

}  // namespace

template <class Real>
std::optional<Turned<Real>> turn_variationally(const Quaternion<Real>& q, const Vec3<Real>& spin,
                                               const Vec3<Real>& inertia, const Real& h) {
  Vec3<Real> in_body = spin_in_body<Real>(q, spin), moments = inertia;
  const Real largest = std::max({inertia[0], inertia[1], inertia[2]});
  if (!(largest > Real(0))) return Turned<Real>{q, Real(0)};
  for (int k = 0; k < 3; ++k) {
    if (inertia[k] > Real(0)) continue;  // about its own line a body does not turn, whatever its moment there
    in_body[k] = Real(0);
    moments[k] = largest;
  }
  for (int k = 0; k < 3; ++k) moments[k] /= largest;
  const Vec3<Real> half = in_body * (h / (Real(2) * largest));
  if (!(norm2(half) > Real(0))) return Turned<Real>{q, Real(0)};
  const DiscreteTurn<Real> equation(moments, half);
  Vec3<Real> z = Vec3<Real>::Zero();
  // Long turns are come to step by step, so that Newton's method finds the one that begins with 0.
  const int parts = 1 + static_cast<int>(std::min(8.0, 4 * free_angle<Real>(in_body, inertia, h)));
  for (int part = 1; part <= parts; ++part) {
    if (!equation.go_to(Real(part) / Real(parts), z)) return {};
  }
  using std::sqrt;
  const Quaternion<Real> turn = quaternion<Real>(sqrt(Real(1) - norm2(z)), z);
  Real action(0);
  for (int k = 0; k < 3; ++k) action += Real(2) * z[k] * z[k] * inertia[k] / h;
  return Turned<Real>{renormalized<Real>(quaternion_product<Real>(q, turn)), action};
}

template <class Real>
std::optional<Failure> turn_all_variationally(ParticleSystem<Real>& s, const Real& h, ScalarColumn<Real>& action) {
  const auto& inertia = std::as_const(s).template column<BodyInertia>();
  const auto& spin = std::as_const(s).template column<BodySpin>();
  auto& orientation = s.template column<BodyOrientation>();
  const Real none = std::numeric_limits<Real>::quiet_NaN();
  for_blocks(s.size(), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const auto next = turn_variationally<Real>(std::as_const(orientation)[i], spin[i], inertia[i], h);
      if (next) orientation.set(i, next->orientation);
      action[i] = next ? next->action : none;
    }
  });
  for (Index i = 0; i < s.size(); ++i) {
    if (action[i] == action[i]) continue;
    const Vec3<Real> in_body = spin_in_body<Real>(Quaternion<Real>(std::as_const(orientation)[i]), spin[i]);
    const double angle = free_angle<Real>(in_body, inertia[i], h);
    return Failure{
        Outcome::Kind::solver_failure, i, "turn",
        fmt::format("the discrete action has no turn of body '{}': at its rate it would turn by {:.4g} rad in "
                    "a step, and by 1 rad about a principal axis there is none; shorten the step, or use "
                    "rotor = \"exact\"",
                    s.name(i), angle)};
  }
  return {};
}

template std::optional<Turned<double>> turn_variationally(const Quaternion<double>&, const Vec3<double>&,
                                                          const Vec3<double>&, const double&);
template std::optional<Turned<Quad>> turn_variationally(const Quaternion<Quad>&, const Vec3<Quad>&, const Vec3<Quad>&,
                                                        const Quad&);
template std::optional<Failure> turn_all_variationally(ParticleSystem<double>&, const double&, ScalarColumn<double>&);
template std::optional<Failure> turn_all_variationally(ParticleSystem<Quad>&, const Quad&, ScalarColumn<Quad>&);

}  // namespace noether
