#include "integrators/manifold.hpp"

#include "engine/bodies.hpp"
#include "engine/moments.hpp"
#include "engine/sums.hpp"
#include "integrators/particle_vector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace noether {

template <class Real> void PivotedSolver<Real>::factorize(Matrix<Real> A) {
  using std::abs;
  const Index n = A.rows();
  const Real least = Real(4096) * std::numeric_limits<Real>::epsilon();
  lu_ = std::move(A);
  rows_.resize(static_cast<std::size_t>(n));
  columns_.resize(static_cast<std::size_t>(n));
  for (rank_ = 0; rank_ < n; ++rank_) {
    Index row = rank_, column = rank_;
    for (Index i = rank_; i < n; ++i) {
      for (Index j = rank_; j < n; ++j) {
        if (abs(lu_(i, j)) > abs(lu_(row, column))) row = i, column = j;
      }
    }
    if (!(abs(lu_(row, column)) > least)) return;
    rows_[static_cast<std::size_t>(rank_)] = row;
    columns_[static_cast<std::size_t>(rank_)] = column;
    for (Index j = 0; j < n; ++j) std::swap(lu_(rank_, j), lu_(row, j));
    for (Index i = 0; i < n; ++i) std::swap(lu_(i, rank_), lu_(i, column));
    for (Index i = rank_ + 1; i < n; ++i) {
      lu_(i, rank_) /= lu_(rank_, rank_);
      for (Index j = rank_ + 1; j < n; ++j) lu_(i, j) -= lu_(i, rank_) * lu_(rank_, j);
    }
  }
}

template <class Real> void PivotedSolver<Real>::solve(Vector<Real>& b) const {
  for (Index k = 0; k < rank_; ++k) std::swap(b[k], b[rows_[static_cast<std::size_t>(k)]]);
  for (Index k = 0; k < rank_; ++k) {
    for (Index i = k + 1; i < b.size(); ++i) b[i] -= lu_(i, k) * b[k];
  }
  for (Index k = b.size(); k-- > 0;) {
    if (k >= rank_) {
      b[k] = Real(0);
      continue;
    }
    for (Index j = k + 1; j < rank_; ++j) b[k] -= lu_(k, j) * b[j];
    b[k] /= lu_(k, k);
  }
  for (Index k = rank_; k-- > 0;) std::swap(b[k], b[columns_[static_cast<std::size_t>(k)]]);
}

template <class Real>
Manifold<Real>::Manifold(ProjectionOptions options, std::vector<std::unique_ptr<Equations<Real>>> own)
    : options_(std::move(options)), own_(std::move(own)) {}

template <class Real>
Manifold<Real>::Manifold(const Manifold& other)
    : options_(other.options_),
      size_(other.size_),
      particles_(other.particles_),
      variables_(other.variables_),
      masses_(other.masses_),
      a_(other.a_) {
  for (const auto& one : other.own_) own_.push_back(one->clone());
}

template <class Real> void Manifold<Real>::bind(const ParticleSystem<Real>& s, const IntegratorClaims& claims) {
  check(s, claims);
  particles_ = s.size();
  variables_ = static_cast<Index>(s.variables().size());
  masses_.clear();
  for (Index i = 0; i < particles_; ++i) masses_.push_back(s.masses()[i]);
  a_ = VectorColumn<Real>(particles_);
  size_ = 0;
  for (const Invariant one : options_.onto) {
    if (one != Invariant::constraints) size_ += one == Invariant::energy ? 1 : 3;
  }
  for (const auto& one : own_) {
    one->bind(s);
    if (s.box().is_periodic()) check_wraps(s, *one);
    size_ += one->size();
  }
  if (options_.how == Projection::hamiltonian && size_ == 1) {
    throw SchemeMismatch(
        "how = hamiltonian is for pairs with {g, h} other than 0, but {g, g} = 0: moving along the "
        "flow of " +
            name(0) + " does not change it; use how = \"orthogonal\"",
        {.key = "how"});
  }
  if (options_.direction.empty()) return;
  const Index numbers = particles_ > 0 ? 6 * particles_ : variables_;
  if (static_cast<Index>(options_.direction.size()) == numbers && size_ == 1) return;
  throw SchemeMismatch(fmt::format("a direction of {} numbers for {} {} does not fit; one for {} numbers of the state "
                                   "and one equation is expected",
                                   options_.direction.size(), size_, size_ == 1 ? "equation" : "equations", numbers),
                       {.key = "direction"});
}

