// Twist of shafts that turn together: angles of their nodes less the mean one, and the size it has.
#pragma once
#include <core/types.hpp>
#include <time/problem.hpp>

#include <span>
#include <vector>

namespace whirl::time {

/// Spin angles of the nodes of shafts that turn in proportion (gears, couplings, joints; or one shaft
/// alone), each over its ratio in the same measure: that of the first shaft.
struct TwistGroup {
  std::vector<Index> unknowns;
  std::vector<double> ratios;  ///< not 0, one for each unknown
};

/// A rotor turns by whole revolutions while it twists by milliradians: its angles' own scale says
/// nothing of a vibration of twist. Deviations are summed up from the increments of steps, since angles
/// lose whole turns.
class TwistScale {
 public:
  void resize(std::span<const Kind> kinds, std::span<const TwistGroup> groups);
  bool empty() const { return groups_.empty(); }
  /// Forgets all motion.
  void reset();
  /// Polar inertia of each unknown, by which angles are averaged, unless one of them is prescribed.
  void set_inertia(CRef inertia);
  /// Largest deviation of a vector of angles from their means, rad of the group's first shaft.
  double size(CRef angles) const;
  /// An accepted step from q0 to q; again: in place of the one before.
  void observe(CRef q0, CRef q, bool again);
  /// Half the largest range that a deviation has swept, rad.
  double swept() const { return swept_; }

  void save(std::vector<double>& out) const;
  const double* restore(const double* in);

 private:
  struct Member {
    Index unknown;
    double per_ratio;  ///< 1 / ratio
    double weight;     ///< in the mean, their sum is 1
  };
  struct Group {
    std::vector<Member> members;
    bool prescribed = false;
  };
  static double mean(const Group& g, CRef angles);

  std::vector<Group> groups_;
  std::vector<double> deviation_, before_, low_, high_;  ///< of members in turn, rad
  double swept_ = 0.0;
};

}  // namespace whirl::time
