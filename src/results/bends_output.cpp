// Where linear motion in time takes supports beyond their linear part, and amplifiers of magnetic
// bearings beyond what they give (W11). Films, seals and contacts with a gap: limits_output.cpp.
#include <results/clearances.hpp>
#include <results/linear_limits.hpp>
#include <results/support_bends.hpp>
#include <results/transient_output.hpp>
#include <analysis/transient/linear_motion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::results {

namespace {

/// Supports whose force may leave its linear part and that no gap speaks for.
std::vector<std::size_t> bending_supports(const run::Job& job) {
  const std::vector<std::size_t> seals = seals_of(job.model);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < job.model.bearings.size(); ++i) {
    const model::SupportTraits traits = model::traits_of(job.model.bearings[i].law);
    const auto& conditions = job.built.conditions;
    const bool magnet = std::holds_alternative<model::MagneticBearing>(job.model.bearings[i].law);
    const bool by_gap =
        std::find(seals.begin(), seals.end(), i) != seals.end() ||
        std::any_of(conditions.begin(), conditions.end(),
                    [i](const assembly::SupportCondition& c) { return c.bearing == i; });
    const bool straight =
        traits.stiffness->has_value() || traits.film || traits.acts == model::Acts::as_constraint;
    if (!straight && (magnet || !by_gap)) out.push_back(i);
  }
  return out;
}

/// Keeps the motions that take each support furthest along every direction. What its force is there
/// is asked at the end: a step costs a look at the places of the supports.
class BendWatch final : public analysis::Observer {
 public:
  BendWatch(const run::Job& job, const analysis::LinearMotion& motion,
            std::vector<std::size_t> supports)
      : job_(job),
        motion_(motion),
        supports_(std::move(supports)),
        furthest_(supports_.size()),
        currents_(current_needs(job)) {}
  void begin(const analysis::Snapshot& s) override { look(s); }
  void step(analysis::StepAccess& s) override { look(s.end()); }
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  const std::vector<CurrentNeed>& currents() const { return currents_; }

  struct Bent {
    SupportBend bend;
    double time = nan;
  };
  /// Where each support of the model was furthest off its linear part.
  std::vector<Bent> bent(MostLinear& most) const;

 private:
  struct Way {
    double reach = 0, time = nan;  ///< m or rad; s
    VecX beside;                   ///< of all unknowns, beside the steady motion
  };
  /// Both senses of six directions, and across the shaft.
  static constexpr std::size_t directions = 13;

  void look(const analysis::Snapshot& s);
  void take(Way& way, double reach, const analysis::Snapshot& s) const;

  const run::Job& job_;
  const analysis::LinearMotion& motion_;
  std::vector<std::size_t> supports_;
  std::vector<std::array<Way, directions>> furthest_;
  std::vector<CurrentNeed> currents_;
};

void BendWatch::take(Way& way, double reach, const analysis::Snapshot& s) const {
  constexpr double further = 1.01;  // so that a motion is kept now and then only
  if (!(reach > further * way.reach)) return;
  way.reach = reach;
  way.time = s.t();
  motion_.steady(s.t(), way.beside);
  way.beside = s.q() - way.beside;
}

void BendWatch::look(const analysis::Snapshot& s) {
  for (std::size_t i = 0; i < supports_.size(); ++i) {
    const meshes::BearingNodes& nodes = job_.mesh.bearings[supports_[i]];
    Vector<6> x = motion_.beside(s.t(), s.q(), nodes.shaft.node);
    if (nodes.other.node >= 0) x -= motion_.beside(s.t(), s.q(), nodes.other.node);
    std::array<Way, directions>& ways = furthest_[i];
    for (Index c = 0; c < 6; ++c) {
      take(ways[2 * static_cast<std::size_t>(c)], x[c], s);
      take(ways[2 * static_cast<std::size_t>(c) + 1], -x[c], s);
    }
    take(ways.back(), x.segment<2>(1).norm(), s);
  }
  for (std::size_t i = 0; i < currents_.size(); ++i) {
    const assembly::MagneticControl& c = job_.built.magnetic_controls[i];
    for (const Index node : c.currents)
      currents_[i].take(std::abs(c.current_unit * s.q()[6 * node]),
                        std::abs(c.current_unit * s.v()[6 * node]), s.t());
  }
}

