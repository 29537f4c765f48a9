// Which rigid motions of shafts and casings nothing resists. Only whether a support acts in a
// direction counts, not how strongly, so a spring of 1 N/m beside one of 1e12 N/m is seen.
//
// Rigid motions of a line in a plane: sideways, and turning about its middle (unit displacement at
// the ends); axially: one. Each support is a row: relative motion of its two sides. What the rows
// leave free is their null space, found for each group of connected lines on its own.
#include <assembly/parts.hpp>
#include <assembly/tied_lines.hpp>
#include <elements/supports/linear_bearing.hpp>
#include <meshes/mass_properties.hpp>

#include <la/dense.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace whirl::assembly {
namespace {

enum Direction { x, y, z, rx, ry, rz };

/// Directions in which a bearing resists relative motion of its sides. A law that holds the shaft
/// exactly to a pedestal does so through the pedestal's spring.
model::Directions resisted(const model::Bearing& b) {
  const model::SupportTraits t = model::traits_of(b.law);
  model::Directions out = t.held;
  if (t.acts == model::Acts::as_constraint && b.pedestal)
    for (std::size_t c = 0; c < 3; ++c)
      out[c] = out[c] && !b.pedestal->K.row(static_cast<Index>(c)).isZero(0.0);
  return out;
}

/// Small motions about the model as drawn: no equilibrium is looked for.
bool is_about_the_drawing(const model::Step& s) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.about; })
          return law.about == model::About::undeformed;
        else
          return false;
      },
      s.law);
}

/// A point whose motion counts: on a line, or nowhere (ground; pedestals resist in every direction,
/// see add_pedestal).
struct End {
  Index line = -1;
  double s = 0;
};

/// The step that a chain of steps begins with: its kind says what the chain needs.
const model::Step& first_of(const model::Model& m, const model::Step& s) {
  for (const model::Step& other : m.steps)
    if (!s.from.empty() && other.name == s.from) return first_of(m, other);
  return s;
}

/// Angle of a line that keeps its spin.
struct Coasting {
  double time = 0, angle = 0, spin = 0;
};
class AngleOfCoasting final : public Law {
 public:
  explicit AngleOfCoasting(std::shared_ptr<const Coasting> motion) : motion_(std::move(motion)) {}
  LawValue at(double t) const override {
    return {motion_->angle + motion_->spin * (t - motion_->time), motion_->spin, 0.0};
  }
  double integral(double t) const override {
    return (motion_->angle - motion_->spin * motion_->time + 0.5 * motion_->spin * t) * t;
  }

 private:
  std::shared_ptr<const Coasting> motion_;
};

class Restraint {
 public:
  explicit Restraint(Assembly& a) : a_(a), group_(a.mesh.lines.size()) {
    for (std::size_t i = 0; i < a.model.bearings.size(); ++i) {
      const model::Bearing& b = a.model.bearings[i];
      End other;
      if (b.to) other = {static_cast<Index>(b.to->shaft), b.to->s};
      links_.push_back({{static_cast<Index>(b.at.shaft), b.at.s}, other, resisted(b)});
    }
    // a part of a step that reports is none of the deck's: it needs what any of these does
    const auto& steps = a.model.steps;
    const bool known = std::any_of(steps.begin(), steps.end(),
                                   [&](const model::Step& s) { return s.name == a.step; });
    for (const model::Step& s : steps)
      if (!known || s.name == a.step) look_at(s);
  }

  void check_axial() {
    for (const auto& lines : groups({x})) {
      if (joined(lines)) continue;
      if (grounded(lines, x)) continue;
      const bool moved = in_time_ && set_moving(lines);
      if ((loaded(lines, true) && (equilibrium_ || frequency_)) || (moved && starts_settled_)) {
        complain(
            lines, "axial motion of {}",
            "add a thrust bearing (kxx), or a bearing of type \"rigid\" with directions = [\"x\"]");
      } else if ((equilibrium_ || (frequency_ && !free_in_space(lines))) && !moved) {
        free_or_hold_axially(lines);
      }
    }
  }

