#include <meshes/surface.hpp>
#include <core/contract.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace whirl::meshes {
namespace {

constexpr int rings_per_piece =
    4;  // a flexible piece is a cubic: four straight facets a piece look smooth

Vec3 unit(const Vec3& v) {
  const double n = std::sqrt(v.squaredNorm());
  return n > 0.0 ? Vec3(v / n) : v;
}

double distance(const Vec3& a, const Vec3& b) { return std::sqrt((a - b).squaredNorm()); }

}  // namespace

Pose magnified(const Pose& p, const Vec3& r0, const Vec3& e, double s) {
  if (s == 1.0) return p;
  Pose q = p;
  q.r = r0 + s * (p.r - r0);
  q.d = unit(e + s * (p.d - e));
  return q;
}

Pose pose_at(std::span<const Pose> nodes, const Place& p) {
  WHIRL_EXPECTS(p.node >= 0 && at(p.node) < nodes.size());
  Pose q = nodes[static_cast<std::size_t>(p.node)];
  q.r += p.offset * q.d;
  return q;
}

Pose interpolate(const Pose& a, const Pose& b, double length, double xi) {
  WHIRL_EXPECTS(length >= 0.0 && xi >= 0.0 && xi <= 1.0);
  if (xi <= 0.0) return a;
  if (xi >= 1.0) return b;
  const double x2 = xi * xi, x3 = x2 * xi;
  Pose q;
  q.r = (1 - 3 * x2 + 2 * x3) * a.r + (3 * x2 - 2 * x3) * b.r +
        length * ((xi - 2 * x2 + x3) * a.d + (x3 - x2) * b.d);
  const Vec3 slope = 6 * (xi - x2) * (b.r - a.r) +
                     length * ((1 - 4 * xi + 3 * x2) * a.d + (3 * x2 - 2 * xi) * b.d);
  q.d = length > 0.0 ? unit(slope) : a.d;
  q.phi = (1 - xi) * a.phi + xi * b.phi;
  return q;
}

Mat3 section_axes(const Mat3& triad, const Vec3& d, double phi) {
  const Vec3 e = triad.col(0);
  const double c = std::cos(phi), s = std::sin(phi), k = 1.0 + e.dot(d);
  const Vec3 w2 = c * triad.col(1) + s * triad.col(2), w3 = c * triad.col(2) - s * triad.col(1);
  Mat3 axes;
  axes.col(0) = d;
  if (k > 1e-12) {
    axes.col(1) = w2 - (d.dot(w2) / k) * (e + d);
    axes.col(2) = w3 - (d.dot(w3) / k) * (e + d);
  } else {  // half a turn about w2
    axes.col(1) = w2;
    axes.col(2) = -w3;
  }
  return axes;
}

Spot make_spot(const Scene& scene, Index line, const Place& a, const Place& b, double xi,
               Index bend_a, Index bend_b) {
  WHIRL_EXPECTS(line >= 0 && at(line) < scene.lines.size());
  WHIRL_EXPECTS(at(a.node) < scene.nodes.size() && at(b.node) < scene.nodes.size());
  const Mat3& triad = scene.lines[static_cast<std::size_t>(line)].triad;
  Spot s;
  s.line = line;
  s.a = a;
  s.b = b;
  s.xi = xi;
  s.bent = bend_a >= 0 && bend_b >= 0;
  if (s.bent) {
    s.bend_a = scene.bends[static_cast<std::size_t>(bend_a)];
    s.bend_b = scene.bends[static_cast<std::size_t>(bend_b)];
  }
  const Vec3 ta = triad * s.bend_a.col(0), tb = triad * s.bend_b.col(0);
  const Vec3 ra = scene.nodes[static_cast<std::size_t>(a.node)] + a.offset * ta;
  const Vec3 rb = scene.nodes[static_cast<std::size_t>(b.node)] + b.offset * tb;
  s.length = distance(ra, rb) * (1.0 + (tb - ta).squaredNorm() / 24.0);  // arc over its chord
  s.reference = s.bent ? interpolate({ra, ta, 0.0}, {rb, tb, 0.0}, s.length, xi).r
                       : Vec3((1 - xi) * ra + xi * rb);
  return s;
}

