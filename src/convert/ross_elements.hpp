// The elements of a ROSS file, read: plain numbers in SI units, ROSS's axes (z along, x and y
// across).
#pragma once
#include <array>
#include <convert/notes.hpp>
#include <deck/text/document.hpp>
#include <string>
#include <vector>

namespace whirl::convert {

struct RossMaterial {
  std::string name;
  double rho = 0, E = 0, G = 0;
  bool operator==(const RossMaterial& o) const { return rho == o.rho && E == o.E && G == o.G; }
};

/// A layer of the shaft between node n and n + 1.
struct RossLayer {
  std::string entity;
  int line = 0;
  long n = 0;
  double length = 0, od_l = 0, id_l = 0, od_r = 0, id_r = 0;
  RossMaterial material;
  double alpha = 0, beta = 0;
  bool shear = true, rotary = true, hutchinson = false;
  bool cylinder() const { return od_l == od_r && id_l == id_r; }
};

struct RossDisk {
  std::string entity, name;
  long n = 0;
  double m = 0, Id = 0, Ip = 0;
};

/// Stiffness, damping and mass of a bearing or seal, one value for each speed.
struct RossBearing {
  std::string entity, name;
  long n = 0, n_link = -1;
  std::vector<double> speed;  ///< rad/s; empty: constant
  /// [k, c, m][xx, xy, yx, yy, zz][speed]
  std::array<std::array<std::vector<double>, 5>, 3> entry;
};

struct RossRotor {
  std::string version;
  double rated = 0, least = 0, most = 0;  ///< speeds of the parameters, rad/s; 0: not given
  std::vector<RossLayer> layers;
  std::vector<RossDisk> disks;
  std::vector<RossDisk> masses;  ///< point masses: on a shaft or on the far side of a bearing
  std::vector<RossBearing> bearings;
};

/// @throws Error (E42) for an element whose numbers cannot be read.
RossRotor read_ross(const deck::Value& file, Notes& notes);

}  // namespace whirl::convert
