#include <analysis/response/periodic_response.hpp>
#include <analysis/spectra/rotating_axes.hpp>
#include <analysis/statics/definiteness.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <core/interrupt.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

/// Relative size of the last correction: it converges quadratically but where a force has corners.
constexpr double close_enough = 1e-9;
constexpr int most_rounds = 60;

}  // namespace

PeriodicResponse::PeriodicResponse(Linearizer& linear, Index harmonics)
    : linear_(linear),
      harmonics_(harmonics),
      parts_(2 * harmonics + 1),
      samples_(8 * (harmonics + 2)),
      workspace_(linear.system().make_workspace()) {
  WHIRL_EXPECTS(harmonics > 0);
  RotatingAxes::require(linear.running());
  if (linear.hysteretic())
    throw run_error("E88",
                    "hysteretic damping of a rotor that breathes: it is known at one frequency at "
                    "a time, and the motion has several",
                    "viscous damping of the shaft (beta_internal) has no such limit");
  basis_.resize(parts_, samples_);
  rate_.resize(parts_, samples_);
  acceleration_.resize(parts_, samples_);
  for (Index n = 0; n < samples_; ++n) {
    // beside the quarters, where what breathes switches
    const double x = two_pi * (static_cast<double>(n) + 0.5) / static_cast<double>(samples_);
    basis_(0, n) = 1.0;
    rate_(0, n) = acceleration_(0, n) = 0.0;
    for (Index h = 1; h <= harmonics_; ++h) {
      const double k = static_cast<double>(h), c = std::cos(k * x), s = std::sin(k * x);
      basis_.col(n).segment<2>(2 * h - 1) << c, s;
      rate_.col(n).segment<2>(2 * h - 1) << -k * s, k * c;
      acceleration_.col(n).segment<2>(2 * h - 1) << -k * k * c, -k * k * s;
    }
  }
  workspace_.context.averaged = linear.running().running().mean;
  workspace_.context.hysteretic = linear.running().running().hysteretic;
  make_pattern();
}

void PeriodicResponse::make_pattern() {
  // node i, part k -> node parts i + k: neighbours stay neighbours
  const system::System& s = linear_.system();
  const la::BlockPattern& p = s.pattern();
  std::vector<std::pair<Index, Index>> couplings;
  for (Index i = 0; i < p.size(); ++i)
    for (Index b = p.row_start()[at(i)]; b < p.row_start()[at(i) + 1]; ++b)
      for (Index k = 0; k < parts_; ++k)
        for (Index l = 0; l < parts_; ++l)
          couplings.emplace_back(parts_ * i + k, parts_ * p.cols()[at(b)] + l);
  pattern_ = std::make_unique<la::BlockPattern>(parts_ * p.size(), couplings);
  hill_ = la::MCK(*pattern_);
  for (Index n = 0; n < samples_; ++n)
    tangents_.push_back(s.make_matrices());
  const auto spinning = linear_.running().spinning();
  for (Index i = 0; i < p.size(); ++i)
    for (Index k = 0; k < parts_; ++k)
      for (Index c = 0; c < 6; ++c) {
        const bool turns = c == system::spin_phi && spinning[at(i)];
        active_.push_back(turns ? 0 : s.active()[at(6 * i + c)]);
      }
  solver_ = la::make_direct_solver<double>(*pattern_, active_);
  x_ = VecX::Zero(6 * pattern_->size());
  f_ = x_;
  r_.resize(s.size());
}

void PeriodicResponse::move(double Omega, Index sample) {
  const system::System& s = linear_.system();
  const SteadySystem& running = linear_.running();
  const double order = running.orders()[0], w = order * std::abs(Omega);
  const double time =
      two_pi * (static_cast<double>(sample) + 0.5) / static_cast<double>(samples_) / w;
  q_ = linear_.equilibrium().state.q;
  v_.resize(s.size());
  running.set_rates(Omega, v_);
  q_ += time * v_;  // nothing else moves
  a_ = VecX::Zero(s.size());
  for (Index i = 0; i < s.nodes(); ++i)
    for (Index k = 0; k < parts_; ++k) {
      const auto part = x_.segment<6>(6 * (parts_ * i + k));
      q_.segment<6>(6 * i) += basis_(k, sample) * part;
      v_.segment<6>(6 * i) += w * rate_(k, sample) * part;
      a_.segment<6>(6 * i) += w * w * acceleration_(k, sample) * part;
    }
}

