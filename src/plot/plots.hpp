// The field's plots: plain data in, Figure out. SI in, the units named here out. Speeds are rad/s
// in and rpm on the axis.
#pragma once
#include <plot/plot.hpp>
#include <core/types.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace whirl::plot {

inline constexpr double rpm = to_rpm(1.0);   ///< of a speed of 1 rad/s
inline constexpr double hertz = to_hz(1.0);  ///< of a frequency of 1 rad/s
inline constexpr double mm = 1e3;            ///< of a length of 1 m

enum class Amplitude { zero_to_peak, peak_to_peak };
/// "0-peak" or "peak-to-peak".
const char* to_string(Amplitude a);
constexpr Amplitude amplitude(bool peak_to_peak) {
  return peak_to_peak ? Amplitude::peak_to_peak : Amplitude::zero_to_peak;
}
/// On amplitudes 0-peak: 1 or 2.
constexpr double factor_of(Amplitude a) { return a == Amplitude::peak_to_peak ? 2.0 : 1.0; }

/// A length in the unit that suits its size (m, mm, um): factor and name.
struct DisplayUnit {
  double factor = 1.0;
  std::string name;
};
DisplayUnit length_unit(double largest);
DisplayUnit unit_for(const std::string& si,
                     double largest);  ///< any SI unit: chooses a prefix for N, J, W, N m, Pa, s

struct Curve {
  std::string label;
  std::vector<double> x, y;
};

/// Orbit of a probe in its two measuring directions, m; dots where the keyphasor fires (indices
/// into y, z).
struct Orbit {
  std::string label;
  std::vector<double> y, z;
  std::vector<std::size_t> keyphasor;
};
Figure plot_orbit(std::string name, std::string title, std::span<const Orbit> orbits,
                  double clearance = 0.0);

/// Path of a point in a plane and in space, m.
Figure plot_path(std::string name, std::string title, std::string x_label, std::string y_label,
                 std::span<const Curve> paths);
Figure plot_path_in_space(std::string name, std::string title, std::span<const double> x,
                          std::span<const double> y, std::span<const double> z);

enum class Whirl { forward, backward, mixed, none };  ///< none: torsional or axial
struct CampbellLine {
  std::string label;
  Whirl whirl = Whirl::none;
  std::vector<double> speed;          ///< rad/s
  std::vector<double> frequency;      ///< damped natural frequency, rad/s; nan = no oscillation
  std::vector<double> log_decrement;  ///< may be empty
  std::vector<Whirl> whirl_at;        ///< direction point by point, may be empty
};
struct CriticalMark {
  double speed = 0, frequency = 0, order = 1;
  std::string label;
};
Figure plot_campbell(std::string name, std::string title, std::span<const CampbellLine> lines,
                     std::span<const double> orders, std::span<const CriticalMark> criticals,
                     double reach = 0.0);
/// Log decrement against speed, with the threshold at zero; enlarged about it where heavily damped
/// modes take the scale.
Figure plot_stability(std::string name, std::string title, std::span<const CampbellLine> lines,
                      std::span<const double> thresholds = {});

/// Steady response amplitude (m, 0-peak) and phase lag (rad) against speed.
struct ResponseCurve {
  std::string label;
  std::vector<double> speed, amplitude, phase_lag;
};
Figure plot_bode(std::string name, std::string title, std::span<const ResponseCurve> curves,
                 Amplitude convention, std::span<const CriticalMark> criticals = {},
                 bool log_amplitude = false);
/// Speeds are written along the curves, at the peaks marked among others.
Figure plot_polar(std::string name, std::string title, std::span<const ResponseCurve> curves,
                  Amplitude convention, std::span<const CriticalMark> marks = {});

/// Stacked spectra against speed (or time): amplitude[i] over frequency (rad/s) at speed[i]
/// (rad/s).
struct SpectrumTrace {
  double speed = 0;
  std::vector<double> frequency, amplitude;
};
Figure plot_waterfall(std::string name, std::string title, std::span<const SpectrumTrace> traces,
                      const std::string& quantity, const std::string& unit, Amplitude convention,
                      std::span<const double> orders);
/// The same as a map of colours.
Figure plot_spectrogram(std::string name, std::string title, std::span<const SpectrumTrace> traces,
                        const std::string& quantity, const std::string& unit, Amplitude convention,
                        bool logarithmic = true);

/// Undamped critical speeds (rad/s) against support stiffness (N/m), and the supports' own
/// stiffness against speed.
Figure plot_critical_map(std::string name, std::string title, std::span<const Curve> modes,
                         std::span<const Curve> supports);

