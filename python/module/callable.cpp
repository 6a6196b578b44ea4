#include "python/module/callable.hpp"

#include "numbers/error.hpp"
#include "scene/reader.hpp"

#include <fmt/format.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <limits>
#include <map>
#include <mutex>
#include <utility>

namespace noether::python {

namespace {

/// Who lives, by number. Callables are made and let go of under Python's lock, and looked for without.
struct Registry {
  std::mutex mutex;
  std::map<std::int64_t, std::weak_ptr<Callable>> owners;
  std::int64_t last = 0;
};
Registry& registry() {
  static Registry one;
  return one;
}

/// Accelerations that a function fills, kept between evaluations: making the column takes longer than a short force.
struct Scratch {
  VectorColumn<double> a;

  VectorColumn<double>& of(Index n) {
    if (a.size() != n) a = VectorColumn<double>(n);
    a.set_zero();
    return a;
  }
};

using Array2 = nb::ndarray<nb::numpy, double, nb::ndim<2>>;
using Array1 = nb::ndarray<nb::numpy, double, nb::ndim<1>>;
using ReadOnly2 = nb::ndarray<nb::numpy, const double, nb::ndim<2>>;
using ReadOnly1 = nb::ndarray<nb::numpy, const double, nb::ndim<1>>;

}  // namespace

Callable::Callable(nb::object object, std::uintptr_t address)
    : object_(object.release().ptr()),
      address_(reinterpret_cast<ForceAddress>(address)),  // NOLINT: this is what an address is
      id_(0) {
  Registry& all = registry();
  const std::scoped_lock lock(all.mutex);
  id_ = ++all.last;
}

Callable::~Callable() {
  {
    Registry& all = registry();
    const std::scoped_lock lock(all.mutex);
    all.owners.erase(id_);
  }
  if (Py_IsInitialized() == 0) return;
  const nb::gil_scoped_acquire locked;
  failed_ = nullptr;
  clear();
}

void Callable::raise_again() {
  if (const std::exception_ptr failed = take_failed()) std::rethrow_exception(failed);
}

std::exception_ptr Callable::take_failed() { return std::exchange(failed_, nullptr); }

void Callable::clear() { Py_XDECREF(std::exchange(object_, nullptr)); }

void raise_again(const std::vector<std::shared_ptr<Callable>>& functions) {
  std::exception_ptr first;
  for (const auto& function : functions) {
    const std::exception_ptr failed = function->take_failed();  // of all: none is left for a later call
    if (!first) first = failed;
  }
  if (first) std::rethrow_exception(first);
}

std::shared_ptr<Callable> callable_of(std::int64_t id) {
  Registry& all = registry();
  const std::scoped_lock lock(all.mutex);
  const auto found = all.owners.find(id);
  return found == all.owners.end() ? nullptr : found->second.lock();
}

std::shared_ptr<Callable> make_callable(nb::object object, std::uintptr_t address) {
  auto made = std::make_shared<Callable>(std::move(object), address);
  Registry& all = registry();
  const std::scoped_lock lock(all.mutex);
  all.owners[made->id()] = made;
  return made;
}

ForceClaims UserForce::claims() const {
  ForceClaims claims;
  claims.energy = energy;
  claims.virial = !periodic;
  claims.velocity_dependent = velocity_dependent || dissipative;
  claims.time_dependent = time_dependent;
  claims.dissipative = dissipative;
  claims.keeps_momentum = keeps_momentum;
  claims.keeps_angular_momentum = keeps_angular_momentum;
  claims.periodic = periodic;
  return claims;
}

void UserForce::add_to(ForceSink<double>& out, const ParticleSystem<double>& s) const {
  const Index n = s.size();
  const auto& x = s.positions();
  const auto& v = s.velocities();
  VectorColumn<double>& a = out.workspace().get<Scratch>().of(n);
  double potential = 0;
  bool fine = true;
  if (callable->address() != nullptr) {
    potential = callable->address()(n, x.stride(), s.time(), x.component(0), v.component(0), s.masses().data(),
                                    a.component(0), nullptr);
  } else {
    fine = callable->call([&](nb::handle function) {
      const nb::object none = nb::none();
      const nb::object told = function(
          s.time(), vectors_of(x.component(0), n, x.stride(), none), vectors_of(v.component(0), n, v.stride(), none),
          numbers_of(s.masses().data(), n, none), vectors_of(a.component(0), n, a.stride(), none, true));
      if (!energy) return;
      if (told.is_none()) {
        throw nb::type_error(
            "the force returned None; return its potential energy, or say energy=False where it has none");
      }
      potential = nb::cast<double>(nb::float_(told));
    });
  }
  if (!fine) {
    out.fail({.message = "the force of one's own raised an exception"});
    // Who settles a state looks at its numbers alone.
    if (n > 0) out.acceleration(0, Vec3<double>::Constant(std::numeric_limits<double>::quiet_NaN()));
    return;
  }
  for (Index i = 0; i < n; ++i) out.acceleration(i, a[i]);
  if (energy && out.wants_energy()) out.energy(potential);
}

void read_files(UserForce& force, TableReader& reader) {
  force.callable = callable_of(force.function);
  if (force.callable == nullptr) {
    reader.fail("function", fmt::format("no function of Python has the number {}; forces of one's own are added in "
                                        "Python, by add_force",
                                        force.function));
  }
}

void UserMonitor::watch(const ConstraintSet& /*constraints*/) {
  callable_ = callable_of(function);
  if (callable_ == nullptr) {
    throw Error(
        fmt::format("no function of Python has the number {}; monitors of one's own are added in Python, by "
                    "every",
                    function));
  }
}

void UserMonitor::observe(const Snapshot<double>& now) {
  const ParticleSystem<double>& s = now.state();
  values_.assign(names.size(), 0);
  const bool fine = callable_->call([&](nb::handle call) {
    const nb::object none = nb::none();
    const Index n = s.size();
    const nb::object told = call(s.time(), vectors_of(s.positions().component(0), n, s.positions().stride(), none),
                                 vectors_of(s.velocities().component(0), n, s.velocities().stride(), none),
                                 numbers_of(s.masses().data(), n, none));
    if (names.size() == 1 && PyObject_Size(told.ptr()) < 0) {  // a number, or an array of no dimension
      PyErr_Clear();
      values_[0] = nb::cast<double>(nb::float_(told));
      return;
    }
    std::vector<double> numbers;
    for (nb::handle one : nb::iter(told)) numbers.push_back(nb::cast<double>(nb::float_(one)));
    if (numbers.size() != names.size()) {
      throw nb::value_error(
          fmt::format("the monitor returned {} numbers; it has {} names", numbers.size(), names.size()).c_str());
    }
    values_ = numbers;
  });
  if (!fine) throw Error("the monitor of one's own raised an exception");  // which comes out instead of this
}

std::vector<Series> UserMonitor::series() const {
  std::vector<Series> all;
  for (std::size_t k = 0; k < names.size(); ++k) {
    all.push_back({.name = names[k], .dimension = "1", .shape = {}, .values = {k < values_.size() ? values_[k] : 0.0}});
  }
  return all;
}

nb::object vectors_of(const double* data, Index n, Index stride, nb::handle owner, bool writable) {
  const std::size_t shape[2] = {static_cast<std::size_t>(n), 3};
  const std::int64_t strides[2] = {1, stride};
  if (writable)
    return nb::cast(Array2(const_cast<double*>(data), 2, shape, owner, strides));  // NOLINT: who calls knows
  return nb::cast(ReadOnly2(data, 2, shape, owner, strides));
}

nb::object numbers_of(const double* data, Index n, nb::handle owner, bool writable) {
  const std::size_t shape[1] = {static_cast<std::size_t>(n)};
  if (writable) return nb::cast(Array1(const_cast<double*>(data), 1, shape, owner));  // NOLINT: who calls knows
  return nb::cast(ReadOnly1(data, 1, shape, owner));
}

}  // namespace noether::python
