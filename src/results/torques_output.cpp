// Torques that a transient sends through shafts and couplings: the largest, their stresses, the life
// that their cycles use up, pictures against time and against the angle of the machine.
#include <analysis/response/fatigue.hpp>
#include <assembly/element_section.hpp>
#include <assembly/section_results.hpp>
#include <plot/plots.hpp>
#include <results/along_shaft.hpp>
#include <results/plot_buffer.hpp>
#include <results/transient_output.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace whirl::results {

namespace {

/// Cycles by amplitude at zero mean, in classes a quarter of an octave wide about the endurance limit.
struct CycleClasses {
  static constexpr int below = 24, classes = 40;
  std::array<double, classes> count{}, damage{};
  static int of(double amplitude, double endurance) {
    const double octaves = std::log2(std::max(amplitude, 1e-12 * endurance) / endurance);
    return static_cast<int>(std::clamp(std::floor(4 * octaves) + below, 0.0, classes - 1.0));
  }
  static double lower(int k, double endurance) { return endurance * std::exp2((k - below) / 4.0); }
};

/// One place: an end of an element, or a coupling.
struct Watched {
  double per_torque = 0;            ///< shear stress a N m, 1/m3; 0: none is known
  std::array<double, 2> earlier{};  ///< N m, at the last two looks
  double low = infinity, high = -infinity, at = 0, largest = -1;  ///< N m, N m, s, N m
  analysis::Rainflow cycles{};
  double damage = 0;
  CycleClasses classes{};
};

struct Vertex {
  double t = 0, value = 0;
};

/// Of the parabola through three looks, where they turn: of order four in their distance. Where the
/// slope breaks it is at most an eighth of the greater change too high.
std::optional<Vertex> vertex_of(const std::array<double, 3>& t, const std::array<double, 3>& y) {
  if (!((y[1] - y[0]) * (y[2] - y[1]) < 0)) return std::nullopt;
  const double before = (y[1] - y[0]) / (t[1] - t[0]), after = (y[2] - y[1]) / (t[2] - t[1]),
               bend = (after - before) / (t[2] - t[0]), at = 0.5 * (t[0] + t[1] - before / bend);
  return Vertex{at, y[0] + (at - t[0]) * (before + bend * (at - t[1]))};
}

class TorqueWatch final : public analysis::Observer {
 public:
  TorqueWatch(const run::Job& job, const model::ShaftTorques& law);
  void begin(const analysis::Snapshot& s) override { look(s); }
  void step(analysis::StepAccess& s) override {
    constexpr int looks = 4;
    for (int k = 1; k <= looks; ++k)
      look(s.at(k == looks ? s.t1() : s.t0() + (s.t1() - s.t0()) * k / looks));
  }
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  /// What is still open of the cycles counts as well.
  void finish();

  const std::vector<Watched>& places() const { return places_; }
  const PlotBuffer& history() const { return history_; }
  /// Numbers of bearings whose torques stand behind those of the elements.
  const std::vector<std::size_t>& couplings() const { return couplings_; }
  bool counts() const { return strength_.endurance > 0; }
  const analysis::FatigueStrength& strength() const { return strength_; }

 private:
  void look(const analysis::Snapshot& s);
  void take(Watched& w, double torque, double t);
  void note(Watched& w, double torque, double t) const;
  void count(Watched& w, const analysis::LoadCycle& c) const;

  const run::Job& job_;
  analysis::FatigueStrength strength_;
  std::vector<std::size_t> couplings_;
  std::vector<Watched> places_;      ///< two an element, then the couplings
  std::array<double, 2> earlier_{};  ///< times of the last two looks
  std::size_t looks_ = 0;
  std::vector<double> row_;
  PlotBuffer history_;  ///< angle of the reference; each element; each coupling
};

std::vector<double> turns_of(std::vector<double> angle) {
  for (double& x : angle)
    x /= two_pi;
  return angle;
}

std::vector<std::size_t> couplings_of(const model::Model& m) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < m.bearings.size(); ++k)
    if (m.bearings[k].to && std::holds_alternative<model::Coupling>(m.bearings[k].law))
      out.push_back(k);
  return out;
}

