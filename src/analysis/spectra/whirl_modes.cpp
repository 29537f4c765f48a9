#include <analysis/spectra/whirl_modes.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <la/multiply.hpp>

#include <fmt/format.h>

#include <la/dense.hpp>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

/// How far beyond the modes asked for the search goes on to where nothing can grow.
constexpr double furthest_search = 16.0;
/// And where so few modes lie that far, much further: stiff supports of light rotors.
constexpr double search_of_few = 1024.0;
constexpr Index few_modes = 64;
constexpr double whirl_of_speed = 2.0;    ///< and at least to this multiple of the speed
constexpr double beyond_bandwidth = 2.0;  ///< of a controller: its phase is worst about its corner

/// A spin of each line about its axis and a slide of each in three directions, where they take part.
MatX motions_of_lines(const system::System& system, const MotionReduction& motion) {
  constexpr Index directions[] = {system::ux, system::ux + 1, system::ux + 2, system::spin_phi};
  constexpr Index each = std::size(directions);
  MatX out = MatX::Zero(system.size(), each * system.lines());
  for (Index i = 0; i < system.nodes(); ++i) {
    if (system.node(i).scalar) continue;
    for (Index d = 0; d < each; ++d)
      if (const Index k = 6 * i + directions[d]; motion.takes_part(k))
        out(k, each * system.node(i).line + d) = 1.0;
  }
  Index used = 0;
  for (Index j = 0; j < out.cols(); ++j)
    if (out.col(j).any()) out.col(used++) = out.col(j);
  return out.leftCols(used);
}

la::ModeOptions la_options(const ModesOptions& o, const MatX& maybe_free, bool hysteretic) {
  la::ModeOptions l;
  l.maybe_free = maybe_free;
  l.certify = o.certify;
  l.count = o.count > 0 && hysteretic
                ? o.count + 2
                : o.count;  // partners of modes that hysteretic damping will tell apart
  l.guard = o.guard;
  l.max_frequency = o.max_frequency;
  l.real_roots = o.real_roots;
  l.growing = o.judge;
  return l;
}
}  // namespace

WhirlSolver::WhirlSolver(Linearizer& linear, const ModesOptions& options)
    : linear_(linear),
      options_(options),
      motion_(linear.system(), options.motion, linear.running().spinning()),
      solver_(linear.system().pattern(), motion_.active(),
              la_options(options, motions_of_lines(linear.system(), motion_),
                         options.damped && linear.hysteretic())) {
  const SteadyRotation& r = linear.running().running();
  if (!r.frequency_dependent()) return;
  la::ModeOptions by_size = la_options(options, motions_of_lines(linear.system(), motion_),
                                       options.damped && linear.hysteretic());
  by_size.certify = by_size.growing = false;  // its search goes by |lambda|
  own_.emplace(linear.system().pattern(), motion_.active(), by_size, r.table_frequencies);
}

const la::MCK& WhirlSolver::matrices_at(double Omega, Complex lambda, double side, double tables) {
  if (!options_.damped) {
    matrices_ = &motion_.reduce(linear_.conservative_at(Omega, lambda.imag()));
    return *matrices_;
  }
  // K holds the decay of the motion, - g eta/w C, where C is damping; what follows has none
  const bool apart = linear_.hysteretic() && motion_.anything_follows() && lambda.real() != 0.0 &&
                     std::isfinite(lambda.imag());
  if (apart) following_ = linear_.at(Omega, Complex(0, lambda.imag()), side, tables).K;
  const la::MCK& m = linear_.at(Omega, lambda, side, tables);
  matrices_ = &motion_.reduce(m, apart ? following_ : m.K);
  return *matrices_;
}

OwnFrequency::Matrices WhirlSolver::at_frequency(double Omega) {
  return [this, Omega](double w) -> const la::MCK& {
    matrices_ = &motion_.reduce(options_.damped ? linear_.at_frequency(Omega, w)
                                                : linear_.conservative_at(Omega, w));
    return *matrices_;
  };
}

