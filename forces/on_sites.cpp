#include "forces/on_sites.hpp"

#include "forces/primary.hpp"
#include "neighbors/neighbor_list.hpp"
#include "numbers/cost_book.hpp"

#include <algorithm>

namespace noether {

namespace {

/// What the force keeps from one evaluation to the next.
template <class Real> struct Expanded {
  KeptSites<Real> sites;
  VectorColumn<Real> a;
  Workspace workspace;
};

}  // namespace

template <class Real> void OnSites<Real>::check_pairs(const ParticleSystem<Real>& s) const {
  for (const AnyForce<Real>& force : forces_.terms()) {
    if (force.claims().fixed_figure && s.bodies()->kind(0) != nullptr)
      detail::refuse_fixed_axis(force.name(), s.name(0));
  }
  const auto& kinds = s.bodies()->kinds;
  if (std::none_of(kinds.begin(), kinds.end(), [](const BodyKind& kind) { return kind.sites.size() > 1; })) return;
  for (const AnyForce<Real>& force : forces_.terms()) {
    const ForceClaims claims = force.claims();
    const bool of_pairs = claims.keeps_momentum && !claims.bonded;  // a field acts on each site alone
    if (!of_pairs || claims.exclusions.value_or(true)) continue;
    throw Error("'" + force.name() + "' would act between the sites of a rigid body too" +
                (claims.kepler ? "; use gravity_of_bodies" : "; take it out"));
  }
}

template <class Real>
template <class Number>
void OnSites<Real>::add(ForceSink<Number>& out, const ParticleSystem<Number>& s) const {
  auto& here = out.workspace().template get<Expanded<Number>>();
  bool are_new = false;
  {
    const Spent spent("sites");
    are_new = here.sites.follow(s);
  }
  if (are_new) {
    here.a = VectorColumn<Number>(here.sites->particles().size());
    here.workspace = Workspace();
    here.workspace.put(NeighborList(forces_.claims().range));
  }
  const ParticleSystem<Number>& sites = here.sites->particles();
  const Request wanted{.energy = out.wants_energy(), .virial = out.wants_virial()};
  // Without the length of kicks: a site moves with its body, whatever its own mass.
  ForceSink<Number> sink(here.a, sites, wanted, &here.workspace);
  if (!out.takes_all()) sink.set_kick_letter(out.kick_letter());
  forces_.add_to(sink, sites);
  if (wanted.energy) out.energy(sink.potential());
  if (sink.failure()) out.fail(*sink.failure());
  const Spent spent("sites");
  here.sites->gather(here.a, sink.virial(), out, s);
}

template <class Real> void OnSites<Real>::add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
  add(out, s);
}
template <class Real> void OnSites<Real>::add_to(ForceSink<Pack>& out, const ParticleSystem<Pack>& s) const {
  add(out, s);
}
template <class Real>
void OnSites<Real>::add_to(ForceSink<Dual<Real, 1>>& out, const ParticleSystem<Dual<Real, 1>>& s) const {
  add(out, s);
}

template class OnSites<double>;
template class OnSites<Quad>;
template struct detail::ForceModel<OnSites<double>, double>;
template struct detail::ForceModel<OnSites<Quad>, Quad>;

}  // namespace noether
