#include "bench/broad_bench.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace selvage::bench {
namespace {

constexpr BroadBenchOptions quick() { return {1, {1, 2}, 50, true}; }

/// Finds every pair there is but the first, and one that is none: its boxes never overlap.
class BadRival : public Rival {
 public:
  void build(const FeatureBoxes& boxes) override { boxes_ = boxes; }
  bool refit(const FeatureBoxes&) override { return false; }
  Candidates query() override {
    Candidates found;
    for (std::size_t v = 0; v < boxes_.vertices.size(); ++v) {
      for (std::size_t f = 0; f < boxes_.faces.size(); ++f) {
        const std::array vertex = {static_cast<VertexId>(v)};
        const bool is_candidate =
            overlap(boxes_.vertices[v], boxes_.faces[f]) && !share_vertex(vertex, boxes_.mesh->faces[f]);
        (is_candidate ? found.vf : none_).push_back({vertex[0], static_cast<FaceId>(f)});
      }
    }
    found.vf.front() = none_.front();
    std::sort(found.vf.begin(), found.vf.end());
    return found;
  }

 private:
  FeatureBoxes boxes_{};
  std::vector<VfCandidate> none_;
};

std::vector<LoadedRival> built_rivals() { return load_rivals(SELVAGE_RIVALS); }

}  // namespace

TEST(BroadBench, TheHierarchiesAgreeAndBruteForceConfirms) {
  const BroadMotionReport report = run_broad_bench(crumpled_sheet(30), {}, quick());
  EXPECT_FALSE(is_wrong(report));
  EXPECT_GT(report.vf, 0);
  EXPECT_GT(report.ee, 0);
  EXPECT_GT(report.sampled, 60);
  EXPECT_EQ(report.methods.size(), 6U);
  EXPECT_GT(report.ns_per_work, 0);
  for (const BroadMethodReport& method : report.methods) EXPECT_GT(method.query.cpu, 0) << method.name;
}

TEST(BroadBench, AWrongAnswerOfOursIsNoticed) {
  BroadMotionReport report = run_broad_bench(crumpled_sheet(10), {}, quick());
  report.methods[1].missing = 1;
  EXPECT_TRUE(is_wrong(report));
  report.methods[1].missing = 0;
  report.differences = 1;
  EXPECT_TRUE(is_wrong(report));
}

TEST(BroadBench, ARivalIsChargedWithWhatItMissesAndAdds) {
  const LoadedRival bad{"bad", {}, [](int) { return std::make_unique<BadRival>(); }};
  const BroadMotionReport report = run_broad_bench(crumpled_sheet(10), std::span(&bad, 1), quick());
  const BroadMethodReport& of_rival = report.methods[3];
  ASSERT_EQ(of_rival.name, "bad");
  EXPECT_EQ(of_rival.missing, 1 + report.ee);
  EXPECT_EQ(of_rival.extra, 1);
  EXPECT_EQ(of_rival.refit.cpu, 0);
  EXPECT_FALSE(is_wrong(report));
}

/// CGAL compares doubles like the kernel; Embree rounds to float32, which only adds pairs.
TEST(BroadBench, TheRivalsThatAreBuiltFindEveryPair) {
  const auto rivals = built_rivals();
  const BroadMotionReport report = run_broad_bench(crumpled_sheet(40), rivals, quick());
  for (const BroadMethodReport& method : report.methods) {
    EXPECT_EQ(method.missing, 0) << method.name;
    if (method.name == "embree") {
      // 0.6 to 3.4 times the candidates in bench/results; all pairs, which miss none either, are hundreds of times.
      EXPECT_LT(method.extra, 10 * (report.vf + report.ee));
    } else {
      EXPECT_EQ(method.extra, 0) << method.name;
    }
  }
  const auto is_cgal = [](const BroadMethodReport& method) { return method.name == "cgal"; };
  EXPECT_EQ(std::count_if(report.methods.begin(), report.methods.end(), is_cgal), 2);
}

TEST(BroadBench, WorkFallsWithTheShareOfMovedVertices) {
  const BroadMotionReport report = run_broad_bench(crumpled_sheet(60), {}, quick());
  std::int64_t patch = std::numeric_limits<std::int64_t>::max();
  for (const BroadIncrementalReport& row : report.incremental) {
    if (row.spread != "patch") continue;
    EXPECT_LT(row.candidates, patch);
    patch = row.candidates;
  }
  EXPECT_EQ(report.incremental.front().candidates, report.vf + report.ee);
  EXPECT_EQ(patch, 0);
}

TEST(BroadBench, ARivalThatIsNotHereSaysWhy) {
  const auto absent = load_rivals("no/such/folder");
  EXPECT_EQ(absent.size(), 2U);
  for (const LoadedRival& rival : absent) {
    EXPECT_FALSE(rival.create);
    EXPECT_NE(rival.absent.find(rival.name), std::string::npos);
  }
}

TEST(BroadBench, JsonCarriesItsSchema) {
  const BroadMotionReport report = run_broad_bench(crumpled_sheet(5), {}, quick());
  const auto absent = load_rivals("no/such/folder");
  const auto json = nlohmann::json::parse(to_json(std::span(&report, 1), absent));
  EXPECT_EQ(json["schema"], "selvage.bench.broad/1");
  EXPECT_EQ(json["motions"][0]["methods"][0]["name"], "automatic");
  EXPECT_EQ(json["motions"][0]["vf"], report.vf);
  EXPECT_TRUE(json["absent"].contains("cgal"));
}

}  // namespace selvage::bench
