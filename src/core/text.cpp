#include <core/text.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace whirl {
namespace {

// Length of the UTF-8 sequence at s[i], 0 when it is broken.
std::size_t sequence(std::string_view s, std::size_t i) {
  const auto c = static_cast<unsigned char>(s[i]);
  const std::size_t n = c < 0x80                ? 1
                        : c >= 0xC2 && c < 0xE0 ? 2
                        : c >= 0xE0 && c < 0xF0 ? 3
                        : c >= 0xF0 && c < 0xF5 ? 4
                                                : 0;
  if (n == 0 || i + n > s.size()) return 0;
  for (std::size_t k = 1; k < n; ++k)
    if ((static_cast<unsigned char>(s[i + k]) & 0xC0) != 0x80) return 0;
  const auto c1 = n > 1 ? static_cast<unsigned char>(s[i + 1]) : 0;
  if ((c == 0xE0 && c1 < 0xA0) || (c == 0xED && c1 > 0x9F) || (c == 0xF0 && c1 < 0x90) ||
      (c == 0xF4 && c1 > 0x8F))
    return 0;
  return n;
}

// Advance widths of Helvetica in thousandths of the font size, ASCII 32 to 126 (Adobe font
// metrics).
constexpr std::array<std::uint16_t, 95> widths = {
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584};

}  // namespace

std::string escape(std::string_view s) {
  std::string out;
  out.reserve(s.size() + 8);
  for (std::size_t i = 0; i < s.size();) {
    const std::size_t n = sequence(s, i);
    if (n == 0) {
      out += "\xEF\xBF\xBD";
      ++i;
      continue;
    }
    const char c = s[i];
    if (n > 1)
      out.append(s, i, n);
    else if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' && c != '\r')
      out += "\xEF\xBF\xBD";
    else
      out += c;
    i += n;
  }
  return out;
}

namespace {

/// As std::to_chars rounds, several times as fast: false, and nothing appended, where x is large, has
/// more decimals, or lies so near to the middle of two numbers that the product may round across it.
bool append_small_number(std::string& out, double x, int decimals) {
  constexpr std::array<double, 4> powers{1.0, 10.0, 100.0, 1000.0};
  if (decimals < 0 || decimals > 3 || !(std::abs(x) < 1e5)) return false;
  const double scaled = std::abs(x) * powers[static_cast<std::size_t>(decimals)];
  const double whole = std::floor(scaled), rest = scaled - whole;
  if (std::abs(rest - 0.5) < 1e-6) return false;
  long n = static_cast<long>(whole) + (rest > 0.5 ? 1 : 0);
  while (decimals > 0 && n % 10 == 0) {
    n /= 10;
    --decimals;
  }
  std::array<char, 16> written;  // from behind
  char *const end = written.data() + written.size(), *first = end;
  for (int k = 0; k < decimals; ++k, n /= 10)
    *--first = static_cast<char>('0' + n % 10);
  if (decimals > 0) *--first = '.';
  do
    *--first = static_cast<char>('0' + n % 10);
  while ((n /= 10) != 0);
  if (std::signbit(x) && !(end - first == 1 && *first == '0')) *--first = '-';
  out.append(first, end);
  return true;
}

}  // namespace

void append_number(std::string& out, double x, int decimals) {
  if (!std::isfinite(x)) x = 0.0;  // callers break lines before; an attribute must stay a number
  if (append_small_number(out, x, decimals)) return;
  char b[64];
  auto r = std::to_chars(b, b + sizeof b, std::abs(x) < 1e15 ? x : std::copysign(1e15, x),
                         std::chars_format::fixed, decimals);
  if (decimals > 0) {
    while (r.ptr[-1] == '0')
      --r.ptr;
    if (r.ptr[-1] == '.') --r.ptr;
  }
  const std::string_view t(b, static_cast<std::size_t>(r.ptr - b));
  out += t == "-0" ? std::string_view("0") : t;
}

std::string number_text(double x, int decimals) {
  std::string s;
  append_number(s, x, decimals);
  return s;
}

std::string power_of_ten(int exponent) {
  static constexpr std::array<const char*, 10> digit = {"⁰", "¹", "²", "³", "⁴",
                                                        "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string s = "10";
  if (exponent < 0) s += "⁻";
  const std::string e = std::to_string(std::abs(exponent));
  for (const char c : e)
    s += digit[static_cast<std::size_t>(c - '0')];
  return s;
}

std::string readable(double x, int digits) {
  if (std::isnan(x)) return "nan";
  if (std::isinf(x)) return x > 0 ? "∞" : "−∞";
  if (x == 0.0) return "0";
  char b[64];
  *std::to_chars(b, b + sizeof b - 1, x, std::chars_format::scientific, digits - 1).ptr = '\0';
  const int e = std::atoi(std::string_view(b).substr(std::string_view(b).find('e') + 1).data());
  std::string mantissa(b, std::string_view(b).find('e'));
  std::string s;
  if (e >= -4 && e < 6)
    s = number_text(x, std::max(0, digits - 1 - e));
  else {
    if (mantissa.find('.') != std::string::npos) {
      while (mantissa.back() == '0')
        mantissa.pop_back();
      if (mantissa.back() == '.') mantissa.pop_back();
    }
    s = mantissa + "×" + power_of_ten(e);
  }
  if (s[0] == '-') s = "−" + s.substr(1);
  return s;
}

double text_width(std::string_view s, double size) {
  double w = 0;
  for (std::size_t i = 0; i < s.size();) {
    const std::size_t n = std::max<std::size_t>(1, sequence(s, i));
    const auto c = static_cast<unsigned char>(s[i]);
    // Superscripts are narrow; Greek letters and the rest are about as wide as a digit.
    if (n == 1)
      w += c >= 32 && c < 127 ? widths[c - 32u] : 556;
    else if (s.compare(i, 2, "\xC2\xB2") == 0 || s.compare(i, 2, "\xC2\xB3") == 0 ||
             s.compare(i, 2, "\xC2\xB9") == 0 || s.compare(i, 2, "\xE2\x81") == 0)
      w += 340;
    else
      w += 570;
    i += n;
  }
  return w * size / 1000;
}

std::string with_article(std::string_view noun) {
  const bool vowel = !noun.empty() && std::string_view("aeiou").find(noun.front()) != noun.npos;
  return (vowel ? "an " : "a ") + std::string(noun);
}

std::string safe_name(std::string_view name) {
  std::string s;
  for (const char c : name) {
    const bool good = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                      c == '-' || c == '_' || c == '.' || static_cast<unsigned char>(c) >= 0x80;
    s += good ? c : '_';
  }
  if (s.empty() || s[0] == '.') s.insert(s.begin(), '_');
  return s;
}

std::string safe_stem(std::string_view name) {
  std::string s = safe_name(name);
  std::replace(s.begin(), s.end(), '.', '_');
  return s;
}

std::string base64(std::string_view in) {
  static constexpr char table[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((in.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < in.size(); i += 3) {
    std::uint32_t v = 0;
    const std::size_t n = std::min<std::size_t>(3, in.size() - i);
    for (std::size_t k = 0; k < 3; ++k)
      v = v << 8 | (k < n ? static_cast<unsigned char>(in[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += k <= n ? table[v >> (18 - 6 * k) & 63u] : '=';
  }
  return out;
}

}  // namespace whirl
