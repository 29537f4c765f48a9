// A results folder belongs to its user: runs replace and remove what runs made and leave everything
// else alone; one run at a time.
#include "unbalanced_rotor.hpp"
#include <gtest/gtest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace fs = std::filesystem;

namespace {

std::string read(const fs::path& p) {
  std::ifstream in(p, std::ios::binary);
  std::ostringstream s;
  s << in.rdbuf();
  return s.str();
}

void write(const fs::path& p, const std::string& text) {
  if (p.has_parent_path()) fs::create_directories(p.parent_path());
  std::ofstream(p, std::ios::binary) << text;
}

constexpr const char* probe = R"([[probe]]
name = "PROBE"
at = "disk"
)";

std::string deck(const std::string& rest, const std::string& name = "P") {
  std::string text = std::string(whirl::test::unbalanced_rotor) + probe;
  text.replace(text.find("PROBE"), 5, name);
  return text + rest;
}

constexpr const char* response =
    "[[step]]\nname = \"r\"\ntype = \"unbalance_response\"\nspeed = { start = \"500 rpm\", stop = "
    "\"1500 rpm\", points = 3 }\n";
constexpr const char* motion =
    "[[step]]\nname = \"m\"\ntype = \"transient\"\nstart = \"rest\"\ninitial_speed = \"1000 "
    "rpm\"\nduration = \"DURATION\"\n";

std::string moving(const std::string& duration, const std::string& more = "") {
  std::string text = motion;
  text.replace(text.find("DURATION"), 8, duration);
  return deck(text + more);
}

class ResultsFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("whirl_folder_" + std::to_string(::getpid()) + "_" +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
    fs::current_path(folder_);
  }
  void TearDown() override {
    fs::current_path("/");
    fs::remove_all(folder_);
  }
  /// Starts `whirl run` with these arguments, its output in log.txt (or into a pipe that nobody
  /// reads).
  pid_t start(const std::vector<std::string>& arguments, bool closed_pipe = false) {
    int ends[2] = {-1, -1};
    if (closed_pipe && ::pipe(ends) != 0) return -1;
    const pid_t pid = ::fork();
    if (pid == 0) {
      const int log = closed_pipe ? ends[1] : ::open("log.txt", O_WRONLY | O_CREAT | O_TRUNC, 0644);
      ::dup2(log, 1);
      ::dup2(log, 2);
      if (closed_pipe) {
        ::close(ends[0]);
        ::close(ends[1]);
      }
      std::vector<char*> argv{const_cast<char*>(WHIRL_EXE), const_cast<char*>("run")};
      for (const auto& a : arguments)
        argv.push_back(const_cast<char*>(a.c_str()));
      argv.push_back(nullptr);
      ::execv(WHIRL_EXE, argv.data());
      ::_exit(127);
    }
    if (closed_pipe) {
      ::close(ends[0]);
      ::close(ends[1]);
    }
    return pid;
  }
  /// Exit code, minus the signal when it died of one.
  static int wait(pid_t pid) {
    int status = 0;
    ::waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  int run(const std::vector<std::string>& arguments) { return wait(start(arguments)); }
  static bool appears(const fs::path& p, double seconds = 20) {
    for (double t = 0; t < seconds && !fs::exists(p); t += 0.02)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return fs::exists(p);
  }
  fs::path folder_;
};

}  // namespace

TEST_F(ResultsFolder, TheUsersOwnFilesStay) {
  write("d.toml", deck(response));
  for (const char* own :
       {"plots/mine.svg", "plots/r_P_bode.svg", "checkpoint/mine.whirl", "summary.json",
        "r_response.csv", "manifest.txt", "vtk/m/frame_notes.txt"})
    write(own, own);
  ASSERT_EQ(run({"d.toml", "-o", "."}), 0) << read("log.txt");
  // twice: the second run knows what the first one made
  ASSERT_EQ(run({"d.toml", "-o", "."}), 0) << read("log.txt");
  for (const char* own : {"plots/mine.svg", "checkpoint/mine.whirl", "vtk/m/frame_notes.txt"})
    EXPECT_EQ(read(own), own);
  // where a result has the same name, the user's file is moved aside
  for (const char* own : {"plots/r_P_bode.svg", "summary.json", "r_response.csv", "manifest.txt"}) {
    EXPECT_EQ(read(std::string(own) + ".kept"), own);
    EXPECT_NE(read(own), own);
    EXPECT_FALSE(fs::exists(std::string(own) + ".kept2"));
  }
}

