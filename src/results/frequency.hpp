// What the steps in the frequency domain share: the linearisation a step works on, its tables,
// figures and pictures.
#pragma once
#include <analysis/spectra/passing_growth.hpp>
#include <analysis/spectra/campbell.hpp>
#include <analysis/response/harmonic.hpp>
#include <analysis/spectra/stability.hpp>
#include <analysis/spectra/whirl_modes.hpp>
#include <results/channels.hpp>
#include <plot/plots.hpp>

#include <cmath>
#include <span>

namespace whirl::results {

/// Spin of every line relative to the reference speed, as the deck's speed_ratio says; casings
/// stand.
analysis::SteadyRotation steady_rotation_of(const run::Job& job, double top_speed);
std::vector<double> speeds_of(const model::SpeedRange& range);
std::vector<double> frequencies_of(const model::FrequencyRange& range);
analysis::Motion motion_of(model::MotionKind kind);
plot::Whirl whirl_of(analysis::Direction d);
/// What no eigenvalue is known to (an undamped mode), as zero: ratios and shares of 1 (or 100 %).
inline double tidy(double x) { return std::abs(x) < 1e-9 ? 0.0 : x; }
/// "lateral, forward", "torsional"
std::string description(const analysis::WhirlMode& m);
/// "lateral 1", "torsional 1", .. of a list: numbers within each kind.
std::vector<std::string> labels_of(std::span<const analysis::WhirlMode> modes);
/// "forward", or "" where there is no lateral orbit
std::string direction_text(const analysis::WhirlMode& m);
/// "No growing motion at any frequency" or up to which one that is known, where none was found.
std::string stability_text(const analysis::SpectrumCertificate& c);
/// With a capital letter.
std::string capital(std::string text);
/// "the equilibrium at 3000 rpm"
std::string equilibrium_at(double Omega);
/// Motions that do not oscillate: overdamped, free and diverging ones, by their rates.
io::Table real_root_table(const std::vector<analysis::WhirlMode>& modes);
/// Forces of the supports on the shaft, N, fixed axes.
std::vector<analysis::Measurement> support_measurements(const run::Job& job);

/// One step on its way: where it stands, and what it has to show.
class FrequencyStep {
 public:
  /// top_speed: highest |speed| expected, rad/s.
  /// title: of its section, "Campbell diagram".
  FrequencyStep(run::Job& job, const model::Step& step, const std::string& type,
                const std::string& title, double top_speed, int load_steps = 1);
  run::Job& job;
  const model::Step& step;
  analysis::Linearizer linear;
  io::ReportSection section;

  io::Value& summary() { return job.summary["steps"][step.name]; }
  /// Writes `<step>_<name>.csv` and shows the table in the report, its title with about() (only as
  /// a file when `shown` is false).
  void add_table(const std::string& name, io::Table table, bool shown = true);
  void add_figure(plot::Figure f);
  /// "about the static equilibrium at 3000 rpm": the state that everything here is linearised
  /// about.
  const std::string& about() const { return about_; }
  /// The same linearisation of another system of this deck, with the lines of this one.
  analysis::Linearizer linearizer_of(const system::System& other) const;
  /// Every line turns at the reference speed, or stands.
  bool turns_as_one() { return linear.running().orders().size() <= 1; }
  /// What the step asks for; all where it has no such key.
  analysis::Motion motion() const;
  /// A name for files: `<step>_<name>`.
  std::string file(const std::string& name) const;
  /// Puts what is known of a list of modes into the summary and the section; what is missing also
  /// into the terminal and the exit code. where: "at 3000 rpm", or empty.
  void certify(const analysis::SpectrumCertificate& certificate, const std::string& where = {});
  /// Says something that the step takes for granted: in summary, section and terminal.
  void assume(const std::string& said);
  /// What the headers of all tables from here on say of their numbers ("frequencies right to
  /// 2e-4"); also in the section's text.
  void claim(std::string text) { claim_ = std::move(text); }
  void claim_also(const std::string& text) { claim_ += (claim_.empty() ? "" : ", ") + text; }
  /// What else the line on the terminal says, after what the step found.
  void say_also(const std::string& text) { also_ += ", " + text; }
  /// Adds the section to the report, the run time to the summary, and a line to the terminal; each
  /// says about() and what the motion asked for leaves out.
  void finish(const std::string& line);

 private:
  /// Of the equilibrium that the step ended with.
  void say_unloaded_pads(const system::State& still);
  /// Gears with play that stands open there: the steps without time see two rotors.
  void say_open_gears();
  /// W14, where the step takes the mean of a stiffness that turns.
  void warn_of_mean_stiffness();
  /// Gears of varying stiffness enter with its mean, and nothing looks at what the change does.
  void say_passing_teeth();
  std::string type_, about_, claim_, also_;
  double top_speed_;
  int load_steps_;
  Stopwatch watch_;
};

/// A shape (amplitudes of all unknowns) as drawings; see shapes.cpp.
struct ShapeDrawing {
  std::string name, title, caption;  ///< name: within the step's files
  const VecXc* a = nullptr;
  analysis::ModeKind kind = analysis::ModeKind::lateral;
  bool in_metres = false;  ///< an operating shape; modes have no size
};
/// Adds the figure of a shape: lateral ones in space and in two planes, all lines where they stand
/// and on one scale; twist and axial motion against position.
void add_shape_figures(FrequencyStep& s, const ShapeDrawing& d);
/// Frames of one period where [[output.vtk]] asks for this step. amplitude: factor on the shape; 0
/// = such that the largest displacement is a twentieth of the rotor's length (times
/// deformation_scale in any case).
void write_shape_frames(FrequencyStep& s, const std::string& name, const VecXc& a,
                        double amplitude = 0);

/// A shaft that turns is cracked.
bool breathes(const model::Model& m);
/// A rotating shaft or a coupling of such has unequal principal stiffnesses, or there is a crack:
/// matrices in fixed axes are means over the revolution, and stability is another matter.
bool turns_with_stiffness(const model::Model& m);
/// A disk that spins has unequal transverse moments of inertia: the same of its mass matrix.
bool turns_with_inertia(const model::Model& m);
/// Stability of such a rotor is judged in axes that turn with it: always where its stiffness is
/// unequal, and where its inertia is and all shafts turn at one speed.
bool is_judged_in_turning_axes(const model::Model& m);
/// Bearings whose stiffness changes as their parts pass, of which linear analyses take the mean; those that
/// pass at one rate together.
std::vector<analysis::PassingParts> passing_parts(const run::Job& job);
/// "bearing 'DE', gear pair 'mesh'"
std::string names_of(const std::vector<analysis::PassingParts>& parts);
/// "stiffness" or "inertia".
const char* what_turns(const model::Model& m);

}  // namespace whirl::results
