// [output] and [[output.vtk]].
#include <core/units.hpp>
#include <deck/visitor.hpp>
#include <fmt/format.h>

namespace whirl::deck {

namespace {

void compression_of(Visitor& v, model::VtkOutput& o) {
  const bool given = v.choice(optional("compression", "lz4, in a .vtkhdf file zlib"), o.compression,
                              {{"none", "as they are"},
                               {"lz4", "half the size for next to no time; in .vtp files alone"},
                               {"zlib", "a third less again for six times the time"}},
                              "how the numbers are packed in the files; they are the same in all");
  if (!o.one_file) return;
  if (!given)
    o.compression = Compression::zlib;
  else if (o.compression == Compression::lz4)
    v.error("E26", "compression", "a .vtkhdf file does not know lz4", "\"zlib\" or \"none\"");
}

}  // namespace

void describe(Visitor& v, model::VtkOutput& o) {
  static constexpr Option content[] = {
      {"line", "centre line with displacement, rotation, velocity, force and moment"},
      {"surface", "the surface of shaft and disks at its deformed place"},
      {"bearings", "bearings with their forces"},
      {"orbits", "paths of the probes"},
  };
  o.where = v.where();
  v.step(optional("step", "all transient steps"), o.step, "the step it belongs to");
  std::vector<double> window;
  const bool has_window =
      v.quantities(optional("window", "the whole run"), window, "s", any, 2, "first and last time");
  const bool every =
      v.quantity(optional("every", "see frames"), o.every, "ms", positive, "time between frames");
  const bool per_rev =
      v.number(optional("frames_per_revolution", "see frames"), o.frames_per_revolution, positive,
               "frames per turn of the reference shaft");
  const bool frames =
      v.integer(every || per_rev ? optional("frames", "") : Key("frames"), o.frames,
                between(1, 1000000), "number of frames, when neither of the two is given");
  v.integer("max_frames", o.max_frames, between(1, 1000000),
            "no more frames than this are written");
  v.options("content", o.content, content, "what the files hold");
  v.number("deformation_scale", o.deformation_scale, positive,
           "exaggeration of the lateral displacement in 'surface'");
  v.integer("points_around", o.points_around, between(3, 1000),
            "points on the circumference of 'surface'");
  v.choice("format", o.one_file,
           {{"vtp", "a file each frame and a .pvd that lists them"},
            {"vtkhdf",
             "all frames of a set in one .vtkhdf file (ParaView 5.12 and later); 'per' stands for "
             "'/' in the names of its arrays"}},
           "files");
  compression_of(v, o);
  if (has_window && v.clean()) {
    if (!(window[1] > window[0])) v.error("E21", "window", "the window ends before it starts");
    o.t0 = window[0];
    o.t1 = window[1];
  }
  if (v.clean() && int(every) + int(per_rev) + int(frames) > 1)
    v.error("E26", every ? "every" : "frames_per_revolution",
            "the number of frames is given in more than one way",
            "keep one of every, frames_per_revolution and frames");
}

void describe(Visitor& v, model::Output& o) {
  static constexpr Option quantities[] = {
      {"speed", "spin of each shaft"},
      {"probes", "displacements of the probes"},
      {"positions", "positions of the probes in space"},
      {"velocity", "velocities of the probes"},
      {"acceleration", "accelerations of the probes, relative to the base"},
      {"rotation", "gamma, phi and its rate at the probes"},
      {"bearing_force", "forces of the bearings on the shaft"},
      {"bearing_moment",
       "moments and torques of the bearings that give any (tilting or torsional stiffness, "
       "friction), about their places"},
      {"torque", "torques of the drives"},
      {"shaft_torque", "torques in the shafts at the probes"},
      {"cracks", "how far the cracks are open, from 0 to 1"},
      {"joints",
       "forces and moments of the joints on the line of their 'at', their angles and "
       "slides"},
      {"control", "control currents of magnetic bearings"},
      {"rings",
       "spins and places of floating rings, eccentricities, power loss and temperatures of their "
       "films"},
      {"energy", "energies and their balance"},
  };
  static constexpr Option amplitudes[] = {{"zero_to_peak", ""}, {"peak_to_peak", ""}};
  int amplitude = o.peak_to_peak ? 1 : 0;
  v.text("directory", o.directory, "folder of the results; ${deck} is the name of the deck");
  v.quantity(optional("every", "each accepted step"), o.every, "ms", positive,
             "time between rows of the histories");
  v.options("quantities", o.quantities, quantities, "columns of the histories");
  std::vector<double> window, speeds;
  const bool has_window =
      v.quantities(optional("window", "the whole run"), window, "s", any, 2,
                   "rows of the histories only from the first to the second time");
  const bool has_speeds =
      v.quantities(optional("speed_window", "all speeds"), speeds, "rpm", any, 2,
                   "rows of the histories only while the reference spin is between these");
  v.quantity(optional("above", "always"), o.above, "mm", positive,
             "rows of the histories only while a probe is displaced by more than this");
  if (has_window && v.clean()) {
    if (!(window[1] > window[0])) v.error("E21", "window", "the window ends before it starts");
    o.t0 = window[0];
    o.t1 = window[1];
  }
  if (has_speeds && v.clean()) {
    if (!(speeds[1] > speeds[0]))
      v.error("E21", "speed_window", "the window ends before it starts");
    o.speed_low = speeds[0];
    o.speed_high = speeds[1];
  }
  v.table("tracking", o.tracking,
          "tracking filter: synchronous amplitude and phase, envelope and orbits of the probes, "
          "turn by turn");
  v.table(optional("spectra", "none"), o.spectra,
          "spectra of the probes, block by block: waterfall and full spectrum");
  v.flag("csv", o.csv, "histories as CSV");
  v.flag("binary", o.binary, "histories as HDF5");
  v.flag("report", o.report, "a report in HTML with the figures");
  v.flag("replay", o.replay,
         "transients can be played back in the report: shafts, orbits and speed from some hundred "
         "moments");
  v.option("amplitude", amplitude, amplitudes,
           "convention of amplitudes in figures; columns of tables are zero to peak");
  o.peak_to_peak = amplitude == 1;
  v.list(optional("vtk", "none"), o.vtk, "pictures for ParaView: frames of the moving rotor");
}

}  // namespace whirl::deck
