#include "fuzz/run/driver.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <functional>
#include <numeric>
#include <set>
#include <stdexcept>

#include <fcntl.h>
#include <oneapi/tbb/global_control.h>
#include <poll.h>

#include "fuzz/base/deaths.h"
#include "fuzz/run/campaign_stats.h"
#include "fuzz/run/work_units.h"
#include "io/file/atomic_file.h"
#include "kernel/assert.h"

namespace selvage::fuzz {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTick_ms = 100;
constexpr double kSaveEvery_s = 1;
/// Beyond a case's time that workers get to come to an end: a hang is seen by then, which takes a few ticks more.
constexpr double kGrace_s = 1;
/// A stream that crashed so many workers is not run any more in this run, because each costs a process; nor is one, or
/// a property, that hung so often, because a hang costs many seconds.
constexpr int kMaxCrashes = 5, kMaxHangsOfStream = 3, kMaxHangs = 10;
/// Failure of code that wrote to the pipe of the worker that runs it.
constexpr const char* kBrokeChannel = "broke-the-channel";

/// The case in hand; of a unit that is done, its last.
struct Place {
  std::size_t stream = 0;
  std::int64_t number = 0;
};
Place place_of(const Job& job, const Progress& progress, const std::vector<Stream>& streams) {
  if (job.kind == Job::Kind::kKeep) return {static_cast<std::size_t>(job.stream), job.number};
  const auto last = static_cast<std::int32_t>(streams.size()) - 1;
  const auto stream = static_cast<std::size_t>(std::clamp(progress.stream, 0, last));
  const std::int64_t per_unit = streams[stream].per_unit;
  const std::int64_t within = progress.stream > last ? per_unit - 1 : progress.number;
  return {stream, job.number * per_unit + within};
}

/// Whether a worker with this job says so: the code under test can write to its pipe as well.
bool is_sound(const Event& event, const Job& job, const Progress& progress, const std::vector<Stream>& streams) {
  const bool is_unit = job.kind == Job::Kind::kUnit;
  const auto count = static_cast<std::int32_t>(streams.size());
  if (event.kind == Event::Kind::kDone) {
    return event.seconds >= 0 && (!is_unit || progress.stream == count || progress.is_stopping);
  }
  if (event.kind != Event::Kind::kFailure || !is_unit || event.stream < 0 || event.stream >= count) return false;
  const std::int64_t per_unit = streams[static_cast<std::size_t>(event.stream)].per_unit;
  return event.number / per_unit == job.number && event.failure[0] != '\0';
}

/// A library that was built anew has the name of the one before: what both of them did would be one campaign.
void require_same_plugin(const Ledger& known, const Ledger& now, const std::string& file) {
  if (known.target != now.target || known.plugin_crc32 == now.plugin_crc32) return;
  const auto words = [](const std::optional<std::uint32_t>& crc32) {
    return crc32 ? "CRC-32 " + std::to_string(*crc32) : std::string("no CRC-32");
  };
  throw io::Error(io::ErrorKind::kBadInput,
                  file + ": is of another library with the name '" + now.target + "': there it has " +
                      words(known.plugin_crc32) + ", now " + words(now.plugin_crc32) +
                      "; it may have been rebuilt: name another folder, or go on with the library of then");
}

}  // namespace

struct Driver::WorkerSlot {
  explicit WorkerSlot(const WorkerSetting& setting) : worker(std::in_place, setting) {}
  /// Always there: an optional because emplace() puts another in its place, and a worker is neither moved nor assigned.
  std::optional<WorkerProcess> worker;
  std::vector<Event> failures;
};

struct Driver::PropertyProgress {
  double seconds = 0;       ///< spent, those in hand estimated
  double unit_seconds = 0;  ///< of the last unit
  std::set<std::int64_t> in_hand;
  std::int64_t next = 0;  ///< lowest unit of the shard that may be open
  std::vector<bool> is_skipped;
  std::vector<int> crashes, hangs;  ///< a stream
  std::set<std::pair<std::string, std::string>> being_kept;
  std::set<std::pair<std::string, std::string>> lost;  ///< findings that a worker died of before it had kept them
};

