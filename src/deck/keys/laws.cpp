// Laws of time: a constant, or a table with a "type".
#include <core/error.hpp>
#include <core/units.hpp>
#include <deck/visitor.hpp>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

enum class Blend { linear, monotone_cubic, smooth, cosine };

/// Points joined by the given blend, held constant outside.
LawPtr make_points(Blend blend, const std::vector<double>& t, const std::vector<double>& f) {
  if (blend == Blend::linear) return make_table(t, f);
  if (blend == Blend::monotone_cubic) return make_pchip(t, f);
  if (t.size() == 1) return make_constant(f[0]);
  std::vector<LawPtr> pieces;
  std::vector<double> start;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    start.push_back(t[i]);
    pieces.push_back(blend == Blend::smooth ? make_smooth_step(t[i], t[i + 1], f[i], f[i + 1])
                                            : make_cosine_step(t[i], t[i + 1], f[i], f[i + 1]));
  }
  return pieces.size() == 1 ? pieces[0] : make_piecewise(std::move(start), std::move(pieces));
}

struct Context {
  LawPtr* target;
  const char* unit;
  int depth;  ///< laws inside laws
};

bool law(Visitor&, const Key&, LawPtr& target, const char* unit, const char* doc, int depth);

/// Laws are built last; what a factory refuses becomes a deck error.
template <class Make>
void build(Visitor& v, LawPtr& target, const char* key, Make make) {
  if (!v.clean()) return;
  try {
    target = make();
  } catch (const Error& e) {
    const Diagnostic& d = e.diagnostics().front();
    v.error(d.code.c_str(), key, d.message, d.hint);
  }
}

struct Point {
  double time = 0, value = 0;
};

void points(Visitor& v, const Context& c, Blend blend, bool table) {
  std::vector<double> t, f;
  if (table) {
    static constexpr Option words[] = {{"linear", "straight lines"},
                                       {"monotone_cubic", "smooth, without overshoot"}};
    int i = 0;
    v.option("interpolation", i, words, "between the points");
    blend = i == 0 ? Blend::linear : Blend::monotone_cubic;
  }
  const Key time = table ? optional("time", "the rows") : required("time"),
            value = table ? optional("value", "the rows") : required("value");
  const bool times = v.quantities(time, t, "s", any, -1, "times of the points");
  const bool values = v.quantities(value, f, c.unit, any, -1,
                                   "values at the points; the first and last hold outside");
  const bool lists = times || values;
  if (table) {
    const auto describe_point = [&](Visitor& w, Point& p) {
      w.quantity(required("time"), p.time, "s", any, "time");
      w.quantity(required("value"), p.value, c.unit, any, "value");
    };
    const bool rows = v.rows(
        {[&](Visitor& w) {
           Point p;
           describe_point(w, p);
           if (w.clean() && !t.empty() && !(p.time > t.back()))
             w.error("E21", "time",
                     fmt::format("the times do not increase: {} after {}",
                                 units::display(p.time, "s"), units::display(t.back(), "s")));
           t.push_back(p.time);
           f.push_back(p.value);
         },
         [&](Visitor& w) {
           Point p;
           describe_point(w, p);
         }},
        false, "the points as a table, or from a CSV file");
    if (v.clean() && rows && lists)
      v.error("E26", "time", "the points are given by lists and by rows", "keep one of the two");
    if (v.clean() && !rows && !lists)
      v.error("E05", nullptr, "the law has no points",
              "give time = [...] and value = [...], or file = \"law.csv\" with columns time[s] and "
              "value[...]");
  }
  if (v.clean() && t.size() != f.size())
    v.error("E20", "value",
            fmt::format("the lists differ in length: {} and {}", t.size(), f.size()),
            "each time needs its value");
  const std::size_t least = table ? 1 : 2;
  if (v.clean() && t.size() < least)
    v.error("E20", "time", fmt::format("at least {} points are needed", least));
  for (std::size_t i = 1; v.clean() && i < t.size(); ++i)
    if (!(t[i] > t[i - 1]))
      v.error("E21", "time",
              fmt::format("the times do not increase: {} after {}", units::display(t[i], "s"),
                          units::display(t[i - 1], "s")));
  build(v, *c.target, "time", [&] { return make_points(blend, t, f); });
}

struct Piece {
  double start = 0;
  LawPtr law;
};

