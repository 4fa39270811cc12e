#include "bench/verify_bench.h"

#include <algorithm>
#include <iterator>
#include <optional>

#include <nlohmann/json.hpp>

#include "bench/child_process.h"
#include "bench/layered_sheet.h"
#include "verify/check.h"

namespace selvage::bench {
namespace {

constexpr int kPlanted = 20;
constexpr double kPlantedGaps = 1.5;  // through the next layer, not into the one after

/// {event, features}: the same pair has the same numbers in every method of a kind.
using Found = std::vector<std::array<std::int32_t, 3>>;

struct Measured {
  VerifyMethodReport report;
  Found found;
};

std::string packed(const Measured& measured) {
  const VerifyMethodReport& r = measured.report;
  return nlohmann::json{r.build.cpu, r.build.wall, r.check.cpu, r.check.wall, r.examined, r.exact, measured.found}
      .dump();
}

Measured unpacked(const std::string& text) {
  const auto json = nlohmann::json::parse(text);
  Measured measured;
  measured.report.build = {json[0], json[1]};
  measured.report.check = {json[2], json[3]};
  measured.report.examined = json[4];
  measured.report.exact = json[5];
  measured.found = json[6].get<Found>();
  measured.report.found = static_cast<std::int64_t>(measured.found.size());
  return measured;
}

class SheetBench {
 public:
  SheetBench(LayeredSheet sheet, bool planted, const LoadedFrameRival& rival, const VerifyBenchOptions& options)
      : sheet_(std::move(sheet)), planted_(planted), rival_(rival), options_(options) {}

  VerifySheetReport run() {
    VerifySheetReport report{static_cast<std::int64_t>(sheet_.V_t0.size()),
                             static_cast<std::int64_t>(sheet_.triangles.size()),
                             sheet_.layers,
                             planted_,
                             {}};
    idle_bytes_ = run_in_child([] { return std::string(); }).peak_bytes;
    if (planted_ && options_.motion) poke(sheet_.V_t1, kPlanted, kPlantedGaps * sheet_.gap);
    if (options_.motion) measure_all("motion", report, [&](int threads) { return check_motion(threads); });
    if (planted_) poke(sheet_.V_t0, kPlanted, kPlantedGaps * sheet_.gap);
    measure_all("frame", report, [&](int threads) { return check_frame(threads); });
    if (rival_.create) measure_all("cgal", report, [&](int threads) { return ask_rival(threads); });
    return report;
  }

 private:
  template <typename Method>
  void measure_all(const std::string& name, VerifySheetReport& report, const Method& method) {
    if (name != "cgal") expected_.reset();
    for (const int threads : options_.thread_counts) {
      const ChildOutcome outcome = run_in_child([&] {
        Measured measured;
        with_threads(threads, [&] { measured = method(threads); });
        return packed(measured);
      });
      Measured measured = unpacked(outcome.answer);
      measured.report.name = name;
      measured.report.thread_count = threads;
      measured.report.peak_bytes = outcome.peak_bytes - idle_bytes_;
      if (!expected_) expected_ = measured.found;
      measured.report.missing = difference_count(*expected_, measured.found);
      measured.report.extra = difference_count(measured.found, *expected_);
      report.methods.push_back(measured.report);
    }
  }
  /// Pairs of a that b has not.
  static std::int64_t difference_count(const Found& a, const Found& b) {
    Found only_a;
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(only_a));
    return static_cast<std::int64_t>(only_a.size());
  }

  template <typename Check>
  Measured check(const Check& run) const {
    Measured measured;
    verify::Topology topology;
    time(measured.report.build, [&] { topology = verify::make_topology({sheet_.triangles}, sheet_.V_t0.size()); });
    verify::CheckOptions options;
    options.max_violations = 1'000'000;  // all: they are compared
    verify::CheckResult result;
    for (int pass = 0; pass < options_.repeat; ++pass) {
      result = {};
      time(measured.report.check, [&] { result = run(topology, options); });
    }
    const verify::PairCounts& pairs = result.pairs;
    measured.report.examined = pairs.vf + pairs.ee + pairs.overlap + pairs.self;
    measured.report.exact = pairs.exact;
    for (const verify::Violation& violation : result.violations) {
      measured.found.push_back(
          {static_cast<std::int32_t>(violation.event), violation.features[0], violation.features[1]});
    }
    return measured;
  }
  Measured check_frame(int) const {
    return check([&](const verify::Topology& topology, const verify::CheckOptions& options) {
      return verify::check_frame(topology, sheet_.V_t0, options);
    });
  }
  Measured check_motion(int) const {
    return check([&](const verify::Topology& topology, const verify::CheckOptions& options) {
      return verify::check_motion(topology, sheet_.V_t0, sheet_.V_t1, options);
    });
  }
  Measured ask_rival(int threads) const {
    Measured measured;
    const std::unique_ptr<FrameRival> rival = rival_.create();
    time(measured.report.build, [&] { rival->build(sheet_.triangles, sheet_.V_t0); });
    std::vector<std::array<std::int32_t, 2>> pairs;
    for (int pass = 0; pass < options_.repeat; ++pass) {
      time(measured.report.check, [&] { pairs = rival->intersections(threads > 1); });
    }
    for (const auto& [f, g] : pairs) {
      measured.found.push_back({static_cast<std::int32_t>(verify::EventKind::kOverlap), f, g});
    }
    return measured;
  }

  LayeredSheet sheet_;
  bool planted_;
  const LoadedFrameRival& rival_;
  const VerifyBenchOptions& options_;
  std::int64_t idle_bytes_ = 0;
  std::optional<Found> expected_;
};

}  // namespace

std::vector<VerifySheetReport> run_verify_bench(const LoadedFrameRival& rival, const VerifyBenchOptions& options) {
  std::vector<VerifySheetReport> reports;
  for (const int faces : options.faces) {
    const int layers = options.layers > 0 ? options.layers : faces < 100'000 ? 10 : 20;
    for (const bool planted : {false, true}) {
      reports.push_back(SheetBench(layered_sheet(faces, layers), planted, rival, options).run());
    }
  }
  return reports;
}

bool is_wrong(const VerifySheetReport& report) {
  return std::any_of(report.methods.begin(), report.methods.end(), [&](const VerifyMethodReport& method) {
    return method.missing > 0 || method.extra > 0 || (method.found > 0) != report.planted;
  });
}

}  // namespace selvage::bench
