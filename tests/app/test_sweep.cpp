// `whirl sweep` as a user calls it: its table against single runs, for any number of processes and
// shards, after being cut off, and with runs that fail.
#include "deck_run.hpp"
#include "unbalanced_rotor.hpp"
#include <core/plugin.hpp>
#include <io/results.hpp>

#include <fcntl.h>
#include <cmath>
#include <sys/file.h>

namespace fs = std::filesystem;

namespace whirl::test {
namespace {

constexpr const char* steps = R"([[step]]
name = "c"
type = "critical_speeds"
max_speed = "20000 rpm"
[[step]]
name = "r"
type = "unbalance_response"
speed = { start = "500 rpm", stop = "9000 rpm", points = 20 }
[[probe]]
name = "P"
at = "disk"
)";
constexpr const char* asked =
    " --vary disk.disk.mass=2kg:4kg:3 --vary 'bearing.A.kyy=uniform(1e6 N/m, 4e6 N/m)' --samples 4 "
    "--response 'first=c_undamped:speed:1' --response 'peak=r_response:P major:max'";

class Sweep : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("whirl_sweep_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    std::ofstream(folder_ / "d.toml") << unbalanced_rotor << steps;
  }
  void TearDown() override {
    std::error_code ec;
    fs::remove_all(folder_, ec);
  }
  int whirl(const std::string& arguments) {
    const int status = std::system(("cd '" + folder_.string() + "' && '" WHIRL_EXE "' " +
                                    arguments + " >log.txt 2>&1 </dev/null")
                                       .c_str());
    log_ = read("log.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / name, std::ios::binary).rdbuf();
    return text.str();
  }
  fs::path folder_;
  std::string log_;
};

TEST_F(Sweep, TableIsThatOfSingleRuns) {
  ASSERT_EQ(whirl(std::string("sweep d.toml -o s") + asked), 0) << log_;
  const Columns table(folder_ / "s/sweep.csv");
  ASSERT_EQ(table.rows.size(), 12u);
  for (const std::size_t k : {0u, 5u, 11u}) {
    const auto row = table.named(table.rows[k]);
    EXPECT_EQ(row.at("run [-]"), static_cast<double>(k));
    char sets[200];
    std::snprintf(sets, sizeof sets,
                  "--set 'disk.disk.mass=%.17g kg' --set 'bearing.A.kyy=%.17g N/m'",
                  row.at("disk.disk.mass [kg]"), row.at("bearing.A.kyy [N/m]"));
    ASSERT_EQ(whirl("run d.toml -q -o one " + std::string(sets)), 0) << log_;
    const Columns criticals(folder_ / "one/c_undamped.csv");
    EXPECT_EQ(criticals.rows[0][criticals.column("speed [rpm]")], row.at("first [rpm]"));
    const Columns response(folder_ / "one/r_response.csv");
    double peak = 0;
    for (std::size_t c = 0; c < response.names.size(); ++c)
      if (response.names[c].starts_with("P major ["))
        for (const auto& r : response.rows)
          peak = std::max(peak, r[c]);
    EXPECT_GT(peak, 0);
    EXPECT_EQ(peak, row.at(table.names[table.column("first [rpm]") + 2]));
  }
  for (const char* file : {"statistics.csv", "effects.csv", "summary.json", "sweep.html"})
    EXPECT_FALSE(read(std::string("s/") + file).empty()) << file;
}

TEST_F(Sweep, SameTableForProcessesShardsAndAfterACut) {
  ASSERT_EQ(whirl(std::string("sweep d.toml -j1 -o one") + asked), 0) << log_;
  const std::string table = read("one/sweep.csv");
  ASSERT_EQ(whirl(std::string("sweep d.toml -j3 -o three") + asked), 0) << log_;
  EXPECT_EQ(read("three/sweep.csv"), table);
  for (int k = 1; k <= 5; ++k) {
    ASSERT_EQ(whirl("sweep d.toml -j1 -o shards --shard " + std::to_string(k) + "/5" + asked), 0)
        << log_;
    EXPECT_EQ(fs::exists(folder_ / "shards/sweep.csv"), k == 5);
  }
  EXPECT_EQ(read("shards/sweep.csv"), table);
  const fs::path rows = folder_ / "one/shard_1_of_1/rows.tsv";
  fs::resize_file(rows, fs::file_size(rows) / 2);
  fs::remove(folder_ / "one/sweep.csv");
  ASSERT_EQ(whirl(std::string("sweep d.toml -j2 --resume -o one") + asked), 0) << log_;
  EXPECT_EQ(read("one/sweep.csv"), table);
}

TEST_F(Sweep, AFailedRunIsARow) {
  ASSERT_EQ(whirl("sweep d.toml -o s --vary 'disk.disk.mass=3 kg,-1 kg,4 kg' --response "
                  "'first=c_undamped:speed:1' --response 'none=c_undamped:speed:99'"),
            4)  // no run gave the second response
      << log_;
  const Columns table(folder_ / "s/sweep.csv");
  ASSERT_EQ(table.rows.size(), 3u);
  const auto first = table.column("first [rpm]"), exit = table.column("exit [-]");
  EXPECT_EQ(table.rows[0][exit], 0);
  EXPECT_EQ(table.rows[1][exit], 3);
  EXPECT_TRUE(std::isnan(table.rows[1][first]));
  EXPECT_GT(table.rows[0][first], table.rows[2][first]);
  EXPECT_NE(read("s/sweep.csv").find("no row 99"), std::string::npos);
  EXPECT_NE(log_.find("1 of 3 runs failed"), std::string::npos) << log_;
}

TEST_F(Sweep, WorstRunsAreMadeAgainWithTheirReports) {
  ASSERT_EQ(whirl(std::string("sweep d.toml -j1 -o s --worst peak:2 --worst first:least:1 "
                              "--exceed 'peak>1e-9'") +
                  asked),
            0)
      << log_;
  const Columns table(folder_ / "s/sweep.csv");
  const std::size_t peak = table.column("first [rpm]") + 2;
  std::size_t worst = 0;
  for (std::size_t k = 1; k < table.rows.size(); ++k)
    if (table.rows[k][peak] > table.rows[worst][peak]) worst = k;
  char name[64];
  std::snprintf(name, sizeof name, "worst/run_%06zu/report.html", worst);
  EXPECT_TRUE(fs::exists(folder_ / "s" / name)) << name;
  EXPECT_NE(read("s/sweep.html").find(name), std::string::npos);
  std::size_t folders = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_ / "s/worst"))
    ++folders;
  EXPECT_GE(folders, 2u);
  EXPECT_LE(folders, 3u);
  EXPECT_EQ(Columns(folder_ / "s/probabilities.csv").last().at("probability [-]"), 1.0);
}

