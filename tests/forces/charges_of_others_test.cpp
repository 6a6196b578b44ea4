/// Forces of charged water beside those of OpenMM's Reference platform and of GROMACS in double precision.

#include "forces/lennard_jones.hpp"
#include "forces/particle_mesh_ewald.hpp"
#include "forces/sum.hpp"
#include "scene/water_box.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/pair_forces.hpp"

#include <array>
#include <vector>

namespace noether {
namespace {

using namespace units::molecular;

struct Known {
  Index atom;
  std::array<double, 3> openmm_pme, openmm_ewald, gromacs;  ///< [kJ/mol/nm]
};

/// 216 molecules of SPC/E as the builder makes them from seed 7, cutoff 0.9 nm, a plain end of Lennard-Jones. Printed
/// by `bench/peers/charge_forces.py PROGRAM 216 0 1 2 300 301 647`: OpenMM 8.6.1, its Reference platform, a tolerance
/// of 1e-8; GROMACS 2022.5 in double precision, a mesh of 0.03 nm, order 8, ewald-rtol 1e-9.
const std::vector<Known> known = {
    {0,
     {-50.72736798, -124.7084562, -30.59040904},
     {-50.72735427, -124.7084431, -30.59042043},
     {-50.7275215, -124.7085336, -30.59025048}},
    {1,
     {45.58260976, 75.29862682, -306.7870462},
     {45.58260788, 75.29862876, -306.7870389},
     {45.58300832, 75.29813105, -306.787147}},
    {2,
     {215.8393967, -257.9284008, 279.2289697},
     {215.839391, -257.9284053, 279.2289725},
     {215.8397082, -257.9283061, 279.2288594}},
    {300,
     {-1179.683346, -223.1494801, 506.3452101},
     {-1179.683338, -223.1494658, 506.3451947},
     {-1179.683808, -223.1500423, 506.3449097}},
    {301,
     {719.9402203, 2.305263819, -79.27063498},
     {719.9402243, 2.305266578, -79.27062805},
     {719.9401347, 2.305547398, -79.27102547}},
    {647,
     {-75.70102901, 293.6904916, -76.87697269},
     {-75.70102942, 293.6904941, -76.87698288},
     {-75.70113571, 293.6903237, -76.87707153}},
};

template <class F> test::Evaluated water_under(const ParticleSystem<double>& water, const F& charges) {
  ForceField<double> forces;
  forces.add(LennardJonesForce{.cutoff = 0.9 * nm, .cutoff_style = Cutoff::plain});
  forces.add(charges);
  return test::evaluated<double>(AnyForce<double>(forces), water);
}

double largest_apart(const std::array<double, 3>& other, const Vec3<double>& own) {
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, std::abs(other[k] - own[static_cast<Index>(k)]));
  return largest;
}

}  // namespace

TEST_CASE("forces of charged water are those of OpenMM's reference and of GROMACS in double precision",
          "[forces][charges]") {
  const ParticleSystem<double> water =
      WaterBox{.model = WaterModel::spce, .molecules = 216, .density = 0.997 * g_per_cm3, .seed = 7}.build();
  for (const test::Evaluated& all :
       {water_under(water, Ewald{.cutoff = 0.9 * nm, .relative_error = 1e-9}),
        water_under(water, ParticleMeshEwald{.cutoff = 0.9 * nm, .relative_error = 1e-9})}) {
    for (const Known& one : known) {
      CAPTURE(one.atom);
      const Vec3<double> f = water.masses()[one.atom] * std::as_const(all.a)[one.atom];
      // Three times the errors that they have of themselves, 2.1e-8, 1.3e-8 and 3.6e-7 of 1075 kJ/mol/nm.
      CHECK(largest_apart(one.openmm_pme, f) < 7e-5);
      CHECK(largest_apart(one.openmm_ewald, f) < 5e-5);
      CHECK(largest_apart(one.gromacs, f) < 1.2e-3);
    }
  }
}

}  // namespace noether
