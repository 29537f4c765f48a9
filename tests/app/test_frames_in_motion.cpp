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
for name, expected in (("velocity [m/s]", (0, 0.5, 0)), ("angular_velocity [rad/s]", (6.283185307, 0, 0))):
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

// A joint is a vertex with the load it carries.
TEST(FramesInMotion, JointsStandAmongTheSupports) {
  if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOXML' 2>/dev/null") != 0)
    GTEST_SKIP() << "no python3-vtk9";
  const DeckRun d(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "beam"
material = "steel"
rotating = false
[[shaft.section]]
name = "a"
length = "1 m"
od = "40 mm"
[[shaft]]
name = "post"
material = "steel"
rotating = false
path = [{ to = ["1 m", "0 m", "-500 mm"] }]
origin = ["1 m", "0 m", "0 m"]
[[shaft.section]]
name = "b"
length = "500 mm"
od = "40 mm"
[[joint]]
name = "wall"
kind = "rigid"
at = "a:start"
[[joint]]
name = "ball"
kind = "spherical"
at = "b:start"
to = "a:end"
[[bearing]]
name = "foot"
at = "b:end"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "a:mid"
force = ["0 N", "200 N", "-300 N"]
[[step]]
name = "s"
type = "static"
[output]
report = false
[[output.vtk]]
step = "s"
content = ["bearings"]
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  if (d.says("VTK")) GTEST_SKIP() << "built without VTK";
  const std::string script = R"(
import csv, sys
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
reader = vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])
reader.Update()
poly = reader.GetOutput()
joint = poly.GetCellData().GetArray("joint")
support = poly.GetCellData().GetArray("support")
force = poly.GetPointData().GetArray("force [N]")
assert poly.GetNumberOfVerts() == 3
rows = [[float(x) for x in r[1:4]] for r in csv.reader(open(sys.argv[2])) if r[0] in ("wall", "ball")]
wrong = len(rows) != 2
places = ((0, 0, 0), (1, 0, 0))
for k in range(2):
    cell = [c for c in range(poly.GetNumberOfCells()) if joint.GetValue(c) == k]
    wrong += len(cell) != 1 or support.GetValue(cell[0]) != -1
    point = poly.GetCell(cell[0]).GetPointId(0)
    wrong += max(abs(a - b) for a, b in zip(force.GetTuple(point), rows[k])) > 1e-4
    wrong += max(abs(a - b) for a, b in zip(poly.GetPoint(point), places[k])) > 5e-3
    wrong += max(abs(x) for x in rows[k]) < 10
wrong += support.GetValue(0) != 0 or joint.GetValue(0) != -1
moment = poly.GetPointData().GetArray("moment [N m]")
wanted = {tuple(float(x) for x in r[4:7]) for f in (2, 3) for r in csv.reader(open(sys.argv[f])) if r[0] in ("wall", "ball", "foot")}
shown = [moment.GetTuple(poly.GetCell(c).GetPointId(0)) for c in range(3)]
wrong += len(wanted) != 3 or max(abs(x) for m in wanted for x in m) < 10
wrong += not all(any(max(abs(a - b) for a, b in zip(w, m)) < 1e-4 for m in shown) for w in wanted)
sys.exit(wrong)
)";
  EXPECT_EQ(std::system(("/usr/bin/python3 -c '" + script + "' '" +
                         (d.folder / "r" / "vtk" / "s_bearings" / "frame_000000.vtp").string() +
                         "' '" + (d.folder / "r" / "s_joints.csv").string() + "' '" +
                         (d.folder / "r" / "s_supports.csv").string() + "'")
                            .c_str()),
            0);
}

