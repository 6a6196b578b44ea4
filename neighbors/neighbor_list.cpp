#include "neighbors/neighbor_list.hpp"

#include "neighbors/neighbor_images.hpp"
#include "neighbors/neighbor_search_simd.hpp"
#include "numbers/cost_book.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

namespace noether {

namespace {

/// The first skin, and the widest of those chosen by cost, as parts of the range.
constexpr double first_skin = 0.12, widest_skin = 0.64;
/// What a search costs a particle, and each pair that it lists, in pairs that an evaluation goes through: fitted to
/// melts with cutoffs of 1.12 and 2.5 sigma at skins of 0.2 to 0.9 sigma (bench fene_melt, lj_melt).
constexpr double search_cost = 220, search_cost_of_pair = 5;
static_assert(NeighborList::shells == neighbor_shells);
/// What two particles may come nearer to each other, in skins, before particles are sorted into cells again: images are
/// laid out so much further, for who has left the box looks for one that has come towards him. (In melts two searches
/// follow a sort then; more would cost memory.)
constexpr double slack = 2.2;
/// What rounding may take from a distance in doubles, many times over.
constexpr double rounding_of_doubles = 1e-9;
/// Whether images three edges away can come into range.
bool reaches_far(double range, double edge) { return range > 0.75 * edge; }
/// How far a record stands from all others that is nobody's, of the extent of these and the range; and at most, so that
/// squares of distances are numbers [length]. (Further out, high powers of the distance are too small for numbers, and
/// processors take their time over these.)
constexpr double nowhere = 0x1p20, nowhere_at_most = 1e140;
/// The same in whole numbers: the box and its images take up less than half of them, around 0.
constexpr std::int32_t whole_nowhere = std::numeric_limits<std::int32_t>::min();

}  // namespace

/// What one thread needs to find the neighbors of a group.
struct NeighborList::Scratch {
  std::vector<PointRun> runs;
  std::array<AlignedVector<float>, 3> points;  ///< of a group that is far out, relative to it
  std::array<AlignedVector<float>, 3> near;    ///< points that any of the group can see
  AlignedVector<std::int32_t> near_number;
  std::array<AlignedVector<std::int32_t>, group_size> number, found;
  std::array<AlignedVector<float>, group_size> r2;