Driver::Driver(Properties& properties, DriverOptions options)
    : properties_(properties),
      options_(std::move(options)),
      ledger_(make_ledger(properties)),
      setting_{properties, options_.seed, std::filesystem::absolute(options_.folder)} {
  ledger_.version = options_.version;
  ledger_.target = options_.target;
  ledger_.plugin_crc32 = options_.plugin_crc32;
  ledger_.seed = options_.seed;
  ledger_.cases = options_.cases;
  ledger_.shard = options_.shard;
  ledger_.shards = options_.shards;
  const std::filesystem::path file = options_.folder / kLedgerFile;
  if (std::filesystem::exists(file)) {
    if (!options_.resume) {
      throw io::Error(
          io::ErrorKind::kFile,
          file.string() + ": there is a campaign already; continue it with --resume or name another folder");
    }
    Ledger known = parse_ledger(io::read_file(file), file.string());
    require_same_plugin(known, ledger_, file.string());
    known.cases = ledger_.cases;  // more may be asked for than the last time
    Ledger blank = known;
    for (PropertyLedger& property : blank.properties) {
      property.units = {};
      property.open.clear();
      property.findings.clear();
      for (Counts& row : property.rows) row = {};
      for (Accuracy& row : property.accuracy) row = {};
    }
    if (blank != ledger_) {
      throw io::Error(io::ErrorKind::kBadInput,
                      file.string() + ": is of another campaign: seed, shard, properties, target or version differ");
    }
    ledger_ = std::move(known);
  }
  for (const auto& property : properties_) {
    PropertyProgress state;
    state.next = options_.shard - 1;
    state.is_skipped.resize(property->streams().size());
    state.crashes.resize(property->streams().size());
    state.hangs.resize(property->streams().size());
    SELVAGE_ASSERT(property->streams().size() <= Progress::kMaxStreams);
    property_progress_.push_back(std::move(state));
  }
}

Driver::~Driver() = default;

bool Driver::run(const std::function<bool()>& stop, const std::function<void(const DriverStatus&)>& watch) {
  std::signal(SIGPIPE, SIG_IGN);  // a worker that died shows at its other pipe
  std::filesystem::create_directories(options_.folder);
  save();
  // Until the last fork: it takes one thread along and the locks of all. At its end the control lets threads start.
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  for (const auto& property : properties_) property->prepare();
  for (int i = 0; i < options_.jobs; ++i) slots_.push_back(std::make_unique<WorkerSlot>(setting_));
  const auto start = Clock::now();
  auto last_save = start;
  bool stopped = false;
  while (true) {
    status_.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    stopped = stopped || stop();
    const Pace now = pace(stopped);
    std::vector<pollfd> waits;
    std::vector<WorkerSlot*> busy;
    for (const auto& slot : slots_) {
      if (!slot->worker->job() && !assign(*slot, now)) continue;
      waits.push_back({slot->worker->events(), POLLIN, 0});
      busy.push_back(slot.get());
    }
    if (busy.empty()) break;
    if (poll(waits.data(), waits.size(), kTick_ms) < 0 && errno != EINTR) throw std::runtime_error("poll failed");
    for (std::size_t i = 0; i < busy.size(); ++i) receive_or_watch(*busy[i], now, waits[i].revents);
    watch(status_);
    if (is_dirty_ && std::chrono::duration<double>(Clock::now() - last_save).count() >= kSaveEvery_s) {
      save();
      last_save = Clock::now();
    }
  }
  save();
  slots_.clear();
  return !stopped;
}

Driver::Pace Driver::pace(bool stopped) {
  if (!stopped && !(options_.seconds && status_.seconds >= *options_.seconds)) return Pace::kFull;
  if (!stopping_since_s_) {
    stopping_since_s_ = status_.seconds;
    for (const auto& slot : slots_) slot->worker->ask_to_stop();
  }
  return status_.seconds - *stopping_since_s_ < options_.case_seconds + kGrace_s ? Pace::kStopping : Pace::kLate;
}

bool Driver::assign(WorkerSlot& slot, Pace pace) {
  const std::optional<Job> job = next_job(pace);
  if (!job) return false;
  slot.failures.clear();
  const auto p = static_cast<std::size_t>(job->property);
  if (job->kind == Job::Kind::kKeep &&
      property_progress_[p].lost.contains(
          {ledger_.properties[p].streams[static_cast<std::size_t>(job->stream)], job->failure})) {
    slot.worker.emplace(setting_);  // one in which nothing has run yet
  }
  const auto& open = ledger_.properties[p].open;
  const auto place = job->kind == Job::Kind::kUnit ? open.find(job->number) : open.end();
  slot.worker->give(*job, property_progress_[p].is_skipped, place == open.end() ? UnitPlace{} : place->second);
  return true;
}

/// `revents`: what poll() says of its events. One that has just spoken is not watched: it may wait for the next job.
void Driver::receive_or_watch(WorkerSlot& slot, Pace pace, short revents) {
  if (revents != 0) return receive(slot, (revents & POLLHUP) != 0);
  slot.worker->watch(options_.case_seconds);
  const Job& job = *slot.worker->job();  // where nothing but a case as it is remains to be written, that is waited for
  if (pace == Pace::kLate && (job.kind == Job::Kind::kUnit || job.shrunk != 0)) slot.worker->abandon();
  // Nothing is lost with a worker that still loads what it tests.
  if (pace == Pace::kStopping && job.kind == Job::Kind::kUnit && !slot.worker->has_started()) slot.worker->abandon();
}

