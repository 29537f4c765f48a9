// Series, tables and JSON: what is written is what is read, whole or not at all, also after a kill.
#include "read_json.hpp"
#include "temp_folder.hpp"
#include <core/error.hpp>
#include <core/plugin.hpp>
#include <io/file.hpp>
#include <io/results.hpp>
#include <io/table_file.hpp>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <bit>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <thread>

namespace whirl::io {
namespace {

namespace fs = std::filesystem;

std::vector<Channel> some_channels() {
  return {{"time", "s", "", {}, 1.0, ""},
          {"DE-XY", "m", "displacement, \"fixed\" axes", {"y", "z"}, 1.0, "probes"},
          {"speed, shaft 'hp'", "rpm", "spin", {}, 30.0 / std::acos(-1.0), ""}};
}

// Row k of a series with awkward numbers in it.
std::array<double, 4> row_of(std::uint64_t k) {
  std::mt19937_64 rng(k);
  std::uniform_real_distribution<double> u(-1, 1);
  return {1e-4 * static_cast<double>(k), u(rng) * 1e-6,
          std::ldexp(u(rng), static_cast<int>(k % 2000) - 1000), 1000 * u(rng)};
}

TEST(ResultsFolder, WritesWhatIsAskedForAlone) {
  TempFolder dir;
  ResultsFolder folder(dir.path());
  folder.write_only({"a.csv"});
  Table table;
  table.columns = {{"x", "m", ""}};
  table.add({1.0});
  folder.write_table("a.csv", table);
  folder.write_table("b.csv", table);
  folder.write_text("resolved.toml", "x");
  folder.write_json("summary.json", Value::object());
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(dir.path()))
    names.push_back(entry.path().filename().string());
  EXPECT_EQ(names, std::vector<std::string>{"a.csv"});
  EXPECT_EQ(read_csv(dir / "a.csv").values.front(), std::vector<double>{1.0});
  folder.set_owner("one");
  folder.write_table("b.csv", table);
  folder.set_owner("other");
  EXPECT_THROW(folder.write_table("b.csv", table), Error);
}

TEST(ResultsFolder, HalfWrittenFilesOfKilledRunsGo) {
  TempFolder dir;
  const pid_t dead = ::fork();
  if (dead == 0) ::_exit(0);
  ::waitpid(dead, nullptr, 0);
  const auto make = [&](const std::string& name) { std::ofstream(dir / name) << "x"; };
  fs::create_directory(dir / "vtk");
  const std::string gone = "." + std::string("run.csv.") + std::to_string(dead) + ".3.part";
  make(gone);
  make("vtk/" + gone);
  const std::string living = ".run.csv." + std::to_string(::getppid()) + ".0.part";
  for (const std::string& name :
       {living, std::string("run.csv"), std::string(".hidden"), std::string(".a.part"),
        std::string(".part"), "a.csv." + std::to_string(dead) + ".3.part"})
    make(name);
  const ResultsFolder folder(dir.path());
  EXPECT_FALSE(fs::exists(dir / gone));
  EXPECT_FALSE(fs::exists(dir / ("vtk/" + gone)));
  EXPECT_EQ(file_count(dir.path()), 6u);
}

TEST(Csv, EveryDoubleComesBackBitForBit) {
  TempFolder dir;
  const auto channels = some_channels();
  auto series = make_csv_series(dir / "a.csv");
  series->begin(channels);
  constexpr std::uint64_t n = 5000;
  for (std::uint64_t k = 0; k < n; ++k)
    series->append(row_of(k));
  const double extreme[] = {std::numeric_limits<double>::denorm_min(),
                            -std::numeric_limits<double>::max(), -0.0, 1e308};
  series->append(extreme);
  series->close();
  EXPECT_EQ(series->rows(), n + 1);

  const Columns c = read_csv(dir / "a.csv");
  EXPECT_EQ(c.names, (std::vector<std::string>{"time", "DE-XY.y", "DE-XY.z", "speed, shaft 'hp'"}));
  EXPECT_EQ(c.units, (std::vector<std::string>{"s", "m", "m", "rpm"}));
  ASSERT_EQ(c.rows(), n + 1);
  for (std::uint64_t k = 0; k < n; ++k) {
    const auto r = row_of(k);
    for (std::size_t j = 0; j < 3; ++j)
      ASSERT_EQ(std::bit_cast<std::uint64_t>(c.values[j][k]), std::bit_cast<std::uint64_t>(r[j]));
    ASSERT_EQ(c.values[3][k], r[3] * channels[2].scale);
  }
  EXPECT_EQ(c.values[0][n], extreme[0]);
  EXPECT_EQ(c.values[1][n], extreme[1]);
  EXPECT_TRUE(std::signbit(c.values[2][n]));
  EXPECT_TRUE(std::isinf(c.values[3][n]));  // 1e308 rad/s in rpm
}

TEST(Csv, NotANumberIsWrittenAndReadAsSuch) {
  TempFolder dir;
  auto series = make_csv_series(dir / "a.csv");
  series->begin(std::vector<Channel>{{"x", "m", "", {}, 1.0, ""}});
  series->append(std::array{std::nan("")});
  series->append(std::array{-std::nan("")});
  series->close();
  EXPECT_EQ(read_text(dir / "a.csv"), "x [m]\nnan\nnan\n");
  EXPECT_TRUE(std::isnan(read_csv(dir / "a.csv").values[0][1]));
}

TEST(Csv, OldFileStaysUntilTheNewOneHasItsHeader) {
  TempFolder dir;
  write_atomic(dir / "a.csv", "old [m]\n1\n");
  std::ifstream old(dir / "a.csv");
  auto series = make_csv_series(dir / "a.csv");
  series->begin(some_channels());
  const std::string text = read_text(dir / "a.csv");
  EXPECT_EQ(text.substr(0, 9), "time [s],");
  EXPECT_EQ(text.back(), '\n');
  std::string line;
  std::getline(old, line);  // a reader of the old file is not disturbed
  EXPECT_EQ(line, "old [m]");
  EXPECT_EQ(file_count(dir.path()), 1u);
}

TEST(Csv, UnfinishedLastLineIsLeftOut) {
  TempFolder dir;
  write_atomic(dir / "a.csv", "t [s],x [m]\n0,1\n0.1,2\n0.2,3.14");
  EXPECT_EQ(read_csv(dir / "a.csv").rows(), 2u);
}

TEST(Csv, UnwritableFolderIsAnIoError) {
  auto series = make_csv_series("/proc/none/a.csv");
  try {
    series->begin(some_channels());
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.exit(), Exit::io);
    EXPECT_NE(std::string(e.what()).find("/proc/none"), std::string::npos);
  }
}