void PeriodicResponse::assemble(double w) {
  const la::BlockPattern& p = linear_.system().pattern();
  const MatX turned = basis_.transpose();  // samples x parts
  MatX of_part(36, samples_), blocks(36, parts_);
  for (Index i = 0; i < p.size(); ++i)
    for (Index b = p.row_start()[at(i)]; b < p.row_start()[at(i) + 1]; ++b) {
      const Index j = p.cols()[at(b)];
      for (Index l = 0; l < parts_; ++l) {
        for (Index n = 0; n < samples_; ++n) {
          const la::MCK& m = tangents_[at(n)];
          Eigen::Map<Matrix<6>>(of_part.col(n).data()) =
              basis_(l, n) * m.K.block(b) + (w * rate_(l, n)) * m.C.block(b) +
              (w * w * acceleration_(l, n)) * m.M.block(b);
        }
        blocks.noalias() = of_part * turned;
        for (Index k = 0; k < parts_; ++k)
          hill_.K.block(pattern_->slot(parts_ * i + k, parts_ * j + l)) =
              Eigen::Map<const Matrix<6>>(blocks.col(k).data());
      }
    }
}

bool PeriodicResponse::balance(double Omega) {
  throw_if_interrupted();
  const system::System& s = linear_.system();
  const system::Frames& frames = linear_.equilibrium().state.frames;
  const double time = linear_.running().running().time;
  f_.setZero();
  for (Index n = 0; n < samples_; ++n) {
    move(Omega, n);
    if (!s.follow(frames, q_, v_, a_)) return false;
    if (!s.residual(workspace_, frames, time, q_, v_, a_, r_)) return false;
    if (!s.tangent(workspace_, frames, time, q_, v_, a_, tangents_[at(n)])) return false;
    for (Index i = 0; i < s.nodes(); ++i)
      for (Index k = 0; k < parts_; ++k)
        f_.segment<6>(6 * (parts_ * i + k)) += basis_(k, n) * r_.segment<6>(6 * i);
  }
  assemble(linear_.running().orders()[0] * std::abs(Omega));
  for (Index k = 0; k < f_.size(); ++k)
    if (!active_[at(k)]) f_[k] = 0.0;
  return true;
}

double PeriodicResponse::size_of(const VecX& x) const {
  double most = 0.0;
  for (Index i = 0; i < pattern_->size(); ++i)
    if (!linear_.system().node(i / parts_).scalar)
      most = std::max(most, x.segment<3>(6 * i).cwiseAbs().maxCoeff());
  return most;
}

PeriodicMotion PeriodicResponse::solve(double Omega) {
  WHIRL_EXPECTS(Omega != 0.0);
  linear_.move_to(Omega);
  x_.setZero();
  PeriodicMotion out;
  double before = infinity;
  for (out.rounds = 1; out.rounds <= most_rounds; ++out.rounds) {
    if (!balance(Omega)) break;
    if (solver_->factor(hill_, 0.0, 0.0, 1.0) != la::Status::ok) break;
    VecX step = f_;
    solver_->solve(step);
    const double size = size_of(step);
    if (!std::isfinite(size)) break;
    // where a force has corners whole steps may go round in a circle
    x_ -= (out.rounds > 8 && size > 0.7 * before ? 0.5 : 1.0) * step;
    before = size;
    out.converged =
        size <= close_enough * std::max(size_of(x_), 1e-9 * model_length(linear_.system()));
    if (out.converged) break;
  }
  const bool converged = out.converged;
  const int rounds = out.rounds;
  out = result(Omega);
  out.converged = converged;
  out.rounds = rounds;
  return out;
}

PeriodicMotion PeriodicResponse::result(double Omega) const {
  const system::System& s = linear_.system();
  PeriodicMotion out;
  out.Omega = Omega;
  for (Index h = 0; h <= harmonics_; ++h) {
    VecXc a(s.size());
    for (Index i = 0; i < s.nodes(); ++i) {
      const auto part = [&](Index k) {
        return x_.segment<6>(6 * (parts_ * i + k)).cast<Complex>();
      };
      // c cos + d sin = Re((c - i d) exp(i x))
      a.segment<6>(6 * i) = part(h == 0 ? 0 : 2 * h - 1);
      if (h > 0) a.segment<6>(6 * i) -= Complex(0, 1) * part(2 * h);
    }
    s.complete(linear_.equilibrium().state, a);
    out.amplitude.push_back(std::move(a));
  }
  double most = 0.0, last = 0.0;
  for (Index h = 1; h <= harmonics_; ++h) {
    double size = 0.0;
    for (Index i = 0; i < s.nodes(); ++i)
      if (!s.node(i).scalar)
        size = std::max(size, out.amplitude[at(h)].segment<3>(6 * i).cwiseAbs().maxCoeff());
    most = std::max(most, size);
    last = size;
  }
  out.last_share = most > 0 ? last / most : 0.0;
  return out;
}

}  // namespace whirl::analysis
