#include <elements/films/film_field.hpp>
#include <core/contract.hpp>
#include <elements/films/turbulence.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

namespace {

/// One pad in a state: what its field and its standing are made from.
class PadInState {
 public:
  PadInState(const FiniteJournal& film, std::size_t k, const FilmPoint& p)
      : film_(film),
        arc_(film.surface->arcs()[k]),
        gap_(film.gap(k, p)),
        medium_(film.medium(k, p)),
        at_(film.place(k, p)),
        slip_(p.slip),
        pad_(film.pad(k)) {
    if (at_.W.norm() <= 1e-9 * std::abs(p.slip) * gap_.pad) at_.W.setZero();
  }

  FilmField field(std::size_t samples) {
    std::vector<double> offset(samples);
    for (std::size_t i = 0; i < samples; ++i)
      offset[i] = arc_.length * static_cast<double>(i) / static_cast<double>(samples - 1);
    const PadProfile profile = pad_.profile(at_.e, at_.W, medium_, offset);
    films_ = profile.films;
    const double unit = film_.pressure_unit(gap_);
    FilmField f;
    for (std::size_t i = 0; i < samples; ++i) {
      const double theta = arc_.start + offset[i];
      f.theta.push_back(theta);
      f.thickness.push_back(thickness(theta));
      f.pressure.push_back(unit * profile.pressure[i]);
      f.slope.push_back(unit * profile.slope[i]);
      f.viscosity.push_back(viscosity(offset[i]));
      const bool wet = film_at(offset[i]) >= 0;
      f.wet.push_back(wet ? 1 : 0);
      f.flow.push_back(wet ? flow(theta, f.viscosity[i], f.slope[i]) : 0.0);
    }
    fill_dry(f);
    return f;
  }

  double thickness(double theta) const {
    return gap_.pad * (1.0 - at_.e.x() * std::cos(theta) - at_.e.y() * std::sin(theta));
  }
  /// Flow where the pressure has no slope.
  double dragged(double offset) const {
    return 0.5 * film_.length * film_.radius * slip_ * thickness(arc_.start + offset);
  }
  /// Through the start and the end of a stretch. f: sampled over the pad.
  std::array<double, 2> through(const PadProfile::Stretch& s, const FilmField& f) const {
    return {s.free_from || arc_.round ? dragged(s.from) : f.flow.front(),
            s.free_to || arc_.round ? dragged(s.to) : f.flow.back()};
  }
  const std::vector<PadProfile::Stretch>& films() const { return films_; }
  double smallest(double& where) const {
    const double turn = std::atan2(at_.e.y(), at_.e.x()) - arc_.start,
                 inside = turn - two_pi * std::floor(turn / two_pi);
    const double end = arc_.start + arc_.length;
    if (arc_.round || inside <= arc_.length)
      where = arc_.start + inside;
    else
      where = thickness(arc_.start) < thickness(end) ? arc_.start : end;
    return thickness(where);
  }
  double dragged_through_thinnest() const {
    double where = 0.0;
    return 0.5 * film_.length * film_.radius * slip_ * smallest(where);
  }

