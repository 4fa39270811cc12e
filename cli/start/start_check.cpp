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

namespace selvage::cli {
namespace {

constexpr std::size_t kNamedPairs = 10;  // the rest is counted
/// That are kept of one state. A mesh whose vertices are in another order has many times as many: 6,962 faces at random
/// take 313 MiB and 8 s of the processor with this, more than 4.4 GB and 71 s with all of their 5 million pairs.
constexpr std::size_t kMostPairs = 200'000;

/// Exact; pairs of bodies are left out. The first kMostPairs; ends with verify::Stopped at a signal.
sim::FindIntersections exact_judge(const sim::World& world) {
  const std::vector<std::uint8_t> is_body = io::body_faces(world.triangles.size(), world.groups);
  const auto vertex_count = static_cast<std::size_t>(world.x_t0.rows());
  return [topology = verify::make_topology({world.triangles, is_body}, vertex_count)](const Positions& x) {
    verify::CheckOptions options;
    options.max_violations = kMostPairs;
    options.stop = interrupted;
    std::vector<sim::FacePair> pairs;
    for (const verify::Violation& found : verify::check_frame(topology, sim::points_of(x), options).violations) {
      pairs.push_back(verify::faces_of(found));
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  };
}

const char* at_least(const std::vector<sim::FacePair>& pairs) { return pairs.size() < kMostPairs ? "" : "at least "; }

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

[[noreturn]] void refuse(const sim::Simulation& simulation, const std::vector<sim::FacePair>& pairs,
                         const std::string& what_to_do) {
  const sim::World& world = simulation.world();
  print_pairs(world, pairs);
  const auto [f, g] = pairs.front();
  const std::string first = part_of_face(world, f), second = part_of_face(world, g);
  throw io::Error(io::ErrorKind::kBadInput,
                  fmt::format("{}: the start has {}{} intersecting pairs, the first of \"{}\"{}; {}",
                              simulation.scene().file.string(), at_least(pairs), pairs.size(), first,
                              first == second ? " with itself" : fmt::format(" and \"{}\"", second), what_to_do));
}

}  // namespace

sim::StartRepair require_clean_start(sim::Simulation& simulation, bool repair) {
  const sim::FindIntersections judge = exact_judge(simulation.world());
  const std::vector<sim::FacePair> pairs = judge(simulation.x());
  if (pairs.empty()) return {};
  if (!repair) {
    const bool is_rounded = simulation.scene().collision.precision == sim::CollisionOptions::Precision::kFloat32;
    refuse(simulation, pairs,
           start_remedy(simulation.world(), simulation.x(), pairs, false) +
               (is_rounded ? "; coordinates are rounded to float32, so far from the origin precision = \"float64\" may "
                             "be all it needs"
                           : ""));
  }
  const sim::World& world = simulation.world();
  if (pairs.size() >= kMostPairs) {
    refuse(simulation, pairs,
           "that is more than --repair looks at; " + start_remedy(world, simulation.x(), pairs, false));
  }
  if (has_edge_without_length(world)) refuse(simulation, pairs, start_remedy(world, simulation.x(), pairs, false));
  sim::RepairedStart repaired = sim::repair_start(simulation, judge);
  if (!repaired.remaining.empty()) {
    std::vector<sim::FacePair> since_start = repaired.remaining;  // what the repair has made says nothing of a mesh
    std::erase_if(since_start, [&](const sim::FacePair& pair) { return !std::ranges::binary_search(pairs, pair); });
    refuse(simulation, repaired.remaining,
           fmt::format("--repair found no way out for them, of {} pairs before; {}", pairs.size(),
                       start_remedy(world, simulation.x(), since_start, true)));
  }
  const sim::StartRepair done{std::ssize(pairs), repaired.moved_vertices, repaired.largest_move_m,
                              repaired.largest_strain};
  sim::SimulationState state = simulation.state();
  state.x = std::move(repaired.x);
  simulation.restore(state);
  say("repair     {} intersecting pairs: {} of {} cloth vertices moved, by at most {:.3g} m, {} states judged; "
      "{} steps drew together what was stretched, largest strain {:.2g}\n",
      pairs.size(), done.moved_vertices, world.cloth_vertex_count, done.largest_move_m, repaired.rounds,
      repaired.relax_steps, repaired.largest_strain);
  if (repaired.largest_strain > sim::kTornStrain) {
    say("note       contact or pins hold cloth at {:.2g} times its length, which will fly apart; move it off what "
        "goes through it in the program that wrote it\n",
        1 + repaired.largest_strain);
  }
  return done;
}

}  // namespace selvage::cli
