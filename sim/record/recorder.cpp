#include "sim/record/recorder.h"

#include <cmath>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/file/text.h"
#include "io/sequence/sequence_json.h"
#include "sim/base/points.h"

namespace selvage::sim {
namespace {

io::SequenceHeader header_of(const Simulation& simulation, io::SequenceKind kind, const std::string& producer) {
  const bool float32 = simulation.scene().collision.precision == CollisionOptions::Precision::kFloat32;
  io::SequenceHeader header;
  header.triangles = simulation.world().triangles;
  header.groups = simulation.world().groups;
  header.kind = kind;
  header.precision = float32 ? io::Precision::kFloat32 : io::Precision::kFloat64;
  header.producer = producer;
  return header;
}

const char* name_of(RunEnd end) {
  switch (end) {
    case RunEnd::kComplete:
      return "complete";
    case RunEnd::kInterrupted:
      return "interrupted";
    case RunEnd::kStopped:
      return "stopped";
    case RunEnd::kFailed:
      return "failed";
  }
  return "";
}

/// Of a folder that holds no sequence, all but what a run leaves that is killed before it has written the header: files
/// of somebody else, among which a sequence would be scattered, or frames would be replaced.
std::filesystem::path require_own(std::filesystem::path folder) {
  std::error_code status;
  if (!std::filesystem::is_directory(folder, status) || std::filesystem::exists(folder / io::kHeaderFile, status)) {
    return folder;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (file == io::kFacesFile || file == io::kFramesFile || io::is_temporary_name(file)) continue;
    throw io::Error(io::ErrorKind::kFile, fmt::format("{}: holds files that are no sequence ({}); name an empty folder "
                                                      "or a new one",
                                                      folder.string(), file));
  }
  return folder;
}

/// kFrames where there is no sequence.
io::SequenceKind recorded_kind(const std::filesystem::path& folder) {
  const std::filesystem::path header = folder / io::kHeaderFile;
  if (!std::filesystem::exists(header)) return io::SequenceKind::kFrames;
  return io::parse_sequence_json(io::read_file(header), header.string()).kind;
}

// What a killed run left of the two files that are written here; the sequence's writer, which holds the lock, removes
// its own. And what an earlier run said of its end, which this one would make untrue.
void remove_leftovers(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::remove(folder / kRunFile, failed);
  if (failed) io::file_error((folder / kRunFile).string(), "remove", failed.value());
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    const bool is_ours =
        file.starts_with(std::string(kCheckpointFile) + ".") || file.starts_with(std::string(kRunFile) + ".");
    std::error_code status;  // what cannot be removed is in nobody's way
    if (is_ours && io::is_temporary_name(file)) std::filesystem::remove(entry.path(), status);
  }
}

/// JSON has no word for what is not finite.
template <class Number>
std::string json_number(Number number) {
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(number)) return "null";
  }
  return fmt::format("{}", number);
}

/// Null where there is none.
std::string json_text(const std::string& words) {
  if (words.empty()) return "null";
  std::string text = "\"";
  for (const char c : io::printable(words)) text += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  return text + "\"";
}

std::string json_list(const BodyWaits& waits, const World& world) {
  std::string text;
  for (const BodyWait& wait : waits) {
    const std::string name = json_text(world.colliders[static_cast<std::size_t>(wait.collider)].name());
    text += fmt::format(
        "{}\n    {{\"name\": {}, \"steps\": {}, \"begin_s\": {}, \"end_s\": {}, \"largest_lag_m\": {}}}",
        text.empty() ? "" : ",", name, wait.steps, wait.begin_s, wait.end_s, json_number(wait.largest_lag_m));
  }
  return text.empty() ? "[]" : "[" + text + "\n  ]";
}

}  // namespace