 private:
  double viscosity(double offset) const {
    if (medium_.log_viscosity.empty()) return film_.viscosity;
    double slope = 0.0;
    return film_.viscosity *
           std::exp(log_viscosity_at(medium_.log_viscosity, offset / arc_.length, slope));
  }
  int film_at(double offset) const {
    for (std::size_t i = 0; i < films_.size(); ++i)
      for (const double turn : {0.0, arc_.round ? two_pi : 0.0, arc_.round ? -two_pi : 0.0}) {
        const double slack = 1e-9;
        if (offset + turn >= films_[i].from - slack && offset + turn <= films_[i].to + slack)
          return static_cast<int>(i);
      }
    return -1;
  }
  double flow(double theta, double eta, double slope) const {
    const double h = thickness(theta), R = film_.radius;
    const double re = film_.turbulent_density * R * std::abs(slip_) * h / eta;
    const double along = re > 0.0 ? TurbulentFactors<double>(re).along : 1.0;
    return film_.length * (0.5 * R * slip_ * h - h * h * h * slope / (12.0 * eta * along * R));
  }
  /// Where there is no film the flow of the stretch upstream, or of the next one where none is.
  void fill_dry(FilmField& f) const {
    const std::size_t n = f.theta.size();
    const bool forward = slip_ >= 0.0;
    const auto place = [&](std::size_t k) { return forward ? k : n - 1 - k; };
    double now = films_.empty() ? dragged_through_thinnest() : nan;
    if (!films_.empty()) {
      const PadProfile::Stretch& first = forward ? films_.front() : films_.back();
      now = dragged(forward ? first.from : first.to);
    }
    for (std::size_t k = 0; k < n; ++k)
      if (f.wet[place(k)])
        now = f.flow[place(k)];
      else
        f.flow[place(k)] = now;
  }

  const FiniteJournal& film_;
  const JournalSurface::Arc& arc_;
  FiniteJournal::Gap gap_;
  PadMedium medium_;
  FiniteJournal::PadPlace at_;
  double slip_;
  PadFilm pad_;
  std::vector<PadProfile::Stretch> films_;
};

/// The film of one pad of a bearing by itself.
FiniteJournal alone(const FiniteJournal& film, std::size_t k) {
  const JournalSurface::Arc& arc = film.surface->arcs()[k];
  FiniteJournal one = film;
  const double thinnest = std::atan2(arc.thinnest.y(), arc.thinnest.x());
  const double clearance = film.surface->clearance(),
               preload = film.surface->lift() / film.surface->pad_clearance();
  const int points =
      std::clamp(static_cast<int>(std::lround(arc.points)), 8, JournalSurface::max_nodes);
  const std::vector<JournalPad> stretch{{arc.start, arc.start + arc.length, thinnest}};
  one.surface = std::make_shared<JournalSurface>(clearance, preload, stretch, points);
  if (film.kept_from >= 0) one.kept_from += static_cast<std::ptrdiff_t>(k) * film.kept_each();
  return one;
}

}  // namespace

FilmField sample_film(const FiniteJournal& film, std::size_t pad, const FilmPoint& p,
                      std::size_t samples) {
  WHIRL_EXPECTS(samples >= 3);
  WHIRL_EXPECTS(film.inside(p));
  return PadInState(film, pad, p).field(samples);
}

FilmStanding film_standing(const FiniteJournal& film, std::size_t pad, const FilmPoint& p,
                           double density) {
  WHIRL_EXPECTS(film.inside(p));
  constexpr std::size_t samples = 121;
  PadInState in(film, pad, p);
  const FilmField f = in.field(samples);
  FilmStanding s;
  FilmForce force;
  alone(film, pad).evaluate(p, force);
  s.force = -force.F;
  s.power = force.pump - (force.F.dot(p.w) + force.T * p.slip);
  s.thinnest = in.smallest(s.thinnest_at);
  const bool forward = p.slip >= 0.0;
  if (in.films().empty()) {
    s.inflow = s.outflow = std::abs(in.dragged_through_thinnest());
  } else {
    const std::array<double, 2> first = in.through(in.films().front(), f),
                                last = in.through(in.films().back(), f);
    s.inflow = forward ? first[0] : -last[1];
    s.outflow = forward ? last[1] : -first[0];
    for (const PadProfile::Stretch& stretch : in.films()) {
      const std::array<double, 2> ends = in.through(stretch, f);
      s.side_flow += ends[0] - ends[1];
    }
  }
  for (std::size_t i = 0; i < samples; ++i) {
    if (film.peak * f.pressure[i] > s.highest) {
      s.highest = film.peak * f.pressure[i];
      s.highest_at = f.theta[i];
    }
    s.reynolds = std::max(
        s.reynolds, density * film.radius * std::abs(p.slip) * f.thickness[i] / f.viscosity[i]);
  }
  return s;
}

}  // namespace whirl::elements
