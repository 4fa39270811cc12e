// What --svg draws: every row of the tables, speed against error.
#pragma once

#include <vector>

#include "bench/broad_bench.h"
#include "bench/ccd_bench.h"
#include "bench/method_bench.h"
#include "bench/query_bench.h"
#include "bench/sim_bench.h"
#include "bench/verify_bench.h"
#include "cli/plot/figure.h"

namespace selvage::cli {

/// A method a bar, its time, and beside it how often it was wrong.
[[nodiscard]] plot::Figure figure_of(const bench::QueryBenchReport& report);
[[nodiscard]] plot::Figure figure_of(const bench::CcdBenchReport& report);
/// A method a line, a setting a point: errors against time, set by set, on the same axes.
[[nodiscard]] plot::Figure figure_of(const std::vector<bench::SetReport>& reports);
/// Time for a candidate, and candidates that differ, against the size of a motion and the candidates that come on a
/// face.
[[nodiscard]] plot::Figure figure_of(const std::vector<bench::BroadMotionReport>& reports);
/// Time and memory for a face, and pairs found, against the size of the sheet.
[[nodiscard]] plot::Figure figure_of(const std::vector<bench::VerifySheetReport>& reports);
/// Error against what is refined and against time; growth; what modules add.
[[nodiscard]] plot::Figure figure_of(const bench::SimBenchReport& report);

}  // namespace selvage::cli
