// Campaigns: the same result for any number of workers and shards, through crashes, hangs and kills.
#include "fuzz/run/driver.h"

#include <csignal>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <oneapi/tbb/parallel_for.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fuzz/run/campaign_stats.h"
#include "fuzz/run/work_units.h"
#include "io/file/atomic_file.h"
#include "tests/cli/run_program.h"

namespace selvage::fuzz {
namespace {

namespace fs = std::filesystem;
using testing::slurp;
using testing::TemporaryFolder;

void endless_loop() {
  volatile bool goes_on = true;
  while (goes_on) {
  }
}

void endless_sleep() {
  while (true) pause();
}

/// Cases that cost nothing and come to something that can be predicted.
class Arithmetic final : public Property {
 public:
  explicit Arithmetic(bool is_deadly = false) : Property("arithmetic", "adds up"), is_deadly_(is_deadly) {
    streams_ = {{"one", 'A', 40}, {"two", 'B', 10}};
    counters_ = {"sum"};
  }
  Outcome run(const Stream& stream, ChoiceSource source) override {
    const auto value = static_cast<std::int64_t>(source.n(1000));
    if (is_deadly_ && stream.name == "two" && value % 100 == 7) std::raise(SIGSEGV);
    if (is_deadly_ && stream.name == "one" && value == 500) endless_loop();
    if (is_deadly_ && stream.name == "one" && value == 600) endless_sleep();
    if (value == 13) return {{1, 1, {value}, value}, "unlucky"};
    const int small = static_cast<int>(value % 6);
    return {{1, 0, {value}, value}, {}, {small, 2 * small, small, value % 2 == 0}};
  }
  std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin, const std::string& failure,
                   bool shrunk) override {
    return stream.name + " " + origin + " " + failure + " " + std::to_string(source.n(1000)) + (shrunk ? "!\n" : "\n");
  }

