// An api_torsional step: the train, where multiples of the speeds and of the line frequency meet its
// torsional modes, how far they keep away, and the stresses that stated torques cause.
#include <core/messages.hpp>
#include <analysis/response/frequency_response.hpp>
#include <analysis/spectra/critical.hpp>
#include <assembly/element_section.hpp>
#include <core/contract.hpp>
#include <core/periodic.hpp>
#include <meshes/mass_properties.hpp>
#include <results/along_shaft.hpp>
#include <results/channels.hpp>
#include <results/compliance.hpp>
#include <results/frequency.hpp>
#include <results/linear_limits.hpp>
#include <results/mesh_accuracy.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::steps {

namespace {

using results::Check;

/// Something that excites torsion: at a multiple of the reference speed, at a frequency, or at the
/// distance of the two.
struct Excitation {
  std::string name;
  double order = 0, frequency = 0;  ///< of the reference speed; rad/s
  double at(double Omega) const { return std::abs(frequency - order * Omega); }
  bool follows() const { return order != 0; }
  /// Least and largest frequency over the operating range, rad/s.
  std::array<double, 2> over(const std::array<double, 2>& speed) const {
    const double a = frequency - order * speed[0], b = frequency - order * speed[1];
    const double low = a * b <= 0 ? 0.0 : std::min(std::abs(a), std::abs(b));
    return {low, std::max(std::abs(a), std::abs(b))};
  }
  /// Speeds at which it has the frequency w. @pre follows().
  std::vector<double> speeds(double w) const {
    std::vector<double> out;
    for (const double f : {frequency - w, frequency + w})
      if (f / order >= 0) out.push_back(f / order);
    return out;
  }
};

/// Distance of a frequency from a range, as a share of its nearer end; negative inside.
double margin_from(double f, const std::array<double, 2>& range) {
  if (f > range[1]) return (f - range[1]) / range[1];
  if (f < range[0]) return (range[0] - f) / range[0];
  return f == 0 ? 0.0 : -std::min(f - range[0], range[1] - f) / f;
}

/// Where a torque does most.
struct Worst {
  double stress = 0, torque = 0, speed = 0, frequency = 0;  ///< Pa, N m, rad/s, rad/s
  Index element = -1;
  bool unbounded = false;
  bool known = false;                       ///< some section has diameters
  double coupling = 0, coupling_speed = 0;  ///< N m, the largest in a coupling, and where, rad/s
  std::string coupling_name;
};

/// Whether a torque tells the stress.
bool has_diameters(const elements::ElementSection& s) {
  return !s.constants && s.od1 > 0 && s.od2 > 0;
}

class TorsionalReport {
 public:
  TorsionalReport(run::Job& job, const model::Step& step, const model::ApiTorsionalStep& law)
      : law_(law),
        s_(job, step, "api_torsional", "torsional report, " + law.standard, law.operating[1]) {}
  void execute();

 private:
  void add_train();
  void find_modes();
  void list_excitations();
  double highest_excitation() const;  ///< over the operating speeds, rad/s
  void add_margins();
  void judge_growth();
  void add_interference();
  void add_stresses();
  double ratio_of(std::size_t shaft) const {
    const model::Shaft& s = s_.job.model.shafts[shaft];
    return s.rotating ? std::abs(s.speed_ratio) : 0.0;
  }
  /// One of the harmonics of a torque.
  struct Component {
    Excitation excitation;
    Complex amplitude;    ///< N m
    double per_turn = 0;  ///< order of the shaft it acts on
  };
  std::vector<Component> components_of(const model::ApiTorque& torque) const;
  std::vector<double> speeds_of(const std::vector<Component>& components) const;
  /// Modes as high as the harmonics of the torques reach, those of the list or more.
  void find_modes_met();
  std::vector<Complex> element_torques(const VecXc& a, const la::MCK& m) const;
  std::vector<Complex> coupling_torques(const VecXc& a, double w) const;
  void look(const std::vector<std::vector<Complex>>& elements,
            const std::vector<std::vector<Complex>>& couplings,
            const std::vector<Component>& components, double Omega, Worst& worst) const;
  Worst respond(const model::ApiTorque& torque);
  void add_events();
  bool add_event(const model::ApiEvent& e, io::Table& t, std::vector<double>& sum);
  std::string without_stresses() const;
  /// Of some section.
  bool stress_is_known() const;
  std::string source(const char* key) const {
    return results::source_of(law_.standard, law_.given, law_.source, {key});
  }

