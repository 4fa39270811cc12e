#include "fuzz/run/worker.h"

#include <csignal>
#include <cstring>
#include <ctime>
#include <exception>

#include <fcntl.h>
#include <oneapi/tbb/global_control.h>
#include <unistd.h>

#include "fuzz/base/deaths.h"
#include "fuzz/run/guarded_run.h"
#include "fuzz/run/wire.h"
#include "io/error.h"
#include "io/file/atomic_file.h"

namespace selvage::fuzz {
namespace {

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Outcome outcome_of(Property& property, const Stream& stream, std::uint64_t seed) {
  try {
    return property.run(stream, ChoiceSource::from_seed(seed));
  } catch (...) {  // a plugin may throw anything, which must not unwind what the fork copied
    return {{1, 1, {}, 0}, kThrew};
  }
}

/// For all that a property makes before its first case, the recorded scene too, which takes seconds under sanitizers.
constexpr double kPrepareSeconds = 20;

class Worker {
 public:
  Worker(const WorkerSetting& setting, Progress& progress, int events)
      : setting_(setting), progress_(progress), events_(events) {}

  void run(const Job& job) {
    const double start = processor_seconds();
    Property& property = *setting_.properties[static_cast<std::size_t>(job.property)];
    if (job.kind == Job::Kind::kUnit) {
      run_unit(property, job.number);
    } else {
      keep(property, job);
    }
    Event done;
    done.seconds = processor_seconds() - start;
    send(events_, done);
  }

 private:
  void run_unit(Property& property, std::int64_t unit) {
    const std::vector<Stream>& streams = property.streams();
    for (; progress_.stream < static_cast<std::int32_t>(streams.size()); ++progress_.stream, progress_.number = 0) {
      const auto place = static_cast<std::size_t>(progress_.stream);
      const Stream& stream = streams[place];
      for (; progress_.number < stream.per_unit && !progress_.is_skipped[place]; ++progress_.number) {
        if (progress_.is_stopping) return;
        progress_.beat.fetch_add(1, std::memory_order_relaxed);
        const std::int64_t number = unit * stream.per_unit + progress_.number;
        const Outcome outcome = outcome_of(property, stream, case_seed(setting_.seed, stream, number));
        progress_.rows[place] += outcome.counts;
        progress_.accuracy[place].add(outcome.accuracy);
        if (!outcome.failure.empty()) report(progress_.stream, number, outcome.failure);
      }
    }
  }

  void report(std::int32_t stream, std::int64_t number, const std::string& failure) const {
    Event event;
    event.kind = Event::Kind::kFailure;
    event.stream = stream;
    event.number = number;
    failure.copy(event.failure, kFailureWord - 1);
    send(events_, event);
  }

  /// First as it is, then simpler: what cannot be shrunk is kept all the same.
  void keep(Property& property, const Job& job) const {
    const Stream& stream = property.streams()[static_cast<std::size_t>(job.stream)];
    const std::string failure = job.failure;
    const std::filesystem::path file = setting_.folder / kept_name(property, stream, failure);
    const std::string origin = case_origin(property, stream, setting_.seed, job.number);
    const ChoiceSource source = ChoiceSource::from_seed(case_seed(setting_.seed, stream, job.number));
    std::filesystem::create_directories(setting_.folder);
    io::write_atomically(file, property.kept(stream, source, origin, failure, false));
    progress_.has_kept = true;
    if (job.shrunk != 0) io::write_atomically(file, property.kept(stream, source, origin, failure, true));
  }

  const WorkerSetting& setting_;
  Progress& progress_;
  int events_;
};

}  // namespace

std::string kept_name(const Property& property, const Stream& stream, const std::string& failure) {
  std::string name = property.name() + "-" + stream.name + "-" + failure;
  for (char& letter : name) letter = letter == ' ' || letter == '/' ? '-' : letter;
  return name + ".case";
}

std::string case_origin(const Property& property, const Stream& stream, std::uint64_t seed, std::int64_t number) {
  return property.name() + ":" + stream_word(stream.name) + ":" + std::to_string(seed) + ":" + std::to_string(number);
}

void work(const WorkerSetting& setting, Progress& progress, int jobs, int events) {
  become_test_process();
  // The driver decides when to stop: a signal to the whole group, as `timeout` sends it, is no crash of what is tested.
  for (const int stop : {SIGINT, SIGTERM, SIGHUP}) std::signal(stop, SIG_IGN);
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  int code = 0;
  try {
    // What the code under test prints is neither result nor progress.
    const io::PosixFile log(setting.folder / kWorkerLog, O_WRONLY | O_CREAT | O_APPEND);
    dup2(log.descriptor(), 1);
    dup2(log.descriptor(), 2);
    for (const auto& property : setting.properties) {
      property->on_beat([&progress] { progress.beat.fetch_add(1, std::memory_order_relaxed); });
      property->start();
    }
    progress.has_started = true;
    Worker worker(setting, progress, events);
    Job job;
    while (receive(jobs, job)) worker.run(job);
  } catch (const std::exception& error) {
    const std::string line = std::string("selvage fuzz: a worker ended: ") + error.what() + "\n";
    const ssize_t ignored = write(2, line.data(), line.size());
    static_cast<void>(ignored);  // there is nobody left to tell
    code = 1;
  } catch (...) {
    code = 1;
  }
  _exit(code);
}

OneCase run_case(Property& property, const Stream& stream, std::uint64_t seed, std::int64_t number, double seconds) {
  struct Plain {
    Counts counts;
    char failure[kFailureWord] = {};
  };
  const auto work = [&] {
    const Outcome outcome = outcome_of(property, stream, case_seed(seed, stream, number));
    Plain plain{outcome.counts, {}};
    outcome.failure.copy(plain.failure, kFailureWord - 1);
    return plain;
  };
  const auto prepare = [&] {
    property.prepare();
    property.start();
  };
  const Guarded<Plain> run = run_guarded<Plain>({prepare, kPrepareSeconds}, work, seconds);
  if (run.death.empty()) return {{run.result.counts, run.result.failure}, false};
  if (!run.has_prepared) {
    throw io::Error(io::ErrorKind::kBadInput, property.name() + ": " + run.death + " before it could run a case");
  }
  return {{{1, 1, {}, 0}, run.death}, true};
}

}  // namespace selvage::fuzz