Frame frame_of(std::span<const Pose> nodes, const Mat3& triad, const Spot& s) {
  if (!s.bent) {
    Pose p = pose_at(nodes, s.a);
    if (s.xi > 0.0) p = interpolate(p, pose_at(nodes, s.b), s.length, s.xi);
    return {p.r, section_axes(triad, p.d, p.phi), p.phi};
  }
  Pose a = nodes[static_cast<std::size_t>(s.a.node)], b = nodes[static_cast<std::size_t>(s.b.node)];
  Mat3 ta = section_axes(triad, a.d, a.phi) * s.bend_a;
  const Mat3 tb = section_axes(triad, b.d, b.phi) * s.bend_b;
  a.d = ta.col(0);
  b.d = tb.col(0);
  a.r += s.a.offset * a.d;
  b.r += s.b.offset * b.d;
  if (s.xi <= 0.0) return {a.r, ta, a.phi};
  const Pose p = interpolate(a, b, s.length, s.xi);
  const Vec3 y = (1 - s.xi) * ta.col(1) + s.xi * tb.col(1);
  ta.col(0) = p.d;
  ta.col(1) = unit(y - p.d.dot(y) * p.d);
  ta.col(2) = p.d.cross(ta.col(1));
  return {p.r, ta, p.phi};
}

Skin::Skin(const Scene& scene, int points_around) : around_(points_around) {
  if (points_around < 3) throw std::invalid_argument("Skin: at least 3 points around");
  for (Index k = 0; k < around_; ++k) {
    const double theta = two_pi * static_cast<double>(k) / static_cast<double>(around_);
    cos_.push_back(std::cos(theta));
    sin_.push_back(std::sin(theta));
  }
  for (std::size_t i = 0; i < scene.lines.size(); ++i) {
    triads_.push_back(scene.lines[i].triad);
    add_shaft(scene, static_cast<Index>(i), add_part(scene.lines[i].name));
    for (const auto& disk : scene.lines[i].disks)
      add_disk(scene, static_cast<Index>(i), disk, add_part(disk.name));
  }
}

int Skin::add_part(const std::string& name) {
  part_names_.push_back(name);
  return static_cast<int>(part_names_.size()) - 1;
}

std::size_t Skin::add_station(Spot s) {
  stations_.push_back(std::move(s));
  return stations_.size() - 1;
}

/// Of a rigid part, from the nearest elements of the line to its left and right.
Skin::Section Skin::section_of(const std::vector<ShaftPiece>& pieces, std::size_t k, double xi) {
  if (const Index e = pieces[k].element; e >= 0) return {2 * e, 2 * e + 1, xi};
  const auto elastic = [](const ShaftPiece& p) { return p.element >= 0; };
  const auto here = pieces.begin() + static_cast<std::ptrdiff_t>(k);
  const auto after = std::find_if(here, pieces.end(), elastic);
  const auto before = std::find_if(std::make_reverse_iterator(here), pieces.rend(), elastic);
  Section s{before == pieces.rend() ? -1 : 2 * before->element + 1,
            after == pieces.end() ? -1 : 2 * after->element, xi};
  if (s.left < 0) s.left = s.right;
  if (s.right < 0) s.right = s.left;
  return s;
}

void Skin::add_shaft(const Scene& scene, Index line, int part) {
  const auto& pieces = scene.lines[static_cast<std::size_t>(line)].pieces;
  std::size_t k = 0;
  double start = 0;  // along the line, from its first piece
  while (k < pieces.size()) {
    // One run of pieces that join end to end: outside left to right, then the bore back.
    std::vector<Vertex> outside, bore;
    do {
      const auto& p = pieces[k];
      const bool rigid = p.left.node == p.right.node;
      const int n = rigid ? 1 : rings_per_piece;
      const double length =
          rigid ? p.right.offset - p.left.offset
                : make_spot(scene, line, p.left, p.right, 0.0, p.bend_left, p.bend_right).length;
      for (int j = 0; j <= n; ++j) {
        const double xi = static_cast<double>(j) / n;
        std::size_t station;
        if (j == 0 && !outside.empty() && pieces[k - 1].bend_right == p.bend_left)
          station = outside.back().station;
        else
          station =
              add_station(make_spot(scene, line, p.left, p.right, xi, p.bend_left, p.bend_right));
        const double s = start + xi * length;
        const Section section = section_of(pieces, k, xi);
        outside.push_back(
            {station, s, p.outer_left + xi * (p.outer_right - p.outer_left), section});
        bore.push_back({station, s, p.inner_left + xi * (p.inner_right - p.inner_left), section});
      }
      start += length;
      ++k;
    } while (k < pieces.size() && pieces[k].left.node == pieces[k - 1].right.node &&
             pieces[k].left.offset == pieces[k - 1].right.offset);
    outside.insert(outside.end(), bore.rbegin(), bore.rend());
    revolve(outside, part);
  }
}