TEST_F(Sweep, RunsOfAFile) {
  std::ofstream(folder_ / "runs.csv") << "disk.disk.mass [kg],bearing.A.kyy [N/m]\n2,1e6\n4,3e6\n";
  ASSERT_EQ(whirl("sweep d.toml -o s --vary @runs.csv --response c_undamped:speed:1"), 0) << log_;
  const Columns table(folder_ / "s/sweep.csv");
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.named(table.rows[1]).at("bearing.A.kyy [N/m]"), 3e6);
}

TEST_F(Sweep, DeckSaysWhatTheCommandLineDoesNot) {
  std::ofstream(folder_ / "s.toml") << unbalanced_rotor << steps << R"deck([sweep]
vary = ["disk.disk.mass=2kg:4kg:3", "bearing.A.kyy=uniform(1e6 N/m, 4e6 N/m)"]
response = ["first=c_undamped:speed:1", "peak=r_response:P major:max"]
samples = 4
exceed = ["peak > 0"]
)deck";
  ASSERT_EQ(whirl("sweep s.toml -o deck"), 0) << log_;
  ASSERT_EQ(whirl(std::string("sweep d.toml -o line") + asked), 0) << log_;
  EXPECT_EQ(read("deck/sweep.csv"), read("line/sweep.csv"));
  EXPECT_FALSE(read("deck/probabilities.csv").empty());
  ASSERT_EQ(whirl("sweep s.toml -o other --seed 2 --samples 2"), 0) << log_;
  EXPECT_EQ(Columns(folder_ / "other/sweep.csv").rows.size(), 6u);
  ASSERT_EQ(whirl("run s.toml -q -o run"), 0) << log_;
  ASSERT_EQ(whirl("sweep run/resolved.toml -o resolved"), 0) << log_;
  EXPECT_EQ(read("resolved/sweep.csv"), read("deck/sweep.csv"));
}

