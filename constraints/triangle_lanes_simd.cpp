#include "constraints/molecule_kernels_simd.hpp"
#include "constraints/molecule_stage_simd.hpp"

#include <limits>

namespace noether::NOETHER_SIMD_LEVEL {

namespace {

constexpr double settled = 4e-15, hard_start = 0.25;
constexpr int newton_steps = 4;

template <int P> struct Atoms { Vectors<P> x[3]; };
/// Multipliers of the bonds 0-1, 0-2 and 1-2.
template <int P> struct Three { Pack<P> a, b, c; };

template <int P> HWY_INLINE Pack<P>& part(Vectors<P>& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// The vectors r1 and r2 of a column, at nearest images where there is an edge.
template <int P>
HWY_INLINE void bonds_of(const MoleculePack& pack, const double* const (&column)[3], const double* edge, double* slots,
                         Vectors<P>& first, Vectors<P>& second) {
  for (int axis = 0; axis < 3; ++axis) {
    load_atoms<P>(pack, column[axis], slots);
    const Pack<P> origin = load<P>(slots);
    Pack<P> one = load<P>(slots + P) - origin, two = load<P>(slots + 2 * P) - origin;
    if (edge != nullptr && edge[axis] > 0) one = nearest<P>(one, edge[axis]), two = nearest<P>(two, edge[axis]);
    part(first, axis) = one;
    part(second, axis) = two;
  }
}
template <int P, class MakeRow>
HWY_INLINE void put(const MoleculePack& pack, Atoms<P>& atoms, const Flags<P>& out, double* slots,
                    const MakeRow& make_row) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int a = 0; a < 3; ++a) store(none_where(out, part(atoms.x[a], axis)), slots + a * P);
    store_atoms<P>(pack, slots, make_row(axis));
  }
}

/// Three equations by the constant inverse.
template <int P>
HWY_INLINE Three<P> solve(const RigidTriangles& t, const Pack<P>& e1, const Pack<P>& e2, const Pack<P>& e3) {
  const auto row = [&](int a, int b, int c) HWY_ATTR {
    return add_product(load<P>(t.inverse[a]), e1, add_product(load<P>(t.inverse[b]), e2, load<P>(t.inverse[c]) * e3));
  };
  return {row(0, 1, 2), row(1, 3, 4), row(2, 4, 5)};
}
/// M^-1 G^T lambda.
template <int P>
HWY_INLINE void push(const RigidTriangles& t, const Vectors<P>& r1, const Vectors<P>& r2, const Three<P>& l,
                     Atoms<P>& out) {
  const Vectors<P> f1 = l.a * r1, f2 = l.b * r2, r3 = r2 - r1;
  out.x[0] = same<P>(-t.inverse_mass[0]) * (f1 + f2);
  out.x[1] = same<P>(t.inverse_mass[1]) * take_product(l.c, r3, f1);
  out.x[2] = same<P>(t.inverse_mass[2]) * add_product(l.c, r3, f2);
}

/// What multipliers make of s1 and s2: s1 + a1 r1 + b1 r2, s2 + a2 r1 + b2 r2.
template <int P> struct Shares {
  Pack<P> a1, b1, a2, b2;

  HWY_INLINE Shares(const RigidTriangles& t, const Three<P>& l) {
    const Pack<P> k1 = same<P>(t.inverse_mass[1]) * l.c, k2 = same<P>(t.inverse_mass[2]) * l.c;
    const Pack<P> w0 = same<P>(t.inverse_mass[0]);
    a1 = add_product(same<P>(t.inverse_mass[0] + t.inverse_mass[1]), l.a, k1);
    b1 = w0 * l.b - k1;
    a2 = w0 * l.a - k2;
    b2 = add_product(same<P>(t.inverse_mass[0] + t.inverse_mass[2]), l.b, k2);
  }
};

