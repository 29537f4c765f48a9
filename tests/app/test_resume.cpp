// A run that is killed, interrupted and continued leaves the files of an uninterrupted one.
#include "film_rotor.hpp"
#include "unbalanced_rotor.hpp"
#include <core/plugin.hpp>
#include <gtest/gtest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <thread>

namespace fs = std::filesystem;

namespace {

std::string read(const fs::path& p) {
  std::ifstream in(p, std::ios::binary);
  std::ostringstream s;
  s << in.rdbuf();
  return s.str();
}

/// Unbalanced rotor on soft bearings through its critical speed under a motor torque: events of
/// every kind, some seconds of work.
const std::string deck = std::string(whirl::test::unbalanced_rotor) + R"([[drive]]
name = "motor"
at = "left:start"
type = "torque"
torque = "3 N.m"
load = { quadratic = "1e-6 N.m.s^2/rad^2" }
[[probe]]
name = "disk"
at = "disk"
[[event]]
name = "swings"
type = "amplitude"
at = "disk"
value = "0.05 mm"
[[step]]
name = "hold"
type = "static"
[[step]]
name = "run_up"
type = "transient"
from = "hold"
duration = "DURATION"
checkpoint = "0.02 s"
METHOD
[output]
every = "0.1 ms"
quantities = ["speed", "probes", "bearing_force", "torque", "energy"]
[output.tracking]
samples = 16
orbit_speeds = ["100 rpm", "150 rpm"]
[output.spectra]
max_frequency = "1000 Hz"
lines = 32
traces = 6
[[output.vtk]]
frames_per_revolution = 1.0
max_frames = 30
content = ["line", "orbits"]
)";

class Resume : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    for (char& c : name)
      if (c == '/') c = '_';
    folder_ =
        fs::temp_directory_path() / ("whirl_resume_" + std::to_string(::getpid()) + "_" + name);
    fs::create_directories(folder_);
    fs::current_path(folder_);
  }
  void TearDown() override {
    fs::current_path("/");
    fs::remove_all(folder_);
  }
  void write_deck(const std::string& file, const std::string& duration,
                  const std::string& more = "", const std::string& integrator = "") {
    std::string text = deck;
    text.replace(text.find("DURATION"), 8, duration);
    text.replace(text.find("METHOD"), 6, integrator);
    std::ofstream(file) << text << more;
  }
  /// Starts `whirl run`; with seconds > 0 sends `signal` after that time. Returns the exit code,
  /// minus the signal when it died of one.
  int run(const std::string& file, const std::string& output, bool resume, double seconds = 0,
          int signal = 0) {
    const pid_t pid = ::fork();
    if (pid == 0) {
      const int log = ::open("log.txt", O_WRONLY | O_CREAT | O_APPEND, 0644);
      ::dup2(log, 1);
      ::dup2(log, 2);
      if (resume)
        ::execl(WHIRL_EXE, WHIRL_EXE, "run", file.c_str(), "-o", output.c_str(), "--resume",
                nullptr);
      else
        ::execl(WHIRL_EXE, WHIRL_EXE, "run", file.c_str(), "-o", output.c_str(), nullptr);
      ::_exit(127);
    }
    if (seconds > 0) {
      std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
      ::kill(pid, signal);
    }
    int status = 0;
    ::waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  /// The list of files grows in the order they are begun, which a kill may change.
  static std::string sorted_lines(const std::string& text) {
    std::istringstream in(text);
    std::set<std::string> lines;
    for (std::string line; std::getline(in, line);)
      lines.insert(line);
    std::string out;
    for (const std::string& line : lines)
      out += line + "\n";
    return out;
  }
  /// Without what it took: of the summary the steps, of the report figures and replay.
  static std::string without_times(const std::string& text, const std::string& extension) {
    std::string kept;
    if (extension == ".json") {
      std::istringstream in(text.substr(0, text.find("\"run time by phase")));
      for (std::string line; std::getline(in, line);)
        if (line.find("\"run time") == std::string::npos &&
            line.find("\"resumed at") == std::string::npos)
          kept += line + "\n";
      return kept;
    }
    for (const std::string tag : {"svg", "script"})
      for (std::size_t from = text.find("<" + tag); from != std::string::npos;
           from = text.find("<" + tag, from + 1)) {
        const std::size_t to = text.find("</" + tag + ">", from);
        kept += text.substr(from, to - from);
      }
    return kept;
  }
  /// Relative path and content of what must not depend on interruptions: all but run times and the
  /// checkpoint's own.
  static std::map<std::string, std::string> files(const fs::path& root) {
    std::map<std::string, std::string> out;
    for (const auto& e : fs::recursive_directory_iterator(root)) {
      const std::string name = fs::relative(e.path(), root).string(),
                        ext = e.path().extension().string();
      if (!e.is_regular_file() || ext == ".whirl" || ext == ".before" || name == "run.json")
        continue;
      const std::string text = read(e.path());
      out[name] = name == "manifest.txt"             ? sorted_lines(text)
                  : ext == ".json" || ext == ".html" ? without_times(text, ext)
                                                     : text;
    }
    return out;
  }
  static void expect_same(const fs::path& a, const fs::path& b) {
    const auto x = files(a), y = files(b);
    for (const auto& [name, content] : x) {
      ASSERT_TRUE(y.count(name)) << name << " is missing";
      EXPECT_TRUE(y.at(name) == content) << name << " differs";
    }
    EXPECT_EQ(x.size(), y.size());
  }
  fs::path folder_;
};

