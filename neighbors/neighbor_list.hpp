#pragma once
/// Who is near whom: one list for all pair forces of a system.

#include "engine/neighbor_options.hpp"
#include "engine/particle_system.hpp"
#include "neighbors/cell_grid.hpp"
#include "numbers/parallel.hpp"

#include <atomic>
#include <memory>
#include <vector>

namespace noether {

struct SearchPoints;

/// For every particle all others up to a distance, found anew only when somebody has moved by half of the skin.
///
/// Particles that follow each other in space stand in groups of eight, one for each lane; a group has rows of eight
/// entries, one neighbor for each of its particles. An entry tells where a *record* begins: x, y, z and the type, 32
/// bytes. In a periodic box the images of particles near its faces, or of all particles again and again
/// where the box is small, have records of their own, so that distances need no wrapping. Every pair stands in the
/// lists of both.
///
/// A search sorts particles into cells and lays out records only where somebody has gone far; before that, it looks
/// into the cells of the last one, so much further as anybody can have gone since.
///
/// Pairs that the topology excludes or scales are not listed. What is summed exactly over the entries depends neither
/// on their order nor on when they were found, how the particles were sorted, or how wide the skin is.
/// @cost O(n) for a search and for an update; about 600 bytes for each particle in a liquid, 700 while sorting
/// @source Verlet1967, Allen2017
class NeighborList {
 public:
  static constexpr Index group_size = 8;
  /// Neighbors are sorted into shells by distance; those too far out to have come near since are not handed out.
  static constexpr int shells = 4;

  explicit NeighborList(double range = 0, NeighborOptions options = {}) : range_(range), options_(options) {}
  /// A copy looks for neighbors itself.
  NeighborList(const NeighborList& other) : NeighborList(other.range_, other.options_) {}
  NeighborList& operator=(const NeighborList& other) { return *this = NeighborList(other); }
  NeighborList(NeighborList&&) = default;
  NeighborList& operator=(NeighborList&&) = default;
  ~NeighborList() = default;

  double range() const { return range_; }
  const NeighborOptions& options() const { return options_; }
  /// More particles and images than this in the range of one are not listed: nobody could hold such a list.
  static constexpr Index most_neighbors = 32768;
  /// A particle that has more, found by the last search, which has listed nobody then; -1: none.
  Index crowded() const { return crowded_; }

  /// What records are kept in.
  enum class Numbers : std::uint8_t { doubles, whole };

  /// Takes the positions of the particles, which in a periodic box are wrapped, into records of these numbers; searches
  /// if somebody has moved too far. Whole numbers are for a periodic box.
  /// @throws Error  if the box is so small that a particle would have more than 10 000 images
  void update(const ParticleSystem<double>& s, Numbers numbers = Numbers::doubles);

  /// Eight particles and their neighbors. A lane without a particle has -1 in `particles`.
  struct Group {
    const std::int32_t* particles;  ///< their indices
    const std::int32_t* records;    ///< where their own records begin, in doubles
    const std::int32_t* entries;    ///< shape (rows, 8): the same of neighbors, or of nobody, who is far from all
    Index rows;
  };
  Index groups() const { return static_cast<Index>(row_begin_.size()) - 1; }
  Group group(Index g) const {
    const auto from = static_cast<std::size_t>(g);
    return {particles_.data() + group_size * g, lanes_.data() + group_size * g,
            entries_.data() + row_begin_[from].begin, row_begin_[from].rows[static_cast<std::size_t>(shell_)]};
  }
  /// Rows of a group up to a shell, and the shell up to which `group` hands them out.
  Index rows(Index g, int shell) const {
    return row_begin_[static_cast<std::size_t>(g)].rows[static_cast<std::size_t>(shell)];
  }
  int shell() const { return shell_; }
  /// Of the last search, for what is made of it: no two searches of any lists have the same; 0: there was none.
  std::uint64_t edition() const { return edition_; }
  /// Records, shape (records, 4): x, y, z [length] relative to the middle of the box, and in the
  /// place of a fourth number the type as std::int64_t.
  const double* records() const { return records_.data(); }
  /// Of a record the index of its particle; the record behind the last of these is nobody's.
  const std::vector<std::int32_t>& particles_of_records() const { return source_; }

  /// Records of the same entries in whole numbers, shape (records, 4): x, y, z in whole numbers of `whole_spacing`,
  /// whose differences are right modulo 2^32, and the type. They depend on the box and the range alone, not on when
  /// neighbors were found.
  const std::int32_t* whole_records() const { return whole_records_.data(); }
  /// A power of two [length].
  double whole_spacing() const;

  const NeighborStatistics& statistics() const { return statistics_; }
  /// Counts as its own what a list of some of the particles has done. Pairs and the skin are those of searches of its
  /// own, where it makes any.
  /// @param part  these are of all particles
  void count(const NeighborStatistics& before, const NeighborStatistics& now, double part);

  /// Compares the list with all pairs of particles and their images, whose distances are taken anew: those in range,
  /// and just after a search those up to the skin.
  /// @throws LogicError  naming the first pair that is missing, or that stands there twice
  /// @cost O(n^2)
  void verify(const ParticleSystem<double>& s) const;

