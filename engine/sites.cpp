#include "engine/sites.hpp"

#include "engine/charge.hpp"
#include "engine/sites_simd.hpp"
#include "numbers/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

namespace noether {

namespace {

/// What a site without mass has instead: forces on it stay in the range of doubles as accelerations, and what it pulls
/// is nothing beside any rounding.
constexpr double mass_of_none = 0x1p-200;

/// Types, parameters and bonds of the sites.
Topology topology_of_sites(const Topology* given, const Bodies& bodies, Index n, const std::vector<Index>& first) {
  Topology t;
  if (given != nullptr) {
    t.type_names = given->type_names;
    t.pair_kinds = given->pair_kinds;
    t.mixing = given->mixing;
    t.explicit_pairs = given->explicit_pairs;
    t.bond_kinds = given->bond_kinds;
    t.angle_kinds = given->angle_kinds;
    t.dihedral_kinds = given->dihedral_kinds;
    t.improper_kinds = given->improper_kinds;
  }
  const auto renamed = [&](const auto& terms, auto& to) {
    for (auto term : terms) {
      for (Index& i : term.particles) {
        if (bodies.kind(i) != nullptr) throw Error("a bond ends at a rigid body; bodies have no bonds yet");
        i = first[static_cast<std::size_t>(i)];
      }
      to.push_back(term);
    }
  };
  if (given != nullptr) {
    renamed(given->bonds, t.bonds);
    renamed(given->angles, t.angles);
    renamed(given->dihedrals, t.dihedrals);
    renamed(given->impropers, t.impropers);
    const auto at = [&](Index i) { return first[static_cast<std::size_t>(i)]; };
    const auto check = [&](Index i) {
      const BodyKind* kind = bodies.kind(i);
      if (kind == nullptr || kind->sites.size() == 1) return;
      throw Error("the pair of a rigid body is excluded or scaled, but the body has several sites; take the pair out",
                  {.key = "exclusions"});
    };
    for (const auto& [i, j] : given->exclusions) {
      check(i), check(j);
      t.exclusions.emplace_back(at(i), at(j));
    }
    for (const auto& one : given->scaled_pairs) {
      check(one.pair.first), check(one.pair.second);
      t.scaled_pairs.push_back({{at(one.pair.first), at(one.pair.second)}, one.factor});
    }
  }
  for (Index i = 0; i < n; ++i) {
    const BodyKind* kind = bodies.kind(i);
    const Index from = first[static_cast<std::size_t>(i)], to = first[static_cast<std::size_t>(i) + 1];
    for (Index a = from; a < to; ++a) {
      t.molecules.push_back(i + 1);  // 0 is no molecule
      const int type = kind != nullptr    ? kind->sites[static_cast<std::size_t>(a - from)].type
                       : given != nullptr ? given->type(i)
                                          : 0;
      t.types.push_back(type);
      for (Index b = a + 1; b < to; ++b) t.exclusions.emplace_back(a, b);
    }
  }
  std::sort(t.exclusions.begin(), t.exclusions.end());
  return t;
}

/// Whether the mass of a body, in some lane, is not that of its sites.
template <class Real> bool differs(const Real& mass, double of_sites) {
  using std::fabs;
  return any(fabs(mass - Real(of_sites)) > Real(1e-12 * of_sites));
}

/// Each of `count` numbers so many times in a row.
void repeat(const std::int32_t* from, Index count, Index times, std::int32_t* to) {
  if (times == 3) {  // water
    for (Index i = 0; i < count; ++i) to[3 * i] = to[3 * i + 1] = to[3 * i + 2] = from[i];
    return;
  }
  for (Index i = 0; i < count; ++i) to = std::fill_n(to, times, from[i]);
}

std::vector<double> places_of(const BodyKind* kind) {
  std::vector<double> places;
  if (kind == nullptr) return places;
  for (const BodySite& site : kind->sites) places.insert(places.end(), site.place.data(), site.place.data() + 3);
  return places;
}

}  // namespace

template <class Real> Sites<Real>::Sites(const ParticleSystem<Real>& s, bool pairs) : particles_(s.units()) {
  NOETHER_EXPECTS(s.bodies() != nullptr, "sites are those of rigid bodies");
  bodies_ = s.shared_bodies();
  const Bodies& bodies = *bodies_;
  const ScalarColumn<Real>* charges = s.template has<Charge>() ? &s.template column<Charge>() : nullptr;
  bool charged = charges != nullptr;
  for (const BodyKind& kind : bodies.kinds) {
    for (const BodySite& site : kind.sites) charged = charged || site.charge != 0;
  }
  if (charged) particles_.template add_column<Charge>();
  first_.push_back(0);
  for (Index i = 0; i < s.size(); ++i) {
    const BodyKind* kind = bodies.kind(i);
    const auto add = [&](const std::string& name, const Real& mass, const Real& charge) {
      const Index a = particles_.add(name, mass, s.positions()[i], Vec3<Real>::Zero());
      if (charged) particles_.template column<Charge>()[a] = charge;
    };
    if (kind == nullptr) {
      add(s.name(i), s.masses()[i], charges != nullptr ? (*charges)[i] : Real(0));
    } else {
      double mass = 0;
      for (const BodySite& site : kind->sites) mass += site.mass;
      if (differs(s.masses()[i], mass)) {
        throw Error(fmt::format("the mass of body '{}' is not that of its sites; change its sites too", s.name(i)));
      }
      for (const BodySite& site : kind->sites) {
        const std::string name = fmt::format("{} of {}", site.name.empty() ? "site" : site.name, s.name(i));
        add(name, Real(site.mass == 0 ? mass_of_none : site.mass), Real(site.charge));
      }
    }
    first_.push_back(particles_.size());
    if (runs_.empty() || runs_.back().kind != kind) runs_.push_back({kind, i, i, places_of(kind)});
    runs_.back().end = i + 1;
  }
  arms_ = VectorColumn<Real>(particles_.size());
  if (pairs) {
    particles_.set_topology(
        std::make_shared<const Topology>(topology_of_sites(s.topology(), bodies, s.size(), first_)));
  }
  particles_.set_box(s.box());
  follow(s);
}

template <class Real> void Sites<Real>::follow(const ParticleSystem<Real>& s) {
  VectorColumn<Real>& to = particles_.positions();
  const auto& orientation = s.template column<BodyOrientation>();  // here, where it may throw
  for_blocks(s.size(), [&](Index begin, Index end) {
    const auto behind =
        std::upper_bound(runs_.begin(), runs_.end(), begin, [](Index i, const Run& run) { return i < run.end; });
    for (auto run = behind; run != runs_.end() && run->begin < end; ++run) {
      const Index from = std::max(begin, run->begin), till = std::min(end, run->end);
      place(*run, from, till, s, orientation, to);
      for (int k = 0; s.box().is_periodic() && k < 3; ++k) {  // those of their bodies, before they are wrapped
        repeat(s.images().component(k) + from, till - from, first(from + 1) - first(from),
               particles_.images().component(k) + first(from));
      }
    }
  });
  particles_.clock() = s.clock();
  particles_.wrap();
}

template <class Real>
void Sites<Real>::place(const Run& run, Index begin, Index end, const ParticleSystem<Real>& s,
                        const RowColumn<Real, 4>& orientation, VectorColumn<Real>& to) {
  const auto& x = s.positions();
  if (run.kind == nullptr) {
    for (Index i = begin; i < end; ++i) to.set(first(i), x[i]);
    return;
  }
  const auto sites = static_cast<Index>(run.kind->sites.size());
  if constexpr (std::is_same_v<Real, double>) {
    const SiteColumns columns{
        {orientation.component(0), orientation.component(1), orientation.component(2), orientation.component(3)},
        {x.component(0), x.component(1), x.component(2)},
        {arms_.component(0), arms_.component(1), arms_.component(2)},
        {to.component(0), to.component(1), to.component(2)}};
    site_kernels().place(columns, run.places.data(), sites, begin, end, first(begin));
  } else {
    for (Index i = begin; i < end; ++i) {
      const Mat3<Real> r = rotation_matrix<Real>(orientation[i]);
      for (Index k = 0; k < sites; ++k) {
        const double* place = run.places.data() + 3 * k;
        const Vec3<Real> arm = to_space<Real>(r, Vec3<Real>(Real(place[0]), Real(place[1]), Real(place[2])));
        arms_.set(first(i) + k, arm);
        to.set(first(i) + k, x[i] + arm);
      }
    }
  }
}

template <class Real>
void Sites<Real>::gather(const VectorColumn<Real>& a, const Mat3<Real>& virial, ForceSink<Real>& out,
                         const ParticleSystem<Real>& s) const {
  const auto& masses = particles_.masses();
  VectorColumn<Real>& to = out.accelerations();
  for_blocks(s.size(), [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      if (s.bodies()->kind(i) == nullptr) {
        to.add(i, a[first(i)]);
        continue;
      }
      Vec3<Real> force = Vec3<Real>::Zero(), torque = force;
      for (Index at = first(i); at < first(i + 1); ++at) {
        const Vec3<Real> one = masses[at] * a[at];
        force += one;
        torque += cross<Real>(arms_[at], one);
      }
      to.add(i, force / s.masses()[i]);
      out.torque(i, torque);
    }
  });
  if (!out.wants_virial()) return;
  WideTensor<Real> of_arms;
  for (Index at = 0; at < particles_.size(); ++at) of_arms.add_outer(arms_[at], masses[at] * a[at]);
  out.virial(virial - of_arms.value());
}

template class Sites<double>;
template class Sites<Quad>;
template class Sites<Pack>;
template class Sites<Dual<double, 1>>;
template class Sites<Dual<Quad, 1>>;

}  // namespace noether