  void make_room(Index count) {
    const std::size_t size = at(count + 32);
    if (found[0].size() >= size) return;
    for (auto* columns : {&points, &near}) {
      for (auto& column : *columns) column.resize(size + size / 2);
    }
    near_number.resize(size + size / 2);
    for (auto* lists : {&number, &found}) {
      for (auto& list : *lists) list.resize(size + size / 2);
    }
    for (auto& list : r2) list.resize(size + size / 2);
  }
};

void NeighborList::update(const ParticleSystem<double>& s, Numbers numbers) {
  const Spent spent("neighbors");
  if (numbers == Numbers::whole && !keep_whole_) {
    keep_whole_ = true;
    version_ = members_ = 0;  // search anew
  }
  if (version_ != s.version()) {
    move_or_search(s, numbers);
  } else if (version_of(numbers) != version_) {  // another force has asked for the same positions in other numbers
    static_cast<void>(take_positions(s, numbers));
  }
  version_of(numbers) = version_;
  if (!options_.verify || crowded_ >= 0) return;
  numbers == Numbers::doubles ? verify(s) : update(s);
}

void NeighborList::move_or_search(const ParticleSystem<double>& s, Numbers numbers) {
  version_ = s.version();
  ++statistics_.updates;
  ++age_;
  double moved = std::numeric_limits<double>::infinity();  // by any particle since the last search
  bool search_now = !is_fresh(s);
  if (!search_now) {
    moved = std::sqrt(take_positions(s, numbers));
    const double approach = 2 * moved;  // of two particles, at most
    shell_ = 0;
    while (shell_ < shells && !(approach <= shell_radius(shell_) - range_)) ++shell_;
    search_now = options_.renewal > 0 ? age_ >= options_.renewal : shell_ == shells;
    shell_ = std::min(shell_, shells - 1);
  }
  if (!search_now) return;
  const auto begin = std::chrono::steady_clock::now();
  search(s, moved, numbers);
  version_of(Numbers::doubles) = version_;
  if (numbers == Numbers::whole) static_cast<void>(take_positions(s, numbers));
  statistics_.search_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

bool NeighborList::is_fresh(const ParticleSystem<double>& s) const {
  return statistics_.searches > 0 && crowded_ < 0 && box_ == s.box() && topology_ == s.shared_topology() &&
         members_ == s.members();
}

/// The skin that costs least if particles go on moving as fast: what an update costs is the pairs it goes through, and
/// its part of a search.
void NeighborList::choose_skin() {
  double widest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3 && box_.is_periodic(); ++k) {
    // Those in range of a particle that has left the box by half of the skin are no further out than is exact, nor are
    // the shifts that put them there: two edges always are.
    const double edge = box_.edges()[k], exact = std::ldexp(spacing_[k], 53);
    widest = std::min(widest, 2 * (exact - edge / 2 - range_));
    widest = std::min(widest, reaches_far(range_, edge) ? exact - edge - range_ : 2 * edge - range_);
  }
  // Whole numbers have room for images up to twice as far out.
  if (keep_whole_) widest = std::min(widest, range_ + box_.edges().maxCoeff() / 2);
  if (options_.skin > 0) {
    skin_ = std::min(options_.skin, widest);
    return;
  }
  if (skin_ == 0 || age_ <= 1) {
    skin_ = std::min(std::max(skin_, first_skin * range_), widest);
    return;
  }
  const double speed = skin_ / static_cast<double>(age_);
  double best = skin_, least = std::numeric_limits<double>::infinity();
  for (int k = 1; k <= 64; ++k) {
    const double skin = widest_skin * range_ * k / 64;
    const double pairs = statistics_.pairs * std::pow((range_ + skin) / (range_ + skin_), 3);
    const double cost = pairs + (search_cost + search_cost_of_pair * pairs) * speed / skin;
    if (cost < least) least = cost, best = skin;
  }
  skin_ = std::min((skin_ + best) / 2, widest);
}

/// Powers of two that depend on box and range alone: images that particles in the box see, as far as the range and
/// more, and the shifts that put them there lie within 2^53 of them, where sums and differences of whole numbers are
/// exact.
void NeighborList::choose_spacing() {
  if (!box_.is_periodic()) return;
  for (int k = 0; k < 3; ++k) {
    const double edge = box_.edges()[k];
    spacing_[k] = box_.spacing(k);
    const double furthest = reaches_far(range_, edge) ? edge + 1.5 * range_ : edge / 2 + 1.25 * range_;
    while (std::ldexp(spacing_[k], 53) < furthest + spacing_[k]) spacing_[k] *= 2;
    record_edges_[k] = on_spacing(k, edge);
  }
}

/// @param moved  what a particle has gone at most since the last search [length]
void NeighborList::search(const ParticleSystem<double>& s, double moved, Numbers numbers) {
  box_ = s.box();
  choose_spacing();
  choose_skin();
  drift_ += moved;
  if (!(range_ + skin_ + 2 * drift_ <= laid_for_)) {
    sort_into_cells(s);
  } else if (numbers != Numbers::doubles) {
    static_cast<void>(take_positions(s, Numbers::doubles));
  }
  start_here();
  while (!find_all()) {
  }
  shell_ = 0;
  static std::atomic<std::uint64_t> editions{0};
  edition_ = ++editions;
  ++statistics_.searches;
  statistics_.skin = skin_;
  statistics_.pairs = s.size() > 0 ? static_cast<double>(*used_) / static_cast<double>(s.size()) : 0;
  statistics_.bytes = bytes();
  age_ = 0;
}

/// Sorts particles and images into cells and lays out their records, for this search and for those that follow before
/// somebody has gone so far that images or cells are not to be relied on.
void NeighborList::sort_into_cells(const ParticleSystem<double>& s) {
  const double reach = range_ + skin_, further = reach + slack * skin_;
  const auto begin = std::chrono::steady_clock::now();
  const bool small = box_.is_periodic() && box_.edges().minCoeff() < 2 * further;  // and more images would be many
  laid_for_ = small ? reach : further;
  drift_ = 0;
  ++statistics_.sorts;
  members_ = s.members();
  if (topology_ != s.shared_topology() || statistics_.searches == 0) {
    topology_ = s.shared_topology();
    take_exclusions(s);
  }
  place_points(s, laid_for_ * (1 + rounding_of_doubles));
  grid_.sort({points_[0].data(), points_[1].data(), points_[2].data()}, static_cast<Index>(owner_.size()), reach);
  lay_out(s);
  form_groups();
  take_struck();
  give_back();
  statistics_.sort_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Memory that only sorting needs: as much as a sixth of the list.
void NeighborList::give_back() {
  points_ = {};
  owner_ = std::vector<std::int32_t>();  // not {}, an empty list of numbers, which would leave the memory where it is
  shift_ = std::vector<std::int32_t>();
  grid_.forget_order();
}

std::size_t NeighborList::bytes() const {
  const auto of = [](const auto&... vectors) {
    return (std::size_t{0} + ... + (vectors.capacity() * sizeof(*vectors.data())));
  };
  std::size_t sum =
      grid_.bytes() + of(records_, whole_records_, record_of_, ghosts_, shifts_, particles_, lanes_, row_begin_,
                         entries_, owner_, shift_, source_, excluded_begin_, excluded_, image_of_, next_image_);
  for (std::size_t k = 0; k < 3; ++k) sum += of(start_[k], points_[k], single_[k]);
  sum += struck_.capacity() * sizeof(Struck);
  for (const Struck& block : struck_) sum += of(block.records);
  return sum;
}

/// The particles, and their images up to `reach` from the box.
void NeighborList::place_points(const ParticleSystem<double>& s, double reach) {
  const Index n = s.size();
  NOETHER_EXPECTS(n < std::numeric_limits<std::int32_t>::max() / 64, "a neighbor list is for less than 2^25 particles");
  for (int k = 0; k < 3; ++k) {
    if (box_.is_periodic())
      middle_[k] = box_.on_grid(k, std::floor(box_.edges()[k] / box_.spacing(k) / 2) * box_.spacing(k));
    points_[at(k)].resize(at(n));
  }
  owner_.resize(at(n));
  shift_.assign(at(n), 0);
  for_blocks(n, [&](Index begin, Index end) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int axis = static_cast<int>(k);
      const double* x = s.positions().component(axis);
      for (Index i = begin; i < end; ++i) points_[k][at(i)] = x[i] - middle_[axis];
      if (!has_coarse_spacing(axis)) continue;
      for (Index i = begin; i < end; ++i) points_[k][at(i)] = on_spacing(axis, points_[k][at(i)]);
    }
    for (Index i = begin; i < end; ++i) owner_[at(i)] = static_cast<std::int32_t>(i);
  });
  shifts_.assign(1, Vec3<double>::Zero());
  if (!box_.is_periodic()) return;
  check_images(box_, range_, skin_);
  // Images along x, then of all these along y, then along z: each particle is asked for few of them.
  std::array<int, 3> most{};
  for (int k = 0; k < 3; ++k) most[at(k)] = static_cast<int>(std::ceil(reach / box_.edges()[k]));
  number_shifts(most);
  std::int32_t stride = 1;
  std::fill(shift_.begin(), shift_.end(), static_cast<std::int32_t>(shifts_.size() / 2));
  for (int k = 0; k < 3; ++k) {
    add_images(k, most[at(k)], stride, reach);
    stride *= 2 * most[at(k)] + 1;
  }
}