/// A mode or an operating shape: along the shaft (m), complex deflection in the two planes.
struct ModeShape {
  std::string label;
  std::vector<double> s;
  std::vector<Complex> y, z;
  std::vector<std::pair<std::string, double>> stations;  ///< bearings, disks: name and s
  bool in_metres = false;  ///< deflections of an operating shape; those of a mode have no size
};
/// What is drawn says how far it is enlarged.
Figure plot_mode_shape(std::string name, std::string title, const ModeShape& mode);

/// A shape of a machine of several lines, where they stand: one scale for all.
struct ShapeLine {
  std::string label;
  std::vector<Vec3> rest;             ///< m
  std::vector<Eigen::Vector3cd> u;    ///< complex deflection, axes of the machine
  std::vector<std::size_t> stations;  ///< points whose orbits are drawn
};
/// What joins two lines, or a line and the ground (`to` empty), and moves with them.
struct ShapeLink {
  std::string name;
  Vec3 at = Vec3::Zero(), to = Vec3::Zero();
  Eigen::Vector3cd u_at = Eigen::Vector3cd::Zero(), u_to = Eigen::Vector3cd::Zero();
  bool to_ground = true;
};
struct MachineShape {
  std::vector<ShapeLine> lines;
  std::vector<ShapeLink> links;
  bool in_metres = false;  ///< as of a ModeShape
};
Figure plot_machine_shape(std::string name, std::string title, const MachineShape& shape);

/// A motion to be played back. rest: places of its points, m (here, not yet in units of the axes).
struct ReplayedLine {
  std::string label;
  std::size_t from = 0, to = 0;  ///< its points of the replay
};
/// @pre at least one moment in which something moves.
Figure plot_replay(std::string name, std::string title, Replay motion,
                   std::span<const ReplayedLine> lines);

/// How far from the middle a line of the machine comes, and how near to the walls about it; m.
struct ReachLine {
  std::string label;
  std::vector<double> x, reach;  ///< axial position; largest distance from the middle
};
struct GapMark {
  std::string name;
  double x = 0, gap = 0;
  double reach = 0;  ///< largest displacement against the other side of the gap
};
/// Clearance diagram. @pre gaps greater than zero.
Figure plot_clearances(std::string name, std::string title, std::span<const ReachLine> lines,
                       std::span<const GapMark> gaps);

/// Error against run time, log-log; the Pareto front is drawn through the best points.
struct StudyPoint {
  double seconds = 0, error = 0;
  std::string label;
};
struct StudyCurve {
  std::string label;
  std::vector<StudyPoint> points;
};
Figure plot_study(std::string name, std::string title, std::span<const StudyCurve> curves,
                  std::string error_label, std::string error_unit, double target = 0.0);

/// Side elevation of a rotor: what `check` draws. Lengths in m.
struct DrawnSection {
  double s0 = 0, s1 = 0, outer_left = 0, outer_right = 0, inner_left = 0, inner_right = 0;
  std::string name;
};
struct DrawnDisk {
  double s = 0, outer = 0, inner = 0, width = 0;
  std::string name;
};
struct DrawnMark {
  double s = 0, radius = 0;
  std::string name;
};
/// On the centre line: what is free there shows in the mark.
struct DrawnJoint {
  double s = 0, radius = 0;
  std::string name, kind;  ///< "hinge" and so on
  Marker marker = Marker::circle;
};
struct RotorDrawing {
  std::string title;
  std::vector<DrawnSection> sections;
  std::vector<DrawnDisk> disks;
  std::vector<DrawnMark> bearings, probes;
  std::vector<DrawnJoint> joints;
  std::vector<double> nodes;  ///< mesh nodes, small ticks on the centre line
};
Figure plot_rotor(std::string name, const RotorDrawing& rotor);
/// Several lines in one elevation: where they stand along x, and how far apart across it.
struct MachineLine {
  RotorDrawing drawing;      ///< bearings: those to the ground alone
  double x = 0, height = 0;  ///< of its left end, m
};
/// What joins two of them: from one radius to another at a place along x, m.
struct MachineLink {
  std::string name;
  double x = 0, from = 0, to = 0;
};
struct MachineDrawing {
  std::string title;
  std::string across;  ///< direction in which the heights are measured: "y", "z"
  std::vector<MachineLine> lines;
  std::vector<MachineLink> links;
};
Figure plot_machine(std::string name, const MachineDrawing& machine);
/// A line that is not straight, in space; lengths in m.
struct DrawnPoint {
  Vec3 r = Vec3::Zero();
  std::string name;
};
struct LineDrawing {
  std::string title;
  std::vector<Vec3> line, nodes;
  std::vector<DrawnPoint> supports, disks, probes, joints;
};
Figure plot_line(std::string name, const LineDrawing& line);

}  // namespace whirl::plot
