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
  for (const system::SeriesCompliance& c : linear.running().series()) {
    kinks_.resize(std::max(kinks_.size(), c.number + 1), Vec2::Zero());
    InSeries s;
    s.of = c;
    s.moment.resize(at(samples_));
    s.by_motion.resize(at(samples_));
    s.law.resize(at(samples_));
    series_.push_back(std::move(s));
  }
  in_series_ = linear.running().series_terms();
  if (!series_.empty()) make_fine_basis();
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

bool PeriodicResponse::look_at_series(double Omega, Index sample) {
  const system::System& s = linear_.system();
  const system::Frames& frames = linear_.equilibrium().state.frames;
  const double time = linear_.running().running().time;
  move(Omega, sample);
  if (!s.follow(frames, q_, v_, a_)) return false;
  std::fill(kinks_.begin(), kinks_.end(), Vec2::Zero());
  for (InSeries& c : series_)
    for (Index k = 0; k < 2; ++k) {
      kinks_[c.of.number][k] = 1.0;
      if (!s.residual(workspace_, frames, time, q_, v_, a_, r_, &in_series_)) return false;
      kinks_[c.of.number][k] = 0.0;
      for (Index i = 0; i < 2; ++i)
        c.by_motion[at(sample)].block<1, 6>(k, 6 * i) =
            -r_.segment<6>(6 * c.of.nodes[at(i)]).transpose();
    }
  for (InSeries& c : series_) {
    c.moment[at(sample)] = c.of.moment(workspace_);
    c.law[at(sample)] = c.of.law(workspace_);
  }
  return true;
}

namespace {

/// Of instant k of so many over the revolution.
double angle_of(Index k, Index of) {
  return two_pi * (static_cast<double>(k) + 0.5) / static_cast<double>(of);
}

/// From axes that have turned by this angle to those that stand.
Mat2 turn_of(double angle) {
  Mat2 out;
  out << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return out;
}

system::SeriesCompliance::Kink seen_standing(const system::SeriesCompliance::Law& law,
                                             const Vec2& moment, double angle) {
  const Mat2 turn = turn_of(angle);
  const system::SeriesCompliance::Kink k = law(turn.transpose() * moment);
  return {turn * k.angle, turn * k.slope * turn.transpose()};
}

}  // namespace

void PeriodicResponse::stand_still(InSeries& c) const {
  if (c.sense == 0.0) {
    // with that sense what the motion does to the moments stays the same
    const Index quarter = samples_ / 4;
    const auto distance = [&](double sense) {
      const Mat2 turn = turn_of(sense * (angle_of(quarter, samples_) - angle_of(0, samples_)));
      return (turn * c.by_motion[at(quarter)] - c.by_motion[0]).norm();
    };
    c.sense = distance(1.0) < distance(-1.0) ? 1.0 : -1.0;
  }
  for (Index n = 0; n < samples_; ++n) {
    const Mat2 turn = turn_of(c.sense * angle_of(n, samples_));
    c.moment[at(n)] = turn * c.moment[at(n)];
    c.by_motion[at(n)] = turn * c.by_motion[at(n)];
  }
}

void PeriodicResponse::make_fine_basis() {
  constexpr Index finer = 16;
  const Index instants = finer * samples_, kept = 2 * harmonics_ + 3;
  fine_basis_.resize(parts_, instants);
  for (Index j = 0; j < instants; ++j) {
    const double x = angle_of(j, instants);
    fine_basis_(0, j) = 1.0;
    for (Index h = 1; h <= harmonics_; ++h) {
      fine_basis_(2 * h - 1, j) = std::cos(static_cast<double>(h) * x);
      fine_basis_(2 * h, j) = std::sin(static_cast<double>(h) * x);
    }
  }
  // 1/instants sum_{|h| <= kept} cos h (x_j - x_n)
  smooth_.resize(instants, samples_);
  for (Index j = 0; j < instants; ++j)
    for (Index n = 0; n < samples_; ++n) {
      double sum = 1.0;
      for (Index h = 1; h <= kept; ++h)
        sum += 2.0 *
               std::cos(static_cast<double>(h) * (angle_of(j, instants) - angle_of(n, samples_)));
      smooth_(j, n) = sum / static_cast<double>(instants);
    }
}

void PeriodicResponse::find_kinks(const InSeries& c, const VecX& m,
                                  std::vector<system::SeriesCompliance::Kink>& kinks) const {
  kinks.resize(at(samples_));
  const Eigen::Map<const MatX> parts(m.data(), 2, parts_);
  if (!c.of.by_moment) {
    const MatX here = parts * basis_;
    for (Index n = 0; n < samples_; ++n)
      kinks[at(n)] = seen_standing(c.law[at(n)], here.col(n), c.sense * angle_of(n, samples_));
    return;
  }
  const MatX here = parts * fine_basis_;
  MatX fine(6, here.cols());
  for (Index j = 0; j < here.cols(); ++j) {
    const system::SeriesCompliance::Kink k =
        seen_standing(c.law.front(), here.col(j), c.sense * angle_of(j, here.cols()));
    fine.col(j) << k.angle, k.slope.col(0), k.slope.col(1);
  }
  const MatX smooth = fine * smooth_;
  for (Index n = 0; n < samples_; ++n) {
    kinks[at(n)].angle = smooth.col(n).head<2>();
    kinks[at(n)].slope << smooth.col(n).segment<2>(2), smooth.col(n).segment<2>(4);
  }
}

