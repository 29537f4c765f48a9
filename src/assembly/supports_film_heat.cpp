// Films of journal bearings for results, and their heat among what states keep.
#include <assembly/film_kernels.hpp>
#include <assembly/support_parts.hpp>
#include <core/contract.hpp>
#include <core/error.hpp>
#include <core/units.hpp>
#include <elements/films/oil.hpp>
#include <elements/films/root_between.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::assembly {

namespace {

constexpr int knots = 21;
constexpr double coldest_grade = 243.15, hottest_grade = 473.0;  // K, of the law of grades

}  // namespace

double viscosity_at(const model::Oil& o, double temperature) {
  if (o.viscosity > 0) return o.viscosity * std::exp(-o.thinning * (temperature - o.temperature));
  return elements::iso_vg_viscosity(o.grade, temperature, o.density);
}

double temperature_of(const model::Oil& o, double viscosity) {
  const double wanted = std::log(viscosity);
  const auto thinner = [&](double T) { return wanted - std::log(viscosity_at(o, T)); };
  if (thinner(coldest_grade) >= 0) return coldest_grade;
  if (thinner(hottest_grade) <= 0) return hottest_grade;
  return elements::root_between(coldest_grade, hottest_grade, 1.0, thinner);
}

elements::HeatSettings heat_settings(const model::FilmFlow& flow, const model::Oil& oil,
                                     bool tilting) {
  WHIRL_EXPECTS(flow.heat.has_value());
  const model::FilmHeat& h = *flow.heat;
  elements::HeatSettings s;
  s.density = oil.density;
  s.specific_heat = h.specific_heat;
  s.conductivity = h.conductivity;
  s.supply_temperature = h.supply_temperature;
  s.carry_over = h.carry_over;
  s.flooded = tilting && h.feed == model::FilmHeat::Feed::flooded;
  if (tilting) s.supply_flow = h.supply_flow;
  s.wall = h.wall;
  s.wall_conductivity = h.wall_conductivity;
  s.back_coefficient = h.back_coefficient;
  s.housing_temperature = h.housing_temperature;
  s.shaft_expansion = h.shaft_expansion;
  s.pad_expansion = h.pad_expansion;
  s.housing_expansion = h.housing_expansion;
  s.assembly_temperature = h.assembly_temperature;
  s.viscosity = [oil](double T) { return viscosity_at(oil, T); };
  s.coldest = coldest_grade;
  s.hottest = hottest_grade;
  return s;
}

void set_flow(elements::FiniteJournal& film, const model::FilmFlow& flow, const model::Oil& oil) {
  if (flow.regime == model::FilmFlow::Regime::ng_pan) film.turbulent_density = oil.density;
  film.supply_pressure = flow.supply_pressure;
  film.mass_conserving = flow.conserves_mass();
  if (flow.heat) film.knots = knots;
}

namespace {

/// Whether every journal is within its film.
bool all_inside(const std::vector<elements::HeatPad>& pads) {
  return std::all_of(pads.begin(), pads.end(),
                     [](const elements::HeatPad& p) { return p.film->inside(p.point); });
}

NodeAt nodes_in(const system::Workspace& w) {
  return [&w](Index k) -> const system::NodeState& { return w.in_own_axes(k); };
}

/// With what its oil is fed, for messages; empty: not known.
std::string supply_of(const elements::HeatSettings& s) {
  if (std::isnan(s.supply_flow)) return {};
  return fmt::format(" with a supply flow of {}", units::display(s.supply_flow, "L/min"));
}

std::string bath_of(const elements::HeatBalance& b, const elements::HeatSettings& s) {
  if (std::isnan(s.supply_flow)) return {};
  return fmt::format(":{} the oil about the pads has {}", supply_of(s),
                     units::display(b.bath, "degC"));
}

/// What cannot be although it is in balance.
void check_balance(const elements::HeatBalance& b, const elements::HeatSettings& s,
                   const std::vector<elements::HeatPad>& pads, const std::string& name) {
  for (std::size_t k = 0; k < b.pads.size(); ++k) {
    const elements::PadTemperatures& t = b.pads[k];
    if (t.film_hottest > s.hottest || t.film_coldest < s.coldest) {
      const bool hot = t.film_hottest > s.hottest;
      throw run_error(
          "E85",
          fmt::format("{}: the film of pad {} reaches {}, beyond -30 to 200 degC, where the "
                      "viscosity of oils is known{}",
                      name, k + 1, units::display(hot ? t.film_hottest : t.film_coldest, "degC"),
                      bath_of(b, s)),
          hot ? "more or cooler oil, a larger clearance, a thinner oil, a lower speed"
              : "warmer oil");
    }
    const double own = pads[k].film->surface->pad_clearance() / pads[k].film->surface->clearance();
    const double assembled = 1.0 + b.growth[k], pad = own + b.pad_growth[k];
    if (assembled > elements::least_clearance && pad > elements::least_clearance) continue;
    const double clearance = pads[k].film->surface->clearance();
    throw run_error(
        "E84",
        fmt::format("{}: hot, with the journal at {} and pad {} at {}, of the clearance {} nothing "
                    "is left ({})",
                    name, units::display(b.journal, "degC"), k + 1, units::display(t.pad, "degC"),
                    units::display(clearance, "um"),
                    units::display(std::min(assembled, pad) * clearance, "um")),
        "a larger clearance, or expansions and temperatures that fit each other");
  }
}

}  // namespace

