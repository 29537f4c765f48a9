#include <analysis/spectra/frequency_dependent_modes.hpp>

#include <analysis/spectra/whirl_modes.hpp>
#include <core/error.hpp>

#include <la/dense.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {
constexpr std::size_t most_nodes = 150;

/// A branch lost below this share of the frequency goes over to the real axis, far from the line.
constexpr double on_the_axis = 0.3;

constexpr std::size_t entry(Index i) { return static_cast<std::size_t>(i); }

bool covered(const OwnFrequency::Matrices& at, double w) {
  try {
    at(w);
    return true;
  } catch (const Error& e) {
    if (e.diagnostics().front().code != "E81") throw;
    return false;
  }
}

/// Entries of the matrices that change from row to row, of unknowns that move: column k of the
/// table is entry k, scaled to a stiffness by 1, w, w^2; unit k says with which others it compares
/// (forces and moments over displacements and angles).
struct Changes {
  MatX value;
  std::vector<int> power, unit;
};

Changes changes_between(const OwnFrequency::Matrices& at, const std::vector<double>& rows,
                        std::span<const unsigned char> active) {
  // NOLINTNEXTLINE(performance-unnecessary-copy-initialization): the next call overwrites it
  const la::MCK base = at(rows.front());
  const la::BlockPattern& p = base.K.pattern();
  const std::size_t n = base.K.value_count();
  const auto part = [](const la::MCK& m, std::size_t k) {
    return (k == 0 ? m.K : k == 1 ? m.C : m.M).data();
  };
  std::vector<std::vector<std::pair<std::size_t, double>>> differs(rows.size());
  std::vector<std::size_t> ids;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    const la::MCK& m = at(rows[r]);
    for (std::size_t k = 0; k < 3; ++k) {
      const double *a = part(base, k), *b = part(m, k);
      for (std::size_t e = 0; e < n; ++e)
        if (a[e] != b[e]) {
          differs[r].emplace_back(k * n + e, b[e]);
          ids.push_back(k * n + e);
        }
    }
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  const auto unknowns = [&](std::size_t id) {
    const Index slot = static_cast<Index>(id % n / 36), local = static_cast<Index>(id % n % 36);
    const Index i =
        static_cast<Index>(std::upper_bound(p.row_start().begin(), p.row_start().end(), slot) -
                           p.row_start().begin()) -
        1;
    return std::pair<Index, Index>(6 * i + local % 6, 6 * p.cols()[entry(slot)] + local / 6);
  };
  std::erase_if(ids, [&](std::size_t id) {
    const auto [i, j] = unknowns(id);
    return !active[entry(i)] || !active[entry(j)];
  });
  Changes out;
  out.value.resize(static_cast<Index>(rows.size()), static_cast<Index>(ids.size()));
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const auto [i, j] = unknowns(ids[k]);
    out.power.push_back(static_cast<int>(ids[k] / n));
    out.unit.push_back((i % 6 < 3 ? 0 : 1) + (j % 6 < 3 ? 0 : 1));
    out.value.col(static_cast<Index>(k)).setConstant(part(base, ids[k] / n)[ids[k] % n]);
  }
  for (std::size_t r = 1; r < rows.size(); ++r)
    for (const auto& [id, v] : differs[r]) {
      const auto k = std::lower_bound(ids.begin(), ids.end(), id);
      if (k != ids.end() && *k == id) out.value(static_cast<Index>(r), k - ids.begin()) = v;
    }
  return out;
}

/// A change that matters, of each entry: its median over the rows since the first one; what is small
/// beside the changes of other entries or within rounding does not. (The entries themselves are no
/// measure: beside the stiffness of short elements, which grows as they get shorter, any support is
/// soft.)
VecX usual_change(const Changes& c, const std::vector<double>& rows) {
  const Index n = c.value.cols();
  VecX out = VecX::Zero(n);
  std::array<double, 3> of_unit{};
  std::vector<double> all;
  for (Index k = 0; k < n; ++k) {
    all.clear();
    double rounding = 0;
    for (Index r = 1; r < c.value.rows(); ++r) {
      const double f = std::pow(rows[entry(r)], c.power[entry(k)]);
      all.push_back(f * std::abs(c.value(r, k) - c.value(0, k)));
      rounding = std::max(rounding, 1e-9 * f * std::abs(c.value(r, k)));
    }
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    out(k) = std::max(*middle, rounding);
    double& most = of_unit[entry(c.unit[entry(k)])];
    most = std::max(most, out(k));
  }
  for (Index k = 0; k < n; ++k)
    out(k) = std::max(out(k), 0.003 * of_unit[entry(c.unit[entry(k)])]);
  return out;
}

