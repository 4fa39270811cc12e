#include "cli/answer/enclosed_cloth.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"

namespace selvage {

using testing::run_program;
using testing::spit;
using testing::TemporaryFolder;

// Cloth inside a body meets nothing; how it came there is what --motion finds.
TEST(EnclosedCloth, IsNotedByVerify) {
  const TemporaryFolder folder;
  const auto frame = [&](const char* name, double height) {
    spit(folder.path() / name, fmt::format("g cloth\nv 0.2 0.2 {0}\nv 0.4 0.2 {0}\nv 0.2 0.4 {0}\nf 1 2 3\n"
                                           "g ball\nv 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\n"
                                           "f 4 5 6\nf 4 5 7\nf 5 6 7\nf 6 4 7\n",
                                           height));
    return folder.path() / name;
  };
  const auto above = frame("above.obj", 3), inside = frame("inside.obj", 0.5);
  const auto json = folder.path() / "report.json";
  const auto verify = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "verify");
    words.insert(words.end(), {"--body", "ball", "--json", json});
    return run_program(folder, words);
  };
  const auto said = [](const testing::ProgramResult& run) {
    return run.err.find("inside the closed body") != run.err.npos;
  };
  EXPECT_FALSE(said(verify({above, above})));
  const auto throughout = verify({inside, inside});
  EXPECT_EQ(throughout.exit_code, 0);
  EXPECT_TRUE(said(throughout));
  EXPECT_EQ(throughout.err.find("came through"), std::string::npos) << throughout.err;
  for (const auto& [first, last] : {std::pair(above, inside), std::pair(inside, above)}) {
    const auto through = verify({first, last});
    EXPECT_EQ(through.exit_code, 0);
    EXPECT_NE(through.err.find("\"cloth\" is wholly inside the closed body \"ball\""), std::string::npos)
        << through.err;
    EXPECT_NE(through.err.find("came through"), std::string::npos) << through.err;
    const auto notes = nlohmann::json::parse(testing::slurp(json))["notes"];
    EXPECT_EQ(notes.size(), 1U) << notes;
    EXPECT_EQ(verify({"--motion", first, last}).exit_code, 1);
  }
  EXPECT_FALSE(said(verify({inside, "--ignore", "ball"})));
  std::string open = testing::slurp(inside);
  open.resize(open.rfind("f 6 4 7\n"));
  spit(folder.path() / "open.obj", open);
  EXPECT_FALSE(said(verify({folder.path() / "open.obj"}))) << "a bowl has no inside";
}

}  // namespace selvage
