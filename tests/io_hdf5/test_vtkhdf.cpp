// Frames in one file: read back through HDF5 by the rules of the format, as VTK's reader (9.3 and later;
// vtkHDFReader::Read) finds a step: offsets, then the part, its cells and its arrays.
#include "../io/temp_folder.hpp"
#include <core/archive.hpp>
#include <core/error.hpp>
#include <core/plugin.hpp>
#include <hdf5.h>
#include <io/file.hpp>
#include <io/frame_sets.hpp>
#include <io/frames.hpp>
#include <gtest/gtest.h>
#include <array>
#include <cmath>

namespace whirl::io {
namespace {

constexpr std::array<const char*, 4> kinds{"Vertices", "Lines", "Polygons", "Strips"};

Scene rotor() {
  Scene s;
  for (int k = 0; k < 3; ++k) {
    s.nodes.emplace_back(0.5 * k, 0, 0);
    s.node_line.push_back(0);
  }
  Scene::Line line;
  line.name = "shaft";
  line.points = {{0, 0}, {1, 0}, {2, 0}};
  line.radius = {0.03, 0.03, 0.03};
  line.pieces = {{{0, 0}, {1, 0}, 0.03, 0.03, 0.01, 0.01},
                 {{1, 0}, {2, 0}, 0.03, 0.03, 0.01, 0.01}};
  line.disks = {{"disk", {1, 0}, 0.2, 0.03, 0.05}};
  s.lines = {line};
  using model::Picture;
  s.supports = {{"DE", Picture::bearing, {0, 0}, false, {}, 0.03},
                {"NDE", Picture::spring, {2, 0}, false, {}, 0.03}};
  s.trails = {{"mid", {1, 0}}, {"end", {2, 0}}};
  return s;
}

std::vector<Pose> whirling(const Scene& s, double t) {
  std::vector<Pose> p;
  for (std::size_t k = 0; k < s.nodes.size(); ++k) {
    const Vec3 w(0, std::cos(40 * t), std::sin(40 * t));
    p.push_back({s.nodes[k] + 1e-3 * static_cast<double>(k) * w, Vec3::UnitX(), 100 * t});
  }
  return p;
}

const std::vector<Vec3> velocity(3, Vec3(0, 1, 2)), force(2, Vec3(0, 0, 500));

FrameState state_of(const std::vector<Pose>& poses, double t) {
  FrameState s;
  s.time = t;
  s.nodes = poses;
  s.velocity = velocity;
  s.support_force = force;
  return s;
}

/// One file, open for reading.
class Vtkhdf {
 public:
  explicit Vtkhdf(const std::filesystem::path& file)
      : file_(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {
    EXPECT_GE(file_, 0) << file;
  }
  ~Vtkhdf() { H5Fclose(file_); }
  std::vector<hsize_t> size(const std::string& name) const {
    const hid_t d = data(name), s = H5Dget_space(d);
    std::vector<hsize_t> out(static_cast<std::size_t>(H5Sget_simple_extent_ndims(s)));
    H5Sget_simple_extent_dims(s, out.data(), nullptr);
    H5Sclose(s);
    H5Dclose(d);
    return out;
  }
  /// Rows [first, first + count).
  template <class T>
  std::vector<T> rows(const std::string& name, std::int64_t first, std::int64_t count) const {
    const hid_t d = data(name), s = H5Dget_space(d);
    const std::vector<hsize_t> all = size(name);
    hsize_t start[2] = {static_cast<hsize_t>(first), 0},
            some[2] = {static_cast<hsize_t>(count), all.size() > 1 ? all[1] : 1};
    EXPECT_LE(start[0] + some[0], all[0]) << name;
    std::vector<T> out(some[0] * some[1]);
    if (count > 0) {
      H5Sselect_hyperslab(s, H5S_SELECT_SET, start, nullptr, some, nullptr);
      const hid_t m = H5Screate_simple(static_cast<int>(all.size()), some, nullptr);
      const hid_t type = std::is_same_v<T, float>    ? H5T_NATIVE_FLOAT
                         : std::is_same_v<T, double> ? H5T_NATIVE_DOUBLE
                                                     : H5T_NATIVE_INT64;
      EXPECT_GE(H5Dread(d, type, m, s, H5P_DEFAULT, out.data()), 0) << name;
      H5Sclose(m);
    }
    H5Sclose(s);
    H5Dclose(d);
    return out;
  }
  std::int64_t one(const std::string& name, std::int64_t row) const {
    return rows<std::int64_t>(name, row, 1).front();
  }
  std::int64_t steps() const {
    const hid_t a = H5Aopen_by_name(file_, "VTKHDF/Steps", "NSteps", H5P_DEFAULT, H5P_DEFAULT);
    std::int64_t n = -1;
    H5Aread(a, H5T_NATIVE_INT64, &n);
    H5Aclose(a);
    return n;
  }
  std::string type() const {
    const hid_t a = H5Aopen_by_name(file_, "VTKHDF", "Type", H5P_DEFAULT, H5P_DEFAULT),
                t = H5Aget_type(a);
    std::string out(H5Tget_size(t), '\0');
    EXPECT_FALSE(H5Tis_variable_str(t) > 0);
    H5Aread(a, t, out.data());
    H5Tclose(t);
    H5Aclose(a);
    return out;
  }

 private:
  hid_t data(const std::string& name) const {
    const hid_t d = H5Dopen2(file_, ("VTKHDF/" + name).c_str(), H5P_DEFAULT);
    EXPECT_GE(d, 0) << name;
    return d;
  }
  hid_t file_;
};

std::string in_file(std::string name) {
  if (const auto p = name.find('/'); p != std::string::npos) name.replace(p, 1, " per ");
  return name;
}

/// Step k of the file is this data.
void expect_step(const Vtkhdf& f, std::int64_t k, const PolyData& data, const std::string& what) {
  const std::int64_t part = f.one("Steps/PartOffsets", k), points = f.one("Steps/PointOffsets", k);
  EXPECT_EQ(f.one("Steps/NumberOfParts", k), 1);
  const auto n = static_cast<std::int64_t>(data.points.size() / 3);
  EXPECT_EQ(f.one("NumberOfPoints", part), n) << what << k;
  EXPECT_EQ(f.rows<float>("Points", points, n), data.points) << what << k;
  const std::vector<std::int64_t> cells = f.rows<std::int64_t>("Steps/CellOffsets", k, 1),
                                  ids = f.rows<std::int64_t>("Steps/ConnectivityIdOffsets", k, 1);
  const PolyData::Cells none;
  const std::array<const PolyData::Cells*, 4> expected{&data.vertices, &data.lines, &data.polygons,
                                                       &none};
  std::int64_t all = 0;
  for (std::size_t j = 0; j < kinds.size(); ++j) {
    const std::string kind = kinds[j];
    const auto count = static_cast<std::int64_t>(expected[j]->size());
    EXPECT_EQ(f.one(kind + "/NumberOfCells", part), count) << what << kind << k;
    // parts before this one: each has a start more than cells
    std::int64_t parts = 0, sum = 0;
    while (parts < part && sum < cells[j])
      sum += f.one(kind + "/NumberOfCells", parts++);
    EXPECT_EQ(f.rows<std::int64_t>(kind + "/Offsets", cells[j] + parts, count + 1),
              expected[j]->offset)
        << what << kind << k;
    EXPECT_EQ(f.rows<std::int64_t>(kind + "/Connectivity", ids[j],
                                   f.one(kind + "/NumberOfConnectivityIds", part)),
              expected[j]->point)
        << what << kind << k;
    all += count;
  }
  for (const PolyData::Array& a : data.point_data) {
    const std::string name = in_file(a.name);
    EXPECT_EQ(f.rows<float>("PointData/" + name, f.one("Steps/PointDataOffsets/" + name, k), n),
              std::get<std::vector<float>>(a.values))
        << what << name << k;
  }
  for (const PolyData::Array& a : data.cell_data) {
    const std::vector<std::int64_t> found = f.rows<std::int64_t>(
        "CellData/" + a.name, f.one("Steps/CellDataOffsets/" + a.name, k), all);
    const auto& numbers = std::get<std::vector<std::int32_t>>(a.values);
    EXPECT_EQ(found, std::vector<std::int64_t>(numbers.begin(), numbers.end())) << what << a.name;
  }
}

std::vector<std::unique_ptr<FrameSet>> all_sets(const Scene& s) {
  std::vector<std::unique_ptr<FrameSet>> out;
  out.push_back(make_line_set(s));
  out.push_back(make_surface_set(s, 8));
  out.push_back(make_support_set(s));
  out.push_back(make_trail_set(s, 4));
  return out;
}

class OneFileFrames : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Plugin::available("hdf5")) GTEST_SKIP() << "built without HDF5";
    options_.directory = dir_.path();
    options_.one_file = options_.bearings = options_.orbits = true;
    options_.points_around = 8;
    options_.trail_points = 4;
  }
  void write(FrameWriter& w, double t) {
    const std::vector<Pose> p = whirling(scene_, t);
    w.frame(state_of(p, t));
  }
  /// The file holds the frames at these times, and what every set makes of them. seen: of all times that
  /// the sets were offered.
  void expect_frames(const std::vector<double>& times, const std::vector<double>& seen) {
    for (const auto& set : all_sets(scene_)) {
      const Vtkhdf f(dir_ / (std::string("frames_") + set->name() + ".vtkhdf"));
      EXPECT_EQ(f.type(), "PolyData");
      ASSERT_EQ(f.steps(), static_cast<std::int64_t>(times.size())) << set->name();
      EXPECT_EQ(f.size("Steps/Values").front(), times.size());
      EXPECT_EQ(f.rows<double>("Steps/Values", 0, f.steps()), times);
      std::size_t k = 0;
      for (const double t : seen) {
        const std::vector<Pose> p = whirling(scene_, t);
        const FrameState s = state_of(p, t);
        set->update({p, p, &s});
        if (k < times.size() && times[k] == t)
          expect_step(f, static_cast<std::int64_t>(k++), set->data(), set->name());
      }
      EXPECT_EQ(k, times.size());
    }
  }
  TempFolder dir_;
  VtkFrameOptions options_;
  const Scene scene_ = rotor();
};

