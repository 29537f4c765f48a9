#include <deck/text/document.hpp>
#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <tuple>
#include <utility>

namespace whirl::deck {

const Member* Value::find(std::string_view key) const {
  for (const auto& m : members)
    if (m.key == key) return &m;
  return nullptr;
}

Member* Value::find(std::string_view key) {
  return const_cast<Member*>(std::as_const(*this).find(key));
}

Member& Value::add(std::string key, Value v, Spot key_spot) {
  members.push_back({std::move(key), key_spot, std::move(v)});
  return members.back();
}

Value Value::of_text(std::string s, Spot spot) {
  Value v;
  v.kind = Kind::text;
  v.text = std::move(s);
  v.spot = spot;
  return v;
}

Value Value::of_number(double x, Spot spot) {
  Value v;
  v.kind = Kind::real;
  v.real = x;
  v.spot = spot;
  return v;
}

Value Value::of_integer(std::int64_t i, Spot spot) {
  Value v;
  v.kind = Kind::integer;
  v.integer = i;
  v.spot = spot;
  return v;
}

Value Value::of_flag(bool b, Spot spot) {
  Value v;
  v.kind = Kind::boolean;
  v.boolean = b;
  v.spot = spot;
  return v;
}

Value Value::make_array(Spot spot) {
  Value v;
  v.kind = Kind::array;
  v.spot = spot;
  return v;
}

Value Value::make_table(Spot spot) {
  Value v;
  v.spot = spot;
  return v;
}

const char* name_of(Value::Kind k) {
  switch (k) {
    case Value::Kind::boolean: return "true or false";
    case Value::Kind::integer: return "a whole number";
    case Value::Kind::real: return "a number";
    case Value::Kind::text: return "text";
    case Value::Kind::date: return "a date or time";
    case Value::Kind::array: return "a list";
    case Value::Kind::table: return "a table";
    case Value::Kind::unreadable: return "unreadable";
  }
  return "";
}

bool Diagnostics::fresh(const std::string& code, const Spot& spot, const std::string& message) {
  // the header of a table of rows is looked at once per row: it is said once
  return seen_
      .insert(fmt::format("{} {} {} {} {}", spot.source, spot.line, spot.column, code, message))
      .second;
}

void Diagnostics::add(Diagnostic::Severity severity, std::string code, const Spot& spot,
                      std::string message, std::string hint, std::string entity) {
  Diagnostic d;
  d.severity = severity;
  d.code = std::move(code);
  d.message = std::move(message);
  d.hint = std::move(hint);
  d.where.entity = std::move(entity);
  list_.push_back({std::move(d), spot});
}

void Diagnostics::error(std::string code, const Spot& spot, std::string message, std::string hint,
                        std::string entity) {
  ++errors_;
  if (full() || !fresh(code, spot, message)) return;
  ++kept_;
  add(Diagnostic::Severity::error, std::move(code), spot, std::move(message), std::move(hint),
      std::move(entity));
}

void Diagnostics::warning(std::string code, const Spot& spot, std::string message, std::string hint,
                          std::string entity) {
  if (warnings_ >= limit || !fresh(code, spot, message)) return;
  ++warnings_;
  add(Diagnostic::Severity::warning, std::move(code), spot, std::move(message), std::move(hint),
      std::move(entity));
}

std::vector<Diagnostic> Diagnostics::take(const Sources& sources) {
  const auto place = [](const Entry& e) {
    return std::tuple(e.spot.source, e.spot.line, e.spot.column);
  };
  std::stable_sort(list_.begin(), list_.end(),
                   [&](const Entry& a, const Entry& b) { return place(a) < place(b); });
  std::vector<Diagnostic> r;
  for (auto& e : list_) {
    const std::string entity = e.d.where.entity;
    e.d.where = sources.where(e.spot);
    e.d.where.entity = entity;
    r.push_back(std::move(e.d));
  }
  if (full()) {
    Diagnostic more;
    more.severity = Diagnostic::Severity::note;
    more.message = fmt::format("the first {} errors are shown; there may be more", limit);
    r.push_back(std::move(more));
  }
  list_.clear();
  return r;
}

std::vector<std::string> nearest(std::string_view word, const std::vector<std::string>& names,
                                 std::size_t count) {
  const auto low = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  // Optimal string alignment: insert, delete, replace, swap of neighbours; a different case or '-'
  // for '_' costs little.
  const auto distance = [&](std::string_view a, std::string_view b) {
    std::vector<double> before(b.size() + 1), up(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
      up[j] = static_cast<double>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
      row[0] = static_cast<double>(i);
      for (std::size_t j = 1; j <= b.size(); ++j) {
        const char x = a[i - 1], y = b[j - 1];
        const bool alike = low(x) == low(y) || ((x == '-' || x == ' ') && y == '_');
        row[j] = std::min({up[j] + 1, row[j - 1] + 1, up[j - 1] + (x == y ? 0 : alike ? 0.1 : 1)});
        if (i > 1 && j > 1 && x == b[j - 2] && a[i - 2] == y)
          row[j] = std::min(row[j], before[j - 2] + 1);
      }
      std::swap(before, up);
      std::swap(up, row);
    }
    return up[b.size()];
  };
  std::vector<std::pair<double, std::string>> found;
  if (word.size() <= 64)
    for (const auto& n : names) {
      const double limit = 0.4 * static_cast<double>(std::max(word.size(), n.size())) + 0.3;
      const double d = distance(word, n);
      // a name that begins with the whole word is near as well ("visc" for "viscosity")
      if (d <= limit || (word.size() >= 3 && n.starts_with(word))) found.emplace_back(d, n);
    }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> r;
  for (const auto& [d, n] : found)
    if (r.size() < count) r.push_back(n);
  return r;
}

}  // namespace whirl::deck
