// A modal step: whirl modes at one speed.
#include <analysis/spectra/mode_energy.hpp>
#include <results/frequency.hpp>
#include <results/linear_limits.hpp>
#include <results/mesh_accuracy.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace whirl::steps {

namespace {

/// Names of what has a part's energy: disks at nodes, bearings at nodes or between two.
class PartNames {
 public:
  explicit PartNames(const run::Job& job) {
    for (const model::Disk& d : job.model.disks)
      add(disks_, {job.mesh.place(d.at).node, -1}, d.name);
    for (std::size_t i = 0; i < job.mesh.bearings.size(); ++i) {
      const meshes::BearingNodes& b = job.mesh.bearings[i];
      const std::string& name = job.model.bearings[i].name;
      const Index other = b.other.node;
      const bool on_the_shaft_alone = other < 0 || other == b.shaft.node || other == b.ground;
      add(bearings_, {b.shaft.node, on_the_shaft_alone ? -1 : other}, name);
      if (b.pedestal >= 0) add(bearings_, {b.pedestal, -1}, name + " pedestal");
      if (b.ground >= 0) grounds_.insert(b.ground);
    }
  }
  /// Empty: none is known.
  std::string of(const analysis::EnergyPart& p, bool kinetic) const {
    const Names& all = kinetic ? disks_ : bearings_;
    const auto ground = [this](Index n) { return grounds_.count(n) > 0; };
    const Ends ends = ground(p.other)  ? Ends{p.node, -1}
                      : ground(p.node) ? Ends{p.other, -1}
                                       : Ends{p.node, p.other};
    const auto it = all.find(sorted(ends));
    return it == all.end() ? std::string() : it->second;
  }

 private:
  using Ends = std::pair<Index, Index>;
  using Names = std::map<Ends, std::string>;
  static Ends sorted(Ends e) {
    if (e.first < e.second) std::swap(e.first, e.second);
    return e;
  }
  static void add(Names& to, Ends ends, const std::string& name) {
    if (ends.first < 0) return;
    std::string& s = to[sorted(ends)];
    s += (s.empty() ? "" : ", ") + name;
  }
  Names disks_, bearings_;
  std::set<Index> grounds_;
};

/// Two tables: every part of every mode (a file), and shares by shaft, disk and bearing (the
/// report).
void add_energy_tables(results::FrequencyStep& s, const std::vector<analysis::WhirlMode>& modes) {
  const PartNames names(s.job);
  io::Table all, sums;
  all.title = "Energy of the modes by element";
  all.columns = {
      {"mode", "-", ""},     {"energy", "-", "strain or kinetic"},        {"part", "-", ""},
      {"from", "-", "node"}, {"to", "-", "node, of what is between two"}, {"share", "%", ""}};
  sums.title = "Energy of the modes by part";
  std::vector<std::pair<std::string, std::vector<double>>> columns;  // in order of appearance
  const auto column = [&](const std::string& name) -> std::vector<double>& {
    for (auto& c : columns)
      if (c.first == name) return c.second;
    columns.emplace_back(name, std::vector<double>(modes.size(), 0.0));
    return columns.back().second;
  };
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const analysis::ModeEnergy e = analysis::energy_distribution(s.linear, modes[k].x);
    const system::System& sys = s.linear.system();
    for (const bool kinetic : {false, true})
      for (const analysis::EnergyPart& p : kinetic ? e.kinetic : e.strain) {
        all.add({static_cast<int>(k + 1), kinetic ? "kinetic" : "strain", p.kind,
                 sys.node(p.node).name, p.other >= 0 ? sys.node(p.other).name : std::string(),
                 100 * p.share});
        const bool shaft = p.family == system::Family::shaft;
        const std::string own = shaft ? "shaft" : names.of(p, kinetic);
        const std::string& part = own.empty() ? p.kind : own;
        column((kinetic ? "kinetic: " : "strain: ") + part)[k] += p.share;
      }
  }
  sums.columns.push_back({"mode", "-", ""});
  std::stable_sort(columns.begin(), columns.end(), [](const auto& a, const auto& b) {
    return a.first.front() > b.first.front();
  });  // strain first
  for (const auto& c : columns)
    sums.columns.push_back({c.first, "%", ""});
  for (std::size_t k = 0; k < modes.size(); ++k) {
    std::vector<io::Table::Cell> row{static_cast<int>(k + 1)};
    for (const auto& c : columns)
      row.emplace_back(100 * results::tidy(c.second[k]));
    sums.add(std::move(row));
  }
  s.add_table("energy_parts", std::move(sums));
  s.add_table("energy", std::move(all), false);
}

analysis::ModesOptions modes_options(const run::Job& job, const model::ModalStep& law) {
  analysis::ModesOptions o;
  o.count = law.modes;
  o.max_frequency = law.max_frequency;
  o.motion = results::motion_of(law.motion);
  o.damped = law.damped;
  o.real_roots = true;
  o.judge = law.damped;
  o.continued = law.damped && !job.built.table_frequencies.empty();
  return o;
}

