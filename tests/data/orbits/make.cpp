// Writes where the starts of the files of this folder lead: Taylor series of degree 30 in double-double, eight starts
// side by side in the lanes of a register.
//
//     g++ -std=c++20 -O3 -march=native -Wno-psabi -ffp-contract=off -o make make.cpp
//     ./make triple.txt                # writes the ends anew
//     ./make --starts 16 triple.txt    # draws the starts that the file lacks, and writes their ends behind the others
//     ./make --check triple.txt        # says how far the ends of the file are from those of steps a fifth shorter
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace {

constexpr std::size_t lanes = 8;
using Lanes [[gnu::vector_size(lanes * sizeof(double))]] = double;

Lanes fused(const Lanes& a, const Lanes& b, const Lanes& c) {
  Lanes value;
  for (std::size_t k = 0; k < lanes; ++k) value[k] = __builtin_fma(a[k], b[k], c[k]);
  return value;
}

/// A number of each start as the sum of two doubles.
struct Wide {
  Lanes high, low;
  Wide(double a = 0) : high(Lanes{} + a), low(Lanes{}) {}
  Wide(const Lanes& a, const Lanes& b) : high(a), low(b) {}
};
Wide ordered(const Lanes& a, const Lanes& b) {
  const Lanes s = a + b;
  return {s, b - (s - a)};
}
Wide operator+(const Wide& a, const Wide& b) {
  const Lanes s = a.high + b.high, w = s - a.high, e = (a.high - (s - w)) + (b.high - w);
  const Lanes t = a.low + b.low, u = t - a.low, g = (a.low - (t - u)) + (b.low - u);
  const Wide q = ordered(s, e + t);
  return ordered(q.high, q.low + g);
}
Wide operator-(const Wide& a) { return {-a.high, -a.low}; }
Wide operator-(const Wide& a, const Wide& b) { return a + -b; }
Wide operator*(const Wide& a, const Wide& b) {
  const Lanes p = a.high * b.high;
  return ordered(p, fused(a.high, b.low, fused(a.low, b.high, fused(a.high, b.high, -p))));
}
/// A sum of products, whose low words are those of all of them.
struct Products {
  Lanes high{}, low{};
  void add(const Wide& a, const Wide& b) {
    const Lanes p = a.high * b.high, s = high + p, w = s - high, e = (high - (s - w)) + (p - w);
    low += fused(a.high, b.low, fused(a.low, b.high, fused(a.high, b.high, -p) + e));
    high = s;
  }
  Wide value() const { return ordered(high, low); }
};
Wide operator/(const Wide& a, const Wide& b) {
  const Lanes none{}, q = a.high / b.high;
  Wide left = a - Wide(q, none) * b;
  const Lanes more = left.high / b.high;
  left = left - Wide(more, none) * b;
  return ordered(q, more) + Wide(left.high / b.high, none);
}
Wide root(const Wide& x) {
  Wide y;
  for (std::size_t k = 0; k < lanes; ++k) y.high[k] = 1 / std::sqrt(x.high[k]);
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
    Series r2, cube, slope;  ///< r^2, r^-3 and t times the derivative of r^-3
  };
  std::vector<Pair> pairs;

  /// Coefficient `o` of all that belongs to a pair: r^2 (r^-3)' = -3/2 (r^2)' r^-3.
  void extend(Pair& p, int o) const {
    const auto at = static_cast<std::size_t>(o);
    Products square;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Series& d = p.d[axis];
      d[at] = q[3 * p.j + axis][at] - q[3 * p.i + axis][at];
      for (std::size_t k = 0; 2 * k < at; ++k) square.add(d[k], d[at - k]);
    }
    p.r2[at] = Wide(2) * square.value();
    if (o % 2 == 0) {
      for (const Series& d : p.d) p.r2[at] = p.r2[at] + d[at / 2] * d[at / 2];
    }
    if (o == 0) {
      p.cube[0] = Wide(1) / (p.r2[0] * root(p.r2[0]));
      p.slope[0] = Wide(0);
      return;
    }
    Products plain, sloped;
    for (std::size_t k = 0; k < at; ++k) {
      plain.add(p.r2[at - k], p.cube[k]);
      sloped.add(p.r2[at - k], p.slope[k]);
    }
    p.slope[at] = (Wide(-1.5 * o) * plain.value() + Wide(0.5) * sloped.value()) / p.r2[0];
    p.cube[at] = p.slope[at] / Wide(o);
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
          Products products;
          for (std::size_t k = 0; k <= at; ++k) products.add(p.d[axis][k], p.cube[at - k]);
          const Wide sum = products.value();
          pull[3 * p.i + axis] = pull[3 * p.i + axis] + mu[p.j] * sum;
          pull[3 * p.j + axis] = pull[3 * p.j + axis] - mu[p.i] * sum;
        }
      }
      for (std::size_t k = 0; k < x.size(); ++k) q[k][at + 2] = pull[k] / Wide((o + 1.0) * (o + 2.0));
    }
  }
  /// The radius in which the series of all starts converge, from the last coefficients of r^2.
  double radius() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Pair& p : pairs) {
      for (int o = degree - 3; o < degree; ++o) {
        double part = 0;
        for (std::size_t k = 0; k < lanes; ++k) {
          part = std::max(part, std::abs(p.r2[static_cast<std::size_t>(o)].high[k]) / p.r2[0].high[k]);
        }
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
      const bool last = h >= left.high[0];
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

struct Start {
  std::vector<double> begin;               ///< x and v, body by body
  std::vector<std::array<double, 2>> end;  ///< coordinates, in two words
};

/// Start 0 is the system; of the others all coordinates, then all velocities, are multiplied by 1 + 1e-10 u, u from -1
/// to 1.
std::vector<double> drawn(const std::vector<double>& system, int number) {
  std::uint64_t state = 88172645463325252ULL + 7919 * static_cast<std::uint64_t>(number);
  std::vector<double> moved = system;
  for (const std::size_t first : {0U, 3U}) {
    for (std::size_t k = first; k < system.size(); k += k % 3 == 2 ? 4 : 1) {
      state ^= state << 13;
      state ^= state >> 7;
      state ^= state << 17;
      const double u = static_cast<double>(state >> 11) / 9007199254740992.0 * 2 - 1;
      if (number > 0) moved[k] *= 1 + 1e-10 * u;
    }
  }
  return moved;
}

/// What a file holds.
struct Orbits {
  std::string name, head;
  double G = 0, until = 0, step = 0;
  int n = 0, about = 0;
  std::vector<double> masses;
  std::vector<Start> starts;

  bool read(const std::string& from) {
    name = from;
    std::ifstream file(name);
    std::string text, line;
    while (std::getline(file, line)) {
      if (line[0] != '#') text += line + '\n';
      if (head.empty()) head = line;
    }
    std::istringstream in(text);
    std::size_t count = 0;
    in >> G >> until >> step >> n >> about >> count;
    if (!in) return false;
    masses.resize(static_cast<std::size_t>(n));
    for (double& m : masses) in >> m;
    starts.resize(count);
    for (Start& start : starts) {
      start.begin.resize(6 * masses.size());
      start.end.resize(3 * masses.size());
      for (std::size_t i = 0; i < masses.size(); ++i) {
        for (std::size_t c = 0; c < 6; ++c) in >> start.begin[6 * i + c];
        for (std::size_t c = 0; c < 3; ++c) in >> start.end[3 * i + c][0] >> start.end[3 * i + c][1];
      }
    }
    return static_cast<bool>(in);
  }

  void write() const {
    std::ofstream out(name);
    const auto put = [&](double x, int digits, char behind) {
      char text[40];
      std::snprintf(text, sizeof text, "%.*g%c", digits, x, behind);
      out << text;
    };
    out << head << '\n';
    for (const double x : {G, until, step}) put(x, 17, ' ');
    out << n << ' ' << about << ' ' << starts.size() << '\n';
    for (const double m : masses) put(m, 17, '\n');
    for (std::size_t k = 0; k < starts.size(); ++k) {
      out << "# start " << k << ": x and v, then x at the end in two words\n";
      for (std::size_t i = 0; i < masses.size(); ++i) {
        for (std::size_t c = 0; c < 6; ++c) put(starts[k].begin[6 * i + c], 17, c == 5 ? '\n' : ' ');
        for (std::size_t c = 0; c < 3; ++c) {
          put(starts[k].end[3 * i + c][0], 17, ' ');
          put(starts[k].end[3 * i + c][1], 6, c == 2 ? '\n' : ' ');
        }
      }
    }
  }

  /// Where the starts from `first` on lead, with steps of `part` of the radius of convergence.
  std::vector<Start> followed(std::size_t first, double part) const {
    std::vector<Start> found(starts.begin() + static_cast<std::ptrdiff_t>(first), starts.end());
    for (std::size_t group = 0; group < found.size(); group += lanes) {
      const auto in_lane = [&](std::size_t k) -> Start& { return found[std::min(group + k, found.size() - 1)]; };
      Bodies s;
      for (std::size_t i = 0; i < masses.size(); ++i) {
        s.mu.push_back(Wide(G) * Wide(masses[i]));
        for (std::size_t j = i + 1; j < masses.size(); ++j) s.pairs.push_back({i, j, {}, {}, {}, {}});
        for (std::size_t c = 0; c < 3; ++c) {
          Wide x, v;
          for (std::size_t k = 0; k < lanes; ++k) {
            x.high[k] = in_lane(k).begin[6 * i + c];
            v.high[k] = in_lane(k).begin[6 * i + 3 + c];
          }
          s.x.push_back(x);
          s.v.push_back(v);
        }
      }
      s.q.resize(s.x.size());
      s.go(until, part);
      for (std::size_t k = 0; k < lanes; ++k) {
        for (std::size_t c = 0; c < s.x.size(); ++c) in_lane(k).end[c] = {s.x[c].high[k], s.x[c].low[k]};
      }
    }
    return found;
  }
};

int redo(const std::string& name, bool check, int count) {
  Orbits file;
  if (!file.read(name)) {
    std::printf("%s: no such file, or one that ends too early\n", name.c_str());
    return 1;
  }
  const std::size_t before = file.starts.size();
  for (std::size_t k = 0; k < before; ++k) {
    if (drawn(file.starts[0].begin, static_cast<int>(k)) == file.starts[k].begin) continue;
    std::printf("%s: start %zu is not the one that is drawn\n", name.c_str(), k);
    return 1;
  }
  for (int k = static_cast<int>(before); k < count; ++k) {
    file.starts.push_back({drawn(file.starts[0].begin, k), std::vector<std::array<double, 2>>(3 * file.masses.size())});
  }
  const std::size_t first = count > 0 ? before : 0;
  const std::vector<Start> found = file.followed(first, check ? 0.09 : 0.112);
  double worst = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    Start& known = file.starts[first + k];
    for (std::size_t c = 0; c < known.end.size(); ++c) {
      const auto& [high, low] = found[k].end[c];
      worst = std::max(worst, std::abs((high - known.end[c][0]) + (low - known.end[c][1])));
    }
    if (!check) known = found[k];
  }
  if (count > 0) {
    std::printf("%s: %zu starts more\n", name.c_str(), found.size());
  } else {
    std::printf("%s: ends differ from those of the file by %.1e at most\n", name.c_str(), worst);
  }
  if (!check) file.write();
  return check && worst > 1e-17 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string option = argc > 1 ? argv[1] : "";
  const bool check = option == "--check";
  const int count = option == "--starts" && argc > 2 ? std::atoi(argv[2]) : 0;
  int failed = 0;
  for (int k = check ? 2 : count > 0 ? 3 : 1; k < argc; ++k) failed += redo(argv[k], check, count);
  return failed;
}
