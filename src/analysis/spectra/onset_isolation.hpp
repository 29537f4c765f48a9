// Onsets of instability isolated between two speeds by the number of growing roots: where nothing that
// is followed from speed to speed accounts for its change (stability.hpp).
#pragma once
#include <analysis/spectra/stability.hpp>

#include <vector>

namespace whirl::analysis {

/// The modes of one speed and what they say of its stability.
struct Look {
  SpeedVerdict verdict;
  std::vector<WhirlMode> modes;
  Look(double speed, std::vector<WhirlMode> modes, const SpectrumCertificate& certificate);
  double speed() const { return verdict.speed; }
};

class OnsetIsolation {
 public:
  struct Found {
    std::vector<Onset> onsets;  ///< ascending
    std::vector<Unplaced> unplaced;
  };

  /// span: of the speeds of the search, rad/s, which bounds what is resolved beside zero. tolerance:
  /// relative, of speeds at which growth is zero.
  OnsetIsolation(Linearizer& linear, const ModesOptions& modes, double span, double tolerance);
  Look look_at(double speed);
  /// @pre a.speed() < b.speed().
  Found between(const Look& a, const Look& b);
  WhirlSolver& follower() { return follower_; }

 private:
  struct Parted;
  static std::vector<Parted> parted(const std::vector<WhirlMode>& here,
                                    const std::vector<WhirlMode>& there);
  void isolate(const Look& a, const Look& b);
  void add(const Look& a, const Look& b);
  void add_slow(const Parted& p, double few, double many, bool gains);
  bool grows_unlisted(const WhirlMode& m, const Look& few);
  void settle();

  WhirlSolver solver_, follower_;
  double least_size_, tolerance_;
  Found found_;
};

}  // namespace whirl::analysis
