"""Reads the frames that test_frames wrote with VTK's own reader and checks what is in them (no numpy needed)."""
import math
import sys

from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

folder = sys.argv[1]


def read(name, k):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(f"{folder}/run_up_{name}/frame_{k:06d}.vtp")
    reader.Update()
    return reader.GetOutput()


def tuples(array):
    return [array.GetTuple(i) for i in range(array.GetNumberOfTuples())]


def arrays(data):
    return {data.GetArrayName(i): tuples(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


def check(ok, what):
    if not ok:
        sys.exit(f"read_frames.py: {what}")


def near(a, b, tolerance):
    return max(abs(x - y) for x, y in zip(a, b)) < tolerance


for k in range(5):
    for name in ("line", "surface", "bearings", "orbits"):
        field = read(name, k).GetFieldData().GetArray("TimeValue")
        check(field is not None and field.GetValue(0) == 0.1 * k, f"TimeValue of {name} {k}")

t = 0.1 * 3
w = (math.cos(40 * t), math.sin(40 * t))
line = read("line", 3)
points = tuples(line.GetPoints().GetData())
data = arrays(line.GetPointData())
for name in ("displacement [m]", "rotation [rad]", "velocity [m/s]", "director", "axis2", "axis3"):
    check(len(data[name]) == len(points) and len(data[name][0]) == 3, f"{name} is not a 3-vector")
middle = min(range(len(points)), key=lambda i: abs(points[i][0] - 0.5))
check(near(data["displacement [m]"][middle], (0, 1e-3 * w[0], 1e-3 * w[1]), 1e-9), "displacement is the true one")
check(near(points[middle], (0.5, 1e-2 * w[0], 1e-2 * w[1]), 1e-7), "points are magnified by 10")
check(all(near(s, (100 * t,), 1e-5) for s in data["spin_angle [rad]"]), "spin angle")
# rotation vector of a tilt towards w by atan(3e-3) at the left end: e x d
check(near(data["rotation [rad]"][0], (0, -3e-3 * w[1], 3e-3 * w[0]), 1e-7), "rotation vector")
check(all(near(r, (0.03,), 1e-8) for r in data["radius [m]"]) and line.GetNumberOfLines() == 1, "line and radius")

check(data["von_mises [Pa]"][middle] == (3e6,) and max(data["von_mises [Pa]"])[0] == 3e6, "stress")

surface = read("surface", 3)
data, cells = arrays(surface.GetPointData()), arrays(surface.GetCellData())
check(surface.GetPointData().GetNormals() is not None and len(data["Normals"][0]) == 3, "normals")
check(set(cells["stripe"]) == {(0,), (1,)} and len(cells["stripe"]) == surface.GetNumberOfPolys(), "stripe")
check(set(cells["part"]) == {(0,), (1,)}, "parts")


def names(data, array):
    field = data.GetFieldData().GetAbstractArray(array)
    return [field.GetValue(i) for i in range(field.GetNumberOfValues())] if field else []


check(len(names(surface, "part names")) == 2 and all(names(surface, "part names")), "names of the parts")
check(names(surface, "deformation scale") == ["10"] and names(line, "deformation scale") == ["10"], "scale is said")
bounds = surface.GetBounds()
check(0.39 < bounds[5] - bounds[4] < 0.41 and abs(bounds[1] - 1.0) < 1e-2, "true size")

bearings = read("bearings", 3)
check(bearings.GetNumberOfVerts() == 2 and bearings.GetNumberOfLines() == 6 + 2, "bearing glyphs")
force = arrays(bearings.GetPointData())["force [N]"]
check([f for f in force if any(f)] == [(0, 0, 500)] * 2, "support forces stand at the journals")
check(len(arrays(bearings.GetCellData())["support"]) == 10, "support numbers")
check(len(names(bearings, "support names")) == 2, "names of the supports")

orbits = read("orbits", 3)
check(orbits.GetNumberOfPoints() == 4, "trail length")
check(near([a[0] for a in arrays(orbits.GetPointData())["age [s]"]], (0.3, 0.2, 0.1, 0.0), 1e-6), "trail age")