  const model::ApiTorsionalStep& law_;
  results::FrequencyStep s_;
  results::Compliance checks_;
  std::vector<analysis::WhirlMode> modes_, met_;
  std::vector<Excitation> excitations_;
};

void TorsionalReport::add_train() {
  const model::Model& m = s_.job.model;
  io::Table shafts, bodies;
  shafts.title = "Train: shafts";
  shafts.columns = {{"shaft", "-", ""},
                    {"speed ratio", "-", "to the reference"},
                    {"mass", "kg", ""},
                    {"inertia", "kg m2", "about its axis"},
                    {"referred inertia", "kg m2", "times the square of the speed ratio"}};
  for (std::size_t k = 0; k < m.shafts.size(); ++k) {
    const meshes::MassProperties p = meshes::shaft_mass(m, k);
    const double r = ratio_of(k);
    shafts.add({m.shafts[k].name, m.shafts[k].rotating ? m.shafts[k].speed_ratio : 0.0, p.mass,
                p.Ip(), r * r * p.Ip()});
  }
  s_.add_table("train", std::move(shafts));
  bodies.title = "Train: bodies and couplings";
  bodies.columns = {{"name", "-", ""},
                    {"shaft", "-", ""},
                    {"place", "m", "from the left end of the shaft"},
                    {"inertia", "kg m2", "about the axis"},
                    {"stiffness", "N m/rad", "in torsion, of a coupling"}};
  bodies.nan_means = "a body has no stiffness, a coupling no inertia here";
  bodies.nan_is_absence = true;
  for (const model::Disk& d : m.disks)
    bodies.add({d.name, m.shafts[d.at.shaft].name, d.at.s, d.Ip, nan});
  for (const model::Bearing& b : m.bearings) {
    const auto* c = std::get_if<model::Coupling>(&b.law);
    if (c && b.to) bodies.add({b.name, m.shafts[b.at.shaft].name, b.at.s, nan, c->K(3, 3)});
  }
  s_.add_table("bodies", std::move(bodies));
}

void TorsionalReport::find_modes() {
  analysis::ModesOptions o;
  o.count = law_.modes;
  o.motion = analysis::Motion::torsional;
  analysis::SpectrumCertificate certificate;
  modes_ = analysis::whirl_modes(s_.linear, law_.operating[1], o, &certificate);
  // a mode that an excitation may come near is judged, whatever its number
  const double highest = (1 + law_.margin) * highest_excitation();
  if (!modes_.empty() && modes_.back().frequency < highest) {
    o.count = 0;
    o.max_frequency = highest;
    analysis::SpectrumCertificate of_reached;
    std::vector<analysis::WhirlMode> reached =
        analysis::whirl_modes(s_.linear, law_.operating[1], o, &of_reached);
    if (reached.size() > modes_.size()) {
      modes_ = std::move(reached);
      certificate = of_reached;
    }
  }
  s_.certify(certificate);
  results::MeshAccuracy mesh(s_);
  mesh.look_at(modes_, law_.operating[1]);
  mesh.report();
  io::Table t;
  t.title = "Torsional natural frequencies";
  t.columns = {{"mode", "-", ""},
               {"frequency", "Hz", ""},
               {"frequency", "rpm", ""},
               {"log decrement", "-", ""}};
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    const analysis::WhirlMode& m = modes_[k];
    t.add({static_cast<int>(k + 1), to_hz(m.frequency), to_rpm(m.frequency),
           results::tidy(m.log_decrement)});
    results::add_shape_figures(
        s_, {fmt::format("mode_{}", k + 1),
             fmt::format("Torsional mode {}: {:.5g} Hz", k + 1, to_hz(m.frequency)),
             {},
             &m.x,
             analysis::ModeKind::torsional});
  }
  s_.add_table("modes", std::move(t));
}

