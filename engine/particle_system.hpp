#pragma once
/// All state of the particles, or of a system without any, and nothing else.

#include "engine/box.hpp"
#include "engine/clock.hpp"
#include "engine/columns.hpp"
#include "engine/topology.hpp"
#include "numbers/error.hpp"
#include "numbers/parallel.hpp"
#include "numbers/real.hpp"
#include "numbers/units.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace noether {

struct Bodies;

/// Where in the word of its integrator a system stands.
struct Phase {
  std::uint8_t coordinates = 0;  ///< of the position and velocity columns: 0 inertial; else a Hamiltonian's own
  bool opened = false;           ///< working coordinates and the word before the run are in effect
  bool pending = false;          ///< the last stage of the last step is still to be done

  bool operator==(const Phase&) const = default;
};

/// Particles as a structure of arrays: id, name, x, v, m, the clock, the box and the phase.
///
/// Columns are 64-byte aligned, shape (n, 3) for vectors. Mass 0 marks a tracer: it feels accelerations and exerts
/// none. Sizes and parameters of a system in a run change only in `Simulation::edit`; ids are never used twice.
template <class Real = double> class ParticleSystem {
 public:
  explicit ParticleSystem(const UnitSystem& units = unit_system("reduced")) : units_(&units) {}

  /// Appends one particle and returns its index; in the columns that parts declared it starts as these say.
  /// @param x, v  inertial [length], [length/time]
  Index add(std::string name, const Real& mass, const Vec3<Real>& x, const Vec3<Real>& v) {
    NOETHER_EXPECTS(!low_, "particles can be added only before an integrator is bound, or in Simulation::edit");
    ids_.push_back(next_id_++);
    names_.push_back(std::move(name));
    m_.append(mass);
    x_.append(x);
    v_.append(v);
    if (!columns_.empty()) columns_.append();
    members_ = detail::fresh_version();
    if (box_.is_periodic()) {
      images_.append(Vec3<std::int32_t>::Zero());
      wrap(size() - 1);
    }
    version_ = detail::fresh_version();
    return size() - 1;
  }

  /// Takes particle `i` out; the others keep their ids.
  void remove(Index i) {
    NOETHER_EXPECTS(!low_, "particles can be removed only in Simulation::edit");
    NOETHER_EXPECTS(!topology_, "bonds refer to particles by index, so no particle can be removed");
    NOETHER_EXPECTS(!bodies_, "rigid bodies are known by index, so no particle can be removed");
    ids_.erase(ids_.begin() + i);
    names_.erase(names_.begin() + i);
    m_.erase(i);
    x_.erase(i);
    v_.erase(i);
    columns_.erase(i);
    if (box_.is_periodic()) images_.erase(i);
    members_ = version_ = detail::fresh_version();
  }

  /// Gives back memory that `add` has taken ahead. @cost O(n)
  void trim() {
    x_.trim();
    v_.trim();
    images_.trim();
    columns_.trim();
  }

  Index size() const { return m_.size(); }

  /// Positions, shape (n, 3) [length]. The writing access makes known forces void.
  const VectorColumn<Real>& positions() const { return x_; }
  VectorColumn<Real>& positions() {
    version_ = detail::fresh_version();
    return x_;
  }
  /// Velocities, shape (n, 3) [length/time].
  const VectorColumn<Real>& velocities() const { return v_; }
  VectorColumn<Real>& velocities() { return v_; }
  /// Masses, shape (n) [mass]; 0 marks a tracer.
  const ScalarColumn<Real>& masses() const { return m_; }
  ScalarColumn<Real>& masses() {
    version_ = mass_version_ = detail::fresh_version();
    return m_;
  }

  /// Variables y of a first-order system, y' = f(t, y); empty where particles carry all state.
  const std::vector<Real>& variables() const { return variables_; }
  std::vector<Real>& variables() { return variables_; }
  /// Names of the variables; empty where they have none.
  const std::vector<std::string>& variable_names() const { return variable_names_; }
  /// Gives variables and their names, or no names at all.
  void set_variables(std::vector<Real> values, std::vector<std::string> names = {}) {
    NOETHER_EXPECTS(names.empty() || names.size() == values.size(), "there is a name for each variable, or for none");
    variables_ = std::move(values);
    variable_names_ = std::move(names);
  }
  /// The name of variable `i`; "y[3]" where variables have none.
  std::string variable_name(Index i) const {
    if (variable_names_.empty()) return "y[" + std::to_string(i) + "]";
    return variable_names_[static_cast<std::size_t>(i)];
  }

  const std::vector<std::int64_t>& ids() const { return ids_; }
  const std::vector<std::string>& names() const { return names_; }
  const std::string& name(Index i) const { return names_[static_cast<std::size_t>(i)]; }
  const UnitSystem& units() const { return *units_; }

  const Box& box() const { return box_; }
  /// Puts the particles into a box, where their positions are wrapped.
  /// @throws Error  for a periodic box where positions are summed with compensation: there they are on a grid
  void set_box(const Box& box) {
    NOETHER_EXPECTS(!box.is_periodic() || !low_, "positions in a periodic box are not compensated");
    for (Index i = 0; i < size(); ++i) x_.set(i, unwrapped(i));
    box_ = box;
    images_ = VectorColumn<std::int32_t>(box.is_periodic() ? size() : 0);
    wrap();
  }
  /// How often each particle has crossed the periodic box, shape (n, 3); empty in open space.
  const VectorColumn<std::int32_t>& images() const { return images_; }
  VectorColumn<std::int32_t>& images() { return images_; }
  /// Position of particle `i` as if it had never been wrapped [length].
  Vec3<Real> unwrapped(Index i) const {
    Vec3<Real> x = x_[i];
    if (!box_.is_periodic()) return x;
    for (int k = 0; k < 3; ++k) x[k] += Real(images_.component(k)[i]) * Real(box_.edges()[k]);
    return x;
  }
  /// Brings all positions back into the periodic box, doubles onto its grid, and counts the cells they have crossed.
  void wrap() {
    if (!box_.is_periodic()) return;
    for_blocks(size(), [&](Index begin, Index end) {
      if constexpr (std::is_same_v<Real, double>) {
        for (int k = 0; k < 3; ++k)
          box_.bring_in(k, x_.component(k) + begin, images_.component(k) + begin, end - begin);
      } else {
        for (Index i = begin; i < end; ++i) wrap(i);
      }
    });
    version_ = detail::fresh_version();
  }
  /// Puts back the images of a file or a copy.
  void restore_images(VectorColumn<std::int32_t> images) {
    NOETHER_EXPECTS(images.size() == (box_.is_periodic() ? size() : 0), "there are images for all particles");
    images_ = std::move(images);
  }

  /// Types and bonds of the particles; null where nobody gave any. Copies of the particles share it.
  const Topology* topology() const { return topology_.get(); }
  const std::shared_ptr<const Topology>& shared_topology() const { return topology_; }
  void set_topology(std::shared_ptr<const Topology> topology) { topology_ = std::move(topology); }
  /// Which particles are rigid bodies (engine/bodies.hpp); null where all are points. Copies share it.
  const Bodies* bodies() const { return bodies_.get(); }
  const std::shared_ptr<const Bodies>& shared_bodies() const { return bodies_; }
  void set_bodies(std::shared_ptr<const Bodies> bodies) { bodies_ = std::move(bodies); }

  const Clock<Real>& clock() const { return clock_; }
  Clock<Real>& clock() { return clock_; }
  /// Time of the current stage [time].
  Real time() const { return clock_.time(); }

  const Phase& phase() const { return phase_; }
  Phase& phase() { return phase_; }

  /// Names the present positions and masses: equal versions of copies mean equal values.
  std::uint64_t version() const { return version_; }
  /// Names who the particles are: equal numbers of copies mean equal ids, in the same order.
  std::uint64_t members() const { return members_; }

  /// x += h v for every particle [length].
  /// @cost O(n), no allocation
  void advance_positions(const Real& h) {
    version_ = detail::fresh_version();
    if (box_.is_periodic()) {
      advance_in_box(h, v_);
    } else if (low_) {
      compensated_add(x_, low_->x, h, v_);
    } else {
      add_scaled(x_, h, v_);
    }
  }
  /// x += dx for every particle in a periodic box, of shape (n) [length].
  /// @cost O(n), no allocation
  void shift_in_box(const VectorColumn<Real>& dx) {
    version_ = detail::fresh_version();
    advance_in_box(Real(1), dx);
  }
  /// v += h a for every particle [length/time].
  void advance_velocities(const Real& h, const VectorColumn<Real>& a) {
    if (low_) {
      compensated_add(v_, low_->v, h, a);
    } else {
      add_scaled(v_, h, a);
    }
  }
  /// x_i += dx, v_i += dv.
  void shift(Index i, const Vec3<Real>& dx, const Vec3<Real>& dv) {
    if (low_) {
      compensated_add(x_, low_->x, i, dx);
      compensated_add(v_, low_->v, i, dv);
    } else {
      move(i, dx);
      v_.add(i, dv);
    }
  }
  /// v_i *= factor for every particle.
  void scale_velocities(const Real& factor) {
    v_.all() *= factor;
    if (low_) low_->v.all() *= factor;
  }
  /// Tells that `shift` changed positions: the version moves once for a whole loop.
  void moved() { version_ = detail::fresh_version(); }

  /// Rounding errors of x and v, kept beside them when an integrator sums with compensation; null otherwise.
  struct LowWords {
    VectorColumn<Real> x, v;
  };
  const LowWords* low_words() const { return low_ ? &*low_ : nullptr; }
  LowWords* low_words() { return low_ ? &*low_ : nullptr; }
  void keep_low_words(bool keep) {
    NOETHER_EXPECTS(!keep || !box_.is_periodic(), "positions in a periodic box are not compensated");
    if (keep && !low_) low_ = LowWords{VectorColumn<Real>(size()), VectorColumn<Real>(size())};
    if (!keep) low_.reset();
  }

  /// A column that the part that needs it declares (engine/columns.hpp): charge, type, orientation.
  template <class Tag> bool has() const { return columns_.find(Tag::name) != nullptr; }
  /// Gives the particles a column, each row as its declaration starts it; the reference holds while others are added.
  /// @throws Error  where a column of that name means something else
  template <class Tag> typename Tag::template type<Real>& add_column() {
    version_ = detail::fresh_version();
    return columns_.template add<Tag>(size());
  }
  /// The same for a column known by name; one that is there stays as it is.
  void add_column(const ColumnInfo& info) {
    columns_.expect_same(info);
    if (columns_.find(info.name) != nullptr) return;
    version_ = detail::fresh_version();
    columns_.add(info, size());
  }
  /// Gives particle `i` its numbers in a column known by name. @throws MissingColumn
  void set_row(std::string_view name, Index i, const std::vector<Real>& numbers) {
    version_ = detail::fresh_version();
    columns_.set_row(name, i, numbers);
  }
  /// @throws MissingColumn
  template <class Tag> const typename Tag::template type<Real>& column() const { return columns_.template get<Tag>(); }
  /// The same to be written to: but of momenta, known forces become void.
  template <class Tag> typename Tag::template type<Real>& column() {
    if constexpr (Tag::role != ColumnRole::momentum) version_ = detail::fresh_version();
    return columns_.template get<Tag>();
  }
  const Columns<Real>& columns() const { return columns_; }
  /// Puts back a column of a file or a copy.
  void restore_column(typename Columns<Real>::Column column) {
    version_ = detail::fresh_version();
    columns_.put(std::move(column));
  }

  /// Bytes of state per particle, as `noether explain` prints them.
  std::size_t bytes_per_particle() const {
    const std::size_t reals = 7 + (low_ ? 6 : 0);
    const std::size_t images = box_.is_periodic() ? 3 * sizeof(std::int32_t) : 0;
    return sizeof(std::int64_t) + reals * sizeof(Real) + images + columns_.bytes_per_particle();
  }

  /// The same particles in another number type: doubles widen exactly.
  template <class Other> ParticleSystem<Other> as() const {
    ParticleSystem<Other> other(*units_);
    for (Index i = 0; i < size(); ++i) {
      const Vec3<Real> x = x_[i], v = v_[i];
      other.add(name(i), static_cast<Other>(m_[i]),
                Vec3<Other>(static_cast<Other>(x[0]), static_cast<Other>(x[1]), static_cast<Other>(x[2])),
                Vec3<Other>(static_cast<Other>(v[0]), static_cast<Other>(v[1]), static_cast<Other>(v[2])));
    }
    other.restore_ids(ids_);
    other.members_ = members_;
    other.set_box(box_);
    other.set_topology(topology_);
    other.set_bodies(bodies_);
    other.restore_images(images_);
    other.columns_ = columns_.template as<Other>();
    std::vector<Other> variables;
    for (const Real& y : variables_) variables.push_back(static_cast<Other>(y));
    other.set_variables(std::move(variables), variable_names_);
    return other;
  }

  /// Becomes a copy of `other`; where the particles are the same ones, only their state is copied.
  /// @cost O(n); no allocation when sizes agree
  void assign_state(const ParticleSystem& other) {
    if (members_ != other.members_ || variables_.size() != other.variables_.size()) {
      *this = other;
      return;
    }
    x_.assign(other.x_);
    v_.assign(other.v_);
    if (mass_version_ != other.mass_version_) m_.assign(other.m_);
    mass_version_ = other.mass_version_;
    if (box_.is_periodic() || other.box_.is_periodic()) {
      box_ = other.box_;
      images_ = other.images_;
    }
    if (!variables_.empty()) variables_ = other.variables_;
    if (low_ || other.low_) low_ = other.low_;
    clock_ = other.clock_;
    phase_ = other.phase_;
    version_ = other.version_;
    columns_.assign(other.columns_);
  }

  /// Largest id: every whole number up to it is a double, as files and other programs may store ids.
  static constexpr std::int64_t largest_id = std::int64_t{1} << 53U;

  /// Gives the particles the ids of a file or a copy, shape (n).
  /// @throws Error  for one that is negative or above `largest_id`
  void restore_ids(const std::vector<std::int64_t>& ids) {
    for (const std::int64_t id : ids) {
      if (id >= 0 && id <= largest_id) continue;
      throw Error("the id " + std::to_string(id) + " cannot be stored; 0 to " + std::to_string(largest_id) +
                  " (2^53) is expected");
    }
    if (ids_ != ids) members_ = detail::fresh_version();
    ids_ = ids;
    for (const std::int64_t id : ids_) next_id_ = std::max(next_id_, id + 1);
  }
  std::int64_t next_id() const { return next_id_; }
  void restore_next_id(std::int64_t id) { next_id_ = id; }

 private:
  template <class Other> friend class ParticleSystem;

  void wrap(Index i) {
    for (int k = 0; k < 3; ++k) {
      Real& x = x_.component(k)[i];
      if constexpr (std::is_same_v<Real, double>) x = box_.on_grid(k, x);
      if constexpr (std::is_same_v<Real, double> || std::is_same_v<Real, Quad>) {
        box_.wrap(k, x, images_.component(k)[i]);
      }
    }
  }
  void move(Index i, const Vec3<Real>& dx) {
    if constexpr (std::is_same_v<Real, double>) {
      if (box_.is_periodic()) {
        for (int k = 0; k < 3; ++k) box_.shift(k, dx[k], x_.component(k)[i], images_.component(k)[i]);
        return;
      }
    }
    x_.add(i, dx);
    if (box_.is_periodic()) wrap(i);
  }
  void advance_in_box(const Real& h, const VectorColumn<Real>& rate) {
    if constexpr (std::is_same_v<Real, double>) {
      for_blocks(size(), [&](Index begin, Index end) {
        for (int k = 0; k < 3; ++k) {
          box_.advance(k, h, rate.component(k) + begin, x_.component(k) + begin, images_.component(k) + begin,
                       end - begin);
        }
      });
    } else {
      x_.add_scaled(h, rate);
      wrap();
    }
  }
  /// value += h rate, block by block where there are many.
  static void add_scaled(VectorColumn<Real>& value, const Real& h, const VectorColumn<Real>& rate) {
    if (value.size() < parallel_threshold) return value.add_scaled(h, rate);
    for_blocks(value.size(), [&](Index begin, Index end) { value.add_scaled(h, rate, begin, end); });
  }
  static void add_with_error(Real& value, Real& low, const Real& increment) {
    const Real d = increment + low;
    const Real sum = value + d;
    const Real back = sum - value;
    low = (value - (sum - back)) + (d - back);
    value = sum;
  }
  static void compensated_add(VectorColumn<Real>& value, VectorColumn<Real>& low, const Real& h,
                              const VectorColumn<Real>& rate) {
    for (int k = 0; k < 3; ++k) {
      for (Index i = 0; i < value.size(); ++i) {
        add_with_error(value.component(k)[i], low.component(k)[i], h * rate.component(k)[i]);
      }
    }
  }
  static void compensated_add(VectorColumn<Real>& value, VectorColumn<Real>& low, Index i, const Vec3<Real>& d) {
    for (int k = 0; k < 3; ++k) add_with_error(value.component(k)[i], low.component(k)[i], d[k]);
  }

  const UnitSystem* units_;
  std::vector<std::int64_t> ids_;
  std::vector<std::string> names_;
  VectorColumn<Real> x_, v_;
  ScalarColumn<Real> m_;
  std::shared_ptr<const Topology> topology_;
  std::shared_ptr<const Bodies> bodies_;
  Box box_;
  VectorColumn<std::int32_t> images_;
  std::vector<Real> variables_;
  std::vector<std::string> variable_names_;
  Clock<Real> clock_;
  Phase phase_;
  std::optional<LowWords> low_;
  Columns<Real> columns_;
  std::int64_t next_id_ = 0;
  std::uint64_t version_ = detail::fresh_version(), members_ = version_, mass_version_ = version_;
};

/// Shifts positions and velocities so that the centre of mass rests in the origin. Plain sums, made once before a run
/// begins, in the order of ids: their rounding stands in trajectories.
/// @throws Error  if all masses are 0
template <class Real> void move_to_barycenter(ParticleSystem<Real>& s) {
  Vec3<Real> x = Vec3<Real>::Zero(), v = Vec3<Real>::Zero();
  Real total(0);
  const auto& c = std::as_const(s);
  for (Index i = 0; i < s.size(); ++i) {
    x += c.masses()[i] * c.positions()[i];
    v += c.masses()[i] * c.velocities()[i];
    total += c.masses()[i];
  }
  if (!(total > Real(0)))
    throw Error("there is no centre of mass, because every particle is a tracer of mass 0; give one of them a mass");
  x /= total;
  v /= total;
  for (Index i = 0; i < s.size(); ++i) {
    s.positions().set(i, c.positions()[i] - x);
    s.velocities().set(i, c.velocities()[i] - v);
  }
}

}  // namespace noether