/// Images, shifted along one axis, of all points so far that lie up to `reach` from the box.
void NeighborList::add_images(int k, int most, std::int32_t stride, double reach) {
  const double lower = -middle_[k] - reach, upper = box_.edges()[k] - middle_[k] + reach;
  const auto count = static_cast<Index>(owner_.size());
  std::vector<std::size_t> places(at(count / block_size + 2));  // where the images of a block of points begin
  for (int a = -most; a <= most; ++a) {
    if (a == 0) continue;
    const double by = a * record_edges_[k];
    const auto is_near = [&](Index p) {
      const double x = points_[at(k)][at(p)] + by;
      return x >= lower && x <= upper;
    };
    for_blocks(count, [&](Index begin, Index end) {
      std::size_t images = 0;
      for (Index p = begin; p < end; ++p) images += is_near(p) ? 1 : 0;
      places[at(begin / block_size + 1)] = images;
    });
    places[0] = owner_.size();
    std::partial_sum(places.begin(), places.end(), places.begin());
    const std::size_t size = places[at((count + block_size - 1) / block_size)];
    for (auto& column : points_) column.resize(size);
    owner_.resize(size);
    shift_.resize(size);
    for_blocks(count, [&](Index begin, Index end) {
      std::size_t place = places[at(begin / block_size)];
      for (Index p = begin; p < end; ++p) {
        if (!is_near(p)) continue;
        for (int c = 0; c < 3; ++c) points_[at(c)][place] = points_[at(c)][at(p)] + (c == k ? by : 0);
        owner_[place] = owner_[at(p)];
        shift_[place++] = shift_[at(p)] + a * stride;
      }
    });
  }
}

