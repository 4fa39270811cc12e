#include <nlohmann/json.hpp>

#include "bench/best_time_json.h"
#include "bench/broad_bench.h"

namespace selvage::bench {
namespace {

nlohmann::ordered_json json_of(const BroadMotionReport& report) {
  nlohmann::ordered_json methods = nlohmann::ordered_json::array(), incremental = nlohmann::ordered_json::array();
  for (const BroadMethodReport& method : report.methods) {
    methods.push_back({{"name", method.name},
                       {"threads", method.thread_count},
                       {"vf", method.vf},
                       {"ee", method.ee},
                       {"missing", method.missing},
                       {"extra", method.extra},
                       {"build_ns", json_of(method.build)},
                       {"refit_ns", json_of(method.refit)},
                       {"query_ns", json_of(method.query)}});
  }
  for (const BroadIncrementalReport& row : report.incremental) {
    incremental.push_back({{"spread", row.spread},
                           {"active_vertices", row.active_vertices},
                           {"candidates", row.candidates},
                           {"refit_ns", json_of(row.refit)},
                           {"query_ns", json_of(row.query)}});
  }
  return {{"motion", report.motion},
          {"vertices", report.vertices},
          {"edges", report.edges},
          {"faces", report.faces},
          {"vf", report.vf},
          {"ee", report.ee},
          {"sampled", report.sampled},
          {"differences", report.differences},
          {"ns_per_work", report.ns_per_work},
          {"methods", methods},
          {"incremental", incremental}};
}

}  // namespace

std::string to_json(std::span<const BroadMotionReport> reports, std::span<const LoadedRival> rivals) {
  nlohmann::ordered_json motions = nlohmann::ordered_json::array();
  for (const BroadMotionReport& report : reports) motions.push_back(json_of(report));
  nlohmann::ordered_json absent = nlohmann::ordered_json::object();
  for (const LoadedRival& rival : rivals) {
    if (!rival.create) absent[rival.name] = rival.absent;
  }
  const nlohmann::ordered_json json = {{"schema", "selvage.bench.broad/1"}, {"motions", motions}, {"absent", absent}};
  return json.dump(2) + "\n";
}

}  // namespace selvage::bench
