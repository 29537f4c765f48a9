#include <analysis/spectra/passing_growth.hpp>

#include <analysis/spectra/whirl_modes.hpp>
#include <core/contract.hpp>
#include <core/error.hpp>
#include <la/multiply.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>

namespace whirl::analysis {

namespace {

/// Samples of one pass: twice the multiples at least, and enough that none of them is taken for another.
constexpr int samples_of_a_pass = 32;

/// A motion and what its amplitude is divided by.
struct Shape {
  double frequency = 0, growth = 0;
  VecXc x;
  Complex slope;  ///< x^H (2 lambda M + C) x
};

/// What two motions have in common with one multiple of what passes.
struct Pair {
  std::size_t parts = 0;
  int multiple = 1;
  std::size_t i = 0, j = 0;  ///< in the order of their frequencies
};

class PassingSearch {
 public:
  PassingSearch(Linearizer& linear, const std::vector<PassingParts>& parts, const Campbell& diagram,
                const PassingOptions& options)
      : linear_(linear),
        parts_(parts),
        diagram_(diagram),
        options_(options),
        solver_(linear, modes_of(options)),
        workspace_(linear.system().make_workspace()),
        matrices_(linear.system().make_matrices()) {
    for (const PassingParts& p : parts) {
      blocks_.push_back(linear.system().blocks_of(p.terms));
      std::vector<Index>& own = nodes_.emplace_back();
      for (const auto& between : p.nodes)
        std::copy_if(between.begin(), between.end(), std::back_inserter(own),
                     [](Index n) { return n >= 0; });
      std::sort(own.begin(), own.end());
      own.erase(std::unique(own.begin(), own.end()), own.end());
    }
  }

  const std::vector<Shape>& shapes_at(double Omega) {
    if (speed_ == Omega) return shapes_;
    speed_ = Omega;
    joined_.assign(parts_.size(), {});
    shapes_ = drawn_at(Omega);
    if (shapes_.size() < at(options_.modes)) shapes_ = found_at(Omega);
    const la::MCK& m = linear_.at(Omega);
    VecXc y;
    for (Shape& s : shapes_) {
      la::multiply(m.M, s.x, y);
      s.slope = 2.0 * Complex(s.growth, s.frequency) * s.x.dot(y);
      la::multiply(m.C, s.x, y);
      s.slope += s.x.dot(y);
    }
    return shapes_;
  }

  /// How far the multiple is from the sum of the frequencies, rad/s.
  double detuning(double Omega, const Pair& p) {
    const std::vector<Shape>& s = shapes_at(Omega);
    return p.multiple * parts_[p.parts].rate * std::abs(Omega) - s[p.i].frequency -
           s[p.j].frequency;
  }

  /// Growth of the two at a detuning, 1/s; below zero: nothing grows.
  double growth(double Omega, const Pair& p, double detuned) {
    const std::vector<Shape>& s = shapes_at(Omega);
    const Complex forth = coupling(p, p.i, p.j), back = std::conj(coupling(p, p.j, p.i));
    const Complex own = s[p.i].growth, other = Complex(s[p.j].growth, detuned);
    const Complex half = 0.5 * (own - other), root = std::sqrt(half * half + forth * back);
    return 0.5 * (own + other).real() + std::abs(root.real());
  }

  /// What passes adds to the growth where neither decays, 1/s.
  double strength(double Omega, const Pair& p) {
    shapes_at(Omega);
    return std::sqrt(std::abs(coupling(p, p.i, p.j) * coupling(p, p.j, p.i)));
  }

  bool has(double Omega, const Pair& p) { return shapes_at(Omega).size() > std::max(p.i, p.j); }

 private:
  static ModesOptions modes_of(const PassingOptions& options) {
    ModesOptions o;
    o.count = options.modes;
    o.certify = false;
    return o;
  }
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }

  /// The slowest that oscillate, without their slopes.
  std::vector<Shape> found_at(double Omega) {
    std::vector<Shape> out;
    for (const WhirlMode& mode : solver_.solve(Omega))
      if (mode.oscillates() && out.size() < at(options_.modes))
        out.push_back({mode.frequency, mode.lambda.real(), mode.x, {}});
    return out;
  }
  std::vector<Shape> drawn_at(double Omega) {
    std::vector<Shape> out;
    const auto& known = diagram_.speeds;
    const auto it = std::find(known.begin(), known.end(), Omega);
    if (it == known.end()) return out;
    const auto k = static_cast<std::size_t>(it - known.begin());
    for (const CampbellLine& l : diagram_.lines)
      if (!std::isnan(l.frequency[k]))
        out.push_back({l.frequency[k], l.lambda[k].real(), l.shape[k], {}});
    std::sort(out.begin(), out.end(),
              [](const Shape& a, const Shape& b) { return a.frequency < b.frequency; });
    if (out.size() > at(options_.modes)) out.resize(at(options_.modes));
    return out;
  }

