// `whirl view`: the state script of ParaView beside the frames of a run.
#include "deck_run.hpp"

#include <core/plugin.hpp>

#include <array>

using namespace whirl;
using namespace whirl::test;

namespace {

const char* deck = R"(format = 1
[[shaft]]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["left", 200, 30], ["right", 200, 30]]
[[disk]]
name = "wheel"
at = "left:end"
mass = "4 kg"
Id = "0.01 kg.m^2"
Ip = "0.02 kg.m^2"
[[bearing]]
name = "A"
at = "left:start"
type = "linear"
kxx = "1e6 N/m"
kyy = "1e6 N/m"
kzz = "2e6 N/m"
[[bearing]]
name = "B"
at = "right:end"
type = "linear"
kyy = "1e6 N/m"
kzz = "2e6 N/m"
[[probe]]
name = "P"
at = "left:end"
[[unbalance]]
at = "left:end"
amount = "100 g.mm"
[[step]]
name = "sag"
type = "static"
[[step]]
name = "turn"
type = "transient"
start = "rest"
duration = "20 ms"
[[drive]]
at = "left:start"
type = "speed"
speed = "3000 rpm"
step = "turn"
[[output.vtk]]
frames = 5
content = ["line", "surface", "bearings", "orbits"]
deformation_scale = 20
)";

struct Said {
  int exit = -1;
  std::string text;
};

Said view(const std::filesystem::path& folder, const std::string& arguments) {
  Said out;
  const std::string command =
      "cd '" + folder.string() + "' && '" WHIRL_EXE "' view " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 4096> buffer;
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    out.text.append(buffer.data(), n);
  const int status = pclose(pipe);
  out.exit = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return out;
}

/// Reads the script as Python does, without ParaView: frames and arrays it names must be there.
const char* check_script = R"(
import ast, os, re, sys
text = open("r/view.py").read()
tree = ast.parse(text)
given = {}
for node in tree.body:
    if isinstance(node, ast.Assign) and node.targets[0].id in ("shown", "kinds", "folder"):
        given[node.targets[0].id] = ast.literal_eval(node.value)
    if len(given) == 3:
        break
assert "@" not in re.sub(r"#.*", "", text), "a mark was left"
assert given["shown"] == sys.argv[1], given
assert given["kinds"] == ["surface", "line", "bearings", "orbits"], given
header = ""
for kind in given["kinds"]:
    listed = open(os.path.join(given["folder"], f"{given['shown']}_{kind}.pvd")).read()
    frame = re.search(r"file=\"([^\"]+)\"", listed).group(1)
    header += open(os.path.join(given["folder"], frame), "rb").read().split(b"<AppendedData")[0].decode()
arrays = set(re.findall(r"Name=\"([^\"]+)\"", header))
used = {n.value for n in ast.walk(tree) if isinstance(n, ast.Constant) and isinstance(n.value, str)
        and re.fullmatch(r"\w+ \[[^\]]+\]|stripe|part names|deformation scale", n.value)}
assert len(used) >= 6 and used <= arrays, (used, used - arrays)
)";

/// Stands for ParaView: takes what the script makes and shows, and looks at it.
const char* stand_in = R"(
import sys, types

class Array:
    def __init__(self, name):
        self.Name = name
    def GetNumberOfComponents(self):
        return 3
    def GetRange(self, component):
        return (0.0, 1.0)

class Arrays(list):
    def __getitem__(self, name):
        return Array(name)

class Thing:
    TimestepValues = [0.0, 1.0]
    PointData = Arrays([Array("displacement [m]"), Array("radius [m]"), Array("force [N]")])
    def __init__(self, kind, args, given):
        self.__dict__.update(given, kind=kind, args=args)
        made.append(self)
    def GetDataInformation(self):
        return self
    def GetBounds(self):
        return (0.0, 0.4, -0.1, 0.1, -0.1, 0.1)
    def GetAbstractArray(self, name):
        return None
    def __getattr__(self, name):
        if name[0] == "_":
            raise AttributeError(name)
        return lambda *args, **given: Thing(name, args, given)

made = []
paraview, simple = types.ModuleType("paraview"), types.ModuleType("paraview.simple")
for name in """CreateView Text Show ColorBy GetColorTransferFunction GetScalarBar Threshold PVDReader VTKHDFReader Tube Glyph
               GetAnimationScene AnnotateTimeFilter CreateLayout AssignViewToLayout AddCameraLink Render SaveScreenshot""".split():
    setattr(simple, name, lambda *args, _kind=name, **given: Thing(_kind, args, given))
simple._DisableFirstRenderCameraReset = lambda: None
simple.servermanager, simple.paraview, paraview.simple = Thing("servermanager", (), {}), paraview, simple
sys.modules.update({"paraview": paraview, "paraview.simple": simple})
exec(open("r/view.py").read(), {"__file__": "r/view.py", "__name__": "__main__"})

