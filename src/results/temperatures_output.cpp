// Temperatures of films that a motion in time changes: effective viscosity and temperature of each
// bearing, and those that the motion would have in balance.
#include <analysis/transient/kept_in_time.hpp>
#include <results/linear_limits.hpp>
#include <results/transient_output.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {

namespace {

/// Of the viscosity from one look to the next; more of it is said.
constexpr double most_change = 0.05;

/// Of a bearing's film at a look; what is kept and what would be in balance.
struct FilmNow {
  double viscosity = 0, growth = 0;  ///< Pa s, of the clearance over that assembled
};

/// degC, of the oil with a viscosity.
double celsius(const assembly::FilmBearing& f, double viscosity) {
  return f.temperature_of(viscosity) - 273.15;
}

class TemperaturesOutput final : public TransientOutput {
 public:
  explicit TemperaturesOutput(const TransientSetup& s)
      : job_(s.job),
        kept_(s.job.system(), s.t_begin, s.law.duration, s.law.integrator.dt,
              [this](double t, std::span<const double> kept, std::span<const double> balance) {
                take(t, kept, balance);
              }) {
    for (const assembly::FilmBearing& f : s.job.built.films)
      if (f.heated) films_.push_back(&f);
  }

  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&kept_);
    const std::string content = fmt::format("{} every {}", films_.size(), kept_.every());
    parts.add({run::Part::temperatures, content}, kept_);
    parts.add(
        {run::Part::temperatures, content + ", rows"},
        [this](OutArchive& a) {
          a.put_count(rows_.size());
          for (const std::vector<double>& row : rows_)
            a.put(row);
        },
        [this](InArchive& a) {
          rows_.resize(a.count());
          for (std::vector<double>& row : rows_)
            row = a.numbers();
        });
  }
  std::function<void(double, system::Frames&)> between_steps() override {
    return [this](double t, system::Frames& f) { kept_.apply(t, f); };
  }
  double longest_step() const override { return kept_.every(); }
  void summarize(TransientEnd& end) override;
  void report(TransientEnd& end) override;

 private:
  static constexpr std::size_t each = 4;  ///< numbers a film in a row, behind the time
  void take(double t, std::span<const double> kept, std::span<const double> balance);
  FilmNow film_now(const assembly::FilmBearing& f, std::span<const double> values) const;
  const model::Bearing& bearing_of(const assembly::FilmBearing& f) const {
    return job_.model.bearings[f.bearing];
  }
  double change_of(const assembly::FilmBearing& f) const {
    return kept_.largest_change(static_cast<std::size_t>(f.kept_from), f.kept);
  }
  io::Table table() const;
  plot::Figure figure(const std::string& step) const;

  run::Job& job_;
  analysis::KeptInTime kept_;
  std::vector<const assembly::FilmBearing*> films_;
  std::vector<std::vector<double>> rows_;  ///< time; kept and balance of viscosity and growth
};

FilmNow TemperaturesOutput::film_now(const assembly::FilmBearing& f,
                                     std::span<const double> values) const {
  FilmNow out;
  double knots = 0, pads = 0;
  const std::size_t first = static_cast<std::size_t>(f.kept_from);
  for (std::size_t i = 0; i < f.kept; ++i) {
    const std::size_t place = i % f.kept_each;
    if (place == 0) {
      out.growth += values[first + i];
      pads += 1;
    } else if (place >= elements::FiniteJournal::kept_growths) {
      out.viscosity += f.viscosity * std::exp(values[first + i]);
      knots += 1;
    }
  }
  out.viscosity /= knots;
  out.growth /= pads;
  return out;
}

void TemperaturesOutput::take(double t, std::span<const double> kept,
                              std::span<const double> balance) {
  std::vector<double> row{t};
  for (const assembly::FilmBearing* f : films_) {
    const FilmNow is = film_now(*f, kept), would = film_now(*f, balance);
    row.insert(row.end(), {is.viscosity, would.viscosity, is.growth, would.growth});
  }
  rows_.push_back(std::move(row));
}