template <class Real> void Manifold<Real>::check(const ParticleSystem<Real>& s, const IntegratorClaims& claims) const {
  if (claims.memory == Memory::immovable) {
    throw SchemeMismatch(
        fmt::format("method '{}' remembers a state that a projection moves, and does not say how; use "
                    "another method, such as 'rk4' or 'dop853'",
                    claims.method));
  }
  if (options_.how == Projection::symmetric && claims.clock == ClockMode::free) {
    throw SchemeMismatch(fmt::format("method '{}' chooses its steps, which a run back would choose otherwise, so that "
                                     "no projection of it is symmetric; use fixed steps, or how = \"orthogonal\"",
                                     claims.method),
                         {.key = "how"});
  }
  if (options_.how == Projection::symmetric && claims.memory != Memory::none) {
    throw SchemeMismatch(fmt::format("method '{}' goes on from earlier states, and a symmetric projection makes its "
                                     "steps again from moved ones; use a one-step method, or how = \"orthogonal\"",
                                     claims.method),
                         {.key = "how"});
  }
  if (!claims.variables) return check_particles(s, claims);
  if (!options_.onto.empty()) {
    throw SchemeMismatch(
        fmt::format("'{}' is a system of variables, whose {} is not projected onto; a program can project it "
                    "onto an invariant of its own",
                    claims.hamiltonian, choice_name(options_.onto.front())),
        {.key = "onto"});
  }
  if (options_.how == Projection::hamiltonian || options_.moves) {
    throw SchemeMismatch(fmt::format("'{}' is a system of variables without positions and velocities; use how = "
                                     "\"orthogonal\"",
                                     claims.hamiltonian),
                         {.key = "how"});
  }
}

template <class Real>
void Manifold<Real>::check_particles(const ParticleSystem<Real>& s, const IntegratorClaims& claims) const {
  const auto refuse = [](const std::string& why) { throw SchemeMismatch(why, {.key = "onto"}); };
  if (has_bodies(s)) refuse("rigid bodies turn, and a projection moves points only; take it out");
  const bool moves_positions =
      options_.moves != Moves::velocities && !(own_.empty() && options_.onto == std::vector{Invariant::momentum});
  if (options_.has(Invariant::angular_momentum) && s.box().is_periodic()) {
    refuse("no angular momentum is conserved in a periodic box; project onto energy or momentum");
  }
  if (s.box().is_periodic() && moves_positions) {
    refuse(
        "positions in a periodic box stand on a grid, which a projection does not keep; use how = \"oblique\" with "
        "moves = \"velocities\"");
  }
  if (options_.has(Invariant::energy)) {
    if (!claims.energy) refuse("a force of '" + claims.hamiltonian + "' has no energy, so none can be projected onto");
    if (claims.dissipative || claims.time_dependent) {
      refuse(
          fmt::format("the energy is not conserved here, because a force {}; project onto what is, or take the "
                      "projection out",
                      claims.dissipative ? "dissipates it" : "depends on time"));
    }
  }
  if (options_.has(Invariant::momentum) && !claims.momentum) {
    refuse("the momentum is not conserved here: a force acts from outside; take it out of onto");
  }
  if (options_.has(Invariant::angular_momentum) && !claims.angular_momentum) {
    refuse("the angular momentum is not conserved here: a force has a torque about the origin; take it out of onto");
  }
  if (options_.has(Invariant::constraints) && claims.constraints == 0) {
    refuse("there are no constraints to project onto; take them out of onto");
  }
  if (!options_.has(Invariant::constraints) && claims.constraints > 0) {
    refuse("a projection would move particles off their constraints; put \"constraints\" into onto");
  }
  if (options_.how == Projection::symmetric && claims.constraints > 0) {
    throw SchemeMismatch(
        "a symmetric projection moves particles off their constraints before each step, which has to "
        "begin on them; use how = \"orthogonal\"",
        {.key = "how"});
  }
  check_hamiltonian();
}

