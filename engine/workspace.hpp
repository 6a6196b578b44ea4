#pragma once
/// What forces keep from one evaluation to the next that is no state: neighbor lists, meshes, trees, plans.

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace noether {

/// Caches of forces, one of each type. The Hamiltonian owns a workspace, its sinks lend it to the forces they serve.
///
///     Workspace& own = out.workspace();  // in `add_to`: that of this force, as the evaluation before left it
///     auto& mesh = own.get<Mesh>();
///
/// Nothing here may decide bits: a cache is a function of positions and parameters, is empty after `bind` and after a
/// restart, and a copy of a workspace holds what copies of its contents hold (a copied neighbor list is empty). A force
/// that would be another one without its workspace has state, and state belongs into columns.
class Workspace {
 public:
  Workspace() = default;
  Workspace(const Workspace& other) {
    for (const auto& [key, held] : other.tenants_) tenants_.emplace_back(key, held->clone());
    for (const auto& room : other.rooms_) rooms_.push_back(std::make_unique<Workspace>(*room));
  }
  Workspace& operator=(const Workspace& other) { return *this = Workspace(other); }
  Workspace(Workspace&&) = default;
  Workspace& operator=(Workspace&&) = default;
  ~Workspace() = default;

  /// What it keeps of a type; null if it keeps none.
  template <class T> T* find() const {
    for (const auto& [key, held] : tenants_) {
      if (key == &key_of<T>) return &static_cast<Held<T>&>(*held).value;
    }
    return nullptr;
  }
  /// What it keeps of a type, made by `T()` when first asked for.
  template <class T> T& get() {
    if (T* found = find<T>()) return *found;
    return put(T());
  }
  /// Keeps a value in place of any other of its type.
  template <class T> T& put(T value) {
    if (T* found = find<T>()) return *found = std::move(value);
    tenants_.emplace_back(&key_of<T>, std::make_unique<Held<T>>(std::move(value)));
    return *find<T>();
  }
  /// The workspace of term `k` of a sum of forces: terms do not see each other's.
  Workspace& room(std::size_t k) {
    while (rooms_.size() <= k) rooms_.push_back(std::make_unique<Workspace>());
    return *rooms_[k];
  }
  bool empty() const { return tenants_.empty() && rooms_.empty(); }

 private:
  struct Tenant {
    virtual ~Tenant() = default;
    virtual std::unique_ptr<Tenant> clone() const = 0;
  };
  template <class T> struct Held final : Tenant {
    explicit Held(T held) : value(std::move(held)) {}
    std::unique_ptr<Tenant> clone() const override {
      if constexpr (std::is_copy_constructible_v<T>) {
        return std::make_unique<Held>(value);
      } else {
        return std::make_unique<Held>(T());
      }
    }
    T value;
  };
  template <class T> static inline const char key_of = 0;

  std::vector<std::pair<const char*, std::unique_ptr<Tenant>>> tenants_;
  std::vector<std::unique_ptr<Workspace>> rooms_;
};

}  // namespace noether
