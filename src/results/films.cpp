// Films of journal bearings at an equilibrium: table, pictures, and whether they are laminar.
#include <results/linear_limits.hpp>
#include <results/support_coefficients.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {
namespace {

constexpr double to_degrees = 180.0 / pi;
constexpr double zero_celsius = 273.15;

/// The angle of a place on a pad, from 0 to 360.
double degrees_of(double theta) {
  const double turns = theta / two_pi;
  return 360.0 * (turns - std::floor(turns));
}

double mean(const std::vector<double>& x) {
  double sum = 0.0;
  for (const double v : x)
    sum += v;
  return sum / static_cast<double>(x.size());
}

double error_of(const std::vector<double>& of_pads, std::size_t k) {
  return of_pads.empty() ? nan : of_pads[k];
}

void add_pad_row(io::Table& t, const SupportCoefficients& c, std::size_t k) {
  const elements::FilmStanding& s = c.films->pads[k];
  double in = nan, out = nan, face = nan, face_at = nan, film = nan, pad = nan, journal = nan,
         growth = nan, to_pad = nan, to_journal = nan, to_oil = nan, hot = nan, returned = nan,
         bath = nan;
  if (c.films->heat) {
    const elements::PadTemperatures& h = c.films->heat->pads[k];
    in = h.in - zero_celsius;
    out = h.out - zero_celsius;
    face = h.hottest - zero_celsius;
    face_at = degrees_of(h.hottest_at);
    film = h.film_hottest - zero_celsius;
    pad = h.pad - zero_celsius;
    journal = c.films->heat->journal - zero_celsius;
    growth = c.films->heat->growth[k] * c.films->clearances[k];
    to_pad = h.to_pad;
    to_journal = h.to_journal;
    to_oil = h.to_oil;
    hot = h.hot_share;
    returned = h.returned;
    bath = h.beyond_at - zero_celsius;
  }
  t.add({c.name,
         to_rpm(c.spin),
         static_cast<double>(k + 1),
         s.force.norm(),
         s.power,
         s.inflow,
         s.outflow,
         s.side_flow,
         s.thinnest,
         degrees_of(s.thinnest_at),
         s.highest,
         degrees_of(s.highest_at),
         s.reynolds,
         mean(c.films->fields[k].viscosity),
         nan,
         in,
         out,
         face,
         face_at,
         film,
         pad,
         journal,
         growth,
         to_pad,
         to_journal,
         nan,
         error_of(c.films->pressure_error, k),
         error_of(c.films->flow_error, k),
         to_oil,
         hot,
         returned,
         bath,
         nan});
}

void add_sum_row(io::Table& t, const SupportCoefficients& c) {
  Vec2 force = Vec2::Zero();
  elements::FilmStanding sum;
  sum.thinnest = infinity;
  double pressure_error = nan, flow_error = 0.0;
  for (std::size_t k = 0; k < c.films->pads.size(); ++k) {
    const elements::FilmStanding& s = c.films->pads[k];
    const double of_flow = error_of(c.films->flow_error, k);
    flow_error += s.side_flow == 0.0 ? 0.0 : of_flow * s.side_flow;
    force += s.force;
    sum.power += s.power;
    sum.side_flow += s.side_flow;
    sum.reynolds = std::max(sum.reynolds, s.reynolds);
    if (s.thinnest < sum.thinnest) {
      sum.thinnest = s.thinnest;
      sum.thinnest_at = s.thinnest_at;
    }
    if (s.highest > sum.highest) {
      sum.highest = s.highest;
      sum.highest_at = s.highest_at;
      pressure_error = error_of(c.films->pressure_error, k);
    }
  }
  double face = nan, face_at = nan, film = nan, journal = nan, to_pad = nan, to_journal = nan,
         to_oil = nan, returned = nan, bath = nan, supply = nan;
  if (c.films->heat) {
    bath = c.films->heat->bath - zero_celsius;
    supply = c.films->heat->supply_flow;
    journal = c.films->heat->journal - zero_celsius;
    face = film = -infinity;
    to_pad = to_journal = to_oil = returned = 0.0;
    for (const elements::PadTemperatures& h : c.films->heat->pads) {
      if (h.hottest - zero_celsius > face) {
        face = h.hottest - zero_celsius;
        face_at = degrees_of(h.hottest_at);
      }
      film = std::max(film, h.film_hottest - zero_celsius);
      to_pad += h.to_pad;
      to_journal += h.to_journal;
      to_oil += h.to_oil;
      returned += h.returned;
    }
  }
  t.add({c.name,
         to_rpm(c.spin),
         0,
         force.norm(),
         sum.power,
         nan,
         nan,
         sum.side_flow,
         sum.thinnest,
         degrees_of(sum.thinnest_at),
         sum.highest,
         degrees_of(sum.highest_at),
         sum.reynolds,
         c.films->viscosity,
         c.films->effective_temperature - zero_celsius,
         nan,
         nan,
         face,
         face_at,
         film,
         nan,
         journal,
         nan,
         to_pad,
         to_journal,
         c.films->face_error,
         pressure_error,
         sum.side_flow > 0.0 ? flow_error / sum.side_flow : nan,
         to_oil,
         nan,
         returned,
         bath,
         supply});
}

/// A curve along all pads, broken between them.
template <class Of>
plot::Series along_pads(const std::vector<elements::FilmField>& fields, std::string label,
                        const Of& of) {
  plot::Series s;
  s.label = std::move(label);
  s.keep_all = true;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if (k > 0) {
      s.x.push_back(nan);
      s.y.push_back(nan);
    }
    of(k, s);
  }
  return s;
}

