#pragma once
/// State on its way to a checkpoint and back: named arrays, exact.

#include "engine/particle_system.hpp"
#include "numbers/real.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace noether {

/// One named array of a part's state.
using SavedArray = std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::string>>;

/// The state of one part: array by name. Nested parts use names with slashes.
using SavedState = std::map<std::string, SavedArray>;

/// A run as a checkpoint keeps it: raw particles, and the declared state of every part by name.
struct SavedRun {
  SavedState particles;
  std::map<std::string, SavedState> parts;
};

namespace detail {

template <class T> struct is_vector : std::false_type {};
template <class T, class A> struct is_vector<std::vector<T, A>> : std::true_type {};
template <class T> struct is_optional : std::false_type {};
template <class T> struct is_optional<std::optional<T>> : std::true_type {};
template <class T> struct is_array : std::false_type {};
template <class T, std::size_t n> struct is_array<std::array<T, n>> : std::true_type {};

template <class T> const std::vector<T>& array_of(const SavedState& saved, const std::string& name) {
  const auto found = saved.find(name);
  const auto* array = found == saved.end() ? nullptr : std::get_if<std::vector<T>>(&found->second);
  if (array == nullptr) throw Error("the saved state has no array '" + name + "' of the expected type");
  return *array;
}

/// Element `at` of a saved array. @throws Error if the array is shorter
template <class T> const T& element(const std::vector<T>& array, std::size_t at) {
  if (at >= array.size()) {
    throw Error("a saved array has " + std::to_string(array.size()) + " elements, at least " + std::to_string(at + 1) +
                " are expected");
  }
  return array[at];
}

/// The enumerator of a saved number. @throws Error if it names none up to `last`
template <class Enum> Enum enumerator(std::int64_t number, Enum last) {
  if (number < 0 || number > static_cast<std::int64_t>(last)) {
    throw Error("a saved choice is " + std::to_string(number) + "; 0 to " +
                std::to_string(static_cast<std::int64_t>(last)) + " is expected");
  }
  return static_cast<Enum>(number);
}

inline void append(std::vector<double>& out, double x) { out.push_back(x); }
inline void append(std::vector<std::int64_t>& out, std::int64_t x) { out.push_back(x); }
inline void append(std::vector<double>& out, const Quad& x) {
  for (const double part : to_doubles(x)) out.push_back(part);
}
inline void take(const std::vector<double>& in, std::size_t& at, double& x) { x = element(in, at++); }
inline void take(const std::vector<std::int64_t>& in, std::size_t& at, std::int64_t& x) { x = element(in, at++); }
inline void take(const std::vector<double>& in, std::size_t& at, Quad& x) {
  x = from_doubles({element(in, at), element(in, at + 1), element(in, at + 2)});
  at += 3;
}
template <class Real> void append(std::vector<double>& out, const Vec3<Real>& v) {
  for (int k = 0; k < 3; ++k) append(out, v[k]);
}
template <class Real> void take(const std::vector<double>& in, std::size_t& at, Vec3<Real>& v) {
  for (int k = 0; k < 3; ++k) take(in, at, v[k]);
}

}  // namespace detail

/// Writes `value` below `name`: numbers, vectors, arrays, optionals, and parts that declare state themselves.
template <class T> void save_value(SavedState& saved, const std::string& name, const T& value) {
  if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
    saved[name] = std::vector<std::int64_t>{static_cast<std::int64_t>(value)};
  } else if constexpr (std::is_same_v<T, std::string>) {
    saved[name] = std::vector<std::string>{value};
  } else if constexpr (std::is_same_v<T, std::vector<std::string>> || std::is_same_v<T, std::vector<std::int64_t>>) {
    saved[name] = value;
  } else if constexpr (detail::is_optional<T>::value) {
    save_value(saved, name + "/present", value.has_value());
    if (value) save_value(saved, name + "/value", *value);
  } else if constexpr (requires { value.save(saved, name); }) {
    value.save(saved, name);
  } else {
    std::vector<double> numbers;
    if constexpr (detail::is_vector<T>::value || detail::is_array<T>::value) {
      for (const auto& x : value) detail::append(numbers, x);
    } else {
      detail::append(numbers, value);
    }
    saved[name] = std::move(numbers);
  }
}

/// Reads back what `save_value` wrote. @throws Error if the array is missing, of another type or too short
template <class T> void load_value(const SavedState& saved, const std::string& name, T& value) {
  if constexpr (std::is_integral_v<T> || std::is_enum_v<T>) {
    value = static_cast<T>(detail::element(detail::array_of<std::int64_t>(saved, name), 0));
  } else if constexpr (std::is_same_v<T, std::string>) {
    value = detail::element(detail::array_of<std::string>(saved, name), 0);
  } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
    value = detail::array_of<std::string>(saved, name);
  } else if constexpr (std::is_same_v<T, std::vector<std::int64_t>>) {
    value = detail::array_of<std::int64_t>(saved, name);
  } else if constexpr (detail::is_optional<T>::value) {
    bool present = false;
    load_value(saved, name + "/present", present);
    value.reset();
    if (present) load_value(saved, name + "/value", value.emplace());
  } else if constexpr (requires { value.load(saved, name); }) {
    value.load(saved, name);
  } else {
    const std::vector<double>& numbers = detail::array_of<double>(saved, name);
    std::size_t at = 0;
    if constexpr (detail::is_vector<T>::value) {
      value.clear();
      while (at < numbers.size()) {
        typename T::value_type x{};
        detail::take(numbers, at, x);
        value.push_back(x);
      }
    } else if constexpr (detail::is_array<T>::value) {
      for (auto& x : value) detail::take(numbers, at, x);
    } else {
      detail::take(numbers, at, value);
    }
  }
}

/// The raw particles of a run, unsettled, as arrays: what a checkpoint calls `/state`.
template <class Real> SavedState save_particles(const ParticleSystem<Real>& s);

/// Rebuilds the particles that `save_particles` wrote. @throws Error if an array is missing or has the wrong length
template <class Real> ParticleSystem<Real> load_particles(const SavedState& saved);

}  // namespace noether