std::optional<la::Mode> WhirlSolver::settle_rate(double Omega, la::Mode mode) {
  const Index from = mode.from;
  // Supports that answer by frequency do so within each round.
  const auto follow = [&](Complex rate, double side, const la::Mode& start) {
    if (!by_frequency() || start.lambda.imag() == 0.0)
      return solver_.follow(matrices_at(Omega, rate, side), start);
    const auto at_rate = [&](double w) -> const la::MCK& {
      return matrices_at(Omega, rate, side, w);
    };
    return own_->settle(at_rate, start);
  };
  const auto finished = [from](la::Mode m) {
    if (m.lambda.imag() < 0.0) {  // a motion that hardly oscillates: found as its other half
      m.lambda = std::conj(m.lambda);
      m.x = m.x.conjugate().eval();
    }
    m.from = from;
    return m;
  };
  // Where forward whirl passes the speed its damping changes sign. The side is settled in an outer
  // loop; where the frequency jumps from one side to the other with it (planes mixed by unequal
  // supports), the last one found stands.
  for (int sides = 0; sides < 6 && mode.lambda.imag() != 0.0; ++sides) {
    const bool given = !std::isnan(options_.hysteresis_order);
    const double side =
        given ? options_.hysteresis_order * std::abs(Omega) : std::abs(mode.lambda.imag());
    bool steady = false;
    double last_change = infinity;
    for (int round = 0; round < 40 && !steady && mode.lambda.imag() != 0.0; ++round) {
      const Complex rate = mode.lambda;
      auto next = follow(rate, side, mode);
      if (!next) return std::nullopt;
      const double change = std::abs(next->lambda - rate);
      const double size = std::abs(rate);
      // Every round contracts, until rounding is what is left: of slow motions of a stiff machine a
      // good part. Own frequencies are known to 1e-11.
      const double rounding = std::max(1e-8 * size, rounding_of(*next));
      const bool at_rounding = change <= rounding && change >= 0.9 * last_change;
      steady = change <= (by_frequency() ? 1e-10 : 1e-13) * size || at_rounding;
      last_change = change;
      if (steady && round == 0 && sides > 0)  // the new side changes nothing
        return finished(*next);
      mode = std::move(*next);
    }
    if (!steady && mode.lambda.imag() != 0.0) return std::nullopt;
    if (given) break;
  }
  return finished(mode);
}

void WhirlSolver::separate(double Omega, std::vector<la::Mode>& group) {
  const Index k = static_cast<Index>(group.size()), n = group.front().x.size();
  Complex rate = 0.0;
  for (const la::Mode& m : group)
    rate += m.lambda / static_cast<double>(k);
  const la::MCK& m = matrices_at(Omega, rate);
  MatXc X(n, k), Y(n, k);
  for (Index j = 0; j < k; ++j)
    X.col(j) = group[at(j)].x.normalized();
  const auto project = [&](const la::BlockMatrix<6>& a) {
    VecXc y;
    for (Index j = 0; j < k; ++j) {
      la::multiply(a, VecXc(X.col(j)), y);
      Y.col(j) = y;
    }
    return MatXc(X.adjoint() * Y);
  };
  const la::DenseLu<Complex> mass(project(m.M));
  MatXc companion = MatXc::Zero(2 * k, 2 * k);
  companion.topRightCorner(k, k).setIdentity();
  companion.bottomLeftCorner(k, k) = -mass.solve(project(m.K));
  companion.bottomRightCorner(k, k) = -mass.solve(project(m.C));
  const la::DenseEigenpairs eig = la::eigenpairs(companion);
  std::vector<Index> order(at(2 * k));
  for (Index j = 0; j < 2 * k; ++j)
    order[at(j)] = j;
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::abs(eig.values(a) - rate) < std::abs(eig.values(b) - rate);
  });
  // motions that move no mass have no others beside them here
  constexpr double beside = 0.5;
  if (!(std::abs(eig.values(order[at(k - 1)]) - rate) < beside * std::abs(rate))) return;
  for (Index j = 0; j < k; ++j) {
    const VecXc y = eig.vectors.col(order[at(j)]).head(k);
    group[at(j)].x = X * y;
    group[at(j)].lambda = eig.values(order[at(j)]);
  }
}