// A limit on file size stands for the full disk.
TEST(Csv, FullDiskIsAnIoError) {
  TempFolder dir;
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  auto* const handler = ::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{20000, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  auto s = make_csv_series(dir / "a.csv", {1000.0, 4096});
  s->begin(some_channels());
  EXPECT_THROW(for (std::uint64_t k = 0; k < 1000; ++k) s->append(row_of(k)), Error);
  EXPECT_THROW(write_atomic(dir / "b", std::string(30000, 'x')), Error);
  EXPECT_FALSE(fs::exists(dir / "b"));
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  EXPECT_EQ(file_count(dir.path()), 1u);  // the series, and no temporary
}

class Series : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (GetParam() == std::string("hdf5") && !Plugin::available("hdf5"))
      GTEST_SKIP() << "built without HDF5";
  }
  TimeSeriesPtr make(const fs::path& p, SeriesOptions o = {}) const {
    return GetParam() == std::string("hdf5") ? make_hdf5_series(p, o) : make_csv_series(p, o);
  }
  Columns read(const fs::path& p) const {
    return GetParam() == std::string("hdf5") ? read_hdf5(p) : read_csv(p);
  }
  void expect_rows(const Columns& c, std::uint64_t n) const {
    ASSERT_EQ(c.rows(), n);
    for (std::uint64_t k = 0; k < n; ++k) {
      const auto r = row_of(k);
      for (std::size_t j = 0; j < 3; ++j)
        ASSERT_EQ(c.values[j][k], r[j]) << "row " << k;
    }
  }
};
INSTANTIATE_TEST_SUITE_P(Formats, Series, ::testing::Values("csv", "hdf5"),
                         [](const auto& i) { return std::string(i.param); });

TEST_P(Series, RoundTripOverManyChunks) {
  TempFolder dir;
  auto s = make(dir / "a");
  s->begin(some_channels());
  constexpr std::uint64_t n = 20000;  // several chunks of 4096 rows and a part
  for (std::uint64_t k = 0; k < n; ++k)
    s->append(row_of(k));
  s->close();
  const Columns c = read(dir / "a");
  EXPECT_EQ(c.names[1], "DE-XY.y");
  EXPECT_EQ(c.units[3], "rpm");
  expect_rows(c, n);
}

TEST_P(Series, ReadableWhileItGrows) {
  TempFolder dir;
  auto s = make(dir / "a");
  s->begin(some_channels());
  std::uint64_t k = 0;
  for (const std::uint64_t upto : {0u, 1u, 300u, 4096u, 4097u, 9000u}) {
    while (k < upto)
      s->append(row_of(k++));
    s->flush();
    expect_rows(read(dir / "a"), upto);
  }
}

