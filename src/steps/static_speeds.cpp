// A static step at a series of speeds: where each journal runs in its bearing, and the coefficients
// of the bearings against speed.
#include <results/static_accuracy.hpp>
#include <results/frequency.hpp>
#include <results/linear_limits.hpp>
#include <results/stability_results.hpp>
#include <results/static_results.hpp>
#include <results/support_coefficients.hpp>
#include <run/support_diagnosis.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>
#include <core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace whirl::steps {

namespace {

/// One bearing over the speeds.
struct Sweep {
  std::string name;
  std::vector<results::SupportCoefficients> at;
  bool film() const { return !at.empty() && std::isfinite(at.front().clearance); }
  template <class Of>
  plot::Series series(std::string label, Of of) const {
    plot::Series s;
    s.label = std::move(label);
    for (const results::SupportCoefficients& c : at) {
      s.x.push_back(to_rpm(c.spin));
      s.y.push_back(of(c));
    }
    s.keep_all = true;
    return s;
  }
};

/// Grid of one pair of axes a bearing.
plot::Figure grid(std::string name, std::string title, std::size_t bearings, double height) {
  plot::Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.columns = bearings > 1 ? 2 : 1;
  const std::size_t rows = (bearings + 1) / 2;
  f.height = height * static_cast<double>(rows);
  return f;
}

/// Places of the journals: in the clearance circle of a film, in um elsewhere.
plot::Figure draw_locus(const std::string& name, const std::vector<Sweep>& all) {
  plot::Figure f = grid(name, "Where the shaft runs in its bearings", all.size(), 400);
  f.caption =
      "The journal's place against its housing from the lowest speed (circle) to the highest "
      "(diamond); points carry their speeds.";
  for (const Sweep& b : all) {
    plot::Axes a;
    a.title = b.name;
    a.equal_aspect = true;
    const double unit = b.film() ? 1.0 / b.at.front().clearance : 1e6;
    a.x = b.film() ? plot::Axis("y / clearance", "-") : plot::Axis("y", "um");
    a.y = b.film() ? plot::Axis("z / clearance", "-") : plot::Axis("z", "um");
    if (b.film()) {
      plot::Series circle;
      circle.label = "clearance";
      circle.style = {plot::ink, plot::Dash::dash_dot, 1.0};
      for (int k = 0; k <= 180; ++k) {
        circle.x.push_back(std::cos(two_pi * k / 180));
        circle.y.push_back(std::sin(two_pi * k / 180));
      }
      a.series.push_back(std::move(circle));
    }
    plot::Series locus;
    locus.label = "locus";
    locus.style = {0, plot::Dash::solid, 1.4, plot::Marker::circle, 3.0};
    for (const results::SupportCoefficients& c : b.at) {
      locus.x.push_back(unit * c.place.x());
      locus.y.push_back(unit * c.place.y());
      locus.point_names.push_back(fmt::format("{:.6g} rpm", to_rpm(c.spin)));
    }
    const auto mark = [&](std::size_t k, plot::Marker m) {
      plot::Series s;
      s.style = {0, plot::Dash::solid, 0.0, m, 9.0};
      s.x = {locus.x[k]};
      s.y = {locus.y[k]};
      s.point_names = {locus.point_names[k]};
      a.series.push_back(std::move(s));
      a.notes.push_back({locus.x[k], locus.y[k], locus.point_names[k]});
    };
    const std::size_t last = locus.x.size() - 1;
    a.series.push_back(locus);
    mark(0, plot::Marker::circle);
    if (last > 0) mark(last, plot::Marker::diamond);
    f.axes.push_back(std::move(a));
  }
  return f;
}

/// Speed ratios of floating rings, and the eccentricities of both films.
plot::Figure draw_ring_speeds(const std::string& name, const std::vector<Sweep>& all) {
  plot::Figure f = grid(name, "Floating rings against speed", all.size(), 330);
  for (const Sweep& b : all) {
    plot::Axes a;
    a.title = b.name;
    a.x = plot::Axis("speed", "rpm");
    a.y = plot::Axis("ring speed over speed, eccentricity ratios", "-");
    a.y.include_zero = true;
    a.series.push_back(b.series("ring speed / speed", [](const results::SupportCoefficients& c) {
      return c.spin != 0 ? c.ring->spin / c.spin : nan;
    }));
    a.series.push_back(b.series("inner eccentricity", [](const results::SupportCoefficients& c) {
      return c.ring->standing.inner.eccentricity;
    }));
    a.series.push_back(b.series("outer eccentricity", [](const results::SupportCoefficients& c) {
      return c.ring->standing.outer.eccentricity;
    }));
    f.axes.push_back(std::move(a));
  }
  return f;
}

/// Ten degrees at the least: below that its numbers would be those of rounding.
plot::Axis attitude_axis(const Sweep& b) {
  plot::Axis axis("attitude", "deg");
  double low = infinity, high = -infinity;
  for (const double y :
       b.series("", [](const results::SupportCoefficients& c) { return c.attitude; }).y)
    if (std::isfinite(y)) {
      low = std::min(low, y);
      high = std::max(high, y);
    }
  if (high - low < 10.0) {
    axis.min = std::floor(0.5 * (low + high)) - 5.0;
    axis.max = axis.min + 11.0;
  }
  return axis;
}

plot::Figure draw_eccentricity(const std::string& name, const std::vector<Sweep>& all) {
  plot::Figure f = grid(name, "Eccentricity and attitude against speed", all.size(), 330);
  f.caption =
      "The attitude is counted from the load in the sense y to z, which is that of a positive "
      "spin.";
  for (const Sweep& b : all) {
    plot::Axes a;
    a.title = b.name;
    a.x = plot::Axis("speed", "rpm");
    a.y = b.film() ? plot::Axis("eccentricity / clearance", "-") : plot::Axis("eccentricity", "um");
    a.y.include_zero = true;
    a.right = attitude_axis(b);
    a.series.push_back(b.series("eccentricity", [&](const results::SupportCoefficients& c) {
      return c.place.norm() * (b.film() ? 1 / c.clearance : 1e6);
    }));
    plot::Series attitude =
        b.series("attitude", [](const results::SupportCoefficients& c) { return c.attitude; });
    attitude.right_axis = true;
    attitude.style.dash = plot::Dash::dashed;
    a.series.push_back(std::move(attitude));
    f.axes.push_back(std::move(a));
  }
  return f;
}

plot::Figure draw_coefficients(const std::string& name, const char* what, const char* letter,
                               const char* unit, double factor,
                               Mat2 results::SupportCoefficients::*matrix,
                               const std::vector<Sweep>& all) {
  plot::Figure f = grid(
      name, fmt::format("{}{} against speed", static_cast<char>(std::toupper(what[0])), what + 1),
      all.size(), 330);
  for (const Sweep& b : all) {
    plot::Axes a;
    a.title = b.name;
    a.x = plot::Axis("speed", "rpm");
    a.y = plot::Axis(what, unit);
    a.y.include_zero = true;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        plot::Series s = b.series(
            fmt::format("{}{}{}", letter, "yz"[i], "yz"[j]),
            [&](const results::SupportCoefficients& c) { return factor * (c.*matrix)(i, j); });
        if (i != j) s.style.dash = plot::Dash::dashed;
        a.series.push_back(std::move(s));
      }
    f.axes.push_back(std::move(a));
  }
  return f;
}

