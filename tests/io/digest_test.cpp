// Digests: SHA-256 of the state, as any other program computes it.

#include "io/digest.hpp"

#include "tests/io/support.hpp"

using namespace noether;

TEST_CASE("sha256 gives the hashes of the standard's examples", "[digest]") {
  CHECK(io::sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(io::sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(io::sha256(std::string(1'000'000, 'a')) == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

namespace {

ParticleSystem<double> three_bodies() {
  ParticleSystem<double> s;
  s.add("one", 1.5, {0.1, -2, 3}, {0, 1e-300, -0.0});
  s.add("two", 0, {1e22, 0.3, -7}, {5, 6, 7});
  s.add("three", 2.25, {-1, -1, -1}, {0.5, 0.25, 0.125});
  s.clock() = Clock<double>::fixed(0.5, 0.1, 3);
  return s;
}

}  // namespace

TEST_CASE("the digest of a state is what Python's hashlib computes from the same numbers", "[digest]") {
  // import hashlib, struct; hashlib.sha256(b'noether-state-1\n' + struct.pack('<qqd', 3, 3, 0.5 + 3 * 0.1) +
  //   struct.pack('<3q', 0, 1, 2) + struct.pack('<9d', .1, -2, 3, 1e22, .3, -7, -1, -1, -1) +
  //   struct.pack('<9d', 0, 1e-300, -0.0, 5, 6, 7, .5, .25, .125) + struct.pack('<3d', 1.5, 0, 2.25)).hexdigest()
  CHECK(io::digest(three_bodies()) == "sha256:bcb3f47f7ef2172a00e36c41acb6a2bfbc57bb3d6ceb9335fc982a9e8f97b55a");
}

TEST_CASE("the digest goes by ids, not by the order of the particles, and feels every bit", "[digest]") {
  const ParticleSystem<double> s = three_bodies();
  ParticleSystem<double> other;
  for (const Index i : {2, 0, 1}) other.add(s.name(i), s.masses()[i], s.positions()[i], s.velocities()[i]);
  other.restore_ids({2, 0, 1});
  other.clock() = s.clock();
  CHECK(io::digest(other) == io::digest(s));

  other.positions()[1][2] = std::nextafter(3.0, 4.0);
  CHECK(io::digest(other) != io::digest(s));
  ParticleSystem<double> later = s;
  later.clock() = Clock<double>::fixed(0.5, 0.1, 4);
  CHECK(io::digest(later) != io::digest(s));
}

TEST_CASE("the digest of a free clock takes the high word of its time", "[digest]") {
  ParticleSystem<double> s = three_bodies();
  s.clock() = Clock<double>::free(0.25);
  const std::vector<double> x = {0.1, -2, 3, 1e22, 0.3, -7, -1, -1, -1}, m = {1.5, 0, 2.25};
  const std::vector<double> v = {0, 1e-300, -0.0, 5, 6, 7, 0.5, 0.25, 0.125};
  CHECK(io::digest(s) == io::digest(0, 0.25, s.ids(), x, v, m));
}
