#include "io/file/zip_archive.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <zlib.h>

#include "io/fail.h"
#include "io/file/byte_order.h"
#include "io/file/checksum.h"

namespace selvage::io {
namespace {

constexpr std::uint64_t kChunk = std::uint64_t{1} << 18;

template <typename T>
T field(std::string_view record, std::size_t offset) {
  return load<T>(record.data() + offset, std::endian::little);
}

/// Where the directory is, from the record at the end of the archive.
struct DirectoryPlace {
  std::uint64_t offset = 0, size = 0, count = 0;
};

/// The 64-bit values of a directory entry whose 32-bit fields are full: extra field 1, in the order of `fields`.
bool widen(std::string_view extra, std::initializer_list<std::uint64_t*> fields) {
  constexpr std::uint64_t kFull64 = 0xffffffff;
  std::string_view wide;
  while (extra.size() >= 4) {
    const std::size_t size = field<std::uint16_t>(extra, 2);
    if (size > extra.size() - 4) return false;
    if (field<std::uint16_t>(extra, 0) == 1) wide = extra.substr(4, size);
    extra.remove_prefix(4 + size);
  }
  for (std::uint64_t* value : fields) {
    if (*value != kFull64) continue;
    if (wide.size() < 8) return false;
    *value = field<std::uint64_t>(wide, 0);
    wide.remove_prefix(8);
  }
  return true;
}

/// The 64-bit end record, which a locator just before the end record at `end` points to.
std::optional<DirectoryPlace> find_wide_directory(const ByteSource& source, std::uint64_t end) {
  constexpr std::uint64_t kLocatorSize = 20, kRecordSize = 56;
  if (end < kLocatorSize + kRecordSize) return std::nullopt;
  const std::string locator = source.read(end - kLocatorSize, kLocatorSize);
  if (!locator.starts_with("PK\x06\x07")) return std::nullopt;
  const std::uint64_t offset = field<std::uint64_t>(locator, 8);
  if (offset > end - kLocatorSize - kRecordSize) return std::nullopt;
  const std::string record = source.read(offset, kRecordSize);
  if (!record.starts_with("PK\x06\x06")) return std::nullopt;
  return DirectoryPlace{.offset = field<std::uint64_t>(record, 48),
                        .size = field<std::uint64_t>(record, 40),
                        .count = field<std::uint64_t>(record, 32)};
}

DirectoryPlace find_directory(const ByteSource& source, const std::string& name) {
  constexpr std::uint64_t kEndSize = 22, kLongestComment = 0xffff;
  const std::uint64_t tail_size = std::min(source.size(), kEndSize + kLongestComment);
  const std::string tail = source.read(source.size() - tail_size, tail_size);
  for (std::size_t at = tail.size() < kEndSize ? 0 : tail.size() - kEndSize + 1; at-- > 0;) {
    const std::string_view end = std::string_view(tail).substr(at);
    if (!end.starts_with("PK\x05\x06") || end.size() != kEndSize + field<std::uint16_t>(end, 20)) continue;
    const std::uint64_t end_offset = source.size() - tail_size + at;
    if (field<std::uint32_t>(end, 4) != 0) bad_input_at_byte(name, end_offset, "the zip is split; join its parts");
    DirectoryPlace place = {.offset = field<std::uint32_t>(end, 16),
                            .size = field<std::uint32_t>(end, 12),
                            .count = field<std::uint16_t>(end, 10)};
    if (const std::optional<DirectoryPlace> wide = find_wide_directory(source, end_offset)) place = *wide;
    if (place.size > end_offset || place.offset > end_offset - place.size) {
      bad_input_at_byte(name, end_offset, "the zip directory is not in the file; copy the file again");
    }
    return place;
  }
  bad_input(name, "no zip directory at the end; the file is cut short or no .npz");
}

}  // namespace

ZipArchive::ZipArchive(std::shared_ptr<const ByteSource> source, std::string name)
    : source_(std::move(source)), name_(std::move(name)) {
  const DirectoryPlace place = find_directory(*source_, name_);
  directory_offset_ = place.offset;
  read_directory(place.offset, place.size, place.count);
}

void ZipArchive::read_directory(std::uint64_t offset, std::uint64_t size, std::uint64_t count) {
  constexpr std::size_t kEntrySize = 46;
  const std::string directory = source_->read(offset, size);
  std::string_view rest = directory;
  const auto fail = [&](std::string_view what) {
    bad_input_at_byte(name_, offset + directory.size() - rest.size(), what);
  };
  for (std::uint64_t i = 0; i < count; ++i) {
    if (rest.size() < kEntrySize || !rest.starts_with("PK\x01\x02")) {
      fail("the zip directory is cut short; copy the file again");
    }
    const std::size_t name_size = field<std::uint16_t>(rest, 28), extra_size = field<std::uint16_t>(rest, 30);
    const std::size_t comment_size = field<std::uint16_t>(rest, 32);
    if (rest.size() - kEntrySize < name_size + extra_size + comment_size) {
      fail("the zip directory is cut short; copy the file again");
    }
    ZipMember member;
    member.name = rest.substr(kEntrySize, name_size);
    member.crc32 = field<std::uint32_t>(rest, 16);
    member.compressed_size = field<std::uint32_t>(rest, 20);
    member.size = field<std::uint32_t>(rest, 24);
    member.header_offset = field<std::uint32_t>(rest, 42);
    if (!widen(rest.substr(kEntrySize + name_size, extra_size),
               {&member.size, &member.compressed_size, &member.header_offset})) {
      fail("the ZIP64 sizes are missing; copy the file again");
    }
    if ((field<std::uint16_t>(rest, 8) & 1) != 0) fail(in_quotes(member.name) + " is encrypted; save it in the clear");
    const int method = field<std::uint16_t>(rest, 10);
    if (method != 0 && method != Z_DEFLATED) {
      fail(in_quotes(member.name) + " is neither stored nor deflated; write it with numpy.savez");
    }
    member.is_deflated = method == Z_DEFLATED;
    (void)data_offset(member);  // a member whose name was damaged here would be one that is not there
    members_.push_back(std::move(member));
    rest.remove_prefix(kEntrySize + name_size + extra_size + comment_size);
  }
}

bool ZipArchive::contains(std::string_view member_name) const {
  return std::any_of(members_.begin(), members_.end(), [&](const ZipMember& m) { return m.name == member_name; });
}

const ZipMember& ZipArchive::find(std::string_view member_name) const {
  const ZipMember* found = nullptr;
  for (const ZipMember& member : members_) {
    if (member.name != member_name) continue;
    if (found != nullptr) bad_input(name_, "two members are named " + in_quotes(member_name) + "; write it again");
    found = &member;
  }
  if (found == nullptr) bad_input(name_, "no member " + in_quotes(member_name) + "; save the arrays V and F");
  return *found;
}

std::uint64_t ZipArchive::data_offset(const ZipMember& member) const {
  constexpr std::uint64_t kHeaderSize = 30;
  const auto fail = [&] {
    bad_input_at_byte(name_, member.header_offset,
                      "the member " + in_quotes(member.name) + " is not here; copy the file again");
  };
  const std::string header = source_->read(member.header_offset, kHeaderSize);
  if (header.size() < kHeaderSize || !header.starts_with("PK\x03\x04")) fail();
  const std::uint64_t name_size = field<std::uint16_t>(header, 26), extra_size = field<std::uint16_t>(header, 28);
  if (source_->read(member.header_offset + kHeaderSize, name_size) != member.name) fail();
  const std::uint64_t offset = member.header_offset + kHeaderSize + name_size + extra_size;
  if (offset > directory_offset_ || member.compressed_size > directory_offset_ - offset) fail();
  return offset;
}

std::shared_ptr<const ByteSource> ZipArchive::open(std::string_view member_name) const {
  const ZipMember& member = find(member_name);
  const std::uint64_t offset = data_offset(member);
  std::uint32_t sum = crc32({});
  std::shared_ptr<const ByteSource> content;
  if (member.is_deflated) {
    std::string bytes = inflate(member, offset);
    sum = crc32(bytes);
    content = in_memory(std::move(bytes));
  } else {
    if (member.size != member.compressed_size) {
      bad_input_at_byte(name_, offset, in_quotes(member.name) + " has two sizes; write the file again");
    }
    content = piece_of(source_, offset, member.size);
    for (std::uint64_t done = 0; done < member.size; done += kChunk) sum = crc32(content->read(done, kChunk), sum);
  }
  if (sum != member.crc32) {
    bad_input_at_byte(name_, offset, "the checksum of " + in_quotes(member.name) + " is wrong; copy the file again");
  }
  return content;
}

std::string ZipArchive::inflate(const ZipMember& member, std::uint64_t offset) const {
  const auto fail = [&](std::string_view what) {
    bad_input_at_byte(name_, offset, in_quotes(member.name) + " " + std::string(what));
  };
  if (member.size > std::max(kInflatedMinimum, kInflatedFactor * source_->size())) {
    fail("inflates to " + std::to_string(member.size) + " bytes, suspiciously many; write it with numpy.savez");
  }
  struct Inflater {
    z_stream stream = {};
    Inflater() {
      if (::inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
    }
    ~Inflater() { ::inflateEnd(&stream); }
  } inflater;
  z_stream& stream = inflater.stream;

  std::string bytes, compressed;
  std::string piece(kChunk, '\0');
  std::uint64_t taken = 0;
  for (int status = Z_OK; status != Z_STREAM_END && bytes.size() <= member.size;) {
    if (stream.avail_in == 0) {
      compressed = source_->read(offset + taken, std::min(kChunk, member.compressed_size - taken));
      taken += compressed.size();
      stream.next_in = reinterpret_cast<Bytef*>(compressed.data());
      stream.avail_in = static_cast<uInt>(compressed.size());
    }
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    status = ::inflate(&stream, Z_NO_FLUSH);
    // Z_BUF_ERROR: no progress, although there was room; so there was no input left, and the end was not seen.
    if (status == Z_BUF_ERROR) fail("is cut short; copy the file again");
    if (status != Z_OK && status != Z_STREAM_END) fail("is damaged; copy the file again");
    bytes.append(piece, 0, piece.size() - stream.avail_out);
  }
  if (bytes.size() != member.size || stream.avail_in != 0 || taken != member.compressed_size) {
    fail("does not inflate to its size; copy the file again");
  }
  return bytes;
}

}  // namespace selvage::io
