#include "integrators/sphere_contacts.hpp"

#include "numbers/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace noether {

namespace {

/// Two spheres touch where d^2 is as near to (r_i + r_j)^2 as sums of squares tell, in units of it.
constexpr double touching = 1e-14;
/// What overlaps by less was left by the rounding of a state in a file.
constexpr double overlap_of_files = 1e-9;
/// Of the shortest edge of a box: two spheres that can come nearer than this see one image of each other alone.
constexpr double share_of_edge = 0.49;

bool is_finite(const Vec3<double>& x) { return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]); }

}  // namespace

void SphereContacts::bind(ParticleSystem<double>& s, const SheetRates& rates) {
  law_.check(s);
  for (const ColumnInfo& info : HardSpheres::columns::infos()) s.add_column(info);
  rates_ = rates;
  shear_ = 1.5 * rates.Omega;
  box_ = s.box();
  radii_ = std::as_const(s).column<BodyRadius>();
  largest_ = *std::max_element(radii_.begin(), radii_.end());
  if (box_.is_periodic()) {
    const double shortest = box_.edges().minCoeff();
    if (shortest < 5 * largest_) {
      throw Error(
          fmt::format("the box has an edge of {}, but a sphere of radius {} could meet two images of another one "
                      "in less than 5 radii; make each edge {} or more",
                      shortest, largest_, 5 * largest_));
    }
  }
  refuse_overlaps(s);
}

/// The largest speed of a free particle against the shear about it, at any time.
double SphereContacts::speed(const Sphere& sphere) const {
  const double z = rates_.Omega_z * height(sphere);
  return std::sqrt(sphere.v[0] * sphere.v[0] + 4 * sphere.v[1] * sphere.v[1] + sphere.v[2] * sphere.v[2] + z * z);
}

/// Of a sphere over the middle of the layer, which is a corner of a cell.
double SphereContacts::height(const Sphere& sphere) const {
  return sphere.x[2] + static_cast<double>(sphere.image[2]) * box_.edges()[2];
}

void SphereContacts::gather(const ParticleSystem<double>& s) {
  const Index n = s.size();
  spheres_.resize(static_cast<std::size_t>(n));
  const bool boxed = box_.is_periodic();
  for (Index i = 0; i < n; ++i) {
    Sphere& sphere = spheres_[static_cast<std::size_t>(i)];
    sphere = Sphere{};
    sphere.x = sphere.centre = s.positions()[i];
    sphere.v = s.velocities()[i];
    sphere.image = boxed ? Vec3<std::int32_t>(s.images()[i]) : Vec3<std::int32_t>(0, 0, 0);
    if (!boxed) sphere.v[1] += shear_ * sphere.x[0];
  }
}

/// How far ahead contacts are looked for at once: no sphere may see two images of another one, and most are to see
/// their neighbors alone.
double SphereContacts::window(double h) const {
  double fastest = 0, speeds = 0, radii = 0;
  Vec3<double> low = spheres_.front().x, high = low;
  for (const Sphere& sphere : spheres_) {
    const double speed = this->speed(sphere);
    fastest = std::max(fastest, speed);
    speeds += speed;
    low = low.cwiseMin(sphere.x);
    high = high.cwiseMax(sphere.x);
  }
  for (const double radius : radii_) radii += radius;
  const auto n = static_cast<double>(spheres_.size());
  const bool boxed = box_.is_periodic();
  const double shortest = boxed ? box_.edges().minCoeff() : std::numeric_limits<double>::infinity();
  const double area = boxed ? box_.edges()[0] * box_.edges()[1] : (high[0] - low[0]) * (high[1] - low[1]);
  const double far = 4 * radii / n + std::max(std::sqrt(area / n), (high - low).maxCoeff() / n);
  const auto too_long = [&](double w) {
    const double widening = 1 + shear_ * w;
    return shear_ * w > 0.25 || 2 * (largest_ + 1.5 * w * fastest) * widening > share_of_edge * shortest ||
           w * speeds / n > far;
  };
  while (too_long(h)) h /= 2;
  return h;
}

std::size_t SphereContacts::slot(std::int64_t across, std::int64_t along) const {
  const std::uint64_t mixed = static_cast<std::uint64_t>(across) * 0x9E3779B97F4A7C15U +
                              static_cast<std::uint64_t>(along) * 0xC2B2AE3D27D4EB4FU;
  return static_cast<std::size_t>((mixed >> 20U) & (first_.size() - 2));
}

