// What `whirl run` refuses before it computes anything, `whirl check` refuses as well, with the
// same code.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

struct Said {
  int exit;
  std::string log;
};

class CheckRefuses : public testing::Test {
 protected:
  CheckRefuses()
      : folder_(fs::temp_directory_path() / ("whirl_refuses_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~CheckRefuses() override {
    std::error_code ec;
    fs::remove_all(folder_, ec);
  }
  Said whirl(const std::string& arguments) const {
    const int status = std::system(("cd '" + folder_.string() + "' && '" WHIRL_EXE "' " +
                                    arguments + " >log.txt 2>&1 </dev/null")
                                       .c_str());
    std::ostringstream text;
    text << std::ifstream(folder_ / "log.txt").rdbuf();
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text.str()};
  }
  void write(const std::string& deck) const { std::ofstream(folder_ / "d.toml") << deck; }
  fs::path folder_;
};

/// A rotor between rigid bearings.
std::string rotor(const std::string& parts) {
  return R"(format = 1
[parameters]
unused = "1 mm"
[model.mesh]
min_elements_per_section = 2
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40], ["b", 300, 40]]
[[bearing]]
name = "L"
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "R"
at = "b:end"
type = "rigid"
directions = ["y", "z"]
)" + parts;
}

}  // namespace

