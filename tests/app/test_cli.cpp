// The program as the user meets it: exit codes, streams, and files, through the real executable.
#include "../io/read_json.hpp"

#include <run/results_folder.hpp>
#include <core/error.hpp>
#include <gtest/gtest.h>
#include <io/value.hpp>
#include <sys/wait.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace fs = std::filesystem;
using namespace whirl;

namespace {

std::string read(const fs::path& p) {
  std::ifstream in(p, std::ios::binary);
  std::ostringstream s;
  s << in.rdbuf();
  return s.str();
}

struct Result {
  int code;
  std::string out, err;
};

class Cli : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("whirl_cli_" + std::to_string(::getpid()) + "_" +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Runs `whirl ARGUMENTS` in the test's own folder.
  Result whirl(const std::string& arguments, const std::string& before = "") {
    const std::string command = "cd '" + folder_.string() + "' && " + before +
                                " >out.txt 2>err.txt </dev/null '" WHIRL_EXE "' " +
                                arguments;  // so a test can redirect again
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(folder_ / "out.txt"),
            read(folder_ / "err.txt")};
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  fs::path folder_;
  static constexpr const char* good = R"(format = 1
title = "Two sections"
[parameters]
od = "40 mm"
[model]
gravity = "0 m/s^2"
[shaft]
[[shaft.section]]
name = "left"
length = "300 mm"
od = "${od}"
material = "steel"
)";
};

}  // namespace

TEST_F(Cli, ExitCodes) {
  write("good.toml", good);
  write("bad.toml", "format = 1\n[shaft]\nlength = 3\n");
  EXPECT_EQ(whirl("check good.toml").code, 0);
  EXPECT_EQ(whirl("--help").code, 0);
  EXPECT_EQ(whirl("--version").code, 0);
  EXPECT_EQ(whirl("check --help").code, 0);
  EXPECT_EQ(whirl("version").code, 0);
  // 2: usage
  EXPECT_EQ(whirl("").code, 2);
  EXPECT_EQ(whirl("chekc good.toml").code, 2);
  EXPECT_EQ(whirl("check").code, 2);
  EXPECT_EQ(whirl("check good.toml --no-such-option").code, 2);
  EXPECT_EQ(whirl("run good.toml --jobs many").code, 2);
  EXPECT_EQ(whirl("run good.toml --jobs -1").code, 2);
  EXPECT_EQ(whirl("completion csh").code, 2);
  EXPECT_EQ(whirl("explain E00").code, 2);
  EXPECT_EQ(whirl("new --example nothing").code, 2);
  EXPECT_EQ(whirl("check good.toml --set od").code, 2);
  // 3: deck
  EXPECT_EQ(whirl("check bad.toml").code, 3);
  EXPECT_EQ(whirl("run bad.toml").code, 3);
  EXPECT_EQ(whirl("run good.toml").code, 3);  // no step
  EXPECT_EQ(whirl("check good.toml --set parameters.od=40").code, 3);
  // 5: input and output
  EXPECT_EQ(whirl("check none.toml").code, 5);
  EXPECT_EQ(whirl("check .").code, 5);
  EXPECT_EQ(whirl("schema >/dev/full").code, 5);
}