/// Newton's method on what violations depend on: scalar products of the bonds s with the bonds r.
/// @param before, after  the largest violations, relative to c11, of free motion and of what comes out
template <int P>
HWY_INLINE Three<P> solve_newton(const RigidTriangles& t, const Vectors<P>& r1, const Vectors<P>& r2,
                                 const Vectors<P>& s1, const Vectors<P>& s2, Pack<P>& before, Pack<P>& after) {
  const Pack<P> p11 = dot(s1, r1), p12 = dot(s1, r2), p21 = dot(s2, r1), p22 = dot(s2, r2);
  const Pack<P> c11 = load<P>(t.c11), c12 = load<P>(t.c12), c22 = load<P>(t.c22), half = same<P>(0.5);
  const Pack<P> w0 = same<P>(t.inverse_mass[0]), w1 = same<P>(t.inverse_mass[1]), w2 = same<P>(t.inverse_mass[2]);
  const Pack<P> w01 = same<P>(t.inverse_mass[0] + t.inverse_mass[1]),
                w02 = same<P>(t.inverse_mass[0] + t.inverse_mass[2]);
  const Pack<P> n11 = c11 - dot(s1, s1), n12 = c12 - dot(s1, s2), n22 = c22 - dot(s2, s2);
  const auto largest = [&](const Pack<P>& e1, const Pack<P>& e2, const Pack<P>& e12) HWY_ATTR {
    return larger(absolute(e1), larger(absolute(e2), absolute(e12))) * load<P>(t.inverse_c11);
  };
  Pack<P> e1 = half * n11, e2 = half * n22, e12 = n12;
  before = largest(e1, e2, e12);
  Three<P> l = solve<P>(t, e1, e2, (e1 + e2) - e12);  // the equation of the third bond
  for (int step = 0;; ++step) {
    const Shares<P> by(t, l);
    const Pack<P> t11 = add_product(by.a1, c11, add_product(by.b1, c12, p11));
    const Pack<P> t12 = add_product(by.a1, c12, add_product(by.b1, c22, p12));
    const Pack<P> t21 = add_product(by.a2, c11, add_product(by.b2, c12, p21));
    const Pack<P> t22 = add_product(by.a2, c12, add_product(by.b2, c22, p22));
    e1 = half * (n11 - add_product(by.a1, p11 + t11, by.b1 * (p12 + t12)));
    e2 = half * (n22 - add_product(by.a2, p21 + t21, by.b2 * (p22 + t22)));
    e12 = n12 - add_product(by.a1, p21, add_product(by.b1, p22, add_product(by.a2, t11, by.b2 * t12)));
    after = largest(e1, e2, e12);
    if (step == newton_steps - 1) return l;
    const Pack<P> j11 = w01 * t11, j12 = w0 * t12, j13 = w1 * (t11 - t12);
    const Pack<P> j21 = w0 * t21, j22 = w02 * t22, j23 = w2 * (t22 - t21);
    const Pack<P> j31 = add_product(w01, t21, w0 * t11), j32 = add_product(w0, t22, w02 * t12);
    const Pack<P> j33 = add_product(w1, t21 - t22, w2 * (t12 - t11));
    const Pack<P> i11 = take_product(j23, j32, j22 * j33), i12 = take_product(j12, j33, j13 * j32);
    const Pack<P> i13 = take_product(j13, j22, j12 * j23), i21 = take_product(j21, j33, j23 * j31);
    const Pack<P> i22 = take_product(j13, j31, j11 * j33), i23 = take_product(j11, j23, j13 * j21);
    const Pack<P> i31 = take_product(j22, j31, j21 * j32), i32 = take_product(j11, j32, j12 * j31);
    const Pack<P> i33 = take_product(j12, j21, j11 * j22);
    const Pack<P> inverse = same<P>(1) / add_product(j11, i11, add_product(j12, i21, j13 * i31));
    const Pack<P> f1 = inverse * e1, f2 = inverse * e2, f12 = inverse * e12;
    l.a = l.a + add_product(i11, f1, add_product(i12, f2, i13 * f12));
    l.b = l.b + add_product(i21, f1, add_product(i22, f2, i23 * f12));
    l.c = l.c + add_product(i31, f1, add_product(i32, f2, i33 * f12));
  }
}

