// The same struct, unchanged, in a scene file: three lines of program.
#include "examples/oblate_saturn/oblateness.hpp"

#include "scene/parts.hpp"
#include "scene/scene.hpp"

using namespace noether;

int main() {
  Parts parts = standard_parts();
  parts.add_force<Oblateness>();
  return exit_code(run(load_run("scene.toml", parts)));
}
