#include <analysis/linearizer.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <core/interrupt.hpp>
#include <la/direct.hpp>

#include <fmt/format.h>

#include <memory>
#include <optional>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {
constexpr std::size_t at_(Index i) { return static_cast<std::size_t>(i); }

/// Largest force and largest moment of the free unknowns.
Vec2 largest(const VecX& r, std::span<const unsigned char> free) {
  Vec2 m = Vec2::Zero();
  for (Index k = 0; k < r.size(); ++k)
    if (free[at_(k)]) {
      double& x = m[k % 6 < 3 ? 0 : 1];
      x = std::max(x, std::abs(r[k]));
    }
  return m;
}
}  // namespace

Linearizer::Linearizer(const system::System& system, SteadyRotation running,
                       EquilibriumOptions options)
    : running_(system, std::move(running)),
      options_(options),
      solver_(running_, options_),
      matrices_(system.make_matrices()) {}

Linearizer::Linearizer(const Linearizer& other)
    : Linearizer(other.system(), other.running_.running(), other.options_) {
  first_ = other.first_;
  if (other.undeformed_) stay_undeformed();
  running_.take_polynomials(other.running_);
  if (other.have_) set_equilibrium(other.equilibrium_);
}

void Linearizer::set_equilibrium(const Equilibrium& e) {
  WHIRL_EXPECTS(e.state.q.size() == system().size());
  equilibrium_ = e;
  have_ = true;
  current_ = have_forcing_ = false;
  balanced_load_ = running_.load();
  running_.residual(e.state.frames, e.Omega, e.state.q, r_);
  floor_ = largest(r_, solver_.free());
}

void Linearizer::stay_undeformed() {
  undeformed_ = true;
  have_ = current_ = false;
  running_.set_load(0.0);
}

void Linearizer::take_undeformed(double Omega) {
  equilibrium_ = Equilibrium();
  equilibrium_.Omega = Omega;
  equilibrium_.state = system().make_state();
  system::State& s = equilibrium_.state;
  s.t = running_.running().time;
  running_.impose(s.frames, s.q);
  running_.set_rates(Omega, s.v);
  s.a.setZero();
  relax_axially();
  system().follow(s);
  equilibrium_.reactions = VecX::Zero(system().size());
  solver_.list_holds(s, equilibrium_);
  have_ = true;
  current_ = have_forcing_ = false;
  balanced_load_ = running_.load();
}

void Linearizer::relax_axially() {
  std::vector<unsigned char> axial(solver_.free().begin(), solver_.free().end());
  for (Index k = 0; k < system().size(); ++k)
    if (k % 6 != system::ux || system().node(k / 6).scalar) axial[at_(k)] = 0;
  VecX& q = equilibrium_.state.q;
  std::unique_ptr<la::DirectSolver<double>> direct;
  constexpr int rounds = 20;  // shafts and linear supports need one
  for (int round = 0; round < rounds; ++round) {
    const system::Frames& frames = equilibrium_.state.frames;
    if (!running_.residual(frames, equilibrium_.Omega, q, r_)) break;
    for (Index k = 0; k < r_.size(); ++k)
      if (!axial[at_(k)]) r_[k] = 0.0;
    if (r_.isZero(0.0)) return;
    if (!running_.tangent(frames, equilibrium_.Omega, q, matrices_)) break;
    double stiffest = 0;
    for (Index k = 0; k < r_.size(); ++k)
      if (axial[at_(k)])
        stiffest =
            std::max(stiffest, std::abs(matrices_.K.block(system().pattern().diagonal(k / 6))(
                                   system::ux, system::ux)));
    constexpr double rounding = 1e-13;
    if (r_.lpNorm<Eigen::Infinity>() <= rounding * stiffest * solver_.length()) return;
    if (!direct) direct = la::make_direct_solver<double>(system().pattern(), axial);
    if (direct->factor(matrices_, 0.0, 0.0, 1.0) != la::Status::ok)
      throw run_error("E75",
                      "nothing resists the axial motion of the undeformed shaft, which heat or "
                      "preload puts under force",
                      "hold a place of it along x, or about = \"equilibrium\"",
                      fmt::format("node {}", direct->singular_unknown() / 6));
    direct->solve(r_);
    q -= r_;
    if (r_.norm() <= 1e-12 * q.norm()) return;
  }
  throw run_error("E76", "the axial forces of the undeformed shaft find no balance",
                  "about = \"equilibrium\"");
}

bool Linearizer::still_balanced(double Omega) {
  // A rotor in linear bearings keeps its equilibrium at every speed: then the residual stays at its
  // rounding level.
  if (!have_ || !system().keepers().empty() ||
      !running_.residual(equilibrium_.state.frames, Omega, equilibrium_.state.q, r_))
    return false;
  const Vec2 now = largest(r_, solver_.free());
  return now[0] <= 4.0 * floor_[0] && now[1] <= 4.0 * floor_[1];
}

