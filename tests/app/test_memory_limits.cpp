// What a run may take of memory and disk: estimates against what runs take, and what is refused.
#include "unbalanced_rotor.hpp"
#include <deck/deck.hpp>
#include <gtest/gtest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <sstream>
#include <thread>

namespace fs = std::filesystem;
using namespace whirl;

namespace {

class MemoryLimits : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = test->name();
    for (char& c : name)
      if (c == '/') c = '_';
    folder_ =
        fs::temp_directory_path() / ("whirl_memory_" + std::to_string(::getpid()) + "_" + name);
    fs::create_directories(folder_);
    fs::current_path(folder_);
  }
  void TearDown() override {
    fs::current_path("/");
    fs::remove_all(folder_);
  }
  static std::string read(const fs::path& p) {
    std::ifstream in(p, std::ios::binary);
    std::ostringstream s;
    s << in.rdbuf();
    return s.str();
  }
  static void write(const std::string& name, const std::string& text) {
    std::ofstream(name, std::ios::binary) << text;
  }
  static pid_t start(const std::vector<std::string>& arguments) {
    const pid_t pid = ::fork();
    if (pid != 0) return pid;
    const int log = ::open("log.txt", O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(log, 1);
    ::dup2(log, 2);
    std::vector<char*> argv{const_cast<char*>(WHIRL_EXE)};
    for (const std::string& a : arguments)
      argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    ::execv(WHIRL_EXE, argv.data());
    ::_exit(127);
  }
  struct Ended {
    int code = 0;
    double megabytes = 0;  ///< most of the memory it had at once
  };
  static Ended wait_for(pid_t pid) {
    int status = 0;
    rusage used{};
    ::wait4(pid, &status, 0, &used);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status),
            static_cast<double>(used.ru_maxrss) * 1024 / 1e6};
  }
  static Ended run(const std::vector<std::string>& arguments) { return wait_for(start(arguments)); }
  /// The shaft of 600 mm in so many elements.
  static std::string rotor(int elements) {
    std::string text = whirl::test::unbalanced_rotor;
    if (elements > 20000)  // more than a deck may ask for of a section
      return text + "[model.mesh]\nmax_element_length = \"" + std::to_string(600.0 / elements) +
             " mm\"\n";
    const std::string half = std::to_string(elements / 2);
    for (std::size_t k = 0; k < 2; ++k)
      text.replace(text.find("20, 3]"), 6, "20, " + half + "]");
    return text;
  }
  fs::path folder_;
};

struct Kind {
  const char* name;
  int elements;
  const char* step;
};
void PrintTo(const Kind& k, std::ostream* out) { *out << k.name << " of " << k.elements; }

class MemoryOfARun : public MemoryLimits, public testing::WithParamInterface<Kind> {};

const char* const speeds = R"(speed = { start = "100 rpm", stop = "3000 rpm", points = 10 }
)";

}  // namespace

// From the size of the program to some hundred megabytes, within what the manual says.
TEST_P(MemoryOfARun, IsEstimated) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer takes more than the program";
#endif
  const Kind& kind = GetParam();
  const std::string name = kind.name;
  std::string text = rotor(kind.elements) + "[output]\nreport = false\n[[step]]\nname = \"s\"\n";
  text += "type = \"" + name.substr(0, name.find(' ')) + "\"\n" + kind.step;
  if (name == "campbell" || name == "stability" || name == "unbalance_response") text += speeds;
  write("d.toml", text);
  const Ended truth = run({"run", "d.toml", "-o", "r", "-q", "-j", "2"});
  ASSERT_EQ(truth.code, 0) << read("log.txt");
  const deck::Deck d = deck::read_deck("d.toml");
  const double said = deck::estimate_memory(d.model, 2).total / 1e6;
  RecordProperty("truth", std::to_string(truth.megabytes));
  RecordProperty("said", std::to_string(said));
  EXPECT_GT(said, 0.7 * truth.megabytes);
  EXPECT_LT(said, 2.0 * truth.megabytes);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, MemoryOfARun,
    testing::Values(
        Kind{"static", 10, ""}, Kind{"static", 3000, ""}, Kind{"modal", 2000, ""},
        Kind{"campbell", 1000, "modes = 8\n"}, Kind{"unbalance_response", 2000, ""},
        Kind{"stability", 1000, ""}, Kind{"critical_speeds", 1000, "max_speed = \"3000 rpm\"\n"},
        Kind{"transient", 1000, "duration = \"1 ms\"\nstart = \"rest\"\n"},
        Kind{"transient gauss", 1000,
             "duration = \"1 ms\"\nstart = \"rest\"\nintegrator = { method = \"gauss4\" }\n"},
        Kind{"transient with pictures", 1000,
             "duration = \"1 ms\"\nstart = \"rest\"\n[[output.vtk]]\nframes = 5\n"}));

