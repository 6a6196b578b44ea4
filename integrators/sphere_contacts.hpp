#pragma once
/// Where and when spheres of a shearing sheet touch between two kicks.

#include "engine/particle_system.hpp"
#include "forces/hard_spheres.hpp"
#include "integrators/epicycle.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

namespace noether {

/// The contacts of hard spheres on epicycles, found at their times and met in the order of time.
///
/// Particles of a box are in (x, y + 3 Omega x t/2, z) and (x', w, z') (integrators/sheared_box.hpp), those of open
/// space in places and velocities. Pairs that can touch within a window of time are found by cells, as far as each
/// sphere can come; when they do is a root of |d(t)| = r_i + r_j along the epicycle of the difference, approached from
/// below along parabolas that lie under |d|^2, so that the first root is never passed. After a contact both spheres
/// have others before them. Nothing depends on the order of particles in cells, on threads, or on where a box is cut.
/// @cost O(n) a window, about 40 operations for each pair within reach, and an epicycle or two for each contact
/// @source Donev2005
class SphereContacts {
 public:
  /// In one flow. Where more are needed spheres fly past thousands of others in a step.
  static constexpr int most_windows = 10'000;

  explicit SphereContacts(HardSpheres law) : law_(law) { law_.check(); }

  const HardSpheres& law() const { return law_; }
  /// Takes the spheres, and gives them the columns of what is counted.
  /// @throws Error  for radii that are none, a box in which two images could be met, and spheres that overlap
  void bind(ParticleSystem<double>& s, const SheetRates& rates);

  /// Finds what happens until a time h from now has gone, or less: how far spheres can go before they are looked for
  /// anew is limited. @param slope  3 Omega t/2 at the time t now; 0 in open space
  /// @return the length of the window
  double find(ParticleSystem<double>& s, double h, double slope);
  /// Puts those who touched where they are at the end of the window, after all particles have made its epicycle.
  void put(ParticleSystem<double>& s) const;
  /// Whether so many contacts were met in one flow that it seems they do not end.
  bool piles_up() const { return met_ > most_; }
  /// A new flow begins.
  void begin(const ParticleSystem<double>& s) { met_ = 0, most_ = 1000 * (s.size() + 10); }

  /// A pair that is to meet.
  struct Contact {
    double time;
    Index i, j;
    std::uint32_t of_i, of_j;  ///< how often each had met others when this was found

    bool operator>(const Contact& other) const {
      if (time != other.time) return time > other.time;
      return i != other.i ? i > other.i : j > other.j;
    }
  };

 private:
  /// A sphere at its last contact, or at the start of the window.
  struct Sphere {
    double time = 0;
    Vec3<double> x = Vec3<double>::Zero(), v = Vec3<double>::Zero();
    Vec3<std::int32_t> image = Vec3<std::int32_t>::Zero();
    double reach = 0;  ///< half the edge of a cube about `centre` that it does not leave
    double path = 0;   ///< how far it may still go in that cube
    Vec3<double> centre = Vec3<double>::Zero();
    std::uint32_t contacts = 0;
    bool touched = false;
  };
  struct Difference {
    Vec3<double> d, u;
    double lift = 0;  ///< of an image along z: what is pulled to the middle is d_z without it
  };

  double slope_at(double time) const { return slope_ + shear_ * time; }
  double speed(const Sphere& sphere) const;
  double height(const Sphere& sphere) const;
  void gather(const ParticleSystem<double>& s);
  double window(double h) const;
  void sort_into_cells();
  template <class Act> void for_cells(const Sphere& sphere, const Act& act) const;
  std::size_t slot(std::int64_t across, std::int64_t along) const;
  void candidates(Index i, bool all, std::vector<Index>& found) const;
  bool within_reach(const Sphere& one, const Sphere& other) const;
  void fly(Sphere& sphere, double time) const;
  Vec3<double> nearest(Vec3<double> d) const;
  Difference difference(const Sphere& one, const Sphere& other, double time) const;
  std::optional<double> meeting(Index i, Index j) const;
  std::optional<double> first_root(const Difference& now, double distance, double left) const;
  void find_all();
  void meet(ParticleSystem<double>& s, const Contact& contact);
  void collide(ParticleSystem<double>& s, Index i, Index j);
  void look_around(Index i);
  void refuse_overlaps(const ParticleSystem<double>& s);

  HardSpheres law_;
  SheetRates rates_;
  double shear_ = 0;  ///< 3 Omega/2
  Box box_;
  ScalarColumn<double> radii_;
  double largest_ = 0;

  double slope_ = 0, end_ = 0;  ///< of this window
  double widening_ = 1;         ///< of distances by the shear within it
  std::vector<Sphere> spheres_;
  double cell_x_ = 1, cell_y_ = 1;
  std::int64_t across_ = 0, along_ = 0;  ///< cells of a box; 0 in open space
  std::vector<std::int32_t> first_;      ///< of each slot, in `members_`
  std::vector<Index> members_;
  std::vector<std::vector<std::pair<Index, Index>>> pairs_;  ///< of each block
  std::vector<std::vector<Contact>> found_;                  ///< of each block
  std::vector<std::vector<Index>> beside_;                   ///< of each sphere, those that it can meet
  std::vector<Index> widened_;                               ///< spheres that left the cells they were sorted into
  std::priority_queue<Contact, std::vector<Contact>, std::greater<>> queue_;
  std::int64_t met_ = 0, most_ = 0;
};

}  // namespace noether
