#include <plot/png.hpp>
#include <algorithm>
#include <array>

namespace whirl::plot {
namespace {

void put32(std::string& s, std::uint32_t v) {
  for (int k = 24; k >= 0; k -= 8)
    s += static_cast<char>(v >> k & 255u);
}

std::uint32_t crc(std::string_view s) {
  static const auto table = [] {
    std::array<std::uint32_t, 256> t{};
    for (std::uint32_t n = 0; n < 256; ++n) {
      std::uint32_t c = n;
      for (int k = 0; k < 8; ++k)
        c = c & 1u ? 0xEDB88320u ^ c >> 1 : c >> 1;
      t[n] = c;
    }
    return t;
  }();
  std::uint32_t c = ~0u;
  for (const char x : s)
    c = table[(c ^ static_cast<unsigned char>(x)) & 255u] ^ c >> 8;
  return ~c;
}

void chunk(std::string& png, const char* type, const std::string& body) {
  put32(png, static_cast<std::uint32_t>(body.size()));
  std::string s = type;
  s += body;
  png += s;
  put32(png, crc(s));
}

}  // namespace

std::string make_png(int nx, int ny, std::span<const std::uint8_t> cells,
                     std::span<const Rgb> palette) {
  std::string png = "\x89PNG\r\n\x1a\n", head;
  put32(head, static_cast<std::uint32_t>(nx));
  put32(head, static_cast<std::uint32_t>(ny));
  head += std::string("\x08\x03\x00\x00\x00", 5);  // 8 bits, palette
  chunk(png, "IHDR", head);
  std::string colors;
  for (const auto& c : palette)
    colors += {static_cast<char>(c.r), static_cast<char>(c.g), static_cast<char>(c.b)};
  chunk(png, "PLTE", colors);
  std::string raw;
  for (int y = 0; y < ny; ++y) {
    raw += '\0';  // no filter
    raw.append(reinterpret_cast<const char*>(cells.data()) +
                   static_cast<std::size_t>(y) * static_cast<std::size_t>(nx),
               static_cast<std::size_t>(nx));
  }
  std::string z = "\x78\x01";
  std::uint32_t a = 1, b = 0;  // Adler-32
  for (const char x : raw) {
    a = (a + static_cast<unsigned char>(x)) % 65521;
    b = (b + a) % 65521;
  }
  for (std::size_t at = 0; at < raw.size();) {
    const std::size_t n = std::min<std::size_t>(65535, raw.size() - at);
    z += at + n == raw.size() ? '\x01' : '\x00';
    for (const auto v : {n, ~n})
      z += {static_cast<char>(v & 255u), static_cast<char>(v >> 8 & 255u)};
    z.append(raw, at, n);
    at += n;
  }
  put32(z, b << 16 | a);
  chunk(png, "IDAT", z);
  chunk(png, "IEND", {});
  return png;
}

}  // namespace whirl::plot
