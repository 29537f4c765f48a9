// Frames for ParaView: times, sets, caps, continuation; read back by VTK itself where its Python
// module is there.
#include "temp_folder.hpp"
#include <core/error.hpp>
#include <core/plugin.hpp>
#include <io/file.hpp>
#include <io/frames.hpp>
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>

namespace whirl::io {
namespace {

namespace fs = std::filesystem;

// A shaft of three nodes with a disk in the middle, two bearings, one trail.
Scene small_rotor() {
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
  s.trails = {{"mid", {1, 0}}};
  return s;
}

// Whirls at the middle with radius 1 mm and spins.
std::vector<Pose> poses_at(const Scene& s, double t) {
  std::vector<Pose> p;
  for (std::size_t k = 0; k < s.nodes.size(); ++k) {
    const double a = k == 1 ? 1e-3 : 0.0, slope = k == 0 ? 3e-3 : k == 2 ? -3e-3 : 0.0;
    const Vec3 w(0, std::cos(40 * t), std::sin(40 * t));
    p.push_back({s.nodes[k] + a * w, (Vec3::UnitX() + slope * w).normalized(), 100 * t});
  }
  return p;
}

struct Listed {
  double time;
  std::string file;
};
std::vector<Listed> read_pvd(const fs::path& p) {
  std::vector<Listed> out;
  std::ifstream in(p);
  for (std::string line; std::getline(in, line);)
    if (const auto a = line.find("timestep=\""); a != std::string::npos) {
      const auto f = line.find("file=\"") + 6;
      out.push_back({std::stod(line.substr(a + 10)), line.substr(f, line.find('"', f) - f)});
    }
  return out;
}

class Frames : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Plugin::available("vtk")) GTEST_SKIP() << "built without VTK";
  }
  void write(FrameWriter& w, const Scene& scene, double t, bool stressed = true) {
    const auto p = poses_at(scene, t);
    const std::vector<Vec3> v(3, Vec3(0, 1, 2)), f(2, Vec3(0, 0, 500));
    FrameState s;
    const double stress[] = {1e6, 3e6, 1e6};
    s.time = t;
    s.nodes = p;
    s.velocity = v;
    s.support_force = f;
    if (stressed) s.stress = stress;
    w.frame(s);
  }
  TempFolder dir_;
};

TEST_F(Frames, VtkReadsWhatIsWritten) {
  const Scene scene = small_rotor();
  VtkFrameOptions o;
  o.directory = dir_.path();
  o.name = "run_up";
  o.bearings = o.orbits = true;
  o.deformation_scale = 10;
  auto w = make_vtk_frames(o);
  w->begin(scene);
  for (int k = 0; k < 5; ++k)
    write(*w, scene, 0.1 * k);
  w->end();
  EXPECT_EQ(w->frames(), 5u);
  for (const char* set : {"line", "surface", "bearings", "orbits"}) {
    const auto list = read_pvd(dir_ / (std::string("run_up_") + set + ".pvd"));
    ASSERT_EQ(list.size(), 5u) << set;
    for (int k = 0; k < 5; ++k)
      EXPECT_EQ(list[static_cast<std::size_t>(k)].time, 0.1 * k);
    EXPECT_TRUE(fs::exists(dir_ / list[4].file));
    EXPECT_EQ(list[4].file, std::string("run_up_") + set + "/frame_000004.vtp");
  }
  if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOXML' 2>/dev/null") != 0)
    GTEST_SKIP() << "no python3-vtk9";
  EXPECT_EQ(std::system(("/usr/bin/python3 read_frames.py " + dir_.path().string()).c_str()), 0);
}

TEST_F(Frames, EveryMomentLeavesAnOpenableCollection) {
  const Scene scene = small_rotor();
  VtkFrameOptions o;
  o.directory = dir_.path();
  o.line = false;
  auto w = make_vtk_frames(o);
  w->begin(scene);
  for (int k = 0; k < 4; ++k) {
    write(*w, scene, k);
    const std::string text = read_text(dir_ / "frames_surface.pvd");
    EXPECT_NE(text.find("</VTKFile>"), std::string::npos);
    EXPECT_EQ(read_pvd(dir_ / "frames_surface.pvd").size(), static_cast<std::size_t>(k + 1));
  }
}

