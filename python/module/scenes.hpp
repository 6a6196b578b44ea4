#pragma once
/// Scenes as Python holds them: read from files, texts or dicts, with functions of one's own; and all that is asked of
/// a scene as a whole.

#include "python/module/callable.hpp"
#include "scene/scene.hpp"

#include <nanobind/nanobind.h>

#include <memory>
#include <string>
#include <vector>

namespace noether::python {

namespace nb = nanobind;

/// All parts of noether, and those of one's own.
const Parts& known_parts();

/// A scene that has been read, and the functions that it may call.
class HeldScene {
 public:
  /// @param source  a path, or a dict of tables
  /// @param text  of a scene, instead of reading `source`
  HeldScene(nb::object source, const std::vector<std::string>& sets, std::vector<std::shared_ptr<Callable>> functions);

  const Scene& scene() const { return run_->scene(); }
  SceneRun& run() { return *run_; }
  std::vector<std::shared_ptr<Callable>>& functions() { return functions_; }
  /// Raises what a function has raised.
  void raise_again();

 private:
  std::vector<std::shared_ptr<Callable>> functions_;
  std::unique_ptr<SceneRun> run_;
};

void bind_scenes(nb::module_& m);
void bind_simulations(nb::module_& m);
void bind_parts(nb::module_& m);
void bind_elements(nb::module_& m);

/// For Python's collector: visits, or lets go of, the objects `Function` that a scene or a simulation holds. Each of
/// these visits the function itself: it has the only reference to it.
int traverse_functions(const std::vector<std::shared_ptr<Callable>>& functions, visitproc visit, void* arg);
void clear_functions(std::vector<std::shared_ptr<Callable>>& functions);

}  // namespace noether::python