void Skin::add_disk(const Scene& scene, Index line, const DiskShape& disk, int part) {
  Place left = disk.at, right = disk.at;
  left.offset -= disk.width / 2;
  right.offset += disk.width / 2;
  const std::size_t a = add_station(make_spot(scene, line, left, left, 0.0, disk.bend, disk.bend)),
                    b = add_station(
                        make_spot(scene, line, right, right, 0.0, disk.bend, disk.bend));
  const double sa = left.offset, sb = right.offset;
  revolve({{a, sa, disk.outer}, {b, sb, disk.outer}, {b, sb, disk.inner}, {a, sa, disk.inner}},
          part);
}

void Skin::revolve(const std::vector<Vertex>& profile, int part) {
  WHIRL_EXPECTS(profile.size() > 2);
  const Index stripe_width = std::max<Index>(1, around_ / 16);
  double last_axial = 0, last_radial = 0;
  std::size_t last_vertex = profile.size();  // where the strip that may go on ends
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Vertex& a = profile[i];
    const Vertex& b = profile[(i + 1) % profile.size()];
    const double ds = b.s - a.s, dr = b.radius - a.radius, l = std::hypot(ds, dr);
    if (l < 1e-12) {  // the same corner twice
      if (last_vertex == i) last_vertex = i + 1;
      continue;
    }
    if (a.radius <= 0 && b.radius <= 0) continue;  // along the axis of a solid body
    const double n_axial = -dr / l, n_radial = ds / l;
    const bool joined = last_vertex == i &&
                        std::abs(n_axial - last_axial) + std::abs(n_radial - last_radial) < 1e-9;
    if (!joined) rings_.push_back({a.station, a.section, a.radius, n_axial, n_radial});
    const Index r0 = static_cast<Index>(rings_.size()) - 1;
    rings_.push_back({b.station, b.section, b.radius, n_axial, n_radial});
    for (Index k = 0; k < around_; ++k) {
      const Index k1 = (k + 1) % around_;
      for (const Index q :
           {r0 * around_ + k, r0 * around_ + k1, (r0 + 1) * around_ + k1, (r0 + 1) * around_ + k})
        quads_.push_back(q);
      stripe_.push_back(k < stripe_width ? 1 : 0);
      part_.push_back(part);
    }
    last_axial = n_axial;
    last_radial = n_radial;
    last_vertex = i + 1;
  }
}

void Skin::update(std::span<const Pose> nodes, std::vector<float>& points,
                  std::vector<float>& normals) const {
  WHIRL_EXPECTS(nodes.size() > 0 || stations_.empty());
  points.resize(static_cast<std::size_t>(3 * point_count()));
  normals.resize(points.size());
  float* p = points.data();
  float* n = normals.data();
  std::size_t station = stations_.size();
  Frame at;
  for (const auto& ring : rings_) {
    if (ring.station != station) {
      station = ring.station;
      at = frame_of(nodes, triads_[static_cast<std::size_t>(stations_[station].line)],
                    stations_[station]);
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(around_); ++k) {
      const Vec3 radial = cos_[k] * at.axes.col(1) + sin_[k] * at.axes.col(2);
      const Vec3 x = at.r + ring.radius * radial,
                 m = ring.n_axial * at.axes.col(0) + ring.n_radial * radial;
      for (int c = 0; c < 3; ++c) {
        *p++ = static_cast<float>(x[c]);
        *n++ = static_cast<float>(m[c]);
      }
    }
  }
}

void Skin::centre_displacement(std::span<const Pose> nodes,
                               std::vector<float>& displacement) const {
  displacement.resize(static_cast<std::size_t>(3 * point_count()));
  float* p = displacement.data();
  for (const auto& ring : rings_) {
    const auto& s = stations_[ring.station];
    const Vec3 u = frame_of(nodes, triads_[static_cast<std::size_t>(s.line)], s).r - s.reference;
    for (Index k = 0; k < around_; ++k)
      for (int c = 0; c < 3; ++c)
        *p++ = static_cast<float>(u[c]);
  }
}

void Skin::section_values(std::span<const double> at_ends, std::vector<float>& values) const {
  values.resize(static_cast<std::size_t>(point_count()));
  float* to = values.data();
  for (const Ring& ring : rings_) {
    const Section& s = ring.section;
    const double x =
        s.left < 0 ? 0.0 : (1 - s.xi) * at_ends[at(s.left)] + s.xi * at_ends[at(s.right)];
    to = std::fill_n(to, around_, static_cast<float>(x));
  }
}

}  // namespace whirl::meshes