  void check_lateral() {
    std::vector<std::pair<std::vector<std::size_t>, std::string>> found[2];
    for (int p = 0; p < 2; ++p) {
      const Direction along = p == 0 ? y : z, turn = p == 0 ? rz : ry;
      for (const auto& lines : groups({along, turn}))
        if (const std::string what =
                joined(lines) || bent(lines) ? "" : free_motion(lines, along, turn);
            !what.empty() && wrong(lines, what))
          found[p].push_back({lines, what});
    }
    const char* hint =
        "a shaft needs two lateral bearings, or one that also holds its tilt; to let it move "
        "freely start the transient from rest "
        "(start = \"rest\")";
    for (const auto& f : found[0]) {
      const bool both = std::find(found[1].begin(), found[1].end(), f) != found[1].end();
      complain(f.first, f.second + (both ? " (y and z)" : " (y)"), hint);
    }
    for (const auto& f : found[1])
      if (std::find(found[0].begin(), found[0].end(), f) == found[0].end())
        complain(f.first, f.second + " (z)", hint);
  }

  void check_spin() {
    for (std::size_t l = 0; l < a_.mesh.lines.size(); ++l) {
      const meshes::Line& line = a_.mesh.lines[l];
      if (!line.rotating) {
        if (!turns_freely(l)) continue;
        a_.builder.hold(line.first_node, system::spin_phi);
        hold(fmt::format("turning of casing '{}' about its axis: held at its left end", line.name));
        continue;
      }
      if (a_.built.spins[l].prescribed || has_polar_inertia(l) || turned_by_another(l)) continue;
      refuse_torques_on(l);
      let_coast(l);
    }
  }

 private:
  bool has_polar_inertia(std::size_t l) const {
    const meshes::Line& line = a_.mesh.lines[l];
    const meshes::MassProperties p = meshes::shaft_mass(a_.model, l);
    return p.Ip() > 1e-15 * p.mass * line.length * line.length;
  }
  /// Something passes torque to it from a line whose spin has an equation: its own is the balance of
  /// torques then (a spacer between couplings, an idler).
  bool turned_by_another(std::size_t l) const {
    std::vector<std::size_t> first = tied_lines(a_.model);
    for (const Link& k : links_) {
      if (!k.in[rx] || k.b.line < 0) continue;
      if (!a_.mesh.lines[at(k.a.line)].rotating || !a_.mesh.lines[at(k.b.line)].rotating) continue;
      const auto [to, from] = std::minmax({first[at(k.a.line)], first[at(k.b.line)]});
      std::replace(first.begin(), first.end(), from, to);
    }
    for (std::size_t other = 0; other < first.size(); ++other)
      if (first[other] == first[l] &&
          (a_.built.spins[other].prescribed || has_polar_inertia(other)))
        return true;
    return false;
  }
  void refuse_torques_on(std::size_t l) {
    for (const model::Drive& d : a_.model.drives) {
      if (!a_.acts(d) || d.at.shaft != l) continue;
      const std::string who = fmt::format("drive '{}'", d.name);
      a_.error(
          "E32",
          fmt::format("{}: shaft '{}' has no inertia about its axis that a torque could accelerate",
                      who, a_.mesh.lines[l].name),
          "give a disk its Ip, or prescribe the speed", d, who);
    }
  }
  /// No inertia about the axis at all: an unknown spin would have no equation.
  void let_coast(std::size_t l) {
    const meshes::Line& line = a_.mesh.lines[l];
    const double spin = a_.built.spins[l].spin0;
    const auto motion = std::make_shared<Coasting>(Coasting{.spin = spin});
    const LawPtr angle = std::make_shared<AngleOfCoasting>(motion);
    for (Index n = line.first_node; n < line.first_node + line.nodes; ++n)
      a_.builder.hold(n, system::spin_phi, angle);
    a_.built.coasting.push_back(
        {line.name, line.first_node, [motion](double t, double phi, double now) {
           *motion = {t, phi, now};
         }});
    hold(fmt::format(
        "torsion and spin of shaft '{}' as unknowns: no inertia about its axis; it keeps "
        "the speed that a step starts with",
        line.name));
  }
  /// Small motions keep it, equilibria hold it; a motion in time that starts from one is held.
  void free_or_hold_axially(const std::vector<std::size_t>& lines) {
    const Index node = a_.mesh.lines[lines.front()].first_node;
    if (!in_time_) {
      a_.built.axially_free.push_back(a_.builder.node(node).line);
    } else if (a_.model.keep_everything && !frequency_) {  // there it would be one more mode
      keep_axial(lines, node);
    } else {
      a_.builder.hold(node, x);
      hold(fmt::format("axial motion of {} as a whole: nothing {} it; held at the {}", named(lines),
                       damped_axially(lines) ? "but damping resists" : "resists or loads",
                       a_.builder.node(node).name));
    }
  }
  /// What is held is also left out of the unknowns.
  void hold(const std::string& what) {
    a_.built.held.push_back(what);
    a_.built.left_out.push_back(what);
  }
  /// The axial motion stays an unknown: a spring that gives it a natural frequency of 1 rad/s makes
  /// its equilibrium unique.
  void keep_axial(const std::vector<std::size_t>& lines, Index node) {
    double mass = 0.0;
    for (std::size_t l : lines)
      mass += meshes::shaft_mass(a_.model, l).mass;
    elements::TranslationalBearing spring{};
    spring.K(0, 0) = mass > 0.0 ? mass : 1.0;
    a_.builder.add(
        spring,
        {node, a_.builder.add_ground(a_.builder.node(node).position, "ground of the axial motion")},
        "linear bearings");
  }
  struct Link {
    End a, b;
    model::Directions in;
  };

