#pragma once
/// Contacts of hard spheres in a sheared box by a search that knows nothing of the engine's, for tests.

#include "integrators/all_schemes.hpp"
#include "tests/support/ring_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace noether::test {

/// A free particle after a time, by the closed form of an epicycle about its guiding centre.
struct Place {
  Vec3<double> x, v;  ///< in space

  Place at(double t, double Omega, double Omega_z) const {
    const double w = v[1] + 1.5 * Omega * x[0], guide = x[0] + 2 * w / Omega, c = std::cos(Omega * t),
                 s = std::sin(Omega * t);
    const double across = guide - 2 * w / Omega * c + v[0] / Omega * s;
    const double z =
        Omega_z > 0 ? x[2] * std::cos(Omega_z * t) + v[2] / Omega_z * std::sin(Omega_z * t) : x[2] + v[2] * t;
    const double vz = Omega_z > 0 ? v[2] * std::cos(Omega_z * t) - x[2] * Omega_z * std::sin(Omega_z * t) : v[2];
    const double w_then = w * c - v[0] / 2 * s;
    return {{across, x[1] - 1.5 * Omega * guide * t + 4 / Omega * (w * s + v[0] / 2 * (c - 1)), z},
            {v[0] * c + 2 * w * s, w_then - 1.5 * Omega * across, vz}};
  }
};

/// A particle of a box as if it had never been wrapped: the cell that it is in has slid along y.
inline Place on_its_path(const ParticleSystem<double>& s, Index i, double Omega) {
  Vec3<double> x = s.unwrapped(i);
  x[1] = s.positions()[i][1] - 1.5 * Omega * s.time() * s.box().edges()[0] * s.images().component(0)[i];
  return {x, s.velocities()[i]};
}

/// Contacts within a step: the gap of every pair, through all 27 images and by its closed form, is looked at in pieces
/// of the step, and where it has a minimum there.
class ByPairs {
 public:
  ByPairs(const ParticleSystem<double>& s, const HardSpheres& law, double Omega)
      : edges_(s.box().edges()), time_(s.time()), law_(law), Omega_(Omega) {
    for (Index i = 0; i < s.size(); ++i) {
      all_.push_back(on_its_path(s, i, Omega));
      masses_.push_back(s.masses()[i]);
      radii_.push_back(s.column<BodyRadius>()[i]);
    }
  }
  int contacts() const { return contacts_; }
  /// Those of them that were through an image along z.
  int contacts_above() const { return contacts_above_; }
  const std::vector<Place>& places() const { return all_; }

  void step(double h) {
    double left = h;
    std::pair<std::size_t, std::size_t> last{0, 0};
    while (true) {
      double first = left;
      std::pair<std::size_t, std::size_t> who{0, 0};
      Vec3<double> offset;
      for (std::size_t i = 0; i < all_.size(); ++i) {
        for (std::size_t j = i + 1; j < all_.size(); ++j) {
          for (const Vec3<double>& image : images(i, j)) {
            const double t = root(i, j, image, first, std::pair{i, j} == last);
            if (t < first) first = t, who = {i, j}, offset = image;
          }
        }
      }
      const Place hit = who.second > 0 ? image_of(who.second, offset) : Place{};
      const double touch = who.second > 0 ? first : left;
      if (who.second > 0) collide(who.first, who.second, hit, offset[2] * edges_[2], touch);
      for (std::size_t i = 0; i < all_.size(); ++i) {
        if (who.second > 0 && (i == who.first || i == who.second)) continue;
        all_[i] = all_[i].at(touch, Omega_, Omega_);
      }
      time_ += touch;
      left -= touch;
      last = who;
      if (who.second == 0) return;
    }
  }