TEST_F(Cli, CheckPrintsStationsAndSummary) {
  write("good.toml", good);
  const Result r = whirl("check good.toml");
  EXPECT_EQ(r.err, "");
  EXPECT_NE(r.out.find("good.toml: Two sections\n  1 shaft, 0 disks"), std::string::npos) << r.out;
  EXPECT_NE(r.out.find("left:start"), std::string::npos) << r.out;
  EXPECT_NE(r.out.find("2.959"), std::string::npos) << r.out;  // mass: 7850 pi/4 0.04^2 0.3
  const Result quiet = whirl("check good.toml --quiet");
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST_F(Cli, MistakesGoToStandardError) {
  write("a deck.toml", "format = 1\n[shaft]\nlenght = 3\n");
  const Result r = whirl("check 'a deck.toml'");
  EXPECT_EQ(r.out, "");
  EXPECT_EQ(
      r.err,
      "a deck.toml:2:1: error[E05]: shaft 'shaft' has no sections\n   2 | [shaft]\n     | "
      "^~~~~~~\n     = hint: give columns and rows, file = \"shaft.csv\", or [[shaft.section]]\n"
      "a deck.toml:3:1: error[E04]: unknown key 'lenght' in shaft 'shaft'\n   3 | lenght = 3\n     "
      "| ^~~~~~\n     = hint: `whirl schema --reference` lists all keys\n"
      "a deck.toml: 2 errors\n");
}

// As for keys of a deck: the nearest there is, also where something else is missing too.
TEST_F(Cli, MisspeltOptionsHaveAHint) {
  write("good.toml", good);
  const auto says = [&](const char* arguments, const char* option, const char* hint) {
    const Result r = whirl(arguments);
    EXPECT_EQ(r.code, 2) << arguments;
    EXPECT_NE(r.err.find(std::string("has no option '") + option + "'"), std::string::npos)
        << arguments << ": " << r.err;
    EXPECT_NE(r.err.find(hint), std::string::npos) << arguments << ": " << r.err;
  };
  says("check good.toml --resolvd", "--resolvd", "did you mean '--resolved'?");
  says("check --resolvd", "--resolvd", "did you mean '--resolved'?");  // no deck either
  says("run good.toml --jbos=2", "--jbos", "did you mean '--jobs'?");
  says("run good.toml -jobs 2", "-jobs", "did you mean '--jobs'?");
  says("run good.toml -output there it_is", "-output", "did you mean '--output'?");
  says("run good.toml -x", "-x", "`whirl run --help` lists them");
  says("run good.toml --nothing-like-it", "--nothing-like-it", "`whirl run --help` lists them");
  says("--verison", "--verison", "did you mean '--version'?");
  says("--jobs 2 run good.toml", "--jobs", "options stand behind the command");
  // what is right is not complained about
  EXPECT_EQ(whirl("run good.toml -j many").err.find("has no option"), std::string::npos);
  EXPECT_EQ(whirl("run -j2").err.find("has no option"), std::string::npos);
}

TEST_F(Cli, NoColourWithoutATerminal) {
  write("bad.toml", "format = 2\n");
  const Result r = whirl("check bad.toml", "TERM=xterm");
  EXPECT_EQ(r.err.find('\x1b'), std::string::npos);
}

TEST_F(Cli, ColourOnATerminalUnlessNoColorIsSet) {
  if (std::system("script --version >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "needs script(1) for a terminal";
  write("bad.toml", "format = 2\n");
  const auto terminal = [&](const std::string& environment) {
    const std::string command = "cd '" + folder_.string() + "' && " + environment +
                                " script -qec \"'" WHIRL_EXE
                                "' check bad.toml\" typescript >/dev/null 2>&1 </dev/null";
    std::system(command.c_str());
    return read(folder_ / "typescript");
  };
  EXPECT_NE(terminal("TERM=xterm NO_COLOR=").find("\x1b[1;31m"), std::string::npos);
  EXPECT_EQ(terminal("TERM=xterm NO_COLOR=1").find("\x1b[1;31m"), std::string::npos);
  EXPECT_EQ(terminal("TERM=dumb NO_COLOR=").find("\x1b[1;31m"), std::string::npos);
}

TEST_F(Cli, Json) {
  write("good.toml", good);
  write("bad.toml", "format = 1\n[shaft]\nmaterial = 3\n");
  const auto ok = tests::parse_json(whirl("check good.toml --json").out);
  EXPECT_TRUE(ok.at("ok").boolean());
  EXPECT_EQ(ok.at("model").at("shafts").items()[0].at("name").text(), "shaft");
  EXPECT_NEAR(ok.at("model").at("shafts").items()[0].at("mass_kg").number(),
              7850 * 3.14159265358979 / 4 * 0.04 * 0.04 * 0.3, 1e-9);
  const Result r = whirl("check bad.toml --json");
  EXPECT_EQ(r.code, 3);
  EXPECT_EQ(r.err, "");
  const auto bad = tests::parse_json(r.out);
  EXPECT_FALSE(bad.at("ok").boolean());
  EXPECT_EQ(bad.at("diagnostics").items()[0].at("code").text(), "E06");
  EXPECT_EQ(bad.at("diagnostics").items()[0].at("line").number(), 3);
}

// Each part of a message as text, as JSON.
TEST_F(Cli, JsonTellsWhatTheMessageTells) {
  write("bad.toml", "format = 1\n[shaft]\n  lenght = 3\n");
  const auto told = tests::parse_json(whirl("check bad.toml --json").out);
  const auto& d = told.at("diagnostics").items();
  ASSERT_EQ(d.size(), 2u);
  EXPECT_EQ(d[0].at("message").text(), "shaft 'shaft' has no sections");
  EXPECT_EQ(d[0].at("hint").text(),
            "give columns and rows, file = \"shaft.csv\", or [[shaft.section]]");
  EXPECT_EQ(d[0].at("column").number(), 1);
  EXPECT_EQ(d[0].at("length").number(), 7);  // "[shaft]"
  EXPECT_EQ(d[1].at("severity").text(), "error");
  EXPECT_EQ(d[1].at("code").text(), "E04");
  EXPECT_EQ(d[1].at("file").text(), "bad.toml");
  EXPECT_EQ(d[1].at("line").number(), 3);
  EXPECT_EQ(d[1].at("column").number(), 3);
  EXPECT_EQ(d[1].at("length").number(), 6);  // "lenght"
  const std::string text = whirl("check bad.toml").err;
  EXPECT_NE(text.find("bad.toml:3:3: error[E04]: " + d[1].at("message").text()), std::string::npos)
      << text;
}

TEST_F(Cli, ResolvedDeckChecksAndHashes) {
  write("good.toml", good);
  const Result r = whirl("check good.toml --resolved --set parameters.od='50 mm'");
  EXPECT_NE(r.out.find("od = \"50 mm\""), std::string::npos) << r.out;
  write("resolved.toml", r.out);
  EXPECT_EQ(whirl("check resolved.toml --resolved").out, r.out);
  const auto model = deck::load_model(folder_ / "resolved.toml");
  EXPECT_EQ(model.resolved, r.out);
}

TEST_F(Cli, ResultsFolder) {
  write("good.toml", std::string(good) + "[[step]]\ntype = \"modal\"\n");
  const auto model = deck::load_model(folder_ / "good.toml");
  run::RunOptions o;
  o.output = folder_ / "results" / "deep";
  const auto where = run::prepare_results(model, o);
  EXPECT_EQ(read(where / "resolved.toml"), model.resolved);
  const auto run = tests::read_json(where / "run.json");
  EXPECT_EQ(run.at("sha256").text(), run::deck_hash(model));
  EXPECT_EQ(run.at("title").text(), "Two sections");
  for (const auto& e : fs::directory_iterator(where))
    EXPECT_NE(e.path().filename().string()[0], '.') << "left behind: " << e.path();
  write("blocked", "a file where the folder should be");
  o.output = folder_ / "blocked";
  EXPECT_THROW(run::prepare_results(model, o), Error);
}

TEST_F(Cli, Explain) {
  const Result list = whirl("explain");
  for (const auto& c : error_catalogue())
    EXPECT_NE(list.out.find(std::string(c.code) + "  " + c.title), std::string::npos) << c.code;
  const Result one = whirl("explain e07");
  EXPECT_EQ(one.out.substr(0, one.out.find('\n')), "E07: a unit is missing");
  EXPECT_NE(one.out.find("    clearance = \"75 um\""), std::string::npos) << one.out;
  std::istringstream lines(one.out);
  for (std::string line; std::getline(lines, line);)
    EXPECT_LE(line.size(), 88u) << line;
}

TEST_F(Cli, NewDecksAreGood) {
  std::istringstream list(whirl("new").out);
  int count = 0;
  for (std::string line; std::getline(list, line); ++count) {
    const std::string name = line.substr(0, line.find(' '));
    EXPECT_EQ(whirl("new --example " + name + " " + name + ".toml").code, 0);
    const Result r = whirl("check " + name + ".toml");
    EXPECT_EQ(r.code, 0) << name << "\n" << r.err;
    EXPECT_EQ(read(folder_ / (name + ".toml")), whirl("new --example " + name).out);
  }
  EXPECT_GE(count, 4);
  EXPECT_EQ(whirl("new --example paper_rotor paper_rotor.toml").code, 5);  // exists
  EXPECT_EQ(whirl("new --example paper_rotor paper_rotor.toml --force").code, 0);
}

TEST_F(Cli, SchemaAndReferenceNameEveryKey) {
  const Result json = whirl("schema");
  const auto schema = tests::parse_json(json.out);
  EXPECT_EQ(schema.at("additionalProperties").boolean(), false);
  for (const char* key :
       {"shaft", "disk", "bearing", "step", "output", "parameters", "include", "format"})
    EXPECT_TRUE(schema.at("properties").at(key).is_object()) << key;
  const std::string reference = whirl("schema --reference").out;
  for (const char* word : {"### [[bearing]]", "type = \"spring_block\"", "`kyy`", "## Laws of time",
                           "`max_element_length`"})
    EXPECT_NE(reference.find(word), std::string::npos) << word;
  EXPECT_NE(whirl("schema --units").out.find("| `rpm` |"), std::string::npos);
}

TEST_F(Cli, CompletionIsValidShell) {
  const Result r = whirl("completion bash");
  EXPECT_EQ(r.code, 0);
  write("completion.bash", r.out);
  EXPECT_EQ(std::system(("bash -n '" + (folder_ / "completion.bash").string() + "'").c_str()), 0);
  // what a shell would offer after "whirl ch"
  write("ask.bash",
        "source ./completion.bash\nCOMP_WORDS=(whirl ch)\nCOMP_CWORD=1\n_whirl\necho "
        "\"${COMPREPLY[*]}\"\nCOMP_WORDS=(whirl check --re)\nCOMP_CWORD=2\n_whirl\necho "
        "\"${COMPREPLY[*]}\"\n");
  EXPECT_EQ(std::system(("cd '" + folder_.string() + "' && bash ask.bash > answer.txt").c_str()),
            0);
  EXPECT_EQ(read(folder_ / "answer.txt"), "check\n--resolved\n");
  EXPECT_NE(whirl("completion fish").out.find("complete -c whirl"), std::string::npos);
}

TEST_F(Cli, ManPageNamesEveryCommandAndOption) {
  const std::string page = read(WHIRL_SOURCE "/docs/whirl.1");
  ASSERT_FALSE(page.empty());
  std::istringstream lines(whirl("completion fish").out);
  for (std::string line; std::getline(lines, line);) {
    std::size_t k = line.find("__fish_use_subcommand -a ");
    if (k != std::string::npos) {
      EXPECT_NE(page.find("\n.SS whirl " + line.substr(k + 25)), std::string::npos) << line;
    }
    k = line.find(" -l ");
    if (k == std::string::npos) continue;
    std::string option = line.substr(k + 4), escaped;
    for (char c : option)
      escaped += c == '-' ? std::string("\\-") : std::string(1, c);
    EXPECT_NE(page.find("\\-\\-" + escaped), std::string::npos) << option;
  }
}

TEST(DeckHash, IsTheSha256OfTheResolvedText) {  // examples of FIPS 180-4
  model::Model model;
  model.resolved = "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
  EXPECT_EQ(run::deck_hash(model),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  model.resolved.clear();
  EXPECT_EQ(run::deck_hash(model),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

// whatever code a message can carry is explained
TEST_F(Cli, EveryCodeInTheSourceIsExplained) {
  const std::regex code("\"([ENRW][0-9][0-9])\"");
  std::set<std::string> unknown;
  int found = 0;
  for (const char* part : {"src", "elements", "meshes"})
    for (const auto& f : fs::recursive_directory_iterator(fs::path(WHIRL_SOURCE) / part)) {
      if (f.path().extension() != ".cpp" && f.path().extension() != ".hpp") continue;
      const std::string text = read(f.path());
      for (auto it = std::sregex_iterator(text.begin(), text.end(), code);
           it != std::sregex_iterator(); ++it, ++found)
        if (!find_code((*it)[1].str()))
          unknown.insert((*it)[1].str() + " in " + f.path().filename().string());
    }
  EXPECT_GT(found, 100);
  for (const auto& u : unknown)
    ADD_FAILURE() << u;
}

TEST_F(Cli, MinusIsStandardInput) {
  write("good.toml", good);
  const Result r = whirl("check - <good.toml");
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_NE(r.out.find("Two sections"), std::string::npos) << r.out;
  write("bad.toml", "format = 1\n[shaft]\nmas = 3\n");
  const Result bad = whirl("check - <bad.toml");
  EXPECT_EQ(bad.code, 3);
  EXPECT_NE(bad.err.find("standard input:3"), std::string::npos) << bad.err;
}

TEST_F(Cli, AMisspeltInstructionSetIsAnError) {
  write("good.toml", good);
  const Result r = whirl("check good.toml", "env WHIRL_ISA=avx3");
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("error[E98]: WHIRL_ISA = 'avx3'"), std::string::npos) << r.err;
  EXPECT_EQ(whirl("check good.toml", "env WHIRL_ISA=baseline").code, 0);
}

TEST_F(Cli, TooMuchOutputIsSaidWithItsLine) {
  const std::string step =
      "[[step]]\ntype = \"transient\"\nstart = \"rest\"\nduration = \"1e9 s\"\n[[probe]]\nat = "
      "\"left\"\n[output]\nevery = \"1 ns\"\n";
  write("long.toml", good + step);
  const Result r = whirl("run long.toml -o r");
  EXPECT_EQ(r.code, 3);
  EXPECT_NE(r.err.find("long.toml:13:"), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("error[E33]: the output would take"), std::string::npos) << r.err;
}
