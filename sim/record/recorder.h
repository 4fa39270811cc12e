// Records a run: the sequence, the checkpoint and run.json in one folder, each replaced atomically.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "io/sequence.h"
#include "sim/record/checkpoint.h"

namespace selvage::sim {

/// Beside the sequence: what a run goes on from, and how it went.
inline constexpr std::string_view kCheckpointFile = "checkpoint.bin";
inline constexpr std::string_view kRunFile = "run.json";

/// How a run ended, in run.json. kFailed: an error, of a file or of the scene's numbers, in the middle of it.
enum class RunEnd { kComplete, kInterrupted, kStopped, kFailed };
struct RunOutcome {
  RunEnd end = RunEnd::kComplete;
  int exit_code = 0;       ///< of the program
  std::string error = {};  ///< kFailed: what was said of it
};

class Recorder {
 public:
  /// kSteps records the end of every collision step, kFrames the frames alone; both begin with the initial state. None:
  /// as the folder's run was started where that goes on, else kFrames.
  /// Throws io::Error if the folder holds a sequence already and `resume` is not set. With `resume` the simulation is
  /// put back to the folder's checkpoint and the sequence is cut to it; a folder without one starts from the beginning.
  /// What is refused leaves the folder as it was.
  /// `producer` is the program and its version, for the files. `repair` is what was done to the start, for run.json; a
  /// run that is resumed knows what was done to its own.
  Recorder(std::filesystem::path folder, Simulation& simulation, std::optional<io::SequenceKind> kind, bool resume,
           std::string producer, const StartRepair& repair = {});

  /// Once, before the first step: from here on run.json is gone until finish() writes it. Writes the initial state,
  /// unless the run is resumed.
  void begin();
  /// After every safe step. Writes the checkpoint at frames.
  void record(const StepResult& step);
  /// Writes the checkpoint where the run is now, unless it failed: then the sequence may lack what was simulated, and
  /// the checkpoint before is the one to go on from. Writes run.json.
  void finish(const RunOutcome& outcome);
  [[nodiscard]] const RunTotals& totals() const { return totals_; }
  [[nodiscard]] const BodyWaits& waits() const { return waits_; }
  [[nodiscard]] bool resumed() const { return resumed_; }

 private:
  [[nodiscard]] io::SequenceWriter open_writer(bool resume) const;
  /// Nothing where there is none. Throws where it is of another scene.
  [[nodiscard]] std::optional<Checkpoint> read_own_checkpoint() const;
  void append();
  void save_checkpoint();

  std::filesystem::path folder_;
  std::string producer_;
  Simulation& simulation_;
  io::SequenceKind kind_;
  SceneIdentity scene_;
  io::SequenceWriter writer_;
  RunTotals totals_;
  BodyWaits waits_;
  bool resumed_ = false;
};

}  // namespace selvage::sim
