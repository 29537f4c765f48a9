#include <core/types.hpp>
#include <core/units_table.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace whirl::units {
namespace {

constexpr int max_depth = 32;           // of parentheses
constexpr std::size_t max_text = 1000;  // bytes; longer texts are not quantities

bool near(double a, double b) { return std::abs(a - b) < 1e-9; }  // exponents are small rationals

struct Fail {
  Problem problem;
};

[[noreturn]] void fail(std::string code, std::string message, std::string hint, std::size_t offset,
                       std::size_t length) {
  throw Fail{{std::move(code), std::move(message), std::move(hint), offset,
              std::max<std::size_t>(length, 1)}};
}

void reduce(Quantity& q) {
  if (q.den > 1 && q.num >= q.den && std::fmod(q.num, q.den) == 0) {
    q.num /= q.den;
    q.den = 1;
  } else if (q.num > 1 && q.den > q.num && std::fmod(q.den, q.num) == 0) {
    q.den /= q.num;
    q.num = 1;
  }
}

bool is_word(char c) {
  const auto u = static_cast<unsigned char>(c);
  return std::isalpha(u) || c == '_' || c == '%';
}

const char* find_name(const Dimension& d) {
  static const auto names = [] {
    std::vector<std::pair<Dimension, const char*>> r;
    for (const auto& n : dimension_names())
      r.emplace_back(unit(n.unit).dimension, n.name);
    return r;
  }();
  for (const auto& [dim, name] : names)
    if (dim == d) return name;
  for (const auto& [dim, name] : names) {  // Hz counted as 1/s inside compounds
    Dimension x = d;
    x.cycles = dim.cycles;
    if (dim == x) return name;
  }
  return nullptr;
}

class Parser {
 public:
  explicit Parser(std::string_view s) : s_(s) {}

  Quantity run() {
    if (s_.size() > max_text) fail("E10", "the text is too long to be a quantity", "", 0, 1);
    skip();
    if (end()) fail("E10", "the text is empty where a quantity is expected", "", 0, 1);
    Quantity q = sum(0);
    skip();
    if (!end()) unexpected();
    const double v = q.value();
    if (!std::isfinite(v))
      fail("E13", fmt::format("\"{}\" is not a finite number", s_),
           "the value overflows double precision", 0, s_.size());
    return q;
  }

 private:
  bool end() const { return i_ >= s_.size(); }
  char peek(std::size_t k = 0) const { return i_ + k < s_.size() ? s_[i_ + k] : '\0'; }
  bool utf8(const char* seq) const { return s_.substr(i_).starts_with(seq); }

  void skip() {
    for (;;) {
      if (peek() == ' ' || peek() == '\t')
        ++i_;
      else if (utf8("\xC2\xA0"))
        i_ += 2;
      else
        break;
    }
  }

  bool minus() {
    if (peek() == '-') {
      ++i_;
      return true;
    }
    if (utf8("\xE2\x88\x92")) {
      i_ += 3;
      return true;
    }
    return false;
  }

  bool number_here() const {
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    return digit(peek()) || (peek() == '.' && digit(peek(1)));
  }

  bool unit_here() const {
    return is_word(peek()) || utf8("\xC2\xB5") || utf8("\xCE\xBC") || utf8("\xC2\xB0") ||
           utf8("\xCE\xA9");
  }

