// What is known of a list of modes: whether it is complete in its band, and whether all that grows is
// in it.
#pragma once
#include <analysis/spectra/frequency_dependent_modes.hpp>
#include <la/eigen.hpp>
#include <optional>
#include <string>

namespace whirl::analysis {

/// What is known of a list of modes, and of its stability.
struct SpectrumCertificate {
  la::Certificate list;    ///< roots counted against roots found
  std::string open;        ///< why nothing was counted; empty when it was
  bool unsettled = false;  ///< open because the count did not settle
  /// rad/s: above it nothing grows (energy) by more than quiet_ratio of its frequency, times its
  /// frequency over this one; nan: not excluded, or not asked for.
  double quiet_above = nan;
  double quiet_ratio = 0;
  /// Supports tabulated against frequency: growing roots counted along the imaginary axis, on which
  /// alone the tables say what the supports do (la/axis_count.hpp). It certifies that every growing
  /// motion is in the list; of the decaying ones ByFrequency says what is known.
  struct Axis {
    bool counted = false;  ///< the samples settle, and the problem at the tables' end is certified
    Index unknown = 0;     ///< growing roots beyond those found
    bool held_beyond = true;  ///< false: the tables end, and were held beyond for the count
    double top = 0;           ///< rad/s: where they end
    Index factorizations = 0;
    bool certain() const { return counted && unknown == 0; }
  };
  std::optional<Axis> axis;
  /// The same supports, and hysteretic damping: `list` is what la/wedge_count.hpp says, of modes from
  /// `low` (rad/s) on.
  struct ByFrequency {
    double low = 0;
    Index rising = 0;  ///< roots met at which a branch of frequencies rises; not in the list
  };
  std::optional<ByFrequency> by_frequency;
  /// More or fewer motions grow, by the count along the imaginary axis, than were found.
  bool contradicted() const { return axis && axis->counted && axis->unknown != 0; }
  bool complete() const { return open.empty() && list.complete() && !contradicted(); }
  /// What decays fast was left out of the count, short of a crowd of such roots.
  bool cut() const { return list.reach < 0.99 * la::oscillating_reach * list.radius; }
  /// Every growing motion is in the list, at any frequency.
  bool stability_certain() const {
    return axis ? axis->certain() : complete() && quiet_above <= list.radius;
  }
  /// "every root up to 1234 Hz (damping ratio to 0.95) counted"; what is missing and where; or why
  /// not.
  std::string text() const;
  void take(const OwnFrequency::Known& known);

 private:
  std::string text_of_list() const;
};

}  // namespace whirl::analysis
