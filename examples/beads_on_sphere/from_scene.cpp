// The same struct, unchanged, in a scene file: three lines of program.
#include "examples/beads_on_sphere/sphere_attraction.hpp"

#include "scene/parts.hpp"
#include "scene/scene.hpp"

using namespace noether;

int main() {
  Parts parts = standard_parts();
  parts.add_force<SphereAttraction>();
  return exit_code(run(load_run("scene.toml", parts)));
}
