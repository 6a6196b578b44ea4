/// What forces keep between evaluations: lent by the sink, one for each force, never state.

#include "engine/workspace.hpp"
#include "engine/any_force.hpp"
#include "forces/sum.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/tops.hpp"

#include <memory>

namespace noether {
namespace {

/// How often a force found its cache as it had left it.
struct Count {
  int found = 0;
};

/// Counts its evaluations in its workspace, and gives the count as energy.
struct Counting {
  double weight = 1;
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& /*s*/) const {
    Workspace& own = out.workspace();
    out.energy(Real(weight * ++own.get<Count>().found));
  }
};

/// Pushes and turns each particle.
struct Turning {
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& s) const {
    for (Index i = 0; i < s.size(); ++i) out.torque(i, Vec3<Real>(Real(0), Real(0), Real(double(i + 1))));
  }
};

/// Known in doubles only, with a reference for truth.
struct Rough {
  void add_to(ForceSink<double>& out, const ParticleSystem<double>& /*s*/) const { out.energy(1.0 / 3); }
  struct Exact {
    template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& /*s*/) const {
      out.energy(Real(1) / Real(3));
    }
  };
  static Exact reference() { return {}; }
};

/// Takes where a particle stands from its id, when it is bound.
struct Pulling {
  std::int64_t id = 0;
  Index at = -1;
  template <class Real> void bind(const ParticleSystem<Real>& s) {
    at = -1;
    for (Index i = 0; i < s.size(); ++i) {
      if (s.ids()[static_cast<std::size_t>(i)] == id) at = i;
    }
  }
  template <class Real> void add_to(ForceSink<Real>& out, const ParticleSystem<Real>& /*s*/) const {
    if (at >= 0) out.acceleration(at, Vec3<Real>(Real(1), Real(0), Real(0)));
  }
};

ParticleSystem<double> two() {
  ParticleSystem<double> s(unit_system("reduced"));
  s.add("a", 1, Vec3<double>::Zero(), Vec3<double>::Zero());
  s.add("b", 1, Vec3<double>(1, 0, 0), Vec3<double>::Zero());
  return s;
}

template <class F> double energy_of(const F& force, const ParticleSystem<double>& s, Workspace* lent) {
  VectorColumn<double> a(s.size());
  ForceSink<double> sink(a, s, {.energy = true}, lent);
  force.add_to(sink, s);
  return sink.potential();
}

}  // namespace

TEST_CASE("a workspace keeps one value of each type, and a copy of it holds copies", "[engine][workspace]") {
  Workspace one;
  CHECK(one.find<Count>() == nullptr);
  one.get<Count>().found = 3;
  one.put(std::make_unique<int>(7));  // cannot be copied: the copy begins with nothing
  one.room(1).get<Count>().found = 4;
  Workspace other = one;
  other.get<Count>().found = 5;
  CHECK(one.get<Count>().found == 3);
  CHECK(other.room(1).get<Count>().found == 4);
  CHECK(*one.get<std::unique_ptr<int>>() == 7);
  CHECK(other.get<std::unique_ptr<int>>() == nullptr);
}

TEST_CASE("each term of a sum finds its own cache again, and none where nobody lends one", "[engine][workspace]") {
  const ParticleSystem<double> s = two();
  const Sum both{Counting{1}, Sum{Counting{100}, Counting{10'000}}};
  ForceField<double> field;
  field.add(Counting{1}).add(Sum{Counting{100}, Counting{10'000}});
  Workspace of_sum, of_field;
  for (const double times : {1, 2, 3}) {
    CHECK(energy_of(both, s, &of_sum) == 10101 * times);
    CHECK(energy_of(field, s, &of_field) == 10101 * times);
    CHECK(energy_of(both, s, nullptr) == 10101);
  }
}

TEST_CASE("a Hamiltonian begins with an empty workspace when it is bound", "[engine][workspace]") {
  ParticleSystem<double> s = two();
  KineticPotential hamiltonian(Counting{1});
  hamiltonian.bind(s);
  CHECK(hamiltonian.energy(s).potential == 1);
  s.moved();
  CHECK(hamiltonian.energy(s).potential == 2);
  hamiltonian.bind(s);
  CHECK(hamiltonian.energy(s).potential == 1);
}

TEST_CASE("torques are written where somebody asks for them", "[engine][workspace]") {
  const ParticleSystem<double> s = two();
  VectorColumn<double> a(2), torques(2);
  torques.set(0, {9, 9, 9});
  ForceSink<double> sink(a, s, {});
  CHECK_FALSE(sink.wants_torques());
  Turning{}.add_to(sink, s);
  sink.set_torques(torques);
  CHECK(sink.wants_torques());
  Turning{}.add_to(sink, s);
  CHECK(std::as_const(torques)[0] == Vec3<double>(0, 0, 1));
  CHECK(std::as_const(torques)[1] == Vec3<double>(0, 0, 2));
}

TEST_CASE("a force for doubles may name another one for truth", "[engine][workspace]") {
  const std::optional<AnyForce<Quad>> wide = AnyForce<double>(Rough{}).in_quad();
  REQUIRE(wide);
  const ParticleSystem<Quad> s = two().as<Quad>();
  VectorColumn<Quad> a(2);
  ForceSink<Quad> sink(a, s, {.energy = true});
  wide->add_to(sink, s);
  CHECK((sink.potential() == Quad(1) / Quad(3)));
}

TEST_CASE("a force that is bound finds its particles by id, erased and in sums", "[engine][workspace]") {
  ParticleSystem<double> s = two();
  s.remove(0);
  const auto pulled = [&](auto force) {
    bind_force(force, s);
    VectorColumn<double> a(1);
    ForceSink<double> sink(a, s, {});
    force.add_to(sink, s);
    return std::as_const(a)[0][0];
  };
  CHECK(pulled(Pulling{1}) == 1);
  CHECK(pulled(Sum{Pulling{1}, Pulling{0}}) == 1);
  CHECK(pulled(AnyForce<double>(Pulling{1})) == 1);
  CHECK(pulled(ForceField<double>().add(Pulling{1}).add(Pulling{1})) == 2);
}

}  // namespace noether