Recorder::Recorder(std::filesystem::path folder, Simulation& simulation, std::optional<io::SequenceKind> kind,
                   bool resume, std::string producer, const StartRepair& repair)
    : folder_(require_own(std::move(folder))),
      producer_(std::move(producer)),
      simulation_(simulation),
      kind_(kind.value_or(resume ? recorded_kind(folder_) : io::SequenceKind::kFrames)),
      scene_(identify(simulation.scene(), simulation.world())),
      writer_(open_writer(resume)) {
  const std::optional<Checkpoint> checkpoint = resume ? read_own_checkpoint() : std::nullopt;
  if (!checkpoint) {
    if (writer_.frame_count() > 1) {
      throw io::Error(io::ErrorKind::kBadInput, folder_.string() +
                                                    ": holds frames but no checkpoint.bin to go on from; start the run "
                                                    "again in another folder, or remove this one first");
    }
    writer_.truncate(0);  // killed between the first frame and the first checkpoint
    totals_.repair = repair;
    return;
  }
  writer_.truncate(static_cast<std::size_t>(checkpoint->recorded));
  simulation_.restore(checkpoint->state);
  totals_ = checkpoint->totals;
  waits_ = checkpoint->waits;
  resumed_ = true;
}

// A scene that has changed may make another mesh: which setting it was says more than that the faces are others.
io::SequenceWriter Recorder::open_writer(bool resume) const try {
  return io::SequenceWriter(folder_, header_of(simulation_, kind_, producer_), resume);
} catch (const io::Error& error) {
  if (resume && error.kind() == io::ErrorKind::kBadInput) (void)read_own_checkpoint();
  throw;
}

std::optional<Checkpoint> Recorder::read_own_checkpoint() const {
  const std::filesystem::path file = folder_ / kCheckpointFile;
  std::optional<Checkpoint> checkpoint = read_checkpoint(file);
  if (!checkpoint) return checkpoint;
  if (const auto difference = first_difference(checkpoint->scene, scene_, simulation_.world())) {
    throw io::Error(
        io::ErrorKind::kBadInput,
        fmt::format("{}: the checkpoint belongs to another scene: {}; resume with the scene that wrote it (--frames "
                    "makes a run longer), or start again in another folder",
                    file.string(), *difference));
  }
  std::int64_t last = -1;
  for (const BodyWait& wait : checkpoint->waits) {
    if (wait.collider > std::exchange(last, wait.collider) &&
        wait.collider < std::ssize(simulation_.world().colliders)) {
      continue;
    }
    throw io::Error(io::ErrorKind::kBadInput, file.string() +
                                                  ": the checkpoint is damaged; start the run again in "
                                                  "another folder, or remove this one first");
  }
  return checkpoint;
}

void Recorder::begin() {
  remove_leftovers(folder_);
  if (resumed_) return;
  append();
  save_checkpoint();
}

void Recorder::record(const StepResult& step) {
  const PhaseTimer timer(totals_.recording);
  totals_.add(step);
  add_waits(simulation_, step, waits_);
  const bool at_frame = simulation_.clock().at_frame();
  if (at_frame || kind_ == io::SequenceKind::kSteps) append();
  if (at_frame) ++totals_.frames;
  if (at_frame) save_checkpoint();
}

void Recorder::finish(const RunOutcome& outcome) {
  if (outcome.end != RunEnd::kFailed) save_checkpoint();
  std::string json = fmt::format("{{\n  \"schema\": \"selvage.run/1\",\n  \"producer\": {},\n  \"end\": \"{}\",\n",
                                 json_text(producer_), name_of(outcome.end));
  json += fmt::format("  \"exit_code\": {},\n  \"error\": {},\n", outcome.exit_code, json_text(outcome.error));
  json += fmt::format("  \"time_s\": {},\n", simulation_.clock().time_s());
  for_each_total(totals_, [&](const char* name, const auto& field) {
    json += fmt::format("  \"{}\": {},\n", name, json_number(field));
  });
  json += fmt::format("  \"waits\": {},\n", json_list(waits_, simulation_.world()));
  json += fmt::format("  \"scene_fingerprint\": \"{:016x}\"\n}}\n", fingerprint_of(scene_));
  io::write_atomically(folder_ / kRunFile, json);
}

void Recorder::append() { writer_.append(simulation_.clock().time_s(), points_of(simulation_.x())); }

void Recorder::save_checkpoint() {
  write_checkpoint(folder_ / kCheckpointFile,
                   {scene_, static_cast<std::int64_t>(writer_.frame_count()), simulation_.state(), totals_, waits_});
}

}  // namespace selvage::sim