class ResumeScheme : public Resume, public testing::WithParamInterface<const char*> {};

}  // namespace

TEST_P(ResumeScheme, KilledAtRandomTimesEqualsUninterrupted) {
  if (std::string(GetParam()).find("ida") != std::string::npos &&
      !whirl::Plugin::available("sundials"))
    GTEST_SKIP() << "built without SUNDIALS";
  write_deck("d.toml", "0.5 s", "", "integrator = { " + std::string(GetParam()) + " }");
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run("d.toml", "whole", false), 0);
  const double whole =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(
      0.02, 0.5);  // the first cut comes while it runs, also when the machine has become idle
  int code = run("d.toml", "cut", false, share(random) * whole, SIGKILL), cuts = 0;
  for (; code != 0 && cuts < 50; ++cuts) {
    // -SIGINT: it came before the program had a handler for it
    EXPECT_TRUE(code == -SIGKILL || code == -SIGINT || code == 130) << code;
    code = cuts < 4 ? run("d.toml", "cut", true, share(random) * whole, cuts % 2 ? SIGKILL : SIGINT)
                    : run("d.toml", "cut", true);
  }
  ASSERT_EQ(code, 0) << read("log.txt");
  EXPECT_GE(cuts, 1);
  expect_same("whole", "cut");
}

INSTANTIATE_TEST_SUITE_P(Schemes, ResumeScheme,
                         testing::Values("method = \"radau5\"",
                                         "method = \"generalized_alpha\", dt = \"10 us\"",
                                         "method = \"gauss4\"",
                                         "method = \"ida\", tolerance = 1e-2"));

// As many kills as WHIRL_KILLS says (5), each at a random time, run after run: whatever a kill leaves
// is gone on with, and every run that comes to its end has the files of an uninterrupted one.
TEST_F(Resume, RandomKillsLeaveNoTrace) {
  const char* asked = std::getenv("WHIRL_KILLS");
  const int kills = asked ? std::atoi(asked) : 5;
  ASSERT_GT(kills, 0);
  write_deck("d.toml", "0.5 s");
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run("d.toml", "whole", false), 0);
  const double whole =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.02, 0.6);
  int done = 0, runs = 0;
  for (int starts = 0; done < kills && starts < 20 * kills; ++starts) {
    const int code = run("d.toml", "cut", fs::exists("cut"), share(random) * whole, SIGKILL);
    ASSERT_TRUE(code == 0 || code == -SIGKILL) << code << read("log.txt");
    done += code == -SIGKILL;
    if (code != 0) continue;
    expect_same("whole", "cut");
    fs::remove_all("cut");
    fs::remove("log.txt");
    ++runs;
  }
  EXPECT_EQ(done, kills);
  if (fs::exists("cut")) {
    ASSERT_EQ(run("d.toml", "cut", true), 0) << read("log.txt");
    expect_same("whole", "cut");
    ++runs;
  }
  RecordProperty("runs", runs);
}