/// m + g P(dW/dm) - P(M), and the kinks at the samples.
VecX PeriodicResponse::moments_defect(const InSeries& c, const VecX& m,
                                      std::vector<system::SeriesCompliance::Kink>& kinks) const {
  find_kinks(c, m, kinks);
  VecX defect = m;
  for (Index n = 0; n < samples_; ++n) {
    const Vec2 off = c.of.stiffness * kinks[at(n)].angle - c.moment[at(n)];
    for (Index a = 0; a < parts_; ++a)
      defect.segment<2>(2 * a) += weight(a) * basis_(a, n) * off;
  }
  return defect;
}

namespace {

/// Of these compliances over the revolution, between the parts.
MatX mean_of(const std::vector<system::SeriesCompliance::Kink>& kinks, const MatX& basis) {
  const Index parts = basis.rows(), samples = basis.cols();
  MatX mean = MatX::Zero(2 * parts, 2 * parts);
  for (Index n = 0; n < samples; ++n)
    for (Index a = 0; a < parts; ++a) {
      const double share = (a == 0 ? 1.0 : 2.0) / static_cast<double>(samples) * basis(a, n);
      for (Index b = 0; b < parts; ++b)
        mean.block<2, 2>(2 * a, 2 * b) += (share * basis(b, n)) * kinks[at(n)].slope;
    }
  return mean;
}

}  // namespace

void PeriodicResponse::solve_moments(InSeries& c) const {
  constexpr int most_rounds = 60;
  constexpr double settled = 1e-12;
  const MatX one = MatX::Identity(2 * parts_, 2 * parts_);
  std::vector<system::SeriesCompliance::Kink> kinks;
  if (c.m.size() == 0) {
    c.m = VecX::Zero(2 * parts_);
    c.m = -moments_defect(c, c.m, kinks);  // as if it were shut
  }
  VecX defect = moments_defect(c, c.m, c.kink);
  for (int round = 0; round < most_rounds; ++round) {
    if (defect.norm() <= settled * c.m.norm()) break;
    const VecX step = (one + c.of.stiffness * mean_of(c.kink, basis_)).partialPivLu().solve(defect);
    double part = 1.0;
    VecX next = c.m - step, left = moments_defect(c, next, kinks);
    for (; !(left.norm() < defect.norm()) && part > 1e-4; part *= 0.5) {
      next = c.m - 0.5 * part * step;
      left = moments_defect(c, next, kinks);
    }
    if (!(left.norm() < defect.norm())) break;  // rounding
    c.m = next;
    defect = left;
    c.kink = kinks;
  }
}

/// Hill's matrix of what its kinks do as the moments follow the motion.
void PeriodicResponse::add_series(const InSeries& c) {
  MatX force = MatX::Zero(12 * parts_, 2 * parts_), moment = MatX::Zero(2 * parts_, 12 * parts_);
  for (Index n = 0; n < samples_; ++n) {
    const Eigen::Matrix<double, 2, 12>& B = c.by_motion[at(n)];
    const Eigen::Matrix<double, 12, 2> by_moment = -B.transpose() * c.kink[at(n)].slope;
    for (Index a = 0; a < parts_; ++a)
      for (Index b = 0; b < parts_; ++b) {
        force.block<12, 2>(12 * a, 2 * b) += (basis_(a, n) * basis_(b, n)) * by_moment;
        moment.block<2, 12>(2 * a, 12 * b) += (weight(a) * basis_(a, n) * basis_(b, n)) * B;
      }
  }
  const MatX give =
      MatX::Identity(2 * parts_, 2 * parts_) + c.of.stiffness * mean_of(c.kink, basis_);
  const MatX hill = force * give.partialPivLu().solve(moment);
  for (Index i = 0; i < 2; ++i)
    for (Index j = 0; j < 2; ++j)
      for (Index a = 0; a < parts_; ++a)
        for (Index b = 0; b < parts_; ++b)
          hill_.K.block(
              pattern_->slot(parts_ * c.of.nodes[at(i)] + a, parts_ * c.of.nodes[at(j)] + b)) +=
              hill.block<6, 6>(12 * a + 6 * i, 12 * b + 6 * j);
}

bool PeriodicResponse::balance(double Omega) {
  throw_if_interrupted();
  const system::System& s = linear_.system();
  const system::Frames& frames = linear_.equilibrium().state.frames;
  const double time = linear_.running().running().time;
  workspace_.context.kinks = kinks_;
  for (Index n = 0; n < samples_ && !series_.empty(); ++n)
    if (!look_at_series(Omega, n)) return false;
  for (InSeries& c : series_) {
    stand_still(c);
    solve_moments(c);
  }
  f_.setZero();
  for (Index n = 0; n < samples_; ++n) {
    move(Omega, n);
    if (!s.follow(frames, q_, v_, a_)) return false;
    for (const InSeries& c : series_)
      kinks_[c.of.number] =
          turn_of(c.sense * angle_of(n, samples_)).transpose() * c.kink[at(n)].angle;
    if (!s.residual(workspace_, frames, time, q_, v_, a_, r_)) return false;
    if (!s.tangent(workspace_, frames, time, q_, v_, a_, tangents_[at(n)])) return false;
    for (Index i = 0; i < s.nodes(); ++i)
      for (Index k = 0; k < parts_; ++k)
        f_.segment<6>(6 * (parts_ * i + k)) += basis_(k, n) * r_.segment<6>(6 * i);
  }
  assemble(linear_.running().orders()[0] * std::abs(Omega));
  for (const InSeries& c : series_)
    add_series(c);
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
  for (InSeries& c : series_) {
    c.m.resize(0);
    c.sense = 0.0;
  }
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