std::vector<BendWatch::Bent> BendWatch::bent(MostLinear& most) const {
  std::vector<Bent> out(job_.built.support_forces.size());
  system::State still = job_.system().make_state();
  still.frames = motion_.frames;
  for (const std::array<Way, directions>& ways : furthest_)
    for (const Way& way : ways) {
      if (std::isnan(way.time)) continue;
      still.t = way.time;
      motion_.steady(way.time, still.q);
      still.v = motion_.steady_rates();
      SupportBends supports(job_, still, false);
      supports.look(way.beside, supports.linear_along(way.beside));
      most.take(supports.bends(), longest_line(job_));
      for (const std::size_t i : supports_)
        if (supports.bends()[i].beyond(out[i].bend)) out[i] = {supports.bends()[i], way.time};
    }
  return out;
}

void BendWatch::save(OutArchive& out) const {
  for (const std::array<Way, directions>& ways : furthest_)
    for (const Way& way : ways) {
      out.put(way.reach);
      out.put(way.time);
      out.put(way.beside);
    }
  for (const CurrentNeed& x : currents_)
    for (const double v : {x.current, x.rate, x.current_at, x.rate_at})
      out.put(v);
}

void BendWatch::restore(InArchive& in) {
  for (std::array<Way, directions>& ways : furthest_)
    for (Way& way : ways) {
      way.reach = in.number();
      way.time = in.number();
      way.beside = in.vector();
    }
  for (CurrentNeed& x : currents_)
    for (double* v : {&x.current, &x.rate, &x.current_at, &x.rate_at})
      *v = in.number();
}

class BendsOutput final : public TransientOutput {
 public:
  BendsOutput(const TransientSetup& s, const std::vector<std::size_t>& supports)
      : content_("beyond linear"),
        watch_(s.job, *s.motion, supports) {
    for (const std::size_t i : supports)
      content_ += fmt::format(" {}", s.job.model.bearings[i].name);
  }
  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&watch_);
    parts.add({run::Part::limits, content_}, watch_);
  }
  void summarize(TransientEnd& end) override {
    for (const CurrentNeed& x : watch_.currents())
      for (const bool of_rate : {false, true})
        if (of_rate ? x.beyond_rate() : x.beyond_current()) say(end, x, of_rate);
    MostLinear most;
    const std::vector<BendWatch::Bent> bent = watch_.bent(most);
    for (std::size_t i = 0; i < bent.size(); ++i)
      if (most.misled_by(bent[i].bend) && !amplifier_named(i))
        say(end, i,
            fmt::format("at t = {:.6g} s the motion takes {}", bent[i].time,
                        text_of(bent[i].bend, most, end.job.model.bearings[i].name)));
  }

 private:
  bool amplifier_named(std::size_t bearing) const {
    return std::any_of(
        watch_.currents().begin(), watch_.currents().end(),
        [bearing](const CurrentNeed& x) { return x.bearing == bearing && x.beyond_current(); });
  }
  static void say(TransientEnd& end, const CurrentNeed& x, bool of_rate) {
    say(end, x.bearing,
        fmt::format("at t = {:.6g} s the motion needs {}", of_rate ? x.rate_at : x.current_at,
                    text_of(x, of_rate, end.job.model.bearings[x.bearing].name)));
  }
  static void say(TransientEnd& end, std::size_t bearing, const std::string& what) {
    Diagnostic d;
    d.code = "W11";
    d.message = fmt::format("step '{}': {}: linear motion does not know it", end.step.name, what);
    d.hint = "without linear = true the step meets it as it is";
    d.where = end.job.model.bearings[bearing].where;
    warn(end.job, std::move(d));
  }

  std::string content_;
  BendWatch watch_;
};

}  // namespace

void add_bends(const TransientSetup& setup, TransientOutputs& outputs) {
  if (!setup.motion) return;
  const std::vector<std::size_t> supports = bending_supports(setup.job);
  if (!supports.empty()) outputs.push_back(std::make_unique<BendsOutput>(setup, supports));
}

}  // namespace whirl::results