/// Modes as a table and in the summary; what they are together.
class ModalRun {
 public:
  ModalRun(run::Job& job, const model::Step& step, const model::ModalStep& law)
      : law_(law),
        options_(modes_options(job, law)),
        s_(job, step, "modal", "whirl modes", std::abs(law.speed)) {}
  void execute();
  const std::vector<analysis::WhirlMode>& modes() const { return modes_; }

 private:
  void solve();
  io::Table empty_table() const;
  void add_modes();
  void add_rates();
  void add_shape(std::size_t k);
  std::string text() const;
  std::string doubt() const;
  std::string line() const;
  /// What turns unevenly enters as its mean: motions that grow by its turning are no modes of that.
  bool is_mean() const {
    const model::Model& m = s_.job.model;
    return law_.speed != 0 && (results::turns_with_stiffness(m) || results::turns_with_inertia(m));
  }

  const model::ModalStep& law_;
  const analysis::ModesOptions options_;
  results::FrequencyStep s_;
  analysis::SpectrumCertificate certificate_;
  std::vector<analysis::WhirlMode> all_, modes_;  ///< modes_: those that oscillate
  std::vector<std::string> labels_;               ///< of modes_
  int unstable_ = 0, diverging_ = 0;
};

void ModalRun::solve() {
  const run::PhaseTimer timer(s_.job, "modes");
  analysis::ModesOptions o = options_;
  while (true) {
    all_ = analysis::whirl_modes(s_.linear, law_.speed, o, &certificate_);
    modes_.clear();
    std::copy_if(all_.begin(), all_.end(), std::back_inserter(modes_),
                 [](const analysis::WhirlMode& m) { return m.oscillates(); });
    // what hardly oscillates stands in a list of its own, and takes no place in this one
    const Index missing = options_.count - static_cast<Index>(modes_.size());
    if (missing <= 0 || static_cast<Index>(all_.size()) < o.count) break;
    o.count += missing;
  }
  labels_ = results::labels_of(modes_);
}

io::Table ModalRun::empty_table() const {
  io::Table table;
  table.title = "Modes";
  table.nan_means = "the mode was not found on a finer mesh";
  table.columns = {
      {"mode", "-", ""},
      {"label", "-", "number within its kind"},
      {"kind", "-", "by the largest share of energy"},
      {"direction", "-", "of the orbits, seen along the spin"},
      {"frequency", "Hz", "damped natural frequency"},
      {"frequency", "rpm", ""},
      {"log decrement", "-", "per cycle; negative: unstable"},
      {"damping ratio", "-", "of the critical damping of the mode"},
      {"lateral", "%", "share of the energy"},
      {"torsional", "%", ""},
      {"axial", "%", ""},
      {"forwardness", "-", "1: forward circles, -1: backward circles"},
      {"mesh error", "-", "of the frequency, relative, by the length of the elements; estimated"}};
  if (options_.continued)
    table.columns.push_back(
        {"continued log decrement", "-",
         "with coefficients continued from the frequency to the decay of the motion, first order"});
  return table;
}

void ModalRun::add_modes() {
  io::Table table = empty_table();
  results::MeshAccuracy mesh(s_);
  io::Value list = io::Value::array();
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    const analysis::WhirlMode& m = modes_[k];
    std::vector<io::Table::Cell> row{static_cast<int>(k + 1),
                                     labels_[k],
                                     std::string(to_string(m.kind)),
                                     results::direction_text(m),
                                     to_hz(m.frequency),
                                     to_rpm(m.frequency),
                                     results::tidy(m.log_decrement),
                                     results::tidy(m.damping_ratio),
                                     100 * results::tidy(m.lateral),
                                     100 * results::tidy(m.torsional),
                                     100 * results::tidy(m.axial),
                                     results::tidy(m.forwardness),
                                     mesh.of(m, law_.speed, labels_[k])};
    const double continued = -two_pi * m.continued.real() / m.continued.imag();
    if (options_.continued) row.emplace_back(results::tidy(continued));
    table.add(std::move(row));
    io::Value e = io::Value::object();
    e["label"] = labels_[k];
    e["frequency [Hz]"] = to_hz(m.frequency);
    e["log decrement"] = results::tidy(m.log_decrement);
    e["damping ratio"] = results::tidy(m.damping_ratio);
    if (options_.continued) e["continued log decrement"] = results::tidy(continued);
    e["kind"] = std::string(to_string(m.kind));
    e["direction"] = results::direction_text(m);
    list.push(std::move(e));
    unstable_ += m.growth() > 0;
  }
  s_.summary()["modes"] = list;
  mesh.report();
  s_.add_table("modes", std::move(table));
}

