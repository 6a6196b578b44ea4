#pragma once
/// What a user may set of a classical method: what many share stands in plain members, what is one method's own in a
/// described struct that only the file of that method knows.

#include "engine/description.hpp"

#include <any>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace noether {

/// How an implicit method keeps J = df/dy and solves its linear systems: LU of all elements, LU of those that can be
/// other than 0, or products J v only.
enum class JacobianForm : std::uint8_t { dense, sparse, matrix_free };

template <> struct EnumNames<JacobianForm> {
  static constexpr std::array<std::pair<JacobianForm, std::string_view>, 3> values{
      {{JacobianForm::dense, "dense"}, {JacobianForm::sparse, "sparse"}, {JacobianForm::matrix_free, "matrix_free"}}};
};

/// On what group rigid bodies move.
enum class BodyGroup : std::uint8_t {
  so3,  ///< orientations by rotations, places along straight lines
  se3   ///< both together by rigid motions: a body that flies and turns evenly goes along a screw
};
/// In whose axes spins (on SE(3) velocities too) go along straight lines.
enum class SpinAxes : std::uint8_t {
  body,  ///< Pi' = Pi x Omega + R^T torque
  space  ///< S' = torque: the spin of a free body stays to the bit, as on its coadjoint orbit
};

template <> struct EnumNames<BodyGroup> {
  static constexpr std::array<std::pair<BodyGroup, std::string_view>, 2> values{
      {{BodyGroup::so3, "so3"}, {BodyGroup::se3, "se3"}}};
};
template <> struct EnumNames<SpinAxes> {
  static constexpr std::array<std::pair<SpinAxes, std::string_view>, 2> values{
      {{SpinAxes::body, "body"}, {SpinAxes::space, "space"}}};
};

/// One option as data: its description and its value.
struct OptionValue {
  using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<std::string>>;

  std::string_view name, dimension, help;
  std::string_view kind;                       ///< flag, whole number, number, text, choice, or list of texts
  std::vector<std::string_view> choices = {};  ///< of a choice
  Value value = {};                            ///< a choice by its name; monostate: the method decides
};

/// A value as messages have it: "true", "0.25", "dense", "energy, momentum", "default".
std::string option_text(const OptionValue::Value& value);

struct MethodOptions;

/// Options that stand together: those of one described struct.
struct OptionGroup {
  std::string_view name;  ///< as the struct describes itself
  std::string_view lacks =
      "";  ///< what is said of methods without them: "solves no linear systems"; empty: "has no ..."
  std::vector<OptionValue> (*values)(const MethodOptions&) = nullptr;
  void (*set)(MethodOptions&, std::string_view key, const OptionValue::Value&) = nullptr;
  void (*check)(const MethodOptions&) = nullptr;  ///< @throws Error  naming the key
};

namespace detail {
/// The group of a struct `T` that one method, or one family, has to itself.
template <class T> struct OwnGroup {
  static std::vector<OptionValue> values(const MethodOptions& options);
  static void set(MethodOptions& options, std::string_view key, const OptionValue::Value& value);
  static void check(const MethodOptions& options);
};
/// The group of members of `MethodOptions` that `T` describes.
template <class T> struct SharedGroup {
  static std::vector<OptionValue> values(const MethodOptions& options);
  static void set(MethodOptions& options, std::string_view key, const OptionValue::Value& value);
  static void check(const MethodOptions& /*options*/) {}
};
}  // namespace detail

template <Described T>
inline constexpr OptionGroup own_options{part_name<T>(), "", detail::OwnGroup<T>::values, detail::OwnGroup<T>::set,
                                         detail::OwnGroup<T>::check};
template <class T>
inline constexpr OptionGroup shared_options{T::describe().name, T::lacks, detail::SharedGroup<T>::values,
                                            detail::SharedGroup<T>::set, detail::SharedGroup<T>::check};