TorqueWatch::TorqueWatch(const run::Job& job, const model::ShaftTorques& law)
    : job_(job),
      strength_{0.67 * law.ultimate, law.thousand, law.endurance, law.cycles},
      couplings_(couplings_of(job.model)),
      history_(1 + job.mesh.elements.size() + couplings_.size(), 1 << 11, 1 << 12) {
  for (const meshes::Element& e : job.mesh.elements) {
    const elements::ElementSection s = assembly::element_section(job.model, e);
    for (const auto& [od, id] : {std::pair{s.od1, s.id1}, std::pair{s.od2, s.id2}}) {
      Watched w;
      if (!s.constants && od > 0)
        w.per_torque = law.concentration * 0.5 * od / elements::annulus_J(od, id);
      places_.push_back(w);
    }
  }
  places_.resize(places_.size() + couplings_.size());
  row_.resize(2 + job.mesh.elements.size() + couplings_.size());
}

void TorqueWatch::count(Watched& w, const analysis::LoadCycle& c) const {
  constexpr double rounding = 1e-9;  // of the endurance: no cycle
  if (!(c.range > rounding * strength_.endurance)) return;
  const double damage = strength_.damage(c);
  const int k = CycleClasses::of(strength_.equivalent(c.amplitude(), c.mean), strength_.endurance);
  w.damage += damage;
  w.classes.count[static_cast<std::size_t>(k)] += c.count;
  w.classes.damage[static_cast<std::size_t>(k)] += damage;
}

void TorqueWatch::take(Watched& w, double torque, double t) {
  if (looks_ > 1)
    if (const auto v =
            vertex_of({earlier_[0], earlier_[1], t}, {w.earlier[0], w.earlier[1], torque}))
      note(w, v->value, v->t);
  note(w, torque, t);
  w.earlier = {w.earlier[1], torque};
}

void TorqueWatch::note(Watched& w, double torque, double t) const {
  w.low = std::min(w.low, torque);
  w.high = std::max(w.high, torque);
  if (std::abs(torque) > w.largest) {
    w.largest = std::abs(torque);
    w.at = t;
  }
  if (counts() && w.per_torque > 0)
    w.cycles.push(w.per_torque * torque, [&](const analysis::LoadCycle& c) { count(w, c); });
}

void TorqueWatch::look(const analysis::Snapshot& s) {
  row_[0] = s.t();
  row_[1] = s.total_phi(job_.reference());
  const std::size_t elements = job_.mesh.elements.size();
  for (std::size_t k = 0; k < elements; ++k) {
    const auto [a, b] = assembly::calc_torques(job_.mesh, job_.built, s.workspace(), k);
    take(places_[2 * k], a, s.t());
    take(places_[2 * k + 1], b, s.t());
    row_[2 + k] = std::abs(a) > std::abs(b) ? a : b;
  }
  const auto nodes = [&s](Index n) -> const system::NodeState& { return s.node(n); };
  const auto reactions = [&s](Index k) { return s.reactions()[k]; };
  for (std::size_t k = 0; k < couplings_.size(); ++k) {
    const model::Bearing& b = job_.model.bearings[couplings_[k]];
    const Vec3 along = job_.scene.lines[b.at.shaft].triad.col(0);
    const assembly::SupportForce& f = job_.built.support_forces[couplings_[k]];
    const double torque = f.moment ? along.dot(f.moment(nodes, s.context(), reactions)) : 0.0;
    row_[2 + elements + k] = torque;
    take(places_[2 * elements + k], torque, s.t());
  }
  history_.append(row_);
  earlier_ = {earlier_[1], s.t()};
  ++looks_;
}

void TorqueWatch::finish() {
  for (Watched& w : places_)
    w.cycles.finish([&](const analysis::LoadCycle& c) { count(w, c); });
}