struct FilmCurves {
  plot::Series pressure, thickness, film, face;
};

FilmCurves curves_of(const FilmResults& f) {
  FilmCurves out;
  const auto field = [&](std::string label, double factor, auto member) {
    return along_pads(f.fields, std::move(label), [&, factor](std::size_t k, plot::Series& s) {
      const elements::FilmField& x = f.fields[k];
      for (std::size_t i = 0; i < x.theta.size(); ++i) {
        s.x.push_back(x.theta[i] * to_degrees);
        s.y.push_back(factor * (x.*member)[i]);
      }
    });
  };
  out.pressure = field("pressure", 1e-6, &elements::FilmField::largest);
  out.thickness = field("film thickness", 1e6, &elements::FilmField::thickness);
  out.thickness.style = {1, plot::Dash::dashed, 1.6};
  if (!f.heat) return out;
  const auto heat = [&](std::string label, auto member) {
    return along_pads(f.fields, std::move(label), [&](std::size_t k, plot::Series& s) {
      const elements::PadTemperatures& x = f.heat->pads[k];
      for (std::size_t i = 0; i < x.theta.size(); ++i) {
        s.x.push_back(x.theta[i] * to_degrees);
        s.y.push_back((x.*member)[i] - zero_celsius);
      }
    });
  };
  out.face = heat("face of the pad", &elements::PadTemperatures::face);
  out.film = heat("film, mean across", &elements::PadTemperatures::film);
  out.film.style = {1, plot::Dash::dashed, 1.6};
  return out;
}

plot::Figure draw_unrolled(const std::string& name, const SupportCoefficients& c) {
  plot::Figure f;
  f.name = name;
  f.title = fmt::format("Films of '{}' at {:.6g} rpm, unrolled", c.name, to_rpm(c.spin));
  f.caption = "Largest pressure along the bearing's axis, above ambient; angles from y to z.";
  FilmCurves curves = curves_of(*c.films);
  plot::Axes a;
  a.x = plot::Axis("angle", "deg");
  a.y = plot::Axis("pressure", "MPa");
  a.y.include_zero = true;
  a.right = plot::Axis("film thickness", "µm");
  a.right.include_zero = true;
  curves.thickness.right_axis = true;
  a.series.push_back(std::move(curves.pressure));
  a.series.push_back(std::move(curves.thickness));
  f.axes.push_back(std::move(a));
  if (!c.films->heat) return f;
  plot::Axes t;
  t.x = plot::Axis("angle", "deg");
  t.y = plot::Axis("temperature", "degC");
  t.share_x = true;
  t.series.push_back(std::move(curves.face));
  t.series.push_back(std::move(curves.film));
  t.rules.push_back({false, c.films->heat->journal - zero_celsius, "journal"});
  f.axes.push_back(std::move(t));
  f.height = 640;
  return f;
}