 private:
  bool is_deadly_;
};

Properties one_property(bool is_deadly = false) {
  Properties properties;
  properties.push_back(std::make_unique<Arithmetic>(is_deadly));
  return properties;
}

DriverOptions options_for(const fs::path& folder, std::int64_t cases) {
  DriverOptions options;
  options.folder = folder;
  options.cases = cases;
  options.version = "test";
  return options;
}

void run_all(Properties& properties, const DriverOptions& options) {
  Driver driver(properties, options);
  EXPECT_TRUE(driver.run([] { return false; }, [](const DriverStatus&) {}));
}

TEST(Driver, AnyNumberOfWorkersAndShardsGivesTheSameBits) {
  const TemporaryFolder folder;
  Properties properties = one_property();
  constexpr std::int64_t kCases = 20000;
  run_all(properties, options_for(folder.path() / "whole", kCases));
  const std::string whole = slurp(folder.path() / "whole" / kLedgerFile);
  const Ledger ledger = parse_ledger(whole, "whole");
  EXPECT_EQ(ledger.properties[0].total().cases, kCases);
  EXPECT_GT(ledger.properties[0].findings.at({"one", "unlucky"}).count, 1);
  const Accuracy accuracy = ledger.properties[0].total_accuracy();
  EXPECT_GT(accuracy.early_time[5], kCases / 10);
  EXPECT_EQ(accuracy.early_time[5], accuracy.early_distance[10]);
  EXPECT_EQ(accuracy.early_time[5], accuracy.apart[5]);

  DriverOptions many = options_for(folder.path() / "many", kCases);
  many.jobs = 5;
  run_all(properties, many);
  EXPECT_EQ(slurp(many.folder / kLedgerFile), whole);

  std::vector<Ledger> parts;
  for (std::int64_t shard = 1; shard <= 3; ++shard) {
    DriverOptions options = options_for(folder.path() / std::to_string(shard), kCases);
    options.shard = shard;
    options.shards = 3;
    options.jobs = 2;
    run_all(properties, options);
    parts.push_back(parse_ledger(slurp(options.folder / kLedgerFile), "part"));
  }
  EXPECT_EQ(to_json(merge(parts)), whole);
  std::swap(parts[0], parts[2]);
  EXPECT_EQ(to_json(merge(parts)), whole);
  EXPECT_THROW((void)merge({parts[0], parts[1]}), io::Error);            // one is missing
  EXPECT_THROW((void)merge({parts[0], parts[1], parts[1]}), io::Error);  // one is twice
  parts[1].seed = 2;
  EXPECT_THROW((void)merge(parts), io::Error);  // another campaign
}

TEST(Driver, RunsNoFewerCasesThanWereAskedFor) {
  const TemporaryFolder folder;
  Properties properties = one_property();
  const std::int64_t asked = unit_size(*properties[0]) + 1;
  run_all(properties, options_for(folder.path(), asked));
  EXPECT_GE(parse_ledger(slurp(folder.path() / kLedgerFile), "ledger").properties[0].total().cases, asked);
}

TEST(Driver, UnitsThatAreOpenInAnyShardAreOpenInTheWhole) {
  Ledger first = make_ledger(one_property());
  first.shards = 2;
  Ledger second = first;
  second.shard = 2;
  first.properties[0].open = {{0, {1, 3}}, {2, {0, 5}}};
  second.properties[0].open = {{1, {0, 7}}};
  const std::map<std::int64_t, UnitPlace> all = {{0, {1, 3}}, {1, {0, 7}}, {2, {0, 5}}};
  EXPECT_EQ(merge({first, second}).properties[0].open, all);
}

TEST(Driver, EveryKindOfFailureIsKeptOnce) {
  const TemporaryFolder folder;
  Properties properties = one_property();
  run_all(properties, options_for(folder.path(), 50000));
  const Ledger ledger = parse_ledger(slurp(folder.path() / kLedgerFile), "ledger");
  for (const auto& [key, finding] : ledger.properties[0].findings) {
    const std::string kept = slurp(folder.path() / finding.file);
    EXPECT_EQ(kept, key.first + " arithmetic:" + key.first + ":1:" + std::to_string(finding.number) + " unlucky 13!\n");
    const auto& streams = properties[0]->streams();
    const auto stream =
        std::find_if(streams.begin(), streams.end(), [&name = key.first](const Stream& s) { return s.name == name; });
    EXPECT_EQ(run_case(*properties[0], *stream, 1, finding.number, 1).outcome.failure, "unlucky");
  }
  EXPECT_EQ(ledger.properties[0].findings.size(), 2U);
}

TEST(Driver, CrashesAndHangsAreFindingsAndNotTheEnd) {
  const TemporaryFolder folder;
  Properties properties = one_property(true);
  DriverOptions options = options_for(folder.path(), 1000);
  options.case_seconds = 0.05;
  options.jobs = 2;
  run_all(properties, options);
  const PropertyLedger ledger = parse_ledger(slurp(folder.path() / kLedgerFile), "ledger").properties[0];
  EXPECT_EQ(ledger.rows[0].cases + ledger.rows[1].cases, 1000);
  std::int64_t deadly = 0;  // as the cases themselves say
  for (std::int64_t number = 0; number < 200; ++number) {
    ChoiceSource source = ChoiceSource::from_seed(case_seed(1, properties[0]->streams()[1], number));
    deadly += source.n(1000) % 100 == 7;
  }
  ASSERT_GT(deadly, 0);
  EXPECT_EQ(ledger.findings.at({"two", "crashed-SIGSEGV"}).count, deadly);
  EXPECT_FALSE(ledger.findings.at({"two", "crashed-SIGSEGV"}).file.empty());
  EXPECT_EQ(ledger.findings.at({"one", "hung"}).count, 2);
}

/// Three cases in two workers: the lowest fails last, like the one that dies while it is made simpler.
class Overtaken final : public Property {
 public:
  explicit Overtaken(fs::path folder) : Property("overtaken", "is kept lowest"), folder_(std::move(folder)) {
    streams_ = {{"one", 0, 1}};
  }
  Outcome run(const Stream& stream, ChoiceSource source) override {
    const std::int64_t number = number_of(stream, source);
    if (number == 0) await("being-shrunk");
    if (number == 2) reach("lowest-is-known");  // given to the worker that has told of case 0
    return {{1, number < 2 ? 1 : 0, {}, 0}, number < 2 ? "unlucky" : ""};
  }
  std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin, const std::string&,
                   bool shrunk) override {
    if (shrunk && number_of(stream, source) == 1) {
      reach("being-shrunk");
      await("lowest-is-known");
      std::raise(SIGSEGV);
    }
    return origin;
  }