TEST_F(Sweep, CorrelatedSensitiveAndLimitedKeysOfTheDeck) {
  std::ofstream(folder_ / "s.toml") << unbalanced_rotor << steps << R"deck([sweep]
vary = ["bearing.B.kyy=uniform(1e6 N/m, 4e6 N/m)", "bearing.A.kyy=uniform(1e6 N/m, 4e6 N/m)"]
response = ["first=c_undamped:speed:1"]
samples = 4
seed = 3
sampling = "random"
correlation = ["bearing.A.kyy,bearing.B.kyy=0.999999"]
worst = ["first:least:1"]
limit = "100 s"
)deck";
  ASSERT_EQ(whirl("sweep s.toml -o s"), 0) << log_;
  const Columns table(folder_ / "s/sweep.csv");
  for (const auto& row : table.rows)
    EXPECT_NEAR(table.named(row).at("bearing.A.kyy [N/m]"),
                table.named(row).at("bearing.B.kyy [N/m]"), 1e4);
  EXPECT_TRUE(fs::exists(folder_ / "s/worst"));
  ASSERT_EQ(whirl("sweep s.toml -o t --sampling morris --set 'sweep.correlation=[]'"), 0) << log_;
  EXPECT_EQ(Columns(folder_ / "t/sensitivity.csv").rows.size(), 2u);
}

TEST_F(Sweep, TasksOfASlurmArrayShareAFolder) {
  const std::string script = WHIRL_SOURCE "/examples/sweep_on_slurm.sh";
  for (int task = 1; task <= 3; ++task) {
    const std::string environment = "SLURM_ARRAY_TASK_ID=" + std::to_string(task) +
                                    " SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_COUNT=3 "
                                    "SLURM_CPUS_PER_TASK=1 WHIRL='" WHIRL_EXE "'";
    const std::string command = "cd '" + folder_.string() + "' && " + environment + " bash '" +
                                script + "' d.toml -o s" + asked + " >log.txt 2>&1 </dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0) << read("log.txt");
    EXPECT_EQ(fs::exists(folder_ / "s/sweep.csv"), task == 3);
  }
  ASSERT_EQ(whirl(std::string("sweep d.toml -j1 -o one") + asked), 0) << log_;
  EXPECT_EQ(read("s/sweep.csv"), read("one/sweep.csv"));
  EXPECT_EQ(whirl("sweep d.toml -o s --shard auto" + std::string(asked)), 2) << log_;
}

/// Open MPI's mpirun, also for root and with more ranks than processors.
std::string mpirun(int ranks, const std::string& arguments) {
  return "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n " +
         std::to_string(ranks) + " '" WHIRL_EXE "' " + arguments;
}

bool has_mpi() {
  return std::system("'" WHIRL_EXE "' version | grep -q mpi && command -v mpirun >/dev/null") == 0;
}