/// Multiples of each shaft, orders of the reference, multiples of the line frequency, torques.
void TorsionalReport::list_excitations() {
  const model::Model& m = s_.job.model;
  const auto add = [&](Excitation e) {
    const bool known = std::any_of(excitations_.begin(), excitations_.end(), [&](const auto& x) {
      return std::abs(x.order - e.order) < 1e-9 && std::abs(x.frequency - e.frequency) < 1e-9;
    });
    if (!known) excitations_.push_back(std::move(e));
  };
  for (std::size_t k = 0; k < m.shafts.size(); ++k)
    for (const double n : law_.multiples)
      if (ratio_of(k) > 0)
        add({fmt::format("{:g}x of {}", n, m.shafts[k].name), n * ratio_of(k), 0});
  for (const double n : law_.orders)
    add({fmt::format("{:g}x of the reference", n), n, 0});
  for (const double n : law_.line_multiples)
    if (law_.line_frequency > 0)
      add({fmt::format("{:g}x line frequency", n), 0, n * law_.line_frequency});
  for (const model::ApiTorque& t : law_.torques)
    if (t.harmonics.empty()) add({t.name, t.order * ratio_of(t.at.shaft), t.frequency});
}

double TorsionalReport::highest_excitation() const {
  double highest = 0;
  for (const Excitation& e : excitations_)
    highest = std::max(highest, e.over(law_.operating)[1]);
  return highest;
}

void TorsionalReport::add_margins() {
  io::Table t;
  t.title = "Margins of the torsional frequencies";
  t.columns = {
      {"mode", "-", ""},       {"frequency", "Hz", ""},
      {"excitation", "-", ""}, {"lowest", "Hz", "over the operating speeds"},
      {"highest", "Hz", ""},   {"margin", "%", "negative: met within the operating speeds"},
      {"result", "-", ""}};
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    const double f = modes_[k].frequency;
    double least = infinity;
    const Excitation* nearest = nullptr;
    for (const Excitation& e : excitations_) {
      const std::array<double, 2> range = e.over(law_.operating);
      const double margin = margin_from(f, range);
      t.add({static_cast<int>(k + 1), to_hz(f), e.name, to_hz(range[0]), to_hz(range[1]),
             100 * margin, margin >= law_.margin ? "passed" : "FAILED"});
      if (margin >= least) continue;
      least = margin;
      nearest = &e;
    }
    if (!nearest) continue;
    Check c = results::compare("torsional margin", 100 * least, "%", Check::Rule::at_least,
                               100 * law_.margin);
    c.where = fmt::format("mode {}, {:.5g} Hz, {}", k + 1, to_hz(f), nearest->name);
    c.source = source("margin");
    c.figure = s_.file("interference");
    checks_.add(std::move(c));
  }
  s_.add_table("margins", std::move(t), false);
}

/// Torques that rise with the speed, and controls, can drive torsion: no margin says so.
void TorsionalReport::judge_growth() {
  const std::vector<double> speeds{law_.operating[0], law_.operating[1]};
  if (!results::warn_of_growth(s_, results::speeds_to_judge(s_.job, speeds),
                               analysis::Motion::torsional))
    return;
  Check c;
  c.what = "torsional stability";
  c.passed = false;
  c.where = "operating speeds";
  c.remark = "a motion grows (W13)";
  checks_.add(std::move(c));
}

