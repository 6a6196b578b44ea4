#include "engine/bodies.hpp"

#include "numbers/error.hpp"
#include "numbers/quantity.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <utility>

namespace noether {

namespace {

std::string text_of(const Vec3<double>& v) {
  return fmt::format("[{}, {}, {}]", format_number(v[0]), format_number(v[1]), format_number(v[2]));
}

void check_mass(const std::string& name, double mass) {
  if (mass > 0 && std::isfinite(mass)) return;
  throw Error(fmt::format("the mass of body '{}' is {}; a mass above 0 is expected", name, format_number(mass)),
              {.key = "mass"});
}

/// @throws Error  for moments that are negative, or of which more than one is 0
void check_inertia(RigidBody& body) {
  const Vec3<double>& I = body.inertia;
  const bool finite = std::isfinite(I[0]) && std::isfinite(I[1]) && std::isfinite(I[2]);
  const int zeros = 3 - turning_freedoms(I);
  if (!finite || I.minCoeff() < 0 || zeros > 1) {
    throw Error(fmt::format("the moments of inertia of body '{}' are {}; three above 0 are expected, or one of 0 for a "
                            "body in a line",
                            body.name, text_of(I)),
                {.key = "inertia"});
  }
  std::array<double, 3> sorted = {I[0], I[1], I[2]};
  std::sort(sorted.begin(), sorted.end());
  if (zeros == 1 && sorted[1] != sorted[2]) {
    throw Error(fmt::format("the moments of inertia of body '{}' are {}; a body in a line has two that are equal",
                            body.name, text_of(I)),
                {.key = "inertia"});
  }
  if (sorted[0] + sorted[1] < sorted[2] * (1 - 1e-12)) {
    body.warning = fmt::format(
        "no mass has the moments of inertia {} of body '{}': the largest is above the sum of the others; they are "
        "followed as they are",
        text_of(I), body.name);
  }
}

/// Principal moments, ascending, and the rotation from the principal axes; axes that are principal already stay.
std::pair<Vec3<double>, Mat3<double>> principal_axes(const Mat3<double>& tensor) {
  const double size = tensor.diagonal().maxCoeff();
  const double off = std::max({std::fabs(tensor(0, 1)), std::fabs(tensor(0, 2)), std::fabs(tensor(1, 2))});
  if (off <= 1e-14 * size) return {tensor.diagonal(), Mat3<double>::Identity()};
  const Eigen::SelfAdjointEigenSolver<Mat3<double>> solver(tensor);
  Mat3<double> axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
  return {solver.eigenvalues(), axes};
}

/// The unit quaternion of a rotation, by its largest component. @source Shepperd1978
Quaternion<double> quaternion_of(const Mat3<double>& r) {
  const double trace = r(0, 0) + r(1, 1) + r(2, 2);
  int largest = -1;
  double most = trace;
  for (int k = 0; k < 3; ++k) {
    if (r(k, k) > most) most = r(k, k), largest = k;
  }
  Quaternion<double> q;
  if (largest < 0) {
    q << 1 + trace, r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1);
  } else {
    const int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
    q[0] = r(k, j) - r(j, k);
    q[1 + i] = 1 + 2 * r(i, i) - trace;
    q[1 + j] = r(i, j) + r(j, i);
    q[1 + k] = r(i, k) + r(k, i);
  }
  return q / std::sqrt(squared_length(q));
}

}  // namespace

bool Bodies::any_held() const {
  return std::any_of(kinds.begin(), kinds.end(), [](const BodyKind& kind) { return kind.held; });
}

Index Bodies::sites_beyond_one() const {
  Index count = 0;
  for (const int of : kind_of) count += of < 0 ? 0 : kinds[static_cast<std::size_t>(of)].massive_sites() - 1;
  return count;
}

Index BodyKind::massive_sites() const {
  return std::count_if(sites.begin(), sites.end(), [](const BodySite& site) { return site.mass > 0; });
}

RigidBody body_of_inertia(std::string name, double mass, const Vec3<double>& inertia) {
  RigidBody body{.name = std::move(name), .mass = mass, .inertia = inertia, .sites = {BodySite{.mass = mass}}};
  check_mass(body.name, mass);
  check_inertia(body);
  return body;
}

