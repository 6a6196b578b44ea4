#pragma once
/// The columns that parts declare beyond position, velocity and mass: charges, orientations, spins.

#include "engine/column.hpp"
#include "numbers/error.hpp"
#include "numbers/fresh_version.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace noether {

/// Whether flows change a column, and whether forces look at it.
enum class ColumnRole : std::uint8_t {
  parameter,      ///< fixed while a run goes on; forces look at it
  configuration,  ///< moves as positions do: forces look at it
  momentum        ///< moves as velocities do: forces of potentials do not depend on it
};

/// What is known of a column by name.
struct ColumnInfo {
  std::string name;       ///< as files and scenes call it
  std::string dimension;  ///< of its numbers, as descriptions write dimensions: "charge", "1", "mass length^2/time"
  ColumnRole role = ColumnRole::parameter;
  int width = 1;                     ///< numbers of a particle: 1, 3, 4 or 9
  std::array<double, 9> start = {};  ///< those of a particle that nobody has given any; the first `width` count

  /// Whether it is state: copied at every look, held in files frame by frame, part of the digest.
  bool moves() const { return role != ColumnRole::parameter; }
  bool operator==(const ColumnInfo&) const = default;
};

/// @throws Error  where two columns of one name differ in anything else: two parts would write over each other
void expect_same_meaning(const ColumnInfo& one, const ColumnInfo& other);

/// What a part declares of the column that it needs:
///
///     struct Orientation {
///       template <class Real> using type = RowColumn<Real, 4>;  // or ScalarColumn, VectorColumn, RowColumn<Real, 9>
///       static constexpr std::string_view name = "orientation", dimension = "1";
///       static constexpr ColumnRole role = ColumnRole::configuration;
///       static constexpr std::array<double, 4> start = {1, 0, 0, 0};  // optional; zeros unless given
///     };
template <class Tag> ColumnInfo column_info() {
  ColumnInfo info{std::string(Tag::name), std::string(Tag::dimension), Tag::role, Tag::template type<double>::width};
  if constexpr (requires { Tag::start; }) {
    static_assert(std::tuple_size_v<std::remove_cvref_t<decltype(Tag::start)>> ==
                  static_cast<std::size_t>(Tag::template type<double>::width));
    std::copy(Tag::start.begin(), Tag::start.end(), info.start.begin());
  }
  return info;
}

/// The columns that a part declares: `using columns = ColumnList<Orientation, Spin>;`.
template <class... Tags> struct ColumnList {
  static std::vector<ColumnInfo> infos() { return {column_info<Tags>()...}; }
};

/// Those of a part; none unless it declares some.
template <class Part> std::vector<ColumnInfo> columns_of() {
  if constexpr (requires { typename Part::columns; }) return Part::columns::infos();
  return {};
}