plot::Figure draw_round(const std::string& name, const SupportCoefficients& c) {
  plot::Figure f;
  f.name = name;
  f.title = fmt::format("Films of '{}' at {:.6g} rpm, round the journal", c.name, to_rpm(c.spin));
  f.caption = "Seen against +x: y to the right, z upwards.";
  f.columns = c.films->heat ? 3 : 2;
  f.height = 340;
  FilmCurves curves = curves_of(*c.films);
  const auto add = [&](const char* what, const char* unit, std::vector<plot::Series> series) {
    plot::Axes a;
    a.kind = plot::AxesKind::polar;
    a.title = fmt::format("{}, {}", what, unit);
    a.x = plot::Axis("angle", "deg");
    a.y = plot::Axis(what, unit);
    a.legend = series.size() > 1;
    a.series = std::move(series);
    f.axes.push_back(std::move(a));
  };
  add("pressure", "MPa", {std::move(curves.pressure)});
  add("film thickness", "µm", {std::move(curves.thickness)});
  if (c.films->heat) add("temperature", "degC", {std::move(curves.face), std::move(curves.film)});
  return f;
}

}  // namespace

io::Table film_table(std::span<const SupportCoefficients> list) {
  io::Table t;
  t.title = "Films at the equilibrium";
  t.nan_means =
      "of the whole bearing there is no such number, its film has no heat balance, or it is solved "
      "along the axis";
  t.nan_is_absence = true;
  t.columns = {
      {"bearing", "-", ""},
      {"speed", "rpm", ""},
      {"pad", "-", "0: all of the bearing"},
      {"film load", "N", "on the pad"},
      {"power loss", "W", "in its film"},
      {"inflow", "m^3/s", "through the leading edge"},
      {"outflow", "m^3/s", "through the trailing edge, and by a relief track"},
      {"side flow", "m^3/s", "at both sides"},
      {"smallest film", "m", ""},
      {"angle of smallest film", "deg", "from +y towards +z"},
      {"largest pressure", "Pa", "above ambient"},
      {"angle of largest pressure", "deg", ""},
      {"Reynolds number", "-", "largest rho R |s| h/eta"},
      {"effective viscosity", "Pa s", "mean along the pad"},
      {"effective temperature", "degC", "of oil with that viscosity, all pads"},
      {"oil in", "degC", "at the leading edge"},
      {"oil out", "degC", "at the trailing edge"},
      {"hottest face", "degC", "of the pad"},
      {"angle of hottest face", "deg", ""},
      {"hottest oil", "degC", "anywhere in the film"},
      {"pad", "degC", "mean of the pad"},
      {"journal", "degC", ""},
      {"growth of clearance", "m", "as assembled, by the temperatures"},
      {"heat into pad", "W", ""},
      {"heat into journal", "W", "from this film; in sum none"},
      {"error of hottest face", "K", "by the grid of the heat balance, any pad"},
      {"axial error of pressure", "-", "of the largest; a film solved along the axis too"},
      {"axial error of side flow", "-", "likewise"},
      {"heat into oil", "W",
       "that leaves the film with it, over oil as fed; with pads the loss and what is returned"},
      {"hot oil in inflow", "-", "from the pad before, of what enters"},
      {"heat returned", "W",
       "by the oil about the pads, in what enters beyond that of the pad before"},
      {"oil about the pads", "degC", "what enters beyond that of the pad before; all pads: mixed"},
      {"supply flow", "m^3/s", "with which the oil about the pads is as warm; or that given"}};
  for (const SupportCoefficients& c : list) {
    if (!c.films) continue;
    for (std::size_t k = 0; k < c.films->pads.size(); ++k)
      add_pad_row(t, c, k);
    add_sum_row(t, c);
  }
  return t;
}

std::vector<plot::Figure> draw_films(const std::string& name,
                                     std::span<const SupportCoefficients> list) {
  std::vector<plot::Figure> out;
  int number = 0;
  for (const SupportCoefficients& c : list) {
    if (!c.films) continue;
    ++number;
    const std::string own = list.size() == 1 ? name : fmt::format("{}_{}", name, number);
    out.push_back(draw_unrolled(own, c));
    out.push_back(draw_round(own + "_round", c));
  }
  return out;
}

