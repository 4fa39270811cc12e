#include "io/point_cache.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/fail.h"
#include "io/file/byte_order.h"
#include "io/file/extension.h"
#include "io/file/fp_guard.h"

namespace selvage::io {
namespace {

constexpr std::string_view kPc2Signature("POINTCACHE2\0", 12);
constexpr std::int32_t kPc2Version = 1;
constexpr std::uint64_t kPc2HeaderSize = 32, kMddHeaderSize = 8;

std::string read_start(const ByteSource& source, std::uint64_t size, const std::string& name) {
  std::string start = source.read(0, size);
  if (start.size() < size) {
    bad_input_at_byte(name, start.size(),
                      "the header is cut short: it needs " + std::to_string(size) + " bytes, the file has " +
                          std::to_string(start.size()) + "; copy the file again");
  }
  return start;
}

std::uint64_t read_count(const std::string& start, std::size_t offset, std::endian order, const char* of_what,
                         const std::string& name) {
  const auto count = load<std::int32_t>(start.data() + offset, order);
  if (count <= 0) {
    bad_input_at_byte(
        name, offset,
        "the number of " + std::string(of_what) + " is " + std::to_string(count) + "; is this a point cache?");
  }
  return static_cast<std::uint64_t>(count);
}

/// Before anything is allocated by the header's counts. Both are below 2^31, and a vertex has 12 bytes: so many
/// overflow.
void require_size(const ByteSource& source, const PointCacheHeader& header, const std::string& name) {
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
  const bool is_sum = header.frame_count <= (kMax - header.data_offset) / header.frame_size();
  const std::uint64_t announced = is_sum ? header.data_offset + header.frame_count * header.frame_size() : kMax;
  if (source.size() == announced) return;
  bad_input_at_byte(name, std::min(source.size(), announced),
                    std::to_string(header.frame_count) + " frames of " + std::to_string(header.vertex_count) +
                        " vertices make " + (is_sum ? "" : "more than ") + std::to_string(announced) +
                        " bytes, the file has " + std::to_string(source.size()) + "; export it again");
}

[[noreturn]] void not_increasing(const std::string& name, std::uint64_t offset, std::uint64_t frame) {
  bad_input_at_byte(
      name, offset,
      "the time of frame " + std::to_string(frame) + " is not later than that of the frame before; correct the times");
}

PointCacheHeader read_pc2(const ByteSource& source, const std::string& name) {
  constexpr std::uint64_t kVersionAt = 12, kVerticesAt = 16, kStartAt = 20, kRateAt = 24, kFramesAt = 28;
  const std::string start = read_start(source, kPc2HeaderSize, name);
  if (!start.starts_with(kPc2Signature)) bad_input_at_byte(name, 0, "not 'POINTCACHE2'; is this a PC2 file?");
  PointCacheHeader header;
  header.order = std::endian::little;
  const auto version = load<std::int32_t>(start.data() + kVersionAt, header.order);
  if (version != kPc2Version) {
    bad_input_at_byte(name, kVersionAt, "PC2 version " + std::to_string(version) + " is not known; export version 1");
  }
  header.vertex_count = read_count(start, kVerticesAt, header.order, "vertices", name);
  header.frame_count = read_count(start, kFramesAt, header.order, "frames", name);
  header.data_offset = kPc2HeaderSize;
  require_size(source, header, name);
  const auto first = static_cast<double>(load<float>(start.data() + kStartAt, header.order));
  const auto rate = static_cast<double>(load<float>(start.data() + kRateAt, header.order));
  if (!std::isfinite(first) || !std::isfinite(rate)) {
    bad_input_at_byte(name, std::isfinite(first) ? kRateAt : kStartAt,
                      "the start frame or the sampling rate is not finite; export it again");
  }
  header.times.reserve(header.frame_count);
  for (std::uint64_t i = 0; i < header.frame_count; ++i) {
    header.times.push_back(first + static_cast<double>(i) * rate);
    if (i > 0 && !(header.times[i - 1] < header.times[i])) not_increasing(name, kRateAt, i);
  }
  return header;
}

PointCacheHeader read_mdd(const ByteSource& source, const std::string& name) {
  const std::string start = read_start(source, kMddHeaderSize, name);
  PointCacheHeader header;
  header.order = std::endian::big;
  header.frame_count = read_count(start, 0, header.order, "frames", name);
  header.vertex_count = read_count(start, 4, header.order, "vertices", name);
  header.data_offset = kMddHeaderSize + header.frame_count * sizeof(float);
  require_size(source, header, name);
  const std::string times = source.read(kMddHeaderSize, header.frame_count * sizeof(float));
  header.times.reserve(header.frame_count);
  for (std::uint64_t i = 0; i < header.frame_count; ++i) {
    const std::uint64_t at = i * sizeof(float);
    header.times.push_back(static_cast<double>(load<float>(times.data() + at, header.order)));
    if (!std::isfinite(header.times[i])) {
      bad_input_at_byte(name, kMddHeaderSize + at,
                        "the time of frame " + std::to_string(i) + " is not finite; export it again");
    }
    if (i > 0 && !(header.times[i - 1] < header.times[i])) not_increasing(name, kMddHeaderSize + at, i);
  }
  return header;
}

}  // namespace

bool is_point_cache(const std::filesystem::path& file) {
  return has_extension(file, ".pc2") || has_extension(file, ".mdd");
}

PointCacheFormat point_cache_format(const std::filesystem::path& file) {
  return has_extension(file, ".pc2") ? PointCacheFormat::kPc2 : PointCacheFormat::kMdd;
}

PointCacheHeader read_point_cache_header(const ByteSource& source, PointCacheFormat format, const std::string& name) {
  const FpGuard guard;
  return format == PointCacheFormat::kPc2 ? read_pc2(source, name) : read_mdd(source, name);
}

std::string pc2_header(std::uint32_t vertex_count, std::uint32_t frame_count) {
  std::string bytes(kPc2Signature);
  append(bytes, kPc2Version, std::endian::little);
  append(bytes, vertex_count, std::endian::little);
  append(bytes, 0.0f, std::endian::little);
  append(bytes, 1.0f, std::endian::little);
  append(bytes, frame_count, std::endian::little);
  return bytes;
}

}  // namespace selvage::io
