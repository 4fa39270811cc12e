// The program: one line per subcommand. What each does is in NAME_command.cpp.
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include "cli/bench_command.h"
#include "cli/command.h"
#include "cli/convert_command.h"
#include "cli/doctor_command.h"
#include "cli/fuzz_command.h"
#include "cli/merge_command.h"
#include "cli/process/exit_code.h"
#include "cli/process/fp_state.h"
#include "cli/process/interrupt.h"
#include "cli/process/memory_limit.h"
#include "cli/process/version.h"
#include "cli/render_command.h"
#include "cli/replay_command.h"
#include "cli/sim_command.h"
#include "cli/subdivide_command.h"
#include "cli/verify_command.h"
#include "cli/view_command.h"
#include "io/file/text.h"
#include "kernel/fp_env.h"

int main(int argc, char** argv) {
  using namespace selvage::cli;
  // Before anything is computed: a library linked with -ffast-math has changed the environment before main.
  const unsigned fp_as_found = selvage::fp_env_defects();
  const selvage::FpEnvGuard fp_guard;
  CLI::App program{"Cloth collisions that never let a surface pass through itself, and the instruments that prove it.",
                   "selvage"};
  show_example_first(program, "selvage --version");
  program.set_version_flag("--version", version_text, "Version of the program and of the libraries in it");
  program.failure_message([](const CLI::App*, const CLI::Error& error) {
    return "selvage: " + selvage::io::printable(error.what()) + "; --help says more\n";
  });
  program.require_subcommand(0, 1);  // one is required, but an unknown name shall be named: see below

  Job job;
  add_bench_command(program, job);
  add_convert_command(program, job);
  add_doctor_command(program, job, fp_as_found);
  add_fuzz_command(program, job);
  add_merge_command(program, job);
  add_render_command(program, job);
  add_replay_command(program, job);
  add_sim_command(program, job);
  add_subdivide_command(program, job);
  add_verify_command(program, job);
  add_view_command(program, job);

  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool is_extra = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
    if (!is_extra || !program.get_subcommands().empty()) {
      // CLI11 numbers its errors from 100 up; --help and --version arrive here with 0.
      const ExitCode code = program.exit(error) == 0 ? ExitCode::kClean : ExitCode::kUsage;
      return static_cast<int>(run_guarded([code] { return code; }));
    }
    job = [name = std::string(argv[1])]() -> ExitCode {
      throw UsageError("no subcommand '" + name + "'; run with --help for the list");
    };
  }
  for (int i = 1; i < argc; ++i) {
    if (*argv[i] != '\0') continue;
    job = [i]() -> ExitCode {  // --json "$UNSET" would not be asked for
      throw UsageError("argument " + std::to_string(i) + " is empty, as a variable without a value is; write it out");
    };
  }
  if (!job) {
    job = []() -> ExitCode { throw UsageError("a subcommand is required; run with --help for more information"); };
  }
  if (!program.got_subcommand("doctor")) {  // which reports instead
    job = [fp_as_found, chosen = std::move(job)] {
      require_sound_fp(fp_as_found);
      return chosen();
    };
  }
  make_size_limits_errors();
  make_lack_of_memory_an_error();
  return static_cast<int>(run_guarded(job));
}