/// SETTLE about the centre of mass: what is to be added to the atoms where free motion ends. Where there is no
/// solution, it is no number. @source MiyamotoKollman1992
template <int P>
HWY_INLINE void settle(const RigidTriangles& t, const Vectors<P>& b0, const Vectors<P>& c0, const Vectors<P>& s1,
                       const Vectors<P>& s2, Atoms<P>& out) {
  const Pack<P> one = same<P>(1), zero = same<P>(0);
  const Pack<P> share1 = same<P>(-t.part1), share2 = same<P>(t.part2);
  const Vectors<P> a1 = take_product(share2, s2, share1 * s1), b1 = s1 + a1, c1 = s2 + a1;
  Vectors<P> z = cross(b0, c0), x = cross(a1, z);
  z = (one / root(dot(z, z))) * z;
  x = (one / root(dot(x, x))) * x;
  const Vectors<P> y = cross(z, x);
  const Pack<P> xb0 = dot(x, b0), yb0 = dot(y, b0), xc0 = dot(x, c0), yc0 = dot(y, c0);
  const Pack<P> za1 = dot(z, a1), xb1 = dot(x, b1), yb1 = dot(y, b1), zb1 = dot(z, b1);
  const Pack<P> xc1 = dot(x, c1), yc1 = dot(y, c1), zc1 = dot(z, c1);
  const Pack<P> sin_phi = load<P>(t.inverse_apex) * za1, cos_phi = root(take_product(sin_phi, sin_phi, one));
  const Pack<P> half_base = load<P>(t.half_base);
  const Pack<P> sin_psi = (zb1 - zc1) / ((half_base + half_base) * cos_phi);
  const Pack<P> cos_psi = root(take_product(sin_psi, sin_psi, one));
  const Pack<P> ya2 = load<P>(t.apex) * cos_phi, xb2 = (zero - half_base) * cos_psi;
  const Pack<P> t1 = (zero - load<P>(t.base)) * cos_phi, t2 = half_base * (sin_psi * sin_phi);
  const Pack<P> yb2 = t1 - t2, yc2 = t1 + t2;
  const Pack<P> alpha = add_product(xb2, xb0 - xc0, add_product(yb0, yb2, yc0 * yc2));
  const Pack<P> beta = add_product(xb2, yc0 - yb0, add_product(xb0, yb2, xc0 * yc2));
  const Pack<P> gamma = take_product(xb1, yb0, take_product(xc1, yc0, add_product(xb0, yb1, xc0 * yc1)));
  const Pack<P> sum = add_product(alpha, alpha, beta * beta), other = root(take_product(gamma, gamma, sum));
  const Pack<P> inverse = one / sum;
  const Pack<P> sine = inverse * take_product(beta, other, alpha * gamma);
  const Pack<P> cosine = inverse * add_product(alpha, other, beta * gamma);
  const auto place = [&](const Pack<P>& xk, const Pack<P>& yk, const Pack<P>& zk) HWY_ATTR {
    return add_product(take_product(yk, sine, xk * cosine), x,
                       add_product(add_product(yk, cosine, xk * sine), y, zk * z));
  };
  out.x[0] = place(zero, ya2, za1) - a1;
  out.x[1] = place(xb2, yb2, zb1) - b1;
  out.x[2] = place(zero - xb2, yc2, zc1) - c1;
}

