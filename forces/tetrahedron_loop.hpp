#pragma once
/// The loop over tetrahedra: what each does to its corners.

#include "engine/force_sink.hpp"
#include "forces/materials.hpp"
#include "forces/mesh_elements.hpp"
#include "forces/secant.hpp"
#include "forces/secant_stress.hpp"
#include "forces/tetrahedron_row.hpp"
#include "numbers/parallel.hpp"
#include "numbers/select.hpp"
#include "numbers/wide_sum.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

namespace noether::detail {

/// Why a run cannot go on with an element. @param part  of its volume at rest
Failure inverted_element(Index element, const std::array<Index, 4>& particles, double part,
                         const std::vector<std::string>& names);

/// Writes the forces of the groups [from, to) into their slots, with the bits that elements have one by one.
/// @return  whether det F > 0 in all of them; the forces mean something only then
bool tetrahedra_in_lanes(const TetrahedronGroups& groups, Index from, Index to);

/// What one evaluation sums beside the forces.
template <class Real> struct MeshTotals {
  WideSum<Real> energy;
  WideTensor<Real> virial;

  MeshTotals& operator+=(const MeshTotals& other) {
    energy += other.energy;
    virial += other.virial;
    return *this;
  }
};

/// Evaluates the tetrahedra of particles, or their secants from another state, and adds up what each particle feels.
template <class Real, class M> class TetrahedronLoop {
 public:
  using Number = typename AtRest<Real>::type;

  TetrahedronLoop(const M& material, const MeshElements<Number>& elements, const ParticleSystem<Real>& s,
                  const ParticleSystem<Real>* from = nullptr)
      : material_(material), elements_(elements), s_(s), from_(from) {}

  void add_to(ForceSink<Real>& out) {
    thread_local AlignedVector<Real> memory;
    const auto wanted = static_cast<std::size_t>(elements_.padded() * MeshElements<Number>::slot_width);
    if (memory.size() < wanted) memory.resize(wanted);
    slots_ = memory.data();  // this thread's, written by all
    if (out.wants_energy() || out.wants_virial()) {
      with_virial_ = out.wants_virial();
      const auto totals = reduce(elements_.size(), MeshTotals<Real>{},
                                 [&](Index begin, Index end) { return evaluate<true>(begin, end); });
      out.energy(totals.energy);
      out.virial(totals.virial);
    } else {
      for_blocks(elements_.size(), [&](Index begin, Index end) { evaluate<false>(begin, end); });
    }
    for_blocks(s_.size(), [&](Index begin, Index end) { gather(out, begin, end); });
    if constexpr (with_secants) {
      for (Index k = 0; k < elements_.size() && out.tangent() != nullptr; ++k) add_tangent(k, *out.tangent());
    }
    if (const Index k = inverted_.load(); k != none) tell(out, k);
  }

 private:
  static constexpr std::uint32_t places_ahead = 96;                   ///< those of some four particles
  static constexpr bool with_secants = std::is_same_v<Real, Number>;  ///< doubles and Quad
  static constexpr Index none = std::numeric_limits<Index>::max();

  template <bool with_totals> MeshTotals<Real> evaluate(Index begin, Index end) {
    MeshTotals<Real> totals;
    if constexpr (!with_totals && std::is_same_v<Real, double> && requires { material_.law(); }) {
      if (from_ == nullptr && forces_in_lanes(begin, end)) return totals;
    }
    if constexpr (with_secants) {
      for (Index k = begin; k < end && from_ != nullptr; ++k) add_secant(k);
      if (from_ != nullptr) return totals;
    }
    for (Index k = begin; k < end; ++k) add_element<with_totals>(k, totals);
    return totals;
  }

  /// Elements of a block eight at a time. @return whether no element is inverted; else they are to be evaluated singly
  bool forces_in_lanes(Index begin, Index end) const {
    constexpr Index group = MeshElements<Number>::group;
    static_assert(block_size % group == 0);
    const IsotropicLaw law = material_.law();
    const auto& x = s_.positions();
    const TetrahedronGroups groups = {elements_.corners(),
                                      elements_.shapes(),
                                      {x.component(0), x.component(1), x.component(2)},
                                      slots_,
                                      law.lambda / 2,
                                      law.mu,
                                      law.kind == ElasticLaw::neo_hookean};
    return tetrahedra_in_lanes(groups, begin / group, (end + group - 1) / group);
  }

  /// The edges from the first corner of element k.
  static std::array<Vec3<Real>, 3> edges(const MeshElements<Number>& elements, Index k, const auto& place) {
    const Vec3<Real> x = place(elements.particle(k, 0));
    return {Vec3<Real>(place(elements.particle(k, 1)) - x), Vec3<Real>(place(elements.particle(k, 2)) - x),
            Vec3<Real>(place(elements.particle(k, 3)) - x)};
  }
  Deformation<Real> deformation(Index k, const std::array<Vec3<Real>, 3>& edge) const {
    Deformation<Real> f;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = static_cast<Index>(i);
      for (Index j = 0; j < 3; ++j) {
        f.row[i][j] = edge[0][at] * Real(elements_.shape(k, j)) + edge[1][at] * Real(elements_.shape(k, 3 + j)) +
                      edge[2][at] * Real(elements_.shape(k, 6 + j));
      }
    }
    return f;
  }