/// What a straight line from row i to row j makes wrong at row r, relative to the change of the entry
/// since the first row, there or usual.
double deviation(const Changes& c, const std::vector<double>& rows, const VecX& usual, Index i,
                 Index j, Index r) {
  const double w = rows[entry(r)], t = (w - rows[entry(i)]) / (rows[entry(j)] - rows[entry(i)]);
  double worst = 0;
  for (Index k = 0; k < c.value.cols(); ++k) {
    const double f = std::pow(w, c.power[entry(k)]), base = f * c.value(0, k),
                 v = f * c.value(r, k),
                 line = f * (c.value(i, k) + t * (c.value(j, k) - c.value(i, k)));
    const double size = std::max({usual(k), std::abs(v - base), std::abs(line - base)});
    if (size > 0) worst = std::max(worst, std::abs(v - line) / size);
  }
  return worst;
}

/// Those of all rows that straight lines between the others do not replace.
std::vector<double> bends(const Changes& c, const std::vector<double>& all, double enough) {
  const VecX usual = usual_change(c, all);
  std::vector<double> out(1, all.front());
  std::vector<std::pair<Index, Index>> open{{0, static_cast<Index>(all.size()) - 1}};
  while (!open.empty()) {  // the lower part on top: rows come out in order
    const auto [i, j] = open.back();
    open.pop_back();
    Index worst = -1;
    double most = enough;
    for (Index r = i + 1; r < j; ++r)
      if (const double d = deviation(c, all, usual, i, j, r); d > most) {
        most = d;
        worst = r;
      }
    if (worst < 0) {
      out.push_back(all[entry(j)]);
    } else {
      open.emplace_back(worst, j);
      open.emplace_back(i, worst);
    }
  }
  return out;
}

la::ModeOptions of_count(la::ModeOptions o, Index count) {
  o.count = count;
  o.real_roots = false;
  // A branch may come down into the circle from outside it.
  o.max_frequency = count > 0 ? infinity : 1.1 * o.max_frequency;
  return o;
}
}  // namespace

OwnFrequency::OwnFrequency(const la::BlockPattern& pattern, std::span<const unsigned char> active,
                           const la::ModeOptions& wanted, std::vector<double> frequencies)
    : pattern_(pattern),
      active_(active.begin(), active.end()),
      wanted_(wanted),
      frequencies_(std::move(frequencies)),
      follower_(pattern, active_, wanted) {
  std::sort(frequencies_.begin(), frequencies_.end());
  frequencies_.erase(std::unique(frequencies_.begin(), frequencies_.end()), frequencies_.end());
  // Four more than wanted: a mode may lie behind others of the problem with its own coefficients.
  scan_count_ = wanted_.count > 0 ? wanted_.count + 4 : 0;
}

void OwnFrequency::find_range(const Matrices& at) {
  if (!std::isnan(lowest_)) return;
  const auto reached = [&](double w) { return covered(at, w); };
  if (reached(0.0)) {
    lowest_ = 0;
  } else {
    const auto first = std::find_if(frequencies_.begin(), frequencies_.end(), reached);
    if (first == frequencies_.end()) {
      at(frequencies_.front());  // says what is wrong
      return;
    }
    lowest_ = *first;
  }
  highest_ = *std::find_if(frequencies_.rbegin(), frequencies_.rend(), reached);
  held_ = reached(2.0 * highest_ + 1.0);
}

OwnFrequency::Range OwnFrequency::range(const Matrices& at) {
  find_range(at);
  return {lowest_, highest_, held_};
}

bool OwnFrequency::reaches_zero(const Matrices& at) {
  find_range(at);
  return lowest_ == 0.0;
}

