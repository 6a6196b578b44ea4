/// Methods on groups over a frame are held to their orders and counts, and to docs/methods.md.

#include "study/frame_traits.hpp"

#include "integrators/all_methods.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/files.hpp"

#include <fmt/format.h>

using namespace noether;

TEST_CASE("methods on groups have their orders on a frame that is driven round, and what docs/methods.md says",
          "[methods][lie]") {
  const std::vector<MeasuredFrames> measured = measured_frames();
  REQUIRE(measured.size() > methods::of_rotations().size());
  for (const MeasuredFrames& one : measured) {
    INFO(one.method << ": " << fmt::format("{}", fmt::join(one.differences(), "; ")));
    CHECK(one.differences().empty());
    if (one.method.starts_with("magnus")) CHECK(one.reversible);
    if (one.method == "rkmk_rk4") CHECK_FALSE(one.reversible);
  }
  INFO("docs/methods.md is written by ./noether list methods --measured > docs/methods.md");
  CHECK(test::read_text(NOETHER_SOURCE_DIR "/docs/methods.md").find(frames_section(measured)) != std::string::npos);
  MeasuredFrames wrong = measured.front();
  wrong.claimed_order = 3;
  wrong.claimed_evaluations = 2;
  CHECK(wrong.differences() ==
        std::vector<std::string>{"order: claims 3, measured 2.00", "evaluations: claims 2, counted 1 and 1"});
}
