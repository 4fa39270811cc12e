#include <nlohmann/json.hpp>

#include "bench/best_time_json.h"
#include "bench/verify_bench.h"

namespace selvage::bench {
namespace {

nlohmann::ordered_json json_of(const VerifySheetReport& report) {
  nlohmann::ordered_json methods = nlohmann::ordered_json::array();
  for (const VerifyMethodReport& method : report.methods) {
    methods.push_back({{"name", method.name},
                       {"threads", method.thread_count},
                       {"build_ns", json_of(method.build)},
                       {"check_ns", json_of(method.check)},
                       {"found", method.found},
                       {"missing", method.missing},
                       {"extra", method.extra},
                       {"examined", method.examined},
                       {"exact", method.exact},
                       {"peak_bytes", method.peak_bytes}});
  }
  return {{"vertices", report.vertices},
          {"faces", report.faces},
          {"layers", report.layers},
          {"planted", report.planted},
          {"methods", methods}};
}

}  // namespace

std::string to_json(const std::vector<VerifySheetReport>& reports, const LoadedFrameRival& rival) {
  nlohmann::ordered_json sheets = nlohmann::ordered_json::array();
  for (const VerifySheetReport& report : reports) sheets.push_back(json_of(report));
  nlohmann::ordered_json json = {{"schema", "selvage.bench.verify/1"}, {"sheets", sheets}};
  if (!rival.create) json["absent"] = {{"cgal", rival.absent}};
  return json.dump(2) + "\n";
}

}  // namespace selvage::bench
