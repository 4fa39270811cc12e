#include <gtest/gtest.h>

// gtest before RapidCheck's bridge
#include <charconv>

#include <rapidcheck/gtest.h>

#include "io/mesh_reader.h"
#include "tests/io/random_doubles.h"
#include "tests/io/support.h"
#include "tests/property.h"

namespace selvage::io {
namespace {

using testing::check_property;
using testing::expect_error;
using testing::same_bits;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Triangles faces_of(const std::string& text) { return parse_obj(text, "a.obj").triangles; }
void expect_bad_obj(const std::string& fragment, const std::string& text) {
  expect_error(ErrorKind::kBadInput, fragment, [&] { (void)parse_obj(text, "a.obj"); });
}

TEST(Obj, CornersInAllForms) {
  const Triangles expected = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(faces_of(kSquare + "f 1 2 3 4\n"), expected);
  EXPECT_EQ(faces_of(kSquare + "f 1/1 2/2 3/3 4/4\n"), expected);
  EXPECT_EQ(faces_of(kSquare + "f 1//1 2//2 3//3 4//4\n"), expected);
  EXPECT_EQ(faces_of(kSquare + "f 1/1/1 2/2/2 3/3/3 4/4/-4"), expected) << "no line end at the end";
  EXPECT_EQ(faces_of(kSquare + "f -4 -3 -2 -1\n"), expected);
  EXPECT_EQ(faces_of("f 1 2 3 4\n" + kSquare), expected) << "faces may precede their vertices";
  EXPECT_EQ(faces_of("# x\r\n\r\n\tv  0 0 0 \r\nv 1 0 0\r\nv 1 1 0 1.0\r\nv 0 1 0 .5 .5 .5\r\nf 1 2 3 4\r\n"),
            expected);
}

TEST(Obj, ALastLineThatMayBeCutIsRefused) {
  std::string points;
  for (int i = 0; i < 13; ++i) points += "v " + std::to_string(i) + " 0 " + std::to_string(i * i) + "\n";
  const std::string cut = "the last line has no end and the face may be cut";
  expect_bad_obj("a.obj:14: " + cut, points + "f 3 4 1");
  expect_bad_obj(cut, points + "f 3 4 -1");
  const std::string ten = points.substr(0, points.find("v 10 "));
  expect_bad_obj("a.obj:11: " + cut, ten + "f 3 4 1");  // of vertex 10, the last there is
  expect_bad_obj(cut, points + "f 1 2 3 4\nf 5 6 7");
  expect_bad_obj(cut, points + "f 1 2 3 4\nf 5 6 7 ");
  expect_bad_obj(cut, points + "f 3 4 \\\n1");
  EXPECT_EQ(faces_of(points + "f 3 4 1\n"), (Triangles{{2, 3, 0}}));
  for (const char* end : {" ", "\r", "#", "/1", "//1"}) {
    EXPECT_EQ(faces_of(points + "f 3 4 1" + end), (Triangles{{2, 3, 0}})) << end;
  }
  for (const int whole : {2, 9, 13}) {  // there is no vertex 20
    EXPECT_EQ(faces_of(points + "f 3 4 " + std::to_string(whole))[0][2], whole - 1);
  }
  expect_bad_obj("a.obj:4: the last line has no end and its number may be cut", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 1");
  EXPECT_EQ(faces_of("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 1 ").size(), 1u);
  EXPECT_EQ(faces_of(points + "f 1 2 3 4\nf 5 6 7 8\nvn 0 0 1").size(), 4u) << "what is skipped may be cut";
}

TEST(Obj, AByteOrderMarkIsNoPartOfTheText) {
  const Triangles expected = {{0, 1, 2}};
  EXPECT_EQ(faces_of("\xef\xbb\xbf" + kSquare + "f 1 2 3\n"), expected);
  expect_bad_obj("a.obj:2: '???v' is not part", "v 0 0 0\n\xef\xbb\xbf" + kSquare + "f 1 2 3\n");
}

TEST(Obj, BackslashContinuesNumbersOnly) {
  const Triangles expected = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(faces_of("v 0 0\\\n 0\nv 1 0 \\\r\n0\nv 1 1 0\nv 0 1 0\nf 1 \\\n2 \\\n3 4\n"), expected);
  EXPECT_EQ(faces_of("# from C:\\\nv 0 0 0\nv 1 0 0\nmtllib C:\\\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"), expected)
      << "a path must not swallow a vertex";
}

TEST(Obj, ACommentMayEndALineOfNumbers) {
  EXPECT_EQ(
      faces_of("v 0 0 0 # origin\nv 1 0 0#x\nv 1 1 \\\n0 # y \\\nv 0 1 0 # f 1 2 \\\nvt 0 0 # uv\nf 1 2 3 4 # 5\n"),
      faces_of("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"));
  const MeshData mesh = parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\ng part #2\nf 1 2 3 # one\n", "in");
  ASSERT_EQ(mesh.groups.size(), 1u);
  EXPECT_EQ(mesh.groups[0].name, "part #2") << "a name keeps its bits";
  expect_error(ErrorKind::kBadInput, "a vertex has 2 numbers", [] { (void)parse_obj("v 0 0 # 0\n", "in"); });
}

TEST(Obj, ANumberThatIsNotFiniteIsNoComment) {
  const std::string rest = "v 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const std::string bad :
       {"1.#INF", "-1.#INF", "1.#INF00", "-1.#IND00", "1.#QNAN", "1.#SNAN0", "1.#J", "1.#inf"}) {
    for (const std::string& line : {"v 0 0 " + bad, "v " + bad + " 0 0", "v 0 0 0 " + bad, "v 0 0 0 1 1 " + bad,
                                    "v 0 0 \\\n" + bad, "v 0 0 " + bad + "# 1"}) {
      expect_bad_obj("'" + bad + "' is not finite; repair the export", line + "\n" + rest);
    }
  }
  for (const char* good : {"v 0 0 1.# top", "v 0 0 1. #INF", "v 0 0 1#INF", "v 0 0 1.0#INF", "v 0 0 1 # 1.#INF"}) {
    EXPECT_EQ(parse_obj(std::string(good) + "\n" + rest, "a.obj").points[0][2], 1) << good;
  }
  EXPECT_EQ(faces_of("v 0 0 0\nvn 0 0 -1.#IND\n" + rest).size(), 1u) << "normals are not read";
}

TEST(Obj, WhatIsNoSurfaceIsSkippedOrRefused) {
  EXPECT_EQ(faces_of("mtllib a.mtl\n" + kSquare + "vt 0 0\nvn 0 0 1\nusemtl red\ns off\nf 1 2 3\n").size(), 1u);
  expect_bad_obj("a.obj:5: 'l' is not part of a surface", kSquare + "l 1 2\nf 1 2 3\n");
  expect_bad_obj("a.obj:1: 'vp' is not part", "vp 0 0\n" + kSquare + "f 1 2 3\n");
}

TEST(Obj, ObjectsAndGroupsAreRangesOfFaces) {
  const MeshData mesh =
      parse_obj(kSquare + "f 1 2 3\no shirt\ng left sleeve\nf 1 2 3\nf 1 3 4\ng empty\ng right\nf 1 2 4\n", "");
  using Role = Group::Role;
  const std::vector<Group> expected = {
      {"default", Role::kCloth, 0, 1}, {"left sleeve", Role::kCloth, 1, 3}, {"right", Role::kCloth, 3, 4}};
  EXPECT_EQ(mesh.groups, expected);
  EXPECT_TRUE(parse_obj(kSquare + "f 1 2 3\n", "").groups.empty());
}

TEST(Obj, NumbersAreCorrectlyRoundedAndBounded) {
  const auto x = [](const std::string& number) {
    return parse_obj("v " + number + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj").points[0][0];
  };
  EXPECT_EQ(x("+1.5"), 1.5);
  EXPECT_EQ(x("1e23"), 1e23);
  EXPECT_EQ(x("-.5E+1"), -5.0);
  EXPECT_EQ(x("5."), 5.0);
  EXPECT_EQ(x("9007199254740993"), 9007199254740992.0) << "a tie goes to the even neighbour";
  EXPECT_EQ(x("9007199254740993.00000000000000000000001"), 9007199254740994.0);
  EXPECT_TRUE(std::signbit(x("-0")));
  for (const char* bad : {"1e999", "-1e999", "1e-999"}) EXPECT_THROW(x(bad), Error) << bad;
  for (const char* bad : {"nan", "inf", "-inf", "0x1p3", "1,5", "1e", "+-1", "++1", "+", "-", ".", "1_0", "1d0"}) {
    EXPECT_THROW(x(bad), Error) << bad;
  }
}

TEST(Obj, IndicesAreCheckedAgainstTheFinalCount) {
  expect_bad_obj("a.obj:5: vertex 5 of 4", kSquare + "f 1 2 5\n");
  expect_bad_obj("a.obj:1: vertex 5 of 4", "f 1 2 5\n" + kSquare + "f 1 2 4\n");
  expect_bad_obj("a.obj:5: vertex '0' of 4", kSquare + "f 0 1 2\n");
  expect_bad_obj("a.obj:5: vertex '-5' of 4", kSquare + "f -5 1 2\n");
  expect_bad_obj("a.obj:2: vertex '-2' of 1", "v 0 0 0\nf -1 -2 -3\nv 1 1 1\nv 2 2 2\n");
  expect_bad_obj("a.obj:5: vertex '99999999999' of 4", kSquare + "f 1 2 99999999999\n");
  expect_bad_obj("is not v, v/vt", kSquare + "f 1 2 99999999999999999999\n");
  for (const char* corner : {"1/", "1//", "1/a", "/1", "1/1/", "1/1/1/1", "1.0", "1//a", "x"}) {
    expect_bad_obj("a.obj:5: '" + std::string(corner) + "' is not v", kSquare + "f " + corner + " 2 3\n");
  }
}

TEST(Obj, prop_shortest_text_comes_back_bit_for_bit) {
  check_property(300, 3, [] {
    const Points points = *testing::finite_points();
    RC_PRE(points.size() >= 3);
    std::string text;
    for (const auto& point : points) {
      text += 'v';
      for (const double x : point) {
        char digits[32];
        text.append(" ").append(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
      }
      text += '\n';
    }
    RC_ASSERT(same_bits(parse_obj(text + "f 1 2 3\n", "a.obj").points, points));
  });
}

}  // namespace
}  // namespace selvage::io
