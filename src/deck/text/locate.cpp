#include <core/units.hpp>
#include <deck/text/document.hpp>
#include <deck/text/locate.hpp>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

std::string_view trim(std::string_view s) {
  while (!s.empty() && s.front() == ' ')
    s.remove_prefix(1);
  while (!s.empty() && s.back() == ' ')
    s.remove_suffix(1);
  return s;
}

struct Named {
  std::string_view name;
  std::size_t shaft;
  double start, end;  ///< equal for a disk or bearing
  int rank;           ///< 0 section, 1 shaft, 2 other
};

std::vector<Named> names_of(const model::Model& m, std::optional<std::size_t> only) {
  std::vector<Named> r;
  for (std::size_t k = 0; k < m.shafts.size(); ++k) {
    if (only && *only != k) continue;
    double s = 0;
    for (const auto& x : m.shafts[k].sections) {
      if (!x.name.empty()) r.push_back({x.name, k, s, s + x.length, 0});
      s += x.length;
    }
    if (!m.shafts[k].name.empty()) r.push_back({m.shafts[k].name, k, 0, s, 1});
  }
  const auto other = [&](const std::string& name, const model::Location& at) {
    if (!name.empty() && at.shaft < m.shafts.size() && !at.text.empty() &&
        (!only || *only == at.shaft))
      r.push_back({name, at.shaft, at.s, at.s, 2});
  };
  for (const auto& d : m.disks)
    other(d.name, d.at);
  for (const auto& b : m.bearings)
    other(b.name, b.at);
  return r;
}

Located fail(std::string code, std::string message, std::string hint, std::size_t offset = 0,
             std::size_t length = 0) {
  return {{}, std::move(code), std::move(message), std::move(hint), offset, length};
}

Located check(const model::Model& m, std::size_t shaft, double s, std::string_view text) {
  const double length = m.shafts[shaft].length();
  // a sum of section lengths may miss the end by a few roundings
  const double slack = 1e-9 * std::max(length, 1e-12);
  if (s < -slack || s > length + slack)
    return fail(
        "E19",
        fmt::format("\"{}\" is {} {} the {} of shaft '{}'", text,
                    units::display(std::abs(s < 0 ? s : s - length), "mm"),
                    s < 0 ? "before" : "beyond", s < 0 ? "start" : "end", m.shafts[shaft].name),
        fmt::format("the shaft is {} long", units::display(length, "mm")));
  Located r;
  r.at = model::Location{shaft, std::clamp(s, 0.0, length), std::string(text), {}};
  return r;
}

}  // namespace

