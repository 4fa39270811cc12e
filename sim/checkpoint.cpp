#include "sim/checkpoint.h"

#include <bit>
#include <cstring>
#include <string>

#include "io/atomic_file.h"

namespace selvage::sim {
namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian: add byte swaps here");

constexpr std::string_view kMagic = "selvage-checkpoint 10\n";

std::uint64_t fnv1a(std::string_view bytes, std::uint64_t hash = 0xcbf29ce484222325u) {
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return hash;
}

std::string_view bytes_of(const Positions& x) {
  return {reinterpret_cast<const char*>(x.data()), static_cast<std::size_t>(x.size()) * sizeof(double)};
}

template <class Number>
void put(std::string& bytes, const Number& number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

void put(std::string& bytes, const Positions& x) {
  put(bytes, static_cast<std::int64_t>(x.rows()));
  bytes += bytes_of(x);
}

static_assert(sizeof(ContactLoad) == 2 * sizeof(std::int32_t) + 4 * sizeof(double),
              "padding would be written as it is");

void put(std::string& bytes, const std::vector<ContactLoad>& loads) {
  put(bytes, static_cast<std::int64_t>(loads.size()));
  for (const ContactLoad& load : loads) put(bytes, load);
}

// Reads what put() wrote; never past the end.
class Source {
 public:
  Source(std::string_view bytes, const std::filesystem::path& file) : bytes_(bytes), file_(file) {}

  [[noreturn]] void fail(const char* what) const {
    throw io::Error(io::ErrorKind::kBadInput,
                    file_.string() + ": " + what + "; start the run again in another folder, or remove this one first");
  }
  std::string_view take(std::size_t count) {
    if (count > bytes_.size()) fail("the checkpoint is cut short");
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }
  template <class Number>
  void get(Number& number) {
    std::memcpy(&number, take(sizeof number).data(), sizeof number);
  }
  void get(Positions& x) {
    std::int64_t rows = 0;
    get(rows);
    constexpr std::int64_t kRowBytes = 3 * sizeof(double);
    if (rows < 0 || rows > static_cast<std::int64_t>(bytes_.size()) / kRowBytes) fail("the checkpoint is damaged");
    x.resize(rows, 3);
    const std::string_view data = take(static_cast<std::size_t>(rows * kRowBytes));
    if (!data.empty()) std::memcpy(x.data(), data.data(), data.size());
  }
  void get(std::vector<ContactLoad>& loads) {
    std::int64_t count = 0;
    get(count);
    constexpr std::int64_t kLoadBytes = sizeof(ContactLoad);
    if (count < 0 || count > static_cast<std::int64_t>(bytes_.size()) / kLoadBytes) fail("the checkpoint is damaged");
    loads.resize(static_cast<std::size_t>(count));
    for (ContactLoad& load : loads) get(load);
  }
  [[nodiscard]] bool empty() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
  const std::filesystem::path& file_;
};

}  // namespace

std::uint64_t scene_fingerprint(const Scene& scene, const World& world) {
  std::uint64_t hash = fnv1a(io::read_file(scene.file));
  hash = fnv1a(scene.quality == Quality::kDraft ? "draft" : "full", hash);
  hash = fnv1a(
      {reinterpret_cast<const char*>(world.triangles.data()), world.triangles.size() * sizeof(world.triangles[0])},
      hash);
  hash = fnv1a(bytes_of(world.v_t0), fnv1a(bytes_of(world.x_t0), hash));
  for (const Collider& collider : world.colliders) {
    if (collider.sequence() != nullptr) hash = fnv1a(std::to_string(collider.sequence()->checksum()), hash);
  }
  return hash;
}

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  std::string bytes(kMagic);
  put(bytes, checkpoint.scene_fingerprint);
  put(bytes, checkpoint.recorded);
  const StepClock::State& clock = checkpoint.state.clock;
  put(bytes, clock.frame);
  put(bytes, clock.tick);
  put(bytes, clock.level);
  put(bytes, clock.good_steps);
  put(bytes, clock.good_steps_asked);
  put(bytes, clock.on_trial);
  put(bytes, checkpoint.state.x);
  put(bytes, checkpoint.state.v);
  put(bytes, checkpoint.state.loads);
  for_each_total(checkpoint.totals, [&](const char*, const auto& field) { put(bytes, field); });
  put(bytes, fnv1a(bytes));
  io::write_atomically(file, bytes);
}

std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  const std::string bytes = io::read_file(file);
  Source source(bytes, file);
  if (source.take(kMagic.size()) != kMagic) source.fail("this is no checkpoint of this version");
  Checkpoint checkpoint;
  source.get(checkpoint.scene_fingerprint);
  source.get(checkpoint.recorded);
  StepClock::State& clock = checkpoint.state.clock;
  source.get(clock.frame);
  source.get(clock.tick);
  source.get(clock.level);
  source.get(clock.good_steps);
  source.get(clock.good_steps_asked);
  source.get(clock.on_trial);
  source.get(checkpoint.state.x);
  source.get(checkpoint.state.v);
  source.get(checkpoint.state.loads);
  for_each_total(checkpoint.totals, [&](const char*, auto& field) { source.get(field); });
  std::uint64_t checksum = 0;
  source.get(checksum);
  if (!source.empty() || checksum != fnv1a(std::string_view(bytes).substr(0, bytes.size() - sizeof checksum))) {
    source.fail("the checkpoint is damaged");
  }
  return checkpoint;
}

}  // namespace selvage::sim