  [[noreturn]] void unexpected() {
    const std::size_t n = (static_cast<unsigned char>(peek()) & 0x80) ? [&] {
      std::size_t k = 1;
      while ((static_cast<unsigned char>(peek(k)) & 0xC0) == 0x80) ++k;
      return k;
    }() : 1;
    if (peek() == ',') {
      std::string fixed(s_);
      fixed[i_] = '.';
      const auto digit = [this](std::size_t k) { return peek(k) >= '0' && peek(k) <= '9'; };
      std::size_t first = i_;
      while (first > 0 && s_[first - 1] >= '0' && s_[first - 1] <= '9')
        --first;
      const bool thousands = first < i_ && s_[first] != '0';
      if (thousands && digit(1) && digit(2) && digit(3) && !digit(4)) {
        std::string joined(s_);
        joined.erase(i_, 1);
        fail("E12", fmt::format("\"{}\" has a comma inside a number", s_),
             fmt::format("write \"{}\" for thousands, \"{}\" for a decimal point", joined, fixed),
             i_, 1);
      }
      fail("E12", fmt::format("\"{}\" has a comma inside a number", s_),
           fmt::format("write a decimal point (\"{}\") and no thousands separator", fixed), i_, 1);
    }
    fail("E10",
         fmt::format("\"{}\" cannot be read as a quantity: unexpected '{}'", s_, s_.substr(i_, n)),
         "a quantity is a number and a unit, such as \"75 um\" or \"8e4 N/m\"", i_, n);
  }

  Quantity sum(int depth) {
    if (depth > max_depth) fail("E10", "too many nested parentheses in a quantity", "", i_, 1);
    Quantity a = product(depth);
    for (;;) {
      skip();
      const std::size_t at = i_;
      double sign = 0;
      if (peek() == '+') {
        sign = 1;
        ++i_;
      } else if (minus())
        sign = -1;
      else
        return a;
      Quantity b = product(depth);
      if (!(a.dimension == b.dimension))
        fail("E08",
             fmt::format("\"{}\" adds {} and {}", s_, name_of(a.dimension), name_of(b.dimension)),
             "", at, 1);
      if (a.offset != 0 || b.offset != 0) no_offset(at);
      if (a.num == b.num && a.den == b.den)
        a.number += sign * b.number;
      else {
        a.number = a.value() + sign * b.value();
        a.num = a.den = 1;
      }
      a.has_unit = a.has_unit || b.has_unit;
    }
  }

  [[noreturn]] void no_offset(std::size_t at) {
    fail("E10",
         fmt::format(
             "\"{}\" calculates with degC or degF, whose zero is not the zero of temperature", s_),
         "write \"40 degC\" alone, or calculate in K", at, 1);
  }

  static void combine(Quantity& a, const Quantity& b, double power) {
    for (std::size_t k = 0; k < 6; ++k)
      a.dimension.exponent[k] += power * b.dimension.exponent[k];
    a.dimension.cycles += power * b.dimension.cycles;
    a.has_unit = a.has_unit || b.has_unit;
  }

  Quantity product(int depth) {
    skip();
    double sign = 1;
    if (peek() == '+') {
      ++i_;
      skip();
    } else if (minus()) {
      sign = -1;
      skip();
    }
    Quantity a = power(depth);
    a.number *= sign;
    bool divided = false;
    for (;;) {
      skip();
      const std::size_t at = i_;
      enum { times, over, next } op = next;
      if (peek() == '*') {
        ++i_;
        op = times;
      } else if (utf8("\xC2\xB7") || utf8("\xC3\x97")) {
        i_ += 2;
        op = times;
      } else if (peek() == '.' && !number_here()) {
        ++i_;
        op = times;
      } else if (peek() == '/') {
        ++i_;
        op = over;
      } else if (peek() == '1' && peek(1) == '/') {
        i_ += 2;
        op = over;
      }  // "0.5 1/s"
      else if (unit_here() || peek() == '(')
        op = times;  // nothing written between
      if (op == next) return a;
      skip();
      const bool to_number = number_here();
      Quantity b = power(depth);
      if (op == times && divided && !to_number)
        fail("E10", fmt::format("\"{}\" can be read in two ways: a product follows the '/'", s_),
             "write the whole denominator in parentheses, such as \"W/(m.K)\"", at, i_ - at);
      if (a.offset != 0 || (b.offset != 0 && (op == over || a.has_unit))) no_offset(at);
      if (op == times) {
        a.number *= b.number;
        a.num *= b.num;
        a.den *= b.den;
        a.offset += b.offset;
        combine(a, b, 1);
      } else {
        a.number /= b.number;
        a.num *= b.den;
        a.den *= b.num;
        combine(a, b, -1);
        divided = true;
      }
      reduce(a);
    }
  }