  /// Groups of lines connected by links that act in one of the directions.
  std::vector<std::vector<std::size_t>> groups(const std::vector<Direction>& directions) {
    std::iota(group_.begin(), group_.end(), std::size_t{0});
    const auto root = [this](std::size_t i) {
      while (group_[i] != i)
        i = group_[i];
      return i;
    };
    for (const Link& k : links_)
      for (Direction d : directions)
        if (k.in[d] && k.b.line >= 0)
          group_[root(static_cast<std::size_t>(k.b.line))] =
              root(static_cast<std::size_t>(k.a.line));
    std::vector<std::vector<std::size_t>> out(group_.size());
    for (std::size_t i = 0; i < group_.size(); ++i)
      out[root(i)].push_back(i);
    out.erase(std::remove_if(out.begin(), out.end(), [](const auto& g) { return g.empty(); }),
              out.end());
    return out;
  }
  static bool contains(const std::vector<std::size_t>& lines, Index l) {
    return l >= 0 &&
           std::find(lines.begin(), lines.end(), static_cast<std::size_t>(l)) != lines.end();
  }
  bool grounded(const std::vector<std::size_t>& lines, Direction d) const {
    return std::any_of(links_.begin(), links_.end(), [&](const Link& k) {
      return k.in[d] && k.b.line < 0 && contains(lines, k.a.line);
    });
  }

  void look_at(const model::Step& s) {
    const model::Step& first = first_of(a_.model, s);
    if (std::holds_alternative<model::StaticStep>(first.law))
      equilibrium_ = true;
    else if (const auto* t = std::get_if<model::TransientStep>(&first.law))
      equilibrium_ |= t->start == model::TransientStep::Start::static_equilibrium;
    else {
      frequency_ = true;
      frequency_settled_ |= !is_about_the_drawing(first);
    }
    if (std::holds_alternative<model::TransientStep>(s.law)) in_time_ = true;
    starts_settled_ |= in_time_ && s.from.empty() && equilibrium_;
  }

  /// What moves the lines along x in time although nothing loads them.
  bool set_moving(const std::vector<std::size_t>& lines) const {
    const model::BaseMotion& base = a_.model.base;
    if (base.acceleration[0] || base.turn) return true;
    return std::any_of(a_.model.initial.begin(), a_.model.initial.end(),
                       [&](const model::InitialMotion& i) {
                         return contains(lines, static_cast<Index>(i.shaft)) &&
                                (i.velocity.x() != 0.0 || i.displacement.x() != 0.0);
                       });
  }
  bool damped_axially(const std::vector<std::size_t>& lines) const {
    return std::any_of(
        a_.model.bearings.begin(), a_.model.bearings.end(), [&](const model::Bearing& b) {
          const auto* law = std::get_if<model::LinearBearing>(&b.law);
          const bool here = contains(lines, static_cast<Index>(b.at.shaft)) ||
                            (b.to && contains(lines, static_cast<Index>(b.to->shaft)));
          return law && here && law->C(x, x) != 0.0;
        });
  }
  /// Bent lines that small motions about the drawing leave free: held at a node along x they would
  /// bend otherwise. Along straight lines only axial motion knows.
  bool free_in_space(const std::vector<std::size_t>& lines) const {
    return bent(lines) && !frequency_settled_;
  }
  bool bent(const std::vector<std::size_t>& lines) const {
    return std::any_of(lines.begin(), lines.end(),
                       [this](std::size_t l) { return !a_.model.shafts[l].path.empty(); });
  }

