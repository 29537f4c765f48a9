// Tilting pads whose films conserve mass in a motion at large: what a pad does of itself (PadMount), and
// the cells of its film (TiltingCell), which carried_film.hpp gives for a pad that stands.
//
// A pad that turns by delta and is pressed outwards by xi moves its centre by a = -arm delta t + xi n
// (tilting_pad.hpp); the gap of its cells is that of a journal at r_p = r - a. A cell gives F = -push to
// the journal, torques about r_p as every film, and F.da to the pad, so that its power at the nodes is
// F.(r' - a') + T_0 s_0 + T_1 s_1: what the cells turn into heat, with the sign changed, less the pump's.
// What moves the wall appears in a cell through its gap alone: m' is minus the divergence of a flow
// whatever the pad does, and mass is conserved to rounding. The groove before the leading edge is full,
// at the supply pressure, which stands behind the pad too.
//
// A pad without inertia moves as fast as its oil gives way: the bulk modulus of the cells holds it, the
// rest damper lets it go, both far faster than anything else; implicit schemes step over it.
// Source: H. G. Elrod, J. Lubr. Technol. 103, 1981, doi 10.1115/1.3251669 (cells); J. W. Lund, ASLE
// Trans. 7, 1964, doi 10.1080/05698196408972064 (pads).
#pragma once
#include <elements/films/pad_cell.hpp>
#include <elements/films/tilting_pad.hpp>

namespace whirl::elements {

/// A pad and the cells of its film, and where both are in balance.
template <class Oil = CarriedPad>
class PadAtRest {
 public:
  /// oil: the cells of its film. A pivot that gives has a rest damper as the tilt has (tilting_pad.hpp).
  PadAtRest(const TiltingPad& pad, std::shared_ptr<const Oil> oil);

  const TiltingPad& pad() const { return pad_; }
  const std::shared_ptr<const Oil>& oil() const { return oil_; }
  /// Tilt, rad, and compression of the pivot, m, at which pad and oil are in balance with a journal that
  /// stands still where it is. There may be several (a pad that carries a little, one that the journal has
  /// left): the nearest to q, of a pad that has not moved yet, q = 0, that of the momentary film. NaN: there
  /// are none. What was asked last is kept: the cells ask one after another, of any thread.
  Vec2 settled(const LateralMotion& journal, const Vec2& q = Vec2::Zero()) const;
  /// Those of a pad that is at q after what it does at once with its journal where it is: a tilt without
  /// inertia, a pivot without mass follow, the rest stays. NaN: there is no balance.
  Vec2 followed(const LateralMotion& journal, const Vec2& q) const;
  /// Force of the oil in balance on a journal at r against the centre of the pad, N. slip: rad/s.
  Vec2 force(const Vec2& r, double slip) const;

 private:
  Vec2 find(const LateralMotion& journal, const Vec2& q) const;
  Vec2 find_near(const LateralMotion& journal, const Vec2& q) const;
  template <class Tilt>
  double find_pressed(const LateralMotion& journal, const Vec2& q, const Tilt& tilt_at) const;
  double find_tilt(const LateralMotion& journal, double pressed, double near) const;

  TiltingPad pad_;
  std::shared_ptr<const Oil> oil_;
  struct Found {
    std::mutex lock;
    Vec2 r = Vec2::Constant(nan);
    double slip = nan;
    Vec2 from = Vec2::Constant(nan), found = Vec2::Constant(nan);
  };
  mutable Found last_;
};

extern template class PadAtRest<CarriedPad>;
extern template class PadAtRest<CarriedGrid>;

/// Springs, dampers and inertia of a pad (tilting_pad.hpp), without its film. Nodes: 0 journal, 1 housing
/// (for where the pad settles), 2 (scalar) tilt in rad, and where the pivot gives 3 (scalar) its
/// compression in m.
template <class Oil, bool Pressed, bool Offsets = false>
struct PadMount {
  static constexpr int n_nodes = Pressed ? 4 : 3, width = 7, size = 7 * n_nodes;
  static constexpr int own = n_nodes - 2;  ///< unknowns of the pad
  static constexpr system::Axes axes = Offsets ? system::Axes::own : system::Axes::any;
  static constexpr bool has_M = true, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  /// Inertia sees a common acceleration of all nodes, of which gravity gives the scalars nothing.
  system::Dependence depends(const system::Context&) const {
    const TiltingPad& pad = rest->pad();
    return {.weight = pad.inertia != 0 || (Pressed && pad.mass != 0)};
  }
  using Nodes = system::Nodes<n_nodes>;