  Quantity power(int depth) {
    const std::size_t at = i_;
    const bool number = number_here();
    Quantity q = primary(depth);
    double e = 1;
    bool raised = false;
    if (utf8("\xC2\xB2")) {
      i_ += 2;
      e = 2;
      raised = true;
    } else if (utf8("\xC2\xB3")) {
      i_ += 2;
      e = 3;
      raised = true;
    } else if (peek() == '^') {
      ++i_;
      e = exponent(depth);
      raised = true;
    } else if (!number && peek() >= '0' && peek() <= '9' && i_ > 0 && is_word(s_[i_ - 1])) {
      e = peek() - '0';
      ++i_;
      raised = true;
    }  // "m2"
    if (!raised) return q;
    if (q.offset != 0) no_offset(at);
    q.number = std::pow(q.number, e);
    const double up = std::pow(q.num, std::abs(e)), down = std::pow(q.den, std::abs(e));
    q.num = e < 0 ? down : up;
    q.den = e < 0 ? up : down;
    for (double& x : q.dimension.exponent)
      x *= e;
    q.dimension.cycles *= e;
    return q;
  }

  double exponent(int depth) {
    skip();
    const std::size_t at = i_;
    double e;
    if (peek() == '(') {
      ++i_;
      Quantity q = sum(depth + 1);
      skip();
      if (peek() != ')') unexpected();
      ++i_;
      if (q.has_unit)
        fail("E10", fmt::format("\"{}\" has an exponent with a unit", s_), "", at, i_ - at);
      e = q.value();
    } else {
      double sign = 1;
      if (peek() == '+')
        ++i_;
      else if (minus())
        sign = -1;
      if (!number_here()) unexpected();
      e = sign * number();
    }
    if (!(std::abs(e) <= 100))
      fail("E10", fmt::format("\"{}\" has an exponent beyond 100", s_), "", at, i_ - at);
    return e;
  }

  double number() {
    double v = 0;
    const char* first = s_.data() + i_;
    const char* last = s_.data() + s_.size();
    const auto r = std::from_chars(first, last, v);
    std::size_t n = static_cast<std::size_t>(r.ptr - first);
    if (r.ec == std::errc::result_out_of_range)
      fail("E13", fmt::format("\"{}\" has a number beyond the range of double precision", s_), "",
           i_, n);
    if (r.ec != std::errc()) unexpected();
    i_ += n;
    // a comma straight after a digit and before one
    if (peek() == ',' && peek(1) >= '0' && peek(1) <= '9') unexpected();
    return v;
  }

  Quantity primary(int depth) {
    skip();
    if (number_here()) {
      Quantity q;
      q.number = number();
      return q;
    }
    if (peek() == '(') {
      const std::size_t at = i_;
      ++i_;
      Quantity q = sum(depth + 1);
      skip();
      if (peek() != ')') {
        if (end())
          fail("E10", fmt::format("\"{}\" has a parenthesis that is not closed", s_), "", at, 1);
        unexpected();
      }
      ++i_;
      return q;
    }
    if (!unit_here()) {
      if (end())
        fail("E10", fmt::format("\"{}\" ends where a number or a unit is expected", s_), "",
             s_.size() - 1, 1);
      unexpected();
    }
    const std::size_t at = i_;
    if (peek() == '%')
      ++i_;
    else {
      for (;;) {
        if (is_word(peek()) && peek() != '%')
          ++i_;
        else if (utf8("\xC2\xB5") || utf8("\xCE\xBC") || utf8("\xC2\xB0") || utf8("\xCE\xA9"))
          i_ += 2;
        else
          break;
      }
    }
    const std::string_view word = s_.substr(at, i_ - at);
    if (auto q = find_unit(word)) return *q;
    unknown(word, at);
  }

