// Orders of the speed from turns sampled at equal angles, by a filter that looks at several turns.
#pragma once
#include <analysis/transient/revolutions.hpp>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

namespace whirl::analysis {

/// Amplitudes of orders over several turns: x against the angle of the shaft, in a Hann window about
/// the middle of each turn,
///   X_k = 2 sum_p w_p x_p exp(-i k phi_p) / sum_p w_p,   w = 1 + cos(2 pi (phi - phi_m) / (2 pi M)).
/// Of M turns it lets half of an amplitude through that is 1/M orders away and nothing at 2/M, 3/M,
/// ... orders: with M = 4 halves of an order are told apart, and what beats over fewer than four
/// turns is left out of amplitude and phase. phi counts from the keyphasor's mark, so that phases of
/// orders that are no whole numbers do not jump from turn to turn. Where the shaft begins, ends or
/// turns round, the nearest full window stands for the turns that none stands about: a narrower one
/// would let through what the others leave out, an oil whirl for instance. Of a run that is shorter
/// than the window whole orders are found from the whole turns that stand about the turn (one at
/// the end: a rectangular window), others are nan. M = 1: each turn by itself, without a Hann window.
/// F. J. Harris 1978, doi 10.1109/PROC.1978.10837.
class OrderFilter {
 public:
  /// The turn, the amplitudes about it: y[probe * orders + order], m, 0-peak (order 0: the mean), and
  /// the turns that its window saw.
  using Sink = std::function<void(const Turn&, std::span<const Complex> y,
                                  std::span<const Complex> z, std::span<const Turn> seen)>;
  /// turns: M. @pre turns > 0, orders not negative.
  OrderFilter(std::size_t probes, std::vector<double> orders, int samples, int turns, Sink sink);
  /// A turn that does not go on where the last one ended begins anew.
  void take(const Turn& turn);
  /// The turns that waited for later ones.
  void end();
  void save(OutArchive& out) const;
  void restore(InArchive& in);

 private:
  using Direction = std::vector<std::vector<double>> Turn::*;
  /// Weights, and weights times exp(-i k (angle since the middle turn began)), of every sample.
  struct Window {
    double sum = 0;  ///< of the weights
    std::vector<double> weight;
    std::vector<std::vector<Complex>> kernel;  ///< [order][sample]
  };
  Window make_window(std::size_t half, int turns) const;
  bool follows(const Turn& turn) const;
  void give(std::size_t turn);
  /// About turn `centre` of those kept, from so many turns to either side.
  Complex amplitude(Direction direction, std::size_t probe, std::size_t order, std::size_t centre,
                    std::size_t half) const;

  std::vector<double> orders_;
  std::size_t samples_, side_;  ///< side_: turns the full window reaches into beside its own
  Sink sink_;
  std::vector<Window> windows_;       ///< [turns to either side]
  std::vector<Turn> kept_;            ///< the first `count_` of them, in order of time
  std::size_t count_ = 0, next_ = 0;  ///< next_: the first that was not given yet
  std::vector<Complex> y_, z_;
};

}  // namespace whirl::analysis
