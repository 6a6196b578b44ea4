/// The mesh of charges against what it is by definition, in double and in single precision, at every SIMD level.

#include "forces/charge_mesh.hpp"
#include "forces/particle_mesh_ewald.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/charged_liquid.hpp"
#include "tests/support/pair_forces.hpp"
#include "tests/support/settings.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <tuple>
#include <vector>

namespace noether {
namespace {

using Complex = std::complex<double>;
using Size = std::array<std::int64_t, 3>;

/// Fourier sums along one axis of an array of shape `size`, term by term.
std::vector<Complex> summed_along(int axis, double sign, const Size& size, const std::vector<Complex>& from) {
  const std::int64_t n = size[static_cast<std::size_t>(axis)];
  const std::int64_t stride = axis == 0 ? size[1] * size[2] : axis == 1 ? size[2] : 1;
  std::vector<Complex> turns;
  for (std::int64_t m = 0; m < n; ++m)
    turns.push_back(std::polar(1.0, sign * 2 * std::numbers::pi * double(m) / double(n)));
  std::vector<Complex> to(from.size());
  for (std::size_t at = 0; at < from.size(); ++at) {
    const std::int64_t k = static_cast<std::int64_t>(at) / stride % n;
    const std::int64_t first = static_cast<std::int64_t>(at) - k * stride;
    for (std::int64_t j = 0; j < n; ++j)
      to[at] += turns[static_cast<std::size_t>(j * k % n)] * from[static_cast<std::size_t>(first + j * stride)];
  }
  return to;
}

struct Waves {
  std::vector<Vec3<double>> forces;
  double energy = 0;
  Mat3<double> virial = Mat3<double>::Zero();
};

/// What smooth particle mesh Ewald says of waves (Essmann and others 1995), as it stands there: C = 1.
Waves by_definition(const ParticleSystem<double>& s, const detail::MeshLayout& layout) {
  const std::int64_t nx = layout.points[0], ny = layout.points[1], nz = layout.points[2];
  const Vec3<double>& edges = layout.edges;
  std::vector<Complex> mesh(static_cast<std::size_t>(nx * ny * nz));
  const auto visit = [&](Index i, const auto& body) {
    std::array<std::int64_t, 3> cell{};
    std::vector<detail::SplineWeights> weights;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Index>(k);
      const double u = s.positions()[i][axis] / edges[axis] * double(layout.points[k]);
      cell[k] = static_cast<std::int64_t>(u);
      weights.emplace_back(u - double(cell[k]), layout.order);
    }
    for (int a = 0; a < layout.order; ++a) {
      for (int b = 0; b < layout.order; ++b) {
        for (int c = 0; c < layout.order; ++c) {
          const std::int64_t x = (cell[0] + a) % nx, y = (cell[1] + b) % ny, z = (cell[2] + c) % nz;
          const auto at = [](int j) { return static_cast<std::size_t>(j); };
          const double u = weights[0].value[at(a)], v = weights[1].value[at(b)], w = weights[2].value[at(c)];
          const Vec3<double> slope(weights[0].slope[at(a)] * v * w * double(nx) / edges[0],
                                   u * weights[1].slope[at(b)] * w * double(ny) / edges[1],
                                   u * v * weights[2].slope[at(c)] * double(nz) / edges[2]);
          body(mesh[static_cast<std::size_t>((x * ny + y) * nz + z)], u * v * w, slope);
        }
      }
    }
  };
  const auto& q = s.column<Charge>();
  for (Index i = 0; i < s.size(); ++i)
    visit(i, [&](Complex& point, double weight, const Vec3<double>& /*slope*/) { point += q[i] * weight; });
  for (int axis = 0; axis < 3; ++axis) mesh = summed_along(axis, -1, layout.points, mesh);
  Waves all;
  std::array<std::vector<double>, 3> factors;
  for (std::size_t k = 0; k < 3; ++k) factors[k] = detail::spline_factors(layout.points[k], layout.order);
  for (std::size_t at = 0; at < mesh.size(); ++at) {
    const auto n = static_cast<std::int64_t>(at);
    const Size m = {n / (ny * nz), n / nz % ny, n % nz};
    Vec3<double> wave, odd;  // waves at the end of the mesh stand for both signs
    double b = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t folded = 2 * m[k] > layout.points[k] ? m[k] - layout.points[k] : m[k];
      wave[static_cast<Index>(k)] = 2 * std::numbers::pi * double(folded) / edges[static_cast<Index>(k)];
      odd[static_cast<Index>(k)] = 2 * m[k] == layout.points[k] ? 0 : wave[static_cast<Index>(k)];
      b *= factors[k][static_cast<std::size_t>(m[k])];
    }
    const double k2 = wave.squaredNorm(), volume = edges[0] * edges[1] * edges[2];
    const double D =
        k2 == 0 ? 0 : 4 * std::numbers::pi * b * std::exp(-k2 / (4 * layout.alpha * layout.alpha)) / (k2 * volume);
    const double energy = D * std::norm(mesh[at]) / 2;
    all.energy += energy;
    if (k2 > 0) {
      Mat3<double> product = odd * odd.transpose();
      product.diagonal() = wave.cwiseProduct(wave);
      const double by = 2 * (1 / k2 + 1 / (4 * layout.alpha * layout.alpha));
      all.virial += energy * (Mat3<double>::Identity() - by * product);
    }
    mesh[at] *= D;
  }
  for (int axis = 0; axis < 3; ++axis) mesh = summed_along(axis, 1, layout.points, mesh);
  for (Index i = 0; i < s.size(); ++i) {
    Vec3<double> force = Vec3<double>::Zero();
    visit(i,
          [&](Complex& point, double /*weight*/, const Vec3<double>& slope) { force -= q[i] * point.real() * slope; });
    all.forces.push_back(force);
  }
  return all;
}