/// Calls `act(slot)` for the cells of the plane that the cube of a sphere covers. Beyond an edge in x cells are those
/// of the image, which has slid along y.
template <class Act> void SphereContacts::for_cells(const Sphere& sphere, const Act& act) const {
  const double y_here = sphere.centre[1] - slope_ * sphere.centre[0];
  const auto cell = [](double x, double edge) {
    constexpr double most = 1e15;  // whole numbers there, in cells far out in open space
    return static_cast<std::int64_t>(std::clamp(std::floor(x / edge), -most, most));
  };
  const auto first = cell(sphere.centre[0] - sphere.reach, cell_x_),
             last = cell(sphere.centre[0] + sphere.reach, cell_x_);
  for (std::int64_t a = first; a <= last; ++a) {
    std::int64_t across = a;
    double y = y_here;
    if (across_ > 0) {
      const double cells = std::floor(static_cast<double>(a) / static_cast<double>(across_));
      across -= static_cast<std::int64_t>(cells) * across_;
      y += slope_ * box_.edges()[0] * cells;
      y -= box_.edges()[1] * std::floor(y / box_.edges()[1]);
    }
    const auto low = cell(y - sphere.reach, cell_y_), high = cell(y + sphere.reach, cell_y_);
    for (std::int64_t b = low; b <= high; ++b) {
      const std::int64_t along = along_ > 0 ? ((b % along_) + along_) % along_ : b;
      act(slot(across, along));
    }
  }
}

void SphereContacts::sort_into_cells() {
  double sum = 0, largest = 0;
  for (const Sphere& sphere : spheres_) {
    sum += sphere.reach;
    largest = std::max(largest, sphere.reach);
  }
  const double wanted = std::max(2.5 * sum / static_cast<double>(spheres_.size()), largest / 20);
  cell_x_ = cell_y_ = wanted;
  across_ = along_ = 0;
  if (box_.is_periodic()) {
    across_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(box_.edges()[0] / wanted));
    along_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(box_.edges()[1] / wanted));
    cell_x_ = box_.edges()[0] / static_cast<double>(across_);
    cell_y_ = box_.edges()[1] / static_cast<double>(along_);
  }
  std::size_t slots = 64;
  while (slots < 2 * spheres_.size()) slots *= 2;
  first_.assign(slots + 1, 0);
  for (const Sphere& sphere : spheres_) for_cells(sphere, [&](std::size_t at) { ++first_[at + 1]; });
  for (std::size_t k = 0; k < slots; ++k) first_[k + 1] += first_[k];
  members_.resize(static_cast<std::size_t>(first_.back()));
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    for_cells(spheres_[i],
              [&](std::size_t at) { members_[static_cast<std::size_t>(next[at]++)] = static_cast<Index>(i); });
  }
  widened_.clear();
}

/// The nearest image of a difference of places, as it is without the shear since t = 0.
Vec3<double> SphereContacts::nearest(Vec3<double> d) const {
  d = box_.minimum_image(d);
  for (int k = 0; k < 3; ++k) {
    if (box_.is_periodic() && 2 * d[k] >= box_.edges()[k]) d[k] -= box_.edges()[k];  // one of two that are as near
  }
  return d;
}

bool SphereContacts::within_reach(const Sphere& one, const Sphere& other) const {
  Vec3<double> d = nearest(other.centre - one.centre);
  d[1] -= slope_ * d[0];
  if (box_.is_periodic()) d[1] -= box_.edges()[1] * std::nearbyint(d[1] / box_.edges()[1]);
  const double reach = one.reach + other.reach;
  return d.squaredNorm() <= reach * reach;
}