TEST_F(ResultsFolder, ResultsOfAnOlderProgramAreReplaced) {
  // A folder from before there were lists: what has the name of a result is one, in every part of
  // the run.
  write("d.toml", deck(response));
  write("r/run.json", "{ \"program\": \"whirl 0.1.0\" }");
  for (const char* older : {"r/summary.json", "r/r_response.csv", "r/plots/r_P_bode.svg"})
    write(older, older);
  ASSERT_EQ(run({"d.toml", "-o", "r"}), 0) << read("log.txt");
  for (const char* older : {"r/summary.json", "r/r_response.csv", "r/plots/r_P_bode.svg"}) {
    EXPECT_FALSE(fs::exists(std::string(older) + ".kept")) << read("log.txt");
    EXPECT_NE(read(older), older);
  }
}

TEST_F(ResultsFolder, PicturesOfEarlierRunsGo) {
  write("d.toml", deck(response));
  ASSERT_EQ(run({"d.toml", "-o", "r"}), 0) << read("log.txt");
  EXPECT_TRUE(fs::exists("r/plots/r_P_bode.svg"));
  write("d.toml", deck(response, "Q"));
  ASSERT_EQ(run({"d.toml", "-o", "r"}), 0) << read("log.txt");
  EXPECT_FALSE(fs::exists("r/plots/r_P_bode.svg"));
  EXPECT_TRUE(fs::exists("r/plots/r_Q_bode.svg"));
}

// A table of a step that the deck has no more stood beside those of this run.
TEST_F(ResultsFolder, TablesOfEarlierRunsGo) {
  write("d.toml", deck(response));
  ASSERT_EQ(run({"d.toml", "-o", "r"}), 0) << read("log.txt");
  ASSERT_TRUE(fs::exists("r/r_response.csv"));
  write("r/r_mine.csv", "mine");
  std::string other = response;
  other.replace(other.find("\"r\""), 3, "\"q\"");
  write("d.toml", deck(other));
  ASSERT_EQ(run({"d.toml", "-o", "r"}), 0) << read("log.txt");
  EXPECT_TRUE(fs::exists("r/q_response.csv"));
  EXPECT_FALSE(fs::exists("r/r_response.csv"));
  EXPECT_EQ(read("r/r_mine.csv"), "mine");
}

// Old numbers stood beside a run that had failed, as if they were its own.
TEST_F(ResultsFolder, RunsThatFailLeaveNoOlderNumbers) {
  write("r/mine.csv", "mine");
  write("d.toml", deck(response));
  ASSERT_EQ(run({"d.toml", "-o", "r"}), 0) << read("log.txt");
  ASSERT_TRUE(fs::exists("r/summary.json"));
  std::string other = response;
  other.replace(other.find("\"r\""), 3, "\"q\"");
  write("d.toml", deck(other));
  fs::create_directories("r/q_response.csv");  // in the way of its table
  EXPECT_EQ(run({"d.toml", "-o", "r"}), 5) << read("log.txt");
  EXPECT_FALSE(fs::exists("r/r_response.csv"));
  for (const char* file : {"r/summary.json", "r/report.html"})  // of what has run
    EXPECT_EQ(read(file).find("r_response"), std::string::npos) << file;
  EXPECT_EQ(read("r/summary.json").find("\"r\": {"), std::string::npos) << read("r/summary.json");
  EXPECT_EQ(read("r/mine.csv"), "mine");
}

// A law of time was moved aside for the histories of the step of its name.
TEST_F(ResultsFolder, WhatTheDeckReadsIsNotReplaced) {
  const std::string law = "time[s],value[rpm]\n0,1000\n1,2000\n";
  write("m.csv", law);
  write("d.toml", moving("0.01 s",
                         "[[drive]]\nat = \"left:start\"\ntype = \"speed\"\nspeed = { type = "
                         "\"table\", file = \"m.csv\" }\n"));
  std::string text = read("d.toml");
  const std::string speed = "initial_speed = \"1000 rpm\"\n";
  text.erase(text.find(speed), speed.size());
  write("d.toml", text);
  EXPECT_EQ(run({"d.toml", "-o", "."}), 5) << read("log.txt");
  EXPECT_NE(read("log.txt").find("results would replace './m.csv', which the deck reads"),
            std::string::npos)
      << read("log.txt");
  EXPECT_EQ(read("m.csv"), law);
  EXPECT_FALSE(fs::exists("m.csv.kept"));
  EXPECT_EQ(run({"d.toml", "-o", "r"}), 0) << read("log.txt");
}