std::optional<plot::Figure> draw_film_trends(const std::string& name,
                                             std::span<const SupportCoefficients> list) {
  plot::Figure f;
  f.name = name;
  f.title = "Power loss and oil of the films against speed";
  plot::Axes power, hot;
  power.x = hot.x = plot::Axis("speed", "rpm");
  power.y = plot::Axis("power loss", "kW");
  power.y.include_zero = true;
  power.right = plot::Axis("side flow", "L/min");
  power.right.include_zero = true;
  hot.y = plot::Axis("hottest face of a pad", "degC");
  std::vector<std::string> names;
  for (const SupportCoefficients& c : list)
    if (c.films && std::find(names.begin(), names.end(), c.name) == names.end())
      names.push_back(c.name);
  if (names.empty()) return std::nullopt;
  bool heated = false;
  for (std::size_t n = 0; n < names.size(); ++n) {
    plot::Series loss, flow, face;
    loss.label = names[n] + ", loss";
    flow.label = names[n] + ", side flow";
    face.label = names[n];
    loss.style = face.style = {static_cast<int>(n), plot::Dash::solid, 1.6};
    flow.style = {static_cast<int>(n), plot::Dash::dashed, 1.6};
    flow.right_axis = true;
    for (const SupportCoefficients& c : list) {
      if (!c.films || c.name != names[n]) continue;
      double sum = 0.0, side = 0.0, hottest = nan;
      for (const elements::FilmStanding& s : c.films->pads) {
        sum += 1e-3 * s.power;
        side += 6e4 * s.side_flow;
      }
      if (c.films->heat)
        for (const elements::PadTemperatures& h : c.films->heat->pads)
          hottest = std::fmax(hottest, h.hottest - zero_celsius);
      heated = heated || c.films->heat;
      for (plot::Series* s : {&loss, &flow, &face})
        s->x.push_back(to_rpm(c.spin));
      loss.y.push_back(sum);
      flow.y.push_back(side);
      face.y.push_back(hottest);
    }
    power.series.push_back(std::move(loss));
    power.series.push_back(std::move(flow));
    hot.series.push_back(std::move(face));
  }
  f.axes.push_back(std::move(power));
  if (heated) {
    f.axes.push_back(std::move(hot));
    f.height = 640;
  }
  return f;
}

void warn_of_turbulence(run::Job& job, const std::string& step,
                        std::span<const SupportCoefficients> list) {
  for (const model::Bearing& b : job.model.bearings) {
    const SupportCoefficients* worst = nullptr;
    for (const SupportCoefficients& c : list) {
      if (c.name != b.name || !c.films || !c.films->laminar) continue;
      if (c.films->reynolds <= c.films->transition) continue;
      if (!worst || c.films->reynolds > worst->films->reynolds) worst = &c;
    }
    if (!worst) continue;
    Diagnostic d;
    d.code = "W03";
    d.message = fmt::format(
        "step '{}': the film of bearing '{}' is laminar in the deck; at {:.6g} rpm its Reynolds "
        "number rho R |s| c/eta is {:.4g}, beyond 41.2 sqrt(R/c) = {:.4g}, from which on vortices "
        "and turbulence are to be expected: more loss, a thicker film",
        step, b.name, to_rpm(worst->spin), worst->films->reynolds, worst->films->transition);
    d.hint = "turbulence = \"ng_pan\"";
    d.where = b.where;
    warn(job, std::move(d));
  }
}

namespace {

/// The heat of its films; null: they have none.
const model::FilmHeat* heat_of(const model::Bearing& b) {
  const model::FilmFlow* flow = nullptr;
  if (const auto* journal = std::get_if<model::FiniteJournal>(&b.law)) flow = &journal->flow;
  if (const auto* pads = std::get_if<model::TiltingPadJournal>(&b.law)) flow = &pads->flow;
  return flow && flow->heat ? &*flow->heat : nullptr;
}

/// Whether its temperatures go with the motion, late as they should be.
bool follows(const model::Bearing& b, bool linear) {
  const model::FilmHeat* heat = heat_of(b);
  return !linear && heat && std::isfinite(heat->time_constant);
}

/// Which pads take in less hot oil than carry_over, as those before them give no more; empty: none.
std::string line_of_limits(const elements::HeatBalance& heat, double carry_over) {
  std::string pads;
  for (std::size_t k = 0; k < heat.pads.size(); ++k) {
    const double share = heat.pads[k].hot_share;
    if (heat.pads[k].heat > 0.0 && share < carry_over * (1 - 1e-6))
      pads += fmt::format("{}pad {}: {:.3g}", pads.empty() ? "" : ", ", k + 1, share);
  }
  if (pads.empty()) return {};
  return fmt::format(
      "less hot oil than carry_over = {:.3g} of what enters ({}): the pad before gives no more",
      carry_over, pads);
}

/// How warm the oil about the pads is, and why; empty: at rest, or nothing enters from there.
std::string line_of_bath(const elements::HeatBalance& heat) {
  double returned = 0.0;
  for (const elements::PadTemperatures& t : heat.pads)
    returned += t.returned;
  if (std::isnan(heat.supply_flow) || !(returned > 0.0)) return {};
  return fmt::format(
      "the oil about the pads has {:.4g} degC and returns {:.4g} W to them, with {:.4g} L/min of "
      "fresh oil",
      heat.bath - zero_celsius, returned, 6e4 * heat.supply_flow);
}

}  // namespace

