// Where the steady motions of a rotor whose matrices turn with it have their peaks. Their matrices, of
// harmonic balance, are real functions H(Omega) of the speed, and H(Omega) x = 0 is an eigenvalue problem of
// the speed: quadratic where nothing but gyroscopic and circulatory forces depends on it.
#include <analysis/spectra/rotating_axes.hpp>

#include <la/eigen.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace whirl::analysis {

struct RotatingAxes::Steady {
  const la::BlockPattern& pattern;
  std::span<const unsigned char> active;
  const std::vector<Index>& orders;
  bool of_weight;  ///< multiples(); else response()
  std::function<const la::MCK&(double)> at;
};

namespace {

/// The matrix as a polynomial of what the speed is off the middle by, through three speeds.
la::MCK expand(const std::function<const la::MCK&(double)>& at, const la::BlockPattern& pattern,
               double middle, double step) {
  la::MCK out(pattern);
  const la::BlockMatrix<6> low = at(middle - step).K, high = at(middle + step).K;
  out.K = at(middle).K;
  for (std::size_t i = 0; i < out.K.value_count(); ++i) {
    const double l = low.data()[i], h = high.data()[i], k = out.K.data()[i];
    out.C.data()[i] = (h - l) / (2.0 * step);
    out.M.data()[i] = (h - 2.0 * k + l) / (2.0 * step * step);
  }
  return out;
}

/// Shares of a motion in the circles that its forces drive, and in those that are seen as the first multiples
/// of the speed in fixed axes.
struct Shares {
  double driven = 0, seen = 0;
};

/// What turns with the rotor stands in the axes; that of fixed direction, which meets stiffness or inertia that
/// turns, makes circles of once a revolution there.
/// arm: m, at which tilts are displacements.
Shares shares_of(const VecXc& x, const std::vector<Index>& orders, const Linearizer& linear,
                 bool of_weight, double arm) {
  const system::Frames& frames = linear.equilibrium().state.frames;
  const Complex i(0, 1);
  double driven = 0, seen = 0, all = 0;
  const auto add = [&](double size, Index order) {  // turns at this multiple of the axes' speed
    all += size;
    if (std::abs(order) == (of_weight ? 1 : 0)) driven += size;
    const Index multiple = std::abs(order + 1);
    if (of_weight ? multiple == 2 || multiple == 3 : multiple == 1) seen += size;
  };
  const Index parts = count_parts(orders);
  for (const VecXc& v : {x, VecXc(x.conjugate())})  // its real and its imaginary part
    for (Index n = 0; n < linear.system().nodes(); ++n) {
      if (linear.system().node(n).scalar) continue;
      const auto displacement = [&](Index part) {
        const Eigen::Vector3cd u = v.segment<3>(6 * (parts * n + part));
        const Eigen::Vector3cd along = frames.axes(n).transpose() * u;
        return Complex(along[1] + i * along[2]);
      };
      const auto tilt = [&](Index part) {
        const Eigen::Vector2cd g = v.segment<2>(6 * (parts * n + part) + system::gamma2);
        return Complex(arm * (g[0] + i * g[1]));
      };
      const auto add_circles = [&](const auto& circle) {
        Index part = 0;
        for (const Index m : orders) {
          const Complex c = circle(part++);
          if (m == 0) {
            add(std::norm(c), 0);
            continue;
          }
          const Complex d = circle(part++);
          add(0.25 * std::norm(c - i * d), m);
          add(0.25 * std::norm(c + i * d), -m);
        }
      };
      add_circles(displacement);
      add_circles(tilt);
    }
  return all > 0 ? Shares{driven / all, seen / all} : Shares{};
}

/// Whether a peak stands out of what is beside it: the part of the motion that is driven and seen, times its
/// amplification.
bool is_seen(Complex pole, const Shares& shares) {
  constexpr double enough = 0.3, undamped = 1e-6;
  const double ratio = std::max(pole.imag() / std::abs(pole), undamped);
  return std::sqrt(shares.driven * shares.seen) > enough * ratio &&
         pole.imag() < std::abs(pole.real());
}

}  // namespace

void RotatingAxes::find_poles(const Steady& of, double low, double high,
                              std::vector<Complex>& out) {
  const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
  la::ModeOptions l;
  l.count = 0;
  l.max_frequency = 1.1 * half;
  const la::MCK on_piece = expand(of.at, of.pattern, middle, half);
  const std::vector<la::Mode> found = la::quadratic_modes(on_piece, of.active, l);
  const bool exact = linear_.running().quadratic_in_speed() && !hysteretic();
  la::ModeSolver solver(of.pattern, of.active, l);
  for (la::Mode x : found) {
    constexpr double margin = 0.1;  // of the piece
    if (std::abs(x.lambda.real()) > (1.0 + margin) * half) continue;
    Complex pole = middle + x.lambda;
    const auto seen = [&] {
      return is_seen(pole, shares_of(x.x, of.orders, linear_, of.of_weight, arm_));
    };
    if (!seen()) continue;
    for (int round = 0; round < 4 && !exact; ++round) {
      constexpr double near = 1e-4, settled = 1e-8;
      const double step = std::clamp(std::abs(pole.imag()), near * half, half);
      const double from = std::clamp(pole.real(), low + step, high - step);
      x.lambda = pole - from;
      const auto next = solver.follow(expand(of.at, of.pattern, from, step), x);
      if (!next) break;
      x = *next;
      const Complex moved = from + x.lambda;
      const double change = std::abs(moved - pole);
      pole = moved;
      if (change <= settled * std::abs(pole)) break;
    }
    if (pole.real() < low || pole.real() > high) continue;
    if (seen()) out.push_back(pole);
  }
}

std::vector<Complex> RotatingAxes::poles(double low, double high) {
  std::vector<Complex> out;
  if (!(high > low)) return out;
  at_odd(low);
  const std::vector<Index> even = orders();
  const Steady turned{*pattern_, active_, even, false,
                      [this](double Omega) -> const la::MCK& { return at(Omega); }};
  const Steady weighed{*odd_pattern_, odd_active_, odd_, true,
                       [this](double Omega) -> const la::MCK& { return at_odd(Omega); }};
  const int pieces = linear_.running().quadratic_in_speed() ? 1 : 8;
  for (int k = 0; k < pieces; ++k) {
    const double from = low + (high - low) * k / pieces, to = low + (high - low) * (k + 1) / pieces;
    for (const Steady& motion : {turned, weighed})
      find_poles(motion, from, to, out);
  }
  std::sort(out.begin(), out.end(), [](Complex a, Complex b) {
    return a.real() != b.real() ? a.real() < b.real() : a.imag() < b.imag();
  });
  constexpr double apart = 1e-9;
  out.erase(std::unique(out.begin(), out.end(),
                        [](Complex a, Complex b) { return std::abs(b - a) < apart * std::abs(b); }),
            out.end());
  return out;
}

}  // namespace whirl::analysis