  /// Weight, loads or accelerations have a moment about the axis of a line.
  bool is_turned(std::size_t l) const {
    const double length = std::max(a_.mesh.lines[l].length, 1e-300);
    const Vec3 centre = meshes::shaft_mass(a_.model, l).centre();
    const bool off_the_axis = centre.tail<2>().norm() > 1e-9 * length;
    const model::BaseMotion& base = a_.model.base;
    const bool pulled = !a_.model.gravity.isZero(0.0) || base.turn ||
                        std::any_of(base.acceleration.begin(), base.acceleration.end(),
                                    [](const LawPtr& law) { return law != nullptr; });
    const bool loaded = std::any_of(
        a_.model.loads.begin(), a_.model.loads.end(),
        [l](const model::PointLoad& f) { return f.at.shaft == l && f.moment.x() != 0.0; });
    return (off_the_axis && (pulled || in_time_)) || (loaded && has_polar_inertia(l));
  }

  /// A straight casing that could turn about its axis. One that has bends is no casing about an
  /// axis: what holds it is the equilibrium's to find (E75); one that is set turning, or that
  /// nothing holds in space, moves as it does.
  bool turns_freely(std::size_t l) {
    if (a_.model.joined(l) || bent({l}) || is_turned(l)) return false;
    const auto with = [&](const std::vector<std::size_t>& lines) {
      return contains(lines, static_cast<Index>(l));
    };
    const auto all = groups({rx});
    const std::vector<std::size_t>& lines = *std::find_if(all.begin(), all.end(), with);
    if (grounded(lines, rx) || bent(lines) || joined(lines)) return false;
    if (lines.front() != l && !a_.mesh.lines[lines.front()].rotating)
      return false;  // holds this one
    if (equilibrium_ || frequency_) return true;
    const bool supported = std::any_of(links_.begin(), links_.end(), [&](const Link& k) {
      return contains({l}, k.a.line) || contains({l}, k.b.line);
    });
    const bool set_turning = std::any_of(
        a_.model.initial.begin(), a_.model.initial.end(),
        [&](const model::InitialMotion& i) { return i.shaft == l && !i.omega.isZero(0.0); });
    return supported && !set_turning;
  }

  /// Lines in joints: their restraint is the equilibrium's to find (E75).
  bool joined(const std::vector<std::size_t>& lines) const {
    return std::any_of(lines.begin(), lines.end(),
                       [this](std::size_t l) { return a_.model.joined(l); });
  }

  double half(std::size_t l) const {
    return a_.mesh.lines[l].length > 0 ? 0.5 * a_.mesh.lines[l].length : 1.0;
  }

  /// "" when every motion of the group in the plane is resisted, else which is not ("turning of {}
  /// ..").
  std::string free_motion(const std::vector<std::size_t>& lines, Direction along,
                          Direction turn) const {
    const Index n = 2 * static_cast<Index>(lines.size());  // (sideways, turning) a line
    MatX A = MatX::Zero(n, n);
    const auto add = [&](VecX& row, const End& e, bool tilt, double sign) {
      const auto it = std::find(lines.begin(), lines.end(), static_cast<std::size_t>(e.line));
      if (e.line < 0 || it == lines.end()) return;
      const Index i = 2 * (it - lines.begin());
      const double h = half(*it), middle = 0.5 * a_.mesh.lines[*it].length;
      if (!tilt) {
        row[i] += sign;
        row[i + 1] += sign * (e.s - middle) / h;
      } else
        row[i + 1] += sign * half(lines.front()) / h;
    };
    for (const Link& k : links_)
      for (bool tilt : {false, true}) {
        if (!k.in[tilt ? turn : along] || !contains(lines, k.a.line)) continue;
        VecX row = VecX::Zero(n);
        add(row, k.a, tilt, 1.0);
        add(row, k.b, tilt, -1.0);
        A += row * row.transpose();
      }
    // Two supports at a distance of 1e-6 of the shaft still count as two.
    const la::SymmetricEigenpairs eig = la::symmetric_eigenpairs(A);
    const Index free = (eig.values.array() < 1e-12).count();
    if (free == 0) return {};
    if (free >= 2) return "lateral motion of {}";
    const VecX v = eig.vectors.col(0);
    const double side = v[0], tilt = v[1];
    if (std::abs(tilt) < 1e-6 * std::abs(side)) return "sideways motion of {}";
    const double h = half(lines.front()),
                 pivot = 0.5 * a_.mesh.lines[lines.front()].length - h * side / tilt;
    return fmt::format("turning of {{}} about the point at {:.4g} m",
                       std::abs(pivot) < 1e-9 * h ? 0.0 : pivot);
  }