void TemperaturesOutput::summarize(TransientEnd& end) {
  if (rows_.empty()) return;
  for (std::size_t k = 0; k < films_.size(); ++k) {
    const assembly::FilmBearing& f = *films_[k];
    const model::Bearing& b = bearing_of(f);
    const double* last = rows_.back().data() + 1 + each * k;
    const double change = change_of(f);
    io::Value& v = end.summary["film temperatures"][b.name];
    v["effective temperature at the end [degC]"] = celsius(f, last[0]);
    v["in balance with the end [degC]"] = celsius(f, last[1]);
    v["largest change of ln viscosity between looks"] = change;
    if (change <= most_change) continue;
    Diagnostic d;
    d.code = "W03";
    d.message = fmt::format(
        "step '{}': the viscosity of bearing '{}' changes by up to {:.2g} of itself from one "
        "look at its temperatures to the next, {:.3g} s later: the motion is right to some such "
        "part "
        "of the film's forces",
        end.step.name, b.name, std::expm1(change), kept_.every());
    d.hint =
        "a longer time_constant of heat, or a shorter step: looks are a twentieth of the time "
        "constant apart, and two thousand a step at most";
    d.where = b.where;
    warn(end.job, std::move(d));
  }
}

io::Table TemperaturesOutput::table() const {
  io::Table t;
  t.title = "Temperatures of the films in time";
  t.columns = {{"bearing", "-", ""},
               {"time", "s", ""},
               {"effective viscosity", "Pa s", "mean along all pads, in the motion"},
               {"effective temperature", "degC", "of oil with that viscosity"},
               {"viscosity in balance", "Pa s", "with the state of the moment"},
               {"temperature in balance", "degC", "of oil with that viscosity"},
               {"growth of clearance", "-", "over that assembled, mean of all pads"},
               {"growth in balance", "-", "with the state of the moment"}};
  for (std::size_t k = 0; k < films_.size(); ++k)
    for (const std::vector<double>& row : rows_) {
      const double* x = row.data() + 1 + each * k;
      t.add({bearing_of(*films_[k]).name, row[0], x[0], celsius(*films_[k], x[0]), x[1],
             celsius(*films_[k], x[1]), x[2], x[3]});
    }
  return t;
}

plot::Figure TemperaturesOutput::figure(const std::string& step) const {
  plot::Figure f;
  f.name = step + "_film_temperatures";
  f.title = "Effective temperatures of the films in time";
  f.caption = "Dashed: in balance with the state of the moment.";
  plot::Axes a;
  a.x = plot::Axis("time", "s");
  a.y = plot::Axis("effective temperature", "degC");
  for (std::size_t k = 0; k < films_.size(); ++k)
    for (const std::size_t which : {std::size_t{0}, std::size_t{1}}) {
      plot::Series s;
      s.label = bearing_of(*films_[k]).name + (which == 0 ? "" : ", in balance");
      s.style = {static_cast<int>(k), which == 0 ? plot::Dash::solid : plot::Dash::dashed,
                 which == 0 ? 1.6 : 1.0};
      for (const std::vector<double>& row : rows_) {
        s.x.push_back(row[0]);
        s.y.push_back(celsius(*films_[k], row[1 + each * k + which]));
      }
      a.series.push_back(std::move(s));
    }
  f.axes.push_back(std::move(a));
  return f;
}

void TemperaturesOutput::report(TransientEnd& end) {
  if (rows_.empty()) return;
  const std::string file = end.step.name + "_film_temperatures.csv";
  end.job.folder.write_table(file, table());
  if (!end.job.model.output.report) return;
  end.section.files.emplace_back("temperatures of films", file);
  end.section.figures.push_back(figure(end.step.name));
}

}  // namespace

void add_temperatures(const TransientSetup& setup, TransientOutputs& outputs) {
  if (!setup.law.linear && analysis::KeptInTime::any(setup.job.system()))
    outputs.push_back(std::make_unique<TemperaturesOutput>(setup));
}

}  // namespace whirl::results