/// Others that a sphere can meet in this window, in the order of their rows.
/// @param all  or those of larger rows only
void SphereContacts::candidates(Index i, bool all, std::vector<Index>& found) const {
  found.clear();
  const Sphere& sphere = spheres_[static_cast<std::size_t>(i)];
  const auto take = [&](Index j) {
    if (j == i || (!all && j < i)) return;
    if (radii_[i] + radii_[j] == 0) return;
    if (within_reach(sphere, spheres_[static_cast<std::size_t>(j)])) found.push_back(j);
  };
  for_cells(sphere, [&](std::size_t at) {
    for (std::int32_t k = first_[at]; k < first_[at + 1]; ++k) take(members_[static_cast<std::size_t>(k)]);
  });
  for (const Index j : widened_) take(j);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

void SphereContacts::fly(Sphere& sphere, double time) const {
  if (time == sphere.time) return;
  const auto epicycle = Epicycle<double>::plain(rates_, time - sphere.time);
  auto change = epicycle.change_in_shear(height(sphere), sphere.v);
  if (box_.is_periodic()) change.x[0] = box_.on_grid(0, change.x[0]);
  change.x[1] += slope_at(time) * change.x[0];
  for (int k = 0; k < 3; ++k) {
    if (box_.is_periodic()) {
      box_.shift(k, change.x[k], sphere.x[k], sphere.image[k]);
    } else {
      sphere.x[k] += change.x[k];
    }
  }
  sphere.v += change.v;
  sphere.time = time;
}

/// From one sphere to the other, both at a time, in space and not in coordinates that do not shear.
SphereContacts::Difference SphereContacts::difference(const Sphere& one, const Sphere& other, double time) const {
  Difference made{nearest(other.x - one.x), other.v - one.v};
  made.d[1] -= slope_at(time) * made.d[0];
  if (box_.is_periodic()) {
    const Vec3<double>& edges = box_.edges();
    made.d[1] -= edges[1] * std::nearbyint(made.d[1] / edges[1]);
    made.lift = edges[2] * std::nearbyint((made.d[2] - (height(other) - height(one))) / edges[2]);
  }
  made.u[1] -= shear_ * made.d[0];
  return made;
}

/// The first time in (0, left] at which a difference on its epicycle has come down to a length; a difference that is no
/// longer than that is let go first. |d|^2 has its value and slope at one time, and nowhere ahead bends down more than
/// c: the first root of that parabola lies before the one that is sought, or there is none.
std::optional<double> SphereContacts::first_root(const Difference& now, double distance, double left) const {
  const double Omega = rates_.Omega, Omega_z = rates_.Omega_z;
  const double w = now.u[1] + shear_ * now.d[0], guide = now.d[0] + 2 * w / Omega, above = now.d[2] - now.lift;
  const double bend2 = 4 * Omega * Omega * (now.u[0] * now.u[0] + 4 * w * w) +
                       Omega_z * Omega_z * (now.u[2] * now.u[2] + Omega_z * Omega_z * above * above);
  const double bend = std::sqrt(bend2);
  const double radius2 = distance * distance, target2 = std::min(radius2, now.d.squaredNorm());
  Vec3<double> d = now.d, u = now.u;
  double t = 0;
  while (true) {
    const double d2 = d.squaredNorm(), gap = std::max(d2 - target2, 0.0), slope = 2 * d.dot(u);
    if (gap <= touching * radius2 && slope < 0) return t;
    if (!(t < left)) return {};
    const double length = std::sqrt(d2), pace = u.norm();
    const double ahead =
        std::min(left - t, std::max(bend > 0 ? 0.5 * pace / bend : left, 0.05 / std::max(Omega, Omega_z)));
    const double slowest = std::max(0.0, pace - bend * ahead);
    const double c = 2 * slowest * slowest - 2 * bend * (length + pace * ahead + bend * ahead * ahead / 2);
    const double inside = slope * slope - 2 * c * gap;
    double step = ahead;
    if (slope < 0 && inside >= 0) {
      step = 2 * gap / (std::sqrt(inside) - slope);
    } else if (slope >= 0 && c < 0) {
      step = (slope + std::sqrt(inside)) / -c;
    }
    // No step is so short that times do not show it.
    t = std::min(left, t + std::max(std::min(step, ahead), 1e-15 * left));
    const double r = Omega * t, s = std::sin(r), half = std::sin(r / 2), one_less = 2 * half * half,
                 cosine = 1 - one_less;
    const double w_now = w * cosine - now.u[0] / 2 * s, v_now = now.u[0] * cosine + 2 * w * s;
    d[0] = now.d[0] + (now.u[0] * s + 2 * w * one_less) / Omega;
    d[1] = now.d[1] - shear_ * guide * t + (4 * w * s - 2 * now.u[0] * one_less) / Omega;
    u[0] = v_now;
    u[1] = w_now - shear_ * d[0];
    if (Omega_z > 0) {
      const double sz = std::sin(Omega_z * t), cz = std::cos(Omega_z * t);
      d[2] = now.lift + (above * cz + now.u[2] * sz / Omega_z);
      u[2] = now.u[2] * cz - above * Omega_z * sz;
    } else {
      d[2] = now.d[2] + now.u[2] * t;
    }
  }
}

/// When two spheres will meet, if they do before the window ends and meet nobody else before.
std::optional<double> SphereContacts::meeting(Index i, Index j) const {
  Sphere one = spheres_[static_cast<std::size_t>(i)], other = spheres_[static_cast<std::size_t>(j)];
  const double from = std::max(one.time, other.time);
  fly(one, from);
  fly(other, from);
  const auto after = first_root(difference(one, other, from), radii_[i] + radii_[j], end_ - from);
  if (!after) return {};
  return std::min(from + *after, end_);
}

/// All pairs within reach of each other, and when they meet; blocks of spheres by threads.
void SphereContacts::find_all() {
  const auto n = static_cast<Index>(spheres_.size());
  const auto blocks = static_cast<std::size_t>((n + block_size - 1) / block_size);
  pairs_.resize(blocks);
  found_.resize(blocks);
  for_blocks(n, [&](Index begin, Index end) {
    auto& pairs = pairs_[static_cast<std::size_t>(begin / block_size)];
    auto& found = found_[static_cast<std::size_t>(begin / block_size)];
    pairs.clear();
    found.clear();
    std::vector<Index> others;
    for (Index i = begin; i < end; ++i) {
      candidates(i, false, others);
      for (const Index j : others) {
        pairs.emplace_back(i, j);
        if (const auto time = meeting(i, j)) found.push_back({*time, i, j, 0, 0});
      }
    }
  });
}

double SphereContacts::find(ParticleSystem<double>& s, double h, double slope) {
  spheres_.clear();
  if (s.size() == 0) return h;
  gather(s);
  const bool finite = std::all_of(spheres_.begin(), spheres_.end(),
                                  [](const Sphere& one) { return is_finite(one.x) && is_finite(one.v); });
  if (!finite || !(h > 0)) {
    spheres_.clear();
    return h;  // the run ends as diverged
  }
  slope_ = slope;
  end_ = window(h);
  widening_ = 1 + shear_ * end_;
  double mean = 0;
  for (const Sphere& sphere : spheres_) mean += speed(sphere) / static_cast<double>(spheres_.size());
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    Sphere& sphere = spheres_[i];
    // Spheres are sped up by others.
    sphere.path = end_ * std::max(1.25 * speed(sphere), 1.5 * mean);
    sphere.reach = (radii_[static_cast<Index>(i)] + sphere.path) * widening_;
  }
  sort_into_cells();
  find_all();
  const bool none = std::all_of(found_.begin(), found_.end(), [](const auto& block) { return block.empty(); });
  if (none) return end_;
  beside_.resize(spheres_.size());
  for (auto& others : beside_) others.clear();
  queue_ = {};
  for (const auto& block : pairs_) {
    for (const auto& [i, j] : block) {
      beside_[static_cast<std::size_t>(i)].push_back(j);
      beside_[static_cast<std::size_t>(j)].push_back(i);
    }
  }
  for (const auto& block : found_) {
    for (const Contact& contact : block) queue_.push(contact);
  }
  while (!queue_.empty() && queue_.top().time <= end_ && !piles_up()) {
    const Contact next = queue_.top();
    queue_.pop();
    const bool stale = spheres_[static_cast<std::size_t>(next.i)].contacts != next.of_i ||
                       spheres_[static_cast<std::size_t>(next.j)].contacts != next.of_j;
    if (!stale) meet(s, next);
  }
  for (Sphere& sphere : spheres_) {
    if (sphere.touched) fly(sphere, end_);
  }
  return end_;
}

