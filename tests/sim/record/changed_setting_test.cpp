#include "sim/record/changed_setting.h"

#include <gtest/gtest.h>

namespace selvage::sim {
namespace {

const std::string kBefore = R"(gravity_m_s2 = [0, 0, -9.81]
[time]
frames = 10 # enough
[[cloth]]
name = "sheet"
stretch_n_m = 40
[[body]]
name = "ball"
[[body]]
name = "floor"
[[body.key]]
time_s = 1
)";

std::string with(const std::string& old, const std::string& replacement) {
  std::string text = kBefore;
  return text.replace(text.find(old), old.size(), replacement);
}

}  // namespace

TEST(ChangedSetting, IsNamedWithBothValuesAndItsLine) {
  const std::pair<std::string, std::string> kChanges[] = {
      {with("-9.81", "-1.62"), "gravity_m_s2 (line 1) was [0, 0, -9.81] and is [0, 0, -1.62]"},
      {with("frames = 10", "frames = 12"), "time.frames (line 3) was 10 and is 12"},
      {with("\"sheet\"", "\"flag\""), "cloth[0].name (line 5) was 'sheet' and is 'flag'"},
      {with("time_s = 1", "time_s = 2"), "body[1].key[0].time_s (line 12) was 1 and is 2"},
      {with("name = \"ball\"\n", "name = \"ball\"\nrepeat = 3\n"), "body[0].repeat (line 9) is 3 and was not there"},
      {with("stretch_n_m = 40\n", ""), "cloth[0].stretch_n_m was 40 and is not there any more"},
      {with("time_s = 1\n", "time_s = 1\n[[body.key]]\n"), "body[1].key[1] (line 13) is {} and was not there"},
      {with("time_s = 1", "time_s = \"1\""), "body[1].key[0].time_s (line 12) was 1 and is '1'"},
  };
  for (const auto& [now, words] : kChanges) EXPECT_EQ(changed_setting(kBefore, now), words);
}

TEST(ChangedSetting, IsTheFirstFromTheTopAndNoneOfLayout) {
  std::string now = "# of the moon\n" + with("stretch_n_m = 40", "stretch_n_m =  40.0");
  EXPECT_EQ(changed_setting(kBefore, now), std::nullopt);
  EXPECT_EQ(changed_setting(kBefore, with("# enough", "# few")), std::nullopt);
  now.replace(now.find("time_s = 1"), 10, "time_s = 2");
  now.replace(now.find("frames = 10"), 11, "frames = 11");
  EXPECT_EQ(changed_setting(kBefore, now), "time.frames (line 4) was 10 and is 11");
}

TEST(ChangedSetting, ALongValueIsCut) {
  std::string many = "pins = [1";
  for (int i = 0; i < 1000; ++i) many += ", 1";
  const std::string words = changed_setting("pins = [2]", many + "]").value();
  EXPECT_TRUE(words.starts_with("pins (line 1) was [2] and is [1, 1, 1")) << words;
  EXPECT_LT(words.size(), 120U);
}

}  // namespace selvage::sim