/// The same by the mesh; without energies in single precision.
template <class T> Waves by_mesh(const ParticleSystem<double>& s, const detail::MeshLayout& layout) {
  detail::ChargeMesh<T> mesh;
  detail::ChargeTiles tiles;
  mesh.lay(layout);
  tiles.lay(layout.points, layout.order - 1, s.size());
  tiles.sort(s, s.column<Charge>().data());
  double strongest = 0;
  for (Index i = 0; i < s.size(); ++i) strongest = std::max(strongest, std::abs(s.column<Charge>()[i]));
  detail::MeshSums sums;
  mesh.solve(tiles, strongest, 1, std::is_same_v<T, double> ? &sums : nullptr);
  VectorColumn<double> a(s.size());
  mesh.add_accelerations(a, s, tiles);
  Waves all{{}, sums.energy, sums.virial};
  for (Index i = 0; i < s.size(); ++i) all.forces.push_back(a[i]);
  return all;
}

double largest_difference(const std::vector<Vec3<double>>& a, const std::vector<Vec3<double>>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).cwiseAbs().maxCoeff());
  return most;
}
double largest(const std::vector<Vec3<double>>& a) {
  return largest_difference(a, std::vector<Vec3<double>>(a.size(), Vec3<double>::Zero()));
}

/// Charges of all sizes up to 2 anywhere in a box, some on points and faces of any mesh.
ParticleSystem<double> scattered(Index count, const Vec3<double>& edges) {
  ParticleSystem<double> s(unit_system("reduced"));
  s.set_box(Box::periodic(edges));
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> anywhere(0, 1);
  const double last = std::nextafter(1.0, 0.0);
  for (Index i = 0; i < count; ++i) {
    Vec3<double> x(anywhere(random), anywhere(random), anywhere(random));
    if (i == 0) x = {0, 0, 0};
    if (i == 1) x = {last, last, last};
    if (i == 2) x = {0.5, 0, last};
    s.add("", 1, Vec3<double>(x.cwiseProduct(edges)), {0, 0, 0});
  }
  auto& q = s.add_column<Charge>();
  for (Index i = 0; i < count; ++i) q[i] = i % 7 == 6 ? 0 : 4 * anywhere(random) - 2;
  return s;
}

}  // namespace

TEST_CASE("the mesh is what its definition says, for every order, factor of its size and SIMD level", "[mesh]") {
  const Vec3<double> edges(3, 4, 3.5);
  const ParticleSystem<double> s = scattered(30, edges);
  int order = detail::least_order;
  for (const Size& points : std::vector<Size>{{4, 4, 4},
                                              {5, 7, 9},
                                              {10, 6, 14},
                                              {12, 15, 8},
                                              {8, 9, 25},
                                              {27, 8, 10},
                                              {7, 16, 21},
                                              {9, 35, 12},
                                              {18, 20, 8},
                                              {49, 8, 30}}) {
    const detail::MeshLayout layout{.points = points, .order = order, .alpha = 1.5, .edges = edges};
    CAPTURE(points[0], points[1], points[2], order);
    const Waves exact = by_definition(s, layout);
    const double force = largest(exact.forces);
    for (const SimdLevel level : test::all_levels()) {
      CAPTURE(name(level));
      const test::AtLevel now(level);
      const Waves mesh = by_mesh<double>(s, layout), single = by_mesh<float>(s, layout);
      CHECK(largest_difference(mesh.forces, exact.forces) < 1e-13 * force);
      CHECK(largest_difference(single.forces, exact.forces) < 2e-6 * force);
      CHECK(std::abs(mesh.energy - exact.energy) < 1e-14 * exact.energy);
      CHECK((mesh.virial - exact.virial).cwiseAbs().maxCoeff() < 1e-13 * exact.energy);
    }
    order = order == std::min<std::int64_t>(detail::largest_order, *std::min_element(points.begin(), points.end()))
                ? detail::least_order
                : order + 1;
  }
}