void TorqueWatch::save(OutArchive& out) const {
  out.put_count(places_.size());
  out.put_count(looks_);
  for (const double t : earlier_)
    out.put(t);
  for (const Watched& w : places_) {
    for (const double x : {w.earlier[0], w.earlier[1], w.low, w.high, w.at, w.largest, w.damage})
      out.put(x);
    out.put(w.cycles.open());
    out.put(std::vector<double>(w.classes.count.begin(), w.classes.count.end()));
    out.put(std::vector<double>(w.classes.damage.begin(), w.classes.damage.end()));
  }
  history_.save(out);
}

void TorqueWatch::restore(InArchive& in) {
  if (in.count() != places_.size()) throw std::invalid_argument("torques of another run");
  looks_ = in.count();
  for (double& t : earlier_)
    t = in.number();
  for (Watched& w : places_) {
    for (double* x : {&w.earlier[0], &w.earlier[1], &w.low, &w.high, &w.at, &w.largest, &w.damage})
      *x = in.number();
    w.cycles.reopen(in.numbers());
    for (std::array<double, CycleClasses::classes>* x : {&w.classes.count, &w.classes.damage}) {
      const std::vector<double> saved = in.numbers();
      if (saved.size() != x->size()) throw std::invalid_argument("torques of another run");
      std::copy(saved.begin(), saved.end(), x->begin());
    }
  }
  history_.restore(in);
}

class TorquesOutput final : public TransientOutput {
 public:
  TorquesOutput(const TransientSetup& s, const model::ShaftTorques& law)
      : law_(law),
        job_(s.job),
        watch_(s.job, law) {}

  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&watch_);
    parts.add({run::Part::torques,
               fmt::format("{} {} {} {} {} {}", law_.concentration, law_.ultimate, law_.thousand,
                           law_.endurance, law_.cycles, watch_.places().size())},
              watch_);
  }
  void summarize(TransientEnd& end) override;
  void report(TransientEnd& end) override;

 private:
  std::size_t elements() const { return job_.mesh.elements.size(); }
  /// The worse end of an element.
  const Watched& worse(std::size_t element) const {
    const Watched &a = watch_.places()[2 * element], &b = watch_.places()[2 * element + 1];
    return a.per_torque * a.largest >= b.per_torque * b.largest ? a : b;
  }
  double damage(std::size_t element) const {
    return std::max(watch_.places()[2 * element].damage, watch_.places()[2 * element + 1].damage);
  }
  std::size_t most_stressed() const;
  std::size_t most_damaged() const;
  io::Table table() const;
  void add_row(io::Table& t, std::vector<io::Table::Cell> part, const Watched& w,
               double used) const;
  io::Table classes(std::size_t element) const;
  plot::Figure along() const;
  std::vector<plot::Series> series(bool against_angle) const;
  void add_histories(TransientEnd& end) const;

  const model::ShaftTorques& law_;
  run::Job& job_;
  TorqueWatch watch_;
};

std::size_t TorquesOutput::most_stressed() const {
  std::size_t most = 0;
  for (std::size_t k = 1; k < elements(); ++k)
    if (worse(k).per_torque * worse(k).largest > worse(most).per_torque * worse(most).largest)
      most = k;
  return most;
}

/// The most stressed one where no cycle does harm.
std::size_t TorquesOutput::most_damaged() const {
  std::size_t most = most_stressed();
  for (std::size_t k = 0; k < elements(); ++k)
    if (damage(k) > damage(most)) most = k;
  return most;
}

void TorquesOutput::summarize(TransientEnd& end) {
  watch_.finish();
  run::ShaftDamage& keep = end.job.shaft_damage[end.step.name];
  keep = {};
  for (std::size_t k = 0; k < elements(); ++k) {
    keep.stress.push_back(worse(k).per_torque * worse(k).largest);
    if (watch_.counts()) keep.damage.push_back(damage(k));
  }
  if (elements() == 0) return;
  const std::size_t most = most_stressed();
  io::Value& v = end.summary["torques"];
  v["most stressed"] = element_name(job_.mesh, most);
  v["largest torque there [N m]"] = worse(most).largest;
  v["shear stress [MPa]"] = 1e-6 * keep.stress[most];
  if (law_.yield > 0) v["of yield [%]"] = 100 * keep.stress[most] / law_.yield;
  if (watch_.counts()) v["damage"] = *std::max_element(keep.damage.begin(), keep.damage.end());
}