/// Brings two spheres to their contact, lets them rebound, and finds whom each meets next.
void SphereContacts::meet(ParticleSystem<double>& s, const Contact& contact) {
  ++met_;
  for (const Index k : {contact.i, contact.j}) {
    Sphere& sphere = spheres_[static_cast<std::size_t>(k)];
    sphere.path -= speed(sphere) * (contact.time - sphere.time);
    fly(sphere, contact.time);
    sphere.touched = true;
    ++sphere.contacts;
  }
  collide(s, contact.i, contact.j);
  look_around(contact.i);
  look_around(contact.j);
  for (const Index k : {contact.i, contact.j}) {
    for (const Index other : beside_[static_cast<std::size_t>(k)]) {
      if (k == contact.j && other == contact.i) continue;
      const auto [i, j] = std::minmax(k, other);
      if (const auto time = meeting(i, j)) {
        queue_.push({*time, i, j, spheres_[static_cast<std::size_t>(i)].contacts,
                     spheres_[static_cast<std::size_t>(j)].contacts});
      }
    }
  }
}

/// The impulse between two spheres along the line of their centres.
void SphereContacts::collide(ParticleSystem<double>& s, Index i, Index j) {
  Sphere &one = spheres_[static_cast<std::size_t>(i)], &other = spheres_[static_cast<std::size_t>(j)];
  const Difference now = difference(one, other, one.time);
  const Vec3<double> n = now.d / now.d.norm();
  const double distance = radii_[i] + radii_[j];
  const double approach = std::max(-now.u.dot(n), 0.0);
  const double rebound = law_.rebound(approach, rates_.Omega * distance / 2000);
  const double mi = s.masses()[i], mj = s.masses()[j];
  const double share = mi == 0 && mj == 0 ? 0.5 : mj / (mi + mj);  // of the change of velocity that i gets
  const bool i_is_light = share > 0.5;
  const double ratio = mi == mj ? 1 : i_is_light ? mi / mj : mj / mi;
  // The heavier one gets what the lighter one does, by their masses: for equal ones the same numbers.
  const Vec3<double> of_light = ((i_is_light ? -share : 1 - share) * (approach + rebound)) * n,
                     of_heavy = -ratio * of_light, &of_i = i_is_light ? of_light : of_heavy,
                     &of_j = i_is_light ? of_heavy : of_light;
  one.v += of_i;
  other.v += of_j;
  const double transport = mj * of_j[1] * now.d[0];
  const double heat = (mi + mj == 0 ? 0 : mi * share) * (approach * approach - rebound * rebound) / 2;
  for (const Index k : {i, j}) {
    s.column<ContactCount>()[k] += 1;
    s.column<ContactTransport>()[k] += transport / 2;
    s.column<ContactHeat>()[k] += heat / 2;
  }
}