TEST_CASE("bits of the mesh depend on no thread and on nothing that was on it before", "[mesh][determinism]") {
  const Vec3<double> edges(5, 6, 7);
  const ParticleSystem<double> s = scattered(600, edges), before = scattered(90, edges);
  for (int order = detail::least_order; order <= detail::largest_order; ++order) {
    CAPTURE(order);
    const detail::MeshLayout layout{.points = {32, 30, 28}, .order = order, .alpha = 2, .edges = edges};
    const auto all = [&](auto type, int threads) {
      using T = decltype(type);
      const test::Threads now(threads);
      detail::ChargeMesh<T> mesh;
      detail::ChargeTiles tiles;
      mesh.lay(layout);
      std::vector<double> found;
      for (const ParticleSystem<double>* one : {&before, &s}) {
        tiles.lay(layout.points, order - 1, one->size());
        tiles.sort(*one, one->column<Charge>().data());
        detail::MeshSums sums;
        mesh.solve(tiles, 2, 1, std::is_same_v<T, double> ? &sums : nullptr);
        VectorColumn<double> a(one->size());
        mesh.add_accelerations(a, *one, tiles);
        found = {sums.energy, sums.virial(0, 0), sums.virial(0, 1), sums.virial(1, 2)};
        for (Index i = 0; i < one->size(); ++i) found.insert(found.end(), {a[i][0], a[i][1], a[i][2]});
      }
      return found;
    };
    const std::vector<double> first = all(double(), 1), single = all(float(), 1);
    const Waves fresh = by_mesh<double>(s, layout);
    CHECK(first[0] == fresh.energy);
    CHECK(first.back() == fresh.forces.back()[2]);
    for (const int threads : {2, 3, 7}) {
      CHECK(all(double(), threads) == first);
      CHECK(all(float(), threads) == single);
    }
  }
}

TEST_CASE("no charge is too large for the mesh's whole numbers, nor are too many at one point", "[mesh]") {
  const Vec3<double> edges(3, 3, 3);
  for (const Index count : {Index(2), Index(300), Index(5000)}) {
    for (const double strong : {1e-30, 1e-6, 1.0, 1e3, 1e30}) {
      CAPTURE(count, strong);
      ParticleSystem<double> s(unit_system("reduced"));
      s.set_box(Box::periodic(edges));
      for (Index i = 0; i < count; ++i) s.add("", 1, {1.5, 1.5, 1.5}, {0, 0, 0});  // all on one point
      s.add("", 1, {0.7, 1.4, 2.9}, {0, 0, 0});
      auto& q = s.add_column<Charge>();
      for (Index i = 0; i < count; ++i) q[i] = strong;
      q[count] = 1e-9 * strong;
      ParticleSystem<double> one(unit_system("reduced"));
      one.set_box(Box::periodic(edges));
      one.add("", 1, {1.5, 1.5, 1.5}, {0, 0, 0});
      one.add("", 1, {0.7, 1.4, 2.9}, {0, 0, 0});
      one.add_column<Charge>()[0] = static_cast<double>(count) * strong;
      one.column<Charge>()[1] = 1e-9 * strong;
      const detail::MeshLayout layout{.points = {12, 12, 12}, .order = 5, .alpha = 2, .edges = edges};
      const Waves expected = by_definition(one, layout);
      const double force = expected.forces.back().cwiseAbs().maxCoeff();
      CHECK(std::abs(by_mesh<double>(s, layout).energy / expected.energy - 1) < 1e-13);
      CHECK(largest_difference({by_mesh<double>(s, layout).forces.back()}, {expected.forces.back()}) < 1e-12 * force);
      // At each of 125 points the parts of the charges are rounded to half of 2^-29 of a fifth of them all.
      const double lost = 2e-6 + 125 * 0.1 * 0x1p-29 * static_cast<double>(count);
      CHECK(largest_difference({by_mesh<float>(s, layout).forces.back()}, {expected.forces.back()}) < lost * force);
    }
  }
}

TEST_CASE("forces of mixed precision are those of doubles to single precision, and energies are the same", "[mesh]") {
  const ParticleSystem<double> s = test::with_special_pairs(test::charged_liquid(4));
  const double typical = s.units().coulomb_constant * std::pow(0.8, 2.0 / 3);  // as in relative_error
  for (const std::int64_t order : {4, 5, 6, 7, 8}) {
    CAPTURE(order);
    ParticleMeshEwald force{.cutoff = 2.4, .relative_error = 1e-5, .order = order};
    const test::Evaluated doubles = test::evaluated<double>(AnyForce<double>(force), s);
    force.precision = PairPrecision::mixed;
    const test::Evaluated mixed = test::evaluated<double>(AnyForce<double>(force), s);
    const double error = std::sqrt((mixed.a.all() - doubles.a.all()).squaredNorm() / static_cast<double>(s.size()));
    CAPTURE(error / typical);
    const ChosenMesh chosen = *force.chosen_for(s);
    const double told = detail::single_precision_error(
        chosen.alpha, s.box().edges()[0] / static_cast<double>(chosen.points[0]), std::cbrt(1 / 0.8));
    CAPTURE(told);
    CHECK(error < told * typical);
    CHECK(error > told * typical / 20);
    CHECK(mixed.energy == doubles.energy);
    CHECK(mixed.virial == doubles.virial);
  }
}

}  // namespace noether