// The state that a step goes on from was removed before it was read.
TEST_F(ResultsFolder, AStateInTheFolderIsKeptForTheStepThatNeedsIt) {
  write("a.toml", moving("0.01 s", "checkpoint = \"1 s\"\n"));
  ASSERT_EQ(run({"a.toml", "-o", "r"}), 0) << read("log.txt");
  const std::string state = read("r/checkpoint/m.whirl");
  ASSERT_FALSE(state.empty());
  const std::string motion_on =
      "[[step]]\nname = \"n\"\ntype = \"transient\"\nduration = \"0.01 s\"\nprevious = "
      "\"r\"\nprevious_step = \"m\"\n";
  write("b.toml", deck(motion_on));
  for (int again = 0; again < 2; ++again) {
    EXPECT_EQ(run({"b.toml", "-o", "r"}), 0) << read("log.txt");
    EXPECT_EQ(read("r/checkpoint/m.whirl"), state);
    EXPECT_TRUE(fs::exists("r/m.csv"));
  }
  // a step of that name would write its own state over it
  std::string same = motion_on;
  same.replace(same.find("\"n\""), 3, "\"m\"");
  write("c.toml", deck(same));
  EXPECT_EQ(run({"c.toml", "-o", "r"}), 3) << read("log.txt");
  EXPECT_EQ(read("r/checkpoint/m.whirl"), state);
  EXPECT_EQ(run({"c.toml", "-o", "s"}), 0) << read("log.txt");
}

TEST_F(ResultsFolder, AnEarlierRunIsAskedForAStepItHas) {
  write("a.toml", moving("0.01 s", "checkpoint = \"1 s\"\n"));
  ASSERT_EQ(run({"a.toml", "-o", "r"}), 0) << read("log.txt");
  std::string on = moving("0.01 s", "previous = \"r\"\nprevious_step = \"zzz\"\n");
  write("b.toml", on);
  EXPECT_EQ(run({"b.toml", "-o", "s"}), 5) << read("log.txt");
  EXPECT_NE(read("log.txt").find("the run in 'r' has no state of a step 'zzz': it has that of 'm'"),
            std::string::npos)
      << read("log.txt");
}

// A state was taken over by a rotor of another mass without a word.
TEST_F(ResultsFolder, AStateOfAnotherRotorIsToldOf) {
  write("a.toml", moving("0.01 s", "checkpoint = \"1 s\"\n"));
  ASSERT_EQ(run({"a.toml", "-o", "r"}), 0) << read("log.txt");
  std::string same = moving("0.01 s", "previous = \"r\"\n");
  same.replace(same.find("60 g.mm"), 7, "90 g.mm");
  write("b.toml", same);
  EXPECT_EQ(run({"b.toml", "-o", "s"}), 0) << read("log.txt");
  EXPECT_EQ(read("log.txt").find("another rotor"), std::string::npos) << read("log.txt");
  same.replace(same.find("mass = \"3 kg\""), 13, "mass = \"4 kg\"");
  write("c.toml", same);
  EXPECT_EQ(run({"c.toml", "-o", "s"}), 0) << read("log.txt");
  EXPECT_NE(read("log.txt").find("one of another rotor: [[disk]] now 'mass = \"4 kg\"', then "
                                 "'mass = \"3 kg\"'"),
            std::string::npos)
      << read("log.txt");
}

TEST_F(ResultsFolder, NothingIsReachedThroughASymbolicLink) {
  write("d.toml", deck(response));
  write("elsewhere/mine.svg", "mine");
  fs::create_directories("r");
  fs::create_directory_symlink(folder_ / "elsewhere", "r/plots");
  EXPECT_EQ(run({"d.toml", "-o", "r"}), 5);
  EXPECT_NE(read("log.txt").find("symbolic link"), std::string::npos) << read("log.txt");
  EXPECT_EQ(read("elsewhere/mine.svg"), "mine");
  int files = 0;
  for (const auto& f : fs::directory_iterator("elsewhere"))
    files += f.exists();
  EXPECT_EQ(files, 1);
  // a list that was tampered with removes nothing outside either
  fs::remove("r/plots");
  write("outside.svg", "mine");
  std::ofstream("r/manifest.txt", std::ios::app) << "plots/../../outside.svg\n";
  EXPECT_EQ(run({"d.toml", "-o", "r"}), 0) << read("log.txt");
  EXPECT_EQ(read("outside.svg"), "mine");
}