// Temperatures of films go on where they were, with the rates they had.
TEST_F(Resume, TemperaturesGoOnWhereTheyWere) {
  const std::string hot = R"(type = "journal"
diameter = "100 mm"
length = "50 mm"
clearance = "75 um"
iso_vg = 32
shape = "two_grooves"
heat = { supply_temperature = "45 degC", time_constant = "20 ms" }
)";
  const std::string step = R"([[unbalance]]
at = "mass"
amount = "5000 g.mm"
[[drive]]
at = "body:start"
type = "speed"
speed = { type = "smooth", time = ["0 s", "0.1 s"], value = ["3000 rpm", "4000 rpm"] }
[[step]]
name = "up"
type = "transient"
duration = "0.5 s"
checkpoint = "0.01 s"
)";
  std::ofstream("d.toml") << whirl::test::film_rotor(hot, 4e3, step);
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run("d.toml", "whole", false), 0) << read("log.txt");
  const double whole =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  int code = run("d.toml", "cut", false, 0.6 * whole, SIGKILL), cuts = 0;
  for (; code != 0 && cuts < 20; ++cuts)
    code = cuts < 2 ? run("d.toml", "cut", true, 0.4 * whole, SIGINT) : run("d.toml", "cut", true);
  ASSERT_EQ(code, 0) << read("log.txt");
  expect_same("whole", "cut");
  EXPECT_TRUE(fs::exists("whole/up_film_temperatures.csv"));
}

TEST_F(Resume, LaterEndAndOtherOutputs) {
  write_deck("short.toml", "0.2 s");
  write_deck("long.toml", "0.4 s",
             "points_around = 16\n[[output.vtk]]\nframes = 11\ncontent = [\"bearings\"]\n");
  ASSERT_EQ(run("short.toml", "r", false), 0);
  const std::string before = read("r/run_up.csv");
  ASSERT_EQ(run("long.toml", "r", true), 0) << read("log.txt");
  const std::string after = read("r/run_up.csv");
  EXPECT_EQ(after.substr(0, before.size()), before);
  EXPECT_GT(after.size(), 1.9 * before.size());
  EXPECT_TRUE(fs::exists("r/vtk/run_up_2_bearings.pvd"));
  // and it stays on the track of a run that was meant to last so long: the end of the first part
  // changed some steps
  ASSERT_EQ(run("long.toml", "whole", false), 0);
  // (undamped torsion rings in the spin of a node, as soon out of step as the steps differ: its
  // mean over the last tenth of a second)
  const auto mean_spin = [](const std::string& csv) {
    std::istringstream in(csv);
    double sum = 0, last = 0;
    int count = 0;
    std::string line;
    for (std::getline(in, line); std::getline(in, line);) {
      const std::size_t comma = line.find(',');
      last = std::stod(line);
      if (last > 0.3) {
        sum += std::stod(line.substr(comma + 1));
        ++count;
      }
    }
    EXPECT_EQ(last, 0.4);
    EXPECT_NEAR(count, 1000, 1);
    return sum / count;
  };
  const double a = mean_spin(after), b = mean_spin(read("whole/run_up.csv"));
  EXPECT_NEAR(a, b, 1e-4 * b);  // the tolerance
}

TEST_F(Resume, OtherColumnsKeepTheEarlierFile) {
  write_deck("a.toml", "0.1 s");
  ASSERT_EQ(run("a.toml", "r", false), 0);
  const std::string before = read("r/run_up.csv");
  std::string text = read("a.toml");
  text.replace(text.find("\"0.1 s\""), 7, "\"0.2 s\"");
  text.replace(text.find(", \"energy\""), 10, "");
  std::ofstream("b.toml") << text;
  ASSERT_EQ(run("b.toml", "r", true), 0) << read("log.txt");
  EXPECT_EQ(read("r/run_up.1.csv"), before);
  EXPECT_EQ(read("r/run_up.csv").find("energy"), std::string::npos);
}