/// Which speeds have an equilibrium, and whether it is stable.
io::Table speeds_table() {
  io::Table t;
  t.title = "Equilibria against speed";
  t.columns = {{"speed", "rpm", ""},
               {"equilibrium", "-", "1: found"},
               {"unstable directions", "-", "negative eigenvalues of the static tangent"},
               {"symmetric tangent", "-", "0: negative real eigenvalues are counted (divergence)"},
               {"proved", "-", "0: counted among the eigenvalues of least size"}};
  return t;
}

/// Equilibria against speed on their way, each started from the one before.
class SpeedSweep {
 public:
  SpeedSweep(run::Job& job, const model::Step& step, const std::vector<double>& speeds,
             int load_steps)
      : job_(job),
        step_(step),
        speeds_(speeds),
        s_(job, step, "static", "equilibria against speed",
           std::max(std::abs(speeds.front()), std::abs(speeds.back())), load_steps) {}
  /// Throws the first error when no speed has an equilibrium.
  void execute();

 private:
  void take(double Omega);
  void miss(double Omega, const Error& e);
  void judge(double Omega, const run::StepState& state);
  void add_coefficients(const run::StepState& state);
  void judge_mesh(double Omega, const run::StepState& state);
  void report_mesh();
  void show_equilibria();
  void show_bearings();
  void show_rings();