// The first frame of a writer is VTK's; those after it are made from it. Each is what a writer of its own,
// that is VTK, has as its first: bytes for bytes, with arrays of several blocks and arrays that come and
// go.
TEST_F(Frames, AreThoseOfVtkByteForByte) {
  const Scene scene = small_rotor();
  int folder = 0;
  for (const Compression how : {Compression::none, Compression::lz4, Compression::zlib})
    for (const int around : {32, 1500}) {
      VtkFrameOptions o;
      o.bearings = true;
      o.compression = how;
      o.points_around = around;
      o.directory = dir_ / std::to_string(folder++);
      const fs::path together = o.directory;
      const auto w = make_vtk_frames(o);
      w->begin(scene);
      for (int k = 0; k < 7; ++k) {
        const bool stressed = k != 3;
        const double t = k == 5 ? 1e-300 : 0.013 * k;
        write(*w, scene, t, stressed);
        o.directory = dir_ / std::to_string(folder++);
        const auto alone = make_vtk_frames(o);
        alone->begin(scene);
        write(*alone, scene, t, stressed);
        for (const char* set : {"line", "surface", "bearings"}) {
          const std::string name = fmt::format("frames_{}/frame_{:06}.vtp", set, k);
          EXPECT_EQ(read_text(together / name),
                    read_text(o.directory / fmt::format("frames_{}/frame_000000.vtp", set)))
              << name << " of " << o.directory;
        }
      }
    }
}

// Where a number is not one VTK writes the frame; those after it are as ever.
TEST_F(Frames, WithoutAFiniteNumberAreThoseOfVtkToo) {
  const Scene scene = small_rotor();
  VtkFrameOptions o;
  o.surface = false;
  o.directory = dir_ / "together";
  const auto w = make_vtk_frames(o);
  w->begin(scene);
  const auto put = [&](FrameWriter& to, int k) {
    std::vector<Pose> p = poses_at(scene, 0.01 * k);
    const std::vector<Vec3> v(3, Vec3(k == 1 ? nan : k == 2 ? infinity : 1.0, 2, 3));
    FrameState s;
    s.time = 0.01 * k;
    s.nodes = p;
    s.velocity = v;
    to.frame(s);
  };
  for (int k = 0; k < 5; ++k) {
    put(*w, k);
    o.directory = dir_ / fmt::format("alone{}", k);
    const auto alone = make_vtk_frames(o);
    alone->begin(scene);
    put(*alone, k);
    EXPECT_EQ(read_text(dir_ / fmt::format("together/frames_line/frame_{:06}.vtp", k)),
              read_text(o.directory / "frames_line/frame_000000.vtp"))
        << k;
  }
}

TEST_F(Frames, AreTheSameHoweverTheyArePacked) {
  const Scene scene = small_rotor();
  std::vector<std::uintmax_t> sizes;
  std::string folders;
  for (const Compression how : {Compression::none, Compression::lz4, Compression::zlib}) {
    VtkFrameOptions o;
    o.directory = dir_ / std::to_string(sizes.size());
    o.bearings = o.orbits = true;
    o.compression = how;
    const auto w = make_vtk_frames(o);
    w->begin(scene);
    for (int k = 0; k < 3; ++k)
      write(*w, scene, 0.1 * k);
    sizes.push_back(fs::file_size(o.directory / "frames_surface/frame_000002.vtp"));
    folders += " '" + o.directory.string() + "'";
  }
  EXPECT_LT(sizes[1], 0.7 * static_cast<double>(sizes[0]));  // lz4
  EXPECT_LT(sizes[2], 0.9 * static_cast<double>(sizes[1]));  // zlib
  if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOXML' 2>/dev/null") != 0)
    GTEST_SKIP() << "no python3-vtk9";
  EXPECT_EQ(std::system(("/usr/bin/python3 same_frames.py" + folders).c_str()), 0);
}

