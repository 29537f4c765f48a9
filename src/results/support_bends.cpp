#include <results/support_bends.hpp>
#include <core/contract.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <variant>

namespace whirl::results {

namespace {

/// Of a force to which its linear part is nothing.
constexpr double without_bound = 1e3;

}  // namespace

void Bend::take(const Vec3& there, const Vec3& rest, const Vec3& linear_part) {
  if (!there.allFinite() || !rest.allFinite() || !linear_part.allFinite()) return;
  linear = std::max(linear, linear_part.norm());
  off = std::max(off, (there - rest - linear_part).norm());
  still = std::max(still, rest.norm());
}

double Bend::share() const {
  return off < without_bound * linear ? off / linear : off > 0 ? without_bound : 0.0;
}

bool Bend::beyond(const Bend& other) const {
  return share() != other.share() ? share() > other.share() : off > other.off;
}

bool Bend::matters(double most) const {
  constexpr double straight = 0.3;
  // what hardly acts misleads nobody, nor does rounding of what stands still
  return share() > straight && off > 1e-3 * most && off > 1e-8 * still;
}

void MostLinear::take(const std::vector<SupportBend>& bends, double length) {
  for (const SupportBend& x : bends) {
    force = std::max(force, x.force.linear);
    moment = std::max({moment, x.moment.linear, length * x.force.linear});
  }
}

double longest_line(const run::Job& job) {
  double length = 0;
  for (const meshes::Line& line : job.mesh.lines)
    length = std::max(length, line.length);
  return length;
}

SupportBends::SupportBends(const run::Job& job, const system::State& still, bool averaged)
    : job_(job),
      still_(still),
      w_(job.system().make_workspace()),
      bends_(job.built.support_forces.size()) {
  w_.context.averaged = averaged;
  w_.context.time = still.t;
  rest_ = at(still.q);
}

SupportBends::Loads SupportBends::at(const VecX& q) {
  const std::vector<assembly::SupportForce>& supports = job_.built.support_forces;
  Loads out = Loads::Constant(6, static_cast<Index>(supports.size()), nan);
  if (!job_.system().evaluate_nodes(w_, still_.frames, still_.t, q, still_.v, still_.a)) return out;
  const auto node = [this](Index n) -> const system::NodeState& { return w_.in_own_axes(n); };
  const auto reaction = [](Index) { return 0.0; };
  for (std::size_t i = 0; i < supports.size(); ++i) {
    auto load = out.col(static_cast<Index>(i));
    load.head<3>() = supports[i].force(node, w_.context, reaction);
    load.tail<3>().setZero();
    if (supports[i].moment) load.tail<3>() = supports[i].moment(node, w_.context, reaction);
  }
  return out;
}

SupportBends::Loads SupportBends::linear_along(const VecX& way) {
  constexpr double small = 1e-3;
  const Loads on = at(still_.q + small * way), back = at(still_.q - small * way);
  return (on - back) / (2 * small);
}

void SupportBends::look(const VecX& way, const Loads& linear) {
  WHIRL_EXPECTS(linear.cols() == rest_.cols());
  const Loads there = at(still_.q + way);
  for (Index i = 0; i < there.cols(); ++i) {
    SupportBend& x = bends_[static_cast<std::size_t>(i)];
    x.force.take(there.col(i).head<3>(), rest_.col(i).head<3>(), linear.col(i).head<3>());
    x.moment.take(there.col(i).tail<3>(), rest_.col(i).tail<3>(), linear.col(i).tail<3>());
  }
}

std::string text_of(const SupportBend& x, const MostLinear& most, const std::string& name) {
  WHIRL_EXPECTS(most.misled_by(x));
  // a play that small motions do not close gives nothing at all, a spring that stiffens a little
  constexpr double nothing = 1e-7, nearly_all = 10;
  const bool force = x.force.matters(most.force);
  const Bend& b = force ? x.force : x.moment;
  const char* unit = force ? "N" : "N m";
  if (b.linear <= nothing * b.off)
    return fmt::format("'{}' into contact, where it would {} with {:.3g} {}", name,
                       force ? "press" : "turn back", b.off, unit);
  if (b.share() > nearly_all)
    return fmt::format("'{}' so far that its {} is {:.3g} {} beside a linear part of {:.2g} {}",
                       name, force ? "force" : "moment", b.off, unit, b.linear, unit);
  return fmt::format("'{}' so far that its {} leaves its linear part by {:.2g} of it", name,
                     force ? "force" : "moment", b.share());
}

void CurrentNeed::take(double asked_current, double asked_rate, double place) {
  if (asked_current > current) {
    current = asked_current;
    current_at = place;
  }
  if (asked_rate > rate) {
    rate = asked_rate;
    rate_at = place;
  }
}

std::vector<CurrentNeed> current_needs(const run::Job& job) {
  std::vector<CurrentNeed> out;
  for (const assembly::MagneticControl& c : job.built.magnetic_controls) {
    const auto& law = std::get<model::MagneticBearing>(job.model.bearings[c.bearing].law);
    CurrentNeed need;
    need.bearing = c.bearing;
    need.most_current = law.current_limit;
    need.most_rate = law.rate_limit;
    out.push_back(need);
  }
  return out;
}

std::string text_of(const CurrentNeed& x, bool of_rate, const std::string& name) {
  const char* unit = of_rate ? "A/s" : "A";
  return fmt::format("{:.4g} {} of magnet '{}', whose amplifier gives {:.4g} {}",
                     of_rate ? x.rate : x.current, unit, name,
                     of_rate ? x.most_rate : x.most_current, unit);
}

}  // namespace whirl::results