void NeighborList::set_type(Index record, std::int64_t type) {
  std::memcpy(&records_[at(4 * record + 3)], &type, sizeof type);
  if (keep_whole_) whole_records_[at(4 * record + 3)] = static_cast<std::int32_t>(type);
}

/// Records in the order of the cells; behind them one that is nowhere.
void NeighborList::lay_out(const ParticleSystem<double>& s) {
  const Index n = s.size();
  const auto& order = grid_.order();
  const auto count = static_cast<Index>(order.size());
  const Topology* topology = s.topology();
  records_.resize(at(4 * (count + 1)));
  whole_records_.resize(keep_whole_ ? records_.size() : 0);
  record_of_.resize(at(n));
  source_.resize(at(count));
  image_of_.assign(excluded_.empty() ? 0 : at(n), -1);
  next_image_.resize(excluded_.empty() ? 0 : at(count));
  ghosts_.clear();
  for_blocks(count, [&](Index begin, Index end) {
    for (Index r = begin; r < end; ++r) {
      const std::int32_t point = order[at(r)], owner = owner_[at(point)];
      for (int k = 0; k < 3; ++k) records_[at(4 * r + k)] = points_[at(k)][at(point)];
      set_type(r, topology != nullptr ? topology->type(owner) : 0);
      source_[at(r)] = owner;
      if (point < n) record_of_[at(owner)] = static_cast<std::int32_t>(r);
    }
  });
  for (Index r = 0; r < count; ++r) {
    const std::int32_t point = order[at(r)];
    if (point < n) continue;
    const std::int32_t owner = source_[at(r)];
    ghosts_.push_back({static_cast<std::int32_t>(r), record_of_[at(owner)], shift_[at(point)]});
    if (!excluded_.empty()) next_image_[at(r)] = std::exchange(image_of_[at(owner)], static_cast<std::int32_t>(r));
  }
  double extent = laid_for_;
  for (Index r = 0; r < count; ++r) {
    for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, std::abs(coordinate(r, k)));
  }
  for (int k = 0; k < 3; ++k) records_[at(4 * count + k)] = std::min(nowhere * extent, nowhere_at_most);
  for (int k = 0; k < 3 && keep_whole_; ++k) whole_records_[at(4 * count + k)] = whole_nowhere;
  set_type(count, 0);
}

/// Takes where everybody is for where the search finds him.
void NeighborList::start_here() {
  const auto records = static_cast<Index>(source_.size()), n = static_cast<Index>(record_of_.size());
  for (std::size_t k = 0; k < 3; ++k) {
    single_[k].resize(at(records + 16));
    start_[k].resize(at(n));
  }
  for_blocks(records, [&](Index begin, Index end) {
    for (Index r = begin; r < end; ++r) {
      for (std::size_t k = 0; k < 3; ++k) single_[k][at(r)] = static_cast<float>(coordinate(r, k));
    }
  });
  for_blocks(n, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < 3; ++k) start_[k][at(i)] = coordinate(record_of_[at(i)], k);
    }
  });
}