void Linearizer::move_to(double Omega) {
  WHIRL_EXPECTS(std::isfinite(Omega));
  throw_if_interrupted();
  running_.set_whirl(0.0);
  running_.set_frequency(nan);
  if (have_ && Omega == equilibrium_.Omega && running_.load() == balanced_load_) {
    // One equilibrium at every frequency asked about, and its forcing.
    return;
  }
  if (undeformed_) {
    take_undeformed(Omega);
  } else if (still_balanced(Omega)) {
    equilibrium_.Omega = Omega;
    running_.set_rates(Omega, equilibrium_.state.v);
    equilibrium_.reactions = r_;
    for (Index k = 0; k < r_.size(); ++k)
      if (solver_.free()[at_(k)]) equilibrium_.reactions[k] = 0.0;
  } else {
    set_equilibrium(solver_.solve(Omega, have_    ? &equilibrium_.state
                                         : first_ ? &*first_
                                                  : nullptr));
  }
  have_forcing_ = false;
}

namespace {

/// The first node with an entry that is no number: a table was asked beyond its end there.
std::optional<Index> first_without_number(const la::MCK& m) {
  for (const la::BlockMatrix<6>* a : {&m.K, &m.C, &m.M}) {
    if (Eigen::Map<const VecX>(a->data(), static_cast<Index>(a->value_count())).allFinite())
      continue;
    const la::BlockPattern& p = a->pattern();
    for (Index i = 0; i < p.size(); ++i)
      if (!a->block(p.diagonal(i)).allFinite()) return i;
    return 0;
  }
  return std::nullopt;
}

}  // namespace

Linearizer::Asked Linearizer::asked(double Omega, Complex lambda, double side,
                                    double tables) const {
  constexpr double none = -1.0;  // NaN would differ from itself
  Asked a{Omega, running_.load(), 0.0, none, none, none};
  if (running_.hysteretic() && !std::isnan(lambda.imag())) {
    const double w = std::abs(lambda.imag());
    a[2] = lambda.real();
    a[3] = w;
    a[4] = std::isnan(side) ? w : side;
  }
  if (running_.running().frequency_dependent() && std::isfinite(tables)) a[5] = std::abs(tables);
  return a;
}

const la::MCK& Linearizer::at(double Omega, Complex lambda, double side, double tables) {
  move_to(Omega);
  const Asked now = asked(Omega, lambda, side, tables);
  if (current_ && now == made_for_) return matrices_;
  current_ = false;
  const auto linearise = [&] {
    running_.set_whirl(std::isnan(lambda.imag()) ? Complex(0) : lambda, false, side);
    const bool inside =
        running_.tangent(equilibrium_.state.frames, Omega, equilibrium_.state.q, matrices_);
    running_.set_whirl(0.0);
    running_.set_frequency(nan);
    if (!inside)
      throw run_error("E76", "no linearisation: the state lies outside the range of an element");
  };
  const bool of_tables = running_.running().frequency_dependent() && std::isfinite(tables);
  if (of_tables) running_.set_frequency(tables);
  linearise();
  if (const auto node = of_tables ? first_without_number(matrices_) : std::nullopt)
    throw run_error(
        "E81",
        fmt::format("a bearing table does not cover the frequency {:.6g} Hz at {:.6g} rpm",
                    to_hz(std::abs(tables)), to_rpm(Omega)),
        "extend its frequencies, narrow the range asked about, or write extrapolate = \"hold\"",
        system().node(*node).name);
  made_for_ = now;
  current_ = true;
  return matrices_;
}

const la::MCK& Linearizer::conservative_at(double Omega, double w) {
  at(Omega, Complex(0, infinity), nan, w);
  if (conservative_.M.value_count() == 0) conservative_ = system().make_matrices();
  take_conservative_part(matrices_, conservative_);
  return conservative_;
}

const std::vector<VecXc>& Linearizer::forcing() {
  WHIRL_EXPECTS(have_);
  if (!have_forcing_) {
    running_.forcing(equilibrium_.state.frames, equilibrium_.Omega, equilibrium_.state.q, forcing_);
    have_forcing_ = true;
  }
  return forcing_;
}

void take_conservative_part(const la::MCK& m, la::MCK& out) {
  WHIRL_EXPECTS(out.K.value_count() == m.K.value_count() && &out != &m);
  const la::BlockPattern& p = m.M.pattern();
  std::copy_n(m.M.data(), m.M.value_count(), out.M.data());
  for (Index i = 0; i < p.size(); ++i)
    for (Index s = p.row_start()[at_(i)]; s < p.row_start()[at_(i) + 1]; ++s) {
      const Index j = p.cols()[at_(s)], t = p.slot(j, i);
      out.C.block(s) = 0.5 * (m.C.block(s) - m.C.block(t).transpose());
      out.K.block(s) = 0.5 * (m.K.block(s) + m.K.block(t).transpose());
    }
}

}  // namespace whirl::analysis
