#include <app/frequency.hpp>

#include <fmt/format.h>

#include <cctype>
#include <map>
#include <optional>

namespace whirl::app {

analysis::Running running_of(const Job& job, double top_speed) {
  analysis::Running r;
  for (std::size_t l = 0; l < job.mesh.lines.size(); ++l)
    r.ratio.push_back(job.mesh.lines[l].rotating ? job.model.shafts[l].speed_ratio : 0.0);
  r.ratio.resize(static_cast<std::size_t>(job.system().lines()), 0.0);
  r.top_speed = top_speed;
  r.table_frequencies = job.built.table_frequencies;
  return r;
}

std::vector<double> speeds_of(const model::SpeedRange& r) {
  if (!r.values.empty()) return r.values;
  std::vector<double> out;
  for (int k = 0; k < r.points; ++k) out.push_back(r.points == 1 ? r.stop : r.start + (r.stop - r.start) * k / (r.points - 1));
  return out;
}

std::vector<double> frequencies_of(const model::FrequencyRange& r) { return speeds_of({r.start, r.stop, r.points, r.values, false}); }

analysis::Motion motion_of(model::MotionKind kind) { return static_cast<analysis::Motion>(kind); }

io::Whirl whirl_of(analysis::Direction d) {
  switch (d) {
    case analysis::Direction::forward: return io::Whirl::forward;
    case analysis::Direction::backward: return io::Whirl::backward;
    case analysis::Direction::mixed:
    case analysis::Direction::planar: return io::Whirl::mixed;
    case analysis::Direction::none: break;
  }
  return io::Whirl::none;
}

std::string description(const analysis::WhirlMode& m) {
  std::string out{to_string(m.kind)};
  if (m.direction != analysis::Direction::none) out += fmt::format(", {}", to_string(m.direction));
  return out;
}

std::vector<analysis::Measurement> support_measurements(const Job& job) {
  std::vector<analysis::Measurement> out;
  for (const assembly::SupportForce& f : job.built.support_forces) {
    analysis::Measurement m{"bearing " + f.name + " force", "N", "force of the support on the shaft, fixed axes", {"x", "y", "z"}, 1.0, {}};
    m.evaluate = [&f](const analysis::Snapshot& s, double* v) {
      system::Context mean;
      mean.time = s.t(), mean.averaged = true;
      Eigen::Map<Vec3>{v} = f.force([&s](Index n) -> const system::NodeState& { return s.node(n); }, mean,
                                    [&s](Index k) { return s.reactions()[k]; });
    };
    out.push_back(std::move(m));
  }
  return out;
}

namespace {
analysis::EquilibriumOptions equilibrium_options(const Job& job, int load_steps) {
  analysis::EquilibriumOptions o;
  o.load_steps = load_steps;
  o.chart_change = job.model.chart_change;
  return o;
}

/// The one speed of a step's equilibrium, rad/s; null where there are several.
std::optional<double> speed_of(const model::StepLaw& law) {
  if (const auto* x = std::get_if<model::ModalStep>(&law)) return x->speed;
  if (const auto* x = std::get_if<model::TorsionalStep>(&law)) return x->max_speed;
  if (const auto* x = std::get_if<model::BucklingStep>(&law)) return x->speed;
  if (const auto* x = std::get_if<model::HarmonicStep>(&law); x && x->frequency) return x->speed;
  return std::nullopt;
}

bool about_undeformed(const model::StepLaw& law) {
  return std::visit(
      [](const auto& x) {
        if constexpr (requires { x.about; }) return x.about == model::About::undeformed;
        else return false;
      },
      law);
}

std::string about_of(const model::StepLaw& law) {
  if (about_undeformed(law)) return "about the undeformed rotor";
  const std::optional<double> speed = speed_of(law);
  const std::string at = speed ? fmt::format("at {:.6g} rpm", to_rpm(*speed)) : "at each speed";
  if (std::holds_alternative<model::BucklingStep>(law)) return "about the unloaded equilibrium " + at;
  if (std::holds_alternative<model::CriticalMapStep>(law)) return "about the static equilibrium " + at + " and stiffness";
  return "about the static equilibrium " + at;
}

std::optional<model::MotionKind> motion_asked(const model::StepLaw& law) {
  if (std::holds_alternative<model::TorsionalStep>(law)) return model::MotionKind::torsional;
  return std::visit(
      [](const auto& x) -> std::optional<model::MotionKind> {
        if constexpr (requires { x.motion; }) return x.motion;
        else return std::nullopt;
      },
      law);
}

/// What a kind of motion leaves out.
std::string motion_text(model::MotionKind kind) {
  switch (kind) {
    case model::MotionKind::lateral: return "Lateral motion: axial motion and twist follow without inertia or damping.";
    case model::MotionKind::torsional: return "Torsional motion: bending and axial motion are held.";
    case model::MotionKind::axial: return "Axial motion: bending and twist are held.";
    case model::MotionKind::all: break;
  }
  return {};
}

std::string_view motion_name(model::MotionKind kind) {
  constexpr std::string_view names[] = {"all", "lateral", "torsional", "axial"};
  return names[static_cast<int>(kind)];
}
}  // namespace

std::vector<std::string> labels_of(std::span<const analysis::WhirlMode> modes) {
  std::map<analysis::ModeKind, int> count;
  std::vector<std::string> out;
  for (const analysis::WhirlMode& m : modes) out.push_back(fmt::format("{} {}", to_string(m.kind), ++count[m.kind]));
  return out;
}

std::string direction_text(const analysis::WhirlMode& m) {
  return m.direction == analysis::Direction::none ? std::string() : std::string(to_string(m.direction));
}

FrequencyStep::FrequencyStep(Job& j, const model::Step& s, const std::string& type, const std::string& title, double top_speed, int load_steps)
    : job(j), step(s), linear((j.build_for(s), j.system()), running_of(j, top_speed), equilibrium_options(j, load_steps)),
      start_(std::chrono::steady_clock::now()) {
  if (!s.from.empty()) linear.start_from(j.states.at(s.from).state);
  if (about_undeformed(s.law)) linear.stay_undeformed();
  type_ = type;
  about_ = about_of(s.law);
  summary()["type"] = type;
  summary()["linearised"] = about_;
  if (const auto motion = motion_asked(s.law)) summary()["motion"] = std::string(motion_name(*motion));
  section.title = fmt::format("{}: {}", s.name, title);
}

std::string FrequencyStep::file(const std::string& name) const {
  std::string out = step.name + "_" + name;
  for (char& c : out)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
  return out;
}

void FrequencyStep::add_table(const std::string& name, io::Table table, bool shown) {
  const std::string path = file(name) + ".csv";
  job.folder.write_table(path, table);
  section.files.emplace_back(table.title.empty() ? name : table.title, path);
  if (!shown) return;
  if (!table.title.empty()) table.title += ", " + about_;
  section.tables.push_back(std::move(table));
}

void FrequencyStep::add_figure(io::Figure f) {
  if (job.model.output.report) section.figures.push_back(std::move(f));
}

void FrequencyStep::finish(const std::string& line) {
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  summary()["run time [s]"] = seconds;
  if (const auto motion = motion_asked(step.law); motion && *motion != model::MotionKind::all) section.text += " " + motion_text(*motion);
  section.text += fmt::format(" Linearised {}.", about_);
  if (turns_with_stiffness(job.model) && type_ != "stability")
    section.text += " The stiffness of the asymmetric shaft enters as its mean over a revolution; a stability step shows where its turning makes the rotor unstable.";
  if (job.model.output.report) job.report.sections.push_back(std::move(section));
  ProgressLine(step.name, job.options.quiet).done(fmt::format("{}, {}, {:.3f} s", line, about_, seconds));
}

}  // namespace whirl::app
