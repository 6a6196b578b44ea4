// Writes where the starts of this folder lead by the plain Wisdom-Holman map: the same map in double-double, four
// starts side by side in the lanes of a register.
//
//     g++ -std=c++20 -O3 -march=x86-64-v3 -ffp-contract=off -o make make.cpp
//     ./make > starts.txt        # hundreds of seconds; lines come as they are found
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

constexpr int lanes = 4, planets = 8;
constexpr double G = 0.01720209895 * 0.01720209895, step = 5;
/// Mass, x, v of the Sun and of eight planets [Msun, au, au/day]: examples/solar_system/planets.csv.
constexpr double bodies[planets + 1][7] = {
    {0.9999999999950272, -0.008816286905115728, -0.0010954664916791675, 0.0002143249385447027, 2.4626088049112407e-06,
     -8.450431028913674e-06, 1.3981313084008716e-08},
    {1.6601208254808336e-07, -0.05942272929227954, -0.46308699693348293, -0.032897989948949075, 0.022326026726528347,
     -0.0016384210481880026, -0.0021808088866929454},
    {2.447838287784771e-06, -0.7276101005375593, 0.006575003332463933, 0.041795901908847084, -0.000330964640457111,
     -0.020322517851845318, -0.00025964720760710317},
    {3.0404326489511185e-06, -0.5789530452882667, -0.8361530119313055, 0.0002611520181901174, 0.013931485484678471,
     -0.00977508675807662, 4.5017716254568716e-07},
    {3.2271560828978514e-07, -1.45202492400084, 0.827519404194876, 0.052981833432457694, -0.006439849625416687,
     -0.01095058361496278, -7.128433278666672e-05},
    {0.0009547919099366768, 4.492983939852296, 2.0661626247490354, -0.10909246996001629, -0.003237247138253835,
     0.0072110416019303515, 4.2507241491783904e-05},
    {0.0002858856700231729, 8.4974210980544, -4.8620394993693585, -0.2537835862373596, 0.002458577049870912,
     0.004831513836068394, -0.00018189995835393385},
    {4.366249613200406e-05, 12.959111916929283, 14.760785302864473, -0.1130656917933948, -0.0029845143668378814,
     0.00241165084768749, 4.7621404630788873e-05},
    {5.151383772628957e-05, 29.787987348666505, -2.51460654509393, -0.6347108842010732, 0.00024328838435528244,
     0.0031466270123719988, -7.040553788324119e-05}};

using Lanes [[gnu::vector_size(lanes * sizeof(double))]] = double;

Lanes same(double a) { return Lanes{} + a; }
Lanes fused(const Lanes& a, const Lanes& b, const Lanes& c) {
  Lanes value;
  for (int k = 0; k < lanes; ++k) value[k] = __builtin_fma(a[k], b[k], c[k]);
  return value;
}
Lanes root(const Lanes& a) {
  Lanes value;
  for (int k = 0; k < lanes; ++k) value[k] = __builtin_sqrt(a[k]);
  return value;
}

/// A number of each start as the sum of two doubles.
struct Wide {
  Lanes high, low;
  Wide() : Wide(0.0) {}
  Wide(double a) : high(same(a)), low(same(0)) {}
  Wide(const Lanes& a, const Lanes& b = same(0)) : high(a), low(b) {}
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
Wide operator-(const Wide& a) { return {same(0) - a.high, same(0) - a.low}; }
Wide operator-(const Wide& a, const Wide& b) { return a + -b; }
Wide operator*(const Wide& a, const Wide& b) {
  const Lanes p = a.high * b.high;
  return ordered(p, fused(a.high, b.low, fused(a.low, b.high, fused(a.high, b.high, same(0) - p))));
}
/// 1/sqrt(a): the residual of an estimate in doubles, put right twice.
Wide inverse_root(const Wide& a) {
  Wide y(same(1) / root(a.high));
  for (int k = 0; k < 2; ++k) y = y + (y * Wide(0.5)) * (Wide(1) - a * (y * y));
  return y;
}
Wide inverse(const Wide& a) {
  Wide y(same(1) / a.high);
  for (int k = 0; k < 2; ++k) y = y + y * (Wide(1) - a * y);
  return y;
}

struct Vector {
  Wide of[3];
};
Vector operator+(const Vector& a, const Vector& b) {
  return {{a.of[0] + b.of[0], a.of[1] + b.of[1], a.of[2] + b.of[2]}};
}
Vector operator-(const Vector& a, const Vector& b) {
  return {{a.of[0] - b.of[0], a.of[1] - b.of[1], a.of[2] - b.of[2]}};
}
Vector operator*(const Wide& a, const Vector& b) { return {{a * b.of[0], a * b.of[1], a * b.of[2]}}; }
Wide dot(const Vector& a, const Vector& b) { return (a.of[0] * b.of[0] + a.of[1] * b.of[1]) + a.of[2] * b.of[2]; }

/// 1/0! to 1/31!
struct Factorials {
  Wide inverse_of[32];
  Factorials() {
    Wide f(1);
    for (int k = 0; k < 32; ++k) {
      if (k > 1) f = f * Wide(k);  // more than 106 bits from 28! on, where a part of 1e-32 is enough
      inverse_of[k] = inverse(f);
    }
  }
};
const Factorials factorials;

constexpr int terms = 14;  // the next one is below 1e-33 of the first for z up to
constexpr double largest = 0.6;
/// c_n(z) = sum (-z)^k/(2k + n)!
Wide stumpff(int n, const Wide& z) {
  Wide sum = factorials.inverse_of[2 * terms + n];
  for (int k = terms; k-- > 0;) sum = factorials.inverse_of[2 * k + n] - sum * z;
  return sum;
}
Lanes stumpff(int n, const Lanes& z) {
  Lanes sum = factorials.inverse_of[22 + n].high;
  for (int k = 10; k-- > 0;) sum = factorials.inverse_of[2 * k + n].high - sum * z;
  return sum;
}

Wide from_starts(const double (*starts)[planets + 1][6], int i, int c) {
  Lanes value;
  for (int k = 0; k < lanes; ++k) value[k] = starts[k][i][c];
  return value;
}

/// Sun and planets in Jacobi coordinates: `x[k]` of planet k is relative to the center of mass of all inside it.
struct Map {
  Wide masses[planets + 1], within[planets + 1], mu[planets], share[planets];
  Vector x[planets], v[planets];
  Vector center, momentum;  // not moved: it changes nothing

