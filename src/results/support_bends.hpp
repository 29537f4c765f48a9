// How far forces and moments of supports leave their linear part on the way of a motion: play that
// closes, springs that stiffen, magnets that saturate. One kernel for steady responses
// (linear_limits.hpp) and for linear motion in time (bends_output.cpp).
#pragma once
#include <run/job.hpp>

#include <string>
#include <vector>

namespace whirl::results {

/// Of one force, N, or moment, N m, of a support.
struct Bend {
  double off = 0, linear = 0;  ///< the largest beside its linear part, and of that part
  double still = 0;            ///< at rest
  void take(const Vec3& there, const Vec3& rest, const Vec3& linear_part);
  /// Of its linear part; a thousand where that is next to nothing.
  double share() const;
  bool beyond(const Bend& other) const;
  /// It misleads: a good part of what it does, and not small against what supports do, `most`.
  bool matters(double most) const;
};

/// Both of a support.
struct SupportBend {
  Bend force, moment;
  bool beyond(const SupportBend& other) const {
    return force.beyond(other.force) || moment.beyond(other.moment);
  }
};

/// What all supports do in linear motion: a force is small against the largest of them, N, a moment
/// against the largest of these and those of forces over the length of the machine, N m.
struct MostLinear {
  double force = 0, moment = 0;
  void take(const std::vector<SupportBend>& bends, double length);
  bool misled_by(const SupportBend& x) const {
    return x.force.matters(force) || x.moment.matters(moment);
  }
};

/// m, of the longest line.
double longest_line(const run::Job& job);

/// The supports about a state at rest.
class SupportBends {
 public:
  /// (force, moment) of every support, one a column; NaN where it cannot be told.
  using Loads = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  /// averaged: what breathes with the turning of a shaft acts with its mean over the revolution.
  SupportBends(const run::Job& job, const system::State& still, bool averaged);
  /// What they change by on a small way in this direction, per `way`.
  Loads linear_along(const VecX& way);
  /// Looks at them at the end of a way, where their linear part changes them by `linear`.
  void look(const VecX& way, const Loads& linear);
  /// Of every support, so far.
  const std::vector<SupportBend>& bends() const { return bends_; }

 private:
  Loads at(const VecX& q);
  const run::Job& job_;
  const system::State& still_;
  system::Workspace w_;
  Loads rest_;
  std::vector<SupportBend> bends_;
};

/// "'stop' into contact, where it would press with 12 N": what a motion takes there.
/// @pre most.misled_by(x).
std::string text_of(const SupportBend& x, const MostLinear& most, const std::string& name);

inline constexpr const char* of_bends =
    "play that closes or opens, a spring that stiffens or a magnet that saturates: ";

/// What the amplifiers of a magnetic bearing are asked for in linear motion, and give; 0: without
/// end.
struct CurrentNeed {
  std::size_t bearing = 0;             ///< of the model
  double current = 0, rate = 0;        ///< A, A/s, the largest
  double current_at = 0, rate_at = 0;  ///< where: whatever counts places
  double most_current = 0, most_rate = 0;
  void take(double asked_current, double asked_rate, double place);
  bool beyond_current() const { return most_current > 0 && current > most_current; }
  bool beyond_rate() const { return most_rate > 0 && rate > most_rate; }
  bool beyond() const { return beyond_current() || beyond_rate(); }
};

/// One for each of Built::magnetic_controls.
std::vector<CurrentNeed> current_needs(const run::Job& job);

/// "470 A/s of magnet 'm', whose amplifier gives 150 A/s": what a motion needs. of_rate: of the rate
/// of its current, else of the current itself.
std::string text_of(const CurrentNeed& x, bool of_rate, const std::string& name);

}  // namespace whirl::results