void OwnFrequency::choose_rows(const Matrices& at) {
  std::vector<double> all{lowest_};
  for (const double w : frequencies_)
    if (w > lowest_ && w <= highest_ && w < wanted_.max_frequency) all.push_back(w);
  if (wanted_.max_frequency < highest_ && wanted_.max_frequency > lowest_)
    all.push_back(wanted_.max_frequency);
  rows_.assign(1, all.front());
  if (all.size() == 1) return;
  const Changes c = changes_between(at, all, active_);
  // Measured tables may have noise in every row.
  for (double enough = 0.02; enough < 1.0; enough *= 2.0) {
    rows_ = bends(c, all, enough);
    if (rows_.size() <= most_nodes) return;
  }
}

OwnFrequency::Node OwnFrequency::node(const Matrices& at, double w, double radius) {
  while (true) {
    if (!scan_) scan_.emplace(pattern_, active_, of_count(wanted_, scan_count_));
    Node n;
    n.w = w;
    n.modes = scan_->solve(at(w));
    ++solved_;
    n.reach = infinity;
    if (scan_count_ == 0 || static_cast<Index>(n.modes.size()) < scan_count_) return n;
    n.reach = 0;
    for (const la::Mode& m : n.modes)
      n.reach = std::max(n.reach, std::abs(m.lambda));
    if (n.reach >= radius) return n;
    scan_count_ += scan_count_ / 2 + 1;
    scan_.reset();
  }
}

std::optional<OwnFrequency::Point> OwnFrequency::step(const Matrices& at, const Point& from,
                                                      double w) {
  const la::MCK& m = at(w);
  auto found = follower_.follow(m, from.mode);
  if (!found || !(found->lambda.imag() > 0.0) || likeness(m, found->x, from.mode.x) < 0.4)
    return std::nullopt;
  return Point{w, std::move(*found)};
}

std::optional<OwnFrequency::Root> OwnFrequency::root(const Matrices& at, Point low, Point high) {
  double w0 = low.w, f0 = low.gap(), w1 = high.w, f1 = high.gap(), width = high.w - low.w;
  if (f0 == 0.0) return Root{std::move(low), false};
  if (std::abs(f0) < std::abs(f1)) {
    std::swap(w0, w1);
    std::swap(f0, f1);
  }
  for (int it = 0, slow = 0; it < 200; ++it) {
    double w = f1 != f0 ? w1 - f1 * (w1 - w0) / (f1 - f0) : nan;
    if (!(w > low.w && w < high.w) || slow >= 3) {
      w = 0.5 * (low.w + high.w);
      slow = 0;
    }
    const bool lower = w - low.w < high.w - w;
    auto p = step(at, lower ? low : high, w);
    if (!p) p = step(at, lower ? high : low, w);
    if (!p) return std::nullopt;
    const double f = p->gap();
    const bool rising = (f - f1) * (w - w1) > 0.0 && std::abs(f1) > 1e-9 * std::abs(p->mode.lambda);
    // The eigenvalue itself is known to 1e-12.
    if (std::abs(f) <= 1e-11 * std::abs(p->mode.lambda)) return Root{std::move(*p), rising};
    w0 = w1;
    f0 = f1;
    w1 = w;
    f1 = f;
    (f > 0.0 ? low : high) = std::move(*p);
    const double now = high.w - low.w;
    if (now <= 1e-15 * high.w) {  // a jump from one branch to another is no root
      if (std::abs(low.gap()) > 1e-7 * low.w) return std::nullopt;
      return Root{low, false};
    }
    slow = now < 0.5 * width ? 0 : slow + 1;
    if (now < 0.5 * width) width = now;
  }
  return std::nullopt;
}

bool OwnFrequency::add_roots(const Matrices& at, const Point& low, const Point& high, int depth) {
  auto r = root(at, low, high);
  if (!r) return false;
  if (!r->rising) {
    add(r->at.mode);
    return true;
  }
  // Between two that fall: those are wanted.
  if (depth == 0) return false;
  const double beside = 1e-3 * std::min(r->at.w - low.w, high.w - r->at.w);
  const auto left = step(at, r->at, r->at.w - beside), right = step(at, r->at, r->at.w + beside);
  if (!left || !right) return false;
  const bool both[2] = {left->gap() >= 0.0 || add_roots(at, low, *left, depth - 1),
                        right->gap() <= 0.0 || add_roots(at, *right, high, depth - 1)};
  return both[0] && both[1];
}