  /// From inertial doubles, body by body.
  explicit Map(const double (*starts)[planets + 1][6]) {
    for (int i = 0; i <= planets; ++i) {
      masses[i] = Wide(bodies[i][0]);
      within[i] = i == 0 ? masses[0] : within[i - 1] + masses[i];
    }
    Vector inner_x, inner_v;
    for (int i = 0; i <= planets; ++i) {
      Vector position, velocity;
      for (int c = 0; c < 3; ++c) {
        position.of[c] = from_starts(starts, i, c);
        velocity.of[c] = from_starts(starts, i, 3 + c);
      }
      if (i == 0) {
        inner_x = position, inner_v = velocity;
        continue;
      }
      x[i - 1] = position - inner_x, v[i - 1] = velocity - inner_v;
      mu[i - 1] = Wide(G) * within[i];
      share[i - 1] = masses[i] * inverse(within[i]);
      inner_x = inner_x + share[i - 1] * x[i - 1];
      inner_v = inner_v + share[i - 1] * v[i - 1];
    }
  }

  void drift(double time) {
    const Wide h(time);
    for (int k = 0; k < planets; ++k) {
      const Wide r2 = dot(x[k], x[k]), r_inverse = inverse_root(r2), r = r2 * r_inverse, eta = dot(x[k], v[k]);
      const Wide beta = Wide(2) * mu[k] * r_inverse - dot(v[k], v[k]), zeta = mu[k] - beta * r;
      // In doubles first.
      Lanes s = same(time) / r.high, last = s;
      for (int pass = 0; pass < 7; ++pass) {
        const Lanes z = beta.high * s * s, g2 = s * s * stumpff(2, z), g3 = s * s * s * stumpff(3, z);
        const Lanes g1 = s - beta.high * g3, g0 = same(1) - beta.high * g2;
        const Lanes slope = r.high + eta.high * g1 + zeta.high * g2;
        const Lanes miss = (same(time) - r.high * s) - (eta.high * g2 + zeta.high * g3), d = miss / slope;
        last = d * (same(1) - same(0.5) * (eta.high * g0 + zeta.high * g1) * d / slope);
        s = s + last;
      }
      const Wide s1(s), z = beta * s1 * s1;
      for (int lane = 0; lane < lanes; ++lane) {
        if (std::fabs(last[lane]) < 1e-13 * std::fabs(s[lane]) && std::fabs(z.high[lane]) < largest) continue;
        std::fprintf(stderr, "planet %d: an arc that this program is not made for\n", k + 1);
        std::exit(1);
      }
      const Wide s2 = s1 * s1;
      Wide g2 = s2 * stumpff(2, z), g3 = s2 * s1 * stumpff(3, z), g1 = s1 - beta * g3;
      const Wide g0 = Wide(1) - beta * g2;
      const Wide miss = (h - r * s1) - (eta * g2 + zeta * g3);
      const Lanes slope = (r + eta * g1 + zeta * g2).high, first = miss.high / slope;
      const Lanes bend = (eta * g0 + zeta * g1).high;
      const Wide d(first - same(0.5) * bend * first * first / slope), half = Wide(0.5) * d;
      const Wide more_g1 = d * (g0 - half * beta * g1), more_g2 = d * (g1 + half * g0), more_g3 = d * (g2 + half * g1);
      g1 = g1 + more_g1, g2 = g2 + more_g2, g3 = g3 + more_g3;
      const Wide falling = -(mu[k] * g2);
      const Vector start = x[k];
      x[k] = start + ((falling * r_inverse) * start + (h - mu[k] * g3) * v[k]);
      const Wide end_inverse = inverse_root(dot(x[k], x[k]));
      v[k] = v[k] + ((-(mu[k] * g1) * r_inverse * end_inverse) * start + (falling * end_inverse) * v[k]);
    }
  }

