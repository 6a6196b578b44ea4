// The same struct, unchanged, in a scene file: three lines of program.
#include "examples/bead_on_wire/cycloid.hpp"

#include "scene/parts.hpp"
#include "scene/scene.hpp"

using namespace noether;

int main() {
  Parts parts = standard_parts();
  parts.add_constraint<OnCycloid>();
  return exit_code(run(load_run("scene.toml", parts)));
}
