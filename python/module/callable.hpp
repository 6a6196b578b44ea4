#pragma once
/// Functions of one's own, written in Python or compiled to C, as scenes know them: by a number.

#include "engine/description.hpp"
#include "engine/force_sink.hpp"
#include "engine/monitor.hpp"
#include "scene/parts.hpp"

#include <nanobind/nanobind.h>

#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <vector>

namespace noether {
class TableReader;
}

namespace noether::python {

namespace nb = nanobind;

/// A force by its address, as numba's `@cfunc` or a C compiler makes it: adds accelerations to `a`, whose columns, as
/// those of x and v, lie `stride` numbers apart, and returns the potential energy.
using ForceAddress = double (*)(std::int64_t n, std::int64_t stride, double t, const double* x, const double* v,
                                const double* m, double* a, void* user);

/// One function. The first exception that it raises is kept for who has started the run; a run that falls back to the
/// last whole step calls it again.
class Callable {
 public:
  /// @param object  called as Python has it, or kept alive beside its `address`
  Callable(nb::object object, std::uintptr_t address);
  ~Callable();
  Callable(const Callable&) = delete;
  Callable& operator=(const Callable&) = delete;

  std::int64_t id() const { return id_; }
  ForceAddress address() const { return address_; }
  PyObject* object() const { return object_; }
  /// Calls `use(function)` while it holds Python's lock, and keeps what is raised. @return whether all went well
  template <class Use> bool call(const Use& use) {
    const nb::gil_scoped_acquire locked;
    try {
      use(nb::handle(object_));
      return true;
    } catch (...) {
      if (!failed_) failed_ = std::current_exception();
    }
    return false;
  }
  /// Raises what was kept, once; the function may then be called again.
  void raise_again();
  /// The same without raising it; null where there is nothing.
  std::exception_ptr take_failed();
  /// Lets go of the object: Python's collector has found a cycle.
  void clear();

 private:
  PyObject* object_;
  ForceAddress address_;
  std::int64_t id_;
  std::exception_ptr failed_;
};

/// Raises what the first of them that has failed has kept; what others have kept goes with it.
void raise_again(const std::vector<std::shared_ptr<Callable>>& functions);
std::shared_ptr<Callable> make_callable(nb::object object, std::uintptr_t address);
/// The function of a number, where it still lives; else null.
std::shared_ptr<Callable> callable_of(std::int64_t id);

/// A force in Python or C, doubles only.
struct UserForce {
  std::int64_t function = 0;
  bool energy = true, velocity_dependent = false, time_dependent = false, dissipative = false;
  bool keeps_momentum = false, keeps_angular_momentum = false, periodic = false;
  std::shared_ptr<Callable> callable = {};

  static constexpr auto describe() {
    return part<UserForce>(
        "user_force", "a function of one's own, in Python or C: it fills the accelerations, and returns its energy",
        field<&UserForce::function>("function", "1", "its number, which Python gives").required("1"),
        field<&UserForce::energy>("energy", "1", "it is the gradient of the energy that it returns"),
        field<&UserForce::velocity_dependent>("velocity_dependent", "1", "it looks at velocities"),
        field<&UserForce::time_dependent>("time_dependent", "1", "it looks at the time"),
        field<&UserForce::dissipative>("dissipative", "1", "it takes energy out of the system"),
        field<&UserForce::keeps_momentum>("keeps_momentum", "1", "its sum over all particles is 0"),
        field<&UserForce::keeps_angular_momentum>("keeps_angular_momentum", "1", "its torque about the origin is 0"),
        field<&UserForce::periodic>("periodic", "1", "it knows periodic boxes"));
  }
  ForceClaims claims() const;
  void add_to(ForceSink<double>& out, const ParticleSystem<double>& s) const;
};

/// Finds the function of a force that has been read. @throws SceneError  if it lives no more
void read_files(UserForce& force, TableReader& reader);

/// A monitor in Python: numbers of its own at each look.
class UserMonitor {
 public:
  std::int64_t function = 0;
  std::vector<std::string> names = {"value"};

  static constexpr auto describe() {
    return part<UserMonitor>(
        "user_monitor", "a function of one's own, in Python: numbers of the state at each look",
        field<&UserMonitor::function>("function", "1", "its number, which Python gives").required("1"),
        field<&UserMonitor::names>("names", "1", "of the numbers that it returns"));
  }
  /// Finds its function. @throws Error  if it lives no more
  void watch(const ConstraintSet& constraints);
  void observe(const Snapshot<double>& now);
  std::vector<Series> series() const;

 private:
  std::shared_ptr<Callable> callable_;
  std::vector<double> values_;
};

/// Arrays of NumPy over memory of `owner`, shapes (n, 3) and (n); they cannot be written to unless `writable`.
nb::object vectors_of(const double* data, Index n, Index stride, nb::handle owner, bool writable = false);
nb::object numbers_of(const double* data, Index n, nb::handle owner, bool writable = false);

}  // namespace noether::python
