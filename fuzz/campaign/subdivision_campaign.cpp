#include "fuzz/campaign/subdivision_campaign.h"

#include <cmath>

#include "fuzz/campaign/mesh_property.h"
#include "fuzz/campaign/surface_streams.h"
#include "fuzz/kept/subdivision_case.h"
#include "fuzz/oracle/step_oracle.h"

namespace selvage::fuzz {
namespace {

constexpr const char* kTents = "tents";

struct Surface {
  io::Triangles faces;
  Positions x;
  std::vector<double> is_scripted;
};

/// Two tents, or valleys, one over the other: smoothing moves the ridge of the coarser one more, through the other.
Surface tents(ChoiceSource& source) {
  const int steepness = source.range(-3, 3);
  const double slope = std::ldexp(source.coin() ? 1.0 : -1.0, steepness);
  const double gap = std::ldexp(1.0, -source.range(0, 20));
  Surface surface;
  std::vector<Vec3> points;
  for (int layer = 0; layer < 2; ++layer) {
    const auto first = static_cast<std::int32_t>(points.size());
    const int columns = 2 * source.range(1, 4), rows = source.range(1, 4);
    for (int row = 0; row <= rows; ++row) {
      for (int column = 0; column <= columns; ++column) {
        const double x = 2.0 * column / columns - 1;
        points.emplace_back(x, 2.0 * row / rows, slope * std::abs(x) + layer * gap);
      }
    }
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const std::int32_t corner = first + row * (columns + 1) + column, above = corner + columns + 1;
        surface.faces.push_back({corner, corner + 1, above + 1});
        surface.faces.push_back({corner, above + 1, above});
      }
    }
  }
  surface.x.resize(std::ssize(points), 3);
  for (Eigen::Index i = 0; i < surface.x.rows(); ++i) surface.x.row(i) = points[static_cast<std::size_t>(i)];
  surface.is_scripted.assign(points.size(), 0);
  return surface;
}

class SubdivisionCampaign final : public MeshProperty {
 public:
  SubdivisionCampaign() : MeshProperty("subdivision", std::string(subdivision_kind().promise)) {
    streams_ = surface_streams(1);
    streams_.push_back({kTents, 0, 8});
    counters_ = {"levels", "stopped", "rounded"};
  }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    const SubdivisionTrial trial = try_subdivision(drawn(stream, source));
    Outcome outcome{{1, trial.retrial.failure.empty() ? 0 : 1, {}, 0}, trial.retrial.failure};
    outcome.counts.of[kLevels] = trial.levels;
    outcome.counts.of[kStopped] = trial.stopped;
    outcome.counts.of[kRounded] = trial.is_rounded;
    return outcome;
  }

  [[nodiscard]] std::string complaint(const Stream& stream, const Counts& counts) const override {
    if (counts.cases <= 100) return "";
    if (counts.of[kLevels] * 2 < counts.cases) return "rounding spoils most of the surfaces";
    // Measured: a fifth of the levels.
    return stream.name == kTents && counts.of[kStopped] * 20 < counts.of[kLevels] ? "hardly anything has to stop" : "";
  }

 private:
  // Places in Counts::of, in the order of counters_.
  enum Counter : std::uint8_t { kLevels, kStopped, kRounded };

  [[nodiscard]] MeshCase drawn(const Stream& stream, ChoiceSource source) const override {
    const Surface surface = first_surface(stream, source);
    return subdivision_case(surface.faces, surface.x, surface.is_scripted, source.range(1, 2));
  }

  /// Up to two steps with hostile candidates leave the surface crumpled and in contact: as they were made, surfaces
  /// are so even that smoothing hardly moves them.
  static Surface first_surface(const Stream& stream, ChoiceSource& source) {
    if (stream.name == kTents) return tents(source);
    const StepWorld world = make_step_world(source, surface_class(stream.name));
    Positions x = world.x;
    for (int steps = source.range(0, 2); steps > 0; --steps) {
      std::string_view candidate_class;
      const Positions candidate = choose_candidate(source, world, x, candidate_class);
      const sim::CollisionStepResult result = selvage_step(world, x, candidate);
      if (result.report.status != sim::StepStatus::kInvalidInput) x = result.x;
    }
    Surface surface{world.mesh.faces, x, {}};
    for (const double mass : world.inverse_mass) surface.is_scripted.push_back(mass == 0 ? 1 : 0);
    return surface;
  }
};

}  // namespace

std::unique_ptr<Property> make_subdivision_campaign() { return std::make_unique<SubdivisionCampaign>(); }

}  // namespace selvage::fuzz
