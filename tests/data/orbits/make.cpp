// Writes where the starts of the files of this folder lead: Taylor series of degree 30 in double-double.
//
//     g++ -std=c++20 -O2 -mfma -ffp-contract=off -o make make.cpp
//     ./make triple.txt                # writes the ends anew
//     ./make --check triple.txt        # says how far the ends of the file are from those of steps a fifth shorter
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace {

/// A number as the sum of two doubles.
struct Wide {
  double high = 0, low = 0;
  Wide(double a = 0, double b = 0) : high(a), low(b) {}
};
Wide ordered(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}
Wide operator+(const Wide& a, const Wide& b) {
  const double s = a.high + b.high, w = s - a.high, e = (a.high - (s - w)) + (b.high - w);
  const double t = a.low + b.low, u = t - a.low, g = (a.low - (t - u)) + (b.low - u);
  const Wide q = ordered(s, e + t);
  return ordered(q.high, q.low + g);
}
Wide operator-(const Wide& a) { return {-a.high, -a.low}; }
Wide operator-(const Wide& a, const Wide& b) { return a + -b; }
Wide operator*(const Wide& a, const Wide& b) {
  const double p = a.high * b.high;
  return ordered(p, std::fma(a.high, b.low, std::fma(a.low, b.high, std::fma(a.high, b.high, -p))));
}
Wide operator/(const Wide& a, const Wide& b) {
  const double q = a.high / b.high;
  Wide left = a - Wide(q) * b;
  const double more = left.high / b.high;
  left = left - Wide(more) * b;
  return ordered(q, more) + Wide(left.high / b.high);
}
Wide root(const Wide& x) {
  Wide y(1 / std::sqrt(x.high));
  for (int k = 0; k < 2; ++k) y = y + y * (Wide(1) - x * y * y) * Wide(0.5);
  return x * y;
}

constexpr int degree = 30;
using Series = std::array<Wide, degree + 2>;

/// Bodies on their way, with the series of their coordinates and those of one pair.
struct Bodies {
  std::vector<Wide> mu, x, v;
  std::vector<Series> q;  ///< of coordinates
  struct Pair {
    std::size_t i, j;
    std::array<Series, 3> d;
    Series r2, cube;  ///< r^2 and r^-3
  };
  std::vector<Pair> pairs;

  /// Coefficient `o` of all that belongs to a pair: r^2 (r^-3)' = -3/2 (r^2)' r^-3.
  void extend(Pair& p, int o) const {
    const auto at = static_cast<std::size_t>(o);
    Wide square;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Series& d = p.d[axis];
      d[at] = q[3 * p.j + axis][at] - q[3 * p.i + axis][at];
      for (std::size_t k = 0; k <= at; ++k) square = square + d[k] * d[at - k];
    }
    p.r2[at] = square;
    if (o == 0) {
      p.cube[0] = Wide(1) / (square * root(square));
      return;
    }
    Wide sum;
    for (int k = 0; k < o; ++k) {
      const auto l = static_cast<std::size_t>(k);
      sum = sum + Wide(-1.5 * (o - k) - k) * p.r2[at - l] * p.cube[l];
    }
    p.cube[at] = sum / (Wide(o) * p.r2[0]);
  }
  /// All coefficients from positions and velocities.
  void expand() {
    for (std::size_t k = 0; k < x.size(); ++k) {
      q[k][0] = x[k];
      q[k][1] = v[k];
    }
    for (int o = 0; o < degree; ++o) {
      const auto at = static_cast<std::size_t>(o);
      std::vector<Wide> pull(x.size());
      for (Pair& p : pairs) {
        extend(p, o);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          Wide sum;
          for (std::size_t k = 0; k <= at; ++k) sum = sum + p.d[axis][k] * p.cube[at - k];
          pull[3 * p.i + axis] = pull[3 * p.i + axis] + mu[p.j] * sum;
          pull[3 * p.j + axis] = pull[3 * p.j + axis] - mu[p.i] * sum;
        }
      }
      for (std::size_t k = 0; k < x.size(); ++k) q[k][at + 2] = pull[k] / Wide((o + 1.0) * (o + 2.0));
    }
  }
  /// The radius in which the series converge, from the last coefficients of r^2.
  double radius() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Pair& p : pairs) {
      for (int o = degree - 3; o < degree; ++o) {
        const double part = std::abs(p.r2[static_cast<std::size_t>(o)].high) / p.r2[0].high;
        if (part > 0) least = std::min(least, std::pow(part, -1.0 / o));
      }
    }
    return least;
  }
  void go(double until, double part) {
    Wide t;
    while (true) {
      expand();
      const double h = part * radius();
      const Wide left = Wide(until) - t;
      const bool last = h >= left.high;
      const Wide step = last ? left : Wide(h);
      for (std::size_t k = 0; k < x.size(); ++k) {
        Wide value, slope;
        for (std::size_t o = degree + 2; o-- > 0;) {
          slope = slope * step + value;
          value = value * step + q[k][o];
        }
        x[k] = value;
        v[k] = slope;
      }
      if (last) return;
      t = t + step;
    }
  }
};

