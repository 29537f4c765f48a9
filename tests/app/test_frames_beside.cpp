// Frames are written beside the solver, by a thread of their own where there may be more than one:
// nothing of it is seen in the files, nor in what is said when they cannot be written.
#include "deck_run.hpp"
#include "unbalanced_rotor.hpp"

#include <core/plugin.hpp>
#include <fmt/format.h>

namespace fs = std::filesystem;

namespace whirl::test {
namespace {

std::string text_of(const fs::path& file) {
  std::ostringstream s;
  s << std::ifstream(file, std::ios::binary).rdbuf();
  return s.str();
}

class FramesBeside : public testing::Test {
 protected:
  void SetUp() override {
    if (!Plugin::available("vtk")) GTEST_SKIP() << "built without VTK";
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              (std::string("whirl_beside_") + test->name() + "_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override {
    std::error_code ec;
    fs::remove_all(folder_, ec);
  }

  void write_deck(const std::string& duration, const std::string& frames) const {
    std::ofstream(folder_ / "d.toml") << unbalanced_rotor << R"([[drive]]
name = "motor"
at = "left:start"
type = "torque"
torque = "3 N.m"
[[probe]]
name = "disk"
at = "disk"
[[step]]
name = "run_up"
type = "transient"
checkpoint = "0.02 s"
duration = ")" << duration << R"("
[output]
every = "1 ms"
report = false
[[output.vtk]]
)" << frames;
  }

  /// Exit code. before: of the shell.
  int run(const std::string& options, const std::string& before = {}) const {
    const std::string command = "cd '" + folder_.string() + "' && " + before +
                                "'" WHIRL_EXE "' run d.toml " + options +
                                " >log.txt 2>&1 </dev/null";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  std::string log() const { return text_of(folder_ / "log.txt"); }

  /// Name and content of every file of frames.
  std::map<std::string, std::string> frames(const std::string& results) const {
    std::map<std::string, std::string> out;
    const fs::path root = folder_ / results / "vtk";
    for (const auto& e : fs::recursive_directory_iterator(root))
      if (e.is_regular_file()) out[fs::relative(e.path(), root).string()] = text_of(e.path());
    return out;
  }

  static void expect_same(const std::map<std::string, std::string>& a,
                          const std::map<std::string, std::string>& b) {
    EXPECT_EQ(a.size(), b.size());
    for (const auto& [name, content] : a) {
      ASSERT_TRUE(b.count(name)) << name;
      EXPECT_TRUE(b.at(name) == content) << name;
    }
  }

  /// Every list is whole, and so is every frame it names. Returns how many.
  static std::size_t readable(const std::map<std::string, std::string>& files) {
    constexpr std::string_view end = "</VTKFile>\n";
    std::size_t named = 0;
    for (const auto& [name, content] : files) {
      if (!name.ends_with(".pvd")) continue;
      EXPECT_TRUE(content.ends_with(end)) << name;
      const std::string_view mark = "file=\"";
      for (std::size_t at = content.find(mark); at != std::string::npos;
           at = content.find(mark, at + 1)) {
        const std::size_t from = at + mark.size();
        const std::string frame = content.substr(from, content.find('"', from) - from);
        EXPECT_TRUE(files.count(frame) && files.at(frame).ends_with(end)) << frame;
        ++named;
      }
    }
    return named;
  }

  fs::path folder_;
};

TEST_F(FramesBeside, AreTheSameForAnyNumberOfThreads) {
  write_deck("0.1 s",
             "every = \"0.4 ms\"\n"
             "content = [\"line\", \"surface\", \"bearings\", \"orbits\"]\n"
             "[[output.vtk]]\nframes_per_revolution = 8\nmax_frames = 16\n");
  ASSERT_EQ(run("-o one --jobs 1"), 0) << log();
  ASSERT_EQ(run("-o many --jobs 4"), 0) << log();
  const auto one = frames("one");
  EXPECT_EQ(readable(one), one.size() - 6);
  EXPECT_GT(one.size(), 900u);
  expect_same(one, frames("many"));
}

TEST_F(FramesBeside, AKilledRunNamesWholeFilesAndGoesOn) {
  write_deck("0.2 s", "every = \"0.2 ms\"\ncontent = [\"line\", \"surface\"]\n");
  ASSERT_EQ(run("-o whole --jobs 1"), 0) << log();
  int cuts = 0, code = -1;
  for (double wait = 0.05; code != 0 && cuts < 6; wait += 0.1, ++cuts) {
    const std::string resume = cuts > 0 ? " --resume" : "";
    // TERM lets it end what it has begun, KILL does not; the last one may take its time
    std::string limit = fmt::format("timeout -s {} {} ", cuts % 2 ? "TERM" : "KILL", wait);
    if (cuts == 5) limit.clear();
    code = run("-o cut --jobs 2" + resume, limit);
    if (code != 0 && fs::exists(folder_ / "cut" / "vtk"))  // as if it had been killed at its list
      std::ofstream(folder_ / "cut" / "vtk" / ".run_up_line.pvd.4711.0.part") << "<?xml";
    if (fs::exists(folder_ / "cut" / "vtk")) readable(frames("cut"));
  }
  EXPECT_EQ(code, 0) << log();
  EXPECT_GT(cuts, 1);
  expect_same(frames("whole"), frames("cut"));
}

// A limit on file size stands for the full disk.
TEST_F(FramesBeside, AFullDiskEndsTheRunAsItEndsOneThread) {
  write_deck("0.1 s", "every = \"0.1 ms\"\npoints_around = 1000\n");
  std::string said[2];
  for (const int jobs : {1, 2}) {
    EXPECT_EQ(run("-o r --quiet --jobs " + std::to_string(jobs), "trap '' XFSZ; ulimit -f 64; "),
              5);
    said[jobs - 1] = log();
    EXPECT_EQ(readable(frames("r")), 1u);  // the first centre line
  }
  EXPECT_NE(said[0].find("E91"), std::string::npos) << said[0];
  EXPECT_NE(said[0].find("run_up_surface/frame_000000.vtp"), std::string::npos) << said[0];
  EXPECT_EQ(said[1], said[0]);
}

}  // namespace

// HDF5 tried at the end of the process to write what the disk had refused, and crashed.
TEST_F(FramesBeside, AFullDiskEndsARunIntoOneFileToo) {
  if (!Plugin::available("hdf5")) GTEST_SKIP() << "built without HDF5";
  write_deck("0.1 s", "every = \"0.1 ms\"\npoints_around = 1000\nformat = \"vtkhdf\"\n");
  for (const int jobs : {1, 2}) {
    EXPECT_EQ(run("-o r --quiet --jobs " + std::to_string(jobs), "trap '' XFSZ; ulimit -f 64; "),
              5);
    EXPECT_NE(log().find("E91"), std::string::npos) << log();
  }
}

}  // namespace whirl::test