 private:
  /// How far, in cells, the images of j that can be near i are away.
  std::vector<Vec3<double>> images(std::size_t i, std::size_t j) const {
    std::vector<Vec3<double>> all;
    const Vec3<double> d = all_[j].x - all_[i].x;
    const double reach = radii_[i] + radii_[j] + 1, near = -std::nearbyint(d[0] / edges_[0]),
                 above = -std::nearbyint(d[2] / edges_[2]);
    for (int a = -1; a <= 1; ++a) {
      const double across = near + a, x = d[0] + across * edges_[0];
      const double y = d[1] - 1.5 * Omega_ * time_ * across * edges_[0];
      const double along = -std::nearbyint(y / edges_[1]);
      for (int b = -1; b <= 1; ++b) {
        for (int c = -1; c <= 1; ++c) {
          if (std::abs(x) < reach && std::abs(y + (along + b) * edges_[1]) < reach &&
              std::abs(d[2] + (above + c) * edges_[2]) < reach)
            all.emplace_back(across, along + b, above + c);
        }
      }
    }
    return all;
  }
  /// The image in the plane. One along z is pulled to a middle of its own, and always as far above this one.
  Place image_of(std::size_t j, const Vec3<double>& image) const {
    Place there = all_[j];
    there.x[0] += image[0] * edges_[0];
    there.x[1] += image[1] * edges_[1] - 1.5 * Omega_ * time_ * image[0] * edges_[0];
    there.v[1] -= 1.5 * Omega_ * image[0] * edges_[0];
    return there;
  }
  /// When j, at an image, comes to touch i. The difference of two epicycles is an epicycle.
  double root(std::size_t i, std::size_t j, const Vec3<double>& image, double left, bool just_met) const {
    const Place there = image_of(j, image);
    const Place d{there.x - all_[i].x, there.v - all_[i].v};
    const Vec3<double> lift(0, 0, image[2] * edges_[2]);
    const double touch = radii_[i] + radii_[j];
    const auto gap = [&](double t) { return (d.at(t, Omega_, Omega_).x + lift).norm() - touch; };
    const auto closing = [&](double t) {
      const Place then = d.at(t, Omega_, Omega_);
      return (then.x + lift).dot(then.v);
    };
    constexpr int pieces = 12;
    if (gap(0) > 2 * left + left * d.v.norm()) return left;
    double from = 0;
    if (!just_met && gap(0) <= 1e-13 && closing(0) < 0) return 0;
    for (int k = 1; k <= pieces; ++k) {
      const double to = left * k / pieces;
      double low = from, high = to;
      if (closing(from) < 0 && closing(to) > 0) {  // a minimum between
        for (int n = 0; n < 60; ++n) (closing((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
      }
      if (closing(from) < 0 && gap(high) < 0) {
        low = from;
        for (int n = 0; n < 60; ++n) (gap((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
        return high;
      }
      from = to;
    }
    return left;
  }
  void collide(std::size_t i, std::size_t j, const Place& image, double lift, double t) {
    Place one = all_[i].at(t, Omega_, Omega_);
    const Place there = image.at(t, Omega_, Omega_);
    Place other = all_[j].at(t, Omega_, Omega_);
    const Vec3<double> n = (there.x + Vec3<double>(0, 0, lift) - one.x).normalized();
    const double approach = -(there.v - one.v).dot(n);
    const double gain = approach + law_.rebound(approach, Omega_ * (radii_[i] + radii_[j]) / 2000);
    one.v -= masses_[j] / (masses_[i] + masses_[j]) * gain * n;
    other.v += masses_[i] / (masses_[i] + masses_[j]) * gain * n;
    all_[i] = one;
    all_[j] = other;
    ++contacts_;
    if (lift != 0) ++contacts_above_;
  }

  Vec3<double> edges_;
  double time_;
  HardSpheres law_;
  double Omega_;
  std::vector<Place> all_;
  std::vector<double> masses_, radii_;
  int contacts_ = 0, contacts_above_ = 0;
};

/// How a run of the engine, with Omega = 1, differs from that search.
struct SearchedRun {
  int contacts = 0;        ///< of the search
  int contacts_above = 0;  ///< those of them that were through an image along z
  int wrong_steps = 0;     ///< that have another number of contacts
  double worst = 0;        ///< difference of a place or a velocity after a step
};

/// Compares the whole state after each step, made from the same state: a contact that is missed, or met twice, shows.
inline SearchedRun searched_run(const ParticleSystem<double>& start, const HardSpheres& law, double h, int steps) {
  Composition<AnyHamiltonian<double>> integrator(sheet_of_spheres({}, law), schemes::verlet);
  auto raw = start;
  raw.clock() = Clock<double>::fixed(0, h);
  integrator.bind(raw);
  auto now = raw;
  SearchedRun found;
  const Vec3<double> edges = start.box().edges();
  for (int step = 0; step < steps; ++step) {
    ByPairs truth(now, law, 1);
    const double before = step > 0 ? total_contacts(now) : 0;
    integrator.advance(raw, {.steps = 1});
    integrator.settle(raw, now, {}, std::nullopt, true);
    truth.step(h);
    if (truth.contacts() != static_cast<int>(total_contacts(now) - before)) ++found.wrong_steps;
    found.contacts += truth.contacts();
    found.contacts_above += truth.contacts_above();
    for (Index i = 0; i < now.size(); ++i) {
      const Place& there = truth.places()[static_cast<std::size_t>(i)];
      Vec3<double> d = there.x - on_its_path(now, i, 1).x;
      d[1] -= edges[1] * std::nearbyint(d[1] / edges[1]);
      found.worst = std::max(
          {found.worst, d.cwiseAbs().maxCoeff(), (there.v - Vec3<double>(now.velocities()[i])).cwiseAbs().maxCoeff()});
    }
  }
  return found;
}

}  // namespace noether::test
