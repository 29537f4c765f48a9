// Frames of the moving rotor. The writer draws a Scene (plain data) at node states; the VTK writer
// is a plug-in that is loaded by make_vtk_frames() and by nothing else, that of HDF5 where all frames
// shall stand in one file.
#pragma once
#include <core/archive.hpp>
#include <core/compression.hpp>
#include <core/types.hpp>
#include <meshes/surface.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace whirl::io {

using meshes::Pose;
using meshes::Scene;

/// State of all nodes at one time. Only `nodes` is needed; what is empty is not written.
struct FrameState {
  double time = 0.0;            ///< s (phase in rad for mode shapes)
  std::span<const Pose> nodes;  ///< one a node of the scene
  std::span<const Mat3>
      charts;  ///< triad of each line that (d, phi) refer to, after a change of chart
  std::span<const Vec3> velocity;          ///< m/s
  std::span<const Vec3> angular_velocity;  ///< rad/s
  /// At the nodes or, for a scene that knows its elements, twice as many values as those: at the left
  /// and the right end of each. Of the part to the right on the part to the left.
  std::span<const Vec3> force;          ///< N
  std::span<const Vec3> moment;         ///< N m
  std::span<const double> stress;       ///< Pa, equivalent (von Mises)
  std::span<const Vec3> support_force;  ///< N on the shaft, one a support of the scene
  std::span<const Vec3> joint_force;    ///< N on the line at `at`, one a joint of the scene
  std::span<const Vec3> support_moment,
      joint_moment;  ///< N m, about their places, in the same way; empty where none gives any
};

class FrameWriter {
 public:
  virtual ~FrameWriter() = default;
  virtual void begin(const Scene& scene) = 0;
  /// @throws std::logic_error without one pose a node; Error (Exit::io) when a file cannot be
  /// written.
  virtual void frame(const FrameState& state) = 0;
  /// The files are complete after every frame; end() only closes.
  virtual void end() = 0;
  virtual std::uint64_t frames() const = 0;
  /// What a checkpoint must know; resume() instead of begin() continues the files from there: later
  /// frames are dropped.
  virtual void save(OutArchive& out) const = 0;
  virtual void resume(const Scene& scene, InArchive& in) = 0;
};

struct VtkFrameOptions {
  std::filesystem::path
      directory;                ///< gets `<name>_line.pvd` ... and a folder of frames for each set
  std::string name = "frames";  ///< characters that do not belong in file names become '_'
  bool line = true, surface = true, bearings = false, orbits = false;
  double deformation_scale = 1.0;  ///< magnifies displacement and tilt, not the spin
  int points_around = 32;
  bool one_file = false;  ///< all frames of a set in `<name>_<set>.vtkhdf`, by the HDF5 plug-in
  Compression compression = Compression::lz4;  ///< in one file none, else zlib
  std::uint64_t max_frames =
      5000;  ///< beyond it every other frame is removed and the stride doubles
  std::size_t trail_points = 2000;  ///< longest orbit trail, frames
  double keep_until = -infinity;  ///< continued run: frames of the earlier run up to this time stay
};

/// Sets from deck names: "line", "surface", "bearings", "orbits".
/// @throws Error (E93) for any other.
void set_content(VtkFrameOptions& options, std::span<const std::string> names);

/// Loads the VTK plug-in (one file: that of HDF5).
/// @throws Error (Exit::io) when it was not built or cannot be loaded.
std::unique_ptr<FrameWriter> make_vtk_frames(VtkFrameOptions options);

/// When frames are due. Either by time or by revolutions of a reference angle; window and cap as in
/// the deck.
class FrameSchedule {
 public:
  struct Options {
    double t0 = 0.0, t1 = infinity;      ///< window, s
    double every = 0.0;                  ///< s between frames
    double frames_per_revolution = 0.0;  ///< used when every == 0
    int frames = 200;                    ///< over the window, when neither is given
    int max_frames = 5000;
  };
  /// t_end: end of the run, to bound an open window. When the number of frames is known beforehand
  /// and above max_frames, the interval is stretched: stretch() tells by how much.
  /// @pre t_begin <= t_end, max_frames > 0.
  FrameSchedule(const Options& options, double t_begin, double t_end);

  bool by_revolution() const { return step_angle_ > 0.0; }
  /// By time: the next frame time, infinity when done.
  double next_time() const { return by_revolution() ? infinity : next_time_; }
  /// By revolution: the next angle above `phi` at which a frame is due; frames stand on multiples
  /// of 2 pi / n.
  /// @pre by_revolution().
  double next_angle(double phi, double direction = 1.0) const;
  bool in_window(double t) const { return t >= t0_ && t <= t1_; }
  /// Call once the frame at next_time() is written.
  void advance();
  std::uint64_t taken() const { return taken_; }
  /// Of a continued run: so many frames are behind us.
  void set_taken(std::uint64_t n);
  double stretch() const { return stretch_; }
  /// Number of frames by time over the whole window; 0 when by revolution.
  std::uint64_t planned() const { return planned_; }

 private:
  double t0_, t1_, step_ = 0.0, step_angle_ = 0.0, next_time_ = infinity, stretch_ = 1.0;
  std::uint64_t planned_ = 0, taken_ = 0;
};

/// One phase of a mode or of a steady harmonic motion about `rest`: r = r_rest + A Re(u exp(i
/// theta)), d = normalised(d_rest + A Re(t exp(i theta))), phi = phi_rest + A Re(phi exp(i theta)).
struct HarmonicShape {
  std::vector<Eigen::Vector3cd> u;     ///< m
  std::vector<Eigen::Vector3cd> tilt;  ///< director change d - e
  std::vector<Complex> phi;            ///< rad; may be empty
};
/// @pre one u and one tilt a node; phi the same or empty.
void pose_of_phase(std::span<const Pose> rest, const HarmonicShape& shape, double amplitude,
                   double theta, std::vector<Pose>& out);
/// Writes `phases` frames of one period.
/// @pre phases > 0.
/// @throws std::invalid_argument without one u and one tilt a node; Error (Exit::io) as the writer.
void write_harmonic(FrameWriter& writer, const Scene& scene, const HarmonicShape& shape,
                    double amplitude, int phases = 24);

}  // namespace whirl::io
