#include "integrators/free_rotor.hpp"

#include "integrators/free_rotor_simd.hpp"
#include "numbers/elliptic.hpp"
#include "numbers/error.hpp"
#include "numbers/pack.hpp"
#include "numbers/small_angle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace noether {

namespace {

/// The rotation by `angle` about a unit vector.
template <class Real> Quaternion<Real> rotation(const Real& angle, const Vec3<Real>& axis) {
  const SineCosine<Real> of = sine_cosine<Real>(angle / Real(2));
  return quaternion(of.cosine, Vec3<Real>(of.sine * axis[0], of.sine * axis[1], of.sine * axis[2]));
}
template <class Real> Quaternion<Real> rotation(const Real& angle, int axis) {
  Vec3<Real> along = Vec3<Real>::Zero();
  along[axis] = Real(1);
  return rotation(angle, along);
}

/// A body on its way through the turns about its axes.
template <class Real> struct AxisTurn {
  Quaternion<Real> q;
  Vec3<Real> in_body;  ///< angular momentum in the principal axes

  /// Turns it about axis `k` by twice the angle `half`.
  template <int k> void about(const Real& half) {
    constexpr int i = (k + 1) % 3, j = (k + 2) % 3;
    const auto [s, c] = sine_cosine<Real>(half);
    const Quaternion<Real> before = q;
    q[0] = before[0] * c - before[1 + k] * s;
    q[1 + k] = before[1 + k] * c + before[0] * s;
    q[1 + i] = before[1 + i] * c + before[1 + j] * s;
    q[1 + j] = before[1 + j] * c - before[1 + i] * s;
    const Real cosine = (c - s) * (c + s), sine = Real(2) * c * s, first = in_body[i];
    in_body[i] = cosine * first + sine * in_body[j];
    in_body[j] = cosine * in_body[j] - sine * first;
  }
  void about(int k, const Real& half) {
    if (k == 0) return about<0>(half);
    if (k == 1) return about<1>(half);
    about<2>(half);
  }
};

/// The axes of a body taken in another order, one or two of them turned round so that they stay right-handed.
struct Relabeled {
  std::array<int, 3> axis;  ///< of the body, for each new one
  std::array<int, 3> sign;

