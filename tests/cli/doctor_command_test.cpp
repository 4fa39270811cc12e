#include <algorithm>
#include <chrono>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"

namespace selvage {
namespace {

using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

/// Two faces that the smallest double keeps apart: under flush to zero they seem to touch.
const char* const kSubnormalGap =
    "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 1 5e-324\nv 2 1 5e-324\nv 1 2 5e-324\nf 4 5 6\n";

}  // namespace

TEST(DoctorCommand, HereAllIsSound) {
  const TemporaryFolder folder;
  const auto json = folder.path() / "doctor.json";
  const auto result = run_program(folder, {"doctor", "--json", json});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(result.out.starts_with("sound\n")) << result.out;
  const auto report = nlohmann::json::parse(slurp(json));
  EXPECT_EQ(report["schema"], "selvage.doctor/1");
  EXPECT_EQ(report["verdict"], "sound");
  EXPECT_EQ(report["floating_point"]["defects_as_found"], nlohmann::json::array());
  EXPECT_EQ(report["floating_point"]["defects_under_guard"], nlohmann::json::array());
  EXPECT_EQ(report["self_check"], (nlohmann::json{{"answers", 24}, {"wrong", nlohmann::json::array()}}));
  EXPECT_EQ(report["hostile"]["environments"].size(), 5u);
  EXPECT_EQ(report["hostile"]["answers"], 25 * report["hostile"]["environments"].size());
  EXPECT_EQ(report["hostile"]["wrong"], nlohmann::json::array());
  EXPECT_FALSE(report["simd"].empty());
  EXPECT_GE(report["threads"], 1);
  EXPECT_NE(report["versions"].get<std::string>().find("GMP"), std::string::npos);
}

TEST(DoctorCommand, WhatAGuardRepairsIsNamedAndNotFatal) {
  const TemporaryFolder folder;
  const auto doctor = run_program(folder, {"doctor"}, SELVAGE_FLUSHED_PROGRAM);
  EXPECT_EQ(doctor.exit_code, 0) << doctor.out;
  EXPECT_NE(doctor.out.find("as found: subnormal results are flushed to zero, subnormal operands are taken as zero; "
                            "repaired"),
            std::string::npos)
      << doctor.out;

  spit(folder.path() / "a.obj", kSubnormalGap);
  const auto verify = run_program(folder, {"verify", folder.path() / "a.obj"}, SELVAGE_FLUSHED_PROGRAM);
  EXPECT_EQ(verify.exit_code, 0) << verify.out;
  EXPECT_NE(verify.err.find("subnormal results are flushed to zero"), std::string::npos) << verify.err;
  EXPECT_EQ(std::count(verify.err.begin(), verify.err.end(), '\n'), 1) << verify.err;
}

TEST(DoctorCommand, WhatCannotBeRepairedIsSixEverywhere) {
  const TemporaryFolder folder;
  const auto json = folder.path() / "doctor.json";
  const auto doctor = run_program(folder, {"doctor", "--json", json}, SELVAGE_UNSOUND_PROGRAM);
  EXPECT_EQ(doctor.exit_code, 6) << doctor.err;
  EXPECT_TRUE(doctor.out.starts_with("unsound\n")) << doctor.out;
  EXPECT_NE(doctor.out.find("NOT REPAIRED: a * b + c is rounded once"), std::string::npos) << doctor.out;
  EXPECT_EQ(nlohmann::json::parse(slurp(json))["verdict"], "unsound");

  spit(folder.path() / "a.obj", kSubnormalGap);
  const auto verify = run_program(folder, {"verify", folder.path() / "a.obj"}, SELVAGE_UNSOUND_PROGRAM);
  EXPECT_EQ(verify.exit_code, 6) << verify.err;
  EXPECT_EQ(verify.out, "") << "no verdict";
  EXPECT_NE(verify.err.find("a * b + c is rounded once; run selvage doctor"), std::string::npos) << verify.err;
}

TEST(DoctorCommand, AnswersWithinASecond) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(run_program({"doctor"}).exit_code, 0);
  // "About a second" on a quiet machine (measured: 10 ms); five leave room for sanitizers and neighbours.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST(DoctorCommand, UnwritableReportIsFour) {
  const TemporaryFolder folder;
  const auto result = run_program(folder, {"doctor", "--json", folder.path() / "no" / "doctor.json"});
  EXPECT_EQ(result.exit_code, 4) << result.err;
  EXPECT_EQ(result.out, "");
}

}  // namespace selvage