TEST_F(MemoryLimits, ARunBeyondThemIsRefused) {
  write("d.toml", rotor(2000) + "[[step]]\nname = \"s\"\ntype = \"static\"\n");
  for (const char* command : {"run", "check", "study"}) {
    EXPECT_EQ(run({command, "d.toml", "--max-memory", "50MB"}).code, 3) << command;
    const std::string said = read("log.txt");
    EXPECT_NE(said.find("error[E44]"), std::string::npos) << said;
    EXPECT_NE(said.find("the limit is 50.0 MB (--max-memory)"), std::string::npos) << said;
  }
  EXPECT_FALSE(fs::exists("results"));
  for (const char* enough : {"1GB", "1 gib", "none", "1000000000"})
    EXPECT_EQ(run({"check", "d.toml", "-q", "--max-memory", enough}).code, 0) << read("log.txt");
  for (const char* no_size : {"8XB", "-1GB", "0", "GB", "", "nan"})
    EXPECT_EQ(run({"check", "d.toml", "--max-memory", no_size}).code, 2) << no_size;
}

// Three million elements were meshed for minutes.
TEST_F(MemoryLimits, AMeshThatDoesNotFitIsNotMade) {
  write("d.toml", rotor(1500000) + "[[step]]\nname = \"s\"\ntype = \"static\"\n");
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(run({"run", "d.toml", "--max-memory", "24GB"}).code, 3);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
  EXPECT_NE(read("log.txt").find("1500004 nodes"), std::string::npos) << read("log.txt");
}

TEST_F(MemoryLimits, MeshingHearsThatItShallStop) {
  write("d.toml", rotor(300000) + "[[step]]\nname = \"s\"\ntype = \"static\"\n");
  const pid_t pid = start({"run", "d.toml", "--max-memory", "none"});
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto begin = std::chrono::steady_clock::now();
  ::kill(pid, SIGTERM);
  EXPECT_EQ(wait_for(pid).code, 130) << read("log.txt");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

TEST_F(MemoryLimits, AnOutputBeyondThemIsRefused) {
  write("d.toml", rotor(10) + R"([[step]]
type = "transient"
start = "rest"
duration = "10 s"
[output]
every = "10 us"
)");
  for (const char* command : {"run", "check"}) {
    EXPECT_EQ(run({command, "d.toml", "--max-disk", "100MB"}).code, 3);
    const std::string said = read("log.txt");
    EXPECT_NE(said.find("error[E33]"), std::string::npos) << said;
    EXPECT_NE(said.find("the limit is 100.0 MB (--max-disk)"), std::string::npos) << said;
  }
  EXPECT_EQ(run({"check", "d.toml", "-q", "--max-disk", "1GB"}).code, 0) << read("log.txt");
}

TEST_F(MemoryLimits, ASweepBeyondThemIsRefused) {
  write("d.toml", rotor(10) + "[[step]]\nname = \"m\"\ntype = \"modal\"\n");
  std::vector<std::string> sweep{"sweep",      "d.toml",
                                 "-o",         "s",
                                 "--vary",     "disk.disk.mass=uniform(2 kg, 4 kg)",
                                 "--response", "f=m_modes:frequency:1",
                                 "--samples"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = sweep;
    all.insert(all.end(), more.begin(), more.end());
    return run(all).code;
  };
  EXPECT_EQ(with({"1000000000"}), 3);
  std::string said = read("log.txt");
  EXPECT_NE(said.find("error[E44]: the sweep would take about 1.5 TB of memory (the table of "
                      "1000000000 runs: 1.5 TB)"),
            std::string::npos)
      << said;
  EXPECT_EQ(with({"10", "-j", "4", "--max-memory", "50MB"}), 3);
  said = read("log.txt");
  EXPECT_NE(said.find("4 processes"), std::string::npos) << said;
  EXPECT_EQ(with({"100000", "--max-disk", "5MB"}), 3);
  said = read("log.txt");
  EXPECT_NE(said.find("error[E33]: the sweep would write about 10.2 MB"), std::string::npos)
      << said;
  EXPECT_FALSE(fs::exists("s"));
  EXPECT_EQ(with({"3", "-q", "--max-memory", "1GB", "--max-disk", "5MB"}), 0) << read("log.txt");
}

// A run of a sweep whose keys make it larger than its share has a row that says so.
TEST_F(MemoryLimits, ARunOfASweepHasItsShare) {
  write("d.toml",
        rotor(10) + "[[step]]\nname = \"m\"\ntype = \"modal\"\n[output]\nreport = false\n");
  EXPECT_EQ(
      run({"sweep", "d.toml", "-o", "s", "-q", "-j", "1", "--max-memory", "100MB", "--vary",
           "model.mesh.min_elements_per_section=4,4000", "--response", "f=m_modes:frequency:1"})
          .code,
      0)
      << read("log.txt");
  const std::string rows = read("s/sweep.csv");
  EXPECT_NE(rows.find("E44"), std::string::npos) << rows;
}
