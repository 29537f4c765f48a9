// `--jobs`: every file that holds numbers is the same, byte for byte, for any number of threads.
#include "deck_run.hpp"
#include "oil_whirl_rotor.hpp"
#include "unbalanced_rotor.hpp"

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
  int run(int jobs) {
    const std::string command = "cd '" + folder_.string() + "' && '" WHIRL_EXE "' run d.toml -o o" +
                                std::to_string(jobs) + " --jobs " + std::to_string(jobs) +
                                " >log.txt 2>&1 </dev/null";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
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
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "o1")) {
      const std::string extension = entry.path().extension();
      if (extension != ".csv" && extension != ".svg") continue;
      const fs::path name = fs::relative(entry.path(), folder_ / "o1");
      EXPECT_EQ(read("o1" / name), read(fs::path("o" + std::to_string(jobs)) / name))
          << name << ", " << jobs << " threads";
      ++files;
    }
  }
  EXPECT_GE(files, films ? 10 : 20);
}

INSTANTIATE_TEST_SUITE_P(Machines, Jobs, testing::Values("linear", "films"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace whirl::test