// Where a support, a load or a step of the diameter makes section forces jump, both values stand in the
// picture, each at a point of its own: those of the table of sections.
TEST(FramesInMotion, JumpsOfSectionForcesStandWhereTheyAre) {
  if (std::system("/usr/bin/python3 -c 'import vtkmodules.vtkIOXML' 2>/dev/null") != 0)
    GTEST_SKIP() << "no python3-vtk9";
  const DeckRun d(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "r"
material = "steel"
[[shaft.section]]
name = "a"
length = "300 mm"
od = "40 mm"
[[shaft.section]]
name = "b"
length = "200 mm"
od = "50 mm"
[[shaft.section]]
name = "c"
length = "100 mm"
od = "50 mm"
[[shaft.section]]
name = "hub"
length = "80 mm"
od = "120 mm"
rigid = true
[[shaft.section]]
name = "d"
length = "200 mm"
od = "30 mm"
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
[[load]]
at = "150 mm"
force = ["0 N", "500 N", "0 N"]
[[load]]
at = "d:end"
force = ["0 N", "100 N", "40 N"]
moment = ["0 N.m", "0 N.m", "3 N.m"]
[[step]]
name = "s"
type = "static"
[output]
report = false
[[output.vtk]]
step = "s"
content = ["line", "surface"]
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  if (d.says("VTK")) GTEST_SKIP() << "built without VTK";
  const std::string script = R"(
import csv, sys
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
reader = vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])
reader.Update()
poly = reader.GetOutput()
data = poly.GetPointData()
names = ("displacement [m]", "force [N]", "moment [N m]", "von_mises [Pa]")
arrays = [data.GetArray(n) for n in names]
points = []
for i in range(poly.GetNumberOfPoints()):
    u, f, m, s = (a.GetTuple(i) for a in arrays)
    lateral = lambda v: (v[1] ** 2 + v[2] ** 2) ** 0.5
    points.append((poly.GetPoint(i)[0] - u[0], lateral(f), lateral(m), s[0], f[1]))
rows = [[r[0]] + [float(x) for x in r[1:]] for r in csv.reader(open(sys.argv[2])) if r[0] == "r"]
ends = [r for k, r in enumerate(rows) if k in (0, len(rows) - 1) or rows[k - 1][2] != r[2] or rows[k + 1][2] != r[2]]
assert len(ends) >= 10
near = lambda a, b, size: abs(a - b) < 2e-4 * size
wrong = 0
for r in ends:
    s, v, m, stress = r[1], (r[4] ** 2 + r[5] ** 2) ** 0.5, r[9], r[13]
    wrong += not any(abs(x - s) < 1e-6 and near(a, v, 500) and near(b, m, 50) and near(c, stress, 1e7) for x, a, b, c, _ in points)
# two points at the load, at both supports but one at the end, at the steps; the rigid hub goes on from what its neighbours leave
count = lambda s: sum(abs(x - s) < 1e-6 for x, *_ in points)
wrong += [count(s) for s in (0.15, 0.3, 0.5, 0.0, 0.88)] != [2, 2, 2, 1, 1]
at_load = [p[4] for p in points if abs(p[0] - 0.15) < 1e-6]
wrong += not near(abs(at_load[1] - at_load[0]), 500, 500)
wrong += poly.GetNumberOfLines() < 6
# the skin has both at the steps: a ring of points for each
reader.SetFileName(sys.argv[3])
reader.Update()
skin = reader.GetOutput().GetPointData()
u, stress = skin.GetArray("displacement [m]"), skin.GetArray("von_mises [Pa]")
rings = {(round(reader.GetOutput().GetPoint(i)[0], 4), stress.GetValue(i)) for i in range(stress.GetNumberOfTuples())}
steps = [r for r in ends if min(abs(r[1] - s) for s in (0.3, 0.6, 0.68)) < 1e-6]
assert len(steps) >= 4
for r in steps:
    wrong += not any(abs(x - r[1]) < 2e-3 and near(s, r[13], 1e7) for x, s in rings)
sys.exit(wrong)
)";
  EXPECT_EQ(std::system(("/usr/bin/python3 -c '" + script + "' '" +
                         (d.folder / "r" / "vtk" / "s_line" / "frame_000000.vtp").string() + "' '" +
                         (d.folder / "r" / "s_sections.csv").string() + "' '" +
                         (d.folder / "r" / "vtk" / "s_surface" / "frame_000000.vtp").string() + "'")
                            .c_str()),
            0);
}

// Sets with heads of all lengths: the data behind them are found by readers with any expat.
TEST(FramesInMotion, DataAreFoundByEveryReader) {
  const DeckRun d(R"(format = 1
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40], ["b", 200, 50]]
[[bearing]]
at = "a:start"
type = "linear"
kyy = "1e7 N/m"
kzz = "2e7 N/m"
[[bearing]]
at = "b:end"
type = "linear"
kyy = "1e7 N/m"
kzz = "2e7 N/m"
[[drive]]
name = "d"
at = "a:start"
type = "speed"
speed = "3000 rpm"
[[step]]
name = "t"
type = "transient"
duration = "0.02 s"
[[probe]]
name = "P"
at = "a:end"
[output]
report = false
[[output.vtk]]
step = "t"
frames = 3
content = ["line", "surface", "bearings", "orbits"]
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  if (d.says("VTK")) GTEST_SKIP() << "built without VTK";
  EXPECT_EQ(std::system(("/usr/bin/python3 find_appended_data.py '" + (d.folder / "r").string() +
                         "'/vtk/t_*/*.vtp >/dev/null")
                            .c_str()),
            0);
}