std::optional<OwnFrequency::Point> OwnFrequency::trace(const Matrices& at, Point p, double to) {
  const double whole = std::abs(to - p.w);
  double goal = to;
  bool lost = false;
  while (p.w != to) {
    const double stride = std::abs(goal - p.w);
    auto q = step(at, p, goal);
    const double middle = 0.5 * (p.w + goal);
    if (!q) {
      if (stride < whole / 50) {
        if (p.mode.lambda.imag() > on_the_axis * p.w) lost_ = true;
        return std::nullopt;
      }
      goal = middle;
      continue;
    }
    const Point &low = p.w < q->w ? p : *q, &high = p.w < q->w ? *q : p;
    const bool above[2] = {low.gap() >= 0.0, high.gap() >= 0.0};
    const double moved = std::abs(q->mode.lambda - p.mode.lambda);
    // Calm: nothing can have happened on the way that the ends do not show.
    const bool calm =
        moved <
        0.5 * (above[0] == above[1] ? std::min(std::abs(low.gap()), std::abs(high.gap())) : stride);
    if (!calm && stride > whole / 12) {
      goal = middle;
      continue;
    }
    if (above[0] && !above[1] && !add_roots(at, low, high, 3)) lost = true;
    p = std::move(*q);
    goal = to;
  }
  if (lost) lost_ = true;
  if (lost) return std::nullopt;
  return p;
}

void OwnFrequency::search_between(const Matrices& at, const Node& a, const Node& b, int halvings) {
  if (search(at, a, b) || halvings == 0) return;
  const double w = 0.5 * (a.w + b.w);
  const Node middle = node(at, w, 1.5 * w);
  search_between(at, a, middle, halvings - 1);
  search_between(at, middle, b, halvings - 1);
}

bool OwnFrequency::search(const Matrices& at, const Node& a, const Node& b) {
  lost_ = false;
  // Pairs on one side of the line that have moved less than half their distance from it need no
  // second look.
  struct Pair {
    double moved;
    std::size_t i, k;
  };
  const la::MCK& m = at(b.w);
  std::vector<bool> of_a(a.modes.size(), false), of_b(b.modes.size(), false);
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < a.modes.size(); ++i)
    for (std::size_t k = 0; k < b.modes.size(); ++k) {
      const double ga = a.modes[i].lambda.imag() - a.w, gb = b.modes[k].lambda.imag() - b.w,
                   moved = std::abs(a.modes[i].lambda - b.modes[k].lambda);
      if ((ga >= 0.0) == (gb >= 0.0) && moved < 0.5 * std::min(std::abs(ga), std::abs(gb)) &&
          likeness(m, a.modes[i].x, b.modes[k].x) > 0.4)
        pairs.push_back({moved, i, k});
    }
  std::sort(pairs.begin(), pairs.end(),
            [](const Pair& x, const Pair& y) { return x.moved < y.moved; });
  for (const Pair& p : pairs)
    if (!of_a[p.i] && !of_b[p.k]) of_a[p.i] = of_b[p.k] = true;
  // A root that falls through the line has its branch above it at a and below it at b; it is looked
  // for from both where they do not meet.
  for (std::size_t i = 0; i < a.modes.size(); ++i) {
    if (of_a[i] || a.modes[i].lambda.imag() < a.w) continue;
    const auto end = trace(at, {a.w, a.modes[i]}, b.w);
    if (!end) continue;
    std::size_t nearest = b.modes.size();
    double least = 1e-9 * std::abs(end->mode.lambda);
    bool taken = false;
    for (std::size_t k = 0; k < b.modes.size(); ++k) {
      const double d = std::abs(b.modes[k].lambda - end->mode.lambda);
      if (of_b[k] && d < 1e-9 * std::abs(end->mode.lambda)) taken = true;
      if (of_b[k] || !(d < least)) continue;
      least = d;
      nearest = k;
    }
    if (nearest < b.modes.size()) of_b[nearest] = true;
    // Two branches cannot end in one: a step went over from one to the other.
    if (nearest == b.modes.size() && taken) lost_ = true;
  }
  for (std::size_t k = 0; k < b.modes.size(); ++k)
    if (!of_b[k] && b.modes[k].lambda.imag() < b.w) trace(at, {b.w, b.modes[k]}, a.w);
  return !lost_;
}