TEST_F(OneFileFrames, AreReadStepByStep) {
  {
    const auto w = make_vtk_frames(options_);
    w->begin(scene_);
    for (const double t : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5})
      write(*w, t);
    EXPECT_EQ(w->frames(), 6u);
  }
  expect_frames({0.0, 0.1, 0.2, 0.3, 0.4, 0.5}, {0.0, 0.1, 0.2, 0.3, 0.4, 0.5});
  // cells that stay stand once
  const Vtkhdf surface(dir_ / "frames_surface.vtkhdf");
  EXPECT_EQ(surface.size("NumberOfPoints").front(), 1u);
}

TEST_F(OneFileFrames, AreTheSameHoweverTheyArePacked) {
  std::vector<std::uintmax_t> sizes;
  for (const Compression how : {Compression::none, Compression::zlib}) {
    options_.compression = how;
    {
      const auto w = make_vtk_frames(options_);
      w->begin(scene_);
      for (const double t : {0.0, 0.1, 0.2})
        write(*w, t);
    }
    expect_frames({0.0, 0.1, 0.2}, {0.0, 0.1, 0.2});
    sizes.push_back(std::filesystem::file_size(dir_ / "frames_surface.vtkhdf"));
  }
  EXPECT_LT(sizes[1], sizes[0]);
}

