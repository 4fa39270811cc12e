#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "fuzz/ledger/ledger.h"
#include "io/file/json_values.h"
#include "io/file/text.h"

namespace selvage::fuzz {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kSchema = "selvage.fuzz/1";

/// The bins that hold something, by number.
Json kept_json(const Accuracy::Histogram& histogram) {
  Json json = Json::object();
  for (std::size_t bin = 0; bin < histogram.size(); ++bin) {
    if (histogram[bin] > 0) json[std::to_string(bin)] = histogram[bin];
  }
  return json;
}

Json kept_json(const Accuracy& accuracy) {
  return {{"early_time", kept_json(accuracy.early_time)},
          {"early_distance", kept_json(accuracy.early_distance)},
          {"apart", accuracy.apart},
          {"alarms", accuracy.alarms}};
}

Json kept_json(const PropertyLedger& property) {
  Json json;
  json["name"] = property.name;
  json["units"] = property.units.ranges();
  for (const auto& [unit, place] : property.open) json["open"].push_back({unit, place.stream, place.number});
  json["counters"] = property.counters;
  Json streams = Json::array();
  for (std::size_t i = 0; i < property.rows.size(); ++i) {
    const Counts& row = property.rows[i];
    const auto used = static_cast<std::ptrdiff_t>(property.counters.size());
    streams.push_back({{"name", property.streams[i]},
                       {"cases", row.cases},
                       {"failures", row.failures},
                       {"counts", std::vector<std::int64_t>(row.of.begin(), row.of.begin() + used)},
                       {"nearest_bits", row.nearest_bits}});
    if (i < property.accuracy.size() && property.accuracy[i] != Accuracy()) {
      streams.back()["accuracy"] = kept_json(property.accuracy[i]);
    }
  }
  json["streams"] = std::move(streams);
  Json findings = Json::array();
  for (const auto& [key, finding] : property.findings) {
    findings.push_back({{"stream", key.first},
                        {"failure", key.second},
                        {"count", finding.count},
                        {"case", finding.number},
                        {"file", finding.file}});
  }
  json["findings"] = std::move(findings);
  return json;
}

/// Not negative, and so that sums of many do not overflow. The library itself would convert -1 and 1e300 without a
/// word.
std::int64_t count(const Json& json) {
  constexpr std::uint64_t kLargest = std::uint64_t{1} << 53;
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > kLargest) {
    throw std::invalid_argument("'" + json.dump() + "' is no such count");
  }
  return json.get<std::int64_t>();
}

std::uint32_t checksum(const Json& json) {
  const std::int64_t value = count(json);
  if (value > std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument("'" + json.dump() + "' is no CRC-32");
  }
  return static_cast<std::uint32_t>(value);
}

Accuracy::Histogram histogram_of(const Json& json) {
  Accuracy::Histogram histogram{};
  for (const auto& [bin, value] : json.items()) {
    const std::optional<std::int64_t> place = io::parse_integer(bin);
    if (!place || *place < 0 || *place >= static_cast<std::int64_t>(histogram.size())) {
      throw std::invalid_argument("'" + bin + "' is no bin of a histogram");
    }
    histogram.at(static_cast<std::size_t>(*place)) = count(value);
  }
  return histogram;
}

Accuracy::ByGap by_gap_of(const Json& json) {
  Accuracy::ByGap by_gap{};
  if (json.size() != by_gap.size()) throw std::invalid_argument("a stream has not as many counts as there are gaps");
  std::transform(json.begin(), json.end(), by_gap.begin(), count);
  return by_gap;
}

Accuracy accuracy_of(const Json& json) {
  return {histogram_of(json.at("early_time")), histogram_of(json.at("early_distance")), by_gap_of(json.at("apart")),
          by_gap_of(json.at("alarms"))};
}

