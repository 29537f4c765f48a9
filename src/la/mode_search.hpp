// The search behind ModeSolver (eigen.hpp): Krylov runs about one shift with all that is known out
// of the way, and the count that certifies what they found. Internal to src/la.
#pragma once
#include <la/eigen.hpp>
#include <la/eigenpairs.hpp>
#include <la/root_count.hpp>

#include <algorithm>
#include <optional>

namespace whirl::la {

struct ModeSolver::Impl : Eigenpairs {
  using Eigenpairs::Eigenpairs;
  Krylov<Complex> krylov_complex;
  std::vector<VecXc> deflated;  ///< Ritz vectors z that polishing could not make anything new of;
                                ///< out of the way of the searches of this call
  std::vector<Mode> result;
  std::optional<RootCounter> counter;
  double fastest_root = 0.0;  ///< rad/s, of a problem solved whole and certified; 0: it was not
  Certificate certificate;

  template <class Scalar>
  void lock_known(Krylov<Scalar>& k);
  /// What a run has converged to, from the largest Ritz value to the first that has not converged
  /// or lies beyond the radius.
  struct Harvest {
    std::vector<Pair> found;
    std::vector<VecXc> vectors;    ///< Ritz vectors, one a pair
    Index counted = 0;             ///< of those asked for
    std::optional<Complex> crowd;  ///< where decaying roots crowd, converged or not
    bool all = true;               ///< nothing within the radius is left to converge
  };
  template <class Scalar>
  Harvest harvest(Krylov<Scalar>& k, bool exhausted, double radius);
  /// One Arnoldi run in the complement of what is known. False: nothing unknown is left within the
  /// wanted radius.
  template <class Scalar>
  bool search(Krylov<Scalar>& k, unsigned seed);
  /// Everything dense: for a handful of unknowns, and for many roots in one place. within: those in
  /// it only. True: something new.
  bool solve_dense(const CountRegion* within = nullptr);
  /// Adds what is faster than `above`, rad/s. True: something may be lost in rounding at this shift.
  bool solve_dense_at(double above, const CountRegion* within, std::vector<Pair>& found);
  void start_from_known();
  /// Indices of the known pairs to be returned.
  std::vector<std::size_t> choose() const;
  void sort_by_frequency(std::vector<std::size_t>& chosen) const;
  /// The same of a counted list: all that oscillates up to the frequency or the number asked for,
  /// and the real roots of the region.
  std::vector<std::size_t> choose_counted() const;
  void collect();
  /// A radius for the count: at least what is asked for, where the frequencies known leave the
  /// widest gap.
  double count_radius() const;
  /// A pair that is no root, or a zero root counted with the free motions already, would hide one
  /// that is missing.
  void drop_unproved();
  /// Where more are known than there are: pairs beside one that is proved much better. False: none.
  bool drop_copies();
  std::vector<Complex> known_roots() const;
  /// Looks for roots within a distance from a place of the complex plane, in complex arithmetic,
  /// with all that is known out of the way. True: something new.
  bool look_near(Complex place, double distance);
  /// Looks over the decaying half of the region from its middle, for many at once. True: something new.
  bool look_over(const CountRegion& region);
  /// Looks round a grid over the region, for roots that lie too close together for their moments to
  /// tell them apart.
  bool look_everywhere(const CountRegion& region);
  Index count_oscillating() const;
  /// Damping by the stiffness makes roots crowd: at -1/beta, and where it is the rotor's own, as far
  /// above and below as the rotor turns. Hundreds in one place cost much and say nothing: searches and
  /// counts end short of them, and (next to) nothing oscillates beyond. Im >= 0 here.
  std::vector<Complex> crowds;
  bool watches_crowds = opt.certify;
  /// Places round which so many of these lie within a twentieth of the distance from zero.
  static std::vector<Complex> crowded_places(const std::vector<Complex>& decaying,
                                             std::ptrdiff_t crowd);
  static bool decays_fast(Complex lambda) { return lambda.real() < -0.2 * std::abs(lambda); }
  /// Of the known pairs.
  std::vector<Complex> known_decaying() const;
  /// From a place to the nearest crowd; infinite: there is none.
  double to_crowd(Complex place) const { return to_nearest(crowds, place); }
  static double to_nearest(const std::vector<Complex>& crowds, Complex place);
  /// A distance from a place that does not reach into one.
  double short_of_crowd(Complex place, double distance) const;
  /// 1/s: decay of the slowest crowd that is met or known; infinite: none.
  double crowd_decay() const;
  /// Cuts the region to be counted short of a crowd where many of its roots are unknown. False: there
  /// is none, or it is cut off already.
  bool avoid_crowd(const RootCount& c, double radius);
  bool cut_short = false;        ///< the region is
  double most_reach = infinity;  ///< 1/s: of such a region
  /// All searches that lead to something new.
  void search_all();
  /// Pairs counted on the way may have turned out to be real: the search goes on until as many
  /// modes oscillate as are wanted.
  void extend_to_count();
  /// The missing roots are further copies of overdamped ones that are known: massless unknowns
  /// under damping in proportion to their stiffness all have the one rate -1/beta. Their number
  /// says nothing about the machine.
  bool further_copies(const std::vector<Complex>& places) const;
  /// Sets double_zeros by a count round zero, where slow roots leave them in doubt.
  void count_double_zeros();
  /// Estimates of roots that a count of the region misses, Im >= 0. Those far nearer to zero than its
  /// radius are counted and placed once more, on a curve as small as they are.
  std::vector<Complex> places_of_missing(Index number, const CountRegion& region);
  /// All of them are zeros as far as rounding tells.
  bool near_zero(const std::vector<Complex>& places) const;
  /// Free motions whose zero roots the search could not tell apart (several at once are defective):
  /// they are counted by themselves, within a circle round zero that is small beside every other
  /// root, and the region once more with as many zeros. True: nothing else is missing.
  bool only_zeros_missing();
  /// Counts the roots of the region, looks for those that are missing, and leaves the certificate.
  void certify();
  void set(const MCK& matrices);
  void solve(const MCK& matrices);
  /// The same, once more from nothing where a list that began with known modes is not complete.
  void solve_from_known(const MCK& matrices);
  void rescale_shift();
};

}  // namespace whirl::la