TEST_F(Sweep, RanksOfMpirunGiveTheSameTable) {
  if (!has_mpi()) GTEST_SKIP() << "needs the component mpi and mpirun";
  ASSERT_EQ(whirl(std::string("sweep d.toml -j1 -o one") + asked), 0) << log_;
  for (const int ranks : {2, 4}) {
    const std::string out = "ranks" + std::to_string(ranks);
    const std::string command = "cd '" + folder_.string() + "' && " +
                                mpirun(ranks, "sweep d.toml -o " + out + asked) +
                                " >log.txt 2>&1 </dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0) << read("log.txt");
    EXPECT_EQ(read(out + "/sweep.csv"), read("one/sweep.csv")) << ranks;
  }
  const std::string wrong = "cd '" + folder_.string() + "' && " +
                            mpirun(3,
                                   "sweep d.toml -o wrong --vary disk.nobody.mass=2kg "
                                   "--response 'first=c_undamped:speed:1'") +
                            " >log.txt 2>&1 </dev/null";
  EXPECT_NE(std::system(wrong.c_str()), 0);
  EXPECT_NE(read("log.txt").find("nobody"), std::string::npos) << read("log.txt");
}

TEST_F(Sweep, AKilledRankCostsNoFinishedRun) {
  if (!has_mpi()) GTEST_SKIP() << "needs the component mpi and mpirun";
  const std::string many =
      std::string(asked).replace(std::string(asked).find("--samples 4"), 11, "--samples 40");
  ASSERT_EQ(whirl("sweep d.toml -j2 -o one" + many), 0) << log_;
  const std::string kill =
      "cd '" + folder_.string() + "' || exit 1\n" + mpirun(3, "sweep d.toml -o cut" + many) +
      " >log.txt 2>&1 </dev/null &\nm=$!\n"
      "rows=cut/shard_1_of_1/rows.tsv\n"
      "while kill -0 $m 2>/dev/null && ! { [ -e $rows ] && [ $(wc -l < $rows) -ge 5 ]; }; do sleep "
      "0.02; done\n"
      "for s in /proc/[0-9]*/status; do grep -q \"^PPid:[[:space:]]*$m$\" $s 2>/dev/null && "
      "r=$(basename $(dirname $s)); done\n"
      "kill -9 $r || exit 1\nwait $m && exit 1\nexit 0\n";
  std::ofstream(folder_ / "kill.sh") << kill;
  ASSERT_EQ(std::system(("bash '" + (folder_ / "kill.sh").string() + "'").c_str()), 0)
      << read("log.txt");
  ASSERT_FALSE(fs::exists(folder_ / "cut/sweep.csv"));
  ASSERT_EQ(whirl("sweep d.toml -j2 --resume -o cut" + many), 0) << log_;
  EXPECT_EQ(log_.find("120 of 120"), std::string::npos) << log_;  // some were there
  EXPECT_EQ(read("cut/sweep.csv"), read("one/sweep.csv"));
}

TEST_F(Sweep, NumbersInHdf5AreThoseOfTheTable) {
  if (!Plugin::available("hdf5") && std::system("'" WHIRL_EXE "' version | grep -q hdf5") != 0)
    GTEST_SKIP() << "needs the component hdf5";
  ASSERT_EQ(whirl(std::string("sweep d.toml -o s --hdf5") + asked), 0) << log_;
  const io::Columns binary = io::read_hdf5(folder_ / "s/sweep.h5");
  const io::Columns text = io::read_csv(folder_ / "s/sweep.csv");
  for (const char* name : {"run", "disk.disk.mass", "first", "peak", "exit"})
    EXPECT_EQ(binary[name], text[name]) << name;
  EXPECT_EQ(binary.rows(), 12u);
}