/// Of a case beside the ledger, or empty. A path would lead those who merge or go on out of their folders.
std::string file_name(const Json& json) {
  const auto name = json.get<std::string>();
  const bool is_path = name != std::filesystem::path(name).filename() || name == "." || name == "..";
  if (is_path || io::printable(name) != name) {
    throw std::invalid_argument("the file of a finding, '" + io::printable(name) +
                                "', is not the name of one in the campaign's folder; take the campaign again from "
                                "where it was made");
  }
  return name;
}

PropertyLedger property_of(const Json& json) {
  PropertyLedger property;
  property.name = json.at("name").get<std::string>();
  for (const Json& range : json.at("units")) {
    const std::int64_t begin = count(range.at(0)), end = count(range.at(1));
    if (begin >= end || !property.units.insert(begin, end)) throw std::invalid_argument("units overlap");
  }
  for (const Json& place : json.value("open", Json::array())) {
    property.open[count(place.at(0))] = {count(place.at(1)), count(place.at(2))};
  }
  property.counters = json.at("counters").get<std::vector<std::string>>();
  for (const Json& stream : json.at("streams")) {
    property.streams.push_back(stream.at("name").get<std::string>());
    Counts row;
    row.cases = count(stream.at("cases"));
    row.failures = count(stream.at("failures"));
    row.nearest_bits = count(stream.at("nearest_bits"));
    const Json& counts = stream.at("counts");
    if (counts.size() != property.counters.size() || counts.size() > Counts::kCounters) {
      throw std::invalid_argument("a stream has not as many counts as there are counters");
    }
    std::transform(counts.begin(), counts.end(), row.of.begin(), count);
    property.rows.push_back(row);
    property.accuracy.push_back(stream.contains("accuracy") ? accuracy_of(stream.at("accuracy")) : Accuracy());
  }
  for (const Json& finding : json.at("findings")) {
    property.findings[{finding.at("stream").get<std::string>(), finding.at("failure").get<std::string>()}] = {
        count(finding.at("count")), count(finding.at("case")), file_name(finding.at("file"))};
  }
  return property;
}

}  // namespace

std::string to_json(const Ledger& ledger) {
  Json json;
  json["schema"] = kSchema;
  json["version"] = ledger.version;
  json["target"] = ledger.target;
  if (ledger.plugin_crc32) json["plugin_crc32"] = *ledger.plugin_crc32;
  json["seed"] = ledger.seed;
  json["cases"] = ledger.cases;
  json["shard"] = {ledger.shard, ledger.shards};
  json["properties"] = Json::array();
  for (const PropertyLedger& property : ledger.properties) json["properties"].push_back(kept_json(property));
  return json.dump(1) + "\n";
}

Ledger parse_ledger(const std::string& text, const std::string& name) {
  try {
    if (const std::string fault = io::zero_byte_fault(text); !fault.empty()) throw std::invalid_argument(fault);
    const Json json = Json::parse(text);
    if (json.at("schema") != kSchema) throw std::invalid_argument("not a " + std::string(kSchema));
    Ledger ledger;
    ledger.version = json.at("version").get<std::string>();
    ledger.target = json.at("target").get<std::string>();
    if (json.contains("plugin_crc32")) ledger.plugin_crc32 = checksum(json.at("plugin_crc32"));
    const Json& seed = json.at("seed");
    if (!seed.is_number_unsigned()) throw std::invalid_argument("the seed is no number");
    ledger.seed = seed.get<std::uint64_t>();
    ledger.cases = count(json.at("cases"));
    ledger.shard = count(json.at("shard").at(0));
    ledger.shards = count(json.at("shard").at(1));
    for (const Json& property : json.at("properties")) ledger.properties.push_back(property_of(property));
    return ledger;
  } catch (const Json::parse_error& error) {
    throw io::Error(io::ErrorKind::kBadInput, name + ": no ledger of a campaign: not valid JSON at byte " +
                                                  std::to_string(error.byte) + "; is it whole?");
  } catch (const std::exception& error) {  // of nlohmann, or ours
    throw io::Error(io::ErrorKind::kBadInput, name + ": no ledger of a campaign: " + error.what());
  }
}

}  // namespace selvage::fuzz