  std::shared_ptr<const PadAtRest<Oil>> rest;
  std::array<double, 2> offset{0.0, 0.0};  ///< of journal and housing, m

  void add_force(const Nodes& x, const system::Context& c, system::ForceX<size>& f) const;
  void add_tangent(const Nodes& x, const system::Context& c, system::TangentX<size>& t) const;
  void add_energy(const Nodes& x, const system::Context& c, system::Energy& e) const;
  /// The journal against its housing, as if it stood still, and tilt and compression.
  LateralMotion journal(const Nodes& x) const;
  Vec2 place(const Nodes& x) const;
  /// The pad with its oil in balance with the journal where it is, at rest.
  void relax(const Nodes& x, const system::Context& c, std::array<double, own>& q) const;
};

extern template struct PadMount<CarriedPad, false, false>;
extern template struct PadMount<CarriedPad, false, true>;
extern template struct PadMount<CarriedPad, true, false>;
extern template struct PadMount<CarriedPad, true, true>;
extern template struct PadMount<CarriedGrid, false, false>;
extern template struct PadMount<CarriedGrid, false, true>;
extern template struct PadMount<CarriedGrid, true, false>;
extern template struct PadMount<CarriedGrid, true, true>;

/// The cells of a pad that tilts, at one angle. Nodes: 0 journal, 1 housing, 2 (scalar) tilt in rad, where
/// the pivot gives 3 (scalar) its compression in m, then contents as PadCell.
template <class Oil, bool Pressed, bool Offsets = false>
struct TiltingCell {
  using Cell = PadCell<Oil, Pressed ? 2 : 1, Offsets>;
  static constexpr int n_nodes = Cell::n_nodes, own = 1, width = Cell::width, size = Cell::size;
  static constexpr int own_each = Cell::own_each;
  static constexpr system::Axes axes = Cell::axes;
  static constexpr bool has_M = Cell::has_M, has_C = Cell::has_C, has_K = Cell::has_K;
  static constexpr system::Family family = Cell::family;
  static constexpr system::Dependence depends = Cell::depends;
  using Nodes = system::Nodes<n_nodes>;

  Cell film;
  std::shared_ptr<const PadAtRest<Oil>> rest;

  /// @pre i below the cells of the pad. offset: of journal and housing, m; block: of its rows.
  static TiltingCell of(const std::shared_ptr<const PadAtRest<Oil>>& rest, Index i,
                        const std::array<double, 2>& offset, Index block = 0);

  void add_force(const Nodes& x, const system::Context& c, system::ForceX<size>& f) const {
    film.add_force(x, c, f);
  }
  void add_tangent(const Nodes& x, const system::Context& c, system::TangentX<size>& t) const {
    film.add_tangent(x, c, t);
  }
  void add_energy(const Nodes& x, const system::Context& c, system::Energy& e) const {
    film.add_energy(x, c, e);
  }
  /// The contents in balance with the journal where it is, and with a pad that is in balance itself, where
  /// it is otherwise.
  void relax(const Nodes& x, const system::Context& c, typename Cell::Rows& q) const;
  /// Force and torques on journal and housing (lateral_joint.hpp).
  Vector<4> load(const Nodes& x, const system::Context& c) const { return film.load(x, c); }
  /// The unknowns where the cells are full, without pressure, m.
  typename Cell::Rows full(const Nodes& x) const { return film.full(x); }
};

extern template struct TiltingCell<CarriedPad, false, false>;
extern template struct TiltingCell<CarriedPad, false, true>;
extern template struct TiltingCell<CarriedPad, true, false>;
extern template struct TiltingCell<CarriedPad, true, true>;
extern template struct TiltingCell<CarriedGrid, false, false>;
extern template struct TiltingCell<CarriedGrid, false, true>;
extern template struct TiltingCell<CarriedGrid, true, false>;
extern template struct TiltingCell<CarriedGrid, true, true>;

}  // namespace whirl::elements
