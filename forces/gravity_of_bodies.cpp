#include "forces/gravity_of_bodies.hpp"

#include "forces/on_sites.hpp"
#include "numbers/parallel.hpp"

#include <utility>
#include <vector>

namespace noether {

namespace {

/// A body as the others feel it.
template <class Real> struct Pull {
  Vec3<Real> x;
  Real mass, trace;  ///< of the moments; 0: of a point
  Vec3<Real> moments;
  Mat3<Real> axes;  ///< of bodies alone
};

/// The bodies of the last evaluation, and their sites where they are asked for.
template <class Real> struct Pulling {
  std::vector<Pull<Real>> bodies;
  KeptSites<Real> sites;
};

/// What the second degree of a body does at a place, for one unit of mass there and G = 1.
template <class Real> struct SecondDegree {
  Vec3<Real> pull = Vec3<Real>::Zero();    ///< acceleration there
  Vec3<Real> torque = Vec3<Real>::Zero();  ///< on the body
  Real potential = Real(0);
};

/// @param e, r  direction from the body to the place or back, and the distance
template <class Real> SecondDegree<Real> second_degree(const Pull<Real>& body, const Vec3<Real>& e, const Real& r) {
  if (body.trace == Real(0)) return {};
  const Real r2 = r * r;
  const Vec3<Real> in_body = to_body<Real>(body.axes, e);
  const Vec3<Real> scaled(body.moments[0] / r2 * in_body[0], body.moments[1] / r2 * in_body[1],
                          body.moments[2] / r2 * in_body[2]);
  const Vec3<Real> moment = to_space<Real>(body.axes, scaled);  // I e/r^2
  const Real along = dot(e, moment), trace = body.trace / r2, over = Real(1) / (Real(2) * r2);
  return {over * ((Real(15) * along - Real(3) * trace) * e - Real(6) * moment), Real(3) / r * cross<Real>(e, moment),
          -(trace - Real(3) * along) / (Real(2) * r)};
}

template <class Real> void look_at(const ParticleSystem<Real>& s, std::vector<Pull<Real>>& bodies) {
  bodies.resize(static_cast<std::size_t>(s.size()));
  const bool turning = s.bodies() != nullptr;
  const auto* inertia = turning ? &s.template column<BodyInertia>() : nullptr;
  const auto* orientation = turning ? &s.template column<BodyOrientation>() : nullptr;
  for (Index i = 0; i < s.size(); ++i) {
    Pull<Real>& one = bodies[static_cast<std::size_t>(i)];
    one.x = s.positions()[i];
    one.mass = s.masses()[i];
    one.moments = Vec3<Real>::Zero();
    if (turning) one.moments = (*inertia)[i];
    one.trace = one.moments[0] + one.moments[1] + one.moments[2];
    if (one.trace != Real(0)) one.axes = rotation_matrix<Real>((*orientation)[i]);
  }
}

/// The pull of `i` and `j` on each other, by their masses and moments.
template <class Real>
void add_pair(const Real& g, bool point_masses, const std::vector<Pull<Real>>& bodies, Index i, Index j,
              ForceSink<Real>& out) {
  using std::sqrt;
  const Pull<Real>&a = bodies[static_cast<std::size_t>(i)], &b = bodies[static_cast<std::size_t>(j)];
  const Vec3<Real> d = a.x - b.x;
  const Real r = sqrt(norm2(d));
  const Vec3<Real> e = d / r;
  const SecondDegree<Real> of_a = second_degree(a, e, r), of_b = second_degree(b, e, r);
  const Vec3<Real> between = point_masses ? Vec3<Real>(-(g / (r * r)) * e) : Vec3<Real>(Vec3<Real>::Zero());
  if (a.mass == Real(0) || b.mass == Real(0)) {  // a tracer
    if (a.mass == Real(0)) out.acceleration(i, b.mass * between + g * of_b.pull);
    if (b.mass == Real(0)) out.acceleration(j, -(a.mass * between + g * of_a.pull));
    return;
  }
  out.pair(i, j, a.mass * b.mass * between + (g * a.mass) * of_b.pull + (g * b.mass) * of_a.pull);
  out.torque(i, (g * b.mass) * of_a.torque);
  out.torque(j, (g * a.mass) * of_b.torque);
  if (!out.wants_energy()) return;
  if (point_masses) out.energy(-g * a.mass * b.mass / r);
  out.energy(g * (a.mass * of_b.potential + b.mass * of_a.potential));
}

/// The pull of all sites of `i` and `j` on each other.
template <class Real>
void add_sites(const Real& g, const Sites<Real>& sites, const ParticleSystem<Real>& s, Index i, Index j,
               ForceSink<Real>& out) {
  using std::sqrt;
  const auto& x = sites.particles().positions();
  const auto& m = sites.particles().masses();
  const bool tracers = s.masses()[i] == Real(0) || s.masses()[j] == Real(0);
  Vec3<Real> force = Vec3<Real>::Zero(), on_i = force, on_j = force;
  WideSum<Real> energy;
  for (Index a = sites.first(i); a < sites.first(i + 1); ++a) {
    Vec3<Real> of_site = Vec3<Real>::Zero();
    for (Index b = sites.first(j); b < sites.first(j + 1); ++b) {
      const Vec3<Real> d = x[a] - x[b];
      const Real r2 = norm2(d), r = sqrt(r2);
      const Real product = tracers ? Real(g * (m[a] + m[b])) : Real(g * m[a] * m[b]);
      const Vec3<Real> f = -(product / (r2 * r)) * d;
      of_site += f;
      if (tracers) continue;
      on_j -= cross<Real>(sites.arm(b), f);
      if (out.wants_energy()) energy += -(product / r);
    }
    force += of_site;
    on_i += cross<Real>(sites.arm(a), of_site);
  }
  if (tracers) {
    if (s.masses()[i] == Real(0)) out.acceleration(i, force);
    if (s.masses()[j] == Real(0)) out.acceleration(j, -force);
    return;
  }
  out.pair(i, j, force);
  out.torque(i, on_i);
  out.torque(j, on_j);
  out.energy(energy);
}

}  // namespace

void GravityOfBodies::check() const {
  check_constant_of_gravitation(G);
  if (point_masses || degree == Figure::second_degree) return;
  throw Error("sites are point masses, so degree = \"sites\" cannot leave these out; give degree = 2",
              {.key = "point_masses"});
}

void GravityOfBodies::check_bodies(const Bodies* bodies) {
  if (bodies == nullptr || !bodies->any_held()) return;
  throw Error("gravity_of_bodies moves bodies, but a fixed point holds one of them; use uniform_field for a top");
}

void GravityOfBodies::refuse_one_site(const std::string& body) {
  throw Error("'" + body + "' has one site, so degree = \"sites\" takes it for a point; give degree = 2, or its sites",
              {.key = "degree"});
}

template <class Real>
  requires(std::is_same_v<Real, double> || std::is_same_v<Real, Quad> || std::is_same_v<Real, Pack> ||
           std::is_same_v<Real, Dual<double, 1>> || std::is_same_v<Real, Dual<Quad, 1>>)
void GravityOfBodies::add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
  const Real g(G ? *G : s.units().G);
  auto& here = out.workspace().template get<Pulling<Real>>();
  const bool by_sites = degree == Figure::sites && s.bodies() != nullptr;
  if (by_sites) {
    here.sites.follow(s, false);
  } else {
    look_at(s, here.bodies);
  }
  const auto& m = s.masses();
  for (Index i = 1; i < s.size(); ++i) {
    for (Index j = 0; j < i; ++j) {
      if (m[i] == Real(0) && m[j] == Real(0)) continue;
      if (by_sites) {
        add_sites(g, *here.sites, s, i, j, out);
      } else {
        add_pair(g, point_masses, here.bodies, i, j, out);
      }
    }
  }
}

template void GravityOfBodies::add_to(ForceSink<double>&, const ParticleSystem<double>&) const;
template void GravityOfBodies::add_to(ForceSink<Quad>&, const ParticleSystem<Quad>&) const;
template void GravityOfBodies::add_to(ForceSink<Pack>&, const ParticleSystem<Pack>&) const;
template void GravityOfBodies::add_to(ForceSink<Dual<double, 1>>&, const ParticleSystem<Dual<double, 1>>&) const;
template void GravityOfBodies::add_to(ForceSink<Dual<Quad, 1>>&, const ParticleSystem<Dual<Quad, 1>>&) const;
template struct detail::ForceModel<GravityOfBodies, double>;
template struct detail::ForceModel<GravityOfBodies, Quad>;

}  // namespace noether
