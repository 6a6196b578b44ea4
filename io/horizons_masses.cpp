// Masses that Horizons does not give: GM of the bodies that it names.
#include "io/horizons_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace noether::io {

namespace {

/// GM of a body, or of a planet with its moons (numbers 1 to 9) [km^3/s^2].
struct KnownMass {
  int number;
  double GM;
};

/// The outer planets without their moons, and the moons of all but Earth, are the solutions for satellites that JPL
/// lists beside DE440.
/// @source Park2021, NaifGm440
constexpr std::array known_masses = {
    KnownMass{10, 132712440041.27942},
    KnownMass{1, 22031.868551},
    KnownMass{2, 324858.592},
    KnownMass{3, 403503.235625},
    KnownMass{4, 42828.375816},
    KnownMass{5, 126712764.1},
    KnownMass{6, 37940584.8418},
    KnownMass{7, 5794556.4},
    KnownMass{8, 6836527.10058},
    KnownMass{9, 975.5},
    KnownMass{199, 22031.868551},
    KnownMass{299, 324858.592},
    KnownMass{399, 398600.435507},
    KnownMass{301, 4902.800118},
    KnownMass{499, 42828.37362069909},
    KnownMass{599, 126686531.9003704},
    KnownMass{699, 37931206.23436167},
    KnownMass{799, 5793951.256527211},
    KnownMass{899, 6835103.145462294},
    KnownMass{999, 869.6138177608748},
    KnownMass{401, 0.0007087546066894452},
    KnownMass{402, 9.615569648120313e-05},
    KnownMass{501, 5959.915466180539},
    KnownMass{502, 3202.712099607295},
    KnownMass{503, 9887.832752719638},
    KnownMass{504, 7179.283402579837},
    KnownMass{505, 0.1645634534798259},
    KnownMass{506, 0.1515524299611265},
    KnownMass{514, 0.030148},
    KnownMass{515, 0.000139},
    KnownMass{516, 0.002501},
    KnownMass{601, 2.503488768152587},
    KnownMass{602, 7.210366688598896},
    KnownMass{603, 41.21352885489587},
    KnownMass{604, 73.11607172482067},
    KnownMass{605, 153.9417519146563},
    KnownMass{606, 8978.137095521046},
    KnownMass{607, 0.3704913747932265},
    KnownMass{608, 120.5151060137642},
    KnownMass{609, 0.5547860052791678},
    KnownMass{610, 0.1265765099012197},
    KnownMass{611, 0.03512333288208074},
    KnownMass{612, 0.0004757419551776972},
    KnownMass{615, 0.0003718871247516475},
    KnownMass{616, 0.0107520800100761},
    KnownMass{617, 0.009290325122028795},
    KnownMass{701, 83.46344431770477},
    KnownMass{702, 85.09338094489388},
    KnownMass{703, 226.9437003741248},
    KnownMass{704, 205.3234302535623},
    KnownMass{705, 4.3195168992321},
    KnownMass{801, 1428.495462910464},
    KnownMass{803, 0.008530281246540886},
    KnownMass{804, 0.0235887319799217},
    KnownMass{805, 0.1167318403814998},
    KnownMass{806, 0.189898503906069},
    KnownMass{807, 0.2548437405693583},
    KnownMass{808, 2.583422379120727},
    KnownMass{901, 105.8799888601881},
    KnownMass{902, 0.00304817564816976},
    KnownMass{903, 0.003211039206155255},
    KnownMass{904, 0.001110040850536676},
};

/// GM of a minor planet [km^3/s^2].
struct KnownMinorPlanet {
  int number;
  std::string_view name;
  double GM;
};

/// The sixteen that move DE440 most.
/// @source Park2021, NaifGm440
constexpr std::array known_minor_planets = {
    KnownMinorPlanet{1, "Ceres", 62.62888864440993},       KnownMinorPlanet{2, "Pallas", 13.665878145967422},
    KnownMinorPlanet{3, "Juno", 1.920570700202589},        KnownMinorPlanet{4, "Vesta", 17.288232879171513},
    KnownMinorPlanet{7, "Iris", 1.1398723232184107},       KnownMinorPlanet{10, "Hygiea", 5.625147645385229},
    KnownMinorPlanet{15, "Eunomia", 2.0230209871098284},   KnownMinorPlanet{16, "Psyche", 1.5896582441709424},
    KnownMinorPlanet{31, "Euphrosyne", 1.079371457703356}, KnownMinorPlanet{52, "Europa", 2.6830359242821795},
    KnownMinorPlanet{65, "Cybele", 0.9381057563915133},    KnownMinorPlanet{87, "Sylvia", 2.168232073699691},
    KnownMinorPlanet{88, "Thisbe", 1.1898077088121908},    KnownMinorPlanet{107, "Camilla", 1.4437384031866},
    KnownMinorPlanet{511, "Davida", 3.8944831481705644},   KnownMinorPlanet{704, "Interamnia", 2.830409639329985},
};

/// Whether an object is a minor planet: "1 Ceres (A801 AA)", or with its number at NAIF, 2000001 or 20000001.
bool is_minor_planet(const HorizonsObject& object, const KnownMinorPlanet& known) {
  if (object.number == 2'000'000 + known.number || object.number == 20'000'000 + known.number) return true;
  const std::string called = fmt::format("{} {}", known.number, known.name);
  return !object.number && (object.text == called || object.text.starts_with(called + " ("));
}

}  // namespace

std::optional<double> known_GM(const HorizonsObject& object) {
  for (const KnownMass& one : known_masses) {
    if (one.number == object.number) return one.GM;
  }
  for (const KnownMinorPlanet& one : known_minor_planets) {
    if (is_minor_planet(object, one)) return one.GM;
  }
  return {};
}

}  // namespace noether::io