/// Columns by name, in the order of their names, each with as many rows as there are particles.
///
/// A loop over them serves copies, checks for finite numbers, checkpoints, digests, frames, adding and removing
/// particles; who needs a column's numbers by name looks it up once for each evaluation.
template <class Real> class Columns {
 public:
  using Values = std::variant<ScalarColumn<Real>, ScalarColumn<std::int64_t>, VectorColumn<Real>, RowColumn<Real, 4>,
                              RowColumn<Real, 9>>;
  struct Column {
    ColumnInfo info;
    Values values;

    /// Calls `visit(column)` with the numbers themselves: each has `component(k)` for k < width.
    template <class Visit> decltype(auto) visit(const Visit& visitor) const { return std::visit(visitor, values); }
    bool is_whole() const { return std::holds_alternative<ScalarColumn<std::int64_t>>(values); }
  };

  bool empty() const { return columns_.empty(); }
  std::size_t size() const { return columns_.size(); }
  auto begin() const { return columns_.begin(); }
  auto end() const { return columns_.end(); }
  /// The column of a name; null if there is none.
  const Column* find(std::string_view name) const {
    const auto found = std::find_if(begin(), end(), [&](const Column& column) { return column.info.name == name; });
    return found == end() ? nullptr : &*found;
  }
  /// Whether some of them are state.
  bool any_moves() const {
    return std::any_of(begin(), end(), [](const Column& column) { return column.info.moves(); });
  }
  std::vector<ColumnInfo> infos() const {
    std::vector<ColumnInfo> all;
    for (const Column& column : columns_) all.push_back(column.info);
    return all;
  }

  /// Puts a column of `n` rows in its place among the others, each row as the declaration starts it.
  /// @throws Error  where a column of the same name means something else
  template <class Tag> typename Tag::template type<Real>& add(Index n) {
    using Type = typename Tag::template type<Real>;
    expect_same(column_info<Tag>());
    return std::get<Type>(put(started(column_info<Tag>(), Type(n))).values);
  }
  /// The same for a column known by name.
  Column& add(const ColumnInfo& info, Index n) {
    expect_same(info);
    return put(started(info, values_of(info.width, n)));
  }
  /// @throws Error  where a column of the same name means something else
  void expect_same(const ColumnInfo& info) const {
    if (const Column* found = find(info.name)) expect_same_meaning(found->info, info);
  }
  /// `n` rows of zeros, of so many numbers each. @throws Error  unless these are 1, 3, 4 or 9
  static Values values_of(int width, Index n) {
    if (width == 1) return ScalarColumn<Real>(n);
    if (width == 3) return VectorColumn<Real>(n);
    if (width == 4) return RowColumn<Real, 4>(n);
    if (width == 9) return RowColumn<Real, 9>(n);
    throw Error("a column has " + std::to_string(width) + " numbers per particle; 1, 3, 4 or 9 are expected");
  }
  /// Puts back a column of a file or a copy, or takes one of the same name away first. References to other columns
  /// hold.
  Column& put(Column column) {
    layout_ = parameters_ = detail::fresh_version();
    const auto place = std::find_if(columns_.begin(), columns_.end(),
                                    [&](const Column& one) { return one.info.name >= column.info.name; });
    if (place != columns_.end() && place->info.name == column.info.name) return *place = std::move(column);
    return *columns_.insert(place, std::move(column));
  }
  /// The numbers of a column, to be changed.
  template <class Tag> typename Tag::template type<Real>& get() {
    if constexpr (Tag::role == ColumnRole::parameter) parameters_ = detail::fresh_version();
    return const_cast<typename Tag::template type<Real>&>(std::as_const(*this).template get<Tag>());
  }
  /// @throws MissingColumn
  template <class Tag> const typename Tag::template type<Real>& get() const {
    const Column* found = find(Tag::name);
    if (found == nullptr) throw MissingColumn("the particles have no column '" + std::string(Tag::name) + "'");
    const auto* values = std::get_if<typename Tag::template type<Real>>(&found->values);
    if (values == nullptr) {
      throw MissingColumn("column '" + std::string(Tag::name) + "' has " + std::to_string(found->info.width) +
                          " numbers per particle where " + std::to_string(Tag::template type<double>::width) +
                          " are expected");
    }
    return *values;
  }

  /// Gives particle `i` its numbers in a column known by name.
  /// @throws MissingColumn  where there is none of that name with so many numbers a particle
  void set_row(std::string_view name, Index i, const std::vector<Real>& numbers) {
    const Column* found = find(name);
    if (found == nullptr || numbers.size() != static_cast<std::size_t>(found->info.width)) {
      throw MissingColumn("the particles have no column '" + std::string(name) + "' of " +
                          std::to_string(numbers.size()) + " numbers");
    }
    parameters_ = detail::fresh_version();
    std::visit(
        [&](auto& values) {
          using Number = std::decay_t<decltype(values.component(0)[0])>;
          for (int k = 0; k < values.width; ++k) {
            values.component(k)[i] = static_cast<Number>(numbers[static_cast<std::size_t>(k)]);
          }
        },
        const_cast<Column*>(found)->values);
  }

  /// A row more in each column, as its declaration starts it.
  void append() {
    layout_ = detail::fresh_version();
    for (Column& column : columns_) {
      std::visit(
          [&](auto& values) {
            using Type = std::decay_t<decltype(values)>;
            if constexpr (Type::width == 1) {
              values.append({});
            } else {
              values.append(Type::Vector::Zero());
            }
            start_row(column, values.size() - 1);
          },
          column.values);
    }
  }
  void erase(Index i) {
    layout_ = detail::fresh_version();
    for (Column& column : columns_) std::visit([&](auto& values) { values.erase(i); }, column.values);
  }
  void trim() {
    for (Column& column : columns_) {
      std::visit(
          [](auto& values) {
            if constexpr (std::decay_t<decltype(values)>::width > 1) values.trim();
          },
          column.values);
    }
  }

  /// Becomes a copy of other columns: of those of the same particles only what may differ is copied.
  /// @cost no allocation where both have the same columns
  void assign(const Columns& other) {
    if (layout_ != other.layout_) {
      *this = other;
      return;
    }
    const bool all = parameters_ != other.parameters_;
    auto theirs = other.columns_.begin();
    for (Column& column : columns_) {
      const Column& from = *theirs++;
      if (!all && !column.info.moves()) continue;
      std::visit([&](auto& mine) { mine.assign(std::get<std::decay_t<decltype(mine)>>(from.values)); }, column.values);
    }
    parameters_ = other.parameters_;
  }

  /// The same columns in another number type; whole numbers stay what they are.
  template <class Other> Columns<Other> as() const {
    Columns<Other> all;
    for (const Column& column : columns_) {
      all.put({column.info, column.visit([](const auto& values) {
                 return typename Columns<Other>::Values(widened<Other>(values));
               })});
    }
    return all;
  }

  /// Bytes of a particle in all of them.
  std::size_t bytes_per_particle() const {
    std::size_t bytes = 0;
    for (const Column& column : columns_) {
      bytes += static_cast<std::size_t>(column.info.width) * (column.is_whole() ? sizeof(std::int64_t) : sizeof(Real));
    }
    return bytes;
  }

 private:
  template <class Other> friend class Columns;

  static Column started(ColumnInfo info, Values values) {
    Column column{std::move(info), std::move(values)};
    const Index n = column.visit([](const auto& of) { return of.size(); });
    for (Index i = 0; i < n; ++i) start_row(column, i);
    return column;
  }
  static void start_row(Column& column, Index i) {
    std::visit(
        [&](auto& values) {
          for (int k = 0; k < values.width; ++k) {
            using Number = std::decay_t<decltype(values.component(k)[i])>;
            values.component(k)[i] = Number(column.info.start[static_cast<std::size_t>(k)]);
          }
        },
        column.values);
  }
  template <class Other> static ScalarColumn<std::int64_t> widened(const ScalarColumn<std::int64_t>& from) {
    return from;
  }
  template <class Other> static ScalarColumn<Other> widened(const ScalarColumn<Real>& from) {
    ScalarColumn<Other> to(from.size());
    widen(from, to);
    return to;
  }
  template <class Other, int w> static RowColumn<Other, w> widened(const RowColumn<Real, w>& from) {
    RowColumn<Other, w> to(from.size());
    widen(from, to);
    return to;
  }
  template <class From, class To> static void widen(const From& from, To& to) {
    using Number = std::decay_t<decltype(to.component(0)[0])>;
    for (int k = 0; k < From::width; ++k) {
      for (Index i = 0; i < from.size(); ++i) to.component(k)[i] = static_cast<Number>(from.component(k)[i]);
    }
  }

  std::list<Column> columns_;  ///< a list: who was given a column keeps it while others are added
  /// Name which columns there are, of how many rows, and what the parameters among them hold.
  std::uint64_t layout_ = 0, parameters_ = 0;
};

}  // namespace noether