/// Looks for others again where a contact has made a sphere too fast for the cube that it was to stay in.
void SphereContacts::look_around(Index i) {
  Sphere& sphere = spheres_[static_cast<std::size_t>(i)];
  const double speed = this->speed(sphere);
  if (speed * (end_ - sphere.time) <= sphere.path) return;
  if (box_.is_periodic()) {
    // As long as it sees one image of each other sphere alone.
    const double most = share_of_edge * box_.edges().minCoeff() / 2 / widening_ - radii_[i];
    end_ = std::min(end_, sphere.time + most / (1.25 * speed));
  }
  sphere.path = 1.25 * speed * (end_ - sphere.time);
  sphere.reach = (radii_[i] + sphere.path) * widening_;
  sphere.centre = sphere.x;
  std::vector<Index> others;
  candidates(i, true, others);
  if (std::find(widened_.begin(), widened_.end(), i) == widened_.end()) widened_.push_back(i);
  auto& mine = beside_[static_cast<std::size_t>(i)];
  for (const Index j : others) {
    if (std::find(mine.begin(), mine.end(), j) != mine.end()) continue;
    mine.push_back(j);
    beside_[static_cast<std::size_t>(j)].push_back(i);
  }
}

void SphereContacts::put(ParticleSystem<double>& s) const {
  for (Index i = 0; i < static_cast<Index>(spheres_.size()); ++i) {
    const Sphere& sphere = spheres_[static_cast<std::size_t>(i)];
    if (!sphere.touched) continue;
    Vec3<double> x = sphere.x, v = sphere.v;
    if (box_.is_periodic()) {
      for (int k = 0; k < 3; ++k) s.images().component(k)[i] = sphere.image[k];
    } else {
      x[1] -= slope_at(end_) * x[0];
      v[1] -= shear_ * x[0];
    }
    s.positions().set(i, x);
    s.velocities().set(i, v);
    if (s.low_words() != nullptr) {
      s.low_words()->x.set(i, Vec3<double>::Zero());
      s.low_words()->v.set(i, Vec3<double>::Zero());
    }
  }
}

void SphereContacts::refuse_overlaps(const ParticleSystem<double>& s) {
  // A run that goes on was looked at when it began, and its places may be those before a stage that is pending.
  if (largest_ == 0 || s.phase().opened) return;
  gather(s);
  slope_ = box_.is_periodic() ? shear_ * s.time() : 0;
  widening_ = 1;
  for (Index i = 0; i < s.size(); ++i) {
    Sphere& sphere = spheres_[static_cast<std::size_t>(i)];
    if (!is_finite(sphere.x)) return;  // told elsewhere
    if (box_.is_periodic()) {
      std::int32_t image = 0;
      box_.shift(1, slope_ * sphere.x[0], sphere.x[1], image);
    }
    sphere.centre = sphere.x;
    sphere.reach = radii_[i];
  }
  sort_into_cells();
  std::vector<Index> others;
  for (Index i = 0; i < s.size(); ++i) {
    candidates(i, false, others);
    for (const Index j : others) {
      const double touch = radii_[i] + radii_[j];
      Difference now = difference(spheres_[static_cast<std::size_t>(i)], spheres_[static_cast<std::size_t>(j)], 0);
      const double distance = now.d.norm();
      if (distance >= touch * (1 - overlap_of_files)) continue;
      throw Error(fmt::format("'{}' and '{}' overlap: they are {} apart, and their radii add up to {}; move them apart",
                              s.name(i), s.name(j), distance, touch));
    }
  }
}

}  // namespace noether