TEST_P(Series, ResumeCutsAtTheCheckpointAndContinues) {
  TempFolder dir;
  const auto channels = some_channels();
  for (const std::uint64_t keep : {0u, 1u, 4095u, 4096u, 5000u, 8192u, 9000u}) {
    auto s = make(dir / "a");
    s->begin(channels);
    for (std::uint64_t k = 0; k < 9000; ++k)
      s->append(row_of(k));
    s->close();
    s = make(dir / "a");
    s->resume(channels, keep);
    EXPECT_EQ(s->rows(), keep);
    for (std::uint64_t k = keep; k < 13000; ++k)
      s->append(row_of(k));
    s->close();
    EXPECT_EQ(s->rows(), 13000u);
    expect_rows(read(dir / "a"), 13000);
  }
}

TEST_P(Series, ResumeRefusesOtherColumnsAndMissingRows) {
  TempFolder dir;
  auto channels = some_channels();
  auto s = make(dir / "a");
  s->begin(channels);
  for (std::uint64_t k = 0; k < 10; ++k)
    s->append(row_of(k));
  s->close();
  EXPECT_THROW(make(dir / "a")->resume(channels, 11), Error);
  channels[1].unit = "um";
  EXPECT_THROW(make(dir / "a")->resume(channels, 5), Error);
  EXPECT_THROW(make(dir / "missing")->resume(channels, 0), Error);
}

// A child writes as fast as it can and is killed; all rows it had flushed must be there, and none
// invented.
TEST_P(Series, KilledWriterLeavesAllFlushedRows) {
  TempFolder dir;
  const auto channels = some_channels();
  int pipe_ends[2];
  ASSERT_EQ(::pipe(pipe_ends), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    auto s = make(dir / "a", {0.02, 1 << 16});
    s->begin(channels);
    for (std::uint64_t k = 0;; ++k) {
      s->append(row_of(k));
      if (k % 500 == 499) {
        s->flush();
        if (::write(pipe_ends[1], &k, sizeof k) != sizeof k) ::_exit(1);
      }
    }
  }
  std::uint64_t flushed = 0;
  while (flushed < 30000 && ::read(pipe_ends[0], &flushed, sizeof flushed) == sizeof flushed) {}
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  ::close(pipe_ends[1]);
  while (::read(pipe_ends[0], &flushed, sizeof flushed) == sizeof flushed) {}
  ::close(pipe_ends[0]);

  const Columns c = read(dir / "a");
  ASSERT_GE(c.rows(), flushed + 1);
  expect_rows(c, c.rows());
  // And the run can go on from its checkpoint.
  auto s = make(dir / "a");
  s->resume(channels, flushed);
  for (std::uint64_t k = flushed; k < flushed + 3000; ++k)
    s->append(row_of(k));
  s->close();
  expect_rows(read(dir / "a"), flushed + 3000);
}

TEST(Hdf5, IsCompactAndFlushesDoNotGrowTheFile) {
  if (!Plugin::available("hdf5")) GTEST_SKIP() << "built without HDF5";
  TempFolder dir;
  const auto run = [&](const std::string& name, std::uint64_t flush_each) {
    auto s = make_hdf5_series(dir / name);
    s->begin(some_channels());
    for (std::uint64_t k = 0; k < 40000; ++k) {
      const double t = 1e-4 * static_cast<double>(k);
      s->append(std::array{t, 1e-5 * std::sin(100 * t), 1e-5 * std::cos(100 * t), 100.0});
      if (k % flush_each == 0) s->flush();
    }
    s->close();
    return fs::file_size(dir / name);
  };
  const auto seldom = run("seldom.h5", 1000000), often = run("often.h5", 50);
  EXPECT_LT(seldom, 40000u * 4 * 8);  // smaller than the bare doubles
  EXPECT_LT(often,
            seldom + 4 * 4096 * 8 + 8192);  // at most the tail more, whatever the number of flushes
}