std::optional<Job> Driver::next_job(Pace pace) {
  for (std::size_t p = 0; p < property_progress_.size(); ++p) {
    for (const auto& [key, finding] : ledger_.properties[p].findings) {
      if (!finding.file.empty() || property_progress_[p].being_kept.contains(key)) continue;
      Job job;
      job.kind = Job::Kind::kKeep;
      job.property = static_cast<std::int32_t>(p);
      const auto& streams = ledger_.properties[p].streams;
      job.stream = static_cast<std::int32_t>(std::ranges::find(streams, key.first) - streams.begin());
      job.number = finding.number;
      key.second.copy(job.failure, kFailureWord - 1);
      const bool can_shrink = !is_death(key.second) && key.second != kBrokeChannel;
      job.shrunk = can_shrink && pace != Pace::kLate ? 1 : 0;
      property_progress_[p].being_kept.insert(key);
      return job;
    }
  }
  if (pace != Pace::kFull) return std::nullopt;
  std::optional<std::size_t> chosen;
  for (std::size_t p = 0; p < property_progress_.size(); ++p) {
    PropertyProgress& state = property_progress_[p];
    while (ledger_.properties[p].units.contains(state.next) || state.in_hand.contains(state.next)) {
      state.next += options_.shards;
    }
    const auto end = unit_count(*properties_[p], options_.cases);
    if (end && state.next >= *end) continue;
    if (std::ranges::all_of(state.is_skipped, std::identity())) continue;
    const auto cost = [&](std::size_t i) { return property_progress_[i].seconds / properties_[i]->weight(); };
    if (!chosen || cost(p) < cost(*chosen)) chosen = p;
  }
  if (!chosen) return std::nullopt;
  PropertyProgress& state = property_progress_[*chosen];
  state.in_hand.insert(state.next);
  state.seconds += state.unit_seconds;
  Job job;
  job.property = static_cast<std::int32_t>(*chosen);
  job.number = state.next;
  return job;
}

void Driver::receive(WorkerSlot& slot, bool has_hung_up) {
  const std::optional<Event> event = slot.worker->receive_event();
  const Job job = *slot.worker->job();
  const std::vector<Stream>& streams = properties_[static_cast<std::size_t>(job.property)]->streams();
  if (!event && has_hung_up) {
    take_death(slot);
  } else if (!event || !is_sound(*event, job, slot.worker->progress(), streams)) {  // a part of one is none either
    take_broken_channel(slot);
  } else if (event->kind == Event::Kind::kFailure) {
    slot.failures.push_back(*event);
  } else {
    take_done(slot, *event);
  }
}

void Driver::take_done(WorkerSlot& slot, const Event& done) {
  const Job job = *slot.worker->job();
  status_.processor_seconds += done.seconds;
  const auto p = static_cast<std::size_t>(job.property);
  PropertyLedger& property = ledger_.properties[p];
  if (job.kind == Job::Kind::kKeep) {
    slot.worker->finish();
    is_dirty_ = true;
    const std::pair<std::string, std::string> key{property.streams[static_cast<std::size_t>(job.stream)], job.failure};
    property_progress_[p].being_kept.erase(key);
    take_kept(job);
    return;
  }
  property_progress_[p].seconds += done.seconds - property_progress_[p].unit_seconds;
  property_progress_[p].unit_seconds = done.seconds;
  take_unit(slot);
}

/// As far as it came: the rest is left for --resume.
void Driver::take_unit(WorkerSlot& slot) {
  const Job job = *slot.worker->job();
  slot.worker->finish();
  is_dirty_ = true;
  const auto p = static_cast<std::size_t>(job.property);
  PropertyLedger& property = ledger_.properties[p];
  const Progress& progress = slot.worker->progress();
  property_progress_[p].in_hand.erase(job.number);
  property.open.erase(job.number);
  if (progress.stream == static_cast<std::int32_t>(property.streams.size())) {
    property.units.insert(job.number);
  } else {
    property.open[job.number] = {progress.stream, progress.number};
  }
  for (std::size_t i = 0; i < property.rows.size(); ++i) {
    property.rows[i] += progress.rows[i];
    property.accuracy[i] += progress.accuracy[i];
    status_.cases += progress.rows[i].cases;
  }
  for (const Event& failure : slot.failures) {
    const auto stream = static_cast<std::size_t>(failure.stream);
    const std::pair<std::string, std::string> key{property.streams.at(stream), failure.failure};
    auto [place, is_new] = property.findings.try_emplace(key, Finding{0, failure.number, {}});
    ++place->second.count;
    if (failure.number < place->second.number) place->second = {place->second.count, failure.number, {}};
  }
}