void put(std::ostream& out, double x, int digits, char behind) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g%c", digits, x, behind);
  out << text;
}

int redo(const std::string& name, bool check) {
  std::ifstream file(name);
  std::string text, line, head;
  while (std::getline(file, line)) {
    if (line[0] != '#') text += line + '\n';
    if (head.empty()) head = line;
  }
  std::istringstream in(text);
  double G = 0, until = 0, step = 0;
  int n = 0, about = 0, starts = 0;
  in >> G >> until >> step >> n >> about >> starts;
  std::vector<double> masses(static_cast<std::size_t>(n));
  for (double& m : masses) in >> m;
  std::ostringstream out;
  out << head << '\n';
  for (const double x : {G, until, step}) put(out, x, 17, ' ');
  out << n << ' ' << about << ' ' << starts << '\n';
  for (const double m : masses) put(out, m, 17, '\n');
  double worst = 0;
  for (int k = 0; k < starts; ++k) {
    Bodies s;
    std::vector<double> begin;
    std::vector<Wide> before;
    for (std::size_t i = 0; i < masses.size(); ++i) {
      s.mu.push_back(Wide(G) * Wide(masses[i]));
      for (std::size_t j = i + 1; j < masses.size(); ++j) s.pairs.push_back({i, j, {}, {}, {}});
      double x[6], e[6];
      for (double& one : x) in >> one;
      for (double& one : e) in >> one;
      for (int axis = 0; axis < 3; ++axis) {
        s.x.emplace_back(x[axis]);
        s.v.emplace_back(x[3 + axis]);
        before.emplace_back(e[2 * axis], e[2 * axis + 1]);
      }
      begin.insert(begin.end(), x, x + 6);
    }
    s.q.resize(s.x.size());
    s.go(until, check ? 0.112 : 0.14);
    out << "# start " << k << ": x and v, then x at the end in two words\n";
    for (std::size_t i = 0; i < masses.size(); ++i) {
      for (std::size_t c = 0; c < 6; ++c) put(out, begin[6 * i + c], 17, c == 5 ? '\n' : ' ');
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Wide& end = s.x[3 * i + axis];
        worst = std::max(worst, std::abs((end - before[3 * i + axis]).high));
        put(out, end.high, 17, ' ');
        put(out, end.low, 6, axis == 2 ? '\n' : ' ');
      }
    }
  }
  if (!in) {
    std::printf("%s: no such file, or one that ends too early\n", name.c_str());
    return 1;
  }
  std::printf("%s: ends differ from those of the file by %.1e at most\n", name.c_str(), worst);
  if (!check) std::ofstream(name) << out.str();
  return check && worst > 1e-17 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const bool check = argc > 1 && std::string(argv[1]) == "--check";
  int failed = 0;
  for (int k = check ? 2 : 1; k < argc; ++k) failed += redo(argv[k], check);
  return failed;
}