shown = [(t, t.args[0]) for t in made if t.kind == "Show"]
surface = [d for d, source in shown if getattr(source, "registrationName", "") == "surface without stripe"]
tubes = [source for d, source in shown if source.kind == "Tube" and source.Input.registrationName == "turn orbits"]
assert len(surface) == 1 and 0.3 <= surface[0].Opacity <= 0.5, surface
assert len(tubes) == 2 and all(0.0005 < t.Radius < 0.003 for t in tubes), tubes
assert not [d for d, source in shown if getattr(source, "registrationName", "") == "turn orbits"]
)";

}  // namespace

// Trails run inside the rotor: the surface lets them be seen, and they are thick enough to be.
TEST(View, TrailsAreSeenThroughTheSurface) {
  const DeckRun r(deck);
  ASSERT_EQ(r.exit, 0) << r.log;
  if (r.says("VTK")) GTEST_SKIP() << "built without VTK";
  ASSERT_EQ(view(r.folder, "r turn").exit, 0);
  std::ofstream(r.folder / "stand_in.py") << stand_in;
  EXPECT_EQ(std::system(("cd '" + r.folder.string() + "' && /usr/bin/python3 stand_in.py").c_str()),
            0);
}

TEST(View, ScriptNamesFramesAndArraysThatThereAre) {
  const DeckRun r(deck);
  ASSERT_EQ(r.exit, 0) << r.log;
  if (r.says("VTK")) GTEST_SKIP() << "built without VTK";
  const Said most = view(r.folder, "r");
  EXPECT_EQ(most.exit, 0) << most.text;
  EXPECT_NE(most.text.find("turn (5 frames; surface, line, bearings, orbits)"), std::string::npos)
      << most.text;
  EXPECT_NE(most.text.find("frames there are: sag, turn"), std::string::npos) << most.text;
  const auto holds = [&](const char* shown) {
    std::ofstream(r.folder / "check.py") << check_script;
    return std::system(
               ("cd '" + r.folder.string() + "' && /usr/bin/python3 check.py " + shown).c_str()) ==
           0;
  };
  EXPECT_TRUE(holds("turn"));
  EXPECT_EQ(view(r.folder, "r turn --script other.py").exit, 0);
  EXPECT_TRUE(std::filesystem::exists(r.folder / "other.py"));
}

TEST(View, KnowsFramesInOneFile) {
  if (!Plugin::available("hdf5")) GTEST_SKIP() << "built without HDF5";
  const DeckRun r(std::string(deck) + "format = \"vtkhdf\"\n");
  ASSERT_EQ(r.exit, 0) << r.log;
  for (const char* set : {"sag_line", "turn_surface", "turn_line", "turn_bearings", "turn_orbits"})
    EXPECT_TRUE(std::filesystem::exists(r.folder / "r" / "vtk" / (std::string(set) + ".vtkhdf")))
        << set;
  EXPECT_FALSE(std::filesystem::exists(r.folder / "r" / "vtk" / "turn_line.pvd"));
  const Said said = view(r.folder, "r turn");
  EXPECT_EQ(said.exit, 0) << said.text;
  EXPECT_NE(said.text.find("turn (one file a set; surface, line, bearings, orbits)"),
            std::string::npos)
      << said.text;
}

TEST(View, SaysWhatThereIsNot) {
  const DeckRun r(deck);
  ASSERT_EQ(r.exit, 0) << r.log;
  if (r.says("VTK")) GTEST_SKIP() << "built without VTK";
  const Said wrong = view(r.folder, "r trun");
  EXPECT_EQ(wrong.exit, 2) << wrong.text;
  EXPECT_NE(wrong.text.find("did you mean 'turn'?"), std::string::npos) << wrong.text;
  const Said empty = view(r.folder, ".");
  EXPECT_NE(empty.exit, 0);
  EXPECT_NE(empty.text.find("E43"), std::string::npos) << empty.text;
}

TEST(View, ParaViewShowsIt) {
  // where ParaView is installed: it does not go together with VTK's own packages on Debian 12
  if (std::system("command -v pvbatch >/dev/null && command -v xvfb-run >/dev/null") != 0)
    GTEST_SKIP() << "no ParaView (pvbatch, xvfb-run)";
  if (std::system("pvbatch find_paraview.py >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "ParaView without its Python module";
  const DeckRun r(deck);
  ASSERT_EQ(r.exit, 0) << r.log;
  if (r.says("VTK")) GTEST_SKIP() << "built without VTK";
  ASSERT_EQ(view(r.folder, "r").exit, 0);
  EXPECT_EQ(
      std::system(("cd '" + r.folder.string() +
                   "' && timeout 100 xvfb-run -a -s -noreset pvbatch r/view.py p.png >log 2>&1")
                      .c_str()),
      0);
  EXPECT_GT(std::filesystem::file_size(r.folder / "p.png"), 20000u);
}