RigidBody top(std::string name, double mass, const Vec3<double>& inertia, const Vec3<double>& center) {
  RigidBody body = body_of_inertia(std::move(name), mass, inertia);
  body.held = true;
  body.center = center;
  // The second moments of its mass about the fixed point are no smaller than those of all of it at its centre.
  Mat3<double> beyond = -mass * center * center.transpose();
  for (int k = 0; k < 3; ++k) beyond(k, k) += (inertia[(k + 1) % 3] + inertia[(k + 2) % 3] - inertia[k]) / 2;
  const double least = Eigen::SelfAdjointEigenSolver<Mat3<double>>(beyond).eigenvalues().minCoeff();
  if (body.warning.empty() && least < -1e-12 * inertia.maxCoeff()) {
    body.warning = fmt::format(
        "no mass with its centre at {} has the moments of inertia {} of body '{}' about its fixed point; they are "
        "followed as they are",
        text_of(center), text_of(inertia), body.name);
  }
  body.sites[0].place = center;
  return body;
}

RigidBody ellipsoid(std::string name, double mass, const Vec3<double>& semi_axes) {
  if (!(semi_axes.minCoeff() > 0)) {
    throw Error(
        fmt::format("the semi-axes of body '{}' are {}; three lengths above 0 are expected", name, text_of(semi_axes)),
        {.key = "semi_axes"});
  }
  const Vec3<double> square = semi_axes.cwiseProduct(semi_axes);
  return body_of_inertia(std::move(name), mass,
                         mass / 5 * Vec3<double>(square[1] + square[2], square[0] + square[2], square[0] + square[1]));
}

RigidBody body_of_sites(std::string name, std::vector<BodySite> sites, std::optional<bool> linear, double straight) {
  RigidBody body{.name = std::move(name)};
  if (sites.size() < 2) {
    throw Error(fmt::format("body '{}' has {} site{}; two or more are expected, or its moments of inertia", body.name,
                            sites.size(), sites.size() == 1 ? "" : "s"),
                {.key = "sites"});
  }
  for (const BodySite& site : sites) {
    if (!(site.mass >= 0)) check_mass(body.name, site.mass);
    body.mass += site.mass;
    body.center += site.mass * site.place;
  }
  check_mass(body.name, body.mass);
  body.center /= body.mass;
  Mat3<double> tensor = Mat3<double>::Zero();
  for (BodySite& site : sites) {
    site.place -= body.center;
    tensor += site.mass * (norm2(site.place) * Mat3<double>::Identity() - site.place * site.place.transpose());
  }
  auto [moments, axes] = principal_axes(tensor);
  const double largest = moments.maxCoeff();
  Index line = 0;
  const bool in_a_line = moments.minCoeff(&line) <= straight * largest;
  if (!(largest > 0) || (in_a_line && !linear.value_or(true))) {
    throw Error(fmt::format("the sites of body '{}' are in a line, so it has only two moments of inertia; give linear "
                            "= true if that is meant",
                            body.name),
                {.key = "sites"});
  }
  if (linear.value_or(false) && !in_a_line) {
    throw Error(
        fmt::format("the sites of body '{}' are not in a line, though linear = true says so; take it out", body.name),
        {.key = "linear"});
  }
  if (in_a_line) {
    const double both = (moments.sum() - moments[line]) / 2;
    moments = Vec3<double>::Constant(both);
    moments[line] = 0;
  }
  body.inertia = moments;
  body.axes = quaternion_of(axes);
  for (BodySite& site : sites) {
    site.place = to_body(axes, site.place);
    if (!in_a_line) continue;
    const double along = site.place[line];
    site.place = Vec3<double>::Zero();
    site.place[line] = along;
  }
  body.sites = std::move(sites);
  return body;
}