TEST_F(OneFileFrames, AreWholeWhileTheRunGoesOn) {
  const auto w = make_vtk_frames(options_);
  w->begin(scene_);
  write(*w, 0.0);
  write(*w, 0.1);
  std::filesystem::copy(dir_ / "frames_line.vtkhdf", dir_ / "copy.vtkhdf");
  EXPECT_EQ(Vtkhdf(dir_ / "copy.vtkhdf").steps(), 2);
}

TEST_F(OneFileFrames, AreThinnedBeyondTheirMost) {
  options_.max_frames = 4;
  std::vector<double> seen;
  {
    const auto w = make_vtk_frames(options_);
    w->begin(scene_);
    for (int k = 0; k < 7; ++k)
      write(*w, 0.1 * k);
    EXPECT_EQ(w->frames(), 4u);
  }
  // the trails see the frames that are written alone
  expect_frames({0.0, 0.1 * 2, 0.1 * 4, 0.1 * 6}, {0.0, 0.1, 0.1 * 2, 0.1 * 3, 0.1 * 4, 0.1 * 6});
}

TEST_F(OneFileFrames, GoOnFromACheckpoint) {
  OutArchive saved;
  {
    const auto w = make_vtk_frames(options_);
    w->begin(scene_);
    for (const double t : {0.0, 0.1, 0.2})
      write(*w, t);
    w->save(saved);
    write(*w, 0.25);  // beyond the checkpoint: dropped
  }
  {
    const auto w = make_vtk_frames(options_);
    InArchive in(saved.data());
    w->resume(scene_, in);
    EXPECT_EQ(w->frames(), 3u);
    write(*w, 0.3);
    write(*w, 0.4);
  }
  expect_frames({0.0, 0.1, 0.2, 0.3, 0.4}, {0.0, 0.1, 0.2, 0.3, 0.4});
}

TEST_F(OneFileFrames, AFileOfSomebodyElseStays) {
  write_atomic(dir_ / "frames_line.vtkhdf", "mine");
  const auto w = make_vtk_frames(options_);
  EXPECT_THROW(w->begin(scene_), Error);
  EXPECT_EQ(read_text(dir_ / "frames_line.vtkhdf"), "mine");
}

}  // namespace
}  // namespace whirl::io
