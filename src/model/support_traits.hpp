// What the rest of the program has to know of a bearing law besides its numbers. Every law answers
// every question beside its struct (bearing_laws.hpp): nothing has a default, so that a law which
// leaves one out does not compile.
#pragma once
#include <core/types.hpp>
#include <model/location.hpp>
#include <array>
#include <concepts>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace whirl::model {

/// A value that must be given: an aggregate that leaves one out does not compile.
template <class T>
class Given {
 public:
  template <class U>
  requires std::convertible_to<U, T>
  constexpr Given(U&& value) : value_(std::forward<U>(value)) {}  // implicit: it stands for a T
  constexpr operator const T&() const { return value_; }
  constexpr const T& operator*() const { return value_; }
  constexpr const T* operator->() const { return &value_; }

 private:
  T value_;
};

/// x, y, z, rx (about the shaft), ry, rz.
using Directions = std::array<bool, 6>;
inline constexpr Directions no_direction{};
inline constexpr Directions lateral_directions{false, true, true, false, false, false};

/// Where a law acts.
enum class Acts {
  between_nodes,  ///< on the shaft and, opposite, on a second node: ground, pedestal, other shaft
  on_the_shaft,   ///< on the shaft node alone where the other side is the ground
  as_constraint,  ///< not by a force law: it holds unknowns of the shaft node exactly
};

/// How a law is drawn.
enum class Picture { bearing, spring };

/// What a law puts on its node that no inertia of the shaft has a part in.
struct NodeLoads {
  bool lateral = false, tilting = false, torque = false;
};

/// Displacement (m, rad) at which a linear law is free, and its constant load (N, N m) on the
/// shaft, in the order (x, y, z, rx, ry, rz).
struct Bias {
  Vector<6> setpoint = Vector<6>::Zero(), preload = Vector<6>::Zero();
};

/// A lateral stiffness as a law states it, for pictures.
struct StiffnessCurve {
  std::string label;          ///< after the name of the bearing
  std::vector<double> k;      ///< N/m
  std::vector<double> speed;  ///< rad/s, as many; empty: the one k holds at every speed
};

/// Two shafts whose speeds a law ties together.
struct ShaftPair {
  double speed_ratio = 1;  ///< speed of the second shaft over that of the first
  const char* noun;        ///< in messages: "coupling"
  std::string details;     ///< after the name in messages: "(20 and 40 teeth)", or empty
  bool mesh = false;       ///< through teeth: the axes of the shafts lie apart
};

/// Parts that pass under the load as the shafts turn, and change the stiffness as they do: teeth, rolling
/// elements.
struct Passing {
  double own = 0,
         other = 0;  ///< passes for each turn of the shaft, and of the other or the housing
};

struct SupportTraits {
  /// Directions in which a displacement meets a force or moment of its own direction, K(c, c) != 0:
  /// at once, or (films, seals, contacts) as soon as the shaft is displaced or turns.
  Given<Directions> held;
  /// What it takes in at its node, for the share that inertia has in the rest
  /// (assembly/mass_shares.hpp). Nothing for laws that hold the node or are open most of the time.
  Given<NodeLoads> loads;
  /// Constant stiffness (x, y, z, rx, ry, rz), N/m, N/rad, N m/rad, of a law that has one.
  Given<std::optional<Matrix<6>>> stiffness;
  Given<Bias> bias;
  Given<std::vector<StiffnessCurve>> curves;
  Given<Acts> acts;
  Given<bool> film;     ///< oil film: it fills a clearance and is not believed near its end
  Given<bool> gap;      ///< over a part of its range it carries nothing
  Given<bool> rolling;  ///< carries by rolling elements, which come and go under the load
  Given<std::optional<Passing>> passing;
  Given<bool> follows_spin;  ///< force or coefficients depend on the spin of the shaft
  Given<bool> nonlinear;     ///< lateral stiffness depends on the displacement
  Given<bool> needs_load;    ///< it has no stiffness where it carries no load
  Given<bool> mapped;  ///< carries laterally by a stiffness that a critical-speed map can vary
  Given<std::optional<ShaftPair>> pair;  ///< only between two shafts
  Given<const Location*>
      sensor;  ///< another place that it measures at, in the law itself; null: none
  Given<Picture> picture;
};

}  // namespace whirl::model
