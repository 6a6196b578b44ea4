#include "integrators/lie/group_system.hpp"

#include "integrators/lie/rotations_simd.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace noether {

namespace {

template <class Real, class V> void put_at(Vector<Real>& y, Index at, const V& v) {
  for (Index k = 0; k < v.size(); ++k) y[at + k] = v[k];
}

}  // namespace

template <class Real>
void GroupSystemField<Real>::act(const Vector<Real>& u, const Vector<Real>& y, Vector<Real>& out) {
  out.resize(size());
  const auto turn = [&](Index at, const Vec3<Real>& by) {
    put_at<Real>(out, at,
                 renormalized<Real>(quaternion_product<Real>(quaternion_at<Real>(y, at), rotation_by<Real>(by))));
  };
  for (Index i = 0; i < n_;) {
    if constexpr (std::is_same_v<Real, double>) i = rotation_kernels().turn(y.data(), u.data(), out.data(), i, n_);
    for (const Index end = std::min(i + lane_count, n_); i < end; ++i) turn(4 * i, triple_at<Real>(u, 3 * i));
  }
  for (Index i = 0; i < m_; ++i) {
    const Index at = 4 * n_ + 7 * i, from = 3 * n_ + 6 * i;
    const Vec3<Real> by = triple_at<Real>(u, from), way = way_of_motion<Real>(by, triple_at<Real>(u, from + 3));
    const Vec3<Real> gone = to_space<Real>(rotation_matrix<Real>(quaternion_at<Real>(y, at)), way);
    turn(at, by);
    put_at<Real>(out, at + 4, Vec3<Real>(triple_at<Real>(y, at + 4) + gone));
  }
  for (Index i = 0; i < k_; ++i) out[4 * n_ + 7 * m_ + i] = y[4 * n_ + 7 * m_ + i] + u[3 * n_ + 6 * m_ + i];
}

template <class Real>
void GroupSystemField<Real>::bracket(const Vector<Real>& u, const Vector<Real>& v, Vector<Real>& out) {
  out.setZero(algebra());
  for (Index i = 0; i < n_; ++i)
    put_at<Real>(out, 3 * i, cross<Real>(triple_at<Real>(v, 3 * i), triple_at<Real>(u, 3 * i)));
  for (Index i = 0; i < m_; ++i) {
    const Index at = 3 * n_ + 6 * i;
    const Vec3<Real> a = triple_at<Real>(u, at), b = triple_at<Real>(u, at + 3), c = triple_at<Real>(v, at),
                     d = triple_at<Real>(v, at + 3);
    put_at<Real>(out, at, cross<Real>(c, a));
    put_at<Real>(out, at + 3, Vec3<Real>(cross<Real>(c, b) + cross<Real>(d, a)));
  }
}

template <class Real>
void GroupSystemField<Real>::sizes(const Vector<Real>& y, const Vector<Real>& y1, double /*h*/,
                                   Vector<double>& out) const {
  out.setOnes(algebra());
  const auto larger = [&](Index at) {
    return std::max(std::abs(static_cast<double>(y[at])), std::abs(static_cast<double>(y1[at])));
  };
  for (Index i = 0; i < m_; ++i) {
    const Index at = 4 * n_ + 7 * i + 4;
    const double size = std::max({larger(at), larger(at + 1), larger(at + 2)});
    for (Index k = 0; k < 3; ++k) out[3 * n_ + 6 * i + 3 + k] = size;
  }
  for (Index i = 0; i < k_; ++i) out[3 * n_ + 6 * m_ + i] = larger(4 * n_ + 7 * m_ + i);
}

template <class Real> void GroupSystemField<Real>::bind(const ParticleSystem<Real>& s) {
  if (static_cast<Index>(s.variables().size()) == size() && s.size() == 0) return;
  throw Error(fmt::format("system '{}' has {} variables, but it was given {} and {} particles", this->claims().name,
                          size(), s.variables().size(), s.size()));
}
template <class Real> void GroupSystemField<Real>::check_start(const ParticleSystem<Real>& s) const {
  Vector<Real> y;
  gather(s, y);
  const auto check = [&](Index at, const char* of, Index which) {
    const double defect = std::abs(static_cast<double>(norm_defect<Real>(quaternion_at<Real>(y, at))));
    if (defect <= farthest_from_group) return;
    throw Error(
        fmt::format("the quaternion of {} {} of system '{}' is not a rotation: |q|^2 - 1 is {:.3g}, but at most "
                    "{:g} is expected",
                    of, which + 1, this->claims().name, defect, farthest_from_group),
        {.key = "start"});
  };
  for (Index i = 0; i < n_; ++i) check(4 * i, "rotation", i);
  for (Index i = 0; i < m_; ++i) check(4 * n_ + 7 * i, "motion", i);
}
template <class Real> void GroupSystemField<Real>::gather(const ParticleSystem<Real>& s, Vector<Real>& y) const {
  y.resize(size());
  for (Index i = 0; i < size(); ++i) y[i] = s.variables()[static_cast<std::size_t>(i)];
}
template <class Real> void GroupSystemField<Real>::scatter(const Vector<Real>& y, ParticleSystem<Real>& s) const {
  for (Index i = 0; i < size(); ++i) s.variables()[static_cast<std::size_t>(i)] = y[i];
}

template <class Real> void GroupSystemField<Real>::evaluate(const Real& t, const Vector<Real>& y, Vector<Real>& dy) {
  dy.resize(size());
  this->find_velocity(t, y, a_);
  const auto turn = [&](Index at, Index from) {
    const Quaternion<Real> by = quaternion<Real>(Real(0), Vec3<Real>(triple_at<Real>(a_, from) / Real(2)));
    put_at<Real>(dy, at, quaternion_product<Real>(quaternion_at<Real>(y, at), by));
  };
  for (Index i = 0; i < n_; ++i) turn(4 * i, 3 * i);
  for (Index i = 0; i < m_; ++i) {
    const Index at = 4 * n_ + 7 * i, from = 3 * n_ + 6 * i;
    turn(at, from);
    const Mat3<Real> r = rotation_matrix<Real>(quaternion_at<Real>(y, at));
    put_at<Real>(dy, at + 4, to_space<Real>(r, triple_at<Real>(a_, from + 3)));
  }
  for (Index i = 0; i < k_; ++i) dy[4 * n_ + 7 * m_ + i] = a_[3 * n_ + 6 * m_ + i];
}

template class GroupSystemField<double>;
template class GroupSystemField<Quad>;

}  // namespace noether