Located locate(const model::Model& m, std::string_view given) {
  const std::string_view text = trim(given);
  if (m.shafts.empty()) {
    return fail("E18", fmt::format("\"{}\" stands on no shaft: the deck has none", text),
                "add [shaft]");
  }
  if (text.empty())
    return fail("E18", "the place is empty",
                "write \"section:mid\" or a distance such as \"1.14 m\"");
  std::string_view rest = text;
  std::optional<std::size_t> only;
  // shaft/...
  for (std::size_t k = 0; k < m.shafts.size(); ++k) {
    const std::string& n = m.shafts[k].name;
    if (!n.empty() && rest.size() > n.size() && rest.starts_with(n) && rest[n.size()] == '/') {
      only = k;
      rest = trim(rest.substr(n.size() + 1));
      break;
    }
  }
  // a distance
  if (!rest.empty() && (std::isdigit(static_cast<unsigned char>(rest.front())) ||
                        rest.front() == '.' || rest.front() == '-' || rest.front() == '(')) {
    const auto c = units::convert(rest, "m");
    const auto names = names_of(m, only);
    const bool is_name = std::any_of(names.begin(), names.end(),
                                     [&](const Named& n) { return rest.starts_with(n.name); });
    if (!c.problem || !is_name) {
      if (c.problem)
        return fail(c.problem->code, c.problem->message, c.problem->hint,
                    static_cast<std::size_t>(rest.data() - given.data()) + c.problem->offset,
                    c.problem->length);
      if (!only && m.shafts.size() > 1)
        return fail("E18", fmt::format("\"{}\" does not say on which shaft", text),
                    fmt::format("write \"{}/{}\"", m.shafts.front().name, rest));
      return check(m, only.value_or(0), c.value, text);
    }
  }
  // the longest name the text begins with, followed by nothing, ':', '+', '-' or a blank
  const auto names = names_of(m, only);
  const Named* best = nullptr;
  std::size_t same = 0;
  for (const auto& n : names) {
    if (!rest.starts_with(n.name)) continue;
    const char next = rest.size() > n.name.size() ? rest[n.name.size()] : '\0';
    if (next != '\0' && next != ':' && next != '+' && next != '-' && next != ' ') continue;
    if (best && n.name.size() == best->name.size() && n.rank == best->rank &&
        n.shaft != best->shaft) {
      ++same;
      continue;
    }
    if (!best || n.name.size() > best->name.size() ||
        (n.name.size() == best->name.size() && n.rank < best->rank)) {
      best = &n;
      same = 0;
    }
  }
  if (!best) {
    const std::size_t stop = std::min(rest.find_first_of(":+"), rest.size());
    const std::string word(trim(rest.substr(0, stop)));
    std::vector<std::string> all;
    for (const auto& n : names)
      all.emplace_back(n.name);
    if (const std::size_t slash = word.find('/'); slash != std::string::npos) {
      std::vector<std::string> shafts;
      for (const auto& x : m.shafts)
        shafts.push_back(x.name);
      const std::string shaft = word.substr(0, slash);
      const auto near_shaft = nearest(shaft, shafts);
      return fail("E18", fmt::format("there is no shaft '{}'", shaft),
                  near_shaft.empty() ? fmt::format("the shafts are: {}", fmt::join(shafts, ", "))
                                     : fmt::format("did you mean '{}'?", near_shaft.front()),
                  static_cast<std::size_t>(rest.data() - given.data()), shaft.size());
    }
    const auto near = nearest(word, all);
    std::string known;
    for (std::size_t i = 0; i < all.size() && i < 12; ++i)
      known += (i ? ", " : "") + all[i];
    return fail("E18",
                fmt::format("there is no section, disk or bearing '{}'{}", word,
                            only ? " on shaft '" + m.shafts[*only].name + "'" : ""),
                !near.empty() ? fmt::format("did you mean '{}'?", near.front())
                : all.empty() ? "the shaft has no named sections"
                              : fmt::format("known: {}{}", known, all.size() > 12 ? ", ..." : ""),
                static_cast<std::size_t>(rest.data() - given.data()), word.size());
  }
  if (same > 0)
    return fail("E18", fmt::format("'{}' stands on more than one shaft", best->name),
                fmt::format("write \"{}/{}\"", m.shafts[best->shaft].name, rest));
  double s = best->start;
  rest = rest.substr(best->name.size());
  if (rest.starts_with(':')) {
    rest.remove_prefix(1);
    const std::size_t stop = std::min(rest.find_first_of("+- "), rest.size());
    const std::string_view word = rest.substr(0, stop);
    if (word == "start")
      s = best->start;
    else if (word == "mid")
      s = 0.5 * (best->start + best->end);
    else if (word == "end")
      s = best->end;
    else if (word == "support" && best->rank == 2) {
      const auto bearing = std::find_if(m.bearings.begin(), m.bearings.end(),
                                        [&](const auto& b) { return b.name == best->name; });
      const std::size_t k = static_cast<std::size_t>(bearing - m.bearings.begin());
      if (bearing == m.bearings.end() ||
          model::traits_of(bearing->law).acts == model::Acts::as_constraint ||
          (!bearing->pedestal && m.foundation_of(k) < 0))
        return fail("E18", fmt::format("'{}' has no support that moves", best->name),
                    "give the bearing support = { mass = ..., kyy = ..., kzz = ... }",
                    static_cast<std::size_t>(word.data() - given.data()), word.size());
      Located r = check(m, best->shaft, s, text);
      if (r.at) r.at->housing = static_cast<int>(k);
      return r;
    } else {
      const auto near = nearest(word, {"start", "mid", "end"});
      return fail("E18", fmt::format("':{}' is not a place in a section", word),
                  near.empty()
                      ? "it is :start, :mid or :end"
                      : fmt::format("did you mean ':{}'? It is :start, :mid or :end", near.front()),
                  static_cast<std::size_t>(word.data() - given.data()), word.size());
    }
    rest = rest.substr(stop);
  }
  rest = trim(rest);
  if (!rest.empty()) {
    const char sign = rest.front();
    if (sign != '+' && sign != '-')
      return fail("E18", fmt::format("\"{}\" cannot be read as a place", text),
                  "write \"section:mid + 20 mm\"",
                  static_cast<std::size_t>(rest.data() - given.data()), rest.size());
    const std::string_view number = trim(rest.substr(1));
    const auto c = units::convert(number, "m");
    if (c.problem)
      return fail(c.problem->code, c.problem->message, c.problem->hint,
                  static_cast<std::size_t>(number.data() - given.data()) + c.problem->offset,
                  c.problem->length);
    s += sign == '+' ? c.value : -c.value;
  }
  return check(m, best->shaft, s, text);
}

}  // namespace whirl::deck