  [[noreturn]] void unknown(std::string_view word, std::size_t at) {
    std::string lower(word);
    for (char& c : lower)
      c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (lower == "nan" || lower == "inf" || lower == "infinity")
      fail("E13", fmt::format("\"{}\" is not a finite number", s_),
           "leave the key out where no limit is meant", at, word.size());
    std::string hint;
    if (word == "lb" || word == "lbs")
      hint = "say which: 'lbm' is the mass, 'lbf' the force";
    else if (word == "C" || word == "F")
      hint = fmt::format("temperatures are written \"deg{}\"", word);
    else {
      for (std::size_t k = 1; k < word.size() && hint.empty();
           ++k) {  // "Nm", "Ns", "kgm": units written together
        const auto a = find_unit(word.substr(0, k)), b = find_unit(word.substr(k));
        if (!a || !b) continue;
        Quantity both = *a;
        combine(both, *b, 1);
        if (find_name(both.dimension))
          hint = fmt::format("write a point between units: '{}.{}'", word.substr(0, k),
                             word.substr(k));
      }
      if (hint.empty()) {
        const std::string n = nearest_unit(word);
        if (!n.empty()) hint = fmt::format("did you mean '{}'?", n);
      }
    }
    fail("E09", fmt::format("unknown unit '{}' in \"{}\"", word, s_), hint, at, word.size());
  }

  std::string_view s_;
  std::size_t i_ = 0;
};

/// Scale that takes `q` to the kind of angle and frequency that is wanted; nothing when the
/// dimensions do not agree.
std::optional<double> agree(const Dimension& given, const Dimension& wanted) {
  for (std::size_t k = 0; k < 5; ++k)
    if (!near(given.exponent[k], wanted.exponent[k])) return {};
  const double ga = given.exponent[Dimension::angle], wa = wanted.exponent[Dimension::angle];
  const double gc = given.cycles, wc = wanted.cycles;
  if (near(ga, wa) && (near(gc, 0) || near(wa, 0) || near(gc, wc))) return 1.0;
  if (!near(gc, 0) && near(wa, ga + gc)) return std::pow(two_pi, gc);  // Hz where rad/s is wanted
  if (!near(wc, 0) && near(wa, 0) && near(gc, 0) && near(ga, wc))
    return std::pow(two_pi, -wc);  // rpm where Hz is wanted
  const bool kinematic = near(wanted.exponent[0], 0) && near(wanted.exponent[1], 0) &&
                         near(wanted.exponent[3], 0) && near(wanted.exponent[4], 0);
  if (!kinematic && near(ga, 0) && near(gc, 0))
    return 1.0;  // N.m for N.m/rad; but 1/s never for rad/s
  return {};
}

std::string with_unit(std::string_view number, std::string_view unit) {
  return fmt::format("{} {}", number, unit);
}

Problem mismatch(std::string_view text, const Quantity& q, const Dimension& want,
                 std::string_view wanted) {
  Problem p;
  p.length = std::max<std::size_t>(text.size(), 1);
  if (!q.has_unit && !want.dimensionless()) {
    p.code = "E07";
    p.message = fmt::format("\"{}\" has no unit where {} is needed", text, name_of(want));
    p.hint = fmt::format("write the unit, for example \"{}\"", with_unit(text, wanted));
    return p;
  }
  p.code = "E08";
  p.message =
      fmt::format("\"{}\" is {} where {} is needed", text, name_of(q.dimension), name_of(want));
  const bool in_g = wanted == "m/s^2" && !text.empty() && text.back() == 'g';
  if (want.dimensionless())
    p.hint = "this value has no unit: write a plain number";
  else if (in_g)
    p.hint = "g is a gram; gn is the acceleration of gravity, 9.80665 m/s^2";
  else if (near(want.exponent[2], q.dimension.exponent[2]) &&
           want.exponent[Dimension::angle] != 0 && near(q.dimension.exponent[0], 0) &&
           near(q.dimension.exponent[1], 0))
    p.hint = fmt::format("say what turns: write it in {}, Hz or rpm",
                         wanted == "rpm" ? "rad/s" : wanted);
  else
    p.hint = fmt::format("write it in {} or another unit of the same kind", wanted);
  return p;
}

/// A key given in K holds a difference, which has no zero of degC or degF in it.
std::optional<Problem> no_difference(std::string_view text, const Quantity& q,
                                     std::string_view wanted) {
  if (wanted != "K" || q.offset == 0) return {};
  Problem p;
  p.code = "E10";
  p.message =
      fmt::format("\"{}\" is a temperature where a difference of temperatures is needed", text);
  p.hint = fmt::format("write it in K{}", q.num == q.den ? ", which is as large as a degree Celsius"
                                                         : ": a degree Fahrenheit is 5/9 K");
  p.length = std::max<std::size_t>(text.size(), 1);
  return p;
}

}  // namespace