  /// c_ij.
  Complex coupling(const Pair& p, std::size_t i, std::size_t j) {
    std::vector<MatXc>& all = joined_[p.parts];
    if (all.empty()) join(p.parts, all);
    const MatXc& joined = all[static_cast<std::size_t>(p.multiple - 1)];
    return -0.5 * joined(static_cast<Index>(i), static_cast<Index>(j)) / shapes_[i].slope;
  }

  /// x_i^H conj(K_h) conj(x_j) of all motions, of each multiple, while parts pass about the equilibrium of
  /// the mean.
  void join(std::size_t k, std::vector<MatXc>& out) {
    const auto n = static_cast<Index>(shapes_.size());
    const std::vector<Index>& nodes = nodes_[k];
    MatXc shapes(6 * static_cast<Index>(nodes.size()), n);
    for (Index i = 0; i < n; ++i)
      for (std::size_t own = 0; own < nodes.size(); ++own)
        shapes.col(i).segment<6>(6 * static_cast<Index>(own)) =
            shapes_[at(i)].x.segment<6>(6 * nodes[own]);
    out.assign(static_cast<std::size_t>(options_.multiples), MatXc::Zero(n, n));
    for (int sample = 0; sample < samples_of_a_pass; ++sample) {
      const double theta = two_pi * sample / samples_of_a_pass;
      const MatX K = stiffness_of(k, (speed_ < 0 ? -theta : theta) / parts_[k].rate);
      const MatXc at_hand = shapes.adjoint() * (K * shapes.conjugate());
      for (int h = 1; h <= options_.multiples; ++h)
        out[static_cast<std::size_t>(h - 1)] +=
            2.0 / samples_of_a_pass * std::polar(1.0, -h * theta) * at_hand;
    }
  }