bool OwnFrequency::feels_tables(const Matrices& at, const la::Mode& mode) {
  if (rows_.empty()) choose_rows(at);
  if (rows_.size() < 2) return true;
  return std::any_of(rows_.begin(), rows_.end(), [&](double w) {
    const la::MCK& m = at(w);
    const auto there = follower_.follow(m, mode);
    return !there || std::abs(there->lambda - mode.lambda) > 1e-10 * std::abs(mode.lambda) ||
           likeness(m, there->x, mode.x) < 0.5;
  });
}

void OwnFrequency::search_above(const Matrices& at, Node top) {
  const auto above = [&] {
    return std::count_if(top.modes.begin(), top.modes.end(),
                         [&](const la::Mode& m) { return m.lambda.imag() >= top.w; });
  };
  while (wanted_.count > 0 && std::isfinite(top.reach) &&
         within(top.reach) + above() < wanted_.count)
    top = node(at, top.w, 1.5 * top.reach);
  std::stable_sort(top.modes.begin(), top.modes.end(), [](const la::Mode& a, const la::Mode& b) {
    return a.lambda.imag() < b.lambda.imag();
  });
  for (const la::Mode& m : top.modes) {
    if (m.lambda.imag() < top.w || m.lambda.imag() > wanted_.max_frequency) continue;
    if (wanted_.count > 0 && within(m.lambda.imag()) >= wanted_.count) break;
    if (!held_ && m.lambda.imag() > top.w && feels_tables(at, m)) at(m.lambda.imag());  // an error
    add(m);
  }
}

Index OwnFrequency::within(double w) const {
  return std::count_if(found_.begin(), found_.end(),
                       [&](const la::Mode& m) { return m.lambda.imag() <= w; });
}

bool add_new(const la::Mode& mode, std::vector<la::Mode>& to) {
  // Two planes may have one frequency: new is what the vectors known there do not span.
  std::vector<const la::Mode*> close;
  for (const la::Mode& k : to)
    if (std::abs(k.lambda - mode.lambda) <= 1e-7 * std::abs(mode.lambda)) close.push_back(&k);
  if (!close.empty()) {
    MatXc a(mode.x.size(), static_cast<Index>(close.size()));
    for (std::size_t j = 0; j < close.size(); ++j)
      a.col(static_cast<Index>(j)) = close[j]->x.normalized();
    if (la::ColumnSpan<Complex>(a).outside(mode.x.normalized()).norm() < 0.05) return false;
  }
  to.push_back(mode);
  to.back().from = -1;
  return true;
}

std::vector<la::Mode> OwnFrequency::solve(const Matrices& at, bool certify) {
  found_.clear();
  rising_.clear();
  known_ = {};
  solved_ = 0;
  find_range(at);
  choose_rows(at);
  const double end = rows_.back();
  Node a = node(at, rows_.front(), 1.5 * rows_.front());
  // Below all tables.
  for (const la::Mode& m : a.modes)
    if (m.lambda.imag() < a.w) {
      if (feels_tables(at, m)) at(m.lambda.imag());  // an error
      add(m);
    }
  const auto enough = [&] { return wanted_.count > 0 && within(a.w) >= wanted_.count; };
  for (std::size_t next = 1; a.w < end && !enough();) {
    const double w = std::min(rows_[next], std::max(0.8 * a.reach, 1.2 * a.w));
    Node b = node(at, w, 1.5 * w);
    search_between(at, a, b, 5);
    if (w == rows_[next]) ++next;
    a = std::move(b);
  }
  if (!enough() && end < wanted_.max_frequency) search_above(at, std::move(a));
  if (certify) complete(at);

  const auto slower = [](const la::Mode& x, const la::Mode& y) {
    return x.lambda.imag() < y.lambda.imag();
  };
  std::erase_if(found_, [&](const la::Mode& m) { return m.lambda.imag() > wanted_.max_frequency; });
  std::stable_sort(found_.begin(), found_.end(), slower);
  if (wanted_.count > 0 && static_cast<Index>(found_.size()) > wanted_.count) {
    const double first_left_out = found_[entry(wanted_.count)].lambda.imag();
    found_.resize(entry(wanted_.count));
    known_.top = std::min(known_.top, 0.5 * (first_left_out + found_.back().lambda.imag()));
  }
  return found_;
}