/// An excitation with a frequency and an order, in the interference diagram.
plot::Series line_of(const Excitation& e, double top) {
  plot::Series s;
  s.label = e.name;
  s.style = {plot::ink, plot::Dash::dotted, 1.2};
  std::vector<double> speeds{0.0, top};
  if (const double zero = e.frequency / e.order; zero > 0 && zero < top)
    speeds.insert(speeds.begin() + 1, zero);
  for (const double Omega : speeds) {
    s.x.push_back(to_rpm(Omega));
    s.y.push_back(to_hz(e.at(Omega)));
  }
  return s;
}

/// Takes lines away that lie above a frequency, rad/s; their names.
std::string take_above(std::vector<plot::CampbellLine>& lines, double most) {
  std::string names;
  std::erase_if(lines, [&](const plot::CampbellLine& l) {
    if (l.frequency.front() <= most) return false;
    names += (names.empty() ? "" : ", ") + l.label;
    return true;
  });
  return names;
}

void TorsionalReport::add_interference() {
  if (modes_.empty()) return;
  const double top = 1.25 * law_.operating[1];
  std::vector<plot::CampbellLine> lines;
  std::vector<plot::CriticalMark> marks;
  std::vector<double> orders;
  for (const Excitation& e : excitations_)
    if (e.follows() && e.frequency == 0) orders.push_back(e.order);
  io::Table t;
  t.title = "Interferences";
  t.columns = {{"excitation", "-", ""},
               {"mode", "-", ""},
               {"speed", "rpm", "of the reference"},
               {"frequency", "Hz", ""},
               {"operating", "-", "within the operating speeds"}};
  for (std::size_t k = 0; k < modes_.size(); ++k) {
    const double f = modes_[k].frequency;
    plot::CampbellLine l;
    l.label = fmt::format("T{}", k + 1);
    l.speed = {0, top};
    l.frequency = {f, f};
    l.log_decrement = {results::tidy(modes_[k].log_decrement),
                       results::tidy(modes_[k].log_decrement)};
    lines.push_back(std::move(l));
    for (const Excitation& e : excitations_) {
      if (!e.follows()) continue;
      for (const double Omega : e.speeds(f)) {
        if (Omega > top) continue;
        marks.push_back({Omega, f, e.order, {}});
        const bool within = Omega >= law_.operating[0] && Omega <= law_.operating[1];
        t.add({e.name, static_cast<int>(k + 1), to_rpm(Omega), to_hz(f), within ? "yes" : "no"});
      }
    }
  }
  // modes far above all excitations would squeeze the lines they meet
  double highest = modes_.front().frequency;
  for (const Excitation& e : excitations_)
    highest = std::max(highest, e.over({0.0, top})[1]);
  constexpr double room = 1.25;
  const std::string above = take_above(lines, room * highest);
  plot::Figure f = plot::plot_campbell(s_.file("interference"), "Torsional interference diagram",
                                       lines, orders, marks, highest);
  if (!above.empty()) f.caption += "Above the axis, and met by no excitation: " + above + ".";
  plot::Axes& a = f.axes.front();
  a.y.min = 0;
  a.y.max = room * to_hz(highest);
  for (const double Omega : law_.operating)
    a.rules.push_back({true,
                       to_rpm(Omega),
                       Omega == law_.operating[0] ? "lowest" : "highest",
                       {plot::ink, plot::Dash::dash_dot, 0.8}});
  for (const Excitation& e : excitations_) {
    if (!e.follows())
      a.rules.push_back({false, to_hz(e.frequency), e.name, {plot::ink, plot::Dash::dotted, 1.2}});
    else if (e.frequency != 0)
      a.series.push_back(line_of(e, top));
  }
  s_.add_figure(std::move(f));
  s_.add_table("interferences", std::move(t));
}