TEST(Hdf5, IsLoadedOnlyWhenAsked) {
  if (!Plugin::available("hdf5")) GTEST_SKIP() << "built without HDF5";
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";  // a fresh process
  EXPECT_EXIT(
      {
        const auto mapped = [] {
          return read_text("/proc/self/maps").find("libhdf5") != std::string::npos;
        };
        TempFolder dir;
        auto csv = make_csv_series(dir / "a.csv");
        const bool before = mapped() || Plugin::loaded("hdf5");
        auto h5 = make_hdf5_series(dir / "a.h5");
        ::_exit(!before && mapped() && Plugin::loaded("hdf5") ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST(Plugin, MissingOneIsAnIoErrorThatSaysWhatToDo) {
  try {
    Plugin::load("no_such");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.exit(), Exit::io);
    EXPECT_NE(e.diagnostics()[0].hint.find("install the package"), std::string::npos);
  }
}

TEST(Tee, FeedsAllSinks) {
  TempFolder dir;
  std::vector<TimeSeriesPtr> sinks;
  sinks.push_back(make_csv_series(dir / "a.csv"));
  sinks.push_back(make_csv_series(dir / "b.csv"));
  auto s = make_tee(std::move(sinks));
  s->begin(some_channels());
  for (std::uint64_t k = 0; k < 3; ++k)
    s->append(row_of(k));
  s->close();
  EXPECT_EQ(s->rows(), 3u);
  EXPECT_EQ(read_text(dir / "a.csv"), read_text(dir / "b.csv"));
}

TEST(Table, NumbersTextAndQuotes) {
  TempFolder dir;
  Table t;
  t.columns = {{"mode, damped", "", ""}, {"frequency", "Hz", ""}};
  t.add({"1st \"forward\"", 0.1 + 0.2});
  t.add({"2nd", 12});
  EXPECT_THROW(t.add({1.0}), std::logic_error);
  ResultsFolder folder(dir / "deep/er");
  folder.write_table("tables/modes.csv", t);
  EXPECT_EQ(
      read_text(dir / "deep/er/tables/modes.csv"),
      "\"mode, damped\",frequency [Hz]\n\"1st \"\"forward\"\"\",0.30000000000000004\n2nd,12\n");
  EXPECT_EQ(read_csv(dir / "deep/er/tables/modes.csv")["frequency"][0], 0.1 + 0.2);
}

// What the Python module reads: numbers of every column, words of those that have any.
TEST(Table, ReadBackWithItsWords) {
  TempFolder dir;
  write_atomic(dir / "words.csv", "s [m],place [-],load [N]\n0.5,left,-2\n1.5,\"a, b\",3e4\n");
  const TableFile words = read_table(dir / "words.csv");
  ASSERT_EQ(words.columns.size(), 3u);
  EXPECT_EQ(words.rows(), 2u);
  EXPECT_EQ(words.columns[0].name, "s");
  EXPECT_EQ(words.columns[0].unit, "m");
  EXPECT_EQ(words.columns[0].numbers, (std::vector<double>{0.5, 1.5}));
  EXPECT_TRUE(words.columns[0].texts.empty());  // numbers alone
  EXPECT_EQ(words.columns[1].texts, (std::vector<std::string>{"left", "a, b"}));
  EXPECT_TRUE(std::isnan(words.columns[1].numbers[0]));
  EXPECT_EQ(words.columns[2].numbers, (std::vector<double>{-2, 3e4}));
  write_atomic(dir / "numbers.csv", "t [s],y [m]\n0,1\n1,2\n");
  const TableFile numbers = read_table(dir / "numbers.csv");
  for (const TableFile::Column& c : numbers.columns)
    EXPECT_TRUE(c.texts.empty()) << c.name;
  EXPECT_EQ(numbers.columns[1].numbers, (std::vector<double>{1, 2}));
}

TEST(Json, KeepsOrderAndDigits) {
  TempFolder dir;
  Value v;
  v["zeta"] = 0.1 + 0.2;
  v["alpha"]["steps"] = std::int64_t{9007199254740993};  // not a double
  v["alpha"]["left out"].push("torsion");
  v["alpha"]["left out"].push(true);
  v["nothing"] = std::nan("");
  v["text"] = std::string("quote \" and bad byte \xff");
  v["list"] = std::vector<double>{1, 2.5};
  ResultsFolder folder(dir.path());
  folder.write_json("summary.json", v);
  const std::string text = read_text(dir / "summary.json");
  EXPECT_LT(text.find("zeta"), text.find("alpha"));
  const Value r = tests::read_json(dir / "summary.json");
  EXPECT_EQ(r.at("zeta").number(), 0.1 + 0.2);
  EXPECT_NE(text.find("9007199254740993"), std::string::npos);
  EXPECT_EQ(r.members()[0].first, "zeta");
  EXPECT_EQ(r.at("alpha").at("left out").items()[0].text(), "torsion");
  EXPECT_EQ(r.at("nothing").text(), "nan");
  EXPECT_EQ(r.at("list").items()[1].number(), 2.5);
  EXPECT_TRUE(r.at("absent").is_null());
}

// Readers that poll while a file is rewritten never see a part of it.
TEST(Atomic, ReaderSeesOldOrNew) {
  TempFolder dir;
  const std::string a(300000, 'a'), b(200000, 'b');
  write_atomic(dir / "f", a);
  std::jthread writer([&](std::stop_token stop) {
    for (int k = 0; !stop.stop_requested(); ++k)
      write_atomic(dir / "f", k % 2 ? a : b);
  });
  for (int k = 0; k < 200; ++k) {
    const std::string s = read_text(dir / "f");
    ASSERT_TRUE(s == a || s == b) << s.size();
  }
  writer.request_stop();
  writer.join();
  EXPECT_EQ(file_count(dir.path()), 1u);  // no temporary left
}

}  // namespace
}  // namespace whirl::io
