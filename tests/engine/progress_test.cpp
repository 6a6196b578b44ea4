// How far a long task is, in words.

#include "numbers/progress.hpp"

#include "tests/support/catch.hpp"

namespace noether {
namespace {

TEST_CASE("a bar fills with the share", "[progress]") {
  CHECK(progress_bar(0, 10) == "[----------]");
  CHECK(progress_bar(0.3, 10) == "[###-------]");
  CHECK(progress_bar(1, 10) == "[##########]");
  CHECK(progress_bar(7, 4) == "[####]");
  CHECK(progress_bar(-1, 4) == "[----]");
}

TEST_CASE("a share tells its row, the method and the time that is left", "[progress]") {
  CHECK(progress_text({.what = "reference"}, 3) == "reference");
  CHECK(progress_text({.row = 4, .rows = 12, .done = 0.25, .what = "verlet, step 0.01"}, 10) ==
        "[#####---------------]  25 %  4 of 12  verlet, step 0.01  30 s left");
  CHECK(progress_text({.row = 1, .rows = 12, .done = 0, .what = "verlet"}, 10) ==
        "[--------------------]   0 %  1 of 12  verlet");
  CHECK(progress_text({.row = 0, .rows = 12, .done = 0.25, .what = "reference"}, 10) ==
        "[#####---------------]  25 %  reference");  // what is prepared does not tell when all is done
  CHECK(spoken_duration(99) == "99 s");
  CHECK(spoken_duration(600) == "10 min");
  CHECK(spoken_duration(9000) == "2.5 h");
  CHECK(spoken_duration(432000) == "5 days");
}

}  // namespace
}  // namespace noether
