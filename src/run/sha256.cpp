#include <run/sha256.hpp>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace whirl::run {
namespace {

using Word = std::uint32_t;

/// First 32 bits of the fractional part of the cube (k = 3) or square (k = 2) roots of the first
/// primes, exactly, by integer root of p * 2^(32 k).
template <std::size_t N>
std::array<Word, N> root_fractions(int k) {
  __extension__ using Wide = unsigned __int128;
  std::array<Word, N> r{};
  std::size_t n = 0;
  for (unsigned p = 2; n < N; ++p) {
    bool prime = true;
    for (unsigned d = 2; d * d <= p; ++d)
      prime = prime && p % d != 0;
    if (!prime) continue;
    const Wide target = static_cast<Wide>(p) << (32 * k);
    std::uint64_t root = 0;  // largest integer with root^k <= p 2^(32k)
    for (int bit = 36; bit >= 0; --bit) {
      const std::uint64_t trial = root | (std::uint64_t{1} << bit);
      Wide power = 1;
      for (int i = 0; i < k; ++i)
        power *= trial;
      if (power <= target) root = trial;
    }
    r[n++] = static_cast<Word>(root);
  }
  return r;
}

}  // namespace

std::string sha256_hex(std::string_view bytes) {
  static const auto K = root_fractions<64>(3);
  auto H = root_fractions<8>(2);

  std::string message(bytes);
  message += static_cast<char>(0x80);
  while (message.size() % 64 != 56)
    message += '\0';
  const std::uint64_t bits = static_cast<std::uint64_t>(bytes.size()) * 8;
  for (int i = 7; i >= 0; --i)
    message += static_cast<char>(bits >> (8 * i));

  for (std::size_t at = 0; at < message.size(); at += 64) {
    std::array<Word, 64> w{};
    for (std::size_t i = 0; i < 16; ++i)
      for (std::size_t b = 0; b < 4; ++b)
        w[i] = w[i] << 8 | static_cast<unsigned char>(message[at + 4 * i + b]);
    for (std::size_t i = 16; i < 64; ++i) {
      const Word s0 = std::rotr(w[i - 15], 7) ^ std::rotr(w[i - 15], 18) ^ w[i - 15] >> 3;
      const Word s1 = std::rotr(w[i - 2], 17) ^ std::rotr(w[i - 2], 19) ^ w[i - 2] >> 10;
      w[i] = w[i - 16] + s0 + w[i - 7] + s1;
    }
    auto [a, b, c, d, e, f, g, h] = H;
    for (std::size_t i = 0; i < 64; ++i) {
      const Word t1 = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) +
                      ((e & f) ^ (~e & g)) + K[i] + w[i];
      const Word t2 =
          (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
      h = g;
      g = f;
      f = e;
      e = d + t1;
      d = c;
      c = b;
      b = a;
      a = t1 + t2;
    }
    const std::array<Word, 8> add{a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < 8; ++i)
      H[i] += add[i];
  }
  static constexpr char digits[] = "0123456789abcdef";
  std::string r;
  for (Word x : H)
    for (int s = 28; s >= 0; s -= 4)
      r += digits[x >> s & 15];
  return r;
}

}  // namespace whirl::run