std::vector<TorsionalReport::Component> TorsionalReport::components_of(
    const model::ApiTorque& torque) const {
  const double ratio = ratio_of(torque.at.shaft);
  if (torque.harmonics.empty())
    return {
        {{torque.name, torque.order * ratio, torque.frequency}, torque.amplitude, torque.order}};
  std::vector<Component> out;
  for (const model::ApiHarmonic& h : torque.harmonics)
    out.push_back({{torque.name, h.order * ratio, 0}, std::polar(h.amplitude, h.phase), h.order});
  return out;
}

/// Operating speeds, those at which a component meets a mode among them.
std::vector<double> TorsionalReport::speeds_of(const std::vector<Component>& components) const {
  const auto [low, high] = law_.operating;
  std::vector<double> out;
  constexpr int points = 100;
  for (int k = 0; k <= points; ++k)
    out.push_back(low + (high - low) * k / points);
  for (const Component& c : components)
    for (const analysis::WhirlMode& m : met_) {
      if (!c.excitation.follows()) break;
      // the peak of a damped mode lies within its width
      for (const double x : {-1.0, -0.5, 0.0, 0.5, 1.0})
        for (const double Omega :
             c.excitation.speeds(std::abs(m.lambda) * (1.0 + x * m.damping_ratio)))
          if (Omega > low && Omega < high) out.push_back(Omega);
    }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

void TorsionalReport::find_modes_met() {
  double highest = 0;
  for (const model::ApiTorque& t : law_.torques)
    for (const Component& c : components_of(t))
      highest = std::max(highest, c.excitation.at(law_.operating[1]));
  met_ = modes_;
  if (highest <= (modes_.empty() ? 0.0 : modes_.back().frequency)) return;
  analysis::ModesOptions o;
  o.count = 0;
  o.max_frequency = 1.05 * highest;
  o.motion = analysis::Motion::torsional;
  analysis::SpectrumCertificate certificate;
  met_ = analysis::whirl_modes(s_.linear, law_.operating[1], o, &certificate);
  if (!certificate.complete()) s_.certify(certificate, "of the modes that torques meet");
}

/// Of every element of the shafts: the coupling of neighbours is its GJ/l.
std::vector<Complex> TorsionalReport::element_torques(const VecXc& a, const la::MCK& m) const {
  std::vector<Complex> out;
  for (const meshes::Element& e : s_.job.mesh.elements) {
    const Index slot = m.K.pattern().slot(e.left.node, e.right.node);
    const double stiffness = slot < 0 ? 0.0 : std::abs(m.K.block(slot)(3, 3));
    out.push_back(stiffness * (a[6 * e.right.node + 3] - a[6 * e.left.node + 3]));
  }
  return out;
}

std::vector<Complex> TorsionalReport::coupling_torques(const VecXc& a, double w) const {
  std::vector<Complex> out;
  for (std::size_t i = 0; i < s_.job.model.bearings.size(); ++i) {
    const auto* c = std::get_if<model::Coupling>(&s_.job.model.bearings[i].law);
    const meshes::BearingNodes& n = s_.job.mesh.bearings[i];
    out.push_back(c && n.other.node >= 0 ? Complex(c->K(3, 3), w * c->C(3, 3)) *
                                               (a[6 * n.shaft.node + 3] - a[6 * n.other.node + 3])
                                         : Complex(0.0));
  }
  return out;
}

/// elements, couplings: torques, one list a component.
void TorsionalReport::look(const std::vector<std::vector<Complex>>& elements,
                           const std::vector<std::vector<Complex>>& couplings,
                           const std::vector<Component>& components, double Omega,
                           Worst& worst) const {
  std::vector<double> orders;
  orders.reserve(components.size());
  for (const Component& c : components)
    orders.push_back(c.per_turn);
  std::vector<Complex> parts(components.size());
  const auto amplitude = [&](const std::vector<std::vector<Complex>>& lists, std::size_t i) {
    for (std::size_t k = 0; k < lists.size(); ++k)
      parts[k] = lists[k][i];
    return 0.5 * calc_swing(parts, orders);
  };
  // nothing damps a resonance that magnifies so much but rounding
  constexpr double limitless = 1e7;
  double largest = 0;
  for (const Component& c : components)
    largest = std::max(largest, std::abs(c.amplitude));
  for (std::size_t i = 0; i < s_.job.mesh.elements.size(); ++i) {
    const double torque = amplitude(elements, i);
    if (!(torque < limitless * largest)) {
      worst.unbounded = true;
      continue;
    }
    const elements::ElementSection section =
        assembly::element_section(s_.job.model, s_.job.mesh.elements[i]);
    if (!has_diameters(section)) continue;
    worst.known = true;
    for (const auto& [od, id] :
         {std::pair{section.od1, section.id1}, std::pair{section.od2, section.id2}}) {
      const double stress = law_.concentration * torque * 0.5 * od / elements::annulus_J(od, id);
      if (!(stress > worst.stress)) continue;
      worst.stress = stress;
      worst.torque = torque;
      worst.speed = Omega;
      worst.frequency = components.front().excitation.at(Omega);
      worst.element = static_cast<Index>(i);
    }
  }
  for (std::size_t i = 0; i < s_.job.model.bearings.size(); ++i) {
    const double torque = amplitude(couplings, i);
    if (!(torque > worst.coupling)) continue;
    worst.coupling = torque;
    worst.coupling_speed = Omega;
    worst.coupling_name = s_.job.model.bearings[i].name;
  }
}

Worst TorsionalReport::respond(const model::ApiTorque& torque) {
  Worst worst;
  const std::vector<Component> components = components_of(torque);
  const analysis::Point at = results::point_of(s_.job, torque.at);
  analysis::HarmonicSolver solver(s_.linear, analysis::Motion::torsional);
  const double slow = modes_.empty() ? 0.0 : 1e-6 * modes_.front().frequency;
  for (const double Omega : speeds_of(components)) {
    const la::MCK& m = s_.linear.at(Omega);
    std::vector<std::vector<Complex>> elements, couplings;
    bool known = true;
    for (const Component& c : components) {
      const double w = c.excitation.at(Omega);
      VecXc a = VecXc::Zero(s_.linear.system().size());
      if (!(w > slow)) {  // beside the slip frequency zero: a steady torque, which accelerates
        known = false;
        break;
      }
      if (!solver.prepare(Omega, w)) {
        worst.unbounded = true;
        known = false;
        break;
      }
      a[6 * at.node + 3] = c.amplitude;
      solver.solve(a);
      elements.push_back(element_torques(a, m));
      couplings.push_back(coupling_torques(a, w));
    }
    if (known) look(elements, couplings, components, Omega, worst);
  }
  return worst;
}

void TorsionalReport::add_stresses() {
  if (law_.torques.empty()) return;
  find_modes_met();
  io::Table t;
  t.title = "Response to the torques, largest over the operating speeds";
  t.columns = {{"torque", "-", ""},
               {"amplitude", "N m", "0 to peak, of the largest harmonic"},
               {"speed", "rpm", "of the reference, at the largest stress"},
               {"frequency", "Hz", "of the first harmonic"},
               {"shaft", "-", ""},
               {"from", "m", "the element with the largest stress"},
               {"to", "m", ""},
               {"torque in the shaft", "N m", "0 to peak"},
               {"shear stress", "MPa", "0 to peak, with the concentration"},
               {"coupling", "-", "with the largest torque"},
               {"torque in the coupling", "N m", "0 to peak"},
               {"speed of that torque", "rpm", "of the reference"}};
  t.nan_means = "a resonance without damping, or no section has diameters, or there is no coupling";
  for (const model::ApiTorque& torque : law_.torques) {
    const Worst w = respond(torque);
    std::string shaft;
    double from = nan, to = nan, speed = nan, frequency = nan;
    if (w.element >= 0) {
      const meshes::Element& e = s_.job.mesh.elements[static_cast<std::size_t>(w.element)];
      shaft = s_.job.mesh.lines[static_cast<std::size_t>(e.line)].name;
      from = e.s1;
      to = e.s2;
      speed = w.speed;
      frequency = w.frequency;
    }
    double amplitude = torque.amplitude;
    for (const model::ApiHarmonic& h : torque.harmonics)
      amplitude = std::max(amplitude, h.amplitude);
    const double stress = w.known && !w.unbounded ? 1e-6 * w.stress : nan;
    const bool coupled = !w.unbounded && !w.coupling_name.empty();
    t.add({torque.name, amplitude, to_rpm(speed), to_hz(frequency), shaft, from, to,
           std::isnan(stress) ? nan : w.torque, stress, w.coupling_name, coupled ? w.coupling : nan,
           coupled ? to_rpm(w.coupling_speed) : nan});
    const bool judged = law_.stress_limit > 0 && !std::isnan(stress);
    Check c = judged ? results::compare("torsional stress", stress, "MPa", Check::Rule::at_most,
                                        1e-6 * law_.stress_limit)
                     : results::compare("torsional stress", stress, "MPa", Check::Rule::none, nan);
    c.where = w.element >= 0 ? fmt::format("{}, {}, {:.5g} rpm", torque.name, shaft, to_rpm(speed))
                             : torque.name;
    c.source = law_.stress_limit > 0 ? source("stress_limit") : "";
    c.remark = without_stresses();
    c.figure = s_.file("interference");
    if (w.unbounded) {
      c.judged = true;
      c.passed = false;
      c.remark = "a resonance without damping lies within the operating speeds";
    }
    checks_.add(std::move(c));
  }
  s_.add_table("stresses", std::move(t));
}

const model::ShaftTorques& strengths_of(const model::Model& m, const std::string& step) {
  const auto of = std::find_if(m.steps.begin(), m.steps.end(),
                               [&](const model::Step& s) { return s.name == step; });
  WHIRL_EXPECTS(of != m.steps.end());
  return *std::get<model::TransientStep>(of->law).torques;
}

bool TorsionalReport::stress_is_known() const {
  const auto& all = s_.job.mesh.elements;
  return std::any_of(all.begin(), all.end(), [this](const meshes::Element& e) {
    return has_diameters(assembly::element_section(s_.job.model, e));
  });
}

std::string TorsionalReport::without_stresses() const {
  std::string out;
  for (const meshes::Element& e : s_.job.mesh.elements) {
    const std::string& line = s_.job.mesh.lines[static_cast<std::size_t>(e.line)].name;
    if (has_diameters(assembly::element_section(s_.job.model, e)) || out.ends_with(line)) continue;
    out += (out.empty() ? "no stress is known where a section has no diameters: " : ", ") + line;
  }
  return out;
}

/// Adds what an event does to the damages; false: no fatigue was asked for.
bool TorsionalReport::add_event(const model::ApiEvent& e, io::Table& t, std::vector<double>& sum) {
  const run::ShaftDamage& d = s_.job.shaft_damage.at(e.step);
  const auto most = static_cast<std::size_t>(std::max_element(d.stress.begin(), d.stress.end()) -
                                             d.stress.begin());
  for (std::size_t k = 0; k < d.damage.size(); ++k)
    sum[k] += e.times * d.damage[k];
  const std::string place = results::element_name(s_.job.mesh, most);
  const bool counts = !d.damage.empty();
  t.add({e.name, e.step, e.times, stress_is_known() ? 1e-6 * d.stress[most] : nan, place,
         counts && stress_is_known() ? *std::max_element(d.damage.begin(), d.damage.end()) : nan});
  const double yield = strengths_of(s_.job.model, e.step).yield;
  const bool judged = yield > 0 && stress_is_known();
  Check c = results::compare("transient stress", stress_is_known() ? 1e-6 * d.stress[most] : nan,
                             "MPa", judged ? Check::Rule::at_most : Check::Rule::none,
                             judged ? 1e-6 * yield : nan);
  c.where = fmt::format("{}, {}", e.name, place);
  c.source = yield > 0 ? "yield stress of the deck" : "";
  c.remark = without_stresses();
  c.figure = e.step + "_shear_stress";
  checks_.add(std::move(c));
  return counts;
}

/// Transients that earlier steps ran: largest stresses, and the sum of the damages.
void TorsionalReport::add_events() {
  const std::size_t elements = s_.job.mesh.elements.size();
  if (law_.events.empty() || elements == 0) return;
  io::Table t;
  t.title = "Transients";
  t.columns = {{"event", "-", ""},
               {"step", "-", ""},
               {"times", "-", "in the life of the train"},
               {"shear stress", "MPa", "largest"},
               {"shaft", "-", "with the largest stress"},
               {"damage", "-", "share of the life of one of them, largest"}};
  t.nan_means = "no fatigue is asked for in that step, or no section has diameters";
  std::vector<double> sum(elements, 0.0);
  std::string uncounted;
  std::size_t counted = 0;
  for (const model::ApiEvent& e : law_.events) {
    if (add_event(e, t, sum))
      ++counted;
    else
      uncounted += (uncounted.empty() ? "without " : ", ") + e.name;
  }
  s_.add_table("events", std::move(t));
  if (counted == 0) return;
  const auto worst =
      static_cast<std::size_t>(std::max_element(sum.begin(), sum.end()) - sum.begin());
  Check c = stress_is_known()
                ? results::compare("fatigue damage", sum[worst], "-", Check::Rule::at_most,
                                   law_.damage_limit)
                : results::compare("fatigue damage", nan, "-", Check::Rule::none, nan);
  c.where = results::element_name(s_.job.mesh, worst);
  const bool given =
      std::find(law_.given.begin(), law_.given.end(), "damage_limit") != law_.given.end();
  c.source = given ? source("damage_limit") : "Palmgren, Miner";
  c.remark = stress_is_known() ? uncounted : without_stresses();
  c.figure = law_.events.front().step + "_shear_stress";
  checks_.add(std::move(c));
}

void TorsionalReport::execute() {
  const run::PhaseTimer timer(s_.job, "torsional report");
  add_train();
  list_excitations();
  find_modes();
  add_interference();
  add_margins();
  judge_growth();
  add_stresses();
  add_events();
  io::Value& v = s_.summary();
  v["standard"] = law_.standard;
  for (const analysis::WhirlMode& m : modes_)
    v["frequencies [Hz]"].push(to_hz(m.frequency));
  v["checks"] = checks_.checks().size();
  v["failed"] = checks_.failed();
  v["compliance"] = checks_.value();
  io::Table t = checks_.table("Compliance");
  s_.add_table("compliance", std::move(t));
  // the table of what complies is what a reader looks for
  std::rotate(s_.section.tables.rbegin(), s_.section.tables.rbegin() + 1, s_.section.tables.rend());
  s_.section.text =
      fmt::format("{} of {} checks failed. Operating from {:.6g} to {:.6g} rpm.", checks_.failed(),
                  checks_.checks().size(), to_rpm(law_.operating[0]), to_rpm(law_.operating[1]));
  run::Job& job = s_.job;
  s_.finish(fmt::format("{}: {} of {} checks failed", law_.standard, checks_.failed(),
                        checks_.checks().size()));
  if (!job.options.quiet && !job.options.json) print(checks_.text());
}

}  // namespace

void run_api_torsional_step(run::Job& job, const model::Step& step,
                            const model::ApiTorsionalStep& law) {
  TorsionalReport(job, step, law).execute();
}

}  // namespace whirl::steps
