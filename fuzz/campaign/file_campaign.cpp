#include "fuzz/campaign/file_campaign.h"

#include <algorithm>
#include <array>

#include "fuzz/kept/file_case.h"
#include "fuzz/kept/file_formats.h"
#include "fuzz/shrink/shrink_bytes.h"
#include "kernel/assert.h"

namespace selvage::fuzz {
namespace {

using namespace std::string_view_literals;

constexpr std::int64_t kTrials = 5000;

/// Words that parsers trip over: numbers at the edge of their types, separators, names of things.
constexpr std::array<std::string_view, 24> kWords{"-1",    "0",   "4294967296", "-9223372036854775809",
                                                  "1e999", "nan", "inf",        "0x1p-1074",
                                                  "1.",    "",    "\n",         " ",
                                                  "\"",    "/",   "[",          "]",
                                                  "{",     "}",   "=",          "f 1 1 1\n",
                                                  "#",     ",",   "\0\0"sv,     "\xff\xff\xff\xff"};

static_assert(std::ranges::count(kWords, ""sv) == 1);  // a word that begins with NUL is none

std::size_t choose_place(ChoiceSource& source, const std::string& bytes) {
  return source.n(static_cast<std::uint32_t>(bytes.size()) + 1);
}

void edit(ChoiceSource& source, std::string& bytes) {
  const std::size_t place = choose_place(source, bytes);
  const std::size_t length = std::min<std::size_t>(1 + source.n(16), bytes.size() - place);
  switch (source.n(6)) {
    case 0:
      if (place < bytes.size()) bytes[place] = static_cast<char>(source.n(256));
      break;
    case 1:
      bytes.erase(place, length);
      break;
    case 2:
      bytes.insert(place, kWords[source.n(kWords.size())]);
      break;
    case 3:
      bytes.insert(choose_place(source, bytes), bytes.substr(place, length));
      break;
    case 4:
      bytes.replace(place, length, kWords[source.n(kWords.size())]);
      break;
    default:
      if (place < bytes.size()) bytes[place] = static_cast<char>(bytes[place] ^ (1 << source.n(8)));
      break;
  }
}

class FileCampaign final : public Property {
 public:
  FileCampaign() : Property("files", std::string(file_kind().promise)) {
    for (const FileFormat& format : file_formats()) streams_.push_back({std::string(format.name), 0, 300});
    counters_ = {"accepted", "refused"};
  }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    Outcome outcome{{1, 0, {}, 0}, {}};
    switch (format_of(stream).parse(damaged(stream, source))) {
      case ParseResult::kAccepted:
        outcome.counts.of[kAccepted] = 1;
        break;
      case ParseResult::kRefused:
        outcome.counts.of[kRefused] = 1;
        break;
      case ParseResult::kUnsound:
        outcome.counts.failures = 1;
        outcome.failure = "unsound";
        break;
    }
    return outcome;
  }

  [[nodiscard]] std::string complaint(const Stream& /*stream*/, const Counts& counts) const override {
    return counts.cases > 200 && counts.of[kRefused] == 0 ? "nothing is refused" : "";
  }

  std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin, const std::string& failure,
                   bool shrunk) override {
    const ByteCase kept = file_case(stream.name, damaged(stream, source));
    return kept_text(KeptBytes(shrunk ? shrink(kept, failure, kTrials) : kept), origin, failure);
  }

 private:
  // Places in Counts::of, in the order of counters_.
  enum Counter : std::uint8_t { kAccepted, kRefused };

  static const FileFormat& format_of(const Stream& stream) {
    const auto found = std::ranges::find(file_formats(), stream.name, &FileFormat::name);
    SELVAGE_ASSERT(found != file_formats().end());
    return *found;
  }

  static std::string damaged(const Stream& stream, ChoiceSource& source) {
    const FileFormat& format = format_of(stream);
    std::string bytes = format.samples[source.n(static_cast<std::uint32_t>(format.samples.size()))];
    for (int edits = source.range(1, 6); edits > 0; --edits) edit(source, bytes);
    return bytes;
  }
};

}  // namespace

std::unique_ptr<Property> make_file_campaign() { return std::make_unique<FileCampaign>(); }

}  // namespace selvage::fuzz