 private:
  static std::int64_t number_of(const Stream& stream, ChoiceSource source) {
    const auto drawn = [](ChoiceSource from) { return from.n(1U << 30); };
    std::int64_t number = 0;
    while (drawn(ChoiceSource::from_seed(case_seed(1, stream, number))) != drawn(source)) ++number;
    return number;
  }
  void reach(const char* mark) const { io::write_atomically(folder_ / mark, ""); }
  void await(const char* mark) const {
    while (!fs::exists(folder_ / mark)) usleep(1000);
  }

  fs::path folder_;
};

TEST(Driver, NamesTheFileOfNoCaseButTheLowest) {
  const TemporaryFolder folder;
  Properties properties;
  properties.push_back(std::make_unique<Overtaken>(folder.path()));
  DriverOptions options = options_for(folder.path() / "campaign", 3);
  options.jobs = 2;
  run_all(properties, options);
  const PropertyLedger ledger = parse_ledger(slurp(options.folder / kLedgerFile), "ledger").properties[0];
  const Finding& finding = ledger.findings.at({"one", "unlucky"});
  EXPECT_EQ(finding.number, 0);
  EXPECT_EQ(slurp(options.folder / finding.file), "overtaken:one:1:0");
}

/// A unit of cases that take a millisecond, until one does something else. Few are ahead of that one: on a busy machine
/// the campaigns of run_out_of_time() come to a few dozen.
class Slow final : public Property {
 public:
  using Case = void (*)();
  explicit Slow(Case last) : Property("slow", "goes on"), last_(last) {
    streams_ = {{"one", 'A', last == nullptr ? 200 : 1}, {"two", 'A', 200}};
  }
  Outcome run(const Stream& stream, ChoiceSource source) override {
    if (last_ != nullptr && stream.name == "two") last_();
    usleep(1000);
    return {{1, 0, {}, static_cast<std::int64_t>(source.n(1000))}, source.n(10) == 0 ? "unlucky" : ""};
  }
  std::string kept(const Stream&, ChoiceSource, const std::string& origin, const std::string&, bool) override {
    return origin;
  }

 private:
  Case last_;
};

/// A campaign that is soon out of time, and how long it took.
double run_out_of_time(Properties& properties, DriverOptions options) {
  options.seconds = 0.3;
  options.case_seconds = 0.5;
  const auto start = std::chrono::steady_clock::now();
  run_all(properties, options);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Driver, AUnitThatIsCutShortGoesOnFromThere) {
  const TemporaryFolder folder;
  Properties properties;
  properties.push_back(std::make_unique<Slow>(nullptr));
  const DriverOptions whole = options_for(folder.path() / "whole", 800);
  run_all(properties, whole);
  DriverOptions parts = options_for(folder.path() / "parts", 800);
  parts.resume = true;
  for (int i = 0; i < 2; ++i) {
    run_out_of_time(properties, parts);
    const PropertyLedger cut = parse_ledger(slurp(parts.folder / kLedgerFile), "cut").properties[0];
    EXPECT_EQ(cut.open.size(), 1U);
    EXPECT_GT(cut.total().cases, 0);
    EXPECT_LT(cut.total().cases, 800);
  }
  run_all(properties, parts);
  EXPECT_EQ(slurp(parts.folder / kLedgerFile), slurp(whole.folder / kLedgerFile));
}

