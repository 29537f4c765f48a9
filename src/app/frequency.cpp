#include <app/frequency.hpp>
#include <app/held.hpp>

#include <fmt/format.h>

#include <cctype>

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
}  // namespace

std::string direction_text(const analysis::WhirlMode& m) {
  return m.direction == analysis::Direction::none ? std::string() : std::string(to_string(m.direction));
}

FrequencyStep::FrequencyStep(Job& j, const model::Step& s, const std::string& type, const std::string& title, double top_speed, int load_steps)
    : job(j), step(s), linear((j.build_for(s), j.system()), running_of(j, top_speed), equilibrium_options(j, load_steps)) {
  if (!s.from.empty()) linear.start_from(j.states.at(s.from).state);
  type_ = type;
  summary()["type"] = type;
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
  if (shown) section.tables.push_back(std::move(table));
}

void FrequencyStep::add_figure(io::Figure f) {
  if (job.model.output.report) section.figures.push_back(std::move(f));
}

void FrequencyStep::finish(const std::string& line) {
  const RunTime time = watch_.elapsed();
  put_run_time(summary(), time);
  if (turns_with_stiffness(job.model) && type_ != "stability")
    section.text += " The stiffness of the asymmetric shaft enters as its mean over a revolution; a stability step shows where its turning makes the rotor unstable.";
  ProgressLine(step.name, job.options.quiet).done(fmt::format("{}, {}", line, time.text()));
  say_held(job, step, held_in_step(job, step), section);
  if (job.model.output.report) job.report.sections.push_back(std::move(section));
}

}  // namespace whirl::app
