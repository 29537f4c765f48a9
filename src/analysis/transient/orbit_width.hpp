// How far a point moves to and fro: half the largest width of its path in two turns of its shaft.
#pragma once
#include <core/archive.hpp>
#include <core/types.hpp>

#include <array>
#include <cstddef>
#include <span>

namespace whirl::analysis {

/// Motion apart from sag and drift: of the path of a point in the lateral plane, in every two turns
/// of its shaft that follow one another, half the width (peak to peak in the direction where that is
/// largest). An ellipse gives its major semi-axis, wherever its centre is and however slowly that
/// moves. Where the shaft makes less than two turns, all there is.
class OrbitWidth {
 public:
  /// Looks at the path in a step, equally spaced, its two ends among them.
  static constexpr int looks = 5;

  /// u: place, m; t: s; phi: angle the shaft has turned, rad.
  void begin(const Vec2& u, double t, double phi);
  /// seen: places at t0 + (t1 - t0) k / 4, m; between them the path is the polynomial through them.
  void step(std::span<const Vec2, looks> seen, double t0, double t1);
  /// The shaft has turned to phi, rad: a turn may be complete.
  void turned_to(double phi, const Vec2& u, double t);
  /// Half the largest width so far, m, and the time its later end was reached, s.
  double amplitude() const;
  double time() const;

  void save(OutArchive& out) const;
  void restore(InArchive& in);

 private:
  static constexpr int directions = 8;  ///< k 180 / 8 degrees from y towards z
  /// Of the projections on the directions: where they end, m, and when they were there, s.
  struct Extent {
    std::array<double, directions> low{}, high{}, t_low{}, t_high{};
    bool empty = true;
  };
  struct Width {
    double half = 0, time = 0;
  };

  static Extent at(const Vec2& u, double t);
  static Extent together(const Extent& a, const Extent& b);
  static Width width_of(const Extent& e);
  Width largest() const;

  Extent before_, now_;  ///< the last whole turn, and since
  double turn_began_ = 0;
  Width largest_;
};

}  // namespace whirl::analysis
