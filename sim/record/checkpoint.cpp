#include "sim/record/checkpoint.h"

#include <bit>
#include <cstring>
#include <string>

#include "io/file/atomic_file.h"
#include "sim/base/fnv1a.h"
#include "sim/base/points.h"

namespace selvage::sim {
namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian: add byte swaps here");

constexpr std::string_view kMagic = "selvage-checkpoint 15\n";

template <class Number>
void put(std::string& bytes, const Number& number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

void put(std::string& bytes, const Positions& x) {
  put(bytes, static_cast<std::int64_t>(x.rows()));
  bytes += bytes_of(x);
}

void put(std::string& bytes, const BlockedWay& way) {
  put(bytes, way.blockage.body);
  put(bytes, way.blockage.vertex);
  for (const double number : way.blockage.at_m) put(bytes, number);
  for (const double number : way.blockage.direction) put(bytes, number);
  put(bytes, way.until_s);
  put(bytes, way.back_m);
}

template <class Item>
void put_all(std::string& bytes, const std::vector<Item>& items) {
  put(bytes, static_cast<std::int64_t>(items.size()));
  for (const Item& item : items) put(bytes, item);
}

static_assert(sizeof(ContactLoad) == 2 * sizeof(std::int32_t) + 4 * sizeof(double),
              "padding would be written as it is");
static_assert(sizeof(BodyWait) == 2 * sizeof(std::int64_t) + 3 * sizeof(double), "likewise");

void put(std::string& bytes, const ContactLoads& loads) {
  put_all(bytes, loads.vf);
  put_all(bytes, loads.ee);
}

void put(std::string& bytes, const Candidates& pairs) {
  put_all(bytes, pairs.vf);
  put_all(bytes, pairs.ee);
}

void put(std::string& bytes, const SceneIdentity& scene) {
  put(bytes, static_cast<std::int64_t>(scene.text.size()));
  bytes += scene.text;
  put(bytes, scene.quality);
  put(bytes, static_cast<std::int64_t>(scene.parts.size()));
  for (const std::uint64_t part : scene.parts) put(bytes, part);
  put(bytes, scene.whole);
}

// Reads what put() wrote; never past the end.
class Source {
 public:
  Source(std::string_view bytes, const std::filesystem::path& file) : bytes_(bytes), file_(file) {}

  [[noreturn]] void fail(const char* what) const {
    throw io::Error(io::ErrorKind::kBadInput,
                    file_.string() + ": " + what + "; start the run again in another folder, or remove this one first");
  }
  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) fail("the checkpoint is cut short");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }
  template <class Number>
  void get(Number& number) {
    std::memcpy(&number, take(sizeof number).data(), sizeof number);
  }
  /// Of what takes `item_bytes` each: no more than there are bytes left for.
  std::size_t count(std::size_t item_bytes) {
    std::int64_t number = 0;
    get(number);
    if (number < 0 || static_cast<std::size_t>(number) > bytes_.size() / item_bytes) fail("the checkpoint is damaged");
    return static_cast<std::size_t>(number);
  }
  void get(SceneIdentity& scene) {
    scene.text = take(count(1));
    get(scene.quality);
    scene.parts.resize(count(sizeof(std::uint64_t)));
    for (std::uint64_t& part : scene.parts) get(part);
    get(scene.whole);
  }
  void get(Positions& x) {
    constexpr std::size_t kRowBytes = 3 * sizeof(double);
    const std::size_t rows = count(kRowBytes);
    x.resize(static_cast<Eigen::Index>(rows), 3);
    const std::string_view data = take(rows * kRowBytes);
    if (!data.empty()) std::memcpy(x.data(), data.data(), data.size());
  }
  template <class Item>
  void get_all(std::vector<Item>& items) {
    items.resize(count(sizeof(Item)));
    for (Item& item : items) get(item);
  }
  void get(ContactLoads& loads) {
    get_all(loads.vf);
    get_all(loads.ee);
  }
  void get(BlockedWay& way) {
    get(way.blockage.body);
    get(way.blockage.vertex);
    for (double& number : way.blockage.at_m) get(number);
    for (double& number : way.blockage.direction) get(number);
    get(way.until_s);
    get(way.back_m);
  }
  void get(Candidates& pairs) {
    get_all(pairs.vf);
    get_all(pairs.ee);
  }
  [[nodiscard]] bool empty() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
  const std::filesystem::path& file_;
};

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  std::string bytes(kMagic);
  put(bytes, checkpoint.scene);
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
  put(bytes, checkpoint.state.pressed);
  put_all(bytes, checkpoint.state.blocked);
  for_each_total(checkpoint.totals, [&](const char*, const auto& field) { put(bytes, field); });
  put_all(bytes, checkpoint.waits);
  put(bytes, fnv1a(bytes));
  io::write_atomically(file, bytes);
}

std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  const std::string bytes = io::read_file(file);
  Source source(bytes, file);
  if (source.take(kMagic.size()) != kMagic) source.fail("this is no checkpoint of this version");
  Checkpoint checkpoint;
  source.get(checkpoint.scene);
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
  source.get(checkpoint.state.pressed);
  source.get_all(checkpoint.state.blocked);
  for_each_total(checkpoint.totals, [&](const char*, auto& field) { source.get(field); });
  source.get_all(checkpoint.waits);
  std::uint64_t checksum = 0;
  source.get(checksum);
  if (!source.empty() || checksum != fnv1a(std::string_view(bytes).substr(0, bytes.size() - sizeof checksum))) {
    source.fail("the checkpoint is damaged");
  }
  return checkpoint;
}

}  // namespace selvage::sim
