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

/// Reads one place: what `rest_` holds is still to be read.
class PlaceReader {
 public:
  PlaceReader(const model::Model& m, std::string_view given)
      : model_(m),
        given_(given),
        text_(trim(given)),
        rest_(text_) {}

  Located read() {
    take_shaft();
    if (is_distance())
      if (std::optional<Located> r = read_distance()) return std::move(*r);
    const std::vector<Named> names = names_of(model_, only_);
    std::size_t same = 0;  // names as long on other shafts
    const Named* best = longest_name(names, same);
    if (!best) return unknown_name(names);
    if (same > 0)
      return fail("E18", fmt::format("'{}' stands on more than one shaft", best->name),
                  fmt::format("write \"{}/{}\"", model_.shafts[best->shaft].name, rest_));
    if (std::optional<Located> r = read_ambiguity(names, *best)) return std::move(*r);
    double s = best->start;
    rest_ = rest_.substr(best->name.size());
    if (rest_.starts_with(':')) {
      rest_.remove_prefix(1);
      if (std::optional<Located> r = read_word(*best, s)) return std::move(*r);
    }
    if (std::optional<Located> r = read_shift(s)) return std::move(*r);
    return check(model_, best->shaft, s, text_);
  }

 private:
  /// Where a part of the text begins.
  std::size_t offset(std::string_view part) const {
    return static_cast<std::size_t>(part.data() - given_.data());
  }

  /// shaft/...
  void take_shaft() {
    for (std::size_t k = 0; k < model_.shafts.size(); ++k) {
      const std::string& n = model_.shafts[k].name;
      if (!n.empty() && rest_.size() > n.size() && rest_.starts_with(n) && rest_[n.size()] == '/') {
        only_ = k;
        rest_ = trim(rest_.substr(n.size() + 1));
        return;
      }
    }
  }

  bool is_distance() const {
    return !rest_.empty() && (std::isdigit(static_cast<unsigned char>(rest_.front())) ||
                              rest_.front() == '.' || rest_.front() == '-' || rest_.front() == '(');
  }

  /// Nothing where it is a name after all.
  std::optional<Located> read_distance() {
    const auto c = units::convert(rest_, "m");
    const auto names = names_of(model_, only_);
    const bool is_name = std::any_of(names.begin(), names.end(),
                                     [&](const Named& n) { return rest_.starts_with(n.name); });
    if (c.problem && is_name) return std::nullopt;
    if (c.problem)
      return fail(c.problem->code, c.problem->message, c.problem->hint,
                  offset(rest_) + c.problem->offset, c.problem->length);
    if (!only_ && model_.shafts.size() > 1)
      return fail("E18", fmt::format("\"{}\" does not say on which shaft", text_),
                  fmt::format("write \"{}/{}\"", model_.shafts.front().name, rest_));
    return check(model_, only_.value_or(0), c.value, text_);
  }

