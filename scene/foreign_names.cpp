#include "scene/foreign_names.hpp"

#include "integrators/all_schemes.hpp"
#include "numbers/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>

namespace noether {

namespace {

// Of words that stand in two rows the one whose name is accepted where the word was written counts, else the first.
constexpr std::array names_of_others = {
    // Splitting schemes.
    ForeignName{" leapfrog leap_frog velocity_verlet verlet_velocity vv md_vv kdk verlet_kdk stormer_verlet "
                "stoermer_verlet nve sts ",
                NamePlace::method, "verlet"},
    ForeignName{" position_verlet dkd verlet_dkd drift_kick_drift ", NamePlace::method, "verlet_aba"},
    ForeignName{" euler_cromer semi_implicit_euler symplectic_euler ", NamePlace::method, "symplectic_euler_a"},
    ForeignName{" forest_ruth fr yoshida ", NamePlace::method, "yoshida_4"},
    ForeignName{" ruth ruth3 ", NamePlace::method, "ruth_3"},
    ForeignName{" blanes_moan blanesmoan ", NamePlace::method, "blanes_moan_s6"},
    ForeignName{" omelyan omf ", NamePlace::method, "pefrl"},
    ForeignName{" mclachlan mclachlan_4 ", NamePlace::method, "mclachlan_s4"},
    ForeignName{" eos embedded_operator_splitting ", NamePlace::method, "blanes_moan_s6",
                "it splits kinetic and potential energy, without a Kepler solver", true},
    ForeignName{" janus ", NamePlace::method, "kahan_li_8_s17",
                "symmetric and of order 8; its arithmetic is not in whole numbers", true},
    ForeignName{" multiple_timestep multiple_time_step multiple_time_steps verlet_i impulse ", NamePlace::method,
                "respa", "with inner_steps = [4], and kick = \"C\" in the table of the slow force"},
    // Along Kepler arcs.
    ForeignName{" whfast whfast512 wh wisdomholman wisdom_holman mvs rmvs swift helio ", NamePlace::hamiltonian,
                "wisdom_holman", "with method = 'verlet', or 'aba_10_6_4' for more accuracy"},
    ForeignName{" democratic democratic_heliocentric whds jacobi barycentric ", NamePlace::hamiltonian, "wisdom_holman",
                "its key coordinates chooses among them"},
    ForeignName{" saba saba4 laskar_robutel ", NamePlace::method, "saba_4", "on the Hamiltonian 'wisdom_holman'"},
    ForeignName{" saba1064 saba_1064 saba_10_6_4 sabah1064 ", NamePlace::method, "aba_10_6_4",
                "on the Hamiltonian 'wisdom_holman'"},
    ForeignName{" saba864 saba_864 saba_8_6_4 ", NamePlace::method, "aba_8_6_4", "on the Hamiltonian 'wisdom_holman'"},
    ForeignName{" sabac sabac1 sabac2 sabac3 sabac4 sabac_4 sabacm4 ", NamePlace::method, "saba_4",
                "on the Hamiltonian 'wisdom_holman', with kernel = \"modified\""},
    ForeignName{" sabacl sabacl4 ", NamePlace::method, "saba_4",
                "on the Hamiltonian 'wisdom_holman' with kernel = \"modified\", which takes the gradient itself", true},
    ForeignName{" corrector correctors symplectic_corrector ", NamePlace::method, "verlet_aba",
                "on the Hamiltonian 'wisdom_holman', with corrector = 17"},
    ForeignName{" whckl whckm whckc ", NamePlace::method, "verlet_aba",
                "on the Hamiltonian 'wisdom_holman', with corrector = 17 and kernel = \"lazy\", \"modified\" or "
                "\"composed\""},
    ForeignName{" mercurius mercury mercury6 trace symba hybrid bs_hybrid close_encounter close_encounters ",
                NamePlace::method, "gauss_radau_15",
                "its steps shrink in close encounters, and so do those of 'dop853'", true},
    ForeignName{" hermite hermite4 hermite_4 hermite6 ahmad_cohen ", NamePlace::method, "gauss_radau_15",
                "of high order that chooses its own steps; 'dop853' is another one", true},
    // Classical methods.
    ForeignName{" ias15 ias radau15 radau_15 ra15 everhart rada27 ", NamePlace::method, "gauss_radau_15"},
    ForeignName{" rk runge_kutta rungekutta runge_kutta_4 rungekutta4 rk_4 classical_rk ", NamePlace::method, "rk4"},
    ForeignName{" modified_euler ", NamePlace::method, "heun"},
    ForeignName{" rk2 midpoint explicit_midpoint ", NamePlace::method, "heun", "of order 2 too", true},
    ForeignName{" forward_euler explicit_euler ", NamePlace::method, "euler"},
    ForeignName{" implicit_euler euler_implicit ", NamePlace::method, "backward_euler"},
    ForeignName{" crank_nicolson cn trapezoid ", NamePlace::method, "trapezoidal"},
    ForeignName{" rk45 dopri dopri5 dopri45 dp5 dp45 rkdp ode45 dormand_prince dormandprince ", NamePlace::method,
                "dormand_prince_5"},
    ForeignName{" tsit5 rkf45 rkf fehlberg ", NamePlace::method, "dormand_prince_5", "of order 5 too", true},
    ForeignName{" rkck cashkarp cash_karp ck45 ", NamePlace::method, "cash_karp_5"},
    ForeignName{" dopri8 dopri853 dp8 dp853 rk853 ", NamePlace::method, "dop853"},
    ForeignName{" rk78 rk8 rkf78 vern8 vern9 fehlberg78 ode78 ode87 ", NamePlace::method, "dop853", "of order 8", true},
    ForeignName{" nystrom rkn rkn12 rkn1210 dprkn12 ", NamePlace::method, "dprkn_12"},
    ForeignName{" bs bulirsch_stoer bulirschstoer burlisch_stoer gbs odex bulsto ", NamePlace::method,
                "gragg_bulirsch_stoer"},
    ForeignName{" gauss_legendre irk gl irkgl16 ", NamePlace::method, "gauss_8"},
    ForeignName{" lsoda vode cvode ode15s gear ndf lsode ", NamePlace::method, "bdf", "for stiff systems too", true},
    ForeignName{" rosenbrock rodas ", NamePlace::method, "rodas_5p"},
    ForeignName{" radau radau5 radau_iia ode23s ros4 stiff ", NamePlace::method, "rodas_5p", "for stiff systems too",
                true},
    ForeignName{" ode113 adams abm adams_bashforth_moulton predictor_corrector pece ", NamePlace::method, "adams_pece"},
    ForeignName{" cowell stormer stoermer ", NamePlace::method, "stormer_cowell_13"},
    ForeignName{" gauss_jackson gj8 ", NamePlace::method, "stormer_cowell_13",
                "a multistep method of second-order systems too", true},
    // Baths.
    ForeignName{" v_rescale vrescale velocity_rescale bussi csvr temp_csvr stochastic_velocity_rescaling rescale ",
                NamePlace::thermostat, "velocity_rescaling", "method = \"verlet\" goes with it"},
    ForeignName{" nvt nose_hoover nosehoover nose_hoover_chain nhc berendsen andersen andersen_massive thermostat "
                "obabo gjf sd bd brownian tdamp dpd ",
                NamePlace::thermostat, "langevin", "a bath with friction and noise; method = \"BAOAB\" goes with it",
                true},
    ForeignName{" langevin_integrator langevinintegrator langevin_middle langevinmiddleintegrator langevinmiddle "
                "baoab_langevin ",
                NamePlace::thermostat, "langevin", "a bath with friction and noise; method = \"BAOAB\" goes with it"},
    ForeignName{" npt nph barostat parrinello_rahman mtk mttk c_rescale monte_carlo_barostat press_berendsen ",
                NamePlace::none, "",
                "there is no barostat here: the box stays as it is; a temperature is held by type = 'langevin' in "
                "[hamiltonian.thermostat], and the monitor 'pressure' tells the pressure"},
    ForeignName{" sei hill shearing_box hills_equations ", NamePlace::hamiltonian, "shearing_sheet",
                "with method = 'verlet_aba'"},
    ForeignName{" steep steepest_descent cg l_bfgs lbfgs fire minimization minimisation min ", NamePlace::none, "",
                "energy is minimized before a run by the table [minimize]"},
    // Forces.
    ForeignName{" lj lj_cut lj126 lj_12_6 12_6 twelve_six vdw vdwaals lennardjones van_der_waals ", NamePlace::force,
                "lennard_jones"},
    ForeignName{" rf reactionfield ", NamePlace::force, "reaction_field"},
    ForeignName{" coulomb coulombs_law coulombic ", NamePlace::force, "coulomb"},
    ForeignName{" coul coul_cut lj_cut_coul_cut electrostatic electrostatics charges charge dsf coul_dsf wolf "
                "cutoff_coulomb ",
                NamePlace::force, "reaction_field", "charges beyond its cutoff are a dielectric", true},
    ForeignName{" ewald ewald_sum ewald_summation ", NamePlace::force, "ewald"},
    ForeignName{" pme spme smooth_pme particle_mesh ", NamePlace::force, "particle_mesh_ewald"},
    ForeignName{" pppm p3m coul_long lj_cut_coul_long kspace ", NamePlace::force, "particle_mesh_ewald",
                "charges and all their images, to a relative_error of forces", true},
    ForeignName{" harmonic bond bonds bond_harmonic harmonic_bonds harmonicbondforce angle angles angle_harmonic "
                "harmonic_angle dihedral dihedrals torsion torsions periodic_torsion improper impropers fene opls "
                "charmm amber gaff morse_bond bond_morse class2 ryckaert_bellemans ",
                NamePlace::force, "bonded",
                "terms of a structure file; springs between named particles are 'harmonic_bond'", true},
    ForeignName{" spring springs harmonic_spring ", NamePlace::force, "harmonic_bond"},
    ForeignName{" posre position_restraint position_restraints restraint restraints spring_self ", NamePlace::force,
                "tether"},
    ForeignName{" newton newtonian newtonian_gravity nbody n_body self_gravity ", NamePlace::force, "gravity"},
    ForeignName{" gr relativity general_relativity gr_correction schwarzschild ", NamePlace::force, "gr_potential",
                "which gives the right advance of pericentres, or 'post_newtonian', which has the mean motion too"},
    ForeignName{" gr_full eih pn post_newton 1pn pn1 ", NamePlace::force, "post_newtonian",
                "for methods such as 'gauss_radau_15' and for 'wisdom_holman'; it knows the field of particle 0 only",
                true},
    ForeignName{" j2 j4 zonal_harmonics gravitational_harmonics oblate quadrupole ", NamePlace::force, "oblateness"},
    ForeignName{" drag friction damping viscous modify_orbits_forces ", NamePlace::force, "linear_drag"},
    ForeignName{" tide tidal tides_spin tides_constant_time_lag tctl tidal_force ", NamePlace::force, "tides",
                "for rigid bodies, with the keys love_number, radius and tide_lag"},
    ForeignName{" hard_sphere hardsphere collisions hard_sphere_collisions granular ", NamePlace::force, "hard_spheres",
                "for spheres of the Hamiltonian 'shearing_sheet'", true},
    ForeignName{" efield electric_field constant_force addforce constant_field ", NamePlace::force, "uniform_field"},
    ForeignName{" buck born born_mayer exp6 exp_6 ", NamePlace::force, "buckingham"},
    ForeignName{" lj_repulsive weeks_chandler_andersen ", NamePlace::force, "wca"},
    ForeignName{" soft repulsive ", NamePlace::force, "wca", "it only repels", true},
    ForeignName{" fput fpu ", NamePlace::force, "fermi_pasta_ulam"},
    // Constraints.
    ForeignName{" shake rattle lincs bond_constraint ", NamePlace::constraint, "distance",
                "constraints are tables [[hamiltonian.constraint]], whose key solver says how they are solved", true},
    ForeignName{" hbonds h_bonds hydrogens ", NamePlace::constraint, "hydrogen_bonds"},
    ForeignName{" all_bonds allbonds rigid_bonds ", NamePlace::constraint, "bonds"},
    ForeignName{" h_angles hangles all_angles allangles rigid_angles ", NamePlace::constraint, "bonds_and_angles"},
    ForeignName{" settle rigid_water rigid_small rigid_molecule rigid_bodies ", NamePlace::constraint,
                "rigid_molecules"},
    ForeignName{" rod bar rigid rigid_rod ", NamePlace::constraint, "rigid_bar"},
    ForeignName{" freeze frozen setforce ", NamePlace::constraint, "fixed"},
    // Monitors and files.
    ForeignName{" energies total_energy etotal kinetic_energy potential_energy ke pe thermo log ", NamePlace::monitor,
                "energy"},
    ForeignName{" msd diffusion ", NamePlace::monitor, "mean_square_displacement"},
    ForeignName{" vacf velocity_correlation ", NamePlace::monitor, "velocity_autocorrelation"},
    ForeignName{" rdf g_r gofr pair_correlation ", NamePlace::monitor, "radial_distribution"},
    ForeignName{" temp ", NamePlace::monitor, "temperature"},
    ForeignName{" dihedral torsion torsions dihedral_angles ", NamePlace::monitor, "dihedrals"},
    ForeignName{" dipole dipoles dipole_moments polarization ", NamePlace::monitor, "dipole_moment"},
    ForeignName{" dielectric permittivity epsilon_r relative_permittivity ", NamePlace::monitor, "dielectric_constant"},
    ForeignName{" virial stress press ", NamePlace::monitor, "pressure"},
    ForeignName{" com center_of_mass_motion barycenter ", NamePlace::monitor, "center_of_mass"},
    ForeignName{" orbits orbital_elements osculating_elements orbit kepler_elements ", NamePlace::monitor, "elements"},
    ForeignName{
        " dump frames xtc trr dcd traj positions output snapshots simulationarchive xyz extxyz extended_xyz pdb ",
        NamePlace::monitor, "trajectory"},
    ForeignName{" restart ", NamePlace::monitor, "checkpoint"},
    ForeignName{" hamiltonian_shadow modified_energy shadow ", NamePlace::monitor, "shadow_hamiltonian"},
    // Hamiltonians and starts.
    ForeignName{" separable cartesian inertial direct ", NamePlace::hamiltonian, "kinetic_potential"},
    ForeignName{" fcc bcc sc crystal ", NamePlace::builder, "lattice", "its key lattice chooses among sc, bcc and fcc"},
    ForeignName{" random fluid ", NamePlace::builder, "liquid"},
    // Keys.
    ForeignName{" dt timestep time_step tstep stepsize step_size delta_t h deltat ", NamePlace::key, "step"},
    ForeignName{" nsteps n_steps num_steps numsteps nstep number_of_steps ", NamePlace::key, "steps"},
    ForeignName{" tmax t_max tend t_end tfinal t_final end end_time stop_time duration t_stop ", NamePlace::key,
                "until"},
    ForeignName{" integrator scheme algorithm solver ", NamePlace::key, "method"},
    ForeignName{" t0 tstart t_start tmin begin start ", NamePlace::key, "start_time"},
    ForeignName{" tol tolerance rel_tol relative_tolerance accuracy reltol ", NamePlace::key, "rtol"},
    ForeignName{" abs_tol absolute_tolerance abstol ", NamePlace::key, "atol"},
    ForeignName{" nstout nstxout stride interval freq frequency nevery every_steps ", NamePlace::key, "steps"},
    ForeignName{" rcut r_cut rc cut rvdw rcoulomb cutoff_distance cutoff_radius ", NamePlace::key, "cutoff"},
    ForeignName{" vdw_modifier vdwtype shift switch cutoff_type ", NamePlace::key, "cutoff_style"},
    ForeignName{" kt t temp tref ref_t temperature_k ", NamePlace::key, "temperature"},
    ForeignName{" gamma damp gamma_ln collision_rate friction_coefficient tau_t ", NamePlace::key, "friction"},
    ForeignName{" random_seed rng iseed ", NamePlace::key, "seed"},
    ForeignName{" eps ", NamePlace::key, "epsilon"},
    ForeignName{" eps softening_length gravitational_softening smoothing ", NamePlace::key, "softening"},
    ForeignName{" sig diameter ", NamePlace::key, "sigma"},
    ForeignName{" rho number_density ", NamePlace::key, "density"},
    ForeignName{" m masses ", NamePlace::key, "mass"},
    ForeignName{" pos position positions r xyz coordinates coords location ", NamePlace::key, "x"},
    ForeignName{" vel velocity velocities u speed ", NamePlace::key, "v"},
    ForeignName{" z qe charges ", NamePlace::key, "charge"},
    ForeignName{" g grav gravitational_constant g_const ", NamePlace::key, "G"},
    ForeignName{" spring_constant force_constant stiffness ", NamePlace::key, "k"},
    ForeignName{" when cadence ", NamePlace::key, "steps"},
    ForeignName{" kind class ", NamePlace::key, "type"},
    ForeignName{" forces potential potentials pair_style interactions ", NamePlace::key, "force"},
    ForeignName{" monitors outputs observables writers ", NamePlace::key, "every"},
    ForeignName{" description comment ", NamePlace::key, "title"},
    ForeignName{" unit unit_system ", NamePlace::key, "units"},
};

/// As words of the table are written.
std::string as_in_table(std::string_view word) {
  std::string text;
  for (const char c : word) {
    const bool joint = std::string_view("_-/. (),").find(c) != std::string_view::npos;
    if (joint && (text.empty() || text.back() == '_')) continue;
    text += joint ? '_' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  if (text.ends_with('_')) text.pop_back();
  return text;
}

/// A word without the kind of thing that it names: "morse" of "morse_potential". Empty if it names none.
std::string without_kind(std::string_view word) {
  const std::string text = as_in_table(word);
  for (const std::string_view kind : {"_potential", "_force", "_field", "_integrator", "_method", "_scheme", "_step",
                                      "_hamiltonian", "_monitor", "_constraint", "_thermostat", "_bath"}) {
    if (text.ends_with(kind) && text.size() > kind.size()) return text.substr(0, text.size() - kind.size());
  }
  return "";
}

bool has_word(const ForeignName& row, std::string_view word) {
  return row.words.find(fmt::format(" {} ", word)) != std::string_view::npos;
}

bool is_one_of(std::string_view name, const std::vector<std::string>& known) {
  return std::find(known.begin(), known.end(), name) != known.end();
}

/// How a scene writes a name at its place.
std::string as_scene_text(const ForeignName& row) {
  const auto in = [&](std::string_view of, std::string_view table) {
    return fmt::format("{} = \"{}\" in {}", of, row.here, table);
  };
  switch (row.place) {
    case NamePlace::method:
      return in("method", "[integrator]");
    case NamePlace::hamiltonian:
      return in("type", "[hamiltonian]");
    case NamePlace::force:
      return in("type", "[[hamiltonian.force]]");
    case NamePlace::thermostat:
      return in("type", "[hamiltonian.thermostat]");
    case NamePlace::constraint:
      return in("type", "[[hamiltonian.constraint]]");
    case NamePlace::monitor:
      return in("type", "[[every]]");
    case NamePlace::builder:
      return in("type", "[particles]");
    case NamePlace::key:
    case NamePlace::none:
      break;
  }
  return std::string(row.here);
}

/// Where a list of names stands: at the one place whose names of the table are all in it; empty: at none, or at
/// several.
std::optional<NamePlace> place_of(const std::vector<std::string>& known) {
  using enum NamePlace;
  std::optional<NamePlace> found;
  for (const NamePlace place : {method, hamiltonian, force, thermostat, constraint, monitor, builder}) {
    const auto fits = [&](const ForeignName& row) { return row.place != place || is_one_of(row.here, known); };
    if (!std::all_of(names_of_others.begin(), names_of_others.end(), fits)) continue;
    if (found) return {};
    found = place;
  }
  return found;
}

/// Whether people who write a word at one place may mean what stands at the other: a method that is a Hamiltonian here,
/// a bath, or a solver of charges or constraints; a force that is a constraint. What is at no place stands in for
/// methods, as minimizers and barostats do.
bool are_related(NamePlace written, NamePlace meant) {
  using enum NamePlace;
  if (written == meant) return true;
  switch (written) {
    case method:
      return meant != monitor && meant != builder && meant != key;
    case hamiltonian:
      return meant == method || meant == force || meant == none;
    case force:
      return meant == hamiltonian || meant == thermostat || meant == constraint;
    case thermostat:
      return meant == method || meant == none;
    case constraint:
      return meant == force;
    case monitor:
    case builder:
    case key:
    case none:
      break;
  }
  return false;
}

/// What there is for a name of another program; empty for a word that is none.
std::string foreign_proposal(std::string_view word, const std::vector<std::string>& known) {
  const std::string text = as_in_table(word);
  const std::optional<NamePlace> place = place_of(known);
  const ForeignName* found = nullptr;
  for (const ForeignName& row : names_of_others) {
    if (row.place == NamePlace::key || !has_word(row, text)) continue;
    if (place && !are_related(*place, row.place)) continue;
    const bool fits = is_one_of(row.here, known);
    if (found == nullptr || fits) found = &row;
    if (fits) break;
  }
  if (found == nullptr) return "";
  if (found->here.empty()) return fmt::format("; {}", found->how);
  const std::string more = found->how.empty() ? "" : fmt::format(" ({})", found->how);
  if (found->other && is_one_of(found->here, known))
    return fmt::format("; in its place there is '{}'{}", found->here, more);
  if (is_one_of(found->here, known)) return fmt::format("; did you mean '{}'?{}", found->here, more);
  return fmt::format("; in its place there is {}{}", as_scene_text(*found), more);
}

/// A known name; of a scheme not one of its other names.
std::string first_name_of(const std::string& known_name, const std::vector<std::string>& known) {
  const Scheme* scheme = schemes::find(known_name);
  return scheme != nullptr && is_one_of(scheme->name, known) ? std::string(scheme->name) : known_name;
}

}  // namespace

std::span<const ForeignName> foreign_names() { return names_of_others; }

std::string proposal_by_name(std::string_view word, const std::vector<std::string>& known) {
  for (const std::string& one : {std::string(word), without_kind(word)}) {
    if (one.empty()) continue;
    const std::string near = suggest(one, known);
    if (!near.empty() && squeezed(one) == squeezed(near)) {
      return fmt::format("; did you mean '{}'?", first_name_of(near, known));
    }
    std::string foreign = foreign_proposal(one, known);
    if (!foreign.empty()) return foreign;
  }
  return "";
}

std::string proposal(std::string_view word, const std::vector<std::string>& known, std::string_view otherwise) {
  const std::string near = first_name_of(suggest(word, known), known);
  const std::string other = proposal_by_name(word, known);
  if (!other.empty()) return other;
  return near.empty() ? std::string(otherwise) : fmt::format("; did you mean '{}'?", near);
}

std::string proposal(std::string_view word, const std::vector<std::string>& known) {
  if (known.empty()) return foreign_proposal(word, known);
  return proposal(word, known, fmt::format("; expected one of: {}", fmt::join(known, ", ")));
}

std::vector<std::string> keys_here(std::string_view word) {
  const std::string text = as_in_table(word);
  std::vector<std::string> keys;
  for (const ForeignName& row : names_of_others) {
    if (row.place == NamePlace::key && has_word(row, text)) keys.emplace_back(row.here);
  }
  return keys;
}

std::string key_proposal(std::string_view word, const std::vector<std::string>& known) {
  for (const std::string& here : keys_here(word)) {
    if (is_one_of(here, known)) return fmt::format("; did you mean '{}'?", here);
  }
  return did_you_mean(word, known);
}

}  // namespace noether