const la::MCK& WhirlSolver::own_matrices(double Omega, Complex lambda) {
  const OwnFrequency::Matrices at = at_frequency(Omega);
  return lambda.imag() != 0.0     ? at(lambda.imag())
         : own_->reaches_zero(at) ? at(0.0)
                                  : matrices_at(Omega, Complex(0, nan));
}

void WhirlSolver::solve_by_frequency(double Omega) {
  const OwnFrequency::Matrices at = at_frequency(Omega);
  std::vector<la::Mode> modes = own_->solve(at, options_.certify);
  if (options_.certify) certificate_.take(own_->known());
  la::Certificate rest;
  if (options_.real_roots) {
    for (const la::Mode& m : solver_.solve(own_matrices(Omega, 0.0)))
      if (m.lambda.imag() == 0.0) modes.push_back(m);
    rest = solver_.certificate();
    std::stable_sort(modes.begin(), modes.end(), [](const la::Mode& a, const la::Mode& b) {
      return a.lambda.imag() < b.lambda.imag();
    });
  }
  for (const la::Mode& m : modes) {
    modes_.push_back(describe_mode(m, own_matrices(Omega, m.lambda), linear_));
    modes_.back().from = -1;
    if (options_.continued && options_.damped && m.lambda.imag() != 0.0)
      modes_.back().continued = own_->continued(at, m);
  }
  if (!options_.judge || !options_.damped || !options_.certify) return;
  count_along_axis(Omega, rest);
  const SpectrumCertificate::Axis& axis = *certificate_.axis;
  if (!axis.counted || axis.unknown <= 0) return;
  add_growth_beyond(Omega);
  count_along_axis(Omega, rest);
}

void WhirlSolver::add_growth_beyond(double Omega) {
  const OwnFrequency::Matrices at = at_frequency(Omega);
  const OwnFrequency::Range range = own_->range(at);
  la::ModeOptions far = la_options(options_, {}, false);
  far.certify = far.growing = far.real_roots = false;
  far.count = 0;
  far.max_frequency = range.held ? quiet_held_ : std::min(quiet_held_, range.high);
  OwnFrequency beyond(linear_.system().pattern(), motion_.active(), far, own_->frequencies());
  std::vector<la::Mode> growing;
  const auto take = [&](const la::Mode& m) {
    const auto same = [&m](const WhirlMode& k) {
      return std::abs(k.lambda - m.lambda) <= 1e-7 * std::abs(m.lambda);
    };
    const bool listed = std::any_of(modes_.begin(), modes_.end(), same);
    if (m.lambda.real() > rounding_of(m) && !listed) growing.push_back(m);
  };
  for (const la::Mode& m : beyond.solve(at))
    take(m);
  if (options_.real_roots) {
    SpectrumCertificate at_rest;
    for (const la::Mode& m : judged(own_matrices(Omega, 0.0), Omega, at_rest))
      if (m.lambda.imag() == 0.0) take(m);
  }
  for (const la::Mode& m : growing) {
    modes_.push_back(describe_mode(m, own_matrices(Omega, m.lambda), linear_));
    modes_.back().from = -1;
    if (options_.continued && m.lambda.imag() != 0.0)
      modes_.back().continued = own_->continued(at, m);
  }
  std::stable_sort(modes_.begin(), modes_.end(), [](const WhirlMode& a, const WhirlMode& b) {
    return a.frequency < b.frequency;
  });
}

