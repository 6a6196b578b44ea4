#include "forces/gravity.hpp"

#include "forces/gravity_simd.hpp"
#include "forces/gravity_stages_simd.hpp"

#include <algorithm>

namespace noether {

namespace {

/// The massive bodies among the particles, side by side; a thread keeps the memory for its next evaluation.
class Gathered {
 public:
  void assign(const ParticleSystem<double>& s) {
    for (auto* column : {&x_, &y_, &z_, &m_, &row_}) column->clear();
    const double *x = s.positions().component(0), *y = s.positions().component(1), *z = s.positions().component(2);
    for (Index i = 0; i < s.size(); ++i) {
      if (s.masses()[i] == 0) continue;
      x_.push_back(x[i]);
      y_.push_back(y[i]);
      z_.push_back(z[i]);
      m_.push_back(s.masses()[i]);
      row_.push_back(static_cast<double>(i));
    }
  }
  AttractingBodies bodies() const {
    return {x_.data(), y_.data(), z_.data(), m_.data(), row_.data(), static_cast<Index>(m_.size())};
  }
  /// The first body of this row or a later one.
  Index from_row(Index row) const {
    return std::lower_bound(row_.begin(), row_.end(), static_cast<double>(row)) - row_.begin();
  }

 private:
  AlignedVector<double> x_, y_, z_, m_, row_;
};

/// What one block of rows feels, for G = 1.
struct Felt {
  alignas(64) double ax[block_size] = {}, ay[block_size] = {}, az[block_size] = {}, phi[block_size] = {};
};

/// Sums over tiles of bodies that stay in the innermost cache; the partial sums also keep rounding small.
void attract(const ParticleSystem<double>& s, const Gathered& gathered, Index begin, Index end, double softening,
             bool with_phi, Felt& felt) {
  constexpr Index tile = 512;
  const GravityKernels& kernels = gravity_kernels();
  const AttractRows others = with_phi ? kernels.others_with_phi : kernels.others;
  const AttractRows among = with_phi ? kernels.among_with_phi : kernels.among;
  const VectorColumn<double>& x = s.positions();
  const AttractedRows rows{x.component(0) + begin,
                           x.component(1) + begin,
                           x.component(2) + begin,
                           felt.ax,
                           felt.ay,
                           felt.az,
                           felt.phi,
                           begin,
                           end - begin};
  const AttractingBodies bodies = gathered.bodies();
  const Index own = gathered.from_row(begin), own_end = gathered.from_row(end);
  const double softening2 = softening * softening;
  for (Index from = 0; from < bodies.count; from += tile) {
    const Index to = std::min(bodies.count, from + tile);
    const Index own_from = std::clamp(own, from, to), own_to = std::clamp(own_end, from, to);
    others(rows, bodies, from, own_from, softening2);
    among(rows, bodies, own_from, own_to, softening2);
    others(rows, bodies, own_to, to, softening2);
  }
}

/// sum over pairs of - G m_i m_j d (x) d / (d^2 + softening^2)^(3/2), in plain loops: it is asked for once in a while.
WideTensor<double> virial_of(const Gathered& gathered, double g, double softening) {
  const AttractingBodies b = gathered.bodies();
  return reduce(b.count, WideTensor<double>{}, [&](Index begin, Index end) {
    WideTensor<double> total;
    for (Index i = begin; i < end; ++i) {
      for (Index j = 0; j < b.count; ++j) {
        if (j == i) continue;
        const Vec3<double> d(b.x[i] - b.x[j], b.y[i] - b.y[j], b.z[i] - b.z[j]);
        const double r2 = norm2(d) + softening * softening;
        total.add_outer(d, -g * b.m[i] * b.m[j] / (r2 * std::sqrt(r2)) / 2 * d);
      }
    }
    return total;
  });
}

}  // namespace

void Gravity::add_stages(ForceSink<Pack>& out, const ParticleSystem<Pack>& s) const {
  const auto numbers = [](auto* packs) { return packs->lane.data(); };
  const VectorColumn<Pack>& x = s.positions();
  VectorColumn<Pack>& a = out.accelerations();
  attract_in_stages()(
      {numbers(x.component(0)), numbers(x.component(1)), numbers(x.component(2)), numbers(s.masses().data()),
       numbers(a.component(0)), numbers(a.component(1)), numbers(a.component(2)), s.size(), out.has_sums()},
      constant(s).lane[0], softening * softening);
}

void Gravity::add_lanes(ForceSink<double>& out, const ParticleSystem<double>& s) const {
  thread_local Gathered gathered;
  gathered.assign(s);
  const Gathered& massive = gathered;  // this thread's, read by all
  const double g = constant(s);
  VectorColumn<double>& a = out.accelerations();
  const auto block = [&](Index begin, Index end) {
    Felt felt;
    attract(s, massive, begin, end, softening, out.wants_energy(), felt);
    WideSum<double> energy;
    for (Index i = begin; i < end; ++i) {
      const Index k = i - begin;
      a.add(i, g * Vec3<double>(felt.ax[k], felt.ay[k], felt.az[k]));
      energy -= g / 2 * s.masses()[i] * felt.phi[k];
    }
    return energy;
  };
  if (out.wants_energy()) {
    out.energy(reduce(s.size(), WideSum<double>{}, block));
  } else {
    for_blocks(s.size(), block);
  }
  if (out.wants_virial()) out.virial(virial_of(massive, g, softening));
}

template void Gravity::add_pairs(ForceSink<double>&, const ParticleSystem<double>&) const;
template struct detail::ForceModel<Gravity, double>;
template struct detail::ForceModel<Gravity, Quad>;

}  // namespace noether
