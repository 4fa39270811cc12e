#include "cli/process/fp_state.h"

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/process/exit_code.h"
#include "cli/process/terminal.h"
#include "kernel/fp_env.h"

namespace selvage::cli {

std::vector<std::string> describe_fp_defects(unsigned defects) {
  constexpr std::pair<unsigned, const char*> kWords[] = {
      {kFpRounding, "numbers are not rounded to nearest"},
      {kFpFlush, "subnormal results are flushed to zero"},
      {kFpDenormals, "subnormal operands are taken as zero"},
      {kFpContracted, "a * b + c is rounded once"},
      {kFpNan, "comparisons with NaN are wrong"},
      {kFpInfinity, "comparisons with infinity are wrong"},
      {kFpExcess, "sums are regrouped or kept in excess precision"},
  };
  std::vector<std::string> words;
  for (const auto& [defect, word] : kWords) {
    if ((defects & defect) != 0) words.emplace_back(word);
  }
  return words;
}

void require_sound_fp(unsigned as_found) {
  if (const unsigned remaining = fp_env_defects(); remaining != 0) {
    throw FpEnvironmentError(fmt::format(
        "this process cannot compute as the proofs assume: {}; run selvage doctor, and rebuild without -ffast-math",
        fmt::join(describe_fp_defects(remaining), ", ")));
  }
  if (as_found != 0) {
    say("selvage: started where {}: repaired (a library linked with -ffast-math does this)\n",
        fmt::join(describe_fp_defects(as_found), ", "));
  }
}

}  // namespace selvage::cli