  run::Job& job_;
  const model::Step& step_;
  const std::vector<double>& speeds_;
  results::FrequencyStep s_;
  io::Table judged_ = speeds_table();
  std::vector<results::SupportCoefficients> rows_;
  std::vector<Sweep> bearings_;
  int unstable_ = 0, undecided_ = 0;  ///< speeds
  bool judges_ = true;                ///< false: controllers decide whether some are stable
  std::size_t found_ = 0;
  int drifted_ = 0;                   ///< of them: Newton's method found none that attracts
  results::StaticAccuracy accuracy_;  ///< the largest error
  int mesh_judged_ = 0, mesh_not_judged_ = 0;
  std::string missing_;  ///< speeds without an equilibrium
  std::optional<Error> first_error_;
};

void SpeedSweep::take(double Omega) {
  try {
    s_.linear.at(Omega);
  } catch (const Error& e) {
    return miss(Omega, e);
  }
  run::StepState state{s_.linear.equilibrium().state, Omega, {}};
  if (s_.linear.equilibrium().drifted) ++drifted_;
  judge(Omega, state);
  if (found_++ == 0)
    run::warn_of_closed_contacts(job_, step_, results::equilibrium_at(Omega), state.state);
  add_coefficients(state);
  judge_mesh(Omega, state);
  job_.states[step_.name] = std::move(state);
}

/// What the elements do to the equilibria at the ends and in the middle of the speeds.
void SpeedSweep::judge_mesh(double Omega, const run::StepState& state) {
  if (Omega != speeds_.front() && Omega != speeds_.back() && Omega != speeds_[speeds_.size() / 2])
    return;
  if (!results::has_deflections(job_, state)) return;
  const auto accuracy =
      results::static_mesh_error(job_, step_.name, state, s_.linear.running().running());
  if (!accuracy) {
    ++mesh_not_judged_;
    return;
  }
  ++mesh_judged_;
  if (accuracy_.shaft.empty() || accuracy->error > accuracy_.error) accuracy_ = *accuracy;
}

void SpeedSweep::report_mesh() {
  if (mesh_judged_ + mesh_not_judged_ == 0) return;
  std::string said = mesh_judged_ > 0 ? results::report_static_accuracy(job_, step_.name, accuracy_)
                                      : results::report_no_static_accuracy(job_, step_.name);
  if (mesh_judged_ > 0 && mesh_not_judged_ > 0)
    said +=
        fmt::format(", at {} of {} speeds judged", mesh_judged_, mesh_judged_ + mesh_not_judged_);
  s_.summary()["mesh"]["judged at speeds"] = mesh_judged_;
  s_.claim(said);
  s_.section.text += " " + results::capital(said) + ".";
}

void SpeedSweep::miss(double Omega, const Error& e) {
  if (!first_error_) {
    run::StepState start{job_.system().make_state(), Omega, {}};
    s_.linear.running().set_rates(Omega, start.state.v);
    first_error_ = run::explain_no_equilibrium(job_, s_.linear.running(), start, e);
  }
  judged_.add({to_rpm(Omega), 0, "", "", ""});
  missing_ += fmt::format("{}{:.6g}", missing_.empty() ? "" : ", ", to_rpm(Omega));
}