  /// The longest name the text begins with, followed by nothing, ':', '+', '-' or a blank.
  const Named* longest_name(const std::vector<Named>& names, std::size_t& same) const {
    const Named* best = nullptr;
    for (const auto& n : names) {
      if (!rest_.starts_with(n.name)) continue;
      const char next = rest_.size() > n.name.size() ? rest_[n.name.size()] : '\0';
      if (next != '\0' && next != ':' && next != '+' && next != '-' && next != ' ') continue;
      if (n.rank != 2 && rest_.substr(n.name.size()).starts_with(":support")) continue;
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
    return best;
  }

  /// Of places of one name the word behind it means those along a section or shaft, or without one any.
  std::optional<Located> read_ambiguity(const std::vector<Named>& names, const Named& best) const {
    const std::string_view word = rest_.substr(best.name.size());
    const bool along =
        word.starts_with(":start") || word.starts_with(":mid") || word.starts_with(":end");
    if (!along && word.starts_with(':')) return std::nullopt;
    const double slack = 1e-9 * std::max(model_.shafts[best.shaft].length(), 1e-12);
    const auto apart = [&](const Named& n) {
      return n.shaft != best.shaft || std::abs(n.start - best.start) > slack ||
             (along && std::abs(n.end - best.end) > slack);
    };
    for (const Named& n : names) {
      if (n.name != best.name || (n.rank == best.rank && n.rank != 2) || !apart(n)) continue;
      if (along && n.rank == 2) continue;
      if (n.rank == best.rank && one_kind(best.name)) continue;
      return fail("E18",
                  n.rank == best.rank
                      ? fmt::format("'{}' is a disk and a bearing, at different places", best.name)
                      : fmt::format("'{}' is a {} and a {}, at different places", best.name,
                                    noun(best.rank), noun(n.rank)),
                  n.rank == best.rank
                      ? "give one of them another name"
                      : fmt::format("\"{}:start\" (or :mid, :end) is a place on the {}; or give "
                                    "one of them another name",
                                    best.name, noun(best.rank)),
                  offset(rest_), best.name.size());
    }
    return std::nullopt;
  }
  /// Two disks, or two bearings, of one name: that is an error by itself (E16).
  bool one_kind(std::string_view name) const {
    const auto called = [&](const auto& x) { return x.name == name; };
    return std::count_if(model_.disks.begin(), model_.disks.end(), called) > 1 ||
           std::count_if(model_.bearings.begin(), model_.bearings.end(), called) > 1;
  }
  static std::string_view noun(int rank) {
    return rank == 0 ? "section" : rank == 1 ? "shaft" : "disk or bearing";
  }

  Located unknown_name(const std::vector<Named>& names) const {
    const std::size_t stop = std::min(rest_.find_first_of(":+"), rest_.size());
    const std::string word(trim(rest_.substr(0, stop)));
    if (const std::size_t slash = word.find('/'); slash != std::string::npos)
      return unknown_shaft(word.substr(0, slash));
    std::vector<std::string> all;
    all.reserve(names.size());
    for (const auto& n : names)
      all.emplace_back(n.name);
    const auto near = nearest(word, all);
    std::string known;
    for (std::size_t i = 0; i < all.size() && i < 12; ++i)
      known += (i ? ", " : "") + all[i];
    return fail("E18",
                fmt::format("there is no section, disk or bearing '{}'{}", word,
                            only_ ? " on shaft '" + model_.shafts[*only_].name + "'" : ""),
                !near.empty() ? fmt::format("did you mean '{}'?", near.front())
                : all.empty() ? "the shaft has no named sections"
                              : fmt::format("known: {}{}", known, all.size() > 12 ? ", ..." : ""),
                offset(rest_), word.size());
  }

  Located unknown_shaft(const std::string& shaft) const {
    std::vector<std::string> shafts;
    for (const auto& x : model_.shafts)
      shafts.push_back(x.name);
    const auto near = nearest(shaft, shafts);
    return fail("E18", fmt::format("there is no shaft '{}'", shaft),
                near.empty() ? fmt::format("the shafts are: {}", fmt::join(shafts, ", "))
                             : fmt::format("did you mean '{}'?", near.front()),
                offset(rest_), shaft.size());
  }

  /// :start, :mid or :end; :support and mistakes end the reading.
  std::optional<Located> read_word(const Named& named, double& s) {
    const std::size_t stop = std::min(rest_.find_first_of("+- "), rest_.size());
    const std::string_view word = rest_.substr(0, stop);
    if (word == "start") {
      s = named.start;
    } else if (word == "mid") {
      s = 0.5 * (named.start + named.end);
    } else if (word == "end") {
      s = named.end;
    } else if (word == "support" && named.rank == 2) {
      return support_of(named, s, word);
    } else {
      const auto near = nearest(word, {"start", "mid", "end"});
      return fail("E18", fmt::format("':{}' is not a place in a section", word),
                  near.empty()
                      ? "it is :start, :mid or :end"
                      : fmt::format("did you mean ':{}'? It is :start, :mid or :end", near.front()),
                  offset(word), word.size());
    }
    rest_ = rest_.substr(stop);
    return std::nullopt;
  }

  Located support_of(const Named& named, double s, std::string_view word) const {
    const auto bearing = std::find_if(model_.bearings.begin(), model_.bearings.end(),
                                      [&](const auto& b) { return b.name == named.name; });
    const std::size_t k = static_cast<std::size_t>(bearing - model_.bearings.begin());
    if (bearing == model_.bearings.end() ||
        model::traits_of(bearing->law).acts == model::Acts::as_constraint ||
        (!bearing->pedestal && model_.foundation_of(k) < 0))
      return fail("E18", fmt::format("'{}' has no support that moves", named.name),
                  "give the bearing support = { mass = ..., kyy = ..., kzz = ... }", offset(word),
                  word.size());
    Located r = check(model_, named.shaft, s, text_);
    if (r.at) r.at->housing = static_cast<int>(k);
    return r;
  }

  /// + or - a length, added to s.
  std::optional<Located> read_shift(double& s) {
    rest_ = trim(rest_);
    if (rest_.empty()) return std::nullopt;
    const char sign = rest_.front();
    if (sign != '+' && sign != '-')
      return fail("E18", fmt::format("\"{}\" cannot be read as a place", text_),
                  "write \"section:mid + 20 mm\"", offset(rest_), rest_.size());
    const std::string_view number = trim(rest_.substr(1));
    const auto c = units::convert(number, "m");
    if (c.problem)
      return fail(c.problem->code, c.problem->message, c.problem->hint,
                  offset(number) + c.problem->offset, c.problem->length);
    s += sign == '+' ? c.value : -c.value;
    return std::nullopt;
  }

  const model::Model& model_;
  std::string_view given_, text_, rest_;
  std::optional<std::size_t> only_;  ///< the shaft the text names
};

}  // namespace

Located locate(const model::Model& m, std::string_view given) {
  const std::string_view text = trim(given);
  if (m.shafts.empty())
    return fail("E18", fmt::format("\"{}\" stands on no shaft: the deck has none", text),
                "add [shaft]");
  if (text.empty())
    return fail("E18", "the place is empty",
                "write \"section:mid\" or a distance such as \"1.14 m\"");
  return PlaceReader(m, given).read();
}

}  // namespace whirl::deck