// A hang that sleeps once held up the end of a campaign by 20 case times a case.
TEST(Driver, OutOfTimeItWaitsForAHangNoLongerThanForACase) {
  // A driver that gets no processor does not see it asleep for long enough, and gives up without a verdict.
  constexpr int kAttempts = 5;
  bool is_heard = false;
  for (int attempt = 0; attempt < kAttempts && !is_heard; ++attempt) {
    const TemporaryFolder folder;
    Properties properties;
    properties.push_back(std::make_unique<Slow>(endless_sleep));
    const DriverOptions options = options_for(folder.path(), 0);
    EXPECT_LT(run_out_of_time(properties, options), 5);
    const PropertyLedger ledger = parse_ledger(slurp(folder.path() / kLedgerFile), "ledger").properties[0];
    const auto hung = ledger.findings.find({"two", "hung"});
    is_heard = hung != ledger.findings.end();
    if (!is_heard) continue;
    EXPECT_EQ(hung->second.count, 1);
    EXPECT_EQ(slurp(folder.path() / hung->second.file), "slow:two:1:0");
  }
  EXPECT_TRUE(is_heard);
}

/// Waits for its child as for a disk, which is no sleep.
void wait_like_a_disk() {
  if (vfork() == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    pause();
    _exit(0);
  }
}

TEST(Driver, WhatNeitherComputesNorSleepsIsGivenUpWithoutAVerdict) {
  const TemporaryFolder folder;
  Properties properties;
  properties.push_back(std::make_unique<Slow>(wait_like_a_disk));
  const DriverOptions options = options_for(folder.path(), 0);
  EXPECT_LT(run_out_of_time(properties, options), 5);
  const PropertyLedger ledger = parse_ledger(slurp(folder.path() / kLedgerFile), "ledger").properties[0];
  EXPECT_FALSE(ledger.findings.contains({"two", "hung"}));
  EXPECT_EQ(ledger.open.at(0), (UnitPlace{1, 0}));
}

std::ptrdiff_t thread_count() {
  const fs::directory_iterator tasks("/proc/self/task");
  return std::distance(begin(tasks), end(tasks));
}

/// What is made once is made with the threads that there are.
class MadeInParallel final : public Property {
 public:
  MadeInParallel() : Property("made in parallel", "forks alone") { streams_ = {{"one", 'A', 1000}}; }
  void prepare() override {
    std::vector<double> sums(1000);
    oneapi::tbb::parallel_for(0, 1000, [&](int i) {
      for (int k = 0; k < 1000; ++k) sums[static_cast<std::size_t>(i)] += std::sqrt(k);
    });
  }
  Outcome run(const Stream& /*stream*/, ChoiceSource source) override {
    const std::vector<char> memory(std::size_t{1} << source.n(18));
    return {{1, 0, {}, 0}, memory.back() == 0 ? "" : "dirty"};
  }
  std::string kept(const Stream&, ChoiceSource, const std::string&, const std::string&, bool) override { return {}; }
};

// A fork copies locks and not the threads that hold them. The driver once let oneTBB start a thread just before it
// forked: under AddressSanitizer one run in about 60 then had a worker that waited for ever for the allocator, and a
// kernel that never hangs was reported to hang.
TEST(Driver, ForksWithoutThreads) {
  const TemporaryFolder folder;
  Properties properties;
  properties.push_back(std::make_unique<MadeInParallel>());
  const std::ptrdiff_t before = thread_count();
  Driver driver(properties, options_for(folder.path(), 20000));
  std::ptrdiff_t most = 0;
  EXPECT_TRUE(driver.run([] { return false; }, [&](const DriverStatus&) { most = std::max(most, thread_count()); }));
  EXPECT_EQ(most, before);
  EXPECT_TRUE(driver.ledger().properties[0].findings.empty());
}

