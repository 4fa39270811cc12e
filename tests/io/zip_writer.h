// Zip archives for tests, honest or not: every field can be falsified.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <zlib.h>

#include "io/file/byte_order.h"
#include "io/file/checksum.h"

namespace selvage::testing {

struct ZipEntry {
  std::string name, content;
  bool deflate = false;
  std::uint16_t method_shown = 0xffff;  ///< 0xffff: the true one
  std::uint16_t flags = 0;
  std::uint32_t crc32_flip = 0;   ///< bits to falsify
  std::int64_t size_error = 0;    ///< added to the size shown
  std::int64_t offset_error = 0;  ///< added to the place of the local header
};

inline std::string raw_deflate(std::string_view bytes) {
  z_stream stream = {};
  ::deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string out(::deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  ::deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  ::deflateEnd(&stream);
  return out;
}

/// With `zip64`, every size and offset is in the 64-bit fields, as in archives beyond 4 GiB.
inline std::string zip(const std::vector<ZipEntry>& entries, bool zip64 = false) {
  const auto u16 = [](std::string& out, std::uint64_t x) {
    io::append(out, static_cast<std::uint16_t>(x), std::endian::little);
  };
  const auto u32 = [](std::string& out, std::uint64_t x) {
    io::append(out, static_cast<std::uint32_t>(x), std::endian::little);
  };
  const auto u64 = [](std::string& out, std::uint64_t x) { io::append(out, x, std::endian::little); };
  std::string archive, directory;
  for (const ZipEntry& entry : entries) {
    const std::string data = entry.deflate ? raw_deflate(entry.content) : entry.content;
    const std::uint64_t size = entry.content.size() + static_cast<std::uint64_t>(entry.size_error);
    const std::uint64_t offset = archive.size() + static_cast<std::uint64_t>(entry.offset_error);
    const unsigned method = entry.method_shown != 0xffff ? entry.method_shown : entry.deflate ? 8 : 0;
    const std::uint32_t sum = io::crc32(entry.content) ^ entry.crc32_flip;
    const auto common = [&](std::string& out, std::uint64_t extra_size) {
      u16(out, 45);
      u16(out, entry.flags);
      u16(out, method);
      u32(out, 0);  // time and date
      u32(out, sum);
      u32(out, zip64 ? 0xffffffff : data.size());
      u32(out, zip64 ? 0xffffffff : size);
      u16(out, entry.name.size());
      u16(out, extra_size);
    };
    archive += "PK\x03\x04";
    common(archive, 7);
    archive += entry.name;
    u16(archive, 0x4242);  // an extra field that readers skip, absent from the directory
    u16(archive, 3);
    archive += "xyz";
    archive += data;
    directory += "PK\x01\x02";
    u16(directory, 45);
    common(directory, zip64 ? 28 : 0);
    u16(directory, 0);  // comment
    u16(directory, 0);  // disk
    u16(directory, 0);
    u32(directory, 0);
    u32(directory, zip64 ? 0xffffffff : offset);
    directory += entry.name;
    if (zip64) {
      u16(directory, 1);
      u16(directory, 24);
      u64(directory, size);
      u64(directory, data.size());
      u64(directory, offset);
    }
  }
  const std::size_t begin = archive.size();
  archive += directory;
  if (zip64) {
    const std::size_t record = archive.size();
    archive += "PK\x06\x06";
    u64(archive, 44);
    u32(archive, 45 << 16 | 45);
    u32(archive, 0);
    u32(archive, 0);
    u64(archive, entries.size());
    u64(archive, entries.size());
    u64(archive, directory.size());
    u64(archive, begin);
    archive += "PK\x06\x07";
    u32(archive, 0);
    u64(archive, record);
    u32(archive, 1);
  }
  archive += "PK\x05\x06";
  u32(archive, 0);
  u16(archive, zip64 ? 0xffff : entries.size());
  u16(archive, zip64 ? 0xffff : entries.size());
  u32(archive, zip64 ? 0xffffffff : directory.size());
  u32(archive, zip64 ? 0xffffffff : begin);
  u16(archive, 0);
  return archive;
}

}  // namespace selvage::testing