/// Options of one method, whatever their struct: `NewmarkOptions{.beta = 0}` is such a value. Empty: its defaults.
class OwnOptions {
 public:
  OwnOptions() = default;
  template <Described T>
  OwnOptions(T options)  // NOLINT: erases on purpose
      : group_(&own_options<T>), held_(std::move(options)) {}

  /// Which they are; null: none are set.
  const OptionGroup* group() const { return group_; }
  /// Them, or the defaults where none are set. @throws LogicError  if they are of another struct
  template <class T> T as() const {
    if (group_ == nullptr) return T{};
    const T* options = std::any_cast<T>(&held_);
    NOETHER_EXPECTS(options != nullptr, "a method was given the options of '" + std::string(group_->name) + "'");
    return *options;
  }
  bool operator==(const OwnOptions& other) const;

 private:
  const OptionGroup* group_ = nullptr;
  std::any held_;
};

/// What a user may set of a method; a method takes what it knows and refuses the rest.
struct MethodOptions {
  std::optional<double> rtol = {};      ///< relative tolerance of adaptive methods [1]
  std::optional<double> atol = {};      ///< absolute tolerance, in the units of each variable; default: see `Tolerance`
  std::optional<bool> adaptive = {};    ///< for methods that can do both
  std::optional<double> first = {};     ///< length of the first step of adaptive methods [time]; default: by the method
  std::optional<double> max_step = {};  ///< longest step of adaptive methods [time]; default: any
  /// Of methods that solve linear systems; default: sparse where the field has a `sparsity`, else dense.
  std::optional<JacobianForm> jacobian = {};
  std::optional<BodyGroup> group = {};     ///< of methods on groups; default: SO(3)
  std::optional<SpinAxes> spin_axes = {};  ///< of methods on groups; default: the body's
  OwnOptions own = {};                     ///< of this method alone

  /// The same, with nothing said of tolerances and lengths of steps.
  MethodOptions without_error_control() const {
    return {.jacobian = jacobian, .group = group, .spin_axes = spin_axes, .own = own};
  }
  /// Options in a text that tells runs apart: what is not told is left out if there was a time without it.
  static bool is_new(std::string_view option) { return option == "max_step"; }
  bool operator==(const MethodOptions&) const = default;
};

/// Keys of methods that can choose their steps. (How long the first one is, `[integrator]` says as `step`.)
struct ErrorControl {
  static constexpr std::string_view lacks = "takes steps of one length";

  static constexpr auto describe() {
    return part<MethodOptions>("error_control", "how a method chooses its steps",
                               field<&MethodOptions::adaptive>("adaptive", "1", "false: steps of one length"),
                               field<&MethodOptions::rtol>("rtol", "1", "relative tolerance"),
                               field<&MethodOptions::atol>("atol", "1",
                                                           "absolute tolerance, of each variable; default: 0 for "
                                                           "particles, of a [system] 1e-9; Gauss's and Radau's methods "
                                                           "do not use it"),
                               field<&MethodOptions::max_step>("max_step", "time", "longest step; default: no limit"));
  }
};

/// The key of methods that solve linear systems.
struct LinearSolver {
  static constexpr std::string_view lacks = "does not solve linear systems";

  static constexpr auto describe() {
    return part<MethodOptions>(
        "linear_solver", "how linear systems are solved",
        field<&MethodOptions::jacobian>("jacobian", "1",
                                        "how df/dy is stored; default: sparse if the system declares its zeros, else "
                                        "dense; for Gauss methods matrix_free if it is large"));
  }
};

/// Keys of methods that step rigid bodies on a Lie group.
struct BodiesOnGroup {
  static constexpr std::string_view lacks = "does not step rigid bodies on a group";

  static constexpr auto describe() {
    return part<MethodOptions>("bodies_on_group", "how rigid bodies stand on a group",
                               field<&MethodOptions::group>(
                                   "group", "1",
                                   "of rigid bodies: so3 turns them and moves their centres along straight lines, se3 "
                                   "moves both along screws; default: so3"),
                               field<&MethodOptions::spin_axes>(
                                   "spin_axes", "1",
                                   "in whose axes spins of rigid bodies go along straight lines; space keeps that "
                                   "of a free body to the bit; default: body"));
  }
};