void WhirlSolver::solve_hysteretic(double Omega) {
  // Forward and backward whirl of one frequency are any two motions of their plane until the
  // damping tells them apart.
  std::vector<la::Mode> known = by_frequency()
                                    ? own_->solve(at_frequency(Omega))
                                    : solver_.solve(matrices_at(Omega, Complex(0, infinity))),
                        group;
  for (const la::Mode& mode : known)
    if (mode.lambda.imag() == 0.0) modes_.push_back(describe_mode(mode, *matrices_, linear_));
  std::erase_if(known, [](const la::Mode& mode) { return mode.lambda.imag() == 0.0; });
  // Coefficients against frequency keep modes apart that are not of one frequency, and may change
  // much between them.
  const double close = by_frequency() ? 1e-4 : 0.05;
  std::vector<la::Mode> own;  // two starts may lead to one mode
  for (std::size_t i = 0; i < known.size();) {
    group.clear();
    do
      group.push_back(known[i++]);
    while (i < known.size() && group.size() < 6 &&
           std::abs(known[i].lambda - known[i - 1].lambda) < close * std::abs(known[i].lambda));
    if (group.size() > 1) separate(Omega, group);
    for (const la::Mode& mode : group) {
      const auto settled = settle_rate(Omega, mode);
      if (!settled && options_.certify) continue;  // the count says whether it is missed
      if (!settled)
        throw run_error("E77",
                        fmt::format("hysteretic damping: a whirl mode was lost on the way to its "
                                    "own frequency at {:.6g} rpm",
                                    to_rpm(Omega)),
                        "use a smaller internal_loss_factor, or internal_beta");
      const bool oscillates = settled->lambda.imag() != 0.0;
      if (oscillates && !add_new(*settled, own)) continue;
      modes_.push_back(describe_mode(*settled, *matrices_, linear_));
    }
  }
  std::stable_sort(modes_.begin(), modes_.end(), [](const WhirlMode& a, const WhirlMode& b) {
    return a.frequency < b.frequency;
  });
  if (options_.certify) count_hysteretic(Omega);
  Index oscillating = 0;
  std::erase_if(modes_, [&](const WhirlMode& m) {
    return options_.count > 0 && m.oscillates() && ++oscillating > options_.count;
  });
}

void WhirlSolver::count_hysteretic(double Omega) {
  la::WedgeProblem p;
  for (const WhirlMode& m : modes_)  // ascending
    if (m.oscillates()) p.known.push_back(m.lambda);
  if (p.known.empty()) return;
  // The list ends in a gap above the modes wanted.
  const std::size_t wanted = options_.count > 0 ? static_cast<std::size_t>(options_.count) : 0;
  std::size_t last = p.known.size() - 1;
  if (wanted > 0 && wanted < p.known.size()) last = wanted - 1;
  while (last + 1 < p.known.size() && p.known[last + 1].imag() < p.known[last].imag() * (1 + 1e-6))
    ++last;
  const double end = p.known[last].imag();
  double next = last + 1 < p.known.size() ? p.known[last + 1].imag() : infinity;
  if (wanted == 0) next = std::min(next, std::max(2.0 * options_.max_frequency - end, end * 1.02));
  const double top = end + 0.5 * std::min(next - end, 0.1 * end);
  const double low = 0.02 * p.known.front().imag();
  p.reach = la::oscillating_reach;
  if (by_frequency()) p.stations = own_->frequencies();
  std::vector<double> edges{low};
  for (const double ratio : linear_.running().running().ratio)
    if (const double spin = std::abs(ratio * Omega); spin > low && spin < top)
      edges.push_back(spin);
  edges.push_back(top);
  std::sort(edges.begin(), edges.end());
  if (!wedge_) wedge_.emplace(linear_.system().pattern(), motion_.active());
  la::Certificate& list = certificate_.list;
  list = {};
  for (std::size_t k = 1; k < edges.size(); ++k) {
    constexpr double beside = 1e-6;
    p.low = k == 1 ? low : edges[k - 1] * (1.0 + beside);
    p.top = k + 1 == edges.size() ? top : edges[k] * (1.0 - beside);
    if (!(p.low < p.top)) continue;
    p.at = [&](Complex s) -> const la::MCK& {
      const double w = std::clamp(s.imag(), p.low, p.top);
      return matrices_at(Omega, Complex(s.real(), w), w, by_frequency() ? w : nan);
    };
    const la::WedgeCount c = wedge_->count(p);
    list.factorizations += c.factorizations;
    if (!c.certain) return;
    list.missing += c.unknown;
    if (c.unknown > 0) list.where.emplace_back(0.0, 0.5 * (p.low + p.top));
  }
  // A mode at the speed of its shaft is a root on neither side: one too many.
  if (list.missing < 0) return;
  list.counted = true;
  list.radius = top;
  list.reach = p.reach * top;
  certificate_.by_frequency = SpectrumCertificate::ByFrequency{low, 0};
  certificate_.open.clear();
  certificate_.unsettled = false;
}