TEST_F(ResultsFolder, OneRunAtATime) {
  write("d.toml", deck(response));
  fs::create_directories("r");
  const int held = ::open("r/.whirl.lock", O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  ASSERT_GE(held, 0);
  ASSERT_EQ(::write(held, "4711\n", 5), 5);
  ASSERT_EQ(::flock(held, LOCK_EX | LOCK_NB), 0);
  EXPECT_EQ(run({"d.toml", "-o", "r"}), 5);
  EXPECT_NE(read("log.txt").find(
                "error[E97]: another run (process 4711) is writing into the results folder 'r'"),
            std::string::npos)
      << read("log.txt");
  EXPECT_FALSE(fs::exists("r/run.json"));
  // its process ends, however: the file alone is no lock
  ::close(held);
  EXPECT_EQ(run({"d.toml", "-o", "r"}), 0) << read("log.txt");
  EXPECT_FALSE(fs::exists("r/.whirl.lock"));
}

TEST_F(ResultsFolder, TwoDecksInOneFolder) {
  write("long.toml", moving("1000 s", "[output]\nevery = \"1 s\"\n"));
  write("d.toml", deck(response));
  const pid_t first = start({"long.toml", "-o", "r"});
  ASSERT_TRUE(appears("r/m.csv"));
  EXPECT_EQ(run({"d.toml", "-o", "r"}), 5);
  EXPECT_NE(read("log.txt").find("E97"), std::string::npos) << read("log.txt");
  ::kill(first, SIGKILL);
  EXPECT_EQ(wait(first), -SIGKILL);
  EXPECT_EQ(run({"d.toml", "-o", "r"}), 0)
      << read("log.txt");  // the lock of a dead process does not count
}

TEST_F(ResultsFolder, AClosedTerminalLeavesACheckpoint) {
  write("long.toml", moving("1000 s", "[output]\nevery = \"1 s\"\n"));
  const pid_t pid = start({"long.toml", "-o", "r"});
  ASSERT_TRUE(appears("r/m.csv"));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  ::kill(pid, SIGHUP);
  ::kill(pid, SIGHUP);  // a shell and the terminal both send it
  EXPECT_EQ(wait(pid), 130) << read("log.txt");
  EXPECT_TRUE(fs::exists("r/checkpoint/m.whirl"));
  EXPECT_NE(read("r/summary.json").find("interrupted"), std::string::npos);
}

TEST_F(ResultsFolder, NobodyWhoReadsTheProgressIsNoReasonToStop) {
  write("d.toml", moving("0.2 s"));
  const int code = wait(start({"d.toml", "-o", "r"}, true));
  EXPECT_EQ(code, 5);  // what it had to say was lost, and only that
  EXPECT_TRUE(fs::exists("r/checkpoint/m.whirl"));
  EXPECT_TRUE(fs::exists("r/report.html"));
  EXPECT_NE(read("r/summary.json").find("end time reached"), std::string::npos);
}

namespace {
constexpr const char* many_modes = R"(
[[step]]
name = "slow"
type = "campbell"
speed = { start = "0 rpm", stop = "30000 rpm", points = 20000 }
modes = 12
)";
}

// each of them would go on for a minute and more
TEST_F(ResultsFolder, InterruptsAreHeardInSweeps) {
  const std::vector<std::string> steps{
      many_modes,
      "[[step]]\nname = \"slow\"\ntype = \"unbalance_response\"\nspeed = { start = \"1 rpm\", stop "
      "= \"30000 rpm\", points = 1000000 }\n",
      "[[step]]\nname = \"slow\"\ntype = \"critical_map\"\nstiffness_min = \"1e4 "
      "N/m\"\nstiffness_max = \"1e9 N/m\"\npoints = 10000\nmax_speed = \"30000 rpm\"\n",
      "[[step]]\nname = \"slow\"\ntype = \"stability\"\nspeed = { start = \"1 rpm\", stop = "
      "\"30000 rpm\", points = 20000 }\n",
      "[[step]]\nname = \"slow\"\ntype = \"static\"\nspeeds = { start = \"1 rpm\", stop = \"30000 "
      "rpm\", points = 1000000 }\n",
      "[[step]]\nname = \"slow\"\ntype = \"transient\"\nstart = \"rest\"\ninitial_speed = \"1000 "
      "rpm\"\nduration = \"1000 s\"\n[output]\nevery = \"1 ns\"\nspeed_window = [\"5000 rpm\", "
      "\"6000 rpm\"]\n",
  };
  for (const auto& step : steps) {
    write("d.toml", deck(step));
    const pid_t pid = start({"d.toml", "-o", "r"});
    ASSERT_TRUE(appears("r/run.json")) << step;
    std::this_thread::sleep_for(std::chrono::milliseconds(1000));
    const auto asked = std::chrono::steady_clock::now();
    ::kill(pid, SIGINT);
    EXPECT_EQ(wait(pid), 130) << step << read("log.txt");
    // half a second at most, and then the report; a busy machine is allowed for
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count(), 5.0)
        << step;
    EXPECT_NE(read("r/summary.json").find("interrupted"), std::string::npos) << step;
    fs::remove_all("r");
  }
}