// Another sweep is at the folder: it keeps its rows, and this one does not begin.
TEST_F(Sweep, AFolderThatIsSweptIsLeftAlone) {
  ASSERT_EQ(whirl(std::string("sweep d.toml -o s") + asked), 0) << log_;
  const std::string rows = read("s/shard_1_of_1/rows.tsv");
  ASSERT_FALSE(rows.empty());
  const std::string lock = (folder_ / "s/shard_1_of_1/.whirl.lock").string();
  const int other = ::open(lock.c_str(), O_RDWR | O_CREAT, 0666);
  ASSERT_GE(other, 0);
  ASSERT_EQ(::flock(other, LOCK_EX | LOCK_NB), 0);
  EXPECT_EQ(whirl("sweep d.toml -o s --vary disk.disk.mass=1kg:2kg:2 --response "
                  "first=c_undamped:speed:1"),
            5)
      << log_;
  EXPECT_NE(log_.find("E97"), std::string::npos) << log_;
  EXPECT_EQ(read("s/shard_1_of_1/rows.tsv"), rows);
  // nor one of all runs, which would take the shards away
  fs::create_directories(folder_ / "s/shard_2_of_3");
  EXPECT_EQ(whirl("sweep d.toml -o s --shard 1/3" + std::string(asked)), 0) << log_;
  ::close(other);
  const std::string second = (folder_ / "s/shard_1_of_3/.whirl.lock").string();
  const int shard = ::open(second.c_str(), O_RDWR | O_CREAT, 0666);
  ASSERT_EQ(::flock(shard, LOCK_EX | LOCK_NB), 0);
  EXPECT_EQ(whirl(std::string("sweep d.toml -o s") + asked), 5) << log_;
  EXPECT_TRUE(fs::exists(folder_ / "s/shard_1_of_3/rows.tsv"));
  ::close(shard);
}

// Nothing goes, and nothing is written, that is not the sweep's own.
TEST_F(Sweep, TheUsersFilesStay) {
  const std::vector<std::string> own{"s/shard_holder/notes.txt", "s/worst/notes.txt",
                                     "s/worst/run_about.txt", "s/runs/000000/notes.txt"};
  for (const std::string& file : own) {
    fs::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file) << "mine";
  }
  fs::create_directories(folder_ / "elsewhere");
  std::ofstream(folder_ / "elsewhere/notes.txt") << "mine";
  fs::create_directory_symlink(folder_ / "elsewhere", folder_ / "s/runs/000001");
  for (int round = 0; round < 2; ++round) {
    ASSERT_EQ(whirl("sweep d.toml -o s --keep --worst first:1 --vary disk.disk.mass=1kg:2kg:3 "
                    "--response first=c_undamped:speed:1"),
              0)
        << log_;
    for (const std::string& file : own)
      EXPECT_EQ(read(file), "mine") << file;
    EXPECT_EQ(read("elsewhere/notes.txt"), "mine");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "elsewhere"), {}), 1);
  }
  EXPECT_NE(log_.find("symbolic link"), std::string::npos) << log_;
}

// Half of the runs, a thousandth of the distribution, have a negative mass and fail.
TEST_F(Sweep, ProbabilitiesOfWeightedSamplesLieWithinTheirBounds) {
  ASSERT_EQ(
      whirl("sweep d.toml -o s --vary 'disk.disk.mass=normal(3 kg, 1 kg) drawn normal(0 kg, 3 kg)' "
            "--samples 60 --sampling random --response 'first=c_undamped:speed:1' --exceed "
            "'first>0'"),
      0)
      << log_;
  const auto p = Columns(folder_ / "s/probabilities.csv").last();
  EXPECT_DOUBLE_EQ(p.at("probability [-]"), 1.0);
  EXPECT_GT(p.at("runs without a value [-]"), 20);
  EXPECT_GT(p.at("at least [-]"), 0.95);
  EXPECT_DOUBLE_EQ(p.at("at most [-]"), 1.0);
}

TEST_F(Sweep, ProbabilitiesOfSamplesThatMissTheirDistributionAreWithheld) {
  ASSERT_EQ(whirl("sweep d.toml -o s --vary 'disk.disk.mass=normal(3 kg, 0.1 kg) drawn normal(4 "
                  "kg, 0.1 kg)' "
                  "--samples 20 --sampling random --response 'first=c_undamped:speed:1' --exceed "
                  "'first>0'"),
            0)
      << log_;
  const auto p = Columns(folder_ / "s/probabilities.csv").last();
  EXPECT_TRUE(std::isnan(p.at("probability [-]")));
  EXPECT_LT(p.at("at least [-]"), 0.5);
  EXPECT_DOUBLE_EQ(p.at("at most [-]"), 1.0);
  EXPECT_NE(read("s/probabilities.csv").find("may lie on either side"), std::string::npos);
  EXPECT_NE(log_.find("the probability of first > 0 lies between"), std::string::npos) << log_;
}

