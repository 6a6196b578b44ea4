#include "engine/saved_state.hpp"

namespace noether {

namespace {

template <class Real> std::vector<double> flatten(const VectorColumn<Real>& column) {
  std::vector<double> numbers;
  for (Index i = 0; i < column.size(); ++i) detail::append(numbers, Vec3<Real>(column[i]));
  return numbers;
}

template <class Real> void unflatten(const SavedState& saved, const std::string& name, VectorColumn<Real>& column) {
  const std::vector<double>& numbers = detail::array_of<double>(saved, name);
  std::size_t at = 0;
  for (Index i = 0; i < column.size(); ++i) {
    Vec3<Real> v;
    detail::take(numbers, at, v);
    column.set(i, v);
  }
}

/// What parts declared beyond x, v and m: "column/charge" and the like, and what each of them is.
template <class Real> void save_columns(SavedState& saved, const ParticleSystem<Real>& s) {
  if (s.columns().empty()) return;
  std::vector<std::string> names, dimensions;
  std::vector<std::int64_t> kinds;
  std::vector<double> starts;
  for (const auto& column : s.columns()) {
    names.push_back(column.info.name);
    dimensions.push_back(column.info.dimension);
    kinds.insert(kinds.end(), {static_cast<std::int64_t>(column.info.role), column.info.width, column.is_whole()});
    starts.insert(starts.end(), column.info.start.begin(), column.info.start.end());
    saved["column/" + column.info.name] = column.visit([](const auto& values) -> SavedArray {
      using Number = std::decay_t<decltype(values.component(0)[0])>;
      using Kept = std::conditional_t<std::is_same_v<Number, std::int64_t>, std::int64_t, double>;
      std::vector<Kept> numbers;
      for (Index i = 0; i < values.size(); ++i) {
        for (int k = 0; k < values.width; ++k) detail::append(numbers, values.component(k)[i]);
      }
      return numbers;
    });
  }
  saved["columns/name"] = std::move(names);
  saved["columns/dimension"] = std::move(dimensions);
  saved["columns/kind"] = std::move(kinds);
  saved["columns/start"] = std::move(starts);
}

template <class Real> void load_columns(const SavedState& saved, ParticleSystem<Real>& s) {
  if (saved.count("columns/name") == 0) return;
  const auto& names = detail::array_of<std::string>(saved, "columns/name");
  const auto& dimensions = detail::array_of<std::string>(saved, "columns/dimension");
  const auto& kinds = detail::array_of<std::int64_t>(saved, "columns/kind");
  const auto& starts = detail::array_of<double>(saved, "columns/start");
  for (std::size_t c = 0; c < names.size(); ++c) {
    const std::int64_t width = detail::element(kinds, 3 * c + 1);
    ColumnInfo info{names[c], detail::element(dimensions, c),
                    detail::enumerator(detail::element(kinds, 3 * c), ColumnRole::momentum), static_cast<int>(width)};
    for (std::size_t k = 0; k < info.start.size(); ++k) info.start[k] = detail::element(starts, 9 * c + k);
    const bool whole = detail::element(kinds, 3 * c + 2) != 0;
    using Values = typename Columns<Real>::Values;
    auto values = whole ? Values(ScalarColumn<std::int64_t>(s.size())) : Columns<Real>::values_of(info.width, s.size());
    std::visit(
        [&](auto& column) {
          using Number = std::decay_t<decltype(column.component(0)[0])>;
          using Kept = std::conditional_t<std::is_same_v<Number, std::int64_t>, std::int64_t, double>;
          const auto& numbers = detail::array_of<Kept>(saved, "column/" + names[c]);
          std::size_t at = 0;
          for (Index i = 0; i < column.size(); ++i) {
            for (int k = 0; k < column.width; ++k) detail::take(numbers, at, column.component(k)[i]);
          }
        },
        values);
    s.restore_column({std::move(info), std::move(values)});
  }
}

/// The periodic box and how often each particle has crossed it; a run in open space has saved none.
template <class Real> void save_box(SavedState& saved, const ParticleSystem<Real>& s) {
  if (!s.box().is_periodic()) return;
  const Vec3<double>& edges = s.box().edges();
  saved["box"] = std::vector<double>{edges[0], edges[1], edges[2]};
  std::vector<std::int64_t> images;
  for (Index i = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k) images.push_back(s.images().component(k)[i]);
  }
  saved["image"] = std::move(images);
}

template <class Real> void load_box(const SavedState& saved, ParticleSystem<Real>& s) {
  if (saved.count("box") == 0) return;
  const auto& edges = detail::array_of<double>(saved, "box");
  s.set_box(Box::periodic({detail::element(edges, 0), detail::element(edges, 1), detail::element(edges, 2)}));
  const auto& numbers = detail::array_of<std::int64_t>(saved, "image");
  VectorColumn<std::int32_t> images(s.size());
  for (Index i = 0, at = 0; i < s.size(); ++i) {
    for (int k = 0; k < 3; ++k, ++at) {
      images.component(k)[i] = static_cast<std::int32_t>(detail::element(numbers, static_cast<std::size_t>(at)));
    }
  }
  s.restore_images(std::move(images));
}

template <class Real> Clock<Real> load_clock(const SavedState& saved) {
  const auto& counts = detail::array_of<std::int64_t>(saved, "clock/counts");
  const auto& times = detail::array_of<double>(saved, "clock/times");
  typename Clock<Real>::Raw raw{.mode = detail::enumerator(detail::element(counts, 0), ClockMode::free),
                                .step = detail::element(counts, 1),
                                .start = detail::element(times, 0),
                                .dt = detail::element(times, 1),
                                .high = detail::element(times, 2),
                                .low = detail::element(times, 3),
                                .fraction = Real(0),
                                .direction = detail::enumerator(detail::element(counts, 2), Direction::backward)};
  load_value(saved, "clock/fraction", raw.fraction);
  return Clock<Real>::from_raw(raw);
}

/// Variables of a first-order system; a run of particles has saved none.
template <class Real> void load_variables(const SavedState& saved, ParticleSystem<Real>& s) {
  std::vector<Real> values;
  std::vector<std::string> names;
  if (saved.count("variables") != 0) load_value(saved, "variables", values);
  if (saved.count("variable_names") != 0) load_value(saved, "variable_names", names);
  if (!names.empty() && names.size() != values.size()) {
    throw Error("the saved state has " + std::to_string(values.size()) + " variables and names for " +
                std::to_string(names.size()));
  }
  s.set_variables(std::move(values), std::move(names));
}

Phase load_phase(const SavedState& saved) {
  const auto& phase = detail::array_of<std::int64_t>(saved, "phase");
  // Which coordinates there are only the Hamiltonian knows.
  return {.coordinates = detail::enumerator(detail::element(phase, 0), std::uint8_t{255}),
          .opened = detail::element(phase, 1) != 0,
          .pending = detail::element(phase, 2) != 0};
}

}  // namespace