std::ptrdiff_t add_film_bearing(Assembly& a, const model::Bearing& b, const model::FilmFlow& flow,
                                const model::Oil& oil, std::size_t pads, const HeatPadsAt& pads_at,
                                const FilmsOn& films_on) {
  FilmBearing film;
  film.bearing = number_of(a, b);
  film.heated = flow.heat.has_value();
  film.standing = [pads_at, density = oil.density](const NodeAt& at) {
    std::vector<elements::FilmStanding> out;
    const std::vector<elements::HeatPad> now = pads_at(at);
    if (!all_inside(now)) return out;
    for (const elements::HeatPad& p : now)
      out.push_back(elements::film_standing(*p.film, p.pad, p.point, density));
    return out;
  };
  film.standing_on = [pads_at, films_on, density = oil.density](const NodeAt& at,
                                                                const FilmGrid& grid) {
    std::vector<elements::FilmStanding> out;
    const std::vector<elements::FiniteJournal> films = films_on(grid);
    std::vector<elements::HeatPad> now = pads_at(at);
    for (std::size_t k = 0; k < now.size(); ++k)
      now[k].film = &films[films.size() == 1 ? 0 : k];
    if (!all_inside(now)) return out;
    for (const elements::HeatPad& p : now)
      out.push_back(elements::film_standing(*p.film, p.pad, p.point, density));
    return out;
  };
  film.fields = [pads_at](const NodeAt& at) {
    constexpr std::size_t samples = 61;
    std::vector<elements::FilmField> out;
    for (const elements::HeatPad& p : pads_at(at))
      out.push_back(elements::sample_film(*p.film, p.pad, p.point, samples));
    return out;
  };
  if (film.heated) {
    const elements::HeatSettings settings =
        heat_settings(flow, oil, std::holds_alternative<model::TiltingPadJournal>(b.law));
    film.heat = [pads_at, settings](const NodeAt& at) {
      return elements::balance_heat(pads_at(at), settings);
    };
    constexpr std::size_t each = knots + elements::FiniteJournal::kept_growths;
    film.finer_heat = [pads_at, fine = elements::finer_settings(settings)](const NodeAt& at) {
      const std::vector<elements::HeatPad> now = pads_at(at);
      FilmBearing::FinerHeat out{elements::balance_heat(now, fine), {}};
      out.kept.resize(now.size() * each);
      for (std::size_t k = 0; k < now.size(); ++k)
        elements::keep_heat(out.balance, k, now[k], std::span(out.kept).subspan(k * each, each));
      return out;
    };
    film.viscosity = viscosity_of(oil);
    film.temperature_of = [oil](double viscosity) { return temperature_of(oil, viscosity); };
    film.kept = pads * each;
    film.kept_each = each;
    std::vector<double> at_first(pads * each, 0.0);
    const double fresh =
        std::log(viscosity_at(oil, settings.supply_temperature) / viscosity_of(oil));
    for (std::size_t i = 0; i < at_first.size(); ++i)
      if (i % each >= elements::FiniteJournal::kept_growths) at_first[i] = fresh;
    system::Keeper keeper;
    keeper.name = name_of(b) + supply_of(settings);
    keeper.time_constant = flow.heat->time_constant;
    keeper.settle = [pads_at, settings](const system::Workspace& w, std::span<double> values) {
      const std::vector<elements::HeatPad> now = pads_at(nodes_in(w));
      if (!all_inside(now)) {  // a film that is not there says nothing: as it was
        const double* kept = now.front().point.kept + now.front().film->kept_from;
        std::copy(kept, kept + values.size(), values.begin());
        return;
      }
      const elements::HeatBalance balance = elements::balance_heat(now, settings);
      for (std::size_t k = 0; k < now.size(); ++k)
        elements::keep_heat(balance, k, now[k], values.subspan(k * each, each));
    };
    keeper.check = [pads_at, settings, name = name_of(b)](const system::Workspace& w) {
      const std::vector<elements::HeatPad> now = pads_at(nodes_in(w));
      if (all_inside(now))
        check_balance(elements::balance_heat(now, settings), settings, now, name);
    };
    film.kept_from = static_cast<std::ptrdiff_t>(a.builder.keep(std::move(keeper), at_first));
  }
  a.built.films.push_back(film);
  return film.kept_from;
}

}  // namespace whirl::assembly
