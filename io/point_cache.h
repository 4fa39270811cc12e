// PC2 and MDD, the point caches of animation programs: float32 positions of one mesh over time, without its faces.
// Sources: PC2: the header as 3ds Max writes and Blender reads it (MOD_meshcache_pc2.c); MDD: LightWave's "Motion
// Designer Displacements" (MOD_meshcache_mdd.c). The layouts stand in docs/formats.md.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/byte_source.h"
#include "io/error.h"
#include "io/mesh_data.h"

namespace selvage::io {

enum class PointCacheFormat : std::uint8_t { kPc2, kMdd };

/// What precedes the positions: frame i is vertex_count times x, y, z from data_offset + i * frame_size().
struct PointCacheHeader {
  std::endian order = std::endian::little;
  std::uint64_t frame_count = 0, vertex_count = 0;
  std::uint64_t data_offset = 0;
  std::vector<double> times;  ///< of each frame, increasing; MDD: seconds, PC2: frames of the animation

  [[nodiscard]] std::uint64_t frame_size() const { return vertex_count * 3 * sizeof(float); }
};

/// Whether `file` is named .pc2 or .mdd, in any case.
[[nodiscard]] bool is_point_cache(const std::filesystem::path& file);
/// REQUIRES is_point_cache(file).
[[nodiscard]] PointCacheFormat point_cache_format(const std::filesystem::path& file);

/// Reads the header and nothing else. Throws Error unless the file has exactly the size that the header announces, and
/// the times are finite and increase. Memory: O(frames), each of which has at least 12 bytes in the file.
[[nodiscard]] PointCacheHeader read_point_cache_header(const ByteSource& source, PointCacheFormat format,
                                                       const std::string& name);

/// The header of a PC2 that starts at frame 0 and has one sample a frame; the positions follow, as float32 in little
/// endian.
[[nodiscard]] std::string pc2_header(std::uint32_t vertex_count, std::uint32_t frame_count);

}  // namespace selvage::io