  /// Heliocentric positions.
  void heliocentric(Vector* y) const {
    Vector inner;
    for (int k = 0; k < planets; ++k) {
      y[k] = inner + x[k];
      inner = inner + share[k] * x[k];
    }
  }

  void kick(double time) {
    const Wide h(time);
    Vector y[planets], a[planets + 1];
    heliocentric(y);
    for (int i = 0; i < planets; ++i) {
      if (i > 0) {  // the arc of the innermost has all of its attraction
        const Wide q = inverse_root(dot(y[i], y[i])), cube = Wide(G) * (q * q * q);
        a[0] = a[0] + (cube * masses[i + 1]) * y[i];
        a[i + 1] = a[i + 1] - (cube * masses[0]) * y[i];
      }
      for (int j = i + 1; j < planets; ++j) {
        const Vector d = y[j] - y[i];
        const Wide q = inverse_root(dot(d, d)), cube = Wide(G) * (q * q * q);
        a[i + 1] = a[i + 1] + (cube * masses[j + 1]) * d;
        a[j + 1] = a[j + 1] - (cube * masses[i + 1]) * d;
      }
    }
    Vector inner = a[0];
    for (int k = 0; k < planets; ++k) {
      Vector own = a[k + 1] - inner;
      inner = inner + share[k] * own;
      if (k > 0) {
        const Wide q = inverse_root(dot(x[k], x[k]));
        own = own + (mu[k] * (q * q * q)) * x[k];
      }
      v[k] = v[k] + h * own;
    }
  }

  /// Energy in the frame of the center of mass.
  Wide energy() const {
    Vector y[planets];
    heliocentric(y);
    Wide sum;
    for (int i = 0; i < planets; ++i) {
      sum = sum + Wide(0.5) * (share[i] * within[i]) * dot(v[i], v[i]);
      sum = sum - Wide(G) * masses[0] * masses[i + 1] * inverse_root(dot(y[i], y[i]));
      for (int j = i + 1; j < planets; ++j) {
        const Vector d = y[j] - y[i];
        sum = sum - Wide(G) * masses[i + 1] * masses[j + 1] * inverse_root(dot(d, d));
      }
    }
    return sum;
  }
};

/// Start 0 is the system; of the others all coordinates and velocities are multiplied by 1 + 1e-12 u, u from -1 to 1.
void make_start(int number, double (*to)[6]) {
  std::uint64_t state = 88172645463325252ULL + static_cast<std::uint64_t>(number);
  const auto draw = [&] {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return static_cast<double>(state >> 11) / 9007199254740992.0 * 2 - 1;
  };
  for (int k = 0; k < 20; ++k) draw();
  for (int i = 0; i <= planets; ++i) {
    for (int c = 0; c < 6; ++c) to[i][c] = bodies[i][1 + c] * (number == 0 ? 1 : 1 + 1e-12 * draw());
  }
}

/// Lines of four starts, from the one numbered `first` on.
void follow(int first, const std::vector<std::int64_t>& looks) {
  static double starts[lanes][planets + 1][6];
  for (int k = 0; k < lanes; ++k) make_start(first + k, starts[k]);
  Map map(starts);
  const Wide before = map.energy();
  std::int64_t done = 0;
  map.drift(step / 2);
  for (const std::int64_t look : looks) {
    for (; done < look; ++done) {
      map.kick(step);
      if (done + 1 < look) map.drift(step);
    }
    Map settled = map;
    settled.drift(step / 2);
    map.drift(step);
    const Wide change = settled.energy() * inverse(before) - Wide(1);
    for (int k = 0; k < lanes; ++k) {
      std::printf("%d %lld %.9e", first + k, static_cast<long long>(look), change.high[k]);
      for (const Vector* vector : {&settled.x[0], &settled.v[0]}) {
        for (const Wide& one : vector->of) std::printf(" %.17g %.6g", one.high[k], one.low[k]);
      }
      std::printf("\n");
    }
    std::fflush(stdout);
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count > 2) {  // a trial: first start and steps
    follow(std::atoi(arguments[1]), {std::atoll(arguments[2])});
    return 0;
  }
  std::printf("# step in days, G, then mass, x, v of the Sun and eight planets\n%.17g %.17g\n", step, G);
  for (const auto& body : bodies) {
    for (int c = 0; c < 7; ++c) std::printf("%.17g%c", body[c], c == 6 ? '\n' : ' ');
  }
  std::printf(
      "# start, steps, relative change of the energy, then x and v of Mercury about the Sun in two words each\n");
  for (int first = 0; first < 64; first += lanes) follow(first, {100, 10'000, 100'000});
  follow(0, {1'000'000, 10'000'000});
  follow(lanes, {1'000'000});
}