/// Groups of particles that follow each other, cut where the next one is far away.
void NeighborList::form_groups() {
  particles_.clear();
  lanes_.clear();
  const auto count = static_cast<std::int32_t>(source_.size());
  const double far = std::max(4 * grid_.edge(), 2 * range_);
  std::int32_t first = 0;
  const auto fill = [&] {  // a lane without a particle stands where the first one does, and has no neighbors
    while (particles_.size() % group_size != 0) {
      particles_.push_back(-1);
      lanes_.push_back(4 * first);
    }
  };
  for (std::int32_t r = 0; r < count; ++r) {
    const std::int32_t i = source_[at(r)];
    if (record_of_[at(i)] != r) continue;  // an image
    if (particles_.size() % group_size != 0) {
      bool near = true;
      for (std::size_t k = 0; k < 3; ++k) near = near && std::abs(coordinate(r, k) - coordinate(first, k)) <= far;
      if (!near) fill();
    }
    if (particles_.size() % group_size == 0) first = r;
    particles_.push_back(i);
    lanes_.push_back(4 * r);
  }
  fill();
  row_begin_.assign(particles_.size() / group_size + 1, Rows{});
}

/// For each particle those whose pair force with it is excluded or scaled.
void NeighborList::take_exclusions(const ParticleSystem<double>& s) {
  excluded_begin_.clear();
  excluded_.clear();
  if (!topology_ || (topology_->exclusions.empty() && topology_->scaled_pairs.empty())) return;
  std::vector<std::pair<std::int32_t, std::int32_t>> both;
  const auto add = [&](const Topology::Pair& pair) {
    both.emplace_back(pair.first, pair.second);
    both.emplace_back(pair.second, pair.first);
  };
  for (const auto& pair : topology_->exclusions) add(pair);
  for (const auto& scaled : topology_->scaled_pairs) add(scaled.pair);
  std::sort(both.begin(), both.end());
  excluded_begin_.assign(at(s.size() + 1), 0);
  for (const auto& [i, j] : both) {
    ++excluded_begin_[at(i + 1)];
    excluded_.push_back(j);
  }
  for (Index i = 0; i < s.size(); ++i) excluded_begin_[at(i + 1)] += excluded_begin_[at(i)];
}

/// Room for so many entries, behind those of other threads; where they stand makes no difference.
std::int64_t NeighborList::reserve(std::int64_t entries) {
  return used_->fetch_add(entries, std::memory_order_relaxed);
}

/// False if there was not room for all; then there is. Where somebody is crowded, groups behind his are left out.
bool NeighborList::find_all() {
  used_->store(0);
  const auto places = static_cast<Index>(particles_.size());
  std::atomic<Index> crowded{places};  // the first such place
  for_blocks(places, [&](Index begin, Index end) {
    thread_local Scratch scratch;
    for (Index g = begin / group_size; g < end / group_size; ++g) {
      Index known = crowded.load();
      if (group_size * g > known) return;
      const Index lane = find(g, scratch);
      if (lane < 0) continue;
      const Index place = group_size * g + lane;
      while (place < known && !crowded.compare_exchange_weak(known, place)) {
      }
    }
  });
  crowded_ = crowded.load() < places ? particles_[at(crowded.load())] : -1;
  if (crowded_ >= 0) {
    row_begin_.assign(row_begin_.size(), Rows{});
    used_->store(0);
    return true;
  }
  const std::size_t needed = at(used_->load());
  if (needed <= entries_.size()) return true;
  entries_ = AlignedVector<std::int32_t>();
  entries_.resize(needed + needed / 32 + 64);
  return false;
}

