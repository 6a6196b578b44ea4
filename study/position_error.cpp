#include "study/position_error.hpp"

#include "engine/bodies.hpp"
#include "engine/sums.hpp"

#include <algorithm>
#include <cmath>

namespace noether {

bool about_center(const Scene& scene) {
  if (scene.particles.size() < 2 || !scene.hamiltonian.constraints.empty()) return false;
  if (!scene.hamiltonian.splitting.claims().keeps_momentum) return false;
  for (const SceneForce& force : scene.hamiltonian.forces) {
    if (!force.force.claims().keeps_momentum) return false;
  }
  return true;
}

PositionError::PositionError(const ParticleSystem<double>& particles, bool about) : about_center_(about) {
  for (Index i = 0; i < particles.size(); ++i) masses_.emplace_back(particles.masses()[i]);
  const double total = sum_over<double>(particles.size(), [&](Index i) { return particles.masses()[i]; });
  if (!(total > 0)) about_center_ = false;
  any_turns_ = has_bodies(particles);
}

double PositionError::turned_apart(const Vector<Quad>& y, const Vector<Quad>& truth) const {
  const auto n = static_cast<Index>(masses_.size());
  double worst = 0;
  for (Index i = 0; i < n; ++i) {
    Quaternion<Quad> q, exact;
    for (int k = 0; k < 4; ++k) {
      q[k] = y[(6 + k) * n + i];
      exact[k] = truth[(6 + k) * n + i];
    }
    const Quaternion<Quad> by = quaternion_product<Quad>(conjugate<Quad>(q), exact);
    const double sine = static_cast<double>(sqrt(norm2(vector_part<Quad>(by))));
    const double angle = 2 * std::atan2(sine, std::abs(static_cast<double>(by[0])));  // q and -q are one rotation
    if (!(angle <= worst)) worst = angle;
  }
  return worst;
}

std::vector<Quad> PositionError::positions(const Vector<Quad>& y) const {
  const std::size_t n = masses_.size();
  if (n == 0) return {y.data(), y.data() + y.size()};
  std::vector<Quad> x(y.data(), y.data() + 3 * static_cast<Index>(n));
  if (!about_center_) return x;
  for (std::size_t k = 0; k < 3; ++k) {
    Quad sum(0), total(0);
    for (std::size_t i = 0; i < n; ++i) {
      sum += masses_[i] * x[k * n + i];
      total += masses_[i];
    }
    for (std::size_t i = 0; i < n; ++i) x[k * n + i] -= sum / total;
  }
  return x;
}

void PositionError::set_scale(const std::vector<Vector<Quad>>& y) {
  scale_ = 0;
  sizes_.clear();
  if (about_center_ || y.empty()) return;
  if (masses_.empty()) {
    sizes_.assign(static_cast<std::size_t>(y[0].size()), 0);
    for (const Vector<Quad>& one : y) {
      for (std::size_t i = 0; i < sizes_.size(); ++i) {
        sizes_[i] = std::max(sizes_[i], std::abs(static_cast<double>(one[static_cast<Index>(i)])));
      }
    }
    const double largest = *std::max_element(sizes_.begin(), sizes_.end());
    std::replace(sizes_.begin(), sizes_.end(), 0.0, largest);  // what is 0 all the time is measured by the others
    return;
  }
  double squares = 0;
  for (const Vector<Quad>& one : y) {
    const std::vector<Quad> all = positions(one);
    squares += sum_over<double>(std::ssize(all), [&](Index i) {
      const double x = static_cast<double>(all[static_cast<std::size_t>(i)]);
      return x * x;
    });
  }
  scale_ = std::sqrt(squares / static_cast<double>(y.size()));
}

double PositionError::size(const Vector<Quad>& y) const {
  Quad squares(0);
  for (const Quad& x : positions(y)) squares += x * x;
  return static_cast<double>(sqrt(squares));
}

double PositionError::operator()(const Vector<Quad>& y, const Vector<Quad>& truth) const {
  const double distance = moved_apart(y, truth);
  if (!any_turns_) return distance;
  const double angle = turned_apart(y, truth);
  return angle <= distance ? distance : angle;
}

double PositionError::moved_apart(const Vector<Quad>& y, const Vector<Quad>& truth) const {
  const std::vector<Quad> x = positions(y), exact = positions(truth);
  if (!sizes_.empty() && sizes_[0] > 0) {
    double squares = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double error = static_cast<double>(x[i] - exact[i]) / sizes_[i];
      squares += error * error;
    }
    return std::sqrt(squares / static_cast<double>(x.size()));
  }
  Quad difference(0), size(0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    difference += (x[i] - exact[i]) * (x[i] - exact[i]);
    size += exact[i] * exact[i];
  }
  const double whole = scale_ > 0 ? scale_ : static_cast<double>(sqrt(size));
  const double distance = static_cast<double>(sqrt(difference));
  return whole > 0 ? distance / whole : distance;
}

}  // namespace noether