// Objects and arrays stay from frame to frame: nothing of an earlier one may be seen in a later one.
TEST_F(Frames, AFrameHoldsNothingOfThoseBefore) {
  const Scene scene = small_rotor();
  VtkFrameOptions o;
  o.directory = dir_.path();
  o.bearings = true;
  o.name = "many";
  const auto many = make_vtk_frames(o);
  many->begin(scene);
  constexpr std::array times{0.1, 0.2, 0.3};
  write(*many, scene, times[0]);
  write(*many, scene, times[1], false);
  write(*many, scene, times[2]);
  o.name = "alone";
  const auto text_of = [&](const char* name, const char* set, int k) {
    return read_text(dir_ / fmt::format("{}_{}/frame_{:06}.vtp", name, set, k));
  };
  for (int k = 0; k < 3; ++k) {
    const auto alone = make_vtk_frames(o);
    alone->begin(scene);
    write(*alone, scene, times[static_cast<std::size_t>(k)], k != 1);
    for (const char* set : {"line", "surface", "bearings"})
      EXPECT_TRUE(text_of("many", set, k) == text_of("alone", set, 0)) << set << k;
  }
}

TEST_F(Frames, CapThinsEvenlyAndRemovesTheFiles) {
  const Scene scene = small_rotor();
  VtkFrameOptions o;
  o.directory = dir_.path();
  o.surface = false;
  o.max_frames = 16;
  auto w = make_vtk_frames(o);
  w->begin(scene);
  for (int k = 0; k < 100; ++k) {
    write(*w, scene, k);
    ASSERT_LE(read_pvd(dir_ / "frames_line.pvd").size(), 16u);
  }
  const auto list = read_pvd(dir_ / "frames_line.pvd");
  ASSERT_GT(list.size(), 8u);
  for (std::size_t k = 0; k < list.size(); ++k) {
    EXPECT_EQ(list[k].time, 8.0 * static_cast<double>(k));
    EXPECT_TRUE(fs::exists(dir_ / list[k].file));
  }
  EXPECT_EQ(file_count(dir_ / "frames_line"), list.size());
  EXPECT_EQ(w->frames(), list.size());
}

TEST_F(Frames, ContinuedRunKeepsEarlierFramesAndDropsLaterOnes) {
  const Scene scene = small_rotor();
  VtkFrameOptions o;
  o.directory = dir_.path();
  o.surface = false;
  auto w = make_vtk_frames(o);
  w->begin(scene);
  for (int k = 0; k < 10; ++k)
    write(*w, scene, k);
  o.keep_until = 5.5;
  w = make_vtk_frames(o);
  w->begin(scene);
  EXPECT_EQ(w->frames(), 6u);
  EXPECT_EQ(file_count(dir_ / "frames_line"), 6u);
  write(*w, scene, 6.25);
  auto list = read_pvd(dir_ / "frames_line.pvd");
  ASSERT_EQ(list.size(), 7u);
  EXPECT_EQ(list[6].time, 6.25);
  EXPECT_EQ(list[6].file, "frames_line/frame_000006.vtp");
  // A new run replaces everything.
  o.keep_until = -infinity;
  w = make_vtk_frames(o);
  w->begin(scene);
  write(*w, scene, 0);
  EXPECT_EQ(file_count(dir_ / "frames_line"), 1u);
}

TEST_F(Frames, AListOfSomebodyElseStays) {
  write_atomic(dir_ / "frames_line.pvd", "<VTKFile type=\"Collection\">mine</VTKFile>\n");
  VtkFrameOptions o;
  o.directory = dir_.path();
  o.surface = false;
  const auto w = make_vtk_frames(o);
  EXPECT_THROW(w->begin(small_rotor()), Error);
  EXPECT_EQ(read_text(dir_ / "frames_line.pvd"), "<VTKFile type=\"Collection\">mine</VTKFile>\n");
}

TEST_F(Frames, NamesOfDecksStayInTheFolder) {
  VtkFrameOptions o;
  o.directory = dir_.path();
  o.name = "../run & up";
  o.surface = false;
  auto w = make_vtk_frames(o);
  w->begin(small_rotor());
  write(*w, small_rotor(), 0);
  const auto list = read_pvd(dir_ / "_.._run___up_line.pvd");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_TRUE(fs::exists(dir_ / list[0].file));
}