inline constexpr const OptionGroup* error_control = &shared_options<ErrorControl>;
inline constexpr const OptionGroup* linear_solver = &shared_options<LinearSolver>;
inline constexpr const OptionGroup* bodies_on_group = &shared_options<BodiesOnGroup>;

namespace detail {

template <class V> OptionValue::Value option_value(const V& value) {
  if constexpr (is_optional<V>::value) {
    return value ? option_value(*value) : OptionValue::Value();
  } else if constexpr (std::is_enum_v<V>) {
    for (const auto& [known, name] : EnumNames<V>::values) {
      if (known == value) return std::string(name);
    }
    return {};
  } else if constexpr (std::is_same_v<V, bool> || std::is_same_v<V, std::string>) {
    return value;
  } else if constexpr (std::is_same_v<V, std::vector<std::string>>) {  // an empty one says nothing
    return value.empty() ? OptionValue::Value() : value;
  } else if constexpr (std::is_integral_v<V>) {
    return static_cast<std::int64_t>(value);
  } else {
    static_assert(std::is_same_v<V, double>, "an option is a flag, a number, a text, a choice or a list of texts");
    return value;
  }
}

template <class V> void set_option(V& target, const OptionValue::Value& value) {
  if constexpr (is_optional<V>::value) {
    if (value.index() == 0) return target.reset();
    typename V::value_type given{};
    set_option(given, value);
    target = std::move(given);
  } else if constexpr (std::is_enum_v<V>) {
    for (const auto& [known, name] : EnumNames<V>::values) {
      if (name == std::get<std::string>(value)) target = known;
    }
  } else if constexpr (std::is_same_v<V, std::vector<std::string>>) {
    target = value.index() != 0 ? std::get<V>(value) : V();
  } else if constexpr (std::is_integral_v<V> && !std::is_same_v<V, bool>) {
    target = static_cast<V>(std::get<std::int64_t>(value));
  } else {
    target = std::get<V>(value);
  }
}

/// The fields that `Description` tells of, as they are in `held`.
template <class Description, class T> std::vector<OptionValue> option_values(const T& held) {
  std::vector<OptionValue> all;
  for_each_field<Description>([&](const auto& field) {
    using V = typename std::remove_cvref_t<decltype(field)>::value_type;
    using Plain = typename optional_value<V>::type;
    OptionValue one{field.name, field.dimension, field.help, field_kind<V>(), {}, option_value(held.*(field.member))};
    if constexpr (std::is_enum_v<Plain>) {
      for (const auto& [known, name] : EnumNames<Plain>::values) one.choices.push_back(name);
    }
    all.push_back(std::move(one));
  });
  return all;
}
template <class Description, class T>
void set_option_of(T& held, std::string_view key, const OptionValue::Value& value) {
  for_each_field<Description>([&](const auto& field) {
    if (field.name == key) set_option(held.*(field.member), value);
  });
}

template <class T> std::vector<OptionValue> OwnGroup<T>::values(const MethodOptions& options) {
  return option_values<T>(options.own.as<T>());
}
template <class T>
void OwnGroup<T>::set(MethodOptions& options, std::string_view key, const OptionValue::Value& value) {
  T own = options.own.as<T>();
  set_option_of<T>(own, key, value);
  options.own = std::move(own);
}
template <class T> void OwnGroup<T>::check(const MethodOptions& options) { check_part(options.own.as<T>()); }

template <class T> std::vector<OptionValue> SharedGroup<T>::values(const MethodOptions& options) {
  return option_values<T>(options);
}
template <class T>
void SharedGroup<T>::set(MethodOptions& options, std::string_view key, const OptionValue::Value& value) {
  set_option_of<T>(options, key, value);
}

}  // namespace detail

}  // namespace noether
