#include "cli/page/conformance_page.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "cli/page/report_words.h"
#include "fuzz/draw/generators.h"
#include "fuzz/kept/case_file.h"
#include "fuzz/shrink/shrink_query.h"
#include "io/file/atomic_file.h"
#include "io/file/text.h"
#include "page/page.h"

namespace selvage::cli {

using fuzz::ConformanceRow;
using page::element;
using page::Html;
using page::text;

namespace {

constexpr std::size_t kLargestCaseShown = 1 << 16;

/// A finding with its kept case, which there is not where the campaign was stopped before it was written.
struct Counterexample {
  std::string stream, failure;
  fuzz::Finding finding;
  std::filesystem::path file;
  std::string case_text;
  std::optional<fuzz::Case> kept;
};

std::vector<Counterexample> counterexamples(const fuzz::PropertyLedger& done, const ConformanceRun& run) {
  std::vector<Counterexample> all;
  for (const auto& [key, finding] : done.findings) {
    Counterexample one{key.first, key.second, finding, {}, {}, {}};
    if (!finding.file.empty()) {
      one.file = run.folder / finding.file;
      one.case_text = io::read_file(one.file, kLargestCaseShown);
      one.kept = fuzz::parse_case(one.case_text, one.file.string());
    }
    all.push_back(std::move(one));
  }
  return all;
}

struct FailureWords {
  std::string_view failure, words;
};
/// The gravest first; those of no plugin in particular come behind them, as they are called.
constexpr std::array<FailureWords, 4> kFailures{{{"missed", "contact missed"},
                                                 {"late-time", "time of impact too late"},
                                                 {"alarm-too-far", "alarm beyond the declared gap"},
                                                 {"unsteady", "answer that depends on earlier ones"}}};

std::string words_for(const std::string& failure) {
  const auto* known = std::ranges::find(kFailures, failure, &FailureWords::failure);
  return known == kFailures.end() ? failure : std::string(known->words);
}

/// Of names of failures.
struct ByGravity {
  bool operator()(const std::string& a, const std::string& b) const {
    const auto key = [](const std::string& failure) {
      return std::pair(std::ranges::find(kFailures, failure, &FailureWords::failure), failure);
    };
    return key(a) < key(b);
  }
};

std::string again(const Counterexample& one, const fuzz::Ledger& ledger, const ConformanceRun& run) {
  return fmt::format("selvage fuzz --plugin {} --seed {} --only {}:{}", io::shell_word(run.library.string()),
                     ledger.seed, fuzz::stream_word(one.stream), one.finding.number);
}

Html labelled(const std::string& label, const Html& content) {
  return element("p", {}, element("span", {{"class", "quiet"}}, text(label + " ")) + content);
}

std::string exact_words(const fuzz::Case& kept) {
  const verify::MotionAnswer exact = fuzz::exact_motion(kept.query, verify::Detail::kFirstTime);
  if (!exact.touches) return "never touch";
  const auto& [lower, upper, lower_approx, upper_approx] = exact.first;
  if (lower == upper) return fmt::format("touch first at t = {}", lower_approx);
  return fmt::format("touch first between t = {} and {}", lower_approx, upper_approx);
}

/// The case as bits, what is exactly true of it, and how to see it again.
Html shown(const Counterexample& one, const fuzz::Ledger& ledger, const ConformanceRun& run) {
  Html all;
  if (one.kept) {
    all += element("pre", {}, text(one.case_text));
    all += labelled("Exactly, the features", element("strong", {}, text(exact_words(*one.kept))));
    all += labelled("Smallest:", element("code", {},
                                         text("selvage replay --plugin " + io::shell_word(run.library.string()) + " " +
                                              io::shell_word(one.file.string()))));
  }
  all += labelled("First:", element("code", {}, text(again(one, ledger, run))));
  return all;
}

/// Of every kind of failure the case with the fewest and shortest numbers.
std::vector<const Counterexample*> smallest_of_each(const std::vector<Counterexample>& all) {
  std::map<std::string, const Counterexample*, ByGravity> smallest;
  for (const Counterexample& one : all) {
    if (!one.kept) continue;
    const Counterexample*& known = smallest[one.failure];
    if (known == nullptr || cost_of(one.kept->query) < cost_of(known->kept->query)) known = &one;
  }
  std::vector<const Counterexample*> list;
  for (const auto& [failure, one] : smallest) list.push_back(one);
  return list;
}

struct Verdict {
  const char* style;
  const char* mark;
  const char* name;
};
Verdict verdict_of(const fuzz::PropertyLedger& done, const ConformanceRun& run) {
  if (!done.findings.empty()) return {"violated", "\u2715", "does not conform"};
  if (done.streams_without_cases() > 0 || !run.is_finished) return {"unknown", "?", "unknown"};
  return {"clean", "\u2713", "nothing found"};
}

std::string lead(const std::vector<Counterexample>& all, const fuzz::PropertyLedger& done, const ConformanceRun& run) {
  const ConformanceRow total(done.total());
  std::string sentence =
      fmt::format("{}, {} of them exact touches", counted(total.queries, "constructed case"), grouped(total.touches));
  std::map<std::string, std::int64_t, ByGravity> kinds;
  for (const Counterexample& one : all) kinds[one.failure] += one.finding.count;
  if (kinds.empty()) sentence += ": no contact missed, no time of impact late, no alarm beyond the declared gap";
  const char* separator = ": ";
  for (const auto& [failure, count] : kinds) {
    sentence += fmt::format("{}{} {}", separator, words_for(failure), count == 1 ? "once" : grouped(count) + " times");
    separator = ", ";
  }
  if (const std::int64_t unasked = done.streams_without_cases(); unasked > 0) {
    sentence += fmt::format(". Of {} of the {} classes nothing is known: they were asked nothing", grouped(unasked),
                            grouped(std::ssize(done.rows)));
  }
  return sentence + (run.is_finished ? "." : ". The campaign was interrupted.");
}

Html header(const fuzz::PropertyLedger& done, const std::vector<Counterexample>& all, const fuzz::PluginInfo& info,
            const ConformanceRun& run) {
  const Verdict verdict = verdict_of(done, run);
  Html html = element("p", {{"class", "kicker"}},
                      text(run.program + " fuzz --plugin ") + element("code", {}, text(run.library.string())));
  html +=
      element("div", {{"class", std::string("verdict ") + verdict.style}},
              element("span", {{"class", "mark"}, {"aria-hidden", "true"}}, element("span", {}, text(verdict.mark))) +
                  element("h1", {{"id", "verdict"}}, text(std::string(info.name) + ": " + verdict.name)));
  return html + element("p", {{"class", "lead"}}, text(lead(all, done, run)));
}

Html detailed_fact(const std::string& name, const std::string& value, const std::string& detail) {
  return element("div", {},
                 element("dt", {}, text(name)) + element("dd", {}, text(value) + element("small", {}, text(detail)))) +
         Html{"\n"};
}

/// What an absurd tolerance shows in, though it keeps every promise.
Html accuracy_facts(const fuzz::Accuracy& accuracy) {
  Html list;
  const fuzz::Spread time = fuzz::spread_of(accuracy.early_time), distance = fuzz::spread_of(accuracy.early_distance);
  if (time.count > 0) {
    list += detailed_fact(
        "Times early by", fmt::format("{:.3g}", time.half),
        fmt::format("of the step at most, half of {}; 99 % {:.3g}, all {:.3g}; of the size {:.3g}, {:.3g}, {:.3g}",
                    grouped(time.count), time.all_but_a_hundredth, time.worst, distance.half,
                    distance.all_but_a_hundredth, distance.worst));
  }
  if (accuracy.apart[0] > 0) {
    const double share = 100 * static_cast<double>(accuracy.alarms[0]) / static_cast<double>(accuracy.apart[0]);
    list += detailed_fact("False alarms", grouped(accuracy.alarms[0]),
                          fmt::format("{:.3g} % of what stays apart by more than 2^{} of the size, of {} measured",
                                      share, fuzz::Accuracy::kGaps[0], grouped(accuracy.apart[0])));
  }
  return list;
}

Html facts_of(const fuzz::Ledger& ledger, const fuzz::PluginInfo& info) {
  const ConformanceRow total(ledger.properties.front().total());
  Html list = detailed_fact("Queries", grouped(total.queries), grouped(total.touches) + " touch exactly");
  list += detailed_fact("Alarms", grouped(total.alarms), "answered: collides");
  list += detailed_fact("Contacts missed", grouped(total.missed), "answered: separated");
  list += detailed_fact("Times too late", grouped(total.late),
                        info.has_toi ? "the features touch before them" : "it gives no times of impact");
  list += detailed_fact(
      "Alarms too far", grouped(total.too_far),
      fmt::format("beyond {:g} + {:g} of the size, as it declares", info.gap.tolerance, info.gap.relative_tolerance));
  list += accuracy_facts(ledger.properties.front().total_accuracy());
  list += detailed_fact("Misdeeds", grouped(total.misdeeds), "crashes, hangs, answers that are none");
  list += detailed_fact("Time a query", fmt::format("{:.0f} ns", total.nanoseconds_per_query()),
                        "reading the clock included, about 50 ns");
  list += detailed_fact("Seed", std::to_string(ledger.seed), "the cases depend on it alone");
  return element("dl", {{"class", "facts"}}, list);
}

/// Which part of the contacts was answered rightly, too late, or not at all.
Html contact_bar(const ConformanceRow& row) {
  if (row.touches == 0) return {};
  const auto part = [&](const char* style, std::int64_t count) {
    return element("i", {{"class", style}, {"style", fmt::format("flex-grow: {}", count)}}, {});
  };
  const std::string words =
      fmt::format("of {}: {} missed, {} late", counted(row.touches, "contact"), row.missed, row.late);
  return element(
      "span", {{"class", "share"}, {"role", "img"}, {"title", words}, {"aria-label", words}},
      part("clean", row.touches - row.missed - row.late) + part("late", row.late) + part("missed", row.missed));
}

Html legend() {
  return Html{
      "<p class=\"quiet\">Contacts: <i class=\"swatch clean\"></i>found in time "
      "<i class=\"swatch late\"></i>answered too late <i class=\"swatch missed\"></i>missed</p>\n"};
}

Html failures(std::int64_t count) {
  if (count == 0) return element("span", {{"class", "quiet"}}, text("0"));
  return element("strong", {{"class", "violated"}}, text(grouped(count)));
}

std::string anchor(std::string stream) {
  std::ranges::replace(stream, ' ', '-');
  return "class-" + stream;
}

std::vector<Html> cells(const Html& name, const ConformanceRow& row) {
  return {name,
          text(grouped(row.queries)),
          text(grouped(row.touches)),
          contact_bar(row),
          failures(row.missed),
          failures(row.late),
          failures(row.too_far),
          failures(row.misdeeds),
          text(fmt::format("{:.0f}", row.nanoseconds_per_query()))};
}

page::Table class_table(const fuzz::PropertyLedger& done, const fuzz::Property& property) {
  page::Table table{
      "classes", {"class", "queries", "contacts", "", "missed", "late", "too far", "misdeeds", "ns a query"}, {}};
  char group = 0;
  for (std::size_t i = 0; i < done.rows.size(); ++i) {
    const fuzz::Stream& stream = property.streams()[i];
    if (stream.group != group) {
      group = stream.group;
      const auto& groups = fuzz::query_groups();
      const auto named = std::ranges::find(groups, group, &fuzz::QueryGroup::letter);
      table.rows.push_back({element("strong", {}, text(fmt::format("{}  {}", group, named->name)))});
    }
    const Html name = done.rows[i].failures == 0
                          ? text(stream.name)
                          : element("a", {{"href", "#" + anchor(stream.name)}}, text(stream.name));
    table.rows.push_back(cells(name, ConformanceRow(done.rows[i])));
  }
  table.rows.push_back(cells(element("strong", {}, text("all")), ConformanceRow(done.total())));
  return table;
}

Html smallest(const std::vector<Counterexample>& all, const fuzz::Ledger& ledger, const ConformanceRun& run) {
  Html cards;
  for (const Counterexample* one : smallest_of_each(all)) {
    const Html heading = element("h3", {}, text(words_for(one->failure))) +
                         element("p", {{"class", "quiet"}}, text("smallest, from the class " + one->stream));
    cards += element("article", {}, heading + shown(*one, ledger, run)) + Html{"\n"};
  }
  return element("div", {{"class", "cards"}}, cards);
}

/// A browser opens what an address points into.
Html findings(const std::vector<Counterexample>& all, const fuzz::Ledger& ledger, const ConformanceRun& run) {
  Html list;
  std::string last;
  for (const Counterexample& one : all) {
    const std::string title =
        fmt::format("{}: {}, {}, first in case {}", one.stream, words_for(one.failure),
                    one.finding.count == 1 ? "once" : grouped(one.finding.count) + " times", one.finding.number);
    const Html inside = shown(one, ledger, run);
    const Html target =
        one.stream == last ? element("div", {}, inside) : element("div", {{"id", anchor(one.stream)}}, inside);
    last = one.stream;
    list += element("details", {}, element("summary", {}, text(title)) + target) + Html{"\n"};
  }
  return list;
}

}  // namespace

std::string conformance_page(const fuzz::Ledger& ledger, const fuzz::Property& property, const fuzz::PluginInfo& info,
                             const ConformanceRun& run) {
  const fuzz::PropertyLedger& done = ledger.properties.front();
  const std::vector<Counterexample> all = counterexamples(done, run);
  page::Page page(fmt::format("{}: {}", info.name, verdict_of(done, run).name));
  page.add_header(header(done, all, info, run));
  page.add_section("What was asked", facts_of(ledger, info), "facts");
  if (!all.empty()) page.add_section("The smallest counterexamples", smallest(all, ledger, run), "smallest");
  page.add_section("Classes of queries", legend() + page::table(class_table(done, property)), "by-class");
  if (!all.empty()) page.add_section("Every finding", findings(all, ledger, run), "findings");
  page.add_section("About this page",
                   element("p", {},
                           text("Every answer was judged by exact arithmetic on the bits shown here. Each point of a "
                                "case stands at t = 0, then at t = 1, and moves on a straight line. 'First' is the "
                                "lowest case of its class that failed so; 'smallest' is what shrinking made of it.")),
                   "about");
  page.add_data("report", fuzz::conformance_json(ledger, info));
  return page.html();
}

}  // namespace selvage::cli
