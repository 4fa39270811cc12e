#include "fuzz/harness/fuzz_target.h"

#include <algorithm>
#include <stdexcept>

#include "fuzz/campaign/property.h"
#include "fuzz/kept/file_formats.h"
#include "kernel/assert.h"

namespace selvage::fuzz {
namespace {

class ParserTarget final : public FuzzTarget {
 public:
  explicit ParserTarget(const FileFormat& format)
      : FuzzTarget(std::string(format.name), {"accepted", "refused"}), format_(format) {}

  TargetResult run(Bytes input) override {
    switch (format_.parse({reinterpret_cast<const char*>(input.data()), input.size()})) {
      case ParseResult::kAccepted:
        return {{"accepted"}, {}};
      case ParseResult::kRefused:
        return {{"refused"}, {}};
      case ParseResult::kUnsound:
        break;
    }
    return {{}, "unsound"};
  }

  std::string kept(Bytes /*input*/, const std::string& /*failure*/) override { return {}; }
  std::vector<std::string> seeds() override { return format_.samples; }

 private:
  const FileFormat& format_;
};

/// Properties with the same streams: the first choice of an input is the stream, the others make the case, which each
/// of the properties judges.
class PropertyTarget final : public FuzzTarget {
 public:
  PropertyTarget(std::string name, const std::vector<std::string>& properties, std::vector<std::string> must_show)
      : FuzzTarget(std::move(name), std::move(must_show)) {
    for (auto& property : all_properties()) {
      if (std::ranges::find(properties, property->name()) != properties.end()) {
        properties_.push_back(std::move(property));
      }
    }
    SELVAGE_ASSERT(properties_.size() == properties.size());
    for (const Stream& stream : properties_.front()->streams()) {
      if (stream.group != kRecordedGroup) streams_.push_back(stream);
    }
  }

  void prepare() override {
    for (const auto& property : properties_) property->prepare();
  }

  TargetResult run(Bytes input) override {
    TargetResult result;
    for (const auto& property : properties_) {
      ChoiceSource source = ChoiceSource::from_bytes(input);
      const Stream& stream = choose_stream(source);
      const Outcome outcome = property->run(stream, source);
      for (std::size_t i = 0; i < property->counters().size(); ++i) {
        if (outcome.counts.of[i] > 0) result.shown.push_back(property->counters()[i]);
      }
      if (!outcome.failure.empty() && result.failure.empty()) result.failure = property->name() + " " + outcome.failure;
    }
    return result;
  }

  std::string kept(Bytes input, const std::string& failure) override {
    for (const auto& property : properties_) {
      if (!failure.starts_with(property->name() + " ")) continue;
      ChoiceSource source = ChoiceSource::from_bytes(input);
      const Stream& stream = choose_stream(source);
      return property->kept(stream, source, "fuzz-input:" + stream_word(stream.name),
                            failure.substr(property->name().size() + 1), true);
    }
    return {};
  }

  /// The first case that a campaign makes of each stream.
  std::vector<std::string> seeds() override {
    std::vector<std::string> seeds;
    for (std::uint32_t i = 0; i < streams_.size(); ++i) {
      std::vector<std::uint8_t> bytes;
      const std::vector<std::uint32_t> choice{i};
      ChoiceSource chooser = ChoiceSource::from_words(choice);
      chooser.record_to(bytes);
      const Stream& stream = choose_stream(chooser);
      ChoiceSource source = ChoiceSource::from_seed(case_seed(1, stream, 0));
      source.record_to(bytes);
      static_cast<void>(properties_.front()->run(stream, source));
      seeds.emplace_back(bytes.begin(), bytes.end());
    }
    return seeds;
  }

 private:
  static constexpr char kRecordedGroup = 'J';

  const Stream& choose_stream(ChoiceSource& source) const {
    return streams_[source.n(static_cast<std::uint32_t>(streams_.size()))];
  }

  Properties properties_;
  std::vector<Stream> streams_;
};

}  // namespace

std::vector<std::unique_ptr<FuzzTarget>> fuzz_targets() {
  std::vector<std::unique_ptr<FuzzTarget>> targets;
  for (const FileFormat& format : file_formats()) targets.push_back(std::make_unique<ParserTarget>(format));
  const auto add = [&targets](std::string name, std::vector<std::string> properties, std::vector<std::string> shows) {
    targets.push_back(std::make_unique<PropertyTarget>(std::move(name), properties, std::move(shows)));
  };
  add("query", {"ccd", "symmetry", "scale", "proximity"}, {"touches", "hits", "alarms", "exact"});
  add("broad", {"broad"}, {"pairs"});
  add("step", {"step"}, {"collisions", "zones", "fail-safe"});
  add("subdivision", {"subdivision"}, {"stopped"});
  return targets;
}

std::unique_ptr<FuzzTarget> fuzz_target(std::string_view name) {
  for (auto& target : fuzz_targets()) {
    if (target->name() == name) return std::move(target);
  }
  throw std::invalid_argument("there is no fuzz target '" + std::string(name) + "'");
}

}  // namespace selvage::fuzz