TEST_F(Sweep, EffectsOfSamplesThatMissTheirDistributionAreWithheld) {
  ASSERT_EQ(whirl("sweep d.toml -o s --vary 'disk.disk.mass=normal(3 kg, 0.1 kg) drawn normal(4 "
                  "kg, 0.1 kg)' "
                  "--samples 20 --sampling random --response 'first=c_undamped:speed:1'"),
            0)
      << log_;
  EXPECT_TRUE(std::isnan(io::read_csv(folder_ / "s/effects.csv")["rank correlation"][0]));
  EXPECT_NE(read("s/sweep.html").find("of the distribution only"), std::string::npos);
}

// The amplification of a mode that grows is none, and the largest of all is not that of the others.
TEST_F(Sweep, AnUnstableRotorIsNoGoodOne) {
  std::ofstream(folder_ / "d.toml", std::ios::app)
      << "[[bearing]]\nname = \"cc\"\nat = \"disk\"\ntype = \"cross_coupling\"\nk = \"1 N/m\"\n"
         "[[step]]\nname = \"l\"\ntype = \"critical_speeds\"\nmax_speed = \"20000 rpm\"\n"
         "motion = \"lateral\"\n";
  ASSERT_EQ(
      whirl("sweep d.toml -o s --vary 'bearing.cc.k=1 N/m,1e6 N/m' "
            "--response 'a=l_damped:amplification:max' --response 'ld=l_damped:log decrement:min'"),
      0)
      << log_;
  const io::Columns runs = io::read_csv(folder_ / "s/sweep.csv");
  EXPECT_GT(runs["ld"][0], 0);
  EXPECT_LT(runs["ld"][1], 0);
  EXPECT_GT(runs["a"][0], 0);
  EXPECT_TRUE(std::isnan(runs["a"][1]));
  EXPECT_NE(read("s/sweep.csv").find("rows: without damping the amplification has no limit"),
            std::string::npos)
      << read("s/sweep.csv");
}

TEST_F(Sweep, ModesThatAreNotThereArePassedBy) {
  std::ofstream(folder_ / "d.toml", std::ios::app)
      << "[[step]]\nname = \"k\"\ntype = \"critical_map\"\nmax_speed = \"9000 rpm\"\n"
         "stiffness_min = \"1e4 N/m\"\nstiffness_max = \"1e9 N/m\"\n";
  ASSERT_EQ(whirl("run d.toml -q -o one"), 0) << log_;
  ASSERT_TRUE(std::isnan(io::read_csv(folder_ / "one/k_critical_map.csv")["critical 2"].back()));
  ASSERT_EQ(whirl("sweep d.toml -o s --vary disk.disk.mass=3kg "
                  "--response 'x=k_critical_map:critical 2:max'"),
            0)
      << log_;
  EXPECT_GT(io::read_csv(folder_ / "s/sweep.csv")["x"][0], 2600);
}

TEST_F(Sweep, WhatCannotBeSweptIsRefused) {
  const std::string response = " --response c_undamped:speed";
  for (const std::string& arguments :
       {std::string(" --vary disk.disk.mass=2kg:4kg:3"),
        " --vary disk.disk.mass=2kg" + response + " --shard 3/2", response,
        " --vary disk.disk.mass=2kg,3kg --sampling best" + response})
    EXPECT_EQ(whirl("sweep d.toml -o s" + arguments), 2) << arguments << log_;
  EXPECT_EQ(whirl("sweep d.toml -o s --vary disk.disk.maas=2kg,3kg" + response), 3) << log_;
  EXPECT_NE(log_.find("unknown key 'maas'"), std::string::npos) << log_;
  ASSERT_EQ(whirl("sweep d.toml -o s --vary disk.disk.mass=2kg,3kg" + response), 0) << log_;
  EXPECT_EQ(whirl("sweep d.toml -o s --vary disk.disk.mass=2kg,4kg --resume" + response), 2);
  EXPECT_NE(log_.find("E99"), std::string::npos);
}