/// Where nothing grows any more, no further than can be searched.
std::optional<GrowthBound::Quiet> WhirlSolver::quiet_above(const la::MCK& m, double reached) {
  const double near = furthest_search * reached;
  if (const auto quiet = bound_->first(m, reached, near)) return quiet;
  const auto few_below = [this](double w) {
    const auto modes = bound_->modes_below(w);
    return modes && *modes <= few_modes;
  };
  if (!few_below(2.0 * near)) return std::nullopt;
  const auto quiet = bound_->first(m, 2.0 * near, search_of_few * reached);
  if (!quiet || !few_below(quiet->above)) return std::nullopt;
  return quiet;
}

const std::vector<la::Mode>& WhirlSolver::judged(const la::MCK& m, double Omega,
                                                 SpectrumCertificate& known) {
  const std::vector<la::Mode>* modes = &solver_.solve(m);
  known.list = solver_.certificate();
  if (!options_.judge || !options_.damped) return *modes;
  if (!bound_) bound_.emplace(linear_.system().pattern(), motion_.active());
  const double reached = known.list.radius;
  const auto quiet = quiet_above(m, reached);
  if (quiet) {
    known.quiet_above = quiet->above;
    known.quiet_ratio = quiet->ratio;
  }
  // Where nothing excludes growth at high frequencies, at least those that rotors whirl at, and
  // those that controllers act at, are searched.
  const double at_speed =
      std::max(whirl_of_speed * std::abs(Omega),
               beyond_bandwidth * linear_.running().running().control_bandwidth);
  const auto fastest = solver_.fastest_root();
  constexpr double beyond_all = 100.0;  // and nothing is counted between the fastest and there
  const double wanted =
      quiet ? quiet->above : std::max(at_speed, beyond_all * fastest.value_or(0.0));
  if (wanted > reached) {
    std::vector<la::Mode> shorter = *modes;
    modes = &solver_.solve_to(m, wanted);
    const bool grows = std::any_of(modes->begin(), modes->end(), [](const la::Mode& mode) {
      return mode.lambda.real() > rounding_of(mode);
    });
    if (known.list.complete() && !solver_.certificate().complete() && !grows) {
      // the list asked for is complete: further up it is not known whether anything grows
      shorter_ = std::move(shorter);
      return shorter_;
    }
    known.list = solver_.certificate();
  }
  if (!quiet && fastest && known.list.complete()) {
    known.quiet_above = known.list.radius;  // no root is faster
    known.quiet_ratio = 0.0;
  }
  return *modes;
}

void WhirlSolver::solve_counted(double Omega) {
  const la::MCK& m = matrices_at(Omega, Complex(0, nan));
  for (const la::Mode& mode : judged(m, Omega, certificate_))
    modes_.push_back(describe_mode(mode, m, linear_));
  // a free motion, a double root at zero, that came out as large as rounding of what is fastest here
  constexpr double of_the_fastest = 1e-12;
  const double radius = certificate_.list.radius;
  for (WhirlMode& mode : modes_)
    if (std::isfinite(radius)) mode.rounding = std::max(mode.rounding, of_the_fastest * radius);
}