 private:
  struct Rows {
    std::int64_t begin = 0;
    std::array<std::int32_t, shells> rows{};  ///< of a shell and those within it
  };
  struct Ghost {
    std::int32_t record, of, shift;
  };
  struct Scratch;
  struct Surroundings;
  class WholeNumbers;

  /// Of the particles in a block of groups, one after the other, the records that are not to be listed, itself first.
  struct Struck {
    std::vector<std::int32_t> records;
    std::array<std::int32_t, block_size + 1> begin{};
  };

  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  double coordinate(Index record, std::size_t axis) const { return records_[at(4 * record) + axis]; }
  bool is_fresh(const ParticleSystem<double>& s) const;
  void move_or_search(const ParticleSystem<double>& s, Numbers numbers);
  void choose_spacing();
  bool has_coarse_spacing(int k) const { return box_.is_periodic() && spacing_[k] > box_.spacing(k); }
  double on_spacing(int k, double x) const { return std::nearbyint(x / spacing_[k]) * spacing_[k]; }
  double take_positions(const ParticleSystem<double>& s, Numbers numbers);
  template <class Put, class Shift>
  double move_records(const ParticleSystem<double>& s, const Put& put, const Shift& shift);
  std::uint64_t& version_of(Numbers numbers) { return versions_[static_cast<std::size_t>(numbers)]; }
  void search(const ParticleSystem<double>& s, double moved, Numbers numbers);
  void sort_into_cells(const ParticleSystem<double>& s);
  void choose_skin();
  void place_points(const ParticleSystem<double>& s, double reach);
  void number_shifts(const std::array<int, 3>& most);
  void add_images(int k, int most, std::int32_t stride, double reach);
  void lay_out(const ParticleSystem<double>& s);
  void set_type(Index record, std::int64_t type);
  void form_groups();
  void give_back();
  void start_here();
  void take_exclusions(const ParticleSystem<double>& s);
  /// Pairs up to this distance when they were found stand in the rows of a shell [length].
  double shell_radius(int shell) const { return range_ + skin_ * (shell + 1) / shells; }
  double reading_error() const;
  bool find_all();
  Surroundings surroundings(const std::array<std::int32_t, group_size>& own) const;
  SearchPoints candidates(const Surroundings& around, Scratch& scratch) const;
  void take_struck();
  Index find(Index group, Scratch& scratch);
  std::int64_t reserve(std::int64_t entries);
  std::size_t bytes() const;

  double range_;
  NeighborOptions options_;
  double skin_ = 0;
  NeighborStatistics statistics_;
  std::uint64_t version_ = 0;                ///< of the positions it was brought up to
  std::array<std::uint64_t, 2> versions_{};  ///< and of those in the records of either numbers
  std::int64_t age_ = 0;                     ///< updates since the last search
  std::uint64_t edition_ = 0;                ///< of the last search
  Index crowded_ = -1;                       ///< see `crowded`
  int shell_ = 0;                            ///< the outermost that can have come into range since

  // What the last search was made for.
  Box box_;
  Vec3<double> middle_ = Vec3<double>::Zero();  ///< of the box, on its grid
  /// What places in records are whole numbers of: the grid of the box, or a coarser one where images reach so far out
  /// that doubles would round them there. Beside it the edges in whole numbers of it; both in periodic boxes alone.
  Vec3<double> spacing_ = Vec3<double>::Zero(), record_edges_ = Vec3<double>::Zero();
  std::uint64_t members_ = 0;
  std::shared_ptr<const Topology> topology_;
  std::array<AlignedVector<double>, 3> start_;  ///< positions then, relative to the middle, by particle

  // Records, and where they come from.
  AlignedVector<double> records_;
  AlignedVector<std::int32_t> whole_records_;  ///< empty unless somebody has asked for them
  bool keep_whole_ = false;
  std::vector<std::int32_t> record_of_;  ///< by particle
  std::vector<Ghost> ghosts_;
  std::vector<Vec3<double>> shifts_;
  std::vector<std::array<std::int32_t, 3>> whole_shifts_;

  // Groups and their rows.
  std::vector<std::int32_t> particles_, lanes_;
  std::vector<Rows> row_begin_;
  AlignedVector<std::int32_t> entries_;
  std::unique_ptr<std::atomic<std::int64_t>> used_ = std::make_unique<std::atomic<std::int64_t>>(0);

  // For the search alone.
  CellGrid grid_;
  double laid_for_ = 0;  ///< how far from the box images have records, and cells are known [length]
  double drift_ = 0;     ///< what a particle has gone at most since it was sorted into its cell [length]
  std::array<AlignedVector<double>, 3> points_;
  std::array<AlignedVector<float>, 3> single_;  ///< of records, at the last search
  std::vector<std::int32_t> owner_, shift_,
      source_;  ///< of a point: its particle and its shift; of a record: its particle
  std::vector<std::int32_t> excluded_begin_, excluded_;
  std::vector<Struck> struck_;                       ///< by block of groups
  std::vector<std::int32_t> image_of_, next_image_;  ///< records of images, by particle and by the one before: -1, none
};

}  // namespace noether
