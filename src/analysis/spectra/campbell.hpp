// Campbell diagram: natural frequencies, damping and direction of the modes against speed, each
// line one mode.
#pragma once
#include <analysis/spectra/track.hpp>
#include <array>
#include <string>

namespace whirl::analysis {

struct CampbellOptions {
  std::vector<double> speeds;  ///< rad/s, monotonic
  TrackOptions track;
  bool shapes = false;  ///< keep the shapes (memory: speeds x modes x unknowns)
};

/// Entries are per speed; nan where the mode is not among those asked for.
struct CampbellLine {
  std::string label;  ///< "1 F", "1 B", "2 M", "T1", "A1": number within its kind and direction
  ModeKind kind = ModeKind::lateral;
  Direction direction = Direction::none;                        ///< at most of the speeds
  std::vector<double> frequency, damping_ratio, log_decrement;  ///< rad/s, -, -
  std::vector<Direction> direction_at;
  std::vector<Complex> lambda;
  std::vector<VecXc> shape;  ///< when asked for
};

struct Campbell {
  std::vector<double> speeds;
  std::vector<CampbellLine> lines;                ///< by frequency at the first speed they appear
  long speeds_solved = 0;                         ///< with those put in to keep the lines apart
  std::vector<SpectrumCertificate> certificates;  ///< one a speed
  std::vector<WhirlMode> last;                    ///< all modes followed, at the last speed
};

/// Collects the modes a tracker finds at the speeds of a diagram.
class CampbellRecorder {
 public:
  explicit CampbellRecorder(std::vector<double> speeds, bool shapes = false);
  /// Modes at speeds[k]; `lines`: number of lines the tracker has seen.
  /// @pre k below the number of speeds.
  void take(std::size_t k, const std::vector<TrackedMode>& modes, Index lines);
  /// Names and sorts the lines.
  Campbell finish(long speeds_solved);

 private:
  Campbell out_;
  bool shapes_;
  std::vector<std::array<int, 3>> votes_;  ///< kinds, by line
};

/// visit: every step of the tracker, speeds put in to keep lines apart included.
Campbell campbell(Linearizer& linear, const CampbellOptions& options,
                  const ModeTracker::Visit& visit = {});

}  // namespace whirl::analysis
