// Embree's rtcCollide over user geometries. Embree's boxes are float32. Rounding to float32 is monotone, so boxes that
// overlap still do: pairs are added, not lost, as long as coordinates are normal float32 numbers below 1e18. Beyond
// that range it cannot be used at all. Embree sets FTZ and DAZ in its tasks: the callbacks here only copy numbers.
#include <stdexcept>
#include <string>

#include <embree3/rtcore.h>
#include <tbb/enumerable_thread_specific.h>

#include "bench/rivals/rival.h"

namespace selvage::bench {
namespace {

using Pair = std::array<std::int32_t, 2>;
using Found = tbb::enumerable_thread_specific<std::vector<Pair>>;

/// The boxes of one kind of feature as a scene with one user geometry.
class BoxScene {
 public:
  BoxScene(RTCDevice device, std::span<const Box> boxes) : scene_(rtcNewScene(device)), boxes_(boxes) {
    geometry_ = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry_, static_cast<unsigned>(boxes.size()));
    rtcSetGeometryUserData(geometry_, this);
    rtcSetGeometryBoundsFunction(geometry_, bounds, nullptr);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);  // "dynamic" scenes allow refits with this quality only
    rtcAttachGeometry(scene_, geometry_);
    commit();
  }
  ~BoxScene() {
    rtcReleaseGeometry(geometry_);
    rtcReleaseScene(scene_);
  }
  BoxScene(const BoxScene&) = delete;
  BoxScene& operator=(const BoxScene&) = delete;

  void refit(std::span<const Box> boxes) {
    boxes_ = boxes;
    rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
    rtcUpdateGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0);
    commit();
  }
  void collide(const BoxScene& other, Found& found) const { rtcCollide(scene_, other.scene_, keep, &found); }

 private:
  void commit() {
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }
  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const Box& box = static_cast<BoxScene*>(arguments->geometryUserPtr)->boxes_[arguments->primID];
    RTCBounds& out = *arguments->bounds_o;
    out.lower_x = static_cast<float>(box.lower[0]);
    out.lower_y = static_cast<float>(box.lower[1]);
    out.lower_z = static_cast<float>(box.lower[2]);
    out.upper_x = static_cast<float>(box.upper[0]);
    out.upper_y = static_cast<float>(box.upper[1]);
    out.upper_z = static_cast<float>(box.upper[2]);
  }
  static void keep(void* found, RTCCollision* collisions, unsigned count) {
    auto& pairs = static_cast<Found*>(found)->local();
    for (unsigned i = 0; i < count; ++i) {
      pairs.push_back(
          {static_cast<std::int32_t>(collisions[i].primID0), static_cast<std::int32_t>(collisions[i].primID1)});
    }
  }

  RTCScene scene_;
  RTCGeometry geometry_;
  std::span<const Box> boxes_;
};

class EmbreeBoxes : public Rival {
 public:
  explicit EmbreeBoxes(int thread_count) : device_(rtcNewDevice(("threads=" + std::to_string(thread_count)).c_str())) {}
  ~EmbreeBoxes() override {
    vertices_.reset();
    edges_.reset();
    faces_.reset();
    rtcReleaseDevice(device_);
  }

  void build(const FeatureBoxes& boxes) override {
    mesh_ = boxes.mesh;
    vertices_ = std::make_unique<BoxScene>(device_, boxes.vertices);
    edges_ = std::make_unique<BoxScene>(device_, boxes.edges);
    faces_ = std::make_unique<BoxScene>(device_, boxes.faces);
    check();
  }
  bool refit(const FeatureBoxes& boxes) override {
    vertices_->refit(boxes.vertices);
    edges_->refit(boxes.edges);
    faces_->refit(boxes.faces);
    check();
    return true;
  }
  Candidates query() override {
    Found vf_parts, ee_parts;
    vertices_->collide(*faces_, vf_parts);
    edges_->collide(*edges_, ee_parts);
    check();
    Candidates found;
    for (const auto& part : vf_parts) {
      for (const auto& [v, f] : part) {
        const bool is_loose = mesh_->vertex_owner[static_cast<std::size_t>(v)] < 0;
        if (!is_loose && !share_vertex(std::array{v}, mesh_->faces[static_cast<std::size_t>(f)])) {
          found.vf.push_back({v, f});
        }
      }
    }
    for (const auto& part : ee_parts) {
      for (const auto& [a, b] : part) {  // each pair comes twice
        if (a < b &&
            !share_vertex(mesh_->edges[static_cast<std::size_t>(a)], mesh_->edges[static_cast<std::size_t>(b)])) {
          found.ee.push_back({a, b});
        }
      }
    }
    make_unique(found.vf);
    make_unique(found.ee);
    return found;
  }

 private:
  void check() const {
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error("Embree reports an error");
  }
  template <typename Candidate>
  static void make_unique(std::vector<Candidate>& pairs) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  }

  RTCDevice device_;
  const Mesh* mesh_ = nullptr;
  std::unique_ptr<BoxScene> vertices_, edges_, faces_;
};

}  // namespace
}  // namespace selvage::bench

extern "C" __attribute__((visibility("default"))) selvage::bench::Rival* selvage_make_rival(int thread_count) {
  return new selvage::bench::EmbreeBoxes(thread_count);
}