  template <bool with_totals> void add_element(Index k, MeshTotals<Real>& totals) {
    const auto edge = edges(elements_, k, [&](Index i) { return Vec3<Real>(s_.positions()[i]); });
    const Deformation<Real> f = deformation(k, edge);
    const Symmetric<Real> c = f.square();
    // The force of an element inside out is a number all the same: iterations may pass there on their way.
    if (any(f.determinant() <= Real(0))) note(k);
    const Real volume(elements_.shape(k, 9));
    const std::array<Vec3<Real>, 3> force = put(k, f.times(stress_of<Real>(material_, c)), volume);
    if constexpr (with_totals) {
      totals.energy += volume * material_.energy(c);
      for (std::size_t a = 0; a < 3 && with_virial_; ++a) totals.virial.add_outer(edge[a], force[a]);
    }
  }

  DeformationStep<Real> step_of(Index k) const {
    const Real half(0.5);
    const auto edge = edges(elements_, k, [&](Index i) { return Vec3<Real>(from_->positions()[i]); });
    const auto way = edges(elements_, k, [&](Index i) { return way_of(*from_, s_, i); });
    std::array<Vec3<Real>, 3> middle, last;
    for (std::size_t a = 0; a < 3; ++a) {
      middle[a] = edge[a] + half * way[a];
      last[a] = edge[a] + way[a];
    }
    DeformationStep<Real> step{deformation(k, edge), deformation(k, middle), deformation(k, last), {}, {}, {}};
    step.before = step.first.square();
    step.after = step.last.square();
    step.change = change_of_square(step.middle, deformation(k, way));
    return step;
  }
  void add_secant(Index k) {
    const DeformationStep<Real> step = step_of(k);
    if (step.first.determinant() <= Real(0) || step.last.determinant() <= Real(0)) note(k);
    const Symmetric<Real> stress = secant_stress<Real>(material_, step.before, step.after, step.change);
    put(k, step.middle.times(stress), Real(elements_.shape(k, 9)));
  }
  /// How the forces on the corners change with the places of all four, which do nothing where they move together.
  void add_tangent(Index k, SecantTangent<Real>& tangent) const {
    std::array<Vec3<Real>, 4> gradient;
    gradient[0] = Vec3<Real>::Zero();
    for (std::size_t a = 1; a < 4; ++a) {
      for (Index j = 0; j < 3; ++j) gradient[a][j] = elements_.shape(k, 3 * static_cast<Index>(a) - 3 + j);
      gradient[0] -= gradient[a];
    }
    const Real volume(elements_.shape(k, 9));
    const auto slopes = secant_slopes(material_, step_of(k));
    for (std::size_t b = 0; b < 4; ++b) {
      const auto pull = slopes_along(slopes, Vec3<Real>(-volume * gradient[b]));
      for (std::size_t a = 0; a < 4; ++a) {
        tangent.force(elements_.particle(k, static_cast<Index>(a)), elements_.particle(k, static_cast<Index>(b)),
                      Mat3<Real>(gradient[a][0] * pull[0] + gradient[a][1] * pull[1] + gradient[a][2] * pull[2]));
      }
    }
  }