  /// Of the parts with the reference turned by an angle, rad, on their nodes.
  MatX stiffness_of(std::size_t k, double turned) {
    const system::System& system = linear_.system();
    const SteadySystem& running = linear_.running();
    const system::State& e = linear_.equilibrium().state;
    VecX q = e.q;
    for (Index i = 0; i < system.nodes(); ++i)
      if (running.spinning()[at(i)])
        q[6 * i + system::spin_phi] += running.ratio(system.node(i).line) * turned;
    workspace_.context.averaged = false;
    if (!system.tangent_blocks(workspace_, e.frames, e.t, q, e.v, e.a, matrices_, parts_[k].terms,
                               blocks_[k]))
      throw run_error("E76", "the equilibrium lies outside the range of what passes", "");
    const std::vector<Index>& nodes = nodes_[k];
    const auto place = [&](Index node) {
      return 6 * (std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
    };
    MatX K = MatX::Zero(6 * static_cast<Index>(nodes.size()), 6 * static_cast<Index>(nodes.size()));
    for (const auto& between : parts_[k].nodes)
      for (const Index i : between)
        for (const Index j : between)
          if (const Index slot = i < 0 || j < 0 ? -1 : matrices_.K.pattern().slot(i, j); slot >= 0)
            K.block<6, 6>(place(i), place(j)) = matrices_.K.block(slot);
    return K;
  }

  Linearizer& linear_;
  const std::vector<PassingParts>& parts_;
  const Campbell& diagram_;
  PassingOptions options_;
  WhirlSolver solver_;
  system::Workspace workspace_;
  la::MCK matrices_;
  std::vector<std::vector<Index>> nodes_;       ///< of the parts, ascending
  std::vector<system::System::Blocks> blocks_;  ///< of their terms
  double speed_ = nan;
  std::vector<Shape> shapes_;
  std::vector<std::vector<MatXc>> joined_;  ///< of the parts, the multiples
};

/// Less than this of the sum of the frequencies is rounding of a motion without damping.
constexpr double undamped_share = 1e-6;

/// Where the multiple meets the sum of the frequencies, to within what changes the growth by little, between
/// two speeds at which it is on either side by `below` and `above`, rad/s. strength: what passes adds to the
/// growth, 1/s.
double meeting(PassingSearch& search, const Pair& p, double low, double high, double below,
               double above, double strength) {
  constexpr int rounds = 6;
  const double close = 0.05 * strength;  // a growth sqrt(strength^2 - detuning^2/4)
  double speed = low;
  for (int k = 0; k < rounds; ++k) {
    speed = low - below * (high - low) / (above - below);
    if (!search.has(speed, p)) break;
    const double here = search.detuning(speed, p);
    if (std::abs(here) < close || !(search.growth(speed, p, 0.0) > 0.0)) break;
    const bool left = (here < 0) == (below < 0);
    (left ? low : high) = speed;
    (left ? below : above) = here;
  }
  return speed;
}

void keep(std::vector<PassingGrowth>& out, const PassingGrowth& x) {
  const auto same = [&](const PassingGrowth& y) {
    constexpr double apart = 1e-3;
    return y.parts == x.parts && y.multiple == x.multiple &&
           std::abs(y.first - x.first) < apart * x.first &&
           std::abs(y.second - x.second) < apart * x.second;
  };
  const auto it = std::find_if(out.begin(), out.end(), same);
  if (it == out.end())
    out.push_back(x);
  else if (x.growth > it->growth)
    *it = x;
}

}  // namespace

std::vector<PassingGrowth> find_passing_growth(Linearizer& linear,
                                               const std::vector<PassingParts>& parts,
                                               const Campbell& diagram,
                                               const PassingOptions& options) {
  WHIRL_EXPECTS(!diagram.speeds.empty() && options.modes > 0 && options.multiples > 0);
  const std::vector<double>& speeds = diagram.speeds;
  std::vector<PassingGrowth> out;
  PassingSearch search(linear, parts, diagram, options);
  const auto look = [&](double Omega, const Pair& p) {
    if (Omega == 0.0 || !search.has(Omega, p)) return;
    const double growth = search.growth(Omega, p, search.detuning(Omega, p));
    const std::vector<Shape>& s = search.shapes_at(Omega);
    constexpr double more = 1.01;  // what grows without anything that passes is none of it
    const double alone = std::max(s[p.i].growth, s[p.j].growth);
    if (!(growth > undamped_share * (s[p.i].frequency + s[p.j].frequency)) ||
        !(growth > more * alone))
      return;
    keep(out, {p.parts, Omega, growth, s[p.i].frequency, s[p.j].frequency, p.multiple});
  };
  const auto for_each_pair = [&](std::size_t motions, const auto& f) {
    for (std::size_t k = 0; k < parts.size(); ++k)
      for (int h = 1; h <= options.multiples; ++h)
        for (std::size_t i = 0; i < motions; ++i)
          for (std::size_t j = i; j < motions; ++j)
            f(Pair{k, h, i, j});
  };
  std::vector<std::vector<double>> known;  // frequencies at the speeds
  const auto off = [&](std::size_t n, const Pair& p) {
    return p.multiple * parts[p.parts].rate * std::abs(speeds[n]) - known[n][p.i] - known[n][p.j];
  };
  struct Between {
    std::size_t n;  ///< the speed behind
    Pair pair;
    double strength;
  };
  std::vector<Between> met;
  for (std::size_t n = 0; n < speeds.size(); ++n) {
    const std::vector<Shape>& s = search.shapes_at(speeds[n]);
    known.emplace_back();
    for (const Shape& x : s)
      known.back().push_back(x.frequency);
    for_each_pair(s.size(), [&](const Pair& p) {
      const double sum = known[n][p.i] + known[n][p.j];
      constexpr double near = 0.05;  // of the sum; farther off only no small change makes grow
      if (std::abs(off(n, p)) < near * sum) look(speeds[n], p);
      const bool before = n > 0 && known[n - 1].size() > std::max(p.i, p.j);
      if (!before || (off(n, p) < 0) == (off(n - 1, p) < 0)) return;
      // where the two meet they grow if what passes exceeds the geometric mean of their decays
      const auto decay = [&](const Shape& x) {
        return std::max(-x.growth, undamped_share * x.frequency);
      };
      const double strength = search.strength(speeds[n], p);
      // half of what damping takes is not there: what changes between the speeds makes it no more
      constexpr double half = 0.5;
      if (strength > half * std::sqrt(decay(s[p.i]) * decay(s[p.j])))
        met.push_back({n, p, strength});
    });
  }
  for (const Between& b : met)
    look(meeting(search, b.pair, speeds[b.n - 1], speeds[b.n], off(b.n - 1, b.pair),
                 off(b.n, b.pair), b.strength),
         b.pair);
  std::sort(out.begin(), out.end(),
            [](const PassingGrowth& a, const PassingGrowth& b) { return a.growth > b.growth; });
  return out;
}

}  // namespace whirl::analysis