TEST_F(Frames, ModesHavePhasesOfOnePeriod) {
  const Scene scene = small_rotor();
  HarmonicShape mode;
  for (int k = 0; k < 3; ++k) {
    mode.u.emplace_back(Eigen::Vector3cd(0, k == 1 ? 1 : 0, Complex(0, k == 1 ? -1 : 0)));
    mode.tilt.emplace_back(Eigen::Vector3cd::Zero());
  }
  VtkFrameOptions o;
  o.directory = dir_ / "modes";
  o.name = "mode_01";
  auto w = make_vtk_frames(o);
  write_harmonic(*w, scene, mode, 0.05);
  EXPECT_EQ(read_pvd(dir_ / "modes/mode_01_surface.pvd").size(), 24u);
  // Re(u exp(i theta)) of (1, -i) is (cos, sin): forward.
  std::vector<Pose> rest{{scene.nodes[0], Vec3::UnitX(), 0},
                         {scene.nodes[1], Vec3::UnitX(), 0},
                         {scene.nodes[2], Vec3::UnitX(), 0}},
      now;
  pose_of_phase(rest, mode, 0.05, pi / 2, now);
  EXPECT_LT((now[1].r - Vec3(0.5, 0, 0.05)).norm(), 1e-15);
}

TEST_F(Frames, VtkIsLoadedOnlyWhenAsked) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";  // a fresh process
  EXPECT_EXIT(
      {
        const auto mapped = [] {
          return read_text("/proc/self/maps").find("libvtk") != std::string::npos;
        };
        const bool before = mapped();
        auto w = make_vtk_frames({});
        ::_exit(!before && mapped() ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST(FrameContent, UnknownNameIsADeckError) {
  VtkFrameOptions o;
  set_content(o, std::vector<std::string>{"bearings", "line"});
  EXPECT_TRUE(o.bearings && o.line && !o.surface && !o.orbits);
  EXPECT_THROW(set_content(o, std::vector<std::string>{"lines"}), Error);
}

TEST(FrameSchedule, TimesAreExactAndEndAtTheWindow) {
  FrameSchedule s({.t0 = 4.0, .t1 = 4.5, .every = 0.001}, 0, 12);
  EXPECT_EQ(s.planned(), 501u);
  EXPECT_EQ(s.stretch(), 1.0);
  std::vector<double> t;
  for (; s.next_time() < infinity; s.advance())
    t.push_back(s.next_time());
  ASSERT_EQ(t.size(), 501u);
  EXPECT_EQ(t.front(), 4.0);
  EXPECT_EQ(t[300], 4.0 + 300 * 0.001);
  EXPECT_NEAR(t.back(), 4.5, 1e-15);
  EXPECT_LE(t.back(), 4.5);
}

TEST(FrameSchedule, CapStretchesTheIntervalOverTheWholeWindow) {
  FrameSchedule s({.every = 1e-6}, 0, 12);
  EXPECT_EQ(s.planned(), 5000u);
  EXPECT_GT(s.stretch(), 2000);
  double last = 0;
  int n = 0;
  for (; s.next_time() < infinity; s.advance(), ++n)
    last = s.next_time();
  EXPECT_EQ(n, 5000);
  EXPECT_NEAR(last, 12, 1e-9);
}

TEST(FrameSchedule, DefaultCountOverTheWindowAndEmptyWindow) {
  FrameSchedule s({.frames = 3}, 1, 2);
  std::vector<double> t;
  for (; s.next_time() < infinity; s.advance())
    t.push_back(s.next_time());
  EXPECT_EQ(t, (std::vector<double>{1, 1.5, 2}));
  FrameSchedule outside({.t0 = 20, .t1 = 30}, 0, 12);
  EXPECT_EQ(outside.next_time(), infinity);
}

TEST(FrameSchedule, ByRevolutionInBothDirections) {
  FrameSchedule s({.frames_per_revolution = 24}, 0, 10);
  ASSERT_TRUE(s.by_revolution());
  EXPECT_EQ(s.next_time(), infinity);
  const double step = two_pi / 24;
  double phi = 0;
  for (int k = 1; k <= 100000; ++k) {
    phi = s.next_angle(phi);
    ASSERT_NEAR(phi, k * step, 1e-10);  // a multiple, not a sum
  }
  EXPECT_NEAR(s.next_angle(-0.5 * step, -1), -step, 1e-12);
  EXPECT_NEAR(s.next_angle(-step, -1), -2 * step, 1e-12);
}

}  // namespace
}  // namespace whirl::io
