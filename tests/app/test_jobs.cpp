// `--jobs`: every file that holds numbers is the same, byte for byte, for any number of threads.
#include "deck_run.hpp"
#include "oil_whirl_rotor.hpp"
#include "unbalanced_rotor.hpp"

#include <algorithm>
#include <string_view>

namespace fs = std::filesystem;

namespace whirl::test {
namespace {

constexpr const char* steps_of_linear_supports = R"([parameters]
damping = "200 N.s/m"
[[bearing]]
name = "damper"
at = "disk"
type = "linear"
kyy = "1e3 N/m"
kyz = "2e4 N/m"
kzy = "-2e4 N/m"
cyy = "${damping}"
[[probe]]
name = "P"
at = "disk"
[[probe]]
name = "Q"
at = "left:start"
[[step]]
name = "lines"
type = "campbell"
speed = { start = "0 rpm", stop = "12000 rpm", points = 17 }
modes = 7
[[step]]
name = "onset"
type = "stability"
speed = { start = "500 rpm", stop = "12000 rpm", points = 13 }
modes = 6
map = { parameter = "damping", values = ["100 N.s/m", "200 N.s/m", "400 N.s/m"] }
[[step]]
name = "critical"
type = "critical_speeds"
max_speed = "15000 rpm"
[[step]]
name = "map"
type = "critical_map"
stiffness_min = "1e5 N/m"
stiffness_max = "1e9 N/m"
points = 11
max_speed = "20000 rpm"
[[step]]
name = "response"
type = "unbalance_response"
speed = { start = "500 rpm", stop = "12000 rpm", points = 90 }
[[step]]
name = "at_frequencies"
type = "harmonic_response"
rotor_speed = "3000 rpm"
frequency = { start = "1 Hz", stop = "200 Hz", points = 150 }
[[step.force]]
at = "disk"
force = ["0 N", "10 N", "0 N"]
whirl = "forward"
[[step]]
name = "at_speeds"
type = "harmonic_response"
order = 2
speed = { start = "500 rpm", stop = "6000 rpm", points = 70 }
[[step.force]]
at = "disk"
force = ["0 N", "10 N", "0 N"]
)";
constexpr const char* steps_of_films = R"([[unbalance]]
at = "disk1"
amount = "60 g.mm"
[[step]]
name = "lines"
type = "campbell"
speed = { start = "1500 rpm", stop = "9000 rpm", points = 12 }
modes = 4
[[step]]
name = "onset"
type = "stability"
speed = { start = "1500 rpm", stop = "12000 rpm", points = 12 }
[[step]]
name = "response"
type = "unbalance_response"
speed = { start = "1500 rpm", stop = "9000 rpm", points = 40 }
)";

/// Five kinds that need nothing of one another.
constexpr const char* independent_steps = R"([[probe]]
name = "P"
at = "disk"
[[step]]
name = "turned"
type = "transient"
start = "static"
initial_speed = "3000 rpm"
duration = "0.1 s"
[[step]]
name = "still"
type = "static"
speed = "1000 rpm"
[[step]]
name = "shapes"
type = "modal"
speed = "3000 rpm"
[[step]]
name = "lines"
type = "campbell"
speed = { start = "0 rpm", stop = "12000 rpm", points = 17 }
[[step]]
name = "response"
type = "unbalance_response"
speed = { start = "500 rpm", stop = "12000 rpm", points = 60 }
)";
/// Two chains and one step that needs nothing, in no order.
constexpr const char* chained_steps = R"([[probe]]
name = "P"
at = "disk"
[[step]]
name = "still"
type = "static"
speed = "1000 rpm"
[[step]]
name = "begun"
type = "transient"
start = "rest"
initial_speed = "3000 rpm"
duration = "0.05 s"
[[step]]
name = "loaded"
type = "transient"
from = "still"
duration = "0.03 s"
[[step]]
name = "shapes"
type = "modal"
speed = "3000 rpm"
[[step]]
name = "goes_on"
type = "transient"
from = "begun"
duration = "0.03 s"
[[step]]
name = "goes_on_too"
type = "transient"
from = "begun"
duration = "0.02 s"
[[step]]
name = "last"
type = "transient"
from = "goes_on"
duration = "0.02 s"
)";
/// The third step fails; the fourth takes longer than all before it.
constexpr const char* failing_steps = R"([[probe]]
name = "P"
at = "disk"
[[step]]
name = "shapes"
type = "modal"
speed = "3000 rpm"
[[step]]
name = "begun"
type = "transient"
start = "rest"
initial_speed = "3000 rpm"
duration = "0.1 s"
[[step]]
name = "unknown"
type = "transient"
start = "mode"
mode = 900
duration = "0.1 s"
[[step]]
name = "later"
type = "transient"
start = "rest"
initial_speed = "3000 rpm"
duration = "20 s"
[[step]]
name = "response"
type = "unbalance_response"
speed = { start = "500 rpm", stop = "12000 rpm", points = 60 }
)";