/// Motions that do not oscillate.
void ModalRun::add_rates() {
  io::Value rates = io::Value::array();
  for (const analysis::WhirlMode& m : all_) {
    if (m.oscillates()) continue;
    diverging_ += m.growth() > 0;
    rates.push(m.growth() == 0 ? 0.0 : m.lambda.real());
  }
  io::Value& v = s_.summary();
  v["rates of motions that do not oscillate [1/s]"] = rates;
  v["unstable modes"] = unstable_;
  v["diverging motions"] = diverging_;
  io::Table real_roots = results::real_root_table(all_);
  if (!real_roots.rows.empty()) s_.add_table("real_roots", std::move(real_roots));
}

void ModalRun::add_shape(std::size_t k) {
  const analysis::WhirlMode& m = modes_[k];
  const std::string name = fmt::format("mode_{}", k + 1);
  results::ShapeDrawing d{name,
                          fmt::format("Mode {} ({}): {:.5g} Hz, {}", k + 1, labels_[k],
                                      to_hz(m.frequency), results::description(m)),
                          {},
                          &m.x,
                          m.kind};
  if (std::abs(m.log_decrement) > 1e-9)
    d.caption = fmt::format("Log decrement {:.4g}, damping ratio {:.4g}.", m.log_decrement,
                            m.damping_ratio);
  results::add_shape_figures(s_, d);
  results::write_shape_frames(s_, name, m.x);
}

std::string ModalRun::text() const {
  std::string text = fmt::format("{} whirl modes at {:.6g} rpm, {}.", modes_.size(),
                                 to_rpm(law_.speed), law_.damped ? "damped" : "undamped");
  if (unstable_ > 0) text += fmt::format(" {} of them unstable.", unstable_);
  if (diverging_ > 0)
    text += fmt::format(" {} motion{} without oscillating.", diverging_,
                        diverging_ == 1 ? " diverges" : "s diverge");
  text += " " + results::capital(certificate_.text()) + ".";
  if (law_.damped && unstable_ + diverging_ == 0)
    text +=
        " " + results::capital(results::stability_text(certificate_)) +
        (is_mean() ? ", of the mean over a revolution; growth in bands of speed is not excluded."
                   : ".");
  return text;
}

/// What grows beyond the list may not be known where nothing in it does.
std::string ModalRun::doubt() const {
  const bool asked = law_.damped && unstable_ + diverging_ == 0;
  if (asked && is_mean()) return ", growth in bands of speed not excluded";
  if (!asked || !certificate_.complete() || certificate_.stability_certain()) return {};
  return fmt::format(", growth above {:.5g} Hz not excluded", to_hz(certificate_.list.radius));
}

std::string ModalRun::line() const {
  const std::size_t asked = static_cast<std::size_t>(law_.modes);
  const bool cut = !certificate_.by_frequency && certificate_.cut();
  const std::string of_those =
      cut && modes_.size() < asked ? fmt::format(" of the {} asked for", asked) : "";
  std::string line =
      fmt::format("{} modes{} at {:.0f} rpm", modes_.size(), of_those, to_rpm(law_.speed));
  for (std::size_t k = 0; k < std::min<std::size_t>(modes_.size(), 4); ++k)
    line += fmt::format("{}{:.4g}", k ? ", " : ": ", to_hz(modes_[k].frequency));
  const la::Certificate& list = certificate_.list;
  std::string complete =
      list.taken_for_zero > 0
          ? fmt::format(", complete but for {} slower than {:.2g} Hz, which rounding hides",
                        list.taken_for_zero, to_hz(list.zeros_within))
          : ", complete";
  if (cut) complete += fmt::format(" as to what decays no faster than {:.3g} 1/s", list.reach);
  return line +
         (modes_.empty()      ? ""
          : modes_.size() > 4 ? " ... Hz"
                              : " Hz") +
         (unstable_ ? fmt::format(", {} unstable", unstable_) : "") +
         (diverging_ ? fmt::format(", {} diverging", diverging_) : "") +
         (certificate_.complete()            ? complete
          : certificate_.stability_certain() ? ", growing ones certified"
                                             : ", not certified") +
         doubt();
}

void ModalRun::execute() {
  solve();
  s_.summary()["speed [rpm]"] = to_rpm(law_.speed);
  results::warn_of_tables(s_.job, s_.step.name, law_.speed, law_.speed);
  add_modes();
  add_rates();
  s_.certify(certificate_);
  if (!modes_.empty()) add_energy_tables(s_, modes_);
  for (std::size_t k = 0; k < std::min(modes_.size(), static_cast<std::size_t>(law_.shapes)); ++k)
    add_shape(k);
  s_.section.text = text();
  const std::string moments = results::moments_along_shafts(s_.job.model);
  if (unstable_ > 0 && !moments.empty()) s_.assume(moments);
  s_.finish(line());
}

}  // namespace

std::vector<analysis::WhirlMode> run_modal_step(run::Job& job, const model::Step& step,
                                                const model::ModalStep& law) {
  ModalRun run(job, step, law);
  run.execute();
  return run.modes();
}

}  // namespace whirl::steps