double OwnFrequency::top_of_list(double share) const {
  std::vector<double> w;
  for (const la::Mode& m : found_)
    w.push_back(m.lambda.imag());
  std::sort(w.begin(), w.end());
  const std::size_t wanted = entry(std::max<Index>(wanted_.count, 0));
  const double limit = held_ ? infinity : highest_;
  double top = wanted > 0 && w.size() >= wanted       ? w[wanted - 1]
               : std::isfinite(wanted_.max_frequency) ? wanted_.max_frequency
               : w.empty()                            ? std::max(highest_, 1.0)
                                                      : w.back();
  top = std::min(top, limit);
  // Into the next gap: of two planes with one frequency both or none are below.
  for (auto above = std::upper_bound(w.begin(), w.end(), top * (1.0 - 1e-6));;) {
    while (above != w.end() && *above <= top * (1.0 + 1e-6))
      top = *above++;
    const double next = above != w.end() ? *above : infinity;
    if (next > top * (1.0 + 1e-6))
      return std::min(limit, top + share * std::min(0.2 * top, next - top));
  }
}

std::optional<la::WedgeCount> OwnFrequency::count_between(const Matrices& at, double low,
                                                          double top) {
  if (!counter_) counter_.emplace(pattern_, active_);
  la::WedgeProblem p;
  double last = nan;
  const la::MCK* matrices = nullptr;
  p.at = [&](Complex s) -> const la::MCK& {
    if (const double w = std::clamp(s.imag(), low, top); w != last) {
      matrices = &at(w);
      last = w;
    }
    return *matrices;
  };
  p.low = low;
  p.top = top;
  p.reach = known_.reach;
  p.stations = rows_;
  for (const la::Mode& m : found_)
    p.known.push_back(m.lambda);
  for (const la::Mode& m : rising_)
    p.rising.push_back(m.lambda);
  const la::WedgeCount c = counter_->count(p);
  known_.factorizations += c.factorizations;
  if (!c.certain) return std::nullopt;
  return c;
}

void OwnFrequency::complete(const Matrices& at) {
  double slowest = infinity;
  for (const la::Mode& m : found_)
    if (m.lambda.imag() > 0.0) slowest = std::min(slowest, m.lambda.imag());
  for (const double share : {0.5, 0.3, 0.7}) {
    known_.reach = la::oscillating_reach * (1.0 - 0.2 * std::abs(share - 0.5));
    known_.top = top_of_list(share);
    known_.low = lowest_ > 0.0 ? lowest_ : share * 0.02 * std::min(slowest, known_.top);
    if (!(known_.low < known_.top)) return;
    const auto c = count_between(at, known_.low, known_.top);
    if (!c) continue;
    known_.counted = true;
    const std::size_t before = found_.size();
    known_.missing = c->unknown == 0 ? 0 : recover(at, known_.low, known_.top, c->unknown, 24);
    known_.recovered = static_cast<Index>(found_.size() - before);
    break;
  }
  for (const la::Mode& m : rising_)
    known_.rising.push_back(m.lambda);
}

Index OwnFrequency::recover(const Matrices& at, double low, double top, Index missing, int depth) {
  const bool last = depth == 0 || top - low < 1e-7 * top;
  missing -= look_between(at, low, top, missing, last || depth % 4 == 0);
  if (missing == 0) return 0;
  if (!last)
    for (const double share : {0.5, 0.37, 0.61}) {
      const double middle = low + share * (top - low);
      const auto lower = count_between(at, low, middle);
      if (!lower) continue;
      const Index above = missing - lower->unknown;
      Index left = lower->unknown;
      if (left != 0) left = recover(at, low, middle, left, depth - 1);
      return left + (above == 0 ? 0 : recover(at, middle, top, above, depth - 1));
    }
  known_.where.emplace_back(0.0, 0.5 * (low + top));
  return missing;
}

Index OwnFrequency::look_between(const Matrices& at, double low, double top, Index missing,
                                 bool everywhere) {
  const double w = 0.5 * (low + top);
  la::ModeOptions near = wanted_;
  near.count = 4 + 2 * std::abs(missing);
  near.max_frequency = infinity;
  near.real_roots = near.certify = near.growing = false;
  Index found = 0;
  for (const double side : {0.0, -0.3, -1.0, -2.5, 0.3, 1.0, 2.5}) {
    near.shift = Complex(side * w, w);
    for (const la::Mode& m : la::quadratic_modes(at(w), active_, near)) {
      const auto r = land(at, {w, m}, low, top);
      if (!r) continue;
      const Complex l = r->at.mode.lambda;
      if (!(low <= l.imag() && l.imag() <= top && std::abs(l.real()) <= known_.reach * l.imag()))
        continue;
      if (add_new(r->at.mode, r->rising ? rising_ : found_)) found += r->rising ? -1 : 1;
    }
    if (!everywhere || found == missing) return found;
  }
  return found;
}