/// A cycle that reaches the strength is the last one: without end is what the damage is, no number
/// that is missing.
io::Table::Cell damage_cell(double x) {
  return std::isinf(x) ? io::Table::Cell("inf") : io::Table::Cell(x);
}

io::Table TorquesOutput::table() const {
  io::Table t;
  t.title = "Torques in shafts and couplings";
  t.columns = {{"part", "-", ""},
               {"from", "m", "from the left end of the shaft"},
               {"to", "m", ""},
               {"lowest", "N m", "torque"},
               {"highest", "N m", ""},
               {"largest at", "s", ""},
               {"shear stress", "MPa", "largest, with the concentration"}};
  if (law_.yield > 0) t.columns.push_back({"of yield", "%", "share of the yield stress"});
  if (watch_.counts()) {
    t.columns.push_back({"damage", "-", "share of the life that this transient uses up"});
    t.columns.push_back({"times", "-", "that the part endures it; empty: endlessly"});
  }
  t.nan_means = "no stress is known there, no end of life";
  t.nan_is_absence = true;
  for (std::size_t k = 0; k < elements(); ++k) {
    const meshes::Element& e = job_.mesh.elements[k];
    add_row(t, {job_.mesh.lines[at(e.line)].name, e.s1, e.s2}, worse(k), damage(k));
  }
  for (std::size_t k = 0; k < watch_.couplings().size(); ++k)
    add_row(t, {job_.model.bearings[watch_.couplings()[k]].name, nan, nan},
            watch_.places()[2 * elements() + k], nan);
  return t;
}

/// part: name, from, to.
void TorquesOutput::add_row(io::Table& t, std::vector<io::Table::Cell> part, const Watched& w,
                            double used) const {
  const bool known = w.per_torque > 0;
  const double stress = known ? w.per_torque * w.largest : nan;
  for (const double x : {w.low, w.high, w.at, 1e-6 * stress})
    part.emplace_back(x);
  if (law_.yield > 0) part.emplace_back(100 * stress / law_.yield);
  if (watch_.counts()) {
    part.push_back(damage_cell(known ? used : nan));
    part.emplace_back(known && used > 0 ? 1.0 / used : nan);
  }
  t.add(std::move(part));
}

/// Of the end with the greater damage.
io::Table TorquesOutput::classes(std::size_t element) const {
  const Watched &a = watch_.places()[2 * element], &b = watch_.places()[2 * element + 1];
  const CycleClasses& c = (a.damage >= b.damage ? a : b).classes;
  io::Table t;
  t.title = "Load cycles (rainflow) of " + element_name(job_.mesh, element);
  t.columns = {{"from", "MPa", "shear stress amplitude about zero mean (Goodman)"},
               {"to", "MPa", ""},
               {"cycles", "-", ""},
               {"damage", "-", ""}};
  const double endurance = watch_.strength().endurance;
  for (int k = 0; k < CycleClasses::classes; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (c.count[i] == 0) continue;
    t.add({k == 0 ? 0.0 : 1e-6 * CycleClasses::lower(k, endurance),
           1e-6 * CycleClasses::lower(k + 1, endurance), c.count[i], damage_cell(c.damage[i])});
  }
  return t;
}