  template <class Real> Vec3<Real> to(const Vec3<Real>& v) const {
    return Vec3<Real>(Real(sign[0]) * v[axis[0]], Real(sign[1]) * v[axis[1]], Real(sign[2]) * v[axis[2]]);
  }
  template <class Real> Vec3<Real> back(const Vec3<Real>& v) const {
    Vec3<Real> old;
    for (int k = 0; k < 3; ++k) old[axis[static_cast<std::size_t>(k)]] = Real(sign[static_cast<std::size_t>(k)]) * v[k];
    return old;
  }
};

/// @param third  the third new axis, of which `m` shall have a component above 0
template <class Real> Relabeled relabeled(int first, int second, int third, const Vec3<Real>& m) {
  const bool even = (second - first + 3) % 3 == 1;
  const int sign = m[third] < Real(0) ? -1 : 1;
  return {{first, second, third}, {even ? sign : -sign, 1, sign}};
}

/// The smallest rotation of the direction of a vector with m_3 > 0 onto the third axis.
template <class Real> Quaternion<Real> onto_third(const Vec3<Real>& m) {
  using std::sqrt;
  const Real across = m[0] * m[0] + m[1] * m[1], twice = Real(sqrt(across + m[2] * m[2])) + m[2];
  const Real scale = Real(1) / sqrt(across + twice * twice);
  return Quaternion<Real>(twice * scale, m[1] * scale, -m[0] * scale, Real(0));
}

/// A body of two equal moments `across` and one `along` its axis.
template <class Real>
Quaternion<Real> turn_symmetric(const Quaternion<Real>& q, const Vec3<Real>& spin, const Real& length, int axis,
                                const Real& along_axis, const Real& across, const Real& along, const Real& h) {
  Quaternion<Real> turned = q;
  if (along > Real(0)) {  // of a body in a line there is nothing to turn about its axis
    const Real rate = along_axis * ((across - along) / (across * along));
    if (detail::DualOf<Real>::is || rate != Real(0)) turned = quaternion_product(q, rotation(Real(h * rate), axis));
  }
  return quaternion_product(rotation<Real>(h * length / across, spin / length), turned);
}

/// What the motion of m = Pi/L between its turning points is made of; moments in the order of `Relabeled`.
template <class Real> struct FreeMotion {
  Real m, m1;                   ///< parameter of the elliptic functions and its complement
  Real lambda;                  ///< du/dt [1/time]
  Real a1, a2, a3;              ///< amplitudes, of an m of the size that was given
  Real ratio;                   ///< a2/a1, also where both are 0
  Real n, root;                 ///< characteristic of the third kind, and the root of n (1 - n)(n - m)
  Real precession;              ///< (I_3 - I_1) L/(I_1 I_3 lambda)
  JacobiFunctions<Real> start;  ///< at u_0
  Real sense;                   ///< -1 where the third axis has the smallest moment: m circles the other way
};

/// @param m  of any size that is not 0
template <class Real>
FreeMotion<Real> free_motion(const Vec3<Real>& I, const Vec3<Real>& m, const Real& size, const Real& length) {
  using std::sqrt;
  const Real d21 = I[1] - I[0], d31 = I[2] - I[0], d32 = I[2] - I[1];
  const Real p1 = m[0] * m[0], p2 = m[1] * m[1], p3 = m[2] * m[2];
  // The same rounded ratios throughout, so that sn^2 + cn^2 is not off 1 the same way each time.
  const Real c21 = d21 / I[1], c31 = d31 / I[0], c32 = d32 / I[1], e31 = d31 / I[2];
  const Real w1 = p2 * c21 + p3 * e31, w3 = p1 * c31 + p2 * c32;  // w1 = (1 - 2 T I_1/L^2) |m|^2
  const Real below = w1 * c32;
  FreeMotion<Real> f;
  f.sense = d31 < Real(0) ? Real(-1) : Real(1);
  f.m = w3 * c21 / below;
  f.m1 = (p3 * e31 * c32 - p1 * c31 * c21) / below;
  if (f.m1 < Real(0)) f.m1 = Real(0);  // on the separatrix, by rounding
  f.lambda = length * (sqrt((w1 / I[0]) * c32 / I[2]) / size);
  f.a1 = sqrt(w3 / c31);
  f.a2 = sqrt(w3 / c32);
  f.a3 = sqrt(w1 / e31);
  f.ratio = sqrt((I[1] / I[0]) * (d31 / d32));
  f.n = -(I[2] / I[0]) * (d21 / d32);
  const Real above = (I[1] / I[0]) * (d31 / d32);  // 1 - n
  f.root = sqrt(-f.n * above * (f.m - f.n));
  f.precession = (d31 / I[0]) / I[2] * length / f.lambda;
  if (f.a1 > Real(0)) {
    f.start = {f.sense * m[1] / f.a2, m[0] / f.a1, m[2] / f.a3};
  } else {
    f.start = {Real(0), Real(1), Real(1)};
  }
  return f;
}

/// The functions at u + v, as they are at u and what v adds to them: a short step is rounded once.
/// @param v  within a quarter period: cn is not below 0
template <class Real>
JacobiFunctions<Real> at_sum(const JacobiFunctions<Real>& u, const JacobiFunctions<Real>& v, const Real& m,
                             const Real& m1) {
  const Real s2 = v.sn * v.sn;
  // 1 - m sn^2 sn'^2 without its cancellation near the separatrix.
  const Real w2 = u.dn * u.dn, both = m * u.sn * v.sn, below = v.cn * v.cn + s2 * w2;
  const Real by_one = Real(1) / (Real(1) + v.cn);                                 // (1 - cn)/s2
  const Real by_dn = v.dn + v.cn > Real(0) ? Real(m1 / (v.dn + v.cn)) : Real(0);  // (dn - cn)/s2
  return {u.sn + (s2 * (v.cn * by_dn - w2) * u.sn + v.sn * u.cn * u.dn) / below,
          u.cn + (s2 * (v.cn * by_one - w2) * u.cn - u.sn * v.sn * u.dn * v.dn) / below,
          u.dn + (s2 * (v.cn * by_dn + v.dn * by_one - w2) * u.dn - both * u.cn * v.cn) / below};
}

/// The turn of a body about an axis, to first order in what its spin has beside that axis: the derivatives there, where
/// the amplitudes are 0.
template <class Real>
Quaternion<Real> turn_about_axis(const Vec3<Real>& I, const Vec3<Real>& m, const Real& length, const Real& h) {
  using std::sqrt;
  const Real first = length * ((I[2] - I[1]) / (I[1] * I[2])), second = length * ((I[2] - I[0]) / (I[0] * I[2]));
  const Real lambda = sqrt(first * second), ratio = first / lambda;  // m1' = - first m2, m2' = second m1
  const SineCosine<Real> u = sine_cosine<Real>(lambda * h);
  const Vec3<Real> stop(m[0] * u.cosine - m[1] * ratio * u.sine, m[1] * u.cosine + m[0] / ratio * u.sine, m[2]);
  return quaternion_product(quaternion_product(conjugate(onto_third(m)), rotation(Real(length * h / I[2]), 2)),
                            onto_third(stop));
}

/// Gives psi its derivatives, where numbers have some. Of psi itself they are differences of what grows without bound
/// near the axes; but p.dq at the end is p.dq at the start + d(h T) + T dh, and with P(m) turned about the third axis
/// by (m_1 dm_2 - m_2 dm_1)/(1 + m_3)
///
///     L dpsi = h dT + 2 T dh - L (what P turns at the end - what it turns at the start) .
template <class Real>
void give_slopes(Real& psi, const Vec3<Real>& I, const Vec3<Real>& start, const Vec3<Real>& stop, const Real& length,
                 const Real& h) {
  if constexpr (detail::DualOf<Real>::is) {
    const Real energy = turning_energy<Real>(Vec3<Real>(length * start), I);
    const auto turned = [](const Vec3<Real>& m, std::size_t k) {
      return (m[0].value * m[1].slope[k] - m[1].value * m[0].slope[k]) / (1 + m[2].value);
    };
    for (std::size_t k = 0; k < psi.slope.size(); ++k) {
      psi.slope[k] = (h.value * energy.slope[k] + 2 * energy.value * h.slope[k]) / length.value - turned(stop, k) +
                     turned(start, k);
    }
  }
}

/// The turn of a body of three different moments.
template <class Real>
Quaternion<Real> turn_asymmetric(const Quaternion<Real>& q, const Vec3<Real>& inertia, const Vec3<Real>& m,
                                 const Real& length, const Relabeled& labels, const Real& h) {
  using std::atan2, std::fabs, std::floor;
  const Vec3<Real> I(inertia[labels.axis[0]], inertia[labels.axis[1]], inertia[labels.axis[2]]), unit = labels.to(m);
  // What is the same in every step, as the amplitudes are, would be rounded the same way each time, and the energy
  // would move one way: so m is of another length at each place of its path.
  const Real size = Real(1.5) + Real(0.37) * unit[0] + Real(0.23) * unit[1] + Real(0.11) * unit[2];
  const Vec3<Real> start = size * unit;
  const FreeMotion<Real> f = free_motion(I, start, size, length);
  if (detail::DualOf<Real>::is && !(f.a1 > Real(0))) {
    const Quaternion<Real> turn = turn_about_axis(I, unit, length, h);
    return quaternion_product(q, quaternion(turn[0], labels.back(vector_part(turn))));
  }
  Real rest = f.lambda * h, integral(0);  // of the third kind
  bool odd = false;
  Real halves(0);  // of the period of m: half turns about the third axis
  const Real half_turn = atan2(Real(0), Real(-1));
  if (f.m1 > Real(0) && fabs(rest) > half_turn / Real(2)) {  // a quarter period is no shorter
    const Real quarter = complete_elliptic(f.m1);
    if (fabs(rest) > quarter) {
      halves = floor(rest / (Real(2) * quarter) + Real(0.5));
      rest -= halves * (Real(2) * quarter);
      odd = halves - Real(2) * floor(halves / Real(2)) != Real(0);
      integral = Real(2) * halves * complete_third_elliptic(quarter, f.n, f.m1);
    }
  }
  const JacobiFunctions<Real> step = jacobi_functions(rest, f.m1), end = at_sum(f.start, step, f.m, f.m1);
  integral += third_elliptic(rest, f.n, step);
  const Real sines = f.start.sn * step.sn * end.sn;
  const Real beside = Real(1) - f.n * end.sn * end.sn + f.n * f.start.sn * step.sn * end.cn * end.dn;
  const Real circled = atan2(f.ratio * (f.start.cn * end.sn - f.start.sn * end.cn),
                             f.start.cn * end.cn + f.ratio * f.ratio * f.start.sn * end.sn);
  Real psi = length * h / I[2] + f.precession * integral -
             f.sense * (atan2(f.root * sines, beside) + circled + half_turn * halves);
  const Real flip(odd ? -1 : 1);
  const Vec3<Real> stop(flip * f.a1 * end.cn, flip * f.sense * f.a2 * end.sn, f.a3 * end.dn);
  give_slopes<Real>(psi, I, unit, Vec3<Real>(stop / size), length, h);
  const Quaternion<Real> turn =
      quaternion_product(quaternion_product(conjugate(onto_third(start)), rotation(psi, 2)), onto_third(stop));
  return quaternion_product(q, quaternion(turn[0], labels.back(vector_part(turn))));
}

/// The rotation that a body which does not turn begins with: the derivatives of its turn.
template <class Real>
Quaternion<Real> turn_from_rest(const Quaternion<Real>& q, const Vec3<Real>& in_body, const Vec3<Real>& inertia,
                                const Real& h) {
  const Vec3<Real> rate = rate_in_body<Real>(in_body, inertia);
  const Real half = h / Real(2);
  return quaternion_product(q, quaternion(Real(1), Vec3<Real>(half * rate[0], half * rate[1], half * rate[2])));
}

/// A row of a column in one of its lanes.
template <int w> Eigen::Matrix<double, w, 1> in_lane(std::size_t lane, const Eigen::Matrix<Pack, w, 1>& row) {
  Eigen::Matrix<double, w, 1> one;
  for (int k = 0; k < w; ++k) one[k] = row[k].lane[lane];
  return one;
}

/// Turns eight bodies one after the other.
/// @param turn  of one lane, as doubles
template <class Turn> Turned<Pack> turn_lane_by_lane(const Turn& turn) {
  Turned<Pack> all;
  for (std::size_t lane = 0; lane < Pack::lanes; ++lane) {
    const Turned<double> one = turn(lane);
    for (int k = 0; k < 4; ++k) all.orientation[k].lane[lane] = one.orientation[k];
    all.action.lane[lane] = one.action;
  }
  return all;
}

}  // namespace