  /// Writes the forces on the corners of element k of a first Piola-Kirchhoff stress into its slots.
  /// @return those on corners 1, 2, 3
  std::array<Vec3<Real>, 3> put(Index k, const Deformation<Real>& stress, const Real& volume) {
    std::array<Vec3<Real>, 3> force;
    Real* const slot = slots_ + MeshElements<Number>::at(k, 0, MeshElements<Number>::slot_width);
    const Index stride = MeshElements<Number>::group;
    for (Index i = 0; i < 3; ++i) {
      const Vec3<Real>& p = stress.row[static_cast<std::size_t>(i)];
      for (Index a = 0; a < 3; ++a) {
        const Real pull = p[0] * Real(elements_.shape(k, 3 * a)) + p[1] * Real(elements_.shape(k, 3 * a + 1)) +
                          p[2] * Real(elements_.shape(k, 3 * a + 2));
        force[static_cast<std::size_t>(a)][i] = -(volume * pull);
      }
      const Real others = (force[0][i] + force[1][i]) + force[2][i];
      for (Index a = 0; a < 3; ++a) slot[(3 * a + i) * stride] = force[static_cast<std::size_t>(a)][i];
      slot[(9 + i) * stride] = -others;
    }
    return force;
  }

  void gather(ForceSink<Real>& out, Index begin, Index end) const {
    const std::uint32_t *const first = elements_.first(), *const places = elements_.places();
    const Index stride = MeshElements<Number>::group;
    const std::uint32_t last = first[elements_.particles()] - 1;
    for (Index i = begin; i < end; ++i) {
      if (first[i] == first[i + 1]) continue;
      Vec3<Real> sum = Vec3<Real>::Zero();
      for (std::uint32_t p = first[i]; p < first[i + 1]; ++p) {
        const Real* const at = slots_ + places[p];
        // Slots are written in the order of elements and read in that of particles: nothing foresees where.
        const Real* const later = slots_ + places[std::min(p + places_ahead, last)];
        for (int c = 0; c < 3; ++c) __builtin_prefetch(later + c * stride);
        for (int c = 0; c < 3; ++c) sum[c] += at[c * stride];
      }
      const Real m = s_.masses()[i];
      if (m != Real(0)) out.accelerations().add(i, Vec3<Real>(sum / m));
    }
  }

  void note(Index k) {
    Index known = inverted_.load();
    while (k < known && !inverted_.compare_exchange_weak(known, k)) {
    }
  }
  void tell(ForceSink<Real>& out, Index k) const {
    const auto part_in = [&](const ParticleSystem<Real>& s) {
      const auto edge = edges(elements_, k, [&](Index i) { return Vec3<Real>(s.positions()[i]); });
      return least(deformation(k, edge).determinant());
    };
    std::array<Index, 4> particles;
    for (std::size_t c = 0; c < 4; ++c) particles[c] = elements_.particle(k, static_cast<Index>(c));
    const double part = from_ != nullptr ? std::min(part_in(*from_), part_in(s_)) : part_in(s_);
    out.fail(inverted_element(elements_.number(k), particles, part, s_.names()));
  }
  /// The smallest of the doubles that a number holds.
  template <class Any> static double least(const Any& x) {
    if constexpr (requires { x.lane; }) {
      double smallest = x.lane[0];
      for (const double one : x.lane) smallest = one < smallest ? one : smallest;
      return smallest;
    } else if constexpr (requires { x.slope; }) {
      return least(x.value);
    } else {
      return static_cast<double>(x);
    }
  }

  const M& material_;
  const MeshElements<Number>& elements_;
  const ParticleSystem<Real>&s_, *from_;
  Real* slots_ = nullptr;
  bool with_virial_ = false;
  std::atomic<Index> inverted_ = none;
};

}  // namespace noether::detail