void pieces(Visitor& v, const Context& c, bool in_time) {
  std::vector<Piece> list;
  const auto describe_piece = [&](Visitor& w, Piece& p) {
    if (in_time) w.quantity(required("start"), p.start, "s", any, "time from which it holds");
    law(w, required("law"), p.law, c.unit, "the law", c.depth + 1);
    if (in_time && w.clean() && !list.empty() && !(p.start > list.back().start))
      w.error("E21", "start", "the times do not increase");
  };
  v.list(
      in_time ? required("pieces") : required("terms"),
      {[&](Visitor& w) {
         Piece p;
         describe_piece(w, p);
         list.push_back(p);
       },
       [&](Visitor& w) {
         Piece p;
         describe_piece(w, p);
       }},
      in_time ? "laws one after the other; each sees the time of the run" : "laws that are added");
  if (v.clean() && list.empty()) v.error("E05", nullptr, "the law has no parts");
  build(v, *c.target, nullptr, [&] {
    std::vector<LawPtr> laws;
    std::vector<double> start;
    for (auto& p : list) {
      laws.push_back(p.law);
      start.push_back(p.start);
    }
    return in_time ? make_piecewise(std::move(start), std::move(laws)) : make_sum(std::move(laws));
  });
}

void harmonic(Visitor& v, const Context& c) {
  double mean = 0, amplitude = 0, omega = 0, phase = 0;
  v.quantity("mean", mean, c.unit, any, "mean value");
  v.quantity(required("amplitude"), amplitude, c.unit, any, "amplitude, zero to peak");
  v.quantity(required("frequency"), omega, "rad/s", not_negative, "frequency (Hz, rpm or rad/s)");
  v.quantity("phase", phase, "deg", any, "mean + amplitude cos(frequency t + phase)");
  build(v, *c.target, nullptr, [&] { return make_harmonic(mean, amplitude, omega, phase); });
}

void decaying(Visitor& v, const Context& c) {
  double start = 0, amplitude = 0, omega = 0, phase = 0, decay = 1;
  v.quantity("start", start, "s", any, "time at which it begins; nothing before");
  v.quantity(required("amplitude"), amplitude, c.unit, any,
             "amplitude, zero to peak, at the start");
  v.quantity("frequency", omega, "rad/s", not_negative, "frequency (Hz, rpm or rad/s)");
  v.quantity("phase", phase, "deg", any, "at the start: of a cosine; -90 deg makes it a sine");
  v.quantity(required("decay"), decay, "s", positive, "time in which it falls to 1/e");
  build(v, *c.target, nullptr,
        [&] { return make_decaying(start, amplitude, omega, phase, decay); });
}

void polynomial(Visitor& v, const Context& c) {
  std::vector<double> a;
  v.quantities(required("coefficients"), a, c.unit, any, -1,
               "c0, c1, c2, ... of c0 + c1 t + c2 t^2 + ..., each with its unit", "s");
  if (v.clean() && a.empty()) v.error("E20", "coefficients", "at least one coefficient is needed");
  build(v, *c.target, "coefficients", [&] { return make_polynomial(a); });
}

bool law(Visitor& v, const Key& key, LawPtr& target, const char* unit, const char* doc, int depth) {
  double constant = 0;
  bool simple = false;
  const auto body = [&](Visitor& w) {
    const Context c{&target, unit, depth};
    std::vector<Alternative> kinds = {
        {"table", "points joined by straight lines or a monotone cubic",
         [=](Visitor& x) { points(x, c, Blend::linear, true); }},
        {"ramp", "straight from point to point, constant outside",
         [=](Visitor& x) { points(x, c, Blend::linear, false); }},
        {"smooth", "from point to point by the quintic without jerk at its ends",
         [=](Visitor& x) { points(x, c, Blend::smooth, false); }},
        {"cosine", "from point to point by half a cosine",
         [=](Visitor& x) { points(x, c, Blend::cosine, false); }},
        {"harmonic", "a cosine about a mean", [=](Visitor& x) { harmonic(x, c); }},
        {"decaying", "a cosine that decays; a sum of them makes a short circuit",
         [=](Visitor& x) { decaying(x, c); }},
        {"polynomial", "a polynomial in time", [=](Visitor& x) { polynomial(x, c); }},
    };
    if (depth == 0) {  // one level is enough, and keeps the description finite
      kinds.push_back({"piecewise", "different laws one after the other",
                       [=](Visitor& x) { pieces(x, c, true); }});
      kinds.push_back({"sum", "the sum of laws", [=](Visitor& x) { pieces(x, c, false); }});
    }
    w.alternatives(required("type"), kinds, "kind of law");
  };
  const bool given = v.either(key, constant, unit, simple, body, doc);
  if (given && simple && v.clean()) target = make_constant(constant);
  return given;
}

}  // namespace

bool describe_law(Visitor& v, const Key& key, LawPtr& target, const char* unit, const char* doc) {
  return law(v, key, target, unit, doc, 0);
}

}  // namespace whirl::deck
