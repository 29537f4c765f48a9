// The films of journal bearings as their kernels, from what the model says.
#pragma once
#include <assembly/film_grid.hpp>
#include <elements/films/film_heat.hpp>
#include <elements/films/finite_journal.hpp>
#include <elements/films/tilting_pad.hpp>
#include <model/model.hpp>

namespace whirl::assembly {

/// grid: that of the law, or another to compare with.
/// @throws Error E84 as JournalSurface and GridPad.
elements::FiniteJournal make_finite_journal(const model::FiniteJournal& law, FilmGrid grid);

/// Points round the circumference of the films of dampers.
inline constexpr int damper_nodes = 72;

/// The film of a damper of finite length or with sealed ends, on a grid, along the axis too where it has
/// rows.
/// @pre a film with a grid: Film::finite or Film::sealed.
elements::FiniteJournal make_damper_film(const model::SqueezeFilm& law, FilmGrid grid);

/// One a pad, in their order.
/// @throws Error E84 as make_tilting_pad.
std::vector<elements::TiltingPad> make_tilting_pads(const model::TiltingPadJournal& law,
                                                    FilmGrid grid);

/// At a temperature, K; of a grade within its range.
double viscosity_at(const model::Oil& o, double temperature);
/// The temperature at which an oil has a viscosity, K: from -30 degC to 199.85 degC, beyond which it is
/// the nearer of these.
double temperature_of(const model::Oil& o, double viscosity);
/// @pre flow.heat.
/// tilting: pads in a housing, which may be flooded.
elements::HeatSettings heat_settings(const model::FilmFlow& flow, const model::Oil& oil,
                                     bool tilting);

/// Force of the theory of short bearings over that of one of finite length, both plain and in steady
/// rotation. It depends on L/D and the eccentricity alone: viscosity and speed are factors of either
/// force.
/// @pre length_over_diameter > 0, 0 <= eccentricity < 1.
double short_bearing_excess(double length_over_diameter, double eccentricity);

}  // namespace whirl::assembly