TEST_F(Sweep, AKeyUnderTwoNamesIsRefused) {
  const std::string response = " --response c_undamped:speed";
  for (const char* name : {"disk.0.mass", "disk.\"disk\".mass"}) {
    EXPECT_EQ(whirl("sweep d.toml -o s --vary disk.disk.mass=2kg,3kg --vary '" + std::string(name) +
                    "=4kg,5kg'" + response),
              2)
        << log_;
    EXPECT_NE(log_.find("are one key"), std::string::npos) << log_;
  }
  EXPECT_EQ(
      whirl("sweep d.toml -o s --vary bearing.A.kyy=2e6N/m --vary bearing.1.kyy=3e6N/m" + response),
      0)
      << log_;
}

TEST_F(Sweep, AParameterThatNoKeyHasIsRefused) {
  std::ofstream(folder_ / "d.toml")
      << unbalanced_rotor << steps << "[parameters]\nP = \"1 kg\"\nunused = \"1 kg\"\n";
  for (const char* name : {"Q", "unused"}) {
    EXPECT_EQ(
        whirl(std::string("sweep d.toml -o s --set 'disk.disk.mass=${P}' --vary parameters.") +
              name + "=2kg,3kg --response c_undamped:speed"),
        2)
        << log_;
    EXPECT_NE(log_.find("no key of the deck has this parameter"), std::string::npos) << log_;
  }
}

// Words of --vary and names of responses stand in cells that spreadsheets read.
TEST_F(Sweep, NoCellIsAFormula) {
  std::ofstream(folder_ / "d.toml") << unbalanced_rotor << steps << "[parameters]\nnote = \"x\"\n";
  const std::string vary =
      " --set 'title=${note}' --vary 'parameters.note=@SUM(A1:A9),=1+1,-x,plain'";
  EXPECT_EQ(whirl("sweep d.toml -o s" + vary + " --response '@SUM(A1)=c_undamped:speed:1'"), 2);
  EXPECT_NE(log_.find("spreadsheets"), std::string::npos) << log_;
  ASSERT_EQ(whirl("sweep d.toml -o s" + vary + " --response 'c=c_undamped:speed:1'"), 0) << log_;
  const std::string table = read("s/sweep.csv");
  for (const char* cell : {",'@SUM(A1:A9),", ",'=1+1,", ",'-x,", ",plain,"})
    EXPECT_NE(table.find(cell), std::string::npos) << table;
}

// The bounds of percentiles stand in the table, and why there are none.
TEST_F(Sweep, PercentilesHaveTheirConfidence) {
  const std::string response = " --response 'first=c_undamped:speed:1'";
  const std::string vary = " --vary 'disk.disk.mass=uniform(2 kg, 4 kg)'";
  ASSERT_EQ(whirl("sweep d.toml -o s --samples 80" + vary + response), 0) << log_;
  const io::Columns runs = io::read_csv(folder_ / "s/sweep.csv");
  std::vector<double> x = runs["first"];
  std::sort(x.begin(), x.end());
  const io::Columns bounds = io::read_csv(folder_ / "s/statistics.csv");
  // of 80 samples, by sums of binomial probabilities in fractions: 1st and 9th, 31st and 50th
  EXPECT_EQ(bounds["5 % from"][0], x[0]);
  EXPECT_EQ(bounds["5 % to"][0], x[8]);
  EXPECT_EQ(bounds["median from"][0], x[30]);
  EXPECT_EQ(bounds["median to"][0], x[49]);
  EXPECT_EQ(bounds["95 % from"][0], x[71]);
  EXPECT_EQ(bounds["95 % to"][0], x[79]);
  EXPECT_NE(read("s/sweep.html").find("bands, 95 % confidence"), std::string::npos);
  ASSERT_EQ(whirl("sweep d.toml -o few --samples 10" + vary + response), 0) << log_;
  EXPECT_NE(read("few/statistics.csv").find("not enough samples for 5 % and 95 %: they take 72"),
            std::string::npos);
}

