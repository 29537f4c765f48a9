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
    content_ = profile.content;
    follow_streams();
    const double unit = film_.pressure_unit(gap_);
    FilmField f;
    for (std::size_t i = 0; i < samples; ++i) {
      const double theta = arc_.start + offset[i];
      f.theta.push_back(theta);
      f.thickness.push_back(thickness(theta));
      f.pressure.push_back(unit * profile.pressure[i]);
      f.largest.push_back(film_.peak * f.pressure.back());
      f.slope.push_back(unit * profile.slope[i]);
      f.viscosity.push_back(viscosity(offset[i]));
      const int wet = film_at(offset[i]);
      f.wet.push_back(wet >= 0 ? 1 : 0);
      f.flow.push_back(wet < 0 ? 0.0 : film_flow(static_cast<std::size_t>(wet), f, i));
    }
    add_wetted(f, offset);
    thin_short_films(f, offset);
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
  bool conserves() const { return !content_.empty(); }
  /// Film i forms of what a ruptured stretch carries to it: its flow is that of the weighted mean over
  /// the length in which such a film conserves mass.
  double share_driven(std::size_t i) const {
    const PadProfile::Stretch& s = films_[i];
    const bool forms = conserves() && (slip_ > 0.0 ? s.free_from : s.free_to);
    return forms ? 12.0 / film_.source : 1.0;
  }
  /// Through the start and the end of stretch i.
  std::array<double, 2> through(std::size_t i) const {
    const PadProfile::Stretch& s = films_[i];
    const double driven = film_.length * film_.radius * film_.source / 12.0 * share_driven(i);
    std::array<double, 2> out{dragged(s.from), dragged(s.to)};
    if (!s.free_from && !arc_.round) out[0] -= driven * s.out_from;
    if (!s.free_to && !arc_.round) out[1] += driven * s.out_to;
    if (!conserves()) return {taken(i, out[0]), taken(i, out[1])};
    // what the stretch before it, or the groove, lets go
    if (slip_ > 0.0 && s.free_from) out[0] = dragged(i > 0 ? films_[i - 1].to : 0.0);
    if (slip_ < 0.0 && s.free_to)
      out[1] = dragged(i + 1 < films_.size() ? films_[i + 1].from : arc_.length);
    return out;
  }
  /// Through the ends of the pad, in the sense of theta.
  std::array<double, 2> through_pad() const {
    const bool forward = slip_ >= 0.0;
    if (films_.empty()) {
      const double flow =
          conserves() ? dragged(forward ? 0.0 : arc_.length) : dragged_through_thinnest();
      return {flow, flow};
    }
    return {through(0)[0], through(films_.size() - 1)[1]};
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
  bool forward() const { return slip_ > 0.0; }
  /// The number of the film that the oil meets as the k-th.
  std::size_t downstream(std::size_t k) const { return forward() ? k : films_.size() - 1 - k; }
  /// Thicknesses of gap that what comes to each film would fill, and what leaves it.
  void follow_streams() {
    double carried = thickness(arc_.start + (forward() ? 0.0 : arc_.length));
    streams_.resize(films_.size());
    for (std::size_t k = 0; k < films_.size(); ++k) {
      const PadProfile::Stretch& s = films_[downstream(k)];
      const double leaves = thickness(arc_.start + (forward() ? s.to : s.from));
      const bool forms = forward() ? s.free_from : s.free_to;
      const double full = forms && !conserves()
                              ? std::min(1.0, (s.to - s.from) / (PadFilm::short_film * arc_.length))
                              : 1.0;
      Stream& own = streams_[downstream(k)];
      own = {full, carried, carried < leaves ? std::lerp(carried, leaves, full) : leaves};
      carried = own.leaves;
    }
  }
  /// Of the width, what oil that is carried to this place wets where film has ruptured, or has not formed.
  double share_wet(double offset) const {
    double carried = thickness(arc_.start + (forward() ? 0.0 : arc_.length));
    for (std::size_t k = 0; k < films_.size(); ++k) {
      const PadProfile::Stretch& s = films_[downstream(k)];
      if (s.from <= offset && offset <= s.to) return 1.0;
      if (forward() ? s.to < offset : s.from > offset) carried = streams_[downstream(k)].leaves;
    }
    return std::min(1.0, carried / thickness(arc_.start + offset));
  }
  /// In film k, whose field is known but for the flow at sample i.
  double film_flow(std::size_t k, const FilmField& f, std::size_t i) const {
    return flow(f.theta[i], f.viscosity[i], share_driven(k) * f.slope[i]);
  }
  /// Of the flow of film k what it has where it does not take in all of it.
  double taken(std::size_t k, double flow) const {
    const Stream& own = streams_[k];
    const double unit = 0.5 * film_.length * film_.radius * slip_;
    if (own.full == 1.0 || !(own.comes < flow / unit)) return flow;
    return std::lerp(unit * own.comes, flow, own.full);
  }
  /// Short films: their flow, and the width that it wets.
  void thin_short_films(FilmField& f, const std::vector<double>& offset) const {
    for (std::size_t i = 0; i < offset.size(); ++i) {
      const int k = film_at(offset[i]);
      if (k < 0) continue;
      const double part = taken(static_cast<std::size_t>(k), f.flow[i]);
      if (part == f.flow[i]) continue;
      f.share[i] = part / f.flow[i];
      f.flow[i] = part;
    }
  }
  void add_wetted(FilmField& f, const std::vector<double>& offset) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < offset.size(); ++k) {
      if (k > 0) sum += wetted(offset[k - 1], offset[k]);
      f.share.push_back(share_wet(offset[k]));
      f.wetted.push_back(sum);
    }
  }
  /// int share dtheta, by Simpson's rule between the ends of films.
  double wetted(double from, double to) const {
    std::vector<double> ends{from};
    for (const PadProfile::Stretch& s : films_)
      for (const double end : {s.from, s.to})
        if (end > from && end < to) ends.push_back(end);
    ends.push_back(to);
    double sum = 0.0;
    for (std::size_t k = 1; k < ends.size(); ++k) {
      const double width = ends[k] - ends[k - 1], inside = 1e-9 * width;
      const double middle = 0.5 * (ends[k] + ends[k - 1]);
      sum +=
          width / 6.0 *
          (share_wet(ends[k - 1] + inside) + 4.0 * share_wet(middle) + share_wet(ends[k] - inside));
    }
    return sum;
  }
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
  /// Where there is no film the flow is what was dragged through the gap where it was full last.
  void fill_dry(FilmField& f) const {
    for (std::size_t k = 0; k < f.theta.size(); ++k)
      if (!f.wet[k])
        f.flow[k] = 0.5 * film_.length * film_.radius * slip_ * f.thickness[k] * f.share[k];
  }

  const FiniteJournal& film_;
  const JournalSurface::Arc& arc_;
  FiniteJournal::Gap gap_;
  PadMedium medium_;
  FiniteJournal::PadPlace at_;
  double slip_;
  PadFilm pad_;
  std::vector<PadProfile::Stretch> films_;
  struct Stream {
    double full;           ///< share of what a film forms with that it takes in
    double comes, leaves;  ///< m
  };
  std::vector<Stream> streams_;  ///< one a film
  std::vector<double> content_;
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
  if (film.grid) one.grid = std::make_shared<const std::vector<GridPad>>(1, (*film.grid)[k]);
  if (film.kept_from >= 0) one.kept_from += static_cast<std::ptrdiff_t>(k) * film.kept_each();
  return one;
}