/// Without what says how long something took.
std::string without_times(const std::string& text) {
  std::istringstream in(text);
  std::string out, line;
  bool in_times = false;
  while (std::getline(in, line)) {
    const bool times = line.find("run time") != std::string::npos;
    if (times && line.ends_with("{")) in_times = true;
    if (!times && !in_times) out += line + "\n";
    if (in_times && line.find('}') != std::string::npos) in_times = false;
  }
  for (const std::string_view unit : {" s CPU", " s wall"})
    for (std::size_t at = out.find(unit); at != std::string::npos; at = out.find(unit, at + 1)) {
      const std::size_t number = out.rfind(' ', at - 1) + 1;
      out.erase(number, at - number);
      at = number;
    }
  return out;
}

/// What the page shows of the steps: not the times at its head, nor the summary.
std::string sections_of(const std::string& page) {
  const std::size_t begin = page.find("<section");
  return without_times(page.substr(begin, page.find("<summary>Run summary") - begin));
}

class Jobs : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = test->name();
    std::replace(name.begin(), name.end(), '/', '_');
    folder_ = fs::temp_directory_path() / ("whirl_jobs_" + name + "_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override {
    std::error_code ec;
    fs::remove_all(folder_, ec);
  }
  /// Exit code.
  int run(int jobs) { return run("o" + std::to_string(jobs), "--jobs " + std::to_string(jobs)); }
  int run(const std::string& output, const std::string& options,
          const std::string& environment = {}) {
    const std::string command = "cd '" + folder_.string() + "' && " + environment +
                                " '" WHIRL_EXE "' run d.toml -o " + output + " " + options +
                                " >log.txt 2>&1 </dev/null";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  /// Files of numbers of one folder that are not the same, byte for byte, in another; how many there
  /// are at all.
  std::vector<std::string> unlike(const std::string& a, const std::string& b, int& files) const {
    std::vector<std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / a)) {
      const std::string extension = entry.path().extension();
      if (extension != ".csv" && extension != ".svg") continue;
      const fs::path name = fs::relative(entry.path(), folder_ / a);
      ++files;
      if (read(a / name) != read(b / name)) out.push_back(name.string());
    }
    return out;
  }
  std::string read(const fs::path& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
    return text.str();
  }
  fs::path folder_;
};

TEST_P(Jobs, AnyNumberOfThreadsGivesTheSameBytes) {
  const bool films = std::string_view(GetParam()) == "films";
  std::ofstream(folder_ / "d.toml")
      << (films ? oil_whirl_rotor(steps_of_films)
                : std::string(unbalanced_rotor) + steps_of_linear_supports);
  ASSERT_EQ(run(1), 0) << read("log.txt");
  int files = 0;
  for (const int jobs : {2, 5}) {
    ASSERT_EQ(run(jobs), 0) << read("log.txt");
    const std::string other = "o" + std::to_string(jobs);
    EXPECT_EQ(unlike("o1", other, files), std::vector<std::string>()) << jobs << " threads";
  }
  EXPECT_GE(files, films ? 10 : 20);
}