template <int P, bool closed_form>
MoleculeReport solve_pack(const MoleculePack& pack, const MoleculeColumns& c, const MoleculeTask& task) {
  const RigidTriangles& t = *pack.triangles;
  double* const slots = pack.scratch;
  const double* const ends[3] = {c.x[0], c.x[1], c.x[2]};
  Vectors<P> r1, r2, s1, s2;
  bonds_of<P>(pack, c.start, c.edge, slots, r1, r2);
  bonds_of<P>(pack, ends, nullptr, slots, s1, s2);
  if (c.edge[0] > 0) s1 = r1 + s1, s2 = r2 + s2;  // there x is what has moved
  Atoms<P> moved;
  Pack<P> before, after;
  if constexpr (closed_form) {
    settle<P>(t, r1, r2, s1, s2, moved);
    const Vectors<P> e1 = s1 + (moved.x[1] - moved.x[0]), e2 = s2 + (moved.x[2] - moved.x[0]);
    const Pack<P> inverse = same<P>(0.5) * load<P>(t.inverse_c11);
    after = larger(absolute(load<P>(t.c11) - dot(e1, e1)), absolute(load<P>(t.c22) - dot(e2, e2))) * inverse;
    before = same<P>(0);
  } else {
    push<P>(t, r1, r2, solve_newton<P>(t, r1, r2, s1, s2, before, after), moved);
  }
  const Flags<P> idle = idle_lanes<P>(pack);
  const Flags<P> hard = but_not(either(exceeds(before, same<P>(hard_start)), exceeds(after, same<P>(settled))), idle);
  const MoleculeReport report{.open = bits_of(hard), .sweeps = closed_form ? 0 : newton_steps};
  const double inverse_h = 1 / task.h;
  put<P>(pack, moved, either(hard, idle), slots, [&](int a) {
    return PositionRow{c.x[a], c.v[a], inverse_h, c.magic[a]};
  });
  return report;
}

/// The constant inverse, twice: what the first time leaves is known from scalar products.
template <int P> MoleculeReport project_pack(const MoleculePack& pack, const MoleculeColumns& c) {
  const RigidTriangles& t = *pack.triangles;
  double* const slots = pack.scratch;
  const double* const velocities[3] = {c.v[0], c.v[1], c.v[2]};
  Vectors<P> r1, r2, v1, v2;
  bonds_of<P>(pack, c.start, c.edge, slots, r1, r2);
  bonds_of<P>(pack, velocities, nullptr, slots, v1, v2);
  const Pack<P> zero = same<P>(0), c11 = dot(r1, r1), c12 = dot(r1, r2), c22 = dot(r2, r2);
  const auto along = [&](const Pack<P>& p11, const Pack<P>& p12, const Pack<P>& p21, const Pack<P>& p22) HWY_ATTR {
    const Pack<P> e1 = zero - p11, e2 = zero - p22;
    return solve<P>(t, e1, e2, (e1 + e2) + (p12 + p21));
  };
  const Pack<P> p11 = dot(r1, v1), p12 = dot(r2, v1), p21 = dot(r1, v2), p22 = dot(r2, v2);
  Three<P> l = along(p11, p12, p21, p22);
  const Shares<P> by(t, l);
  const Three<P> more = along(
      add_product(by.a1, c11, add_product(by.b1, c12, p11)), add_product(by.a1, c12, add_product(by.b1, c22, p12)),
      add_product(by.a2, c11, add_product(by.b2, c12, p21)), add_product(by.a2, c12, add_product(by.b2, c22, p22)));
  l = {l.a + more.a, l.b + more.b, l.c + more.c};
  Atoms<P> moved;
  push<P>(t, r1, r2, l, moved);
  // Velocities that are no numbers are left to those who name them.
  const Flags<P> idle = idle_lanes<P>(pack);
  const Pack<P> all = absolute(l.a) + (absolute(l.b) + absolute(l.c));
  const Flags<P> lost = but_not(exceeds(all, same<P>(std::numeric_limits<double>::max())), idle);
  put<P>(pack, moved, either(lost, idle), slots, [&](int a) { return VelocityRow{c.v[a]}; });
  return {.open = bits_of(lost)};
}

template <bool closed_form>
MoleculeReport solve_positions(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask& task) {
  return solve_pack<8, closed_form>(pack, columns, task);
}
MoleculeReport project_velocities(const MoleculePack& pack, const MoleculeColumns& columns, const MoleculeTask&) {
  return project_pack<8>(pack, columns);
}

}  // namespace

extern const MoleculeKernels triangle_lanes;
const MoleculeKernels triangle_lanes{
    .solve_positions = solve_positions<false>, .project_velocities = project_velocities, .most_of_sixteen = 0};
extern const MoleculeKernels settle_lanes;
const MoleculeKernels settle_lanes{
    .solve_positions = solve_positions<true>, .project_velocities = project_velocities, .most_of_sixteen = 0};

}  // namespace noether::NOETHER_SIMD_LEVEL