template <class Real> SavedState save_particles(const ParticleSystem<Real>& s) {
  SavedState saved;
  std::vector<double> masses;
  for (const Real& m : s.masses()) detail::append(masses, m);
  saved["id"] = s.ids();
  saved["name"] = s.names();
  saved["mass"] = std::move(masses);
  saved["position"] = flatten(s.positions());
  saved["velocity"] = flatten(s.velocities());
  if (s.low_words() != nullptr) {
    saved["position_low"] = flatten(s.low_words()->x);
    saved["velocity_low"] = flatten(s.low_words()->v);
  }
  const auto clock = s.clock().raw();
  saved["clock/counts"] = std::vector<std::int64_t>{static_cast<std::int64_t>(clock.mode), clock.step,
                                                    static_cast<std::int64_t>(clock.direction)};
  saved["clock/times"] = std::vector<double>{clock.start, clock.dt, clock.high, clock.low};
  save_value(saved, "clock/fraction", clock.fraction);
  saved["phase"] =
      std::vector<std::int64_t>{s.phase().coordinates, s.phase().opened ? 1 : 0, s.phase().pending ? 1 : 0};
  saved["units"] = std::vector<std::string>{std::string(s.units().name)};
  saved["next_id"] = std::vector<std::int64_t>{s.next_id()};
  if (!s.variables().empty()) save_value(saved, "variables", s.variables());
  if (!s.variable_names().empty()) saved["variable_names"] = s.variable_names();
  save_box(saved, s);
  save_columns(saved, s);
  return saved;
}

template <class Real> ParticleSystem<Real> load_particles(const SavedState& saved) {
  ParticleSystem<Real> s(unit_system(detail::element(detail::array_of<std::string>(saved, "units"), 0)));
  const auto& ids = detail::array_of<std::int64_t>(saved, "id");
  const auto& names = detail::array_of<std::string>(saved, "name");
  const auto& masses = detail::array_of<double>(saved, "mass");
  std::size_t at = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Real m{};
    detail::take(masses, at, m);
    s.add(detail::element(names, i), m, Vec3<Real>::Zero(), Vec3<Real>::Zero());
  }
  s.restore_ids(ids);
  s.restore_next_id(detail::element(detail::array_of<std::int64_t>(saved, "next_id"), 0));
  load_box(saved, s);
  unflatten(saved, "position", s.positions());
  unflatten(saved, "velocity", s.velocities());
  if (saved.count("position_low") != 0) {
    s.keep_low_words(true);
    unflatten(saved, "position_low", s.low_words()->x);
    unflatten(saved, "velocity_low", s.low_words()->v);
  }
  s.clock() = load_clock<Real>(saved);
  s.phase() = load_phase(saved);
  load_variables(saved, s);
  load_columns(saved, s);
  return s;
}

template SavedState save_particles(const ParticleSystem<double>&);
template SavedState save_particles(const ParticleSystem<Quad>&);
template ParticleSystem<double> load_particles(const SavedState&);
template ParticleSystem<Quad> load_particles(const SavedState&);

}  // namespace noether
