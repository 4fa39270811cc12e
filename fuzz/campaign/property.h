// A promise that campaigns attack: named streams of cases, each case made from a seed, run, and judged.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fuzz/base/choice_source.h"
#include "fuzz/base/counts.h"
#include "fuzz/oracle/accuracy.h"

namespace selvage::fuzz {

/// Cases of one kind. Case i depends on the campaign's seed, the stream's name and i alone.
struct Stream {
  std::string name;
  char group = 0;             ///< of query classes; 0: none
  std::int64_t per_unit = 1;  ///< cases in a work unit
};

/// A stream's name without blanks, as --only and the origin of a kept case have it.
[[nodiscard]] inline std::string stream_word(std::string name) {
  std::ranges::replace(name, ' ', '/');
  return name;
}

[[nodiscard]] std::uint64_t case_seed(std::uint64_t seed, const Stream& stream, std::int64_t number);

struct Outcome {
  Counts counts;
  std::string failure;  ///< the broken promise in a word, or empty
  AccuracySample accuracy = {};
};

class Property {
 public:
  Property(std::string name, std::string promise) : name_(std::move(name)), promise_(std::move(promise)) {}
  virtual ~Property() = default;
  Property(const Property&) = delete;
  Property& operator=(const Property&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& promise() const { return promise_; }  ///< one line for people
  [[nodiscard]] const std::vector<Stream>& streams() const { return streams_; }
  [[nodiscard]] const std::vector<std::string>& counters() const { return counters_; }
  /// Share of a campaign's processor time, relative to the other properties.
  [[nodiscard]] int weight() const { return weight_; }

  /// In the driver, before there are workers, which inherit what is made here. May not start threads.
  virtual void prepare() {}
  /// In the process that will run cases, before the first.
  virtual void start() {}
  /// To be called with each case that kept() runs, by a property whose cases may hang.
  void on_beat(std::function<void()> beat) { beat_ = std::move(beat); }
  [[nodiscard]] virtual Outcome run(const Stream& stream, ChoiceSource source) = 0;
  /// Why these counts say that a stream has gone dead or an answer is useless (F1), or nothing.
  [[nodiscard]] virtual std::string complaint(const Stream& /*stream*/, const Counts& /*counts*/) const { return {}; }
  /// A file that keeps the case and that `selvage replay` explains. With `shrunk` it is made simpler first, as long as
  /// it fails with the same word; the code under test runs for that. `origin` says where it came from.
  [[nodiscard]] virtual std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin,
                                         const std::string& failure, bool shrunk) = 0;

 protected:
  std::vector<Stream> streams_;
  std::vector<std::string> counters_;
  int weight_ = 1;
  std::function<void()> beat_ = [] {};

 private:
  std::string name_, promise_;
};

using Properties = std::vector<std::unique_ptr<Property>>;

/// Everything that Selvage promises and can be fuzzed, in a fixed order.
[[nodiscard]] Properties all_properties();

}  // namespace selvage::fuzz