/// What depends on where particles are jumps where they cross a periodic box.
template <class Real> void Manifold<Real>::check_wraps(const ParticleSystem<Real>& s, Equations<Real>& own) const {
  Matrix<Real> G = Matrix<Real>::Zero(6 * s.size(), own.size());
  own.gradients(s, G, 0);
  if ((G.topRows(3 * s.size()).array() == Real(0)).all()) return;
  throw SchemeMismatch(own.name() +
                           " depends on positions, which jump where particles cross the periodic box; project "
                           "onto what depends on velocities alone, or take the box out",
                       {.key = "onto"});
}

/// Moving along the flow of H, P or L does not change them all: {H, H} = {P, P} = 0, and {L_x, L_y} = L_z.
template <class Real> void Manifold<Real>::check_hamiltonian() const {
  if (options_.how != Projection::hamiltonian) return;
  for (const Invariant one : options_.onto) {
    if (one == Invariant::constraints) continue;
    const std::string symbol = one == Invariant::energy ? "H" : one == Invariant::momentum ? "P_z" : "J_z";
    throw SchemeMismatch(fmt::format("how = hamiltonian is for pairs with {{g, h}} other than 0, but {{{}, {}}} = 0: "
                                     "moving along the flow of {} does not change it; use how = \"orthogonal\"",
                                     symbol, symbol, choice_name(one)),
                         {.key = "how"});
  }
}

template <class Real> std::string Manifold<Real>::name(Index equation) const {
  for (const Invariant one : options_.onto) {
    if (one == Invariant::constraints) continue;
    const Index count = one == Invariant::energy ? 1 : 3;
    if (equation < count) return choice_name(one);
    equation -= count;
  }
  for (const auto& one : own_) {
    if (equation < one->size()) return one->name();
    equation -= one->size();
  }
  return "";
}

template <class Real> std::string Manifold<Real>::signature() const {
  std::string text = options_.signature();
  for (const auto& one : own_) text += " and " + one->signature();
  return text;
}

template <class Real> void Manifold<Real>::gather(const ParticleSystem<Real>& s, Vector<Real>& y) const {
  if (variables_ == 0) return detail::gather_particles(s, y);
  y.resize(variables_);
  std::copy(s.variables().begin(), s.variables().end(), y.data());
}

template <class Real> void Manifold<Real>::scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const {
  if (variables_ > 0) {
    std::copy(y.data(), y.data() + variables_, s.variables().begin());
    return;
  }
  detail::scatter_particles(y, s);
  if (s.low_words() == nullptr) return;
  s.keep_low_words(false);
  s.keep_low_words(true);
}

template <class Real>
void Manifold<Real>::values(AnyIntegrator<Real>& of, const ParticleSystem<Real>& s, Vector<Real>& g,
                            Vector<Real>& scale) {
  using std::abs, std::sqrt;
  g.resize(size_);
  scale.resize(size_);
  Index at = 0;
  const auto put = [&](const Vec3<Real>& sums, const Real& size) {
    for (Index k = 0; k < 3; ++k, ++at) g[at] = sums[k], scale[at] = size;
  };
  for (const Invariant one : options_.onto) {
    if (one == Invariant::energy) {
      const EnergyTerms<Real> energy = of.energy(s);
      g[at] = energy.total();
      scale[at++] = Real(abs(energy.kinetic)) + Real(abs(energy.potential));
    } else if (one == Invariant::momentum) {
      put(rounded(weighted_sum(s, s.velocities())), sum_over<Real>(s.size(), [&](Index i) {
            return s.masses()[i] * Real(sqrt(norm2(Vec3<Real>(s.velocities()[i]))));
          }));
    } else if (one == Invariant::angular_momentum) {
      put(rounded(angular_momentum(s)), sum_over<Real>(s.size(), [&](Index i) {
            const Vec3<Real> x = s.positions()[i], v = s.velocities()[i];
            return s.masses()[i] * Real(sqrt(norm2(x) * norm2(v)));
          }));
    }
  }
  for (const auto& one : own_) {
    one->values(s, g.data() + at, scale.data() + at);
    at += one->size();
  }
}