TEST_F(Resume, AnotherModelIsRefused) {
  write_deck("a.toml", "0.1 s");
  ASSERT_EQ(run("a.toml", "r", false), 0);
  const auto before = files("r");
  std::string text = read("a.toml");
  text.replace(text.find("\"3 kg\""), 6, "\"4 kg\"");
  std::ofstream("b.toml") << text;
  EXPECT_EQ(run("b.toml", "r", true), 3);
  EXPECT_NE(read("log.txt").find("error[E94]"), std::string::npos) << read("log.txt");
  EXPECT_NE(read("log.txt").find("mass = \"4 kg\""), std::string::npos) << read("log.txt");
  EXPECT_TRUE(files("r") == before);
}

// The checkpoint before a damaged one is used, and what comes of it is what an undisturbed run leaves.
TEST_F(Resume, TheCheckpointBeforeADamagedOneIsUsed) {
  write_deck("d.toml", "0.3 s");
  ASSERT_EQ(run("d.toml", "whole", false), 0);
  ASSERT_TRUE(fs::exists("whole/checkpoint/run_up.whirl.before"));
  const std::string last = read("whole/checkpoint/run_up.whirl");
  std::vector<std::pair<std::string, std::string>> damaged;
  for (const double share : {0.0, 0.001, 0.3, 0.999})
    damaged.emplace_back(std::to_string(share) + " of it",
                         last.substr(0, static_cast<std::size_t>(share * last.size())));
  damaged.emplace_back("without the last byte", last.substr(0, last.size() - 1));
  damaged.emplace_back("another text", "a text that is longer than what a checkpoint begins with");
  for (const std::size_t at : {std::size_t{3}, last.size() / 2, last.size() - 3}) {
    std::string flipped = last;
    flipped[at] ^= 1;
    damaged.emplace_back("byte " + std::to_string(at), flipped);
  }
  for (const auto& [what, content] : damaged) {
    SCOPED_TRACE(what);
    fs::remove_all("r");
    fs::remove("log.txt");
    fs::copy("whole", "r", fs::copy_options::recursive);
    std::ofstream("r/checkpoint/run_up.whirl", std::ios::binary) << content;
    ASSERT_EQ(run("d.toml", "r", true), 0) << read("log.txt");
    const std::string said = read("log.txt");
    EXPECT_NE(said.find("warning: "), std::string::npos) << said;
    EXPECT_NE(said.find("'r/checkpoint/run_up.whirl'"), std::string::npos) << said;
    EXPECT_NE(said.find("'r/checkpoint/run_up.whirl.before'"), std::string::npos) << said;
    expect_same("whole", "r");
    fs::remove("log.txt");
    ASSERT_EQ(run("d.toml", "r", true), 0);
    EXPECT_EQ(read("log.txt").find("warning"), std::string::npos) << read("log.txt");
  }
}

// A kill just after the run has gone on from the earlier one finds that one in its place.
TEST_F(Resume, ALostCheckpointLeavesTheOneBefore) {
  write_deck("d.toml", "0.5 s");
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run("d.toml", "whole", false), 0);
  const double whole =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  int code = run("d.toml", "cut", false, 0.6 * whole, SIGKILL);
  for (int cuts = 0; code != 0 && cuts < 4; ++cuts) {
    const fs::path last = "cut/checkpoint/run_up.whirl";
    if (fs::exists(
            "cut/checkpoint/run_up.whirl.before")) {  // else the kill came before the next one
      // a file of its own: at the kill both names may have been those of one file
      const std::string part = fs::exists(last) ? read(last).substr(0, 100) : std::string();
      fs::remove(last);
      if (cuts % 2 != 0 && !part.empty()) std::ofstream(last, std::ios::binary) << part;
    }
    code = run("d.toml", "cut", true, 0.2 * whole, SIGKILL);
  }
  if (code != 0) code = run("d.toml", "cut", true);
  ASSERT_EQ(code, 0) << read("log.txt");
  expect_same("whole", "cut");
}