TEST_F(CheckRefuses, WhatRunRefuses) {
  struct Kind {
    const char* name;
    const char* code;
    std::string deck;
    std::string run_options = " -o r";
  };
  const std::string map =
      "[[step]]\nname = \"map\"\ntype = \"critical_map\"\nstiffness_min = \"1e5 "
      "N/m\"\nstiffness_max = \"1e8 N/m\"\npoints = 3\nmax_speed = \"9000 rpm\"\n";
  const std::string linear =
      "[[bearing]]\nname = \"M\"\nat = \"a:end\"\ntype = \"linear\"\nkyy = \"1e6 N/m\"\nkzz = "
      "\"1e6 N/m\"\n";
  const Kind kinds[] = {
      {"a map over a bearing that is not there", "E80",
       rotor(linear + map + "bearings = [\"N\"]\n")},
      {"a map with nothing to vary", "E80", rotor(map)},
      {"a map over bearings without a stiffness of their own", "E80",
       rotor("[[bearing]]\nname = \"B\"\nat = \"a:end\"\ntype = \"linear\"\nkxx = \"1e6 "
             "N/m\"\n" +
             map)},
      {"a map over a bearing that only holds the shaft along its axis", "E80",
       rotor(linear +
             "[[bearing]]\nname = \"B\"\nat = \"a:start\"\ntype = \"linear\"\nkxx = \"1e6 "
             "N/m\"\n" +
             map + "bearings = [\"B\"]\n")},
      {"a shaft held where it shall turn", "E78",
       rotor("[[bearing]]\nat = \"a:end\"\ntype = \"rigid\"\ndirections = [\"rx\"]\n[[step]]\ntype "
             "= \"modal\"\nspeed = \"3000 rpm\"\n")},
      {"a held shaft in an equilibrium", "E78",
       rotor("[[bearing]]\nat = \"a:end\"\ntype = \"rigid\"\ndirections = [\"rx\"]\n[[step]]\ntype "
             "= \"static\"\nspeed = \"3000 rpm\"\n")},
      {"the momentum form with a flexible shaft", "E74",
       rotor("[[step]]\ntype = \"transient\"\nduration = \"1 ms\"\nintegrator = { method = "
             "\"momentum_rk\" }\n")},
      {"a start in a mode beyond all of them", "E76",
       rotor(
           linear +
           "[[step]]\ntype = \"transient\"\nduration = \"1 ms\"\nstart = \"mode\"\nmode = 5000\n")},
      {"a fixed step of IDA", "N11",
       rotor("[[step]]\ntype = \"transient\"\nduration = \"1 ms\"\nintegrator = { method = "
             "\"ida\", dt = \"1 us\" }\n")},
      {"an earlier run that is not there", "E91",
       rotor("[[step]]\ntype = \"transient\"\nduration = \"1 ms\"\nprevious = \"nowhere\"\n")},
      {"orders of the speed of a shaft that stands", "E26",
       rotor(
           "[[shaft]]\nname = \"casing\"\nrotating = false\nmaterial = \"steel\"\ncolumns = "
           "[\"name\", \"length[mm]\", \"od[mm]\"]\nrows = [[\"c\", 300, 60]]\n[[bearing]]\nat = "
           "\"c:start\"\ntype = \"rigid\"\ndirections = [\"x\", \"y\", \"z\", \"rx\", \"ry\", "
           "\"rz\"]\n[[step]]\ntype = \"api_torsional\"\noperating_speed = [\"1000 rpm\", \"1100 "
           "rpm\"]\n[[step.torque]]\nname = \"pulsation\"\nat = \"c:end\"\norder = 1\namplitude = "
           "\"10 N.m\"\n")},
      {"a stability map of a parameter that nothing uses", "E89",
       rotor(linear +
             "[[step]]\ntype = \"stability\"\nspeed = { start = \"1000 rpm\", stop = \"3000 rpm\", "
             "points = 3 }\nmap = { parameter = \"unused\", values = [\"1 mm\", \"2 mm\"] }\n")},
      {"results below a file", "E91",
       rotor("[[step]]\ntype = \"static\"\n[output]\ndirectory = \"d.toml/r\"\n"), ""},
      {"an asymmetric shaft among shafts of different speeds", "E88",
       R"(format = 1
[[shaft]]
name = "flat"
material = "steel"
[[shaft.section]]
name = "a"
length = "1 m"
general = { A = "1000 mm^2", Iy = "1e5 mm^4", Iz = "2e5 mm^4", J = "3e5 mm^4", kappa_y = 0.9, kappa_z = 0.9 }
[[shaft]]
name = "quick"
material = "steel"
speed_ratio = 2
columns = ["name", "length[mm]", "od[mm]"]
rows = [["q", 300, 40]]
[[bearing]]
at = "flat/a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "flat/a:end"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
at = "quick/q:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "quick/q:end"
type = "rigid"
directions = ["y", "z"]
[[step]]
type = "stability"
speed = { start = "1000 rpm", stop = "3000 rpm", points = 3 }
)"},
      {"small motions of an asymmetric shaft", "E39",
       R"(format = 1
[[shaft]]
material = "steel"
[[shaft.section]]
name = "a"
length = "1 m"
general = { A = "1000 mm^2", Iy = "1e5 mm^4", Iz = "2e5 mm^4", J = "3e5 mm^4", kappa_y = 0.9, kappa_z = 0.9 }
[[bearing]]
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "a:end"
type = "rigid"
directions = ["y", "z"]
[[step]]
type = "transient"
duration = "1 ms"
linear = true
initial_speed = "3000 rpm"
)"},
  };
  for (const Kind& k : kinds) {
    SCOPED_TRACE(k.name);
    write(k.deck);
    const Said run = whirl("run d.toml" + k.run_options), check = whirl("check d.toml"),
               json = whirl("check --json d.toml");
    if (run.log.find("[E90]") != std::string::npos) continue;  // built without SUNDIALS
    EXPECT_NE(run.exit, 0) << run.log;
    EXPECT_EQ(check.exit, run.exit) << check.log << run.log;
    EXPECT_EQ(json.exit, run.exit) << json.log;
    for (const Said& said : {run, check})
      EXPECT_NE(said.log.find(std::string("[") + k.code + "]"), std::string::npos) << said.log;
    EXPECT_NE(json.log.find(std::string("\"") + k.code + "\""), std::string::npos) << json.log;
    EXPECT_NE(json.log.find("\"ok\": false"), std::string::npos) << json.log;
  }
}

TEST_F(CheckRefuses, NothingThatRuns) {
  write(
      rotor("[[step]]\ntype = \"transient\"\nname = \"t\"\nduration = \"1 ms\"\ninitial_speed = "
            "\"3000 rpm\"\n[[step]]\ntype = \"modal\"\nspeed = \"3000 rpm\"\n"
            "[[step]]\ntype = \"transient\"\nname = \"u\"\nfrom = \"t\"\nduration = \"1 ms\"\n"));
  EXPECT_EQ(whirl("check d.toml").exit, 0) << whirl("check d.toml").log;
  EXPECT_EQ(whirl("run d.toml -o r").exit, 0);
  // the state of that run is there for another one
  write(
      rotor("[[step]]\ntype = \"transient\"\nduration = \"1 ms\"\nprevious = \"r\"\nprevious_step "
            "= \"t\"\n"));
  EXPECT_EQ(whirl("check d.toml").exit, 0) << whirl("check d.toml").log;
  EXPECT_EQ(whirl("run d.toml -o s").exit, 0);
}
