// The lists fit the sources, and what does not fit is refused.
#include "tests/mutants/planting.h"

#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace selvage::mutants {
namespace {

std::vector<Mutant> parse(const std::string& text) {
  std::vector<Mutant> mutants;
  append_list(text, "list", mutants);
  return mutants;
}

std::string refusal(const std::string& text, const std::string& source = "") {
  try {
    (void)plant(source, "a.cpp", parse(text));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

const std::string kHead = "mutant M1 a defect\nbreaks K1\nkiller p within 3\nin a.cpp\n";
const std::string kOther = "mutant M2 another\nbreaks K1\nkiller p within 3\nin a.cpp\n";

}  // namespace

TEST(MutantLists, EveryMutantHasItsPlaceInTheSources) {
  const std::filesystem::path root(SELVAGE_SOURCE_DIR);
  const std::vector<Mutant> mutants = read_lists(root / "tests/mutants/lists");
  std::set<std::string> files;
  for (const Mutant& mutant : mutants) {
    for (const Edit& edit : mutant.edits) files.insert(edit.file);
  }
  for (const std::string& file : files) {
    EXPECT_TRUE(file.ends_with(".cpp")) << file << ": a header's copy would have to be compiled everywhere";
    EXPECT_NO_THROW((void)plant(read_text(root / file), file, mutants));
  }
  EXPECT_GE(mutants.size(), 60U);
}

TEST(Planting, MakesAChoiceOfEveryPlace) {
  const std::vector<Mutant> mutants =
      parse(kHead + "find x + 1\nwith x - 1\nfind f(x);\nwith\n" + kOther + "find x + 1\nwith x\n");
  const std::string planted = plant("y = x + 1; f(x); g(x);", "a.cpp", mutants);
  EXPECT_EQ(planted,
            "#include \"tests/mutants/planted.h\"\n#line 1 \"a.cpp\"\n"
            "y = ((selvage::mutants::planted == 1) ? (x - 1) : (selvage::mutants::planted == 2) ? (x) : (x + 1)); "
            "if (selvage::mutants::planted == 1) {  } else { f(x); } g(x);");
}

TEST(Planting, RefusesAListThatIsBehindItsSource) {
  EXPECT_EQ(refusal(kHead + "find x + 1\nwith x\n", "y = x;"), "M1: 'x + 1' does not stand in a.cpp");
  EXPECT_EQ(refusal(kHead + "find x\nwith y\n", "y = x + x;"), "M1: 'x' stands in a.cpp more than once");
  EXPECT_EQ(refusal(kHead + "find a b\nwith c\n" + kOther + "find b c\nwith c\n", "a b c"),
            "M1 and M2: their finds in a.cpp overlap");
  EXPECT_EQ(refusal(kHead + "find a b\nwith c\n" + kOther + "find a\nwith c\n", "a b c"),
            "M1 and M2: different finds start at one place of a.cpp");
}

TEST(MutantLists, RefuseWhatIsNotFinished) {
  EXPECT_EQ(refusal("breaks K1\n"), "list:1: expected 'mutant'");
  EXPECT_EQ(refusal("mutant M1\n"), "list:1: a mutant needs a name and a defect");
  EXPECT_EQ(refusal(kHead), "list:4: M1 is not finished");
  EXPECT_EQ(refusal(kHead + "find x\n"), "list:5: M1 is not finished");
  EXPECT_EQ(refusal(kHead + "find x\nwith y\n" + kHead), "list:7: there are two mutants M1");
  EXPECT_EQ(refusal("mutant M1 d\nbreaks K1\nin a.cpp\nfind x\nwith y\n"), "list:5: M1 has no killer");
  EXPECT_EQ(refusal("mutant M1 d\nkiller p within many\n"), "list:2: expected 'killer PROPERTY within CASES'");
  EXPECT_EQ(refusal("mutant M1 d\nkills K1\n"), "list:2: unknown word 'kills'");
}

}  // namespace selvage::mutants
