#include "integrators/methods/boris_sdc.hpp"

#include "integrators/all_methods.hpp"
#include "integrators/gyration.hpp"
#include "integrators/methods/collocation_table.hpp"

#include <algorithm>

namespace noether {

void BorisSdcOptions::check() const {
  if (nodes < 3 || nodes > 9) refuse_field("nodes", nodes, "is not a valid number of nodes; 3 to 9 are expected");
  if (sweeps < 1 || sweeps > 32)
    refuse_field("sweeps", sweeps, "is not a valid number of sweeps; 1 to 32 are expected");
}

template <class Real>
BorisSdc<Real>::BorisSdc(const MethodInfo& info, const MethodOptions& options)
    : name_(info.name), options_(options.own.as<BorisSdcOptions>()) {
  const CollocationTable& table = lobatto_table(static_cast<int>(options_.nodes));
  const auto twice = table.twice();
  const std::size_t n = table.stages();
  const auto real = [](const Quad& x) { return static_cast<Real>(x); };
  const Row zeros(n, Real(0));
  to_positions_ = of_news_ = along_ = std::vector<Row>(n, zeros);
  for (std::size_t m = 0; m < n; ++m) {
    c_.push_back(real(table.c[m]));
    // Between nodes k - 1 and k velocity Verlet takes d_k v + d_k^2 f/2; v has taken halves of two rates a step.
    const auto step_to = [&](std::size_t k) { return table.c[k] - table.c[k - 1]; };
    for (std::size_t l = 0; l < n; ++l) {
      to_positions_[m][l] = real(twice[m][l]);
      if (m > 0) along_[m][l] = real(table.a[m][l] - table.a[m - 1][l]);
      if (l >= m) continue;
      const Quad after = table.c[m] - table.c[l + 1], until_end = step_to(l + 1);
      Quad x = until_end * until_end / Quad(2) + after * until_end / Quad(2);
      if (l > 0) x += step_to(l) * (table.c[m] - table.c[l]) / Quad(2);
      of_news_[m][l] = real(x);
    }
  }
  nodes_.resize(n);
}

template <class Real> MethodClaims BorisSdc<Real>::claims() const {
  const auto most = 2 * options_.nodes - 2, passes = turns_ ? (options_.sweeps + 1) / 2 : options_.sweeps;
  const auto reached = 2 + 2 * passes;
  return {
      .name = name_, .order = static_cast<int>(std::min(most, reached)), .second_order_only = true, .turns_only = true};
}

template <class Real> void BorisSdc<Real>::bind(const VectorField<Real>& f) {
  const FieldClaims field = f.claims();
  if (!field.second_order) {
    throw SchemeMismatch(
        fmt::format("method '{}' is for q'' = a + v x rate only, but '{}' is a first-order system; use "
                    "'gauss_6' instead",
                    name_, field.name));
  }
  if (field.velocity_dependent && !field.gyrates) {
    throw SchemeMismatch(
        fmt::format("method '{}' needs forces that depend on velocities by magnetic fields alone; use "
                    "'gauss_6' instead",
                    name_));
  }
  turns_ = field.gyrates && field.velocity_dependent;
  here_.resize(f.size());
  for (Node& node : nodes_) {
    for (Vector<Real>* v : {&node.a, &node.rate, &node.f, &node.f_before, &node.change}) v->setZero(f.size() / 2);
  }
}

/// The position at node m.
template <class Real> void BorisSdc<Real>::place(std::size_t m, const Vector<Real>& y, const Real& h) {
  const Index n = y.size() / 2;
  for (Index i = 0; i < n; ++i) {
    Real bend(0);
    for (std::size_t l = 0; l < nodes_.size(); ++l) bend += to_positions_[m][l] * nodes_[l].f_before[i];
    for (std::size_t l = 0; l < m; ++l) bend += of_news_[m][l] * (nodes_[l].f[i] - nodes_[l].f_before[i]);
    here_[i] = y[i] + h * (c_[m] * y[n + i] + h * bend);
  }
}

/// The velocity at node m, and f there.
template <class Real> void BorisSdc<Real>::push(std::size_t m, const Vector<Real>& y, const Real& h) {
  const Node& last = nodes_[m - 1];
  Node& node = nodes_[m];
  const Index n = y.size() / 2;
  const Real half = h * (c_[m] - c_[m - 1]) / Real(2);
  // From v of the node before by u with u - half u x rate = half (f' + a + v x rate - f - f) + h integral.
  for (Index i = 0; i < n; ++i) {
    Real integral(0);
    for (std::size_t l = 0; l < nodes_.size(); ++l) integral += along_[m][l] * nodes_[l].f_before[i];
    const Real change = half * (last.f[i] - last.f_before[i] + (node.a[i] - node.f_before[i])) + h * integral;
    node.change[i] = last.change[i];
    here_[n + i] = y[n + i] + last.change[i];
    node.f[i] = change;
  }
  if (turns_) {
    const auto at = [n](const Vector<Real>& x, Index from, Index i) {
      return Vec3<Real>(x[from + i], x[from + n / 3 + i], x[from + 2 * (n / 3) + i]);
    };
    for (Index i = 0; i < n / 3; ++i) {
      const Vec3<Real> t = half * at(node.rate, 0, i);
      const Vec3<Real> u = detail::half_turned_about<Real>(at(node.f, 0, i) + cross(at(here_, n, i), t), t);
      for (int k = 0; k < 3; ++k) node.f[k * (n / 3) + i] = u[k];
    }
  }
  for (Index i = 0; i < n; ++i) {
    node.change[i] += node.f[i];
    here_[n + i] = y[n + i] + node.change[i];
  }
}

/// f of a node, with the velocity of `here_`.
template <class Real> void BorisSdc<Real>::finish(Node& node) const {
  node.f = node.a;
  if (!turns_) return;
  const Index all = node.a.size(), n = all / 3;
  for (Index i = 0; i < n; ++i) {
    const Vec3<Real> v(here_[all + i], here_[all + n + i], here_[all + 2 * n + i]);
    const Vec3<Real> turn = cross(v, Vec3<Real>(node.rate[i], node.rate[n + i], node.rate[2 * n + i]));
    for (int k = 0; k < 3; ++k) node.f[k * n + i] += turn[k];
  }
}

template <class Real> StepResult BorisSdc<Real>::step(VectorField<Real>& f, const Real& t, Vector<Real>& y, double h) {
  const Real step(h);
  here_ = y;
  const auto act_at = [&](const Real& time, Node& node) {
    if (turns_) return f.acceleration_and_rate(time, here_, node.a, node.rate);
    f.acceleration(time, here_, node.a);
  };
  act_at(t, nodes_[0]);
  finish(nodes_[0]);
  for (Node& node : nodes_) node.f_before.setZero();
  for (std::int64_t pass = 0; pass <= options_.sweeps; ++pass) {
    for (std::size_t m = 1; m < nodes_.size(); ++m) {
      Node& node = nodes_[m];
      place(m, y, step);
      act_at(t + c_[m] * step, node);
      push(m, y, step);
      finish(node);
    }
    for (Node& node : nodes_) node.f_before = node.f;
  }
  y = here_;
  return {.h = h};
}

template class BorisSdc<double>;
template class BorisSdc<Quad>;

namespace {
template <class Real>
std::unique_ptr<Method<Real>> make_boris_sdc(const MethodInfo& info, const MethodOptions& options) {
  return std::make_unique<BorisSdc<Real>>(info, options);
}
}  // namespace

std::span<const MethodInfo> methods::boris_sdc_list() {
  static const MethodInfo list[] = {
      {.name = "boris_sdc",
       .summary =
           "Boris's step between Lobatto nodes, corrected by sweeps towards collocation: order by nodes and sweeps",
       .use = "charges in fields to high accuracy over short times without linear systems (order 6 in magnetic fields)",
       .source = "WinkelSpeckRuprecht2015",
       .family = "collocation",
       .options = {&own_options<BorisSdcOptions>},
       .order = 8,
       .evaluations = 17,
       .make = make_boris_sdc<double>,
       .make_quad = make_boris_sdc<Quad>},
  };
  return list;
}

}  // namespace noether
