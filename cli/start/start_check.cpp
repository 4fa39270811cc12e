#include "cli/start/start_check.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "cli/answer/part_name.h"
#include "cli/process/interrupt.h"
#include "cli/process/terminal.h"
#include "cli/start/start_remedy.h"
#include "io/error.h"
#include "sim/base/points.h"
#include "sim/repair/start_repair.h"
#include "verify/check.h"
#include "verify/first_violations.h"

namespace selvage::cli {
namespace {

constexpr std::size_t kNamedPairs = 10;  // the rest is counted
/// That are looked for in a start, and kept of what a repair makes of it. Copies at one place, and a mesh whose
/// vertices are in another order, have many times as many: 300 sheets of 162 faces at one place take 1.6 s of the
/// processor and 214 MiB with this; 100 were not through after 24 s where all pairs were examined, and 6,962 faces at
/// random took more than 4.4 GB where their 5 million pairs were kept.
constexpr std::size_t kMaxPairs = 200'000;

/// Exact, of one state; pairs of bodies are left out. Both end with verify::Stopped at a signal.
class Judge {
 public:
  explicit Judge(const sim::World& world)
      : topology_(verify::make_topology({world.triangles, io::body_faces(world.triangles.size(), world.groups)},
                                        static_cast<std::size_t>(world.x_t0.rows()))) {
    options_.max_violations = kMaxPairs;
    options_.stop = interrupted;
  }

  /// All, or kMaxPairs where there are more, and then it looks no further.
  [[nodiscard]] std::vector<sim::FacePair> find_most(const Positions& x) const {
    return pairs_of(verify::first_violations(topology_, sim::points_of(x), kMaxPairs, options_));
  }
  /// The first kMaxPairs of all.
  [[nodiscard]] std::vector<sim::FacePair> operator()(const Positions& x) const {
    return pairs_of(verify::check_frame(topology_, sim::points_of(x), options_).violations);
  }

 private:
  static std::vector<sim::FacePair> pairs_of(const std::vector<verify::Violation>& violations) {
    std::vector<sim::FacePair> pairs;
    for (const verify::Violation& found : violations) pairs.push_back(verify::faces_of(found));
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  }

  verify::Topology topology_;
  verify::CheckOptions options_;
};

const char* at_least(const std::vector<sim::FacePair>& pairs) { return pairs.size() < kMaxPairs ? "" : "at least "; }

void print_pairs(const sim::World& world, const std::vector<sim::FacePair>& pairs) {
  for (std::size_t i = 0; i < std::min(pairs.size(), kNamedPairs); ++i) {
    const auto [f, g] = pairs[i];
    if (f == g) {
      say("  face {} of \"{}\" has no area\n", f, part_of_face(world, f));
    } else {
      say("  face {} of \"{}\" and face {} of \"{}\" intersect\n", f, part_of_face(world, f), g,
          part_of_face(world, g));
    }
  }
  if (pairs.size() > kNamedPairs) say("  and {}{} pairs more\n", at_least(pairs), pairs.size() - kNamedPairs);
}

/// Strain has no meaning there, whatever a repair does to the corners.
bool has_edge_without_length(const sim::World& world) {
  return std::ranges::any_of(world.springs.springs(), [](const sim::Spring& spring) {
    return spring.kind == sim::SpringKind::kStructural && !(spring.rest_length_m > 0);
  });
}

/// `named` are those of the pairs that the user must part.
[[noreturn]] void refuse(const sim::Simulation& simulation, const std::vector<sim::FacePair>& pairs,
                         const std::vector<sim::FacePair>& named, const std::string& what_to_do) {
  const sim::World& world = simulation.world();
  print_pairs(world, named);
  const auto [f, g] = named.front();
  const std::string first = part_of_face(world, f), second = part_of_face(world, g);
  throw io::Error(io::ErrorKind::kBadInput,
                  fmt::format("{}: the start has {}{} intersecting pairs, the first of \"{}\"{}; {}",
                              simulation.scene().file.string(), at_least(pairs), pairs.size(), first,
                              first == second ? " with itself" : fmt::format(" and \"{}\"", second), what_to_do));
}

/// Where all are left, whatever a try made of them, it says no number.
std::string named_of(const std::vector<sim::FacePair>& some, const std::vector<sim::FacePair>& all) {
  return some.size() < all.size() ? fmt::format("{} of them", some.size()) : "them";
}

/// `first` pairs intersect; how many of them are gone is shown.
sim::RepairedStart repair_and_show(const sim::Simulation& simulation, const Judge& judge, std::size_t first) {
  ProgressBar bar("repair");
  bar.update(0, first);
  return sim::repair_start(simulation, [&](const Positions& x) {
    std::vector<sim::FacePair> left = judge(x);
    bar.update(first - std::min(first, left.size()), first);
    return left;
  });
}

}  // namespace

sim::StartRepair require_clean_start(sim::Simulation& simulation, bool repair) {
  const Judge judge(simulation.world());
  const std::vector<sim::FacePair> pairs = judge.find_most(simulation.x());
  if (pairs.empty()) return {};
  if (!repair) {
    const bool is_rounded = simulation.scene().collision.precision == sim::CollisionOptions::Precision::kFloat32;
    refuse(simulation, pairs, pairs,
           start_remedy(simulation.world(), simulation.x(), pairs, false) +
               (is_rounded ? "; coordinates are rounded to float32, so far from the origin precision = \"float64\" may "
                             "be all it needs"
                           : ""));
  }
  const sim::World& world = simulation.world();
  if (pairs.size() >= kMaxPairs) {
    refuse(simulation, pairs, pairs,
           "that is more than --repair looks at; " + start_remedy(world, simulation.x(), pairs, false));
  }
  if (has_edge_without_length(world)) {
    refuse(simulation, pairs, pairs, start_remedy(world, simulation.x(), pairs, false));
  }
  sim::RepairedStart repaired = repair_and_show(simulation, judge, pairs.size());
  if (!repaired.remaining.empty()) {
    refuse(simulation, pairs, repaired.remaining,
           fmt::format("--repair found no way out for {}; {}", named_of(repaired.remaining, pairs),
                       start_remedy(world, simulation.x(), repaired.remaining, true)));
  }
  const sim::StartRepair done{std::ssize(pairs), repaired.moved_vertices, repaired.largest_move_m,
                              repaired.largest_strain};
  const std::string note = note_on_freed(world, simulation.x(), pairs);
  sim::SimulationState state = simulation.state();
  state.x = std::move(repaired.x);
  simulation.restore(state);
  say("repair     {} intersecting pairs: {} of {} cloth vertices moved, by at most {:.3g} m, {} states judged; "
      "{} steps eased what was strained, largest strain {:.2g}\n",
      pairs.size(), done.moved_vertices, world.cloth_vertex_count, done.largest_move_m, repaired.rounds,
      repaired.relax_steps, repaired.largest_strain);
  if (!note.empty()) say("note       {}\n", note);
  if (repaired.largest_strain > sim::kTornStrain) {
    say("note       contact or pins hold cloth at {:.2g} times its length, which will fly apart; move it off what "
        "goes through it in the program that wrote it\n",
        1 + repaired.largest_strain);
  }
  return done;
}

}  // namespace selvage::cli