namespace {

/// An orientation of any length as a unit quaternion. @throws Error  if it is 0 or not finite
Quaternion<double> unit_orientation(const RigidBody& body, const Quaternion<double>& given) {
  if (squared_length(given) == 1) return given;
  const double largest = given.cwiseAbs().maxCoeff();
  if (!(largest > 0) || !given.allFinite()) {
    throw Error(fmt::format("the orientation of body '{}' is [{}]; four numbers that are not all 0 are expected",
                            body.name, fmt::join(given.data(), given.data() + 4, ", ")),
                {.key = "orientation"});
  }
  const Quaternion<double> scaled = given * std::ldexp(1.0, -std::ilogb(largest));  // exact; its squares are in range
  return scaled / std::sqrt(squared_length(scaled));
}

/// The angular momentum in space.
Vec3<double> spin_of(const RigidBody& body, const BodyState& state, const Quaternion<double>& q) {
  const int ways = (state.spin ? 1 : 0) + (state.spin_in_body ? 1 : 0) + (state.angular_velocity ? 1 : 0) +
                   (state.spin_period ? 1 : 0);
  if (ways > 1) {
    throw Error(fmt::format("the rotation of body '{}' is given more than once; give one of spin, angular_velocity "
                            "and spin_period",
                            body.name),
                {.key = state.spin               ? "spin"
                        : state.angular_velocity ? "angular_velocity"
                                                 : "spin_period"});
  }
  const Mat3<double> r = rotation_matrix(q);
  const auto without_line = [&](Vec3<double> pi) {  // a body in a line has no turn about it
    const double size = std::sqrt(norm2(pi));
    for (int k = 0; k < 3; ++k) {
      if (body.inertia[k] > 0 || pi[k] == 0) continue;
      if (std::abs(pi[k]) > 1e-9 * size) {
        throw Error(
            fmt::format("body '{}' is a line, and has no spin about it; a spin across it is expected", body.name),
            {.key = state.angular_velocity ? "angular_velocity" : "spin"});
      }
      pi[k] = 0;
    }
    return pi;
  };
  const bool line = turning_freedoms(body.inertia) == 2;
  if (line && state.angular_velocity) static_cast<void>(without_line(*state.angular_velocity));
  if (state.spin) return line ? to_space(r, without_line(to_body(r, *state.spin))) : *state.spin;
  Vec3<double> in_body = state.spin_in_body.value_or(Vec3<double>::Zero());
  if (state.angular_velocity) in_body = state.angular_velocity->cwiseProduct(body.inertia);
  if (state.spin_period) {
    if (*state.spin_period == 0 || !std::isfinite(*state.spin_period)) {
      throw Error(fmt::format("the spin period of body '{}' is {}; a time other than 0 is expected", body.name,
                              format_number(*state.spin_period)),
                  {.key = "spin_period"});
    }
    Index axis = 2;  // of bodies with equal moments the last
    if (body.inertia[1] > body.inertia[axis]) axis = 1;
    if (body.inertia[0] > body.inertia[axis]) axis = 0;
    in_body[axis] = body.inertia[axis] * 2 * std::acos(-1.0) / *state.spin_period;
  }
  return to_space(r, line ? without_line(in_body) : in_body);
}

}  // namespace

Index add_body(ParticleSystem<double>& s, Bodies& bodies, const RigidBody& body, const BodyState& state) {
  const Quaternion<double> q = quaternion_product(unit_orientation(body, state.orientation), body.axes);
  const Vec3<double> spin = spin_of(body, state, q);
  for (const ColumnInfo& info : {column_info<BodyOrientation>(), column_info<BodySpin>(), column_info<BodyInertia>()}) {
    s.add_column(info);
  }
  const Index i = s.add(body.name, body.mass, state.x, body.held ? Vec3<double>::Zero().eval() : state.v);
  s.column<BodyOrientation>().set(i, q);
  s.column<BodySpin>().set(i, spin);
  s.column<BodyInertia>().set(i, body.inertia);
  const BodyKind kind{body.sites, body.held};
  const auto known = std::find(bodies.kinds.begin(), bodies.kinds.end(), kind);
  const auto at = static_cast<int>(known - bodies.kinds.begin());
  if (known == bodies.kinds.end()) bodies.kinds.push_back(kind);
  bodies.kind_of.resize(static_cast<std::size_t>(i), -1);
  bodies.kind_of.push_back(at);
  return i;
}

Index add_body(ParticleSystem<double>& s, const RigidBody& body, const BodyState& state) {
  Bodies bodies = s.bodies() != nullptr ? *s.bodies() : Bodies{};
  const Index i = add_body(s, bodies, body, state);
  s.set_bodies(std::make_shared<const Bodies>(std::move(bodies)));
  return i;
}

}  // namespace noether