std::vector<std::string> groove_lines(const run::Job& job,
                                      std::span<const SupportCoefficients> list) {
  std::vector<std::string> out;
  for (const SupportCoefficients& c : list) {
    if (!c.films || !c.films->heat) continue;
    const auto named = std::find_if(job.model.bearings.begin(), job.model.bearings.end(),
                                    [&](const model::Bearing& b) { return b.name == c.name; });
    if (named == job.model.bearings.end() || !heat_of(*named)) continue;
    const std::string line = std::isnan(c.films->heat->bath)
                                 ? line_of_limits(*c.films->heat, heat_of(*named)->carry_over)
                                 : line_of_bath(*c.films->heat);
    if (!line.empty())
      out.push_back(fmt::format("bearing '{}' at {:.6g} rpm: {}", c.name, to_rpm(c.spin), line));
  }
  return out;
}

void warn_of_hot_bath(run::Job& job, const std::string& step,
                      std::span<const SupportCoefficients> list) {
  for (const model::Bearing& b : job.model.bearings) {
    if (!heat_of(b) || !std::isnan(heat_of(b)->supply_flow)) continue;
    const SupportCoefficients* worst = nullptr;
    std::size_t pad = 0;
    double most = 0.01;  // K: less is the rounding of a bath that is as warm
    for (const SupportCoefficients& c : list) {
      if (c.name != b.name || !c.films || !c.films->heat) continue;
      const elements::HeatBalance& heat = *c.films->heat;
      for (std::size_t k = 0; k < heat.pads.size(); ++k) {
        if (!(heat.pads[k].beyond_at - heat.mixed > most)) continue;
        most = heat.pads[k].beyond_at - heat.mixed;
        worst = &c;
        pad = k;
      }
    }
    if (!worst) continue;
    const elements::HeatBalance& heat = *worst->films->heat;
    Diagnostic d;
    d.code = "W03";
    d.message = fmt::format(
        "step '{}': bearing '{}' at {:.6g} rpm: with carry_over = {:.4g} the oil about the pads "
        "that enters pad {} would have {:.4g} degC, and what leaves the films has {:.4g} in the "
        "mean: no bath of that oil is as warm",
        step, b.name, to_rpm(worst->spin), heat_of(b)->carry_over, pad + 1,
        heat.pads[pad].beyond_at - zero_celsius, heat.mixed - zero_celsius);
    d.hint = "a lower carry_over, or supply_flow, which predicts how warm that oil is";
    d.where = b.where;
    warn(job, std::move(d));
  }
}

void report_kept_films(run::Job& job, const std::string& step, const system::State& end,
                       bool linear) {
  if (std::none_of(job.built.films.begin(), job.built.films.end(),
                   [](const assembly::FilmBearing& f) { return f.heated; }))
    return;
  system::Workspace w = job.system().make_workspace();
  if (!job.system().evaluate_nodes(w, end.frames, end.t, end.q, end.v, end.a)) return;
  std::vector<double> settled;
  job.system().settle_kept(w, settled);
  for (const assembly::FilmBearing& f : job.built.films) {
    if (!f.heated) continue;
    const model::Bearing& b = job.model.bearings[f.bearing];
    double sum = 0.0, count = 0.0;
    const std::size_t first = static_cast<std::size_t>(f.kept_from);
    for (std::size_t i = 0; i < f.kept; ++i)
      if (i % f.kept_each >= elements::FiniteJournal::kept_growths) {
        sum += settled[first + i] - end.frames.kept[first + i];
        count += 1.0;
      }
    const double ratio = std::exp(sum / count);
    job.summary["steps"][step]["film viscosity in balance over that kept"][b.name] = ratio;
    if (std::abs(ratio - 1.0) <= 0.05 || follows(b, linear)) continue;
    Diagnostic d;
    d.code = "W03";
    d.message = fmt::format(
        "step '{}': the film of bearing '{}' kept the temperatures of its start; in balance with "
        "the last state its viscosity would be {:.3g} times what it was, in the mean",
        step, b.name, ratio);
    d.hint = linear ? "start from a static step near the speed of interest: small motions do not "
                      "heat films"
                    : "time_constant of heat lets them follow; or start from a static step near "
                      "the speed of interest";
    d.where = b.where;
    warn(job, std::move(d));
  }
}

}  // namespace whirl::results