  /// Free turning is no mistake where weight along the axis can give it an equilibrium (a
  /// pendulum), nor is any free motion where nothing asks for an equilibrium.
  bool wrong(const std::vector<std::size_t>& lines, const std::string& what) const {
    if (what.front() == 't' && a_.model.gravity.x() != 0) return false;
    return equilibrium_ || (frequency_ && loaded(lines, false));
  }

  bool loaded(const std::vector<std::size_t>& lines, bool axial) const {
    const auto acts = [axial](const Vec3& f) {
      return axial ? f.x() != 0 : f.y() != 0 || f.z() != 0;
    };
    for (const model::PointLoad& l : a_.model.loads)
      if (contains(lines, static_cast<Index>(l.at.shaft)) && acts(l.force)) return true;
    for (const model::Bearing& b : a_.model.bearings) {
      const Vec3 preload = model::traits_of(b.law).bias->preload.head<3>();
      if (contains(lines, static_cast<Index>(b.at.shaft)) && acts(preload)) return true;
    }
    for (const model::Step& s : a_.model.steps)
      if (const auto* h = std::get_if<model::HarmonicStep>(&s.law))
        for (const model::HarmonicForce& f : h->forces)
          if (contains(lines, static_cast<Index>(f.at.shaft)) && acts(f.force)) return true;
    return acts(a_.model.gravity);
  }

  std::string named(const std::vector<std::size_t>& lines) const {
    std::string out;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const meshes::Line& l = a_.mesh.lines[lines[i]];
      out += fmt::format("{}{} '{}'",
                         i == 0                  ? ""
                         : i + 1 == lines.size() ? " and "
                                                 : ", ",
                         l.rotating ? "shaft" : "casing", l.name);
    }
    return lines.size() > 1 ? out + " together" : out;
  }
  void complain(const std::vector<std::size_t>& lines, const std::string& motion,
                const char* hint) {
    const model::Shaft& shaft = a_.model.shafts[lines.front()];
    a_.error("E32", "nothing resists " + fmt::format(fmt::runtime(motion), named(lines)), hint,
             shaft, named({lines.front()}));
  }

  Assembly& a_;
  std::vector<Link> links_;
  std::vector<std::size_t> group_;
  bool equilibrium_ = false, frequency_ = false, in_time_ = false, starts_settled_ = false,
       frequency_settled_ = false;  ///< some frequencies are about an equilibrium
};

/// A shaft that no support of its own holds along its axis.
bool may_move_axially(const model::Model& m) {
  for (std::size_t k = 0; k < m.shafts.size(); ++k)
    if (std::none_of(m.bearings.begin(), m.bearings.end(), [k](const model::Bearing& b) {
          return b.at.shaft == k && !b.to && resisted(b)[x];
        }))
      return true;
  return false;
}

}  // namespace

std::string system_key(const model::Model& m, const model::Step& step) {
  const bool drives = std::any_of(m.drives.begin(), m.drives.end(),
                                  [&](const model::Drive& d) { return d.step == step.name; });
  const auto* first = std::get_if<model::TransientStep>(&first_of(m, step).law);
  const bool settled = !first || first->start == model::TransientStep::Start::static_equilibrium;
  const bool set_moving = !m.initial.empty() || m.base.acceleration[0] || m.base.turn;
  const bool in_time = std::holds_alternative<model::TransientStep>(step.law);
  // what is free along its axis stays so in small motions, and is held in time
  const bool held_along = in_time && settled && !set_moving && may_move_axially(m);
  const bool drawn =
      is_about_the_drawing(step) &&
      std::any_of(m.shafts.begin(), m.shafts.end(), [](const auto& s) { return !s.path.empty(); });
  return fmt::format("{}{}{}{}{}{}", drives ? step.name : "", settled ? "" : "; from rest",
                     in_time && set_moving ? "; set moving" : "", held_along ? "; held along" : "",
                     drawn ? "; as drawn" : "", follows_oil(m, step) ? "; oil followed" : "");
}

void check_restraint(Assembly& a) {
  Restraint r(a);
  r.check_axial();
  r.check_lateral();
  r.check_spin();
}

}  // namespace whirl::assembly