FilmForce force_alone(const FiniteJournal& film, std::size_t pad, const FilmPoint& p) {
  FilmForce force;
  alone(film, pad).evaluate(p, force);
  return force;
}
double loss_of(const FilmForce& force, const FilmPoint& p) {
  return force.pump - (force.F.dot(p.w) + force.T * p.slip);
}

/// A row of numbers at places in ascending order, between them linear.
double between(const std::vector<double>& places, const std::vector<double>& values, double at) {
  const auto next = std::upper_bound(places.begin(), places.end(), at);
  if (next == places.begin()) return values.front();
  if (next == places.end()) return values.back();
  const std::size_t k = static_cast<std::size_t>(next - places.begin());
  const double share = (at - places[k - 1]) / (places[k] - places[k - 1]);
  return values[k - 1] + share * (values[k] - values[k - 1]);
}

double relative_viscosity(const GridDrive& in, double place) {
  if (in.log_viscosity.empty()) return 1.0;
  double slope = 0.0;
  return std::exp(log_viscosity_at(in.log_viscosity, place, slope));
}

FilmField sample_grid(const FiniteJournal& film, std::size_t pad, const FilmPoint& p,
                      std::size_t samples) {
  const JournalSurface::Arc& arc = film.surface->arcs()[pad];
  const FiniteJournal::Gap gap = film.gap(pad, p);
  const GridDrive drive = film.drive(pad, p);
  GridField g = (*film.grid)[pad].field(drive);
  // the pressure at the ends is known
  if (!arc.round)
    for (auto* values : {&g.mean, &g.largest}) {
      values->insert(values->begin(), drive.edge);
      values->push_back(drive.edge);
    }
  std::vector<double> places = g.place;
  if (!arc.round) {
    places.insert(places.begin(), 0.0);
    places.push_back(arc.length);
  }
  const double unit = film.pressure_unit(gap);
  const double loss = unit * film.radius * film.length;
  const double drag = film.viscosity * std::pow(film.radius, 3) * film.length / gap.pad;
  FilmField f;
  for (std::size_t i = 0; i < samples; ++i) {
    const double at = arc.length * static_cast<double>(i) / static_cast<double>(samples - 1);
    const std::size_t column = std::min(
        static_cast<std::size_t>(std::upper_bound(g.face_place.begin(), g.face_place.end(), at) -
                                 g.face_place.begin()) -
            1,
        g.place.size() - 1);
    const double step = 1e-3 * arc.length, low = std::max(0.0, at - step),
                 high = std::min(arc.length, at + step);
    const double thickness = between(g.place, g.thickness, at);
    f.theta.push_back(arc.start + at);
    f.thickness.push_back(gap.pad * thickness);
    f.pressure.push_back(unit * between(places, g.mean, at));
    f.largest.push_back(unit * between(places, g.largest, at));
    f.slope.push_back(unit * (between(places, g.mean, high) - between(places, g.mean, low)) /
                      (high - low));
    f.viscosity.push_back(film.viscosity * relative_viscosity(drive, at / arc.length));
    f.flow.push_back(film.length * film.radius * between(g.face_place, g.flow, at));
    f.wet.push_back(g.wet[column]);
    if (!g.stream.empty()) {
      f.stream.push_back(film.length * film.radius * between(g.face_place, g.stream, at));
      f.from_groove.push_back(film.length * film.radius * between(g.face_place, g.from_groove, at));
    }
    f.filled.push_back(film.length * film.radius * between(g.face_place, g.filled, at));
    f.lost.push_back(loss * between(g.face_place, g.driven, at) +
                     drag * p.slip * p.slip * between(g.face_place, g.shear, at));
    f.gap.push_back(gap.pad * between(g.place, g.gap, at));
    f.conducting.push_back(between(g.place, g.conducting, at) / gap.pad);
  }
  return f;
}

