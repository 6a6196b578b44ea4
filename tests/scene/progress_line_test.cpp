// The line that a terminal shows while a run goes on: what it tells, and that it has room.

#include "scene/progress_line.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#include <limits>
#include <string>

namespace noether::test {
namespace {

ProgressState half_way() {
  ProgressState state;
  state.share = 0.5;
  state.time = 182625;
  state.time_unit = "day";
  state.rate = 12345;
  state.seconds_left = 754;
  state.energy_error = 1.23e-12;
  return state;
}

TEST_CASE("a bar with share, time, time left, worst energy error and rate has room in 80 columns",
          "[scene][progress]") {
  const std::string line = progress_text(half_way(), 79);
  CHECK(line == "[#####-----] 50.0 %  time 1.826e+05 day  13 min left  dE/E 1e-12  12.3k steps/s");
}

TEST_CASE("the line is never longer than the terminal, and leaves out the last parts first", "[scene][progress]") {
  ProgressState state = half_way();
  for (std::size_t columns = 0; columns <= 200; ++columns) {
    const std::string line = progress_text(state, columns);
    CHECK(line.size() <= columns);
    if (columns >= 20) CHECK(has(line, "50.0 %"));
  }
  CHECK(has(progress_text(state, 45), "time 1.826e+05 day"));
  CHECK_FALSE(has(progress_text(state, 45), "steps/s"));
  state.share = 1;
  CHECK(has(progress_text(state, 30), "##########] 100.0 %"));
  state.share = std::numeric_limits<double>::quiet_NaN();
  CHECK(progress_text(state, 30).find('#') == std::string::npos);
}

TEST_CASE("what is not known is left out, and reduced times have no unit", "[scene][progress]") {
  ProgressState state;
  state.time = 3;
  const std::string line = progress_text(state, 79);
  CHECK(line.ends_with("]  0.0 %  time         3"));
}

}  // namespace
}  // namespace noether::test