bool Dimension::dimensionless() const {
  return std::all_of(exponent.begin(), exponent.end(), [](double x) { return near(x, 0); }) &&
         near(cycles, 0);
}

bool Dimension::plain_zero() const {
  Dimension degrees;
  degrees.exponent[temperature] = 1;
  return !(*this == degrees);
}

Parsed parse(std::string_view text) {
  try {
    return {Parser(text).run(), {}};
  } catch (const Fail& f) {
    return {{}, f.problem};
  }
}

Quantity unit(std::string_view text) {
  Quantity one;
  one.number = 1;
  if (text.empty() || text == "1") return one;
  Parsed p = parse(text.starts_with("1/") ? std::string(text) : fmt::format("1 {}", text));
  if (p.problem) throw std::logic_error(fmt::format("unit '{}': {}", text, p.problem->message));
  return p.quantity;
}

namespace {
/// A balance grade of ISO 21940-11 as it is written there, "G2.5": a velocity in mm/s.
bool is_balance_grade(std::string_view text, std::string_view wanted) {
  return wanted == "mm/s" && text.size() > 1 && text.front() == 'G' &&
         text.find_first_not_of("0123456789. ", 1) == std::string_view::npos;
}
}  // namespace

Converted convert(std::string_view text, std::string_view wanted) {
  if (is_balance_grade(text, wanted))
    return convert(fmt::format("{} {}", text.substr(1), wanted), wanted);
  Parsed p = parse(text);
  if (p.problem) return {0, p.problem};
  const Dimension want = unit(wanted).dimension;
  if (!p.quantity.has_unit && p.quantity.value() == 0 && want.plain_zero()) return {0, {}};
  const auto scale = agree(p.quantity.dimension, want);
  if (!scale || (!p.quantity.has_unit && !want.dimensionless()))
    return {0, mismatch(text, p.quantity, want, wanted)};
  if (auto problem = no_difference(text, p.quantity, wanted)) return {0, std::move(problem)};
  const double v = p.quantity.value() * *scale;
  if (!std::isfinite(v))
    return {0,
            Problem{"E13", fmt::format("\"{}\" is not a finite number", text), "", 0, text.size()}};
  return {v, {}};
}

Factor factor(std::string_view given, std::string_view wanted) {
  Factor f;
  Parsed p = given.empty() || given == "-" || given == "1"
                 ? Parsed{}
                 : parse(given.starts_with("1/") ? std::string(given) : fmt::format("1 {}", given));
  if (p.problem) {
    f.problem = p.problem;
    const std::size_t shift = given.starts_with("1/") ? 0 : 2;  // the "1 " put before it
    f.problem->offset -= std::min(shift, f.problem->offset);
    if (f.problem->code == "E09")
      f.problem->message = f.problem->message.substr(0, f.problem->message.find(" in \""));
    return f;
  }
  const Dimension want = unit(wanted).dimension;
  const auto scale = agree(p.quantity.dimension, want);
  if (!scale || (!p.quantity.has_unit && !want.dimensionless())) {
    f.problem = mismatch(given, p.quantity, want, wanted);
    if (!p.quantity.has_unit) {
      f.problem->message = fmt::format("no unit where {} is needed", name_of(want));
      f.problem->hint.clear();
    }
    return f;
  }
  f.problem = no_difference(given, p.quantity, wanted);
  if (f.problem) return f;
  f.num = p.quantity.has_unit ? p.quantity.number * p.quantity.num * *scale : 1;
  f.den = p.quantity.den;
  f.offset = p.quantity.offset;
  return f;
}