template <class Real>
Turned<Real> turn_exactly(const Quaternion<Real>& q, const Vec3<Real>& spin, const Vec3<Real>& inertia, const Real& h) {
  using std::sqrt;
  const Vec3<Real> in_body = spin_in_body(q, spin);
  const Real action = h * turning_energy(in_body, inertia), length = sqrt(norm2(spin));
  if (turning_freedoms(inertia) == 0) return {q, action};
  if (!(length != Real(0))) {
    if constexpr (detail::DualOf<Real>::is) return {turn_from_rest(q, in_body, inertia, h), action};
    return {q, action};
  }
  std::array<int, 3> by = {0, 1, 2};  // ascending moments
  std::sort(by.begin(), by.end(), [&](int a, int b) { return inertia[a] < inertia[b]; });
  const Real low = inertia[by[0]], middle = inertia[by[1]], high = inertia[by[2]];
  Quaternion<Real> turned;
  if (low == middle) {
    turned = turn_symmetric(q, spin, length, by[2], in_body[by[2]], low, high, h);
  } else if (middle == high) {
    turned = turn_symmetric(q, spin, length, by[0], in_body[by[0]], high, low, h);
  } else {
    const Vec3<Real> m = in_body / length;
    const Real about_high = m[by[2]] * m[by[2]] * ((high - middle) / high);
    const bool largest = about_high > m[by[0]] * m[by[0]] * ((middle - low) / low);
    const Relabeled labels = largest ? relabeled(by[0], by[1], by[2], m) : relabeled(by[2], by[1], by[0], m);
    turned = turn_asymmetric(q, inertia, m, length, labels, h);
  }
  return {renormalized(turned), action};
}