/// Flows and the thinnest film of a pad on its grid.
void stand_on_grid(const FiniteJournal& film, std::size_t pad, const FilmPoint& p,
                   FilmStanding& s) {
  const JournalSurface::Arc& arc = film.surface->arcs()[pad];
  const GridField g = (*film.grid)[pad].field(film.drive(pad, p));
  const double unit = film.length * film.radius;
  const bool forward = p.slip >= 0.0;
  s.thinnest = film.gap(pad, p).pad * g.thinnest;
  s.thinnest_at = arc.start + g.thinnest_at;
  s.highest = film.pressure_unit(film.gap(pad, p)) * g.highest;
  s.highest_at = arc.start + g.highest_at;
  s.inflow = unit * (forward ? g.flow.front() : -g.flow.back());
  s.outflow = unit * ((forward ? g.flow.back() : -g.flow.front()) + g.into_open);
  s.side_flow = unit * g.side;
}

}  // namespace

FilmField sample_film(const FiniteJournal& film, std::size_t pad, const FilmPoint& p,
                      std::size_t samples) {
  WHIRL_EXPECTS(samples >= 3);
  WHIRL_EXPECTS(film.inside(p));
  if (film.grid) return sample_grid(film, pad, p, samples);
  return PadInState(film, pad, p).field(samples);
}

namespace {

/// Flows and the thinnest film of a pad with a profile along the axis.
void stand_on_profile(PadInState& in, bool forward, FilmStanding& s) {
  s.thinnest = in.smallest(s.thinnest_at);
  const std::array<double, 2> ends = in.through_pad();
  s.inflow = forward ? ends[0] : -ends[1];
  s.outflow = forward ? ends[1] : -ends[0];
  for (std::size_t i = 0; i < in.films().size(); ++i) {
    const std::array<double, 2> through = in.through(i);
    s.side_flow += through[0] - through[1];
  }
}

}  // namespace

double film_loss(const FiniteJournal& film, std::size_t pad, const FilmPoint& p) {
  WHIRL_EXPECTS(film.inside(p));
  return loss_of(force_alone(film, pad, p), p);
}

FilmStanding film_standing(const FiniteJournal& film, std::size_t pad, const FilmPoint& p,
                           double density) {
  WHIRL_EXPECTS(film.inside(p));
  constexpr std::size_t samples = 121;
  FilmStanding s;
  FilmField f;
  if (film.grid) {
    f = sample_grid(film, pad, p, samples);
    stand_on_grid(film, pad, p, s);
  } else {
    PadInState in(film, pad, p);
    f = in.field(samples);
    stand_on_profile(in, p.slip >= 0.0, s);
  }
  const FilmForce force = force_alone(film, pad, p);
  s.force = -force.F;
  s.power = loss_of(force, p);
  for (std::size_t i = 0; i < samples; ++i) {
    if (f.largest[i] > s.highest) {
      s.highest = f.largest[i];
      s.highest_at = f.theta[i];
    }
    s.reynolds = std::max(
        s.reynolds, density * film.radius * std::abs(p.slip) * f.thickness[i] / f.viscosity[i]);
  }
  return s;
}

}  // namespace whirl::elements
