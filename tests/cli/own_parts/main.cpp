/// The program with parts from outside the library: what a user's own program is.

#include "cli/program.hpp"
#include "tests/support/energy_projection.hpp"
#include "tests/support/gyration.hpp"
#include "tests/support/mesh_field.hpp"
#include "tests/support/tops.hpp"

int main(int argc, char** argv) {
  noether::Parts parts = noether::standard_parts();
  parts.add_hamiltonian<noether::test::Gyration>();
  parts.add_hamiltonian<noether::test::Tops>();
  parts.add_force<noether::test::MeshField>();
  parts.add_decorator<noether::test::EnergyProjection>();
  return noether::program(argc, argv, parts);
}
