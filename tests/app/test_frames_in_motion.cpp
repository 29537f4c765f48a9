// Frames of a motion in time show what those of an equilibrium show: section forces, stresses,
// forces of the supports.
#include "deck_run.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

using whirl::test::DeckRun;

TEST(FramesInMotion, ShowEveryArrayOfAnEquilibrium) {
  if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOXML' 2>/dev/null") != 0)
    GTEST_SKIP() << "no python3-vtk9";
  const DeckRun d(R"(format = 1
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40], ["b", 200, 50]]
[[disk]]
at = "a:end"
mass = "20 kg"
Ip = "0.3 kg.m^2"
Id = "0.16 kg.m^2"
[[bearing]]
name = "L"
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "R"
at = "b:end"
type = "linear"
kyy = "1e7 N/m"
kzz = "2e7 N/m"
[[load]]
at = "a:end"
force = ["0 N", "500 N", "0 N"]
[[step]]
name = "sag"
type = "static"
[[step]]
name = "go"
type = "transient"
duration = "1 us"
[output]
report = false
[[output.vtk]]
step = "sag"
content = ["line", "surface", "bearings"]
[[output.vtk]]
step = "go"
frames = 2
content = ["line", "surface", "bearings"]
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  if (d.says("VTK")) GTEST_SKIP() << "built without VTK";
  EXPECT_EQ(std::system(("/usr/bin/python3 compare_frames.py " + (d.folder / "r" / "vtk").string() +
                         " sag go")
                            .c_str()),
            0);
}

// A rotor that spins at 60 rpm and moves at 0.5 m/s: the one is not the other.
TEST(FramesInMotion, HoldTheAngularVelocity) {
  if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOXML' 2>/dev/null") != 0)
    GTEST_SKIP() << "no python3-vtk9";
  const DeckRun d(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40]]
[[initial]]
velocity = ["0 m/s", "0.5 m/s", "0 m/s"]
angular_velocity = ["6.283185307179586 rad/s", "0 rad/s", "0 rad/s"]
[[step]]
name = "go"
type = "transient"
start = "rest"
duration = "1 ms"
[output]
report = false
[[output.vtk]]
step = "go"
frames = 2
content = ["line"]
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  if (d.says("VTK")) GTEST_SKIP() << "built without VTK";
  const std::string script = R"(
import sys
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
reader = vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])
reader.Update()
data = reader.GetOutput().GetPointData()
wrong = 0
for name, expected in (("velocity", (0, 0.5, 0)), ("angular_velocity", (6.283185307, 0, 0))):
    array = data.GetArray(name)
    assert array.GetNumberOfTuples() > 1
    for i in range(array.GetNumberOfTuples()):
        wrong += max(abs(a - b) for a, b in zip(array.GetTuple(i), expected)) > 1e-5
sys.exit(wrong > 0)
)";
  EXPECT_EQ(std::system(("/usr/bin/python3 -c '" + script + "' '" +
                         (d.folder / "r" / "vtk" / "go_line" / "frame_000000.vtp").string() + "'")
                            .c_str()),
            0);
}
