// PNG as in W3C "Portable Network Graphics (PNG) Specification", 2nd edition: signature, IHDR, IDAT, IEND.
#include "io/format/png.h"

#include <cstdlib>

#include <zlib.h>

#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/file/byte_order.h"
#include "io/file/checksum.h"

namespace selvage::io {
namespace {

constexpr std::size_t kPixel = 3;
constexpr int kLargestSide = 65536;

void append_chunk(std::string& png, std::string_view type, std::string_view data) {
  append(png, static_cast<std::uint32_t>(data.size()), std::endian::big);
  png.append(type).append(data);
  append(png, crc32(data, crc32(type)), std::endian::big);
}

/// Section 9.4: the neighbour (left, above, above left) nearest to left + above - above_left.
int paeth(int left, int above, int above_left) {
  const int guess = left + above - above_left;
  const int to_left = std::abs(guess - left), to_above = std::abs(guess - above);
  const int to_above_left = std::abs(guess - above_left);
  if (to_left <= to_above && to_left <= to_above_left) return left;
  return to_above <= to_above_left ? above : above_left;
}

/// Every row as its filter type 4 (Paeth) and the differences from the prediction: smooth shading becomes small
/// numbers.
std::string filtered_rows(const Picture& picture) {
  const std::size_t row_size = kPixel * static_cast<std::size_t>(picture.width);
  std::string rows;
  rows.reserve((row_size + 1) * static_cast<std::size_t>(picture.height));
  for (std::size_t begin = 0; begin < picture.rgb.size(); begin += row_size) {
    rows += '\x04';
    for (std::size_t i = 0; i < row_size; ++i) {
      const std::size_t here = begin + i;
      const int left = i >= kPixel ? picture.rgb[here - kPixel] : 0;
      const int above = begin > 0 ? picture.rgb[here - row_size] : 0;
      const int above_left = begin > 0 && i >= kPixel ? picture.rgb[here - row_size - kPixel] : 0;
      rows += static_cast<char>((picture.rgb[here] - paeth(left, above, above_left)) & 0xff);
    }
  }
  return rows;
}

std::string deflated(const std::string& bytes) {
  uLongf size = ::compressBound(bytes.size());
  std::string compressed(size, '\0');
  const int status = ::compress2(reinterpret_cast<Bytef*>(compressed.data()), &size,
                                 reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_DEFAULT_COMPRESSION);
  if (status != Z_OK) throw std::bad_alloc();  // the only failure when the buffer is compressBound long
  compressed.resize(size);
  return compressed;
}

}  // namespace

std::string png_bytes(const Picture& picture) {
  const auto is_side = [](int side) { return 1 <= side && side <= kLargestSide; };
  if (!is_side(picture.width) || !is_side(picture.height) ||
      picture.rgb.size() !=
          kPixel * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height)) {
    bad_input("picture", "the pixels do not fill " + std::to_string(picture.width) + " by " +
                             std::to_string(picture.height) + "; choose sides of 1 to 65536");
  }
  std::string header;
  append(header, static_cast<std::uint32_t>(picture.width), std::endian::big);
  append(header, static_cast<std::uint32_t>(picture.height), std::endian::big);
  header.append({8, 2, 0, 0, 0});  // 8 bits, RGB, deflate, adaptive filters, not interlaced

  std::string png = "\x89PNG\r\n\x1a\n";
  append_chunk(png, "IHDR", header);
  constexpr std::size_t kChunk = std::size_t{1} << 20;  // a chunk holds less than 2^31 bytes
  const std::string pixels = deflated(filtered_rows(picture));
  for (std::size_t i = 0; i < pixels.size(); i += kChunk) {
    append_chunk(png, "IDAT", std::string_view(pixels).substr(i, kChunk));
  }
  append_chunk(png, "IEND", "");
  return png;
}

void write_png(const std::filesystem::path& file, const Picture& picture) {
  write_atomically(file, png_bytes(picture));
}

}  // namespace selvage::io