/// The first unstable one is shown.
void SpeedSweep::judge(double Omega, const run::StepState& state) {
  const analysis::Definiteness tangent = results::judge_state(
      s_.linear.running(), state.state, Omega, s_.linear.equilibrium().holds(), unstable_ == 0);
  judged_.add({to_rpm(Omega), 1, static_cast<int>(tangent.negative), tangent.symmetric ? 1 : 0,
               tangent.certain ? 1 : 0});
  judges_ = judges_ && tangent.judged;
  const bool open = tangent.undecided();
  if (tangent.stable() && !open) return;
  if ((open ? undecided_ : unstable_)++ > 0) return;
  // of those that are unstable the summary speaks first
  if (!open || unstable_ == 0) results::add_stability(s_.summary(), tangent, Omega);
  results::warn_of_unstable(job_, fmt::format("{}, {:.6g} rpm", step_.name, to_rpm(Omega)), tangent,
                            Omega);
  if (tangent.shape.size() == 0) return;
  const std::string title =
      fmt::format("Direction in which the equilibrium at {:.6g} rpm is left", to_rpm(Omega));
  s_.add_table("unstable_direction",
               results::shape_table(job_, title, state.state.frames, state.state.q, tangent.shape),
               false);
}

void SpeedSweep::add_coefficients(const run::StepState& state) {
  for (results::SupportCoefficients& c : results::calc_support_coefficients(job_, state)) {
    auto b = std::find_if(bearings_.begin(), bearings_.end(),
                          [&](const Sweep& x) { return x.name == c.name; });
    if (b == bearings_.end()) b = bearings_.insert(b, Sweep{c.name, {}});
    b->at.push_back(c);
    rows_.push_back(std::move(c));
  }
}

void SpeedSweep::show_equilibria() {
  io::Value& v = s_.summary();
  if (undecided_ > 0) v["equilibria not decided"] = undecided_;
  if (unstable_ == 0 && undecided_ == 0 && judges_)
    v["stability"]["stable"] = true;
  else if (unstable_ == 0 && undecided_ == 0)
    v["stability"]["stable"] = "not judged: " + results::left_to_controllers;
  v["unstable equilibria"] = unstable_;
  v["speeds"] = static_cast<int>(speeds_.size());
  v["equilibria"] = static_cast<int>(found_);
  if (drifted_ > 0) v["reached as motions without inertia"] = drifted_;
  s_.add_table("equilibria", std::move(judged_), unstable_ > 0);
  s_.section.text = fmt::format(
      "Equilibria at {} of {} speeds from {:.6g} to {:.6g} rpm, each started from the one before.",
      found_, speeds_.size(), to_rpm(speeds_.front()), to_rpm(speeds_.back()));
  if (!missing_.empty())
    s_.section.text +=
        fmt::format(" None at {} rpm: {}.", missing_, first_error_->diagnostics().front().message);
}

void SpeedSweep::show_rings() {
  results::RingTables rings = results::ring_tables(rows_);
  if (rings.empty()) return;
  s_.add_table("rings", std::move(rings.rings), false);
  s_.add_table("ring_coefficients", std::move(rings.reduced), false);
  s_.add_table("full_ring_coefficients", std::move(rings.full), false);
  for (const std::string& starved : results::starved_rings(rows_))
    s_.summary()["starved rings"].push(starved);
  std::vector<Sweep> ringed;
  for (const Sweep& b : bearings_)
    if (b.at.front().ring) ringed.push_back(b);
  s_.add_figure(draw_ring_speeds(s_.file("ring_speeds"), ringed));
  for (plot::Figure& f : results::draw_rings(
           s_.file("rings"), std::span(rows_).last(std::min(rows_.size(), bearings_.size()))))
    s_.add_figure(std::move(f));
}