TEST_F(Resume, TwoDamagedCheckpointsAreAnError) {
  write_deck("a.toml", "0.3 s");
  ASSERT_EQ(run("a.toml", "r", false), 0);
  const auto before = files("r");
  for (const char* file : {"r/checkpoint/run_up.whirl", "r/checkpoint/run_up.whirl.before"}) {
    std::string c = read(file);
    c[c.size() / 2] ^= 1;
    std::ofstream(file, std::ios::binary) << c;
  }
  EXPECT_EQ(run("a.toml", "r", true), 5);
  const std::string said = read("log.txt");
  EXPECT_NE(said.find("error[E91]: damaged checkpoint"), std::string::npos) << said;
  EXPECT_NE(said.find("run_up.whirl.before', cannot be used either"), std::string::npos) << said;
  EXPECT_TRUE(files("r") == before);

  fs::remove("log.txt");
  fs::remove("r/checkpoint/run_up.whirl.before");
  EXPECT_EQ(run("a.toml", "r", true), 5);
  EXPECT_NE(read("log.txt").find("there is none before it"), std::string::npos);
}

// A run that starts from another one wants its last state, not some earlier one.
TEST_F(Resume, AStartFromAnotherRunTakesNoEarlierState) {
  write_deck("a.toml", "0.3 s");
  ASSERT_EQ(run("a.toml", "r", false), 0);
  std::string text = read("a.toml");
  text.replace(text.find("from = \"hold\""), 13, "previous = \"r\"");
  std::ofstream("b.toml") << text;
  ASSERT_EQ(run("b.toml", "s", false), 0) << read("log.txt");
  fs::resize_file("r/checkpoint/run_up.whirl", 100);
  EXPECT_EQ(run("b.toml", "s", false), 5);
}

// A fresh run removes both.
TEST_F(Resume, ARunAnewLeavesNoEarlierCheckpoint) {
  write_deck("a.toml", "0.3 s");
  ASSERT_EQ(run("a.toml", "r", false), 0);
  EXPECT_NE(read("r/manifest.txt").find("checkpoint/run_up.whirl.before"), std::string::npos);
  std::string text = read("a.toml");
  text.replace(text.find("checkpoint = \"0.02 s\""), 21, "checkpoint = \"0 s\"");
  std::ofstream("b.toml") << text;
  ASSERT_EQ(run("b.toml", "r", false), 0);
  EXPECT_FALSE(fs::exists("r/checkpoint/run_up.whirl"));
  EXPECT_FALSE(fs::exists("r/checkpoint/run_up.whirl.before"));
}

TEST_F(Resume, CheckpointOfAnotherVersionIsAnError) {
  write_deck("a.toml", "0.1 s");
  ASSERT_EQ(run("a.toml", "r", false), 0);
  for (const char* file : {"r/checkpoint/run_up.whirl", "r/checkpoint/run_up.whirl.before"}) {
    if (!fs::exists(file)) continue;  // a fast machine writes one
    std::string c = read(file);
    const std::string head = "whirl checkpoint ";
    ASSERT_EQ(c.substr(0, head.size()), head);
    c[head.size()] = '1';
    std::ofstream(file, std::ios::binary) << c;
  }
  EXPECT_EQ(run("a.toml", "r", true), 5);
  EXPECT_NE(read("log.txt").find("error[E91]"), std::string::npos) << read("log.txt");
  EXPECT_NE(read("log.txt").find("another version"), std::string::npos) << read("log.txt");
}

TEST_F(Resume, WithoutACheckpointStartsAnew) {
  write_deck("a.toml", "0.1 s");
  ASSERT_EQ(run("a.toml", "whole", false), 0);
  ASSERT_EQ(run("a.toml", "r", true), 0);
  EXPECT_NE(read("log.txt").find("no checkpoint in r"), std::string::npos);
  expect_same("whole", "r");
}