/// Where neighbors of a group are looked for, in single precision.
struct NeighborList::Surroundings {
  CellGrid::Bounds bounds;
  SearchBox box;
  float limits[shells];  ///< squares of the shells' radii and of what rounding may add to a distance
  /// The group is so far out that single precision tells distances only relative to it.
  bool far;
  std::array<double, 3> origin;
};

/// What distances of whole numbers in single precision may be shorter than true ones: each place is rounded, and so are
/// the edges between two; the rest is that of single precision. [length]
double NeighborList::reading_error() const {
  if (!keep_whole_) return 0;
  return whole_spacing() * (5 + shell_radius(shells - 1) / box_.edges().minCoeff()) + 0x1p-22 * range_;
}

NeighborList::Surroundings NeighborList::surroundings(const std::array<std::int32_t, group_size>& own) const {
  constexpr double rounding = 8 * 0x1p-24, most = 0.02;
  const double reach = shell_radius(shells - 1);
  Surroundings around{};
  double extent = reach, size = reach;
  for (std::size_t k = 0; k < 3; ++k) {
    double lower = std::numeric_limits<double>::infinity(), upper = -lower;
    for (const std::int32_t record : own) {
      lower = std::min(lower, coordinate(record, k));
      upper = std::max(upper, coordinate(record, k));
    }
    around.bounds.lower[k] = lower;
    around.bounds.upper[k] = upper;
    extent = std::max(extent, reach + (upper - lower));
    size = std::max({size, reach + std::abs(lower), reach + std::abs(upper)});
  }
  around.far = !(rounding * size <= most * reach);
  for (std::size_t k = 0; k < 3; ++k) {
    const double half = (around.bounds.upper[k] - around.bounds.lower[k]) / 2, middle = around.bounds.lower[k] + half;
    around.origin[k] = around.far ? middle : 0;
    around.box.middle[k] = static_cast<float>(middle - around.origin[k]);
    around.box.half[k] = static_cast<float>(half);
  }
  const double lost = rounding * (around.far ? extent : size) + reading_error();
  for (int shell = 0; shell < shells; ++shell) {
    const double limit = shell_radius(shell) + lost;
    around.limits[shell] = static_cast<float>(limit * limit * (1 + 0x1p-20));
  }
  return around;
}

/// Runs of records that can be near, and where they are in single precision.
SearchPoints NeighborList::candidates(const Surroundings& around, Scratch& scratch) const {
  Index count = 0;
  scratch.runs.clear();
  grid_.near(around.bounds, shell_radius(shells - 1) * (1 + rounding_of_doubles) + drift_, [&](Index from, Index to) {
    if (from == to) return;
    const auto begin = static_cast<std::int32_t>(from);
    scratch.runs.push_back({begin, static_cast<std::int32_t>(to - from), begin});
    count += to - from;
  });
  scratch.make_room(count);
  if (!around.far) return {single_[0].data(), single_[1].data(), single_[2].data()};
  std::int32_t place = 0;
  for (PointRun& run : scratch.runs) {
    run.begin = place;
    for (std::int32_t record = run.number; record < run.number + run.count; ++record, ++place) {
      for (std::size_t k = 0; k < 3; ++k) {
        scratch.points[k][at(place)] = static_cast<float>(coordinate(record, k) - around.origin[k]);
      }
    }
  }
  return {scratch.points[0].data(), scratch.points[1].data(), scratch.points[2].data()};
}

/// Looks up for blocks of particles whom each is not to have in its list: all of a block at once, for they stand far
/// apart in memory, and one look-up need not wait for the other.
void NeighborList::take_struck() {
  if (excluded_.empty()) return struck_.clear();
  const auto count = static_cast<Index>(particles_.size());
  struck_.resize(at((count + block_size - 1) / block_size));
  for_blocks(count, [&](Index begin, Index end) {
    Struck& struck = struck_[at(begin / block_size)];
    struck.records.clear();
    for (Index place = begin; place < end; ++place) {
      struck.begin[at(place - begin)] = static_cast<std::int32_t>(struck.records.size());
      struck.records.push_back(lanes_[at(place)] / 4);
      const std::int32_t i = particles_[at(place)];
      if (i < 0) continue;
      for (std::int32_t k = excluded_begin_[at(i)]; k < excluded_begin_[at(i + 1)]; ++k) {
        const std::int32_t j = excluded_[at(k)];
        struck.records.push_back(record_of_[at(j)]);
        for (std::int32_t image = image_of_[at(j)]; image >= 0; image = next_image_[at(image)]) {
          struck.records.push_back(image);
        }
      }
    }
    struck.begin[at(end - begin)] = static_cast<std::int32_t>(struck.records.size());
  });
}