TEST(Driver, SaysWhereItIs) {
  Ledger ledger;
  PropertyLedger property;
  property.counters = {"touches", "hits", "alarms", "exact"};
  property.streams = {"one", "two"};
  property.rows = {{40, 2, {9, 12'345, 6, 5}, 51}, {60, 0, {1, 0, 1, 0}, 53}};
  property.findings[{"one", "missed"}] = {2, 7, {}};
  ledger.properties = {property};
  DriverStatus status;
  status.seconds = 20;
  status.cases = 4'560'000;
  EXPECT_EQ(status_line(ledger, status),
            "20 s: 4.56M cases, 228k a second, 12.3k hits, 7 alarms, 5 exact, nearest 2^-53, 2 missed");
  const auto line = nlohmann::json::parse(stats_line(ledger, status));
  EXPECT_EQ(line["cases_per_second"], 228'000);
  const nlohmann::json& one = line["properties"][property.name];
  EXPECT_EQ(one["cases"], 100);
  EXPECT_EQ(one["hits"], 12'345);
  EXPECT_EQ(one["alarms"], 7);
  EXPECT_EQ(one["exact"], 5);
  EXPECT_EQ(one["nearest_bits"], 53);
  EXPECT_EQ(one["failures"]["missed"], 2);
  ledger.properties[0].findings.clear();
  EXPECT_TRUE(status_line(ledger, status).ends_with(", no failure"));
}

TEST(Driver, RefusesAnotherCampaignsFolder) {
  const TemporaryFolder folder;
  Properties properties = one_property();
  run_all(properties, options_for(folder.path(), 100));
  try {
    const Driver again(properties, options_for(folder.path(), 100));
    ADD_FAILURE() << "a campaign is there already";
  } catch (const io::Error& error) {
    EXPECT_EQ(error.kind(), io::ErrorKind::kFile);
  }
  DriverOptions other = options_for(folder.path(), 100);
  other.resume = true;
  other.seed = 2;
  EXPECT_THROW(Driver(properties, other), io::Error);
}

/// The driver in a process of its own, to be killed.
pid_t start_driver(const DriverOptions& options) {
  const pid_t child = fork();
  if (child != 0) return child;
  Properties properties = one_property();
  Driver driver(properties, options);
  const bool finished = driver.run([] { return false; }, [](const DriverStatus&) {});
  _exit(finished ? 0 : 1);
}

/// SELVAGE_KILLS: how often; a few in ctest, hundreds by hand.
TEST(Driver, KilledAtAnyMomentItLosesNothingAcknowledged) {
  const TemporaryFolder folder;
  constexpr std::int64_t kCases = 400000;
  Properties properties = one_property();
  run_all(properties, options_for(folder.path() / "whole", kCases));
  DriverOptions options = options_for(folder.path() / "killed", kCases);
  options.resume = true;
  options.jobs = 2;
  const char* asked = std::getenv("SELVAGE_KILLS");
  const int kills = asked != nullptr ? std::atoi(asked) : 8;
  ChoiceSource random = ChoiceSource::from_seed(1);
  std::int64_t acknowledged = 0;
  int killed = 0;
  for (int i = 0; i < kills; ++i) {
    const pid_t child = start_driver(options);
    std::this_thread::sleep_for(std::chrono::milliseconds(1 + random.n(60)));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    killed += WIFSIGNALED(status) ? 1 : 0;
    if (WIFEXITED(status)) fs::remove_all(options.folder), acknowledged = 0;  // it was done: begin again
    if (!fs::exists(options.folder / kLedgerFile)) continue;
    const Ledger ledger = parse_ledger(slurp(options.folder / kLedgerFile), "killed");  // never half-written
    const std::int64_t units = ledger.properties[0].units.size();
    EXPECT_GE(units, acknowledged);
    acknowledged = units;
    std::istringstream stats(slurp(options.folder / kStatsFile));
    for (std::string line; std::getline(stats, line);) EXPECT_TRUE(nlohmann::json::accept(line)) << line;
  }
  EXPECT_GT(killed, 0);
  run_all(properties, options);
  EXPECT_EQ(slurp(options.folder / kLedgerFile), slurp(folder.path() / "whole" / kLedgerFile));
}

}  // namespace
}  // namespace selvage::fuzz