template <>
Turned<Pack> turn_exactly(const Quaternion<Pack>& q, const Vec3<Pack>& spin, const Vec3<Pack>& inertia, const Pack& h) {
  return turn_lane_by_lane([&](std::size_t k) {
    return turn_exactly<double>(in_lane(k, q), in_lane(k, spin), in_lane(k, inertia), h.lane[k]);
  });
}

template <class Real>
Turned<Real> turn_by_axes(const Quaternion<Real>& q, const Vec3<Real>& spin, const Vec3<Real>& inertia, const Real& h,
                          const AxisOrder& order) {
  AxisTurn<Real> turn{q, spin_in_body(q, spin)};
  // Half angles are Pi_k times these in a whole step; an axis without a moment does not turn.
  Vec3<Real> per_spin = Vec3<Real>::Zero();
  for (int k = 0; k < 3; ++k) {
    if (inertia[k] > Real(0)) per_spin[k] = h / (Real(2) * inertia[k]);
  }
  Real action(0);
  for (std::size_t stage = 0; stage < 5; ++stage) {
    const int k = order[stage < 3 ? stage : 4 - stage];
    const Real along = turn.in_body[k], half = along * (stage == 2 ? per_spin[k] : Real(per_spin[k] / Real(2)));
    action += along * half;
    turn.about(k, half);
  }
  return {renormalized(turn.q), action};
}

template <>
Turned<Pack> turn_by_axes(const Quaternion<Pack>& q, const Vec3<Pack>& spin, const Vec3<Pack>& inertia, const Pack& h,
                          const AxisOrder& order) {
  return turn_lane_by_lane([&](std::size_t k) {
    return turn_by_axes<double>(in_lane(k, q), in_lane(k, spin), in_lane(k, inertia), h.lane[k], order);
  });
}

