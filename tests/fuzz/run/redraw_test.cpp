// A case that is known by its seed alone.
#include "fuzz/run/redraw.h"

#include <gtest/gtest.h>

#include "fuzz/kept/drawn_case.h"
#include "fuzz/kept/step_case.h"

namespace selvage::fuzz {

TEST(Redraw, MakesTheCaseOfAStreamThatIsKnownAndRunsIt) {
  const std::string text = drawn_text("step:soup:1:2", "hung");
  const ParsedCase parsed = parse_kept_case(text, "x.case", redraw);
  EXPECT_EQ(kept_text(*parsed.kept, parsed.origin, parsed.failure), text);
  EXPECT_EQ(parsed.kept->promise(), step_kind().promise);
  const Retrial retrial = parsed.kept->retry();
  EXPECT_EQ(retrial.failure, "");
  ASSERT_EQ(retrial.facts.size(), 1U);
  EXPECT_NE(retrial.facts[0].find("in a process of its own"), std::string::npos);
}

TEST(Redraw, RefusesWhatNoPropertyCanDraw) {
  for (const char* origin : {"stop:soup:1:2", "step:sup:1:2", "step:soup:1", "step:soup:1:2:3", "step:soup:-1:2"}) {
    EXPECT_THROW((void)parse_kept_case(drawn_text(origin, "hung"), "x.case", redraw), io::Error) << origin;
  }
}

}  // namespace selvage::fuzz