void SpeedSweep::show_bearings() {
  if (rows_.empty()) {
    s_.section.text += " No bearing of this model changes its coefficients with speed or load.";
    return;
  }
  io::Table t = results::support_table(rows_);
  t.title = "Bearings against speed";
  if (const std::string grid = results::report_grid_error(s_.summary(), rows_); !grid.empty()) {
    t.title += "; " + grid;
    s_.section.text += " " + results::capital(grid) + ".";
  }
  s_.add_table("coefficients", std::move(t));
  if (results::PadTables pads = results::pad_tables(rows_); !pads.empty()) {
    s_.add_table("pads", std::move(pads.pads), false);
    s_.add_table("pad_coefficients", std::move(pads.reduced), false);
    s_.add_table("full_coefficients", std::move(pads.full), false);
    for (const std::string& unloaded : results::unloaded_pads(rows_))
      s_.summary()["unloaded pads"].push(unloaded);
    for (plot::Figure& f : results::draw_pads(
             s_.file("pads"), std::span(rows_).last(std::min(rows_.size(), bearings_.size()))))
      s_.add_figure(std::move(f));
  }
  if (io::Table films = results::film_table(rows_); !films.rows.empty()) {
    s_.add_table("films", std::move(films), false);
    for (plot::Figure& f : results::draw_films(
             s_.file("films"), std::span(rows_).last(std::min(rows_.size(), bearings_.size()))))
      s_.add_figure(std::move(f));
    if (auto trend = results::draw_film_trends(s_.file("film_trends"), rows_))
      s_.add_figure(std::move(*trend));
    results::warn_of_turbulence(job_, step_.name, rows_);
    results::warn_of_hot_bath(job_, step_.name, rows_);
  }
  show_rings();
  const std::size_t shown = std::min<std::size_t>(bearings_.size(), 8);
  const std::vector<Sweep> drawn(bearings_.begin(),
                                 bearings_.begin() + static_cast<std::ptrdiff_t>(shown));
  s_.add_figure(draw_locus(s_.file("locus"), drawn));
  s_.add_figure(draw_eccentricity(s_.file("eccentricity"), drawn));
  s_.add_figure(draw_coefficients(s_.file("stiffness"), "stiffness", "k", "MN/m", 1e-6,
                                  &results::SupportCoefficients::K, drawn));
  s_.add_figure(draw_coefficients(s_.file("damping"), "damping", "c", "kN s/m", 1e-3,
                                  &results::SupportCoefficients::C, drawn));
  for (const Sweep& b : bearings_) {
    io::Value e = io::Value::object();
    e["bearing"] = b.name;
    if (b.film()) {
      e["eccentricity / clearance at the first speed"] =
          b.at.front().place.norm() / b.at.front().clearance;
      e["and at the last"] = b.at.back().place.norm() / b.at.back().clearance;
    }
    s_.summary()["bearings"].push(std::move(e));
  }
}

void SpeedSweep::execute() {
  run::ProgressLine progress(step_.name, job_.options.quiet);
  for (std::size_t k = 0; k < speeds_.size(); ++k) {
    progress.update(static_cast<double>(k) / static_cast<double>(speeds_.size()),
                    fmt::format("{:.6g} rpm", to_rpm(speeds_[k])));
    take(speeds_[k]);
  }
  if (found_ == 0) throw *first_error_;
  results::warn_of_tables(job_, step_.name, speeds_);
  results::warn_of_mean_crack(job_, step_.name, true);
  report_mesh();
  show_equilibria();
  show_bearings();
  std::string judgement = unstable_ == 0 ? "" : fmt::format(", {} of them unstable", unstable_);
  if (drifted_ > 0) judgement += fmt::format(", {} reached as motions without inertia", drifted_);
  s_.finish(fmt::format("equilibria at {} speeds{}{}", found_, judgement,
                        missing_.empty() ? "" : fmt::format(", none at {} rpm", missing_)));
}

}  // namespace

void run_static_speeds(run::Job& job, const model::Step& step, const std::vector<double>& speeds,
                       int load_steps) {
  SpeedSweep(job, step, speeds, load_steps).execute();
}

}  // namespace whirl::steps