/// Largest shear stress along every shaft.
plot::Figure TorquesOutput::along() const {
  plot::Axes a;
  a.x = plot::Axis("axial position", "m");
  a.y = plot::Axis("largest shear stress", "MPa");
  a.y.include_zero = true;
  for (std::size_t l = 0; l < job_.mesh.lines.size(); ++l) {
    plot::Series s;
    s.label = job_.mesh.lines.size() > 1 ? job_.mesh.lines[l].name : "";
    for (std::size_t k = 0; k < elements(); ++k) {
      const meshes::Element& e = job_.mesh.elements[k];
      if (at(e.line) != l) continue;
      for (const std::size_t right : {0u, 1u}) {
        const Watched& w = watch_.places()[2 * k + right];
        s.x.push_back(job_.model.shafts[l].position(right ? e.s2 : e.s1).x());
        s.y.push_back(w.per_torque > 0 ? 1e-6 * w.per_torque * w.largest : nan);
      }
    }
    if (!s.x.empty()) a.series.push_back(std::move(s));
  }
  plot::Figure f;
  f.title = "Largest shear stress along the shafts";
  f.axes.push_back(std::move(a));
  return f;
}

/// Of the most stressed element and of the couplings.
std::vector<plot::Series> TorquesOutput::series(bool against_angle) const {
  std::vector<std::pair<std::string, std::size_t>> shown;
  if (elements() > 0)
    shown.emplace_back("shaft " + element_name(job_.mesh, most_stressed()), 1 + most_stressed());
  for (std::size_t k = 0; k < watch_.couplings().size(); ++k)
    shown.emplace_back(job_.model.bearings[watch_.couplings()[k]].name, 1 + elements() + k);
  std::vector<plot::Series> out;
  for (const auto& [name, channel] : shown) {
    plot::Series s;
    s.label = name;
    s.style.width = 1.1;
    if (channel > elements()) s.style.dash = plot::Dash::dashed;  // often over that of the shaft
    PlotBuffer::Points p = watch_.history().channel(channel);
    s.x = against_angle ? turns_of(watch_.history().values_at(0, p.t)) : std::move(p.t);
    s.y = std::move(p.y);
    out.push_back(std::move(s));
  }
  return out;
}

void TorquesOutput::add_histories(TransientEnd& end) const {
  double largest = 0;
  for (const plot::Series& s : series(false))
    for (const double y : s.y)
      largest = std::max(largest, std::abs(y));
  if (!(largest > 0)) return;
  const plot::DisplayUnit unit = plot::unit_for("N.m", largest);
  for (const bool against_angle : {false, true}) {
    plot::Figure f;
    f.name = end.step.name + (against_angle ? "_shaft_torque_angle" : "_torques");
    f.title = std::string("Torques in the most stressed part and in couplings") +
              (against_angle ? ", against the angle of the machine" : "");
    plot::Axes a;
    a.x = against_angle ? plot::Axis("angle of the reference shaft", "turns")
                        : plot::Axis("time", "s");
    a.y = plot::Axis("torque", unit.name);
    a.series = series(against_angle);
    for (plot::Series& s : a.series)
      for (double& y : s.y)
        y *= unit.factor;
    f.axes.push_back(std::move(a));
    end.section.figures.push_back(std::move(f));
  }
}

void TorquesOutput::report(TransientEnd& end) {
  if (watch_.places().empty()) return;
  const std::string& step = end.step.name;
  const bool shown = end.job.model.output.report;
  const auto add = [&](io::Table t, const char* what, const std::string& file) {
    end.job.folder.write_table(file, t);
    if (!shown) return;
    end.section.files.emplace_back(what, file);
    end.section.tables.push_back(std::move(t));
  };
  add(table(), "torques", step + "_torques.csv");
  if (watch_.counts() && elements() > 0)
    add(classes(most_damaged()), "load cycles", step + "_rainflow.csv");
  if (!shown) return;
  add_histories(end);
  if (elements() == 0) return;
  plot::Figure f = along();
  f.name = step + "_shear_stress";
  end.section.figures.push_back(std::move(f));
}

}  // namespace

void add_torques(const TransientSetup& setup, TransientOutputs& outputs) {
  if (setup.law.torques)
    outputs.push_back(std::make_unique<TorquesOutput>(setup, *setup.law.torques));
}

}  // namespace whirl::results