/// The case is written. A lower one may have failed meanwhile: then that one is kept instead.
void Driver::take_kept(const Job& job) {
  const auto p = static_cast<std::size_t>(job.property);
  const Stream& stream = properties_[p]->streams()[static_cast<std::size_t>(job.stream)];
  Finding& finding = ledger_.properties[p].findings.at({stream.name, job.failure});
  if (finding.number == job.number) finding.file = kept_name(*properties_[p], stream, job.failure);
}

void Driver::fail_of_worker(const Death& death, const std::string& what_for) const {
  const std::string what = "a worker " + death.failure + " before it could " + what_for + " a case; " +
                           (setting_.folder / kWorkerLog).string() + " may say why";
  if (options_.plugin_crc32) throw io::Error(io::ErrorKind::kBadInput, ledger_.target + ": " + what);
  throw std::runtime_error(what);
}

void Driver::take_death(WorkerSlot& slot) {
  const Death death = slot.worker->reap();
  SELVAGE_ASSERT(slot.worker->job().has_value());
  const Job job = *slot.worker->job();
  if (job.kind == Job::Kind::kKeep) return take_death_of_keeping(slot, job, death);
  if (death.is_abandoned) {
    take_unit(slot);
    return slot.worker->restart();
  }
  if (death.at_start) fail_of_worker(death, "run");
  const auto p = static_cast<std::size_t>(job.property);
  PropertyProgress& state = property_progress_[p];
  Progress& progress = slot.worker->progress();
  const auto [stream, number] = place_of(job, progress, properties_[p]->streams());
  Event failure;
  failure.kind = Event::Kind::kFailure;
  failure.stream = static_cast<std::int32_t>(stream);
  failure.number = number;
  death.failure.copy(failure.failure, kFailureWord - 1);
  slot.failures.push_back(failure);
  progress.rows[stream] += {1, 1, {}, 0};
  ++progress.number;
  if (death.failure == kHung) {
    if (++state.hangs[stream] >= kMaxHangsOfStream) state.is_skipped[stream] = true;
    const int hangs = std::accumulate(state.hangs.begin(), state.hangs.end(), 0);
    if (hangs >= kMaxHangs) state.is_skipped.assign(state.is_skipped.size(), true);
  } else if (++state.crashes[stream] >= kMaxCrashes) {
    state.is_skipped[stream] = true;
  }
  for (std::size_t i = 0; i < state.is_skipped.size(); ++i) progress.is_skipped[i] = state.is_skipped[i];
  slot.worker->restart();
}

/// Shrinking ran into a case that kills, or has no time left: what was written first stays. Before that, what is tested
/// has spoilt its worker: another keeps the case.
void Driver::take_death_of_keeping(WorkerSlot& slot, const Job& job, const Death& death) {
  const auto p = static_cast<std::size_t>(job.property);
  const Stream& stream = properties_[p]->streams()[static_cast<std::size_t>(job.stream)];
  const std::pair<std::string, std::string> key{stream.name, job.failure};
  property_progress_[p].being_kept.erase(key);
  if (slot.worker->progress().has_kept) {
    take_kept(job);
    is_dirty_ = true;
  } else if (!death.is_abandoned && !property_progress_[p].lost.insert(key).second) {
    fail_of_worker(death, "keep");
  }
  slot.worker->restart();
}

/// Nothing that comes out of the pipe is believed any more: the unit in hand is not done, and nothing more of the
/// property is run.
void Driver::take_broken_channel(WorkerSlot& slot) {
  const Job job = *slot.worker->job();
  const auto p = static_cast<std::size_t>(job.property);
  PropertyLedger& property = ledger_.properties[p];
  PropertyProgress& state = property_progress_[p];
  const auto [stream, number] = place_of(job, slot.worker->progress(), properties_[p]->streams());
  if (job.kind == Job::Kind::kKeep) {  // as above: what was written first, if anything was, stays
    if (slot.worker->progress().has_kept) take_kept(job);
    state.being_kept.erase({property.streams[stream], job.failure});
  }
  auto [place, is_new] =
      property.findings.try_emplace({property.streams[stream], kBrokeChannel}, Finding{0, number, {}});
  ++place->second.count;
  state.is_skipped.assign(state.is_skipped.size(), true);
  is_dirty_ = true;
  slot.worker.emplace(setting_);
}

void Driver::save() {
  io::write_atomically(options_.folder / kLedgerFile, to_json(ledger_));
  append_stats();
  is_dirty_ = false;
}

void Driver::append_stats() const {
  const io::PosixFile file(options_.folder / kStatsFile, O_WRONLY | O_CREAT | O_APPEND);
  file.write(stats_line(ledger_, status_));
}

}  // namespace selvage::fuzz