constexpr const char* step_in_time = R"([[step]]
name = "m"
type = "modal"
speed = "3000 rpm"
[[step]]
name = "t"
type = "transient"
start = "rest"
initial_speed = "3000 rpm"
duration = "0.02 s"
amplitude_limit = "1 mm"
)";
constexpr const char* asked_for_words =
    " --samples 30 --vary 'step.t.amplitude_limit=uniform(0.05 mm, 1 mm)' "
    "--response end=summary:steps.t.outcome --response time=summary:steps.t.t_end "
    "--response kind=m_modes:kind:1 --response none=summary:steps.t.nothing";

TEST_F(Sweep, WordsAreResponses) {
  std::ofstream(folder_ / "d.toml", std::ios::app) << step_in_time;
  ASSERT_EQ(whirl(std::string("sweep d.toml -o s") + asked_for_words), 4) << log_;
  const std::string runs = read("s/sweep.csv");
  EXPECT_NE(runs.find(",end time reached,,0.02,,lateral,,nan,no entry"), std::string::npos) << runs;
  EXPECT_NE(runs.find(",amplitude limit exceeded,,"), std::string::npos) << runs;
  const io::Columns shares = io::read_csv(folder_ / "s/statistics.csv");
  double sum = 0;
  for (std::size_t row = 0; row < shares.rows(); ++row) {
    const double share = shares["share"][row];
    if (!(share < 1)) continue;  // of numbers there is none
    EXPECT_LT(shares["share from"][row], share);
    EXPECT_GT(shares["share to"][row], share);
    EXPECT_EQ(shares["runs"][row], std::round(30 * share));
    sum += share;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  // it is the low limits that are exceeded
  const io::Columns keys = io::read_csv(folder_ / "s/words.csv");
  EXPECT_LT(keys["mean"][1], keys["mean of all"][1]);
  EXPECT_GT(keys["mean"][0], keys["mean of all"][0]);
  EXPECT_NE(read("s/sweep.html").find("id=\"words_1\""), std::string::npos);
  ASSERT_EQ(whirl(std::string("sweep d.toml -o one -j 1") + asked_for_words), 4) << log_;
  EXPECT_EQ(read("one/sweep.csv"), runs);
}

TEST_F(Sweep, WordsInHdf5) {
  if (!Plugin::available("hdf5") && std::system("'" WHIRL_EXE "' version | grep -q hdf5") != 0)
    GTEST_SKIP() << "needs the component hdf5";
  std::ofstream(folder_ / "d.toml", std::ios::app) << step_in_time;
  ASSERT_EQ(whirl(std::string("sweep d.toml -o s --hdf5") + asked_for_words), 4) << log_;
  const io::Columns binary = io::read_hdf5(folder_ / "s/sweep.h5");
  EXPECT_EQ(binary["time"], io::read_csv(folder_ / "s/sweep.csv")["time"]);
  const std::string bytes = read("s/sweep.h5");
  for (const char* word : {"amplitude limit exceeded", "no entry 'steps.t.nothing' in the summary"})
    EXPECT_NE(bytes.find(word), std::string::npos) << word;
}

// A map of stability reads the deck again with other values of its parameter.
TEST_F(Sweep, ListsThoseOfMapsToo) {
  const std::string deck = std::string(WHIRL_SOURCE) + "/examples/07_internal_damping/deck.toml";
  ASSERT_EQ(whirl("sweep '" + deck + "' --list -o s"), 0) << log_;
  EXPECT_NE(log_.find("stability"), std::string::npos) << log_;
}

TEST_F(Sweep, ListsWhatCanBeAResponse) {
  ASSERT_EQ(whirl("sweep d.toml --list -o s"), 0);
  EXPECT_NE(log_.find("c_undamped:speed [rpm]"), std::string::npos) << log_;
  EXPECT_NE(log_.find("summary:steps.c.type (words)"), std::string::npos) << log_;
}

}  // namespace
}  // namespace whirl::test