class StepsSideBySide : public Jobs {
 protected:
  void write(const char* steps) {
    std::ofstream(folder_ / "d.toml") << std::string(unbalanced_rotor) + steps;
  }
  std::vector<std::string> names_in(const std::string& output) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / output))
      names.push_back(fs::relative(entry.path(), folder_ / output).string());
    std::sort(names.begin(), names.end());
    return names;
  }
  static std::string with_name(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at))
      text.replace(at, from.size(), to);
    return text;
  }
  /// Runs with any number of threads; everything but times is that of one thread.
  void expect_same(int exit) {
    ASSERT_EQ(run(1), exit) << read("log.txt");
    const std::string said = without_times(read("log.txt"));
    int files = 0;
    for (const int jobs : {2, 3, 8}) {
      ASSERT_EQ(run(jobs), exit) << read("log.txt");
      const std::string other = "o" + std::to_string(jobs);
      EXPECT_EQ(unlike("o1", other, files), std::vector<std::string>()) << jobs << " threads";
      EXPECT_EQ(names_in("o1"), names_in(other));
      EXPECT_EQ(read("o1/manifest.txt"), read(other + "/manifest.txt"));
      EXPECT_EQ(with_name(without_times(read("log.txt")), other, "o1"), said);
      EXPECT_EQ(without_times(read(other + "/summary.json")),
                without_times(read("o1/summary.json")));
      EXPECT_TRUE(sections_of(read(other + "/report.html")) == sections_of(read("o1/report.html")))
          << jobs << " threads";
    }
    EXPECT_GE(files, 15);
  }
};

TEST_P(StepsSideBySide, AreAsOneAfterTheOther) {
  const bool chained = std::string_view(GetParam()) == "chained";
  write(chained ? chained_steps : independent_steps);
  expect_same(0);
}

INSTANTIATE_TEST_SUITE_P(Decks, StepsSideBySide, testing::Values("independent", "chained"),
                         [](const auto& info) { return std::string(info.param); });

using FailingStep = StepsSideBySide;

// Steps after it run at the same time: they are ended, and nothing of them stays.
TEST_P(FailingStep, IsTheLastThatIsHeardOf) {
  write(failing_steps);
  expect_same(4);
  EXPECT_EQ(read("o8/summary.json").find("\"later\""), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Decks, FailingStep, testing::Values("failing"),
                         [](const auto& info) { return std::string(info.param); });

// A processor without AVX2 is played by what hides it from the program and from the C library.
TEST_P(Jobs, AnyProcessorGivesTheSameBytes) {
  const bool films = std::string_view(GetParam()) == "films";
  const std::string run_up = R"([[drive]]
name = "motor"
at = "left:start"
type = "torque"
torque = "40 N.m"
[[step]]
name = "run_up"
type = "transient"
start = "rest"
duration = "0.02 s"
)";
  const std::string response = R"([[unbalance]]
at = "disk1"
amount = "60 g.mm"
[[step]]
name = "response"
type = "unbalance_response"
speed = { start = "1500 rpm", stop = "9000 rpm", points = 5 }
)";
  std::ofstream(folder_ / "d.toml")
      << (films ? oil_whirl_rotor(response) : std::string(unbalanced_rotor) + run_up);
  const std::string plain =
      "WHIRL_ISA=baseline GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-AVX,-FMA,-FMA4,-AVX512F,-AVX512VL";
  ASSERT_EQ(run("here", "--reproducible"), 0) << read("log.txt");
  ASSERT_EQ(run("old", "", plain), 0) << read("log.txt");
  ASSERT_EQ(run("forced", "--reproducible", "WHIRL_ISA=avx2"), 0) << read("log.txt");
  int files = 0;
  EXPECT_EQ(unlike("here", "old", files), std::vector<std::string>());
  EXPECT_EQ(unlike("here", "forced", files), std::vector<std::string>());
  EXPECT_GE(files, 4);
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return;
  ASSERT_EQ(run("fast", ""), 0) << read("log.txt");
  EXPECT_NE(unlike("here", "fast", files), std::vector<std::string>()) << "nothing was chosen";
#endif
}

INSTANTIATE_TEST_SUITE_P(Machines, Jobs, testing::Values("linear", "films"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace whirl::test