std::optional<OwnFrequency::Root> OwnFrequency::land(const Matrices& at, Point p, double low,
                                                     double top) {
  // By secant from a derivative: branches may run through the line much faster than it. Their shapes
  // may be any two of a plane; what tells where one goes is its eigenvalue.
  const auto moved = [&](const Point& from, double w) -> std::optional<Point> {
    auto found = follower_.follow(at(w), from.mode);
    if (!found || !(found->lambda.imag() > 0.0)) return std::nullopt;
    return Point{w, std::move(*found)};
  };
  const auto settled = [](const Point& x) {
    return std::abs(x.gap()) <= 1e-11 * std::abs(x.mode.lambda);
  };
  if (settled(p)) return Root{p, rises(at, p)};
  auto q = moved(p, p.w + 1e-4 * (top - p.w));
  int outside = 0;
  for (int it = 0; it < 40 && q && q->w != p.w && q->gap() != p.gap(); ++it) {
    if (settled(*q)) return Root{*q, rises(at, *q)};
    double next = q->w - q->gap() * (q->w - p.w) / (q->gap() - p.gap());
    if (!(next >= low && next <= top) && ++outside > 3) return std::nullopt;
    next = std::clamp(next, low, top);
    if (next == q->w) return std::nullopt;
    p = std::move(*q);
    q = moved(p, next);
  }
  return std::nullopt;
}

bool OwnFrequency::rises(const Matrices& at, const Point& root) {
  const double h = 1e-7 * root.w;
  const auto a = step(at, root, std::max(root.w - h, lowest_));
  const auto b = step(at, root, held_ ? root.w + h : std::min(root.w + h, highest_));
  return a && b && b->mode.lambda.imag() - a->mode.lambda.imag() > b->w - a->w;
}

Complex OwnFrequency::continued(const Matrices& at, const la::Mode& mode) {
  find_range(at);
  const double w = mode.lambda.imag(), g = mode.lambda.real();
  const auto above = std::upper_bound(frequencies_.begin(), frequencies_.end(), w);
  const bool between = above != frequencies_.begin() && above != frequencies_.end();
  const double h = std::min(0.01 * w, between ? 0.25 * (*above - *(above - 1)) : infinity);
  const double low = std::max(w - h, lowest_), high = held_ ? w + h : std::min(w + h, highest_);
  if (!(high > low)) return mode.lambda;
  const auto a = step(at, {w, mode}, low), b = step(at, {w, mode}, high);
  if (!a || !b) return mode.lambda;
  const Complex i(0, 1), slope = (b->mode.lambda - a->mode.lambda) / (high - low);
  return mode.lambda - i * slope * g / (1.0 + i * slope);
}

std::optional<la::Mode> OwnFrequency::settle(const Matrices& at, const la::Mode& start) {
  find_range(at);
  const double top = held_ ? infinity : highest_;
  const auto inside = [&](double w) { return std::clamp(w, lowest_, top); };
  std::optional<Point> p = step(at, {0.0, start}, inside(start.lambda.imag())), low, high;
  double w0 = nan, f0 = nan;
  for (int it = 0; it < 60 && p; ++it) {
    const double f = p->gap(), w = p->w;
    if (std::abs(f) <= 1e-11 * std::abs(p->mode.lambda)) return std::move(p->mode);
    (f > 0.0 ? low : high) = *p;
    if (low && high && low->w < high->w) {
      auto r = root(at, *low, *high);
      if (!r) return std::nullopt;
      return std::move(r->at.mode);
    }
    double next = std::isnan(w0) || f == f0 ? w + f : w - f * (w - w0) / (f - f0);
    if (!(next > 0.5 * w && next < 2.0 * w)) next = w + f;
    next = inside(next);
    if (next == w) {
      if (feels_tables(at, p->mode)) at(p->mode.lambda.imag());  // an error
      return std::move(p->mode);
    }
    w0 = w;
    f0 = f;
    p = step(at, *p, next);
  }
  return std::nullopt;
}

}  // namespace whirl::analysis