/// Lists the neighbors of a group, if there is room; returns the lane of one that has too many, else -1.
Index NeighborList::find(Index group, Scratch& scratch) {
  const NeighborSearchKernels& kernels = neighbor_search_kernels();
  std::array<std::int32_t, group_size> own{};  // their records
  for (Index lane = 0; lane < group_size; ++lane) own[at(lane)] = lanes_[at(group_size * group + lane)] / 4;
  const std::int32_t* particles = particles_.data() + group_size * group;
  const Surroundings around = surroundings(own);
  const SearchPoints points = candidates(around, scratch);
  NearPoints near{scratch.near[0].data(), scratch.near[1].data(), scratch.near[2].data(), scratch.near_number.data(),
                  0};
  const float limit = around.limits[shells - 1];
  kernels.gather(scratch.runs.data(), static_cast<std::ptrdiff_t>(scratch.runs.size()), points, around.box, limit,
                 near);
  std::array<std::ptrdiff_t, group_size> counts{};
  for (std::size_t lane = 0; lane < group_size; ++lane) {
    if (particles[lane] < 0) continue;
    const auto relative = [&](std::size_t k) {
      return static_cast<float>(coordinate(own[lane], k) - around.origin[k]) - around.box.middle[k];
    };
    counts[lane] = kernels.select(near, relative(0), relative(1), relative(2), limit, scratch.number[lane].data(),
                                  scratch.r2[lane].data());
    if (counts[lane] <= most_neighbors) continue;
    const auto range2 = static_cast<float>(range_ * range_);  // whatever the skin is
    const float* r2 = scratch.r2[lane].data();
    if (std::count_if(r2, r2 + counts[lane], [&](float one) { return one < range2; }) > most_neighbors) {
      return static_cast<Index>(lane);
    }
  }
  Rows& place = row_begin_[at(group)];
  std::int32_t within[shells] = {};
  const auto struck = [&](std::size_t lane) -> std::pair<const std::int32_t*, std::ptrdiff_t> {
    if (struck_.empty()) return {&own[lane], 1};
    const Struck& block = struck_[at(group_size * group / block_size)];
    const std::int32_t* begin = block.begin.data() + group_size * group % block_size + static_cast<Index>(lane);
    return {block.records.data() + begin[0], begin[1] - begin[0]};
  };
  for (std::size_t lane = 0; lane < group_size; ++lane) {
    if (particles[lane] < 0) continue;
    const std::int32_t* number = scratch.number[lane].data();
    const auto [out, out_count] = struck(lane);
    counts[lane] = kernels.sort(number, scratch.r2[lane].data(), counts[lane], out, out_count, around.limits,
                                scratch.found[lane].data(), within);
  }
  std::copy_n(within, shells, place.rows.begin());
  const std::ptrdiff_t rows = place.rows[shells - 1];
  const std::ptrdiff_t room = (rows + group_size - 1) / group_size * group_size;
  place.begin = reserve(group_size * room);
  if (place.begin + group_size * room > static_cast<std::int64_t>(entries_.size())) return -1;
  const std::int32_t* lists[group_size];
  for (std::size_t lane = 0; lane < group_size; ++lane) {
    std::int32_t* found = scratch.found[lane].data();
    std::fill(found + counts[lane], found + room, static_cast<std::int32_t>(source_.size()));  // nobody
    lists[lane] = found;
  }
  kernels.turn(lists, rows, entries_.data() + place.begin);
  return -1;
}

}  // namespace noether