std::string format_number(double value) {
  if (value == 0) return "0";
  return fmt::format("{}", value);
}

std::string display(double value, std::string_view unit_text) {
  const Quantity u = unit(unit_text);
  const double x = (value - u.offset) * u.den / (u.num * u.number);
  return unit_text.empty() ? fmt::format("{:.6g}", x) : fmt::format("{:.6g} {}", x, unit_text);
}

std::string format(double value, std::string_view unit_text) {
  const Quantity u = unit(unit_text);
  if (u.dimension.dimensionless() && !u.has_unit) return format_number(value);
  const double x = (value - u.offset) * u.den / (u.num * u.number);
  for (int digits : {6, 9, 12, 15, 16, 17}) {
    std::string s = fmt::format("{:.{}g}", x, digits);
    double back = 0;
    std::from_chars(s.data(), s.data() + s.size(), back);
    s = with_unit(format_number(back), unit_text);
    const Converted c = convert(s, unit_text);
    if (!c.problem && c.value == value) return s;
  }
  return format_number(value) + ' ' + base_units(u.dimension);
}

std::string base_units(const Dimension& d) {
  static constexpr const char* names[] = {"m", "kg", "s", "K", "A", "rad"};
  std::string s;
  for (std::size_t k : {1u, 0u, 5u, 2u, 3u, 4u}) {
    const double e = d.exponent[k];
    if (near(e, 0)) continue;
    if (!s.empty()) s += '.';
    s += names[k];
    if (!near(e, 1)) s += fmt::format("^{}", e);
  }
  return s;
}

std::string name_of(const Dimension& d) {
  const char* name = find_name(d);
  return name ? std::string(name) : fmt::format("a quantity in {}", base_units(d));
}

std::string nearest_unit(std::string_view text, double limit) {
  // Optimal string alignment distance, a difference of case counting little, over every unit with
  // every prefix it takes.
  const auto distance = [](std::string_view a, std::string_view b) {
    std::vector<double> row(b.size() + 1), up(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
      up[j] = static_cast<double>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
      row[0] = static_cast<double>(i);
      for (std::size_t j = 1; j <= b.size(); ++j) {
        const bool same = a[i - 1] == b[j - 1];
        const bool case_only = std::tolower(static_cast<unsigned char>(a[i - 1])) ==
                               std::tolower(static_cast<unsigned char>(b[j - 1]));
        row[j] = std::min({up[j] + 1, row[j - 1] + 1,
                           up[j - 1] + (same        ? 0
                                        : case_only ? 0.2
                                                    : 1)});
      }
      std::swap(row, up);
    }
    return up[b.size()];
  };
  if (text.size() > 12) return {};
  std::string best;
  double least = std::min(limit, text.size() <= 2 ? 0.7 : text.size() <= 4 ? 1.3 : 2.3);
  for (const auto& e : entries()) {
    const std::string prefixes = std::string(1, '\0') + e.prefixes;
    for (char p : prefixes) {
      const std::string name = p ? std::string(1, p) + e.name : e.name;
      const double d = distance(text, name);
      if (d < least) {
        least = d;
        best = name;
      }
    }
  }
  return best;
}

std::vector<UnitInfo> unit_table() {
  std::vector<UnitInfo> r;
  for (const auto& e : entries())
    r.push_back({e.name, e.meaning, *e.prefixes != '\0'});
  return r;
}

}  // namespace whirl::units