void WhirlSolver::count_along_axis(double Omega, const la::Certificate& rest) {
  const OwnFrequency::Matrices at = at_frequency(Omega);
  const OwnFrequency::Range range = own_->range(at);
  const la::MCK held = at(range.high);
  SpectrumCertificate of_held;
  la::AxisProblem p;
  p.held = &held;
  p.at = [&](double w) -> const la::MCK& { return at(std::clamp(w, range.low, range.high)); };
  p.stations = own_->frequencies();
  double slowest = infinity;
  const auto add = [&](Complex lambda, double rounding, std::vector<Complex>& to) {
    if (lambda.real() <= rounding) lambda.real(-std::abs(lambda.real()));
    if (lambda.imag() != 0.0) slowest = std::min(slowest, std::abs(lambda));
    to.push_back(lambda);
  };
  for (const la::Mode& m : judged(held, Omega, of_held))
    add(m.lambda, rounding_of(m), p.known_held);
  quiet_held_ = of_held.list.radius;
  for (const WhirlMode& m : modes_)
    add(m.lambda, m.rounding, p.known);
  // what is slower is left to the count with the coefficients of zero frequency
  p.rho = 0.1 * std::min(slowest, std::max(range.high, 1.0));
  p.top = std::max(range.high, 2.0 * p.rho);
  if (!axis_) axis_.emplace(linear_.system().pattern(), motion_.active());
  const la::AxisCount c = axis_->count(p);
  SpectrumCertificate::Axis& out = certificate_.axis.emplace(SpectrumCertificate::Axis{});
  out.counted = c.certain && of_held.stability_certain() && rest.complete();
  out.unknown = c.unknown;
  out.held_beyond = range.held && range.low == 0.0;
  out.top = range.high;
  out.factorizations = c.factorizations;
  at(range.low);
}

const std::vector<WhirlMode>& WhirlSolver::solve(double Omega) {
  WHIRL_EXPECTS(std::isfinite(Omega));
  modes_.clear();
  certificate_ = {};
  if (options_.damped && linear_.hysteretic()) {
    certificate_.open =
        "hysteretic damping depends on the frequency of each mode (each followed to its own "
        "frequency), and the count of its modes did not settle";
    certificate_.unsettled = options_.certify;
    if (!options_.certify) certificate_.open = "not asked for";
    solve_hysteretic(Omega);
  } else if (by_frequency()) {
    if (!options_.certify) certificate_.open = "not asked for";
    solve_by_frequency(Omega);
  } else {
    if (!options_.certify) certificate_.open = "not asked for";
    solve_counted(Omega);
  }
  separate_pairs(Omega != 0.0);
  return modes_;
}

void WhirlSolver::separate_pairs(bool turning) {
  constexpr double same = 1e-8;
  for (std::size_t k = 0; k + 1 < modes_.size(); ++k) {
    WhirlMode &a = modes_[k], &b = modes_[k + 1];
    const bool lateral = a.kind == ModeKind::lateral && b.kind == ModeKind::lateral;
    if (!lateral || a.frequency == 0.0 ||
        !(std::abs(a.lambda - b.lambda) < same * std::abs(a.lambda)))
      continue;
    separate_pair(linear_, turning, a, b);
    ++k;
  }
}

std::optional<WhirlMode> WhirlSolver::follow(double Omega, const WhirlMode& start) {
  la::Mode from;
  from.lambda = start.lambda;
  from.x = start.x;
  std::optional<la::Mode> found;
  if (options_.damped && linear_.hysteretic())
    found = settle_rate(Omega, from);
  else if (by_frequency() && from.lambda.imag() != 0.0)
    found = own_->settle(at_frequency(Omega), from);
  else if (by_frequency())
    found = solver_.follow(own_->reaches_zero(at_frequency(Omega))
                               ? at_frequency(Omega)(0.0)
                               : matrices_at(Omega, Complex(0, nan)),
                           from);
  else
    found = solver_.follow(matrices_at(Omega, Complex(0, nan)), from);
  if (!found || likeness(*matrices_, found->x, start.x) < 0.3)
    return std::nullopt;  // a planar start and the circle it becomes are 0.5 alike
  return describe_mode(*found, *matrices_, linear_);
}

std::vector<WhirlMode> whirl_modes(Linearizer& linear, double Omega, const ModesOptions& options,
                                   SpectrumCertificate* certificate) {
  WhirlSolver solver(linear, options);
  std::vector<WhirlMode> modes = solver.solve(Omega);
  if (certificate) *certificate = solver.certificate();
  return modes;
}

}  // namespace whirl::analysis