template <class Real> std::vector<Real> Manifold<Real>::aims(const Vector<Real>& g) const {
  std::vector<Real> all(g.data(), g.data() + g.size());
  Index end = size_;
  for (std::size_t k = own_.size(); k-- > 0;) {
    const Index begin = end - own_[k]->size();
    if (own_[k]->vanish()) std::fill(all.begin() + begin, all.begin() + end, Real(0));
    end = begin;
  }
  return all;
}

/// dH/dx = - m a, dH/dv = m v.
template <class Real>
void Manifold<Real>::energy_gradient(AnyIntegrator<Real>& of, const ParticleSystem<Real>& s, Matrix<Real>& G,
                                     Index column) {
  const Index n = particles_;
  of.accelerations(s, a_);
  for (Index i = 0; i < n; ++i) {
    const Real m = masses_[static_cast<std::size_t>(i)];
    const Vec3<Real> a = a_[i], v = s.velocities()[i];
    for (Index k = 0; k < 3; ++k) {
      G(k * n + i, column) = -m * a[k];
      G((3 + k) * n + i, column) = m * v[k];
    }
  }
}

template <class Real>
void Manifold<Real>::gradients(AnyIntegrator<Real>& of, const ParticleSystem<Real>& s, Matrix<Real>& G) {
  const Index n = particles_;
  G.setZero(n > 0 ? 6 * n : variables_, size_);
  Index at = 0;
  for (const Invariant one : options_.onto) {
    if (one == Invariant::energy) energy_gradient(of, s, G, at++);
    if (one != Invariant::momentum && one != Invariant::angular_momentum) continue;
    for (Index i = 0; i < n; ++i) {
      const Real m = masses_[static_cast<std::size_t>(i)];
      const Vec3<Real> x = s.positions()[i], v = s.velocities()[i];
      for (Index k = 0; k < 3; ++k) {
        if (one == Invariant::momentum) {
          G((3 + k) * n + i, at + k) = m;
          continue;
        }
        // L_k = m (x_p v_q - x_q v_p)
        const Index p = (k + 1) % 3, q = (k + 2) % 3;
        G(p * n + i, at + k) = m * v[q];
        G(q * n + i, at + k) = -m * v[p];
        G((3 + p) * n + i, at + k) = -m * x[q];
        G((3 + q) * n + i, at + k) = m * x[p];
      }
    }
    at += 3;
  }
  for (const auto& one : own_) {
    one->gradients(s, G, at);
    at += one->size();
  }
}

template <class Real> void Manifold<Real>::directions(const Matrix<Real>& G, Matrix<Real>& D) const {
  const Index n = particles_;
  if (!options_.direction.empty()) {
    D.resize(G.rows(), 1);
    for (Index i = 0; i < D.rows(); ++i) D(i, 0) = Real(options_.direction[static_cast<std::size_t>(i)]);
    return;
  }
  if (options_.how != Projection::hamiltonian) return weigh(G, D);
  // The flow of g: x' = dg/dp, p' = - dg/dx.
  D.setZero(G.rows(), G.cols());
  for (Index k = 0; k < 3 * n; ++k) {
    const Real m = masses_[static_cast<std::size_t>(k % n)];
    if (m == Real(0)) continue;
    D.row(k) = G.row(3 * n + k) / m;
    D.row(3 * n + k) = -G.row(k) / m;
  }
}

/// W^-1 G, or the part of it that moves positions or velocities alone; what has no mass stays.
template <class Real> void Manifold<Real>::weigh(const Matrix<Real>& G, Matrix<Real>& D) const {
  const Index n = particles_;
  D = G;
  if (n == 0) return;
  const Real slow = Real(1) / (Real(options_.time_scale) * Real(options_.time_scale));
  for (Index k = 0; k < 6 * n; ++k) {
    const bool velocity = k >= 3 * n;
    const Real m = options_.norm == ProjectionNorm::mass ? masses_[static_cast<std::size_t>(k % n)] : Real(1);
    const bool stays = options_.moves && (*options_.moves == Moves::velocities) != velocity;
    const Real weight = stays || m == Real(0) ? Real(0) : (velocity ? slow : Real(1)) / m;
    D.row(k) *= weight;
  }
}

template class PivotedSolver<double>;
template class PivotedSolver<Quad>;
template class Manifold<double>;
template class Manifold<Quad>;

}  // namespace noether