namespace {

/// Turns one body of eight systems, which stand side by side as eight bodies of one do.
/// @return whether it could: none turns too far for the lanes
bool turn_in_lanes(RowColumn<Pack, 4>& orientation, const VectorColumn<Pack>& spin, const VectorColumn<Pack>& inertia,
                   double h, const AxisOrder& order, Index i, Pack& action) {
  const auto of = [&](const auto& column, int k) { return column.component(k)[i].lane.data(); };
  double* turned[4];
  for (int k = 0; k < 4; ++k) turned[k] = orientation.component(k)[i].lane.data();
  const TurningColumns columns{{turned[0], turned[1], turned[2], turned[3]},
                               {of(spin, 0), of(spin, 1), of(spin, 2)},
                               {of(inertia, 0), of(inertia, 1), of(inertia, 2)},
                               action.lane.data()};
  return free_rotor_kernels().by_axes(columns, h, order.data(), 0, Pack::lanes) == Pack::lanes;
}

}  // namespace

template <class Real>
void turn_all_by_axes(RowColumn<Real, 4>& orientation, const VectorColumn<Real>& spin,
                      const VectorColumn<Real>& inertia, const Real& h, const AxisOrder& order, Index begin, Index end,
                      ScalarColumn<Real>& action) {
  const auto turn = [&](Index from, Index to) {
    for (Index i = from; i < to; ++i) {
      action[i] = Real(0);
      const Vec3<Real> moments = inertia[i];
      if (turning_freedoms(moments) == 0) continue;
      const Turned<Real> next = turn_by_axes<Real>(std::as_const(orientation)[i], spin[i], moments, h, order);
      orientation.set(i, next.orientation);
      action[i] = next.action;
    }
  };
  if constexpr (std::is_same_v<Real, double>) {
    const TurningColumns columns{
        {orientation.component(0), orientation.component(1), orientation.component(2), orientation.component(3)},
        {spin.component(0), spin.component(1), spin.component(2)},
        {inertia.component(0), inertia.component(1), inertia.component(2)},
        action.data()};
    for (Index i = begin; (i = free_rotor_kernels().by_axes(columns, h, order.data(), i, end)) < end; i += 8)
      turn(i, std::min(i + 8, end));
  } else if constexpr (std::is_same_v<Real, Pack>) {
    const bool one_step = all(h == Pack(h.lane[0]));
    for (Index i = begin; i < end; ++i) {
      if (!one_step || !turn_in_lanes(orientation, spin, inertia, h.lane[0], order, i, action[i])) turn(i, i + 1);
    }
  } else {
    turn(begin, end);
  }
}

namespace {
[[noreturn]] void refuse_axes(const std::string& text) {
  throw Error("axes = \"" + text + "\" is not an order of three axes; \"xyz\", \"zyx\" or another one is expected",
              {.key = "axes", .value = "\"" + text + "\""});
}
}  // namespace

AxisOrder axis_order(const std::string& text) {
  static constexpr std::string_view names = "xyz";
  AxisOrder order{};
  std::string sorted = text;
  std::sort(sorted.begin(), sorted.end());
  if (sorted != names) refuse_axes(text);
  for (std::size_t k = 0; k < 3; ++k) order[k] = static_cast<int>(names.find(text[k]));
  return order;
}

#define NOETHER_FREE_ROTOR(Real)                                                                                  \
  template Turned<Real> turn_exactly(const Quaternion<Real>&, const Vec3<Real>&, const Vec3<Real>&, const Real&); \
  template Turned<Real> turn_by_axes(const Quaternion<Real>&, const Vec3<Real>&, const Vec3<Real>&, const Real&,  \
                                     const AxisOrder&);                                                           \
  template void turn_all_by_axes(RowColumn<Real, 4>&, const VectorColumn<Real>&, const VectorColumn<Real>&,       \
                                 const Real&, const AxisOrder&, Index, Index, ScalarColumn<Real>&);

using Tangent = Dual<double, 1>;
using WideTangent = Dual<Quad, 1>;

NOETHER_FREE_ROTOR(double)
NOETHER_FREE_ROTOR(Quad)
NOETHER_FREE_ROTOR(Tangent)
NOETHER_FREE_ROTOR(WideTangent)
template void turn_all_by_axes(RowColumn<Pack, 4>&, const VectorColumn<Pack>&, const VectorColumn<Pack>&, const Pack&,
                               const AxisOrder&, Index, Index, ScalarColumn<Pack>&);

#undef NOETHER_FREE_ROTOR

}  // namespace noether
